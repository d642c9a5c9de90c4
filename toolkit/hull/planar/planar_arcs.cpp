#include "taut/hull/planar/planar_arcs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace taut {
namespace {

/// A curve whose control points are as near to a line is straight.
constexpr double straight_width = 1e-13;
/// Corners of control polygons lower than this are rounding.
constexpr double polygon_noise = 2e-15;
/// A part that turns less has one farthest point in each direction of its tangents' normals.
constexpr double most_turning = 1.5;
/// Parts about a cusp shrink with the square of their parameters' interval.
constexpr int deepest_cut = 40;

dvec2 plane_point(const dvec3& p) { return dvec2(p) / p.z; }

std::vector<dvec2> plane_point(const std::vector<dvec3>& points) {
  std::vector<dvec2> result;
  result.reserve(points.size());
  for (const dvec3& p : points) result.push_back(plane_point(p));
  return result;
}

double height(const std::vector<dvec2>& polygon, const dvec2& n) {
  double highest = -std::numeric_limits<double>::infinity();
  for (const dvec2& p : polygon) highest = std::max(highest, glm::dot(n, p));
  return highest;
}

bool is_straight(const std::vector<dvec2>& polygon) {
  dvec2 axis(0);
  for (const dvec2& p : polygon) {
    if (glm::length(p - polygon[0]) > glm::length(axis)) axis = p - polygon[0];
  }
  const double width = straight_width * glm::length(axis);
  return std::all_of(polygon.begin(), polygon.end(), [&](const dvec2& p) {
    return std::abs(cross(axis, p - polygon[0])) <= width;
  });
}

/// The polygon's sides; without those that are rounding.
std::vector<dvec2> polygon_sides(const std::vector<dvec2>& polygon) {
  std::vector<dvec2> sides;
  sides.reserve(polygon.size());
  dvec2 from = polygon[0];
  for (const dvec2& p : polygon) {
    if (glm::length(p - from) <= polygon_noise) continue;
    sides.push_back(p - from);
    from = p;
  }
  return sides;
}

/// How a polygon turns.
struct Turning {
  bool left = false;
  bool right = false;
  double angle = 0;

  explicit Turning(const std::vector<dvec2>& sides) {
    for (std::size_t k = 1; k < sides.size(); ++k) {
      const dvec2& a = sides[k - 1];
      const dvec2& b = sides[k];
      const double area = cross(a, b);
      angle += std::abs(std::atan2(area, glm::dot(a, b)));
      const double noise = polygon_noise * std::max(glm::length(a), glm::length(b));
      left = left || area > noise;
      right = right || area < -noise;
    }
  }
};

/// Both halves of a curve (de Casteljau).
std::pair<std::vector<dvec3>, std::vector<dvec3>> parts(std::vector<dvec3> points, double t) {
  std::vector<dvec3> lower;
  lower.reserve(points.size());
  for (std::size_t last = points.size(); last > 0; --last) {
    lower.push_back(points[0]);
    // What is left of each round stands at the end: the other half.
    for (std::size_t i = 0; i + 1 < last; ++i) points[i] = (1 - t) * points[i] + t * points[i + 1];
  }
  return {std::move(lower), std::move(points)};
}

}  // namespace

PlanarJet planar_jet(const std::vector<dvec3>& curve, double t) {
  const double degree = double(curve.size()) - 1;
  std::vector<dvec3> b = curve;
  dvec3 Pt(0);
  dvec3 Ptt(0);
  for (std::size_t last = b.size() - 1; last > 0; --last) {
    if (last == 2) Ptt = degree * (degree - 1) * (b[2] - 2.0 * b[1] + b[0]);
    if (last == 1) Pt = degree * (b[1] - b[0]);
    for (std::size_t i = 0; i < last; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
  }
  PlanarJet jet;
  const double w = b[0].z;
  jet.c = plane_point(b[0]);
  jet.ct = (dvec2(Pt) - Pt.z * jet.c) / w;
  jet.ctt = (dvec2(Ptt) - Ptt.z * jet.c - 2 * Pt.z * jet.ct) / w;
  return jet;
}

std::vector<dvec2> part_polygon(const std::vector<dvec3>& curve, double from, double to) {
  if (from > to) std::swap(from, to);
  const std::vector<dvec3> lower = parts(curve, to).first;
  return plane_point(parts(lower, to > 0 ? from / to : 0).second);
}

PlanarArcs::PlanarArcs(std::span<const dvec2> points, std::span<const std::vector<dvec3>> curves,
                       Stop stop)
    : curves_(curves), stop_(std::move(stop)) {
  elements_.reserve(points.size() + curves.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    ConvexArc arc;
    arc.point = int(k);
    arc.polygon = {points[k]};
    elements_.push_back({int(arcs_.size()), int(arcs_.size()), arc.polygon});
    arcs_.push_back(std::move(arc));
  }
  for (std::size_t k = 0; k < curves.size(); ++k) add_curve(int(k));
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    active_.push_back(int(k));
    element_of_arc_.resize(std::size_t(elements_[k].last_arc) + 1, int(k));
  }
  make_tree();
}

void PlanarArcs::make_tree() {
  std::vector<PlanarTree::Entry> entries;
  entries.reserve(active_.size());
  for (const int k : active_) entries.push_back({k, PlanarBox(elements_[std::size_t(k)].polygon)});
  tree_ = PlanarTree(std::move(entries));
}

