#include "taut/hull/concave_surroundings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "taut/bounds/curvature_nets.h"
#include "taut/bounds/scene_content.h"
#include "taut/bounds/vector_net.h"

namespace taut {
namespace {

/// Cells on either side of the cell that need not stay below it, tried one after the other; half as
/// many more are to be concave.
constexpr std::array widths = {4, 2, 1};
/// Rectangles after which the surroundings are given up: two rings of patches about one are 25.
constexpr std::size_t rectangle_limit = 32;
/// The same of those that have grown together on the way.
constexpr std::size_t growth_limit = 2 * rectangle_limit;
/// Distance that is kept clear of the outline, in the cell's sizes, far more than rounding.
constexpr double clearance = 1e-6;
/// Parts of a rectangle, in each direction, the control points of which bound where it is.
constexpr int parts = 2;
/// Levels below a cell's down to which its surroundings are looked at.
constexpr int finer_levels = 1;

bool disjoint(const Interval& a, const Interval& b) {
  return a.upper <= b.lower || b.upper <= a.lower;
}

bool contains(const Interval& a, const Interval& b) {
  return a.lower <= b.lower && a.upper >= b.upper;
}

Interval united(const Interval& a, const Interval& b) {
  return {std::min(a.lower, b.lower), std::max(a.upper, b.upper)};
}

/// The interval with so many of its lengths on either side.
Interval widened(const Interval& t, int lengths) {
  const double length = t.upper - t.lower;
  return {t.lower - lengths * length, t.upper + lengths * length};
}

/// What of it is in [0, 1].
Interval clipped(const Interval& t) { return {std::max(0.0, t.lower), std::min(1.0, t.upper)}; }

/// The points of a net's side, without their weights.
std::vector<dvec3> side_points(NetShape shape, const std::vector<dvec4>& net, Side side) {
  std::vector<dvec3> result;
  const int count = along_v(side) ? shape.q : shape.p;
  result.reserve(std::size_t(count) + 1);
  for (int k = 0; k <= count; ++k) {
    const int i = along_v(side) ? (at_upper_end(side) ? shape.p : 0) : k;
    const int j = along_v(side) ? k : (at_upper_end(side) ? shape.q : 0);
    result.push_back(euclidean(net[std::size_t(i * (shape.q + 1) + j)]));
  }
  return result;
}

/// Coordinates in the plane normal to an axis, by two vectors that span another one.
class PlaneMap {
 public:
  /// @pre the axis is not in the plane of the two
  PlaneMap(const dvec3& center, const dvec3& axis, const dvec3& a, const dvec3& b)
      : center_(center) {
    const double volume = glm::dot(glm::cross(a, b), axis);
    to_a_ = glm::cross(b, axis) / volume;
    to_b_ = glm::cross(axis, a) / volume;
  }
  dvec2 operator()(const dvec3& x) const {
    return {glm::dot(x - center_, to_a_), glm::dot(x - center_, to_b_)};
  }

 private:
  dvec3 center_, to_a_, to_b_;
};

/// A line is found that parts the convex hulls of two sets of points, the first one near the
/// segment between its ends.
bool are_apart(const std::vector<dvec2>& curve, const std::vector<dvec2>& points) {
  const dvec2 chord = curve.back() - curve.front();
  const dvec2 middle = curve.back() + curve.front();
  const std::array<dvec2, 3> directions = {dvec2(chord.y, -chord.x), dvec2(-chord.y, chord.x),
                                           middle};
  return std::any_of(directions.begin(), directions.end(), [&](const dvec2& d) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const dvec2& p : curve) least = std::min(least, glm::dot(p, d));
    for (const dvec2& p : points) most = std::max(most, glm::dot(p, d));
    return least > most + clearance * glm::length(d);
  });
}

}  // namespace

/// A rectangle of a patch of the cell's part, or one that reaches beyond the patch.
struct ConcaveSurroundings::Rectangle {
  int patch = -1;
  Interval u, v;

