#include "taut/hull/polyhedral/polyhedral_hull.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

#include "taut/core/stopwatch.h"
#include "taut/core/tolerances.h"
#include "taut/hull/polyhedral/polyhedral_boundary.h"
#include "taut/hull/polyhedral/polyhedral_faces.h"
#include "taut/hull/polytope/affine_span.h"
#include "taut/hull/polytope/coarse_hull.h"
#include "taut/hull/polytope/model_points.h"
#include "taut/hull/polytope/outline.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/sample/polytope_mesh.h"

namespace taut {
namespace {

bool keeps_all(const HullOptions& options) {
  return options.resolution && *options.resolution == 0;
}

/// Builds the hull of whatever dimension from all points.
class PolyhedralHull {
 public:
  PolyhedralHull(const Model& model, const HullOptions& options)
      : model_(model),
        points_(model),
        options_(options),
        rounding_(
            points_.product_scale() == 1 && !keeps_all(options)
                ? rounding_width(points_.points(), std::min(coordinate_rounding * points_.reach(),
                                                            spurious_share * points_.diagonal()))
                : RoundingWidth()),
        width_(rounding_.largest()) {}

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
                   double thickness);
  void make_solid(const PointHull& hull);
  void make_thin(const PointHull& hull, std::span<const int> vertices, const AffineSpan& span);
  void make_polytope(const PointHull& hull, const std::vector<int>* original = nullptr);
  void finish(std::vector<int> corners);
  /// How many of the points are vertices of the hull.
  long extreme_count(const PointHull& hull) const;
  dvec3 normal_of(OpenMesh::FaceHandle f) const;

  /// Of a length or height that is computed from differences of points, each operation's at most.
  double rounding() const { return 8 * rounding_unit * points_.diagonal(); }
  const dvec3& point(int i) const { return points_.points()[std::size_t(i)]; }
  const dvec3& point_at(OpenMesh::VertexHandle v) const {
    return point(corners_[std::size_t(v.idx())]);
  }

