#include "taut/hull/concave_surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>

#include "taut/bounds/scene_content.h"
#include "taut/hull/concave_patch.h"

namespace taut {
namespace {

/// Radii of the disc, in that of the cell, tried one after the other. At twice the cell's radius a
/// paraboloid is as high as the cell's tangent planes.
constexpr std::array<double, 3> disc_radii = {2, 3, 5};
/// Shares of the disc's radius. Within this one, what is curved one way is divided until it is
/// inside of the disc,
constexpr double inner = 0.8;
/// but for what is so narrow;
constexpr double coarse = 0.5;
/// and nothing so narrow is divided to find it curved one way.
constexpr double fine = 1.0 / 32;
/// Pieces of the surface after which a disc is given up.
constexpr std::size_t piece_limit = 512;
/// Nodes of patches' trees that are held, some kilobytes each, and cells after which they are
/// counted again.
constexpr std::size_t node_limit = 16384;
constexpr long cells_between_counts = 64;
/// Share of the radius that is kept clear of the border, far more than rounding.
constexpr double clearance = 1e-6;
/// The fall to one side of a cell as a share of that to another below which it counts as none.
constexpr double flat_share = 1e-10;
const double diagonal = std::sqrt(0.5);
/// Directions in which a disc is looked at first.
const std::array<dvec2, 8> spokes = {
    dvec2(1, 0), {diagonal, diagonal},   {0, 1},  {-diagonal, diagonal},
    {-1, 0},     {-diagonal, -diagonal}, {0, -1}, {diagonal, -diagonal}};
/// Points of a rectangle that are tried before it is divided.
const std::array<dvec2, 5> probes = {dvec2(0.5, 0.5), {0, 0}, {0, 1}, {1, 0}, {1, 1}};
/// Levels of a patch's tree.
constexpr int level_limit = 80;

/// Coordinates in the plane normal to an axis, about a point of a surface, in which the surface
/// falls below its tangent plane by half the square of the distance, to second order.
class FallMap {
 public:
  /// None if it does not fall to all sides, away from the axis. Of a stand-in, distances count.
  static std::optional<FallMap> about(const ConcavePatch& patch, const dvec2& p,
                                      const dvec3& axis) {
    const PatchJet2 jet = jet2(patch.bezier(), p.x, p.y);
    dvec3 n = glm::cross(jet.Su, jet.Sv);
    const double volume = glm::dot(n, axis);
    n *= std::copysign(1 / glm::length(n), volume);
    const bool falls = !patch.stand_in();
    const double uu = falls ? -glm::dot(jet.Suu, n) : glm::dot(jet.Su, jet.Su);
    const double uv = falls ? -glm::dot(jet.Suv, n) : glm::dot(jet.Su, jet.Sv);
    const double vv = falls ? -glm::dot(jet.Svv, n) : glm::dot(jet.Sv, jet.Sv);
    const double rest = vv - uv * uv / uu;
    if (!(uu > 0 && rest > flat_share * vv)) return {};
    const dvec3 to_u = glm::cross(jet.Sv, axis) / volume;
    const dvec3 to_v = glm::cross(axis, jet.Su) / volume;
    FallMap map;
    map.center_ = jet.S;
    map.uu_ = std::sqrt(uu);
    map.uv_ = uv / map.uu_;
    map.vv_ = std::sqrt(rest);
    map.x_ = map.uu_ * to_u + map.uv_ * to_v;
    map.y_ = map.vv_ * to_v;
    return map;
  }

  dvec2 operator()(const dvec3& p) const {
    return {glm::dot(p - center_, x_), glm::dot(p - center_, y_)};
  }
  /// The step in the surface's parameters, to first order.
  dvec2 step(const dvec2& to) const {
    const double dv = to.y / vv_;
    return {(to.x - uv_ * dv) / uu_, dv};
  }

