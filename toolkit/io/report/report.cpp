#include "taut/io/report/report.h"

#include <nlohmann/json.hpp>

namespace taut {
namespace {

using ReportJson = nlohmann::ordered_json;

ReportJson to_json(const dvec3& p) { return {p.x, p.y, p.z}; }

ReportJson to_json(const Report::Input& input) {
  ReportJson json = {{"files", input.files},     {"faces", input.faces},
                     {"edges", input.edges},     {"vertices", input.vertices},
                     {"patches", input.patches}, {"diagonal", input.diagonal}};
  if (!input.box.empty()) json["box"] = {to_json(input.box.lower), to_json(input.box.upper)};
  json["curves"] = input.curves;
  json["points"] = input.points;
  json["unit"] = input.unit.empty() ? ReportJson() : ReportJson(input.unit);
  return json;
}

/// The area, and that of both sides where it is that of one.
void add_area(ReportJson& json, double area, int dimension) {
  constexpr int planar = 2;
  json["area"] = area;
  if (dimension == planar) json["area_of_both_sides"] = 2 * area;
}

ReportJson to_json(const Report::ExactHull& hull, int dimension) {
  ReportJson json = ReportJson::object();
  if (hull.counts) {
    json["patches"] = hull.counts->patches;
    json["scrolls"] = hull.counts->scrolls;
    json["facets"] = hull.counts->facets;
    json["curves"] = hull.counts->curves;
    json["unresolved"] = hull.counts->unresolved;
  }
  if (hull.resolution) {
    json["resolution"] = hull.resolution->rho;
    json["resolution_source"] = name_of(hull.resolution->source);
  }
  if (hull.tolerant) {
    json["tolerant"] = hull.tolerant->faces;
    json["tolerant_bound"] = hull.tolerant->bound;
  }
  if (hull.measures) {
    const dmat3& inertia = hull.measures->inertia;  // symmetric: columns are rows
    json["volume"] = hull.measures->volume;
    add_area(json, hull.measures->area, dimension);
    json["centroid"] = to_json(hull.measures->centroid);
    json["inertia"] = {to_json(inertia[0]), to_json(inertia[1]), to_json(inertia[2])};
  }
  if (hull.mean_width) json["mean_width"] = *hull.mean_width;
  if (hull.measures_accuracy) json["measures_accuracy"] = *hull.measures_accuracy;
  if (hull.gap_bound) json["gap_bound"] = *hull.gap_bound;
  if (hull.dropped > 0) json["dropped"] = hull.dropped;
  return json;
}

ReportJson to_json(const Report::Mesh& mesh, int dimension) {
  ReportJson json = {{"vertices", mesh.vertices},
                     {"edges", mesh.edges},
                     {"faces", mesh.faces},
                     {"volume", mesh.measures.volume}};
  add_area(json, mesh.measures.area, dimension);
  json["tolerance"] = mesh.tolerance;
  json["distance_bound"] = mesh.distance_bound;
  json["files"] = ReportJson::array();
  for (const auto& f : mesh.files) {
    json["files"].push_back({{"file", f.file}, {"rounding", f.rounding}});
  }
  return json;
}

ReportJson to_json(const Report::Queries& queries) {
  return {{"support", queries.support}, {"newton_iterations", queries.newton_iterations}};
}

ReportJson to_json(const Report::Seconds& seconds) {
  return {{"read", seconds.read},  {"build", seconds.build},     {"sample", seconds.sample},
          {"cull", seconds.cull},  {"trace", seconds.trace},     {"stitch", seconds.stitch},
          {"mesh", seconds.mesh},  {"measure", seconds.measure}, {"write", seconds.write},
          {"total", seconds.total}};
}

ReportJson to_json(const std::vector<Warning>& warnings) {
  ReportJson json = ReportJson::array();
  for (const Warning& w : warnings) json.push_back({{"code", w.code}, {"text", w.text}});
  return json;
}

}  // namespace

std::string to_json(const Report& report) {
  ReportJson json = {{"taut", TAUT_VERSION},
                     {"input", to_json(report.input)},
                     {"method", report.method},
                     {"dimension", report.dimension},
                     {"hull", to_json(report.hull, report.dimension)},
                     {"mesh", to_json(report.mesh, report.dimension)}};
  if (report.subdivision) {
    json["subdivision"] = {{"irregular_faces", report.subdivision->irregular_faces},
                           {"refined_faces", report.subdivision->refined_faces},
                           {"deviation_bound", report.subdivision->deviation_bound}};
  }
  if (report.culling) {
    json["culling"] = {{"leaves", report.culling->leaves},
                       {"kept", report.culling->kept},
                       {"searched", report.culling->searched}};
  }
  if (report.directions) {
    json["directions"] = {{"cells", report.directions->cells},
                          {"candidates", report.directions->candidates},
                          {"undecided", report.directions->undecided}};
  }
  json["queries"] = to_json(report.queries);
  json["seconds"] = to_json(report.seconds);
  json["peak_bytes"] = report.peak_bytes;
  json["warnings"] = to_json(report.warnings);
  // File names are any bytes; what is no UTF-8 in them must not lose the report.
  return json.dump(2, ' ', false, ReportJson::error_handler_t::replace) + "\n";
}

}  // namespace taut
