#include "freeform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

namespace taut_test {
namespace {

using taut::homogeneous;
using taut::PatchPiece;

double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// A polynomial in u and v by Bernstein coefficients.
struct Polynomial {
  int p = 0;
  int q = 0;
  std::vector<double> at;
};

std::size_t index(const Polynomial& f, int i, int j) {
  return std::size_t(i) * std::size_t(f.q + 1) + std::size_t(j);
}

Polynomial constant(int p, int q, double value) {
  return {p, q, std::vector<double>(std::size_t(p + 1) * std::size_t(q + 1), value)};
}

Polynomial operator*(const Polynomial& f, const Polynomial& g) {
  Polynomial result = constant(f.p + g.p, f.q + g.q, 0);
  for (int i = 0; i <= f.p; ++i) {
    for (int j = 0; j <= f.q; ++j) {
      for (int k = 0; k <= g.p; ++k) {
        for (int l = 0; l <= g.q; ++l) {
          const double in_u = binomial(f.p, i) * binomial(g.p, k) / binomial(result.p, i + k);
          const double in_v = binomial(f.q, j) * binomial(g.q, l) / binomial(result.q, j + l);
          result.at[index(result, i + k, j + l)] +=
              in_u * in_v * f.at[index(f, i, j)] * g.at[index(g, k, l)];
        }
      }
    }
  }
  return result;
}

/// @pre same degrees
Polynomial operator+(Polynomial f, const Polynomial& g) {
  std::transform(f.at.begin(), f.at.end(), g.at.begin(), f.at.begin(), std::plus<>());
  return f;
}

Polynomial operator*(double factor, Polynomial f) {
  for (double& c : f.at) c *= factor;
  return f;
}

Polynomial raised(const Polynomial& f, int p, int q) { return f * constant(p - f.p, q - f.q, 1); }

/// A patch's homogeneous coordinates.
struct Coordinates {
  Polynomial x, y, z, w;
};

Coordinates coordinates(const BezierPatch& patch) {
  std::array<Polynomial, 4> all;
  for (int k = 0; k < 4; ++k) {
    Polynomial& f = all[std::size_t(k)];
    f = constant(patch.degree_u, patch.degree_v, 0);
    for (std::size_t i = 0; i < f.at.size(); ++i) f.at[i] = patch.points[i][k];
  }
  return {all[0], all[1], all[2], all[3]};
}

BezierPatch patch_of(const Coordinates& c) {
  BezierPatch patch{c.x.p, c.x.q, {}};
  patch.points.reserve(c.x.at.size());
  for (std::size_t i = 0; i < c.x.at.size(); ++i) {
    patch.points.emplace_back(c.x.at[i], c.y.at[i], c.z.at[i], c.w.at[i]);
  }
  return patch;
}

/// Knots 0, 1, .. of Bezier pieces that share their end points.
std::vector<double> piecewise_knots(int pieces, int degree) {
  std::vector<double> knots = {0};
  for (int k = 0; k <= pieces; ++k) knots.insert(knots.end(), std::size_t(degree), double(k));
  knots.push_back(pieces);
  return knots;
}

/// One surface of patches of one degree, `down` of them along v within those along u.
NurbsSurface assembled(const std::vector<BezierPatch>& patches, int down) {
  const int p = patches.front().degree_u;
  const int q = patches.front().degree_v;
  const int around = int(patches.size()) / down;
  NurbsSurface surface{p, q, piecewise_knots(around, p), piecewise_knots(down, q), {}};
  surface.points.resize(std::size_t(surface.count_u()) * std::size_t(surface.count_v()));
  for (std::size_t n = 0; n < patches.size(); ++n) {
    const int i = p * (int(n) / down);
    const int j = q * (int(n) % down);
    for (int k = 0; k <= p; ++k) {
      for (int l = 0; l <= q; ++l) {
        surface.points[std::size_t((i + k) * surface.count_v() + j + l)] = patches[n].at(k, l);
      }
    }
  }
  return surface;
}

std::vector<BezierPatch> patches_of(const NurbsSurface& surface) {
  const std::vector<PatchPiece> pieces = taut::decompose(surface);
  std::vector<BezierPatch> result;
  result.reserve(pieces.size());
  for (const PatchPiece& piece : pieces) result.push_back(piece.bezier);
  return result;
}

/// How many patches a surface has along v.
int patches_down(const NurbsSurface& surface) {
  const std::vector<PatchPiece> pieces = taut::decompose(surface);
  return int(std::count_if(pieces.begin(), pieces.end(), [&](const PatchPiece& piece) {
    return piece.u.lower == pieces.front().u.lower;
  }));
}

NurbsCurve assembled(const std::vector<BezierCurve>& pieces) {
  const int degree = pieces.front().degree();
  NurbsCurve curve{degree, piecewise_knots(int(pieces.size()), degree), pieces.front().points};
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    const std::vector<dvec4>& points = pieces[k].points;
    curve.points.insert(curve.points.end(), points.begin() + 1, points.end());
  }
  return curve;
}

/// The part of [0, 1] below the parameter, or that above.
taut::Interval half(int side, double at) {
  return side == 0 ? taut::Interval{0, at} : taut::Interval{at, 1};
}

void reverse_knots(std::vector<double>& knots) {
  const double sum = knots.front() + knots.back();
  std::reverse(knots.begin(), knots.end());
  for (double& knot : knots) knot = sum - knot;
}

using Complex = std::complex<double>;

/// Bernstein coefficients of the product of (1 + i s)^m (1 - i s)^n over -half <= s <= half.
std::vector<Complex> powers(int m, int n, double half) {
  std::vector<Complex> c = {1};
  for (int k = 0; k < m + n; ++k) {
    const Complex first = k < m ? Complex(1, -half) : Complex(1, half);
    std::vector<Complex> next(c.size() + 1, 0);
    for (std::size_t i = 0; i < c.size(); ++i) {
      next[i] += c[i] * first;
      next[i + 1] += c[i] * std::conj(first);
    }
    c = std::move(next);
  }
  for (int k = 0; k <= m + n; ++k) c[std::size_t(k)] /= binomial(m + n, k);
  return c;
}

/// The tied curve within an eighth of a turn of t: with s = tan((t' - t) / 2), exp(i t') is
/// exp(i t) (1 + i s) / (1 - i s), and (1 + s^2)^3 the common denominator.
std::vector<dvec4> tied_piece(double t) {
  const double half = std::numbers::sqrt2 - 1;
  const auto first = powers(4, 2, half);
  const auto second = powers(5, 1, half);
  const auto third = powers(6, 0, half);
  const auto weight = powers(3, 3, half);
  std::vector<dvec4> points;
  points.reserve(weight.size());
  for (std::size_t k = 0; k < weight.size(); ++k) {
    points.emplace_back((std::polar(1.0, t) * first[k]).real(),
                        (std::polar(1.0, 2 * t) * second[k]).imag(),
                        (std::polar(1.0, 3 * t) * third[k]).real(), weight[k].real());
  }
  return points;
}

/// How deep the dent is in a direction on the unit sphere.
double depth_at(const Dent& dent, const dvec3& d) {
  const dvec3 n = glm::normalize(dent.direction);
  const double z = glm::dot(n, d);
  if (z <= 0) return 0;
  const dvec3 side = glm::normalize(glm::cross(n, dvec3(0.36, 0.48, 0.8)));
  const double x = glm::dot(side, d);
  const double y = glm::dot(glm::cross(n, side), d);
  const double turn = std::atan2(y, x) - dent.turn;
  // Of two lobes exactly an ellipse's.
  const double steepness = 7 * (1 - 0.35 * std::cos(dent.lobes * turn));
  return dent.depth * std::exp(-steepness * (x * x + y * y) / (z * z));
}

dvec3 pressed(const std::vector<Dent>& dents, dvec3 d) {
  constexpr dvec3 half(1.3, 1.15, 1);
  double factor = 1;
  for (const Dent& dent : dents) factor *= 1 - depth_at(dent, d);
  return factor * half * d;
}

Shape turned(const BezierCurve& profile) { return {{revolved(taut::as_nurbs(profile))}, {}, {}}; }

dmat3 half_axes() { return {1.6, 0, 0, 0, 1.3, 0, 0, 0, 1}; }

/// The unit circle's arc between two angles from the z axis.
BezierCurve meridian(double from, double to) {
  const double weight = std::cos(0.5 * (to - from));
  const auto at = [](double s) { return dvec3(std::sin(s), 0, std::cos(s)); };
  const dvec3 middle = at(0.5 * (from + to)) / weight;
  return {{homogeneous(at(from)), homogeneous(middle, weight), homogeneous(at(to))}};
}

/// Pressed in times 1 - depth (4 u (1 - u))^m (4 v (1 - v))^n.
struct Press {
  int m, n;
  double depth;
};

/// One surface of patches, `down` of them along v, of which one is pressed in; turned.
Shape with_dent(std::vector<BezierPatch> patches, int down, std::size_t dented,
                const Press& press) {
  const int m = press.m;
  const int n = press.n;
  const Polynomial one = constant(2 * m, 2 * n, 1);
  // The powers have a middle coefficient alone.
  Polynomial factor = one;
  factor.at[index(factor, m, n)] -=
      press.depth * std::pow(4, m + n) / (binomial(2 * m, m) * binomial(2 * n, n));
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const Coordinates c = coordinates(patches[k]);
    const Polynomial& f = k == dented ? factor : one;
    patches[k] = patch_of({c.x * f, c.y * f, c.z * f, c.w * one});
  }
  return mapped({{assembled(patches, down)}, {}, {}}, skew_rotation());
}

}  // namespace

