// Developable patches whose rulings are no parameter lines: found, followed, and labelled on hulls.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "exact_checks.h"
#include "models.h"
#include "sound_hull.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/surface/flatness.h"
#include "taut/surface/rulings.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// A polynomial of degrees p and q by its Bernstein coefficients.
template <class T>
struct Net {
  int p = 0, q = 0;
  std::vector<T> c;

  T& at(int i, int j) { return c[to_size(i * (q + 1) + j)]; }
  const T& at(int i, int j) const { return c[to_size(i * (q + 1) + j)]; }
};

template <class T>
Net<T> product(const Net<double>& a, const Net<T>& b) {
  Net<T> r{a.p + b.p, a.q + b.q, std::vector<T>(to_size((a.p + b.p + 1) * (a.q + b.q + 1)))};
  for (int i = 0; i <= a.p; ++i) {
    for (int j = 0; j <= a.q; ++j) {
      for (int k = 0; k <= b.p; ++k) {
        for (int l = 0; l <= b.q; ++l) {
          const double share = binomial(a.p, i) * binomial(b.p, k) / binomial(r.p, i + k) *
                               binomial(a.q, j) * binomial(b.q, l) / binomial(r.q, j + l);
          r.at(i + k, j + l) += share * a.at(i, j) * b.at(k, l);
        }
      }
    }
  }
  return r;
}

/// One of the new parameters.
using Map = std::function<double(double, double)>;

/// The coefficients of a function that is quadratic in both.
Net<double> quadratic(const Map& f) {
  Net<double> net{2, 2, std::vector<double>(9)};
  for (int i = 0; i <= 2; ++i) {
    for (int j = 0; j <= 2; ++j) net.at(i, j) = f(0.5 * i, 0.5 * j);
  }
  for (int i = 0; i <= 2; ++i)
    net.at(i, 1) = 2 * net.at(i, 1) - 0.5 * (net.at(i, 0) + net.at(i, 2));
  for (int j = 0; j <= 2; ++j)
    net.at(1, j) = 2 * net.at(1, j) - 0.5 * (net.at(0, j) + net.at(2, j));
  return net;
}

/// S(f(u, v), g(u, v)), by de Casteljau's algorithm on polynomials; f and g are quadratic in both.
BezierPatch reparametrised(const BezierPatch& patch, const Map& f, const Map& g) {
  const auto casteljau = [](std::vector<Net<dvec4>> c, const Net<double>& t) {
    Net<double> rest = t;
    for (double& x : rest.c) x = 1 - x;
    for (std::size_t count = c.size() - 1; count > 0; --count) {
      for (std::size_t i = 0; i < count; ++i) {
        Net<dvec4> sum = product(rest, c[i]);
        const Net<dvec4> more = product(t, c[i + 1]);
        for (std::size_t k = 0; k < sum.c.size(); ++k) sum.c[k] += more.c[k];
        c[i] = std::move(sum);
      }
    }
    return c.front();
  };
  std::vector<Net<dvec4>> rows;
  for (int i = 0; i <= patch.degree_u; ++i) {
    std::vector<Net<dvec4>> row;
    for (int j = 0; j <= patch.degree_v; ++j) row.push_back({0, 0, {patch.at(i, j)}});
    rows.push_back(casteljau(std::move(row), quadratic(g)));
  }
  const Net<dvec4> net = casteljau(std::move(rows), quadratic(f));
  return {net.p, net.q, net.c};
}

double same_u(double u, double /*v*/) { return u; }
double same_v(double /*u*/, double v) { return v; }
/// These leave the square's sides as they are.
double bulged_u(double u, double v) { return u + 0.8 * u * (1 - u) * v * (1 - v); }
double bulged_v(double u, double v) { return v - 0.6 * u * (1 - u) * v * (1 - v); }
/// And these are affine.
double skew_u(double u, double v) { return 0.3 + 0.5 * u + 0.2 * v; }
double skew_v(double u, double v) { return 0.5 - 0.5 * u + 0.5 * v; }

