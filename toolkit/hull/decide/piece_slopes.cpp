#include "taut/hull/decide/piece_slopes.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Directions are as long as sqrt(3), and kinks are measured at some places.
constexpr double kink_reach = 4;

/// Oblique directions count where they are this much better: rectangles fit them less.
constexpr double oblique_worth = 4;

double width(const Corners& c) {
  return *std::max_element(c.begin(), c.end()) - *std::min_element(c.begin(), c.end());
}

Corners difference(const Corners& a, const Corners& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}

double mean(const Corners& c) { return 0.25 * (c[0] + c[1] + c[2] + c[3]); }

}  // namespace

void PieceSlopes::Change::include(double of_u, double of_v) {
  along_u = std::max(along_u, std::abs(of_u));
  along_v = std::max(along_v, std::abs(of_v));
}

/// Height of a control point times its weight, over that of the piece's middle.
double PieceSlopes::middle(std::size_t k) const {
  return mean(values_[k]) - 0.5 * (mean(seen_.low) + mean(seen_.top)) * points_[k].w;
}

/// By the control points next to one, with such heights.
template <class Middle>
PieceSlopes::Bend PieceSlopes::bend_at(int i, int j, const Middle& middle) const {
  const auto row = std::size_t(q() + 1);
  Bend bend;
  if (p() > 1) {
    const std::size_t k = index(std::clamp(i, 0, p() - 2), std::clamp(j, 0, q()));
    bend.uu = p() * (p() - 1) * (middle(k) - 2 * middle(k + row) + middle(k + 2 * row));
  }
  if (q() > 1) {
    const std::size_t k = index(std::clamp(i, 0, p()), std::clamp(j, 0, q() - 2));
    bend.vv = q() * (q() - 1) * (middle(k) - 2 * middle(k + 1) + middle(k + 2));
  }
  if (p() > 0 && q() > 0) {
    const std::size_t k = index(i, j);
    bend.uv = p() * q() * (middle(k + row + 1) - middle(k + row) - middle(k + 1) + middle(k));
  }
  return bend;
}

PieceSlopes::Bend PieceSlopes::bend() const {
  return bend_at((p() - 1) / 2, (q() - 1) / 2, [&](std::size_t k) { return middle(k); });
}

PieceSlopes::Lines PieceSlopes::lines(Direction direction) const {
  const int row = q() + 1;
  return direction == Direction::u ? Lines{row, 1, p(), q()} : Lines{1, row, q(), p()};
}

bool PieceSlopes::is_at(Side side) const {
  const Interval& across = along_v(side) ? piece_.u : piece_.v;
  return at_upper_end(side) ? across.upper == 1 : across.lower == 0;
}

bool PieceSlopes::is_at_pole_or_kink() const {
  return std::any_of(all_sides.begin(), all_sides.end(), [&](Side side) {
    const auto k = std::size_t(side);
    return is_at(side) && (element_.collapsed[k] || element_.kink[k] > 0);
  });
}

bool PieceSlopes::surely_rise() const {
  if (p() > 0 && rise_along(Direction::u)) return true;
  if (q() > 0 && rise_along(Direction::v)) return true;
  return p() > 0 && q() > 0 && rise_obliquely();
}

/// Along a collapsed side slopes vanish. Beside it they are the distance from it, a factor that is
/// taken out, times a function. Towards a join with a kink, what is beyond may fall though this
/// side rises: by the kink times the longest step, which for weights that change is that of the
/// points of the piece.
bool PieceSlopes::rise_along(Direction direction) const {
  const bool of_u = direction == Direction::u;
  const auto [step, across, count, degree] = lines(direction);
  const Side lower_side = of_u ? Side::v0 : Side::u0;
  const Side upper_side = of_u ? Side::v1 : Side::u1;
  const bool lower = is_at(lower_side) && element_.collapsed[std::size_t(lower_side)];
  const bool upper = is_at(upper_side) && element_.collapsed[std::size_t(upper_side)];
  CoefficientRange range;
  for (int j = lower ? 1 : 0; j <= degree - (upper ? 1 : 0); ++j) {
    const double factor =
        (lower ? double(degree) / j : 1) * (upper ? double(degree) / (degree - j) : 1);
    for (int i = 0; i < count; ++i) {
      const int k = i * step + j * across;
      const double dw = element_.rational ? points_[k + step].w - points_[k].w : 0;
      for (std::size_t c = 0; c < 4; ++c) {
        const double slope = values_[k + step][c] - values_[k][c];
        range.include(factor * (slope - seen_.low[c] * dw));
        range.include(factor * (slope - seen_.top[c] * dw));
      }
    }
    if (range.has_zero(noise_)) return false;
  }
  const double margin = noise_ + (lower || upper ? pole_margin(direction, lower, upper) : 0);
  const double longest = longest_step(direction);
  const auto beyond = [&](Side side) {
    return is_at(side) ? kink_reach * element_.kink[std::size_t(side)] * longest : 0;
  };
  return range.lower > margin + beyond(of_u ? Side::u1 : Side::v1) ||
         range.upper < -margin - beyond(of_u ? Side::u0 : Side::v0);
}

