#include "taut/hull/decide/near_concavity.h"

#include <algorithm>
#include <cmath>

#include "taut/core/disjoint_sets.h"
#include "taut/hull/decide/parameter_hull.h"

namespace taut {
namespace {

/// Of length one, from a side into its patch.
dvec3 inwards(const ContactJet& j, Side side) {
  return unit((at_upper_end(side) ? -1.0 : 1.0) * (along_v(side) ? j.dx[0] : j.dx[1]));
}

}  // namespace

/// Along any chord of the rectangle second derivatives are at most 8 rho over its length's square:
/// then the middle of two near-maxima falls short of them by rho at most. Where several charts make
/// a branch, slopes may grow from one to the next, and chords of the size of the branch count.
bool NearConcavity::is_nearly_concave(const CellView& view, const Chart& chart, double size,
                                      const std::vector<dvec2>& region) {
  if (chart.kind == SourceKind::vertex) return true;
  const MapElement& element = pieces_.element(chart.element);
  pieces_.restricted(chart.element, chart.u, chart.v, net_);
  const NetShape shape = element.root->exact.shape;
  // What changes weights changes regions.
  if (element.rational && region.empty()) even_weights(shape, net_);
  double least = infinity;
  Corners low, top;
  low.fill(infinity);
  top.fill(-infinity);
  for (dvec4& p : net_) {
    least = std::min(least, p.w);
    p = dvec4(dvec3(p) - p.w * view.q(), p.w);
    for (std::size_t c = 0; c < 4; ++c) {
      const double h = glm::dot(dvec3(p), view.corners()[c]) / p.w;
      low[c] = std::min(low[c], h);
      top[c] = std::max(top[c], h);
    }
  }
  const int row = shape.q + 1;
  const auto at = [&](int i, int j) -> const dvec4& { return net_[std::size_t(i * row + j)]; };
  const auto chord = [&](double extent) { return std::max(1.0, size / extent); };
  double along_u = infinity;
  double along_v = infinity;
  for (int j = 0; j <= shape.q; ++j) {
    along_u = std::min(along_u, glm::distance(euclidean(at(0, j)), euclidean(at(shape.p, j))));
  }
  for (int i = 0; i <= shape.p; ++i) {
    along_v = std::min(along_v, glm::distance(euclidean(at(i, 0)), euclidean(at(i, shape.q))));
  }
  // Slopes at a pole lead in all directions.
  const bool collapses = (shape.p > 0 && !(along_u > 0)) || (shape.q > 0 && !(along_v > 0));
  if (size > 0 && collapses) return false;
  const double m = size > 0 && shape.p > 0 ? chord(along_u) : 1;
  const double n = size > 0 && shape.q > 0 ? chord(along_v) : 1;
  bends_.find(shape, net_);
  const double limit = 8 * rho_ * least;
  const auto most = [&](std::size_t k) {
    double result = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const dvec4 d(view.corners()[c], 0);
      for (const double h : {low[c], top[c]}) {
        const auto over = [&](const dvec4& x) { return glm::dot(x, d) - h * x.w; };
        result = std::max(result,
                          largest_bend(m * m * over(bends_.uu()[k]), m * n * over(bends_.uv()[k]),
                                       n * n * over(bends_.vv()[k])));
        if (!element.rational) break;
      }
    }
    return result;
  };
  return bends_.are_below(most, limit, region);
}

/// The highest point of what they share is inside, where the gradient across is that of both sides,
/// and so the highest of one of them; or at an end that the heights along it grow towards, if what
/// leads from there into the two sides is opposite: it is the highest of the one they fall into.
bool NearConcavity::meet_once(const CellView& view, const Branches& branches, const Branch& branch,
                              const Glue& glue) const {
  if (!span_the_same(branches, glue)) return false;
  const Interval& common = along(branches.chart(glue.a), Side(glue.at_a));
  const double size = glm::distance(branch.lower, branch.upper);
  for (const bool upper : {false, true}) {
    const double t = upper ? common.upper : common.lower;
    const ContactJet own = jet_at(branches, glue.a, Side(glue.at_a), t);
    const dvec3 outwards =
        (upper ? 1.0 : -1.0) * (along_v(Side(glue.at_a)) ? own.dx[1] : own.dx[0]);
    const auto& d = view.corners();
    // No slope at all may be one of the parameters.
    if (outwards != dvec3(0.0) &&
        std::all_of(d.begin(), d.end(), [&](const dvec3& n) { return glm::dot(outwards, n) <= 0; }))
      continue;
    const double there = glue.reversed ? 1 - t : t;
    const ContactJet beyond = jet_at(branches, glue.b, Side(glue.at_b), there);
    const dvec3 both = inwards(own, Side(glue.at_a)) + inwards(beyond, Side(glue.at_b));
    for (const dvec3& n : d) {
      if (!(glm::dot(both, n) * size <= rho_)) return false;
    }
  }
  return true;
}

