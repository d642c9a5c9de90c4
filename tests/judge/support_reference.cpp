#include "support_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace taut_test {
namespace {

/// Samples a span of knots are so many times its degree, and at least this many.
constexpr int sampled_degrees = 3;
constexpr int least_samples = 4;
/// Samples, far from each other, from which searches begin, and the best that they are taken from.
constexpr std::size_t starts = 6;
/// Samples from which the places of a point are sought: many elements may pass by it.
constexpr std::size_t places = 24;
constexpr std::size_t most_looked = 200;
/// Shares of the distance between samples: of the first step of a way that is to leave no valley
/// out, and of the last one.
constexpr double first_share = 1e-3;
constexpr double least_share = 1e-11;
constexpr int search_limit = 6000;
/// Elements that a way leads over at most.
constexpr int most_crossings = 8;

constexpr std::size_t most_points = 32;

/// The point of a row of control points at t, by de Boor's triangle. @pre degree < most_points
template <class Point>
dvec4 de_boor(int degree, const std::vector<double>& knots, double t, const Point& point) {
  const int count = int(knots.size()) - degree - 1;
  int span = degree;
  while (span + 1 < count && t >= knots[std::size_t(span) + 1]) ++span;
  std::array<dvec4, most_points> d;
  for (int j = 0; j <= degree; ++j) d[std::size_t(j)] = point(span - degree + j);
  for (int r = 1; r <= degree; ++r) {
    for (int j = degree; j >= r; --j) {
      const double lower = knots[std::size_t(span - degree + j)];
      const double upper = knots[std::size_t(span + 1 + j - r)];
      const double share = upper > lower ? (t - lower) / (upper - lower) : 0;
      d[std::size_t(j)] = (1 - share) * d[std::size_t(j) - 1] + share * d[std::size_t(j)];
    }
  }
  return d[std::size_t(degree)];
}

/// Parameters over the spans of knots.
std::vector<double> sampled(int degree, const std::vector<double>& knots) {
  const int count = std::max(least_samples, sampled_degrees * degree);
  std::vector<double> result;
  for (std::size_t k = std::size_t(degree); k + std::size_t(degree) + 1 < knots.size(); ++k) {
    if (!(knots[k + 1] > knots[k])) continue;
    for (int i = 0; i < count; ++i) {
      result.push_back(knots[k] + (knots[k + 1] - knots[k]) * i / count);
    }
  }
  result.push_back(knots[knots.size() - std::size_t(degree) - 1]);
  return result;
}

}  // namespace

SupportReference::SupportReference(const Shape& shape) {
  for (const auto& s : shape.surfaces) {
    add({{s.degree_u, s.degree_v}, {s.knots_u, s.knots_v}, s.points, {}});
  }
  for (const auto& c : shape.curves) add({{c.degree, 0}, {c.knots, {}}, c.points, {}});
  for (const dvec3& p : shape.points) add({{0, 0}, {}, {dvec4(p, 1.0)}, {}});
  taut::Box box;
  for (const Place& p : samples_) box.include(p.x);
  diagonal_ = taut::diagonal(box);
}

void SupportReference::add(Element element) {
  std::array<std::vector<double>, 2> at;
  for (std::size_t k = 0; k < 2; ++k) {
    at[k] = element.knots[k].empty() ? std::vector<double>{0.0}
                                     : sampled(element.degree[k], element.knots[k]);
    element.domain[0][int(k)] = at[k].front();
    element.domain[1][int(k)] = at[k].back();
  }
  const auto step = [](const std::vector<double>& t, std::size_t i) {
    if (t.size() < 2) return 0.0;
    return i + 1 < t.size() ? t[i + 1] - t[i] : t[i] - t[i - 1];
  };
  for (std::size_t i = 0; i < at[0].size(); ++i) {
    for (std::size_t j = 0; j < at[1].size(); ++j) {
      const dvec2 uv(at[0][i], at[1][j]);
      samples_.push_back(
          {elements_.size(), uv, dvec2(step(at[0], i), step(at[1], j)), evaluate(element, uv)});
    }
  }
  elements_.push_back(std::move(element));
}

