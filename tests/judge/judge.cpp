#include "judge.h"

#include <cmath>
#include <stdexcept>

#include "cages.h"
#include "claims.h"
#include "limit_support.h"
#include "taut/bounds/contact_geometry.h"
#include "taut/core/error.h"
#include "taut/core/stopwatch.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/report/report.h"
#include "taut/verify/verify_hull.h"

namespace taut_test {

using namespace taut;  // NOLINT: what is judged

namespace {

/// What `taut verify` holds documents to beyond the bounds that they state, in diagonals.
constexpr double exact_relative = 1e-12;
/// Relative differences of measures of rounded models from those of the models drawn.
constexpr double rounded_measure = 1e-5;
/// And of meshes that are the hull from its boundary, by the rounding of vertices.
constexpr double mesh_measure = 1e-12;
/// Levels to which all of a cage is refined, and how close bounds of its support are to be, in
/// diagonals.
constexpr int refined_levels = 3;
constexpr double support_accuracy = 1e-9;

/// The first measure that is not what is expected, or less than the mesh's although that lies
/// within the hull; `measured` receives those that were compared.
std::string wrong_measure(const Scene& scene, const Hull& hull, const Expected& expected,
                          std::string& measured) {
  const BoundaryMeasures measures = measure(scene, ContactGeometry(scene), *hull.boundary);
  const Measures mesh = measure(polygons(hull.mesh));
  std::string wrong;
  const auto contain = [&](const char* what, double of_mesh, double found, double bound) {
    const double lacks = of_mesh / found - 1;
    if (measures.volume > 0 && wrong.empty() && !(lacks <= bound + mesh_measure)) {
      wrong = off_by(what, lacks);
    }
  };
  contain("volume below the mesh's", mesh.volume, measures.volume, measures.bounds.volume);
  contain("area below the mesh's", mesh.area, measures.area, measures.bounds.area);
  const auto compare = [&](const char* letter, const char* what, double found, double right) {
    if (!std::isfinite(right)) return;
    measured += letter;
    const double off = std::abs(found / right - 1);
    if (wrong.empty() && !(off <= expected.accuracy)) wrong = off_by(what, off);
  };
  compare("V", "volume off", measures.volume, expected.volume);
  compare("A", "area off", measures.area, expected.area);
  compare("W", "mean width off", measures.mean_width, expected.mean_width);
  return wrong;
}

/// What is wrong by a support function of the judge's own.
std::string wrong_support(const Subject& subject, const Scene& scene, const Hull& hull,
                          Random& random) {
  const double size = scene.diagonal();
  const HullBoundary* whole =
      hull.boundary && hull.boundary->unresolved.empty() ? hull.boundary.get() : nullptr;
  if (subject.cage) {
    const LimitSupport limit(*subject.cage, refined_levels);
    const Support support = [&](const dvec3& n) { return limit(n, support_accuracy * size); };
    const double slack = subject.model.deviation_bound();
    std::string wrong = wrong_mesh(hull, support, size, slack, random);
    if (!wrong.empty() || whole == nullptr) return wrong;
    return wrong_contacts(*whole, support, size, slack, random);
  }
  const Shape& shape = subject.shape;
  if (shape.surfaces.empty() && shape.curves.empty() && shape.points.empty()) {
    throw std::invalid_argument("there is nothing to compare the hull with");
  }
  const SupportReference reference(shape);
  const Support support = [&](const dvec3& n) { return SupportRange{reference(n).h, infinity}; };
  std::string wrong = wrong_mesh(hull, support, size, 0, random);
  if (!wrong.empty() || whole == nullptr) return wrong;
  return wrong_places(*whole, reference, random);
}

}  // namespace

HullDocument document_of(const Scene& scene, const Hull& hull) {
  const HullBoundary& boundary = *hull.boundary;
  HullDocument document = hull_document(scene, boundary);
  Report report;
  report.hull.resolution = hull.resolution;
  report.hull.counts = {boundary.count(FaceKind::patch), boundary.count(FaceKind::scroll),
                        boundary.count(FaceKind::facet), int(boundary.curves.size()),
                        int(boundary.unresolved.size())};
  Report::ExactHull::Tolerant tolerant;
  for (const HullDocument::Face& face : document.faces) {
    tolerant.faces += face.tolerant > 0 ? 1 : 0;
    tolerant.bound = std::max(tolerant.bound, face.tolerant);
  }
  report.hull.tolerant = tolerant;
  if (boundary.unresolved.empty()) {
    const BoundaryMeasures measures = measure(scene, ContactGeometry(scene), boundary);
    report.hull.measures = measures;
    report.hull.mean_width = measures.mean_width;
    report.hull.measures_accuracy = measures.bounds.largest();
  }
  if (scene.model().deviation_bound() > 0) {
    report.subdivision = Report::Subdivision{0, 0, scene.model().deviation_bound()};
  }
  document.report = to_json(report);
  return document;
}

Verdict judged(const Subject& subject, Random& random, const HullOptions& hull_options) {
  Verdict verdict;
  const Scene scene(subject.model);
  const Stopwatch watch;
  Hull hull;
  try {
    hull = convex_hull(scene, hull_options);
  } catch (const HullNotConverged& stop) {
    hull = *stop.best;
    verdict.missed = stop.what();
  }
  verdict.seconds = watch.seconds();
  verdict.bound = hull.distance_bound / scene.diagonal();
  verdict.wrong = wrong_support(subject, scene, hull, random);
  if (!hull.boundary) return verdict;
  const HullBoundary& boundary = *hull.boundary;
  verdict.unresolved = int(boundary.unresolved.size());
  verdict.closed = boundary.unresolved.empty();
  verdict.found = {boundary.count(FaceKind::patch), boundary.count(FaceKind::scroll),
                   boundary.count(FaceKind::facet), int(boundary.curves.size())};
  if (!verdict.closed) return verdict;
  verdict.within = verdict.missed.empty();
  const Counts& counts = subject.expected.counts;
  if (verdict.within && differ(verdict.found, counts)) {
    verdict.miscounted = text(verdict.found) + ", not " + text(counts);
  }
  VerifyOptions options;
  options.random_directions = 500;
  const HullDocument document = document_of(scene, hull);
  verdict.verified = verify(document, scene, options).is_hull(exact_relative);
  const std::string wrong = wrong_measure(scene, hull, subject.expected, verdict.measured);
  if (verdict.wrong.empty()) verdict.wrong = wrong;
  return verdict;
}

Verdict judged(const Natural& natural, Variant variant, Random& random,
               const HullOptions& options) {
  const Natural stored = placed(natural, variant, random);
  Expected expected = stored.expected;
  if (rounds(variant)) {
    expected.accuracy = rounded_measure;
    // Points are what they are: rounding parts those in one plane.
    if (stored.shape.surfaces.empty() && stored.shape.curves.empty()) expected.counts = {};
  }
  return judged({stored.cage ? cage_model(*stored.cage) : make_model(stored.shape), expected,
                 stored.shape, stored.cage},
                random, options);
}

}  // namespace taut_test
