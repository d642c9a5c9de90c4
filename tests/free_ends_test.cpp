#include "taut/hull/solve/free_ends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "exact_checks.h"
#include "free_end_checks.h"
#include "models.h"
#include "taut/bounds/poles.h"
#include "taut/bounds/supporting_plane.h"
#include "taut/subdivision/reparametrize.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// A scene with all that free ends are sought and judged by.
struct Setting {
  explicit Setting(const Shape& shape) : Setting(make_model(shape)) {}
  explicit Setting(Model model)
      : scene(std::move(model), {.threads = 1, .progress = {}}), geometry(scene), query(scene) {}
  dvec3 point(const FreeEnd& end) const {
    return scene.frame().to_model(geometry.point(end.contact));
  }
  bool supports(const FreeEnd& end) {
    return is_supporting(geometry, query, end.n, glm::dot(geometry.point(end.contact), end.n),
                         end.contact);
  }

  Scene scene;
  ContactGeometry geometry;
  SupportQuery query;
};

/// Places in all elements of a kind; no ends, middles or quarters of any.
std::vector<Contact> places(const Setting& own, SourceKind kind, int steps) {
  const Part& part = own.geometry.part({0, kind, 0, 0, 0});
  const std::size_t count = kind == SourceKind::face   ? part.patches().size()
                            : kind == SourceKind::edge ? part.pieces().size()
                                                       : part.vertices().size();
  const int in_u = kind == SourceKind::vertex ? 1 : steps;
  const int in_v = kind == SourceKind::face ? steps : 1;
  std::vector<Contact> result;
  for (int k = 0; k < int(count); ++k) {
    for (int i = 0; i < in_u; ++i) {
      for (int j = 0; j < in_v; ++j) {
        result.push_back({0, kind, k, (i + 0.37) / steps, (j + 0.41) / steps});
      }
    }
  }
  return result;
}

/// The place nearest to a point of the model.
Contact place_near(const Setting& own, SourceKind kind, const dvec3& x) {
  const dvec3 to = own.scene.frame().to_frame(x);
  const std::vector<Contact> all = places(own, kind, kind == SourceKind::face ? 32 : 256);
  const auto distance = [&](const Contact& c) { return glm::distance(own.geometry.point(c), to); };
  return *std::min_element(all.begin(), all.end(), [&](const Contact& a, const Contact& b) {
    return distance(a) < distance(b);
  });
}

/// What is found from a place nearby and a direction that is turned a little.
std::optional<FreeEnd> sought(const Setting& own, FreeEnd::Kind kind, SourceKind element,
                              const dvec3& x, const dvec3& n) {
  const dvec3 turned = glm::normalize(n + 1e-3 * glm::cross(n, dvec3(0.6, -0.5, 0.4)));
  return polished(own.geometry, {turned, place_near(own, element, x), kind, dvec3(0.0)});
}

/// A free end that is known in closed form.
struct KnownEnd {
  FreeEnd::Kind kind;
  SourceKind element;
  dvec3 x, n, along;
};

/// Lengths relative to `size`. From which contact to which it leads at a border or a vertex counts,
/// as `along` tells.
void expect_found(Setting& own, const KnownEnd& known, double size, double slack) {
  const std::optional<FreeEnd> end = sought(own, known.kind, known.element, known.x, known.n);
  ASSERT_TRUE(end.has_value());
  EXPECT_EQ(end->kind, known.kind);
  EXPECT_EQ(end->contact.kind, known.element);
  EXPECT_LT(glm::distance(own.point(*end), known.x), slack * size);
  EXPECT_LT(glm::distance(end->n, known.n), slack);
  const bool has_sense = known.kind == FreeEnd::Kind::border || known.kind == FreeEnd::Kind::end;
  const double cosine = glm::dot(end->along, known.along);
  EXPECT_NEAR(has_sense ? cosine : std::abs(cosine), 1, slack);
  EXPECT_TRUE(own.supports(*end));
}

