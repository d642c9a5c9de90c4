#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "taut/core/tolerances.h"
#include "taut/hull/affine_span.h"
#include "taut/hull/coarse_hull.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/outline.h"
#include "taut/hull/point_hull.h"
#include "taut/hull/polytope_mesh.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Sizes at which no product of the hull's arithmetic leaves the range of doubles.
constexpr int safe_exponent = 200;

/// The power of two by which coordinates up to this size are multiplied: one for all usual sizes.
double scale_for(double largest) {
  int exponent = 0;
  std::frexp(largest, &exponent);
  if (largest == 0 || std::abs(exponent) <= safe_exponent) return 1;
  return std::ldexp(1.0, std::min(-exponent, 1023));
}

/// All points of a model, placed by its instances.
class ModelPoints {
 public:
  explicit ModelPoints(const Model& model) : model_(model) {
    Box box;
    for_each([&](const dvec3& x, bool) { box.include(x); });
    const dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    scale_ = scale_for(std::max({reach.x, reach.y, reach.z}));
    diagonal_ = scale_ * taut::diagonal(box);
    reach_ = scale_ * (reach.x + reach.y + reach.z);
    int count = 0;
    for (const Instance& instance : model.instances()) {
      first_.push_back(count);
      count += part_of(instance).point_count();
    }
    if (scale_ == 1 && model.instances().size() == 1 && at_rest(model.instances().front())) {
      points_ = part_of(model.instances().front()).vertices();
      return;
    }
    moved_.reserve(std::size_t(count));
    for_each([&](const dvec3& x, bool moved) {
      moved_.push_back(scale_ * x);
      any_moved_ = any_moved_ || moved;
    });
    points_ = moved_;
  }

  std::span<const dvec3> points() const { return points_; }
  /// What coordinates were multiplied by.
  double scale() const { return scale_; }
  double diagonal() const { return diagonal_; }
  /// The sum of the largest coordinates' sizes.
  double reach() const { return reach_; }
  /// How far the points may lie from the instances' true ones.
  double placement_bound() const { return any_moved_ ? coordinate_rounding * reach_ : 0; }

  /// The source of the point of this number.
  int source(int point) const { return model_.source_id(place_of(point)); }
  /// The point as it stands in the model, not multiplied.
  dvec3 model_point(int point) const {
    const Source place = place_of(point);
    const Instance& instance = model_.instances()[std::size_t(place.instance)];
    const dvec3& x = part_of(instance).vertices()[std::size_t(place.index)];
    return at_rest(instance) ? x : instance.pose(x);
  }

  /// Calls visit with the source and the corners, by number of points, of every polygon.
  template <class Visit>
  void for_each_polygon(Visit visit) const {
    std::vector<int> corners;
    for (int i = 0; i < int(model_.instances().size()); ++i) {
      const Part& part = part_of(model_.instances()[std::size_t(i)]);
      for (int k = 0; k < int(part.polygons().size()); ++k) {
        corners = part.polygons()[std::size_t(k)];
        for (int& c : corners) c += first_[std::size_t(i)];
        visit(model_.source_id({SourceKind::face, i, k}), corners);
      }
    }
  }

 private:
  static bool at_rest(const Instance& instance) {
    return instance.pose.rotation == dmat3(1.0) && instance.pose.translation == dvec3(0.0);
  }
  const Part& part_of(const Instance& instance) const {
    return model_.parts()[std::size_t(instance.part)];
  }
  Source place_of(int point) const {
    const auto next = std::upper_bound(first_.begin(), first_.end(), point);
    const auto instance = std::size_t(next - first_.begin()) - 1;
    return {SourceKind::vertex, int(instance), point - first_[instance]};
  }
  template <class Visit>
  void for_each(Visit visit) const {
    for (const Instance& instance : model_.instances()) {
      const bool moved = !at_rest(instance);
      for (const dvec3& x : part_of(instance).vertices()) {
        visit(moved ? instance.pose(x) : x, moved);
      }
    }
  }

  const Model& model_;
  std::vector<int> first_;  ///< per instance: the number of its first point
  std::vector<dvec3> moved_;
  std::span<const dvec3> points_;
  double scale_ = 1;
  double diagonal_ = 0;
  double reach_ = 0;
  bool any_moved_ = false;
};

/// Builds the hull of whatever dimension from all points.
class PolyhedralHull {
 public:
  PolyhedralHull(const Model& model, const HullOptions& options)
      : points_(model),
        options_(options),
        width_(
            std::min(coordinate_rounding * points_.reach(), spurious_share * points_.diagonal())) {}

  Hull run();

 private:
  static Box box_of(std::span<const dvec3> points) {
    Box box;
    for (const dvec3& p : points) box.include(p);
    return box;
  }