 private:
  dvec3 center_, x_, y_;
  double uu_ = 0, uv_ = 0, vv_ = 0;  // of the map of the surface's parameters
};

/// A point of a patch, over a disc, where it is not curved one way.
bool bends_at(const ConcavePatch& surface, const dvec2& p, const FallMap& map, double radius) {
  return glm::length(map(point(surface.bezier(), p.x, p.y))) < radius &&
         !(surface.curvature(p) > 0);
}

/// Some points of a patch over a disc about one of them are not curved one way: there is no need to
/// look at the whole disc.
bool bends_within(const ConcavePatch& surface, const dvec2& middle, const FallMap& map,
                  double radius) {
  for (const dvec2& d : spokes) {
    const dvec2 p = glm::clamp(middle + map.step(0.9 * radius * d), 0.0, 1.0);
    if (bends_at(surface, p, map, radius)) return true;
  }
  return false;
}

/// A line is found that parts the points' convex hull from a disc about the origin.
bool are_apart(const std::vector<dvec2>& points, double radius) {
  dvec2 mean(0.0);
  dvec2 nearest = points.front();
  for (const dvec2& p : points) {
    mean += p;
    if (glm::dot(p, p) < glm::dot(nearest, nearest)) nearest = p;
  }
  const auto parts = [&](const dvec2& d) {
    const double least = radius * glm::length(d);
    return std::all_of(points.begin(), points.end(),
                       [&](const dvec2& p) { return glm::dot(p, d) > least; });
  };
  return parts(nearest) || parts(mean);
}

double farthest(const std::vector<dvec2>& points) {
  double result = 0;
  for (const dvec2& p : points) result = std::max(result, glm::length(p));
  return result;
}

double width(const Interval& t) { return t.upper - t.lower; }

/// Bound of the distance of any two of them.
double width(const std::vector<dvec2>& points) {
  dvec2 least = points.front();
  dvec2 most = least;
  for (const dvec2& p : points) {
    least = glm::min(least, p);
    most = glm::max(most, p);
  }
  return glm::distance(least, most);
}

/// A stretch of a line of constant parameter of a patch, as seen from one side of it.
struct Gate {
  bool of_u = true;     ///< the constant parameter is u
  double at = 0;        ///< its value
  bool upwards = true;  ///< towards larger ones
  Interval along;       ///< of the other parameter

  /// The rectangle has some of what is next to the stretch on that side.
  bool opens_into(const ParameterRectangle& cell) const {
    const Interval& across = of_u ? cell.u : cell.v;
    const Interval& other = of_u ? cell.v : cell.u;
    const bool reaches =
        upwards ? across.lower <= at && at < across.upper : across.lower < at && at <= across.upper;
    return reaches && other.lower < along.upper && along.lower < other.upper;
  }
  /// It is the border of the patch, seen from within.
  bool leaves_patch() const { return at == (upwards ? 1 : 0); }
};

/// Out of a rectangle, across its side.
Gate gate_of(const ParameterRectangle& cell, Side side) {
  const Interval& across = along_v(side) ? cell.u : cell.v;
  return {along_v(side), at_upper_end(side) ? across.upper : across.lower, at_upper_end(side),
          along_v(side) ? cell.v : cell.u};
}

/// Into the patch beyond a border.
Gate gate_beyond(const Gate& gate, const Border& border) {
  const Side side = border.neighbor_side;
  const Interval along =
      border.reversed ? Interval{1 - gate.along.upper, 1 - gate.along.lower} : gate.along;
  return {along_v(side), at_upper_end(side) ? 1.0 : 0.0, !at_upper_end(side), along};
}

/// The entries of a net's side take the place of others.
void take_side(NetShape shape, const std::vector<dvec2>& net, Side side,
               std::vector<dvec2>& entries) {
  entries.clear();
  const int count = along_v(side) ? shape.q : shape.p;
  for (int k = 0; k <= count; ++k) {
    const int i = along_v(side) ? (at_upper_end(side) ? shape.p : 0) : k;
    const int j = along_v(side) ? k : (at_upper_end(side) ? shape.q : 0);
    entries.push_back(net[std::size_t(i * (shape.q + 1) + j)]);
  }
}

}  // namespace

/// The surface over a disc, as far as it is joined to the disc's centre.
class ConcaveSurroundings::Walk {
 public:
  Walk(ConcaveSurroundings& of, int part, const dvec3& axis, const FallMap& map, double radius)
      : of_(of),
        number_(++of.walks_),
        part_(part),
        patches_(of.scene_.content().model.parts()[std::size_t(part)].patches()),
        axis_(axis),
        map_(map),
        radius_(radius) {}

  /// From a cell of a patch on. False if it is not certain that the surface is concave over the
  /// disc and goes on all over it.
  bool run(int patch, const ParameterRectangle& cell) {
    if (!begin(patch, of_.surface(part_, patch), 0, cell)) return false;
    while (!waiting_.empty()) {
      const int piece = waiting_.top().second;
      waiting_.pop();
      for (const Side side : all_sides) {
        if (!cross(piece, side)) return false;
      }
    }
    return true;
  }