Shape tied_curve(double start) {
  NurbsCurve curve{6, piecewise_knots(4, 6), {}};
  for (int k = 0; k < 4; ++k) {
    const std::vector<dvec4> piece = tied_piece(start + pi / 4 + k * pi / 2);
    // Pieces share their ends; the last one ends where the first begins, bit for bit.
    curve.points.insert(curve.points.end(), piece.begin(), piece.end() - 1);
  }
  curve.points.push_back(curve.points.front());
  return {{}, {curve}, {}};
}

Shape godron(double a, double b, double c) {
  const Polynomial x{1, 0, {-1, 1}};
  const Polynomial y{0, 1, {-1, 1}};
  const Polynomial z =
      -a * raised(x * x * x * x, 4, 2) + b * raised(x * x * y, 4, 2) + -c * raised(y * y, 4, 2);
  return of_patch(patch_of({raised(x, 4, 2), raised(y, 4, 2), z, constant(4, 2, 1)}));
}

Shape split(const Shape& shape, double u, double v) {
  Shape result = shape;
  for (NurbsSurface& surface : result.surfaces) {
    const std::vector<BezierPatch> patches = patches_of(surface);
    const int down = patches_down(surface);
    std::vector<BezierPatch> finer(4 * patches.size());
    for (int k = 0; k < int(finer.size()); ++k) {
      const int i = k / (2 * down);
      const int j = k % (2 * down);
      const auto whole = std::size_t((i / 2) * down + j / 2);
      finer[std::size_t(k)] = taut::restricted(patches[whole], half(i % 2, u), half(j % 2, v));
    }
    surface = assembled(finer, 2 * down);
  }
  for (NurbsCurve& curve : result.curves) {
    const std::vector<taut::CurvePiece> pieces = taut::decompose(curve);
    std::vector<BezierCurve> finer;
    finer.reserve(2 * pieces.size());
    for (const taut::CurvePiece& piece : pieces) {
      for (const int side : {0, 1}) finer.push_back(taut::restricted(piece.bezier, half(side, u)));
    }
    curve = assembled(finer);
  }
  return result;
}

