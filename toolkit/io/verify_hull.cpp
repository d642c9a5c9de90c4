#include "taut/io/verify_hull.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "taut/bounds/support_query.h"
#include "taut/core/parallel.h"
#include "taut/core/tolerances.h"
#include "taut/io/hull_structure.h"
#include "taut/surface/bezier.h"

namespace taut {
namespace {

/// Ends of curves closer than this fraction of the diagonal are one: curves meet in the same points
/// but for the rounding of two computations, and that of their coordinates.
constexpr double same_point = 1e-9;

/// How far, as a share of a Bezier patch's parameters, a contact may lie beside the polygon of a
/// region's outline: outlines are smooth between points whose normals differ by up to 0.1.
constexpr double outline_slack = 0.02;

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

/// A point of a source and its derivatives over a whole Bezier patch or curve.
struct SourceJet {
  dvec3 x = dvec3(0.0);
  std::array<dvec3, 2> dx = {dvec3(0.0), dvec3(0.0)};
};

/// A region with a box of the parameters that count as its own.
struct RegionBox {
  const HullDocument::Region* region = nullptr;
  dvec2 slack, lower, upper;
};

/// Checks one document.
class HullVerifier {
 public:
  HullVerifier(const HullDocument& hull, const Scene& scene, const VerifyOptions& options);
  HullVerification run();

 private:
  std::vector<SourceJet> jets(const HullDocument::Contact& c) const;
  void check_contact(const HullDocument::Contact& c, const dvec3& n);
  void check_side(const HullDocument::Face& facet, std::size_t k);
  void check_geometry();
  void check_support();
  void check_cover();
  void list_regions();
  bool covers(const Contact& contact) const;
  bool covers(int source, const dvec2& uv) const;

  double relative(double length) const {
    return std::abs(length) / (diagonal_ > 0 ? diagonal_ : 1);
  }
  /// A length that is no number is as bad as can be.
  static void raise(double& worst, double value) {
    worst = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(worst, value);
  }

