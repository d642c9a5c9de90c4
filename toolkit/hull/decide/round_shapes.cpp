#include "taut/hull/decide/round_shapes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "taut/core/disjoint_sets.h"
#include "taut/surface/bezier.h"

namespace taut {
namespace {

/// Places in each parameter at which a shape is fitted to an element.
constexpr int fit_samples = 5;
/// Rays that are tried until one is well off the elements' corners.
constexpr int ray_limit = 16;

/// Points of an element, in order of the parameters.
std::vector<dvec3> samples(const MapPieces& pieces, int element) {
  const StoredNet& net = pieces.element(element).root->exact;
  const dvec4* p = net.points;
  BezierPatch patch{net.shape.p, net.shape.q, {p, p + net.shape.size()}};
  std::vector<dvec3> result;
  for (int i = 0; i < fit_samples; ++i) {
    for (int j = 0; j < (net.shape.q > 0 ? fit_samples : 1); ++j) {
      result.push_back(point(patch, i / double(fit_samples - 1), j / double(fit_samples - 1)));
    }
  }
  return result;
}

Eigen::Vector3d eigen(const dvec3& x) { return {x.x, x.y, x.z}; }
dvec3 vector(const Eigen::Vector3d& x) { return {x.x(), x.y(), x.z()}; }

/// The quadric about points with coordinates of size about one, as x' A x + b' x = 1 in the first
/// coordinates, as many as `dimension`; least squares.
struct Quadric {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

Quadric fitted(const std::vector<Eigen::Vector3d>& points, int dimension) {
  const int squares = dimension * (dimension + 1) / 2;
  Eigen::MatrixXd rows(Eigen::Index(points.size()), squares + dimension);
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    const Eigen::Vector3d& x = points[std::size_t(k)];
    int column = 0;
    for (int i = 0; i < dimension; ++i) {
      for (int j = i; j < dimension; ++j) rows(k, column++) = x[i] * x[j];
    }
    for (int i = 0; i < dimension; ++i) rows(k, column++) = x[i];
  }
  const Eigen::VectorXd found =
      rows.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(rows.rows()));
  Quadric quadric;
  int column = 0;
  for (int i = 0; i < dimension; ++i) {
    for (int j = i; j < dimension; ++j, ++column) {
      quadric.A(i, j) = quadric.A(j, i) = i == j ? found[column] : 0.5 * found[column];
    }
  }
  for (int i = 0; i < dimension; ++i) quadric.b[i] = found[column++];
  return quadric;
}

/// The ellipse or ellipsoid near points; none if another quadric is nearest.
std::optional<RoundShape> shape_near(const std::vector<dvec3>& points, SourceKind kind) {
  const int dimension = kind == SourceKind::face ? 3 : 2;
  dvec3 middle(0.0);
  for (const dvec3& x : points) middle += x;
  middle /= double(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double size = 0;
  for (const dvec3& x : points) {
    covariance += eigen(x - middle) * eigen(x - middle).transpose();
    size = std::max(size, glm::length(x - middle));
  }
  // The plane of an ellipse is spanned by the two directions of most extent.
  Eigen::Matrix3d frame =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().rowwise().reverse();
  std::vector<Eigen::Vector3d> scaled;
  scaled.reserve(points.size());
  for (const dvec3& x : points) scaled.push_back(frame.transpose() * eigen(x - middle) / size);
  const Quadric quadric = fitted(scaled, dimension);
  const Eigen::MatrixXd A = quadric.A.topLeftCorner(dimension, dimension);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  if (!(solver.eigenvalues()[0] > 0)) return std::nullopt;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  center.head(dimension) = -0.5 * A.ldlt().solve(quadric.b.head(dimension));
  const double level = 1 + center.dot(quadric.A * center);
  RoundShape shape;
  shape.kind = kind;
  shape.center = middle + size * vector(frame * center);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  axes.topLeftCorner(dimension, dimension) = solver.eigenvectors();
  axes = frame * axes;
  for (int k = 0; k < 3; ++k) {
    const dvec3 axis = unit(vector(axes.col(k)));
    const double radius = k < dimension ? size * std::sqrt(level / solver.eigenvalues()[k]) : 0;
    if (!std::isfinite(radius)) return std::nullopt;
    shape.axes[k] = axis;
    shape.radii[k] = radius;
    shape.root += radius * glm::outerProduct(axis, axis);
  }
  return shape;
}

const StoredNet& net_of(const MapPieces& pieces, int element) {
  return pieces.element(element).root->exact;
}

std::span<const dvec4> points_of(const MapPieces& pieces, int element) {
  const StoredNet& net = net_of(pieces, element);
  return {net.points, std::size_t(net.shape.size())};
}

/// How often rays from the centre meet the elements of a shape, of which each is drawn together to
/// the chord or the two triangles between its corners: on the way it meets the centre nowhere, as
/// its control points lie to one side of it.
class RayCount {
 public:
  RayCount(const MapPieces& pieces, const RoundShape& shape, double gap)
      : shape_(shape), margin_(gap / std::max(shape.least_radius(), gap)) {
    for (const int element : shape.elements) {
      std::vector<dvec4> points = shape.in_frame(points_of(pieces, element));
      add(net_of(pieces, element).shape, points);
    }
  }

  /// An odd number of times, for some ray that stays off the corners. False where an element lies
  /// on all sides of the centre.
  bool is_odd() const {
    for (int k = 0; k < ray_limit && is_apart_; ++k) {
      const double turn = k * std::numbers::phi * 2 * std::numbers::pi;
      const double z = shape_.is_flat() ? 0 : -1 + (2 * k + 1.0) / ray_limit;
      const double r = std::sqrt(1 - z * z);
      const std::optional<int> hits = hits_of({r * std::cos(turn), r * std::sin(turn), z});
      if (hits) return *hits % 2 == 1;
    }
    return false;
  }

 private:
  void add(NetShape net, std::vector<dvec4>& points) {
    if (shape_.is_flat()) {
      for (dvec4& y : points) y.z = 0;
    }
    dvec3 along(0.0);
    for (const dvec4& y : points) along += dvec3(y) / y.w;
    for (const dvec4& y : points) is_apart_ = is_apart_ && glm::dot(dvec3(y), along) > 0;
    const auto corner = [&](int i, int j) {
      return euclidean(points[std::size_t(i * (net.q + 1) + j)]);
    };
    const dvec3 a = corner(0, 0);
    const dvec3 b = corner(net.p, net.q);
    if (net.q == 0) {
      chords_.push_back({a, b, {0, 0, 1}});
      return;
    }
    chords_.push_back({a, corner(net.p, 0), b});
    chords_.push_back({a, corner(0, net.q), b});
  }

  /// None where the ray passes near a corner, or a side.
  std::optional<int> hits_of(const dvec3& ray) const {
    int hits = 0;
    for (const auto& [a, b, c] : chords_) {
      const auto volume = [](const dvec3& x, const dvec3& y, const dvec3& z) {
        return glm::dot(glm::cross(x, y), z);
      };
      // The ray's coordinates along the three, times their volume. Of a chord two count.
      std::array<double, 3> along = {volume(b, c, ray), volume(c, a, ray), volume(a, b, ray)};
      if (shape_.is_flat()) along[2] = along[0];
      const double sign = volume(a, b, c) < 0 ? -1 : 1;
      const auto [least, most] = std::minmax({sign * along[0], sign * along[1], sign * along[2]});
      if (least > margin_) {
        ++hits;
      } else if (!(least < -margin_)) {
        return std::nullopt;
      }
    }
    return hits;
  }

  const RoundShape& shape_;
  double margin_;
  std::vector<std::array<dvec3, 3>> chords_;
  bool is_apart_ = true;
};

/// Elements that go on into each other without a border, and each only there.
std::vector<std::vector<int>> closed_blocks(const MapPieces& pieces) {
  const ContactGeometry& geometry = pieces.geometry();
  const auto count = pieces.elements().size();
  DisjointSets sets(count);
  std::vector<bool> ends(count, false);
  const auto go_on = [&](int from, int to) {
    if (to < 0) ends[std::size_t(from)] = true;
    if (to >= 0) sets.unite(from, to);
  };
  for (int k = 0; k < int(count); ++k) {
    geometry.check_stop();
    const MapElement& element = pieces.element(k);
    const Contact& c = element.contact;
    for (const Side side : all_sides) {
      if (c.kind != SourceKind::face) break;
      if (!pieces.is_pole(element, side)) go_on(k, element.beyond[std::size_t(side)].element);
    }
    for (const std::size_t end : {0u, 1u}) {
      if (c.kind != SourceKind::edge) break;
      const int next = geometry.piece(c).end_neighbor[end];
      const int passed = element.next[end][0];
      go_on(k, next < 0 ? passed : pieces.find({c.instance, c.kind, next, 0, 0}));
    }
    if (c.kind == SourceKind::vertex) ends[std::size_t(k)] = true;
  }
  std::map<int, std::vector<int>> blocks;
  std::vector<bool> open(count, false);
  for (int k = 0; k < int(count); ++k) {
    if (ends[std::size_t(k)]) open[std::size_t(sets.find(k))] = true;
    blocks[sets.find(k)].push_back(k);
  }
  std::vector<std::vector<int>> result;
  for (auto& [first, block] : blocks) {
    if (!open[std::size_t(first)]) result.push_back(std::move(block));
  }
  return result;
}

}  // namespace

std::vector<RoundShape> round_shapes(const MapPieces& pieces, double distance) {
  std::vector<RoundShape> result;
  const Scene& scene = pieces.geometry().scene();
  const double rounding = pieces.geometry().rounding();
  // Elements that go on into each other miss each other by no more.
  double gap = rounding;
  for (const Part& part : scene.model().parts()) {
    gap = std::max(gap, rounding + scene.frame().length_to_frame(part.join_gap()));
  }
  for (std::vector<int>& block : closed_blocks(pieces)) {
    const SourceKind kind = pieces.element(block.front()).contact.kind;
    std::vector<dvec3> points;
    for (const int element : block) {
      pieces.geometry().check_stop();
      const std::vector<dvec3> own = samples(pieces, element);
      points.insert(points.end(), own.begin(), own.end());
    }
    std::optional<RoundShape> shape = shape_near(points, kind);
    if (!shape) continue;
    shape->elements = std::move(block);
    for (const int element : shape->elements) {
      pieces.geometry().check_stop();
      const RoundShape::Distances off =
          shape->distances(net_of(pieces, element).shape, points_of(pieces, element));
      shape->inside = std::max(shape->inside, off.inwards + rounding);
      shape->outside = std::max(shape->outside, off.outwards + rounding);
      if (!(std::max(shape->inside, shape->outside) <= distance)) break;
    }
    if (!(std::max(shape->inside, shape->outside) <= distance)) continue;
    if (RayCount(pieces, *shape, gap).is_odd()) result.push_back(std::move(*shape));
  }
  return result;
}

}  // namespace taut
