#include "taut/hull/decide/translates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "taut/core/nearest_in_simplex.h"
#include "taut/hull/decide/held_elements.h"
#include "taut/hull/decide/round_shapes.h"

namespace taut {
namespace {

/// Steps of the search for the nearest point of a convex hull; it ends where it gains nothing.
constexpr int nearest_step_limit = 64;

/// Translates of an element that it is compared with in cells.
constexpr std::size_t near_translates = 4;

/// Tells most shapes apart by one number; across all that models are aligned with.
const dvec3 gauge_axis = {0.5773, 0.2113, 0.7887};

/// What is the same of translates: offsets of the control points from their middle, or half axes.
struct Shape {
  dvec3 middle = dvec3(0.0);
  std::vector<dvec3> offsets;
  std::vector<double> weights;  // over the first one's
  double gauge = 0;             // of offsets: it changes by no more than they do
  const RoundShape* round = nullptr;
};

double gauge_of(const std::vector<dvec3>& offsets) {
  double sum = 0;
  for (const dvec3& x : offsets) sum += std::abs(glm::dot(x, gauge_axis));
  return sum / double(offsets.size());
}

Shape shape_of(const MapElement& element) {
  const StoredNet& net = element.root->exact;
  const dvec4* p = net.points;
  Shape shape;
  for (int k = 0; k < net.shape.size(); ++k) {
    shape.offsets.push_back(euclidean(p[k]));
    shape.weights.push_back(p[k].w / p[0].w);
    shape.middle += shape.offsets.back();
  }
  shape.middle /= double(net.shape.size());
  for (dvec3& x : shape.offsets) x -= shape.middle;
  shape.gauge = gauge_of(shape.offsets);
  return shape;
}

Shape shape_of(const RoundShape& round) {
  Shape shape;
  shape.middle = round.center;
  for (int k = 0; k < 3; ++k) shape.offsets.push_back(round.root[k]);
  shape.weights.assign(3, 1.0);
  shape.gauge = gauge_of(shape.offsets);
  shape.round = &round;
  return shape;
}

/// Upper bound of how far the points of two shapes are from each other that differ in weights only:
/// a control point draws the others towards it.
double apart_by_weights(const Shape& a, const Shape& b) {
  double farthest = 0;
  for (const dvec3& x : a.offsets) farthest = std::max(farthest, glm::length(x));
  double largest = 0;
  for (std::size_t k = 0; k < a.offsets.size(); ++k) {
    const double off = std::abs(a.weights[k] - b.weights[k]) / std::min(a.weights[k], b.weights[k]);
    largest = std::max(largest, off * (farthest + glm::length(a.offsets[k])));
  }
  return largest;
}

/// Upper bound of how far the points of two shapes are from each other, moved to one middle.
double apart(const Shape& a, const Shape& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.offsets.size(); ++k) {
    largest = std::max(largest, glm::distance(a.offsets[k], b.offsets[k]));
  }
  return largest + apart_by_weights(a, b);
}

/// Most that are none differ in a point that comes early.
bool are_translates(const Shape& a, const Shape& b, double budget) {
  for (std::size_t k = 0; k < a.offsets.size(); ++k) {
    if (!(glm::distance(a.offsets[k], b.offsets[k]) <= budget)) return false;
  }
  return apart(a, b) <= budget;
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

/// An element, or those of a round shape.
struct Member {
  std::vector<int> elements;
  Shape shape;
};

struct Group {
  std::vector<Member> members;
  std::vector<dvec3> places;
};

/// The largest distance of a member's control points from the same mean of the others'; of a round
/// shape's elements from the convex hull of the others'.
double distance(const MapPieces& pieces, const Group& group, std::size_t own, const Mean& mean) {
  const Shape& shape = group.members[own].shape;
  const auto other = [&](int k) -> const Shape& {
    return group.members[std::size_t(mean.of[std::size_t(k)])].shape;
  };
  double largest = 0;
  if (shape.round != nullptr) {
    std::array<const RoundShape*, 4> rounds;
    for (int k = 0; k < mean.size; ++k) rounds[std::size_t(k)] = other(k).round;
    const auto size = std::size_t(mean.size);
    const RoundShape hull = mean_of({rounds.data(), size}, {mean.weight.data(), size});
    for (const int k : group.members[own].elements) {
      largest = std::max(largest, distance_outside(pieces, k, hull));
    }
    return largest + hull.inside;
  }
  for (std::size_t i = 0; i < shape.offsets.size(); ++i) {
    dvec3 off = shape.middle + shape.offsets[i];
    for (int k = 0; k < mean.size; ++k) {
      off -= mean.weight[std::size_t(k)] * (other(k).middle + other(k).offsets[i]);
    }
    largest = std::max(largest, glm::length(off));
  }
  double by_weights = 0;
  for (int k = 0; k < mean.size; ++k) {
    by_weights = std::max(by_weights, apart_by_weights(shape, other(k)));
  }
  return largest + by_weights;
}

/// Which of a group are covered by the ones that are left.
std::vector<bool> covered(const MapPieces& pieces, const Group& group, double budget) {
  const std::size_t count = group.places.size();
  std::vector<bool> counts(count, true);
  for (std::size_t k = count; k-- > 0;) {
    pieces.geometry().check_stop();
    counts[k] = !mean_near(group.places, counts, k, budget);
  }
  // One after the other may have gone too far.
  std::vector<bool> result(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (counts[k]) continue;
    pieces.geometry().check_stop();
    const std::optional<Mean> mean = mean_near(group.places, counts, k, budget);
    result[k] = mean && distance(pieces, group, k, *mean) <= budget;
  }
  return result;
}

/// From a member to the nearest of the others that are not covered.
std::vector<Likeness::Other> to_others(const Group& group, const std::vector<bool>& covered,
                                       std::size_t own, double budget) {
  std::vector<Likeness::Other> result;
  for (std::size_t k = 0; k < group.places.size(); ++k) {
    if (k == own || covered[k]) continue;
    const dvec3 off = group.places[k] - group.places[own];
    if (result.size() == near_translates && glm::length(off) >= glm::length(result.back().off))
      continue;
    const Shape& shape = group.members[own].shape;
    const double by = apart(group.members[k].shape, shape);
    if (!(by <= budget)) continue;
    const RoundShape* round = group.members[k].shape.round;
    result.push_back(
        {off, round == nullptr ? by : std::sqrt(3.0) * by + round->inside + shape.round->outside});
    std::sort(result.begin(), result.end(), [](const Likeness::Other& a, const Likeness::Other& b) {
      return glm::length(a.off) < glm::length(b.off);
    });
    if (result.size() > near_translates) result.pop_back();
  }
  return result;
}

class Search {
 public:
  Search(const MapPieces& pieces, double budget) : pieces_(pieces), budget_(budget) {}

  Likenesses run() {
    result_.resize(pieces_.elements().size());
    rounds_ = round_shapes(pieces_, budget_);
    for (const RoundShape& round : rounds_) {
      add({-1, int(round.kind), 0}, {round.elements, shape_of(round)});
    }
    // A round shape that is like no other counts by its elements.
    std::vector<bool> counts_round(result_.size(), false);
    for (auto& group : groups_) {
      if (group.members.size() == 1) group = {};
      for (const Member& member : group.members) {
        for (const int k : member.elements) counts_round[std::size_t(k)] = true;
      }
    }
    for (int k = 0; k < int(result_.size()); ++k) {
      if (counts_round[std::size_t(k)]) continue;
      pieces_.geometry().check_stop();
      const MapElement& element = pieces_.element(k);
      const NetShape net = element.root->exact.shape;
      add({int(element.contact.kind), net.p, net.q}, {{k}, shape_of(element)});
    }
    for (std::size_t k = 0; k < groups_.size(); ++k) tell(int(k));
    const std::vector<bool> held = hold_by_rounds(pieces_, rounds_, budget_, result_);
    keep_neighbors(held);
    for (std::size_t k = 0; k < rounds_.size(); ++k) {
      for (const int element : rounds_[k].elements) result_[std::size_t(element)].round = int(k);
    }
    return {std::move(result_), std::move(rounds_)};
  }

 private:
  using Key = std::array<int, 3>;

  void add(const Key& key, Member member) {
    auto& alike = by_gauge_[key];
    const double gauge = member.shape.gauge;
    int found = -1;
    for (auto it = alike.lower_bound(gauge - 2 * budget_);
         it != alike.end() && it->first <= gauge + 2 * budget_ && found < 0; ++it) {
      const Shape& first = groups_[std::size_t(it->second)].members.front().shape;
      if (are_translates(first, member.shape, budget_)) found = it->second;
    }
    if (found < 0) {
      found = int(groups_.size());
      alike.emplace(gauge, found);
      groups_.emplace_back();
    }
    groups_[std::size_t(found)].places.push_back(member.shape.middle);
    groups_[std::size_t(found)].members.push_back(std::move(member));
  }

  void tell(int number) {
    const Group& group = groups_[std::size_t(number)];
    if (group.members.size() < 2 || group.members.size() > translate_limit) return;
    const std::vector<bool> goes = covered(pieces_, group, budget_);
    const bool stands = std::count(goes.begin(), goes.end(), true) > 0;
    for (std::size_t k = 0; k < goes.size(); ++k) {
      pieces_.geometry().check_stop();
      const Likeness own{
          goes[k],
          stands && !goes[k],
          -1,
          number,
          group.places[k],
          goes[k] ? std::vector<Likeness::Other>() : to_others(group, goes, k, budget_)};
      for (const int element : group.members[k].elements) result_[std::size_t(element)] = own;
    }
  }

  bool counts(int element) const { return element >= 0 && !result_[std::size_t(element)].covered; }

  /// An element that goes on smoothly into one that is not covered is not either.
  bool has_neighbor_that_counts(const MapElement& element) const {
    const Contact& c = element.contact;
    if (c.kind == SourceKind::face) {
      return std::any_of(element.beyond.begin(), element.beyond.end(),
                         [&](const auto& beyond) { return counts(beyond.element); });
    }
    if (c.kind != SourceKind::edge) return false;
    const auto& next = pieces_.geometry().piece(c).end_neighbor;
    return counts(element.next[0][0]) || counts(element.next[1][0]) ||
           std::any_of(next.begin(), next.end(), [&](int piece) {
             return piece >= 0 && counts(pieces_.find({c.instance, c.kind, piece, 0, 0}));
           });
  }

  /// An edge that a round shape holds, but not the patch beside it, is where contacts of that end.
  bool bounds_what_counts(const MapElement& element) const {
    return std::any_of(element.beside.begin(), element.beside.end(),
                       [&](int k) { return counts(k); });
  }

  void keep_neighbors(const std::vector<bool>& held) {
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < result_.size(); ++k) {
        const MapElement& element = pieces_.element(int(k));
        if (!result_[k].covered) continue;
        if (!has_neighbor_that_counts(element) && !(held[k] && bounds_what_counts(element))) {
          continue;
        }
        result_[k].covered = false;
        changed = true;
      }
    }
  }

  const MapPieces& pieces_;
  double budget_;
  std::vector<Likeness> result_;
  std::vector<RoundShape> rounds_;
  std::vector<Group> groups_;
  std::map<Key, std::multimap<double, int>> by_gauge_;
};

}  // namespace

Likenesses find_translates(const MapPieces& pieces, double budget) {
  return Search(pieces, budget).run();
}

}  // namespace taut
