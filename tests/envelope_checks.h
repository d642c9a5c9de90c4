#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "models.h"
#include "taut/bounds/support_query.h"
#include "taut/core/parallel.h"
#include "taut/envelope/trace_envelope.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/result/hull.h"

namespace taut_test {

/// How far apart two directions are, in pixels of the image of the first one's hemisphere.
inline double pixels_between(const taut::EnvelopeImages& images, const dvec3& a, const dvec3& b) {
  const taut::StereographicView view = images.view(taut::hemisphere_of(a));
  if (view.pole() * b.z < -0.5) return std::numeric_limits<double>::infinity();
  return glm::distance(view.pixel(a), view.pixel(b));
}

/// A direction so many pixels away from n, along the tangent.
inline dvec3 pixels_away(const taut::EnvelopeImages& images, const dvec3& n, const dvec3& tangent,
                         double pixels) {
  const double z = std::abs(n.z);
  // A pixel turns by 2 / size * (1 + |n.z|).
  return taut::unit(n + pixels * 2.0 / images.size() * (1 + z) * tangent);
}

/// What comparing an image's sources with those of support queries gave.
struct SourceCounts {
  long right = 0;
  long near = 0;   ///< wrong, within two pixels of a change of source
  long wrong = 0;  ///< elsewhere
};

/// Random directions. A wrong source does not count where another one is within two pixels.
inline SourceCounts count_sources(const taut::EnvelopeImages& images, long directions,
                                  unsigned seed) {
  const taut::Scene& scene = images.scene();
  constexpr int around = 12;
  constexpr std::size_t grain = 1024;
  std::vector<SourceCounts> counts((std::size_t(directions) + grain - 1) / grain);
  taut::parallel_for(std::size_t(directions), grain, 0, [&](std::size_t begin, std::size_t end) {
    Random random(seed + begin);
    taut::SupportQuery query(scene);
    SourceCounts& own = counts[begin / grain];
    const auto changes_near = [&](const dvec3& n, const taut::Support& s, int source) {
      const auto [e0, e1] = taut::tangent_frame(n);
      for (int i = 0; i < around; ++i) {
        const double angle = 2 * M_PI * i / around;
        for (const double pixels : {1.0, 2.0}) {
          const dvec3 m =
              pixels_away(images, n, std::cos(angle) * e0 + std::sin(angle) * e1, pixels);
          if (scene.source(query(m, s.contact).contact).source != source) return true;
        }
      }
      return false;
    };
    for (std::size_t k = begin; k < end; ++k) {
      const dvec3 n = random_direction(random);
      const taut::Support s = query(n);
      const int source = scene.source(s.contact).source;
      if (images.source(images.pixel(n)) == source) {
        ++own.right;
      } else if (changes_near(n, s, source)) {
        ++own.near;
      } else {
        ++own.wrong;
      }
    }
  });
  SourceCounts sum;
  for (const SourceCounts& c : counts) {
    sum.right += c.right;
    sum.near += c.near;
    sum.wrong += c.wrong;
  }
  return sum;
}

/// Directions along curves, sorted into cells of the cube about the sphere, to find near ones.
class NearDirections {
 public:
  NearDirections(const taut::EnvelopeImages& images, const std::vector<std::vector<dvec3>>& curves)
      : images_(images) {
    for (const auto& curve : curves) {
      for (std::size_t k = 0; k < curve.size(); ++k) {
        add(curve[k]);
        if (k + 1 == curve.size()) continue;
        const double gap = glm::distance(curve[k], curve[k + 1]) * images.size();
        for (double t = 1; t < gap; ++t) {
          add(taut::unit(curve[k] + t / gap * (curve[k + 1] - curve[k])));
        }
      }
    }
  }
  /// In pixels; infinite if more than some.
  double distance(const dvec3& n) const {
    double least = std::numeric_limits<double>::infinity();
    const auto [x, y, z] = cell(n);
    for (int i = x - 1; i <= x + 1; ++i) {
      for (int j = y - 1; j <= y + 1; ++j) {
        for (int k = z - 1; k <= z + 1; ++k) {
          const auto found = cells_.find({i, j, k});
          if (found == cells_.end()) continue;
          for (const dvec3& m : found->second) {
            least = std::min(least, pixels_between(images_, n, m));
          }
        }
      }
    }
    return least;
  }

 private:
  std::array<int, 3> cell(const dvec3& n) const {
    const double size = images_.size() / 16.0;
    return {int(std::floor(n.x * size)), int(std::floor(n.y * size)), int(std::floor(n.z * size))};
  }
  void add(const dvec3& n) { cells_[cell(n)].push_back(n); }

