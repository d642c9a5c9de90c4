#include "taut/surface/near_copies.h"

#include <algorithm>
#include <vector>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// A unit vector, to within a hundredth, across all that models are aligned with: along it few
/// patches are as far.
const dvec3 sorting_axis = {0.5773, 0.2113, 0.7887};
constexpr double sorting_axis_length = 1.01;

/// A patch's control points where it is placed, and the middle of them.
struct PlacedPatch {
  const BezierPatch* net;
  std::vector<dvec3> points;
  dvec3 middle;
  double along = 0;
};

std::vector<PlacedPatch> placed_patches(const Model& model) {
  std::vector<PlacedPatch> all;
  for (const Instance& instance : model.instances()) {
    const Part& part = model.parts()[to_size(instance.part)];
    if (!part.cages().empty()) continue;
    for (const Patch& patch : part.patches()) {
      PlacedPatch placed{&patch.bezier, {}, dvec3(0.0)};
      placed.points.reserve(patch.bezier.points.size());
      for (const dvec4& p : patch.bezier.points) {
        placed.points.push_back(instance.pose(euclidean(p)));
        placed.middle += placed.points.back() / double(patch.bezier.points.size());
      }
      placed.along = glm::dot(placed.middle, sorting_axis);
      all.push_back(std::move(placed));
    }
  }
  return all;
}

bool have_same_weights(const BezierPatch& a, const BezierPatch& b) {
  if (a.degree_u != b.degree_u || a.degree_v != b.degree_v) return false;
  const double factor = b.points.front().w / a.points.front().w;
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(),
                    [&](const dvec4& x, const dvec4& y) {
                      return std::abs(y.w - factor * x.w) <= coordinate_rounding * std::abs(y.w);
                    });
}

}  // namespace

double copies_apart(const Model& model, double limit) {
  std::vector<PlacedPatch> all = placed_patches(model);
  std::stable_sort(all.begin(), all.end(),
                   [](const PlacedPatch& a, const PlacedPatch& b) { return a.along < b.along; });
  double largest = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const PlacedPatch &a = all[i], &b = all[j];
      if (b.along - a.along > sorting_axis_length * limit) break;
      if (glm::distance(a.middle, b.middle) > limit || !have_same_weights(*a.net, *b.net)) continue;
      double apart = 0;
      for (std::size_t k = 0; k < a.points.size() && apart <= limit; ++k) {
        apart = std::max(apart, glm::distance(a.points[k], b.points[k]));
      }
      if (apart <= limit) largest = std::max(largest, apart);
    }
  }
  return largest;
}

}  // namespace taut
