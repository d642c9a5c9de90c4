#include "taut/hull/decide/rectangle_sides.h"

#include <algorithm>

#include "taut/bounds/vector_net.h"
#include "taut/hull/decide/height_growth.h"

namespace taut {
namespace {

/// The most that a direction inwards leads along the side, in the rectangle's parameters from 0 to
/// 1: at a corner, where it is exchanged for that of the other side, what is between leads inwards
/// too.
constexpr double most_oblique = 0.99;

/// How often a side is halved to tell where heights grow along it, are concave, or fall.
constexpr int side_halvings = 10;

}  // namespace

void RectangleSides::turn_to(int index, const Interval& u, const Interval& v) {
  const MapElement& element = pieces_.element(index);
  shape_ = element.root->exact.shape;
  pieces_.restricted(index, u, v, net_);
  if (element.rational) even_weights(shape_, net_);
}

/// What they do along the side, part by part: where they grow, then are concave, then fall they
/// have no low. At ends where the side is straight they are concave all but strictly.
bool RectangleSides::have_no_low(const CellView& view, Side side, double tilt) const {
  const int degree = along_v(side) ? shape_.q : shape_.p;
  const int fixed = at_upper_end(side) ? (along_v(side) ? shape_.p : shape_.q) : 0;
  std::vector<dvec4> line;
  for (int k = 0; k <= degree; ++k) line.push_back(along_v(side) ? at(fixed, k) : at(k, fixed));
  enum class Way { grow, concave, fall };
  Way last = Way::grow;
  const auto ways_are_in_order = [&](const auto& self, std::vector<dvec4> net, int halvings) {
    HeightGrowth growth(view, tilt);
    for (const dvec4& p : net) growth.include(p);
    bool grows = true;
    bool falls = true;
    bool concave = degree > 1;
    for (std::size_t k = 1; k < net.size(); ++k) {
      grows = grows && growth.along(net[k] - net[k - 1]);
      falls = falls && growth.along(net[k - 1] - net[k]);
      concave = concave && (k < 2 || growth.along(2.0 * net[k - 1] - net[k - 2] - net[k]));
    }
    if (grows && last == Way::grow) return true;
    if (falls || (concave && last != Way::fall)) {
      last = falls ? Way::fall : Way::concave;
      return true;
    }
    if (halvings == 0 || grows || concave) return false;
    std::vector<dvec4> lower = net;
    halve_u({degree, 0}, net.data(), lower.data());
    return self(self, std::move(lower), halvings - 1) && self(self, std::move(net), halvings - 1);
  };
  return ways_are_in_order(ways_are_in_order, std::move(line), side_halvings);
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
