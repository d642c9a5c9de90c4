#include "taut/verify/verify_hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>

#include "taut/bounds/support_query.h"
#include "taut/core/integers.h"
#include "taut/core/parallel.h"
#include "taut/core/tolerances.h"
#include "taut/verify/check_labels.h"
#include "taut/verify/check_outlines.h"
#include "taut/verify/check_patches.h"
#include "taut/verify/check_report.h"
#include "taut/verify/check_sources.h"
#include "taut/verify/hull_structure.h"
#include "taut/verify/nearest_point.h"

namespace taut {
namespace {

/// Ends of curves closer than this fraction of the diagonal are one: curves meet in the same points
/// but for the rounding of two computations, and that of their coordinates.
constexpr double same_point = 1e-9;

/// Relative error of the mean width by support queries, times their number: that of the lattice is
/// below a tenth of this even of polyhedra, whose support functions have kinks.
constexpr double mean_width_spread = 1;

/// A direction with the support value that the document claims for it, about the scene's centre.
struct Claim {
  dvec3 n = dvec3(0.0);
  double h = 0;
};

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
    see(face.normal);
    see(face.offset);
    see(face.contacts);
    see(face.boundary);
  }
  return finite_;
}

/// Directions spread evenly (spherical Fibonacci lattice: Swinbank and Purser 2006), turned at
/// random.
std::vector<dvec3> even_directions(int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gaussian;
  const auto vector = [&] {
    const double x = gaussian(random);
    const double y = gaussian(random);
    return dvec3(x, y, gaussian(random));
  };
  const dvec3 z = unit(vector());
  const dvec3 x = unit(glm::cross(z, vector()));
  const dvec3 y = glm::cross(z, x);
  std::vector<dvec3> directions;
  directions.reserve(to_size(std::max(count, 0)));
  for (int k = 0; k < count; ++k) {
    const double height = 1 - (2 * k + 1.0) / count;
    const double radius = std::sqrt(1 - height * height);
    const double angle = 2 * std::numbers::pi * std::fmod(k * std::numbers::phi, 1.0);
    directions.push_back(unit(radius * (std::cos(angle) * x + std::sin(angle) * y) + height * z));
  }
  return directions;
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
        geometry_(hull, scene.frame().center, rounding_) {}
  HullVerification run();

 private:
  void check_structure();
  void check_contact(const HullDocument::Contact& c, const dvec3& n);
  void check_side(const HullDocument::Face& facet, std::size_t k);
  void check_geometry();
  void check_faces();
  void add_listed_claims(std::vector<Claim>& claims);
  void add_claims_between(const DocumentOutlines& outlines, std::vector<Claim>& claims) const;
  void check_support(const std::vector<Claim>& claims);
  void check_even_directions(const DocumentOutlines& outlines,
                             const std::optional<DocumentMeasures>& measures);
  void check_points();
  bool covers(const DocumentOutlines& outlines, const NearestPoint& curves,
              const Contact& contact) const;
  bool names(const DocumentOutlines& outlines, const Contact& contact) const;

  double relative(double length) const {
    return std::abs(length) / (diagonal_ > 0 ? diagonal_ : 1);
  }

  const HullDocument& hull_;
  const Scene& scene_;
  const VerifyOptions& options_;
  double diagonal_;
  double rounding_;
  DocumentGeometry geometry_;
  std::map<int, int> place_of_source_;
  HullVerification result_;
  HullFaults faults_;
};

HullVerification HullVerifier::run() {
  result_.rounding = rounding_;
  if (!FiniteNumbers().all(hull_)) faults_.add("numbers", "a number is not finite");
  check_structure();
  const bool finite = faults_.list().empty();
  const bool same = check_sources(hull_, scene_, faults_, result_.off_model);
  if (finite) check_geometry();
  options_.progress.update("verify", 0.1);
  result_.comparable = finite && same;
  if (result_.comparable) {
    check_faces();
  } else {
    std::vector<Claim> claims;
    add_listed_claims(claims);
    check_support(claims);
    check_report(hull_, std::nullopt, rounding_, faults_);
  }
  result_.faults = faults_.list();
  return result_;
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

/// The contact is on one of its patches, and tangent there.
void HullVerifier::check_contact(const HullDocument::Contact& c, const dvec3& n) {
  double off = infinity;
  double slope = 0;
  for (const SourcePlace& place : geometry_.places(c)) {
    const SourceJet jet = geometry_.jet(c.source, place);
    const double off_here = relative(glm::distance(jet.x, geometry_.local(c.p)));
    double slope_here = 0;
    for (const dvec3& d : jet.dx) raise(slope_here, relative(glm::dot(d, n)));
    if (!(off_here + slope_here < off + slope)) continue;
    off = off_here;
    slope = slope_here;
  }
  raise(result_.off_source, off);
  raise(result_.tangency, slope);
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
    raise(result_.flatness, relative(glm::dot(x, facet.normal) - offset));
    if (i > 0 && i < parts) continue;
    const std::size_t end = (k + (i == 0 ? 0 : 1)) % facet.contacts.size();
    raise(result_.off_source, relative(glm::distance(x, geometry_.local(facet.contacts[end].p))));
  }
}