Shape with_higher_degrees(const Shape& shape) {
  Shape result = shape;
  for (NurbsSurface& surface : result.surfaces) {
    std::vector<BezierPatch> patches = patches_of(surface);
    for (BezierPatch& patch : patches) {
      patch = taut::elevated(patch, patch.degree_u + 1, patch.degree_v + 2);
    }
    surface = assembled(patches, patches_down(surface));
  }
  for (NurbsCurve& curve : result.curves) {
    const std::vector<taut::CurvePiece> pieces = taut::decompose(curve);
    std::vector<BezierCurve> higher;
    higher.reserve(pieces.size());
    for (const taut::CurvePiece& piece : pieces) {
      higher.push_back(taut::elevated(piece.bezier, curve.degree + 1));
    }
    curve = assembled(higher);
  }
  return result;
}

Shape with_reversed_parameters(const Shape& shape) {
  Shape result = shape;
  for (NurbsSurface& surface : result.surfaces) {
    reverse_knots(surface.knots_u);
    const int rows = surface.count_u();
    const auto row = std::ptrdiff_t(surface.count_v());
    for (int i = 0; i < rows / 2; ++i) {
      const auto first = surface.points.begin() + i * row;
      std::swap_ranges(first, first + row, surface.points.begin() + (rows - 1 - i) * row);
    }
  }
  for (NurbsCurve& curve : result.curves) {
    reverse_knots(curve.knots);
    std::reverse(curve.points.begin(), curve.points.end());
  }
  return result;
}

Shape with_exchanged_parameters(const Shape& shape) {
  Shape result = shape;
  for (NurbsSurface& surface : result.surfaces) {
    const NurbsSurface old = surface;
    std::swap(surface.degree_u, surface.degree_v);
    std::swap(surface.knots_u, surface.knots_v);
    const auto rows = std::size_t(surface.count_u());
    const auto columns = std::size_t(surface.count_v());
    for (std::size_t k = 0; k < old.points.size(); ++k) {
      surface.points[k] = old.points[(k % columns) * rows + k / columns];
    }
  }
  return result;
}

