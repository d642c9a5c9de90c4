#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "taut/envelope/gauss_triangles.h"

namespace taut {
namespace {

/// Cells of a patch are halved at most so often, and of one with many cells less often: needles a
/// million times as long as wide turn within a millionth of their parameters.
constexpr int finest_level = 24;
constexpr int finest_level_of_many = 10;
constexpr std::size_t many_cells = 20000;

/// Second derivatives along the normal that are no larger, as a share of the patch's size, have no
/// sign.
constexpr double flat_bend = 1e-9;

/// Levels that are never left out, so that what happens inside a cell of higher degree shows.
int coarsest_level(const BezierPatch& patch) {
  const int degree = std::max(patch.degree_u, patch.degree_v);
  return degree <= 2 ? 0 : degree <= 3 ? 1 : degree <= 8 ? 2 : 3;
}

/// Of 3 x 3 points of a cell, each that lies halfway between two others, with these around it.
constexpr std::array<std::array<std::size_t, 3>, 6> halfway_points = {
    {{0, 1, 2}, {6, 7, 8}, {0, 3, 6}, {2, 5, 8}, {0, 4, 8}, {2, 4, 6}}};

/// The adaptive triangulation of one patch. Places in its parameters are integers in
/// [0, 2^finest_level].
class FaceTriangles {
 public:
  FaceTriangles(const ContactGeometry& geometry, const Contact& patch, int element,
                const InnerPoints& inner, const GaussTriangleOptions& options,
                GaussTriangles& result)
      : geometry_(geometry),
        patch_(patch),
        element_(element),
        inner_(inner),
        options_(options),
        result_(result),
        bezier_(geometry.patch(patch).bezier),
        coarsest_(coarsest_level(bezier_)) {}

  void run(std::span<const CulledCell> cells);

 private:
  /// The patch at a place. `plus`, `minus`: the second form lets a supporting plane with the normal
  /// n or -n touch there.
  struct Point {
    dvec3 n, x;
    dvec2 uv;
    bool plus, minus;
    std::array<int, 2> node = {-1, -1};  ///< with n and with -n
  };
  struct Cell {
    int i, j, size;
    ContactSigns signs;

    bool has(int sign) const { return sign > 0 ? signs.plus : signs.minus; }
  };
  static constexpr int side = 1 << finest_level;
  static std::uint64_t key(int i, int j) { return std::uint64_t(i) << 32U | std::uint64_t(j); }

  Point& at(int i, int j);
  Point evaluate(const dvec2& uv) const;
  void split(Cell cell, int level);
  void hide(Cell& cell);
  bool is_fine(const Cell& cell, int level);
  bool is_halfway(const Point& a, const Point& middle, const Point& b) const;
  void side_points(int i0, int j0, int i1, int j1, std::vector<std::array<int, 2>>& list);
  void triangulate(const Cell& cell, int sign);
  int node(int i, int j, int sign);
  void draw_side(const Cell& cell, Side which, int sign);
  void draw_pole(Side which, int sign);

  const ContactGeometry& geometry_;
  Contact patch_;
  int element_;
  const InnerPoints& inner_;
  const GaussTriangleOptions& options_;
  GaussTriangles& result_;
  const BezierPatch& bezier_;
  int coarsest_;
  std::unordered_map<std::uint64_t, Point> points_;
  std::unordered_map<std::uint64_t, bool> corners_;  ///< of leaves
  std::vector<Cell> leaves_;
};

FaceTriangles::Point FaceTriangles::evaluate(const dvec2& uv) const {
  Contact c = patch_;
  c.u = uv.x;
  c.v = uv.y;
  const ContactJet j = geometry_.jet(c);
  const auto [n, regular] = surface_normal(geometry_, c, j);
  Point p{n, j.x, uv, false, false};
  if (p.n == dvec3(0.0)) return p;
  const double uu = glm::dot(j.dxx, p.n);
  const double uv_form = glm::dot(j.dxy, p.n);
  const double vv = glm::dot(j.dyy, p.n);
  // On collapsed sides the form is singular; what lies beside them tells.
  const double zero = flat_bend * (std::abs(uu) + std::abs(uv_form) + std::abs(vv));
  const bool definite = !regular || uu * vv - uv_form * uv_form >= -zero * zero;
  p.plus = definite && uu <= zero && vv <= zero;
  p.minus = definite && uu >= -zero && vv >= -zero;
  return p;
}

FaceTriangles::Point& FaceTriangles::at(int i, int j) {
  const auto [found, is_new] = points_.try_emplace(key(i, j));
  if (is_new) found->second = evaluate({double(i) / side, double(j) / side});
  return found->second;
}

/// Whether the middle is as interpolation between the two has it.
bool FaceTriangles::is_halfway(const Point& a, const Point& middle, const Point& b) const {
  const dvec3 sum = a.n + b.n;
  if (glm::length(middle.n - unit(sum)) > options_.direction_tolerance) return false;
  // For the opposite normals the value is the same but for its sign.
  const double value = 0.5 * glm::dot(a.x + b.x, middle.n) + glm::dot(a.n - b.n, a.x - b.x) / 8;
  return std::abs(glm::dot(middle.x, middle.n) - value) <= options_.value_tolerance;
}

bool FaceTriangles::is_fine(const Cell& cell, int level) {
  const int h = cell.size / 2;
  std::array<Point, 9> p;
  bool any = false;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      Point& own = p[std::size_t(3 * a + b)] = at(cell.i + a * h, cell.j + b * h);
      if (own.n == dvec3(0.0)) return true;
      any = any || own.plus || own.minus;
    }
  }
  if (!any && level > coarsest_) return true;
  const double turn = std::cos(largest_turn);
  for (const auto& [a, b] : {std::pair(0, 2), {0, 6}, {0, 8}, {2, 6}, {2, 8}, {6, 8}}) {
    if (glm::dot(p[std::size_t(a)].n, p[std::size_t(b)].n) < turn) return false;
  }
  return std::all_of(halfway_points.begin(), halfway_points.end(), [&](const auto& own) {
    const auto& [a, m, b] = own;
    return is_halfway(p[a], p[m], p[b]);
  });
}

