#include "taut/subdivision/limit_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/subdivision/cage_level.h"
#include "taut/subdivision/dart_limit.h"
#include "taut/subdivision/region_bound.h"
#include "taut/subdivision/reparametrize.h"
#include "taut/subdivision/smooth_caps.h"
#include "taut/subdivision/touch_test.h"
#include "taut/subdivision/triangle_points.h"

namespace taut {
namespace {

/// Levels whose patches' corners are the known points around what remains of a region.
constexpr std::size_t levels_around = 3;

/// How many diameters of a region such points are away at most.
constexpr double sizes_around = 16;

/// How many such points a level has at most: those of all regions about a vertex of many faces, of
/// which each is near all others, would grow with their number squared.
constexpr std::size_t most_around = 256;

/// Levels after which a region is left as it is: it halves at least every other one.
constexpr int level_limit = 96;

/// Factor by which bounds fall from level to level, about.
constexpr double falls_a_level = 4;

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

bool is_quad(const CellPatch& patch) {
  const std::size_t n = to_size(patch.degree) + 1;
  return patch.points.size() == n * n;
}

bool is_irregular(const CellPatch& patch) { return patch.kind != CellPatch::Kind::regular; }

/// In their order; of a triangle three.
std::vector<dvec3> corners(const CellPatch& patch) {
  const auto& p = patch.points;
  const std::size_t n = to_size(patch.degree);
  if (is_quad(patch)) return {p.front(), p[n * (n + 1)], p.back(), p[n]};
  return {p.front(), p[n], p.back()};
}

/// Of the sides but those that are `point` long at most, which are points at all levels; 0 if all
/// are. Of the diagonals too: a quad between two sides of a smooth crease gets thin.
double least_width(const CellPatch& patch, double point) {
  const std::vector<dvec3> c = corners(patch);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < c.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      const double length = glm::distance(c[k], c[i]);
      if (length > point) least = std::min(least, length);
    }
  }
  return std::isinf(least) ? 0 : least;
}

/// The patch's points with another corner first, or back from that.
std::vector<dvec3> turned(const CellPatch& patch, std::size_t corner, bool back = false) {
  const std::size_t n = to_size(patch.degree);
  std::vector<dvec3> result(patch.points.size());
  const auto copy = [&](std::size_t to, std::size_t from) {
    result[back ? from : to] = patch.points[back ? to : from];
  };
  if (is_quad(patch)) {
    for (std::size_t i = 0; i <= n; ++i) {
      for (std::size_t j = 0; j <= n; ++j) {
        const std::array<std::array<std::size_t, 2>, 4> from = {
            {{i, j}, {n - j, i}, {n - i, n - j}, {j, n - i}}};
        copy(i * (n + 1) + j, from[corner][0] * (n + 1) + from[corner][1]);
      }
    }
  } else {
    for (std::size_t j = 0; j <= n; ++j) {
      for (std::size_t i = 0; i + j <= n; ++i) {
        const std::array<std::size_t, 3> counts = {n - i - j, i, j};  // towards each corner
        copy(triangle_point(n, i, j),
             triangle_point(n, counts[(4 - corner) % 3], counts[(5 - corner) % 3]));
      }
    }
  }
  return result;
}

/// Lets a cap go on, with its first derivatives, as a regular cell does beyond its side between the
/// corner `side` and the next: 1 or 2 of a quad, 1 of a triangle. The other one's first corner is
/// that of the side's ends which is not opposite to the cap's first; of triangles, the one that is
/// not on the side.
void continue_beyond(std::vector<dvec3>& cap, const std::vector<dvec3>& beyond, std::size_t side) {
  if (cap.size() == 16) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto at = [&](std::size_t row) { return side == 1 ? 4 * row + k : 4 * k + row; };
      cap[at(3)] = beyond[at(0)];
      cap[at(2)] = 2.0 * beyond[at(0)] - beyond[at(1)];
    }
    return;
  }
  const auto on_side = [&](std::size_t k) { return beyond[triangle_point(4, k, 4 - k)]; };
  for (std::size_t k = 0; k <= 4; ++k) cap[triangle_point(4, 4 - k, k)] = on_side(k);
  for (std::size_t k = 0; k <= 3; ++k) {
    cap[triangle_point(4, 3 - k, k)] =
        on_side(k) + on_side(k + 1) - beyond[triangle_point(4, k, 3 - k)];
  }
}

