#pragma once

#include <cstddef>
#include <optional>

#include "taut/hull/contact/contact_system.h"

namespace taut {

/// The pole in which contact i stands in `pole`, told with the direction in which it comes there
/// from a ruling before. None where it leaves its patch on the way.
std::optional<Contact> into_pole(const ContactSystem& system, const Ruling& from,
                                 const Ruling& pole, std::size_t i);

/// A contact of an arc that passes a pole: at the pole, told with the direction in which it comes
/// to it from the patch before, and with that in which it leaves it, straight on, in the patch
/// beyond.
struct PolePassage {
  Contact into, out_of;
};

/// How contact i passes the pole in which it stands in `pole`, on the way from a ruling before to
/// one after. None where it leaves the patch before it comes there.
std::optional<PolePassage> pole_passage(const ContactSystem& system, const Ruling& from,
                                        const Ruling& pole, const Ruling& to, std::size_t i);

}  // namespace taut
