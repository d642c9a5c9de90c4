#include "taut/hull/decide/contact_index.h"

#include <algorithm>

#include "taut/bounds/vector_net.h"
#include "taut/core/disjoint_sets.h"
#include "taut/hull/decide/parameter_region.h"

namespace taut {
namespace {

/// The most that a direction inwards leads along the side, in the chart's parameters from 0 to 1:
/// at a corner, where it is exchanged for that of the other side, what is between leads inwards
/// too.
constexpr double most_oblique = 0.99;

/// In units of the resolution: what is smaller may be taken for a point.
constexpr double point_size = 4;

/// How often a surface is let reach further: each time it becomes up to three times as wide.
constexpr int extension_limit = 24;

Corners heights_in(const CellView& view, const dvec4& p) {
  return heights(p, view.q(), view.corners());
}

}  // namespace

/// Of homogeneous points and vectors from them: the heights surely grow along all the vectors, for
/// points between the points.
class ContactIndex::Growth {
 public:
  /// Along vectors of length one by more than `tilt`.
  explicit Growth(const CellView& view, double tilt = 0) : view_(view), tilt_(tilt) {
    lower_.fill(infinity);
    upper_.fill(-infinity);
  }
  void include(const dvec4& point) {
    const Corners y = heights_in(view_, point);
    for (std::size_t c = 0; c < 4; ++c) {
      lower_[c] = std::min(lower_[c], y[c] / point.w);
      upper_[c] = std::max(upper_[c], y[c] / point.w);
    }
  }
  bool along(const dvec4& vector) const {
    const Corners y = heights_in(view_, vector);
    const double least = view_.noise() + (tilt_ > 0 ? tilt_ * glm::length(dvec3(vector)) : 0);
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(y[c] - (vector.w > 0 ? upper_[c] : lower_[c]) * vector.w > least)) return false;
    }
    return true;
  }

 private:
  const CellView& view_;
  double tilt_;
  Corners lower_, upper_;
};

/// Strictly, so that every point at which a plane touches counts one.
bool ContactIndex::is_curved(const CellView& view, const Chart& chart) {
  if (chart.kind == SourceKind::vertex) return true;
  if (stand_ins_.is_stand_in(chart)) return true;  // are_points() tells
  if (chart.kind == SourceKind::face) return regions_.are_definite(chart.element, chart.u, chart.v);
  pieces_.restricted(chart.element, chart.u, {0, 1}, net_);
  Growth growth(view);
  for (const dvec4& p : net_) growth.include(p);
  for (std::size_t k = 0; k + 2 < net_.size(); ++k) {
    if (!growth.along(2.0 * net_[k + 1] - net_[k] - net_[k + 2])) return false;
  }
  return net_.size() > 2;
}

/// The control points of a patch over a chart's rectangle, for side_rises().
void ContactIndex::show(int index) {
  const Chart& chart = view_branches_->chart(index);
  show(chart.element, chart.u, chart.v);
}

void ContactIndex::show(int index, const Interval& u, const Interval& v) {
  const MapElement& element = pieces_.element(index);
  pieces_.restricted(index, u, v, net_);
  if (element.rational) even_weights(element.root->exact.shape, net_);
}

/// From the border of a patch's rectangle inwards, where nothing is glued to it.
bool ContactIndex::face_border_rises(const CellView& view, int index) {
  const std::array<int, 4>& glued = glued_[std::size_t(index)];
  if (std::all_of(glued.begin(), glued.end(), [](int g) { return g >= 0; })) return true;
  show(index);
  const int element = view_branches_->chart(index).element;
  const NetShape shape = pieces_.element(element).root->exact.shape;
  const auto is_apart = [&](Side side) {
    const std::array beside =
        along_v(side) ? std::array{Side::v0, Side::v1} : std::array{Side::u0, Side::u1};
    return glued[std::size_t(beside[0])] < 0 && glued[std::size_t(beside[1])] < 0;
  };
  return std::all_of(all_sides.begin(), all_sides.end(), [&](Side side) {
    return glued[std::size_t(side)] >= 0 || side_rises(view, shape, side) ||
           (is_apart(side) && side_has_no_low(view, shape, side));
  });
}

