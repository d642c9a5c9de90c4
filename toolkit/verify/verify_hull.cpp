#include "taut/verify/verify_hull.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "taut/bounds/support_query.h"
#include "taut/core/integers.h"
#include "taut/core/parallel.h"
#include "taut/core/tolerances.h"
#include "taut/verify/check_labels.h"
#include "taut/verify/check_outlines.h"
#include "taut/verify/check_patches.h"
#include "taut/verify/check_report.h"
#include "taut/verify/check_sources.h"
#include "taut/verify/check_support.h"
#include "taut/verify/coverage.h"
#include "taut/verify/even_directions.h"
#include "taut/verify/hull_structure.h"
#include "taut/verify/stated_bounds.h"

namespace taut {
namespace {

/// Ends of curves closer than this fraction of the diagonal are one: curves meet in the same points
/// but for the rounding of two computations, and that of their coordinates.
constexpr double same_point = 1e-9;

/// Bounds that faces may state, in units of the resolution: what is deeper is not resolved.
constexpr double deepest_bound = 4;

/// Relative error of the mean width by support queries, times their number: that of the lattice is
/// below a tenth of this even of polyhedra, whose support functions have kinks.
constexpr double mean_width_spread = 1;

/// Directions in which the outline of a planar hull is compared with the model.
constexpr int outline_directions = 720;

/// Shares of the step at which the geometry that is listed, what it claims of the model, the
/// measures and the patches are checked.
constexpr double geometry_share = 0.1;
constexpr double claimed_share = 0.3;
constexpr double measured_share = 0.5;
constexpr double patches_share = 0.9;

/// All numbers of a document, to find one that is none.
class FiniteNumbers {
 public:
  bool all(const HullDocument& hull);

 private:
  void see(double x) { finite_ = finite_ && std::isfinite(x); }
  void see(const dvec2& p) { see(p.x), see(p.y); }
  void see(const dvec3& p) { see(p.x), see(p.y), see(p.z); }
  void see(const dvec4& p) { see(dvec3(p)), see(p.w); }
  void see(const HullDocument::Contact& c) { see(c.uv), see(c.p); }
  void see(const HullDocument::Ruling& r) { see(r.n), see(r.a), see(r.b); }
  void see(const HullDocument::Loop& loop) { see(loop.uv); }
  void see(const HullDocument::Region& region) { see(region.loops); }
  void see(const HullDocument::Patch& patch) { see(patch.points); }
  template <class Value>
  void see(const std::vector<Value>& values) {
    for (const Value& value : values) see(value);
  }

  bool finite_ = true;
};

bool FiniteNumbers::all(const HullDocument& hull) {
  see(hull.diagonal);
  for (const HullDocument::Source& source : hull.sources) see(source.patches);
  for (const HullDocument::Curve& curve : hull.curves) see(curve.points);
  for (const HullDocument::Face& face : hull.faces) {
    see(face.loops);
    see(face.regions);
    see(face.rulings);
    see(face.tolerant);
    see(face.normal);
    see(face.offset);
    see(face.contacts);
    see(face.boundary);
  }
  return finite_;
}

/// What the rounding of a scene's coordinates may do to lengths, as a fraction of its diagonal.
double relative_rounding(const Scene& scene) {
  const Box& box = scene.box();
  const dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  const double rounding = coordinate_rounding * (reach.x + reach.y + reach.z);
  return scene.diagonal() > 0 ? rounding / scene.diagonal() : rounding;
}

/// Checks one document.
class HullVerifier {
 public:
  HullVerifier(const HullDocument& hull, const Scene& scene, const VerifyOptions& options)
      : hull_(hull),
        scene_(scene),
        options_(options),
        diagonal_(scene.diagonal()),
        rounding_(relative_rounding(scene)),
        stated_(stated_resolution(hull)),
        resolution_(stated_.length),
        geometry_(hull, scene.frame().center, rounding_) {}
  HullVerification run();

 private:
  void check_bounds();
  void check_structure();
  void check_contact(const HullDocument::Contact& c, const dvec3& n, double bound);
  void check_height(double length, double bound);
  void check_facet(const HullDocument::Face& facet);
  void check_side(const HullDocument::Face& facet, std::size_t k);
  void check_geometry();
  void check_faces();
  void check_support(const std::vector<SupportClaim>& claims);
  void check_even_directions(const Coverage& coverage,
                             const std::optional<DocumentMeasures>& measures);
  void check_points();

