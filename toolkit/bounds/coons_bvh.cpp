#include "taut/bounds/coons_bvh.h"

#include <cmath>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Depth at which a node becomes a leaf whatever its distance from its Coons patch: 4^8 nodes a
/// patch are the most that a hierarchy may hold; the bounds below stay valid, only less tight.
constexpr int max_explicit_level = 8;

HomogeneousBound operator+(const HomogeneousBound& a, const HomogeneousBound& b) {
  return {a.space + b.space, a.weight + b.weight};
}

HomogeneousBound operator*(double s, const HomogeneousBound& a) {
  return {s * a.space, s * a.weight};
}

HomogeneousBound larger(const HomogeneousBound& a, const HomogeneousBound& b) {
  return {std::max(a.space, b.space), std::max(a.weight, b.weight)};
}

/// Euclidean distance that a homogeneous error makes (see the class comment).
double euclidean_bound(const HomogeneousBound& error, double radius, double min_weight) {
  return (error.space + radius * error.weight) / min_weight;
}

/// The net moved so that `center` becomes the origin.
BezierPatch centered(const BezierPatch& patch, const dvec3& center) {
  BezierPatch result = patch;
  for (dvec4& p : result.points) p -= dvec4(p.w * center, 0.0);
  return result;
}

}  // namespace

/// Subdivides the net from the root down, depth first; the corners of a split node's children are
/// its own and five new ones.
class CoonsBvh::Builder {
 public:
  Builder(CoonsBvh& bvh, double coons_tolerance) : bvh_(bvh), tolerance_(coons_tolerance) {}

  void build(const BezierPatch& patch) {
    bvh_.nodes_.resize(1);
    const int p = patch.degree_u;
    const int q = patch.degree_v;
    Node& root = bvh_.nodes_[0];
    root.corner[0] = add_corner(patch.at(0, 0));
    root.corner[1] = add_corner(patch.at(0, q));
    root.corner[2] = add_corner(patch.at(p, 0));
    root.corner[3] = add_corner(patch.at(p, q));
    fill(0, patch, {});
  }

 private:
  std::int32_t add_corner(const dvec4& p) {
    bvh_.corners_.push_back(euclidean(p));
    return static_cast<std::int32_t>(bvh_.corners_.size()) - 1;
  }

  void fill(std::int32_t index, const BezierPatch& patch, const CoonsCell& cell) {
    dvec3 center(0.0);
    for (const std::int32_t c : node(index).corner) center += 0.25 * corner(c);
    const BezierPatch net = centered(patch, center);
    double radius = 0;
    double min_weight = net.points.front().w;
    for (const dvec4& p : net.points) {
      radius = std::max(radius, glm::length(euclidean(p)));
      min_weight = std::min(min_weight, p.w);
    }
    const auto border_bound = [&](Side a, Side b) {
      return 0.125 * larger(second_derivative_bound(border(net, a)),
                            second_derivative_bound(border(net, b)));
    };
    const HomogeneousBound border_u = border_bound(Side::v0, Side::v1);
    const HomogeneousBound border_v = border_bound(Side::u0, Side::u1);
    const HomogeneousBound inner_u = 0.125 * second_derivative_bound(net, Direction::u);
    const HomogeneousBound inner_v = 0.125 * second_derivative_bound(net, Direction::v);
    const auto distance = [&](const HomogeneousBound& error) {
      return euclidean_bound(error, radius, min_weight);
    };
    // S - B = (I - P1) S + P1 (I - P2) S: one direction inside, the other on the borders only.
    node(index).deviation =
        std::min(distance(inner_u + border_v), distance(border_u + inner_v)) + bvh_.rounding_;

    const HomogeneousBound coons = (1.0 / 64) * mixed_derivative_bound(net);
    const bool close = distance(coons) <= tolerance_ && coons.weight <= 0.5 * min_weight;
    if (close || cell.level >= max_explicit_level) {
      // The Coons patch itself may leave the net's ball by its distance from the surface; where its
      // weight may vanish, nothing below the leaf is bounded.
      const double weight = min_weight - coons.weight;
      const double reach = weight > 0 ? radius + euclidean_bound(coons, radius, weight)
                                      : std::numeric_limits<double>::infinity();
      make_leaf(index, patch, cell, border_u, border_v, coons, min_weight, reach);
    } else {
      split(index, patch, cell);
    }
  }

