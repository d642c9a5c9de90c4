#include "taut/hull/stitch/curve_chains.h"

#include <algorithm>
#include <deque>
#include <map>
#include <tuple>

namespace taut {
namespace {

/// Puts elements together, each into one chain.
class Chainer {
 public:
  Chainer(const std::vector<CurveElement>& elements, const std::vector<dvec3>& corners,
          double distance)
      : elements_(elements),
        corners_(corners),
        distance_(distance),
        used_(elements.size(), false) {}

  bool is_used(std::size_t k) const { return used_[k]; }

  /// The chain through an element, of unused ones of the group.
  CurveChain chain_through(std::size_t start, const std::vector<std::size_t>& group) {
    std::deque<std::size_t> run = {start};
    used_[start] = true;
    bool closed = follows(start, start);
    while (!closed) {
      const auto next = unused(group, [&](std::size_t k) { return follows(run.back(), k); });
      if (next == group.end()) break;
      run.push_back(*next);
      used_[*next] = true;
      closed = follows(*next, start);
    }
    while (!closed) {
      const auto before = unused(group, [&](std::size_t k) { return follows(k, run.front()); });
      if (before == group.end()) break;
      run.push_front(*before);
      used_[*before] = true;
    }
    return {{run.begin(), run.end()}, closed};
  }

 private:
  bool follows(std::size_t a, std::size_t b) const {
    const dvec3& end = elements_[a].points.back();
    return are_one(end, elements_[b].points.front()) &&
           std::none_of(corners_.begin(), corners_.end(),
                        [&](const dvec3& corner) { return are_one(corner, end); });
  }
  bool are_one(const dvec3& a, const dvec3& b) const { return glm::distance(a, b) < distance_; }
  template <class Matches>
  std::vector<std::size_t>::const_iterator unused(const std::vector<std::size_t>& group,
                                                  Matches matches) const {
    return std::find_if(group.begin(), group.end(),
                        [&](std::size_t k) { return !used_[k] && matches(k); });
  }

  const std::vector<CurveElement>& elements_;
  const std::vector<dvec3>& corners_;
  double distance_;
  std::vector<bool> used_;
};

}  // namespace

std::vector<CurveChain> chains(const std::vector<CurveElement>& elements,
                               const std::vector<dvec3>& corners, double distance) {
  std::map<std::tuple<int, int, int>, std::vector<std::size_t>> alike;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    alike[{elements[k].left, elements[k].right, elements[k].source}].push_back(k);
  }
  Chainer chainer(elements, corners, distance);
  std::vector<CurveChain> result;
  for (const auto& [key, group] : alike) {
    for (const std::size_t start : group) {
      if (!chainer.is_used(start)) result.push_back(chainer.chain_through(start, group));
    }
  }
  return result;
}

std::vector<dvec3> points_along(const CurveChain& chain,
                                const std::vector<CurveElement>& elements) {
  std::vector<dvec3> points;
  for (const std::size_t k : chain.elements) {
    const auto& own = elements[k].points;
    points.insert(points.end(), own.begin() + (points.empty() ? 0 : 1), own.end());
  }
  if (chain.closed) points.back() = points.front();
  return points;
}

}  // namespace taut
