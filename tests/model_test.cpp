#include "taut/surface/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <numbers>
#include <random>

#include "error_checks.h"
#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using taut_test::expect_invalid;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// What is put into a part.
struct PartShape {
  std::vector<NurbsSurface> surfaces;
  std::vector<NurbsCurve> curves;
  std::vector<dvec3> points;
};

Part part_of(const PartShape& shape) {
  Part part;
  for (const NurbsSurface& s : shape.surfaces) part.add_surface(s, "surface");
  for (const NurbsCurve& c : shape.curves) part.add_curve(c, "curve");
  for (const dvec3& p : shape.points) part.add_point(p);
  return part;
}

Part connected(const PartShape& shape, double smooth_angle = smooth_join_angle) {
  Part part = part_of(shape);
  part.connect(smooth_angle);
  return part;
}

NurbsSurface quad(const dvec3& p00, const dvec3& p01, const dvec3& p10, const dvec3& p11) {
  return as_nurbs(
      BezierPatch{1, 1, {homogeneous(p00), homogeneous(p01), homogeneous(p10), homogeneous(p11)}});
}

/// The square with these three corners: at (0, 0), along u and along v.
NurbsSurface square(const dvec3& origin, const dvec3& u, const dvec3& v) {
  return quad(origin, origin + v, origin + u, origin + u + v);
}

NurbsCurve polyline(const std::vector<dvec3>& points) {
  NurbsCurve curve{1, {0}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    curve.points.push_back(homogeneous(points[i]));
    curve.knots.push_back(static_cast<double>(i));
  }
  curve.knots.push_back(curve.knots.back());
  return curve;
}

/// Quarter circles in the x-y plane from (1, 0).
NurbsCurve arcs(int quarters) {
  const std::array<dvec2, 8> corners = {dvec2(1, 0),  dvec2(1, 1),   dvec2(0, 1),  dvec2(-1, 1),
                                        dvec2(-1, 0), dvec2(-1, -1), dvec2(0, -1), dvec2(1, -1)};
  NurbsCurve curve{2, {0}, {}};
  for (int i = 0; i <= 2 * quarters; ++i) {
    const double w = i % 2 == 0 ? 1 : std::numbers::sqrt2 / 2;
    curve.points.push_back(homogeneous(dvec3(corners[to_size(i % 8)], 0), w));
  }
  for (int i = 0; i <= quarters; ++i) curve.knots.insert(curve.knots.end(), 2, i);
  curve.knots.push_back(quarters);
  return curve;
}

/// A profile in the (x, z) half plane, revolved about the z axis by quarters of a turn.
NurbsSurface revolved(const NurbsCurve& profile, int quarters = 4) {
  const NurbsCurve circle = arcs(quarters);
  NurbsSurface surface{profile.degree, 2, profile.knots, circle.knots, {}};
  for (const dvec4& p : profile.points) {
    for (const dvec4& c : circle.points) {
      surface.points.emplace_back(p.x * c.x, p.x * c.y, p.z * c.w, p.w * c.w);
    }
  }
  return surface;
}

/// The curve in the (x, z) plane turned by a multiple of 90 degrees, scaled and moved.
NurbsCurve profile(NurbsCurve curve, int turns, double radius, const dvec2& center) {
  for (dvec4& p : curve.points) {
    for (int i = 0; i < turns; ++i) p = dvec4(-p.y, p.x, 0, p.w);
    p = dvec4(radius * p.x + center.x * p.w, 0, radius * p.y + center.y * p.w, p.w);
  }
  return curve;
}

PartShape cube() {
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  const dvec3 z(0, 0, 1);
  return {{square(dvec3(0), x, y), square(z, x, y), square(dvec3(0), y, z), square(x, z, y),
           square(x + y + z, -x, -z), square(x, -x, z)},
          {},
          {}};
}

PartShape sphere() { return {{revolved(profile(arcs(2), 3, 1, dvec2(0)))}, {}, {}}; }
PartShape torus() { return {{revolved(profile(arcs(4), 0, 0.5, dvec2(2, 0)))}, {}, {}}; }
PartShape cylinder_side() {
  return {{revolved(polyline({dvec3(1, 0, 0), dvec3(1, 0, 2)}))}, {}, {}};
}
PartShape cone() { return {{revolved(polyline({dvec3(1, 0, 0), dvec3(0, 0, 2)}))}, {}, {}}; }

/// The disc's centre is a pole of a plane.
PartShape hemisphere_with_base() {
  return {{revolved(profile(arcs(1), 0, 1, dvec2(0))),
           revolved(polyline({dvec3(0, 0, 0), dvec3(1, 0, 0)}))},
          {},
          {}};
}

/// Triangles with a collapsed side each.
PartShape pyramid() {
  const dvec3 tip(0, 0, 1);
  const std::array<dvec3, 4> base = {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(-1, 0, 0),
                                     dvec3(0, -1, 0)};
  PartShape shape;
  for (std::size_t i = 0; i < 4; ++i) {
    shape.surfaces.push_back(quad(tip, tip, base[i], base[(i + 1) % 4]));
  }
  return shape;
}

/// One face of two squares with a crease between them.
PartShape roof() {
  NurbsSurface surface{1, 1, {0, 0, 1, 2, 2}, {0, 0, 1, 1}, {}};
  for (const double x : {-1, 0, 1}) {
    for (const double y : {0, 2}) {
      surface.points.push_back(homogeneous(dvec3(x, y, -std::abs(x))));
    }
  }
  return {{surface}, {}, {}};
}

PartShape three_sheets() {
  const dvec3 z(0, 0, 1);
  return {{square(dvec3(0), dvec3(1, 0, 0), z), square(z, dvec3(-1, 1, 0), -z),
           square(dvec3(0), z, dvec3(-1, -1, 0))},
          {},
          {}};
}

/// Squares on a base of two patches: the edge between them changes its faces midway.
PartShape two_on_one() {
  const dvec3 x(1, 0, 0);
  const dvec3 z(0, 0, 1);
  NurbsSurface base{1, 1, {0, 0, 1, 2, 2}, {0, 0, 1, 1}, {}};
  for (const double u : {0, 1, 2}) {
    for (const double v : {0, 1}) base.points.push_back(homogeneous(dvec3(u, v, 0)));
  }
  return {{base, square(dvec3(0), x, z), square(x, x, z)}, {}, {}};
}

/// Free curves and points, and a square that one of the curves starts at.
PartShape wires() {
  PartShape shape;
  shape.surfaces = {square(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0))};
  shape.curves = {
      polyline({dvec3(0), dvec3(0, 0, 3)}),
      arcs(4),
      polyline({dvec3(2, 0, 0), dvec3(3, 0, 0), dvec3(3, 1, 0), dvec3(2, 0, 0)}),
  };
  shape.points = {dvec3(0, 0, -1), dvec3(0, 0, -2)};
  return shape;
}

std::map<std::string, PartShape> all_shapes() {
  return {{"cube", cube()},
          {"sphere", sphere()},
          {"torus", torus()},
          {"cylinder side", cylinder_side()},
          {"cone", cone()},
          {"hemisphere with base", hemisphere_with_base()},
          {"pyramid", pyramid()},
          {"roof", roof()},
          {"three sheets", three_sheets()},
          {"two on one", two_on_one()},
          {"wires", wires()}};
}

/// Applies f to all Euclidean control points.
PartShape transformed(PartShape shape, const std::function<dvec3(const dvec3&)>& f) {
  const auto apply = [&](std::vector<dvec4>& points) {
    for (dvec4& p : points) p = homogeneous(f(euclidean(p)), p.w);
  };
  for (NurbsSurface& s : shape.surfaces) apply(s.points);
  for (NurbsCurve& c : shape.curves) apply(c.points);
  for (dvec3& p : shape.points) p = f(p);
  return shape;
}

void reverse_knots(std::vector<double>& knots) {
  std::reverse(knots.begin(), knots.end());
  for (double& t : knots) t = -t;
}

