#include "taut/hull/decide/curved_regions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "taut/core/geometry.h"

namespace taut {
namespace {

/// Halvings after which a rectangle's curvature is left open.
constexpr int curvature_level_limit = 13;

/// What rounding may do to angles.
constexpr double angle_slack = 1e-14;

bool overlap(const Interval& a, const Interval& b) {
  return a.lower < b.upper && b.lower < a.upper;
}

bool contains(const Interval& a, const Interval& b) {
  return a.lower <= b.lower && b.upper <= a.upper;
}

double width(const Interval& t) { return t.upper - t.lower; }

}  // namespace

CurvedRegions::CurvedRegions(const MapPieces& pieces)
    : pieces_(pieces), trees_(pieces.elements().size()) {}

CurvedRegions::Tree& CurvedRegions::tree(int element) {
  Tree& tree = trees_[std::size_t(element)];
  if (!tree.empty()) return tree;
  Node root;
  root.nets = nets_of(element);
  tree.push_back(std::move(root));
  return tree;
}

std::unique_ptr<CurvatureNets> CurvedRegions::nets_of(int element) const {
  const MapElement& e = pieces_.element(element);
  const StoredNet& net = e.root->exact;
  BezierPatch bezier{net.shape.p, net.shape.q, {}};
  const dvec4* p = net.points;
  bezier.points.assign(p, p + net.shape.size());
  std::array<bool, 4> poles;
  for (const Side side : all_sides) poles[std::size_t(side)] = pieces_.is_pole(e, side);
  return std::make_unique<CurvatureNets>(bezier, poles);
}

/// Nets are large: where they are not expected to be asked for again there are none.
const CurvatureNets& CurvedRegions::nets(int element, Node& node) const {
  if (node.nets == nullptr) node.nets = nets_again(element, node);
  return *node.nets;
}

const CurvatureNets::NormalBounds& CurvedRegions::normals(int element, Node& node) const {
  if (!node.normals) node.normals = nets(element, node).normal_bounds();
  return *node.normals;
}

/// Of the curvatures all over the rectangle; 0 if there is none.
int CurvedRegions::sign(int element, Node& node) const {
  if (!node.sign) {
    node.sign = nets(element, node).definite_sign();
    if (*node.sign != 0) node.nets.reset();
  }
  return *node.sign;
}

/// A bound of the curvatures towards the normals, times the sign. The forms are the second
/// derivatives of the heights along N, where that is normal to the surface, times its length:
/// curvatures are these over the squares of lengths on the surface.
double CurvedRegions::hollow(int element, Node& node, int towards) const {
  if (const int own = sign(element, node); own != 0) return own == towards ? 0 : infinity;
  std::optional<double>& bound = node.hollow[towards > 0 ? 1 : 0];
  if (!bound) {
    const double stretch = least_stretch(element, node.u, node.v);
    const double least = normals(element, node).least;
    bound = least > 0 && stretch > 0
                ? nets(element, node).shortfall_bound(towards) / (least * stretch * stretch)
                : infinity;
    // Few of these are asked for again.
    if (node.level == curvature_level_limit) node.nets.reset();
  }
  return *bound;
}

bool CurvedRegions::has_pole(int element) const {
  const auto& collapsed = pieces_.element(element).collapsed;
  return std::count(collapsed.begin(), collapsed.end(), true) > 0;
}

/// The least length on the surface of a step of length one in the parameters: that of the means of
/// the differences of control points, less what these differ from them.
double CurvedRegions::least_stretch(int element, const Interval& u, const Interval& v) const {
  const NetShape shape = pieces_.element(element).root->exact.shape;
  std::vector<dvec4> net;
  pieces_.restricted(element, u, v, net);
  const int row = shape.q + 1;
  std::vector<dvec3> along_u, along_v;
  for (int i = 0; i <= shape.p; ++i) {
    for (int j = 0; j <= shape.q; ++j) {
      const dvec4* p = net.data() + i * row + j;
      if (i < shape.p) along_u.push_back(shape.p / width(u) * (euclidean(p[row]) - euclidean(*p)));
      if (j < shape.q) along_v.push_back(shape.q / width(v) * (euclidean(p[1]) - euclidean(*p)));
    }
  }
  const auto mean = [](const std::vector<dvec3>& all) {
    dvec3 sum(0.0);
    for (const dvec3& x : all) sum += x;
    return sum / double(all.size());
  };
  const auto off = [](const std::vector<dvec3>& all, const dvec3& from) {
    double farthest = 0;
    for (const dvec3& x : all) farthest = std::max(farthest, glm::distance(x, from));
    return farthest;
  };
  const dvec3 a = mean(along_u);
  const dvec3 b = mean(along_v);
  const double e = glm::dot(a, a);
  const double g = glm::dot(b, b);
  const double least = 0.5 * (e + g) - std::hypot(0.5 * (e - g), glm::dot(a, b));
  return least > 0 ? std::sqrt(least) - std::hypot(off(along_u, a), off(along_v, b)) : 0;
}

Direction CurvedRegions::direction_of_halves(const Interval& u, const Interval& v) {
  return width(u) >= width(v) ? Direction::u : Direction::v;
}

/// The nets of a node, as they were.
std::unique_ptr<CurvatureNets> CurvedRegions::nets_again(int element, const Node& node) const {
  std::unique_ptr<CurvatureNets> nets = nets_of(element);
  Interval u{0, 1};
  Interval v{0, 1};
  for (int level = 0; level < node.level; ++level) {
    const Direction direction = direction_of_halves(u, v);
    Interval& range = direction == Direction::u ? u : v;
    const double middle = range.at(0.5);
    const bool upper = (direction == Direction::u ? node.u : node.v).lower >= middle;
    (upper ? range.lower : range.upper) = middle;
    nets = std::make_unique<CurvatureNets>(nets->halves(direction)[upper ? 1 : 0]);
  }
  return nets;
}

/// False at the limit of levels.
bool CurvedRegions::split(int element, int index) {
  Tree& tree = this->tree(element);
  Node& node = tree[std::size_t(index)];
  if (node.first_half >= 0) return true;
  if (node.level == curvature_level_limit) return false;
  const Direction direction = direction_of_halves(node.u, node.v);
  const bool of_u = direction == Direction::u;
  const auto halves = nets(element, node).halves(direction);
  node.nets.reset();
  const int first = int(tree.size());
  node.first_half = first;
  const Interval u = node.u;
  const Interval v = node.v;
  const int level = node.level + 1;
  for (std::size_t k : {0u, 1u}) {
    Node half;
    half.u = u;
    half.v = v;
    half.level = level;
    half.nets = std::make_unique<CurvatureNets>(halves[k]);
    Interval& range = of_u ? half.u : half.v;
    const double middle = 0.5 * (range.lower + range.upper);
    (k == 0 ? range.upper : range.lower) = middle;
    tree.push_back(std::move(half));
  }
  return true;
}

/// Halves are not curved otherwise either, if the rectangle is all there is of the node.
bool CurvedRegions::is_small_part(const Node& node, const Interval& u, const Interval& v) {
  return contains(u, node.u) && contains(v, node.v) && width(u) > 4 * width(node.u) &&
         width(v) > 4 * width(node.v);
}

CurvedRegions::Cone CurvedRegions::cone_of(const std::array<dvec3, 4>& directions) {
  Cone cone{unit(unit(directions[0]) + unit(directions[3])), 0};
  for (const dvec3& d : directions) {
    cone.angle = std::max(cone.angle, angle_between(d, cone.axis));
  }
  return cone;
}

/// No normal over the node is one of the directions, or opposite to one.
bool CurvedRegions::is_apart(int element, Node& node, const Cone& directions) const {
  const CurvatureNets::NormalBounds& bounds = normals(element, node);
  if (!(bounds.least > 0)) return false;
  const double off = angle_between(bounds.axis, aligned(directions.axis, bounds.axis));
  return off > bounds.angle + directions.angle + angle_slack;
}

/// Of the part of the rectangle in the node; its sign is to be this one, or is told if there is
/// none yet.
bool CurvedRegions::are_definite(int element, int index, const Interval& u, const Interval& v,
                                 const Cone& directions, int& of_all) {
  Tree& tree = this->tree(element);
  Node& node = tree[std::size_t(index)];
  if (is_apart(element, node, directions)) return true;
  if (const int own = sign(element, node); own != 0) {
    if (of_all == 0) of_all = own;
    return own == of_all;
  }
  if (is_small_part(node, u, v) || !split(element, index)) return false;
  const int first = tree[std::size_t(index)].first_half;
  for (const int half : {first, first + 1}) {
    if (!overlap(tree[std::size_t(half)].u, u) || !overlap(tree[std::size_t(half)].v, v)) continue;
    if (!are_definite(element, half, u, v, directions, of_all)) return false;
  }
  return true;
}

bool CurvedRegions::is_nearly_concave(int element, int index, const Interval& u, const Interval& v,
                                      const Cone& directions, double most) {
  Tree& tree = this->tree(element);
  {
    Node& node = tree[std::size_t(index)];
    if (is_apart(element, node, directions)) return true;
    const dvec3& axis = node.normals->axis;
    const bool along = glm::dot(axis, directions.axis) > 0;
    // All normals over the node lead to one side of the planes across the directions.
    const double off = angle_between(axis, aligned(directions.axis, axis));
    const bool one_side =
        off + node.normals->angle + directions.angle + angle_slack < 0.5 * std::numbers::pi;
    if (one_side && hollow(element, node, along ? -1 : 1) <= most) return true;
    if (is_small_part(node, u, v)) return false;
    // What is curved the other way is so in its halves.
    if (one_side && sign(element, node) == (along ? 1 : -1)) return false;
  }
  if (!split(element, index)) return false;
  const int first = tree[std::size_t(index)].first_half;
  for (const int half : {first, first + 1}) {
    const Node& node = tree[std::size_t(half)];
    if (!overlap(node.u, u) || !overlap(node.v, v)) continue;
    if (!is_nearly_concave(element, half, u, v, directions, most)) return false;
  }
  return true;
}

bool CurvedRegions::are_nearly_concave(int element, const Interval& u, const Interval& v,
                                       const Cone& directions, double most) {
  if (pieces_.element(element).rational || has_pole(element)) return false;
  if (pieces_.geometry().patch(pieces_.element(element).contact).stand_in) return false;
  return is_nearly_concave(element, 0, u, v, directions, most);
}

bool CurvedRegions::are_definite(int element, const Interval& u, const Interval& v,
                                 const Cone& directions) {
  if (pieces_.geometry().patch(pieces_.element(element).contact).stand_in) return false;
  int sign = 0;
  return are_definite(element, 0, u, v, directions, sign);
}

}  // namespace taut