/// No height along the side is lower than those on both sides of it: it is concave, or monotone.
bool ContactIndex::side_has_no_low(const CellView& view, const NetShape& shape, Side side) const {
  if (tilt_ > 0) return false;
  const int degree = along_v(side) ? shape.q : shape.p;
  const int fixed = at_upper_end(side) ? (along_v(side) ? shape.p : shape.q) : 0;
  const auto at = [&](int along) -> const dvec4& {
    const int i = along_v(side) ? fixed : along;
    const int j = along_v(side) ? along : fixed;
    return net_[std::size_t(i * (shape.q + 1) + j)];
  };
  Growth growth(view);
  for (int k = 0; k <= degree; ++k) growth.include(at(k));
  bool concave = degree > 1;
  for (int k = 0; k + 2 <= degree && concave; ++k) {
    concave = growth.along(2.0 * at(k + 1) - at(k) - at(k + 2));
  }
  bool grows = !concave;
  bool falls = !concave;
  for (int k = 0; k < degree; ++k) {
    grows = grows && growth.along(at(k + 1) - at(k));
    falls = falls && growth.along(at(k) - at(k + 1));
  }
  return concave || grows || falls;
}

/// Inwards, or also along the side so that the slope is much the same all over it.
bool ContactIndex::side_rises(const CellView& view, const NetShape& shape, Side side,
                              bool obliquely) const {
  const int degree = along_v(side) ? shape.q : shape.p;
  const int across = along_v(side) ? shape.p : shape.q;
  const auto at = [&](int along, int depth) -> const dvec4& {
    const int k = at_upper_end(side) ? across - depth : depth;
    const int i = along_v(side) ? k : along;
    const int j = along_v(side) ? along : k;
    return net_[std::size_t(i * (shape.q + 1) + j)];
  };
  Growth growth(view, tilt_);
  for (int k = 0; k <= degree; ++k) growth.include(at(k, 0));
  const auto rises = [&](double m) {
    for (int k = 0; k <= degree; ++k) {
      dvec4 along(0.0);
      if (m != 0 && k > 0) along += double(k) * (at(k, 0) - at(k - 1, 0));
      if (m != 0 && k < degree) along += double(degree - k) * (at(k + 1, 0) - at(k, 0));
      if (!growth.along(double(across) * (at(k, 1) - at(k, 0)) + m * along)) return false;
    }
    return true;
  };
  if (rises(0)) return true;
  if (degree < 2 || !obliquely) return false;
  const auto middle = [&](const dvec4& p) {
    const Corners y = heights_in(view, p);
    return y[0] + y[1] + y[2] + y[3];
  };
  const int k = (degree - 2) / 2;
  const double own = degree * (degree - 1) * middle(at(k, 0) - 2.0 * at(k + 1, 0) + at(k + 2, 0));
  const int l = (degree - 1) / 2;
  const double mixed = degree * across * middle(at(l + 1, 1) - at(l, 1) - at(l + 1, 0) + at(l, 0));
  const double oblique = own != 0 ? std::clamp(-mixed / own, -most_oblique, most_oblique) : 0;
  return oblique != 0 && rises(oblique);
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
  const MapPiece& root = *element.root;
  std::vector<std::vector<dvec4>> inside;
  for (std::size_t k = 0; k < root.inward.size(); ++k) {
    const StoredNet& net = root.inward[k];
    const dvec4* p = net.points;
    std::vector<dvec4> inward(p, p + net.shape.size());
    restrict_net(net.shape, inward.data(), chart.u, Interval{0, 1});
    if (is_beside(index, element.beside[k])) {
      inside.push_back(std::move(inward));
    } else if (!std::all_of(inward.begin(), inward.end(),
                            [&](const dvec4& vector) { return growth.along(-vector); })) {
      return false;
    }
  }
  return fold_outwards(growth, inside);
}

