#include "taut/containment/surface_distance.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/vector_net.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Cells that one point may take, after which the bounds found stand.
constexpr int cell_limit = 20'000;

/// Largest length of points in the scene's frame, about.
constexpr double net_reach = 2;

/// Cells larger than this share of a patch are looked through by Newton's method.
constexpr double coarse_cell = 0.2;
constexpr int newton_limit = 20;
constexpr double newton_end = 1e-15;

/// Next to the surface distances are sought to this share of themselves, or to rounding.
constexpr double near_share = 0.05;
constexpr double least_gap = 1024 * rounding_unit;

}  // namespace

bool SurfaceDistance::done(double lower) const {
  if (goal_.tolerance >= 0 && (lower - surface_.rounding > goal_.tolerance ||
                               best_ + surface_.rounding <= goal_.tolerance)) {
    return true;
  }
  return best_ - lower <= std::max(std::min(goal_.accuracy, near_share * best_), least_gap);
}

double SurfaceDistance::lower_bound(const dvec4* net, std::size_t size) const {
  Box box;
  double beyond = infinity;
  for (std::size_t k = 0; k < size; ++k) {
    const dvec3 p = euclidean(net[k]);
    box.include(p);
    beyond = std::min(beyond, glm::dot(x_ - p, toward_));
  }
  const dvec3 to_middle = unit(x_ - box.center());
  double beyond_middle = infinity;
  for (std::size_t k = 0; k < size; ++k) {
    beyond_middle = std::min(beyond_middle, glm::dot(x_ - euclidean(net[k]), to_middle));
  }
  return std::max({distance(box, x_), beyond, beyond_middle});
}

void SurfaceDistance::offer(const dvec3& point) {
  const double distance = glm::distance(x_, point);
  if (!(distance < best_)) return;
  best_ = distance;
  toward_ = unit(x_ - point);
}

/// Newton's method for the nearest point, along the sides too, each step of which must not lead
/// away.
void SurfaceDistance::improve(const PlacedPatch& patch, double u, double v) {
  double length = infinity;
  for (int step = 0; step < newton_limit; ++step) {
    const PatchJet2 j = jet2(patch.bezier, u, v);
    const dvec3 r = j.S - x_;
    offer(j.S);
    if (!(glm::length(r) <= length * (1 + 1e-9))) return;
    length = glm::length(r);
    const double gu = glm::dot(j.Su, r);
    const double gv = glm::dot(j.Sv, r);
    const double eu = glm::dot(j.Su, j.Su);
    const double ev = glm::dot(j.Sv, j.Sv);
    const double ef = glm::dot(j.Su, j.Sv);
    double uu = eu + glm::dot(j.Suu, r);
    double uv = ef + glm::dot(j.Suv, r);
    double vv = ev + glm::dot(j.Svv, r);
    if (!(uu > 0 && uu * vv - uv * uv > 1e-9 * eu * ev)) {  // no minimum near: Gauss and Newton
      uu = eu;
      uv = ef;
      vv = ev;
    }
    const bool free_u = !((u <= 0 && gu > 0) || (u >= 1 && gu < 0)) && uu > 0;
    const bool free_v = !((v <= 0 && gv > 0) || (v >= 1 && gv < 0)) && vv > 0;
    double du = 0;
    double dv = 0;
    const double det = uu * vv - uv * uv;
    if (free_u && free_v && det > 0) {
      du = (uv * gv - vv * gu) / det;
      dv = (uv * gu - uu * gv) / det;
    } else if (free_u) {
      du = -gu / uu;
    } else if (free_v) {
      dv = -gv / vv;
    }
    const double next_u = std::clamp(u + du, 0.0, 1.0);
    const double next_v = std::clamp(v + dv, 0.0, 1.0);
    if (std::abs(next_u - u) + std::abs(next_v - v) < newton_end) return;
    u = next_u;
    v = next_v;
  }
}

