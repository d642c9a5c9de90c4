#include "taut/hull/decide/height_bends.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/vector_net.h"

namespace taut {
namespace {

/// Parts of nets that are looked at before a bound is given up.
constexpr int part_limit = 64;

/// All of a rectangle is on the outer side of a side of a convex polygon.
bool is_outside(const Interval& u, const Interval& v, const std::vector<dvec2>& polygon) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const dvec2& a = polygon[k];
    const dvec2 way = polygon[k + 1 < polygon.size() ? k + 1 : 0] - a;
    // Of the corner farthest to the left of it.
    const dvec2 corner(way.y < 0 ? u.upper : u.lower, way.x > 0 ? v.upper : v.lower);
    if (way.x * (corner.y - a.y) < way.y * (corner.x - a.x)) return true;
  }
  return false;
}

}  // namespace

double largest_bend(double a, double b, double c) {
  if (a <= 0 && c <= 0 && b * b <= a * c) return 0;
  const auto at_one = [](double x, double y, double z) {  // s = 1
    const double t = z < 0 ? std::clamp(-y / z, 0.0, 1.0) : 1;
    return std::max(x, x + 2 * y * t + z * t * t);
  };
  return std::max(at_one(a, std::abs(b), c), at_one(c, std::abs(b), a));
}

void NetBends::find(NetShape shape, const std::vector<dvec4>& net) {
  shape_ = shape;
  part_.u = part_.v = {0, 1};
  const std::vector<dvec4> u = derived(shape, net, Direction::u);
  part_.uu = derived(shape, u, Direction::u);
  part_.uv = derived(shape, u, Direction::v);
  part_.vv = derived(shape, derived(shape, net, Direction::v), Direction::v);
}

/// Across the parameter with which they change most. Keeps the upper half, and leaves the lower one
/// for later.
void NetBends::halve() {
  const auto row = std::size_t(shape_.q + 1);
  double with_u = 0;
  double with_v = 0;
  for (const std::vector<dvec4>* net : {&part_.uu, &part_.uv, &part_.vv}) {
    for (std::size_t k = 0; k < net->size(); ++k) {
      const dvec4& own = (*net)[k];
      if (k >= row) with_u = std::max(with_u, shape_.p * glm::distance(own, (*net)[k - row]));
      if (k % row > 0) with_v = std::max(with_v, shape_.q * glm::distance(own, (*net)[k - 1]));
    }
  }
  Part& lower = waiting_.emplace_back(part_);
  const auto split = [&](std::vector<dvec4>& own, std::vector<dvec4>& other) {
    with_u > with_v ? halve_u(shape_, own.data(), other.data())
                    : halve_v(shape_, own.data(), other.data());
  };
  split(part_.uu, lower.uu);
  split(part_.uv, lower.uv);
  split(part_.vv, lower.vv);
  Interval& own = with_u > with_v ? part_.u : part_.v;
  own.lower = 0.5 * (own.lower + own.upper);
  (with_u > with_v ? lower.u : lower.v).upper = own.lower;
}

bool NetBends::are_below(const std::function<double(std::size_t)>& measure, double limit,
                         const std::vector<dvec2>& polygon) {
  const auto size = std::size_t(shape_.size());
  waiting_.clear();
  for (int part = 0; part < part_limit; ++part) {
    bool all = is_outside(part_.u, part_.v, polygon);
    if (!all) {
      all = true;
      for (std::size_t k = 0; k < size && all; ++k) all = measure(k) <= limit;
    }
    if (all) {
      if (waiting_.empty()) return true;
      part_ = std::move(waiting_.back());
      waiting_.pop_back();
      continue;
    }
    for (const bool upper_u : {false, true}) {
      for (const bool upper_v : {false, true}) {
        const double s = upper_u ? part_.u.upper : part_.u.lower;
        const double t = upper_v ? part_.v.upper : part_.v.lower;
        const int k = (upper_u ? shape_.p : 0) * (shape_.q + 1) + (upper_v ? shape_.q : 0);
        if (!is_outside({s, s}, {t, t}, polygon) && !(measure(std::size_t(k)) <= limit)) {
          return false;
        }
      }
    }
    halve();
  }
  return false;
}

}  // namespace taut
