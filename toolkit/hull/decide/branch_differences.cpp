#include "taut/hull/decide/branch_differences.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Of matrices as vectors of their numbers.
double product(const dmat3& a, const dmat3& b) {
  return glm::dot(a[0], b[0]) + glm::dot(a[1], b[1]) + glm::dot(a[2], b[2]);
}

/// An upper bound of the distance of points of two shapes that touch parallel planes, if the shapes
/// are one in two sizes and have one centre.
double distance(const dmat3& root, const dmat3& other) {
  return std::sqrt(product(root - other, root - other));
}

/// The size of a shape in that of another, which it is in another size to within the tolerance.
std::optional<double> size_in(const RoundShape& shape, const RoundShape& other, double tolerance) {
  if (shape.kind != other.kind) return std::nullopt;
  const double size = product(shape.root, other.root) / product(other.root, other.root);
  if (!(distance(shape.root, size * other.root) <= tolerance)) return std::nullopt;
  return size;
}

/// What of a branch may be moved: the elements that are translates of others, or of one round shape
/// together; none where one is no translate.
std::vector<const Likeness*> movable(const MapPieces& pieces, const Branches& branches,
                                     const Branch& branch) {
  std::vector<const Likeness*> result;
  for (const int chart : branch.charts) {
    const Likeness& own = pieces.element(branches.chart(chart).element).likeness;
    if (own.group < 0) return {};
    if (std::none_of(result.begin(), result.end(), [&](const Likeness* other) {
          return other->group == own.group && other->place == own.place;
        })) {
      result.push_back(&own);
    }
  }
  return result;
}

/// How far a branch is moved to be another one, to within rounding of the model's coordinates; none
/// if they are no translates of each other.
std::optional<Box> translation(const MapPieces& pieces, const Branches& branches,
                               const Branch& from, const Branch& to, double tolerance) {
  const std::vector<const Likeness*> own = movable(pieces, branches, from);
  const std::vector<const Likeness*> others = movable(pieces, branches, to);
  if (own.empty() || own.size() != others.size()) return std::nullopt;
  for (const Likeness* first : others) {
    if (first->group != own.front()->group) continue;
    const dvec3 off = first->place - own.front()->place;
    Box box;
    const bool all_move = std::all_of(own.begin(), own.end(), [&](const Likeness* a) {
      return std::any_of(others.begin(), others.end(), [&](const Likeness* b) {
        const dvec3 moved = b->place - a->place;
        if (a->group != b->group || !(glm::distance(moved, off) <= tolerance)) return false;
        box.include(moved);
        return true;
      });
    });
    if (all_move) return box;
  }
  return std::nullopt;
}

}  // namespace

const RoundShape* BranchDifferences::round(const Branch& branch) const {
  const auto shape = [&](int k) {
    return pieces_.element(branches_.chart(k).element).likeness.round;
  };
  const int first = shape(branch.charts.front());
  const bool is_one = std::all_of(branch.charts.begin(), branch.charts.end(),
                                  [&](int k) { return shape(k) == first; });
  return first >= 0 && is_one ? &pieces_.round(first) : nullptr;
}

bool BranchDifferences::is_round(const Branch& branch) const {
  const RoundShape* shape = round(branch);
  return shape != nullptr && shape->is_touched_once(view_.corners());
}

std::optional<Box> BranchDifferences::translation_to(const Branch& from, const Branch& to) const {
  return translation(pieces_, branches_, from, to, tolerance_);
}

BranchDifferences::Slopes BranchDifferences::slopes(const Branch& a, const Branch& b) const {
  const auto of_box = [&](const Box& off) {
    const dvec3 half = 0.5 * (off.upper - off.lower);
    const auto along = [&](const dvec3& axis) {
      const double m = glm::dot(off.center(), axis);
      const double r = glm::dot(half, glm::abs(axis));
      return Interval{m - r, m + r};
    };
    return Slopes{along(axes_[0]), along(axes_[1])};
  };
  if (const std::optional<Box> moved = translation_to(b, a)) return of_box(*moved);
  const Slopes by_boxes = of_box({a.lower - b.upper, a.upper - b.lower});
  const RoundShape* own = round(a);
  const RoundShape* other = round(b);
  if (own == nullptr || other == nullptr || !size_in(*own, *other, tolerance_)) return by_boxes;
  const dvec3 off = own->center - other->center;
  const double reach = distance(own->root, other->root);
  Slopes result;
  for (const std::size_t k : {0u, 1u}) {
    const double m = glm::dot(off, axes_[k]);
    result[k] = {std::max(by_boxes[k].lower, m - reach), std::min(by_boxes[k].upper, m + reach)};
  }
  return result;
}

