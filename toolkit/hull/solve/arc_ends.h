#pragma once

#include <optional>
#include <vector>

#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/solve/ruling_search.h"

namespace taut {

/// Leaves out known rulings so close to the one in which their arc begins (0) or ends (1), if that
/// is at a pole, that rounding moves their contacts by more than they tell. One is left at least.
void drop_close_to_pole(const ContactGeometry& geometry, const Ruling& end_ruling,
                        std::vector<Ruling>& known, int end);

/// Leads an arc on from its last ruling to the free end in which its contacts merge: by rulings of
/// less and less length, also where the map's resolution ends before. Where the end is not `told`
/// before nor found, in one of the contacts.
void merge(const RulingSearch& search, std::vector<ArcPiece>& pieces,
           const std::optional<Ruling>& told = std::nullopt);

}  // namespace taut