/// What stands for a cell at an apex, its first corner, is free there, but for its two spokes that
/// are creases: the surface comes to a point, and is no polynomial.
void come_to_point(std::vector<dvec3>& cap, const dvec3& apex,
                   const std::array<std::optional<std::array<dvec3, 4>>, 2>& creases) {
  const bool is_quad = cap.size() == 16;
  const auto at = [&](std::size_t i, std::size_t j) -> dvec3& {
    return cap[is_quad ? 4 * i + j : triangle_point(4, i, j)];
  };
  const std::size_t n = is_quad ? 3 : 4;
  for (const bool first : {true, false}) {
    const auto spoke = [&](std::size_t k) -> dvec3& { return first ? at(k, 0) : at(0, k); };
    for (std::size_t k = 0; k + 1 < n; ++k) {
      spoke(k) = glm::mix(apex, spoke(n - 1), double(k) / double(n - 1));
    }
    const auto& crease = creases[first ? 0 : 1];
    if (!crease) continue;
    const std::vector<dvec3> own = elevated_curve({crease->begin(), crease->end()}, n);
    for (std::size_t k = 0; k <= n; ++k) spoke(k) = own[k];
  }
  if (is_quad) {
    at(1, 1) = (at(0, 1) + at(1, 0) + at(1, 2) + at(2, 1)) / 4.0;
  } else {
    at(1, 1) = (at(2, 0) + at(0, 2)) / 2.0;
  }
}

/// Cells around an inner vertex, counter-clockwise, and which of their corners are there.
struct CellFan {
  int centre = -1;
  std::vector<std::size_t> cells;
  std::vector<std::size_t> corners;
  /// The side from the vertex to the first cell's next corner is sharp, all others are smooth.
  bool is_dart = false;
};

/// Refines a cage.
class Refinement {
 public:
  Refinement(const ControlCage& cage, const LimitOptions& options)
      : options_(options), level_(cage), middles_(to_int(cage.points.size())) {
    Box box;
    for (const dvec3& p : cage.points) box.include(p);
    tolerance_ = options.accuracy * diagonal(box);
    result_.accuracy = tolerance_;
    point_side_ = join_distance * diagonal(box);
    least_side_ = shortest_side * point_side_;
    result_.non_manifold_edges = level_.non_manifold_edges();
    result_.non_manifold_vertices = level_.non_manifold_vertices();
  }

  LimitSurface run();

 private:
  void take_regular();
  void sort_out();
  void emit_rest();
  void finish_or_refine(const std::vector<std::size_t>& region);
  std::optional<CellFan> fan(const std::vector<std::size_t>& region) const;
  std::vector<dvec3> ring(const CellFan& fan) const;
  std::optional<std::vector<dvec3>> cap_of(const CellFan& fan, std::size_t k) const;
  std::optional<std::vector<std::vector<dvec3>>> caps_of(const CellFan& fan) const;
  std::optional<int> apex(const std::vector<std::size_t>& region) const;
  bool fit_caps(const std::vector<std::size_t>& region);
  void emit_caps(const std::vector<std::size_t>& region);
  double bound_of(const std::vector<std::size_t>& region, bool fit, bool least) const;
  Surroundings near(const std::vector<std::size_t>& region, const Surroundings& surroundings) const;
  void emit(std::size_t cell, bool may_touch = true);
  void count_irregular();
  void go_down();
  void report(double share_of_level) const;
  LimitSurface finish();

  const LimitOptions& options_;
  CageLevel level_;
  EdgeMiddles middles_;
  double tolerance_ = 0;
  double point_side_ = 0;
  double least_side_ = 0;
  int depth_ = 0;
  std::vector<CellPatch> patches_;  // of the level's cells
  TouchTest touch_;
  std::vector<Surroundings> surroundings_;  // per region
  std::vector<std::size_t> refined_;        // cells that go down
  std::vector<std::size_t> stand_ins_;      // caps that do not touch
  LimitSurface result_;
  std::vector<SurfaceTriangle> triangles_;
};

