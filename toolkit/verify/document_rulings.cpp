#include "taut/verify/document_rulings.h"

#include <cmath>
#include <optional>

#include "taut/core/integers.h"
#include "taut/verify/ruling_solver.h"

namespace taut {
namespace {

/// Rulings tell about a free end up to this many times the length of the last one before it.
constexpr double reach_of_free_end = 8;

const HullDocument::Contact& contact_of(const HullDocument::Ruling& r, std::size_t k) {
  return k == 0 ? r.a : r.b;
}

/// Places in the first Bezier patch that has both contacts.
std::optional<std::array<SourcePlace, 2>> common_places(const DocumentGeometry& geometry,
                                                        const HullDocument::Contact& a,
                                                        const HullDocument::Contact& b) {
  if (a.source != b.source) return std::nullopt;
  for (const SourcePlace& p : geometry.places(a)) {
    for (const SourcePlace& q : geometry.places(b)) {
      if (p.patch == q.patch) return std::array<SourcePlace, 2>{p, q};
    }
  }
  return std::nullopt;
}

/// What is known without solving: the ends.
RulingPanel straight(const RulingInterval& interval) {
  RulingPanel panel(0, 1);
  panel.add(0, interval.first);
  panel.add(1, interval.last);
  return panel;
}

}  // namespace

bool DocumentRulings::fill(const HullDocument::Ruling& from, const HullDocument::Ruling& to,
                           RulingInterval& interval) const {
  interval.first.n = from.n;
  interval.last.n = to.n;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto both = common_places(geometry_, contact_of(from, k), contact_of(to, k));
    if (!both) return false;
    interval.source[k] = contact_of(from, k).source;
    interval.patch[k] = (*both)[0].patch;
    interval.first.t[k] = (*both)[0].t;
    interval.last.t[k] = (*both)[1].t;
  }
  return true;
}

/// Of the interval that ends or begins in a merged ruling, from the nodes of its neighbour's panel
/// at that end.
void DocumentRulings::extrapolate(const RulingInterval& neighbor, bool ends,
                                  RulingInterval& interval) const {
  if (!neighbor.solved || neighbor.source != interval.source || neighbor.patch != interval.patch) {
    return;
  }
  const auto ruling_length = [&](const RulingState& state) {
    std::array<dvec3, 2> x;
    for (std::size_t k = 0; k < 2; ++k) {
      x[k] = geometry_.jet(interval.source[k], {interval.patch[k], state.t[k]}).x;
    }
    return glm::distance(x[0], x[1]);
  };
  const RulingPanel& panel = ends ? neighbor.panels.back() : neighbor.panels.front();
  const RulingState& near = ends ? interval.first : interval.last;
  const RulingState& merged = ends ? interval.last : interval.first;
  const double whole = ruling_length(near);
  // The length falls with the way to the end or with its square: that which the neighbour's nodes,
  // without the merged ruling, lead to it by.
  std::optional<RulingPanel> best;
  double least_miss = 0;
  for (const double order : {1.0, 2.0}) {
    RulingPanel told;
    told.add(1, near);
    std::vector<std::pair<double, RulingState>> known = {{ends ? 0 : 1, near}};
    // Every second node, since high degrees magnify what rounding moves them by.
    const std::size_t count = panel.nodes().size();
    for (std::size_t i = 2; i < count; i += 2) {
      const RulingState& state = panel.states()[ends ? count - 1 - i : i];
      const double ratio = ruling_length(state) / whole;
      if (!(ratio > 1) || ratio > reach_of_free_end) continue;
      const double share = std::pow(ratio, 1 / order);
      told.add(share, state);
      known.emplace_back(ends ? 1 - share : share, state);
    }
    // Every second one of these, with both ends among them, tells what all miss.
    known.emplace(known.begin() + (known.size() > 1 ? 2 : 1), ends ? 1 : 0, merged);
    RulingPanel next(0, 1);
    for (const auto& [s, state] : known) next.add(s, state);
    const double miss = length(told.through(1, 0)[0] - merged);
    if (best && miss >= least_miss) continue;
    least_miss = miss;
    best = std::move(next);
  }
  // Rulings that do not lead to the merged one tell nothing about the way there.
  if (least_miss < length(near - merged)) interval.panels = {std::move(*best)};
}

std::vector<RulingInterval> DocumentRulings::intervals(const HullDocument::Face& scroll) const {
  std::vector<RulingInterval> found;
  const std::vector<HullDocument::Ruling>& rulings = scroll.rulings;
  found.reserve(rulings.size());
  const double near = geometry_.noise() * geometry_.hull().diagonal;
  const auto merged = [&](const HullDocument::Ruling& r) {
    return glm::distance(r.a.p, r.b.p) <= near;
  };
  // One ruling in two terms, or two that are one but for the rounding of where it passes borders.
  const auto same = [&](const HullDocument::Ruling& r, const HullDocument::Ruling& s) {
    return glm::distance(r.n, s.n) <= geometry_.noise() && glm::distance(r.a.p, s.a.p) <= near &&
           glm::distance(r.b.p, s.b.p) <= near;
  };
  for (std::size_t i = 0; i + 1 < rulings.size(); ++i) {
    const HullDocument::Ruling& from = rulings[i];
    const HullDocument::Ruling& to = rulings[i + 1];
    if (same(from, to)) continue;
    RulingInterval interval;
    interval.ruling = int(i);
    if (!fill(from, to, interval)) continue;
    if (!merged(from) && !merged(to)) interval.solved = RulingSolver(geometry_, interval).run();
    if (!interval.solved) interval.panels = {straight(interval)};
    found.push_back(std::move(interval));
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto at = to_size(found[i].ruling);
    if (merged(rulings[at + 1]) && i > 0) extrapolate(found[i - 1], true, found[i]);
    if (merged(rulings[at]) && i + 1 < found.size()) extrapolate(found[i + 1], false, found[i]);
  }
  return found;
}

}  // namespace taut