  const taut::EnvelopeImages& images_;
  std::map<std::array<int, 3>, std::vector<dvec3>> cells_;
};

/// How what an image shows agrees with the exact boundary. "Wide": wider than three pixels.
struct MatchCounts {
  long curve_points = 0, curve_points_off = 0;     ///< of the image; off by more than two pixels
  long curve_points_wrong = 0;                     ///< off, and its contacts do not both support
  long wide_rulings = 0, wide_rulings_missed = 0;  ///< of the exact curves, about one a pixel
  long narrow_rulings = 0;
  long triple_points = 0, triple_points_off = 0;     ///< of the image
  long triple_points_wrong = 0;                      ///< off, and not all contacts support
  long wide_facets = 0, wide_facets_missed = 0;      ///< of the boundary
  long wide_regions = 0;                             ///< of the image, of faces
  long regions_of_none = 0, regions_of_several = 0;  ///< patches of the boundary
  long patches = 0, patches_split = 0;               ///< of the boundary; shown by several regions
};

/// Along a separating curve: on either side of n, up to three pixels away, its contacts support.
inline bool is_wide(const taut::EnvelopeImages& images, taut::SupportQuery& query,
                    const taut::Ruling& r) {
  const dvec3 d = r.point[0] - r.point[1];
  const double length = glm::length(d);
  const dvec3 across = d - glm::dot(d, r.n) * r.n;
  if (!(glm::length(across) > 0)) return false;
  for (const double pixels : {1.0, 2.0, 3.0}) {
    for (const int side : {0, 1}) {
      const double sign = side == 0 ? 1 : -1;
      const dvec3 n = pixels_away(images, r.n, taut::unit(across), sign * pixels);
      const taut::Support s = query(n, r.contact[std::size_t(side)]);
      if (glm::distance(s.point, r.point[std::size_t(side)]) > 0.3 * length) return false;
    }
  }
  return true;
}

/// The points, in model coordinates, support the direction, to within interpolation by pixels.
template <class Points>
bool all_support(const taut::EnvelopeImages& images, taut::SupportQuery& query, const dvec3& n,
                 const Points& points) {
  const double h = query(n).h;
  return std::all_of(points.begin(), points.end(), [&](const dvec3& p) {
    return h - glm::dot(images.scene().frame().to_frame(p), n) < 1e-6;
  });
}

/// Those of a piece's rulings, and of some between each two.
inline std::vector<dvec3> normals_along(const taut::ContactSystem& system,
                                        const std::vector<taut::Ruling>& rulings) {
  constexpr int parts = 8;
  std::vector<dvec3> normals = {rulings.front().n};
  for (std::size_t k = 1; k < rulings.size(); ++k) {
    for (int i = 1; i < parts; ++i) {
      const auto r = ruling_between(system, rulings[k - 1], rulings[k], double(i) / parts);
      if (r) normals.push_back(r->n);
    }
    normals.push_back(rulings[k].n);
  }
  return normals;
}

inline void match_curves(const taut::EnvelopeImages& images, const taut::EnvelopeMap& map,
                         const taut::HullBoundary& boundary, MatchCounts& counts) {
  std::vector<std::vector<dvec3>> exact;
  std::vector<std::vector<dvec3>> seen;
  const taut::ContactGeometry geometry(images.scene());
  const taut::ContactSystem system(geometry);
  for (const taut::SeparatingArc& arc : boundary.arcs) {
    for (const taut::ArcPiece& piece : arc.pieces) {
      exact.push_back(normals_along(system, piece.rulings));
    }
  }
  for (const taut::EnvelopeCurve& curve : map.curves) {
    seen.emplace_back();
    for (const auto& p : curve.points) seen.back().push_back(p.n);
    if (curve.closed) seen.back().push_back(curve.points.front().n);
  }
  const NearDirections near_exact(images, exact);
  const NearDirections near_seen(images, seen);
  taut::SupportQuery query(images.scene());
  for (const taut::EnvelopeCurve& curve : map.curves) {
    for (const auto& p : curve.points) {
      ++counts.curve_points;
      if (near_exact.distance(p.n) <= 2) continue;
      ++counts.curve_points_off;
      counts.curve_points_wrong += all_support(images, query, p.n, p.point) ? 0 : 1;
    }
  }
  for (const taut::SeparatingArc& arc : boundary.arcs) {
    for (const taut::ArcPiece& piece : arc.pieces) {
      for (const taut::Ruling& r : piece.rulings) {
        if (!is_wide(images, query, r)) {
          ++counts.narrow_rulings;
          continue;
        }
        ++counts.wide_rulings;
        counts.wide_rulings_missed += near_seen.distance(r.n) > 2 ? 1 : 0;
      }
    }
  }
}

/// No other facet is within six pixels, and in all directions around, four pixels away, one of its
/// contacts supports, moved by much less than the contacts are apart, each in some of them.
inline bool is_wide(const taut::EnvelopeImages& images, taut::SupportQuery& query,
                    const taut::HullBoundary& boundary, const taut::HullFace& facet) {
  for (const taut::HullFace& other : boundary.faces) {
    if (&other == &facet || other.kind != taut::FaceKind::facet) continue;
    if (pixels_between(images, facet.n, other.n) < 6) return false;
  }
  // The contacts' sectors around the facet's direction are seen.
  const auto [e0, e1] = taut::tangent_frame(facet.n);
  std::vector<long> seen(facet.points.size(), 0);
  double apart = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < facet.points.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      apart = std::min(apart, glm::distance(facet.points[k], facet.points[i]));
    }
  }
  const bool straight = facet.sides.empty();  // else contacts move along its sides
  constexpr int around = 64;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * M_PI * i / around;
    const dvec3 n = pixels_away(images, facet.n, std::cos(angle) * e0 + std::sin(angle) * e1, 4);
    const dvec3 x = query(n).point;
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < facet.points.size(); ++k) {
      if (glm::distance(x, facet.points[k]) < glm::distance(x, facet.points[nearest])) nearest = k;
    }
    if (straight && glm::distance(x, facet.points[nearest]) > 0.3 * apart) return false;
    ++seen[nearest];
  }
  return std::all_of(seen.begin(), seen.end(), [](long n) { return n >= 3; });
}