Shape as_shape(const BezierCurve& curve) {
  NurbsCurve nurbs{curve.degree(), {}, curve.points};
  nurbs.knots.assign(curve.points.size(), 0.0);
  nurbs.knots.insert(nurbs.knots.end(), curve.points.size(), 1.0);
  return {{}, {nurbs}, {}};
}

/// Coefficients of a polynomial of degree n in Bernstein form over [a, b], from those of powers.
std::vector<double> bernstein(std::vector<double> powers, int n, double a, double b) {
  powers.resize(std::size_t(n) + 1);
  // In s, x = a + (b - a) s: Horner's scheme on polynomials.
  std::vector<double> shifted(std::size_t(n) + 1, 0.0);
  for (int k = n; k >= 0; --k) {
    for (int i = n; i >= 0; --i) {
      shifted[std::size_t(i)] =
          a * shifted[std::size_t(i)] + (i > 0 ? (b - a) * shifted[std::size_t(i) - 1] : 0.0);
    }
    shifted[0] += powers[std::size_t(k)];
  }
  std::vector<double> result(std::size_t(n) + 1, 0.0);
  for (int i = 0; i <= n; ++i) {
    double share = 1;  // binomial(i, k) / binomial(n, k)
    for (int k = 0; k <= i; ++k) {
      result[std::size_t(i)] += share * shifted[std::size_t(k)];
      share *= double(i - k) / double(n - k);
    }
  }
  return result;
}

/// One half of (cos t, sin 2t, cos 3t), exactly, by the tangent of t / 2 over [from, to]; the other
/// half with both cosines' signs changed.
NurbsCurve half_wave(double from, double to, double sign) {
  // Times (1 + s^2)^3, with c = 1 - s^2 and w = 1 + s^2: c w^2, 4 s c w, 4 c^3 - 3 c w^2.
  const std::vector<double> x = {1, 0, 1, 0, -1, 0, -1};
  const std::vector<double> y = {0, 4, 0, 0, 0, -4, 0};
  const std::vector<double> z = {1, 0, -15, 0, 15, 0, -1};
  const std::vector<double> w = {1, 0, 3, 0, 3, 0, 1};
  const auto of = [&](const std::vector<double>& powers) { return bernstein(powers, 6, from, to); };
  const auto bx = of(x), by = of(y), bz = of(z), bw = of(w);
  NurbsCurve curve{6, {}, {}};
  curve.knots = {0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1};
  curve.points.reserve(7);
  for (std::size_t k = 0; k <= 6; ++k) {
    curve.points.emplace_back(sign * bx[k], by[k], sign * bz[k], bw[k]);
  }
  return curve;
}

void expect_wave_ends(const Shape& wave, const std::string& name) {
  SCOPED_TRACE(name);
  Setting own(wave);
  for (const double sign : {1.0, -1.0}) {
    // At (1, 0, 1) the tangent is (0, 2, 0) and the second derivative (-1, 0, -9).
    const dvec3 n = sign * dvec3(9, 0, -1) / std::sqrt(82.0);
    expect_found(own,
                 {FreeEnd::Kind::edge, SourceKind::edge, sign * dvec3(1, 0, 1), n, dvec3(0, 1, 0)},
                 1, 1e-12);
  }
}

TEST(FreeEnds, OfATwistedCurve) {
  // The ends inside of pieces, where pieces join, and next to that.
  for (const std::vector<double>& joins :
       {std::vector<double>{-1, -0.4, 0.5, 1}, {-1, 0, 1}, {-1, 1e-3, 1}, {-1, -1e-6, 1}}) {
    Shape wave;
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t k = 0; k + 1 < joins.size(); ++k) {
        wave.curves.push_back(half_wave(joins[k], joins[k + 1], sign));
      }
    }
    expect_wave_ends(wave, std::to_string(joins[1]));
  }
}

