#include "taut/hull/decide/contact_index.h"

#include <algorithm>
#include <optional>
#include <set>

#include "taut/bounds/vector_net.h"
#include "taut/core/disjoint_sets.h"

namespace taut {
namespace {

/// The most that a direction inwards leads along the side, in the chart's parameters from 0 to 1: at
/// a corner, where it is exchanged for that of the other side, what is between leads inwards too.
constexpr double most_oblique = 0.99;

Corners heights_in(const dvec4& p, const CellView& view) {
  const dvec3 x = dvec3(p) - p.w * view.q();
  const auto& d = view.corners();
  return {glm::dot(x, d[0]), glm::dot(x, d[1]), glm::dot(x, d[2]), glm::dot(x, d[3])};
}

/// Of homogeneous points and vectors from them: the heights surely grow along all the vectors, for
/// points between the points.
class Growth {
 public:
  explicit Growth(const CellView& view) : view_(view) {
    lower_.fill(infinity);
    upper_.fill(-infinity);
  }
  void include(const dvec4& point) {
    const Corners y = heights_in(point, view_);
    for (std::size_t c = 0; c < 4; ++c) {
      lower_[c] = std::min(lower_[c], y[c] / point.w);
      upper_[c] = std::max(upper_[c], y[c] / point.w);
    }
  }
  bool along(const dvec4& vector) const {
    const Corners y = heights_in(vector, view_);
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(y[c] - (vector.w > 0 ? upper_[c] : lower_[c]) * vector.w > view_.noise())) return false;
    }
    return true;
  }

 private:
  const CellView& view_;
  Corners lower_, upper_;
};

Side other_way(Side side) { return Side(int(side) ^ 1); }

/// A corner of a patch, seen on the way around it: the side over which the next step leads, and the
/// other one.
struct AtCorner {
  int chart;
  Side next, other;
};

}  // namespace

/// Strictly, so that every point at which a plane touches counts one.
bool ContactIndex::is_curved(const CellView& view, const Chart& chart) {
  if (chart.kind == SourceKind::vertex) return true;
  if (chart.kind == SourceKind::face) return regions_.are_definite(chart.element, chart.u, chart.v);
  pieces_.restricted(chart.element, chart.u, {0, 1}, net_);
  for (std::size_t k = 0; k + 2 < net_.size(); ++k) {
    const dvec4 second = net_[k] - 2.0 * net_[k + 1] + net_[k + 2];
    const Corners y = heights_in(second, view);
    for (std::size_t c = 0; c < 4; ++c) {
      const double h = second.w > 0 ? chart.low[c] : chart.top[c];
      if (!(y[c] - h * second.w < -view.noise())) return false;
    }
  }
  return net_.size() > 2;
}

/// From the border of a patch's rectangle inwards, where nothing is glued to it.
bool ContactIndex::face_border_rises(const CellView& view, int index) {
  const std::array<int, 4>& glued = glued_[std::size_t(index)];
  if (std::all_of(glued.begin(), glued.end(), [](int g) { return g >= 0; })) return true;
  const Chart& chart = view_branches_->chart(index);
  const MapElement& element = pieces_.element(chart.element);
  const NetShape shape = pieces_.piece(element.root).exact.shape;
  pieces_.restricted(chart.element, chart.u, chart.v, net_);
  if (element.rational) even_weights(shape, net_);
  const auto at = [&](Side side, int along, int depth) -> const dvec4& {
    const int last = along_v(side) ? shape.p : shape.q;
    const int across = at_upper_end(side) ? last - depth : depth;
    const int i = along_v(side) ? across : along;
    const int j = along_v(side) ? along : across;
    return net_[std::size_t(i * (shape.q + 1) + j)];
  };
  for (const Side side : all_sides) {
    if (glued[std::size_t(side)] >= 0) continue;
    const int degree = along_v(side) ? shape.q : shape.p;
    Growth growth(view);
    for (int k = 0; k <= degree; ++k) growth.include(at(side, k, 0));
    const int across = along_v(side) ? shape.p : shape.q;
    // Inwards, and along the side so that the slope is much the same all over it.
    double own = 0;
    double mixed = 0;
    const auto middle = [&](const dvec4& p) {
      const Corners y = heights_in(p, view);
      return y[0] + y[1] + y[2] + y[3];
    };
    if (degree > 1) {
      const int k = (degree - 2) / 2;
      own = degree * (degree - 1) *
            middle(at(side, k, 0) - 2.0 * at(side, k + 1, 0) + at(side, k + 2, 0));
      const int l = (degree - 1) / 2;
      mixed = degree * across *
              middle(at(side, l + 1, 1) - at(side, l, 1) - at(side, l + 1, 0) + at(side, l, 0));
    }
    const double oblique = own != 0 ? std::clamp(-mixed / own, -most_oblique, most_oblique) : 0;
    const auto rises = [&](double m) {
      for (int k = 0; k <= degree; ++k) {
        dvec4 along(0.0);
        if (m != 0 && k > 0) along += double(k) * (at(side, k, 0) - at(side, k - 1, 0));
        if (m != 0 && k < degree) {
          along += double(degree - k) * (at(side, k + 1, 0) - at(side, k, 0));
        }
        if (!growth.along(double(across) * (at(side, k, 1) - at(side, k, 0)) + m * along)) {
          return false;
        }
      }
      return true;
    };
    if (!rises(0) && (oblique == 0 || !rises(oblique))) return false;
  }
  return true;
}

