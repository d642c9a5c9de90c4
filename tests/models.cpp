#include "models.h"

#include <cmath>
#include <numbers>

#include "taut/core/tolerances.h"
#include "taut/io/read_model.h"

namespace taut_test {
namespace {

constexpr double half_sqrt = std::numbers::sqrt2 / 2;

/// Knots of `arcs` quadratic pieces, joined at double knots.
std::vector<double> arc_knots(int arcs) {
  std::vector<double> knots(3, 0.0);
  for (int k = 1; k < arcs; ++k) knots.insert(knots.end(), 2, double(k));
  knots.insert(knots.end(), 3, double(arcs));
  return knots;
}

/// Consecutive quarters of a circle: the unit square's corners have weight sqrt(1/2).
NurbsCurve arcs(const dvec3& center, const std::vector<dvec3>& offsets) {
  NurbsCurve curve{2, arc_knots(int(offsets.size()) / 2), {}};
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    curve.points.push_back(taut::homogeneous(center + offsets[k], k % 2 == 0 ? 1 : half_sqrt));
  }
  return curve;
}

template <class Geometry>
void map(Geometry& geometry, const dmat3& matrix, const dvec3& translation) {
  for (dvec4& p : geometry.points) {
    p = taut::homogeneous(matrix * taut::euclidean(p) + translation, p.w);
  }
}

NurbsSurface bilinear(const dvec3& p00, const dvec3& p01, const dvec3& p10, const dvec3& p11) {
  return taut::as_nurbs(
      BezierPatch{1, 1, {dvec4(p00, 1.0), dvec4(p01, 1.0), dvec4(p10, 1.0), dvec4(p11, 1.0)}});
}

/// z(x, y) over [-1, 1]^2 with quadratic z given at the 3 x 3 Bezier points.
Shape height_field(const double (&z)[3][3]) {
  BezierPatch patch{2, 2, {}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) patch.points.emplace_back(i - 1.0, j - 1.0, z[i][j], 1.0);
  }
  return of_patch(patch);
}

}  // namespace

double uniform(Random& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

double log_uniform(Random& random, double lower, double upper) {
  return std::exp(uniform(random, std::log(lower), std::log(upper)));
}

int pick(Random& random, int lower, int upper) {
  return std::uniform_int_distribution<int>(lower, upper)(random);
}

dvec3 random_point(Random& random) {
  const double x = uniform(random, -1, 1);
  const double y = uniform(random, -1, 1);
  return {x, y, uniform(random, -1, 1)};
}

dvec3 random_direction(Random& random) {
  for (;;) {
    const dvec3 p = random_point(random);
    const double length = glm::length(p);
    if (length > 0.01 && length <= 1) return p / length;
  }
}

dmat3 random_rotation(Random& random) {
  const dvec3 a = random_direction(random);
  const dvec3 b = glm::normalize(glm::cross(a, random_direction(random)));
  return {a, b, glm::cross(a, b)};
}

dmat3 skew_rotation() {
  Random random(20);
  return random_rotation(random);
}

Shape operator+(Shape a, const Shape& b) {
  a.surfaces.insert(a.surfaces.end(), b.surfaces.begin(), b.surfaces.end());
  a.curves.insert(a.curves.end(), b.curves.begin(), b.curves.end());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  return a;
}

Shape mapped(Shape shape, const dmat3& matrix, const dvec3& translation) {
  for (NurbsSurface& surface : shape.surfaces) map(surface, matrix, translation);
  for (NurbsCurve& curve : shape.curves) map(curve, matrix, translation);
  for (dvec3& p : shape.points) p = matrix * p + translation;
  return shape;
}

Shape scaled(Shape shape, double factor) { return mapped(std::move(shape), dmat3(factor)); }

Shape shifted(Shape shape, const dvec3& translation) {
  return mapped(std::move(shape), dmat3(1.0), translation);
}

Model make_model(const Shape& shape) {
  taut::Part part;
  part.name = "test";
  for (const NurbsSurface& surface : shape.surfaces) part.add_surface(surface, "face");
  for (const NurbsCurve& curve : shape.curves) part.add_curve(curve, "edge");
  for (const dvec3& p : shape.points) part.add_point(p);
  Model model;
  model.add_part(std::move(part), taut::smooth_join_angle);
  return model;
}

taut::Scene make_scene(const Shape& shape, int threads) {
  return taut::Scene(make_model(shape), {.threads = threads, .progress = {}});
}

NurbsCurve circle(const dvec3& center, const dvec3& a, const dvec3& b) {
  return arcs(center, {a, a + b, b, b - a, -a, -a - b, -b, a - b, a});
}

NurbsCurve half_circle(const dvec3& center, const dvec3& a, const dvec3& b) {
  return arcs(center, {b, a + b, a, a - b, -b});
}

NurbsCurve segment(const dvec3& a, const dvec3& b) {
  return taut::as_nurbs(BezierCurve{{dvec4(a, 1.0), dvec4(b, 1.0)}});
}

NurbsCurve twisted_cubic() {
  return taut::as_nurbs(
      BezierCurve{{{0, 0, 0, 1}, {1.0 / 3, 0, 0, 1}, {2.0 / 3, 1.0 / 3, 0, 1}, {1, 1, 1, 1}}});
}

NurbsSurface revolved(const NurbsCurve& profile) {
  const NurbsCurve turn = circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0});
  NurbsSurface surface{turn.degree, profile.degree, turn.knots, profile.knots, {}};
  for (const dvec4& t : turn.points) {
    for (const dvec4& p : profile.points) {
      const dvec3 x = taut::euclidean(p);
      const dvec3 c = taut::euclidean(t);
      surface.points.push_back(taut::homogeneous({x.x * c.x, x.x * c.y, x.z}, p.w * t.w));
    }
  }
  return surface;
}

