#include "taut/hull/contact/ruling_starts.h"

#include <algorithm>

#include "taut/hull/contact/level_sides.h"
#include "taut/hull/contact/local_curvature.h"
#include "taut/hull/contact/parabolic_sides.h"

namespace taut {
namespace {

/// n turns with the square of the contact's way: at the end of an edge that does not bend there,
/// and off a side across which the patch is level.
bool leaves_flat(const ContactGeometry& geometry, const Ruling& r, const Ruling& other,
                 std::size_t i) {
  const Contact& c = r.contact[i];
  if (c.kind != SourceKind::face) return ends_straight(geometry, c);
  return std::any_of(all_sides.begin(), all_sides.end(), [&](Side side) {
    const double value = at_upper_end(side) ? 1 : 0;
    const double from = along_v(side) ? c.u : c.v;
    const double to = along_v(side) ? other.contact[i].u : other.contact[i].v;
    return from == value && to != value && is_level_across(geometry, c, side, r.n);
  });
}

}  // namespace

RulingStart start_at(const ContactGeometry& geometry, const Ruling& r, const Ruling& other) {
  const std::array<bool, 2> flat = {leaves_flat(geometry, r, other, 0),
                                    leaves_flat(geometry, r, other, 1)};
  if (!flat[0] && !flat[1]) return RulingStart::plain;
  const auto moves_so = [&](std::size_t i) {
    return flat[i] || r.contact[i].kind == SourceKind::vertex;
  };
  return moves_so(0) && moves_so(1) ? RulingStart::stands : RulingStart::straight;
}

bool begins_on_segment(const ContactGeometry& geometry, const Ruling& r) {
  return std::any_of(r.contact.begin(), r.contact.end(), [&](const Contact& c) {
    return c.kind == SourceKind::face &&
           std::any_of(all_sides.begin(), all_sides.end(), [&](Side side) {
             const double value = along_v(side) ? c.u : c.v;
             return value == (at_upper_end(side) ? 1 : 0) && straight_piece(geometry, c, side);
           });
  });
}

}  // namespace taut
