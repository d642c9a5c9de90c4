#include "taut/envelope/cull/patch_culling.h"

#include <algorithm>
#include <limits>
#include <span>

#include "taut/bounds/scene_content.h"
#include "taut/bounds/second_form.h"

namespace taut {
namespace {

/// By how many of its own sizes a cell is surrounded at most where the whole patch is too curved,
/// and then half as many, down to one. What is close to the cell must be inside: where the two
/// principal curvatures differ by a factor of k, a pyramid across them may hold normals that point
/// k cells away.
constexpr int widest_surrounding = 8;

/// Roundings by which a point that supports its normal may fall short of what a query finds.
constexpr double middle_rounding = 16;

/// Distances of the points that stand for a cell, in its sizes.
constexpr std::array<double, 2> ring_radii = {0.5, 2};

/// Cells that a task's queries may look at, and how many more each of them: ten times what is
/// usual, and more. Where much of a model is as high but for little, as about a pole of needles,
/// they take thousands, and decide next to nothing; the most of such cells are left.
constexpr long cells_a_task = 5'000;
constexpr long cells_a_query = 200;

/// A sampled point that a cell is compared with.
struct Beacon {
  Contact contact;
  dvec3 local;  ///< in the part's frame
  bool known = false;
};

/// Culls the cells of one patch of one instance, depth first.
class PatchCulling {
 public:
  PatchCulling(const Scene& scene, const GaussMap& map, const SpreadSamples& spread, int instance,
               int root, int levels, CullingTools& tools)
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

  CulledPatch&& result() { return std::move(result_); }

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
  CullingTools& tools_;
  CulledPatch result_;
};

}  // namespace

bool CullingTools::may_ask() {
  ++asked;
  return query.cells() < cells_a_task + cells_a_query * asked;
}

CulledPatch cull_patch(const Scene& scene, const GaussMap& map, const SpreadSamples& spread,
                       int instance, int root, int levels, CullingTools& tools) {
  return PatchCulling(scene, map, spread, instance, root, levels, tools).result();
}

}  // namespace taut