Shape of_patch(const BezierPatch& patch) { return {{taut::as_nurbs(patch)}, {}, {}}; }

Shape sphere(double radius) {
  return {{revolved(half_circle(dvec3(0.0), {radius, 0, 0}, {0, 0, radius}))}, {}, {}};
}

Shape ellipsoid(double a, double b, double c) {
  return mapped(sphere(), dmat3(a, 0, 0, 0, b, 0, 0, 0, c));
}

Shape torus(double R, double r) {
  return {{revolved(circle({R, 0, 0}, {r, 0, 0}, {0, 0, r}))}, {}, {}};
}

Shape cylinder(double r, double h) { return frustum(r, r, h); }
Shape cone(double r, double h) { return frustum(r, 0, h); }
Shape frustum(double R, double r, double h) {
  return {{revolved(segment({R, 0, 0}, {r, 0, h}))}, {}, {}};
}

Shape box(double a, double b, double c) {
  const auto p = [&](int i, int j, int k) { return dvec3(i * a, j * b, k * c); };
  Shape shape;
  for (int k = 0; k < 2; ++k) {
    shape.surfaces.push_back(bilinear(p(k, 0, 0), p(k, 1, 0), p(k, 0, 1), p(k, 1, 1)));
    shape.surfaces.push_back(bilinear(p(0, k, 0), p(1, k, 0), p(0, k, 1), p(1, k, 1)));
    shape.surfaces.push_back(bilinear(p(0, 0, k), p(1, 0, k), p(0, 1, k), p(1, 1, k)));
  }
  return shape;
}

