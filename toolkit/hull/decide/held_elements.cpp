#include "taut/hull/decide/held_elements.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace taut {
namespace {

/// Of more round shapes it is not told what is between two of them. The work grows with the square
/// of their number times that of elements.
constexpr std::size_t between_limit = 32;

dvec3 middle_of(const MapElement& element) {
  const StoredNet& net = element.root->exact;
  dvec3 sum(0.0);
  for (int k = 0; k < net.shape.size(); ++k) sum += euclidean(net.points[k]);
  return sum / double(net.shape.size());
}

class Holding {
 public:
  Holding(const MapPieces& pieces, const std::vector<RoundShape>& rounds, double budget,
          std::vector<Likeness>& likenesses)
      : pieces_(pieces),
        rounds_(rounds),
        budget_(budget),
        likenesses_(likenesses),
        held_(likenesses.size(), false) {}

  /// What a shape holds, the largest first, which others then hold no more.
  void hold() {
    std::vector<int> order(rounds_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return rounds_[std::size_t(a)].greatest_radius() > rounds_[std::size_t(b)].greatest_radius();
    });
    for (const int number : order) {
      pieces_.geometry().check_stop();
      const RoundShape& round = rounds_[std::size_t(number)];
      if (is_covered(round)) continue;
      for (int k = 0; k < int(likenesses_.size()); ++k) {
        Likeness& own = likenesses_[std::size_t(k)];
        if (own.covered || std::count(round.elements.begin(), round.elements.end(), k) > 0)
          continue;
        const StoredNet& net = pieces_.element(k).root->exact;
        if (round.surely_misses(euclidean(*net.points), budget_)) continue;
        own.covered = distance_outside(pieces_, k, round) + round.inside <= budget_;
        held_[std::size_t(k)] = own.covered;
        if (own.covered) let_stand(round);
      }
    }
  }

  /// What the convex hull of two shapes holds, which others then hold no more.
  void hold_between() {
    std::vector<const RoundShape*> left;
    for (const RoundShape& round : rounds_) {
      if (!is_covered(round)) left.push_back(&round);
    }
    if (left.size() > between_limit) return;
    std::vector<bool> carries(likenesses_.size(), false);
    for (std::size_t i = 0; i < left.size(); ++i) {
      for (std::size_t j = i + 1; j < left.size(); ++j) {
        pieces_.geometry().check_stop();
        const std::array<const RoundShape*, 2> two = {left[i], left[j]};
        if (two[0]->kind != two[1]->kind || is_covered(*two[0])) continue;
        for (int k = 0; k < int(likenesses_.size()) && !is_covered(*two[1]); ++k) {
          if (likenesses_[std::size_t(k)].covered || carries[std::size_t(k)]) continue;
          if (!holds_between(two, k)) continue;
          likenesses_[std::size_t(k)].covered = held_[std::size_t(k)] = true;
          for (const RoundShape* round : two) let_stand(*round);
          for (const RoundShape* round : two) {
            for (const int element : round->elements) carries[std::size_t(element)] = true;
          }
        }
      }
    }
  }

  std::vector<bool> held() { return std::move(held_); }

 private:
  /// The mean of two shapes in whose plane, or beside whose centre, the element's middle lies holds
  /// the element.
  bool holds_between(const std::array<const RoundShape*, 2>& two, int element) const {
    for (const RoundShape* round : two) {
      if (std::count(round->elements.begin(), round->elements.end(), element) > 0) return false;
    }
    const dvec3 way = two[1]->center - two[0]->center;
    const dvec3 across = two[0]->is_flat() ? two[0]->axes[2] : way;
    const dvec3 middle = middle_of(pieces_.element(element));
    const double share = glm::dot(middle - two[0]->center, across) / glm::dot(way, across);
    if (!(share > 0 && share < 1)) return false;
    const std::array<double, 2> weights = {1 - share, share};
    const RoundShape mean = mean_of(two, weights);
    return distance_outside(pieces_, element, mean) + mean.inside <= budget_;
  }

  void let_stand(const RoundShape& round) {
    for (const int k : round.elements) likenesses_[std::size_t(k)].stands_for_others = true;
  }

  bool is_covered(const RoundShape& round) const {
    return std::any_of(round.elements.begin(), round.elements.end(),
                       [&](int k) { return likenesses_[std::size_t(k)].covered; });
  }

  const MapPieces& pieces_;
  const std::vector<RoundShape>& rounds_;
  double budget_;
  std::vector<Likeness>& likenesses_;
  std::vector<bool> held_;
};

}  // namespace

std::vector<bool> hold_by_rounds(const MapPieces& pieces, const std::vector<RoundShape>& rounds,
                                 double budget, std::vector<Likeness>& likenesses) {
  Holding holding(pieces, rounds, budget, likenesses);
  holding.hold();
  holding.hold_between();
  return holding.held();
}

double distance_outside(const MapPieces& pieces, int element, const RoundShape& round) {
  const StoredNet& net = pieces.element(element).root->exact;
  const auto size = std::size_t(net.shape.size());
  return round.distances(net.shape, {net.points, size}).outwards + pieces.geometry().rounding();
}

}  // namespace taut
