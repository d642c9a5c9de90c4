#include "sound_hull.h"

#include <algorithm>
#include <sstream>

#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/document/polyhedral_document.h"
#include "taut/io/report/report.h"

namespace taut_test {

using namespace taut;  // NOLINT: what is tested

namespace {

void add_report(const Hull& hull, Sound& sound) {
  const auto count = [&](FaceKind kind) {
    return int(std::count_if(sound.hull.faces.begin(), sound.hull.faces.end(),
                             [&](const HullDocument::Face& f) { return f.kind == kind; }));
  };
  Report report;
  report.dimension = sound.hull.dimension;
  report.hull.counts = {count(FaceKind::patch), count(FaceKind::scroll), count(FaceKind::facet),
                        int(sound.hull.curves.size()),
                        hull.boundary ? int(hull.boundary->unresolved.size()) : 0};
  if (hull.boundary && !sound.scene.model().polyhedral()) {
    const BoundaryMeasures measures =
        measure(sound.scene, ContactGeometry(sound.scene), *hull.boundary);
    report.hull.measures = measures;
    report.hull.mean_width = measures.mean_width;
    report.hull.measures_accuracy = measures.bounds.largest();
  } else {
    Measures measures = measure(polygons(hull.mesh));
    if (hull.kind == HullKind::planar) measures.area /= 2;
    report.hull.measures = measures;
  }
  sound.hull.report = to_json(report);
}

}  // namespace

Sound sound_hull(const Shape& shape) {
  Sound sound{make_scene(shape), {}};
  HullOptions options;
  options.relative = 1e-2;
  options.threads = 1;
  const Hull hull = convex_hull(sound.scene, options);
  sound.hull = hull.boundary ? hull_document(sound.scene, *hull.boundary)
                             : hull_document(sound.scene.model(), hull.mesh);
  add_report(hull, sound);
  return sound;
}

void state(HullDocument& hull, double resolution, int tolerant, double bound) {
  Report report;
  report.hull.resolution.emplace().rho = resolution;
  report.hull.tolerant = {tolerant, bound};
  hull.report = to_json(report);
}

HullVerification verified(const HullDocument& hull, const Scene& scene) {
  VerifyOptions options;
  options.random_directions = 2000;
  options.threads = 1;
  return verify(hull, scene, options);
}

std::set<std::string> failed(const HullVerification& v) {
  std::set<std::string> names;
  for (const HullFault& fault : v.faults) names.insert(fault.check);
  const auto check = [&](const char* name, bool passed) {
    if (!passed) names.insert(name);
  };
  const auto small = [&](double length) { return length <= exact + v.rounding; };
  check("complete", v.complete);
  check("closed", v.closed);
  check("euler", v.topological_sphere());
  check("covered", v.uncovered == 0);
  check("off_model", small(v.off_model));
  check("off_source", small(v.off_source));
  check("off_outline", small(v.off_outline));
  check("tangency", small(v.tangency));
  check("flatness", small(v.flatness));
  check("model_outside", small(v.model_outside));
  check("hull_outside", small(v.hull_outside));
  check("patch_outside", small(v.patch_outside));
  check("vector_area", v.closes_up(exact));
  check("mean_width", v.has_width(exact));
  return names;
}

std::string text_of(const HullVerification& v) {
  std::ostringstream text;
  for (const std::string& name : failed(v)) text << name << " ";
  for (const HullFault& fault : v.faults) text << "\n  " << fault.text;
  text << "\n  euler " << v.euler << " uncovered " << v.uncovered << " model " << v.off_model
       << " off_source " << v.off_source << " outline " << v.off_outline << " tangency "
       << v.tangency << " flat " << v.flatness << " outside " << v.model_outside << " "
       << v.hull_outside << " " << v.patch_outside << " rounding " << v.rounding << " area "
       << v.vector_area << " width " << v.mean_width_error;
  return text.str();
}

}  // namespace taut_test