/// No two of the surfaces or edges that end at a chart, both in the branch, grow from it at once:
/// the sum of their vectors, in like lengths, falls. Else the chart were the floor of a fold.
bool ContactIndex::fold_outwards(const Growth& growth,
                                 const std::vector<std::vector<dvec4>>& inward) {
  const auto longest = [](const std::vector<dvec4>& vectors) {
    double length = 0;
    for (const dvec4& v : vectors) length = std::max(length, glm::length(dvec3(v)));
    return length;
  };
  for (std::size_t a = 0; a < inward.size(); ++a) {
    for (std::size_t b = a + 1; b < inward.size(); ++b) {
      if (inward[a].size() != inward[b].size()) return false;
      const double share = longest(inward[a]) / longest(inward[b]);
      for (std::size_t k = 0; k < inward[a].size(); ++k) {
        if (!growth.along(-inward[a][k] - share * inward[b][k])) return false;
      }
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
  const MapPiece& root = *element.root;
  Growth growth(view);
  growth.include(*root.net.points);
  std::vector<std::vector<dvec4>> inside;
  for (std::size_t k = 0; k < root.inward.size(); ++k) {
    const dvec4 tangent = *root.inward[k].points;
    if (is_beside(index, element.beside[k])) {
      inside.push_back({tangent});
    } else if (!growth.along(-tangent)) {
      return false;
    }
  }
  return fold_outwards(growth, inside);
}

/// The largest angle by which two charts that go on into each other miss a smooth way.
double ContactIndex::kink(const Glue& glue) {
  if (glue.kind == Glue::Kind::faces) {
    const MapElement& element = pieces_.element(view_branches_->chart(glue.a).element);
    return element.kink[std::size_t(glue.at_a)];
  }
  if (glue.kind != Glue::Kind::edges) return 0;
  const auto tangent = [&](int chart, int end) {
    const int element = view_branches_->chart(chart).element;
    pieces_.restricted(element, {0, 1}, {0, 1}, net_);
    const std::size_t last = net_.size() - 1;
    return unit(end == 0 ? euclidean(net_[1]) - euclidean(net_[0])
                         : euclidean(net_[last - 1]) - euclidean(net_[last]));
  };
  return glm::length(tangent(glue.a, glue.at_a) + tangent(glue.b, glue.at_b));
}

/// Two charts span the same stretch of what they share.
bool ContactIndex::is_whole(const Branches& branches, const Glue& glue) {
  if (glue.kind != Glue::Kind::faces && glue.kind != Glue::Kind::face_edge) return true;
  const Interval& own = along(branches.chart(glue.a), Side(glue.at_a));
  const Chart& other = branches.chart(glue.b);
  const Interval& b = glue.kind == Glue::Kind::faces ? along(other, Side(glue.at_b)) : other.u;
  return glue.reversed ? own.lower == 1 - b.upper && own.upper == 1 - b.lower
                       : own.lower == b.lower && own.upper == b.upper;
}

bool ContactIndex::find_glued(const Branches& branches, const Branch& branch) {
  view_branches_ = &branches;
  glued_.assign(branches.charts().size(), {-1, -1, -1, -1});
  beside_.clear();
  glue_count_ = 0;
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind == Glue::Kind::face_vertex) continue;
    if (!is_whole(branches, glue)) return false;
    ++glue_count_;
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
  }
  return true;
}

/// Two charts of one element that overlap: what is in both would count twice.
bool ContactIndex::any_overlap(const Branches& branches, const Branch& branch) {
  std::vector<int> order = branch.charts;
  const auto element = [&](int k) { return branches.chart(k).element; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return element(a) < element(b); });
  for (std::size_t a = 0; a < order.size(); ++a) {
    const Chart& s = branches.chart(order[a]);
    if (s.kind != SourceKind::face) continue;
    for (std::size_t b = a + 1; b < order.size() && element(order[b]) == s.element; ++b) {
      const Chart& t = branches.chart(order[b]);
      if (s.u.lower < t.u.upper && t.u.lower < s.u.upper && s.v.lower < t.v.upper &&
          t.v.lower < s.v.upper) {
        return true;
      }
    }
  }
  return false;
}

bool ContactIndex::is_disc(const Branches& branches, const Branch& branch) {
  if (any_overlap(branches, branch) || !find_glued(branches, branch)) return false;
  DisjointSets sets(branches.charts().size());
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::face_vertex) sets.unite(glue.a, glue.b);
  }
  for (const int k : branch.charts) {
    if (sets.find(k) != sets.find(branch.charts.front())) return false;
  }
  rings_.find(branches, branch, glued_);
  if (int(branch.charts.size()) - glue_count_ + rings_.count() != 1) return false;
  find_ends(branches, branch);
  for (const auto& [chart, side] : rings_.poles()) {
    glued_[std::size_t(chart)][std::size_t(side)] = 0;  // no border is there
  }
  return true;
}

void ContactIndex::find_ends(const Branches& branches, const Branch& branch) {
  ends_.clear();
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::faces) continue;
    const Side side = Side(glue.at_a);
    for (const bool upper : {false, true}) {
      const Side border = side_at_end(side, upper);
      if (rings_.is_inside(glue.a, side, border)) continue;
      const Side there = Side(glue.at_b);
      const Side border_there = side_at_end(there, upper != glue.reversed);
      std::optional<CornerRings::Fan> fan = rings_.fan(glue.a, side, border);
      if (!fan && !is_at(branches.chart(glue.a), border)) {
        fan = {{{glue.a, border, side}, {glue.b, border_there, there}}};
      }
      if (fan && std::any_of(fan->begin(), fan->end(), [&](const CornerRings::Corner& c) {
            return glued_[std::size_t(c.chart)][std::size_t(c.next)] >= 0;
          })) {
        fan.reset();  // not the last ones
      }
      ends_.push_back({{glue.a, side, border}, {glue.b, border_there}, fan});
    }
  }
}

