#include "taut/hull/decide/hanging_branches.h"

#include <algorithm>

#include "taut/core/disjoint_sets.h"

namespace taut {
namespace {

std::vector<dvec3> corners_of_pieces(const CellView& view, const Branches& branches,
                                     const Branch& branch) {
  std::vector<dvec3> corners;
  for (const int chart : branch.charts) {
    for (const int k : branches.chart(chart).pieces) {
      const StoredNet& net = view.seen()[std::size_t(k)].piece->net;
      const int row = net.shape.q + 1;
      for (const int corner : {0, row - 1, net.shape.p * row, net.shape.p * row + row - 1}) {
        corners.push_back(euclidean(net.points[corner]));
      }
    }
  }
  return corners;
}

}  // namespace

bool hang_together(const CellView& view, const Branches& branches, double resolution) {
  const std::vector<Branch>& all = branches.all();
  const auto come_near = [&](const Branch& a, const Branch& b) {
    if (glm::length(box_gaps(Box{a.lower, a.upper}, Box{b.lower, b.upper})) > resolution)
      return false;
    const std::vector<dvec3> own = corners_of_pieces(view, branches, a);
    const std::vector<dvec3> other = corners_of_pieces(view, branches, b);
    return std::any_of(own.begin(), own.end(), [&](const dvec3& x) {
      return std::any_of(other.begin(), other.end(),
                         [&](const dvec3& y) { return glm::distance(x, y) <= resolution; });
    });
  };
  DisjointSets sets(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      if (come_near(all[i], all[j])) sets.unite(int(i), int(j));
    }
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (sets.find(int(i)) != sets.find(0)) return false;
  }
  return true;
}

}  // namespace taut