  bool contains(const Rectangle& other) const {
    return patch == other.patch && taut::contains(u, other.u) && taut::contains(v, other.v);
  }
  bool overlaps(const Rectangle& other) const {
    return patch == other.patch && !disjoint(u, other.u) && !disjoint(v, other.v);
  }
  Rectangle on_patch() const { return {patch, clipped(u), clipped(v)}; }
  const Interval& across(Side side) const { return along_v(side) ? u : v; }
  const Interval& along(Side side) const { return along_v(side) ? v : u; }
  /// Its side lies on that of the patch.
  bool reaches(Side side) const {
    return at_upper_end(side) ? across(side).upper == 1 : across(side).lower == 0;
  }
  /// How far it reaches beyond a side of its patch.
  double excess(Side side) const {
    return at_upper_end(side) ? across(side).upper - 1 : -across(side).lower;
  }
  /// Where it runs along a side, in the parameter of the patch beyond.
  Interval along_beyond(Side side, const Border& border) const {
    const Interval& t = along(side);
    return border.reversed ? Interval{1 - t.upper, 1 - t.lower} : t;
  }
  /// What reaches beyond a side, in the parameters of the patch there.
  Rectangle beyond(Side side, const Border& border) const {
    const Interval next_along = along_beyond(side, border);
    const double depth = excess(side);
    const Interval next_across =
        at_upper_end(border.neighbor_side) ? Interval{1 - depth, 1.0} : Interval{0.0, depth};
    return along_v(border.neighbor_side) ? Rectangle{border.neighbor, next_across, next_along}
                                         : Rectangle{border.neighbor, next_along, next_across};
  }
  std::vector<Rectangle> divided() const {
    const auto part = [](const Interval& t, int k) {
      return Interval{k == 0 ? t.lower : t.at(double(k) / parts),
                      k + 1 == parts ? t.upper : t.at((k + 1.0) / parts)};
    };
    std::vector<Rectangle> result;
    result.reserve(std::size_t(parts * parts));
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; j < parts; ++j) result.push_back({patch, part(u, i), part(v, j)});
    }
    return result;
  }
  /// The side of one of its parts lies on its own.
  bool has_side(const Rectangle& part, Side side) const {
    return at_upper_end(side) ? part.across(side).upper == across(side).upper
                              : part.across(side).lower == across(side).lower;
  }
};

/// A patch, with a quadtree of where it is curved one way, which grows as it is asked.
class ConcaveSurroundings::Surface {
 public:
  Surface(const SceneElement& element, const Patch& patch)
      : shape_(element.shape), bezier_(bezier(element)), curvature_(bezier_, poles(patch)) {
    nodes_.push_back({});
  }

  NetShape shape() const { return shape_; }
  std::vector<dvec4> points(const Rectangle& r) const {
    std::vector<dvec4> net = bezier_.points;
    restrict_net(shape_, net.data(), r.u, r.v);
    return net;
  }

  /// By how much the normals at the ends of a cell's middle line part, times its length.
  double fall(const PatchCell& cell, Direction direction) const {
    const bool of_u = direction == Direction::u;
    const auto at = [&](double t) {
      return of_u ? dvec2(cell.u().at(t), cell.v().at(0.5))
                  : dvec2(cell.u().at(0.5), cell.v().at(t));
    };
    const dvec2 low = at(0);
    const dvec2 high = at(1);
    const dvec3 turn = unit_normal(bezier_, high.x, high.y) - unit_normal(bezier_, low.x, low.y);
    const dvec3 length = point(bezier_, high.x, high.y) - point(bezier_, low.x, low.y);
    return std::abs(glm::dot(turn, length));
  }

  /// Certain: there it is curved one way, downwards where m is up, with normals within a right
  /// angle of m or of its opposite. Cells down to that level are looked at.
  bool is_concave(const Rectangle& r, const dvec3& m, int level) {
    return is_concave(r, m, level, 0, {});
  }

 private:
  struct Node {
    bool known = false;
    int first_child = -1;
    double sign = 0;  ///< of the normals for which it is concave; 0: not known to be
    NormalPyramid pyramid;
  };

