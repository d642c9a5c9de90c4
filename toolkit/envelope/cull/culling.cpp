#include "taut/envelope/cull/culling.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "taut/bounds/patch_nets.h"
#include "taut/bounds/reach_test.h"
#include "taut/bounds/scene_content.h"
#include "taut/bounds/second_form.h"
#include "taut/bounds/support_query.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"
#include "taut/core/pool.h"
#include "taut/core/stop.h"
#include "taut/envelope/cull/concave_surroundings.h"

namespace taut {
namespace {

constexpr int level_limit = 20;

/// The finer the patches, the less is to be gained by their cells.
constexpr int default_levels = 3;
constexpr long cells_in_all = 16384;

/// The sphere is sampled at one direction for some patches, between 96 and 6144 in all: the more
/// patches there are, the more of them lie under the samples and need no queries of their own.
constexpr std::size_t patches_per_direction = 8;
constexpr int coarsest_directions = 2;
constexpr int finest_directions = 5;
/// Edges have no cells: where they are curved, this many levels of directions at least.
constexpr int directions_for_edges = 3;

/// A pyramid that is this many cells of the spread samples wide needs no query of its own.
constexpr double dense_samples = 4;

/// Patches of a task, between these, so that there are many tasks for all threads; each task makes
/// its own queries and caps.
constexpr std::size_t least_patches_per_task = 8;
constexpr std::size_t most_patches_per_task = 256;
constexpr std::size_t tasks = 64;

/// By how many of its own sizes a cell is surrounded at most where the whole patch is too curved,
/// and then half as many, down to one. What is close to the cell must be inside: where the two
/// principal curvatures differ by a factor of k, a pyramid across them may hold normals that point
/// k cells away.
constexpr int widest_surrounding = 8;

/// Cells that a task's queries may look at, and how many more each of them: ten times what is
/// usual, and more. Where much of a model is as high but for little, as about a pole of needles,
/// they take thousands, and decide next to nothing; the most of such cells are left.
constexpr long cells_a_task = 5'000;
constexpr long cells_a_query = 200;

/// Roundings by which a point that supports its normal may fall short of what a query finds.
constexpr double middle_rounding = 16;

/// Distances of the points that stand for a cell, in its sizes.
constexpr std::array<double, 2> ring_radii = {0.5, 2};

/// A sampled point that a cell is compared with.
struct Beacon {
  Contact contact;
  dvec3 local;  ///< in the part's frame
  bool known = false;
};

bool has_curved_edges(const Model& model) {
  return std::any_of(model.parts().begin(), model.parts().end(), [](const Part& part) {
    return std::any_of(part.pieces().begin(), part.pieces().end(), [](const EdgePiece& piece) {
      return piece.edge >= 0 && piece.bezier.degree() > 1;
    });
  });
}

/// Support points of directions spread over the sphere, one for each of its cells.
class SpreadSamples {
 public:
  SpreadSamples(const Scene& scene, std::size_t patches, const CullingOptions& options)
      : level_(has_curved_edges(scene.model()) ? directions_for_edges : coarsest_directions) {
    while (level_ < finest_directions &&
           (std::size_t(6) << (2 * (level_ + 1))) * patches_per_direction <= patches) {
      ++level_;
    }
    const std::uint32_t side = std::uint32_t{1} << level_;
    samples_.resize(6 * std::size_t(side) * side);
    points_.resize(samples_.size());
    std::vector<DirectionCell> cells;
    for (int face = 0; face < 6; ++face) {
      for (std::uint32_t i = 0; i < side; ++i) {
        for (std::uint32_t j = 0; j < side; ++j) cells.push_back({face, level_, i, j});
      }
    }
    parallel_for(cells.size(), directions_per_task, options.threads,
                 [&](std::size_t begin, std::size_t end) {
                   options.progress.check();
                   SupportQuery query(scene, options.progress.stop);
                   for (std::size_t k = begin; k < end; ++k) {
                     const auto c = cells[k].corners();
                     const dvec3 n = unit(c[0] + c[1] + c[2] + c[3]);
                     const Support s = query(n);
                     samples_[cells[k].index()] = {n, s.contact};
                     points_[cells[k].index()] = s.point;
                   }
                 });
  }

