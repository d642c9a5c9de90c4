#include "taut/hull/decide/branches.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "taut/core/disjoint_sets.h"

namespace taut {
namespace {

/// Passes over the glue after which charts are as they are: each carries a change one chart on.
constexpr int evening_limit = 32;

bool touches(const Interval& a, const Interval& b) {
  return a.lower <= b.upper && b.lower <= a.upper;
}

bool include(Interval& range, const Interval& other) {
  const bool grows = other.lower < range.lower || other.upper > range.upper;
  range.lower = std::min(range.lower, other.lower);
  range.upper = std::max(range.upper, other.upper);
  return grows;
}

Interval turned(const Interval& t, bool reversed) {
  return reversed ? Interval{1 - t.upper, 1 - t.lower} : t;
}

Interval& along(Chart& chart, Side side) { return along_v(side) ? chart.v : chart.u; }

/// The strip of no width along a side.
std::array<Interval, 2> strip(Side side, const Interval& t) {
  const double fixed = at_upper_end(side) ? 1 : 0;
  const Interval across{fixed, fixed};
  return along_v(side) ? std::array{across, t} : std::array{t, across};
}

}  // namespace

const Interval& along(const Chart& chart, Side side) { return along_v(side) ? chart.v : chart.u; }

Side side_at_end(Side side, bool upper) {
  return along_v(side) ? (upper ? Side::v1 : Side::v0) : (upper ? Side::u1 : Side::u0);
}

bool is_at(const Chart& chart, Side side) {
  const Interval& across = along_v(side) ? chart.u : chart.v;
  return at_upper_end(side) ? across.upper == 1 : across.lower == 0;
}

void Branches::clear() {
  charts_.clear();
  branches_.clear();
  glues_.clear();
}

void Branches::keep(const std::vector<bool>& left) {
  std::vector<Branch> all;
  all.swap(branches_);
  for (std::size_t b = 0; b < all.size(); ++b) {
    for (const int k : all[b].charts) {
      charts_[std::size_t(k)].branch = left[b] ? int(branches_.size()) : -1;
    }
    if (left[b]) branches_.push_back(std::move(all[b]));
  }
}

void Branches::find(const CellView& view) {
  clear();
  make_charts(view);
  glue(view.pieces());
  sort_into_branches(view.pieces());
  find_boxes(view);
}

void Branches::glue(const MapPieces& pieces) {
  glues_.clear();
  sort_charts();
  for (int k = 0; k < int(charts_.size()); ++k) {
    if (charts_[std::size_t(k)].kind == SourceKind::face) glue_face(pieces, k);
    if (charts_[std::size_t(k)].kind == SourceKind::edge) glue_edge(pieces, k);
  }
  even_out();
}

void Branches::unite() {
  Branch all;
  for (const Branch& branch : branches_) {
    all.charts.insert(all.charts.end(), branch.charts.begin(), branch.charts.end());
    all.glues.insert(all.glues.end(), branch.glues.begin(), branch.glues.end());
    all.lower = glm::min(all.lower, branch.lower);
    all.upper = glm::max(all.upper, branch.upper);
  }
  for (const int k : all.charts) charts_[std::size_t(k)].branch = 0;
  branches_ = {std::move(all)};
}

Branches Branches::alone(const Branch& branch) const {
  Branches result;
  std::vector<int> index(charts_.size(), -1);
  result.branches_.push_back(branch);
  Branch& own = result.branches_.front();
  for (int& k : own.charts) {
    index[std::size_t(k)] = int(result.charts_.size());
    result.charts_.push_back(charts_[std::size_t(k)]);
    result.charts_.back().branch = 0;
    k = index[std::size_t(k)];
  }
  for (int& g : own.glues) {
    Glue glue = glues_[std::size_t(g)];
    glue.a = index[std::size_t(glue.a)];
    glue.b = index[std::size_t(glue.b)];
    g = int(result.glues_.size());
    result.glues_.push_back(glue);
  }
  return result;
}

bool Branches::extend(const MapPieces& pieces, const std::vector<std::pair<int, Side>>& beyond) {
  sort_charts();
  for (const auto& [chart, side] : beyond) {
    if (!extend(pieces, chart, side)) return false;
  }
  join_touching();
  glue(pieces);
  if (join_touching()) glue(pieces);
  sort_into_branches(pieces);
  for (Branch& branch : branches_) {
    std::vector<dvec4> net;
    for (const int k : branch.charts) {
      const Chart& chart = charts_[std::size_t(k)];
      pieces.restricted(chart.element, chart.u, chart.v, net);
      for (const dvec4& p : net) {
        branch.lower = glm::min(branch.lower, euclidean(p));
        branch.upper = glm::max(branch.upper, euclidean(p));
      }
    }
  }
  return true;
}

/// Charts of one element that have grown together are one.
bool Branches::join_touching() {
  sort_charts();
  std::vector<bool> goes(charts_.size(), false);
  bool any = false;
  for (std::size_t k = 0; k < of_elements_.size(); ++k) {
    const int index = of_elements_[k].second;
    if (goes[std::size_t(index)]) continue;
    Chart& own = charts_[std::size_t(index)];
    for (std::size_t l = k + 1; l < of_elements_.size() && of_elements_[l].first == own.element;) {
      const auto other = std::size_t(of_elements_[l++].second);
      const Chart& next = charts_[other];
      if (goes[other] || !touches(own.u, next.u) || !touches(own.v, next.v)) continue;
      include(own.u, next.u);
      include(own.v, next.v);
      own.pieces.insert(own.pieces.end(), next.pieces.begin(), next.pieces.end());
      goes[other] = any = true;
      l = k + 1;
    }
  }
  if (!any) return false;
  std::size_t left = 0;
  for (std::size_t k = 0; k < charts_.size(); ++k) {
    if (goes[k]) continue;
    if (left != k) charts_[left] = std::move(charts_[k]);
    ++left;
  }
  charts_.resize(left);
  return true;
}

bool Branches::extend(const MapPieces& pieces, int index, Side side) {
  Chart& chart = charts_[std::size_t(index)];
  Interval& across = along_v(side) ? chart.u : chart.v;
  const double width = across.upper - across.lower;
  if (!is_at(chart, side)) {
    if (at_upper_end(side)) {
      across.upper = std::min(1.0, across.upper + width);
    } else {
      across.lower = std::max(0.0, across.lower - width);
    }
    return true;
  }
  const Contact& c = pieces.element(chart.element).contact;
  const Border& border = pieces.geometry().patch(c).borders[std::size_t(side)];
  if (border.kind != BorderKind::smooth) return false;
  const int element = pieces.find({c.instance, SourceKind::face, border.neighbor, 0, 0});
  if (element < 0) return false;
  const Side there = border.neighbor_side;
  Chart next{element, SourceKind::face, {0, 1}, {0, 1}, {}, -1};
  Interval& beyond = along_v(there) ? next.u : next.v;
  beyond = at_upper_end(there) ? Interval{1 - width, 1} : Interval{0, width};
  along(next, there) = turned(along(chart, side), border.reversed);
  const int known = chart_touching(element, next.u, next.v);
  if (known >= 0) {
    include(charts_[std::size_t(known)].u, next.u);
    include(charts_[std::size_t(known)].v, next.v);
  } else {
    const std::pair<int, int> own(element, int(charts_.size()));
    of_elements_.insert(std::upper_bound(of_elements_.begin(), of_elements_.end(), own), own);
    charts_.push_back(std::move(next));
  }
  return true;
}

void Branches::make_charts(const CellView& view) {
  const std::vector<SeenPiece>& seen = view.seen();
  const MapPieces& pieces = view.pieces();
  const auto piece = [&](int k) -> const MapPiece& { return *seen[std::size_t(k)].piece; };
  rest_.resize(seen.size());
  std::iota(rest_.begin(), rest_.end(), 0);
  std::stable_sort(rest_.begin(), rest_.end(),
                   [&](int a, int b) { return piece(a).element < piece(b).element; });
  // Those of one element; -1: in a chart already.
  for (auto begin = rest_.begin(); begin != rest_.end();) {
    const int element = piece(*begin).element;
    const auto end =
        std::find_if(begin, rest_.end(), [&](int k) { return piece(k).element != element; });
    const SourceKind kind = pieces.element(element).contact.kind;
    for (auto first = begin; first != end; ++first) {
      if (*first < 0) continue;
      Chart chart{element, kind, piece(*first).u, piece(*first).v, {*first}, -1};
      *first = -1;
      for (std::size_t next = 0; next < chart.pieces.size(); ++next) {
        const MapPiece& from = piece(chart.pieces[next]);
        for (auto k = first + 1; k != end; ++k) {
          if (*k < 0 || !touches(from.u, piece(*k).u) || !touches(from.v, piece(*k).v)) continue;
          chart.pieces.push_back(*k);
          include(chart.u, piece(*k).u);
          include(chart.v, piece(*k).v);
          *k = -1;
        }
      }
      charts_.push_back(std::move(chart));
    }
    begin = end;
  }
  // In the order of their first pieces.
  std::sort(charts_.begin(), charts_.end(),
            [](const Chart& a, const Chart& b) { return a.pieces.front() < b.pieces.front(); });
}

void Branches::sort_charts() {
  of_elements_.clear();
  for (const Chart& chart : charts_) {
    of_elements_.emplace_back(chart.element, int(of_elements_.size()));
  }
  std::sort(of_elements_.begin(), of_elements_.end());
}

/// The first of those, -1 if there is none. @pre the charts are sorted
int Branches::chart_touching(int element, const Interval& u, const Interval& v) const {
  if (element < 0) return -1;
  auto own = std::lower_bound(of_elements_.begin(), of_elements_.end(), std::pair(element, 0));
  for (; own != of_elements_.end() && own->first == element; ++own) {
    const Chart& chart = charts_[std::size_t(own->second)];
    if (touches(chart.u, u) && touches(chart.v, v)) return own->second;
  }
  return -1;
}

/// What two charts tell of each other counts once: it has been told if the other one came first.
void Branches::add(const Glue& glue) {
  const auto first = std::lower_bound(glues_.begin(), glues_.end(), glue.b,
                                      [](const Glue& g, int chart) { return g.a < chart; });
  for (auto g = first; g != glues_.end() && g->a == glue.b; ++g) {
    if (g->kind == glue.kind && g->b == glue.a && g->at_a == glue.at_b && g->at_b == glue.at_a) {
      return;
    }
  }
  glues_.push_back(glue);
}

void Branches::glue_face(const MapPieces& pieces, int index) {
  const ContactGeometry& geometry = pieces.geometry();
  const Chart& chart = charts_[std::size_t(index)];
  const Contact& c = pieces.element(chart.element).contact;
  const Patch& patch = geometry.patch(c);
  const auto at_vertex = [&](int vertex, int place) {
    if (vertex < 0) return;
    const int element = pieces.find_first({c.instance, SourceKind::vertex, vertex, 0, 0});
    const int other = chart_touching(element, {0, 0}, {0, 0});
    if (other >= 0) add({Glue::Kind::face_vertex, index, other, place, 0, false});
  };
  for (const Side side : all_sides) {
    if (!is_at(chart, side)) continue;
    const Border& border = patch.borders[std::size_t(side)];
    const auto& beyond = pieces.element(chart.element).beyond[std::size_t(side)];
    if (beyond.element >= 0) {
      const auto there = strip(beyond.side, turned(along(chart, side), beyond.reversed));
      const int other = chart_touching(beyond.element, there[0], there[1]);
      if (other >= 0) {
        add({Glue::Kind::faces, index, other, int(side), int(beyond.side), beyond.reversed});
      }
    } else if (border.kind == BorderKind::collapsed) {
      at_vertex(border.vertex, int(side));
    } else if (border.piece >= 0) {
      const Contact piece{c.instance, SourceKind::edge, border.piece, 0, 0};
      const bool reversed = border.piece_reversed != pieces.runs_against_first(piece);
      const int other =
          chart_touching(pieces.find_first(piece), turned(along(chart, side), reversed), {0, 0});
      if (other >= 0) add({Glue::Kind::face_edge, index, other, int(side), 0, reversed});
    }
  }
  for (int corner = 0; corner < 4; ++corner) {
    if (is_at(chart, corner < 2 ? Side::u0 : Side::u1) &&
        is_at(chart, corner % 2 == 0 ? Side::v0 : Side::v1)) {
      at_vertex(patch.corner_vertex[std::size_t(corner)], 4 + corner);
    }
  }
}

void Branches::glue_edge(const MapPieces& pieces, int index) {
  const ContactGeometry& geometry = pieces.geometry();
  const Chart& chart = charts_[std::size_t(index)];
  const Contact& c = pieces.element(chart.element).contact;
  const EdgePiece& piece = geometry.piece(c);
  for (const int end : {0, 1}) {
    if (end == 0 ? chart.u.lower > 0 : chart.u.upper < 1) continue;
    const int vertex = piece.end_vertex[std::size_t(end)];
    if (vertex >= 0) {
      const int element = pieces.find_first({c.instance, SourceKind::vertex, vertex, 0, 0});
      const int other = chart_touching(element, {0, 0}, {0, 0});
      if (other >= 0) add({Glue::Kind::edge_vertex, index, other, end, 0, false});
    }
    if (const auto& [passed, at] = pieces.element(chart.element).next[std::size_t(end)];
        passed >= 0) {
      const int other = chart_touching(passed, {double(at), double(at)}, {0, 0});
      if (other >= 0) add({Glue::Kind::edges, index, other, end, at, false});
    }
    const int next = piece.end_neighbor[std::size_t(end)];
    if (next < 0) continue;
    const Contact beyond{c.instance, SourceKind::edge, next, 0, 0};
    const bool turned_round = pieces.runs_against_first(beyond);
    for (const int far : {0, 1}) {
      if (geometry.piece(beyond).end_neighbor[std::size_t(far)] != c.element) continue;
      if (next == c.element && far == end) continue;
      const double t = turned_round ? 1 - far : far;
      const int other = chart_touching(pieces.find_first(beyond), {t, t}, {0, 0});
      if (other >= 0) add({Glue::Kind::edges, index, other, end, int(t), false});
    }
  }
}

void Branches::even_out() {
  for (int pass = 0; pass < evening_limit; ++pass) {
    bool changed = false;
    for (const Glue& glue : glues_) {
      if (glue.kind != Glue::Kind::faces && glue.kind != Glue::Kind::face_edge) continue;
      Interval& a = along(charts_[std::size_t(glue.a)], Side(glue.at_a));
      Chart& other = charts_[std::size_t(glue.b)];
      Interval& b = glue.kind == Glue::Kind::faces ? along(other, Side(glue.at_b)) : other.u;
      changed = include(a, turned(b, glue.reversed)) || changed;
      changed = include(b, turned(a, glue.reversed)) || changed;
    }
    if (!changed) return;
  }
}

void Branches::sort_into_branches(const MapPieces& pieces) {
  DisjointSets sets(charts_.size());
  for (const Glue& glue : glues_) sets.unite(glue.a, glue.b);
  branches_.clear();
  std::map<int, int> of_rounds;
  for (int k = 0; k < int(charts_.size()); ++k) {
    const int round = pieces.element(charts_[std::size_t(k)].element).likeness.round;
    if (round >= 0) sets.unite(k, of_rounds.try_emplace(round, k).first->second);
  }
  std::vector<int> branch_of(charts_.size(), -1);
  for (std::size_t k = 0; k < charts_.size(); ++k) {
    int& branch = branch_of[std::size_t(sets.find(int(k)))];
    if (branch < 0) {
      branch = int(branches_.size());
      branches_.emplace_back();
    }
    charts_[k].branch = branch;
    branches_[std::size_t(branch)].charts.push_back(int(k));
  }
  for (std::size_t k = 0; k < glues_.size(); ++k) {
    branches_[std::size_t(charts_[std::size_t(glues_[k].a)].branch)].glues.push_back(int(k));
  }
}

void Branches::find_boxes(const CellView& view) {
  for (const Chart& chart : charts_) {
    Branch& own = branches_[std::size_t(chart.branch)];
    for (const int index : chart.pieces) {
      const Box& box = view.seen()[std::size_t(index)].piece->box;
      own.lower = glm::min(own.lower, box.lower);
      own.upper = glm::max(own.upper, box.upper);
    }
  }
}

}  // namespace taut
