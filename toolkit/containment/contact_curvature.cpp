#include "taut/containment/contact_curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "taut/bounds/scene_content.h"

namespace taut {
namespace {

/// A parameter closer to its end, and a slope against its tangent's length, that are as good as
/// none for a step that queries check anyway.
constexpr double at_end = 1e-12;
constexpr double no_slope = 1e-9;
/// A determinant of B smaller than this share of its diagonal's product is that of a flat contact.
constexpr double flat = 1e-9;

/// Longest step, as the tangent of its angle; Newton's method is local.
constexpr double longest_step = 0.5;
/// Contacts whose predictions differ by less than this share of what their points do are one.
constexpr double same_contact = 0.25;
constexpr double same_contact_point = 1e-7;
/// Weights may be rounded below zero.
constexpr double least_weight = -1e-6;

/// Tangents and second derivatives of x . n by the contact's free parameters.
struct FreeJet {
  int dimension = 0;
  std::array<dvec3, 2> tangent = {dvec3(0.0), dvec3(0.0)};
  double uu = 0, uv = 0, vv = 0;
};

bool pressed(double parameter, double slope, double length) {
  if (parameter <= at_end) return slope < -no_slope * length;
  return parameter >= 1 - at_end && slope > no_slope * length;
}

FreeJet patch_jet(const BezierPatch& patch, const Contact& c, const dvec3& n) {
  const PatchJet2 j = jet2(patch, c.u, c.v);
  FreeJet free;
  const bool u = !pressed(c.u, glm::dot(j.Su, n), glm::length(j.Su));
  const bool v = !pressed(c.v, glm::dot(j.Sv, n), glm::length(j.Sv));
  free.dimension = int(u) + int(v);
  free.tangent = {u ? j.Su : j.Sv, j.Sv};
  free.uu = glm::dot(u ? j.Suu : j.Svv, n);
  free.uv = glm::dot(j.Suv, n);
  free.vv = glm::dot(j.Svv, n);
  return free;
}

FreeJet piece_jet(const BezierCurve& curve, const Contact& c, const dvec3& n) {
  const CurveJet j = jet(curve, c.u);
  FreeJet free;
  if (pressed(c.u, glm::dot(j.ct, n), glm::length(j.ct))) return free;
  free.dimension = 1;
  free.tangent[0] = j.ct;
  free.uu = glm::dot(j.ctt, n);
  return free;
}

/// -J B^-1 J^T.
std::optional<dmat3> hessian(const FreeJet& j) {
  const dvec3& a = j.tangent[0];
  const dvec3& b = j.tangent[1];
  if (j.dimension == 0) return dmat3(0.0);
  if (!(j.uu < 0)) return std::nullopt;
  if (j.dimension == 1) return glm::outerProduct(a, a) / -j.uu;
  const double det = j.uu * j.vv - j.uv * j.uv;
  if (!(det > flat * j.uu * j.vv)) return std::nullopt;
  return (glm::outerProduct(a, a) * -j.vv + glm::outerProduct(b, b) * -j.uu +
          (glm::outerProduct(a, b) + glm::outerProduct(b, a)) * j.uv) /
         det;
}

/// Solves the first `size` equations by elimination with pivots; false if they are singular.
template <std::size_t N>
bool solve(std::array<std::array<double, N + 1>, N>& m, int size) {
  for (int k = 0; k < size; ++k) {
    int pivot = k;
    for (int i = k + 1; i < size; ++i) {
      if (std::abs(m[std::size_t(i)][std::size_t(k)]) >
          std::abs(m[std::size_t(pivot)][std::size_t(k)])) {
        pivot = i;
      }
    }
    std::swap(m[std::size_t(k)], m[std::size_t(pivot)]);
    const auto& row = m[std::size_t(k)];
    if (!(std::abs(row[std::size_t(k)]) > 0)) return false;
    for (int i = 0; i < size; ++i) {
      if (i == k) continue;
      auto& other = m[std::size_t(i)];
      const double factor = other[std::size_t(k)] / row[std::size_t(k)];
      for (std::size_t j = std::size_t(k); j <= N; ++j) other[j] -= factor * row[j];
    }
  }
  for (int k = 0; k < size; ++k) m[std::size_t(k)][N] /= m[std::size_t(k)][std::size_t(k)];
  return true;
}

/// The contacts with those left out that repeat another; the one supporting nearer to n stays.
std::vector<CurvedContact> distinct(std::span<const CurvedContact> contacts, const dvec3& n) {
  std::vector<CurvedContact> kept;
  for (const CurvedContact& c : contacts) {
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const CurvedContact& k) {
      return glm::distance(k.point_at(n), c.point_at(n)) <
             same_contact * glm::distance(k.point, c.point) + same_contact_point;
    });
    if (same == kept.end()) {
      kept.push_back(c);
      continue;
    }
    const double weight = same->weight + c.weight;
    if (glm::dot(c.n, n) > glm::dot(same->n, n)) *same = c;
    same->weight = weight;
  }
  if (kept.size() > 3) {
    std::sort(kept.begin(), kept.end(),
              [](const CurvedContact& a, const CurvedContact& b) { return a.weight > b.weight; });
    kept.resize(3);
  }
  return kept;
}