  const std::vector<Sample>& samples() const { return samples_; }
  const std::vector<dvec3>& points() const { return points_; }
  /// Index of the sample whose cell holds the direction.
  std::size_t nearest(const dvec3& n) const { return DirectionCell::of(n, level_).index(); }
  /// The pyramid is so wide that its axis has a sample that is as good as its own.
  bool is_dense_in(const NormalPyramid& pyramid) const {
    const double width = std::min(glm::distance(pyramid.corners[0], pyramid.corners[2]),
                                  glm::distance(pyramid.corners[1], pyramid.corners[3]));
    return width > dense_samples * std::ldexp(2.0, -level_);
  }

 private:
  static constexpr std::size_t directions_per_task = 64;

  int level_;
  std::vector<Sample> samples_;
  std::vector<dvec3> points_;
};

/// What one patch of one instance contributes to the result.
struct PatchResult {
  std::vector<Sample> samples;
  std::vector<dvec3> frame_points;
  std::vector<CulledCell> cells;
  std::vector<CullingLevel> levels;
  long queries = 0;
};

/// Scratch memory of a task.
struct Tools {
  Tools(const Scene& scene, ConcaveSurroundings& with, Stop stop = {})
      : query(scene, stop), reach(scene, std::move(stop)), surroundings(with) {}
  /// To be asked before each query; those that are not made count too.
  bool may_ask() {
    ++asked;
    return query.cells() < cells_a_task + cells_a_query * asked;
  }
  SupportQuery query;
  ReachTest reach;
  ConcaveSurroundings& surroundings;
  long asked = 0;
  std::vector<std::array<CellNets, 4>> quarters;  // per level
};

/// Culls the cells of one patch of one instance, depth first.
class PatchCulling {
 public:
  PatchCulling(const Scene& scene, const GaussMap& map, const SpreadSamples& spread, int instance,
               int root, int levels, Tools& tools)
      : content_(scene.content()),
        spread_(spread),
        instance_(instance),
        placed_(content_.instances[std::size_t(instance)]),
        back_(glm::inverse(placed_.rotation)),
        nodes_(map.nodes(placed_.part)),
        element_(content_.parts[std::size_t(placed_.part)]
                     .elements[std::size_t(nodes_[std::size_t(root)].element)]),
        finest_(levels),
        nets_(element_),
        tools_(tools) {
    result_.levels.resize(std::size_t(levels) + 1);
    if (map.ruled(placed_.part, root)) {
      ++at(0).visited;
      ++at(0).ruled;
      finish({}, CellState::ruled, {false, false});
      return;
    }
    visit({}, root, nodes_[std::size_t(root)].bounds, nets_.root(), {true, true}, {});
  }

  PatchResult&& result() { return std::move(result_); }

 private:
  using Beacons = std::array<Beacon, 2>;  // for the normals and their opposites

  CullingLevel& at(int level) { return result_.levels[std::size_t(level)]; }
  /// Normals and points go by the inverse and its transpose: rotations are orthogonal only within
  /// rotation_tolerance.
  dvec3 to_frame(const dvec3& n) const { return placed_.rotated ? glm::transpose(back_) * n : n; }
  dvec3 to_local(const dvec3& x) const {
    const dvec3 moved = x - placed_.translation;
    return placed_.rotated ? back_ * moved : moved;
  }

  void finish(const PatchCell& cell, CellState state, const ContactSigns& signs,
              bool definite = false) {
    result_.cells.push_back({instance_, element_.index, cell, state, signs, definite});
  }