  void make_point(int p);
  void make_segment(int a, int b, double distance_bound);
  void make_planar(std::span<const int> candidates, const std::array<int, 4>& witnesses,
                   double off_plane);
  void make_solid(const PointHull& hull);
  void make_polytope(const PointHull& hull, const std::vector<int>* original = nullptr);
  void finish(const std::vector<int>& corners);
  dvec3 normal_of(OpenMesh::FaceHandle f, const std::vector<int>& corners) const;
  void label_faces(const PointHull& hull, const PointHull::Polygons& polygons,
                   const std::vector<int>& vertex_of);

  const dvec3& point(int i) const { return points_.points()[std::size_t(i)]; }

  ModelPoints points_;
  const HullOptions& options_;
  double width_;  ///< what is put down to rounding, scaled as the points are
  Hull result_;
};

Hull PolyhedralHull::run() {
  const auto start = Clock::now();
  options_.progress.update("sample", 0);
  const std::span<const dvec3> all = points_.points();
  PointHull hull(box_of(all));
  hull.add(all, options_.progress);
  options_.progress.update("sample", 1);
  result_.statistics.seconds_sample = seconds_since(start);
  const auto mesh_start = Clock::now();
  if (hull.dimension() == 3) {
    make_solid(hull);
  } else {
    std::vector<int> candidates(all.size());
    std::iota(candidates.begin(), candidates.end(), 0);
    if (hull.dimension() == 2) {
      make_planar(candidates, hull.simplex(), 0);
    } else {
      // Along a line, points are ordered as their coordinates are.
      const auto before = [&](int i, int j) {
        const dvec3& p = point(i);
        const dvec3& q = point(j);
        return std::tie(p.x, p.y, p.z, i) < std::tie(q.x, q.y, q.z, j);
      };
      const auto [low, high] = std::minmax_element(candidates.begin(), candidates.end(), before);
      hull.dimension() == 1 ? make_segment(*low, *high, 0) : make_point(0);
    }
  }
  result_.distance_bound = (result_.distance_bound + points_.placement_bound()) / points_.scale();
  result_.statistics.seconds_mesh = seconds_since(mesh_start);
  return std::move(result_);
}

void PolyhedralHull::make_point(int p) {
  result_.kind = HullKind::point;
  result_.mesh = make_hull_mesh({point(p)}, {});
  finish({p});
}

void PolyhedralHull::make_segment(int a, int b, double distance_bound) {
  result_.kind = HullKind::segment;
  result_.distance_bound = distance_bound;
  result_.mesh = make_hull_mesh({point(a), point(b)}, {});
  finish({a, b});
}

/// The outline of points of a plane, or of points that differ from one by at most off_plane.
void PolyhedralHull::make_planar(std::span<const int> candidates,
                                 const std::array<int, 4>& witnesses, double off_plane) {
  std::vector<dvec3> points;
  points.reserve(candidates.size());
  for (const int c : candidates) points.push_back(point(c));
  const PlaneView view(point(witnesses[0]), point(witnesses[1]), point(witnesses[2]));
  const std::vector<int> exact = convex_outline(points, view);
  std::vector<int> outline = simplified_outline(exact, points, width_);
  const double in_plane = outline.size() < exact.size() ? width_ : 0;
  for (int& corner : outline) corner = candidates[std::size_t(corner)];
  if (outline.size() < 3) {
    make_segment(outline.front(), outline.back(), in_plane + off_plane);
    return;
  }
  std::vector<dvec3> corners;
  std::vector<int> loop(outline.size());
  for (const int c : outline) corners.push_back(point(c));
  std::iota(loop.begin(), loop.end(), 0);
  result_.kind = HullKind::planar;
  result_.distance_bound = in_plane + off_plane;
  result_.mesh = make_hull_mesh(corners, {loop, {loop.rbegin(), loop.rend()}});
  finish(outline);
}

void PolyhedralHull::make_solid(const PointHull& hull) {
  if (width_ == 0 || !has_nearly_flat_edges(hull, width_)) {
    make_polytope(hull);
    return;
  }
  std::vector<bool> on_hull(hull.points().size(), false);
  for (const PointHull::Facet& f : hull.facets()) {
    if (!f.alive) continue;
    for (const int v : f.vertex) on_hull[std::size_t(v)] = true;
  }
  std::vector<int> vertices;
  std::vector<dvec3> positions;
  for (int i = 0; i < int(on_hull.size()); ++i) {
    if (!on_hull[std::size_t(i)]) continue;
    vertices.push_back(i);
    positions.push_back(point(i));
  }
  AffineSpan span = affine_span(positions, width_);
  for (int k = 0; k <= span.dimension; ++k) {
    int& witness = span.witnesses[std::size_t(k)];
    witness = vertices[std::size_t(witness)];
  }
  if (span.dimension == 1) {
    make_segment(span.witnesses[0], span.witnesses[1], width_);
  } else if (span.dimension == 2) {
    make_planar(vertices, span.witnesses, width_);
  } else {
    const CoarseHull coarse = coarse_hull(hull, span.witnesses, width_, options_.progress);
    if (coarse.distance_bound <= spurious_share * points_.diagonal()) {
      result_.distance_bound = coarse.distance_bound;
      make_polytope(coarse.hull, &coarse.original);
    } else {
      make_polytope(hull);  // at a corner too sharp to tell how much is rounding
    }
  }
}