  void make_leaf(std::int32_t index, const BezierPatch& patch, const CoonsCell& cell,
                 const HomogeneousBound& border_u, const HomogeneousBound& border_v,
                 const HomogeneousBound& coons, double min_weight, double radius) {
    node(index).first_child = -1 - bvh_.leaf_count();
    bvh_.leaves_.push_back({cell.level, cell.i, cell.j,
                            static_cast<std::int32_t>(bvh_.borders_.size()), border_u, border_v,
                            coons, min_weight, radius});
    for (const Side side : {Side::v0, Side::v1, Side::u0, Side::u1}) {
      const BezierCurve curve = border(patch, side);
      bvh_.borders_.insert(bvh_.borders_.end(), curve.points.begin(), curve.points.end());
    }
  }

  void split(std::int32_t index, const BezierPatch& patch, const CoonsCell& cell) {
    const auto first = static_cast<std::int32_t>(bvh_.nodes_.size());
    bvh_.nodes_.resize(bvh_.nodes_.size() + 4);
    node(index).first_child = first;
    const Interval half[2] = {{0, 0.5}, {0.5, 1}};
    BezierPatch quarter[2][2];
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) quarter[a][b] = restricted(patch, half[a], half[b]);
    }
    const int p = patch.degree_u;
    const int q = patch.degree_v;
    const std::int32_t* own = node(index).corner;
    const std::int32_t grid[3][3] = {
        {own[0], add_corner(quarter[0][0].at(0, q)), own[1]},
        {add_corner(quarter[0][0].at(p, 0)), add_corner(quarter[0][0].at(p, q)),
         add_corner(quarter[0][1].at(p, q))},
        {own[2], add_corner(quarter[1][0].at(p, q)), own[3]}};
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) {
        const std::int32_t child = first + 2 * a + b;
        const std::int32_t corners[4] = {grid[a][b], grid[a][b + 1], grid[a + 1][b],
                                         grid[a + 1][b + 1]};
        std::copy(corners, corners + 4, node(child).corner);
        fill(child, quarter[a][b],
             {child, cell.level + 1, 2 * cell.i + std::uint32_t(a), 2 * cell.j + std::uint32_t(b)});
      }
    }
  }

  Node& node(std::int32_t i) { return bvh_.nodes_[static_cast<std::size_t>(i)]; }
  const dvec3& corner(std::int32_t i) { return bvh_.corners_[static_cast<std::size_t>(i)]; }

  CoonsBvh& bvh_;
  double tolerance_;
};

CoonsBvh::CoonsBvh(const BezierPatch& patch, double coons_tolerance)
    : degree_u_(patch.degree_u), degree_v_(patch.degree_v) {
  double size = 0;
  for (const dvec4& p : patch.points) size = std::max(size, glm::length(euclidean(p)));
  // Subdivided points are convex combinations, rounded twice a step: at most degree steps a level
  // and direction; the evaluation of a Coons point adds fewer than 32 roundings more.
  rounding_ = (32 + 2 * max_explicit_level * (degree_u_ + degree_v_)) * 2 * rounding_unit * size;
  Builder(*this, coons_tolerance).build(patch);
}

std::array<CoonsCell, 4> CoonsBvh::children(const CoonsCell& cell) const {
  const Node& node = nodes_[static_cast<std::size_t>(cell.node)];
  std::array<CoonsCell, 4> result;
  for (std::uint32_t k = 0; k < 4; ++k) {
    result[k] = {node.first_child < 0 ? cell.node : node.first_child + std::int32_t(k),
                 cell.level + 1, 2 * cell.i + k / 2, 2 * cell.j + k % 2};
  }
  return result;
}

