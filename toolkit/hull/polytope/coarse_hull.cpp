#include "taut/hull/polytope/coarse_hull.h"

#include <algorithm>

#include "taut/core/tolerances.h"
#include "taut/hull/polytope/affine_span.h"
#include "taut/hull/polytope/certificate.h"
#include "taut/hull/polytope/polytope_support.h"

namespace taut {
namespace {

dvec3 normal_of(const PointHull& hull, int facet) { return unit(hull.facet(facet).side.normal()); }

/// Turned by so much, a direction in which a whole face or edge is highest has one of its corners
/// highest, by far more than noise.
constexpr double tie_break = 1e-6;

/// Along no edge, and across no face, of anything that people make.
const dvec3 skew(0.67123, 0.31798, 0.66957);

/// Grows the coarse hull from the points highest in skew directions: the point highest above each
/// facet goes in while it is above the width.
class Coarsener {
 public:
  Coarsener(const PointHull& fine, const std::array<int, 4>& spanning, const RoundingWidth& width)
      : fine_(fine), support_(fine), width_(width), result_{PointHull(box_of(fine)), {}, 0} {
    for (const dvec3& n : directions_across({})) {
      add(support_(unit(n + 0.1 * dvec3(skew.y, skew.z, skew.x) * n.x + 0.1 * skew)));
    }
    if (result_.hull.dimension() < 3) {
      for (const int p : spanning)
        add(support_(unit(skew + fine.point(p) - fine.point(spanning[0])), p));
      for (const int p : spanning) add(p);
    }
  }

  CoarseHull run(const Progress& progress) {
    while (grow()) progress.check();
    bound_distance();
    return std::move(result_);
  }

 private:
  struct Candidate {
    double height;
    int facet, point;
    std::array<int, 3> vertex;  ///< tells whether the facet has been replaced
  };

  static Box box_of(const PointHull& hull) {
    Box box;
    for (const PointHull::Facet& f : hull.facets()) {
      for (const int v : f.vertex) box.include(hull.point(v));
    }
    return box;
  }

  void add(int point) {
    result_.original.push_back(point);
    result_.hull.add({&fine_.point(point), 1});
  }
  /// One round over the facets not yet known to be final. False when none grows any more.
  bool grow();
  void bound_distance();

  const PointHull& fine_;
  PolytopeSupport support_;
  RoundingWidth width_;
  CoarseHull result_;
  std::vector<int> tops_;  ///< per facet: the point highest above it; -1: not known
};

bool Coarsener::grow() {
  PointHull& hull = result_.hull;
  tops_.resize(hull.facets().size(), -1);
  std::vector<Candidate> candidates;
  for (std::size_t f = 0; f < tops_.size(); ++f) {
    const PointHull::Facet& facet = hull.facet(int(f));
    if (!facet.alive || tops_[f] >= 0) continue;
    const dvec3 n = normal_of(hull, int(f));
    const auto height_of = [&](int p) {
      return glm::dot(fine_.point(p) - hull.point(facet.vertex[0]), n);
    };
    int top = support_(n, result_.original[std::size_t(facet.vertex[0])]);
    double height = height_of(top);
    tops_[f] = top;
    const int corner = support_(unit(n + tie_break * skew), top);
    if (height_of(corner) > std::max(width_.along(n), 0.5 * height)) {
      top = corner;
      height = height_of(corner);
    }
    if (height > width_.along(n)) candidates.push_back({height, int(f), top, facet.vertex});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.height != b.height ? a.height > b.height : a.facet < b.facet;
  });
  bool grown = false;
  for (const Candidate& c : candidates) {
    const PointHull::Facet& facet = hull.facet(c.facet);
    if (!facet.alive || facet.vertex != c.vertex) continue;
    if (!hull.insert(fine_.point(c.point), c.facet)) continue;
    result_.original.push_back(c.point);
    tops_.resize(hull.facets().size(), -1);
    for (const int f : hull.created()) tops_[std::size_t(f)] = -1;
    grown = true;
  }
  return grown;
}

/// As for sampled hulls (certificate.h). A sliver's normal is rounded far off its plane, so that
/// each of its corners has a gap of its own.
void Coarsener::bound_distance() {
  const PointHull& hull = result_.hull;
  // Differences, products and sums round by four units of lengths at most the diagonal.
  const double rounding = 8 * rounding_unit * diagonal(box_of(fine_));
  std::vector<std::vector<int>> facets(hull.points().size());
  for (std::size_t f = 0; f < tops_.size(); ++f) {
    if (!hull.facet(int(f)).alive) continue;
    for (const int v : hull.facet(int(f)).vertex) facets[std::size_t(v)].push_back(int(f));
  }
  std::vector<dvec3> normals;
  for (std::size_t v = 0; v < facets.size(); ++v) {
    const std::vector<int>& fan = facets[v];
    if (fan.empty()) continue;
    normals.clear();
    double highest = 0;
    for (const int f : fan) {
      normals.push_back(normal_of(hull, f));
      const dvec3& top = fine_.point(tops_[std::size_t(f)]);
      highest = std::max(highest, glm::dot(top - hull.point(int(v)), normals.back()));
    }
    result_.distance_bound = std::max(
        result_.distance_bound, taut::distance_bound(highest + rounding, cone_depth(normals)));
  }
}

}  // namespace

bool has_nearly_flat_edges(const PointHull& hull, const RoundingWidth& width) {
  for (std::size_t f = 0; f < hull.facets().size(); ++f) {
    const PointHull::Facet& facet = hull.facet(int(f));
    if (!facet.alive) continue;
    const dvec3 n = normal_of(hull, int(f));
    for (const int g : facet.neighbor) {
      for (const int v : hull.facet(g).vertex) {
        if (std::find(facet.vertex.begin(), facet.vertex.end(), v) != facet.vertex.end()) continue;
        const double height = glm::dot(hull.point(v) - hull.point(facet.vertex[0]), n);
        if (height > -width.along(n) && facet.side.side(hull.point(v)) == Sign::negative)
          return true;
      }
    }
  }
  return false;
}

double coarsening_work(const PointHull& hull) {
  std::vector<int> valence(hull.points().size(), 0);
  for (const PointHull::Facet& facet : hull.facets()) {
    if (!facet.alive) continue;
    for (const int v : facet.vertex) ++valence[std::size_t(v)];
  }
  return double(hull.facet_count()) * *std::max_element(valence.begin(), valence.end());
}

CoarseHull coarse_hull(const PointHull& hull, const std::array<int, 4>& spanning,
                       const RoundingWidth& width, const Progress& progress) {
  return Coarsener(hull, spanning, width).run(progress);
}

}  // namespace taut
