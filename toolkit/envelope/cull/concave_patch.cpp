#include "taut/envelope/cull/concave_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "taut/bounds/vector_net.h"

namespace taut {
namespace {

/// Determinant of the second fundamental form, as a share of what the second derivatives' lengths
/// allow, that is negligible.
constexpr double negligible = 1e-9;
/// Halvings of a rectangle by which it is tried to show that it is curved one way.
constexpr int proof_depth = 6;

BezierPatch bezier_of(const SceneElement& element) {
  BezierPatch patch{element.shape.p, element.shape.q, {}};
  const SceneNet& net = element.net;
  patch.points.reserve(net.x.size());
  for (std::size_t k = 0; k < net.x.size(); ++k) {
    patch.points.emplace_back(net.x[k], net.y[k], net.z[k], net.w[k]);
  }
  return patch;
}

std::array<bool, 4> poles(const Patch& patch) {
  std::array<bool, 4> result{};
  for (const Side side : all_sides) {
    const Border& border = patch.borders[std::size_t(side)];
    result[std::size_t(side)] = border.kind == BorderKind::collapsed && border.vertex < 0;
  }
  return result;
}

bool within_right_angle(const NormalPyramid& pyramid, double sign, const dvec3& m) {
  return std::all_of(pyramid.corners.begin(), pyramid.corners.end(),
                     [&](const dvec3& n) { return sign * glm::dot(n, m) > 0; });
}

bool are_disjoint(const Interval& a, const Interval& b) {
  return a.upper <= b.lower || b.upper <= a.lower;
}

}  // namespace

bool ParameterRectangle::overlaps(const ParameterRectangle& other) const {
  return !are_disjoint(u, other.u) && !are_disjoint(v, other.v);
}

bool ParameterRectangle::contains(const ParameterRectangle& other) const {
  return u.lower <= other.u.lower && other.u.upper <= u.upper && v.lower <= other.v.lower &&
         other.v.upper <= v.upper;
}

ConcavePatch::ConcavePatch(const SceneElement& element, const Patch& patch)
    : bezier_(bezier_of(element)),
      stand_in_(patch.stand_in),
      poles_(poles(patch)),
      curvature_(bezier_, poles_),
      nodes_(1) {
  nodes_.front().nets = std::make_unique<CurvatureNets>(curvature_);
}

int ConcavePatch::child(int node, int k) {
  if (nodes_[std::size_t(node)].first_child < 0) halve(node);
  return nodes_[std::size_t(node)].first_child + k;
}

/// Direction of the longest row of control points: of their legs, for a row's ends may coincide.
Direction ConcavePatch::longer_side(int node) {
  const std::vector<dvec3>& net = points(node);
  const int p = bezier_.degree_u;
  const int q = bezier_.degree_v;
  const auto leg = [&](int i, int j, int k, int l) {
    return glm::distance(net[bezier_.index(i, j)], net[bezier_.index(k, l)]);
  };
  double longest_u = 0;
  double longest_v = 0;
  for (int j = 0; j <= q; ++j) {
    double length = 0;
    for (int i = 0; i < p; ++i) length += leg(i, j, i + 1, j);
    longest_u = std::max(longest_u, length);
  }
  for (int i = 0; i <= p; ++i) {
    double length = 0;
    for (int j = 0; j < q; ++j) length += leg(i, j, i, j + 1);
    longest_v = std::max(longest_v, length);
  }
  return longest_u >= longest_v ? Direction::u : Direction::v;
}

void ConcavePatch::halve(int node) {
  const Direction direction = longer_side(node);
  Node lower;
  lower.cell = cell(node);
  lower.level = level(node) + 1;
  lower.parent = node;
  Node upper;
  upper.cell = lower.cell;
  upper.level = lower.level;
  upper.parent = node;
  if (direction == Direction::u) {
    lower.cell.u.upper = upper.cell.u.lower = cell(node).u.at(0.5);
  } else {
    lower.cell.v.upper = upper.cell.v.lower = cell(node).v.at(0.5);
  }
  look(node);
  if (at(node).sign == 0) {
    std::array<CurvatureNets, 2> nets = at(node).nets->halves(direction);
    at(node).nets.reset();
    lower.nets = std::make_unique<CurvatureNets>(std::move(nets[0]));
    upper.nets = std::make_unique<CurvatureNets>(std::move(nets[1]));
  }
  at(node).first_child = int(nodes_.size());
  nodes_.push_back(std::move(lower));
  nodes_.push_back(std::move(upper));
}

const std::vector<dvec3>& ConcavePatch::points(int node) {
  std::vector<dvec3>& result = nodes_[std::size_t(node)].points;
  if (!result.empty()) return result;
  std::vector<dvec4> net = bezier_.points;
  if (node > 0) restrict_net(shape(), net.data(), cell(node).u, cell(node).v);
  result.reserve(net.size());
  for (const dvec4& p : net) result.push_back(euclidean(p));
  return result;
}

bool ConcavePatch::is_concave(int node, const dvec3& m) {
  if (stand_in_) {
    std::optional<NormalPyramid>& pyramid = at(node).pyramid;
    if (!pyramid) pyramid = curvature_.normals(cell(node).u, cell(node).v);
    if (!pyramid) return false;
    const double sign = glm::dot(pyramid->axis, m) > 0 ? 1 : -1;
    return within_right_angle(*pyramid, sign, m);
  }
  return sign(node, proof_depth) != 0 && faces(node, m);
}

/// The sign of the normals for which the rectangle is concave, as its own nets or those of smaller
/// ones show, so many halvings below; 0 if they do not.
double ConcavePatch::sign(int node, int depth) {
  look(node);
  if (at(node).sign != 0 || depth <= at(node).depth) return at(node).sign;
  at(node).depth = depth;
  if (!(curvature(cell(node).middle()) > 0)) return 0;
  const double lower = sign(child(node, 0), depth - 1);
  if (lower != 0 && sign(child(node, 1), depth - 1) == lower) at(node).sign = lower;
  return at(node).sign;
}

/// Of a node of known sign: all its normals, with that sign, are within a right angle of m.
bool ConcavePatch::faces(int node, const dvec3& m) {
  const int parent = at(node).parent;
  if (parent >= 0 && at(parent).sign != 0 && faces(parent, m)) return true;
  std::optional<NormalPyramid>& pyramid = at(node).pyramid;
  if (!pyramid) pyramid = curvature_.normals(cell(node).u, cell(node).v);
  return pyramid && within_right_angle(*pyramid, at(node).sign, m);
}

double ConcavePatch::curvature(const dvec2& p) const {
  if (stand_in_) return std::numeric_limits<double>::infinity();
  for (const Side side : all_sides) {
    const double t = along_v(side) ? p.x : p.y;
    if (poles_[std::size_t(side)] && t == (at_upper_end(side) ? 1 : 0)) {
      return std::numeric_limits<double>::infinity();
    }
  }
  const PatchJet2 jet = jet2(bezier_, p.x, p.y);
  const dvec3 n = glm::cross(jet.Su, jet.Sv);
  const double size = glm::dot(n, n);
  const double uv = glm::dot(jet.Suv, n);
  const double determinant = glm::dot(jet.Suu, n) * glm::dot(jet.Svv, n) - uv * uv;
  const double most = size * glm::length(jet.Suu) * glm::length(jet.Svv);
  return std::abs(determinant) <= negligible * most ? 0 : determinant / (size * size);
}

void ConcavePatch::look(int index) {
  Node& node = at(index);
  if (node.known) return;
  node.known = true;
  if (node.parent >= 0) {
    look(node.parent);
    node.sign = at(node.parent).sign;
    if (node.sign != 0) return;
  }
  node.sign = -node.nets->definite_sign();
  if (node.sign == 0) return;
  node.pyramid = node.nets->normals();
  node.nets.reset();
}

}  // namespace taut
