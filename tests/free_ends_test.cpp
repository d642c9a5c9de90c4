#include "taut/hull/free_ends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "models.h"
#include "taut/hull/facet_contacts.h"
#include "taut/hull/precise_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// A scene with all that a search for free ends takes.
struct Setting {
  explicit Setting(const Shape& shape)
      : scene(make_scene(shape)),
        geometry(scene),
        query(scene),
        map(scene, {.threads = 1, .progress = {}}) {
    culling = cull(scene, map, {.levels = 3, .threads = 1, .progress = {}});
  }
  std::vector<FreeEnd> ends() { return free_ends(geometry, query, culling.cells); }
  dvec3 point(const FreeEnd& end) const {
    return scene.frame().to_model(geometry.point(end.contact));
  }

  Scene scene;
  ContactGeometry geometry;
  SupportQuery query;
  GaussMap map;
  Culling culling;
};

int count(const std::vector<FreeEnd>& ends, FreeEnd::Kind kind) {
  return int(std::count_if(ends.begin(), ends.end(),
                           [&](const FreeEnd& end) { return end.kind == kind; }));
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
  for (std::size_t k = 0; k <= 6; ++k)
    curve.points.emplace_back(sign * bx[k], by[k], sign * bz[k], bw[k]);
  return curve;
}

void expect_wave_ends(const Shape& wave, const std::string& name) {
  SCOPED_TRACE(name);
  Setting own(wave);
  const std::vector<FreeEnd> ends = own.ends();
  ASSERT_EQ(ends.size(), 2U);
  for (const FreeEnd& end : ends) {
    EXPECT_EQ(end.kind, FreeEnd::Kind::edge);
    const dvec3 x = own.point(end);
    // At (1, 0, 1) the tangent is (0, 2, 0) and the second derivative (-1, 0, -9).
    const dvec3 n = (x.x < 0 ? -1.0 : 1.0) * dvec3(9, 0, -1) / std::sqrt(82.0);
    EXPECT_LT(glm::distance(x, (x.x < 0 ? -1.0 : 1.0) * dvec3(1, 0, 1)), 1e-12);
    EXPECT_LT(glm::distance(end.n, n), 1e-12);
    EXPECT_NEAR(std::abs(end.along.y), 1, 1e-12);
  }
}

TEST(FreeEnds, OfATwistedCurve) {
  // The ends inside of pieces, and where pieces join.
  expect_wave_ends({{}, {half_wave(-1, 1, 1), half_wave(-1, 1, -1)}, {}}, "two pieces");
  Shape four;
  for (const double sign : {1.0, -1.0}) {
    four.curves.push_back(half_wave(-1, 0, sign));
    four.curves.push_back(half_wave(0, 1, sign));
  }
  expect_wave_ends(four, "four pieces");
  Shape uneven;
  for (const double sign : {1.0, -1.0}) {
    uneven.curves.push_back(half_wave(-1, 0.003, sign));
    uneven.curves.push_back(half_wave(0.003, 1, sign));
  }
  expect_wave_ends(uneven, "uneven pieces");
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
  const std::vector<FreeEnd> ends = own.ends();
  ASSERT_EQ(count(ends, FreeEnd::Kind::face), 1);
  const auto end = std::find_if(ends.begin(), ends.end(),
                                [](const FreeEnd& e) { return e.kind == FreeEnd::Kind::face; });
  EXPECT_LT(glm::distance(own.point(*end), shift), 1e-12);
  EXPECT_LT(glm::distance(end->n, turn * dvec3(0, 0, 1)), 1e-12);
  EXPECT_NEAR(std::abs(glm::dot(end->along, turn * dvec3(1, 0, 0))), 1, 1e-12);

  // From nearby it is found again.
  FreeEnd near = *end;
  for (double* t : {&near.contact.u, &near.contact.v}) *t += *t < 0.5 ? 1e-3 : -1e-3;
  const std::optional<FreeEnd> found = polished(own.geometry, near);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT(glm::distance(own.point(*found), shift), 1e-12);
  EXPECT_LT(glm::distance(found->n, end->n), 1e-12);
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

TEST(FreeEnds, NoneOnUnexposedGodrons) {
  Setting own(of_patch(godron_patch(0.2, 1, 1, {-0.9, 1.1}, {-0.9, 1.1})));
  EXPECT_EQ(count(own.ends(), FreeEnd::Kind::face), 0);
}

TEST(FreeEnds, TwoOnADentedEllipsoid) {
  for (const Shape& shape :
       {dented_ellipsoid(), mapped(dented_ellipsoid(), skew_rotation(), dvec3(1, 2, 3))}) {
    Setting own(shape);
    const std::vector<FreeEnd> ends = own.ends();
    EXPECT_EQ(ends.size(), 2U);
    EXPECT_EQ(count(ends, FreeEnd::Kind::face), 2);
  }
}

TEST(FreeEnds, NoneOnRoundOrPlanarThings) {
  for (const Shape& shape :
       {sphere(), torus(2, 1), ellipsoid(1, 2, 3), oloid(), solid_cylinder(1, 2),
        filleted_box(1, 2, 3, 0.2), spherical_cap(0.5), dented()}) {
    for (const Shape& placed : {shape, mapped(shape, skew_rotation())}) {
      Setting own(placed);
      EXPECT_TRUE(own.ends().empty());
    }
  }
}

/// Those in which the exact boundary's arcs end.
std::vector<Ruling> ends_of_arcs(const HullBoundary& boundary) {
  std::vector<Ruling> result;
  for (const SeparatingArc& arc : boundary.arcs) {
    if (arc.closed) continue;
    if (arc.facet[0] < 0) result.push_back(arc.pieces.front().rulings.front());
    if (arc.facet[1] < 0) result.push_back(arc.pieces.back().rulings.back());
  }
  return result;
}

void expect_those_of_arcs(const Shape& shape) {
  Setting own(shape);
  HullStatistics statistics;
  HullOptions options;
  options.threads = 1;
  const HullBoundary boundary = exact_boundary(own.scene, own.map, options, statistics);
  const std::vector<FreeEnd> ends = own.ends();
  const std::vector<Ruling> traced = ends_of_arcs(boundary);
  EXPECT_EQ(ends.size(), traced.size());
  for (const Ruling& ruling : traced) {
    double nearest = 1;
    for (const FreeEnd& end : ends) {
      const double by_point = glm::distance(own.geometry.point(end.contact), ruling.point[0]);
      nearest = std::min(nearest, std::max(by_point, glm::distance(end.n, ruling.n)));
    }
    EXPECT_LT(nearest, 1e-5);
  }
}

class Blobs : public testing::TestWithParam<unsigned> {};

TEST_P(Blobs, EndTheirArcs) { expect_those_of_arcs(blob(GetParam())); }

INSTANTIATE_TEST_SUITE_P(Seeds, Blobs, testing::Range(1U, 22U));

}  // namespace
}  // namespace taut