/// Leaves out the signs with which nothing of the cell can be seen, by its corners and the points
/// halfway.
void FaceTriangles::hide(Cell& cell) {
  std::array<dvec3, 9> x{};
  std::array<dvec3, 9> n{};
  for (std::size_t k = 0; k < 9; ++k) {
    const Point& p = at(cell.i + int(k / 3) * cell.size / 2, cell.j + int(k % 3) * cell.size / 2);
    if (p.n == dvec3(0.0) || glm::dot(p.n, n[0]) < 0) return;
    x[k] = p.x;
    n[k] = p.n;
  }
  // How far the surface may be from between its points, and normals from between theirs: by the
  // differences over twice the distance, which are some four times as large.
  double rise = 0;
  for (const auto& [a, m, b] : halfway_points) {
    rise = std::max(rise, glm::distance(x[m], 0.5 * (x[a] + x[b])));
    rise = std::max(rise, 2 * glm::distance(n[m], unit(n[a] + n[b])));
  }
  cell.signs.plus = cell.signs.plus && !inner_.surely_hides(x, n, rise);
  for (dvec3& direction : n) direction = -direction;
  cell.signs.minus = cell.signs.minus && !inner_.surely_hides(x, n, rise);
}

void FaceTriangles::split(Cell cell, int level) {
  if (level >= coarsest_) hide(cell);
  if (!cell.signs.any()) return;
  const bool last =
      cell.size == 2 || (level >= finest_level_of_many && leaves_.size() >= many_cells);
  if (last || (level >= coarsest_ && is_fine(cell, level))) {
    leaves_.push_back(cell);
    for (const int i : {cell.i, cell.i + cell.size}) {
      for (const int j : {cell.j, cell.j + cell.size}) corners_[key(i, j)] = true;
    }
    return;
  }
  const int h = cell.size / 2;
  for (const int i : {cell.i, cell.i + h}) {
    for (const int j : {cell.j, cell.j + h}) split({i, j, h, cell.signs}, level + 1);
  }
}

/// The leaves' corners on the segment, its beginning but not its end.
void FaceTriangles::side_points(int i0, int j0, int i1, int j1,
                                std::vector<std::array<int, 2>>& list) {
  const int i = (i0 + i1) / 2;
  const int j = (j0 + j1) / 2;
  const bool halved = std::max(std::abs(i1 - i0), std::abs(j1 - j0)) >= 2 &&
                      corners_.find(key(i, j)) != corners_.end();
  if (!halved) {
    list.push_back({i0, j0});
    return;
  }
  side_points(i0, j0, i, j, list);
  side_points(i, j, i1, j1, list);
}

int FaceTriangles::node(int i, int j, int sign) {
  Point& p = at(i, j);
  int& number = p.node[sign > 0 ? 0 : 1];
  if (number < 0) number = result_.add_node({double(sign) * p.n, p.x, p.uv});
  return number;
}

void FaceTriangles::triangulate(const Cell& cell, int sign) {
  const int i0 = cell.i;
  const int i1 = cell.i + cell.size;
  const int j0 = cell.j;
  const int j1 = cell.j + cell.size;
  std::vector<std::array<int, 2>> loop;
  side_points(i0, j0, i1, j0, loop);
  side_points(i1, j0, i1, j1, loop);
  side_points(i1, j1, i0, j1, loop);
  side_points(i0, j1, i0, j0, loop);
  const int middle_i = i0 + cell.size / 2;
  const int middle_j = j0 + cell.size / 2;
  const auto touches = [&](int i, int j) {
    const Point& p = at(i, j);
    return sign > 0 ? p.plus : p.minus;
  };
  bool any = touches(middle_i, middle_j);
  for (const auto& [i, j] : loop) {
    if (at(i, j).n == dvec3(0.0)) return;
    any = any || touches(i, j);
  }
  if (!any) return;
  std::vector<int> nodes;
  nodes.reserve(loop.size());
  for (const auto& [i, j] : loop) nodes.push_back(node(i, j, sign));
  if (nodes.size() == 4) {
    result_.add_triangle(element_, nodes[0], nodes[1], nodes[2]);
    result_.add_triangle(element_, nodes[0], nodes[2], nodes[3]);
    return;
  }
  const int middle = node(middle_i, middle_j, sign);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    result_.add_triangle(element_, nodes[k], nodes[(k + 1) % nodes.size()], middle);
  }
}

