#include "taut/hull/sample/polytope_mesh.h"

#include <algorithm>

#include "taut/core/parallel.h"
#include "taut/core/stopwatch.h"
#include "taut/core/tolerances.h"
#include "taut/hull/sample/vertex_normals.h"

namespace taut {
namespace {

/// Faces that are labelled between two looks at the progress.
constexpr int faces_per_update = 256;
/// Vertices whose normals one thread finds at a time.
constexpr std::size_t vertices_per_range = 256;

/// Steps of the projection of an edge's middle onto the surface; chords are short against the
/// curvature, so few are enough, and a miss only makes an edge bridging.
constexpr int projection_steps = 3;

/// An edge runs along the surface if the surface comes nearer to its middle than the polytope is to
/// the hull, and than this share of its length. Where the surface is part of the hull, the distance
/// is the sagitta; across a gap the nearest points are the edge's ends, at half its length, or a
/// surface that the hull has left.
constexpr double along_share = 0.25;

/// Follows the scene's surfaces from contacts, in model coordinates times the scene's scale.
class SurfaceWalk {
 public:
  SurfaceWalk(const Scene& scene, const std::vector<Sample>& samples, const PointHull& hull,
              double distance_bound)
      : model_(scene.model()),
        scale_(scene.frame().scale),
        samples_(samples),
        hull_(hull),
        distance_bound_(distance_bound * scale_) {}

  bool runs_along_surface(int a, int b) const {
    const dvec3 middle = 0.5 * (hull_.point(a) + hull_.point(b));
    const double reach =
        std::min(along_share * glm::distance(hull_.point(a), hull_.point(b)), distance_bound_);
    const Contact& ca = samples_[std::size_t(a)].contact;
    const Contact& cb = samples_[std::size_t(b)].contact;
    if (ca.instance == cb.instance && ca.kind == cb.kind && ca.element == cb.element) {
      const PatchJet1 j = jet_at(ca, 0.5 * (ca.u + cb.u), 0.5 * (ca.v + cb.v));
      if (glm::distance(j.S, to_part(ca, middle)) < reach) return true;
    }
    return reaches(ca, middle, reach) || reaches(cb, middle, reach);
  }

  /// The face that the contact's patch belongs to, -1 for curves and points.
  int face_source(const Contact& c) const {
    if (c.kind != SourceKind::face) return -1;
    const int face = part(c).patches()[std::size_t(c.element)].face;
    return model_.source_id({SourceKind::face, c.instance, face});
  }

 private:
  const Instance& instance(const Contact& c) const {
    return model_.instances()[std::size_t(c.instance)];
  }
  const Part& part(const Contact& c) const { return model_.parts()[std::size_t(instance(c).part)]; }

  /// Point and tangents of the contact's element, in its part's frame.
  PatchJet1 jet_at(const Contact& c, double u, double v) const {
    PatchJet1 j;
    if (c.kind == SourceKind::face) {
      j = jet1(part(c).patches()[std::size_t(c.element)].bezier, u, v);
    } else if (c.kind == SourceKind::edge) {
      const CurveJet curve = jet(part(c).pieces()[std::size_t(c.element)].bezier, u);
      j = {curve.c, curve.ct, dvec3(0.0)};
    } else {
      j = {part(c).vertices()[std::size_t(c.element)], dvec3(0.0), dvec3(0.0)};
    }
    return {scale_ * j.S, scale_ * j.Su, scale_ * j.Sv};
  }

  dvec3 to_part(const Contact& c, const dvec3& x) const {
    const RigidMotion& pose = instance(c).pose;
    return glm::transpose(pose.rotation) * (x - scale_ * pose.translation);
  }

  /// Whether Gauss-Newton steps from the contact, kept in its element, come near the target.
  bool reaches(const Contact& c, const dvec3& target, double reach) const {
    if (c.kind == SourceKind::vertex) return false;
    const dvec3 local = to_part(c, target);
    double u = c.u;
    double v = c.v;
    for (int step = 0;; ++step) {
      const PatchJet1 j = jet_at(c, u, v);
      const dvec3 d = local - j.S;
      if (glm::length(d) < reach) return true;
      if (step == projection_steps) return false;
      const double uu = glm::dot(j.Su, j.Su);
      const double uv = glm::dot(j.Su, j.Sv);
      const double vv = glm::dot(j.Sv, j.Sv);
      const double det = uu * vv - uv * uv;
      const double fu = glm::dot(j.Su, d);
      const double fv = glm::dot(j.Sv, d);
      // Where the tangents are parallel or vanish, one direction alone.
      if (det > 1e-12 * uu * vv) {
        u += (vv * fu - uv * fv) / det;
        v += (uu * fv - uv * fu) / det;
      } else if (uu >= vv && uu > 0) {
        u += fu / uu;
      } else if (vv > 0) {
        v += fv / vv;
      }
      u = std::clamp(u, 0.0, 1.0);
      v = std::clamp(v, 0.0, 1.0);
    }
  }

