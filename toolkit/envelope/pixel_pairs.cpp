#include "taut/envelope/pixel_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Two contacts are on different branches if climbing from each, in the other's direction, ends
/// away from the other: together by more than this times their distance. The share is two for
/// branches that do not meet, and at most one where the one goes on into the other, whether
/// climbing gets across the border between them or stops there.
constexpr double bridging_share = 1.5;

/// Contacts no farther apart, in the scene's frame, are one.
constexpr double least_distance = 1e-9;

constexpr int plane_steps = 6;

/// Contacts of a plane that touches along a curve stay so far apart, in the scene's frame, however
/// near their directions come to the plane's; down to this, in radians.
constexpr double hole_size = 0.05;
constexpr double least_angle = 1e-6;

bool share_node(const GaussTriangles::Triangle& a, const GaussTriangles::Triangle& b) {
  return std::any_of(a.node.begin(), a.node.end(), [&](int node) {
    return std::find(b.node.begin(), b.node.end(), node) != b.node.end();
  });
}

dvec3 to_model(const EnvelopeContent& content, const dvec3& x) {
  return content.scene.frame().to_model(x);
}

/// Both triangles are of one element, side by side: what they show is one surface.
bool are_neighbors(const EnvelopeContent& content, const EnvelopePixel& p, const EnvelopePixel& q) {
  const OffscreenCanvas::Pixel& a = content.at(p);
  const OffscreenCanvas::Pixel& b = content.at(q);
  if (a.element != b.element) return false;
  if (a.triangle == b.triangle) return true;
  if (content.elements.contact(int(a.element)).kind == SourceKind::vertex) return true;
  const GaussTriangles::Triangle& s = content.triangles.triangles[a.triangle];
  const GaussTriangles::Triangle& t = content.triangles.triangles[b.triangle];
  return s.element == t.element && share_node(s, t);
}

dvec3 mean_direction(const EnvelopeContent& content, std::span<const EnvelopePixel> pixels) {
  dvec3 sum(0.0);
  for (const EnvelopePixel& p : pixels) sum += content.direction(p);
  return unit(sum);
}

/// The normal of the plane through the points of a polygon, on the side of n (Newell's).
dvec3 plane_normal(const std::vector<ClimbedContact>& contacts, const dvec3& n) {
  dvec3 sum(0.0);
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const dvec3& a = contacts[k].x - contacts[0].x;
    const dvec3& b = contacts[(k + 1) % contacts.size()].x - contacts[0].x;
    sum += glm::cross(a, b);
  }
  return aligned(unit(sum), n);
}

EnvelopeTriplePoint triple_point(const EnvelopeContent& content, const dvec3& n,
                                 const std::vector<ClimbedContact>& contacts) {
  EnvelopeTriplePoint result{n, {}, {}};
  for (const ClimbedContact& c : contacts) {
    result.contacts.push_back(content.told(c.contact));
    result.points.push_back(to_model(content, c.x));
  }
  return result;
}

}  // namespace

bool is_bridging(const EnvelopeContent& content, const EnvelopePixel& p, const EnvelopePixel& q) {
  if (are_neighbors(content, p, q)) return false;
  const dvec3 m = content.direction(p);
  const dvec3 n = content.direction(q);
  const ClimbedContact a = content.climbed(p);
  const ClimbedContact b = content.climbed(q);
  const double distance = glm::distance(a.x, b.x);
  if (distance <= least_distance) return false;
  const double missed = glm::distance(climb(content.geometry, a.contact, n).x, b.x) +
                        glm::distance(climb(content.geometry, b.contact, m).x, a.x);
  return missed > bridging_share * distance;
}

