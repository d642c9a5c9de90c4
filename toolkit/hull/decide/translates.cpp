#include "taut/hull/decide/translates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "taut/core/nearest_in_simplex.h"

namespace taut {
namespace {

/// Steps of the search for the nearest point of a convex hull; it ends where it gains nothing.
constexpr int nearest_step_limit = 64;

/// Tells most shapes apart by one number; across all that models are aligned with.
const dvec3 gauge_axis = {0.5773, 0.2113, 0.7887};

struct Shape {
  dvec3 middle = dvec3(0.0);
  std::vector<dvec3> offsets;   // of the control points from it
  std::vector<double> weights;  // over the first one's
  double gauge = 0;             // of offsets: it changes by no more than they do
};

Shape shape_of(const MapPieces& pieces, const MapElement& element) {
  const StoredNet& net = pieces.piece(element.root).exact;
  const dvec4* p = pieces.points(net);
  Shape shape;
  for (int k = 0; k < net.shape.size(); ++k) {
    shape.offsets.push_back(euclidean(p[k]));
    shape.weights.push_back(p[k].w / p[0].w);
    shape.middle += shape.offsets.back();
  }
  shape.middle /= double(net.shape.size());
  for (dvec3& x : shape.offsets) {
    x -= shape.middle;
    shape.gauge += std::abs(glm::dot(x, gauge_axis));
  }
  shape.gauge /= double(net.shape.size());
  return shape;
}

bool are_translates(const Shape& a, const Shape& b, double budget) {
  for (std::size_t k = 0; k < a.offsets.size(); ++k) {
    if (!(glm::distance(a.offsets[k], b.offsets[k]) <= budget)) return false;
    const double off = std::abs(a.weights[k] - b.weights[k]) / std::min(a.weights[k], b.weights[k]);
    if (!(off * glm::length(a.offsets[k]) <= budget)) return false;
  }
  return true;
}

/// A point of the convex hull of some points, as a mean of up to four.
struct Mean {
  std::array<int, 4> of = {-1, -1, -1, -1};
  std::array<double, 4> weight = {};
  int size = 0;
};

/// A mean of others that count, within the budget of a point; none if there is surely none.
std::optional<Mean> mean_near(const std::vector<dvec3>& points, const std::vector<bool>& counts,
                              std::size_t own, double budget) {
  const dvec3 x = points[own];
  const auto lowest = [&](const dvec3& along) {
    std::size_t best = points.size();
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (k == own || !counts[k]) continue;
      if (best == points.size() || glm::dot(points[k], along) < glm::dot(points[best], along)) {
        best = k;
      }
    }
    return best;
  };
  const std::size_t first = lowest(dvec3(0.0));
  if (first == points.size()) return std::nullopt;
  // Those that carry the nearest point so far.
  std::vector<int> carriers = {int(first)};
  std::vector<dvec3> offsets = {points[first] - x};
  for (int step = 0; step < nearest_step_limit; ++step) {
    const NearestInSimplex nearest = nearest_in_simplex(offsets);
    Mean mean;
    mean.size = nearest.size;
    std::vector<int> kept;
    std::vector<dvec3> kept_offsets;
    for (int k = 0; k < nearest.size; ++k) {
      const auto at = std::size_t(nearest.carrier[std::size_t(k)]);
      mean.of[std::size_t(k)] = carriers[at];
      mean.weight[std::size_t(k)] = nearest.weight[std::size_t(k)];
      kept.push_back(carriers[at]);
      kept_offsets.push_back(offsets[at]);
    }
    if (nearest.contains_origin || glm::length(nearest.point) <= budget) return mean;
    const std::size_t next = lowest(nearest.direction);
    if (glm::dot(points[next] - x, nearest.direction) > budget) return std::nullopt;
    if (std::count(kept.begin(), kept.end(), int(next)) > 0 || kept.size() == 4)
      return std::nullopt;
    carriers = std::move(kept);
    offsets = std::move(kept_offsets);
    carriers.push_back(int(next));
    offsets.push_back(points[next] - x);
  }
  return std::nullopt;
}

struct Group {
  Shape shape;
  std::vector<int> elements;
  std::vector<dvec3> places;
};

/// The largest distance of an element's control points from the same mean of the others'.
double distance(const MapPieces& pieces, const Group& group, std::size_t own, const Mean& mean) {
  const auto points = [&](std::size_t k) {
    return pieces.points(pieces.piece(pieces.element(group.elements[k]).root).exact);
  };
  double largest = 0;
  const dvec4* x = points(own);
  for (std::size_t i = 0; i < group.shape.offsets.size(); ++i) {
    dvec3 off = euclidean(x[i]);
    for (int k = 0; k < mean.size; ++k) {
      const auto at = std::size_t(k);
      off -= mean.weight[at] * euclidean(points(std::size_t(mean.of[at]))[i]);
    }
    largest = std::max(largest, glm::length(off));
  }
  return largest;
}

/// Which of a group are covered by the ones that are left.
std::vector<bool> covered(const MapPieces& pieces, const Group& group, double budget) {
  const std::size_t count = group.places.size();
  std::vector<bool> counts(count, true);
  for (std::size_t k = count; k-- > 0;) {
    counts[k] = !mean_near(group.places, counts, k, budget);
  }
  // One after the other may have gone too far.
  std::vector<bool> result(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (counts[k]) continue;
    const std::optional<Mean> mean = mean_near(group.places, counts, k, budget);
    result[k] = mean && distance(pieces, group, k, *mean) <= budget;
  }
  return result;
}

/// An element that goes on smoothly into one that is not covered is not either.
void keep_neighbors(const MapPieces& pieces, std::vector<bool>& covered) {
  const ContactGeometry& geometry = pieces.geometry();
  const auto counts = [&](const Contact& c) {
    const int element = pieces.find(c);
    return element >= 0 && !covered[std::size_t(element)];
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t k = 0; k < covered.size(); ++k) {
      if (!covered[k]) continue;
      const Contact& c = pieces.element(int(k)).contact;
      bool keeps = false;
      if (c.kind == SourceKind::face) {
        for (const Border& border : geometry.patch(c).borders) {
          keeps = keeps || (border.kind == BorderKind::smooth &&
                            counts({c.instance, c.kind, border.neighbor, 0, 0}));
        }
      } else if (c.kind == SourceKind::edge) {
        for (const int next : geometry.piece(c).end_neighbor) {
          keeps = keeps || (next >= 0 && counts({c.instance, c.kind, next, 0, 0}));
        }
      }
      if (!keeps) continue;
      covered[k] = false;
      changed = true;
    }
  }
}

}  // namespace