/// z = -(a x^4 - b x^2 y + c y^2) over a rectangle.
BezierPatch godron_patch(double a, double b, double c, Interval x, Interval y) {
  BezierPatch patch{4, 2, {}};
  const std::vector<double> x4 = bernstein({0, 0, 0, 0, 1}, 4, x.lower, x.upper);
  const std::vector<double> x2 = bernstein({0, 0, 1}, 4, x.lower, x.upper);
  const std::vector<double> x1 = bernstein({0, 1}, 4, x.lower, x.upper);
  const std::vector<double> y2 = bernstein({0, 0, 1}, 2, y.lower, y.upper);
  const std::vector<double> y1 = bernstein({0, 1}, 2, y.lower, y.upper);
  for (std::size_t i = 0; i <= 4; ++i) {
    for (std::size_t j = 0; j <= 2; ++j) {
      const double z = -(a * x4[i] - b * x2[i] * y1[j] + c * y2[j]);
      patch.points.push_back(homogeneous({x1[i], y1[j], z}));
    }
  }
  return patch;
}

/// In pieces over the grid of these lines.
Shape godron(double a, double b, double c, const std::vector<double>& xs,
             const std::vector<double>& ys) {
  Shape shape;
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
      shape = shape + of_patch(godron_patch(a, b, c, {xs[i], xs[i + 1]}, {ys[j], ys[j + 1]}));
    }
  }
  return shape;
}

void expect_godron(const Shape& shape, const dmat3& turn, const dvec3& shift) {
  Setting own(mapped(shape, turn, shift));
  expect_found(
      own,
      {FreeEnd::Kind::face, SourceKind::face, shift, turn * dvec3(0, 0, 1), turn * dvec3(1, 0, 0)},
      1, 1e-12);
}

TEST(FreeEnds, OfGodrons) {
  Random random(3);
  for (int k = 0; k < 12; ++k) {
    const double b = uniform(random, 0.5, 2);
    const double c = uniform(random, 0.5, 2);
    const double a = b * b / (4 * c) * uniform(random, 1.3, 4);
    const dmat3 turn = k == 0 ? dmat3(1.0) : random_rotation(random);
    const dvec3 shift = k == 0 ? dvec3(0.0) : random_point(random);
    const std::vector<double> whole = {-0.9, 1.1};
    const std::vector<double> split = {-0.9, 0, 1.1};
    const std::vector<double> beside = {-0.9, 1e-4, 1.1};
    for (const auto& xs : {whole, split, beside}) {
      for (const auto& ys : {whole, split, beside}) {
        SCOPED_TRACE(std::to_string(k) + " " + std::to_string(xs[1]) + " " + std::to_string(ys[1]));
        expect_godron(godron(a, b, c, xs, ys), turn, shift);
      }
    }
  }
}

/// The cusp is there, under the plane that touches the surface on both sides of it.
TEST(FreeEnds, OfUnexposedGodrons) {
  Setting own(of_patch(godron_patch(0.2, 1, 1, {-0.9, 1.1}, {-0.9, 1.1})));
  const std::optional<FreeEnd> end =
      sought(own, FreeEnd::Kind::face, SourceKind::face, dvec3(0.0), dvec3(0, 0, 1));
  ASSERT_TRUE(end.has_value());
  EXPECT_LT(glm::length(own.point(*end)), 1e-12);
  EXPECT_FALSE(own.supports(*end));
  for (const Ruling& ruling : free_ends_of(*boundary_of(own.scene).boundary)) {
    EXPECT_GT(glm::length(own.scene.frame().to_model(ruling.point[0])), 0.1);
  }
}

TEST(FreeEnds, TwoOnADentedEllipsoid) {
  for (const Shape& shape :
       {dented_ellipsoid(), mapped(dented_ellipsoid(), skew_rotation(), dvec3(1, 2, 3))}) {
    Setting own(shape);
    const std::vector<Ruling> ends = free_ends_of(*boundary_of(own.scene).boundary);
    EXPECT_EQ(ends.size(), 2U);
    for (const Ruling& end : ends) {
      EXPECT_TRUE(ends_in_free_end(own.geometry, end));
      EXPECT_EQ(sought_beside(own.geometry, end)->kind, FreeEnd::Kind::face);
    }
  }
}

