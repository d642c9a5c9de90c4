#include "taut/hull/decide/corner_rings.h"

#include <algorithm>

namespace taut {
void CornerRings::find(const Branches& branches, const Branch& branch,
                       const ChartGlue::Table& glued) {
  branches_ = &branches;
  branch_ = &branch;
  glued_ = &glued;
  count_ = 0;
  reentrant_ = false;
  poles_.clear();
  fans_.clear();
  const std::size_t places = place(int(branches.charts().size()), Side::u0, Side::u0);
  passed_.assign(places, false);
  inside_.assign(places, false);
  fan_at_.assign(places, -1);
  for (const int k : branch.charts) {
    if (branches.chart(k).kind != SourceKind::face) continue;
    for (const Side u : {Side::u0, Side::u1}) {
      for (const Side v : {Side::v0, Side::v1}) visit(k, u, v);
    }
  }
}

bool CornerRings::is_pole(const Corner& c) const {
  const MapElement& element = pieces_.element(branches_->chart(c.chart).element);
  return element.collapsed[std::size_t(c.other)];
}

/// The point at a chart's corner, if it has one there and the point has not been passed yet.
void CornerRings::visit(int k, Side u, Side v) {
  const Chart& chart = branches_->chart(k);
  const auto& collapsed = pieces_.element(chart.element).collapsed;
  if (!is_at(chart, u) || !is_at(chart, v)) return;
  if (collapsed[std::size_t(u)] && collapsed[std::size_t(v)]) return;
  const Corner start = collapsed[std::size_t(u)] ? Corner{k, v, u} : Corner{k, u, v};
  const bool pole = is_pole(start);
  if (pole && !is_at(chart, opposite(start.next))) return;
  if (passed_[place(k, start.next, start.other)]) return;
  walk(start, way_);
  bool closed = way_.closed;
  if (!closed && !pole) {
    // From one edge to another, with what these meet in.
    walk({k, start.other, start.next}, back_);
    closed = way_.edge >= 0 && back_.edge >= 0 && meet(way_.edge, back_.edge);
    if (way_.edge < 0 && back_.edge < 0) add_fan();
    way_.corners.insert(way_.corners.end(), back_.corners.begin(), back_.corners.end());
    reentrant_ = reentrant_ || way_.corners.size() > 3;  // the first one twice
  }
  // The point is met from each of its charts, and both ways around.
  for (const Corner& c : way_.corners) {
    passed_[place(c.chart, c.next, c.other)] = true;
    passed_[place(c.chart, pole ? opposite(c.next) : c.other, pole ? c.other : c.next)] = true;
    if (!closed) continue;
    inside_[place(c.chart, c.next, c.other)] = true;
    inside_[place(c.chart, c.other, c.next)] = true;
    if (!pole) continue;
    inside_[place(c.chart, opposite(c.next), c.other)] = true;
    poles_.emplace_back(c.chart, c.other);
  }
  count_ += closed ? 1 : 0;
}

/// Of the ways to both sides.
void CornerRings::add_fan() {
  const int fan = int(fans_.size());
  fans_.push_back({way_.corners.back(), back_.corners.back()});
  for (const Way* own : {&way_, &back_}) {
    for (const Corner& c : own->corners) {
      fan_at_[place(c.chart, c.next, c.other)] = fan_at_[place(c.chart, c.other, c.next)] = fan;
    }
  }
}

void CornerRings::walk(const Corner& from, Way& way) const {
  way.corners.assign(1, from);
  way.closed = false;
  way.edge = -1;
  const std::size_t limit = 4 * branch_->charts.size();
  for (std::optional<Corner> at = step(from, way.edge); at; at = step(*at, way.edge)) {
    way.closed = *at == from;
    if (way.closed || way.corners.size() > limit) break;
    way.corners.push_back(*at);
  }
}

/// Over a join; about a pole on over the opposite side. None where there is no chart beyond, or an
/// edge.
std::optional<CornerRings::Corner> CornerRings::step(const Corner& from, int& edge) const {
  const int g = (*glued_)[std::size_t(from.chart)][std::size_t(from.next)];
  if (g < 0) return std::nullopt;
  const Glue& glue = branches_->glue(g);
  if (glue.kind != Glue::Kind::faces) {
    edge = glue.b;
    return std::nullopt;
  }
  const bool is_a = glue.a == from.chart && glue.at_a == int(from.next);
  const Side side = Side(is_a ? glue.at_b : glue.at_a);
  const bool upper = at_upper_end(from.other) != glue.reversed;
  const Corner next{is_a ? glue.b : glue.a, side_at_end(side, upper), side};
  const Chart& chart = branches_->chart(next.chart);
  if (!is_at(chart, next.next)) return std::nullopt;
  const Corner at_pole{next.chart, opposite(side), next.next};
  if (!is_pole(at_pole)) return next;
  return is_at(chart, at_pole.next) ? std::optional(at_pole) : std::nullopt;
}

/// Two edges go on into each other, or end in one vertex of the branch.
bool CornerRings::meet(int edge, int other) const {
  std::vector<int> vertices, others;
  for (const int g : branch_->glues) {
    const Glue& glue = branches_->glue(g);
    if (glue.kind == Glue::Kind::edges &&
        ((glue.a == edge && glue.b == other) || (glue.a == other && glue.b == edge))) {
      return true;
    }
    if (glue.kind != Glue::Kind::edge_vertex) continue;
    if (glue.a == edge) vertices.push_back(glue.b);
    if (glue.a == other) others.push_back(glue.b);
  }
  return std::any_of(vertices.begin(), vertices.end(), [&](int vertex) {
    return std::count(others.begin(), others.end(), vertex) > 0;
  });
}

}  // namespace taut
