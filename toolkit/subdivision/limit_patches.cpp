#include "taut/subdivision/limit_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "taut/core/tolerances.h"
#include "taut/subdivision/cage_level.h"
#include "taut/subdivision/hull_distance.h"
#include "taut/subdivision/touch_test.h"

namespace taut {
namespace {

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }
int to_int(std::size_t n) { return static_cast<int>(n); }

/// Levels whose patches' corners are the known points around what remains of a region.
constexpr std::size_t levels_around = 3;

/// How many diameters of a region such points are away at most.
constexpr double sizes_around = 16;

/// Levels after which a region is left as it is: it halves at least every other one.
constexpr int level_limit = 96;

/// Sides shorter than this many join tolerances may be taken for points once they are split.
constexpr double shortest_side = 16;

/// Known points around a region, by level.
using Surroundings = std::vector<std::vector<dvec3>>;

/// Sets of cells that share vertices.
std::vector<int> connected_sets(const CageLevel& level, const std::vector<std::size_t>& cells) {
  std::vector<int> parent(cells.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](int a) {
    while (parent[to_size(a)] != a) a = parent[to_size(a)] = parent[to_size(parent[to_size(a)])];
    return a;
  };
  std::vector<std::pair<int, int>> uses;  // vertex, cell
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const int v : level.vertices(cells[i])) uses.emplace_back(v, to_int(i));
  }
  std::sort(uses.begin(), uses.end());
  for (std::size_t k = 1; k < uses.size(); ++k) {
    if (uses[k].first != uses[k - 1].first) continue;
    const int a = find(uses[k - 1].second);
    const int b = find(uses[k].second);
    parent[to_size(std::max(a, b))] = std::min(a, b);
  }
  std::vector<int> set(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) set[i] = find(to_int(i));
  return set;
}

std::array<dvec3, 4> corners(const CellPatch& patch) {
  const auto& p = patch.points;
  if (p.size() == 16) return {p[0], p[3], p[12], p[15]};
  return {p[0], p[4], p[14], p[14]};
}

double least_side(const CellPatch& patch) {
  const auto& p = patch.points;
  const std::vector<std::array<std::size_t, 2>> sides =
      p.size() == 16 ? std::vector<std::array<std::size_t, 2>>{{0, 3}, {3, 15}, {15, 12}, {12, 0}}
                     : std::vector<std::array<std::size_t, 2>>{{0, 4}, {4, 14}, {14, 0}};
  double least = glm::distance(p[sides[0][0]], p[sides[0][1]]);
  for (const auto& [a, b] : sides) least = std::min(least, glm::distance(p[a], p[b]));
  return least;
}

/// Refines a cage.
class Refinement {
 public:
  Refinement(const ControlCage& cage, const LimitOptions& options)
      : options_(options), level_(cage) {
    Box box;
    for (const dvec3& p : cage.points) box.include(p);
    tolerance_ = options.accuracy * diagonal(box);
    least_side_ = shortest_side * join_distance * diagonal(box);
    result_.non_manifold_edges = level_.non_manifold_edges();
    result_.non_manifold_vertices = level_.non_manifold_vertices();
  }

  LimitSurface run();

 private:
  void take_regular();
  void sort_out();
  void finish_or_refine(const std::vector<std::size_t>& region);
  double bound_of(const std::vector<std::size_t>& region, double enough) const;
  Surroundings near(const std::vector<std::size_t>& region, const Surroundings& surroundings) const;
  void emit(std::size_t cell);
  void count_irregular();
  void go_down();
  LimitSurface finish();

  const LimitOptions& options_;
  CageLevel level_;
  double tolerance_ = 0;
  double least_side_ = 0;
  int depth_ = 0;
  std::vector<CellPatch> patches_;  // of the level's cells
  TouchTest touch_;
  std::vector<Surroundings> surroundings_;  // per region
  std::vector<std::size_t> refined_;        // cells that go down
  LimitSurface result_;
  std::vector<SurfaceTriangle> triangles_;
};

LimitSurface Refinement::run() {
  while (!level_.cells().empty()) {
    options_.progress.check();
    patches_ = level_.patches();
    take_regular();
    if (depth_ == 0) count_irregular();
    sort_out();
    result_.levels = depth_;
    if (refined_.empty()) break;
    go_down();
  }
  return finish();
}

void Refinement::emit(std::size_t cell) {
  CellPatch& patch = patches_[cell];
  const int face = level_.cells()[cell].cage_face;
  if (patch.points.size() == 16) {
    SurfacePatch surface;
    surface.bezier.degree_u = surface.bezier.degree_v = 3;
    surface.bezier.points.reserve(16);
    for (const dvec3& p : patch.points) surface.bezier.points.push_back(homogeneous(p));
    surface.cage_face = face;
    surface.exact = patch.kind == CellPatch::Kind::regular;
    // Sides run v = 0, u = 1, v = 1, u = 0.
    surface.smooth = {patch.smooth[3], patch.smooth[1], patch.smooth[0], patch.smooth[2]};
    result_.patches.push_back(std::move(surface));
  } else {
    triangles_.push_back({std::move(patch.points),
                          face,
                          {patch.smooth[0], patch.smooth[1], patch.smooth[2]},
                          patch.kind == CellPatch::Kind::regular});
  }
}

/// Regular cells are done; their corners are points of the surface.
void Refinement::take_regular() {
  std::vector<dvec3> known;
  for (Surroundings& s : surroundings_) {
    s.emplace_back();
    if (s.size() > levels_around) s.erase(s.begin());
  }
  for (std::size_t c = 0; c < patches_.size(); ++c) {
    if (patches_[c].kind != CellPatch::Kind::regular) continue;
    const std::array<dvec3, 4> points = corners(patches_[c]);
    known.insert(known.end(), points.begin(), points.end());
    const int region = level_.cells()[c].region;
    if (region >= 0) {
      auto& own = surroundings_[to_size(region)].back();
      own.insert(own.end(), points.begin(), points.end());
    }
    emit(c);
  }
  touch_.add(known);
}