/// Tangents at n, the first towards a second contact: the step along it is what makes both support,
/// and rounding of it must not get into the step across, which may be all but free.
std::array<dvec3, 2> step_frame(const std::vector<CurvedContact>& active, const dvec3& n) {
  if (active.size() < 2) return tangent_frame(n);
  const dvec3 between = active[1].point_at(n) - active[0].point_at(n);
  const dvec3 along = unit(between - glm::dot(between, n) * n);
  if (along == dvec3(0.0)) return tangent_frame(n);
  return {along, glm::cross(n, along)};
}

}  // namespace

std::optional<dmat3> support_hessian(const Scene& scene, const Contact& contact, const dvec3& n) {
  if (contact.kind == SourceKind::vertex) return dmat3(0.0);
  const Instance& instance = scene.model().instances()[std::size_t(contact.instance)];
  const Part& part = scene.model().parts()[std::size_t(instance.part)];
  const dmat3& rotation = instance.pose.rotation;
  const dvec3 local = n * rotation;
  const auto element = std::size_t(contact.element);
  const FreeJet j = contact.kind == SourceKind::face
                        ? patch_jet(part.patches()[element].bezier, contact, local)
                        : piece_jet(part.pieces()[element].bezier, contact, local);
  const std::optional<dmat3> h = hessian(j);
  if (!h) return std::nullopt;
  return rotation * *h * glm::transpose(rotation) * scene.frame().scale;
}

std::optional<dvec3> projection_step(std::span<const CurvedContact> contacts, const dvec3& x,
                                     const dvec3& n, double regular) {
  std::vector<CurvedContact> active = distinct(contacts, n);
  while (!active.empty()) {
    const int count = int(active.size());
    const auto tangents = step_frame(active, n);
    const auto flat_part = [&](const dvec3& v) {
      return dvec2(glm::dot(v, tangents[0]), glm::dot(v, tangents[1]));
    };
    double total = 0;
    for (const CurvedContact& c : active) total += c.weight;
    // (sum l_i H_i + (x . n - h) I) d + sum l'_i D_i = r,   D_i . d = h_0 - h_i.
    const dvec3 first = active[0].point_at(n);
    const double first_value = active[0].value_at(n);
    std::array<std::array<double, 5>, 4> m{};
    double height = 0;
    for (int i = 0; i < count; ++i) {
      const CurvedContact& c = active[std::size_t(i)];
      const double share = c.weight / total;
      height += share * (glm::dot(x, n) - c.value_at(n));
      for (std::size_t k = 0; k < 2; ++k) {
        const dvec2 column = flat_part(c.hessian * tangents[k]);
        m[0][k] += share * column.x;
        m[1][k] += share * column.y;
      }
      if (i == 0) continue;
      const dvec2 d = flat_part(c.point_at(n) - first);
      const auto row = std::size_t(i + 1);
      m[row][0] = m[0][row] = d.x;
      m[row][1] = m[1][row] = d.y;
      m[row][4] = first_value - c.value_at(n);
    }
    const double least = regular * (std::abs(m[0][0]) + std::abs(m[1][1]));
    m[0][0] += height + least;
    m[1][1] += height + least;
    const dvec2 r = flat_part(x - first);
    m[0][4] = r.x;
    m[1][4] = r.y;
    if (!solve<4>(m, count + 1)) return std::nullopt;

    double first_weight = 1;
    double lowest = least_weight;
    int out = -1;
    for (int i = 1; i < count; ++i) {
      const double weight = m[std::size_t(i + 1)][4];
      first_weight -= weight;
      if (weight < lowest) {
        lowest = weight;
        out = i;
      }
    }
    if (count > 1 && first_weight < lowest) out = 0;
    if (out >= 0) {
      active.erase(active.begin() + out);
      continue;
    }
    const dvec2 step(m[0][4], m[1][4]);
    if (!(glm::length(step) < longest_step)) return std::nullopt;
    return unit(n + step.x * tangents[0] + step.y * tangents[1]);
  }
  return std::nullopt;
}

}  // namespace taut
