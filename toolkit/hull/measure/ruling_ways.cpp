#include "taut/hull/measure/ruling_ways.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "taut/hull/measure/quadrature.h"

namespace taut {
namespace {

/// Parts of a way that still do not lead on when they have been halved so often are straight.
constexpr int halvings = 8;
/// See leads().
constexpr double least_way = 1e-10;

/// The contacts lie in their elements, but for what is rounding of merging ones.
bool lies_inside(const CommonSupport& s) {
  const auto inside = [](double t) { return t >= -same_contact && t <= 1 + same_contact; };
  return std::all_of(s.contact.begin(), s.contact.begin() + s.count,
                     [&](const Contact& c) { return inside(c.u) && inside(c.v); });
}

double distance(const Ruling& a, const Ruling& b) {
  return glm::distance(a.point[0], b.point[0]) + glm::distance(a.point[1], b.point[1]);
}

/// Both contacts are where their elements support: what exact rulings miss it by then is the
/// system's noise, as near free ends.
bool is_exact(const ContactGeometry& geometry, const Ruling& r) {
  return std::all_of(r.contact.begin(), r.contact.end(), [&](const Contact& c) {
    const ContactJet jet = geometry.jet(c);
    return std::all_of(jet.dx.begin(), jet.dx.begin() + jet.dimension, [&](const dvec3& dx) {
      return std::abs(glm::dot(dx, r.n)) <= geometry.tie();
    });
  });
}

class Ways {
 public:
  Ways(const ContactSystem& system, double tolerance)
      : system_(system), geometry_(system.geometry()), tolerance_(tolerance) {}

  void divide(const Ruling& from, const Ruling& to, int depth) {
    const RulingsBetween between(system_, from, to);
    if (between.empty()) return;
    RulingWay way{from, to};
    way.exact = is_exact(between, from, to);
    if (!way.exact) {
      const std::optional<Ruling> middle = depth < halvings ? middle_of(between) : std::nullopt;
      way.deviation =
          middle ? distance(*middle, way.straight(geometry_, 0.5).at.ruling()) : distance(from, to);
      if (middle && way.uncertainty() > 0.5 * tolerance_) {
        divide(from, *middle, depth + 1);
        return divide(*middle, to, depth + 1);
      }
    }
    ways_.push_back(way);
  }
  std::vector<RulingWay> take() { return std::move(ways_); }

 private:
  /// The exact ruling with its contacts moved into their elements.
  std::optional<Ruling> middle_of(const RulingsBetween& between) const {
    const std::optional<MovingRuling> m = between(0.5);
    if (!m) return std::nullopt;
    Ruling ruling = m->at.ruling();
    for (std::size_t i = 0; i < 2; ++i) {
      Contact& c = ruling.contact[i];
      c.u = std::clamp(c.u, 0.0, 1.0);
      c.v = std::clamp(c.v, 0.0, 1.0);
      ruling.point[i] = geometry_.point(c);
    }
    return ruling;
  }
  /// By one rule, without halving.
  static bool is_exact(const RulingsBetween& between, const Ruling& from, const Ruling& to) {
    if (between.is_smoother()) return true;
    const auto& rule = GaussRule<6>::get();
    std::array<dvec3, 2> moved = {dvec3(0.0), dvec3(0.0)};
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const std::optional<MovingRuling> m = between(rule.node[k]);
      if (!m || !lies_inside(m->at)) return false;
      for (std::size_t i = 0; i < 2; ++i) moved[i] += rule.weight[k] * m->dx[i];
    }
    return leads(missed_way(moved, from, to));
  }

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  double tolerance_;
  std::vector<RulingWay> ways_;
};

}  // namespace

