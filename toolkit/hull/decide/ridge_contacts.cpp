#include "taut/hull/decide/ridge_contacts.h"

#include <algorithm>

#include "taut/bounds/vector_net.h"
#include "taut/hull/decide/parameter_hull.h"

namespace taut {
namespace {

/// How often stretches are halved, and widened across.
constexpr int cut_limit = 5;
constexpr int widening_limit = 6;
constexpr int narrowing_limit = 4;
constexpr double narrow_share = 0.7;

/// In units of what rounding may do to heights: what it may do to second and third derivatives.
constexpr double derivative_noise = 256;

/// The derivative of a net along s or t, as a net of the same degrees.
void derive_net(NetShape shape, const std::vector<dvec4>& net, bool along_s,
                std::vector<dvec4>& result) {
  const int degree = along_s ? shape.p : shape.q;
  const int step = along_s ? shape.q + 1 : 1;
  result.assign(net.size(), dvec4(0.0));
  for (int k = 0; k < shape.size(); ++k) {
    const int i = along_s ? k / (shape.q + 1) : k % (shape.q + 1);
    const dvec4& own = net[std::size_t(k)];
    dvec4& to = result[std::size_t(k)];
    if (i > 0) to += double(i) * (own - net[std::size_t(k - step)]);
    if (i < degree) to += double(degree - i) * (net[std::size_t(k + step)] - own);
  }
}

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

void RidgeContacts::Range::include(double x) {
  lower = std::min(lower, x);
  upper = std::max(upper, x);
}

/// With t within s.
void RidgeContacts::derive(Direction along) {
  std::vector<dvec4> s;
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
  derive_net(shape_, net_, true, s);
  derive_net(shape_, net_, false, t_);
  derive_net(shape_, s, true, second_[0]);
  derive_net(shape_, s, false, second_[1]);
  derive_net(shape_, t_, false, second_[2]);
  derive_net(shape_, second_[0], true, third_[0]);
  derive_net(shape_, second_[0], false, third_[1]);
  derive_net(shape_, second_[2], true, third_[2]);
  derive_net(shape_, second_[2], false, third_[3]);
}

void RidgeContacts::restrict(const std::vector<dvec4>& net, const Stretch& stretch,
                             std::vector<dvec4>& part) {
  part = net;
  restrict_net(shape_, part.data(), stretch.s, stretch.t);
}

/// Widens a stretch until heights grow from both sides inwards.
bool RidgeContacts::widen(const CellView& view, Stretch& stretch) {
  for (int round = 0; round < widening_limit; ++round) {
    const double noise = derivative_noise * view.noise();
    const Interval& t = stretch.t;
    const bool lower = of_net(view, t_, {stretch.s, {t.lower, t.lower}}).lower > noise;
    const bool upper = of_net(view, t_, {stretch.s, {t.upper, t.upper}}).upper < -noise;
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
    const double noise = derivative_noise * view.noise();
    const double up = std::max(0.0, slope.upper + noise) / -(bend.upper + noise);
    const double down = std::min(0.0, slope.lower - noise) / -(bend.upper + noise);
    const double least_up = std::max(0.0, slope.lower - noise) / -(bend.lower - noise);
    const double least_down = std::min(0.0, slope.upper + noise) / -(bend.lower - noise);
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
bool RidgeContacts::find_bend(const CellView& view, Stretch& stretch) {
  const double noise = derivative_noise * view.noise();
  for (std::size_t k : {0u, 1u, 2u}) restrict(second_[k], stretch, part_[k]);
  const std::size_t size = part_[0].size();
  Range way;
  Range bend;
  for (const dvec3& d : view.corners()) {
    for (std::size_t k = 0; k < size; ++k) {
      const double ss = glm::dot(dvec3(part_[0][k]), d);
      const double st = glm::dot(dvec3(part_[1][k]), d);
      const double tt = glm::dot(dvec3(part_[2][k]), d);
      way.include(st / -tt);
      bend.include(ss + st * st / -tt);
    }
  }
  stretch.bend = Bend::down;
  if (bend.upper < -noise) return true;
  const double middle = 0.5 * (way.lower + way.upper);
  Range along;
  for (const dvec3& d : view.corners()) {
    for (std::size_t k = 0; k < size; ++k) {
      along.include(
          glm::dot(dvec3(part_[0][k] + middle * (2.0 * part_[1][k] + middle * part_[2][k])), d));
    }
  }
  stretch.bend = Bend::up;
  if (along.lower > noise) return true;
  for (std::size_t k : {0u, 1u, 2u, 3u}) restrict(third_[k], stretch, part_[k]);
  // Bernstein coefficients of the cubic polynomial in m.
  Range third;
  const double a = way.lower;
  const double b = way.upper;
  for (const dvec3& d : view.corners()) {
    for (std::size_t k = 0; k < size; ++k) {
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
  return third.upper < -noise || third.lower > noise;
}

bool RidgeContacts::cut(const CellView& view, const std::vector<dvec2>& hull, const Interval& s,
                        int depth) {
  Stretch stretch{s, slice(hull, s)};
  const double noise = derivative_noise * view.noise();
  if (widen(view, stretch) && of_net(view, second_[2], stretch).upper < -2 * noise) {
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

/// Of all ways in which it may change its sign: it goes on without a step from stretch to stretch.
bool RidgeContacts::bends_down_once() const {
  constexpr int impossible = -1;
  // How often at most it has become negative, if it is now positive, and if it is negative.
  int up = 0;
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
  return std::max(up, down) <= 1;
}

bool RidgeContacts::are_one(const CellView& view, Direction along, const std::vector<dvec2>& hull) {
  derive(along);
  std::vector<dvec2> turned = hull;
  if (along == Direction::v) {
    for (dvec2& p : turned) std::swap(p.x, p.y);
  }
  Range s;
  for (const dvec2& p : turned) s.include(p.x);
  stretches_.clear();
  return cut(view, turned, {s.lower, s.upper}, 0) && bends_down_once();
}

bool RidgeContacts::are_one(const CellView& view, const Branches& branches, const Branch& branch) {
  if (branch.charts.size() > 1) return false;
  const Chart& chart = branches.chart(branch.charts.front());
  const MapElement& element = pieces_.element(chart.element);
  if (chart.kind != SourceKind::face || element.rational) return false;
  std::vector<dvec2> hull = parameter_hull(view, branches, branch, branch.charts.front());
  for (dvec2& p : hull) {
    p = {chart.u.lower + p.x * (chart.u.upper - chart.u.lower),
         chart.v.lower + p.y * (chart.v.upper - chart.v.lower)};
  }
  constexpr std::array directions = {Direction::u, Direction::v};
  return std::any_of(directions.begin(), directions.end(), [&](Direction along) {
    shape_ = element.root->exact.shape;
    pieces_.restricted(chart.element, {0, 1}, {0, 1}, net_);
    return are_one(view, along, hull);
  });
}

}  // namespace taut