bool ContactIndex::bends_down(const CellView& view, const Branches& branches,
                              const Branch& branch) {
  view_branches_ = &branches;
  const double size = glm::distance(branch.lower, branch.upper);
  double kinks = 0;
  for (const int g : branch.glues) {
    const double own = kink(branches.glue(g));
    kinks += own;
    if (!(own * size <= rho_)) return false;
  }
  if (!(kinks * size <= kink_share * rho_)) return false;
  tilt_ = 0;
  const bool curved = std::all_of(branch.charts.begin(), branch.charts.end(),
                                  [&](int k) { return is_curved(view, branches.chart(k)); });
  if (curved) return stand_ins_.are_points(branches, branch, rho_);
  return is_nearly_concave(view, branches, branch);
}

/// Let D be the extent of the branch, h the heights less e |x - c|^2 with c in its box and
/// e = rho / (4 D^2). Where h has no slope, the normal is d - 2 e (x - c), of a length less than
/// 2, and h is concave there if the curvature towards it is less than e, for its second derivatives
/// are that times the length less 2 e. The slopes of h differ from those of the heights by 2 e D.
bool ContactIndex::is_nearly_concave(const CellView& view, const Branches& branches,
                                     const Branch& branch) {
  const double size = glm::distance(branch.lower, branch.upper);
  tilt_ = rho_ / (2 * size);
  return std::all_of(branch.charts.begin(), branch.charts.end(), [&](int k) {
    const Chart& chart = branches.chart(k);
    return chart.kind == SourceKind::face &&
           regions_.are_nearly_concave(chart.element, chart.u, chart.v, view.corners(),
                                       rho_ / (4 * size * size));
  });
}

bool ContactIndex::border_rises(const CellView& view, int chart) {
  const SourceKind kind = view_branches_->chart(chart).kind;
  return kind == SourceKind::face   ? face_border_rises(view, chart)
         : kind == SourceKind::edge ? edge_border_rises(view, chart)
                                    : vertex_border_rises(view, chart);
}

/// What leads from a corner of a chart along its two sides.
ContactIndex::CornerRays ContactIndex::rays(const CornerRings::Corner& corner) {
  show(corner.chart);
  const int element = view_branches_->chart(corner.chart).element;
  const NetShape shape = pieces_.element(element).root->exact.shape;
  const bool of_v = along_v(corner.next);
  const bool upper_u = at_upper_end(of_v ? corner.next : corner.other);
  const bool upper_v = at_upper_end(of_v ? corner.other : corner.next);
  const auto at = [&](int i, int j) -> const dvec4& {
    const int k = upper_u ? shape.p - i : i;
    const int l = upper_v ? shape.q - j : j;
    return net_[std::size_t(k * (shape.q + 1) + l)];
  };
  const dvec3 own = euclidean(at(0, 0));
  const dvec3 ways[] = {euclidean(at(1, 0)) - own, euclidean(at(0, 1)) - own};
  return {at(0, 0), ways[of_v ? 1 : 0], ways[of_v ? 0 : 1]};
}

/// From where charts meet on the border heights grow along what two of them share; or straight
/// inwards from both of their borders there, which leads to the same side of a notch.
bool ContactIndex::join_rises(const CellView& view, const JoinEnd& end) {
  const CornerRays own = rays(end.at);
  Growth growth(view, tilt_);
  growth.include(own.corner);
  if (growth.along({own.next, 0})) return true;
  return end.fan && std::all_of(end.fan->begin(), end.fan->end(), [&](const auto& corner) {
           const CornerRays last = rays(corner);
           const dvec3 border = unit(last.next);
           return growth.along({last.other - glm::dot(last.other, border) * border, 0});
         });
}

bool ContactIndex::joins_rise(const CellView& view) {
  return std::all_of(ends_.begin(), ends_.end(),
                     [&](const JoinEnd& end) { return join_rises(view, end); });
}

bool ContactIndex::is_one(const CellView& view, const Branches& branches, const Branch& branch) {
  if (glm::distance(branch.lower, branch.upper) <= point_size * rho_) return true;
  return is_cap(view, branches, branch) && joins_rise(view) &&
         std::all_of(branch.charts.begin(), branch.charts.end(),
                     [&](int k) { return border_rises(view, k); });
}