/// Neither curves end free nor is a cusp found anywhere, be it on a circle of flat points.
TEST(FreeEnds, NoneOnRoundOrPlanarThings) {
  for (const Shape& shape :
       {sphere(), torus(2, 1), ellipsoid(1, 2, 3), oloid(), solid_cylinder(1, 2),
        filleted_box(1, 2, 3, 0.2), spherical_cap(0.5), dented()}) {
    for (const Shape& placed : {shape, mapped(shape, skew_rotation())}) {
      SCOPED_TRACE(std::to_string(shape.surfaces.size()) + " surfaces");
      Setting own(placed);
      EXPECT_TRUE(free_ends_of(*boundary_of(own.scene).boundary).empty());
      for (const Contact& c : places(own, SourceKind::face, 8)) {
        const dvec3 n = unit_normal(own.geometry, c);
        for (const double sign : {1.0, -1.0}) {
          const auto end = polished(own.geometry, {sign * n, c, FreeEnd::Kind::face, dvec3(0.0)});
          EXPECT_FALSE(end && own.supports(*end));
        }
      }
    }
  }
}

/// z = -(x^3 + b x^2 y + y^2) over x >= 0: the parabolic curve meets the border in the origin,
/// where the cubic along x falls.
TEST(FreeEnds, OnTheBorderOfAFace) {
  Random random(4);
  for (int k = 0; k < 8; ++k) {
    const double b = uniform(random, 0.5, 1.5);
    BezierPatch patch{3, 2, {}};
    const std::vector<double> x1 = bernstein({0, 1}, 3, 0, 1);
    const std::vector<double> x2 = bernstein({0, 0, 1}, 3, 0, 1);
    const std::vector<double> x3 = bernstein({0, 0, 0, 1}, 3, 0, 1);
    const std::vector<double> y1 = bernstein({0, 1}, 2, -0.6, 0.7);
    const std::vector<double> y2 = bernstein({0, 0, 1}, 2, -0.6, 0.7);
    for (std::size_t i = 0; i <= 3; ++i) {
      for (std::size_t j = 0; j <= 2; ++j) {
        patch.points.push_back(homogeneous({x1[i], y1[j], -(x3[i] + b * x2[i] * y1[j] + y2[j])}));
      }
    }
    const dmat3 turn = random_rotation(random);
    const double scale = log_uniform(random, 1e-4, 1e4);
    Setting own(mapped(of_patch(patch), scale * turn));
    expect_found(own,
                 {FreeEnd::Kind::border, SourceKind::edge, dvec3(0.0), turn * dvec3(0, 0, 1),
                  turn * dvec3(1, 0, 0)},
                 scale, 1e-12);
  }
}

/// z = -(x^3 + b x y^2 + y^2) over x >= 0 is level across the border, along which the curvature is
/// -4 b^2 y^2: the parabolic curve touches it in the origin. Small in a large scene, where rounding
/// leaves nothing of that about a double root.
BezierPatch touching_patch(double b) {
  BezierPatch patch{2, 3, {}};
  const std::vector<double> x1 = bernstein({0, 1}, 3, 0, 1);
  const std::vector<double> x3 = bernstein({0, 0, 0, 1}, 3, 0, 1);
  const std::vector<double> y1 = bernstein({0, 1}, 2, -0.6, 0.7);
  const std::vector<double> y2 = bernstein({0, 0, 1}, 2, -0.6, 0.7);
  for (std::size_t j = 0; j <= 2; ++j) {
    for (std::size_t i = 0; i <= 3; ++i) {
      patch.points.push_back(homogeneous({x1[i], y1[j], -(x3[i] + b * x1[i] * y2[j] + y2[j])}));
    }
  }
  return patch;
}

void expect_touching_end(const BezierPatch& patch, Random& random, double slack) {
  const double large = log_uniform(random, 1, 1e3);
  Shape shape = of_patch(patch);
  for (const dvec3& corner : {dvec3(1, 1, -2), dvec3(-1, 1, -2), dvec3(0, -1, -3)}) {
    shape.points.push_back(large * corner);
  }
  const dmat3 turn = random_rotation(random);
  const double scale = log_uniform(random, 1e-4, 1e4);
  Setting own(mapped(shape, scale * turn));
  expect_found(own,
               {FreeEnd::Kind::border, SourceKind::edge, dvec3(0.0), turn * dvec3(0, 0, 1),
                turn * dvec3(1, 0, 0)},
               scale, slack * large);
}

