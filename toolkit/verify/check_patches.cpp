#include "taut/verify/check_patches.h"

#include <algorithm>
#include <random>

#include "taut/bounds/support_query.h"
#include "taut/core/integers.h"
#include "taut/core/parallel.h"
#include "taut/core/tolerances.h"
#include "taut/verify/even_directions.h"
#include "taut/verify/stated_bounds.h"

namespace taut {
namespace {

/// Of a Bezier patch and of a region: cells of the grid in each direction, and random places.
constexpr int grid = 6;
constexpr int random_places = 16;

/// How far beside an outline, as a share of a Bezier patch's parameters.
constexpr double beside = 3e-3;

/// A surface's total curvature times the square of the scene's size, above which it is strictly
/// convex: points of planar, developable and nearly such faces support outside of patches.
constexpr double strict_curvature = 1e-6;

/// Even directions in which the model's support points are asked, lest places far below are.
constexpr int beacon_directions = 400;

struct Sample {
  int source = -1;
  SourcePlace place;
  int region = -1;  ///< -1: outside of all
};

/// The scene's contact at a place of the document. @pre the document's sources are the model's
Contact scene_contact(const DocumentGeometry& geometry, const Scene& scene, int source,
                      const SourcePlace& place) {
  const Model& model = scene.model();
  const Source own = model.source(geometry.source(source).id);
  const Part& part = model.parts()[to_size(model.instances()[to_size(own.instance)].part)];
  int element = own.index;
  if (own.kind == SourceKind::face) element = part.faces()[to_size(own.index)].first_patch;
  if (own.kind == SourceKind::edge) element = part.edges()[to_size(own.index)].first_piece;
  if (own.kind != SourceKind::vertex) element += place.patch;
  return {own.instance, own.kind, element, place.t.x, place.t.y};
}

/// Checks one document.
class PatchCheck {
 public:
  PatchCheck(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
             const Coverage& coverage, const Scene& scene, double resolution,
             const VerifyOptions& options, HullFaults& faults)
      : geometry_(geometry),
        outlines_(outlines),
        coverage_(coverage),
        scene_(scene),
        resolution_(resolution),
        options_(options),
        faults_(faults),
        random_(options.seed) {}
  double run();

 private:
  void add_samples();
  void add_box(int source, int patch, const dvec2& lower, const dvec2& upper);
  bool is_whole(int source, const RegionOutline& outline) const;
  void add_beside(const RegionOutline& outline);
  void add(int source, int patch, const dvec2& uv);
  void find_beacons();
  bool is_below_beacons(const dvec3& x, const dvec3& n) const;
  double gap(SupportQuery& query, const Sample& sample, int sign) const;
  double gap_inside(SupportQuery& query, const Sample& sample) const;
  double gap_outside(SupportQuery& query, const Sample& sample) const;
  bool is_nearly_ruled(const Sample& sample) const;
  bool strictly_convex(const SourceJet& j, const dvec3& n) const;
  std::string name(const Sample& sample) const;
  dvec3 point(const Sample& sample) const {
    return geometry_.jet(sample.source, sample.place).x + geometry_.origin();
  }