  /// Cells of patches that lie over the disc, joined to the centre over it.
  std::vector<std::pair<int, ParameterRectangle>> inside() const {
    std::vector<std::pair<int, ParameterRectangle>> result;
    std::vector<bool> known(pieces_.size(), false);
    std::vector<int> waiting;
    const auto add = [&](int index) {
      if (known[std::size_t(index)] || !pieces_[std::size_t(index)].inside) return;
      known[std::size_t(index)] = true;
      waiting.push_back(index);
    };
    add(0);
    while (!waiting.empty()) {
      const Piece& piece = pieces_[std::size_t(waiting.back())];
      waiting.pop_back();
      result.emplace_back(piece.patch, piece.surface->cell(piece.node));
      for (const int next : piece.joined) add(next);
    }
    return result;
  }

 private:
  /// A node of a patch's tree where the surface is concave: the first from the root on that is
  /// small enough.
  struct Piece {
    int patch;
    ConcavePatch* surface;
    int node;
    std::vector<dvec2> net;  ///< its control points, as seen along the axis
    bool inside;             ///< of the disc
    std::vector<int> joined;
  };

  /// What a node is, besides the index of a piece.
  enum Found { apart = -1, divided = -2, failed = -3 };

  int look(int patch, ConcavePatch& surface, int node) {
    ConcavePatch::Mark& mark = surface.mark(node);
    if (mark.walk != number_) mark = {number_, found(patch, surface, node)};
    return mark.found;
  }

  int add(Piece piece) {
    const double k = piece.surface->curvature(piece.surface->cell(piece.node).middle());
    if (pieces_.empty()) curvature_ = k;
    pieces_.push_back(std::move(piece));
    const int index = int(pieces_.size()) - 1;
    const bool tells = std::isfinite(k) && std::isfinite(curvature_);
    waiting_.emplace(tells ? std::abs(std::log(k / curvature_)) : 0, index);
    return index;
  }

  int found(int patch, ConcavePatch& surface, int node) {
    const std::vector<dvec3>& points = surface.points(node);
    std::vector<dvec2> net;
    net.reserve(points.size());
    for (const dvec3& p : points) net.push_back(map_(p));
    if (are_apart(net, (1 + clearance) * radius_)) return apart;
    const bool inside = farthest(net) <= radius_;
    const double size = width(net);
    const bool small = inside || size <= coarse * radius_ || are_apart(net, inner * radius_);
    if (!small) return divided;
    if (surface.is_concave(node, axis_)) {
      if (pieces_.size() == piece_limit) return failed;
      return add({patch, &surface, node, std::move(net), inside, {}});
    }
    const ParameterRectangle& cell = surface.cell(node);
    for (const dvec2& p : probes) {
      if (bends_at(surface, {cell.u.at(p.x), cell.v.at(p.y)}, map_, radius_)) return failed;
    }
    return size > fine * radius_ && surface.level(node) < level_limit ? divided : failed;
  }

  /// All of the cell itself: where it fails, it does so soon.
  bool begin(int patch, ConcavePatch& surface, int node, const ParameterRectangle& cell) {
    if (!surface.cell(node).overlaps(cell)) return true;
    const int found = look(patch, surface, node);
    if (found != divided) return found != failed;
    for (int k = 0; k < 2; ++k) {
      if (!begin(patch, surface, surface.child(node, k), cell)) return false;
    }
    return true;
  }

  /// To what is joined to a piece at its side, where that is over the disc.
  bool cross(int index, Side side) {
    const Piece& piece = pieces_[std::size_t(index)];
    take_side(piece.surface->shape(), piece.net, side, line_);
    if (are_apart(line_, (1 + clearance) * radius_)) return true;
    const Gate gate = gate_of(piece.surface->cell(piece.node), side);
    if (!gate.leaves_patch()) return enter(index, piece.patch, *piece.surface, 0, gate);
    const Border& border = patches_[std::size_t(piece.patch)].borders[std::size_t(side)];
    if (border.kind == BorderKind::collapsed) return border.vertex < 0;
    return border.kind == BorderKind::smooth &&
           enter(index, border.neighbor, of_.surface(part_, border.neighbor), 0,
                 gate_beyond(gate, border));
  }