NurbsSurface reversed_u(const NurbsSurface& s) {
  NurbsSurface r = s;
  reverse_knots(r.knots_u);
  const std::size_t count_v = to_size(s.count_v());
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    r.points[i] = s.points[(to_size(s.count_u()) - 1 - i / count_v) * count_v + i % count_v];
  }
  return r;
}

NurbsSurface transposed(const NurbsSurface& s) {
  NurbsSurface t{s.degree_v, s.degree_u, s.knots_v, s.knots_u, {}};
  for (std::size_t j = 0; j < to_size(s.count_v()); ++j) {
    for (std::size_t i = 0; i < to_size(s.count_u()); ++i) {
      t.points.push_back(s.points[i * to_size(s.count_v()) + j]);
    }
  }
  return t;
}

NurbsCurve reversed(NurbsCurve curve) {
  reverse_knots(curve.knots);
  std::reverse(curve.points.begin(), curve.points.end());
  return curve;
}

class Rearrangement {
 public:
  explicit Rearrangement(unsigned seed) : engine_(seed) {}
  double operator()(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(engine_);
  }
  bool coin() { return (*this)(0, 1) < 0.5; }
  dvec3 vector() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }
  dmat3 rotation() {
    const dvec3 a = glm::normalize(vector());
    const dvec3 b = glm::normalize(glm::cross(a, vector()));
    return {a, b, glm::cross(a, b)};
  }
  template <class T>
  void shuffle(std::vector<T>& v) {
    std::shuffle(v.begin(), v.end(), engine_);
  }
  /// The same geometry with other parameters, in another order.
  PartShape rearranged(PartShape shape) {
    for (NurbsSurface& s : shape.surfaces) {
      if (coin()) s = reversed_u(s);
      if (coin()) s = transposed(s);
      if (coin()) s = reversed_u(s);
    }
    for (NurbsCurve& c : shape.curves) {
      if (coin()) c = reversed(c);
    }
    shuffle(shape.surfaces);
    shuffle(shape.curves);
    shuffle(shape.points);
    return shape;
  }

 private:
  std::mt19937_64 engine_;
};

// ---- What connect() found

/// Everything that must not depend on order, parameters, place and size.
struct Summary {
  std::size_t edges = 0, vertices = 0, seam_vertices = 0, pieces = 0;
  int smooth_sides = 0, edge_sides = 0, poles = 0, tips = 0, corners = 0;
  std::vector<std::pair<std::size_t, int>> faces_and_pieces_of_edges;
  std::vector<int> ends_at_vertices;

  bool operator==(const Summary&) const = default;
};

Summary summary(const Part& part) {
  Summary s;
  s.edges = part.edges().size();
  s.seam_vertices = to_size(part.seam_vertex_count());
  s.vertices = part.vertices().size() - s.seam_vertices;
  s.pieces = part.pieces().size();
  for (const Patch& patch : part.patches()) {
    for (const Border& b : patch.borders) {
      s.smooth_sides += b.kind == BorderKind::smooth;
      s.edge_sides += b.kind == BorderKind::edge;
      s.poles += b.kind == BorderKind::collapsed && b.vertex < 0;
      s.tips += b.kind == BorderKind::collapsed && b.vertex >= 0;
    }
    for (const int v : patch.corner_vertex) s.corners += v >= 0;
  }
  for (const Edge& e : part.edges()) {
    s.faces_and_pieces_of_edges.emplace_back(e.faces.size(), e.piece_count);
  }
  s.ends_at_vertices.resize(part.vertices().size());
  for (const EdgePiece& p : part.pieces()) {
    for (const int v : p.end_vertex) {
      if (v >= 0) ++s.ends_at_vertices[to_size(v)];
    }
  }
  std::sort(s.faces_and_pieces_of_edges.begin(), s.faces_and_pieces_of_edges.end());
  std::sort(s.ends_at_vertices.begin(), s.ends_at_vertices.end());
  return s;
}

std::ostream& operator<<(std::ostream& out, const Summary& s) {
  return out << s.edges << " edges, " << s.vertices << " vertices, " << s.pieces << " pieces, "
             << s.smooth_sides << " smooth and " << s.edge_sides << " edge sides, " << s.poles
             << " poles, " << s.tips << " tips, " << s.corners << " corners";
}

/// Checks all that model.h promises of a connected part, by geometry.
class Checker {
 public:
  explicit Checker(const Part& part)
      : part_(part), tolerance_(4 * join_distance * diagonal(part.control_box())) {}

  void check() {
    check_faces();
    sides_of_piece_.assign(part_.pieces().size(), 0);
    for (std::size_t p = 0; p < part_.patches().size(); ++p) {
      for (const Side side : all_sides) check_border(static_cast<int>(p), side);
    }
    check_edges();
    for (std::size_t i = 0; i < part_.pieces().size(); ++i) check_ends(static_cast<int>(i));
  }

 private:
  const Patch& patch(int i) const { return part_.patches()[to_size(i)]; }
  const EdgePiece& piece(int i) const { return part_.pieces()[to_size(i)]; }
  const Border& border_of(int p, Side side) const {
    return patch(p).borders[to_size(static_cast<int>(side))];
  }

  void expect_same(const dvec3& a, const dvec3& b) const {
    EXPECT_LE(glm::length(a - b), tolerance_);
  }
  void expect_same(const BezierCurve& a, const BezierCurve& b, bool reversed) const {
    for (int i = 0; i <= 16; ++i) {
      const double t = i / 16.0;
      expect_same(point(a, t), point(b, reversed ? 1 - t : t));
    }
  }

  void check_faces() {
    int next = 0;
    for (std::size_t f = 0; f < part_.faces().size(); ++f) {
      const Face& face = part_.faces()[f];
      EXPECT_EQ(face.first_patch, next);
      EXPECT_GT(face.patch_count, 0);
      next += face.patch_count;
      for (int p = face.first_patch; p < next; ++p) EXPECT_EQ(to_size(patch(p).face), f);
    }
    EXPECT_EQ(to_size(next), part_.patches().size());
  }

  void check_border(int p, Side side) {
    SCOPED_TRACE(testing::Message() << "patch " << p << " side " << static_cast<int>(side));
    const Border& b = border_of(p, side);
    const BezierCurve curve = border(patch(p).bezier, side);
    const std::array<int, 2> ends = corner_vertices(p, side);
    for (const int e : {0, 1}) {
      const int v = ends[to_size(e)];
      if (v >= 0) expect_same(part_.vertices()[to_size(v)], point(curve, e));
    }
    EXPECT_EQ(b.kind == BorderKind::edge, b.edge >= 0);
    if (b.kind != BorderKind::smooth) {
      EXPECT_EQ(b.kind == BorderKind::edge, b.piece >= 0);
    }
    if (b.kind == BorderKind::collapsed) {
      EXPECT_EQ(b.neighbor, -1);
      EXPECT_EQ(ends[0], b.vertex);
      EXPECT_EQ(ends[1], b.vertex);
      expect_same(point(curve, 0), point(curve, 0.5));
      return;
    }
    EXPECT_EQ(b.vertex, -1);
    if (b.kind == BorderKind::smooth) {
      EXPECT_GE(b.neighbor, 0);
    }
    if (b.neighbor >= 0) check_neighbor(p, side);
    if (b.piece < 0) return;
    const EdgePiece& edge_piece = piece(b.piece);
    ++sides_of_piece_[to_size(b.piece)];
    EXPECT_EQ(edge_piece.edge, b.edge);
    expect_same(curve, edge_piece.bezier, b.piece_reversed);
    if (b.edge >= 0) {
      const Edge& edge = part_.edges()[to_size(b.edge)];
      EXPECT_EQ(std::count(edge.faces.begin(), edge.faces.end(), patch(p).face) > 0, true);
      EXPECT_EQ(b.neighbor >= 0, edge.faces.size() == 2);
    }
    for (const std::size_t e : {0u, 1u}) {
      const std::size_t end = b.piece_reversed ? 1 - e : e;
      EXPECT_EQ(edge_piece.end_vertex[end], ends[e]);
    }
  }

