#include "shapes.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace taut::shapes {
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
    curve.points.push_back(homogeneous(center + offsets[k], k % 2 == 0 ? 1 : half_sqrt));
  }
  return curve;
}

template <class Geometry>
void map(Geometry& geometry, const dmat3& matrix, const dvec3& translation) {
  for (dvec4& p : geometry.points) {
    p = homogeneous(matrix * euclidean(p) + translation, p.w);
  }
}

NurbsSurface bilinear(const dvec3& p00, const dvec3& p01, const dvec3& p10, const dvec3& p11) {
  return as_nurbs(
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

NurbsCurve circle(const dvec3& center, const dvec3& a, const dvec3& b) {
  return arcs(center, {a, a + b, b, b - a, -a, -a - b, -b, a - b, a});
}

NurbsCurve half_circle(const dvec3& center, const dvec3& a, const dvec3& b) {
  return arcs(center, {b, a + b, a, a - b, -b});
}

NurbsCurve segment(const dvec3& a, const dvec3& b) {
  return as_nurbs(BezierCurve{{dvec4(a, 1.0), dvec4(b, 1.0)}});
}

NurbsCurve twisted_cubic() {
  return as_nurbs(
      BezierCurve{{{0, 0, 0, 1}, {1.0 / 3, 0, 0, 1}, {2.0 / 3, 1.0 / 3, 0, 1}, {1, 1, 1, 1}}});
}

NurbsSurface revolved(const NurbsCurve& profile) {
  const NurbsCurve turn = circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0});
  NurbsSurface surface{turn.degree, profile.degree, turn.knots, profile.knots, {}};
  for (const dvec4& t : turn.points) {
    for (const dvec4& p : profile.points) {
      const dvec3 x = euclidean(p);
      const dvec3 c = euclidean(t);
      surface.points.push_back(homogeneous({x.x * c.x, x.x * c.y, x.z}, p.w * t.w));
    }
  }
  return surface;
}

Shape of_patch(const BezierPatch& patch) { return {{as_nurbs(patch)}, {}, {}}; }

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
Shape solid_cylinder(double r, double h) { return cylinder(r, h) + disc(r, 0) + disc(r, h); }
Shape solid_cone(double r, double h) { return cone(r, h) + disc(r, 0); }
Shape disc(double r, double z) { return {{revolved(segment({0, 0, z}, {r, 0, z}))}, {}, {}}; }
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
            strip.points.push_back(homogeneous(p, q.w));
          }
        }
        shape.surfaces.push_back(as_nurbs(strip));
      }
    }
  }
  for (int octant = 0; octant < 8; ++octant) {
    const dvec3 sign(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
    BezierPatch corner{2, 2, {}};
    for (const dvec4& q : quarter.points) {
      for (const dvec4& m : quarter.points) {
        const dvec3 on_sphere(m.x / m.w * q.x / q.w, m.x / m.w * q.y / q.w, m.y / m.w);
        corner.points.push_back(homogeneous(sign * (core + r * on_sphere), q.w * m.w));
      }
    }
    shape.surfaces.push_back(as_nurbs(corner));
  }
  return shape;
}

Shape spherical_cap(double height) {
  // The arc from the pole down to the rim as one rational quadratic; its middle weight is the
  // cosine of half its angle.
  const double cosine = 1 - height;
  const double sine = std::sqrt(height * (2 - height));
  const BezierCurve arc{{{0, 0, 1, 1},
                         homogeneous({sine / (1 + cosine), 0, 1}, std::sqrt((1 + cosine) / 2)),
                         {sine, 0, cosine, 1}}};
  return {{revolved(as_nurbs(arc))}, {}, {}};
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
  return {{revolved(as_nurbs(profile))}, {}, {}};
}

namespace {

double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// (1 - B) S for a patch S and B(u, v) = a(u) b(v), by Bezier coefficients of a and b.
BezierPatch scaled_by(const BezierPatch& S, const std::vector<double>& a,
                      const std::vector<double>& b) {
  const int m = int(a.size()) - 1;
  const int n = int(b.size()) - 1;
  BezierPatch result = elevated(S, S.degree_u + m, S.degree_v + n);
  for (int i = 0; i <= S.degree_u; ++i) {
    for (int j = 0; j <= S.degree_v; ++j) {
      for (int k = 0; k <= m; ++k) {
        for (int l = 0; l <= n; ++l) {
          const double in_u =
              binomial(S.degree_u, i) * binomial(m, k) / binomial(result.degree_u, i + k);
          const double in_v =
              binomial(S.degree_v, j) * binomial(n, l) / binomial(result.degree_v, j + l);
          const double share = in_u * in_v * a[std::size_t(k)] * b[std::size_t(l)];
          result.at(i + k, j + l) -= share * dvec4(dvec3(S.at(i, j)), 0.0);
        }
      }
    }
  }
  return result;
}

/// Knots 0, 1, .. of Bezier pieces that share their end points.
std::vector<double> piecewise_knots(int pieces, int degree) {
  std::vector<double> knots = {0};
  for (int k = 0; k <= pieces; ++k) knots.insert(knots.end(), std::size_t(degree), double(k));
  knots.push_back(pieces);
  return knots;
}

}  // namespace

Shape dented_ellipsoid() {
  // (1 - s^2)^2 and (1 - s^2)^3 by Bezier coefficients, s falling from 1 to 0 and rising again.
  const std::vector<double> flat(5, 0.0);
  const std::vector<std::vector<double>> bumps_u = {
      {0, 0, 2.0 / 3, 1, 1}, {1, 1, 2.0 / 3, 0, 0}, flat, flat};
  const std::vector<std::vector<double>> bumps_v = {{0, 0, 0, 0.4, 0.8, 1, 1},
                                                    {1, 1, 0.8, 0.4, 0, 0, 0}};
  constexpr double depth = 0.6;
  constexpr int p = 2 + 4;
  constexpr int q = 2 + 6;

  const std::vector<PatchPiece> pieces = decompose(ellipsoid(3, 2, 1).surfaces[0]);
  NurbsSurface surface{p, q, piecewise_knots(4, p), piecewise_knots(2, q), {}};
  surface.points.resize(std::size_t(surface.count_u()) * std::size_t(surface.count_v()));
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      std::vector<double> along_u = bumps_u[i];
      for (double& a : along_u) a *= depth;
      const BezierPatch patch = scaled_by(pieces[2 * i + j].bezier, along_u, bumps_v[j]);
      for (int k = 0; k <= p; ++k) {
        for (int l = 0; l <= q; ++l) {
          const std::size_t row = p * i + std::size_t(k);
          const std::size_t column = q * j + std::size_t(l);
          surface.points[row * std::size_t(surface.count_v()) + column] = patch.at(k, l);
        }
      }
    }
  }
  return {{surface}, {}, {}};
}

}  // namespace taut::shapes