void Refinement::count_irregular() {
  result_.irregular_faces = std::count_if(patches_.begin(), patches_.end(), [](const CellPatch& p) {
    return p.kind != CellPatch::Kind::regular;
  });
}

/// Decides for all irregular cells: end caps stand for those that do not touch.
void Refinement::sort_out() {
  refined_.clear();
  std::vector<std::size_t> touching;
  std::vector<dvec3> points;
  for (std::size_t c = 0; c < patches_.size(); ++c) {
    const CellPatch& patch = patches_[c];
    if (patch.kind == CellPatch::Kind::regular) continue;
    if (patch.kind == CellPatch::Kind::cap) {
      level_.enclosure(c, points);
      points.insert(points.end(), patch.points.begin(), patch.points.end());
      if (!touch_.may_touch(points)) {
        emit(c);
        continue;
      }
    }
    touching.push_back(c);
  }
  const std::vector<int> set = connected_sets(level_, touching);
  std::vector<std::size_t> order(touching.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return set[a] < set[b]; });
  std::vector<std::size_t> region;
  for (std::size_t k = 0; k < order.size(); ++k) {
    region.push_back(touching[order[k]]);
    if (k + 1 < order.size() && set[order[k + 1]] == set[order[k]]) continue;
    finish_or_refine(region);
    region.clear();
  }
}

/// What stands for a region and the region itself are no farther than this from the convex hull of
/// points of the surface; anything above `enough` if it is more than that.
double Refinement::bound_of(const std::vector<std::size_t>& region, double enough) const {
  std::vector<dvec3> known;
  const int number = level_.cells()[region.front()].region;
  if (number >= 0) {
    for (const auto& level : surroundings_[to_size(number)]) {
      known.insert(known.end(), level.begin(), level.end());
    }
  }
  double bound = 0;
  std::vector<dvec3> points;
  if (known.empty()) {
    for (const std::size_t c : region) {
      level_.enclosure(c, points);
      known.insert(known.end(), points.begin(), points.end());
    }
    Box box;
    for (const dvec3& p : known) box.include(p);
    return diagonal(box);
  }
  for (const std::size_t c : region) {
    level_.enclosure(c, points);
    points.insert(points.end(), patches_[c].points.begin(), patches_[c].points.end());
    for (const dvec3& p : points) {
      bound = std::max(bound, distance_from_hull_bound(p, known));
      if (bound > enough) return bound;
    }
  }
  return bound;
}

/// Those of the points that are near a region, as its own size goes.
Surroundings Refinement::near(const std::vector<std::size_t>& region,
                              const Surroundings& surroundings) const {
  Box box;
  for (const std::size_t c : region) {
    for (const dvec3& p : corners(patches_[c])) box.include(p);
  }
  const double reach = sizes_around * diagonal(box);
  Surroundings result(surroundings.size());
  for (std::size_t i = 0; i < surroundings.size(); ++i) {
    for (const dvec3& p : surroundings[i]) {
      if (glm::distance(p, box.center()) <= reach) result[i].push_back(p);
    }
  }
  return result;
}

void Refinement::finish_or_refine(const std::vector<std::size_t>& region) {
  const bool has_caps = std::all_of(region.begin(), region.end(), [&](std::size_t c) {
    return patches_[c].kind == CellPatch::Kind::cap && !patches_[c].semi_sharp;
  });
  if (has_caps && depth_ > 0) {
    const bool small =
        depth_ >= level_limit || std::any_of(region.begin(), region.end(), [&](std::size_t c) {
          return least_side(patches_[c]) < least_side_;
        });
    const double bound =
        bound_of(region, small ? std::numeric_limits<double>::infinity() : tolerance_);
    if (bound <= tolerance_ || small) {
      result_.deviation_bound = std::max(result_.deviation_bound, bound);
      for (const std::size_t c : region) emit(c);
      return;
    }
  }
  const int parent = level_.cells()[region.front()].region;
  Surroundings around;
  if (parent >= 0) around = near(region, surroundings_[to_size(parent)]);
  for (const std::size_t c : region) level_.cells()[c].region = to_int(surroundings_.size());
  surroundings_.push_back(std::move(around));
  refined_.insert(refined_.end(), region.begin(), region.end());
}

void Refinement::go_down() {
  std::sort(refined_.begin(), refined_.end());
  if (depth_ == 0) result_.refined_faces = static_cast<long>(refined_.size());
  // Regions are numbered anew: only those of cells that go down are left.
  std::vector<Surroundings> left;
  std::vector<int> number(surroundings_.size(), -1);
  for (const std::size_t c : refined_) {
    int& region = level_.cells()[c].region;
    int& n = number[to_size(region)];
    if (n < 0) {
      n = to_int(left.size());
      left.push_back(std::move(surroundings_[to_size(region)]));
    }
    region = n;
  }
  surroundings_ = std::move(left);
  level_ = level_.refined(refined_);
  ++depth_;
}

LimitSurface Refinement::finish() {
  std::vector<SurfacePatch>& patches = result_.patches;
  patches = triangles_.empty() ? conforming(std::move(patches)) : conforming(std::move(triangles_));
  std::stable_sort(
      patches.begin(), patches.end(),
      [](const SurfacePatch& a, const SurfacePatch& b) { return a.cage_face < b.cage_face; });
  return std::move(result_);
}

}  // namespace

LimitSurface limit_patches(const ControlCage& cage, const LimitOptions& options) {
  return Refinement(cage, options).run();
}

}  // namespace taut