  /// `node`: the cell's node in the Gauss map, -1 below its leaves. `signs` are those that its
  /// parent has left.
  void visit(const PatchCell& cell, int node, const NormalBounds& bounds, const CellNets& nets,
             const ContactSigns& signs, Beacons beacons) {
    CullingLevel& count = at(cell.level);
    ++count.visited;
    ContactSigns left = {signs.plus && bounds.signs.plus, signs.minus && bounds.signs.minus};
    if (!left.any()) {
      ++count.off_by_curvature;
      finish(cell, CellState::off, left);
      return;
    }
    if (bounds.pyramid) {
      const NormalPyramid& pyramid = *bounds.pyramid;
      const bool may_be_on = left.plus != left.minus;
      const double sign = left.plus ? 1 : -1;
      Beacon& beacon = beacons[left.plus ? 0 : 1];
      // Where the parent's support point is here, the proof needs no query.
      const bool near = may_be_on && is_near(beacon, cell);
      bool on = near && surely_on(bounds, nets.points, cell, sign);
      if (on) {
        sample_middle(cell, sign);
      } else {
        if (left.plus) left.plus = !surely_off(pyramid, nets.points, cell, 1, beacons[0]);
        if (left.minus) left.minus = !surely_off(pyramid, nets.points, cell, -1, beacons[1]);
        if (!left.any()) {
          ++count.off_by_samples;
          finish(cell, CellState::off, left);
          return;
        }
        on = left.plus != left.minus && !near && is_near(beacons[left.plus ? 0 : 1], cell) &&
             surely_on(bounds, nets.points, cell, left.plus ? 1 : -1);
      }
      if (on) {
        ++count.on;
        finish(cell, CellState::on, left);
        return;
      }
    }
    ++count.kept;
    if (cell.level == finest_) {
      finish(cell, CellState::mixed, left, bounds.definite);
      return;
    }
    refine(cell, node, nets, left, beacons);
  }

  void refine(const PatchCell& cell, int node, const CellNets& nets, const ContactSigns& left,
              const Beacons& beacons) {
    const auto depth = std::size_t(cell.level);
    if (tools_.quarters.size() <= depth) tools_.quarters.resize(std::size_t(finest_));
    std::array<CellNets, 4>& quarters = tools_.quarters[depth];
    nets_.quarter_points(nets.points, quarters);
    const std::int32_t first = node < 0 ? -1 : nodes_[std::size_t(node)].first_child;
    if (first < 0) {
      // The first level below the map begins with the patch's normals.
      nets_.quarter_normals(node < 0 ? nets.normals : nets_.normals(cell.u(), cell.v()), quarters);
    }
    for (std::uint32_t k = 0; k < 4; ++k) {
      const PatchCell child = cell.child(k);
      if (first >= 0) {
        const int next = first + int(k);
        visit(child, next, nodes_[std::size_t(next)].bounds, quarters[k], left, beacons);
      } else {
        visit(child, -1, nets_.bounds(quarters[k], child.level), quarters[k], left, beacons);
      }
    }
  }

