#include "taut/verify/document_rulings.h"

#include <cmath>
#include <optional>

#include "taut/hull/contact/contact_exits.h"
#include "taut/hull/contact/level_sides.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

/// Where rulings are solved for: the extrema of a Chebyshev polynomial, which interpolate well.
constexpr std::array<double, RulingInterval::node_count> node = {
    0,   0.0244717418524232303, 0.0954915028125262857, 0.20610737385376343,   0.3454915028125262857,
    0.5, 0.6545084971874737143, 0.7938926261462365,    0.9045084971874737143, 0.9755282581475768,
    1};

/// Residuals, in the scene's frame, of rulings that are solutions.
constexpr double solved_residual = 1e-12;

/// Rulings tell about a free end up to this many times the length of the last one before it.
constexpr double reach_of_free_end = 8;

const HullDocument::Contact& contact_of(const HullDocument::Ruling& r, std::size_t k) {
  return k == 0 ? r.a : r.b;
}

double distance(const RulingState& a, const RulingState& b) {
  return glm::distance(a.n, b.n) + glm::distance(a.t[0], b.t[0]) + glm::distance(a.t[1], b.t[1]);
}

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

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

/// The contacts k of two rulings between which it runs along an edge or a seam, from which nothing
/// else keeps it, as contacts of that.
void put_on_common_edge(const ContactGeometry& geometry, std::array<Ruling, 2>& ends,
                        std::size_t k) {
  for (const Side side : all_sides) {
    const auto on_edge = [&](const Ruling& r) {
      return on_level_edge(geometry, r.contact[k], side, r.n);
    };
    const std::optional<Contact> first = on_edge(ends[0]);
    const std::optional<Contact> last = first ? on_edge(ends[1]) : std::nullopt;
    if (!last || !same_element(*first, *last)) continue;
    ends[0].contact[k] = *first;
    ends[1].contact[k] = *last;
    return;
  }
}

}  // namespace

void RulingInterval::add(double s, const RulingState& state) {
  nodes_.push_back(s);
  states_.push_back(state);
}

/// Lagrange's form and its derivative.
std::array<RulingState, 2> RulingInterval::evaluate(double s) const {
  RulingState value, slope;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    double weight = 1;
    double weight_slope = 0;
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      if (j == i) continue;
      const double step = 1 / (nodes_[i] - nodes_[j]);
      weight_slope = (weight_slope * (s - nodes_[j]) + weight) * step;
      weight *= (s - nodes_[j]) * step;
    }
    value.n += weight * states_[i].n;
    slope.n += weight_slope * states_[i].n;
    for (std::size_t k = 0; k < 2; ++k) {
      value.t[k] += weight * states_[i].t[k];
      slope.t[k] += weight_slope * states_[i].t[k];
    }
  }
  return {value, slope};
}

Contact scene_contact(const DocumentGeometry& geometry, const Scene& scene, int source,
                      const SourcePlace& place) {
  const Model& model = scene.model();
  const Source own = model.source(geometry.source(source).id);
  const Part& part = model.parts()[to_size(model.instances()[to_size(own.instance)].part)];
  int element = own.index;
  if (own.kind == SourceKind::face) element = part.faces()[to_size(own.index)].first_patch;
  if (own.kind == SourceKind::edge) element = part.edges()[to_size(own.index)].first_piece;
  if (own.kind != SourceKind::vertex) element += place.patch;
  return {own.instance, own.kind, element, place.t.x, place.t.y};
}