  static BezierPatch bezier(const SceneElement& element) {
    BezierPatch patch{element.shape.p, element.shape.q, {}};
    const SceneNet& net = element.net;
    patch.points.reserve(net.x.size());
    for (std::size_t k = 0; k < net.x.size(); ++k) {
      patch.points.emplace_back(net.x[k], net.y[k], net.z[k], net.w[k]);
    }
    return patch;
  }

  static std::array<bool, 4> poles(const Patch& patch) {
    std::array<bool, 4> result{};
    for (const Side side : all_sides) {
      const Border& border = patch.borders[std::size_t(side)];
      result[std::size_t(side)] = border.kind == BorderKind::collapsed && border.vertex < 0;
    }
    return result;
  }

  bool is_concave(const Rectangle& r, const dvec3& m, int finest, std::size_t index,
                  const PatchCell& cell) {
    if (disjoint(r.u, cell.u()) || disjoint(r.v, cell.v())) return true;
    if (!nodes_[index].known) look(nodes_[index], cell);
    const Node& node = nodes_[index];
    if (node.sign != 0) {
      const double sign = glm::dot(node.pyramid.axis, m) > 0 ? 1 : -1;
      const bool faces = std::all_of(node.pyramid.corners.begin(), node.pyramid.corners.end(),
                                     [&](const dvec3& n) { return sign * glm::dot(n, m) > 0; });
      if (faces) return sign == node.sign;
    }
    if (cell.level >= finest) return false;
    if (node.first_child < 0) {
      nodes_[index].first_child = int(nodes_.size());
      nodes_.resize(nodes_.size() + 4);
    }
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::size_t child = std::size_t(nodes_[index].first_child) + k;
      if (!is_concave(r, m, finest, child, cell.child(k))) return false;
    }
    return true;
  }

  void look(Node& node, const PatchCell& cell) const {
    node.known = true;
    const SecondForm form = curvature_.over(cell.u(), cell.v());
    const bool negative = form.surely_negative();
    if (!negative && !form.surely_positive()) return;
    const std::optional<NormalPyramid> pyramid = curvature_.normals(cell.u(), cell.v());
    if (!pyramid) return;
    node.pyramid = *pyramid;
    node.sign = negative ? 1 : -1;
  }

  NetShape shape_;
  BezierPatch bezier_;
  CurvatureNets curvature_;
  std::vector<Node> nodes_;
};

/// What surrounds a cell.
class ConcaveSurroundings::Neighborhood {
 public:
  Neighborhood(ConcaveSurroundings& of, int instance, int patch, const PatchCell& cell,
               const dvec3& axis)
      : content_(of.scene_.content()),
        instance_(instance),
        part_(content_.instances[std::size_t(instance)].part),
        surfaces_(of.surfaces_),
        own_{patch, cell.u(), cell.v()},
        level_(cell.level),
        axis_(axis) {
    const std::vector<dvec4> net = surface(patch).points(own_);
    const std::vector<dvec3> low = side_points(surface(patch).shape(), net, Side::u0);
    const std::vector<dvec3> high = side_points(surface(patch).shape(), net, Side::u1);
    center_ = 0.25 * (low.front() + low.back() + high.front() + high.back());
    along_u_ = 0.5 * (high.front() + high.back() - low.front() - low.back());
    along_v_ = 0.5 * (low.back() + high.back() - low.front() - high.front());
    flat_ = glm::dot(glm::cross(along_u_, along_v_), axis) != 0;
    if (!flat_) return;
    // How far the surface falls below its tangent plane within a cell's length.
    const double fall_u = surface(patch).fall(cell, Direction::u);
    const double fall_v = surface(patch).fall(cell, Direction::v);
    if (!(fall_u > 0 && fall_v > 0)) return;
    const double lengths = std::ldexp(1.0, cell.level);
    stretch_u_ = int(std::clamp(std::round(std::sqrt(fall_v / fall_u)), 1.0, lengths));
    stretch_v_ = int(std::clamp(std::round(std::sqrt(fall_u / fall_v)), 1.0, lengths));
  }