/// The longest of the control polygons, of the points over their weights.
double PieceSlopes::longest_step(Direction direction) const {
  const auto [step, across, count, degree] = lines(direction);
  const dvec3 center = piece_.box.center();
  const double reach = 0.5 * diagonal(piece_.box);
  double longest = 0;
  for (int j = 0; j <= degree; ++j) {
    for (int i = 0; i < count; ++i) {
      const int k = i * step + j * across;
      const dvec4 off = points_[k + step] - points_[k];
      longest =
          std::max(longest, glm::length(dvec3(off) - off.w * center) + reach * std::abs(off.w));
    }
  }
  return longest;
}

/// Of the heights over one of the piece, times the weights; a part of them once one is not above
/// `least`.
CoefficientRange PieceSlopes::second_differences(Direction direction, double least) const {
  const Lines line = lines(direction);
  CoefficientRange range;
  for (int j = 0; j <= line.degree; ++j) {
    for (int i = 0; i + 2 <= line.count; ++i) {
      const int k = i * line.step + j * line.across;
      const auto bend = [&](const auto& of) {
        return of(k) - 2 * of(k + line.step) + of(k + 2 * line.step);
      };
      const double w = element_.rational ? bend([&](int l) { return points_[l].w; }) : 0;
      for (std::size_t c = 0; c < 4; ++c) {
        const double y = bend([&](int l) { return values_[l][c]; });
        range.include(y - seen_.low[c] * w);
        range.include(y - seen_.top[c] * w);
        if (!(range.lower > least)) return range;
      }
    }
  }
  return range;
}

/// Of a net of the piece's degrees a coefficient of the slope in a direction, as one of the same
/// degrees.
template <class Of>
double PieceSlopes::slope_at(int i, int j, const Way& way, const Of& of) const {
  const auto row = std::size_t(q() + 1);
  const std::size_t k = index(i, j);
  const double own = of(k);
  double u = 0, v = 0;
  if (i > 0) u += i * (own - of(k - row));
  if (i < p()) u += (p() - i) * (of(k + row) - own);
  if (j > 0) v += j * (own - of(k - 1));
  if (j < q()) v += (q() - j) * (of(k + 1) - own);
  return way.along_u * u + way.along_v * v;
}

bool PieceSlopes::surely_bend_up() const {
  if (p() > 1 && bend_up_along(Direction::u)) return true;
  if (q() > 1 && bend_up_along(Direction::v)) return true;
  return p() > 0 && q() > 0 && bend_up_obliquely();
}

/// At a join with a kink the heights may fall at first, by the kink: by no more than they have
/// grown at the other end.
bool PieceSlopes::bend_up_along(Direction direction) const {
  const bool of_u = direction == Direction::u;
  const double least = 2 * noise_;
  const CoefficientRange range = second_differences(direction, least);
  if (!(range.lower > least)) return false;
  double kink = 0;
  for (const Side side : of_u ? std::array{Side::u0, Side::u1} : std::array{Side::v0, Side::v1}) {
    if (is_at(side)) kink = std::max(kink, element_.kink[std::size_t(side)]);
  }
  const int degree = of_u ? p() : q();
  return kink == 0 ||
         0.5 * (degree - 1) * range.lower > least + kink_reach * kink * longest_step(direction);
}

/// Where patches twist. At a corner of the patch what is beside it may be all that is higher.
bool PieceSlopes::bend_up_obliquely() const {
  if ((is_at(Side::u0) || is_at(Side::u1)) && (is_at(Side::v0) || is_at(Side::v1))) return false;
  if (is_at_pole_or_kink()) return false;
  const std::optional<Way> way = steepest_bend(bend());
  return way && are_convex(*way);
}

/// In the middle, if the heights bend up there at all: as far as a parameter goes.
std::optional<PieceSlopes::Way> PieceSlopes::steepest_bend(const Bend& b) const {
  const bool more_of_u = b.uu - b.vv > 0;
  // Of a slope that does not change across it: the bend is det / vv or det / uu.
  const double own = more_of_u ? b.vv : b.uu;
  if (!(own < 0)) return std::nullopt;
  const double oblique = -b.uv / own;
  const double up = (more_of_u ? b.uu : b.vv) + oblique * b.uv;
  if (!(up > noise_)) return std::nullopt;
  const double scale = 1 / std::max(1.0, std::abs(oblique));
  return more_of_u ? Way{scale, scale * oblique, scale * scale * up}
                   : Way{scale * oblique, scale, scale * scale * up};
}

