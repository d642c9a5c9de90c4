#include "taut/hull/decide/corner_rings.h"

#include <algorithm>

namespace taut {
namespace {

Side opposite(Side side) { return Side(int(side) ^ 1); }

}  // namespace

CornerRings::CornerRings(const MapPieces& pieces, const Branches& branches, const Branch& branch,
                         const Glued& glued)
    : pieces_(pieces), branches_(branches), branch_(branch), glued_(glued) {
  for (const int k : branch.charts) {
    if (branches.chart(k).kind != SourceKind::face) continue;
    for (const Side u : {Side::u0, Side::u1}) {
      for (const Side v : {Side::v0, Side::v1}) visit(k, u, v);
    }
  }
}

bool CornerRings::is_pole(const Corner& c) const {
  const MapElement& element = pieces_.element(branches_.chart(c.chart).element);
  return element.collapsed[std::size_t(c.other)];
}

/// The point at a chart's corner, if it has one there and the point has not been passed yet.
void CornerRings::visit(int k, Side u, Side v) {
  const Chart& chart = branches_.chart(k);
  const auto& collapsed = pieces_.element(chart.element).collapsed;
  if (!is_at(chart, u) || !is_at(chart, v)) return;
  if (collapsed[std::size_t(u)] && collapsed[std::size_t(v)]) return;
  const Corner start = collapsed[std::size_t(u)] ? Corner{k, v, u} : Corner{k, u, v};
  const bool pole = is_pole(start);
  if (pole && !is_at(chart, opposite(start.next))) return;
  if (passed_.contains({k, int(start.next), int(start.other)})) return;
  Way way = walk(start);
  bool closed = way.closed;
  if (!closed && !pole) {
    // From one edge to another, with what these meet in.
    const Way back = walk({k, start.other, start.next});
    closed = way.edge >= 0 && back.edge >= 0 && meet(way.edge, back.edge);
    if (way.edge < 0 && back.edge < 0) add_fan(way, back);
    way.corners.insert(way.corners.end(), back.corners.begin(), back.corners.end());
    reentrant_ = reentrant_ || way.corners.size() > 3;  // the first one twice
  }
  // The point is met from each of its charts, and both ways around.
  for (const Corner& c : way.corners) {
    passed_.insert({c.chart, int(c.next), int(c.other)});
    passed_.insert({c.chart, int(pole ? opposite(c.next) : c.other), int(pole ? c.other : c.next)});
    if (!closed) continue;
    inside_.insert({c.chart, int(c.next), int(c.other)});
    inside_.insert({c.chart, int(c.other), int(c.next)});
    if (!pole) continue;
    inside_.insert({c.chart, int(opposite(c.next)), int(c.other)});
    poles_.emplace_back(c.chart, c.other);
  }
  count_ += closed ? 1 : 0;
}

void CornerRings::add_fan(const Way& way, const Way& back) {
  const Fan fan = {way.corners.back(), back.corners.back()};
  for (const Way* own : {&way, &back}) {
    for (const Corner& c : own->corners) {
      fans_[{c.chart, int(c.next), int(c.other)}] = fan;
      fans_[{c.chart, int(c.other), int(c.next)}] = fan;
    }
  }
}

CornerRings::Way CornerRings::walk(const Corner& from) const {
  Way way{{from}, false, -1};
  const std::size_t limit = 4 * branch_.charts.size();
  for (std::optional<Corner> at = step(from, way.edge); at; at = step(*at, way.edge)) {
    way.closed = *at == from;
    if (way.closed || way.corners.size() > limit) break;
    way.corners.push_back(*at);
  }
  return way;
}

/// Over a join; about a pole on over the opposite side. None where there is no chart beyond, or an
/// edge.
std::optional<CornerRings::Corner> CornerRings::step(const Corner& from, int& edge) const {
  const int g = glued_[std::size_t(from.chart)][std::size_t(from.next)];
  if (g < 0) return std::nullopt;
  const Glue& glue = branches_.glue(g);
  if (glue.kind != Glue::Kind::faces) {
    edge = glue.b;
    return std::nullopt;
  }
  const bool is_a = glue.a == from.chart && glue.at_a == int(from.next);
  const Side side = Side(is_a ? glue.at_b : glue.at_a);
  const bool upper = at_upper_end(from.other) != glue.reversed;
  const Corner next{is_a ? glue.b : glue.a, side_at_end(side, upper), side};
  const Chart& chart = branches_.chart(next.chart);
  if (!is_at(chart, next.next)) return std::nullopt;
  const Corner at_pole{next.chart, opposite(side), next.next};
  if (!is_pole(at_pole)) return next;
  return is_at(chart, at_pole.next) ? std::optional(at_pole) : std::nullopt;
}

/// Two edges go on into each other, or end in one vertex of the branch.
bool CornerRings::meet(int edge, int other) const {
  std::vector<int> vertices, others;
  for (const int g : branch_.glues) {
    const Glue& glue = branches_.glue(g);
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