/// Levels that it takes at least are all that is known: each brings what remains nearer to what
/// stands for it by a factor.
void Refinement::report(double share_of_level) const {
  const double levels =
      std::clamp(-std::log(options_.accuracy) / std::log(falls_a_level), 1.0, double(level_limit));
  options_.progress.update("refine", std::min((depth_ + share_of_level) / levels, 1.0));
}

LimitSurface Refinement::run() {
  while (!level_.cells().empty()) {
    report(0);
    patches_ = level_.patches(options_.progress);
    take_regular();
    if (depth_ == 0) count_irregular();
    sort_out();
    emit_rest();
    result_.levels = depth_;
    if (refined_.empty()) break;
    go_down();
  }
  LimitSurface surface = finish();
  options_.progress.update("refine", 1);
  return surface;
}

void Refinement::emit(std::size_t cell, bool may_touch) {
  CellPatch& patch = patches_[cell];
  const int face = level_.cells()[cell].cage_face;
  std::array<int, 4> v = {};
  std::transform(level_.vertices(cell).begin(), level_.vertices(cell).end(), v.begin(),
                 [&](int vertex) { return level_.number(vertex); });
  if (is_quad(patch)) {
    SurfacePatch surface;
    surface.bezier.degree_u = surface.bezier.degree_v = patch.degree;
    surface.bezier.points.reserve(patch.points.size());
    for (const dvec3& p : patch.points) surface.bezier.points.push_back(homogeneous(p));
    surface.cage_face = face;
    surface.vertices = {v[0], v[3], v[1], v[2]};
    surface.exact = patch.kind == CellPatch::Kind::regular;
    surface.may_touch = may_touch;
    // Sides run v = 0, u = 1, v = 1, u = 0.
    surface.smooth = {patch.smooth[3], patch.smooth[1], patch.smooth[0], patch.smooth[2]};
    result_.patches.push_back(std::move(surface));
  } else {
    triangles_.push_back({std::move(patch.points),
                          face,
                          {v[0], v[1], v[2]},
                          {patch.smooth[0], patch.smooth[1], patch.smooth[2]},
                          patch.kind == CellPatch::Kind::regular,
                          may_touch});
  }
}

/// The corners of regular cells are points of the surface.
void Refinement::take_regular() {
  for (Surroundings& s : surroundings_) {
    s.emplace_back();
    if (s.size() > levels_around) s.erase(s.begin());
  }
  for (std::size_t c = 0; c < patches_.size(); ++c) {
    if (patches_[c].kind != CellPatch::Kind::regular) continue;
    options_.progress.check();
    const std::vector<dvec3> points = corners(patches_[c]);
    touch_.add(points);
    const int region = level_.cells()[c].region;
    if (region >= 0) {
      auto& own = surroundings_[to_size(region)].back();
      own.insert(own.end(), points.begin(), points.end());
    }
  }
}

void Refinement::count_irregular() {
  result_.irregular_faces = std::count_if(patches_.begin(), patches_.end(), is_irregular);
}