/// A strip along the cell's part of a side of the patch, as wide as border_width to either side.
void FaceTriangles::draw_side(const Cell& cell, Side which, int sign) {
  const int first = along_v(which) ? cell.j : cell.i;
  const int across = along_v(which) ? cell.i : cell.j;
  if (at_upper_end(which) ? across + cell.size != side : across != 0) return;
  const int fixed = at_upper_end(which) ? side : 0;
  const auto place = [&](int free) {
    return along_v(which) ? std::array<int, 2>{fixed, free} : std::array<int, 2>{free, fixed};
  };
  const std::array<int, 2> from = place(first);
  const std::array<int, 2> to = place(first + cell.size);
  std::vector<std::array<int, 2>> list;
  side_points(from[0], from[1], to[0], to[1], list);
  list.push_back(to);
  const double width = options_.border_width;
  for (std::size_t k = 0; k + 1 < list.size(); ++k) {
    const Point& a = at(list[k][0], list[k][1]);
    const Point& b = at(list[k + 1][0], list[k + 1][1]);
    const bool touches = sign > 0 ? a.plus || b.plus : a.minus || b.minus;
    if (!touches || a.n == dvec3(0.0) || b.n == dvec3(0.0)) continue;
    const dvec3 na = double(sign) * a.n;
    const dvec3 nb = double(sign) * b.n;
    const dvec3 middle = unit(na + nb);
    const dvec3 way = nb - na;
    const dvec3 along = glm::length(way) > 1e-9 ? unit(way - glm::dot(way, middle) * middle)
                                                : tangent_frame(middle)[0];
    const dvec3 sideways = glm::cross(middle, along);
    const auto corner = [&](const dvec3& n, double forward, double left, const Point& p) {
      return result_.add_node({unit(n + width * (forward * along + left * sideways)), p.x, p.uv});
    };
    const int a0 = corner(na, -1, -1, a);
    const int a1 = corner(na, -1, 1, a);
    const int b0 = corner(nb, 1, -1, b);
    const int b1 = corner(nb, 1, 1, b);
    result_.add_triangle(element_, a0, b0, b1, false);
    result_.add_triangle(element_, a0, b1, a1, false);
  }
}

/// The one direction of a smooth pole.
void FaceTriangles::draw_pole(Side which, int sign) {
  const dvec2 uv = on_side(which, 0.5);
  const Point& p = at(int(uv.x * side), int(uv.y * side));
  if (p.n == dvec3(0.0)) return;
  const dvec3 n = double(sign) * p.n;
  const auto [e0, e1] = tangent_frame(n);
  std::array<int, 4> corner{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double a = k == 1 || k == 2 ? 1 : -1;
    const double b = k >= 2 ? 1 : -1;
    corner[k] = result_.add_node({unit(n + options_.border_width * (a * e0 + b * e1)), p.x, p.uv});
  }
  result_.add_triangle(element_, corner[0], corner[1], corner[2], false);
  result_.add_triangle(element_, corner[0], corner[2], corner[3], false);
}

void FaceTriangles::run(std::span<const CulledCell> cells) {
  for (const CulledCell& c : cells) {
    const int size = side >> c.cell.level;
    split({int(c.cell.i) * size, int(c.cell.j) * size, size, c.signs}, c.cell.level);
  }
  const auto& borders = geometry_.patch(patch_).borders;
  for (const int sign : {1, -1}) {
    for (const Cell& leaf : leaves_) {
      if (!leaf.has(sign)) continue;
      triangulate(leaf, sign);
      for (const Side which : all_sides) {
        if (borders[std::size_t(which)].kind == BorderKind::collapsed) continue;
        draw_side(leaf, which, sign);
      }
    }
    for (const Side which : all_sides) {
      const Border& border = borders[std::size_t(which)];
      if (border.kind == BorderKind::collapsed && border.vertex < 0) draw_pole(which, sign);
    }
  }
}

}  // namespace

void add_face_triangles(const ContactGeometry& geometry, const Contact& patch, int element,
                        std::span<const CulledCell> cells, const InnerPoints& inner,
                        const GaussTriangleOptions& options, GaussTriangles& result) {
  FaceTriangles(geometry, patch, element, inner, options, result).run(cells);
}

}  // namespace taut