Shape dented_body(const std::vector<Dent>& dents, double start) {
  constexpr int around = 16;
  constexpr int down = 12;
  NurbsSurface surface{3, 3, {}, {0, 0, 0}, {}};
  for (int k = -3; k <= around + 3; ++k) surface.knots_u.push_back(k);
  for (int k = 0; k <= down; ++k) surface.knots_v.push_back(k);
  surface.knots_v.insert(surface.knots_v.end(), 3, double(down));
  const auto control_point = [&](int i, int row) {
    // Poles, and rings level with them, so that the tangent planes there are.
    if (row == 0 || row == down + 2) return dvec3(0, 0, row == 0 ? 1 : -1);
    const double t = start + 2 * pi * (i % around) / around;
    const double s = pi * (row - 1 + (row == 1 ? 0.4 : row == down + 1 ? -0.4 : 0)) / down;
    const dvec3 d(std::sin(s) * std::cos(t), std::sin(s) * std::sin(t), std::cos(s));
    if (row > 1 && row < down + 1) return pressed(dents, d);
    return dvec3(1.3 * d.x, 1.15 * d.y, row == 1 ? 1 : -1);
  };
  surface.points.reserve(std::size_t((around + 3) * (down + 3)));
  for (int i = 0; i < around + 3; ++i) {
    for (int row = 0; row <= down + 2; ++row) {
      surface.points.push_back(homogeneous(control_point(i, row)));
    }
  }
  return {{surface}, {}, {}};
}

Shape ellipsoid_with_a_valley() {
  // Of three rows of patches the middle one reaches 45 degrees to either side of the equator.
  std::vector<BezierPatch> patches(12);
  for (std::size_t row = 0; row < 3; ++row) {
    const std::array<double, 4> polar = {0, pi / 4, 3 * pi / 4, pi};
    const Shape zone = turned(meridian(polar[row], polar[row + 1]));
    const std::vector<BezierPatch> around = patches_of(mapped(zone, half_axes()).surfaces[0]);
    for (std::size_t k = 0; k < 4; ++k) patches[3 * k + row] = around[k];
  }
  return with_dent(patches, 3, 1, {14, 4, 0.08});
}

Shape ellipsoid_with_a_threefold_dent() {
  const std::vector<BezierPatch> patches = patches_of(mapped(sphere(), half_axes()).surfaces[0]);
  return with_dent(patches, 2, 0, {3, 3, 0.5});
}

Shape bean() {
  // Poles away from the hollow's middle and from its ends.
  const Shape body = mapped(mapped(sphere(), skew_rotation()), dmat3(2, 0, 0, 0, 1, 0, 0, 0, 0.6));
  std::vector<BezierPatch> patches = patches_of(body.surfaces[0]);
  for (BezierPatch& patch : patches) {
    const Coordinates c = coordinates(patch);
    const Polynomial z = c.z * c.w + 0.4 * (c.x * c.x) + 0.1 * (c.x * c.y);
    patch = patch_of({c.x * c.w, c.y * c.w, z, c.w * c.w});
  }
  return {{assembled(patches, 2)}, {}, {}};
}

Shape dumbbell() {
  return turned({{{0, 0, -3, 1},
                  {2.2, 0, -3, 1},
                  {2.2, 0, -1, 1},
                  {-1.2, 0, 0, 1},
                  {1.9, 0, 1, 1},
                  {1.9, 0, 3, 1},
                  {0, 0, 3, 1}}});
}

Shape lemon() { return turned({{{0, 0, -1, 1}, homogeneous({4.0 / 3, 0, 0}, 0.6), {0, 0, 1, 1}}}); }

Shape ogive() {
  // The circle about (-0.5, 0, 0) of radius 1.5; half the arc's angle has the tangent sqrt(1/2).
  const double root = std::sqrt(0.5);
  return turned({{{1, 0, 0, 1},
                  homogeneous({1, 0, 1.5 * root}, std::sqrt(2.0 / 3)),
                  {0, 0, std::numbers::sqrt2, 1}}});
}

Shape half_torus(double R, double r) {
  std::vector<BezierPatch> patches = patches_of(torus(R, r).surfaces[0]);
  patches.resize(patches.size() / 2);
  return {{assembled(patches, 4)}, {}, {}};
}

Shape dented_sheet(double down) {
  constexpr int count = 17;
  NurbsSurface surface{3, 3, {0, 0, 0}, {0, 0, 0}, {}};
  for (int k = 0; k <= count - 3; ++k) {
    surface.knots_u.push_back(k);
    surface.knots_v.push_back(k);
  }
  surface.knots_u.insert(surface.knots_u.end(), 3, count - 3.0);
  surface.knots_v.insert(surface.knots_v.end(), 3, count - 3.0);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const dvec2 p(2.0 * i / (count - 1) - 1, 2.0 * j / (count - 1) - 1);
      const double z = -0.25 * glm::dot(p, p) - (i == count / 2 && j == count / 2 ? down : 0);
      surface.points.push_back(homogeneous({p.x, p.y, z}));
    }
  }
  return {{surface}, {}, {}};
}

}  // namespace taut_test