  std::array<int, 2> corner_vertices(int p, Side side) const {
    const std::array<int, 4>& v = patch(p).corner_vertex;
    switch (side) {
      case Side::u0:
        return {v[0], v[1]};
      case Side::u1:
        return {v[2], v[3]};
      case Side::v0:
        return {v[0], v[2]};
      default:
        return {v[1], v[3]};
    }
  }

  void check_neighbor(int p, Side side) {
    const Border& b = border_of(p, side);
    const Border& other = border_of(b.neighbor, b.neighbor_side);
    EXPECT_EQ(other.neighbor, p);
    EXPECT_EQ(other.neighbor_side, side);
    EXPECT_EQ(other.kind, b.kind);
    EXPECT_EQ(other.reversed, b.reversed);
    EXPECT_EQ(other.edge, b.edge);
    EXPECT_EQ(other.piece, b.piece);
    expect_same(border(patch(p).bezier, side), border(patch(b.neighbor).bezier, b.neighbor_side),
                b.reversed);
  }

  void check_edges() {
    int next = 0;
    for (std::size_t e = 0; e < part_.edges().size(); ++e) {
      SCOPED_TRACE(testing::Message() << "edge " << e);
      const Edge& edge = part_.edges()[e];
      EXPECT_EQ(edge.first_piece, next);
      EXPECT_GT(edge.piece_count, 0);
      next += edge.piece_count;
      EXPECT_TRUE(std::is_sorted(edge.faces.begin(), edge.faces.end()));
      for (int i = edge.first_piece; i < next; ++i) {
        EXPECT_EQ(to_size(piece(i).edge), e);
        EXPECT_EQ(to_size(sides_of_piece_[to_size(i)]), edge.faces.size());
        if (i > edge.first_piece) {
          EXPECT_EQ(piece(i).t.lower, piece(i - 1).t.upper);
        }
        if (edge.faces.empty()) continue;
        EXPECT_EQ(piece(i).t.lower, i - edge.first_piece);
        EXPECT_EQ(piece(i).t.upper, i - edge.first_piece + 1);
        // A border edge bends nowhere.
        if (i > edge.first_piece && piece(i).end_vertex[0] < first_seam_vertex()) {
          EXPECT_EQ(piece(i).end_neighbor[0], i - 1);
        }
      }
    }
    for (; to_size(next) < part_.pieces().size(); ++next) {
      EXPECT_EQ(piece(next).edge, -1);
      EXPECT_EQ(sides_of_piece_[to_size(next)], 2);
    }
  }

  int first_seam_vertex() const {
    return static_cast<int>(part_.vertices().size()) - part_.seam_vertex_count();
  }

  dvec3 end_point(int i, std::size_t end) const {
    return point(piece(i).bezier, static_cast<double>(end));
  }
  dvec3 inward(int i, std::size_t end) const {
    constexpr double near = 1e-4;
    return glm::normalize(point(piece(i).bezier, end == 0 ? near : 1 - near) - end_point(i, end));
  }

  void check_ends(int i) {
    SCOPED_TRACE(testing::Message() << "piece " << i);
    for (const std::size_t end : {0u, 1u}) {
      const int v = piece(i).end_vertex[end];
      const int neighbor = piece(i).end_neighbor[end];
      EXPECT_NE(v >= 0, neighbor >= 0);
      if (v >= 0) {
        expect_same(part_.vertices()[to_size(v)], end_point(i, end));
        EXPECT_GE(v, part_.point_count());
        continue;
      }
      bool goes_on = false;
      for (const std::size_t other : {0u, 1u}) {
        goes_on = goes_on ||
                  (piece(neighbor).end_neighbor[other] == i && !(neighbor == i && other == end) &&
                   glm::length(end_point(neighbor, other) - end_point(i, end)) <= tolerance_ &&
                   glm::length(inward(neighbor, other) + inward(i, end)) < 2e-3);
      }
      EXPECT_TRUE(goes_on);
    }
  }

  const Part& part_;
  double tolerance_;
  std::vector<int> sides_of_piece_;
};

void expect_consistent(const Part& part) { Checker(part).check(); }

void expect_counts(const Part& part, std::size_t edges, std::size_t vertices) {
  expect_consistent(part);
  EXPECT_EQ(part.edges().size(), edges);
  EXPECT_EQ(part.vertices().size() - to_size(part.seam_vertex_count()), vertices);
}

void expect_seams(const Part& part, std::size_t pieces, int vertices) {
  std::size_t edge_pieces = 0;
  for (const Edge& e : part.edges()) edge_pieces += to_size(e.piece_count);
  EXPECT_EQ(part.pieces().size() - edge_pieces, pieces);
  EXPECT_EQ(part.seam_vertex_count(), vertices);
}

// ---- How sides meet

TEST(Model, Cube) {
  const Part part = connected(cube());
  expect_counts(part, 12, 8);
  for (const Edge& edge : part.edges()) {
    EXPECT_EQ(edge.faces.size(), 2u);
    EXPECT_EQ(edge.piece_count, 1);
  }
  EXPECT_EQ(part.point_count(), 0);
  for (const dvec3& v : part.vertices()) {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(v[i] == 0 || v[i] == 1);
  }
  for (const Patch& patch : part.patches()) {
    for (const int v : patch.corner_vertex) EXPECT_GE(v, 0);
  }
  EXPECT_EQ(summary(part).ends_at_vertices, std::vector<int>(8, 3));
}

TEST(Model, SphereIsSmooth) {
  const Part part = connected(sphere());
  expect_counts(part, 0, 0);
  EXPECT_EQ(part.patches().size(), 8u);
  EXPECT_EQ(summary(part).smooth_sides, 24);
  EXPECT_EQ(summary(part).poles, 8);
  expect_seams(part, 0, 0);
}

TEST(Model, TorusIsSmooth) {
  const Part part = connected(torus());
  expect_counts(part, 0, 0);
  EXPECT_EQ(summary(part).smooth_sides, 64);
  expect_seams(part, 8, 0);  // the two circles on which it lies on a table
}

TEST(Model, CylinderSideHasTwoRims) {
  const Part part = connected(cylinder_side());
  expect_counts(part, 2, 0);
  EXPECT_EQ(summary(part).smooth_sides, 8);
  for (const Edge& edge : part.edges()) {
    EXPECT_EQ(edge.piece_count, 4);
    EXPECT_EQ(edge.faces, std::vector<int>{0});
    const int last = edge.first_piece + 3;
    EXPECT_EQ(part.pieces()[to_size(edge.first_piece)].end_neighbor[0], last);
    EXPECT_EQ(part.pieces()[to_size(last)].end_neighbor[1], edge.first_piece);
  }
  // Both begin with the first patch.
  EXPECT_EQ(part.patches()[0].borders[0].piece, part.edges()[0].first_piece);
  EXPECT_EQ(part.patches()[0].borders[1].piece, part.edges()[1].first_piece);
}

TEST(Model, ConeHasATip) {
  const Part part = connected(cone());
  expect_counts(part, 1, 1);
  EXPECT_EQ(part.vertices()[0], dvec3(0, 0, 2));
  EXPECT_EQ(summary(part).tips, 4);
  EXPECT_EQ(summary(part).smooth_sides, 8);
  EXPECT_EQ(summary(part).corners, 8);
}

/// The flatter the cone, the less its normals differ at the tip.
TEST(Model, FlatConesTip) {
  for (const auto& [height, tips] : {std::pair(1e-2, 1u), std::pair(1e-6, 0u)}) {
    const PartShape shape{{revolved(polyline({dvec3(1, 0, 0), dvec3(0, 0, height)}))}, {}, {}};
    expect_counts(connected(shape), 1, tips);
  }
}