  bool enter(int from, int patch, ConcavePatch& surface, int node, const Gate& gate) {
    if (!gate.opens_into(surface.cell(node))) return true;
    const int found = look(patch, surface, node);
    if (found >= 0) {
      pieces_[std::size_t(from)].joined.push_back(found);
      pieces_[std::size_t(found)].joined.push_back(from);
    }
    if (found != divided) return found != failed;
    for (int k = 0; k < 2; ++k) {
      if (!enter(from, patch, surface, surface.child(node, k), gate)) return false;
    }
    return true;
  }

  ConcaveSurroundings& of_;
  long number_;
  int part_;
  const std::vector<Patch>& patches_;
  dvec3 axis_;
  const FallMap& map_;
  double radius_;
  double curvature_ = 0;
  std::vector<Piece> pieces_;
  /// Pieces the sides of which are to be crossed, the most differently curved from the first one
  /// first: where the walk fails, it fails soon.
  std::priority_queue<std::pair<double, int>> waiting_;
  std::vector<dvec2> line_;  // scratch
};

ConcaveSurroundings::ConcaveSurroundings(const Scene& scene) : scene_(scene), reach_(scene) {}

ConcaveSurroundings::~ConcaveSurroundings() = default;

ConcavePatch& ConcaveSurroundings::surface(int part, int patch) {
  std::unique_ptr<ConcavePatch>& held = surfaces_[{part, patch}];
  if (!held) {
    const ScenePart& of = scene_.content().parts[std::size_t(part)];
    const int element = of.element_of_patch[std::size_t(patch)];
    held = std::make_unique<ConcavePatch>(
        of.elements[std::size_t(element)],
        scene_.content().model.parts()[std::size_t(part)].patches()[std::size_t(patch)]);
  }
  return *held;
}

/// Lest memory grow with the model: it is only sooner asked again.
void ConcaveSurroundings::forget_some() {
  if (++cells_ % cells_between_counts != 0) return;
  std::size_t nodes = 0;
  for (const auto& [place, surface] : surfaces_) nodes += surface->node_count();
  if (nodes > node_limit) surfaces_.clear();
}

bool ConcaveSurroundings::surely_on(int instance, int patch, const PatchCell& cell,
                                    const NormalPyramid& pyramid, double sign) {
  forget_some();
  const SceneInstance& placed = scene_.content().instances[std::size_t(instance)];
  const dvec3 axis = sign * pyramid.axis;
  const ParameterRectangle own{cell.u(), cell.v()};
  const dvec2 middle = own.middle();
  const ConcavePatch& surface_here = surface(placed.part, patch);
  const std::optional<FallMap> map = FallMap::about(surface_here, middle, axis);
  if (!map) return false;
  double size = 0;
  for (const dvec4& p : restricted(surface_here.bezier(), own.u, own.v).points) {
    size = std::max(size, glm::length((*map)(euclidean(p))));
  }
  std::array<dvec3, 4> corners = pyramid.corners;
  for (dvec3& n : corners) {
    n = sign * (placed.rotated ? glm::transpose(glm::inverse(placed.rotation)) * n : n);
  }
  for (const double radius : disc_radii) {
    if (bends_within(surface_here, middle, *map, radius * size)) return false;
    Walk walk(*this, placed.part, axis, *map, radius * size);
    if (!walk.run(patch, own)) return false;  // nor over a larger disc
    if (is_above_others(instance, patch, own, corners, walk.inside())) return true;
  }
  return false;
}

/// A point of the cell or of the pieces is above all else, in all directions between the corners.
bool ConcaveSurroundings::is_above_others(
    int instance, int patch, const ParameterRectangle& cell, const std::array<dvec3, 4>& corners,
    const std::vector<std::pair<int, ParameterRectangle>>& pieces) {
  std::vector<dvec3> points;
  const auto add_point = [&](int of, double u, double v) {
    points.push_back(scene_.content().frame_point({instance, SourceKind::face, of, u, v}));
  };
  for (const double s : {0.0, 0.5, 1.0}) {
    for (const double t : {0.0, 0.5, 1.0}) add_point(patch, cell.u.at(s), cell.v.at(t));
  }
  std::vector<PatchRectangle> regions;
  double narrowest = std::min(width(cell.u), width(cell.v));
  for (const auto& [of, piece] : pieces) {
    const dvec2 p = piece.middle();
    add_point(of, p.x, p.y);
    regions.push_back({instance, of, piece.u, piece.v});
    narrowest = std::min({narrowest, width(piece.u), width(piece.v)});
  }
  return reach_.surely_below(points, corners, regions, 1 - std::ilogb(narrowest));
}

}  // namespace taut