bool BranchDifferences::is_arc(const Branch& a, const Branch& b) const {
  const Slopes slope = slopes(a, b);
  return excludes_zero(slope[0]) || excludes_zero(slope[1]);
}

bool BranchDifferences::is_node(const Branch& a, const Branch& b, const Branch& c) const {
  const Slopes s = slopes(a, b);
  const Slopes t = slopes(a, c);
  const auto product = [](const Interval& x, const Interval& y) {
    const auto [least, most] =
        std::minmax({x.lower * y.lower, x.lower * y.upper, x.upper * y.lower, x.upper * y.upper});
    return Interval{least, most};
  };
  const Interval p = product(s[0], t[1]);
  const Interval q = product(s[1], t[0]);
  return excludes_zero({p.lower - q.upper, p.upper - q.lower});
}

/// Of round shapes of one form and in line, by h(d) = center . d + size |root d|: the middle one's
/// is no less than the mean of the others' that has its centre, in all directions of the cell and
/// within the tolerance. What is less by no more than that supports, as far as is known.
bool BranchDifferences::stands_out(const Branch& a, const Branch& middle, const Branch& c) const {
  const RoundShape* own = round(middle);
  const RoundShape* first = round(a);
  const RoundShape* last = round(c);
  if (own == nullptr || first == nullptr || last == nullptr) return false;
  const std::optional<double> first_size = size_in(*first, *own, tolerance_);
  const std::optional<double> last_size = size_in(*last, *own, tolerance_);
  if (!first_size || !last_size) return false;
  const dvec3 way = last->center - first->center;
  const double share = glm::dot(own->center - first->center, way) / glm::dot(way, way);
  if (!(share > 0 && share < 1)) return false;
  const double more = 1 - (1 - share) * *first_size - share * *last_size;
  const dvec3 off = own->center - first->center - share * way;
  dvec3 along(0.0);
  for (const dvec3& d : view_.corners()) along += own->root * d;
  along = unit(along);
  // The length is convex, and at least what it is along a vector.
  return std::all_of(view_.corners().begin(), view_.corners().end(), [&](const dvec3& d) {
    const dvec3 reach = own->root * d;
    const double length = more > 0 ? glm::dot(reach, along) : glm::length(reach);
    return glm::dot(off, d) + more * length > -tolerance_;
  });
}

std::optional<std::array<int, 3>> BranchDifferences::line_of(
    const std::vector<Branch>& three) const {
  for (const std::size_t axis : {0u, 1u}) {
    std::array<int, 3> order = {0, 1, 2};
    const auto at = [&](int k) -> const Branch& { return three[std::size_t(k)]; };
    const auto before = [&](int a, int b) { return slopes(at(a), at(b))[axis].upper < 0; };
    do {
      if (before(order[0], order[1]) && before(order[1], order[2]) && before(order[0], order[2]) &&
          stands_out(at(order[0]), at(order[1]), at(order[2]))) {
        return order;
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return std::nullopt;
}

std::vector<MapCell::Translate> BranchDifferences::translates() const {
  std::vector<MapCell::Translate> result;
  const std::vector<Branch>& all = branches_.all();
  for (std::size_t k = 0; k < all.size() && all.size() > 1; ++k) {
    MapCell::Translate own{int(k)};
    for (std::size_t first = 0; first < k && own.of == int(k); ++first) {
      if (result[first].of != int(first)) continue;
      const std::optional<Box> moved = translation_to(all[first], all[k]);
      if (moved) own = {int(first), moved->center()};
    }
    result.push_back(own);
  }
  return result;
}

std::vector<MapCell::Round> BranchDifferences::rounds() const {
  std::vector<MapCell::Round> result;
  for (const Branch& branch : branches_.all()) {
    const RoundShape* shape = round(branch);
    if (shape == nullptr) return {};
    result.push_back({shape->center, shape->root});
  }
  return result.size() > 1 ? result : std::vector<MapCell::Round>();
}

}  // namespace taut