  const Model& model_;
  ModelPoints points_;
  const HullOptions& options_;
  RoundingWidth rounding_;
  double width_;  ///< the largest of it: what is put down to rounding, scaled as the points are;
                  ///< zero: nothing
  Hull result_;
  std::vector<int> corners_;    ///< per vertex of the mesh: its number among the points
  std::vector<dvec3> normals_;  ///< per face of the mesh
};

/// Neighbours of vertices that coarse_hull() may look at: some seconds.
constexpr double most_work = 3e8;

Hull PolyhedralHull::run() {
  const Stopwatch start;
  options_.progress.update("sample", 0);
  const std::span<const dvec3> all = points_.points();
  PointHull hull(box_of(all));
  hull.add(all, options_.progress);
  options_.progress.update("sample", 1);
  result_.statistics.seconds_sample = start.seconds();
  const Stopwatch mesh_start;
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
  result_.statistics.seconds_mesh = mesh_start.seconds();
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

/// The outline of points of a plane, or of points between two parallels to it, so far apart.
void PolyhedralHull::make_planar(std::span<const int> candidates,
                                 const std::array<int, 4>& witnesses, double thickness) {
  std::vector<dvec3> points;
  points.reserve(candidates.size());
  for (const int c : candidates) points.push_back(point(c));
  const PlaneView view(point(witnesses[0]), point(witnesses[1]), point(witnesses[2]));
  const std::vector<int> exact = convex_outline(points, view);
  std::vector<int> outline = width_ > 0 ? simplified_outline(exact, points, rounding_) : exact;
  // Along the axis of the view, which is no more than 55 degrees from the normal, every point has
  // some of the exact outline's hull across from it.
  double bound = std::sqrt(3.0) * thickness;
  if (outline.size() < exact.size()) bound += width_ + rounding();
  result_.points_left_out = long(exact.size() - outline.size());
  for (int& corner : outline) corner = candidates[std::size_t(corner)];
  if (outline.size() < 3) {
    make_segment(outline.front(), outline.back(), bound);
    return;
  }
  std::vector<dvec3> corners;
  corners.reserve(outline.size());
  std::vector<int> loop(outline.size());
  for (const int c : outline) corners.push_back(point(c));
  std::iota(loop.begin(), loop.end(), 0);
  result_.kind = HullKind::planar;
  result_.distance_bound = bound;
  result_.mesh = make_hull_mesh(corners, {loop, {loop.rbegin(), loop.rend()}});
  finish(outline);
}

void PolyhedralHull::make_solid(const PointHull& hull) {
  if (width_ == 0) {
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
  if (span.dimension < 3) {
    make_thin(hull, vertices, span);
  } else if (!has_nearly_flat_edges(hull, rounding_) || coarsening_work(hull) > most_work) {
    make_polytope(hull);
  } else {
    const CoarseHull coarse = coarse_hull(hull, span.witnesses, rounding_, options_.progress);
    if (coarse.distance_bound <= spurious_share * points_.diagonal()) {
      result_.distance_bound = coarse.distance_bound;
      result_.points_left_out = extreme_count(hull) - extreme_count(coarse.hull);
      make_polytope(coarse.hull, &coarse.original);
    } else {
      make_polytope(hull);  // at a corner too sharp to tell how much is rounding
    }
  }
}

/// Of a solid whose vertices are on a line or a plane, but for what is put down to rounding.
void PolyhedralHull::make_thin(const PointHull& hull, std::span<const int> vertices,
                               const AffineSpan& span) {
  if (span.dimension == 1) {
    make_segment(span.witnesses[0], span.witnesses[1], width_ + rounding());
  } else {
    double low = 0;
    double high = 0;
    for (const int v : vertices) {
      const double height = glm::dot(point(v) - point(span.witnesses[0]), span.normal);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    make_planar(vertices, span.witnesses, high - low + 2 * rounding());
  }
  result_.points_left_out = extreme_count(hull) - long(result_.mesh.n_vertices());
}

long PolyhedralHull::extreme_count(const PointHull& hull) const {
  std::vector<int> numbers;
  return long(
      bare_mesh(hull, 1, hull.merged_polygons(options_.progress), numbers, options_.progress)
          .n_vertices());
}

/// Convex polygons as fans of triangles.
std::vector<std::vector<int>> triangulated(const std::vector<std::vector<int>>& polygons) {
  std::vector<std::vector<int>> triangles;
  for (const std::vector<int>& p : polygons) {
    for (std::size_t k = 1; k + 1 < p.size(); ++k) triangles.push_back({p[0], p[k], p[k + 1]});
  }
  return triangles;
}

/// `original`: the numbers of a coarse hull's points among all. Which of its facets are exactly
/// coplanar is chance, so all are triangles.
void PolyhedralHull::make_polytope(const PointHull& hull, const std::vector<int>* original) {
  result_.kind = HullKind::solid;
  PointHull::Polygons polygons = hull.merged_polygons(options_.progress);
  if (original != nullptr) polygons.loops = triangulated(polygons.loops);
  options_.progress.update("mesh", 0);
  std::vector<int> corners;  // per vertex of the mesh
  result_.mesh = bare_mesh(hull, 1, std::move(polygons), corners, options_.progress);
  if (original != nullptr) {
    for (int& c : corners) c = (*original)[std::size_t(c)];
  }
  finish(std::move(corners));
  PolyhedralFaces faces(points_, corners_, normals_, width_, result_.mesh);
  if (original != nullptr) faces.join_coplanar();
  faces.join_slivers();
  faces.label();
  result_.boundary =
      std::make_shared<const HullBoundary>(polyhedral_boundary(model_, result_.mesh));
}

dvec3 PolyhedralHull::normal_of(OpenMesh::FaceHandle f) const {
  std::vector<dvec3> corners;
  for (const auto v : result_.mesh.fv_range(f)) {
    corners.push_back(points_.product_scale() * point_at(v));
  }
  return plane_normal(corners);
}

/// Puts the vertices, which are these points, in their places, and labels them and the faces.
void PolyhedralHull::finish(std::vector<int> corners) {
  corners_ = std::move(corners);
  HullMesh& mesh = result_.mesh;
  const float bound =
      float_above((result_.distance_bound + points_.placement_bound()) / points_.scale());
  for (const auto v : mesh.vertices()) {
    const int number = corners_[std::size_t(v.idx())];
    const dvec3 x = points_.model_point(number);
    mesh.set_point(v, {x.x, x.y, x.z});
    mesh.data(v).source = points_.source(number);
    mesh.data(v).quality = bound;
  }
  std::vector<dvec3> vertex_normals(corners_.size(), dvec3(0.0));
  for (const auto f : mesh.faces()) {
    mesh.data(f).kind = FaceKind::facet;
    // Both sides of a planar hull are one face, of which its vertices take the first one's normal.
    const bool is_planar = result_.kind == HullKind::planar;
    mesh.data(f).hull_face = is_planar ? 0 : f.idx();
    normals_.push_back(normal_of(f));
    if (is_planar && f.idx() > 0) continue;
    for (const auto v : mesh.fv_range(f)) vertex_normals[std::size_t(v.idx())] += normals_.back();
  }
  for (const auto v : mesh.vertices()) {
    const dvec3 n = unit(vertex_normals[std::size_t(v.idx())]);
    mesh.set_normal(v, {n.x, n.y, n.z});
  }
  for (const auto e : mesh.edges()) mesh.data(e).feature = true;
}

}  // namespace

Hull polyhedral_hull(const Model& model, const HullOptions& asked) {
  const HullOptions options = within_limits(asked);
  tolerance_for(options, 0);
  const Resolution resolution = resolution_for(options, model, diagonal(model.control_box()));
  if (model.empty()) return {};
  warn_if_capped(resolution, options.progress);
  Hull hull = PolyhedralHull(model, options).run();
  hull.resolution = resolution;
  if (keeps_all(options)) hull.resolution.rho = 0;
  return hull;
}

}  // namespace taut
