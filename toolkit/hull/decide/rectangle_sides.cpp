#include "taut/hull/decide/rectangle_sides.h"

#include <algorithm>

#include "taut/hull/decide/height_growth.h"

namespace taut {
namespace {

/// The most that a direction inwards leads along the side, in the rectangle's parameters from 0 to
/// 1: at a corner, where it is exchanged for that of the other side, what is between leads inwards
/// too.
constexpr double most_oblique = 0.99;

}  // namespace

void RectangleSides::turn_to(int index, const Interval& u, const Interval& v) {
  const MapElement& element = pieces_.element(index);
  shape_ = element.root->exact.shape;
  pieces_.restricted(index, u, v, net_);
  if (element.rational) even_weights(shape_, net_);
}

bool RectangleSides::have_no_low(const CellView& view, Side side, double tilt) const {
  const int degree = along_v(side) ? shape_.q : shape_.p;
  const int fixed = at_upper_end(side) ? (along_v(side) ? shape_.p : shape_.q) : 0;
  const auto at_side = [&](int along) -> const dvec4& {
    return along_v(side) ? at(fixed, along) : at(along, fixed);
  };
  HeightGrowth growth(view, tilt);
  for (int k = 0; k <= degree; ++k) growth.include(at_side(k));
  bool concave = degree > 1;
  for (int k = 0; k + 2 <= degree && concave; ++k) {
    concave = growth.along(2.0 * at_side(k + 1) - at_side(k) - at_side(k + 2));
  }
  bool grows = !concave;
  bool falls = !concave;
  for (int k = 0; k < degree; ++k) {
    grows = grows && growth.along(at_side(k + 1) - at_side(k));
    falls = falls && growth.along(at_side(k) - at_side(k + 1));
  }
  return concave || grows || falls;
}

bool RectangleSides::rise(const CellView& view, Side side, double tilt, bool obliquely) const {
  const int degree = along_v(side) ? shape_.q : shape_.p;
  const int across = along_v(side) ? shape_.p : shape_.q;
  const auto from_side = [&](int along, int depth) -> const dvec4& {
    const int k = at_upper_end(side) ? across - depth : depth;
    return along_v(side) ? at(k, along) : at(along, k);
  };
  HeightGrowth growth(view, tilt);
  for (int k = 0; k <= degree; ++k) growth.include(from_side(k, 0));
  const auto rises = [&](double m) {
    for (int k = 0; k <= degree; ++k) {
      const dvec4& own = from_side(k, 0);
      dvec4 along(0.0);
      if (m != 0 && k > 0) along += double(k) * (own - from_side(k - 1, 0));
      if (m != 0 && k < degree) along += double(degree - k) * (from_side(k + 1, 0) - own);
      if (!growth.along(double(across) * (from_side(k, 1) - own) + m * along)) return false;
    }
    return true;
  };
  if (rises(0)) return true;
  if (degree < 2 || !obliquely) return false;
  const auto middle = [&](const dvec4& p) {
    const Corners y = heights(p, view.q(), view.corners());
    return y[0] + y[1] + y[2] + y[3];
  };
  const int k = (degree - 2) / 2;
  const double own = degree * (degree - 1) *
                     middle(from_side(k, 0) - 2.0 * from_side(k + 1, 0) + from_side(k + 2, 0));
  const int l = (degree - 1) / 2;
  const double mixed =
      degree * across *
      middle(from_side(l + 1, 1) - from_side(l, 1) - from_side(l + 1, 0) + from_side(l, 0));
  const double oblique = own != 0 ? std::clamp(-mixed / own, -most_oblique, most_oblique) : 0;
  return oblique != 0 && rises(oblique);
}

RectangleSides::Corner RectangleSides::corner(Side side, Side other) const {
  const bool of_v = along_v(side);
  const bool upper_u = at_upper_end(of_v ? side : other);
  const bool upper_v = at_upper_end(of_v ? other : side);
  const auto from_corner = [&](int i, int j) -> const dvec4& {
    return at(upper_u ? shape_.p - i : i, upper_v ? shape_.q - j : j);
  };
  const dvec3 own = euclidean(from_corner(0, 0));
  const dvec3 ways[] = {euclidean(from_corner(1, 0)) - own, euclidean(from_corner(0, 1)) - own};
  return {from_corner(0, 0), ways[of_v ? 1 : 0], ways[of_v ? 0 : 1]};
}

}  // namespace taut