  const Model& model_;
  double scale_;
  const std::vector<Sample>& samples_;
  const PointHull& hull_;
  double distance_bound_;
};

/// Per vertex of the mesh, a direction in which it supports the scene.
std::vector<dvec3> vertex_normals(const Scene& scene, const HullOptions& options,
                                  const std::vector<Sample>& samples,
                                  const std::vector<int>& point_of, const HullMesh& mesh) {
  std::vector<dvec3> normals(point_of.size());
  parallel_for(normals.size(), vertices_per_range, options.threads,
               [&](std::size_t begin, std::size_t end) {
                 VertexNormals find(scene, options.progress.stop);
                 for (std::size_t v = begin; v < end; ++v) {
                   const Sample& sample = samples[std::size_t(point_of[v])];
                   normals[v] = find(mesh, OpenMesh::VertexHandle(int(v)), sample);
                 }
               });
  return normals;
}

void label_vertices(const Scene& scene, const HullOptions& options,
                    const std::vector<Sample>& samples, const std::vector<double>& bounds,
                    const std::vector<int>& point_of, HullMesh& mesh) {
  const std::vector<dvec3> normals = vertex_normals(scene, options, samples, point_of, mesh);
  for (const auto v : mesh.vertices()) {
    options.progress.check();
    const auto p = std::size_t(point_of[std::size_t(v.idx())]);
    const SourceContact c = scene.source(samples[p].contact);
    auto& data = mesh.data(v);
    data.source = c.source;
    data.u = c.u;
    data.v = c.v;
    data.quality = float_above(bounds[p]);
    const dvec3& n = normals[std::size_t(v.idx())];
    mesh.set_normal(v, {n.x, n.y, n.z});
  }
}

/// Reads kinds of faces off the samples at their corners.
class GuessedLabels {
 public:
  GuessedLabels(const Scene& scene, const SampledPolytope& polytope, const HullMesh& mesh,
                const std::vector<int>& point_of)
      : samples_(polytope.samples),
        mesh_(mesh),
        point_of_(point_of),
        walk_(scene, polytope.samples, polytope.hull,
              *std::max_element(polytope.vertex_bounds.begin(), polytope.vertex_bounds.end())),
        edges_(mesh.n_edges(), Edge::unknown) {}

  /// How many of the face's edges bridge gaps.
  unsigned bridges(OpenMesh::FaceHandle f) {
    unsigned count = 0;
    for (const auto e : mesh_.fe_range(f)) count += bridging(e) ? 1 : 0;
    return count;
  }

  FaceLabel operator()(OpenMesh::FaceHandle f, bool flat) {
    const unsigned bridges = this->bridges(f);
    int common = -2;
    int first = -1;
    for (const auto v : mesh_.fv_range(f)) {
      const int source = walk_.face_source(samples_[std::size_t(point_at(v))].contact);
      if (first < 0) first = source;
      common = common == -2 || common == source ? source : -1;
    }
    FaceLabel label;
    label.kind = flat || bridges == mesh_.valence(f) ? FaceKind::facet
                 : bridges == 0                      ? FaceKind::patch
                                                     : FaceKind::scroll;
    label.source = label.kind == FaceKind::patch && common < 0 ? first : common;
    return label;
  }

 private:
  enum class Edge : unsigned char { unknown, along, bridging };

  int point_at(OpenMesh::VertexHandle v) const { return point_of_[std::size_t(v.idx())]; }
  bool bridging(OpenMesh::EdgeHandle e) {
    Edge& edge = edges_[std::size_t(e.idx())];
    if (edge == Edge::unknown) {
      const auto h = mesh_.halfedge_handle(e, 0);
      const bool along = walk_.runs_along_surface(point_at(mesh_.from_vertex_handle(h)),
                                                  point_at(mesh_.to_vertex_handle(h)));
      edge = along ? Edge::along : Edge::bridging;
    }
    return edge == Edge::bridging;
  }