/// From the point that two edges share, for some direction of the cell, by more than a kink that
/// amounts to the resolution over the branch.
bool NearConcavity::both_rise(const CellView& view, const Branches& branches, const Branch& branch,
                              const Glue& glue) const {
  const auto leaving = [&](int chart, int end) {
    const StoredNet& net = pieces_.element(branches.chart(chart).element).root->exact;
    const dvec4* p = net.points;
    const int last = net.shape.p;
    const dvec3 own = euclidean(p[end == 0 ? 0 : last]);
    dvec3 way(0.0);
    for (int k = 1; k <= last && way == dvec3(0.0); ++k) {
      way = euclidean(p[end == 0 ? k : last - k]) - own;
    }
    return unit(way);
  };
  const dvec3 both = leaving(glue.a, glue.at_a) + leaving(glue.b, glue.at_b);
  const double size = glm::distance(branch.lower, branch.upper);
  return std::any_of(view.corners().begin(), view.corners().end(),
                     [&](const dvec3& n) { return !(glm::dot(both, n) * size <= rho_); });
}

ContactJet NearConcavity::jet_at(const Branches& branches, int chart, Side side, double t) const {
  const Contact& c = pieces_.element(branches.chart(chart).element).contact;
  const dvec2 uv = on_side(side, t);
  return pieces_.geometry().jet({c.instance, c.kind, c.element, uv.x, uv.y});
}

/// From a corner that is re-entrant a chart may be left for either of two others.
bool NearConcavity::is_reentrant(const Branches& branches, const Branch& branch) {
  ChartGlue::Table glued(branches.charts().size(), {-1, -1, -1, -1});
  int joins = 0;
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::faces) continue;
    glued[std::size_t(glue.a)][std::size_t(glue.at_a)] = g;
    glued[std::size_t(glue.b)][std::size_t(glue.at_b)] = g;
    ++joins;
  }
  if (joins < 2) return false;  // three charts do not meet
  rings_.find(branches, branch, glued);
  return rings_.any_is_reentrant();
}

/// An edge in a patch, or a vertex in a patch or an edge, adds nothing to it, and nothing hangs
/// together by it: from a vertex between two edges both may rise. What hangs together goes on into
/// each other smoothly. From a chart that meets two others in what is highest of it both would have
/// to rise, against slopes that are the same on the two sides; what slopes may grow by between them
/// counts over the branch.
bool NearConcavity::is_one(const CellView& view, const Branches& branches, const Branch& branch) {
  DisjointSets sets(branches.charts().size());
  std::vector<bool> held(branches.charts().size(), false);
  double kinks = 0;
  const double size = glm::distance(branch.lower, branch.upper);
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::faces && glue.kind != Glue::Kind::edges) {
      if (spans(branches, glue)) held[std::size_t(glue.b)] = true;
      continue;
    }
    if (glue.kind == Glue::Kind::edges) {
      if (!both_rise(view, branches, branch, glue)) sets.unite(glue.a, glue.b);
      continue;
    }
    const MapElement& element = pieces_.element(branches.chart(glue.a).element);
    const double kink = element.kink[std::size_t(glue.at_a)];
    kinks += kink;
    if (!(kink * size <= rho_)) continue;
    if (meet_once(view, branches, branch, glue)) sets.unite(glue.a, glue.b);
  }
  if (!(kinks * size <= kink_share * rho_) || is_reentrant(branches, branch)) return false;
  int first = -1;
  int count = 0;
  for (const int k : branch.charts) {
    if (held[std::size_t(k)]) continue;
    ++count;
    if (first < 0) first = k;
    if (sets.find(k) != sets.find(first)) return false;
  }
  const bool all = std::all_of(branch.charts.begin(), branch.charts.end(), [&](int k) {
    return held[std::size_t(k)] ||
           is_nearly_concave(view, branches.chart(k), count > 1 ? size : 0, {});
  });
  if (all) return true;
  if (find_chain(view, branches, branch, held)) return chain_is_nearly_concave(view);
  if (count > 1 || branches.chart(first).kind != SourceKind::face) return false;
  return is_nearly_concave(view, branches.chart(first), 0,
                           parameter_hull(view, branches, branch, first));
}

/// The intervals of a chart's pieces, and what is between them.
std::vector<Interval> NearConcavity::stretches(const CellView& view, const Chart& chart) {
  std::vector<Interval> pieces;
  for (const int k : chart.pieces) {
    pieces.push_back(view.seen()[std::size_t(k)].piece->u);
  }
  std::sort(pieces.begin(), pieces.end(),
            [](const Interval& a, const Interval& b) { return a.lower < b.lower; });
  std::vector<Interval> result;
  double end = chart.u.lower;
  for (const Interval& t : pieces) {
    if (t.lower > end) result.push_back({end, t.lower});
    result.push_back(t);
    end = std::max(end, t.upper);
  }
  if (end < chart.u.upper) result.push_back({end, chart.u.upper});
  return result;
}