inline void match_triple_points(const taut::EnvelopeImages& images, const taut::EnvelopeMap& map,
                                const taut::HullBoundary& boundary, MatchCounts& counts) {
  taut::SupportQuery query(images.scene());
  const auto nearest = [&](const dvec3& n, const auto& list, const auto& direction) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& item : list) {
      least = std::min(least, pixels_between(images, n, direction(item)));
    }
    return least;
  };
  std::vector<dvec3> facets;
  for (const taut::HullFace& face : boundary.faces) {
    if (face.kind == taut::FaceKind::facet) facets.push_back(face.n);
  }
  for (const auto& p : map.triple_points) {
    ++counts.triple_points;
    const double off = nearest(p.n, facets, [](const dvec3& n) { return n; });
    if (off <= 2) continue;
    ++counts.triple_points_off;
    counts.triple_points_wrong += all_support(images, query, p.n, p.points) ? 0 : 1;
  }
  for (const taut::HullFace& face : boundary.faces) {
    if (face.kind != taut::FaceKind::facet || !is_wide(images, query, boundary, face)) continue;
    ++counts.wide_facets;
    const double off = nearest(face.n, map.triple_points, [](const auto& p) { return p.n; });
    counts.wide_facets_missed += off > 2 ? 1 : 0;
  }
}

/// Patches of the exact hull and regions of the images. Each vertex inside of a patch of a fine
/// mesh lies in a region, as far as that is wide; the middle of each wide region is supported by a
/// vertex at which a patch of its source lies.
inline void match_regions(const taut::EnvelopeImages& images, const taut::EnvelopeMap& map,
                          const taut::Hull& hull, MatchCounts& counts) {
  const Model& model = images.scene().model();
  std::map<int, std::set<int>> patches_of;  // per region
  std::map<int, std::set<int>> regions_of;  // per patch
  for (const auto v : hull.mesh.vertices()) {
    std::set<int> faces;
    bool inside = true;
    for (const auto f : hull.mesh.vf_range(v)) {
      inside = inside && hull.mesh.data(f).kind == taut::FaceKind::patch;
      faces.insert(hull.mesh.data(f).hull_face);
    }
    if (!inside || faces.size() != 1) continue;
    const auto& n = hull.mesh.normal(v);
    const int region = map.region_at(images.pixel(taut::unit({n[0], n[1], n[2]})));
    if (region < 0 || map.regions[std::size_t(region)].depth < 2) continue;
    if (map.regions[std::size_t(region)].source != hull.mesh.data(v).source) continue;
    patches_of[region].insert(*faces.begin());
    regions_of[*faces.begin()].insert(region);
  }
  for (std::size_t r = 0; r < map.regions.size(); ++r) {
    const taut::EnvelopeRegion& region = map.regions[r];
    if (region.depth < 2 || model.source(region.source).kind != taut::SourceKind::face) continue;
    const dvec3 n = images.direction(region.inside);
    const auto highest = *std::max_element(hull.mesh.vertices_begin(), hull.mesh.vertices_end(),
                                           [&](const auto& a, const auto& b) {
                                             return glm::dot(taut::position(hull.mesh, a), n) <
                                                    glm::dot(taut::position(hull.mesh, b), n);
                                           });
    for (const auto f : hull.mesh.vf_range(highest)) {
      const auto& face = hull.mesh.data(f);
      if (face.kind != taut::FaceKind::patch || face.source != region.source) continue;
      patches_of[int(r)].insert(face.hull_face);
      regions_of[face.hull_face].insert(int(r));
    }
    ++counts.wide_regions;
    counts.regions_of_none += patches_of[int(r)].empty() ? 1 : 0;
    counts.regions_of_several += patches_of[int(r)].size() > 1 ? 1 : 0;
  }
  counts.patches = long(regions_of.size());
  for (const auto& [patch, regions] : regions_of) {
    counts.patches_split += regions.size() != 1 ? 1 : 0;
  }
}

inline MatchCounts match(const taut::EnvelopeImages& images, const taut::EnvelopeMap& map,
                         const taut::Hull& hull) {
  MatchCounts counts;
  match_curves(images, map, *hull.boundary, counts);
  match_triple_points(images, map, *hull.boundary, counts);
  match_regions(images, map, hull, counts);
  return counts;
}

}  // namespace taut_test