bool ContactIndex::are_one_of_more(const CellView& view, Branches branches) {
  std::vector<std::pair<int, Side>> beyond;
  for (int round = 0; round < extension_limit; ++round) {
    beyond.clear();
    const bool one = branches.all().size() == 1;
    for (const Branch& branch : branches.all()) {
      if (!bends_down(view, branches, branch) || !find_glued(branches, branch)) return false;
      tilt_ = 0;
      if (!add_falling(view, branch, one, beyond)) return false;
    }
    if (beyond.empty()) {
      // Now it is to be a cap, of which less may be a border and heights have to grow by more.
      const Branch& all = branches.all().front();
      if (!one || !is_cap(view, branches, all) || !add_falling(view, all, true, beyond))
        return false;
      if (beyond.empty() && !add_ends(view, beyond)) return false;
      if (beyond.empty()) return true;
    }
    if (!branches.extend(pieces_, beyond)) return false;
  }
  return false;
}

/// The borders beside joins from whose ends the heights do not grow inwards. False if there are
/// none.
bool ContactIndex::add_ends(const CellView& view, std::vector<std::pair<int, Side>>& sides) {
  for (const JoinEnd& end : ends_) {
    if (join_rises(view, end)) continue;
    const std::size_t before = sides.size();
    for (const std::pair<int, Side>& side : {std::pair(end.at.chart, end.at.other), end.beside}) {
      if (glued_[std::size_t(side.first)][std::size_t(side.second)] < 0) sides.push_back(side);
    }
    if (sides.size() == before) return false;
  }
  return true;
}

/// Nothing is beyond it.
bool ContactIndex::is_pole(const Chart& chart, Side side) const {
  return is_at(chart, side) && pieces_.is_pole(pieces_.element(chart.element), side);
}

/// The sides of a branch beyond which it has to reach further: from which heights do not grow
/// inwards, and if it is `alone` not from where it matters. False if they do not so from edges or
/// vertices.
bool ContactIndex::add_falling(const CellView& view, const Branch& branch, bool alone,
                               std::vector<std::pair<int, Side>>& sides) {
  for (const int k : branch.charts) {
    const Chart& chart = view_branches_->chart(k);
    const bool is_face = chart.kind == SourceKind::face;
    if ((alone || !is_face) && border_rises(view, k)) continue;
    if (!is_face) return false;
    show(k);
    const NetShape shape = pieces_.element(chart.element).root->exact.shape;
    for (const Side side : all_sides) {
      if (glued_[std::size_t(k)][std::size_t(side)] >= 0 || is_pole(chart, side)) continue;
      if (!side_rises(view, shape, side)) sides.emplace_back(k, side);
    }
  }
  return true;
}

/// Beyond a side from which the heights do not grow inwards the region goes on, as far as it may.
bool ContactIndex::is_one_of_pieces(const CellView& view, const Branches& branches,
                                    const Branch& branch) {
  const Chart& chart = branches.chart(branch.charts.front());
  if (branch.charts.size() > 1 || chart.kind != SourceKind::face || chart.pieces.size() < 3) {
    return false;
  }
  const MapElement& element = pieces_.element(chart.element);
  const NetShape shape = element.root->exact.shape;
  std::vector<ParameterRegion::Cell> rectangles;
  for (const int k : chart.pieces) {
    const MapPiece& piece = *view.seen()[std::size_t(k)].piece;
    rectangles.push_back({piece.u, piece.v});
    if (!regions_.are_definite(chart.element, piece.u, piece.v)) return false;
  }
  ParameterRegion region(rectangles);
  tilt_ = 0;
  for (int round = 0; round < extension_limit; ++round) {
    if (!region.is_disc()) return false;
    bool any = false;
    // Where heights grow inwards obliquely, or not at all.
    std::vector<ParameterRegion::BorderSide> others;
    for (const ParameterRegion::BorderSide& side : region.border()) {
      const ParameterRegion::Cell cell = region.cell(side.i, side.j);
      show(chart.element, cell.u, cell.v);
      if (side_rises(view, shape, side.side, false)) continue;
      if (side_rises(view, shape, side.side, true) || side_has_no_low(view, shape, side.side)) {
        others.push_back(side);
        continue;
      }
      const std::optional<ParameterRegion::Cell> beyond = region.extend(side);
      if (!beyond || !regions_.are_definite(chart.element, beyond->u, beyond->v)) return false;
      any = true;
    }
    if (!any) return !region.any_end_inwards(others);
  }
  return false;
}

}  // namespace taut
