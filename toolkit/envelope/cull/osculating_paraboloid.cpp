#include "taut/envelope/cull/osculating_paraboloid.h"

#include <cmath>

namespace taut {
namespace {

/// The fall to one side of a cell as a share of that to another below which it counts as none.
constexpr double flat_share = 1e-10;

}  // namespace

std::optional<OsculatingParaboloid> OsculatingParaboloid::about(const ConcavePatch& patch,
                                                                const dvec2& p, const dvec3& axis) {
  const PatchJet2 jet = jet2(patch.bezier(), p.x, p.y);
  dvec3 n = glm::cross(jet.Su, jet.Sv);
  const double volume = glm::dot(n, axis);
  n *= std::copysign(1 / glm::length(n), volume);
  const bool falls = !patch.stand_in();
  const double uu = falls ? -glm::dot(jet.Suu, n) : glm::dot(jet.Su, jet.Su);
  const double uv = falls ? -glm::dot(jet.Suv, n) : glm::dot(jet.Su, jet.Sv);
  const double vv = falls ? -glm::dot(jet.Svv, n) : glm::dot(jet.Sv, jet.Sv);
  const double rest = vv - uv * uv / uu;
  if (!(uu > 0 && rest > flat_share * vv)) return {};
  const dvec3 to_u = glm::cross(jet.Sv, axis) / volume;
  const dvec3 to_v = glm::cross(axis, jet.Su) / volume;
  OsculatingParaboloid map;
  map.center_ = jet.S;
  map.uu_ = std::sqrt(uu);
  map.uv_ = uv / map.uu_;
  map.vv_ = std::sqrt(rest);
  map.x_ = map.uu_ * to_u + map.uv_ * to_v;
  map.y_ = map.vv_ * to_v;
  return map;
}

dvec2 OsculatingParaboloid::step(const dvec2& to) const {
  const double dv = to.y / vv_;
  return {(to.x - uv_ * dv) / uu_, dv};
}

}  // namespace taut