  /// Of what may be stated.
  double largest_bound() const {
    return deepest_bound * (resolution_ > 0 ? resolution_ : coarsest_resolution * diagonal_);
  }
  /// In every direction some point of the boundary is no farther below the supporting plane.
  double promised_length() const {
    double length = std::max((same_point + rounding_) * diagonal_, resolution_);
    for (const HullDocument::Face& face : hull_.faces) raise(length, face.tolerant);
    return length;
  }
  /// For what is a part of the step.
  VerifyOptions part(double begin, double end) const {
    VerifyOptions own = options_;
    own.progress = options_.progress.part(begin, end);
    return own;
  }
  double relative(double length) const {
    return std::abs(length) / (diagonal_ > 0 ? diagonal_ : 1);
  }

  const HullDocument& hull_;
  const Scene& scene_;
  const VerifyOptions& options_;
  double diagonal_;
  double rounding_;
  StatedResolution stated_;
  double resolution_;
  DocumentGeometry geometry_;
  HullVerification result_;
  HullFaults faults_;
};

HullVerification HullVerifier::run() {
  result_.rounding = rounding_;
  if (!FiniteNumbers().all(hull_)) faults_.add("numbers", "a number is not finite");
  const bool finite = faults_.list().empty();
  check_bounds();
  check_structure();
  const bool same = check_sources(hull_, scene_, faults_, result_.off_model);
  if (finite) check_geometry();
  options_.progress.update("verify", geometry_share);
  result_.comparable = finite && same;
  if (result_.comparable) {
    check_faces();
  } else {
    check_support(listed_claims(geometry_));
    check_report(hull_, std::nullopt, rounding_, faults_);
  }
  result_.faults = faults_.list();
  return result_;
}

/// What all else is held to must not be stated at will.
void HullVerifier::check_bounds() {
  for (std::size_t f = 0; f < hull_.faces.size(); ++f) {
    const double bound = hull_.faces[f].tolerant;
    if (0 <= bound && bound <= largest_bound()) continue;
    faults_.add("bounds", "faces[" + std::to_string(f) +
                              "]: its places are too far below the supporting planes");
  }
}

void HullVerifier::check_structure() {
  if (hull_.dimension < 2) {
    result_.complete = result_.closed = true;
    result_.euler = 2;
    return;
  }
  const HullStructure structure = hull_structure(hull_, (same_point + rounding_) * diagonal_);
  result_.complete = structure.complete;
  result_.closed = structure.closed;
  result_.euler = structure.euler;
}

/// How far a source rises that begins with a slope, over a parameter up to 1.
double height(double slope, double curvature) {
  if (!(slope > 0)) return 0;
  return slope < -curvature ? -0.5 * slope * slope / curvature : slope;
}

/// How steeply a source rises over a plane at one of its places, as derivative over a whole Bezier
/// patch or curve: where that ends it may fall off. What is nearer than the resolution is one: by
/// as much as slopes change over it, by second derivatives, they are none. Only the height counts
/// at its ends, where it may join others with a kink, and of a model whose numbers are rounded.
double rise(const SourceJet& jet, const dvec2& t, const dvec3& n,
            const StatedResolution& resolution) {
  const std::array<std::array<dvec3, 2>, 2> ddx = {{{jet.dxx, jet.dxy}, {jet.dxy, jet.dyy}}};
  double steepest = 0;
  for (std::size_t k = 0; k < to_size(jet.dimension); ++k) {
    const double slope = glm::dot(jet.dx[k], n);
    double changed = 0;
    for (std::size_t j = 0; j < to_size(jet.dimension); ++j) {
      const double speed = glm::length(jet.dx[j]);
      if (!(speed > resolution.length)) continue;
      changed += resolution.length / speed * std::abs(glm::dot(ddx[k][j], n));
    }
    const double at = t[int(k)];
    const bool may_kink = resolution.is_of_model || at == 0 || at == 1;
    const double bend = may_kink ? glm::dot(ddx[k][k], n) : 0;
    if (at < 1) raise(steepest, height(slope - changed, bend));
    if (at > 0) raise(steepest, height(-slope - changed, bend));
  }
  return steepest;
}

/// The contact is on one of its patches, and none that meet there rises, where it is told to
/// support exactly: what is within a bound below the supporting plane need not be tangent.
void HullVerifier::check_contact(const HullDocument::Contact& c, const dvec3& n, double bound) {
  const std::vector<SourcePlace> places = geometry_.places(c);
  std::vector<double> off;
  off.reserve(places.size());
  for (const SourcePlace& place : places) {
    const dvec3 x = geometry_.jet(c.source, place).x;
    off.push_back(relative(glm::distance(x, geometry_.local(c.p))));
  }
  const double least = off.empty() ? infinity : *std::min_element(off.begin(), off.end());
  raise(result_.off_source, std::max(least - relative(bound), 0.0));
  if (bound > 0) return;
  for (std::size_t i = 0; i < places.size(); ++i) {
    // Patches that are no neighbours may have these parameters too.
    if (off[i] > least + geometry_.noise()) continue;
    const SourceJet jet = geometry_.jet(c.source, places[i]);
    raise(result_.tangency, relative(rise(jet, places[i].t, n, stated_)));
  }
}

/// What is not flat is so by no more than the bound that is stated.
void HullVerifier::check_height(double length, double bound) {
  raise(result_.flatness, relative(std::max(std::abs(length) - bound, 0.0)));
}

/// The side runs from its contact to the next one and in the facet's plane.
void HullVerifier::check_side(const HullDocument::Face& facet, std::size_t k) {
  constexpr int parts = 4;
  const HullDocument::Side& side = facet.sides[k];
  if (side.source < 0) return;
  for (int i = 0; i <= parts; ++i) {
    HullDocument::Contact c = {side.source, {}, dvec3(0.0)};
    for (std::size_t p = 0; p < side.from.size(); ++p) {
      c.uv.push_back(Interval{side.from[p], side.to[p]}.at(double(i) / parts));
    }
    const std::vector<SourcePlace> found = geometry_.places(c);
    if (found.empty()) {
      raise(result_.off_source, infinity);
      return;
    }
    const dvec3 x = geometry_.jet(c.source, found.front()).x;
    const double offset = facet.offset - glm::dot(geometry_.origin(), facet.normal);
    check_height(glm::dot(x, facet.normal) - offset, facet.tolerant);
    if (i > 0 && i < parts) continue;
    const std::size_t end = (k + (i == 0 ? 0 : 1)) % facet.contacts.size();
    const double off = glm::distance(x, geometry_.local(facet.contacts[end].p));
    raise(result_.off_source, relative(std::max(off - facet.tolerant, 0.0)));
  }
}

void HullVerifier::check_facet(const HullDocument::Face& face) {
  raise(result_.tangency, std::abs(glm::length(face.normal) - 1));
  const double offset = face.offset - glm::dot(geometry_.origin(), face.normal);
  const auto height = [&](const dvec3& p) {
    return glm::dot(geometry_.local(p), face.normal) - offset;
  };
  for (const HullDocument::Contact& c : face.contacts) {
    check_contact(c, face.normal, face.tolerant);
    check_height(height(c.p), face.tolerant);
  }
  const std::size_t sides = std::min(face.sides.size(), face.contacts.size());
  for (std::size_t k = 0; k < sides; ++k) check_side(face, k);
  for (const dvec3& p : face.boundary) check_height(height(p), face.tolerant);
  for (const auto& [c, sense] : face.outline) {
    const HullDocument::Curve& curve = hull_.curves[to_size(c)];
    for (const dvec3& p : curve.points) check_height(height(p), bound_of(hull_, curve));
  }
}

void HullVerifier::check_geometry() {
  for (const HullDocument::Face& face : hull_.faces) {
    for (const HullDocument::Ruling& r : face.rulings) {
      raise(result_.tangency, std::abs(glm::length(r.n) - 1));
      check_contact(r.a, r.n, face.tolerant);
      check_contact(r.b, r.n, face.tolerant);
      check_height(glm::dot(r.a.p - r.b.p, r.n), face.tolerant);
    }
    if (face.kind == FaceKind::facet) check_facet(face);
  }
}

/// What needs the model's sources to be the document's.
void HullVerifier::check_faces() {
  const DocumentOutlines outlines(geometry_);
  std::vector<SupportClaim> claims = listed_claims(geometry_);
  const std::vector<SupportClaim> between = claims_between(geometry_, outlines);
  claims.insert(claims.end(), between.begin(), between.end());
  check_support(claims);
  std::optional<DocumentMeasures> measures;
  if (hull_.dimension >= 2) {
    const double tolerance = (same_point + rounding_) * diagonal_;
    raise(result_.off_outline,
          relative(check_outlines(geometry_, outlines, tolerance, resolution_, faults_)));
    check_labels(geometry_, scene_, resolution_, faults_);
  }
  if (hull_.dimension >= 2) {
    measures = measure(geometry_, outlines, part(claimed_share, measured_share));
    raise(result_.measures_error, measures->error());
  }
  if (hull_.dimension == 3) {
    raise(result_.vector_area,
          std::max(glm::length(measures->vector_area) - measures->vector_area_bound, 0.0) /
              measures->area);
    raise(result_.vector_area_error, measures->vector_area_error);
    // What is flat to within the resolution may enclose no more than that over its area.
    const bool is_flat = std::abs(measures->volume) < resolution_ * measures->area;
    if (!(measures->volume > 0) && !is_flat) {
      faults_.add("measures", "the faces enclose nothing");
    }
    const Coverage coverage(geometry_, outlines, scene_, promised_length());
    raise(result_.patch_outside, check_patches(geometry_, outlines, coverage, scene_, resolution_,
                                               part(measured_share, patches_share), faults_));
    check_even_directions(coverage, measures);
  } else {
    check_points();
  }
  check_report(hull_, measures, rounding_, faults_);
}

void HullVerifier::check_support(const std::vector<SupportClaim>& claims) {
  const SupportGaps gaps = support_gaps(claims, scene_, part(geometry_share, claimed_share));
  raise(result_.model_outside, relative(gaps.above));
  raise(result_.hull_outside, relative(gaps.below));
  result_.directions += int(claims.size());
}

void HullVerifier::check_even_directions(const Coverage& coverage,
                                         const std::optional<DocumentMeasures>& measures) {
  const std::vector<dvec3> directions = even_directions(options_.random_directions, options_.seed);
  std::vector<double> h(directions.size(), 0);
  std::vector<char> missed(directions.size(), 0);
  constexpr std::size_t grain = 64;
  parallel_for(directions.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    SupportQuery query(scene_, options_.progress.stop);
    for (std::size_t i = begin; i < end; ++i) {
      const Support s = query(directions[i]);
      h[i] = s.h;
      missed[i] = coverage.covers(directions[i], s.contact) ? 0 : 1;
    }
  });
  result_.uncovered = int(std::count(missed.begin(), missed.end(), 1));
  result_.directions += int(directions.size());
  if (directions.empty() || !measures) return;
  result_.mean_width_accuracy = mean_width_spread / double(directions.size());
  double sum = 0;
  for (const double one : h) sum += one;
  const double width = 2 * scene_.frame().length_to_model(sum / double(directions.size()));
  const auto miss = [&](double found) { return std::abs(found / width - 1); };
  raise(result_.mean_width_error, miss(measures->mean_width) - measures->mean_width_error);
  if (const auto stated = stated_mean_width(hull_)) raise(result_.mean_width_error, miss(*stated));
}

/// A hull of lower dimension reaches as far as its points, which a polyhedral one lists, as a
/// segment does and a point; another planar one as far as its outline. What has no faces that state
/// a bound is within that of the whole.
void HullVerifier::check_points() {
  if (hull_.dimension == 2 && !scene_.model().polyhedral()) {
    check_support(outline_claims(geometry_, outline_directions, options_));
    return;
  }
  const double bound = hull_.faces.empty() ? stated_gap(hull_) : 0;
  if (bound > largest_bound()) faults_.add("bounds", "the model may be too far off");
  std::vector<dvec3> points;
  for (const HullDocument::Curve& curve : hull_.curves) {
    points.insert(points.end(), curve.points.begin(), curve.points.end());
  }
  if (hull_.curves.empty()) {
    for (const HullDocument::Source& source : hull_.sources) {
      for (const HullDocument::Patch& p : source.patches) points.emplace_back(p.points[0]);
    }
  }
  std::vector<SupportClaim> claims;
  for (const dvec3& n : even_directions(options_.random_directions, options_.seed)) {
    SupportClaim claim{n, -infinity, bound};
    for (const dvec3& p : points) claim.h = std::max(claim.h, glm::dot(geometry_.local(p), n));
    claims.push_back(claim);
  }
  check_support(claims);
}

}  // namespace

double HullVerification::worst_length() const {
  return std::max({off_model, tangency, flatness, off_source, off_outline, model_outside,
                   hull_outside, patch_outside});
}

bool HullVerification::closes_up(double relative) const {
  return vector_area <= std::max(relative, measure_accuracy) + rounding + vector_area_error;
}

bool HullVerification::has_width(double relative) const {
  return mean_width_error <= std::max(relative, mean_width_accuracy);
}

bool HullVerification::is_hull(double relative) const {
  return comparable && complete && closed && topological_sphere() && uncovered == 0 &&
         faults.empty() && closes_up(relative) && has_width(relative) &&
         worst_length() <= relative + rounding;
}

HullVerification verify(const HullDocument& hull, const Scene& scene,
                        const VerifyOptions& options) {
  return HullVerifier(hull, scene, options).run();
}

}  // namespace taut