/// Both ends of the collapsed side have the same normal, its middle has not. The open borders run
/// straight over the tip.
TEST(Model, TipWhoseEndsAgree) {
  BezierPatch patch{1, 4, std::vector<dvec4>(5, homogeneous(dvec3(0)))};
  for (const dvec3& p :
       {dvec3(1, 0, 0), dvec3(1, 1, 0), dvec3(0, 1, 1), dvec3(-1, 1, 0), dvec3(-1, 0, 0)}) {
    patch.points.push_back(homogeneous(p));
  }
  const Part part = connected({{as_nurbs(patch)}, {}, {}});
  expect_counts(part, 3, 3);
  EXPECT_EQ(summary(part).tips, 1);
}

TEST(Model, HemisphereWithBase) {
  const Part part = connected(hemisphere_with_base());
  expect_counts(part, 1, 0);
  EXPECT_EQ(part.edges()[0].faces, (std::vector<int>{0, 1}));
  EXPECT_EQ(part.edges()[0].piece_count, 4);
  EXPECT_EQ(summary(part).poles, 8);
}

TEST(Model, PyramidsTipIsWhereCreasesEnd) {
  const Part part = connected(pyramid());
  expect_counts(part, 8, 5);
  EXPECT_EQ(summary(part).tips, 4);
}

TEST(Model, LunesOfASphere) {
  // Two meridians meet at the pole at right angles, or straight on.
  const NurbsCurve meridian = profile(arcs(1), 0, 1, dvec2(0));
  expect_counts(connected({{revolved(meridian, 1)}, {}, {}}), 3, 3);
  const Part half = connected({{revolved(meridian, 2)}, {}, {}});
  expect_counts(half, 3, 2);
  EXPECT_EQ(summary(half).poles, 2);
}

TEST(Model, OpenSheetOfManyPatches) {
  NurbsSurface sheet{2, 1, {0, 0, 0}, {0, 0}, {}};
  for (int i = 1; i < 40; ++i) sheet.knots_u.push_back(i);
  for (int j = 1; j < 30; ++j) sheet.knots_v.push_back(j);
  sheet.knots_u.insert(sheet.knots_u.end(), 3, 40);
  sheet.knots_v.insert(sheet.knots_v.end(), 2, 30);
  for (int i = 0; i < sheet.count_u(); ++i) {
    for (int j = 0; j < sheet.count_v(); ++j) {
      sheet.points.push_back(homogeneous(dvec3(i, j, std::sin(0.1 * i) - 0.5 * i)));
    }
  }
  const Part part = connected({{sheet}, {}, {}});
  expect_counts(part, 4, 4);
  EXPECT_EQ(part.patches().size(), 1200u);
  EXPECT_EQ(summary(part).faces_and_pieces_of_edges,
            (std::vector<std::pair<std::size_t, int>>{{1, 30}, {1, 30}, {1, 40}, {1, 40}}));
}

TEST(Model, CreaseInsideAFace) {
  const Part part = connected(roof());
  // Both long sides have a kink in the middle.
  expect_counts(part, 7, 6);
  const auto crease = std::find_if(part.edges().begin(), part.edges().end(),
                                   [](const Edge& e) { return e.faces.size() == 2; });
  ASSERT_NE(crease, part.edges().end());
  EXPECT_EQ(crease->faces, (std::vector<int>{0, 0}));
}

/// Six squares, one of them with a bump that is smooth at all borders but the one at x = 0, 0 < y
/// < 1.
TEST(Model, CreaseThatFadesOut) {
  BezierPatch bump{3, 4, {}};
  for (int i = 0; i <= 3; ++i) {
    for (int j = 0; j <= 4; ++j) {
      const double z = i == 1 && j == 2 ? 0.3 : 0;
      bump.points.push_back(homogeneous(dvec3(i / 3.0, j / 4.0, z)));
    }
  }
  PartShape shape;
  for (const double i : {-1.0, 0.0}) {
    for (const double j : {-1.0, 0.0, 1.0}) {
      const bool bumped = i == 0 && j == 0;
      shape.surfaces.push_back(bumped ? as_nurbs(bump)
                                      : square(dvec3(i, j, 0), dvec3(1, 0, 0), dvec3(0, 1, 0)));
    }
  }
  const Part part = connected(shape);
  expect_counts(part, 11, 6);
  EXPECT_EQ(summary(part).smooth_sides, 12);
  // A free curve takes up where it ends.
  shape.curves = {polyline({dvec3(0, 1, 0), dvec3(0, 2, 0)})};
  expect_counts(connected(shape), 12, 6);
}

TEST(Model, KinkInABorder) {
  NurbsSurface sheet{1, 1, {0, 0, 1, 2, 2}, {0, 0, 1, 1}, {}};
  for (const dvec2& p :
       {dvec2(0, 0), dvec2(0, 1), dvec2(1, 0), dvec2(1, 1), dvec2(2, 0.5), dvec2(2, 1)}) {
    sheet.points.push_back(homogeneous(dvec3(p, 0)));
  }
  const Part part = connected({{sheet}, {}, {}});
  expect_counts(part, 5, 5);
  EXPECT_EQ(part.pieces().size(), 6u);
}

TEST(Model, MoreThanTwoSides) {
  const Part part = connected(three_sheets());
  expect_counts(part, 10, 8);
  int shared = 0;
  for (const Edge& edge : part.edges()) shared += edge.faces == std::vector<int>{0, 1, 2};
  EXPECT_EQ(shared, 1);
  EXPECT_EQ(summary(part).smooth_sides, 0);
  // Nor is a join smooth of which but two sides continue each other.
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  const Part tee =
      connected({{square(dvec3(0), x, y), square(x, x, y), square(x, dvec3(0, 0, 1), y)}, {}, {}});
  expect_counts(tee, 10, 8);
  EXPECT_EQ(summary(tee).smooth_sides, 0);
}

/// Two squares in one face, whose sides v0 meet head on.
TEST(Model, GapInsideAFace) {
  NurbsSurface pair{1, 1, {0, 0, 1, 1, 2, 2}, {0, 0, 1, 1}, {}};
  for (const dvec3& p : {dvec3(0, 0, 0), dvec3(0, 1, 0), dvec3(1, 0, 0), dvec3(1, 1, 0),
                         dvec3(2, 0, 0), dvec3(2, 1, 0), dvec3(1, 0, 0), dvec3(1, 1, 0)}) {
    pair.points.push_back(homogeneous(p));
  }
  const Part part = connected({{pair}, {}, {}});
  expect_counts(part, 6, 4);
  EXPECT_EQ(summary(part).smooth_sides, 2);
}

/// A disc as one patch: the rim is smooth where its four sides meet.
TEST(Model, EdgesEndWithTheirSide) {
  const double c = std::numbers::sqrt2 / 2;
  BezierPatch disc{2, 2, {}};
  for (const int i : {-1, 0, 1}) {
    for (const int j : {-1, 0, 1}) {
      const bool corner = i != 0 && j != 0;
      const double radius = corner ? c : 1 / c;
      disc.points.push_back(homogeneous(radius * dvec3(i, j, 0), (i + j) % 2 == 0 ? 1 : c));
    }
  }
  const Part part = connected({{as_nurbs(disc)}, {}, {}});
  expect_counts(part, 4, 0);
}

TEST(Model, StraightContinuationHasNoVertex) {
  // Along one face, along two faces, and where a third one meets them.
  const Part part = connected(two_on_one());
  expect_counts(part, 9, 6);
  EXPECT_EQ(summary(part).smooth_sides, 4);
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  expect_counts(connected({{square(dvec3(0), x, y), square(x, x, y)}, {}, {}}), 6, 4);
}

