#include "taut/hull/contact/supporting_poles.h"

#include "taut/bounds/poles.h"

namespace taut {

std::vector<SupportingPole> supporting_poles(const ContactGeometry& geometry, SupportQuery& query) {
  std::vector<SupportingPole> result;
  const Model& model = geometry.scene().model();
  for (const int i : geometry.scene().distinct_instances()) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    for (int p = 0; p < int(part.patches().size()); ++p) {
      for (const Side side : all_sides) {
        Contact c{i, SourceKind::face, p, 0.5, 0.5};
        if (!is_pole(geometry, c, side) || geometry.is_repeated(c)) continue;
        (along_v(side) ? c.u : c.v) = at_upper_end(side) ? 1 : 0;
        const dvec3 normal = unit_normal(geometry, c);
        if (normal == dvec3(0.0)) continue;
        const dvec3 x = geometry.point(c);
        const double turn = pole_turn(geometry, c);
        for (const dvec3& n : {normal, -normal}) {
          if (query(n, c).h > glm::dot(x, n) + geometry.tie() + turn) continue;
          result.push_back({n, c, turn});
        }
      }
    }
  }
  return result;
}

bool is_landmark(std::span<const Landmark> landmarks, const dvec3& n) {
  return std::any_of(landmarks.begin(), landmarks.end(),
                     [&](const Landmark& l) { return glm::distance(l.n, n) < same_plane; });
}

std::optional<Landmark> facet_at_pole(const ContactGeometry& geometry, SupportQuery& query,
                                      const SupportingPole& pole) {
  const auto facet = [&](const dvec3& normal, double slack) {
    std::optional<FacetContacts> f =
        facet_contacts(geometry, query, normal, {pole.contact}, {}, slack);
    return f && f->contacts.size() >= 3 ? f : std::nullopt;
  };
  std::optional<FacetContacts> f = facet(pole.n, pole.turn);
  if (!f || pole.turn < geometry.tie())
    return f ? std::optional(Landmark{pole.n, *f}) : std::nullopt;
  dvec3 normal = polygon_normal(f->points);
  if (glm::dot(normal, pole.n) < 0) normal = -normal;
  f = facet(normal, 0);
  return f ? std::optional(Landmark{normal, *f}) : std::nullopt;
}

}  // namespace taut