/// Every patch of the first surfaces a surface of its own.
Shape reparametrised(const Shape& shape, const Map& f, const Map& g, std::size_t count = 1) {
  Shape result = shape;
  result.surfaces.clear();
  for (std::size_t k = 0; k < shape.surfaces.size(); ++k) {
    if (k >= count) {
      result.surfaces.push_back(shape.surfaces[k]);
      continue;
    }
    for (const PatchPiece& piece : decompose(shape.surfaces[k])) {
      result.surfaces.push_back(as_nurbs(reparametrised(piece.bezier, f, g)));
    }
  }
  return result;
}

/// The patch as a B-spline surface with these inner knots, so that it has many patches.
NurbsSurface refined(const BezierPatch& b, const std::vector<double>& knots) {
  const auto all = [&](int degree) {
    std::vector<double> result(to_size(degree) + 1, 0.0);
    result.insert(result.end(), knots.begin(), knots.end());
    result.insert(result.end(), to_size(degree) + 1, 1.0);
    return result;
  };
  NurbsSurface s{b.degree_u, b.degree_v, all(b.degree_u), all(b.degree_v), {}};
  const auto blossom = [](std::vector<dvec4> c, const double* t) {
    for (std::size_t count = c.size() - 1; count > 0; --count, ++t) {
      for (std::size_t i = 0; i < count; ++i) c[i] = (1 - *t) * c[i] + *t * c[i + 1];
    }
    return c.front();
  };
  const auto inner = static_cast<int>(knots.size());
  for (int i = 0; i <= b.degree_u + inner; ++i) {
    for (int j = 0; j <= b.degree_v + inner; ++j) {
      std::vector<dvec4> row;
      for (int k = 0; k <= b.degree_u; ++k) {
        std::vector<dvec4> column;
        for (int l = 0; l <= b.degree_v; ++l) column.push_back(b.at(k, l));
        row.push_back(blossom(std::move(column), &s.knots_v[to_size(j) + 1]));
      }
      s.points.push_back(blossom(std::move(row), &s.knots_u[to_size(i) + 1]));
    }
  }
  return s;
}

BezierPatch quarter_of(const Shape& shape) { return decompose(shape.surfaces[0])[0].bezier; }

/// c(u) + (0.3 + 0.7 v) c'(u) for c = (t, t^2, t^3).
BezierPatch tangent_developable() {
  const std::vector<dvec4> c = twisted_cubic().points;
  BezierPatch patch{3, 1, {}};
  for (std::size_t i = 0; i <= 3; ++i) {
    // Of c', with its degree raised.
    const auto k = double(i);
    const dvec4 before = i > 0 ? c[i] - c[i - 1] : dvec4(0.0);
    const dvec4 behind = i < 3 ? c[i + 1] - c[i] : dvec4(0.0);
    const dvec4 d = k * before + (3 - k) * behind;
    for (const double t : {0.3, 1.0}) patch.points.push_back(c[i] + t * d);
  }
  return patch;
}

/// z = 1 - x^2 over [-1, 1] x [0, 2].
BezierPatch parabolic_cylinder() {
  BezierPatch patch{2, 1, {}};
  for (const dvec3& p : {dvec3(-1, 0, 0), dvec3(0, 0, 2), dvec3(1, 0, 0)}) {
    for (const double y : {0.0, 2.0}) patch.points.push_back(homogeneous(p + dvec3(0, y, 0)));
  }
  return patch;
}