std::optional<Direction> PieceSlopes::bends_both_ways(double least) const {
  std::optional<Direction> result;
  for (const Direction direction : {Direction::u, Direction::v}) {
    const int degree = direction == Direction::u ? p() : q();
    if (degree < 2) continue;
    const double most = degree * (degree - 1) * second_differences(direction, -infinity).upper;
    if (!(most > least)) continue;
    least = most;
    result = direction;
  }
  if (p() == 0 || q() == 0) return result;
  std::optional<Way> most;
  for (const int i : {0, p() - 1}) {
    for (const int j : {0, q() - 1}) {
      const std::optional<Way> way =
          steepest_bend(bend_at(i, j, [&](std::size_t k) { return middle(k); }));
      if (!way || !(way->up > least)) continue;
      least = way->up;
      most = way;
    }
  }
  return most ? changes_most(*most) : result;
}

/// The parameter with which the second derivative in a direction changes most.
Direction PieceSlopes::changes_most(const Way& way) const {
  const auto derivative = [&](const auto& of) {
    std::vector<double> net;
    net.reserve(std::size_t(piece_.net.shape.size()));
    for (int i = 0; i <= p(); ++i) {
      for (int j = 0; j <= q(); ++j) net.push_back(slope_at(i, j, way, of));
    }
    return net;
  };
  const std::vector<double> slopes = derivative([&](std::size_t k) { return middle(k); });
  const std::vector<double> bends = derivative([&](std::size_t k) { return slopes[k]; });
  double with_u = 0, with_v = 0;
  for (int i = 0; i <= p(); ++i) {
    for (int j = 0; j <= q(); ++j) {
      const double own = bends[index(i, j)];
      if (i > 0) with_u = std::max(with_u, p() * std::abs(own - bends[index(i - 1, j)]));
      if (j > 0) with_v = std::max(with_v, q() * std::abs(own - bends[index(i, j - 1)]));
    }
  }
  return with_u > with_v ? Direction::u : Direction::v;
}

/// Along a collapsed side weights may change. A point beside it is lower or higher than the side by
/// its distance from it times the slope across, and that, times the change, adds to the slope.
double PieceSlopes::pole_margin(Direction direction, bool lower, bool upper) const {
  const auto [step, across, count, degree] = lines(direction);
  double change = 0;
  for (int i = 0; i < count; ++i) {
    for (const int j : {lower ? 0 : degree, upper ? degree : 0}) {
      const int k = i * step + j * across;
      change = std::max(change, std::abs(points_[k + step].w - points_[k].w));
    }
  }
  double fall = 0;
  for (int j = 0; j < degree; ++j) {
    for (int i = 0; i <= count; ++i) {
      const int k = i * step + j * across;
      for (std::size_t c = 0; c < 4; ++c) {
        fall = std::max(fall, std::abs(values_[k + across][c] / points_[k + across].w -
                                       values_[k][c] / points_[k].w));
      }
    }
  }
  return change * degree * fall;
}

/// In a direction oblique to the parameters', in which slopes change but little across it: along
/// the floor of a valley, or the crest of a ridge.
bool PieceSlopes::rise_obliquely() const {
  if (is_at_pole_or_kink()) return false;
  const Bend b = bend();
  if (b.uv == 0) return false;
  return (b.vv != 0 && are_definite({1, -b.uv / b.vv})) ||
         (b.uu != 0 && are_definite({-b.uv / b.uu, 1}));
}

/// The second derivative's coefficients in a direction are positive.
bool PieceSlopes::are_convex(const Way& way) const {
  const double scale = std::abs(way.along_u) * p() + std::abs(way.along_v) * q();
  const double least = 4 * scale * scale * noise_;  // each is a sum of so many coefficients
  std::vector<std::array<double, 5>> slopes(std::size_t(piece_.net.shape.size()));
  for (int i = 0; i <= p(); ++i) {
    for (int j = 0; j <= q(); ++j) {
      const auto slope = [&](const auto& of) { return slope_at(i, j, way, of); };
      std::array<double, 5>& own = slopes[index(i, j)];
      for (std::size_t c = 0; c < 4; ++c) {
        own[c] = slope([&](std::size_t k) { return values_[k][c]; });
      }
      own[4] = element_.rational ? slope([&](std::size_t k) { return points_[k].w; }) : 0;
    }
  }
  for (int i = 0; i <= p(); ++i) {
    for (int j = 0; j <= q(); ++j) {
      const auto bend = [&](std::size_t c) {
        return slope_at(i, j, way, [&](std::size_t k) { return slopes[k][c]; });
      };
      const double w = element_.rational ? bend(4) : 0;
      for (std::size_t c = 0; c < 4; ++c) {
        const double y = bend(c);
        if (!(y - seen_.low[c] * w > least) || !(y - seen_.top[c] * w > least)) return false;
      }
    }
  }
  return true;
}

