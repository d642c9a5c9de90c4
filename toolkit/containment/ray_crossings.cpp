#include "taut/containment/ray_crossings.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/vector_net.h"
#include "taut/core/predicates.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Halvings after which a cell that may hold a crossing is a doubt: it is smaller than rounding.
constexpr int depth_limit = 80;

/// Newton's method on a cell with one crossing ends within this share of the cell.
constexpr int crossing_newton_limit = 30;
constexpr double crossing_newton_end = 1e-14;

/// A crossing is inside of its cell if it is farther from the sides than this share of the patch.
constexpr double least_inset = 1e-12;

/// Rounding of a share of the ray.
constexpr double share_rounding = 1e-12;

struct Range {
  double lower, upper;
};

Range range(const double* b, int size) {
  const auto [least, most] = std::minmax_element(b, b + size);
  return {*least, *most};
}

/// Coefficients' ranges of the derivatives by u and v, over the unit square.
std::array<Range, 2> slopes(NetShape shape, const double* b) {
  const int row = shape.q + 1;
  Range u{INFINITY, -INFINITY};
  Range v{INFINITY, -INFINITY};
  const auto take = [](Range& r, double x) {
    r.lower = std::min(r.lower, x);
    r.upper = std::max(r.upper, x);
  };
  for (int i = 0; i <= shape.p; ++i) {
    for (int j = 0; j <= shape.q; ++j) {
      if (i < shape.p) take(u, shape.p * (b[(i + 1) * row + j] - b[i * row + j]));
      if (j < shape.q) take(v, shape.q * (b[i * row + j + 1] - b[i * row + j]));
    }
  }
  return {u, v};
}

/// Whether the segment may come nearer to the box than the margin.
bool may_meet(const dvec3& center, const dvec3& half, const dvec3& x, const dvec3& end,
              double margin) {
  double from = 0;
  double to = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = half[axis] + margin;
    const double d = end[axis] - x[axis];
    const double offset = center[axis] - x[axis];
    if (d == 0) {
      if (std::abs(offset) > reach) return false;
      continue;
    }
    const double a = (offset - reach) / d;
    const double b = (offset + reach) / d;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to + share_rounding;
}

