#include "sweeps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace taut_test {
namespace {

using taut::euclidean;
using taut::homogeneous;
using taut::unit;

std::vector<double> clamped_knots(int points, int degree) {
  std::vector<double> knots(std::size_t(degree), 0.0);
  for (int k = 0; k <= points - degree; ++k) knots.push_back(k);
  knots.insert(knots.end(), std::size_t(degree), points - degree);
  return knots;
}

}  // namespace

NurbsCurve arc(const dvec3& a, const dvec3& corner, const dvec3& b) {
  const double weight = glm::dot(unit(b - a), unit(corner - a));
  return {2, {0, 0, 0, 1, 1, 1}, {dvec4(a, 1), homogeneous(corner, weight), dvec4(b, 1)}};
}

std::vector<NurbsCurve> rounded(const std::vector<dvec3>& points, double radius, bool closed) {
  const std::size_t count = points.size();
  std::vector<std::pair<dvec3, dvec3>> cut(count);  // where the arc at a point begins and ends
  for (std::size_t k = 0; k < count; ++k) {
    cut[k] = {points[k], points[k]};
    if (radius == 0 || (!closed && (k == 0 || k + 1 == count))) continue;
    const dvec3 before = unit(points[(k + count - 1) % count] - points[k]);
    const dvec3 after = unit(points[(k + 1) % count] - points[k]);
    const double turn = std::acos(std::clamp(glm::dot(before, after), -1.0, 1.0));
    const double length = radius / std::tan(0.5 * turn);
    cut[k] = {points[k] + length * before, points[k] + length * after};
  }
  std::vector<NurbsCurve> result;
  for (std::size_t k = 0; k < count; ++k) {
    if (cut[k].first != cut[k].second) {
      result.push_back(arc(cut[k].first, points[k], cut[k].second));
    }
    if (!closed && k + 1 == count) break;
    result.push_back(segment(cut[k].second, cut[(k + 1) % count].first));
  }
  return result;
}

NurbsCurve spline(const std::vector<dvec3>& points, int degree) {
  NurbsCurve curve{degree, clamped_knots(int(points.size()), degree), {}};
  for (const dvec3& p : points) curve.points.emplace_back(p, 1.0);
  return curve;
}

NurbsCurve closed_spline(std::vector<dvec3> points) {
  for (std::size_t k = 0; k < 3; ++k) points.push_back(points[k]);
  NurbsCurve curve{3, {}, {}};
  for (std::size_t k = 0; k < points.size() + 4; ++k) curve.knots.push_back(double(k));
  for (const dvec3& p : points) curve.points.emplace_back(p, 1.0);
  return curve;
}

NurbsSurface spline(const std::vector<std::vector<dvec3>>& rows, int degree_u, int degree_v) {
  NurbsSurface surface{degree_u,
                       degree_v,
                       clamped_knots(int(rows.size()), degree_u),
                       clamped_knots(int(rows.front().size()), degree_v),
                       {}};
  for (const auto& row : rows) {
    for (const dvec3& p : row) surface.points.emplace_back(p, 1.0);
  }
  return surface;
}

NurbsSurface lofted(const std::vector<NurbsCurve>& curves) {
  const NurbsCurve& first = curves.front();
  NurbsSurface surface{3, first.degree, clamped_knots(int(curves.size()), 3), first.knots, {}};
  for (const NurbsCurve& c : curves) {
    surface.points.insert(surface.points.end(), c.points.begin(), c.points.end());
  }
  return surface;
}

NurbsSurface ruled(const NurbsCurve& a, const NurbsCurve& b) {
  NurbsSurface surface{a.degree, 1, a.knots, {0, 0, 1, 1}, {}};
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    surface.points.push_back(a.points[k]);
    surface.points.push_back(b.points[k]);
  }
  return surface;
}

NurbsSurface fan(const NurbsCurve& curve, const dvec3& apex) {
  NurbsCurve tip = curve;
  for (dvec4& p : tip.points) p = homogeneous(apex, p.w);
  return ruled(curve, tip);
}

NurbsCurve moved(NurbsCurve curve, const dvec3& d) {
  for (dvec4& p : curve.points) p = homogeneous(euclidean(p) + d, p.w);
  return curve;
}

NurbsSurface extruded(const NurbsCurve& curve, const dvec3& d) {
  return ruled(curve, moved(curve, d));
}

NurbsSurface quarter_turn(const NurbsCurve& profile) {
  NurbsSurface surface{2, profile.degree, {0, 0, 0, 1, 1, 1}, profile.knots, {}};
  for (int k = 0; k < 3; ++k) {
    for (const dvec4& p : profile.points) {
      const dvec3 x = euclidean(p);
      const double weight = k == 1 ? std::numbers::sqrt2 / 2 : 1;
      surface.points.push_back(homogeneous({k < 2 ? x.x : 0, k > 0 ? x.x : 0, x.z}, weight * p.w));
    }
  }
  return surface;
}

NurbsSurface quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  return ruled(segment(a, b), segment(d, c));
}

Shape of(std::vector<NurbsSurface> surfaces) { return {std::move(surfaces), {}, {}}; }

Shape revolved_all(const std::vector<NurbsCurve>& profile) {
  Shape shape;
  for (const NurbsCurve& curve : profile) {
    const bool on_axis = std::all_of(curve.points.begin(), curve.points.end(),
                                     [](const dvec4& p) { return p.x == 0; });
    if (!on_axis) shape.surfaces.push_back(revolved(curve));
  }
  return shape;
}

Shape prism(const std::vector<NurbsCurve>& outline, double h, const dvec3& inside) {
  Shape shape;
  const dvec3 up(0, 0, h);
  for (const NurbsCurve& curve : outline) {
    shape.surfaces.push_back(extruded(curve, up));
    shape.surfaces.push_back(fan(curve, inside));
    shape.surfaces.push_back(fan(moved(curve, up), inside + up));
  }
  return shape;
}

}  // namespace taut_test