  /// The cell is no segment or point as seen along the axis.
  bool is_sound() const { return flat_; }

  /// The rectangles within so many lengths of the cell, those of its longer side where the other
  /// one is shorter, over smooth joins too; none if they are too many. Where two of a patch overlap
  /// yet, their sides count as outline, which proves less.
  std::vector<Rectangle> within(int lengths) const {
    std::vector<Rectangle> wide = {around_poles({own_.patch, widened(own_.u, lengths * stretch_u_),
                                                 widened(own_.v, lengths * stretch_v_)})};
    std::vector<std::size_t> waiting = {0};
    while (!waiting.empty()) {
      const Rectangle r = wide[waiting.back()];
      waiting.pop_back();
      if (r.patch < 0) continue;
      for (const Side side : all_sides) {
        const Border& border = patches()[std::size_t(r.patch)].borders[std::size_t(side)];
        if (border.kind != BorderKind::smooth || !(r.excess(side) > 0)) continue;
        Rectangle next = around_poles(r.beyond(side, border));
        const bool known = std::any_of(
            wide.begin(), wide.end(), [&](const Rectangle& other) { return other.contains(next); });
        if (known) continue;
        // What has come to the patch another way is one with it.
        for (std::size_t k = 0; k < wide.size(); ++k) {
          if (!wide[k].overlaps(next)) continue;
          next.u = united(next.u, wide[k].u);
          next.v = united(next.v, wide[k].v);
          wide[k].patch = -1;
        }
        if (wide.size() == growth_limit) return {};
        waiting.push_back(wide.size());
        wide.push_back(next);
      }
    }
    std::vector<Rectangle> result;
    for (const Rectangle& r : wide) {
      if (r.patch >= 0) result.push_back(r.on_patch());
    }
    if (result.size() > rectangle_limit) result.clear();
    return result;
  }

  /// Some points of them, in the scene's frame.
  std::vector<dvec3> points(const std::vector<Rectangle>& rectangles) const {
    std::vector<dvec3> result;
    result.reserve(9 * rectangles.size());
    for (const Rectangle& r : rectangles) {
      for (const double s : {0.0, 0.5, 1.0}) {
        for (const double t : {0.0, 0.5, 1.0}) {
          result.push_back(
              content_.frame_point({instance_, SourceKind::face, r.patch, r.u.at(s), r.v.at(t)}));
        }
      }
    }
    return result;
  }

  std::vector<PatchRectangle> regions(const std::vector<Rectangle>& rectangles) const {
    std::vector<PatchRectangle> result;
    result.reserve(rectangles.size());
    for (const Rectangle& r : rectangles) result.push_back({instance_, r.patch, r.u, r.v});
    return result;
  }

  bool are_concave(const std::vector<Rectangle>& rectangles) const {
    return std::all_of(rectangles.begin(), rectangles.end(), [&](const Rectangle& r) {
      return surface(r.patch).is_concave(r, axis_, level_ + finer_levels);
    });
  }

  /// The outline of the outer rectangles does not meet the convex hull of what bounds the inner
  /// ones, as seen along the axis.
  bool surround(const std::vector<Rectangle>& outer, const std::vector<Rectangle>& inner) const {
    const PlaneMap map(center_, axis_, along_u_, along_v_);
    std::vector<dvec2> inside;
    for (const Rectangle& whole : inner) {
      for (const Rectangle& r : whole.divided()) {
        for (const dvec4& p : surface(r.patch).points(r)) inside.push_back(map(euclidean(p)));
      }
    }
    return std::all_of(outer.begin(), outer.end(), [&](const Rectangle& whole) {
      const std::vector<Rectangle> pieces = whole.divided();
      return std::all_of(pieces.begin(), pieces.end(), [&](const Rectangle& r) {
        return is_outline_apart(outer, whole, r, map, inside);
      });
    });
  }