TEST(FreeEnds, WhereAParabolicCurveTouchesABorder) {
  Random random(5);
  for (int k = 0; k < 8; ++k) {
    expect_touching_end(touching_patch(uniform(random, 0.5, 1.5)), random, 1e-12);
  }
}

/// The patch is level across the border in directions that are not those of a parameter.
TEST(FreeEnds, WhereAParabolicCurveTouchesTheBorderOfATaperedPatch) {
  Random random(6);
  for (int k = 0; k < 8; ++k) {
    const BezierPatch patch = touching_patch(uniform(random, 0.5, 1.5));
    expect_touching_end(tapered(patch, 1, uniform(random, 0.3, 0.9)), random, 1e-11);
  }
}

/// The twisted cubic lies on one side of its osculating plane at either end.
TEST(FreeEnds, AtTheEndsOfATwistedCubic) {
  Setting own({{}, {twisted_cubic()}, {}});
  expect_found(
      own, {FreeEnd::Kind::end, SourceKind::vertex, dvec3(0.0), dvec3(0, 0, -1), dvec3(1, 0, 0)}, 1,
      1e-13);
  expect_found(own,
               {FreeEnd::Kind::end, SourceKind::vertex, dvec3(1.0), glm::normalize(dvec3(3, -3, 1)),
                -glm::normalize(dvec3(1, 2, 3))},
               1, 1e-13);
}

/// z = -(u^2 + 2 b u v + v^2) over the unit square bends as a saddle in its corner, over which the
/// two borders compete where b > 1. Where b < 1 the face comes between them.
TEST(FreeEnds, AtTheCornerOfASaddle) {
  for (const double b : {0.7, 1.3, 2.0}) {
    BezierPatch patch{2, 2, {}};
    for (int i = 0; i <= 2; ++i) {
      for (int j = 0; j <= 2; ++j) {
        const double z = -((i == 2) + 2 * b * (0.5 * i) * (0.5 * j) + (j == 2));
        patch.points.push_back(homogeneous({0.5 * i, 0.5 * j, z}));
      }
    }
    const dmat3 turn = skew_rotation();
    const dvec3 shift(1, 2, 3);
    Setting own(mapped(of_patch(patch), turn, shift));
    for (const double at : {0.0, 1.0}) {
      const double slope = (2 + 2 * b) * at;
      const dvec3 x = shift + turn * dvec3(at, at, -(2 + 2 * b) * at);
      const dvec3 n = turn * glm::normalize(dvec3(slope, slope, 1));
      const dvec3 diagonal = turn * glm::normalize(dvec3(1, -1, 0));
      if (b > 1) {
        expect_found(own, {FreeEnd::Kind::corner, SourceKind::vertex, x, n, diagonal}, 1, 1e-13);
      } else {
        EXPECT_FALSE(sought(own, FreeEnd::Kind::corner, SourceKind::vertex, x, n));
      }
    }
  }
}

TEST(FreeEnds, PolishLeadsNowhereWhereThereIsNone) {
  Setting own(ellipsoid(1, 2, 3));
  const Support top = own.query(glm::normalize(dvec3(1, 2, 3)));
  const FreeEnd near{glm::normalize(dvec3(1, 2, 3)), top.contact, FreeEnd::Kind::face, dvec3(0.0)};
  EXPECT_FALSE(polished(own.geometry, near).has_value());
}

/// Where an arc of the exact boundary ends free, and where the rulings before lead by themselves.
struct ArcEnd {
  Ruling ruling;
  /// Point and n as cubics in the distance of the two contacts; only of ends with enough rulings.
  dvec3 x = dvec3(0.0), n = dvec3(0.0);
  /// By how much the parabola through the first three misses that: it tells how far to trust it.
  double doubt = std::numeric_limits<double>::infinity();
};

