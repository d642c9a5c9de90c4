#pragma once

#include <array>
#include <vector>

#include "taut/bounds/contact_geometry.h"

namespace taut {

/// Elements that a contact passes on one way, at most. They may be much smaller than ways that are
/// not divided.
inline constexpr int most_passed = 256;

/// Where the segment from one point to another passes a side of a patch, nearly: of the side's
/// points the nearest to the segment's line, from the contact on the side on.
Contact passed_on_side(const ContactGeometry& geometry, Contact c, Side side, const dvec3& from,
                       const dvec3& to);

/// A contact's way to another place, straight as far as borders between elements let it: the
/// shortest over borders that are no farther than some depth below the two along n, or else over
/// the highest. (A detour over a corner would enclose what does not support.) Where it is not
/// known, as between parts or over more than `most_passed` elements, it has no borders, and at()
/// stays at its beginning.
class ContactWay {
 public:
  ContactWay(const ContactGeometry& geometry, const Contact& from, const Contact& to,
             const dvec3& n, double depth);

  /// There is one: elements that are not the same have borders between them.
  bool is_known() const { return same_element(from_, to_) || !borders_.empty(); }

  /// Borders that it passes, in each the contact as one of the element before and of that beyond.
  const std::vector<std::array<Contact, 2>>& borders() const { return borders_; }
  /// Share of the way to border k; infinity if there are not so many.
  double share(std::size_t k) const { return k < shares_.size() ? shares_[k] : infinity; }

  /// Where it is at a share: straight in the parameters of the element that it is in.
  Contact at(double share) const;
  /// The same when it has passed so many borders.
  Contact at(double share, std::size_t passed) const;

 private:
  Contact from_, to_;
  std::vector<std::array<Contact, 2>> borders_;
  std::vector<double> shares_;
};

}  // namespace taut