EnvelopeCurvePoint curve_point(const EnvelopeContent& content, const EnvelopePixel& p,
                               const EnvelopePixel& q) {
  const dvec3 m = content.direction(p);
  const dvec3 n = content.direction(q);
  ClimbedContact a = content.climbed(p);
  ClimbedContact b = content.climbed(q);
  EnvelopeCurvePoint result;
  for (int step = 0; step < 3; ++step) {
    const double at_m = glm::dot(a.x - b.x, m);
    const double at_n = glm::dot(a.x - b.x, n);
    const double t = at_m > at_n ? std::clamp(at_m / (at_m - at_n), 0.0, 1.0) : 0.5;
    result.n = unit((1 - t) * m + t * n);
    a = climb(content.geometry, a.contact, result.n);
    b = climb(content.geometry, b.contact, result.n);
  }
  result.contact = {content.told(a.contact), content.told(b.contact)};
  result.point = {to_model(content, a.x), to_model(content, b.x)};
  return result;
}

std::optional<EnvelopeTriplePoint> common_plane(const EnvelopeContent& content,
                                                std::span<const EnvelopePixel> pixels,
                                                double reach) {
  const dvec3 middle = mean_direction(content, pixels);
  std::vector<ClimbedContact> contacts;
  for (const EnvelopePixel& p : pixels) contacts.push_back(content.climbed(p));
  // Three decide on the plane; further ones are on it, or belong to another one nearby.
  const std::vector<ClimbedContact> first(contacts.begin(), contacts.begin() + 3);
  std::vector<ClimbedContact> three = first;
  dvec3 n = middle;
  for (int step = 0; step < plane_steps; ++step) {
    const dvec3 next = plane_normal(three, n);
    if (next == dvec3(0.0) || glm::distance(next, middle) > reach) return std::nullopt;
    const double moved = glm::distance(next, n);
    n = next;
    for (std::size_t k = 0; k < 3; ++k) {
      three[k] = climb(content.geometry, three[k].contact, n);
    }
    if (moved < 1e-14) break;
  }
  const double tie = 1e-9;
  const auto on_plane = [&](const ClimbedContact& c) { return std::abs(c.h - three[0].h) < tie; };
  if (!on_plane(three[1]) || !on_plane(three[2])) return std::nullopt;
  // Climbs of two may end in one contact, through which and the third there is no one plane.
  for (std::size_t k = 0; k < 3; ++k) {
    if (glm::distance(three[k].x, three[(k + 1) % 3].x) <= least_distance) return std::nullopt;
  }
  for (std::size_t k = 3; k < contacts.size(); ++k) {
    const ClimbedContact c = climb(content.geometry, contacts[k].contact, n);
    if (on_plane(c)) {
      three.push_back(c);
    } else if (c.h > three[0].h) {
      return std::nullopt;
    }
  }
  return triple_point(content, n, three);
}

std::optional<EnvelopeTriplePoint> plane_over_hole(const EnvelopeContent& content,
                                                   std::span<const EnvelopePixel> loop,
                                                   double reach) {
  const dvec3 middle = mean_direction(content, loop);
  std::vector<ClimbedContact> contacts;
  for (const EnvelopePixel& p : loop) contacts.push_back(content.climbed(p));
  const auto spread = [&] {  // no less across than along
    dvec3 area(0.0);
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      area += 0.5 * glm::cross(contacts[k].x - contacts[0].x,
                               contacts[(k + 1) % contacts.size()].x - contacts[0].x);
    }
    return std::sqrt(glm::length(area));
  };
  if (spread() < hole_size) return std::nullopt;
  // Closer and closer about the direction of the plane through them.
  dvec3 n = plane_normal(contacts, middle);
  double angle = glm::distance(content.direction(loop[0]), content.direction(loop[1]));
  for (; angle > least_angle; angle *= 0.25) {
    if (n == dvec3(0.0) || glm::distance(n, middle) > reach) return std::nullopt;
    const auto [e0, e1] = tangent_frame(n);
    const std::array<dvec3, 4> around = {e0, e1, -e0, -e1};
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      contacts[k] = climb(content.geometry, contacts[k].contact, unit(n + angle * around[k % 4]));
    }
    if (spread() < hole_size) return std::nullopt;
    n = plane_normal(contacts, n);
  }
  return triple_point(content, n, contacts);
}

}  // namespace taut