  /// Compares with the parent's sample, with the nearest of the spread ones, then with the cell's
  /// own, which takes the parent's place.
  bool surely_off(const NormalPyramid& pyramid, const std::vector<dvec4>& points,
                  const PatchCell& cell, double sign, Beacon& beacon) {
    dvec4 highest(-std::numeric_limits<double>::infinity());
    for (const dvec4& p : points) {
      dvec4 h(glm::dot(dvec3(p), pyramid.corners[0]), glm::dot(dvec3(p), pyramid.corners[1]),
              glm::dot(dvec3(p), pyramid.corners[2]), glm::dot(dvec3(p), pyramid.corners[3]));
      h *= element_.rational ? sign / p.w : sign;
      highest = glm::max(highest, h);
    }
    const auto is_above = [&](const dvec3& x) {
      for (int k = 0; k < 4; ++k) {
        const dvec3& n = pyramid.corners[std::size_t(k)];
        // Rounding of the control points' values, of the sampled point and of its value.
        const double error = 3 * content_.rounding * glm::length(n);
        if (!(sign * glm::dot(x, n) > highest[k] + error)) return false;
      }
      return true;
    };
    if (beacon.known && is_above(beacon.local)) return true;
    const dvec3 axis = sign * pyramid.axis;
    const dvec3 n = unit(to_frame(axis));
    const std::size_t near = spread_.nearest(n);
    const Beacon nearest{spread_.samples()[near].contact, to_local(spread_.points()[near]), true};
    if (is_above(nearest.local)) return true;
    if (spread_.is_dense_in(pyramid) || !tools_.may_ask()) {
      beacon = nearest;
      return false;
    }
    const Support s = tools_.query(n, hint(axis, cell, {beacon, nearest}));
    ++result_.queries;
    result_.samples.push_back({n, s.contact});
    result_.frame_points.push_back(s.point);
    beacon = {s.contact, to_local(s.point), true};
    return is_above(beacon.local);
  }

  /// The cell's middle or one of the contacts known, whichever is highest.
  Contact hint(const dvec3& axis, const PatchCell& cell,
               const std::array<Beacon, 2>& beacons) const {
    Contact best{instance_, SourceKind::face, element_.index,
                 0.5 * (cell.u().lower + cell.u().upper), 0.5 * (cell.v().lower + cell.v().upper)};
    double highest = glm::dot(content_.local_point(best), axis);
    for (const Beacon& beacon : beacons) {
      if (!beacon.known || glm::dot(beacon.local, axis) <= highest) continue;
      best = beacon.contact;
      highest = glm::dot(beacon.local, axis);
    }
    return best;
  }

  /// The interval and some of its lengths on either side, within [0, 1].
  static Interval grown(const Interval& t, int lengths) {
    const double length = t.upper - t.lower;
    return {std::max(0.0, t.lower - lengths * length), std::min(1.0, t.upper + lengths * length)};
  }

  /// A contact is on the cell or next to it.
  bool is_near(const Beacon& beacon, const PatchCell& cell) const {
    const Contact& c = beacon.contact;
    if (!beacon.known || c.instance != instance_ || c.kind != SourceKind::face ||
        c.element != element_.index) {
      return false;
    }
    const Interval u = grown(cell.u(), 1);
    const Interval v = grown(cell.v(), 1);
    return c.u >= u.lower && c.u <= u.upper && c.v >= v.lower && c.v <= v.upper;
  }

  /// Other patches share a side of the cell, or all of a side is one point: nothing beyond it can
  /// be proven to stay below.
  bool touches_another(const PatchCell& cell) const {
    const std::uint32_t last = (std::uint32_t{1} << cell.level) - 1;
    const std::array<bool, 4> touches = {cell.i == 0, cell.i == last, cell.j == 0, cell.j == last};
    for (const Side side : all_sides) {
      const Border& border = patch().borders[std::size_t(side)];
      if (touches[std::size_t(side)] &&
          (border.neighbor >= 0 || border.kind == BorderKind::collapsed)) {
        return true;
      }
    }
    return false;
  }

  const Patch& patch() const {
    return content_.model.parts()[std::size_t(placed_.part)].patches()[std::size_t(element_.index)];
  }

  /// A cell that is on has its own support points.
  void sample_middle(const PatchCell& cell, double sign) {
    const double u = 0.5 * (cell.u().lower + cell.u().upper);
    const double v = 0.5 * (cell.v().lower + cell.v().upper);
    const Contact middle{instance_, SourceKind::face, element_.index, u, v};
    result_.samples.push_back({unit(to_frame(sign * unit_normal(patch().bezier, u, v))), middle});
    result_.frame_points.push_back(content_.frame_point(middle));
  }

