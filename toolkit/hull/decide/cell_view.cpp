#include "taut/hull/decide/cell_view.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Directions are as long as sqrt(3); kinks are measured at some places.
constexpr double kink_reach = 4;

/// A piece over which slopes change by more than over the cell, times this, is split.
constexpr double split_share = 1;
/// Oblique directions count where they are this much better: rectangles fit them less.
constexpr double oblique_worth = 4;
/// Of a cell with more pieces only those are split that are this much coarser than it; of one with
/// still more, none: the cell is split rather than they.
constexpr std::size_t many_pieces = 128;
constexpr double coarse_share = 64;
constexpr std::size_t split_piece_limit = 192;

/// Heights of a homogeneous vector over q, times its weight, by corner.
Corners heights(const dvec4& p, const dvec3& q, const std::array<dvec3, 4>& d) {
  const dvec3 x = dvec3(p) - p.w * q;
  return {glm::dot(x, d[0]), glm::dot(x, d[1]), glm::dot(x, d[2]), glm::dot(x, d[3])};
}

double middle_height(const SeenPiece& seen) {
  double sum = 0;
  for (std::size_t c = 0; c < 4; ++c) sum += seen.low[c] + seen.top[c];
  return 0.125 * sum;
}

/// What a sign is sought of: a range of values over the cell's corners and all heights of planes.
struct Range {
  double lower = infinity;
  double upper = -infinity;
  void include(double x) {
    lower = std::min(lower, x);
    upper = std::max(upper, x);
  }
};

}  // namespace

void CellView::turn_to(const std::array<dvec3, 4>& corners, const dvec3& q,
                       std::span<const dvec3> beacons) {
  d_ = corners;
  q_ = q;
  beacons_.clear();
  for (const dvec3& b : beacons) beacons_.push_back(heights({b, 1}, q_, d_));
  seen_.clear();
  values_.clear();
  highest_ = {};
}

bool CellView::is_beaten(const Corners& top) const {
  return std::any_of(beacons_.begin(), beacons_.end(), [&](const Corners& b) {
    return top[0] < b[0] - noise_ && top[1] < b[1] - noise_ && top[2] < b[2] - noise_ &&
           top[3] < b[3] - noise_;
  });
}

void CellView::look(int index) {
  ++looked;
  const MapPiece& piece = pieces_.piece(index);
  const int size = piece.net.shape.size();
  const dvec4* p = pieces_.points(piece.net);
  SeenPiece seen{index, values_.size(), {}, {}};
  seen.top.fill(-infinity);
  seen.low.fill(infinity);
  const bool rational = pieces_.element_of(piece).rational;
  for (int k = 0; k < size; ++k) {
    const Corners y = heights(p[k], q_, d_);
    values_.push_back(y);
    const double scale = rational ? 1 / p[k].w : 1;
    for (std::size_t c = 0; c < 4; ++c) {
      seen.top[c] = std::max(seen.top[c], y[c] * scale);
      seen.low[c] = std::min(seen.low[c], y[c] * scale);
    }
  }
  if (is_beaten(seen.top)) {
    values_.resize(seen.values);
    return;
  }
  seen_.push_back(seen);
}

void CellView::finish() {
  highest_.fill(0);
  for (const SeenPiece& seen : seen_) {
    for (std::size_t c = 0; c < 4; ++c) highest_[c] = std::max(highest_[c], seen.top[c]);
  }
  std::erase_if(seen_, [&](const SeenPiece& seen) {
    const MapPiece& piece = pieces_.piece(seen.piece);
    return surely_rises(piece, seen) || rises_inward(piece, seen);
  });
}