  const DocumentGeometry& geometry_;
  const DocumentOutlines& outlines_;
  const Coverage& coverage_;
  const Scene& scene_;
  double resolution_;
  const VerifyOptions& options_;
  HullFaults& faults_;
  std::mt19937_64 random_;
  std::vector<Sample> samples_;
  std::vector<dvec3> beacons_;  ///< points of the model, relative to the document's origin
};

void PatchCheck::add(int source, int patch, const dvec2& uv) {
  const std::vector<Interval>& domain = geometry_.source(source).patches[to_size(patch)].domain;
  Sample sample{source, {patch, dvec2(0.0)}, -1};
  for (int k = 0; k < 2; ++k) {
    const Interval& interval = domain[to_size(k)];
    sample.place.t[k] = (uv[k] - interval.lower) / (interval.upper - interval.lower);
    if (!(0 < sample.place.t[k] && sample.place.t[k] < 1)) return;
  }
  for (const int i : outlines_.regions_of(source)) {
    const RegionOutline& region = outlines_.regions()[to_size(i)];
    if (region.region->patch != patch) continue;
    const RegionOutline::Location location = region.locate(uv);
    if (location.near) return;
    if (location.winding == 0) continue;
    if (location.winding != 1 || sample.region >= 0) {
      return faults_.add("regions", name(sample) +
                                        " lies in more than one region or on the wrong "
                                        "side of an outline");
    }
    sample.region = i;
  }
  samples_.push_back(sample);
}

std::string PatchCheck::name(const Sample& sample) const {
  const dvec2 uv = geometry_.parameters(sample.source, sample.place);
  return "sources[" + std::to_string(sample.source) + "] at (" + std::to_string(uv.x) + ", " +
         std::to_string(uv.y) + ")";
}

void PatchCheck::add_box(int source, int patch, const dvec2& lower, const dvec2& upper) {
  for (int i = 0; i < grid; ++i) {
    for (int k = 0; k < grid; ++k) {
      add(source, patch, lower + (upper - lower) * dvec2((i + 0.5) / grid, (k + 0.5) / grid));
    }
  }
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < random_places; ++i) {
    const double u = uniform(random_);
    add(source, patch, lower + (upper - lower) * dvec2(u, uniform(random_)));
  }
}

/// The box about the outline is the patch's domain.
bool PatchCheck::is_whole(int source, const RegionOutline& outline) const {
  const std::vector<Interval>& domain =
      geometry_.source(source).patches[to_size(outline.region->patch)].domain;
  return outline.lower() == dvec2(domain[0].lower, domain[1].lower) &&
         outline.upper() == dvec2(domain[0].upper, domain[1].upper);
}

void PatchCheck::add_beside(const RegionOutline& outline) {
  const int source = geometry_.hull().faces[to_size(outline.face)].source;
  const std::vector<Interval>& domain =
      geometry_.source(source).patches[to_size(outline.region->patch)].domain;
  const dvec2 size(domain[0].upper - domain[0].lower, domain[1].upper - domain[1].lower);
  for (const std::vector<OutlineStretch>& loop : outline.loops) {
    for (const OutlineStretch& stretch : loop) {
      const dvec2 along = (stretch.to - stretch.from) / size;
      const double length = glm::length(along);
      if (!(length > 0)) continue;
      const dvec2 across = size * dvec2(-along.y, along.x) * (beside / length);
      const dvec2 middle = 0.5 * (stretch.from + stretch.to);
      for (const double side : {-1.0, 1.0}) {
        add(source, outline.region->patch, middle + side * across);
      }
    }
  }
}

void PatchCheck::add_samples() {
  const HullDocument& hull = geometry_.hull();
  for (int s = 0; s < int(hull.sources.size()); ++s) {
    if (hull.sources[to_size(s)].kind != SourceKind::face) continue;
    const std::vector<HullDocument::Patch>& patches = hull.sources[to_size(s)].patches;
    for (int i = 0; i < int(patches.size()); ++i) {
      const std::vector<Interval>& domain = patches[to_size(i)].domain;
      add_box(s, i, {domain[0].lower, domain[1].lower}, {domain[0].upper, domain[1].upper});
    }
  }
  for (const RegionOutline& region : outlines_.regions()) {
    const int source = hull.faces[to_size(region.face)].source;
    const int patch = region.region->patch;
    if (!(region.area() > 0)) {
      faults_.add("regions", "faces[" + std::to_string(region.face) +
                                 "]: a region lies to the right of its outline");
    }
    // The places of a whole patch are there.
    if (!is_whole(source, region)) add_box(source, patch, region.lower(), region.upper());
    add_beside(region);
  }
}

/// By how much the scene reaches farther than the place in the direction of its normal.
double PatchCheck::gap(SupportQuery& query, const Sample& sample, int sign) const {
  const dvec3 n = unit(geometry_.normal(sample.source, sample.place, sign));
  if (n == dvec3(0.0)) return 0;
  const SourceJet j = geometry_.jet(sample.source, sample.place);
  const Contact hint = scene_contact(geometry_, scene_, sample.source, sample.place);
  const SceneFrame& frame = scene_.frame();
  const double h = frame.length_to_model(query(n, hint).h);
  return (h - glm::dot(j.x + (geometry_.origin() - frame.center), n)) / scene_.diagonal();
}

bool PatchCheck::is_nearly_ruled(const Sample& sample) const {
  const Contact c = scene_contact(geometry_, scene_, sample.source, sample.place);
  if (c.kind != SourceKind::face) return false;
  const Model& model = scene_.model();
  const Part& part = model.parts()[to_size(model.instances()[to_size(c.instance)].part)];
  return part.patches()[to_size(c.element)].lines(resolution_).any();
}

bool PatchCheck::strictly_convex(const SourceJet& j, const dvec3& n) const {
  const double L = -glm::dot(j.dxx, n);
  const double M = -glm::dot(j.dxy, n);
  const double N = -glm::dot(j.dyy, n);
  const dvec3 area = glm::cross(j.dx[0], j.dx[1]);
  const double size = scene_.diagonal() * scene_.diagonal();
  return L > 0 && (L * N - M * M) * size > strict_curvature * glm::dot(area, area);
}

void PatchCheck::find_beacons() {
  SupportQuery query(scene_, options_.progress.stop);
  for (const dvec3& n : even_directions(beacon_directions, options_.seed)) {
    const Contact contact = query(n).contact;
    beacons_.push_back(geometry_.local(scene_.point(contact)));
  }
}

/// By more than what counts as on the hull.
bool PatchCheck::is_below_beacons(const dvec3& x, const dvec3& n) const {
  const double least = glm::dot(x, n) + 2 * support_slack * scene_.diagonal();
  return std::any_of(beacons_.begin(), beacons_.end(),
                     [&](const dvec3& p) { return glm::dot(p, n) > least; });
}

double PatchCheck::gap_inside(SupportQuery& query, const Sample& sample) const {
  return gap(query, sample, outlines_.regions()[to_size(sample.region)].region->sign);
}

/// The smaller gap of both sides, or any that is not on the hull.
double PatchCheck::gap_outside(SupportQuery& query, const Sample& sample) const {
  double least = 1;
  if (is_nearly_ruled(sample)) return least;
  const SourceJet j = geometry_.jet(sample.source, sample.place);
  for (const int sign : {-1, 1}) {
    const dvec3 n = geometry_.normal(sample.source, sample.place, sign);
    if (!strictly_convex(j, n) || is_below_beacons(j.x, unit(n))) continue;
    least = std::min(least, gap(query, sample, sign));
  }
  return least;
}

double PatchCheck::run() {
  add_samples();
  find_beacons();
  std::vector<double> gaps(samples_.size(), 0);
  constexpr std::size_t grain = 64;
  parallel_for(
      samples_.size(), grain, options_.threads,
      [&](std::size_t begin, std::size_t end) {
        options_.progress.check();
        SupportQuery query(scene_, options_.progress.stop);
        for (std::size_t i = begin; i < end; ++i) {
          const bool is_inside = samples_[i].region >= 0;
          gaps[i] = is_inside ? gap_inside(query, samples_[i]) : gap_outside(query, samples_[i]);
        }
      },
      [&](std::size_t done) {
        options_.progress.update("verify", double(done) / double(samples_.size()));
      });
  double worst = 0;
  // Where a face beside a patch is below the supporting planes, their curve is off the true outline
  // of the patch: from there to the curve its places fall below their planes, by what the face is
  // below its own at the curve.
  const std::vector<double> bounds = bounds_beside(geometry_.hull());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (samples_[i].region >= 0) {
      const int face = outlines_.regions()[to_size(samples_[i].region)].face;
      raise(worst, gaps[i] - bounds[to_size(face)] / scene_.diagonal());
    } else if (gaps[i] <= support_slack && !coverage_.is_near(point(samples_[i]))) {
      faults_.add("regions", name(samples_[i]) + " is on the hull, but in no region");
    }
  }
  return worst;
}

}  // namespace

double check_patches(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                     const Coverage& coverage, const Scene& scene, double resolution,
                     const VerifyOptions& options, HullFaults& faults) {
  return PatchCheck(geometry, outlines, coverage, scene, resolution, options, faults).run();
}

}  // namespace taut
