#include "taut/bounds/repeated_elements.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "taut/surface/bezier.h"

namespace taut {
namespace {

dvec3 middle(const PlacedElement& e) {
  dvec3 sum(0.0);
  for (const dvec4& p : e.points) sum += euclidean(p);
  return sum / double(e.points.size());
}

/// The control point of `e` that a symmetry of the parameters takes to place (i, j).
const dvec4& point_at(const PlacedElement& e, int i, int j, bool swapped, bool reversed_u,
                      bool reversed_v) {
  if (swapped) std::swap(i, j);
  if (reversed_u) i = e.degree_u - i;
  if (reversed_v) j = e.degree_v - j;
  return e.points[std::size_t(i) * std::size_t(e.degree_v + 1) + std::size_t(j)];
}

/// How far their control points are apart, if no farther than the tolerance and of the same
/// weights.
std::optional<double> apart(const PlacedElement& a, const PlacedElement& b, bool swapped,
                            bool reversed_u, bool reversed_v, double tolerance) {
  const int p = swapped ? b.degree_v : b.degree_u;
  const int q = swapped ? b.degree_u : b.degree_v;
  if (a.degree_u != p || a.degree_v != q) return std::nullopt;
  double largest = 0;
  const double factor = a.points.front().w / point_at(b, 0, 0, swapped, reversed_u, reversed_v).w;
  for (int i = 0; i <= p; ++i) {
    for (int j = 0; j <= q; ++j) {
      const dvec4& x = point_at(a, i, j, false, false, false);
      const dvec4& y = point_at(b, i, j, swapped, reversed_u, reversed_v);
      const double distance = glm::distance(euclidean(x), euclidean(y));
      if (!(distance <= tolerance) || !(std::abs(x.w - factor * y.w) <= tolerance * x.w)) {
        return std::nullopt;
      }
      largest = std::max(largest, distance);
    }
  }
  return largest;
}

}  // namespace

RepeatedElements::RepeatedElements(const std::vector<PlacedElement>& elements, double tolerance) {
  std::vector<dvec3> middles;
  middles.reserve(elements.size());
  for (const PlacedElement& e : elements) middles.push_back(middle(e));
  std::vector<std::size_t> order(elements.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(middles[a].x, a) < std::pair(middles[b].x, b);
  });
  const auto compare = [&](std::size_t a, std::size_t b) {
    const PlacedElement& first = elements[std::min(a, b)];
    const PlacedElement& other = elements[std::max(a, b)];
    const Key key(int(other.kind), other.instance, other.element);
    if (first.kind != other.kind || repeats_.contains(key)) return;
    for (unsigned symmetry = 0; symmetry < 8; ++symmetry) {
      const bool swapped = (symmetry & 4) != 0;
      const bool reversed_u = (symmetry & 1) != 0;
      const bool reversed_v = (symmetry & 2) != 0;
      if (const auto found = apart(first, other, swapped, reversed_u, reversed_v, tolerance)) {
        farthest_ = std::max(farthest_, *found);
        repeats_[key] = {first.instance, first.element, swapped, reversed_u, reversed_v};
        return;
      }
    }
  };
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const dvec3 off = glm::abs(middles[order[j]] - middles[order[i]]);
      if (off.x > tolerance) break;
      if (off.y <= tolerance && off.z <= tolerance) compare(order[i], order[j]);
    }
  }
}

Contact RepeatedElements::first(const Contact& c) const {
  if (empty()) return c;
  Contact at = c;
  // Copies of copies, too.
  for (auto found = repeats_.find(key(at)); found != repeats_.end();
       found = repeats_.find(key(at))) {
    const Repeat& r = found->second;
    double u = r.reversed_u ? 1 - at.u : at.u;
    double v = r.reversed_v ? 1 - at.v : at.v;
    if (r.swapped) std::swap(u, v);
    at = {r.instance, c.kind, r.element, u, v};
  }
  if (const auto place = places_.find(key(at)); place != places_.end()) return place->second;
  if (c.kind == SourceKind::vertex) at.u = at.v = 0;
  if (c.kind == SourceKind::edge) at.v = 0;
  return at;
}

bool RepeatedElements::reversed(const Contact& c) const {
  Contact low = c;
  low.u = 0;
  return first(low).u != 0;
}

std::vector<Contact> RepeatedElements::all() const {
  std::vector<Contact> result;
  result.reserve(repeats_.size());
  for (const auto& entry : repeats_) {
    const auto& [kind, instance, element] = entry.first;
    result.push_back({instance, SourceKind(kind), element, 0, 0});
  }
  return result;
}

}  // namespace taut
