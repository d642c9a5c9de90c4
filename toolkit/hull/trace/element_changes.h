#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "taut/bounds/contact_exits.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/exit_margins.h"
#include "taut/hull/trace/curve_point.h"

namespace taut {

/// Where one of the two contacts of a separating curve stands at an exit of its element.
struct ElementChange {
  double length = 0;  ///< along the step's tangent
  int contact = 0;
  ContactExit exit;
  CommonSupport support;
  double after = 0;  ///< the margin at the step's end, negative
};

/// The change's contacts in their elements, the one at its exit exactly.
void put_on_border(const ContactGeometry& geometry, ElementChange& event);

/// The changes of elements that steps from a point of a separating curve meet.
class ElementChanges {
 public:
  /// It follows the point, which outlives it, while the contacts stay in their elements.
  explicit ElementChanges(const CurvePoint& point)
      : geometry_(point.geometry()), system_(point.system()), point_(point) {}

  /// Begins in the point's elements.
  void begin();
  /// The first margin on the way to `next`, a step of this length, that is crossed there. Not
  /// `known` if it is not found where.
  std::optional<ElementChange> first(const CommonSupport& next, double length, bool& known) const;
  /// A contact that the step takes across a pole, or -1, and the side.
  std::pair<int, Side> pole_crossed(const CommonSupport& next) const;

 private:
  std::optional<ElementChange> solved(const CommonSupport& next, double share, int contact,
                                      const ContactExit& exit) const;
  double margin(const CommonSupport& s, int contact, const ContactExit& exit) const {
    return exit_margin(geometry_, s, contact, exit).residual;
  }
  bool stays_level(int contact, const ContactExit& exit) const;
  ElementChange change_here(int contact, const ContactExit& exit) const;
  bool precedes(const ElementChange& a, const ElementChange& b) const;
  double slack(int contact, const ContactExit& exit) const;

  const ContactGeometry& geometry_;
  const ContactSystem& system_;
  const CurvePoint& point_;
  std::array<std::vector<ContactExit>, 2> exits_;
};

}  // namespace taut