  const std::vector<Sample>& samples_;
  const HullMesh& mesh_;
  const std::vector<int>& point_of_;
  SurfaceWalk walk_;
  std::vector<Edge> edges_;
};

/// Numbers the hull faces that are not known, from `count` on: connected mesh faces of one kind,
/// patches of one source also; every facet is one of its own. Marks the edges between them.
void number_hull_faces(HullMesh& mesh, int count, const Progress& progress) {
  const auto joined = [&](auto a, auto b) {
    const auto& x = mesh.data(a);
    const auto& y = mesh.data(b);
    return x.kind == y.kind && x.kind != FaceKind::facet &&
           (x.kind == FaceKind::scroll || x.source == y.source);
  };
  std::vector<OpenMesh::FaceHandle> stack;
  for (const auto start : mesh.faces()) {
    progress.check();
    if (mesh.data(start).hull_face >= 0) continue;
    mesh.data(start).hull_face = count;
    stack.assign(1, start);
    while (!stack.empty()) {
      progress.check();
      const auto f = stack.back();
      stack.pop_back();
      for (const auto g : mesh.ff_range(f)) {
        if (mesh.data(g).hull_face >= 0 || !joined(f, g)) continue;
        mesh.data(g).hull_face = count;
        stack.push_back(g);
      }
    }
    ++count;
  }
  for (const auto e : mesh.edges()) {
    progress.check();
    const auto f = mesh.face_handle(mesh.halfedge_handle(e, 0));
    const auto g = mesh.face_handle(mesh.halfedge_handle(e, 1));
    mesh.data(e).feature = mesh.data(f).hull_face != mesh.data(g).hull_face;
  }
}

/// The mesh of a polytope with the origins of its vertices and faces.
HullMesh labelled_mesh(const Scene& scene, const HullOptions& options,
                       const SampledPolytope& polytope, const KnownLabels& known) {
  const Progress& progress = options.progress;
  const PointHull::Polygons polygons = polytope.hull.merged_polygons(progress);
  std::vector<int> point_of;  // per mesh vertex
  HullMesh mesh = bare_mesh(polytope.hull, scene.frame().scale, polygons, point_of, progress);
  label_vertices(scene, options, polytope.samples, polytope.vertex_bounds, point_of, mesh);
  GuessedLabels guess(scene, polytope, mesh, point_of);
  for (const auto f : mesh.faces()) {
    if (f.idx() % faces_per_update == 0) {
      progress.update("mesh", double(f.idx()) / double(mesh.n_faces()));
    }
    const std::vector<int>& corners = polygons.loops[std::size_t(f.idx())];
    std::optional<FaceLabel> label;
    if (known.label) label = known.label(corners, [&] { return guess.bridges(f) > 0; });
    if (!label) {
      const int facet = polygons.facets[std::size_t(f.idx())];
      label = guess(f, polytope.gaps[std::size_t(facet)] <= flat_width);
    }
    auto& data = mesh.data(f);
    data.kind = label->kind;
    data.source = label->source;
    data.hull_face = label->hull_face;
  }
  number_hull_faces(mesh, known.count, progress);
  return mesh;
}

}  // namespace

HullMesh bare_mesh(const PointHull& hull, double scale, PointHull::Polygons polygons,
                   std::vector<int>& point_of, const Progress& progress) {
  std::vector<int> vertex_of(hull.points().size(), -1);
  std::vector<dvec3> vertices;
  for (std::vector<int>& loop : polygons.loops) {
    progress.check();
    for (int& p : loop) {
      int& vertex = vertex_of[std::size_t(p)];
      if (vertex < 0) {
        vertex = int(point_of.size());
        point_of.push_back(p);
        vertices.push_back(hull.point(p) / scale);  // exactly the coordinates that were scaled
      }
      p = vertex;
    }
  }
  return make_hull_mesh(vertices, polygons.loops, progress);
}

Hull polytope_hull(const Scene& scene, const HullOptions& options, const SampledPolytope& polytope,
                   const KnownLabels& known) {
  const Stopwatch time;
  options.progress.update("mesh", 0);
  Hull hull;
  hull.kind = HullKind::solid;
  hull.mesh = labelled_mesh(scene, options, polytope, known);
  hull.distance_bound = polytope.distance_bound;
  hull.resolution = resolution_for(options, scene.model(), scene.diagonal());
  hull.statistics = polytope.statistics;
  hull.statistics.seconds_mesh = time.seconds();
  options.progress.update("mesh", 1);
  throw_if_failed(hull, polytope.failure, polytope.limit);
  return hull;
}

void throw_if_failed(Hull& hull, const std::optional<std::string>& failure,
                     const std::optional<std::string>& limit) {
  if (limit) throw HullLimitExceeded(*limit, std::move(hull));
  if (failure) throw HullNotConverged(*failure, std::move(hull));
}

}  // namespace taut