/// `original`: the numbers of the hull's points among all, where they differ.
void PolyhedralHull::make_polytope(const PointHull& hull, const std::vector<int>* original) {
  result_.kind = HullKind::solid;
  const PointHull::Polygons polygons = hull.merged_polygons();
  options_.progress.update("mesh", 0);
  std::vector<int> corners;  // per vertex of the mesh
  result_.mesh = bare_mesh(hull, 1, polygons, corners);
  if (original != nullptr) {
    for (int& c : corners) c = (*original)[std::size_t(c)];
  }
  finish(corners);
  std::vector<int> vertex_of(points_.points().size(), -1);
  for (std::size_t v = 0; v < corners.size(); ++v) vertex_of[std::size_t(corners[v])] = int(v);
  label_faces(hull, polygons, vertex_of);
}

dvec3 PolyhedralHull::normal_of(OpenMesh::FaceHandle f, const std::vector<int>& corners) const {
  dvec3 normal(0.0);
  std::optional<dvec3> first;
  dvec3 before(0.0);
  for (const auto v : result_.mesh.fv_range(f)) {
    const dvec3 p = point(corners[std::size_t(v.idx())]);
    if (!first) first = before = p;
    normal += glm::cross(before - *first, p - *first);
    before = p;
  }
  return unit(normal);
}

/// Puts the vertices, which are these points, in their places, and labels them and the faces.
void PolyhedralHull::finish(const std::vector<int>& corners) {
  HullMesh& mesh = result_.mesh;
  const float bound =
      float_above((result_.distance_bound + points_.placement_bound()) / points_.scale());
  for (const auto v : mesh.vertices()) {
    const dvec3 x = points_.model_point(corners[std::size_t(v.idx())]);
    mesh.set_point(v, {x.x, x.y, x.z});
    mesh.data(v).source = points_.source(corners[std::size_t(v.idx())]);
    mesh.data(v).quality = bound;
  }
  std::vector<dvec3> normals(corners.size(), dvec3(0.0));
  for (const auto f : mesh.faces()) {
    mesh.data(f).kind = FaceKind::facet;
    mesh.data(f).hull_face = f.idx();
    // Both sides of a planar hull would cancel: its vertices take the first one's.
    if (result_.kind == HullKind::planar && f.idx() > 0) continue;
    const dvec3 normal = normal_of(f, corners);
    for (const auto v : mesh.fv_range(f)) normals[std::size_t(v.idx())] += normal;
  }
  for (const auto v : mesh.vertices()) {
    const dvec3 n = unit(normals[std::size_t(v.idx())]);
    mesh.set_normal(v, {n.x, n.y, n.z});
  }
  for (const auto e : mesh.edges()) mesh.data(e).feature = true;
}

/// Finds for every face the first polygon of the input that lies in it and touches a corner.
void PolyhedralHull::label_faces(const PointHull& hull, const PointHull::Polygons& polygons,
                                 const std::vector<int>& vertex_of) {
  HullMesh& mesh = result_.mesh;
  points_.for_each_polygon([&](int source, const std::vector<int>& corners) {
    const auto touching = std::find_if(corners.begin(), corners.end(),
                                       [&](int c) { return vertex_of[std::size_t(c)] >= 0; });
    if (touching == corners.end()) return;
    for (const auto f : mesh.vf_range(OpenMesh::VertexHandle(vertex_of[std::size_t(*touching)]))) {
      if (mesh.data(f).source >= 0) continue;
      const PlaneSide& plane = hull.facet(polygons.facets[std::size_t(f.idx())]).side;
      const bool lies_in = std::all_of(corners.begin(), corners.end(),
                                       [&](int c) { return plane.side(point(c)) == Sign::zero; });
      if (lies_in) mesh.data(f).source = source;
    }
  });
}

}  // namespace

Hull polyhedral_hull(const Model& model, const HullOptions& options) {
  tolerance_for(options, 0);
  if (model.empty()) return {};
  return PolyhedralHull(model, options).run();
}

}  // namespace taut