/// The heights grow or fall along a parameter all over the piece, and so nothing touches inside.
/// A plane at height h touches where (P - q w) . d - h w has no slope.
bool CellView::surely_rises(const MapPiece& piece, const SeenPiece& seen) const {
  const MapElement& element = pieces_.element_of(piece);
  const NetShape shape = piece.net.shape;
  const dvec4* p = pieces_.points(piece.net);
  const Corners* y = values(seen);
  const int row = shape.q + 1;
  // Along a collapsed side the slopes vanish. Beside it they are the distance from it, (1 - t) say,
  // times a function; a point at height (1 - t) L below the side's adds its share of dw to that.
  const auto sign_along = [&](Direction along) {
    const bool of_u = along == Direction::u;
    const int step = of_u ? row : 1;
    const int across = of_u ? 1 : row;
    const int count = of_u ? shape.p : shape.q;
    const int degree = of_u ? shape.q : shape.p;  // across
    const Interval& t = of_u ? piece.v : piece.u;
    const bool lower = t.lower == 0 && element.collapsed[std::size_t(of_u ? Side::v0 : Side::u0)];
    const bool upper = t.upper == 1 && element.collapsed[std::size_t(of_u ? Side::v1 : Side::u1)];
    Range range;
    double longest = 0;
    double heaviest = 0;
    for (int j = 0; j <= degree; ++j) {
      if ((lower && j == 0) || (upper && j == degree)) {
        for (int i = 0; i < count; ++i) {
          const int k = i * step + j * across;
          heaviest = std::max(heaviest, std::abs(p[k + step].w - p[k].w));
        }
        continue;
      }
      const double share = (lower ? double(degree) / j : 1) * (upper ? double(degree) / (degree - j) : 1);
      for (int i = 0; i < count; ++i) {
        const int k = i * step + j * across;
        const double dw = element.rational ? p[k + step].w - p[k].w : 0;
        for (std::size_t c = 0; c < 4; ++c) {
          const double slope = y[k + step][c] - y[k][c];
          range.include(share * (slope - seen.low[c] * dw));
          range.include(share * (slope - seen.top[c] * dw));
        }
        longest = std::max(longest, glm::length(dvec3(p[k + step] - p[k])));
      }
      if (range.lower <= noise_ && range.upper >= -noise_) return false;
    }
    double margin = noise_;
    if (heaviest > 0 && (lower || upper)) {
      double fall = 0;
      for (int j = 0; j < degree; ++j) {
        for (int i = 0; i <= count; ++i) {
          const int k = i * step + j * across;
          for (std::size_t c = 0; c < 4; ++c) {
            fall = std::max(fall, std::abs(y[k + across][c] / p[k + across].w - y[k][c] / p[k].w));
          }
        }
      }
      margin += heaviest * degree * fall;
    }
    // Towards a join with a kink, what is beyond may fall though this side rises.
    const auto beyond = [&](bool at_end, Side side) {
      return at_end ? kink_reach * element.kink[std::size_t(side)] * longest : 0;
    };
    return range.lower > margin + beyond((of_u ? piece.u : piece.v).upper == 1, of_u ? Side::u1 : Side::v1) ||
           range.upper < -margin - beyond((of_u ? piece.u : piece.v).lower == 0, of_u ? Side::u0 : Side::v0);
  };
  if (shape.p > 0 && sign_along(Direction::u)) return true;
  if (shape.q > 0 && sign_along(Direction::v)) return true;
  return shape.p > 0 && shape.q > 0 && surely_rises_obliquely(piece, seen);
}

/// Second derivatives in the middle of a piece and of the cell, with respect to parameters that run
/// from 0 to 1 over it.
CellView::Bend CellView::bend(const MapPiece& piece, const SeenPiece& seen) const {
  const NetShape shape = piece.net.shape;
  const dvec4* p = pieces_.points(piece.net);
  const Corners* y = values(seen);
  const int row = shape.q + 1;
  const double h = middle_height(seen);
  const auto at = [&](int i, int j) {
    const auto k = std::size_t(i * row + j);
    return 0.25 * (y[k][0] + y[k][1] + y[k][2] + y[k][3]) - h * p[k].w;
  };
  const int i = (shape.p - 1) / 2;
  const int j = (shape.q - 1) / 2;
  Bend bend;
  if (shape.p > 1) {
    const int k = (shape.p - 2) / 2;
    const int l = shape.q / 2;
    bend.uu = shape.p * (shape.p - 1) * (at(k, l) - 2 * at(k + 1, l) + at(k + 2, l));
  }
  if (shape.q > 1) {
    const int k = shape.p / 2;
    const int l = (shape.q - 2) / 2;
    bend.vv = shape.q * (shape.q - 1) * (at(k, l) - 2 * at(k, l + 1) + at(k, l + 2));
  }
  bend.uv = shape.p * shape.q * (at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j));
  return bend;
}