 private:
  const std::vector<Patch>& patches() const {
    return content_.model.parts()[std::size_t(part_)].patches();
  }
  /// What reaches a pole goes all around it.
  Rectangle around_poles(Rectangle r) const {
    for (const Side side : all_sides) {
      const Border& border = patches()[std::size_t(r.patch)].borders[std::size_t(side)];
      if (border.kind != BorderKind::collapsed || border.vertex >= 0 || r.excess(side) < 0)
        continue;
      Interval& along = along_v(side) ? r.v : r.u;
      along = united(along, {-1, 2});
    }
    return r;
  }
  /// The side of the rectangle lies on that of its patch, and others of the rectangles beyond it.
  bool goes_on(const std::vector<Rectangle>& rectangles, const Rectangle& r, Side side) const {
    if (!r.reaches(side)) return false;
    const Border& border = patches()[std::size_t(r.patch)].borders[std::size_t(side)];
    if (border.kind == BorderKind::collapsed) return border.vertex < 0;
    if (border.kind != BorderKind::smooth) return false;
    const Interval along = r.along_beyond(side, border);
    return std::any_of(rectangles.begin(), rectangles.end(), [&](const Rectangle& other) {
      return other.patch == border.neighbor && other.reaches(border.neighbor_side) &&
             contains(other.along(border.neighbor_side), along);
    });
  }
  /// The sides of a part of a rectangle that nothing is joined to do not meet the points' hull.
  bool is_outline_apart(const std::vector<Rectangle>& rectangles, const Rectangle& whole,
                        const Rectangle& r, const PlaneMap& map,
                        const std::vector<dvec2>& inside) const {
    const std::vector<dvec4> net = surface(r.patch).points(r);
    return std::all_of(all_sides.begin(), all_sides.end(), [&](const Side side) {
      if (!whole.has_side(r, side) || goes_on(rectangles, r, side)) return true;
      std::vector<dvec2> outline;
      for (const dvec3& p : side_points(surface(r.patch).shape(), net, side)) {
        outline.push_back(map(p));
      }
      return are_apart(outline, inside);
    });
  }

  Surface& surface(int patch) const {
    std::unique_ptr<Surface>& held = surfaces_[{part_, patch}];
    if (!held) {
      const int element = content_.element({instance_, SourceKind::face, patch, 0, 0});
      held = std::make_unique<Surface>(
          content_.parts[std::size_t(part_)].elements[std::size_t(element)],
          patches()[std::size_t(patch)]);
    }
    return *held;
  }

  const Scene::Content& content_;
  int instance_;
  int part_;
  std::map<std::pair<int, int>, std::unique_ptr<Surface>>& surfaces_;
  Rectangle own_;
  int level_;
  dvec3 axis_;
  dvec3 center_, along_u_, along_v_;
  int stretch_u_ = 1;
  int stretch_v_ = 1;
  bool flat_ = false;
};

ConcaveSurroundings::ConcaveSurroundings(const Scene& scene) : scene_(scene), reach_(scene) {}

ConcaveSurroundings::~ConcaveSurroundings() = default;

bool ConcaveSurroundings::surely_on(int instance, int patch, const PatchCell& cell,
                                    const NormalPyramid& pyramid, double sign) {
  const Neighborhood around(*this, instance, patch, cell, sign * pyramid.axis);
  if (!around.is_sound()) return false;
  const dmat3 rotation = scene_.content().instances[std::size_t(instance)].rotation;
  const bool rotated = scene_.content().instances[std::size_t(instance)].rotated;
  std::array<dvec3, 4> corners = pyramid.corners;
  for (dvec3& n : corners) n = sign * (rotated ? glm::transpose(glm::inverse(rotation)) * n : n);
  for (const int width : widths) {
    const std::vector<Rectangle> outer = around.within(width + (width + 1) / 2);
    if (outer.empty() || !around.are_concave(outer)) continue;
    const std::vector<Rectangle> inner = around.within(width);
    // What is nearer is no easier to be above of.
    if (!reach_.surely_below(around.points(inner), corners, around.regions(inner),
                             cell.level + 1)) {
      return false;
    }
    if (around.surround(outer, inner)) return true;
  }
  return false;
}

}  // namespace taut
