#include "taut/hull/solve/touching_plane.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Steps of the method, which needs five.
constexpr int plane_steps = 40;
/// Longest step, in radians, and one that is rounding.
constexpr double longest_step = 0.25;
constexpr double shortest_step = 1e-15;
/// Width of contacts, relative to their length, below which they are in line.
constexpr double line_width = 1e-6;

class PlaneSearch {
 public:
  PlaneSearch(const ContactGeometry& geometry, const dvec3& n, const std::vector<Contact>& contacts)
      : geometry_(geometry), starts_(contacts) {
    found_.n = n;
  }

  TouchingPlane run() {
    double last = infinity;
    for (int k = 0; k < plane_steps; ++k) {
      climb_all();
      const dvec3 turn = step();
      const double length = glm::length(turn);
      if (length <= shortest_step || (k > 4 && length >= 0.5 * last && length < 1e-12)) break;
      last = length;
      found_.n = unit(found_.n + turn * std::min(1.0, longest_step / length));
    }
    climb_all();
    return found_;
  }

 private:
  void climb_all() {
    found_.contacts.clear();
    double lowest = infinity;
    double highest = -infinity;
    for (Contact& start : starts_) {
      found_.contacts.push_back(climb(geometry_, start, found_.n));
      const ClimbedContact& c = found_.contacts.back();
      start = c.contact;
      lowest = std::min(lowest, c.h);
      highest = std::max(highest, c.h);
    }
    found_.spread = highest - lowest;
  }

  /// The shortest turn that makes the heights as alike as turns do to first order.
  dvec3 step() {
    const std::array<dvec3, 2> frame = tangent_frame(found_.n);
    const auto count = Eigen::Index(found_.contacts.size());
    dvec3 middle(0.0);
    for (const ClimbedContact& c : found_.contacts) middle += c.x / double(count);
    Eigen::MatrixXd rates(count, 2);
    Eigen::VectorXd heights(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const dvec3 x = found_.contacts[std::size_t(k)].x - middle;
      rates.row(k) << glm::dot(x, frame[0]), glm::dot(x, frame[1]);
      heights[k] = -glm::dot(x, found_.n);
    }
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(rates, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(line_width);
    found_.in_line = svd.rank() < 2;
    const Eigen::Vector2d turn = svd.solve(heights);
    return turn[0] * frame[0] + turn[1] * frame[1];
  }

  const ContactGeometry& geometry_;
  std::vector<Contact> starts_;
  TouchingPlane found_;
};

}  // namespace

TouchingPlane touching_plane(const ContactGeometry& geometry, SupportQuery& query, dvec3 n,
                             const std::vector<Contact>& contacts) {
  TouchingPlane plane = PlaneSearch(geometry, n, contacts).run();
  double highest = -infinity;
  for (const ClimbedContact& c : plane.contacts) highest = std::max(highest, c.h);
  plane.above = std::max(0.0, query(plane.n, plane.contacts.front().contact).h - highest);
  return plane;
}

}  // namespace taut
