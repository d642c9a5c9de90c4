#include "taut/hull/decide/ridge_contacts.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/vector_net.h"
#include "taut/hull/decide/parameter_hull.h"

namespace taut {
namespace {

/// How often stretches are halved, and widened across.
constexpr int cut_limit = 5;
constexpr int widening_limit = 6;
/// Steps of Newton's method, which ends where one does not make a stretch this much narrower.
constexpr int narrowing_limit = 4;
constexpr double narrow_share = 0.7;

/// How often the part beside an edge over which heights bend up is halved.
constexpr int dent_limit = 12;

/// The extent across of a convex polygon over an interval of s, which is its first coordinate.
Interval slice(const std::vector<dvec2>& polygon, const Interval& s) {
  Interval t = {infinity, -infinity};
  const auto include = [&](double x) { t = {std::min(t.lower, x), std::max(t.upper, x)}; };
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const dvec2& a = polygon[k];
    const dvec2& b = polygon[k + 1 < polygon.size() ? k + 1 : 0];
    if (a.x >= s.lower && a.x <= s.upper) include(a.y);
    for (const double end : {s.lower, s.upper}) {
      if ((a.x < end) == (b.x < end)) continue;
      include(a.y + (end - a.x) / (b.x - a.x) * (b.y - a.y));
    }
  }
  return t;
}

}  // namespace

/// With t within s.
void RidgeContacts::derive(Direction along) {
  if (along == Direction::v) {
    std::vector<dvec4> turned(net_.size());
    for (int i = 0; i <= shape_.p; ++i) {
      for (int j = 0; j <= shape_.q; ++j) {
        turned[std::size_t(j * (shape_.p + 1) + i)] = net_[std::size_t(i * (shape_.q + 1) + j)];
      }
    }
    net_.swap(turned);
    std::swap(shape_.p, shape_.q);
  }
  s_ = derived(shape_, net_, Direction::u);
  t_ = derived(shape_, net_, Direction::v);
  second_[0] = derived(shape_, s_, Direction::u);
  second_[1] = derived(shape_, s_, Direction::v);
  second_[2] = derived(shape_, t_, Direction::v);
  third_[0] = derived(shape_, second_[0], Direction::u);
  third_[1] = derived(shape_, second_[0], Direction::v);
  third_[2] = derived(shape_, second_[2], Direction::u);
  third_[3] = derived(shape_, second_[2], Direction::v);
}

void RidgeContacts::restrict(const std::vector<dvec4>& net, const Stretch& stretch,
                             std::vector<dvec4>& part) {
  part = net;
  restrict_net(shape_, part.data(), stretch.s, stretch.t);
}

/// Widens a stretch until heights grow from both sides inwards.
bool RidgeContacts::widen(const CellView& view, Stretch& stretch) {
  for (int round = 0; round < widening_limit; ++round) {
    const Interval& t = stretch.t;
    const bool lower = of_net(view, t_, {stretch.s, {t.lower, t.lower}}).lower > noise_;
    const bool upper = of_net(view, t_, {stretch.s, {t.upper, t.upper}}).upper < -noise_;
    if (lower && upper) return true;
    if ((!lower && stretch.t.lower <= 0) || (!upper && stretch.t.upper >= 1)) return false;
    const double width = stretch.t.upper - stretch.t.lower;
    if (!lower) stretch.t.lower = std::max(0.0, stretch.t.lower - width);
    if (!upper) stretch.t.upper = std::min(1.0, stretch.t.upper + width);
  }
  return false;
}

/// To where the ridge is, by Newton's method for intervals. @pre heights are concave across and
/// grow from both sides inwards
void RidgeContacts::narrow(const CellView& view, Stretch& stretch) {
  Interval& t = stretch.t;
  for (int round = 0; round < narrowing_limit; ++round) {
    const double middle = 0.5 * (t.lower + t.upper);
    const Range slope = of_net(view, t_, {stretch.s, {middle, middle}});
    const Range bend = of_net(view, second_[2], stretch);
    const double up = std::max(0.0, slope.upper + noise_) / -(bend.upper + noise_);
    const double down = std::min(0.0, slope.lower - noise_) / -(bend.upper + noise_);
    const double least_up = std::max(0.0, slope.lower - noise_) / -(bend.lower - noise_);
    const double least_down = std::min(0.0, slope.upper + noise_) / -(bend.lower - noise_);
    const Interval own = {std::max(t.lower, middle + (down < 0 ? down : least_up)),
                          std::min(t.upper, middle + (up > 0 ? up : least_down))};
    const bool ends = own.upper - own.lower > narrow_share * (t.upper - t.lower);
    t = own;
    if (ends) return;
  }
}