  /// Cells of the finest level are not tried with others.
  bool surely_on(const NormalBounds& bounds, const std::vector<dvec4>& points,
                 const PatchCell& cell, double sign) {
    const NormalPyramid& pyramid = *bounds.pyramid;
    const bool alone = bounds.definite && !touches_another(cell);
    return (alone && surely_on_alone(pyramid, points, cell, sign)) ||
           (cell.level < finest_ && surely_on_with_others(pyramid, cell, sign));
  }

  bool surely_on_alone(const NormalPyramid& pyramid, const std::vector<dvec4>& points,
                       const PatchCell& cell, double sign) {
    std::array<dvec3, 4> corners = pyramid.corners;
    for (dvec3& n : corners) n *= sign;
    const auto is_concave = [&](const std::vector<dvec4>& net) {
      return second_form(element_.shape, element_.rational, net, points, corners,
                         nets_.point_rounding())
          .surely_negative();
    };
    PatchRectangle region{instance_, element_.index, {0, 1}, {0, 1}};
    bool concave = is_concave(nets_.root().points);
    for (int k = widest_surrounding; !concave && k > 0; k /= 2) {
      region.u = grown(cell.u(), k);
      region.v = grown(cell.v(), k);
      concave = is_concave(nets_.points(region.u, region.v));
    }
    if (!concave) return false;
    for (dvec3& n : corners) n = to_frame(n);
    return tools_.reach.surely_below(points_around(cell, region), corners, {&region, 1},
                                     cell.level + 1);
  }

  bool surely_on_with_others(const NormalPyramid& pyramid, const PatchCell& cell, double sign) {
    return supports_in_middle(cell, sign) &&
           tools_.surroundings.surely_on(instance_, element_.index, cell, pyramid, sign);
  }

  /// The middle supports its normal; otherwise there is no need to look further.
  bool supports_in_middle(const PatchCell& cell, double sign) {
    const Contact middle{instance_, SourceKind::face, element_.index, cell.u().at(0.5),
                         cell.v().at(0.5)};
    const dvec3 normal = sign * unit_normal(patch().bezier, middle.u, middle.v);
    if (normal == dvec3(0.0) || !tools_.may_ask()) return false;
    const dvec3 n = unit(to_frame(normal));
    const Support s = tools_.query(n, middle);
    ++result_.queries;
    if (glm::dot(s.point - content_.frame_point(middle), n) <=
        middle_rounding * content_.rounding) {
      return true;
    }
    result_.samples.push_back({n, s.contact});
    result_.frame_points.push_back(s.point);
    return false;
  }

  /// Points of the region in rings about the cell, in the scene's frame. Any of them may be
  /// compared with; best is one between the cell and what is to be beaten.
  std::vector<dvec3> points_around(const PatchCell& cell, const PatchRectangle& region) const {
    const double size = cell.u().upper - cell.u().lower;
    const double u = 0.5 * (cell.u().lower + cell.u().upper);
    const double v = 0.5 * (cell.v().lower + cell.v().upper);
    std::vector<dvec3> points;
    const auto add = [&](double x, double y) {
      const Contact c{instance_, SourceKind::face, element_.index,
                      std::clamp(x, region.u.lower, region.u.upper),
                      std::clamp(y, region.v.lower, region.v.upper)};
      points.push_back(content_.frame_point(c));
    };
    add(u, v);
    for (const double radius : ring_radii) {
      for (int k = 0; k < 9; ++k) {
        const int along_u = k / 3 - 1;
        const int along_v = k % 3 - 1;
        if (k != 4) add(u + along_u * radius * size, v + along_v * radius * size);
      }
    }
    return points;
  }