/// Of edges one behind the other: finds their control polygon over a parameter that runs along all
/// of them at a speed without steps, with weights that match where they meet. False if there is
/// none.
bool NearConcavity::find_chain(const CellView& view, const Branches& branches, const Branch& branch,
                               const std::vector<bool>& held) {
  std::vector<int> left;
  for (const int k : branch.charts) {
    if (held[std::size_t(k)]) continue;
    if (branches.chart(k).kind != SourceKind::edge) return false;
    left.push_back(k);
  }
  const auto beyond = [&](int chart, int end) -> std::optional<std::array<int, 2>> {
    for (const int g : branch.glues) {
      const Glue& glue = branches.glue(g);
      if (glue.kind != Glue::Kind::edges) continue;
      if (glue.a == chart && glue.at_a == end) return std::array{glue.b, glue.at_b};
      if (glue.b == chart && glue.at_b == end) return std::array{glue.a, glue.at_a};
    }
    return std::nullopt;
  };
  const auto first =
      std::find_if(left.begin(), left.end(), [&](int k) { return !beyond(k, 0) || !beyond(k, 1); });
  if (first == left.end()) return false;  // a ring
  std::array<int, 2> next = {*first, beyond(*first, 0) ? 1 : 0};
  polygon_.clear();
  known_.clear();
  double t = 0;
  double scale = 1;
  dvec3 step(0.0);  // the last one, over the parameter
  for (std::size_t count = 0; count < left.size(); ++count) {
    const auto [index, entry] = next;
    const Chart& chart = branches.chart(index);
    std::vector<Interval> all = stretches(view, chart);
    if (entry == 1) std::reverse(all.begin(), all.end());
    for (const Interval& own : all) {
      pieces_.restricted(chart.element, own, {0, 1}, net_);
      if (entry == 1) std::reverse(net_.begin(), net_.end());
      const double length = own.upper - own.lower;
      const double degree = double(net_.size() - 1);
      const auto step_at = [&](std::size_t from, std::size_t to) {
        const double weights = net_[to].w / net_[from].w;
        return degree / length * weights * (euclidean(net_[to]) - euclidean(net_[from]));
      };
      if (count > 0 && &own == &all.front()) {
        // It goes on at the same speed, and with the same weight.
        const double speed = glm::length(step_at(0, 1));
        if (!(speed > 0) || step == dvec3(0.0)) return false;
        scale = speed / glm::length(step);
      }
      const double weight = polygon_.empty() ? 1 : polygon_.back().second.w / net_.front().w;
      for (std::size_t k = 0; k < net_.size(); ++k) {
        const dvec4 p = weight * net_[k];
        polygon_.emplace_back(t + scale * length * double(k) / degree,
                              dvec4(dvec3(p) - p.w * view.q(), p.w));
      }
      known_.push_back(euclidean(net_.front()));
      known_.push_back(euclidean(net_.back()));
      t += scale * length;
      step = -step_at(net_.size() - 1, net_.size() - 2) / scale;
    }
    if (count + 1 == left.size()) break;
    const auto follows = beyond(index, 1 - entry);
    if (!follows) return false;
    next = *follows;
  }
  return true;
}

/// Control polygons of the heights along a chain are no farther than the resolution below a concave
/// one. Heights between the two have one near-maximum.
bool NearConcavity::chain_is_nearly_concave(const CellView& view) {
  const dvec3 middle =
      0.25 * (view.corners()[0] + view.corners()[1] + view.corners()[2] + view.corners()[3]);
  const dvec3 high = *std::max_element(
      known_.begin(), known_.end(),
      [&](const dvec3& x, const dvec3& y) { return glm::dot(x, middle) < glm::dot(y, middle); });
  double least = infinity;
  for (const auto& [at, p] : polygon_) least = std::min(least, p.w);
  for (const dvec3& d : view.corners()) {
    // Of the planes that touch.
    const double low = glm::dot(high - view.q(), d);
    double top = low;
    for (const auto& [at, p] : polygon_) top = std::max(top, glm::dot(dvec3(p), d) / p.w);
    for (const double h : {low, top}) {
      hull_.clear();
      for (const auto& [at, p] : polygon_) {
        const dvec2 x(at, glm::dot(dvec3(p), d) - h * p.w);
        while (hull_.size() > 1 && !turns_right(hull_[hull_.size() - 2], hull_.back(), x)) {
          hull_.pop_back();
        }
        hull_.push_back(x);
      }
      std::size_t k = 0;
      for (const auto& [at, p] : polygon_) {
        while (k + 2 < hull_.size() && hull_[k + 1].x < at) ++k;
        const dvec2& a = hull_[k];
        const dvec2& b = hull_[k + 1];
        const double share = b.x > a.x ? std::clamp((at - a.x) / (b.x - a.x), 0.0, 1.0) : 0;
        const double gap = a.y + share * (b.y - a.y) - (glm::dot(dvec3(p), d) - h * p.w);
        if (!(gap + view.noise() <= rho_ * least)) return false;
      }
    }
  }
  return true;
}

}  // namespace taut