/// From the ends of an interval inwards, and from the surfaces beside it onto the edge.
bool ContactIndex::edge_border_rises(const CellView& view, int index) {
  const Chart& chart = view_branches_->chart(index);
  const MapElement& element = pieces_.element(chart.element);
  pieces_.restricted(chart.element, chart.u, {0, 1}, net_);
  const std::size_t last = net_.size() - 1;
  for (const std::size_t end : {0u, 1u}) {
    if (glued_[std::size_t(index)][end] >= 0) continue;
    Growth growth(view);
    const dvec4& own = end == 0 ? net_.front() : net_.back();
    growth.include(own);
    if (!growth.along((end == 0 ? net_[1] : net_[last - 1]) - own)) return false;
  }
  Growth growth(view);
  for (const dvec4& p : net_) growth.include(p);
  const MapPiece& root = pieces_.piece(element.root);
  std::vector<dvec4> inward;
  for (std::size_t k = 0; k < root.inward.size(); ++k) {
    if (is_beside(index, element.beside[k])) continue;
    const StoredNet& net = root.inward[k];
    const dvec4* p = pieces_.points(net);
    inward.assign(p, p + net.shape.size());
    restrict_net(net.shape, inward.data(), chart.u, Interval{0, 1});
    for (const dvec4& vector : inward) {
      if (!growth.along(-vector)) return false;
    }
  }
  return true;
}

/// A patch whose border the edge is belongs to the branch.
bool ContactIndex::is_beside(int edge, int element) const {
  return element >= 0 && std::any_of(beside_.begin(), beside_.end(), [&](const auto& pair) {
           return pair.first == edge && view_branches_->chart(pair.second).element == element;
         });
}

/// The edges at a vertex fall away from it, but for those that belong to the branch.
bool ContactIndex::vertex_border_rises(const CellView& view, int index) {
  const Chart& chart = view_branches_->chart(index);
  const MapElement& element = pieces_.element(chart.element);
  const MapPiece& root = pieces_.piece(element.root);
  Growth growth(view);
  growth.include(*pieces_.points(root.net));
  for (std::size_t k = 0; k < root.inward.size(); ++k) {
    if (is_beside(index, element.beside[k])) continue;
    if (!growth.along(-*pieces_.points(root.inward[k]))) return false;
  }
  return true;
}

/// Points at which charts meet all around: corners of patches, poles.
int ContactIndex::closed_points(const Branch& branch) {
  poles_.clear();
  const Branches& branches = *view_branches_;
  // One step around the corner, over a join; where there is none, the edge or vertex beyond.
  const auto step = [&](const AtCorner& from, int& end) -> std::optional<AtCorner> {
    const int g = glued_[std::size_t(from.chart)][std::size_t(from.next)];
    if (g < 0) return std::nullopt;
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::faces) {
      end = glue.b;
      return std::nullopt;
    }
    const bool is_a = glue.a == from.chart && glue.at_a == int(from.next);
    const int chart = is_a ? glue.b : glue.a;
    const Side side = Side(is_a ? glue.at_b : glue.at_a);
    const bool upper = at_upper_end(from.other) != glue.reversed;
    const Side across = along_v(side) ? (upper ? Side::v1 : Side::v0) : (upper ? Side::u1 : Side::u0);
    // About a pole, one goes on over the opposite side.
    const bool is_pole = pieces_.element(branches.chart(chart).element).collapsed[std::size_t(across)];
    if (!is_at(branches.chart(chart), across)) return std::nullopt;
    if (!is_pole) return AtCorner{chart, across, side};
    if (!is_at(branches.chart(chart), other_way(side))) return std::nullopt;
    return AtCorner{chart, other_way(side), across};
  };
  const auto code = [](const AtCorner& at) {
    return std::array<int, 3>{at.chart, int(at.next), int(at.other)};
  };
  int count = 0;
  std::set<std::array<int, 3>> passed;
  for (const int k : branch.charts) {
    const Chart& chart = branches.chart(k);
    if (chart.kind != SourceKind::face) continue;
    const auto& collapsed = pieces_.element(chart.element).collapsed;
    for (const Side u : {Side::u0, Side::u1}) {
      for (const Side v : {Side::v0, Side::v1}) {
        if (!is_at(chart, u) || !is_at(chart, v)) continue;
        if (collapsed[std::size_t(u)] && collapsed[std::size_t(v)]) continue;
        const AtCorner start = collapsed[std::size_t(u)] ? AtCorner{k, v, u} : AtCorner{k, u, v};
        if (collapsed[std::size_t(start.other)] && !is_at(chart, other_way(start.next))) continue;
        if (passed.contains(code(start))) continue;
        // Around, as far as it goes.
        int end = -1;
        bool closed = false;
        std::vector<AtCorner> ring = {start};
        for (std::optional<AtCorner> at = step(start, end); at; at = step(*at, end)) {
          if (code(*at) == code(start)) {
            closed = true;
            break;
          }
          if (ring.size() > branch.charts.size() * 4) break;
          ring.push_back(*at);
        }
        const bool is_pole = collapsed[std::size_t(start.other)];
        if (!closed && !is_pole) {
          // The other way around, to the other edge.
          int other_end = -1;
          const AtCorner back{k, start.other, start.next};
          std::vector<AtCorner> more = {back};
          for (std::optional<AtCorner> at = step(back, other_end); at; at = step(*at, other_end)) {
            if (more.size() > branch.charts.size() * 4) break;
            more.push_back(*at);
          }
          closed = end >= 0 && other_end >= 0 && meet(branch, end, other_end);
          ring.insert(ring.end(), more.begin(), more.end());
        }
        // The same point is met from each of its charts, both ways around.
        for (const AtCorner& at : ring) {
          passed.insert({at.chart, int(at.next), int(at.other)});
          passed.insert({at.chart, int(at.other), int(at.next)});
          if (is_pole) passed.insert({at.chart, int(other_way(at.next)), int(at.other)});
          if (is_pole && closed) poles_.emplace_back(at.chart, at.other);
        }
        count += closed ? 1 : 0;
      }
    }
  }
  return count;
}

