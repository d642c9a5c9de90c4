#include "taut/hull/stitch/trim_stretches.h"

#include <cmath>

namespace taut {
namespace {

/// Two patches agree on where their common border leaves the hull to within this.
constexpr double same_leaving_parameter = 1e-6;

Contact contact(const TrimRegion& r, const dvec2& at) {
  return {r.instance, SourceKind::face, r.patch, at.x, at.y};
}

}  // namespace

TrimStretches::TrimStretches(const ContactGeometry& geometry, const SeparatingGraph& graph,
                             std::vector<TrimRegion> regions, std::vector<Unresolved>& unresolved)
    : geometry_(geometry), regions_(std::move(regions)) {
  const EdgeIncidence incidence(geometry, graph, regions_);
  for (TrimRegion& r : regions_) {
    geometry.check_stop();
    for (auto& loop : r.loops) loop = split(incidence, r, loop);
  }
  number_all();
  match_joins(unresolved);
}

int TrimStretches::source_of(int region) const {
  const TrimRegion& r = regions_[std::size_t(region)];
  const int face = geometry_.patch(contact(r, {})).face;
  return geometry_.scene().model().source_id({SourceKind::face, r.instance, face});
}

int TrimStretches::next(int stretch) const {
  const Place& at = place(stretch);
  const auto& loop = region_at(stretch).loops[at.loop];
  return number(at.region, at.loop, (at.index + 1) % loop.size());
}

std::span<const int> TrimStretches::along(int arc, int piece, int contact) const {
  const auto found = along_.find({arc, piece, contact});
  if (found == along_.end()) return {};
  return found->second;
}

std::vector<dvec3> TrimStretches::polyline(int stretch) const {
  const TrimRegion& r = region_at(stretch);
  const TrimStretch& s = (*this)[stretch];
  std::vector<dvec3> points;
  points.reserve(border_points + 1);
  for (int k = 0; k <= border_points; ++k) {
    const double share = double(k) / border_points;
    const double t = k == border_points ? s.to : (1 - share) * s.from + share * s.to;
    points.push_back(geometry_.point(contact(r, on_side(s.side, t))));
  }
  return points;
}

void TrimStretches::set_curve(int stretch, int curve) {
  const Place& at = place(stretch);
  regions_[std::size_t(at.region)].loops[at.loop][at.index].curve = curve;
}

const Border& TrimStretches::border(const TrimRegion& region, Side side) const {
  return geometry_.patch(contact(region, {})).borders[std::size_t(side)];
}

dvec3 TrimStretches::normal(const TrimRegion& region, Side side, double t) const {
  const ContactJet j = geometry_.jet(contact(region, on_side(side, t)));
  return double(region.sign) * unit(glm::cross(j.dx[0], j.dx[1]));
}

/// The loop with its stretches on edges split.
std::vector<TrimStretch> TrimStretches::split(const EdgeIncidence& incidence,
                                              const TrimRegion& region,
                                              const std::vector<TrimStretch>& loop) const {
  std::vector<TrimStretch> result;
  for (const TrimStretch& s : loop) {
    const Border& b = border(region, s.side);
    if (s.arc >= 0 || b.piece < 0) {
      result.push_back(s);
      continue;
    }
    double from = s.from;
    const Contact low = geometry_.first({region.instance, SourceKind::edge, b.piece, 0, 0});
    const bool reversed = b.piece_reversed != (low.u != 0);
    for (const double t : incidence.breaks(low.instance, low.element, reversed, s.from, s.to)) {
      result.push_back(s);
      result.back().from = from;
      result.back().to = t;
      from = t;
    }
    result.push_back(s);
    result.back().from = from;
  }
  return result;
}

void TrimStretches::number_all() {
  for (int r = 0; r < int(regions_.size()); ++r) {
    geometry_.check_stop();
    const auto& loops = regions_[std::size_t(r)].loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
      for (std::size_t k = 0; k < loops[l].size(); ++k) {
        const TrimStretch& s = loops[l][k];
        if (s.arc >= 0) along_[{s.arc, s.piece, s.contact}].push_back(count());
        if (k == 0) first_of_loop_[{r, l}] = count();
        places_.push_back({r, l, k});
      }
    }
  }
  twin_.assign(places_.size(), -1);
}

/// Finds the twins.
void TrimStretches::match_joins(std::vector<Unresolved>& unresolved) {
  std::map<std::tuple<int, int, int>, std::vector<int>> on;  // by instance, patch and side
  for (int k = 0; k < count(); ++k) {
    geometry_.check_stop();
    const TrimStretch& s = (*this)[k];
    const TrimRegion& r = region_at(k);
    const bool on_border = s.arc < 0;
    if (on_border && border(r, s.side).kind == BorderKind::smooth && border(r, s.side).piece < 0) {
      on[{r.instance, r.patch, int(s.side)}].push_back(k);
    }
  }
  for (const auto& [key, own] : on) {
    geometry_.check_stop();
    for (const int k : own) {
      if (twin(k) >= 0) continue;
      const TrimStretch& s = (*this)[k];
      const TrimRegion& r = region_at(k);
      const Border& b = border(r, s.side);
      const auto across = on.find({r.instance, b.neighbor, int(b.neighbor_side)});
      const int found = across == on.end() ? -1 : find_twin(k, across->second);
      if (found < 0) {
        unresolved.push_back({normal(r, s.side, 0.5 * (s.from + s.to)),
                              "two patches disagree on how much of their join lies on the hull"});
        continue;
      }
      twin_[std::size_t(k)] = found;
      twin_[std::size_t(found)] = k;
    }
  }
}

/// The neighbour passes it the other way.
int TrimStretches::find_twin(int stretch, const std::vector<int>& candidates) const {
  const TrimStretch& s = (*this)[stretch];
  const bool reversed = border(region_at(stretch), s.side).reversed;
  const auto over = [&](double t) { return reversed ? 1 - t : t; };
  for (const int other : candidates) {
    if (other == stretch || twin(other) >= 0) continue;
    const TrimStretch& t = (*this)[other];
    if (std::abs(over(s.from) - t.to) < same_leaving_parameter &&
        std::abs(over(s.to) - t.from) < same_leaving_parameter) {
      return other;
    }
  }
  return -1;
}

}  // namespace taut