/// z = 1 - x^2 and z = y^2 - 1 over the disc of radius sqrt(2), where they meet: one biquadratic
/// square of four arcs, turned by the angle with this tangent of its half.
Shape lens(double half_tangent) {
  const double h = std::sqrt(0.5);
  const double s = 2 * half_tangent / (1 + half_tangent * half_tangent);
  const double c = (1 - half_tangent * half_tangent) / (1 + half_tangent * half_tangent);
  Net<double> x{2, 2, {}};
  Net<double> y{2, 2, {}};
  Net<double> w{2, 2, {}};
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 1; ++j) {
      const int off = std::abs(i) + std::abs(j);
      const double weight = off == 1 ? h : 1;
      // The tangents at the corners meet at twice as far from the centre as the corners' sides.
      const dvec2 p = off == 0 ? dvec2(0.11, -0.07) : (off == 1 ? 2.0 : 1.0) * dvec2(i, j);
      x.c.push_back(weight * (c * p.x - s * p.y));
      y.c.push_back(weight * (s * p.x + c * p.y));
      w.c.push_back(weight);
    }
  }
  const Net<double> ww = product(w, w);
  const Net<double> xx = product(x, x);
  const Net<double> yy = product(y, y);
  const Net<double> xw = product(x, w);
  const Net<double> yw = product(y, w);
  Shape shape;
  for (const bool upper : {true, false}) {
    BezierPatch patch{4, 4, {}};
    for (std::size_t k = 0; k < ww.c.size(); ++k) {
      const double z = upper ? ww.c[k] - xx.c[k] : yy.c[k] - ww.c[k];
      patch.points.emplace_back(xw.c[k], yw.c[k], z, ww.c[k]);
    }
    shape.surfaces.push_back(as_nurbs(patch));
  }
  return shape;
}

std::vector<std::pair<std::string, BezierPatch>> oblique_patches() {
  std::vector<std::pair<std::string, BezierPatch>> all;
  for (const auto& [name, patch] : {std::pair("cylinder", quarter_of(cylinder(1, 2))),
                                    std::pair("cone", quarter_of(cone(1, 2))),
                                    std::pair("frustum", quarter_of(frustum(1, 0.5, 2))),
                                    std::pair("parabolic cylinder", parabolic_cylinder()),
                                    std::pair("tangent developable", tangent_developable())}) {
    all.emplace_back(std::string("bulged ") + name, reparametrised(patch, bulged_u, bulged_v));
    all.emplace_back(std::string("skew ") + name, reparametrised(patch, skew_u, skew_v));
  }
  for (const NurbsSurface& s : lens(0.2).surfaces) {
    all.emplace_back("lens", decompose(s).front().bezier);
  }
  return all;
}

BezierPatch moved(BezierPatch patch, const dmat3& turn, const dvec3& shift) {
  for (dvec4& p : patch.points) p = {turn * dvec3(p) + p.w * shift, p.w};
  return patch;
}

TEST(DevelopableFaces, AreFoundInAnyPlace) {
  for (const auto& [name, patch] : oblique_patches()) {
    SCOPED_TRACE(name);
    for (const dvec3& shift : {dvec3(0.0), dvec3(100, -200, 30)}) {
      EXPECT_TRUE(is_developable(moved(patch, dmat3(1.0), shift)));
      EXPECT_TRUE(is_developable(moved(patch, skew_rotation(), shift)));
    }
    EXPECT_FALSE(is_ruled(patch, Direction::u));
    EXPECT_FALSE(is_ruled(patch, Direction::v));
  }
}

TEST(DevelopableFaces, OthersAreNone) {
  EXPECT_FALSE(is_developable(quarter_of(sphere())));
  EXPECT_FALSE(is_developable(quarter_of(torus(2, 0.5))));
  EXPECT_FALSE(is_developable(quarter_of(saddle())));
  EXPECT_FALSE(is_developable(quarter_of(paraboloid())));
  // However small.
  EXPECT_FALSE(is_developable(moved(quarter_of(sphere()), dmat3(1e-150), dvec3(0.0))));
  EXPECT_FALSE(is_developable(moved(quarter_of(sphere()), dmat3(1e150), dvec3(0.0))));
  // A bulge across the rulings that is small, but no rounding.
  BezierPatch bent = reparametrised(parabolic_cylinder(), bulged_u, bulged_v);
  bent.at(2, 1).z += 1e-9;
  EXPECT_FALSE(is_developable(bent));
  // Folded along a line inside.
  const Map there_and_back = [](double u, double v) { return 0.1 + 2.8 * u * (1 - u) + 0.1 * v; };
  EXPECT_FALSE(is_developable(reparametrised(parabolic_cylinder(), there_and_back, same_v)));
}