/// Two edges go on into each other, or end in one vertex of the branch.
bool ContactIndex::meet(const Branch& branch, int a, int b) const {
  std::vector<int> at_a, at_b;
  for (const int g : branch.glues) {
    const Glue& glue = view_branches_->glue(g);
    if (glue.kind == Glue::Kind::edges &&
        ((glue.a == a && glue.b == b) || (glue.a == b && glue.b == a))) {
      return true;
    }
    if (glue.kind != Glue::Kind::edge_vertex) continue;
    if (glue.a == a) at_a.push_back(glue.b);
    if (glue.a == b) at_b.push_back(glue.b);
  }
  return std::any_of(at_a.begin(), at_a.end(), [&](int vertex) {
    return std::count(at_b.begin(), at_b.end(), vertex) > 0;
  });
}

bool ContactIndex::is_disc(const Branches& branches, const Branch& branch) {
  view_branches_ = &branches;
  // Two charts of one element that overlap count twice what is in both.
  for (const int a : branch.charts) {
    for (const int b : branch.charts) {
      const Chart& s = branches.chart(a);
      const Chart& t = branches.chart(b);
      if (a < b && s.element == t.element && s.kind == SourceKind::face &&
          s.u.lower < t.u.upper && t.u.lower < s.u.upper && s.v.lower < t.v.upper &&
          t.v.lower < s.v.upper) {
        return false;
      }
    }
  }
  glued_.assign(branches.charts().size(), {-1, -1, -1, -1});
  beside_.clear();
  DisjointSets sets(branches.charts().size());
  int arcs = 0;
  const double size = glm::distance(branch.lower, branch.upper);
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind == Glue::Kind::face_vertex) continue;
    ++arcs;
    sets.unite(glue.a, glue.b);
    int& at_a = glued_[std::size_t(glue.a)][std::size_t(glue.at_a)];
    if (at_a >= 0) return false;
    at_a = g;
    if (glue.kind == Glue::Kind::faces || glue.kind == Glue::Kind::edges) {
      int& at_b = glued_[std::size_t(glue.b)][std::size_t(glue.at_b)];
      if (at_b >= 0) return false;
      at_b = g;
    } else {
      beside_.emplace_back(glue.b, glue.a);
    }
    if (glue.kind == Glue::Kind::faces) {
      const double kink = pieces_.element(branches.chart(glue.a).element).kink[std::size_t(glue.at_a)];
      if (!(kink * size <= rho_)) return false;
    }
  }
  for (const int k : branch.charts) {
    if (sets.find(k) != sets.find(branch.charts.front())) return false;
  }
  const int closed = closed_points(branch);
  for (const auto& [chart, side] : poles_) glued_[std::size_t(chart)][std::size_t(side)] = 0;
  return int(branch.charts.size()) - arcs + closed == 1;
}

bool ContactIndex::is_one(const CellView& view, const Branches& branches, const Branch& branch) {
  if (!is_disc(branches, branch)) return false;
  const bool rises = std::all_of(branch.charts.begin(), branch.charts.end(), [&](int k) {
    const SourceKind kind = branches.chart(k).kind;
    return kind == SourceKind::face   ? face_border_rises(view, k)
           : kind == SourceKind::edge ? edge_border_rises(view, k)
                                      : vertex_border_rises(view, k);
  });
  return rises && std::all_of(branch.charts.begin(), branch.charts.end(),
                              [&](int k) { return is_curved(view, branches.chart(k)); });
}

}  // namespace taut