TEST(Model, SheetsBackToBackAreNotSmooth) {
  const NurbsSurface sheet = square(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0));
  // Of another degree: the same patch once more would be a repetition.
  const NurbsSurface raised = as_nurbs(elevated(decompose(sheet)[0].bezier, 2, 3));
  for (const NurbsSurface& other : {raised, reversed_u(raised), transposed(raised)}) {
    const Part part = connected({{sheet, other}, {}, {}});
    expect_counts(part, 4, 4);
    for (const Edge& edge : part.edges()) EXPECT_EQ(edge.faces, (std::vector<int>{0, 1}));
  }
}

/// All sixteen ways in which a side of one patch meets one of another, forwards and backwards.
TEST(Model, SmoothWhicheverSidesMeet) {
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  for (int code = 0; code < 64; ++code) {
    NurbsSurface a = square(dvec3(0), x, y);
    NurbsSurface b = square(x, x, y);
    if (code & 1) a = reversed_u(a);
    if (code & 2) a = transposed(a);
    if (code & 4) a = reversed_u(a);
    if (code & 8) b = reversed_u(b);
    if (code & 16) b = transposed(b);
    if (code & 32) b = reversed_u(b);
    const Part part = connected({{a, b}, {}, {}});
    expect_counts(part, 6, 4);
    EXPECT_EQ(summary(part).smooth_sides, 2);
  }
}

/// A tube of one patch, closed on itself with and without a kink: of two, so that none goes on into
/// itself, whichever parameter runs around it.
TEST(Model, PatchClosedOnItselfIsHalved) {
  for (const bool kink : {false, true}) {
    std::vector<dvec2> section = {dvec2(0, 0),  dvec2(1, 0),  dvec2(2, 3),
                                  dvec2(-2, 3), dvec2(-1, 0), dvec2(0, 0)};
    if (kink) section[1] = dvec2(1, 1);
    BezierPatch tube{5, 1, {}};
    for (const dvec2& p : section) {
      tube.points.push_back(homogeneous(dvec3(p, 0)));
      tube.points.push_back(homogeneous(dvec3(p, 4)));
    }
    for (const bool turned : {false, true}) {
      const BezierPatch own = turned ? transposed(tube) : tube;
      const Part part = connected({{as_nurbs(own)}, {}, {}});
      expect_counts(part, kink ? 3 : 2, kink ? 2 : 0);
      ASSERT_EQ(part.patches().size(), 2u);
      const Patch& first = part.patches()[0];
      const Interval& t = turned ? first.v : first.u;
      EXPECT_EQ(t.upper, 0.5);
      const dvec3 half = point(first.bezier, turned ? 0.3 : 0.5, turned ? 0.5 : 0.3);
      EXPECT_LE(glm::distance(half, point(own, turned ? 0.3 : 0.25, turned ? 0.25 : 0.3)), 1e-15);
      const Border& seam = first.borders[std::size_t(turned ? Side::v0 : Side::u0)];
      EXPECT_EQ(seam.kind, kink ? BorderKind::edge : BorderKind::smooth);
      EXPECT_EQ(seam.neighbor, 1);
      EXPECT_EQ(seam.neighbor_side, turned ? Side::v1 : Side::u1);
      if (kink) {
        EXPECT_EQ(part.edges()[to_size(seam.edge)].faces, (std::vector<int>{0, 0}));
      }
    }
  }
}

/// A patch that is closed both ways: of four, v within u.
TEST(Model, PatchClosedBothWaysIsQuartered) {
  const std::vector<dvec2> loop = {dvec2(0, 0), dvec2(4, 3), dvec2(4, -3), dvec2(0, 0)};
  BezierPatch own{3, 3, {}};
  for (const dvec2& a : loop) {
    for (const dvec2& b : loop) own.points.push_back(homogeneous(dvec3(a.x, a.y + b.x, b.y)));
  }
  Part part;
  part.add_surface(as_nurbs(own), "closed");
  ASSERT_EQ(part.patches().size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const Patch& patch = part.patches()[k];
    const dvec2 lower(0.5 * double(k / 2), 0.5 * double(k % 2));
    EXPECT_EQ(dvec2(patch.u.lower, patch.v.lower), lower);
    EXPECT_EQ(dvec2(patch.u.upper, patch.v.upper), lower + 0.5);
    const dvec3 middle = point(own, lower.x + 0.25, lower.y + 0.25);
    EXPECT_LE(glm::distance(point(patch.bezier, 0.5, 0.5), middle), 1e-14);
  }
}

/// A curve of one closed piece is of two.
TEST(Model, CurveClosedOnItselfIsHalved) {
  const BezierCurve loop = {
      {dvec4(0, 0, 0, 1), dvec4(4, 3, 0, 1), dvec4(4, -3, 0, 1), dvec4(0, 0, 0, 1)}};
  const Part part = connected({{}, {as_nurbs(loop)}, {}});
  ASSERT_EQ(part.pieces().size(), 2u);
  EXPECT_EQ(part.edges().size(), 1u);
  EXPECT_EQ(part.pieces()[1].t.lower, 0.5);
  EXPECT_EQ(point(part.pieces()[0].bezier, 1), point(loop, 0.5));
}

TEST(Model, OtherDegreesAndWeightsOnTheOtherSide) {
  Rearrangement random(1);
  BezierPatch a{3, 2, {}};
  for (int i = 0; i < 12; ++i) a.points.push_back(homogeneous(random.vector(), random(0.5, 2)));
  BezierPatch b{3, 2, {}};
  for (int i = 0; i < 12; ++i) b.points.push_back(homogeneous(random.vector(), random(0.5, 2)));
  for (int j = 0; j <= 2; ++j) b.at(0, j) = a.at(3, 2 - j);
  b = elevated(b, 3, 5);
  for (dvec4& p : b.points) p *= 7.3;
  const Part part = connected({{as_nurbs(a), as_nurbs(b)}, {}, {}});
  expect_counts(part, 7, 6);
  EXPECT_EQ(part.patches()[0].borders[1].neighbor, 1);
  EXPECT_TRUE(part.patches()[0].borders[1].reversed);
}

/// Curves with the same ends and the same middle are not the same curve.
TEST(Model, SidesMustAgreeEverywhere) {
  const auto sheet = [](double bulge, double depth) {
    BezierPatch patch{4, 1, {}};
    const std::array<double, 5> x = {0, 1, 2, 3, 4};
    const std::array<double, 5> y = {0, bulge, 0, -bulge, 0};
    for (std::size_t i = 0; i < 5; ++i) {
      patch.points.push_back(homogeneous(dvec3(x[i], y[i], 0)));
      patch.points.push_back(homogeneous(dvec3(x[i], y[i], depth)));
    }
    return as_nurbs(patch);
  };
  expect_counts(connected({{sheet(0.01, 1), sheet(0.01, -1)}, {}, {}}), 6, 4);
  const Part part = connected({{sheet(0.01, 1), sheet(-0.01, -1)}, {}, {}});
  EXPECT_EQ(part.patches()[0].borders[2].neighbor, -1);
  EXPECT_EQ(part.edges().size(), 8u);
}

TEST(Model, GapsUpToTheJoinDistance) {
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  const double tolerance = join_distance * std::sqrt(5);
  for (const dvec3& direction : {x, y, dvec3(0, 0, 1)}) {
    for (const auto& [gap, edges] : {std::pair(0.99, 6u), std::pair(1.01, 8u)}) {
      const dvec3 shift = gap * tolerance * direction;
      const PartShape shape{{square(dvec3(0), x, y), square(x + shift, x, y)}, {}, {}};
      EXPECT_EQ(connected(shape).edges().size(), edges) << gap;
    }
  }
}

TEST(Model, JoinsUpToTheSmoothAngle) {
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  for (const double limit : {1e-6, smooth_join_angle, 0.1, 1.0}) {
    for (const auto& [factor, edges] : {std::pair(0.999, 6u), std::pair(1.001, 7u)}) {
      for (const double sign : {-1.0, 1.0}) {
        const double angle = sign * factor * limit;
        const dvec3 bent(std::cos(angle), 0, std::sin(angle));
        // The rims go straight on within the same angle.
        const PartShape shape{{square(dvec3(0), x, y), square(x, bent, y)}, {}, {}};
        EXPECT_EQ(connected(shape, limit).edges().size(), edges) << angle;
      }
    }
  }
}

