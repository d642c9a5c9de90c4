#include "taut/envelope/cull/convex_cap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <span>
#include <utility>

#include "taut/bounds/scene_content.h"

namespace taut {
namespace {

/// Shares of the disc's radius. Within this share, what is curved one way is divided until it is
/// inside of the disc,
constexpr double inner = 0.8;
/// but for what is narrower than this;
constexpr double coarse = 0.5;
/// and nothing narrower than this is divided to find it curved one way.
constexpr double fine = 1.0 / 32;
/// Pieces of the surface after which a disc is given up.
constexpr std::size_t piece_limit = 512;
/// Share of the radius that is kept clear of the border, far more than rounding.
constexpr double clearance = 1e-6;
const double diagonal = std::sqrt(0.5);
/// Directions in which a disc is looked at first.
const std::array<dvec2, 8> spokes = {
    dvec2(1, 0), {diagonal, diagonal},   {0, 1},  {-diagonal, diagonal},
    {-1, 0},     {-diagonal, -diagonal}, {0, -1}, {diagonal, -diagonal}};
/// Points of a rectangle that are tried before it is divided.
const std::array<dvec2, 5> probes = {dvec2(0.5, 0.5), {0, 0}, {0, 1}, {1, 0}, {1, 1}};
/// Levels of a patch's tree.
constexpr int tree_levels = 80;
/// Quarterings of a cell of which the parts are looked for in a cap.
constexpr int cover_depth = 4;

/// A point of a patch, over a disc, where it is not curved one way.
bool bends_at(const ConcavePatch& surface, const dvec2& p, const OsculatingParaboloid& map,
              double radius) {
  return glm::length(map(point(surface.bezier(), p.x, p.y))) < radius &&
         !(surface.curvature(p) > 0);
}

/// Some points of a patch over a disc about one of them are not curved one way: there is no need to
/// look at the whole disc.
bool bends_within(const ConcavePatch& surface, const dvec2& middle, const OsculatingParaboloid& map,
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

/// Bound of the distance of any two of the points.
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
  /// The line is a border of the patch, seen from within.
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

/// The surface over a disc, as far as it is joined to the disc's centre.
class Walk {
 public:
  Walk(ConcaveSurfaces& surfaces, int part, const dvec3& axis, const OsculatingParaboloid& map,
       double radius)
      : surfaces_(surfaces),
        number_(surfaces.next_walk()),
        part_(part),
        patches_(surfaces.patches(part)),
        axis_(axis),
        map_(map),
        radius_(radius) {}

  /// From a cell of a patch on. False if it is not certain that the surface is concave over the
  /// disc and goes on all over it.
  bool run(int patch, const ParameterRectangle& cell) {
    if (!begin(patch, surfaces_.patch(part_, patch), 0, cell)) return false;
    while (!waiting_.empty()) {
      surfaces_.check_stop();
      const int piece = waiting_.top().second;
      waiting_.pop();
      for (const Side side : all_sides) {
        if (!cross(piece, side)) return false;
      }
    }
    return true;
  }

  /// What lies over the disc, joined to the centre over it.
  std::vector<ConvexCap::Piece> inside() const {
    std::vector<ConvexCap::Piece> result;
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
      const ParameterRectangle& cell = piece.surface->cell(piece.node);
      const dvec2 p = cell.middle();
      result.push_back({piece.patch, cell, map_(point(piece.surface->bezier(), p.x, p.y))});
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
    const ConcavePatch::Mark mark = surface.mark(node);
    if (mark.walk == number_) return mark.found;
    const int result = found(patch, surface, node);
    surface.mark(node) = {number_, result};
    return result;
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
    const Found halves = surface.level(node) < tree_levels ? divided : failed;
    if (!small) return halves;
    if (surface.is_concave(node, axis_)) {
      if (pieces_.size() == piece_limit) return failed;
      return add({patch, &surface, node, std::move(net), inside, {}});
    }
    const ParameterRectangle& cell = surface.cell(node);
    for (const dvec2& p : probes) {
      if (bends_at(surface, {cell.u.at(p.x), cell.v.at(p.y)}, map_, radius_)) return failed;
    }
    return size > fine * radius_ ? halves : failed;
  }

  /// Looks at all of the cell itself: where the walk fails, it fails soon.
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
           enter(index, border.neighbor, surfaces_.patch(part_, border.neighbor), 0,
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

  ConcaveSurfaces& surfaces_;
  long number_;
  int part_;
  const std::vector<Patch>& patches_;
  dvec3 axis_;
  const OsculatingParaboloid& map_;
  double radius_;
  double curvature_ = 0;
  std::vector<Piece> pieces_;
  /// Pieces the sides of which are to be crossed, the most differently curved from the first one
  /// first: where the walk fails, it fails soon.
  std::priority_queue<std::pair<double, int>> waiting_;
  std::vector<dvec2> line_;  // scratch
};

/// All of the rectangle is in the pieces, which are of its patch.
bool are_covering(std::span<const ConvexCap::Piece> pieces, const ParameterRectangle& cell,
                  int depth) {
  bool meets = false;
  for (const ConvexCap::Piece& piece : pieces) {
    if (piece.cell.contains(cell)) return true;
    meets = meets || piece.cell.overlaps(cell);
  }
  if (!meets || depth == cover_depth) return false;
  const double u = cell.u.at(0.5);
  const double v = cell.v.at(0.5);
  const std::array<ParameterRectangle, 4> quarters = {
      ParameterRectangle{{cell.u.lower, u}, {cell.v.lower, v}},
      {{u, cell.u.upper}, {cell.v.lower, v}},
      {{cell.u.lower, u}, {v, cell.v.upper}},
      {{u, cell.u.upper}, {v, cell.v.upper}}};
  return std::all_of(quarters.begin(), quarters.end(), [&](const ParameterRectangle& quarter) {
    return are_covering(pieces, quarter, depth + 1);
  });
}

}  // namespace

const std::vector<Patch>& ConcaveSurfaces::patches(int part) const {
  return scene_.content().model.parts()[std::size_t(part)].patches();
}

ConcavePatch& ConcaveSurfaces::patch(int part, int patch) {
  std::unique_ptr<ConcavePatch>& held = held_[{part, patch}];
  if (!held) {
    const ScenePart& of = scene_.content().parts[std::size_t(part)];
    const int element = of.element_of_patch[std::size_t(patch)];
    held = std::make_unique<ConcavePatch>(of.elements[std::size_t(element)],
                                          patches(part)[std::size_t(patch)]);
  }
  return *held;
}

std::size_t ConcaveSurfaces::node_count() const {
  std::size_t nodes = 0;
  for (const auto& [place, surface] : held_) nodes += surface->node_count();
  return nodes;
}

bool ConvexCap::covers(int patch, const ParameterRectangle& cell) const {
  const auto [first, last] =
      std::equal_range(pieces.begin(), pieces.end(), Piece{patch, {}, {}},
                       [](const Piece& a, const Piece& b) { return a.patch < b.patch; });
  return are_covering({first, last}, cell, 0);
}

bool ConvexCap::faces(const NormalPyramid& pyramid, double sign) const {
  return std::all_of(pyramid.corners.begin(), pyramid.corners.end(),
                     [&](const dvec3& n) { return sign * glm::dot(n, axis) > 0; });
}

std::optional<ConvexCap> convex_cap(ConcaveSurfaces& surfaces, int part, int patch,
                                    const ParameterRectangle& cell, const dvec3& axis,
                                    const OsculatingParaboloid& map, double radius) {
  if (bends_within(surfaces.patch(part, patch), cell.middle(), map, radius)) return {};
  Walk walk(surfaces, part, axis, map, radius);
  if (!walk.run(patch, cell)) return {};
  ConvexCap cap{axis, map, radius, walk.inside()};
  std::stable_sort(cap.pieces.begin(), cap.pieces.end(),
                   [](const auto& a, const auto& b) { return a.patch < b.patch; });
  return cap;
}

}  // namespace taut