/// Segments run through their points, from border to border, within the surface: of one normal.
TEST(DevelopableFaces, RulingsRunFromBorderToBorder) {
  for (const auto& [name, patch] : oblique_patches()) {
    SCOPED_TRACE(name);
    Random random(5);
    for (int k = 0; k < 100; ++k) {
      const dvec2 uv{uniform(random, 0.02, 0.98), uniform(random, 0.02, 0.98)};
      const auto ends = ruling_ends(patch, uv);
      ASSERT_TRUE(ends);
      const dvec3 x = point(patch, uv.x, uv.y);
      const dvec3 n = unit_normal(patch, uv.x, uv.y);
      const dvec3 a = point(patch, (*ends)[0].x, (*ends)[0].y);
      const dvec3 b = point(patch, (*ends)[1].x, (*ends)[1].y);
      EXPECT_LT(glm::length(glm::cross(x - a, unit(b - a))), 1e-11);
      EXPECT_GT(glm::dot(x - a, b - x), 0) << "between";
      for (const dvec2& end : *ends) {
        EXPECT_TRUE(end.x == 0 || end.x == 1 || end.y == 0 || end.y == 1);
        const PatchJet1 j = jet1(patch, end.x, end.y);
        const dvec3 normal = glm::cross(j.Su, j.Sv);
        // A tip has none.
        if (glm::length(normal) < 1e-6) continue;
        EXPECT_LT(glm::length(glm::cross(unit(normal), n)), 1e-9);
      }
    }
  }
}

/// Ends at the border from which a ruling leaves, and one that lies on the border.
TEST(DevelopableFaces, RulingsBeginOnBorders) {
  const BezierPatch patch = reparametrised(quarter_of(cylinder(1, 2)), bulged_u, bulged_v);
  for (const double u : {0.0, 0.3, 1.0}) {
    const auto ends = ruling_ends(patch, {u, 0});
    ASSERT_TRUE(ends);
    const dvec3 a = point(patch, (*ends)[0].x, (*ends)[0].y);
    const dvec3 b = point(patch, (*ends)[1].x, (*ends)[1].y);
    EXPECT_NEAR(glm::distance(a, b), 2, 1e-12);
  }
}

struct SolidCase {
  std::string name;
  Shape ruled;
  Shape oblique;
  double volume;
  double area;
};

/// Cut into two along a curve between opposite sides of every patch, along v or across.
Shape cut(const Shape& shape, bool along) {
  const auto edge = [](double t) { return 0.3 + 0.4 * t; };
  const Map below = [&](double u, double v) { return along ? u * edge(v) : v * edge(u); };
  const Map above = [&](double u, double v) {
    return along ? edge(v) + u * (1 - edge(v)) : edge(u) + v * (1 - edge(u));
  };
  Shape rest = shape;
  rest.surfaces.erase(rest.surfaces.begin());
  const Shape face = {{shape.surfaces[0]}, {}, {}};
  return along ? reparametrised(face, below, same_v) + reparametrised(face, above, same_v) + rest
               : reparametrised(face, same_u, below) + reparametrised(face, same_u, above) + rest;
}

std::vector<SolidCase> solid_cases() {
  std::vector<SolidCase> all;
  const auto add = [&](const std::string& name, const Shape& shape, double volume, double area) {
    const Shape ruled = reparametrised(shape, same_u, same_v);
    all.push_back(
        {name + ", bulged", ruled, reparametrised(shape, bulged_u, bulged_v), volume, area});
    all.push_back({name + ", cut along u", ruled, cut(shape, false), volume, area});
    // Those whose border curves change stand alone.
    if (shape.surfaces.size() > 1) return;
    Shape splines;
    for (const PatchPiece& piece : decompose(shape.surfaces[0])) {
      splines.surfaces.push_back(refined(reparametrised(piece.bezier, bulged_u, bulged_v), {0.4}));
    }
    all.push_back({name + ", refined", ruled, splines, volume, area});
    all.push_back({name + ", cut along v", ruled, cut(shape, true), volume, area});
  };
  add("solid cylinder", solid_cylinder(1, 2), 2 * pi, 6 * pi);
  add("solid cone", solid_cone(1, 2), 2 * pi / 3, pi * (1 + std::sqrt(5.0)));
  // Its hull is the solid's.
  add("frustum", frustum(1, 0.5, 2), pi * 7 / 6, pi * (1.25 + 1.5 * std::sqrt(4.25)));
  return all;
}

