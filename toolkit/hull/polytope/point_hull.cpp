#include "taut/hull/polytope/point_hull.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace taut {
namespace {

/// Insertions between two looks at whether to stop.
constexpr long progress_interval = 4096;

int next3(int k) { return k == 2 ? 0 : k + 1; }

/// Which side of the facet borders on `other`.
int side_towards(const PointHull::Facet& facet, int other) {
  for (int k = 0; k < 3; ++k) {
    if (facet.neighbor[std::size_t(k)] == other) return k;
  }
  std::abort();
}

}  // namespace

/// Four points that span space, the first facets and the first assignment. The choice among the
/// points is by rounded sizes (it decides speed only), their independence is exact.
bool PointHull::make_simplex() {
  const int count = int(points_.size());
  if (count == 0) return false;
  const auto find = [&](auto size, auto independent) {
    int best = -1;
    double largest = -1;
    for (int i = 0; i < count; ++i) {
      const double s = size(point(i));
      if (s > largest && independent(point(i))) {
        largest = s;
        best = i;
      }
    }
    return best;
  };
  // Differences of halves, in units of the points' spread, neither over- nor underflow.
  Box box;
  for (const dvec3& p : points_) box.include(p);
  const dvec3 half = 0.5 * box.upper - 0.5 * box.lower;
  const double spread = std::max({half.x, half.y, half.z, std::numeric_limits<double>::min()});
  const auto from = [&](const dvec3& p, const dvec3& q) { return (0.5 * q - 0.5 * p) / spread; };
  const dvec3 a = point(0);
  dimension_ = 0;
  const int ib = find([&](const dvec3& p) { return glm::length(from(a, p)); },
                      [&](const dvec3& p) { return p != a; });
  if (ib < 0) return false;
  simplex_[1] = ib;
  const dvec3 b = point(ib);
  const dvec3 ab = from(a, b);
  dimension_ = 1;
  const int ic = find([&](const dvec3& p) { return glm::length(glm::cross(ab, from(a, p))); },
                      [&](const dvec3& p) { return !collinear(a, b, p); });
  if (ic < 0) return false;
  simplex_[2] = ic;
  const dvec3 c = point(ic);
  const dvec3 normal = glm::cross(ab, from(a, c));
  dimension_ = 2;
  const PlaneSide plane(a, b, c, extent_);
  const int id = find([&](const dvec3& p) { return std::abs(glm::dot(normal, from(a, p))); },
                      [&](const dvec3& p) { return plane.side(p) != Sign::zero; });
  if (id < 0) return false;
  simplex_[3] = id;
  dimension_ = 3;

  int v[4] = {0, ib, ic, id};
  if (plane.side(point(id)) == Sign::positive) std::swap(v[1], v[2]);
  // Now v[3] is below v[0] v[1] v[2].
  const int f0 = new_facet(v[0], v[1], v[2]);
  const int f1 = new_facet(v[1], v[0], v[3]);
  const int f2 = new_facet(v[2], v[1], v[3]);
  const int f3 = new_facet(v[0], v[2], v[3]);
  facets_[std::size_t(f0)].neighbor = {f1, f2, f3};
  facets_[std::size_t(f1)].neighbor = {f0, f3, f2};
  facets_[std::size_t(f2)].neighbor = {f0, f1, f3};
  facets_[std::size_t(f3)].neighbor = {f0, f2, f1};
  return true;
}

int PointHull::new_facet(int a, int b, int c) {
  const Facet facet{
      {a, b, c}, {-1, -1, -1}, PlaneSide(point(a), point(b), point(c), extent_), true};
  ++alive_;
  if (free_.empty()) {
    facets_.push_back(facet);
    waiting_.push_back({});
    return int(facets_.size()) - 1;
  }
  const int place = free_.back();
  free_.pop_back();
  facets_[std::size_t(place)] = facet;
  waiting_[std::size_t(place)] = {};
  return place;
}