std::array<dvec3, 4> CoonsBvh::corners(const CoonsCell& cell) const {
  const Node& node = nodes_[static_cast<std::size_t>(cell.node)];
  std::array<dvec3, 4> result;
  if (node.first_child < 0) {
    const Leaf& leaf = leaves_[static_cast<std::size_t>(-1 - node.first_child)];
    const int below = cell.level - leaf.level;
    if (below > 0) {
      const double size = std::ldexp(1.0, -below);
      const double u = (cell.i - std::ldexp(double(leaf.i), below)) * size;
      const double v = (cell.j - std::ldexp(double(leaf.j), below)) * size;
      for (int k = 0; k < 4; ++k) {
        result[std::size_t(k)] = coons_point(leaf, k < 2 ? u : u + size, k % 2 ? v + size : v);
      }
      return result;
    }
  }
  for (std::size_t k = 0; k < 4; ++k) {
    result[k] = corners_[static_cast<std::size_t>(node.corner[k])];
  }
  return result;
}

double CoonsBvh::deviation(const CoonsCell& cell) const {
  const Node& node = nodes_[static_cast<std::size_t>(cell.node)];
  if (node.first_child >= 0) return node.deviation;
  const Leaf& leaf = leaves_[static_cast<std::size_t>(-1 - node.first_child)];
  const int below = cell.level - leaf.level;
  if (below == 0) return node.deviation;
  const double quarter = std::ldexp(1.0, -2 * below);
  return euclidean_bound(quarter * (leaf.along_u + leaf.along_v) + leaf.coons, leaf.radius,
                         leaf.min_weight) +
         rounding_;
}

double CoonsBvh::coons_distance(const CoonsCell& cell) const {
  const Node& node = nodes_[static_cast<std::size_t>(cell.node)];
  if (node.first_child >= 0) return 0;
  const Leaf& leaf = leaves_[static_cast<std::size_t>(-1 - node.first_child)];
  return euclidean_bound(leaf.coons, leaf.radius, leaf.min_weight) + rounding_;
}

std::size_t CoonsBvh::memory() const {
  return sizeof(*this) + nodes_.size() * sizeof(Node) + leaves_.size() * sizeof(Leaf) +
         corners_.size() * sizeof(dvec3) + borders_.size() * sizeof(dvec4);
}

dvec3 CoonsBvh::coons_point(const Leaf& leaf, double u, double v) const {
  const dvec4* v0 = &borders_[static_cast<std::size_t>(leaf.first_point)];
  const dvec4* v1 = v0 + degree_u_ + 1;
  const dvec4* u0 = v1 + degree_u_ + 1;
  const dvec4* u1 = u0 + degree_v_ + 1;
  const auto bernstein_sum = [](const dvec4* points, int degree, double t) {
    // Horner's scheme for Bernstein sums.
    dvec4 sum = points[0];
    double power = 1;
    double binomial = 1;
    for (int i = 1; i <= degree; ++i) {
      power *= t;
      binomial *= double(degree - i + 1) / i;
      sum = sum * (1 - t) + (binomial * power) * points[i];
    }
    return sum;
  };
  const dvec4 along_u =
      (1 - v) * bernstein_sum(v0, degree_u_, u) + v * bernstein_sum(v1, degree_u_, u);
  const dvec4 along_v =
      (1 - u) * bernstein_sum(u0, degree_v_, v) + u * bernstein_sum(u1, degree_v_, v);
  const dvec4 bilinear =
      (1 - u) * ((1 - v) * v0[0] + v * v1[0]) + u * ((1 - v) * v0[degree_u_] + v * v1[degree_u_]);
  return euclidean(along_u + along_v - bilinear);
}

}  // namespace taut