void HullVerifier::check_geometry() {
  for (const HullDocument::Face& face : hull_.faces) {
    for (const HullDocument::Ruling& r : face.rulings) {
      check_contact(r.a, r.n);
      check_contact(r.b, r.n);
      raise(result_.flatness, relative(glm::dot(r.a.p - r.b.p, r.n)));
    }
    if (face.kind != FaceKind::facet) continue;
    const double offset = face.offset - glm::dot(geometry_.origin(), face.normal);
    const auto off_plane = [&](const dvec3& p) {
      return relative(glm::dot(geometry_.local(p), face.normal) - offset);
    };
    for (const HullDocument::Contact& c : face.contacts) {
      check_contact(c, face.normal);
      raise(result_.flatness, off_plane(c.p));
    }
    const std::size_t sides = std::min(face.sides.size(), face.contacts.size());
    for (std::size_t k = 0; k < sides; ++k) check_side(face, k);
    for (const dvec3& p : face.boundary) raise(result_.flatness, off_plane(p));
    for (const auto& [curve, sense] : face.outline) {
      for (const dvec3& p : hull_.curves[to_size(curve)].points) {
        raise(result_.flatness, off_plane(p));
      }
    }
  }
}

/// What needs the model's sources to be the document's.
void HullVerifier::check_faces() {
  for (std::size_t i = 0; i < hull_.sources.size(); ++i) {
    place_of_source_[hull_.sources[i].id] = int(i);
  }
  const DocumentOutlines outlines(geometry_);
  std::vector<Claim> claims;
  add_listed_claims(claims);
  add_claims_between(outlines, claims);
  check_support(claims);
  options_.progress.update("verify", 0.4);
  std::optional<DocumentMeasures> measures;
  if (hull_.dimension >= 2) {
    const double tolerance = (same_point + rounding_) * diagonal_;
    raise(result_.off_outline, relative(check_outlines(geometry_, outlines, tolerance, faults_)));
    check_labels(geometry_, scene_, faults_);
  }
  if (hull_.dimension == 3) {
    measures = measure(geometry_, outlines, options_.progress);
    raise(result_.vector_area, glm::length(measures->vector_area) / measures->area);
    raise(result_.measures_error, measures->error);
    if (!(measures->volume > 0)) faults_.add("measures", "the faces enclose nothing");
    raise(result_.patch_outside, check_patches(geometry_, outlines, scene_, options_, faults_));
    options_.progress.update("verify", 0.8);
    check_even_directions(outlines, measures);
  } else {
    check_points();
  }
  check_report(hull_, measures, rounding_, faults_);
}

void HullVerifier::add_listed_claims(std::vector<Claim>& claims) {
  const dvec3& center = scene_.frame().center;
  for (const HullDocument::Face& face : hull_.faces) {
    for (const HullDocument::Ruling& r : face.rulings) {
      const dvec3 n = unit(r.n);
      raise(result_.tangency, std::abs(glm::length(r.n) - 1));
      for (const dvec3& p : {r.a.p, r.b.p}) claims.push_back({n, glm::dot(p - center, n)});
    }
    if (face.kind != FaceKind::facet) continue;
    raise(result_.tangency, std::abs(glm::length(face.normal) - 1));
    claims.push_back({unit(face.normal), face.offset - glm::dot(face.normal, center)});
  }
}

/// Rulings between the listed ones support as well.
void HullVerifier::add_claims_between(const DocumentOutlines& outlines,
                                      std::vector<Claim>& claims) const {
  for (const std::vector<RulingInterval>& intervals : outlines.intervals()) {
    for (const RulingInterval& interval : intervals) {
      for (const RulingPanel& panel : interval.panels) {
        if (!interval.solved) break;
        // The first and the last one of the interval are listed.
        for (std::size_t i = 1; i < panel.nodes().size() && panel.nodes()[i] < 1; ++i) {
          const RulingState& state = panel.states()[i];
          for (std::size_t k = 0; k < 2; ++k) {
            const SourceJet j = geometry_.jet(interval.source[k], {interval.patch[k], state.t[k]});
            claims.push_back({state.n, glm::dot(j.x, state.n)});
          }
        }
      }
    }
  }
}