/// Puts the point on the list of the first candidate that it is strictly above; it is inside
/// otherwise: a point above a removed facet and outside the new hull is above a facet of the cone.
void PointHull::assign(int p, std::span<const int> candidates) {
  const dvec3& x = point(p);
  for (const int f : candidates) {
    if (side(f, x) != Sign::positive) continue;
    const PlaneSide& plane = facets_[std::size_t(f)].side;
    const double height = plane.determinant(x) / std::max(glm::length(plane.normal()), 1e-300);
    Waiting& list = waiting_[std::size_t(f)];
    if (list.first < 0 || height > list.height) {
      next_[std::size_t(p)] = list.first;
      list = {p, height};
    } else {
      next_[std::size_t(p)] = next_[std::size_t(list.first)];
      next_[std::size_t(list.first)] = p;
    }
    return;
  }
}

void PointHull::collect_visible(const dvec3& p, int start) {
  visible_.clear();
  horizon_.clear();
  stack_.assign(1, start);
  facets_[std::size_t(start)].alive = false;
  while (!stack_.empty()) {
    const int f = stack_.back();
    stack_.pop_back();
    visible_.push_back(f);
    for (int k = 0; k < 3; ++k) {
      const Facet& facet = facets_[std::size_t(f)];
      const int other = facet.neighbor[std::size_t(k)];
      Facet& neighbor = facets_[std::size_t(other)];
      if (!neighbor.alive) continue;  // seen already
      if (neighbor.side.side(p) == Sign::positive) {
        neighbor.alive = false;
        stack_.push_back(other);
      } else {
        horizon_.push_back(
            {facet.vertex[std::size_t(k)], facet.vertex[std::size_t(next3(k))], other});
      }
    }
  }
}

/// Replaces the visible facets by the cone from the apex over the horizon, a simple closed loop.
void PointHull::make_cone(int apex) {
  // The horizon's facets name visible neighbours by number, so places are freed after linking.
  created_.clear();
  for (const HorizonEdge& e : horizon_) {
    const int f = new_facet(e.from, e.to, apex);
    Facet& outside = facets_[std::size_t(e.outside)];
    for (int k = 0; k < 3; ++k) {
      if (outside.vertex[std::size_t(k)] == e.to &&
          outside.vertex[std::size_t(next3(k))] == e.from) {
        outside.neighbor[std::size_t(k)] = f;
      }
    }
    facets_[std::size_t(f)].neighbor[0] = e.outside;
    facet_from_[std::size_t(e.from)] = f;
    created_.push_back(f);
  }
  for (const int f : created_) {
    const int next = facet_from_[std::size_t(facets_[std::size_t(f)].vertex[1])];
    facets_[std::size_t(f)].neighbor[1] = next;
    facets_[std::size_t(next)].neighbor[2] = f;
  }
  free_.insert(free_.end(), visible_.begin(), visible_.end());
  alive_ -= int(visible_.size());
}

bool PointHull::insert(const dvec3& p, int facet) {
  if (side(facet, p) != Sign::positive) return false;
  points_.push_back(p);
  next_.push_back(-1);
  facet_from_.push_back(-1);
  collect_visible(p, facet);
  make_cone(int(points_.size()) - 1);
  return true;
}

const std::vector<int>& PointHull::visible(const dvec3& p, int facet) {
  visible_.clear();
  if (side(facet, p) != Sign::positive) return visible_;
  collect_visible(p, facet);
  for (const int f : visible_) facets_[std::size_t(f)].alive = true;
  return visible_;
}