/// The heights grow or fall in a direction oblique to the parameters', in which slopes change but
/// little across it.
bool CellView::surely_rises_obliquely(const MapPiece& piece, const SeenPiece& seen) const {
  const MapElement& element = pieces_.element_of(piece);
  for (const Side side : all_sides) {
    const Interval& across = along_v(side) ? piece.u : piece.v;
    const bool at_side = at_upper_end(side) ? across.upper == 1 : across.lower == 0;
    const auto k = std::size_t(side);
    if (at_side && (element.collapsed[k] || element.kink[k] > 0)) return false;
  }
  const Bend b = bend(piece, seen);
  const NetShape shape = piece.net.shape;
  const dvec4* p = pieces_.points(piece.net);
  const Corners* y = values(seen);
  const int row = shape.q + 1;
  const auto is_definite = [&](double along_u, double along_v) {
    Range range;
    for (int i = 0; i <= shape.p; ++i) {
      for (int j = 0; j <= shape.q; ++j) {
        const auto k = std::size_t(i * row + j);
        const auto slope = [&](const auto& of) {
          const double own = of(k);
          double u = 0;
          double v = 0;
          if (i > 0) u += i * (own - of(k - std::size_t(row)));
          if (i < shape.p) u += (shape.p - i) * (of(k + std::size_t(row)) - own);
          if (j > 0) v += j * (own - of(k - 1));
          if (j < shape.q) v += (shape.q - j) * (of(k + 1) - own);
          return along_u * u + along_v * v;
        };
        const double dw =
            element.rational ? slope([&](std::size_t l) { return p[l].w; }) : 0;
        for (std::size_t c = 0; c < 4; ++c) {
          const double dy = slope([&](std::size_t l) { return y[l][c]; });
          range.include(dy - seen.low[c] * dw);
          range.include(dy - seen.top[c] * dw);
        }
      }
      if (range.lower <= noise_ && range.upper >= -noise_) return false;
    }
    return true;
  };
  if (b.uv == 0) return false;
  return (b.vv != 0 && is_definite(1, -b.uv / b.vv)) || (b.uu != 0 && is_definite(-b.uv / b.uu, 1));
}

/// A surface or an edge that ends at the piece rises from all of it, in all directions of the cell.
bool CellView::rises_inward(const MapPiece& piece, const SeenPiece& seen) const {
  return std::any_of(piece.inward.begin(), piece.inward.end(), [&](const StoredNet& net) {
    const dvec4* p = pieces_.points(net);
    for (int k = 0; k < net.shape.size(); ++k) {
      const Corners y = heights(p[k], q_, d_);
      for (std::size_t c = 0; c < 4; ++c) {
        const double h = p[k].w > 0 ? seen.top[c] : seen.low[c];
        if (!(y[c] - h * p[k].w > noise_)) return false;
      }
    }
    return true;
  });
}

