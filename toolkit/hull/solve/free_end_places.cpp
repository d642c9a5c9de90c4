#include "taut/hull/solve/free_end_places.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/local_curvature.h"
#include "taut/hull/solve/free_end_roots.h"

namespace taut {
namespace {

using Kind = FreeEnd::Kind;

/// Third derivatives across a plane that are below this, relative to the whole ones or the unit,
/// may be zero.
constexpr double cubic_slack = 1e-9;
/// The same of a curvature on the other side of a join, relative to the principal one.
constexpr double flat_slack = 1e-7;
/// Where a departure is level for a cusp or a zero of the torsion, that is no farther.
constexpr double level_reach = 1e-6;
/// How far rounding may move a root off the end at which it is.
constexpr double root_slack = 1e-11;
/// Share of a direction's rate across a side below which it may lead along that.
constexpr double along_side = 1e-9;
/// What is nearer to a collapsed side is at it.
constexpr double pole_distance = 1e-6;

/// A root may be in [0, 1], up to rounding.
bool is_within(double root) { return root >= -root_slack && root <= 1 + root_slack; }

/// A root where it is surely inside, and at the end where it may be there.
double placed(double root) {
  if (root < root_slack) return 0;
  return root > 1 - root_slack ? 1 : root;
}

const Border& border_at(const ContactGeometry& geometry, const Contact& c, Side side) {
  return geometry.patch(c).borders[std::size_t(side)];
}

bool near_pole(const ContactGeometry& geometry, const Contact& c) {
  return std::any_of(all_sides.begin(), all_sides.end(), [&](Side side) {
    return border_at(geometry, c, side).kind == BorderKind::collapsed &&
           distance_from(c, side) < pole_distance;
  });
}

/// How the surface or curve leaves the plane across n at a border, where it is flat to second
/// order.
enum class Departure { below, level, above };

Departure departure(double cubic, double slack) {
  return cubic < -slack ? Departure::below : cubic > slack ? Departure::above : Departure::level;
}

/// Rate into the patch at a side.
double inward_rate(const SurfaceCurvature& b, Side side) {
  const double across = along_v(side) ? b.rate.x : b.rate.y;
  return at_upper_end(side) ? -across : across;
}

/// Into the patch along the flat direction, to third order.
Departure inward_departure(const SurfaceCurvature& b, Side side) {
  const double cubic = inward_rate(b, side) < 0 ? -b.cubic : b.cubic;
  return departure(cubic, cubic_slack * std::max(1.0, b.third));
}

/// The side over a smooth join where the contact lies.
struct Beyond {
  Contact contact;
  Side side = Side::u0;
};
std::optional<Beyond> beyond_join(const ContactGeometry& geometry, const Contact& c, Side side) {
  const Border& border = border_at(geometry, c, side);
  if (border.kind != BorderKind::smooth) return std::nullopt;
  // Not beyond(): of a seam that is the seam's piece.
  const double t = along_v(side) ? c.v : c.u;
  const Contact neighbor{c.instance, SourceKind::face, border.neighbor, 0, 0};
  return Beyond{on_side_of(neighbor, border.neighbor_side, border.reversed ? 1 - t : t),
                border.neighbor_side};
}

/// Beyond a smooth join, where there is one, the surface leaves the plane as it does on this side;
/// or it bends away.
bool agrees_beyond(const ContactGeometry& geometry, const Contact& c, Side side, Departure own) {
  const std::optional<Beyond> over = beyond_join(geometry, c, side);
  if (!over) return true;
  const std::optional<SurfaceCurvature> b = surface_curvature(geometry, over->contact);
  if (!b) return false;
  return b->flat < flat_slack * b->steep || inward_departure(*b, over->side) == own;
}

/// The contacts of all patches about a smooth corner. None if the contact lies on one side only, or
/// if the corner is on an edge.
std::vector<Contact> about_corner(const ContactGeometry& geometry, const Contact& c) {
  std::vector<Contact> found = about(geometry, c);
  const auto is_corner = [&](const Contact& at) {
    const std::vector<ContactExit> all = exits(geometry, at);
    return std::count_if(all.begin(), all.end(), [&](const ContactExit& exit) {
             return leads_over_border(exit) && stands_at(at, exit) &&
                    beyond_join(geometry, at, all_sides[std::size_t(exit.index)]);
           }) == 2;
  };
  if (!std::all_of(found.begin(), found.end(), is_corner)) found.clear();
  return found;
}

/// The same in a direction from a corner, of the patch into which it leads.
std::optional<Departure> corner_departure(const ContactGeometry& geometry,
                                          const std::vector<Contact>& around, const dvec3& along) {
  for (const Contact& c : around) {
    const std::optional<SurfaceCurvature> b = surface_curvature(geometry, c);
    if (!b) return std::nullopt;
    const double sense = glm::dot(b->along, along) < 0 ? -1 : 1;
    const bool leads_in = std::all_of(all_sides.begin(), all_sides.end(), [&](Side side) {
      return distance_from(c, side) != 0 ||
             sense * inward_rate(*b, side) > -along_side * glm::length(b->rate);
    });
    if (leads_in) {
      return departure(sense * b->cubic, cubic_slack * std::max(1.0, b->third));
    }
  }
  return std::nullopt;
}

/// The root is that at a corner in which the patch is flat to second order, as sheets are whose
/// corner is a planar quad; no generic end. The twist has a double root there: Newton's method,
/// halving its distance, ends no farther than its last step, or where the twist is rounding.
bool is_at_flat_corner(const ContactGeometry& geometry, const Contact& patch, Side side, double t) {
  const double end = t < 0.5 ? 0 : 1;
  const auto bends = [&](double at) {
    const Contact c = on_side_of(patch, side, at);
    const ContactJet j = geometry.jet(c);
    const dvec3 n = unit_normal(geometry, c);
    return glm::abs(dvec3(glm::dot(j.dxx, n), glm::dot(j.dxy, n), glm::dot(j.dyy, n)));
  };
  const dvec3 there = bends(end);
  if (std::max({there.x, there.y, there.z}) > geometry.rounding()) return false;
  return std::abs(t - end) <= noise_step(geometry, on_side_of(patch, side, end)) ||
         bends(0.5 * (t + end)).y <= geometry.rounding();
}

/// From an end of the piece on, to third order.
Departure inward_departure(const CurveCurvature& b, int end, const dvec3& n) {
  const double cubic = glm::dot(b.third, n);
  return departure(end == 0 ? cubic : -cubic, cubic_slack * std::max(1.0, glm::length(b.third)));
}

/// The face between two pieces that end in a common vertex, if a patch has both for sides, is a
/// saddle there.
bool parts_at_corner(const ContactGeometry& geometry, const Contact& a, const Contact& b) {
  for (const ContactGeometry::PieceSide& s : geometry.sides(a)) {
    for (const ContactGeometry::PieceSide& t : geometry.sides(b)) {
      if (s.patch != t.patch || along_v(s.side) == along_v(t.side)) continue;
      const dvec2 uv = on_side(s.side, at_upper_end(t.side) ? 1 : 0);
      const std::optional<SurfaceCurvature> bend =
          surface_curvature(geometry, {a.instance, SourceKind::face, s.patch, uv.x, uv.y});
      if (!bend || bend->flat <= 0) return false;
    }
  }
  return true;
}

/// At a vertex, in the plane of two edges that end there: above it both edges' contacts compete,
/// unless a face's takes over between them.
std::optional<FreeEnd> corner_end(const ContactGeometry& geometry, const Contact& vertex,
                                  const std::array<Contact, 2>& c, double sign) {
  std::array<CurveCurvature, 2> bend;
  std::array<dvec3, 2> away;
  for (std::size_t i = 0; i < 2; ++i) {
    const bool seam = geometry.part(c[i]).pieces()[std::size_t(c[i].element)].edge < 0;
    const std::optional<CurveCurvature> b = curve_curvature(geometry, c[i]);
    if (seam || !b || geometry.is_straight(c[i])) return std::nullopt;
    bend[i] = *b;
    away[i] = c[i].u == 0 ? b->along : -b->along;
  }
  const dvec3 cross = glm::cross(away[0], away[1]);
  if (glm::length(cross) < smooth_join_angle) return std::nullopt;
  const dvec3 n = sign * unit(cross);
  dvec3 along(0.0);
  for (std::size_t i = 0; i < 2; ++i) {
    const double falls = -glm::dot(bend[i].second, n);
    if (falls <= flat_slack * bend[i].curvature) return std::nullopt;
    along += (i == 0 ? -1 : 1) / std::sqrt(falls) * away[i];
  }
  if (!parts_at_corner(geometry, c[0], c[1])) return std::nullopt;
  return FreeEnd{n, vertex, Kind::corner, unit(along)};
}

}  // namespace

double distance_from(const Contact& c, Side side) {
  const double t = along_v(side) ? c.u : c.v;
  return at_upper_end(side) ? 1 - t : t;
}

std::optional<FreeEnd> cusp_end(const ContactGeometry& geometry, const Contact& root) {
  if (!is_within(root.u) || !is_within(root.v)) return std::nullopt;
  Contact c = root;
  c.u = placed(root.u);
  c.v = placed(root.v);
  const std::optional<SurfaceCurvature> b = surface_curvature(geometry, c);
  if (!b || near_pole(geometry, c)) return std::nullopt;
  return FreeEnd{b->n, c, Kind::face, b->along};
}

std::optional<FreeEnd> border_end(const ContactGeometry& geometry, const Contact& patch, Side side,
                                  double t) {
  if (!is_within(t) || is_at_flat_corner(geometry, patch, side, t)) return std::nullopt;
  const Contact c = on_side_of(patch, side, placed(t));
  const std::optional<SurfaceCurvature> b = surface_curvature(geometry, c);
  if (!b || near_pole(geometry, c)) return std::nullopt;
  const std::vector<Contact> around = about_corner(geometry, c);
  std::optional<Departure> own = inward_departure(*b, side);
  if (around.empty()) {
    if (!agrees_beyond(geometry, c, side, *own)) return std::nullopt;
  } else {
    own = corner_departure(geometry, around, b->along);
    if (own != corner_departure(geometry, around, -b->along)) return std::nullopt;
  }
  if (!own || own == Departure::above) return std::nullopt;
  if (own == Departure::level && !cusp_near(geometry, c, level_reach)) return std::nullopt;
  const Contact place = geometry.canonical(c);
  const Kind kind = place.kind == SourceKind::face ? Kind::face : Kind::border;
  return FreeEnd{b->n, place, kind, inward_rate(*b, side) < 0 ? -b->along : b->along};
}

std::optional<FreeEnd> edge_end(const ContactGeometry& geometry, Contact c, double t, double sign) {
  if (!is_within(t)) return std::nullopt;
  c.u = std::clamp(t, 0.0, 1.0);
  const std::optional<CurveCurvature> b = curve_curvature(geometry, c);
  if (!b || b->binormal == dvec3(0.0)) return std::nullopt;
  return FreeEnd{sign * b->binormal, c, Kind::edge, b->along};
}

std::optional<FreeEnd> piece_end(const ContactGeometry& geometry, Contact c, int end, double sign) {
  c.u = end;
  const std::optional<CurveCurvature> b = curve_curvature(geometry, c);
  const std::optional<Contact> over = beyond(geometry, c, {ContactExit::Kind::end, end});
  if (!b || b->binormal == dvec3(0.0) || !over) return std::nullopt;
  const dvec3 n = sign * b->binormal;
  const Departure own = inward_departure(*b, end, n);
  if (own == Departure::above) return std::nullopt;
  if (own == Departure::level) {
    const auto twist = [&](double t) { return twist_at(geometry, c, t); };
    if (!root_near(twist, double(end), level_reach, noise_step(geometry, c))) return std::nullopt;
  }
  const dvec3 along = end == 0 ? b->along : -b->along;
  if (over->kind == SourceKind::vertex) return FreeEnd{n, *over, Kind::end, along};
  const std::optional<CurveCurvature> next = curve_curvature(geometry, *over);
  if (!next) return std::nullopt;
  const bool bends_away = glm::dot(next->second, n) < -flat_slack * next->curvature;
  if (!bends_away && inward_departure(*next, int(over->u), n) != own) return std::nullopt;
  return FreeEnd{n, c, Kind::edge, along};
}

std::vector<FreeEnd> corner_ends(const ContactGeometry& geometry, const Contact& vertex) {
  std::vector<FreeEnd> result;
  const std::vector<Contact> ends = piece_ends(geometry, vertex);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      for (const double sign : {1.0, -1.0}) {
        const auto end = corner_end(geometry, vertex, {ends[i], ends[j]}, sign);
        if (end) result.push_back(*end);
      }
    }
  }
  return result;
}

}  // namespace taut
