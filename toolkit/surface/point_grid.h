#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

/// The quotient comes first since squares of a small part's lengths underflow.
inline bool same_point(const dvec3& a, const dvec3& b, double tolerance) {
  const dvec3 d = (a - b) / tolerance;
  return glm::dot(d, d) <= 1;
}

/// Numbered points, found by place. Cells are a few tolerances wide: a query seldom looks into more
/// than one, and points that lie farther apart than the tolerance cannot crowd one.
class PointGrid {
 public:
  PointGrid(const Box& box, double tolerance)
      : origin_(box.lower), tolerance_(tolerance), cell_(8 * tolerance) {}

  void insert(const dvec3& p, int number) {
    int& head = heads_.try_emplace(key(cell(p, 0)), -1).first->second;
    entries_.push_back({p, number, head});
    head = static_cast<int>(entries_.size()) - 1;
  }

  /// Calls visit(number) for all points within the tolerance of p, in a fixed order.
  template <class Visit>
  void visit_near(const dvec3& p, const Visit& visit) const {
    const Cell lower = cell(p, -tolerance_);
    const Cell upper = cell(p, tolerance_);
    Cell c;
    for (c[0] = lower[0]; c[0] <= upper[0]; ++c[0]) {
      for (c[1] = lower[1]; c[1] <= upper[1]; ++c[1]) {
        for (c[2] = lower[2]; c[2] <= upper[2]; ++c[2]) {
          const auto head = heads_.find(key(c));
          if (head == heads_.end()) continue;
          for (int e = head->second; e >= 0; e = entries_[std::size_t(e)].next) {
            const Entry& entry = entries_[std::size_t(e)];
            if (same_point(entry.point, p, tolerance_)) visit(entry.number);
          }
        }
      }
    }
  }

 private:
  struct Entry {
    dvec3 point;
    int number;
    int next;
  };
  using Cell = std::array<std::uint64_t, 3>;

  /// The box is at most 1 / (8 join_distance) cells wide, which leaves room in 21 bits; the limits
  /// are met only where coordinates are so far out that a tolerance is less than their rounding.
  Cell cell(const dvec3& p, double offset) const {
    Cell c;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = std::floor((p[axis] + offset - origin_[axis]) / cell_) + 2;
      c[std::size_t(axis)] = static_cast<std::uint64_t>(std::fmin(std::fmax(x, 0), 0x1p21 - 1));
    }
    return c;
  }
  static std::uint64_t key(const Cell& c) { return (c[0] << 42) | (c[1] << 21) | c[2]; }

  dvec3 origin_;
  double tolerance_;
  double cell_;
  std::unordered_map<std::uint64_t, int> heads_;
  std::vector<Entry> entries_;
};

}  // namespace taut