/// What has these values at these places, at zero.
dvec3 extrapolated(std::span<const double> places, std::span<const dvec3> values) {
  dvec3 result(0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (j != i) weight *= places[j] / (places[j] - places[i]);
    }
    result += weight * values[i];
  }
  return result;
}

ArcEnd arc_end(std::vector<Ruling> rulings, bool last) {
  if (last) std::reverse(rulings.begin(), rulings.end());
  ArcEnd end;
  end.ruling = rulings.front();
  if (rulings.size() < 5) return end;
  std::array<double, 4> apart;
  std::array<dvec3, 4> x, n;
  for (std::size_t i = 0; i < 4; ++i) {
    const Ruling& ruling = rulings[i + 1];
    apart[i] = glm::distance(ruling.point[0], ruling.point[1]);
    x[i] = 0.5 * (ruling.point[0] + ruling.point[1]);
    n[i] = ruling.n;
  }
  end.x = extrapolated(apart, x);
  end.n = extrapolated(apart, n);
  const auto first = [](const auto& values) { return std::span(values).first(3); };
  end.doubt = std::max(glm::distance(end.x, extrapolated(first(apart), first(x))),
                       glm::distance(end.n, extrapolated(first(apart), first(n))));
  return end;
}

std::vector<ArcEnd> arc_ends(const HullBoundary& boundary) {
  std::vector<ArcEnd> result;
  for (const SeparatingArc& arc : boundary.arcs) {
    if (arc.closed) continue;
    if (arc.facet[0] < 0) result.push_back(arc_end(arc.pieces.front().rulings, false));
    if (arc.facet[1] < 0) result.push_back(arc_end(arc.pieces.back().rulings, true));
  }
  return result;
}

/// Arcs end in free ends, into which the rulings before lead.
void expect_arcs_end_free(const Shape& shape) {
  constexpr double rulings_error = 1e-6;  // next to an end contacts are known less well
  Setting own(shape);
  for (const ArcEnd& end : arc_ends(*boundary_of(own.scene).boundary)) {
    EXPECT_TRUE(ends_in_free_end(own.geometry, end.ruling));
    EXPECT_LT(
        std::max(glm::distance(end.x, end.ruling.point[0]), glm::distance(end.n, end.ruling.n)),
        4 * end.doubt + rulings_error);
  }
}

TEST(FreeEnds, MoveWithTheInstance) {
  Setting at_rest(blob(2));
  Model model = make_model(blob(2));
  const RigidMotion pose{skew_rotation(), dvec3(3, -2, 1)};
  model.clear_instances();
  model.add_instance(0, pose);
  Setting moved(std::move(model));
  const std::vector<Ruling> before = free_ends_of(*boundary_of(at_rest.scene).boundary);
  const std::vector<Ruling> after = free_ends_of(*boundary_of(moved.scene).boundary);
  ASSERT_FALSE(before.empty());
  ASSERT_EQ(before.size(), after.size());
  for (const Ruling& end : before) {
    double nearest = 1;
    for (const Ruling& other : after) {
      const dvec3 x = at_rest.scene.frame().to_model(end.point[0]);
      const double by_point = glm::distance(pose(x), moved.scene.frame().to_model(other.point[0]));
      const double by_n = glm::distance(pose.rotation * end.n, other.n);
      nearest = std::min(nearest, std::max(by_point, by_n));
    }
    EXPECT_LT(nearest, 1e-12);
  }
}

class Blobs : public testing::TestWithParam<unsigned> {};

TEST_P(Blobs, EndTheirArcs) { expect_arcs_end_free(blob(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Seeds, Blobs, testing::Range(1U, 22U));

TEST(FreeEnds, EndTheArcsOfRandomCurves) {
  Random random(5);
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(k);
    const int degree = pick(random, 3, 7);
    expect_arcs_end_free(as_shape(random_curve(random, degree, 1)));
  }
}

TEST(FreeEnds, EndTheArcsOfRandomPatches) {
  Random random(6);
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(k);
    expect_arcs_end_free(of_patch(random_patch(random, {3, 4}, 2)));
  }
}

}  // namespace
}  // namespace taut