void HullVerifier::check_support(const std::vector<Claim>& claims) {
  const SceneFrame& frame = scene_.frame();
  std::vector<double> gap(claims.size());
  constexpr std::size_t grain = 64;
  parallel_for(claims.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    SupportQuery query(scene_, options_.progress.stop);
    Contact near;
    for (std::size_t i = begin; i < end; ++i) {
      if (!(glm::length(claims[i].n) > 0.5)) {
        gap[i] = infinity;
        continue;
      }
      const Support s = query(claims[i].n, near);
      near = s.contact;
      gap[i] = frame.length_to_model(s.h) - claims[i].h;
    }
  });
  for (const double g : gap) {
    raise(result_.model_outside, g > 0 ? relative(g) : std::isnan(g) ? g : 0);
    raise(result_.hull_outside, g < 0 ? relative(g) : 0);
  }
  result_.directions += int(claims.size());
}

/// On an edge or vertex that the document names, or on a patch, be it at its border; or in a point
/// of its curves, where a corner is named as the end of an edge.
bool HullVerifier::covers(const DocumentOutlines& outlines, const NearestPoint& curves,
                          const Contact& contact) const {
  if (curves.distance(scene_.point(contact)) <= (same_point + rounding_) * diagonal_) return true;
  // The document may name any of the copies in one place.
  const int instances = int(scene_.model().instances().size());
  Contact copy = contact;
  for (copy.instance = 0; copy.instance < instances; ++copy.instance) {
    const bool same =
        scene_.first_instance(copy.instance) == scene_.first_instance(contact.instance);
    if (same && names(outlines, copy)) return true;
  }
  return false;
}

/// The contact is on a source that the document names, and inside of the patch's outline there.
bool HullVerifier::names(const DocumentOutlines& outlines, const Contact& contact) const {
  const SourceContact c = scene_.source(contact);
  if (c.kind != SourceKind::face && place_of_source_.contains(c.source)) return true;
  if (contact.kind != SourceKind::face) return false;
  const Model& model = scene_.model();
  const Part& part = model.parts()[to_size(model.instances()[to_size(contact.instance)].part)];
  const Patch& patch = part.patches()[to_size(contact.element)];
  const auto place =
      place_of_source_.find(model.source_id({SourceKind::face, contact.instance, patch.face}));
  return place != place_of_source_.end() &&
         outlines.covers(place->second, {patch.u.at(contact.u), patch.v.at(contact.v)});
}

void HullVerifier::check_even_directions(const DocumentOutlines& outlines,
                                         const std::optional<DocumentMeasures>& measures) {
  const std::vector<dvec3> directions = even_directions(options_.random_directions, options_.seed);
  std::vector<double> h(directions.size(), 0);
  std::vector<char> missed(directions.size(), 0);
  std::vector<dvec3> points;
  for (const HullDocument::Curve& curve : hull_.curves) {
    points.insert(points.end(), curve.points.begin(), curve.points.end());
  }
  const NearestPoint curves(std::move(points));
  constexpr std::size_t grain = 64;
  parallel_for(directions.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    SupportQuery query(scene_, options_.progress.stop);
    for (std::size_t i = begin; i < end; ++i) {
      const Support s = query(directions[i]);
      h[i] = s.h;
      missed[i] = covers(outlines, curves, s.contact) ? 0 : 1;
    }
  });
  result_.uncovered = int(std::count(missed.begin(), missed.end(), 1));
  result_.directions += int(directions.size());
  if (directions.empty() || !measures) return;
  result_.mean_width_accuracy = mean_width_spread / double(directions.size());
  double sum = 0;
  for (const double one : h) sum += one;
  const double width = 2 * scene_.frame().length_to_model(sum / double(directions.size()));
  raise(result_.mean_width_error, std::abs(measures->mean_width / width - 1));
}

/// A hull of lower dimension reaches as far as its points, which a polyhedral one lists.
void HullVerifier::check_points() {
  if (!scene_.model().polyhedral()) return;
  std::vector<dvec3> points;
  for (const HullDocument::Curve& curve : hull_.curves) {
    points.insert(points.end(), curve.points.begin(), curve.points.end());
  }
  if (hull_.curves.empty()) {
    for (const HullDocument::Source& source : hull_.sources) {
      for (const HullDocument::Patch& p : source.patches) points.emplace_back(p.points[0]);
    }
  }
  std::vector<Claim> claims;
  for (const dvec3& n : even_directions(options_.random_directions, options_.seed)) {
    Claim claim{n, -infinity};
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
  return vector_area <= std::max(relative, measure_accuracy) + rounding + measures_error;
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