/// The patches are tangent at the ends and in the middle of their join, not between.
TEST(Model, JoinsMustBeSmoothEverywhere) {
  for (const double bump : {0.0, 0.02}) {
    BezierPatch a{1, 3, {}};
    BezierPatch b{1, 3, {}};
    const std::array<double, 4> z = {0, bump, -bump, 0};
    for (const double x : {-1.0, 0.0}) {
      for (const double y : {0, 1, 2, 3}) a.points.push_back(homogeneous(dvec3(x, y, 0)));
    }
    for (const double x : {0.0, 1.0}) {
      for (std::size_t j = 0; j < 4; ++j) {
        b.points.push_back(homogeneous(dvec3(x, static_cast<double>(j), x * z[j])));
      }
    }
    const Part part = connected({{as_nurbs(a), as_nurbs(b)}, {}, {}});
    EXPECT_EQ(part.patches()[0].borders[1].neighbor, 1);
    EXPECT_EQ(part.patches()[0].borders[1].kind, bump == 0 ? BorderKind::smooth : BorderKind::edge);
  }
}

/// Every square is off by its own error, and many borders lie across the cells of a search.
TEST(Model, SquaresThatFitWithinTolerance) {
  Rearrangement random(2);
  const int n = 30;
  const double error = 0.25 * join_distance * n * std::numbers::sqrt2;
  const dmat3 rotation = random.rotation();
  PartShape shape;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto corner = [&](int a, int b) {
        return rotation * dvec3(i + a, j + b, 0) + error * random.vector();
      };
      shape.surfaces.push_back(quad(corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)));
    }
  }
  random.shuffle(shape.surfaces);
  const Part part = connected(shape);
  expect_counts(part, 4 * n, 4);
  EXPECT_EQ(summary(part).smooth_sides, 4 * n * (n - 1));
}

/// A corner that is within the tolerance of two others, which are not of each other: what meets it
/// along a side, or collapses onto it, ends in the same vertex.
TEST(Model, CornersThatJoinsUnite) {
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  const dvec3 z(0, 0, 1);
  const dvec3 shift = 0.9 * join_distance * std::sqrt(9) * x;
  const PartShape shape{
      {square(x + y + shift, x, y), square(dvec3(0), x, y), square(x - shift, y, z)}, {}, {}};
  expect_counts(connected(shape), 11, 9);
  const PartShape tip{
      {square(shift, x, 2.0 * y), quad(dvec3(0), -shift, -x - z, -y - 2.0 * z)}, {}, {}};
  expect_counts(connected(tip), 7, 6);
}

TEST(Model, PatchWithoutExtent) {
  // Smaller than the tolerance: nothing is left of it but a vertex.
  const dvec3 small(1e-8, 0, 0);
  const NurbsSurface dot = quad(dvec3(0), small, small, dvec3(0));
  const NurbsSurface sheet = square(dvec3(1), dvec3(1, 0, 0), dvec3(0, 1, 0));
  expect_counts(connected({{dot, sheet}, {}, {}}), 4, 5);
  expect_counts(connected({{quad(dvec3(7), dvec3(7), dvec3(7), dvec3(7))}, {}, {}}), 0, 1);
  // A surface that is but a segment meets itself, without any normal.
  const NurbsSurface needle = quad(dvec3(0), dvec3(1, 2, 3), dvec3(0), dvec3(1, 2, 3));
  const Part part = connected({{needle}, {}, {}});
  expect_counts(part, 1, 2);
  EXPECT_EQ(part.edges()[0].faces, (std::vector<int>{0, 0}));
}

TEST(Model, NothingAtAll) {
  const Part part = connected({});
  expect_counts(part, 0, 0);
  EXPECT_TRUE(part.control_box().empty());
}

// ---- Free curves and points

TEST(Model, FreeCurves) {
  const dvec3 x(1, 0, 0);
  expect_counts(connected({{}, {polyline({dvec3(0), x})}, {}}), 1, 2);
  expect_counts(connected({{}, {arcs(4)}, {}}), 1, 0);
  expect_counts(connected({{}, {arcs(3)}, {}}), 1, 2);
  // Kinks are vertices, whether or not the curve closes; the curve stays one edge.
  expect_counts(connected({{}, {polyline({dvec3(0), x, dvec3(0, 1, 0), dvec3(0)})}, {}}), 1, 3);
  expect_counts(connected({{}, {polyline({dvec3(0), x, dvec3(1, 1, 0), 3.0 * x})}, {}}), 1, 4);
  // Straight on from curve to curve, against each other's direction.
  const Part two = connected({{}, {polyline({x, dvec3(0)}), polyline({x, 2.0 * x})}, {}});
  expect_counts(two, 2, 2);
  EXPECT_EQ(two.pieces()[0].end_neighbor, (std::array<int, 2>{1, -1}));
  EXPECT_EQ(two.pieces()[1].end_neighbor, (std::array<int, 2>{0, -1}));
  // No direction at all, and one that takes some looking for.
  expect_counts(connected({{}, {polyline({x, x})}, {}}), 1, 1);
  const BezierCurve slow{{homogeneous(dvec3(0)), homogeneous(dvec3(0, 1e-9, 0)), homogeneous(x)}};
  BezierCurve back = slow;
  for (dvec4& p : back.points) p = homogeneous(-euclidean(p));
  expect_counts(connected({{}, {as_nurbs(slow), as_nurbs(back)}, {}}), 2, 2);
  // A straight one goes on in a bent one: in a vertex.
  expect_counts(connected({{}, {as_nurbs(slow), polyline({dvec3(0), -x})}, {}}), 2, 3);
  // Two that run back over each other.
  expect_counts(connected({{}, {polyline({dvec3(0), x}), polyline({x, dvec3(0)})}, {}}), 2, 2);
  // A gap inside.
  NurbsCurve broken{1, {0, 0, 1, 1, 2, 2}, {}};
  for (int i = 0; i < 4; ++i) broken.points.push_back(homogeneous(dvec3(i, 0, 0)));
  expect_counts(connected({{}, {broken}, {}}), 1, 4);
}

TEST(Model, FreeCurveKeepsItsNameAndParameter) {
  NurbsCurve curve = polyline({dvec3(0), dvec3(1, 0, 0), dvec3(2, 1, 0)});
  curve.knots = {5, 5, 7, 8, 8};
  Part part;
  part.add_surface(square(dvec3(0), dvec3(0, 1, 0), dvec3(0, 0, 1)), "wall");
  part.add_curve(curve, "rail");
  part.connect(smooth_join_angle);
  expect_consistent(part);
  EXPECT_EQ(part.faces()[0].name, "wall");
  EXPECT_EQ(part.edges()[0].name, "rail");
  EXPECT_TRUE(part.edges()[0].faces.empty());
  EXPECT_EQ(part.pieces()[0].t.lower, 5);
  EXPECT_EQ(part.pieces()[1].t.lower, 7);
  EXPECT_EQ(part.pieces()[1].t.upper, 8);
  // It starts at a corner of the wall: one vertex for both.
  EXPECT_EQ(part.edges().size(), 5u);
  EXPECT_EQ(part.vertices().size(), 6u);
  EXPECT_EQ(part.pieces()[0].end_vertex[0], part.patches()[0].corner_vertex[0]);
}

TEST(Model, FreePoints) {
  Part part;
  part.add_point(dvec3(1, 2, 3));
  part.add_point(dvec3(1, 2, 3));
  part.add_curve(polyline({dvec3(1, 2, 3), dvec3(4, 5, 6)}), "line");
  part.connect(smooth_join_angle);
  ASSERT_EQ(part.vertices().size(), 4u);
  EXPECT_EQ(part.point_count(), 2);
  EXPECT_EQ(part.vertices()[1], dvec3(1, 2, 3));
  expect_consistent(part);
}