/// Calls visit with the items of all boxes that the segment may meet, until it returns false;
/// whether it never did.
template <class Visit>
bool visit_boxes(const BoxTree& tree, const dvec3& x, const dvec3& end, double margin,
                 Visit visit) {
  if (tree.nodes.empty()) return true;
  std::vector<int> open = {0};
  while (!open.empty()) {
    const BoxTree::Node& node = tree.nodes[std::size_t(open.back())];
    open.pop_back();
    if (!may_meet(node.center, node.half, x, end, margin)) continue;
    if (node.count == 0) {
      open.insert(open.end(), {node.first, node.first + 1});
      continue;
    }
    for (int k = node.first; k < node.first + node.count; ++k) {
      const auto i = std::size_t(k);
      const dvec3 center(tree.center[0][i], tree.center[1][i], tree.center[2][i]);
      const dvec3 half(tree.half[0][i], tree.half[1][i], tree.half[2][i]);
      if (may_meet(center, half, x, end, margin) && !visit(std::size_t(tree.items[i]))) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

RayCrossings::Answer RayCrossings::look(const PlacedPatch& patch, const Cell& cell) {
  const NetShape shape{patch.bezier.degree_u, patch.bezier.degree_v};
  const int size = shape.size();
  const double* d1 = nets_.data() + cell.slot;
  const double* d2 = d1 + size;
  const double* ahead = d2 + size;
  double heaviest = 0;
  for (const dvec4& p : patch.bezier.points) heaviest = std::max(heaviest, p.w);
  const double reach = 2 + glm::length(x_);
  const double halving = reach * halving_rounding(patch.bezier, cell.size_u, cell.size_v);
  const double slack = (surface_.rounding + halving + surface_.crack) * heaviest;
  for (const double* d : {d1, d2}) {
    const Range r = range(d, size);
    if (r.lower > slack || r.upper < -slack) return Answer::none;
  }
  if (range(ahead, size).upper < -slack) return Answer::none;
  if (cell.depth >= depth_limit) return Answer::doubt;

  // The derivatives, over the cell's own square, preconditioned by their middles.
  const auto s1 = slopes(shape, d1);
  const auto s2 = slopes(shape, d2);
  const auto middle = [](const Range& r) { return 0.5 * (r.lower + r.upper); };
  const auto half = [](const Range& r) { return 0.5 * (r.upper - r.lower); };
  const double a = middle(s1[0]), b = middle(s1[1]), c = middle(s2[0]), d = middle(s2[1]);
  const double det = a * d - b * c;
  if (det == 0) return Answer::split;
  // |A^-1| times the half-widths, by rows: below one, the map is one to one on the cell.
  const double row1 =
      (std::abs(d) * (half(s1[0]) + half(s1[1])) + std::abs(b) * (half(s2[0]) + half(s2[1]))) /
      std::abs(det);
  const double row2 =
      (std::abs(c) * (half(s1[0]) + half(s1[1])) + std::abs(a) * (half(s2[0]) + half(s2[1]))) /
      std::abs(det);
  if (!(std::max(row1, row2) < 0.5)) return Answer::split;

  const ScalarNet<-1, -1> net(shape);
  double u = 0.5;
  double v = 0.5;
  bool converged = false;
  for (int step = 0; step < crossing_newton_limit && !converged; ++step) {
    const NetJet j1 = net.jet(d1, u, v);
    const NetJet j2 = net.jet(d2, u, v);
    const double jdet = j1.gu * j2.gv - j1.gv * j2.gu;
    if (jdet == 0) return Answer::split;
    const double du = (j1.gv * j2.g - j2.gv * j1.g) / jdet;
    const double dv = (j2.gu * j1.g - j1.gu * j2.g) / jdet;
    u = std::clamp(u + du, -0.5, 1.5);
    v = std::clamp(v + dv, -0.5, 1.5);
    converged = std::abs(du) + std::abs(dv) < crossing_newton_end;
  }
  // The crossing is off by the rounding, and the crack, of the coordinates over the slope.
  const double norm = (std::abs(a) + std::abs(b) + std::abs(c) + std::abs(d)) / std::abs(det);
  const double inset = least_inset / std::min(cell.size_u, cell.size_v) + 4 * slack * norm;
  if (!converged || std::min({u, 1 - u, v, 1 - v}) < inset) return Answer::split;
  const double t = net.value(ahead, u, v);
  if (std::abs(t) <= 2 * slack) return Answer::doubt;
  return t > 0 ? Answer::one : Answer::none;
}

void RayCrossings::split(const PlacedPatch& patch, const Cell& cell) {
  const NetShape shape{patch.bezier.degree_u, patch.bezier.degree_v};
  const int size = shape.size();
  const std::size_t lower = nets_.size();
  nets_.resize(lower + 3 * std::size_t(size));
  const double* d1 = nets_.data() + cell.slot;
  const auto s1 = slopes(shape, d1);
  const auto s2 = slopes(shape, d1 + size);
  const auto most = [](const Range& a, const Range& b) {
    return std::max(std::abs(a.lower), std::abs(a.upper)) +
           std::max(std::abs(b.lower), std::abs(b.upper));
  };
  const bool along_u = most(s1[0], s2[0]) >= most(s1[1], s2[1]);
  for (int k = 0; k < 3; ++k) {
    double* b = nets_.data() + cell.slot + std::size_t(k * size);
    double* other = nets_.data() + lower + std::size_t(k * size);
    along_u ? halve_u(shape, b, other) : halve_v(shape, b, other);
  }
  Cell upper = cell;
  ++upper.depth;
  Cell other = upper;
  other.slot = lower;
  if (along_u) {
    upper.size_u = other.size_u = 0.5 * cell.size_u;
    upper.u += upper.size_u;
  } else {
    upper.size_v = other.size_v = 0.5 * cell.size_v;
    upper.v += upper.size_v;
  }
  stack_.push_back(other);
  stack_.push_back(upper);
}

bool RayCrossings::cross(const PlacedPatch& patch) {
  const std::size_t size = patch.bezier.points.size();
  nets_.resize(3 * size);
  for (std::size_t k = 0; k < size; ++k) {
    const dvec4& p = patch.bezier.points[k];
    const dvec3 from = dvec3(p) - p.w * x_;
    nets_[k] = glm::dot(from, across_[0]);
    nets_[size + k] = glm::dot(from, across_[1]);
    nets_[2 * size + k] = glm::dot(from, along_);
  }
  stack_ = {{0, 0, 1, 1, 0, 0}};
  while (!stack_.empty()) {
    const Cell cell = stack_.back();
    stack_.pop_back();
    switch (look(patch, cell)) {
      case Answer::none:
        break;
      case Answer::one:
        odd_[std::size_t(patch.body)] ^= 1;
        break;
      case Answer::doubt:
        return false;
      case Answer::split:
        split(patch, cell);
    }
  }
  return true;
}

bool RayCrossings::cross(const PlacedTriangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  const Sign from = orientation(a, b, c, x_);
  const Sign to = orientation(a, b, c, end_);
  const std::array<Sign, 3> about = {orientation(x_, end_, a, b), orientation(x_, end_, b, c),
                                     orientation(x_, end_, c, a)};
  const auto is = [](Sign sign) { return [sign](Sign s) { return s == sign; }; };
  const bool left = std::any_of(about.begin(), about.end(), is(Sign::positive));
  const bool right = std::any_of(about.begin(), about.end(), is(Sign::negative));
  if (left && right) return true;  // the line passes by
  if (from == to && from != Sign::zero) return true;
  const bool clear = std::none_of(about.begin(), about.end(), is(Sign::zero)) &&
                     from != Sign::zero && to != Sign::zero;
  if (!clear) return collinear(a, b, c);  // nothing crosses a triangle of no area
  odd_[std::size_t(triangle.body)] ^= 1;
  return true;
}

bool RayCrossings::count(const dvec3& x, const dvec3& direction, int body) {
  x_ = x;
  along_ = direction;
  end_ = x + 16.0 * direction;
  across_ = tangent_frame(direction);
  odd_.assign(std::size_t(surface_.bodies), 0);
  const double margin = surface_.rounding + surface_.crack;
  const auto cross_one = [&](const auto& piece) {
    return (body >= 0 && piece.body != body) || cross(piece);
  };
  const auto cross_patch = [&](std::size_t k) { return cross_one(surface_.patches[k]); };
  const auto cross_triangle = [&](std::size_t k) { return cross_one(surface_.triangles[k]); };
  return visit_boxes(surface_.patch_tree, x_, end_, margin, cross_patch) &&
         visit_boxes(surface_.triangle_tree, x_, end_, margin, cross_triangle);
}

}  // namespace taut