RidgeContacts::Range RidgeContacts::of_net(const CellView& view, const std::vector<dvec4>& net,
                                           const Stretch& stretch) {
  restrict(net, stretch, part_[0]);
  Range range;
  for (const dvec4& coefficient : part_[0]) {
    for (const dvec3& d : view.corners()) range.include(glm::dot(dvec3(coefficient), d));
  }
  return range;
}

/// The direction of the ridge is (1, m), where m is a ratio of nets and as such between those of
/// their coefficients. The second derivative along it is at least that along any other direction;
/// and, a convex function of the three, at most the largest of those at coefficients.
RidgeContacts::Range RidgeContacts::bend(const CellView& view, const Stretch& stretch, Range& way) {
  for (std::size_t k : {0u, 1u, 2u}) restrict(second_[k], stretch, part_[k]);
  const std::size_t size = part_[0].size();
  way = {};
  Range above;
  for (const dvec3& d : view.corners()) {
    for (std::size_t k = 0; k < size; ++k) {
      const double ss = glm::dot(dvec3(part_[0][k]), d);
      const double st = glm::dot(dvec3(part_[1][k]), d);
      const double tt = glm::dot(dvec3(part_[2][k]), d);
      way.include(st / -tt);
      above.include(ss + st * st / -tt);
    }
  }
  const double middle = 0.5 * (way.lower + way.upper);
  Range along;
  for (const dvec3& d : view.corners()) {
    for (std::size_t k = 0; k < size; ++k) {
      along.include(
          glm::dot(dvec3(part_[0][k] + middle * (2.0 * part_[1][k] + middle * part_[2][k])), d));
    }
  }
  return {along.lower, above.upper};
}

bool RidgeContacts::find_bend(const CellView& view, Stretch& stretch) {
  Range way;
  const Range second = bend(view, stretch, way);
  stretch.bend = Bend::down;
  if (second.upper < -noise_) return true;
  stretch.bend = Bend::up;
  if (second.lower > noise_) return true;
  for (std::size_t k : {0u, 1u, 2u, 3u}) restrict(third_[k], stretch, part_[k]);
  // Bernstein coefficients of the cubic polynomial in m.
  Range third;
  const double a = way.lower;
  const double b = way.upper;
  for (const dvec3& d : view.corners()) {
    for (std::size_t k = 0; k < part_[0].size(); ++k) {
      const auto y = [&](std::size_t n) { return glm::dot(dvec3(part_[n][k]), d); };
      const double sss = y(0);
      const double sst = y(1);
      const double stt = y(2);
      const double ttt = y(3);
      third.include(sss + a * (3 * sst + a * (3 * stt + a * ttt)));
      third.include(sss + (2 * a + b) * sst + a * (a + 2 * b) * stt + a * a * b * ttt);
      third.include(sss + (a + 2 * b) * sst + b * (2 * a + b) * stt + a * b * b * ttt);
      third.include(sss + b * (3 * sst + b * (3 * stt + b * ttt)));
    }
  }
  stretch.bend = third.upper < 0 ? Bend::falling : Bend::rising;
  return third.upper < -noise_ || third.lower > noise_;
}

bool RidgeContacts::cut(const CellView& view, const std::vector<dvec2>& hull, const Interval& s,
                        int depth) {
  Stretch stretch{s, slice(hull, s)};
  if (widen(view, stretch) && of_net(view, second_[2], stretch).upper < -2 * noise_) {
    const Interval across = stretch.t;
    narrow(view, stretch);
    if (find_bend(view, stretch)) {
      stretch.t = across;
      // Else there were two ridges.
      if (!stretches_.empty()) {
        const Interval& before = stretches_.back().t;
        if (before.lower > across.upper || across.lower > before.upper) return false;
      }
      stretches_.push_back(stretch);
      return true;
    }
  }
  if (depth == cut_limit) return false;
  const double middle = 0.5 * (s.lower + s.upper);
  return cut(view, hull, {s.lower, middle}, depth + 1) &&
         cut(view, hull, {middle, s.upper}, depth + 1);
}

/// An edge at an end of s is a contact where g falls from it inwards. If g bends up there by b at
/// least over a width of no less than e / b, where -e is the least slope, it falls by e^2 / 2b at
/// most before it grows again. If it bends down from a width w on and up by c at most before that,
/// it falls by c w^2 / 2 at most.
bool RidgeContacts::is_dent_small(const CellView& view, bool at_upper) {
  const Stretch& beside = at_upper ? stretches_.back() : stretches_.front();
  const Interval& across = beside.t;
  const double end = at_upper ? beside.s.upper : beside.s.lower;
  const auto narrowed = [&](const Interval& s) {
    Stretch part{s, across};
    narrow(view, part);
    return part;
  };
  Range way;
  const Range slope = of_net(view, s_, narrowed({end, end}));
  const double fall = noise_ + std::max(0.0, at_upper ? slope.upper : -slope.lower);
  const bool turns = beside.bend == (at_upper ? Bend::rising : Bend::falling);
  double width = beside.s.upper - beside.s.lower;
  for (int round = 0; round < dent_limit; ++round, width *= 0.5) {
    const double at = at_upper ? end - width : end + width;
    const Range own = bend(view, narrowed({std::min(end, at), std::max(end, at)}), way);
    const double least = own.lower - noise_;
    if (least * width >= fall && fall * fall <= 2 * least * rho_) return true;
    if (turns && bend(view, narrowed({at, at}), way).upper < -noise_ &&
        own.upper * width * width <= 2 * rho_) {
      return true;
    }
  }
  return false;
}