void PlanarArcs::add_curve(int number) {
  stop_.check();
  const std::vector<dvec3>& points = curve(number);
  const int first = int(arcs_.size());
  std::vector<dvec2> polygon = plane_point(points);
  if (!is_straight(polygon)) {
    cut(number, points, {}, 0);
  } else {
    for (const double t : {0.0, 1.0}) {
      ConvexArc end;
      end.curve = number;
      end.t0 = end.t1 = t;
      end.polygon = {t == 0 ? polygon.front() : polygon.back()};
      arcs_.push_back(std::move(end));
    }
    polygon = {polygon.front(), polygon.back()};
  }
  elements_.push_back({first, int(arcs_.size()) - 1, std::move(polygon)});
}

void PlanarArcs::cut(int number, const std::vector<dvec3>& part, Interval t, int depth) {
  ConvexArc arc;
  arc.polygon = plane_point(part);
  const std::vector<dvec2> sides = polygon_sides(arc.polygon);
  const Turning turning(sides);
  const bool convex = turning.angle < most_turning && !(turning.left && turning.right);
  if (!convex && depth < deepest_cut) {
    const double middle = t.at(0.5);
    const auto halves = parts(part, 0.5);
    cut(number, halves.first, {t.lower, middle}, depth + 1);
    cut(number, halves.second, {middle, t.upper}, depth + 1);
    return;
  }
  arc.curve = number;
  arc.t0 = t.lower;
  arc.t1 = t.upper;
  arc.turn = turning.angle;
  if (convex) arc.sense = int(turning.left) - int(turning.right);
  if (!sides.empty()) {
    arc.first = sides.front();
    arc.last = sides.back();
  }
  arcs_.push_back(std::move(arc));
}

ArcPoint PlanarArcs::tangent_point(int number, const dvec2& n) const {
  const ConvexArc& arc = (*this)[number];
  double lower = arc.t0;
  double upper = arc.t1;
  const double rise = glm::dot(arc.first, n) / glm::length(arc.first);
  const double fall = glm::dot(arc.last, n) / glm::length(arc.last);
  double t = lower + (upper - lower) * rise / (rise - fall);
  constexpr int most_steps = 80;
  for (int step = 0; step < most_steps; ++step) {
    const PlanarJet jet = planar_jet(curve(arc.curve), t);
    const double slope = glm::dot(jet.ct, n);
    (slope > 0 ? lower : upper) = t;
    double next = t - slope / glm::dot(jet.ctt, n);
    if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
    const double moved = std::abs(next - t);
    t = next;
    if (moved <= std::numeric_limits<double>::epsilon()) break;
  }
  return {number, t, planar_jet(curve(arc.curve), t).c};
}

ArcPoint PlanarArcs::support(int number, const dvec2& n) const {
  const ConvexArc& arc = (*this)[number];
  if (glm::dot(arc.first, n) > 0 && glm::dot(arc.last, n) < 0) return tangent_point(number, n);
  const dvec2& a = arc.polygon.front();
  const dvec2& b = arc.polygon.back();
  return glm::dot(a, n) >= glm::dot(b, n) ? ArcPoint{number, arc.t0, a}
                                          : ArcPoint{number, arc.t1, b};
}

ArcPoint PlanarArcs::support(int first, int last, const dvec2& n) const {
  ArcPoint best = support(first, n);
  for (int arc = std::min(first, last); arc <= std::max(first, last); ++arc) {
    const ArcPoint p = support(arc, n);
    if (glm::dot(p.x, n) > glm::dot(best.x, n)) best = p;
  }
  return best;
}

/// The farthest point; none where no control point is above a height.
ArcPoint PlanarArcs::element_support(const Element& element, const dvec2& n, double above) const {
  ArcPoint best;
  for (int arc = element.first_arc; arc <= element.last_arc; ++arc) {
    if (height((*this)[arc].polygon, n) <= above) continue;
    const ArcPoint p = support(arc, n);
    if (glm::dot(p.x, n) <= above) continue;
    above = glm::dot(p.x, n);
    best = p;
  }
  return best;
}

ArcPoint PlanarArcs::support(const dvec2& n, int preferred) const {
  stop_.check();
  double highest = -std::numeric_limits<double>::infinity();
  ArcPoint own;
  if (preferred >= 0) {
    const int element = element_of_arc_[std::size_t(preferred)];
    own = element_support(elements_[std::size_t(element)], n, highest);
    highest = glm::dot(own.x, n) + planar_slack;
  }
  ArcPoint best = own;
  tree_.visit(n, highest, [&](int k) {
    const Element& element = elements_[std::size_t(k)];
    if (height(element.polygon, n) <= highest) return highest;
    const ArcPoint p = element_support(element, n, highest);
    if (p.arc < 0) return highest;
    best = p;
    highest = glm::dot(p.x, n);
    return highest;
  });
  return best;
}

void PlanarArcs::leave_out_inside(const std::vector<dvec2>& polygon) {
  if (polygon.size() < 3) return;
  const auto inside = [&](const dvec2& p) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const dvec2 side = polygon[(k + 1) % polygon.size()] - polygon[k];
      // Rounding counts for the outside.
      constexpr double margin = 1e-11;
      if (cross(side, p - polygon[k]) <= margin * glm::length(side)) return false;
    }
    return true;
  };
  std::erase_if(active_, [&](int k) {
    const std::vector<dvec2>& control = elements_[std::size_t(k)].polygon;
    return std::all_of(control.begin(), control.end(), inside);
  });
  make_tree();
}

std::vector<int> PlanarArcs::beyond(const dvec2& n, double least) const {
  stop_.check();
  std::vector<int> result;
  tree_.visit(n, least, [&](int k) {
    const Element& element = elements_[std::size_t(k)];
    if (height(element.polygon, n) <= least) return least;
    for (int arc = element.first_arc; arc <= element.last_arc; ++arc) {
      if (height((*this)[arc].polygon, n) > least) result.push_back(arc);
    }
    return least;
  });
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace taut