// ---- Invariance

TEST(Model, InvariantUnderOrderParametersPlaceAndSize) {
  Rearrangement random(3);
  for (const auto& [name, shape] : all_shapes()) {
    const Summary expected = summary(connected(shape));
    for (int k = 0; k < 30; ++k) {
      const double scale = std::pow(10.0, random(-6, 6));
      const dmat3 rotation = random.rotation();
      const dvec3 shift = std::pow(10.0, random(-2, 2)) * random.vector();
      const PartShape other = random.rearranged(
          transformed(shape, [&](const dvec3& x) { return scale * (rotation * x + shift); }));
      const Part part = connected(other);
      SCOPED_TRACE(testing::Message() << name << " scale " << scale);
      expect_consistent(part);
      EXPECT_EQ(summary(part), expected);
    }
  }
}

TEST(Model, AllShapesInOnePart) {
  PartShape all;
  Summary expected;
  double place = 0;
  for (const auto& [name, shape] : all_shapes()) {
    place += 10;
    const PartShape moved =
        transformed(shape, [&](const dvec3& x) { return x + dvec3(place, 0, 0); });
    all.surfaces.insert(all.surfaces.end(), moved.surfaces.begin(), moved.surfaces.end());
    all.curves.insert(all.curves.end(), moved.curves.begin(), moved.curves.end());
    all.points.insert(all.points.end(), moved.points.begin(), moved.points.end());
    const Summary s = summary(connected(shape));
    expected.edges += s.edges;
    expected.vertices += s.vertices;
    expected.smooth_sides += s.smooth_sides;
  }
  const Part part = connected(all);
  expect_consistent(part);
  EXPECT_EQ(summary(part).edges, expected.edges);
  EXPECT_EQ(summary(part).vertices, expected.vertices);
  EXPECT_EQ(summary(part).smooth_sides, expected.smooth_sides);
}

// ---- The teapot

std::vector<BezierPatch> read_bpt(std::istream& in) {
  int count = 0;
  in >> count;
  std::vector<BezierPatch> patches(to_size(count));
  for (BezierPatch& patch : patches) {
    in >> patch.degree_u >> patch.degree_v;
    for (int i = 0; i < (patch.degree_u + 1) * (patch.degree_v + 1); ++i) {
      dvec3 p;
      in >> p.x >> p.y >> p.z;
      patch.points.push_back(homogeneous(p));
    }
  }
  return patches;
}

dvec3 side_normal(const BezierPatch& patch, Side side, double t) {
  const dvec2 at = on_side(side, t);
  return unit_normal(patch, at.x, at.y);
}

/// Largest angle between the tangent planes along all joins of two sides.
double largest_join_angle(const Part& part) {
  double largest = 0;
  for (const Patch& patch : part.patches()) {
    for (const Side side : all_sides) {
      const Border& b = patch.borders[to_size(static_cast<int>(side))];
      if (b.neighbor < 0) continue;
      for (int k = 0; k <= 200; ++k) {
        const double t = k / 200.0;
        const dvec3 m = side_normal(patch.bezier, side, t);
        const dvec3 n = side_normal(part.patches()[to_size(b.neighbor)].bezier, b.neighbor_side,
                                    b.reversed ? 1 - t : t);
        largest =
            std::max(largest, std::atan2(glm::length(glm::cross(m, n)), std::abs(glm::dot(m, n))));
      }
    }
  }
  return largest;
}