bool DocumentRulings::solve_between(const HullDocument::Ruling& from,
                                    const HullDocument::Ruling& to,
                                    RulingInterval& interval) const {
  const SceneFrame& frame = system_.geometry().scene().frame();
  std::array<Ruling, 2> ends;
  for (std::size_t e = 0; e < 2; ++e) {
    const HullDocument::Ruling& r = e == 0 ? from : to;
    ends[e].n = r.n;
    for (std::size_t k = 0; k < 2; ++k) {
      const SourcePlace at{interval.patch[k], interval.states()[e].t[k]};
      ends[e].contact[k] =
          scene_contact(geometry_, system_.geometry().scene(), interval.source[k], at);
      ends[e].point[k] = frame.to_frame(contact_of(r, k).p);
    }
  }
  const std::array<Contact, 2> in_patches = ends[0].contact;
  for (std::size_t k = 0; k < 2; ++k) put_on_common_edge(system_.geometry(), ends, k);
  const RulingsBetween between(system_, ends[0], ends[1]);
  if (between.empty()) return false;
  bool solved = true;
  for (std::size_t i = 1; i + 1 < node.size(); ++i) {
    const std::optional<MovingRuling> m =
        between.is_smoother() ? between.interpolated(node[i]) : between(node[i]);
    if (!m) return false;
    const CommonSupport& support = m->at;
    const Ruling r = support.ruling();
    double residual = std::abs(glm::dot(support.d(), r.n));
    for (std::size_t k = 0; k < 2; ++k) {
      for (const dvec3& d : support.jet[k].dx) residual += std::abs(glm::dot(d, r.n));
    }
    solved = solved && residual <= solved_residual;
    RulingState state{r.n, {}};
    for (std::size_t k = 0; k < 2; ++k) {
      const std::optional<Contact> c =
          expressed_in(system_.geometry(), r.contact[k], in_patches[k]);
      if (!c) return false;
      state.t[k] = {c->u, c->v};
    }
    interval.add(node[i], state);
  }
  return solved;
}

bool DocumentRulings::fill(const HullDocument::Ruling& from, const HullDocument::Ruling& to,
                           RulingInterval& interval) const {
  RulingState first{from.n, {}};
  RulingState last{to.n, {}};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto both = common_places(geometry_, contact_of(from, k), contact_of(to, k));
    if (!both) return false;
    interval.source[k] = contact_of(from, k).source;
    interval.patch[k] = (*both)[0].patch;
    first.t[k] = (*both)[0].t;
    last.t[k] = (*both)[1].t;
  }
  interval.add(0, first);
  interval.add(1, last);
  return true;
}

/// Of the interval that ends or begins in a merged ruling, from the nodes of its neighbour.
void DocumentRulings::extrapolate(const RulingInterval& neighbor, bool ends,
                                  RulingInterval& interval) const {
  if (!neighbor.solved || neighbor.source != interval.source || neighbor.patch != interval.patch) {
    return;
  }
  const auto length = [&](const RulingState& state) {
    std::array<dvec3, 2> x;
    for (std::size_t k = 0; k < 2; ++k) {
      x[k] = geometry_.jet(interval.source[k], {interval.patch[k], state.t[k]}).x;
    }
    return glm::distance(x[0], x[1]);
  };
  const double whole = length(interval.states()[ends ? 0 : 1]);
  const RulingState& merged = interval.states()[ends ? 1 : 0];
  // The length falls with the way to the end or with its square: that which the neighbour's nodes,
  // without the merged ruling, lead to it by.
  std::optional<RulingInterval> best;
  double least_miss = 0;
  for (const double order : {1.0, 2.0}) {
    RulingInterval told;
    RulingInterval next = interval;
    told.add(1, interval.states()[ends ? 0 : 1]);
    // The nearest nodes but the one that both have: the nearer to the end, the better they tell.
    // Every second one, since high degrees magnify what rounding moves them by.
    const double nearest = ends ? 1 : 0;
    for (std::size_t i = 0; i < neighbor.nodes().size(); ++i) {
      const bool is_end = i < 2;
      if (neighbor.nodes()[i] == nearest || (!is_end && i % 2 == 0)) continue;
      const double ratio = length(neighbor.states()[i]) / whole;
      if (!(ratio > 1) || ratio > reach_of_free_end) continue;
      const double share = std::pow(ratio, 1 / order);
      told.add(share, neighbor.states()[i]);
      next.add(ends ? 1 - share : share, neighbor.states()[i]);
    }
    const double miss = distance(told.value(0), merged);
    if (best && miss >= least_miss) continue;
    least_miss = miss;
    best = std::move(next);
  }
  // Rulings that do not lead to the merged one tell nothing about the way there.
  const double way = distance(interval.states()[0], interval.states()[1]);
  if (least_miss < way) interval = std::move(*best);
}

std::vector<RulingInterval> DocumentRulings::intervals(const HullDocument::Face& scroll) const {
  std::vector<RulingInterval> found;
  const std::vector<HullDocument::Ruling>& rulings = scroll.rulings;
  found.reserve(rulings.size());
  const double near = geometry_.noise() * system_.geometry().scene().diagonal();
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
    if (!merged(from) && !merged(to)) interval.solved = solve_between(from, to, interval);
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
