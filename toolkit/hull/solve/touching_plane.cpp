#include "taut/hull/solve/touching_plane.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

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

/// Turns a plane about the line that its contacts lie in.
class LineTurn {
 public:
  LineTurn(const ContactGeometry& geometry, const TouchingPlane& plane)
      : geometry_(geometry), plane_(plane) {
    for (const ClimbedContact& a : plane.contacts) {
      for (const ClimbedContact& b : plane.contacts) {
        if (glm::distance(a.x, b.x) > glm::distance(from_, to_)) {
          from_ = a.x;
          to_ = b.x;
        }
      }
    }
    across_ = glm::cross(unit(to_ - from_), plane.n);
  }

  dvec3 turned(double angle) const {
    return std::cos(angle) * plane_.n + std::sin(angle) * across_;
  }
  double angle(const dvec3& n) const {
    return std::atan2(glm::dot(n, across_), glm::dot(n, plane_.n));
  }
  /// A contact has left the line.
  bool parts(double angle) const {
    const dvec3 n = turned(angle);
    return std::any_of(plane_.contacts.begin(), plane_.contacts.end(), [&](const auto& c) {
      const dvec3 x = climb(geometry_, c.contact, n).x;
      return glm::length(glm::cross(x - from_, unit(to_ - from_))) > parted;
    });
  }
  /// Between an angle at which none has and one at which some have.
  double found(double together, double apart) const {
    for (int k = 0; k < turn_halvings; ++k) {
      const double middle = 0.5 * (together + apart);
      (parts(middle) ? apart : together) = middle;
    }
    return together;
  }

 private:
  /// In the scene's frame; the distance grows with the angle.
  static constexpr double parted = 1e-9;
  static constexpr int turn_halvings = 50;

  const ContactGeometry& geometry_;
  const TouchingPlane& plane_;
  dvec3 from_ = dvec3(0.0), to_ = dvec3(0.0);
  dvec3 across_ = dvec3(0.0);
};

void find_above(SupportQuery& query, TouchingPlane& plane) {
  double highest = -infinity;
  for (const ClimbedContact& c : plane.contacts) highest = std::max(highest, c.h);
  plane.above = std::max(0.0, query(plane.n, plane.contacts.front().contact).h - highest);
}

}  // namespace

TouchingPlane turned_to_part(const ContactGeometry& geometry, SupportQuery& query,
                             const TouchingPlane& plane, const std::vector<dvec3>& beside) {
  const LineTurn turn(geometry, plane);
  std::optional<double> together, apart;
  for (const dvec3& n : beside) {
    const double angle = turn.angle(n);
    std::optional<double>& own = turn.parts(angle) ? apart : together;
    if (!own || std::abs(angle) < std::abs(*own)) own = angle;
  }
  if (!together || !apart) return plane;
  std::vector<Contact> contacts;
  for (const ClimbedContact& c : plane.contacts) contacts.push_back(c.contact);
  TouchingPlane found =
      PlaneSearch(geometry, turn.turned(turn.found(*together, *apart)), contacts).run();
  find_above(query, found);
  return found;
}

TouchingPlane touching_plane(const ContactGeometry& geometry, SupportQuery& query, dvec3 n,
                             const std::vector<Contact>& contacts) {
  TouchingPlane plane = PlaneSearch(geometry, n, contacts).run();
  find_above(query, plane);
  return plane;
}

}  // namespace taut