/// Decides for all irregular cells that may touch.
void Refinement::sort_out() {
  refined_.clear();
  stand_ins_.clear();
  std::vector<std::size_t> touching;
  for (std::size_t c = 0; c < patches_.size(); ++c) {
    const CellPatch& patch = patches_[c];
    if (patch.kind == CellPatch::Kind::regular) continue;
    options_.progress.check();
    if (patch.kind == CellPatch::Kind::cap) {
      std::vector<dvec3> points = level_.enclosure({&c, 1});
      points.insert(points.end(), patch.points.begin(), patch.points.end());
      if (!touch_.may_touch(points)) {
        stand_ins_.push_back(c);
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
    report(double(k) / double(order.size()));
    finish_or_refine(region);
    region.clear();
  }
}

/// Emits regular cells, and the end caps that stand for cells that do not touch, but for those at a
/// vertex of one that goes down: they go with it if they are in its sector between sharp edges,
/// which is irregular about the vertex, or beyond such an edge. So no side meets more than halves;
/// else those that end there would meet ever smaller ones.
void Refinement::emit_rest() {
  std::unordered_map<int, int> region_at;  // vertex -> region
  for (const std::size_t c : refined_) {
    for (const int v : level_.vertices(c)) region_at.emplace(v, level_.cells()[c].region);
  }
  const auto goes_down = [&](std::size_t c, const auto& with) {
    const std::span<const int> own = level_.vertices(c);
    const auto v = std::find_if(own.begin(), own.end(), with);
    if (v == own.end()) return false;
    level_.cells()[c].region = region_at.at(*v);
    refined_.push_back(c);
    return true;
  };
  for (const std::size_t c : stand_ins_) {
    if (!goes_down(c, [&](int v) { return region_at.count(v) > 0; })) emit(c, false);
  }
  std::unordered_set<int> sharp;  // of those vertices
  for (const std::size_t c : refined_) {
    const std::span<const int> own = level_.vertices(c);
    for (std::size_t k = 0; k < std::min<std::size_t>(4, own.size()); ++k) {
      if (patches_[c].smooth[k]) continue;
      for (const int v : {own[k], own[(k + 1) % own.size()]}) {
        if (region_at.count(v) > 0) sharp.insert(v);
      }
    }
  }
  for (std::size_t c = 0; c < patches_.size(); ++c) {
    if (patches_[c].kind != CellPatch::Kind::regular) continue;
    if (!goes_down(c, [&](int v) { return sharp.count(v) > 0; })) emit(c);
  }
}

/// What stands for a region changes the support function by no more than this; more than the
/// accuracy if it is too much, the least that can be said of it if asked for. `fit`: its caps have
/// the surface's vertex that they are about.
double Refinement::bound_of(const std::vector<std::size_t>& region, bool fit, bool least) const {
  std::vector<dvec3> known;
  const int number = level_.cells()[region.front()].region;
  if (number >= 0) {
    for (const auto& level : surroundings_[to_size(number)]) {
      known.insert(known.end(), level.begin(), level.end());
    }
  }
  if (const std::optional<int> apex = this->apex(region)) known.push_back(level_.point(*apex));
  if (const std::optional<CellFan> fan = fit ? this->fan(region) : std::nullopt) {
    known.push_back(corners(patches_[fan->cells.front()])[fan->corners.front()]);
  }
  if (!known.empty()) {
    return region_bound(level_, region, patches_, known, tolerance_, options_.progress, least);
  }
  Box box;
  for (const dvec3& p : level_.enclosure(region)) box.include(p);
  return diagonal(box);
}

/// Those of the points that are near a region, as its own size goes; the nearest of many.
Surroundings Refinement::near(const std::vector<std::size_t>& region,
                              const Surroundings& surroundings) const {
  Box box;
  for (const std::size_t c : region) {
    for (const dvec3& p : corners(patches_[c])) box.include(p);
  }
  const auto away = [&](const dvec3& p) { return glm::distance(p, box.center()); };
  const double reach = sizes_around * diagonal(box);
  Surroundings result(surroundings.size());
  for (std::size_t i = 0; i < surroundings.size(); ++i) {
    for (const dvec3& p : surroundings[i]) {
      if (away(p) <= reach) result[i].push_back(p);
    }
    if (result[i].size() <= most_around) continue;
    std::nth_element(result[i].begin(), result[i].begin() + most_around, result[i].end(),
                     [&](const dvec3& a, const dvec3& b) { return away(a) < away(b); });
    result[i].resize(most_around);
  }
  return result;
}

/// The cells of a region that is all cells around one inner vertex, at which one side at most is
/// sharp; with that of the first cell.
std::optional<CellFan> Refinement::fan(const std::vector<std::size_t>& region) const {
  const std::size_t n = region.size();
  if (n < 3) return std::nullopt;
  // The vertex that all have, and where.
  const auto place_in = [&](std::size_t c, int vertex) {
    const std::span<const int> own = level_.vertices(c);
    return to_size(to_int(std::find(own.begin(), own.end(), vertex) - own.begin()));
  };
  const std::span<const int> first = level_.vertices(region.front());
  const auto centre = std::find_if(first.begin(), first.end(), [&](int v) {
    return std::all_of(region.begin(), region.end(),
                       [&](std::size_t c) { return place_in(c, v) < level_.vertices(c).size(); });
  });
  if (centre == first.end()) return std::nullopt;
  // From spoke to spoke.
  const auto spoke_end = [&](std::size_t c, std::size_t turn) {
    const std::span<const int> own = level_.vertices(c);
    return own[(place_in(c, *centre) + turn) % own.size()];
  };
  CellFan fan;
  fan.centre = *centre;
  for (std::size_t c = region.front(); fan.cells.size() < n;) {
    fan.cells.push_back(c);
    fan.corners.push_back(place_in(c, *centre));
    const int last = spoke_end(c, level_.vertices(c).size() - 1);
    const auto next = std::find_if(region.begin(), region.end(),
                                   [&](std::size_t other) { return spoke_end(other, 1) == last; });
    if (next == region.end()) return std::nullopt;
    c = *next;
    const bool closes = fan.cells.size() == n && c == fan.cells.front();
    if (!closes && std::find(fan.cells.begin(), fan.cells.end(), c) != fan.cells.end()) {
      return std::nullopt;
    }
  }
  std::vector<std::ptrdiff_t> sharp;
  for (std::size_t k = 0; k < n; ++k) {
    if (!patches_[fan.cells[k]].smooth[fan.corners[k]]) sharp.push_back(std::ptrdiff_t(k));
  }
  if (sharp.size() > 1) return std::nullopt;
  fan.is_dart = !sharp.empty();
  if (fan.is_dart) {
    std::rotate(fan.cells.begin(), fan.cells.begin() + sharp.front(), fan.cells.end());
    std::rotate(fan.corners.begin(), fan.corners.begin() + sharp.front(), fan.corners.end());
  }
  return fan;
}

/// The points about the centre of a fan at a dart, as dart_limit() takes them.
std::vector<dvec3> Refinement::ring(const CellFan& fan) const {
  const auto vertex = [&](std::size_t k, std::size_t turn) {
    const std::span<const int> own = level_.vertices(fan.cells[k]);
    return level_.point(own[(fan.corners[k] + turn) % own.size()]);
  };
  std::vector<dvec3> points = {vertex(0, 0)};
  for (std::size_t k = 0; k < fan.cells.size(); ++k) points.push_back(vertex(k, 1));
  if (level_.vertices(fan.cells.front()).size() == 3) return points;
  for (std::size_t k = 0; k < fan.cells.size(); ++k) points.push_back(vertex(k, 2));
  return points;
}

/// The cap of a fan's cell with the fan's vertex first. OpenSubdiv's caps at a dart or
/// an apex, as if that were smooth, do not go on in the regular cells around: there they are made
/// to.
std::optional<std::vector<dvec3>> Refinement::cap_of(const CellFan& fan, std::size_t k) const {
  const std::size_t cell = fan.cells[k];
  std::vector<dvec3> cap = turned(patches_[cell], fan.corners[k]);
  const bool is_apex = level_.is_apex(fan.centre);
  if (!fan.is_dart && !is_apex) return cap;
  const std::span<const int> own = level_.vertices(cell);
  for (std::size_t side = 1; side + 1 < own.size(); ++side) {
    const std::size_t from = (fan.corners[k] + side) % own.size();
    const std::size_t to = (from + 1) % own.size();
    const std::optional<std::size_t> other = level_.across(cell, from);
    if (!other || is_irregular(patches_[*other])) return std::nullopt;
    const std::span<const int> others = level_.vertices(*other);
    const auto corner = [&](int vertex) {
      return std::size_t(std::find(others.begin(), others.end(), vertex) - others.begin());
    };
    const std::size_t first =
        own.size() == 3 ? (corner(own[from]) + 1) % 3 : corner(own[side == 1 ? from : to]);
    continue_beyond(cap, turned(patches_[*other], first), side);
  }
  if (is_apex) {
    std::optional<std::array<dvec3, 4>> last =
        level_.crease(cell, (fan.corners[k] + own.size() - 1) % own.size());
    if (last) std::reverse(last->begin(), last->end());
    come_to_point(cap, level_.point(fan.centre), {level_.crease(cell, fan.corners[k]), last});
  }
  return cap;
}

/// The caps of a fan's cells, each with the fan's vertex first; none if there is no telling them.
std::optional<std::vector<std::vector<dvec3>>> Refinement::caps_of(const CellFan& fan) const {
  std::vector<std::vector<dvec3>> caps;
  for (std::size_t k = 0; k < fan.cells.size(); ++k) {
    std::optional<std::vector<dvec3>> cap = cap_of(fan, k);
    if (!cap) return std::nullopt;
    caps.push_back(std::move(*cap));
  }
  if (level_.is_apex(fan.centre)) return caps;
  const bool quads = is_quad(patches_[fan.cells.front()]);
  std::optional<VertexLimit> dart;
  if (fan.is_dart) {
    dart = dart_limit(quads ? CageScheme::catmark : CageScheme::loop, ring(fan));
    if (!dart) return std::nullopt;
  }
  return quads ? smooth_quad_caps(caps, dart) : smooth_triangle_caps(caps, dart);
}

/// The apex of a region's cells, if there is one.
std::optional<int> Refinement::apex(const std::vector<std::size_t>& region) const {
  for (const std::size_t c : region) {
    for (const int v : level_.vertices(c)) {
      if (level_.is_apex(v)) return v;
    }
  }
  return std::nullopt;
}

/// Lets the caps of a region that is all cells around one inner vertex meet as the surface does
/// there: smoothly, in a dart or in an apex. Whether they do.
bool Refinement::fit_caps(const std::vector<std::size_t>& region) {
  const std::optional<CellFan> fan = this->fan(region);
  if (!fan) return false;
  std::optional<std::vector<std::vector<dvec3>>> caps = caps_of(*fan);
  if (!caps) return false;
  for (std::size_t k = 0; k < fan->cells.size(); ++k) {
    CellPatch& patch = patches_[fan->cells[k]];
    patch.points = std::move((*caps)[k]);
    if (!level_.is_apex(fan->centre)) patch.degree += 2;
    patch.points = turned(patch, fan->corners[k], true);
  }
  return true;
}

/// The caps of a region stand for it from now on. At an apex they do not go on into each other.
void Refinement::emit_caps(const std::vector<std::size_t>& region) {
  for (const std::size_t c : region) {
    const std::span<const int> own = level_.vertices(c);
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (level_.is_apex(own[k]) || level_.is_apex(own[(k + 1) % own.size()])) {
        patches_[c].smooth[k] = false;
      }
    }
    emit(c);
  }
}

void Refinement::finish_or_refine(const std::vector<std::size_t>& region) {
  options_.progress.check();
  const bool has_caps = std::all_of(region.begin(), region.end(), [&](std::size_t c) {
    return patches_[c].kind == CellPatch::Kind::cap && !patches_[c].semi_sharp;
  });
  if (has_caps && depth_ > 0) {
    const bool small =
        depth_ >= level_limit || std::any_of(region.begin(), region.end(), [&](std::size_t c) {
          return least_width(patches_[c], point_side_) < least_side_;
        });
    const bool fit = fit_caps(region);
    const double bound = bound_of(region, fit, small);
    if (((fit || !apex(region)) && bound <= tolerance_) || small) {
      result_.deviation_bound = std::max(result_.deviation_bound, bound);
      emit_caps(region);
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
  if (depth_ == 0) {
    result_.refined_faces = std::count_if(refined_.begin(), refined_.end(),
                                          [&](std::size_t c) { return is_irregular(patches_[c]); });
  }
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
  level_ = level_.refined(refined_, middles_);
  ++depth_;
}

LimitSurface Refinement::finish() {
  std::vector<SurfacePatch>& patches = result_.patches;
  patches = triangles_.empty() ? conforming(std::move(patches), middles_, options_.progress)
                               : conforming(std::move(triangles_), middles_, options_.progress);
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
