#include "taut/envelope/contact_climb.h"

#include <algorithm>
#include <cmath>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

constexpr int step_limit = 30;
constexpr int crossing_limit = 64;
/// A step in the parameters after which a further one is below rounding.
constexpr double last_step = 1e-9;
/// Where the value is not concave, steps go uphill by so much of the patch.
constexpr double uphill_step = 0.05;
/// A rise of the value that is more than rounding, in the scene's frame.
constexpr double least_gain = 16 * rounding_unit;

struct Place {
  Contact contact;
  ContactJet jet;
  double h;
};

Place place_at(const ContactGeometry& geometry, const Contact& c, const dvec3& n) {
  Place p{c, geometry.jet(c), 0};
  p.h = glm::dot(p.jet.x, n);
  return p;
}

/// The parameter is at an end of [0, 1] and the value grows beyond.
bool is_held(double parameter, double slope) {
  return (parameter == 0 && slope <= 0) || (parameter == 1 && slope >= 0);
}

/// The step towards the maximum in one parameter.
double step_of(double slope, double second) {
  if (second < 0) return std::clamp(-slope / second, -1.0, 1.0);
  return slope > 0 ? uphill_step : slope < 0 ? -uphill_step : 0;
}

/// The step towards the maximum, with parameters that are held left as they are.
dvec2 step_from(const Place& p, const dvec3& n) {
  const dvec2 slope(glm::dot(p.jet.dx[0], n), glm::dot(p.jet.dx[1], n));
  const double uu = glm::dot(p.jet.dxx, n);
  const double uv = glm::dot(p.jet.dxy, n);
  const double vv = glm::dot(p.jet.dyy, n);
  const bool u_held = is_held(p.contact.u, slope.x);
  const bool v_held = p.jet.dimension < 2 || is_held(p.contact.v, slope.y);
  if (u_held && v_held) return dvec2(0.0);
  if (u_held) return {0, step_of(slope.y, vv)};
  if (v_held) return {step_of(slope.x, uu), 0};
  const double det = uu * vv - uv * uv;
  if (uu < 0 && vv < 0 && det > 1e-14 * uu * vv) {
    return dvec2(uv * slope.y - vv * slope.x, uv * slope.x - uu * slope.y) / det;
  }
  return {step_of(slope.x, uu), step_of(slope.y, vv)};
}

/// To the maximum on the contact's own patch or piece.
Place climb_element(const ContactGeometry& geometry, Place p, const dvec3& n) {
  for (int k = 0; k < step_limit; ++k) {
    dvec2 step = step_from(p, n);
    if (step == dvec2(0.0)) break;
    Place next = p;
    bool higher = false;
    for (int halving = 0; halving < 8 && !higher; ++halving, step *= 0.25) {
      Contact c = p.contact;
      c.u = std::clamp(c.u + step.x, 0.0, 1.0);
      c.v = std::clamp(c.v + step.y, 0.0, 1.0);
      next = place_at(geometry, c, n);
      higher = next.h >= p.h - least_gain;
    }
    if (!higher) break;
    const double moved =
        std::max(std::abs(next.contact.u - p.contact.u), std::abs(next.contact.v - p.contact.v));
    p = next;
    if (moved < last_step) break;
  }
  return p;
}

/// Where the pieces that end in the vertex begin.
void add_pieces(const ContactGeometry& geometry, const Contact& vertex,
                std::vector<Contact>& result) {
  for (const ContactGeometry::PieceEnd& end : geometry.ends(vertex)) {
    const int instance = end.instance >= 0 ? end.instance : vertex.instance;
    const Contact next{instance, SourceKind::edge, end.piece, double(end.end), 0};
    if (!geometry.is_straight(next)) result.push_back(next);
  }
}

/// The same place on the patches that have the piece for a border, and the pieces that go on from
/// it at an end that holds the contact back.
void add_sides(const ContactGeometry& geometry, const Place& p, const dvec3& n,
               std::vector<Contact>& result) {
  const Contact& c = p.contact;
  for (const ContactGeometry::PieceSide& side : geometry.sides(c)) {
    const int instance = side.instance >= 0 ? side.instance : c.instance;
    const dvec2 uv = on_side(side.side, side.reversed ? 1 - c.u : c.u);
    result.push_back({instance, SourceKind::face, side.patch, uv.x, uv.y});
  }
  const EdgePiece& piece = geometry.part(c).pieces()[std::size_t(c.element)];
  const double slope = glm::dot(p.jet.dx[0], n);
  for (const int end : {0, 1}) {
    const int next = piece.end_neighbor[std::size_t(end)];
    if (c.u != end || next < 0 || !is_held(c.u, slope)) continue;
    const EdgePiece& other = geometry.part(c).pieces()[std::size_t(next)];
    const bool at_start = other.end_neighbor[0] == c.element && (next != c.element || end == 1);
    result.push_back({c.instance, SourceKind::edge, next, at_start ? 0.0 : 1.0, 0});
  }
}

/// Where the value may grow on: beyond the patch's sides that hold the contact back, from an edge
/// onto its patches, and from a vertex onto its edges.
std::vector<Contact> beyond(const ContactGeometry& geometry, const Place& p, const dvec3& n) {
  std::vector<Contact> result;
  if (p.contact.kind != SourceKind::face && geometry.is_repeated(p.contact)) return result;
  if (p.contact.kind == SourceKind::vertex) add_pieces(geometry, p.contact, result);
  if (p.contact.kind == SourceKind::edge) add_sides(geometry, p, n, result);
  if (p.contact.kind != SourceKind::face) return result;
  const Patch& patch = geometry.patch(p.contact);
  for (const Side side : all_sides) {
    const double across = along_v(side) ? p.contact.u : p.contact.v;
    const double slope = glm::dot(p.jet.dx[along_v(side) ? 0 : 1], n);
    const Border& border = patch.borders[std::size_t(side)];
    const bool on_side = across == (at_upper_end(side) ? 1.0 : 0.0);
    if (!on_side || border.neighbor < 0 || !is_held(across, slope)) continue;
    const double t = along_v(side) ? p.contact.v : p.contact.u;
    const dvec2 uv = taut::on_side(border.neighbor_side, border.reversed ? 1 - t : t);
    const Contact next{p.contact.instance, SourceKind::face, border.neighbor, uv.x, uv.y};
    if (!geometry.is_ruled(next)) result.push_back(next);
  }
  return result;
}

}  // namespace

ClimbedContact climb(const ContactGeometry& geometry, const Contact& start, const dvec3& n) {
  Place best = climb_element(geometry, place_at(geometry, start, n), n);
  for (int crossing = 0; crossing < crossing_limit; ++crossing) {
    bool higher = false;
    for (const Contact& next : beyond(geometry, best, n)) {
      const Place other = climb_element(geometry, place_at(geometry, next, n), n);
      if (!(other.h > best.h + least_gain)) continue;
      best = other;
      higher = true;
      break;
    }
    if (!higher) break;
  }
  return {geometry.canonical(best.contact), best.contact, best.jet.x, best.h};
}

}  // namespace taut