  const SceneContent& content_;
  const SpreadSamples& spread_;
  int instance_;
  const SceneInstance& placed_;
  dmat3 back_;
  std::span<const GaussNode> nodes_ = {};
  const SceneElement& element_;
  int finest_;
  PatchNets nets_;
  Tools& tools_;
  PatchResult result_;
};

/// A patch of an instance.
struct CellPlace {
  int instance;
  int root;
};

void append(const PatchResult& from, Culling& to) {
  to.support_queries += from.queries;
  to.samples.insert(to.samples.end(), from.samples.begin(), from.samples.end());
  to.frame_points.insert(to.frame_points.end(), from.frame_points.begin(), from.frame_points.end());
  to.cells.insert(to.cells.end(), from.cells.begin(), from.cells.end());
  for (std::size_t l = 0; l < from.levels.size(); ++l) {
    CullingLevel& sum = to.levels[l];
    const CullingLevel& more = from.levels[l];
    sum.visited += more.visited;
    sum.off_by_samples += more.off_by_samples;
    sum.off_by_curvature += more.off_by_curvature;
    sum.on += more.on;
    sum.ruled += more.ruled;
    sum.kept += more.kept;
  }
}

void add_shares(std::size_t patches, std::vector<CullingLevel>& levels) {
  double removed = 0;
  double decided = 0;
  double cell = patches > 0 ? 1.0 / double(patches) : 0;
  for (CullingLevel& level : levels) {
    removed += cell * double(level.off_by_samples + level.off_by_curvature);
    decided += cell * double(level.on + level.ruled);
    level.removed_share = removed;
    level.decided_share = removed + decided;
    cell /= 4;
  }
}

}  // namespace

std::set<std::pair<int, int>> mixed_patches(const std::vector<CulledCell>& cells) {
  std::set<std::pair<int, int>> patches;
  for (const CulledCell& cell : cells) {
    if (cell.state == CellState::mixed) patches.emplace(cell.instance, cell.patch);
  }
  return patches;
}

int culling_levels(long patches) {
  int levels = default_levels;
  while (levels > 0 && patches * (1L << (2 * levels)) > cells_in_all) --levels;
  return levels;
}

long Culling::visited() const {
  long sum = 0;
  for (const CullingLevel& level : levels) sum += level.visited;
  return sum;
}

long Culling::mixed() const { return levels.empty() ? 0 : levels.back().kept; }

Culling cull(const Scene& scene, const GaussMap& map, const CullingOptions& options) {
  if (options.levels < 0 || options.levels > level_limit) {
    throw InvalidInput("levels of culling must be 0 .. 20, not " + std::to_string(options.levels));
  }
  options.progress.update("cull", 0);
  Culling result;
  result.levels.resize(std::size_t(options.levels) + 1);
  const SceneContent& content = scene.content();
  std::vector<CellPlace> places;
  for (const int i : content.distinct_instances) {
    const int roots = map.root_count(content.instances[std::size_t(i)].part);
    for (int root = 0; root < roots; ++root) places.push_back({i, root});
  }
  const SpreadSamples spread(scene, places.size(), options);
  result.samples = spread.samples();
  result.frame_points = spread.points();
  result.support_queries = long(spread.samples().size());
  std::vector<PatchResult> results(places.size());
  Pool<ConcaveSurroundings> surroundings(
      [&] { return std::make_unique<ConcaveSurroundings>(scene, options.progress.stop); });
  const std::size_t patches_per_task =
      std::clamp(places.size() / tasks, least_patches_per_task, most_patches_per_task);
  parallel_for(places.size(), patches_per_task, options.threads,
               [&](std::size_t begin, std::size_t end) {
                 const Pool<ConcaveSurroundings>::Lease lent = surroundings.lease();
                 (*lent).begin_anew();  // whichever tasks had it before
                 Tools tools(scene, *lent, options.progress.stop);
                 for (std::size_t k = begin; k < end; ++k) {
                   options.progress.check();
                   results[k] = PatchCulling(scene, map, spread, places[k].instance, places[k].root,
                                             options.levels, tools)
                                    .result();
                 }
               });
  for (const PatchResult& patch : results) append(patch, result);
  add_shares(places.size(), result.levels);
  options.progress.update("cull", 1);
  return result;
}

}  // namespace taut