/// The slope's coefficients in a direction, as those of the degree of the piece, have one sign.
bool PieceSlopes::are_definite(const Way& way) const {
  const double noise = noise_ * std::max({1.0, std::abs(way.along_u), std::abs(way.along_v)});
  CoefficientRange range;
  for (int i = 0; i <= p(); ++i) {
    for (int j = 0; j <= q(); ++j) {
      const auto slope = [&](const auto& of) { return slope_at(i, j, way, of); };
      const double dw = element_.rational ? slope([&](std::size_t l) { return points_[l].w; }) : 0;
      for (std::size_t c = 0; c < 4; ++c) {
        const double dy = slope([&](std::size_t l) { return values_[l][c]; });
        range.include(dy - seen_.low[c] * dw);
        range.include(dy - seen_.top[c] * dw);
      }
    }
    if (range.has_zero(noise)) return false;
  }
  return true;
}

/// How much slopes from end to end differ over the cell: along the sides where they do most, for
/// others may be points.
double PieceSlopes::spread(double along_u, double along_v) const {
  const auto wider = [](const Corners& a, const Corners& b) {
    return width(a) >= width(b) ? a : b;
  };
  const auto at = [&](int i, int j) -> const Corners& { return values_[index(i, j)]; };
  const Corners u = wider(difference(at(p(), 0), at(0, 0)), difference(at(p(), q()), at(0, q())));
  const Corners v = wider(difference(at(0, q()), at(0, 0)), difference(at(p(), q()), at(p(), 0)));
  Corners both;
  for (std::size_t c = 0; c < 4; ++c) both[c] = along_u * u[c] + along_v * v[c];
  return std::max(width(both), noise_);
}

/// Slopes in two directions change over the piece by its second derivatives, and over the cell by
/// its width; where both directions are oblique to the parameters', often by less.
std::optional<Direction> PieceSlopes::wanted_split(double share,
                                                   std::vector<double>& scratch) const {
  if (p() == 0 && q() == 0) return std::nullopt;
  scratch.clear();
  for (int k = 0; k < piece_.net.shape.size(); ++k) scratch.push_back(middle(std::size_t(k)));
  const auto known = [&](std::size_t k) { return scratch[k]; };
  const Bend b = bend_at((p() - 1) / 2, (q() - 1) / 2, known);
  const double m = std::abs(b.uv) < std::abs(b.vv) ? -b.uv / b.vv : 0;
  const double n = std::abs(b.uv) < std::abs(b.uu) ? -b.uv / b.uu : 0;
  // Of slopes along u and v, and along (1, m) and (n, 1).
  Change plain_u, plain_v, oblique_u, oblique_v;
  for (int i = 0; i <= std::max(0, p() - 1); ++i) {
    for (int j = 0; j <= std::max(0, q() - 1); ++j) {
      const Bend at = bend_at(i, j, known);
      plain_u.include(at.uu, at.uv);
      plain_v.include(at.uv, at.vv);
      oblique_u.include(at.uu + m * at.uv, at.uv + m * at.vv);
      oblique_v.include(at.uv + n * at.uu, at.vv + n * at.uv);
    }
  }
  double along_u = 0, along_v = 0;
  const auto add = [&](const Change& plain, double wide, const Change& oblique,
                       double oblique_wide) {
    const double best = std::max(oblique.along_u, oblique.along_v) / oblique_wide;
    const bool is_better = oblique_worth * best < std::max(plain.along_u, plain.along_v) / wide;
    along_u += is_better ? oblique.along_u / oblique_wide : plain.along_u / wide;
    along_v += is_better ? oblique.along_v / oblique_wide : plain.along_v / wide;
  };
  if (p() > 0) add(plain_u, spread(1, 0), oblique_u, spread(1, m));
  if (q() > 0) add(plain_v, spread(0, 1), oblique_v, spread(n, 1));
  if (p() == 0) along_u = 0;
  if (q() == 0) along_v = 0;
  if (!(std::max(along_u, along_v) > share)) return std::nullopt;
  return along_u >= along_v ? Direction::u : Direction::v;
}

}  // namespace taut