/// 0: none, 1: along u, 2: along v. Slopes in two directions change over the piece by the second
/// derivatives, and over the cell by its width; where both are oblique to the parameters', by less.
int CellView::wanted_split(const SeenPiece& seen, double share) const {
  const MapPiece& piece = pieces_.piece(seen.piece);
  const NetShape shape = piece.net.shape;
  const int p = shape.p;
  const int q = shape.q;
  if (p == 0 && q == 0) return 0;
  const Corners* y = values(seen);
  const auto at = [&](int i, int j) -> const Corners& { return y[i * (q + 1) + j]; };
  // Slopes from end to end, by corner, along the sides where they differ most: others may be points.
  const auto slopes = [&](const Corners& from, const Corners& to) {
    return Corners{to[0] - from[0], to[1] - from[1], to[2] - from[2], to[3] - from[3]};
  };
  const auto wider = [](const Corners& a, const Corners& b) {
    const auto width = [](const Corners& c) {
      return *std::max_element(c.begin(), c.end()) - *std::min_element(c.begin(), c.end());
    };
    return width(a) >= width(b) ? a : b;
  };
  const Corners u = wider(slopes(at(0, 0), at(p, 0)), slopes(at(0, q), at(p, q)));
  const Corners v = wider(slopes(at(0, 0), at(0, q)), slopes(at(p, 0), at(p, q)));
  const auto spread = [&](double along_u, double along_v) {
    double lower = infinity, upper = -infinity;
    for (std::size_t c = 0; c < 4; ++c) {
      const double slope = along_u * u[c] + along_v * v[c];
      lower = std::min(lower, slope);
      upper = std::max(upper, slope);
    }
    return std::max(upper - lower, noise_);
  };
  const double h = middle_height(seen);
  const dvec4* points = pieces_.points(piece.net);
  const auto middle = [&](int i, int j) {
    const Corners& c = at(i, j);
    return 0.25 * (c[0] + c[1] + c[2] + c[3]) - h * points[i * (q + 1) + j].w;
  };
  const Bend b = bend(piece, seen);
  const double m = std::abs(b.uv) < std::abs(b.vv) ? -b.uv / b.vv : 0;
  const double n = std::abs(b.uv) < std::abs(b.uu) ? -b.uv / b.uu : 0;
  // Of slopes in the directions (1, 0), (0, 1), and (1, m), (n, 1): changes along u and v.
  struct Change {
    double along_u = 0, along_v = 0;
    void include(double of_u, double of_v) {
      along_u = std::max(along_u, std::abs(of_u));
      along_v = std::max(along_v, std::abs(of_v));
    }
  };
  Change plain_u, plain_v, oblique_u, oblique_v;
  for (int i = 0; i <= std::max(0, p - 1); ++i) {
    for (int j = 0; j <= std::max(0, q - 1); ++j) {
      const int k = std::max(0, std::min(i, p - 2));
      const int l = std::max(0, std::min(j, q - 2));
      const double uu =
          p > 1 ? p * (p - 1) * (middle(k, j) - 2 * middle(k + 1, j) + middle(k + 2, j)) : 0;
      const double vv =
          q > 1 ? q * (q - 1) * (middle(i, l) - 2 * middle(i, l + 1) + middle(i, l + 2)) : 0;
      const double uv = p > 0 && q > 0 ? p * q * (middle(i + 1, j + 1) - middle(i + 1, j) -
                                                  middle(i, j + 1) + middle(i, j))
                                       : 0;
      plain_u.include(uu, uv);
      plain_v.include(uv, vv);
      oblique_u.include(uu + m * uv, uv + m * vv);
      oblique_v.include(uv + n * uu, vv + n * uv);
    }
  }
  double along_u = 0;
  double along_v = 0;
  const auto add = [&](const Change& plain, double wide, const Change& oblique, double oblique_wide) {
    const bool is_better = oblique_worth * std::max(oblique.along_u, oblique.along_v) / oblique_wide <
                           std::max(plain.along_u, plain.along_v) / wide;
    along_u += is_better ? oblique.along_u / oblique_wide : plain.along_u / wide;
    along_v += is_better ? oblique.along_v / oblique_wide : plain.along_v / wide;
  };
  if (p > 0) add(plain_u, spread(1, 0), oblique_u, spread(1, m));
  if (q > 0) add(plain_v, spread(0, 1), oblique_v, spread(n, 1));
  if (p == 0) along_u = 0;
  if (q == 0) along_v = 0;
  if (!(std::max(along_u, along_v) > share)) return 0;
  return along_u >= along_v ? 1 : 2;
}

bool CellView::refine() {
  if (seen_.size() > split_piece_limit) return false;
  const double share = seen_.size() > many_pieces ? coarse_share : split_share;
  before_.swap(seen_);
  seen_.clear();
  bool any = false;
  for (const SeenPiece& seen : before_) {
    const int split = wanted_split(seen, share);
    if (split == 0) {
      seen_.push_back(seen);
      continue;
    }
    any = true;
    for (const int half : pieces_.halves(seen.piece, split == 1 ? Direction::u : Direction::v)) {
      look(half);
    }
  }
  if (any) finish();
  return any;
}

}  // namespace taut
