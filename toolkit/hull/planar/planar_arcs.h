#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/stop.h"
#include "taut/hull/planar/planar_tree.h"

namespace taut {

/// Twice the area of the triangle that two vectors span, positive where b is to the left of a.
inline double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// The unit vector at an angle.
inline dvec2 direction_at(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// The unit normal of a side that leads from a to b, outward where it does so counter-clockwise.
inline dvec2 outward(const dvec2& a, const dvec2& b) {
  const dvec2 d = b - a;
  return dvec2(d.y, -d.x) / glm::length(d);
}

/// Point and derivatives of a rational Bezier curve of the plane, (w x, w y, w), at t in [0, 1].
struct PlanarJet {
  dvec2 c, ct, ctt;
};
PlanarJet planar_jet(const std::vector<dvec3>& curve, double t);

/// The Euclidean control points of the curve's part over [from, to]; in either order.
std::vector<dvec2> part_polygon(const std::vector<dvec3>& curve, double from, double to);

/// A point of an arc.
struct ArcPoint {
  int arc = -1;
  double t = 0;
  dvec2 x = dvec2(0);
};

/// A part of a curve that turns one way only, by less than a right angle, or a single point: one
/// that was given, or the end of a straight curve. A cusp or an inflection lies in a part that
/// is straight to within rounding.
struct ConvexArc {
  int point = -1;  ///< -1: on a curve
  int curve = -1;
  double t0 = 0;
  double t1 = 0;    ///< t0 for a single point
  int sense = 0;    ///< 1: to the left for growing t, -1: to the right, 0: straight
  double turn = 0;  ///< the angle between the tangents of the ends
  std::vector<dvec2> polygon;
  dvec2 first = dvec2(0);  ///< direction at t0
  dvec2 last = dvec2(0);   ///< direction at t1
};

/// The points and curves, cut into convex arcs; the arcs of a curve follow each other.
class PlanarArcs {
 public:
  /// The points are kept by reference, as are the curves. `stop`: makes this and all that goes
  /// through the arcs throw Cancelled.
  PlanarArcs(std::span<const dvec2> points, std::span<const std::vector<dvec3>> curves,
             Stop stop = {});

  const ConvexArc& operator[](int arc) const { return arcs_[std::size_t(arc)]; }
  const std::vector<dvec3>& curve(int number) const { return curves_[std::size_t(number)]; }
  bool empty() const { return arcs_.empty(); }
  /// @throws Cancelled if stopping was asked for
  void check_stop() const { stop_.check(); }

  /// The arc's farthest point in a direction.
  ArcPoint support(int arc, const dvec2& n) const;
  /// Of the arcs from one number to another, in either order. @pre of one curve
  ArcPoint support(int first, int last, const dvec2& n) const;
  /// The farthest point of all. Another one, of the curve or point to which the arc `preferred`
  /// belongs (-1: none), where it is as far to within planar_slack.
  ArcPoint support(const dvec2& n, int preferred) const;

  /// Forgets, for the support of all, what lies inside of a convex polygon, counter-clockwise.
  void leave_out_inside(const std::vector<dvec2>& polygon);

  /// The arcs with a control point farther than `height` in a direction.
  std::vector<int> beyond(const dvec2& n, double height) const;

 private:
  /// A point, or a curve: its arcs and its control points.
  struct Element {
    int first_arc;
    int last_arc;
    std::vector<dvec2> polygon;
  };

  void add_curve(int number);
  void make_tree();
  void cut(int number, const std::vector<dvec3>& part, Interval t, int depth);
  ArcPoint element_support(const Element& element, const dvec2& n, double above) const;
  ArcPoint tangent_point(int arc, const dvec2& n) const;

  std::span<const std::vector<dvec3>> curves_;
  Stop stop_;
  std::vector<ConvexArc> arcs_;
  std::vector<Element> elements_;
  std::vector<int> element_of_arc_;
  std::vector<int> active_;  ///< those that the support of all is sought among
  PlanarTree tree_;          ///< of these
};

/// Heights that differ by less are taken for equal, with coordinates of size about one.
inline constexpr double planar_slack = 1e-13;

}  // namespace taut
