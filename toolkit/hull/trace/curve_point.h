#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"

namespace taut {

/// Margins and lengths below this are none.
inline constexpr double margin_slack = 1e-12;
/// How far the corrector may move the prediction, as a share of the step.
inline constexpr double correction_limit = 0.15;

/// Where a trace along a separating curve stands: two contacts that support together and the
/// curve's tangent. Steps are predicted along the tangent and corrected across it (pseudo-arclength
/// continuation; Allgower, Georg 1990). Lengths are in (n, x_0, x_1), in the scene's frame, whose
/// size is about one.
class CurvePoint {
 public:
  /// All outlive it. Without a tangent as yet (settle()).
  CurvePoint(const ContactSystem& system, SupportQuery& query, const CommonSupport& start)
      : at(start), system_(system), geometry_(system.geometry()), query_(query) {}

  CommonSupport at;
  CurveTangent tangent;
  /// The smooth join, a side of its patch, along which a contact runs (settle()).
  std::array<std::optional<Side>, 2> join;

  const ContactSystem& system() const { return system_; }
  const ContactGeometry& geometry() const { return geometry_; }
  SupportQuery& query() const { return query_; }

  /// A corrected step of this length along the tangent.
  std::optional<CommonSupport> stepped(double length) const;

  double length_to(const CommonSupport& s) const {
    return length_along(s.n, s.jet[0].x, s.jet[1].x);
  }
  /// Along the tangent.
  double length_along(const dvec3& n, const dvec3& x0, const dvec3& x1) const {
    return glm::dot(n - at.n, tangent.n) + glm::dot(x0 - at.jet[0].x, tangent.x[0]) +
           glm::dot(x1 - at.jet[1].x, tangent.x[1]);
  }
  double distance_to(const CommonSupport& s) const {
    return std::sqrt(square(s.n - at.n) + square(s.jet[0].x - at.jet[0].x) +
                     square(s.jet[1].x - at.jet[1].x));
  }
  /// Of the contacts, and its rate along the tangent.
  double apart() const { return glm::length(at.d()); }
  double rate_apart() const { return glm::dot(tangent.x[0] - tangent.x[1], at.d()) / apart(); }

  /// Where a contact moves along an edge or a seam, it is told as one of that; along another smooth
  /// join, as one of the patch into which its region extends. Sets the tangent and the joins anew;
  /// false if there is none.
  bool settle();
  /// How far beyond a smooth join, a side of its patch, a contact may be and not be told to have
  /// left it, as a parameter: by rounding, or while it runs along it.
  double join_distance(std::size_t contact, Side side) const;
  /// Turns the tangent into the element of the contact, which has just come over its border, where
  /// the direction stands still at first: the element is flat there, and tells no sense.
  void head_into(std::size_t contact);

  /// The two contacts support the model.
  bool supports(const CommonSupport& s) const;
  /// Whether the rulings between two of them are found, in the same elements, and support the
  /// model.
  bool is_followed(Ruling from, const Ruling& to) const;
  /// How far contacts may leave their elements by rounding; or by that of coordinates, of a ruling
  /// and of its neighbours.
  double border_distance() const;

 private:
  CommonSupport predicted(double length) const;
  double rounding_across(std::size_t contact, Side side) const;
  bool runs_along(std::size_t contact, const ContactExit& exit) const;
  void move_to_edges();
  void find_joins();
  static double square(const dvec3& x) { return glm::dot(x, x); }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
};

}  // namespace taut