void SurfaceDistance::push(const Cell& cell) {
  const BezierPatch& b = surface_.patches[std::size_t(cell.patch)].bezier;
  const auto p = std::size_t(b.degree_u);
  const auto q = std::size_t(b.degree_v);
  const dvec4* net = nets_.data() + cell.slot;
  for (const std::size_t k : {std::size_t{0}, q, p * (q + 1), p * (q + 1) + q}) {
    offer(euclidean(net[k]));
  }
  Cell bounded = cell;
  const double rounding = net_reach * halving_rounding(b, cell.size_u, cell.size_v);
  bounded.lower = std::max(cell.lower, lower_bound(net, b.points.size()) - rounding);
  if (bounded.lower >= best_) return;
  heap_.push_back(bounded);
  std::push_heap(heap_.begin(), heap_.end());
}

void SurfaceDistance::open(int patch) {
  const BezierPatch& b = surface_.patches[std::size_t(patch)].bezier;
  const std::size_t slot = nets_.size();
  nets_.insert(nets_.end(), b.points.begin(), b.points.end());
  push({0, patch, 0, 0, 1, 1, slot});
}

/// In two, across the longer of the net's first row and column.
void SurfaceDistance::split(const Cell& cell) {
  const BezierPatch& b = surface_.patches[std::size_t(cell.patch)].bezier;
  const NetShape shape{b.degree_u, b.degree_v};
  const std::size_t size = b.points.size();
  const auto row = std::size_t(shape.q + 1);
  const dvec4* net = nets_.data() + cell.slot;
  const auto span = [&](std::size_t i, std::size_t j) {
    return glm::distance(euclidean(net[i]), euclidean(net[j]));
  };
  const std::size_t last = size - 1;
  const std::size_t corner_u = last - (row - 1);
  const bool along_u = std::max(span(0, corner_u), span(row - 1, last)) >=
                       std::max(span(0, row - 1), span(corner_u, last));
  const std::size_t lower = nets_.size();
  nets_.resize(lower + size);
  Cell upper = cell;
  Cell other = cell;
  other.slot = lower;
  if (along_u) {
    halve_u(shape, nets_.data() + cell.slot, nets_.data() + lower);
    upper.size_u = other.size_u = 0.5 * cell.size_u;
    upper.u += upper.size_u;
  } else {
    halve_v(shape, nets_.data() + cell.slot, nets_.data() + lower);
    upper.size_v = other.size_v = 0.5 * cell.size_v;
    upper.v += upper.size_v;
  }
  push(other);
  push(upper);
}

DistanceRange SurfaceDistance::operator()(const dvec3& x, const DistanceGoal& goal, int body,
                                          double within) {
  x_ = x;
  goal_ = goal;
  best_ = infinity;
  toward_ = dvec3(0.0);
  heap_.clear();
  nets_.clear();
  std::vector<std::pair<double, int>> order;
  for (std::size_t k = 0; k < surface_.patches.size(); ++k) {
    const PlacedPatch& patch = surface_.patches[k];
    if (body >= 0 && patch.body != body) continue;
    const double lower = distance(patch.box, x);
    if (lower <= within + surface_.rounding) order.emplace_back(lower, int(k));
  }
  std::sort(order.begin(), order.end());
  for (const auto& [lower, patch] : order) {
    if (lower < best_) open(patch);
  }
  double lower = best_;
  for (int count = 0; count < cell_limit && !heap_.empty(); ++count) {
    const Cell cell = heap_.front();
    lower = std::min(cell.lower, best_);
    if (done(lower)) break;
    std::pop_heap(heap_.begin(), heap_.end());
    heap_.pop_back();
    if (cell.size_u > coarse_cell || cell.size_v > coarse_cell) {
      improve(surface_.patches[std::size_t(cell.patch)], cell.u + 0.5 * cell.size_u,
              cell.v + 0.5 * cell.size_v);
    }
    split(cell);
    if (heap_.empty()) lower = best_;
  }
  if (best_ == infinity) return {infinity, infinity, infinity};
  return {best_, std::max(0.0, lower - surface_.rounding), best_ + surface_.rounding};
}

}  // namespace taut
