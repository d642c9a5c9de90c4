#include "taut/hull/trace/free_end_seeds.h"

#include <array>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/poles.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/trace/partings.h"

namespace taut {
namespace {

/// Distances of two contacts that have parted from a free end, the first that are found count; and
/// how far from the end they are at most, in units of these.
constexpr std::array<double, 4> parted_lengths = {8e-3, 4e-3, 1e-3, 2.5e-4};
constexpr double parted_reach = 64;
/// How far aside from the end they are sought, in the same units: along a join between patches
/// contacts part slowly.
constexpr std::array<double, 7> parted_aside = {0, 4, -4, 12, -12, 32, -32};

/// The contact moved along its smooth surface by a tangent, over the join at which it stands if the
/// tangent leads there. None if it does not stay in a patch.
std::optional<Contact> moved(const ContactGeometry& geometry, const Contact& c, const dvec3& by) {
  std::vector<Contact> elements = {c};
  for (const ContactExit& exit : exits(geometry, c)) {
    const std::optional<Contact> over = beyond(geometry, c, exit);
    if (over && over->kind == SourceKind::face &&
        glm::distance(geometry.point(*over), geometry.point(c)) < same_branch_distance) {
      elements.push_back(*over);
    }
  }
  for (Contact own : elements) {
    const ContactJet j = geometry.jet(own);
    const dvec2 r(glm::dot(j.dx[0], by), glm::dot(j.dx[1], by));
    const double uu = glm::dot(j.dx[0], j.dx[0]);
    const double uv = glm::dot(j.dx[0], j.dx[1]);
    const double vv = glm::dot(j.dx[1], j.dx[1]);
    const double det = uu * vv - uv * uv;
    if (!(det > 0)) continue;
    own.u += (vv * r.x - uv * r.y) / det;
    own.v += (uu * r.y - uv * r.x) / det;
    if (own.u >= 0 && own.u <= 1 && own.v >= 0 && own.v <= 1) return own;
  }
  return std::nullopt;
}

/// Two contacts of one surface that have parted from the free end by so much, sought about a point
/// that lies so many times as far aside.
std::optional<CommonSupport> parted(const ContactSystem& system, SupportQuery& query,
                                    const FreeEnd& end, double length, double aside) {
  if (end.kind != FreeEnd::Kind::face) return std::nullopt;
  const dvec3 middle = aside * length * glm::cross(end.n, end.along);
  const ContactGeometry& geometry = system.geometry();
  CommonSupport s;
  for (const double sense : {-0.5, 0.5}) {
    const auto c = moved(geometry, end.contact, middle + sense * length * end.along);
    if (!c) return std::nullopt;
    s.add(geometry, *c);
    s.n += aligned(unit_normal(geometry, *c), end.n);
  }
  s.n = glm::normalize(s.n);
  const dvec3 x = geometry.point(end.contact);
  const bool found =
      system.settle(s, [&](const CommonSupport& now) { return distance_equation(now, length); });
  const auto in_element = [](double t) { return t >= 0 && t <= 1; };
  for (std::size_t i = 0; found && i < 2; ++i) {
    if (!in_element(s.contact[i].u) || !in_element(s.contact[i].v)) return std::nullopt;
    if (glm::distance(s.jet[i].x, x) > parted_reach * length) return std::nullopt;
  }
  if (!found || query(s.n, s.contact[0]).h > glm::dot(s.jet[0].x, s.n) + geometry.tie()) {
    return std::nullopt;
  }
  return s;
}

}  // namespace

void visit_parted(const ContactSystem& system, SupportQuery& query, const FreeEnd& end,
                  const std::function<bool(const CommonSupport&)>& visit) {
  for (const double length : parted_lengths) {
    for (const double aside : parted_aside) {
      const std::optional<CommonSupport> s = parted(system, query, end, length, aside);
      if (s && visit(*s)) return;
    }
  }
}

}  // namespace taut