LedRulings::LedRulings(const ContactGeometry& geometry, const RulingsBetween& between,
                       const Ruling& from, const Ruling& to)
    : geometry_(geometry), between_(between) {
  if (is_exact(geometry, from) && is_exact(geometry, to)) {
    missed_ = 0;
    return;
  }
  const std::array<std::optional<MovingRuling>, 2> exact = {between(0), between(1)};
  if (!exact[0] || !exact[1]) return;
  at_ = {offset(from, *exact[0]), offset(to, *exact[1])};
  missed_ = distance(from, exact[0]->at.ruling()) + distance(to, exact[1]->at.ruling());
  // Where a side is collapsed parameters there tell nothing, but those that are moved by them do.
  const std::optional<MovingRuling> middle = between(0.5);
  if (!middle) return;
  double moved = 0;
  for (const Offset& offset : at_) {
    for (std::size_t i = 0; i < 2; ++i) {
      const ContactJet& jet = middle->at.jet[i];
      moved += glm::length(offset.parameters[i].x * jet.dx[0]) +
               glm::length(offset.parameters[i].y * jet.dx[1]);
    }
  }
  missed_ = std::max(missed_, moved);
}

LedRulings::Offset LedRulings::offset(const Ruling& end, const MovingRuling& exact) {
  Offset offset{end.n - exact.at.n, {}};
  for (std::size_t i = 0; i < 2; ++i) {
    offset.parameters[i] = parameters(end.contact[i]) - parameters(exact.at.contact[i]);
  }
  return offset;
}

std::optional<MovingRuling> LedRulings::operator()(double s) const {
  std::optional<MovingRuling> m = between_(s);
  if (!m) return std::nullopt;
  Ruling ruling = m->at.ruling();
  ruling.n = unit(ruling.n + glm::mix(at_[0].n, at_[1].n, s));
  m->dn += at_[1].n - at_[0].n;
  for (std::size_t i = 0; i < 2; ++i) {
    const dvec2 moved = glm::mix(at_[0].parameters[i], at_[1].parameters[i], s);
    ruling.contact[i].u += moved.x;
    ruling.contact[i].v += moved.y;
    m->dp[i] += at_[1].parameters[i] - at_[0].parameters[i];
  }
  m->at = CommonSupport(geometry_, ruling);
  m->complete();
  return m;
}

MovingRuling RulingWay::straight(const ContactGeometry& geometry, double r) const {
  Ruling between = from;
  MovingRuling m;
  between.n = unit(glm::mix(from.n, to.n, r));
  for (std::size_t i = 0; i < 2; ++i) {
    const Contact& a = from.contact[i];
    const Contact& b = to.contact[i];
    m.dp[i] = {b.u - a.u, b.v - a.v};
    between.contact[i].u = glm::mix(a.u, b.u, r);
    between.contact[i].v = glm::mix(a.v, b.v, r);
    between.point[i] = geometry.point(between.contact[i]);
  }
  m.at = CommonSupport(geometry, between);
  m.dn = (to.n - from.n) / glm::length(glm::mix(from.n, to.n, r));
  m.complete();
  return m;
}

double RulingWay::uncertainty() const {
  const double turn = glm::distance(from.n, to.n);
  const double way =
      glm::distance(from.point[0], to.point[0]) + glm::distance(from.point[1], to.point[1]);
  // What turns by so much on a way bulges by an eighth of both over the straight one.
  return 0.5 * turn * (deviation + turn * way / 8);
}

double missed_way(const std::array<dvec3, 2>& moved, const Ruling& from, const Ruling& to) {
  const double missed = glm::distance(moved[0], to.point[0] - from.point[0]) +
                        glm::distance(moved[1], to.point[1] - from.point[1]);
  return missed < infinity ? missed : infinity;
}

double missed_curvature(double missed) { return std::numbers::pi / 4 * missed; }

bool leads(double missed) { return missed <= least_way; }

std::vector<RulingWay> ruling_ways(const ContactSystem& system, const Ruling& from,
                                   const Ruling& to, double tolerance) {
  Ways ways(system, tolerance);
  ways.divide(from, to, 0);
  return ways.take();
}

}  // namespace taut