std::vector<bool> covered_translates(const MapPieces& pieces, double budget) {
  std::vector<Group> groups;
  std::map<std::tuple<SourceKind, int, int>, std::multimap<double, int>> by_gauge;
  for (int k = 0; k < int(pieces.elements().size()); ++k) {
    const MapElement& element = pieces.element(k);
    const NetShape net = pieces.piece(element.root).exact.shape;
    Shape shape = shape_of(pieces, element);
    auto& alike = by_gauge[{element.contact.kind, net.p, net.q}];
    int found = -1;
    for (auto it = alike.lower_bound(shape.gauge - 2 * budget);
         it != alike.end() && it->first <= shape.gauge + 2 * budget && found < 0; ++it) {
      if (are_translates(groups[std::size_t(it->second)].shape, shape, budget)) found = it->second;
    }
    if (found < 0) {
      found = int(groups.size());
      alike.emplace(shape.gauge, found);
      groups.push_back({shape, {}, {}});
    }
    groups[std::size_t(found)].elements.push_back(k);
    groups[std::size_t(found)].places.push_back(shape.middle);
  }
  std::vector<bool> result(pieces.elements().size(), false);
  for (const Group& group : groups) {
    if (group.elements.size() < 2 || group.elements.size() > translate_limit) continue;
    const std::vector<bool> own = covered(pieces, group, budget);
    for (std::size_t k = 0; k < own.size(); ++k) result[std::size_t(group.elements[k])] = own[k];
  }
  keep_neighbors(pieces, result);
  return result;
}

}  // namespace taut
