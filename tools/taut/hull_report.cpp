#include "hull_report.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "taut/hull/measure/boundary_measures.h"
#include "taut/hull/result/measures.h"
#include "text.h"

namespace taut::tool {
namespace {

/// Reasons for unresolved spots that the warning names; -v tells all.
constexpr std::size_t reasons_told = 3;
/// Estimated relative accuracy of its measures that a complete boundary does not exceed.
constexpr double worst_accuracy = 1e-9;

/// Warns that the exact hull is not complete: how many spots of it, and the first reasons.
void warn_of_unresolved(const HullBoundary& boundary, Console& console) {
  if (boundary.unresolved.empty()) return;
  std::vector<std::pair<std::string, long>> reasons;  // each once, with how often it occurs
  for (const Unresolved& spot : boundary.unresolved) {
    console.note("unresolved at the normal " + number(spot.n.x) + " " + number(spot.n.y) + " " +
                 number(spot.n.z) + ": " + spot.reason);
    const auto known = std::find_if(reasons.begin(), reasons.end(),
                                    [&](const auto& r) { return r.first == spot.reason; });
    if (known == reasons.end()) {
      reasons.emplace_back(spot.reason, 1);
    } else {
      ++known->second;
    }
  }
  std::vector<std::string> words;
  for (std::size_t k = 0; k < std::min(reasons.size(), reasons_told); ++k) {
    words.push_back(reasons[k].first +
                    (reasons[k].second > 1 ? " (" + number(reasons[k].second) + ")" : ""));
  }
  if (reasons.size() > reasons_told) words.emplace_back("and others (-v tells all)");
  console.warn("unresolved",
               counted(long(boundary.unresolved.size()), "spot", "spots") +
                   " of the exact hull could not be resolved: " + joined(words, "; ") +
                   ". Faces of it may be missing, it is not measured; the mesh is whole and within "
                   "its distance");
}

/// Mean width of a convex polyhedron, polygon (both sides of which are faces), segment or point:
/// over 4 pi, the sum of its edges' lengths times the angles by which the normal turns there.
double mean_width(const HullMesh& mesh) {
  const auto normal = [&](OpenMesh::FaceHandle face) {
    std::vector<dvec3> corners;
    for (const auto v : mesh.fv_range(face)) corners.push_back(position(mesh, v));
    return plane_normal(corners);
  };
  std::vector<dvec3> normals;
  for (const auto face : mesh.faces()) normals.push_back(normal(face));
  double sum = 0;
  for (const auto edge : mesh.edges()) {
    const auto h = mesh.halfedge_handle(edge, 0);
    const auto a = mesh.face_handle(h);
    const auto b = mesh.face_handle(mesh.opposite_halfedge_handle(h));
    const dvec3 side =
        position(mesh, mesh.to_vertex_handle(h)) - position(mesh, mesh.from_vertex_handle(h));
    double turn = 2 * std::numbers::pi;  // about a segment
    if (a.is_valid() && b.is_valid()) {
      turn =
          exterior_angle(normals[std::size_t(a.idx())], normals[std::size_t(b.idx())], unit(side));
    }
    sum += turn * glm::length(side);
  }
  return sum / (4 * std::numbers::pi);
}

/// The measures of its mesh; the area of a planar hull is that of one of its two sides.
Measures mesh_measures(const Hull& hull) {
  Measures measures = measure(polygons(hull.mesh));
  if (hull.kind == HullKind::planar) measures.area /= 2;
  return measures;
}

/// How many faces of a boundary are tolerant, and the largest of their bounds.
Report::ExactHull::Tolerant tolerant_faces(const HullBoundary& boundary) {
  Report::ExactHull::Tolerant tolerant;
  for (const HullFace& face : boundary.faces) {
    if (!(face.tolerant > 0)) continue;
    ++tolerant.faces;
    tolerant.bound = std::max(tolerant.bound, boundary.frame.length_to_model(face.tolerant));
  }
  return tolerant;
}

/// Why a boundary is not whole as far as its measures tell.
std::optional<std::string> failure_of_measures(const BoundaryMeasures& measures) {
  // What is known to the resolution only is so of what is whole, too.
  const double of_places = measures.bounds.largest() - measures.accuracy;
  if (measures.accuracy <= std::max(worst_accuracy, of_places)) return {};
  return "faces of the exact hull are missing or do not meet: its measures are accurate to " +
         number(measures.accuracy, 2) + " only";
}

/// Adds the measures of a boundary, and what they tell against it. @throws LimitMet
void add_measures(Input& input, Outcome& outcome, Console& console, Report::ExactHull& exact) {
  const HullBoundary& boundary = *outcome.exact().boundary;
  const Progress progress = console.progress();
  progress.update("measure", 0);
  const BoundaryMeasures measures =
      measure(input.scene(), ContactGeometry(input.scene(), progress.stop), boundary, progress);
  progress.update("measure", 1);
  exact.measures = measures;
  exact.mean_width = measures.mean_width;
  exact.measures_accuracy = measures.bounds.largest();
  if (!outcome.failure) outcome.failure = failure_of_measures(measures);
}

/// Of a hull that is its mesh: that of points and polygons, a segment, or a point. How far its two
/// ends may be from those of the model's segment is a share of its length.
void add_mesh_as_hull(const Hull& hull, Report::ExactHull& exact) {
  // The two sides of a planar hull are one facet.
  exact.counts = {0, 0, hull.kind == HullKind::planar ? 1 : 0, int(hull.mesh.n_edges()), 0};
  exact.tolerant = Report::ExactHull::Tolerant{};
  exact.measures = mesh_measures(hull);
  exact.mean_width = mean_width(hull.mesh);
  if (hull.kind != HullKind::segment) return;
  const double length = 2 * *exact.mean_width;
  if (length > 0) exact.measures_accuracy = 2 * *exact.gap_bound / length;
}

/// What is known of the exact hull: its faces and, if no limit is met meanwhile, its measures.
Report::ExactHull exact_hull(Input& input, Outcome& outcome, const std::string& method,
                             Console& console) {
  const Hull& hull = outcome.exact();
  Report::ExactHull exact;
  exact.gap_bound = hull.distance_bound + input.model().deviation_bound();
  if (hull.boundary) {
    const HullBoundary& boundary = *hull.boundary;
    warn_of_unresolved(boundary, console);
    exact.counts = {boundary.count(FaceKind::patch), boundary.count(FaceKind::scroll),
                    boundary.count(FaceKind::facet), int(boundary.curves.size()),
                    int(boundary.unresolved.size())};
    exact.tolerant = tolerant_faces(boundary);
    if (input.model().polyhedral()) {
      exact.measures = mesh_measures(hull);
      exact.mean_width = mean_width(hull.mesh);
    } else if (boundary.unresolved.empty()) {
      try {
        add_measures(input, outcome, console, exact);
      } catch (const LimitMet& met) {
        outcome.meet(std::string(met.what()) + " before the hull was measured");
      }
    }
  } else if (method == "precise" && (input.model().polyhedral() || hull.dimension() < 2)) {
    add_mesh_as_hull(hull, exact);
  }
  return exact;
}

/// What became of the control cages, if there are any.
std::optional<Report::Subdivision> subdivision(const Model& model) {
  Report::Subdivision sum;
  bool any = false;
  for (const Part& part : model.parts()) {
    for (const CageOfPart& cage : part.cages()) {
      any = true;
      sum.irregular_faces += cage.irregular_faces;
      sum.refined_faces += cage.refined_faces;
    }
  }
  if (!any) return {};
  sum.deviation_bound = model.deviation_bound();
  return sum;
}

}  // namespace

Report make_report(Input& input, Outcome& outcome, const HullArguments& arguments, double tolerance,
                   Console& console) {
  const Hull& hull = *outcome.hull;
  Report report;
  report.input = input.summary();
  report.method = arguments.method;
  report.dimension = hull.dimension();
  const Stopwatch measuring;
  report.hull = exact_hull(input, outcome, arguments.method, console);
  report.hull.resolution = hull.resolution;
  report.hull.dropped = outcome.exact().points_left_out;
  report.mesh.vertices = long(hull.mesh.n_vertices());
  report.mesh.edges = long(hull.mesh.n_edges());
  report.mesh.faces = long(hull.mesh.n_faces());
  report.mesh.measures = mesh_measures(hull);
  report.seconds.measure = measuring.seconds();
  report.mesh.tolerance = tolerance;
  // The scene's surfaces themselves may stand for others.
  report.mesh.distance_bound = hull.distance_bound + input.model().deviation_bound();
  report.subdivision = subdivision(input.model());
  const HullStatistics& statistics = hull.statistics;
  if (statistics.map_cells > 0) {
    report.culling = {statistics.map_candidates, statistics.map_contacts, statistics.map_undecided};
    report.directions = {statistics.map_cells, statistics.map_candidates, statistics.map_undecided};
  }
  report.queries = {statistics.support_queries, statistics.newton_iterations};
  report.seconds.read = input.seconds_read();
  report.seconds.build = input.seconds_build();
  report.seconds.sample = statistics.seconds_sample;
  report.seconds.cull = statistics.seconds_map;
  report.seconds.trace = statistics.seconds_trace;
  report.seconds.stitch = statistics.seconds_stitch;
  report.seconds.mesh = statistics.seconds_mesh;
  return report;
}

/// The times and warnings until now.
void bring_up_to_date(Report& report, const Outcome& outcome, const Console& console) {
  report.seconds.total = console.seconds();
  report.peak_bytes = peak_bytes();
  report.warnings = console.warnings();
  if (!outcome.failure) return;
  report.warnings.push_back({outcome.met_limit ? "limit-met" : "not-converged", *outcome.failure});
}

}  // namespace taut::tool