dvec3 SupportReference::evaluate(const Element& e, const dvec2& at) {
  const auto row = [&](int i) {
    if (e.knots[1].empty()) return e.points[std::size_t(i)];
    const std::size_t width = e.knots[1].size() - std::size_t(e.degree[1]) - 1;
    return de_boor(e.degree[1], e.knots[1], at.y,
                   [&](int j) { return e.points[std::size_t(i) * width + std::size_t(j)]; });
  };
  return taut::euclidean(e.knots[0].empty() ? e.points.front()
                                            : de_boor(e.degree[0], e.knots[0], at.x, row));
}

SupportReference::Place SupportReference::climbed(
    Place place, double share, const std::function<double(const dvec3&)>& height) const {
  const Element& e = elements_[place.element];
  double h = height(place.x);
  int looked = 0;
  for (; share > least_share && looked < search_limit;) {
    Place best = place;
    for (const double du : {-1.0, 0.0, 1.0}) {
      for (const double dv : {-1.0, 0.0, 1.0}) {
        const dvec2 step = share * place.step * dvec2(du, dv);
        const dvec2 to = glm::clamp(place.at + step, e.domain[0], e.domain[1]);
        if (to == place.at) continue;
        const dvec3 x = evaluate(e, to);
        ++looked;
        if (!(height(x) > h)) continue;
        h = height(x);
        best.at = to;
        best.x = x;
      }
    }
    share = best.at == place.at ? 0.5 * share : std::min(1.0, 2 * share);
    place = best;
  }
  return place;
}

std::vector<const SupportReference::Place*> SupportReference::highest(
    std::size_t count, const std::function<double(const dvec3&)>& height) const {
  std::vector<std::pair<double, const Place*>> order;
  order.reserve(samples_.size());
  for (const Place& place : samples_) order.emplace_back(height(place.x), &place);
  const std::size_t looked = std::min<std::size_t>(most_looked, order.size());
  std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(looked), order.end(),
                    [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<const Place*> result;
  for (std::size_t k = 0; k < looked && result.size() < count; ++k) {
    const Place& place = *order[k].second;
    const bool beside = std::any_of(result.begin(), result.end(), [&](const Place* other) {
      const dvec2 off = glm::abs(other->at - place.at);
      return other->element == place.element && off.x <= 1.01 * place.step.x &&
             off.y <= 1.01 * place.step.y;
    });
    if (!beside) result.push_back(&place);
  }
  return result;
}

SupportReference::Top SupportReference::operator()(const dvec3& n) const {
  const auto height = [&](const dvec3& x) { return glm::dot(x, n); };
  Top top{dvec3(0.0), -taut::infinity};
  for (const Place* from : highest(starts, height)) {
    const Place there = climbed(*from, 1, height);
    if (height(there.x) > top.h) top = {there.x, height(there.x)};
  }
  return top;
}

double SupportReference::climbed_from(const dvec3& x, const dvec3& n, double within) const {
  const auto height = [&](const dvec3& y) { return glm::dot(y, n); };
  Top top{x, -taut::infinity};
  for (int crossing = 0; crossing < most_crossings; ++crossing) {
    const dvec3 from = top.x;
    const double before = top.h;
    const auto nearness = [&](const dvec3& y) { return -glm::distance(from, y); };
    for (const Place* near : highest(places, nearness)) {
      const Place start = climbed(*near, 1, nearness);
      if (-nearness(start.x) > within) continue;
      const Place there = climbed(start, first_share, height);
      if (height(there.x) > top.h) top = {there.x, height(there.x)};
    }
    if (!(top.h > before + within)) break;
  }
  return top.h;
}

}  // namespace taut_test