Shape filleted_box(double a, double b, double c, double r) {
  Shape shape;
  const dvec3 half = 0.5 * dvec3(a, b, c);
  const dvec3 core = half - dvec3(r);
  const BezierCurve quarter{{{1, 0, 0, 1}, {half_sqrt, half_sqrt, 0, half_sqrt}, {0, 1, 0, 1}}};
  for (int axis = 0; axis < 3; ++axis) {
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    for (const int s : {-1, 1}) {
      const auto flat = [&](int si, int sj) {
        dvec3 p(0.0);
        p[axis] = s * half[axis];
        p[i] = si * core[i];
        p[j] = sj * core[j];
        return p;
      };
      shape.surfaces.push_back(bilinear(flat(-1, -1), flat(-1, 1), flat(1, -1), flat(1, 1)));
    }
    for (const int si : {-1, 1}) {
      for (const int sj : {-1, 1}) {
        BezierPatch strip{2, 1, {}};
        for (const dvec4& q : quarter.points) {
          for (const int s : {-1, 1}) {
            dvec3 p(0.0);
            p[axis] = s * core[axis];
            p[i] = si * (core[i] + r * q.x / q.w);
            p[j] = sj * (core[j] + r * q.y / q.w);
            strip.points.push_back(taut::homogeneous(p, q.w));
          }
        }
        shape.surfaces.push_back(taut::as_nurbs(strip));
      }
    }
  }
  for (int octant = 0; octant < 8; ++octant) {
    const dvec3 sign(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
    BezierPatch corner{2, 2, {}};
    for (const dvec4& q : quarter.points) {
      for (const dvec4& m : quarter.points) {
        const dvec3 on_sphere(m.x / m.w * q.x / q.w, m.x / m.w * q.y / q.w, m.y / m.w);
        corner.points.push_back(taut::homogeneous(sign * (core + r * on_sphere), q.w * m.w));
      }
    }
    shape.surfaces.push_back(taut::as_nurbs(corner));
  }
  return shape;
}

Shape spherical_cap(double height) {
  // The arc from the pole down to the rim as one rational quadratic.
  const double half = 0.5 * std::acos(1 - height);
  const dvec3 end(std::sin(2 * half), 0, std::cos(2 * half));
  const BezierCurve arc{
      {{0, 0, 1, 1}, taut::homogeneous({std::tan(half), 0, 1}, std::cos(half)), dvec4(end, 1.0)}};
  return {{revolved(taut::as_nurbs(arc))}, {}, {}};
}

Shape two_spheres(double r1, double r2, double d) {
  return sphere(r1) + shifted(sphere(r2), {0, 0, d});
}

Shape oloid() {
  return {
      {}, {circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0}), circle({1, 0, 0}, {1, 0, 0}, {0, 0, 1})}, {}};
}

Shape perpendicular_circles() {
  return {
      {}, {circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0}), circle(dvec3(0.0), {1, 0, 0}, {0, 0, 1})}, {}};
}

Shape paraboloid() { return height_field({{2, 0, 2}, {0, -2, 0}, {2, 0, 2}}); }
Shape saddle() { return height_field({{0, 2, 0}, {-2, 0, -2}, {0, 2, 0}}); }

Shape bilinear_saddle() {
  return {{bilinear({-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {1, 1, 1})}, {}, {}};
}

Shape dented() {
  const BezierCurve profile{{{0, 0, 0.2, 1},
                             {0.8, 0, 0.2, 1},
                             {0.9, 0, 2, 1},
                             {1.8, 0, 0.5, 1},
                             {1, 0, -1, 1},
                             {0, 0, -1, 1}}};
  return {{revolved(taut::as_nurbs(profile))}, {}, {}};
}

Shape teapot() {
  Model model;
  taut::read_model(TAUT_DATA "/teapot.bpt", model);
  Shape shape;
  for (const taut::Patch& patch : model.parts()[0].patches()) {
    shape.surfaces.push_back(taut::as_nurbs(patch.bezier));
  }
  return shape;
}

BezierPatch random_patch(Random& random, int degree_u, int degree_v, double weight_range) {
  BezierPatch patch{degree_u, degree_v, {}};
  for (int k = 0; k < (degree_u + 1) * (degree_v + 1); ++k) {
    const double w = weight_range > 1 ? log_uniform(random, 1 / weight_range, weight_range) : 1;
    patch.points.push_back(taut::homogeneous(random_point(random), w));
  }
  return patch;
}

BezierCurve random_curve(Random& random, int degree, double weight_range) {
  return {random_patch(random, degree, 0, weight_range).points};
}

}  // namespace taut_test