/// In all ways in which g may change between bending up and down, from stretch to stretch without a
/// step; beyond an edge it bends down, unless there is no dent beside it that counts.
bool RidgeContacts::bends_down_once(const CellView& view, const std::array<bool, 2>& edges) {
  constexpr int impossible = -1;
  // How often at most it has begun to bend down, if it now bends up, and if down.
  int up = edges[0] && !is_dent_small(view, false) ? 1 : 0;
  int down = 1;
  for (const Stretch& stretch : stretches_) {
    switch (stretch.bend) {
      case Bend::up:
        down = impossible;
        break;
      case Bend::down:
        up = impossible;
        break;
      case Bend::falling:
        if (up != impossible) down = std::max(down, up + 1);
        break;
      case Bend::rising:
        up = std::max(up, down);
        break;
    }
  }
  if (up == 1 && edges[1] && !is_dent_small(view, true)) ++up;
  const int most = std::max(up, down);
  return most != impossible && most <= 1;
}

bool RidgeContacts::are_one(const CellView& view, Direction along, const std::vector<dvec2>& hull,
                            const std::array<bool, 4>& edges) {
  const bool of_u = along == Direction::u;
  for (const Side side : all_sides) {
    if (edges[std::size_t(side)] && along_v(side) != of_u) return false;
  }
  derive(along);
  std::vector<dvec2> turned = hull;
  if (!of_u) {
    for (dvec2& p : turned) std::swap(p.x, p.y);
  }
  Range s;
  for (const dvec2& p : turned) s.include(p.x);
  stretches_.clear();
  const auto edge = [&](Side side) { return edges[std::size_t(side)]; };
  return cut(view, turned, {s.lower, s.upper}, 0) &&
         bends_down_once(view, of_u ? std::array{edge(Side::u0), edge(Side::u1)}
                                    : std::array{edge(Side::v0), edge(Side::v1)});
}

/// The branch's only patch, and at which of its sides edges belong to the branch.
std::optional<int> RidgeContacts::patch(const Branches& branches, const Branch& branch,
                                        std::array<bool, 4>& edges) {
  std::optional<int> face;
  for (const int k : branch.charts) {
    const SourceKind kind = branches.chart(k).kind;
    if (kind == SourceKind::edge) continue;
    if (kind != SourceKind::face || face) return std::nullopt;
    face = k;
  }
  edges = {};
  for (const int g : branch.glues) {
    const Glue& glue = branches.glue(g);
    if (glue.kind != Glue::Kind::face_edge || edges[std::size_t(glue.at_a)]) return std::nullopt;
    edges[std::size_t(glue.at_a)] = true;
  }
  const auto count = std::count(edges.begin(), edges.end(), true);
  return count + 1 == std::ptrdiff_t(branch.charts.size()) ? face : std::nullopt;
}

bool RidgeContacts::are_one(const CellView& view, const Branches& branches, const Branch& branch) {
  std::array<bool, 4> edges = {};
  const std::optional<int> face = patch(branches, branch, edges);
  if (!face) return false;
  const Chart& chart = branches.chart(*face);
  const MapElement& element = pieces_.element(chart.element);
  if (element.rational) return false;
  std::vector<dvec2> hull = parameter_hull(view, branches, branch, *face);
  for (dvec2& p : hull) {
    p = {chart.u.lower + p.x * (chart.u.upper - chart.u.lower),
         chart.v.lower + p.y * (chart.v.upper - chart.v.lower)};
  }
  const NetShape shape = element.root->exact.shape;
  noise_ = view.noise() * std::pow(2 * std::max({shape.p, shape.q, 1}), 3);
  constexpr std::array directions = {Direction::u, Direction::v};
  return std::any_of(directions.begin(), directions.end(), [&](Direction along) {
    shape_ = shape;
    pieces_.restricted(chart.element, {0, 1}, {0, 1}, net_);
    for (dvec4& p : net_) p /= p.w;
    return are_one(view, along, hull, edges);
  });
}

}  // namespace taut