/// Newell's teapot has no crease: all 52 joins of its 32 patches are G1, as are the poles of the
/// knob and of the bottom. What is left are the rims, as smooth closed loops: of the body and of
/// the lid (4 patches each), of both ends of the handle and of the spout (2 each). The crests of
/// its rim and its handle cannot touch the hull.
TEST(Model, Teapot) {
  const char* folder = std::getenv("TAUT_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_MODELS does not name the folder of models";
  std::ifstream file(std::string(folder) + "/A14_teapot_newell.bpt");
  if (!file) GTEST_SKIP() << "no teapot in " << folder;
  PartShape shape;
  for (const BezierPatch& patch : read_bpt(file)) shape.surfaces.push_back(as_nurbs(patch));
  ASSERT_EQ(shape.surfaces.size(), 32u);

  const Part part = connected(shape);
  const Summary found = summary(part);
  const double angle = largest_join_angle(part);
  std::cout << "teapot: " << found << "; largest join angle " << angle << "\n";
  expect_counts(part, 16, 0);
  expect_seams(part, 0, 0);
  EXPECT_EQ(found.smooth_sides, 104);
  EXPECT_EQ(found.poles, 8);
  EXPECT_LT(angle, 1e-6);
  for (const Edge& edge : part.edges()) EXPECT_EQ(edge.faces.size(), 1u);

  Rearrangement random(4);
  for (int k = 0; k < 10; ++k) {
    const double scale = std::pow(10.0, random(-6, 6));
    const dmat3 rotation = random.rotation();
    const PartShape other = random.rearranged(
        transformed(shape, [&](const dvec3& x) { return scale * (rotation * x); }));
    EXPECT_EQ(summary(connected(other)), found);
  }
}

// ---- Parts and instances

TEST(Model, SourcesAreNumberedPerInstance) {
  Model model;
  EXPECT_EQ(model.source_count(), 0);
  EXPECT_EQ(model.add_part(part_of(cube()), smooth_join_angle), 0);    // 6 + 12 + 8
  EXPECT_EQ(model.add_part(part_of({}), smooth_join_angle), 1);        // nothing
  EXPECT_EQ(model.add_part(connected(cone()), smooth_join_angle), 2);  // 1 + 1 + 1
  RigidMotion pose;
  pose.translation = dvec3(5, 0, 0);
  model.add_instance(0, pose);
  EXPECT_EQ(model.instances().size(), 4u);
  EXPECT_EQ(model.source_count(), 26 + 0 + 3 + 26);
  EXPECT_EQ(model.face_count(), 13);
  EXPECT_EQ(model.edge_count(), 25);
  EXPECT_EQ(model.vertex_count(), 17);
  EXPECT_EQ(model.patch_count(), 16);

  std::vector<Source> sources;
  for (int instance = 0; instance < 4; ++instance) {
    const Part& part = model.parts()[to_size(model.instances()[to_size(instance)].part)];
    const auto append = [&](SourceKind kind, std::size_t count) {
      for (int i = 0; i < static_cast<int>(count); ++i) sources.push_back({kind, instance, i});
    };
    append(SourceKind::face, part.faces().size());
    append(SourceKind::edge, part.edges().size());
    append(SourceKind::vertex, part.vertices().size());
  }
  ASSERT_EQ(to_size(model.source_count()), sources.size());
  for (int id = 0; id < model.source_count(); ++id) {
    const Source& expected = sources[to_size(id)];
    const Source source = model.source(id);
    EXPECT_EQ(source.kind, expected.kind) << id;
    EXPECT_EQ(source.instance, expected.instance) << id;
    EXPECT_EQ(source.index, expected.index) << id;
    EXPECT_EQ(model.source_id(source), id);
  }
}

TEST(Model, ClearInstances) {
  Model model;
  model.add_part(part_of(cube()), smooth_join_angle);
  model.clear_instances();
  EXPECT_EQ(model.source_count(), 0);
  EXPECT_EQ(model.patch_count(), 0);
  EXPECT_EQ(model.face_count(), 0);
  EXPECT_EQ(model.parts().size(), 1u);
  RigidMotion pose;
  pose.rotation = Rearrangement(5).rotation();
  model.add_instance(0, pose);
  EXPECT_EQ(model.source_count(), 26);
  EXPECT_EQ(model.source(25).kind, SourceKind::vertex);
  EXPECT_EQ(model.source(25).instance, 0);
}

TEST(Model, AddPartConnectsUnlessConnected) {
  const dvec3 x(1, 0, 0);
  const dvec3 y(0, 1, 0);
  const PartShape bent{{square(dvec3(0), x, y), square(x, dvec3(1, 0, 0.1), y)}, {}, {}};
  Model model;
  EXPECT_FALSE(part_of(bent).connected());
  model.add_part(part_of(bent), smooth_join_angle);
  model.add_part(connected(bent, 1.0), smooth_join_angle);
  EXPECT_TRUE(model.parts()[0].connected());
  EXPECT_EQ(model.parts()[0].edges().size(), 7u);
  EXPECT_EQ(model.parts()[1].edges().size(), 6u);
}

TEST(Model, InstancesAreValidated) {
  Model model;
  model.add_part(part_of(cube()), smooth_join_angle);
  expect_invalid([&] { model.add_instance(1, {}); }, "no part 1");
  expect_invalid([&] { model.add_instance(-1, {}); }, "no part -1");
  RigidMotion pose;
  pose.rotation[0][0] = -1;
  expect_invalid([&] { model.add_instance(0, pose); }, "instance 1");
  pose.rotation = dmat3(1.0 + 1e-8);
  expect_invalid([&] { model.add_instance(0, pose); }, "rotation");
  pose.rotation = dmat3(1.0);
  pose.rotation[1][0] = 1e-8;
  expect_invalid([&] { model.add_instance(0, pose); }, "rotation");
  pose.rotation[1][0] = no_number;
  expect_invalid([&] { model.add_instance(0, pose); }, "rotation");
  pose.rotation = dmat3(1.0 + 1e-10);
  pose.translation.y = infinity;
  expect_invalid([&] { model.add_instance(0, pose); }, "translation");
  EXPECT_EQ(model.instances().size(), 1u);
  pose.translation.y = 1e100;
  EXPECT_NO_THROW(model.add_instance(0, pose));
}

TEST(Model, ExtentsThatOverflowAreRefused) {
  const auto far = [](double x) {
    Part part;
    part.name = "far";
    part.add_point(dvec3(x, 0, 0));
    return part;
  };
  Model model;
  model.add_part(far(1.7e308), smooth_join_angle);
  expect_invalid([&] { model.add_part(far(-1.7e308), smooth_join_angle); }, "part far: the extent");
  EXPECT_EQ(model.parts().size(), 1U);
  EXPECT_EQ(model.instances().size(), 1U);
  for (const dvec3& to : {dvec3(0, 1.7e308, 1.7e308), dvec3(1e308, 0, 0)}) {
    expect_invalid([&] { model.add_instance(0, {dmat3(1.0), to}); }, "instance 1: the extent");
  }
  model.clear_instances();
  EXPECT_NO_THROW(model.add_part(far(-1.7e308), smooth_join_angle));
}

TEST(Model, NamesInMessagesAreShortAndPrintable) {
  Part part;
  part.name = "a\n" + std::string(200, 'b');
  const std::string shown = "a?" + std::string(78, 'b') + "...";
  expect_invalid([&] { part.add_point(dvec3(0, 0, infinity)); }, shown + ": point 0 is not");
  const NurbsCurve line{1, {0, 0, 1, 1}, {homogeneous(dvec3(0.0)), homogeneous(dvec3(infinity))}};
  expect_invalid([&] { part.add_curve(line, "c\x1b"); }, "c?: control point 1");
}

TEST(Model, SourcesBeyondIntAreRefused) {
  Part part;
  const int points = 1 << 16;
  for (int i = 0; i < points; ++i) part.add_point(dvec3(i, 0, 0));
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  for (int i = 1; i < 32767; ++i) model.add_instance(0, {});
  EXPECT_EQ(model.source_count(), 32767 * points);
  EXPECT_THROW(model.add_instance(0, {}), LimitExceeded);
  EXPECT_EQ(model.source_count(), 32767 * points);
  Part other;
  for (int i = 0; i < points; ++i) other.add_point(dvec3(i, 0, 0));
  EXPECT_THROW(model.add_part(other, smooth_join_angle), LimitExceeded);
  EXPECT_EQ(model.parts().size(), 1u);
}

TEST(Model, PatchesBeyondIntAreRefused) {
  const int n = 64;
  NurbsSurface sheet{1, 1, {0}, {0}, {}};
  for (int i = 0; i <= n; ++i) {
    sheet.knots_u.push_back(i);
    sheet.knots_v.push_back(i);
    for (int j = 0; j <= n; ++j) sheet.points.push_back(homogeneous(dvec3(i, j, 0)));
  }
  sheet.knots_u.push_back(n);
  sheet.knots_v.push_back(n);
  Model model;
  model.add_part(part_of({{sheet}, {}, {}}), smooth_join_angle);
  const int most = std::numeric_limits<int>::max() / (n * n);
  for (int i = 1; i < most; ++i) model.add_instance(0, {});
  EXPECT_EQ(model.patch_count(), most * n * n);
  EXPECT_THROW(model.add_instance(0, {}), LimitExceeded);
}

/// What is refused leaves the part as it was.
TEST(Model, GeometryIsValidated) {
  Part part;
  part.name = "bracket";
  NurbsSurface surface = square(dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0));
  surface.points[2].w = 0;
  expect_invalid([&] { part.add_surface(surface, "lid"); }, "lid");
  surface = square(dvec3(0), dvec3(1e308, 0, 0), dvec3(0, 1e308, 1e308));
  surface.points[0].x = -1e308;
  expect_invalid([&] { part.add_surface(surface, "lid"); }, "extent");
  NurbsCurve curve = polyline({dvec3(0), dvec3(1)});
  curve.points[1].w = 1e-320;
  expect_invalid([&] { part.add_curve(curve, "rail"); }, "rail");
  curve.knots[1] = no_number;
  expect_invalid([&] { part.add_curve(curve, "rail"); }, "knot 1");
  expect_invalid([&] { part.add_point(dvec3(0, no_number, 0)); }, "bracket: point 0");
  expect_invalid([&] { part.add_point(dvec3(0, 0, infinity)); }, "not finite");
  EXPECT_TRUE(part.control_box().empty());
  EXPECT_TRUE(part.faces().empty() && part.edges().empty() && part.vertices().empty());
  EXPECT_TRUE(part.patches().empty() && part.pieces().empty());
  for (const double angle : {-1e-3, no_number, 2.0}) {
    expect_invalid([&] { part.connect(angle); }, "smooth angle");
  }
  EXPECT_FALSE(part.connected());
}

TEST(Model, ControlBox) {
  Part part;
  part.add_surface(square(dvec3(0), dvec3(1, 0, 0), dvec3(0, 2, 0)), "a");
  part.add_curve(polyline({dvec3(-1, 0, 0), dvec3(0, 0, 5)}), "b");
  part.add_point(dvec3(0, -3, 0));
  EXPECT_EQ(part.control_box().lower, dvec3(-1, -3, 0));
  EXPECT_EQ(part.control_box().upper, dvec3(1, 2, 5));
}

/// Of many patches; of a few it tells nothing.
TEST(Model, ConnectTellsTheShareThatIsDone) {
  for (const int rows : {2, 40}) {
    Part part;
    for (int k = 0; k < rows * rows; ++k) {
      part.add_surface(square(dvec3(k % rows, k / rows, 0), dvec3(1, 0, 0), dvec3(0, 1, 0)),
                       "tile");
    }
    std::vector<double> shares;
    Progress progress;
    progress.report = [&](std::string_view step, double share) {
      EXPECT_EQ(step, "connect");
      shares.push_back(share);
    };
    part.connect(smooth_join_angle, progress);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.size() > 10, rows == 40);
    for (const double share : shares) EXPECT_TRUE(share > 0 && share < 1);
  }
}

}  // namespace
}  // namespace taut