void PointHull::add(std::span<const dvec3> points, const Progress& progress) {
  std::size_t first = points_.size();
  points_.insert(points_.end(), points.begin(), points.end());
  next_.resize(points_.size(), -1);
  facet_from_.resize(points_.size(), -1);
  if (dimension_ < 3) {
    if (!make_simplex()) return;
    first = 0;
  }
  std::vector<int> all;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (facets_[f].alive) all.push_back(int(f));
  }
  for (std::size_t p = first; p < points_.size(); ++p) assign(int(p), all);
  progress.check();

  std::vector<int> pending = all;
  std::vector<int> orphans;
  long inserted = 0;
  while (!pending.empty()) {
    const int f = pending.back();
    const int apex = facets_[std::size_t(f)].alive ? waiting_[std::size_t(f)].first : -1;
    if (apex < 0) {
      pending.pop_back();
      continue;
    }
    if (++inserted % progress_interval == 0) progress.check();
    waiting_[std::size_t(f)].first = next_[std::size_t(apex)];
    collect_visible(point(apex), f);
    orphans.clear();
    for (const int v : visible_) {
      for (int p = waiting_[std::size_t(v)].first; p >= 0; p = next_[std::size_t(p)]) {
        orphans.push_back(p);
      }
    }
    make_cone(apex);
    for (const int p : orphans) assign(p, created_);
    pending.insert(pending.end(), created_.begin(), created_.end());
  }
}

PointHull::Polygons PointHull::merged_polygons(const Progress& progress) const {
  const std::size_t count = facets_.size();
  // Groups of facets in one plane.
  std::vector<int> group(count, -1);
  Polygons result;
  std::vector<int> stack;
  for (std::size_t start = 0; start < count; ++start) {
    progress.check();
    if (!facets_[start].alive || group[start] >= 0) continue;
    const int id = int(result.facets.size());
    result.facets.push_back(int(start));
    group[start] = id;
    stack.assign(1, int(start));
    while (!stack.empty()) {
      const Facet& f = facet(stack.back());
      stack.pop_back();
      for (const int other : f.neighbor) {
        if (group[std::size_t(other)] >= 0) continue;
        const Facet& g = facet(other);
        const int across = side_towards(g, int(&f - facets_.data()));
        // The neighbour's vertex off the common edge decides whether both planes are one.
        const int off = g.vertex[std::size_t(next3(next3(across)))];
        if (f.side.side(point(off)) != Sign::zero) continue;
        group[std::size_t(other)] = id;
        stack.push_back(other);
      }
    }
  }

  // A vertex is extreme iff three or more groups meet in it.
  std::vector<std::array<int, 3>> seen(points_.size(), {-1, -1, -1});
  for (std::size_t f = 0; f < count; ++f) {
    progress.check();
    if (!facets_[f].alive) continue;
    for (const int v : facets_[f].vertex) {
      for (int& s : seen[std::size_t(v)]) {
        if (s == group[f]) break;
        if (s < 0) {
          s = group[f];
          break;
        }
      }
    }
  }

  // Walk each group's outline: edges with the group on the left and another on the right.
  result.loops.resize(result.facets.size());
  std::vector<bool> walked(result.facets.size(), false);
  for (std::size_t f = 0; f < count; ++f) {
    progress.check();
    if (!facets_[f].alive || walked[std::size_t(group[f])]) continue;
    for (int k = 0; k < 3; ++k) {
      if (group[std::size_t(facets_[f].neighbor[std::size_t(k)])] == group[f]) continue;
      std::vector<int>& loop = result.loops[std::size_t(group[f])];
      walked[std::size_t(group[f])] = true;
      int facet_now = int(f);
      int side_now = k;
      do {
        const int v = facet(facet_now).vertex[std::size_t(side_now)];
        if (seen[std::size_t(v)][2] >= 0) loop.push_back(v);
        // Turn about the edge's end until the next outline edge.
        side_now = next3(side_now);
        for (;;) {
          const int other = facet(facet_now).neighbor[std::size_t(side_now)];
          if (group[std::size_t(other)] != group[f]) break;
          side_now = next3(side_towards(facet(other), facet_now));
          facet_now = other;
        }
      } while (facet_now != int(f) || side_now != k);
      break;
    }
  }
  return result;
}

}  // namespace taut