  const HullDocument& hull_;
  const Scene& scene_;
  const VerifyOptions& options_;
  double diagonal_;
  /// As homogeneous control nets.
  std::vector<std::vector<BezierPatch>> nets_;
  std::map<int, int> place_of_source_;
  std::vector<std::vector<RegionBox>> regions_of_;  ///< per source
  HullVerification result_;
};

HullVerifier::HullVerifier(const HullDocument& hull, const Scene& scene,
                           const VerifyOptions& options)
    : hull_(hull), scene_(scene), options_(options), diagonal_(scene.diagonal()) {
  for (std::size_t i = 0; i < hull.sources.size(); ++i) {
    place_of_source_[hull.sources[i].id] = int(i);
    std::vector<BezierPatch>& nets = nets_.emplace_back();
    for (const HullDocument::Patch& patch : hull.sources[i].patches) {
      BezierPatch& net = nets.emplace_back();
      net.degree_u = patch.rows - 1;
      net.degree_v = patch.columns - 1;
      for (const dvec4& p : patch.points) net.points.push_back(homogeneous(dvec3(p), p.w));
    }
  }
}

HullVerification HullVerifier::run() {
  if (hull_.dimension >= 2) {
    const Box& box = scene_.box();
    const dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    const double rounding = coordinate_rounding * (reach.x + reach.y + reach.z);
    const HullStructure structure = hull_structure(hull_, same_point * diagonal_ + rounding);
    result_.complete = structure.complete;
    result_.closed = structure.closed;
    result_.euler = structure.euler;
  } else {
    result_.complete = result_.closed = true;
    result_.euler = 2;
  }
  check_geometry();
  options_.progress.update("verify", 0.1);
  check_support();
  options_.progress.update("verify", 0.8);
  if (hull_.dimension == 3) check_cover();
  return result_;
}

/// By each of the source's patches that has the contact's parameters: several where they meet.
std::vector<SourceJet> HullVerifier::jets(const HullDocument::Contact& c) const {
  const HullDocument::Source& source = hull_.sources[to_size(c.source)];
  std::vector<SourceJet> found;
  for (std::size_t i = 0; i < source.patches.size(); ++i) {
    const HullDocument::Patch& patch = source.patches[i];
    std::array<double, 2> t = {0, 0};
    bool inside = true;
    for (std::size_t k = 0; k < patch.domain.size(); ++k) {
      const Interval& interval = patch.domain[k];
      t[k] = (c.uv[k] - interval.lower) / (interval.upper - interval.lower);
      if (c.uv[k] == interval.upper) t[k] = 1;
      inside = inside && 0 <= t[k] && t[k] <= 1;
    }
    if (!inside) continue;
    const BezierPatch& net = nets_[to_size(c.source)][i];
    if (source.kind == SourceKind::vertex) {
      found.push_back({dvec3(patch.points[0]), {}});
    } else if (source.kind == SourceKind::edge) {
      const CurveJet j = taut::jet(BezierCurve{net.points}, t[0]);
      found.push_back({j.c, {j.ct, dvec3(0.0)}});
    } else {
      const PatchJet1 j = jet1(net, t[0], t[1]);
      found.push_back({j.S, {j.Su, j.Sv}});
    }
  }
  return found;
}

/// The contact is on one of its patches, and tangent there.
void HullVerifier::check_contact(const HullDocument::Contact& c, const dvec3& n) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double off = infinity;
  double slope = 0;
  for (const SourceJet& jet : jets(c)) {
    const double off_here = relative(glm::distance(jet.x, c.p));
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
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const HullDocument::Side& side = facet.sides[k];
  if (side.source < 0) return;
  for (int i = 0; i <= parts; ++i) {
    HullDocument::Contact c = {side.source, {}, dvec3(0.0)};
    for (std::size_t p = 0; p < side.from.size(); ++p) {
      c.uv.push_back(Interval{side.from[p], side.to[p]}.at(double(i) / parts));
    }
    const std::vector<SourceJet> found = jets(c);
    if (found.empty()) {
      raise(result_.off_source, infinity);
      return;
    }
    const dvec3& x = found[0].x;
    raise(result_.flatness, relative(glm::dot(x, facet.normal) - facet.offset));
    if (i > 0 && i < parts) continue;
    const std::size_t end = (k + (i == 0 ? 0 : 1)) % facet.contacts.size();
    raise(result_.off_source, relative(glm::distance(x, facet.contacts[end].p)));
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
    for (const HullDocument::Contact& c : face.contacts) {
      check_contact(c, face.normal);
      raise(result_.flatness, relative(glm::dot(c.p, face.normal) - face.offset));
    }
    for (std::size_t k = 0; k < face.sides.size(); ++k) check_side(face, k);
    for (const dvec3& p : face.boundary) {
      raise(result_.flatness, relative(glm::dot(p, face.normal) - face.offset));
    }
  }
}

void HullVerifier::check_support() {
  struct Claim {
    dvec3 n;
    double h;  ///< about the scene's centre, in model units
  };
  std::vector<Claim> claims;
  const SceneFrame& frame = scene_.frame();
  for (const HullDocument::Face& face : hull_.faces) {
    for (const HullDocument::Ruling& r : face.rulings) {
      const dvec3 n = unit(r.n);
      raise(result_.tangency, std::abs(glm::length(r.n) - 1));
      for (const dvec3& p : {r.a.p, r.b.p}) claims.push_back({n, glm::dot(p - frame.center, n)});
    }
    if (face.kind != FaceKind::facet) continue;
    raise(result_.tangency, std::abs(glm::length(face.normal) - 1));
    claims.push_back({unit(face.normal), face.offset - glm::dot(face.normal, frame.center)});
  }
  std::vector<double> gap(claims.size());
  constexpr std::size_t grain = 64;
  parallel_for(claims.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    SupportQuery query(scene_);
    Contact near;
    for (std::size_t i = begin; i < end; ++i) {
      if (claims[i].n == dvec3(0.0)) {
        gap[i] = std::numeric_limits<double>::infinity();
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

/// Whether the point lies in the polygon, by the parity of crossings, or within the slack of it.
bool near_polygon(const std::vector<std::vector<dvec2>>& loops, const dvec2& p,
                  const dvec2& slack) {
  bool inside = false;
  for (const std::vector<dvec2>& loop : loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const dvec2 a = loop[k];
      const dvec2 b = loop[(k + 1) % loop.size()];
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) {
        inside = !inside;
      }
      const dvec2 side = (b - a) / slack;
      const dvec2 from = (p - a) / slack;
      const double length = glm::dot(side, side);
      const double s = length > 0 ? std::clamp(glm::dot(from, side) / length, 0.0, 1.0) : 0;
      if (glm::length(from - s * side) <= 1) return true;
    }
  }
  return inside;
}

/// On an edge or vertex that the document names, or on a patch, be it at its border.
bool HullVerifier::covers(const Contact& contact) const {
  const SourceContact c = scene_.source(contact);
  if (c.kind != SourceKind::face && place_of_source_.contains(c.source)) return true;
  if (contact.kind != SourceKind::face) return false;
  const Model& model = scene_.model();
  const Part& part = model.parts()[to_size(model.instances()[to_size(contact.instance)].part)];
  const Patch& patch = part.patches()[to_size(contact.element)];
  return covers(model.source_id({SourceKind::face, contact.instance, patch.face}),
                {patch.u.at(contact.u), patch.v.at(contact.v)});
}

bool HullVerifier::covers(int id, const dvec2& uv) const {
  const auto place = place_of_source_.find(id);
  if (place == place_of_source_.end()) return false;
  const std::vector<RegionBox>& regions = regions_of_[to_size(place->second)];
  return std::any_of(regions.begin(), regions.end(), [&](const RegionBox& box) {
    return glm::all(glm::lessThanEqual(box.lower, uv)) &&
           glm::all(glm::lessThanEqual(uv, box.upper)) &&
           near_polygon(box.region->loops, uv, box.slack);
  });
}

void HullVerifier::list_regions() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  regions_of_.resize(hull_.sources.size());
  for (const HullDocument::Face& face : hull_.faces) {
    for (const HullDocument::Region& region : face.regions) {
      const std::vector<Interval>& domain =
          hull_.sources[to_size(face.source)].patches[to_size(region.patch)].domain;
      RegionBox box{&region,
                    outline_slack *
                        dvec2(domain[0].upper - domain[0].lower, domain[1].upper - domain[1].lower),
                    dvec2(infinity), dvec2(-infinity)};
      for (const std::vector<dvec2>& loop : region.loops) {
        for (const dvec2& p : loop) {
          box.lower = glm::min(box.lower, p - box.slack);
          box.upper = glm::max(box.upper, p + box.slack);
        }
      }
      regions_of_[to_size(face.source)].push_back(box);
    }
  }
}

void HullVerifier::check_cover() {
  list_regions();
  std::mt19937_64 random(options_.seed);
  std::normal_distribution<double> gaussian;
  std::vector<dvec3> directions;
  for (int k = 0; k < options_.random_directions; ++k) {
    const double x = gaussian(random);
    const double y = gaussian(random);
    const dvec3 n = unit({x, y, gaussian(random)});
    if (n != dvec3(0.0)) directions.push_back(n);
  }
  std::vector<char> missed(directions.size(), 0);
  constexpr std::size_t grain = 64;
  parallel_for(directions.size(), grain, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    SupportQuery query(scene_);
    for (std::size_t i = begin; i < end; ++i) {
      missed[i] = covers(query(directions[i]).contact) ? 0 : 1;
    }
  });
  result_.uncovered = int(std::count(missed.begin(), missed.end(), 1));
  result_.directions += int(directions.size());
}

}  // namespace

HullVerification verify(const HullDocument& hull, const Scene& scene,
                        const VerifyOptions& options) {
  return HullVerifier(hull, scene, options).run();
}

}  // namespace taut