void expect_as_ruled(const SolidCase& each) {
  for (const bool turned : {false, true}) {
    SCOPED_TRACE(each.name + (turned ? ", turned" : ""));
    const dmat3 turn = turned ? skew_rotation() : dmat3(1.0);
    const Scene scene = make_scene(mapped(each.oblique, turn));
    const Hull hull = boundary_of(scene);
    expect_complete(*hull.boundary);
    const Hull ruled = boundary_of(make_scene(mapped(each.ruled, turn)));
    EXPECT_EQ(face_counts(*hull.boundary), face_counts(*ruled.boundary));
    const BoundaryMeasures measures = measures_of(scene, hull);
    EXPECT_NEAR(measures.volume, each.volume, 1e-9 * each.volume);
    EXPECT_NEAR(measures.area, each.area, 1e-9 * each.area);
  }
}

TEST(DevelopableFaces, OfSolidsAreThoseOfTheirRuledOnes) {
  for (const SolidCase& each : solid_cases()) expect_as_ruled(each);
}

TEST(DevelopableFaces, OfALens) {
  for (const double half_tangent : {0.0, 0.15}) {
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      const Scene scene = make_scene(mapped(lens(half_tangent), turn));
      const Hull hull = boundary_of(scene);
      expect_complete(*hull.boundary);
      EXPECT_EQ(face_counts(*hull.boundary), (FaceCounts{0, 2, 0}));
      EXPECT_NEAR(measures_of(scene, hull).volume, 2 * std::numbers::pi, 1e-9);
      std::vector<int> sources;
      for (const HullFace& face : hull.boundary->faces) sources.push_back(face.source);
      std::sort(sources.begin(), sources.end());
      EXPECT_EQ(sources, (std::vector<int>{0, 1}));
    }
  }
}

/// Single faces, of one patch and of many: one scroll lies on them.
TEST(DevelopableFaces, LabelTheirScrolls) {
  for (const auto& [name, patch] : oblique_patches()) {
    // On the hulls of these no whole scroll is on the face.
    if (name == "skew tangent developable" || name == "skew cone") continue;
    for (const bool many : {false, true}) {
      SCOPED_TRACE(name + (many ? ", refined" : ""));
      const NurbsSurface surface = many ? refined(patch, {0.25, 0.5}) : as_nurbs(patch);
      const Hull hull = boundary_of(make_scene({{surface}, {}, {}}));
      expect_complete(*hull.boundary);
      const auto labelled = std::count_if(hull.boundary->faces.begin(), hull.boundary->faces.end(),
                                          [](const HullFace& f) { return f.source == 0; });
      EXPECT_EQ(labelled, 1);
      EXPECT_EQ(hull.boundary->count(FaceKind::patch), 0);
    }
  }
}

TEST(DevelopableFaces, AreVerified) {
  const Sound sound = sound_hull(lens(0.15));
  EXPECT_EQ(failed(verified(sound.hull, sound.scene)), std::set<std::string>{});
  HullDocument untold = sound.hull;
  untold.faces[0].source = -1;
  EXPECT_TRUE(failed(verified(untold, sound.scene)).contains("labels"));
  HullDocument exchanged = sound.hull;
  std::swap(exchanged.faces[0].source, exchanged.faces[1].source);
  EXPECT_TRUE(failed(verified(exchanged, sound.scene)).contains("labels"));
}

/// A face that a scroll goes on from, into another, is not its source.
TEST(DevelopableFaces, ThatEndWithinAScrollDoNotLabelIt) {
  const Shape quarter = {{as_nurbs(quarter_of(cylinder(1, 2)))}, {}, {}};
  const Shape apart = cylinder(1, 1) + shifted(cylinder(1, 1), {0, 0, 2});
  for (const Shape& shape : {cut(quarter, false), cut(quarter, true), apart}) {
    const Sound sound = sound_hull(shape);
    EXPECT_EQ(failed(verified(sound.hull, sound.scene)), std::set<std::string>{})
        << text_of(verified(sound.hull, sound.scene));
    for (const HullDocument::Face& face : sound.hull.faces) EXPECT_EQ(face.source, -1);
  }
}

}  // namespace
}  // namespace taut
