#include "taut/hull/decide/cell_view.h"

#include <algorithm>

#include "taut/hull/decide/piece_slopes.h"

namespace taut {
namespace {

/// A piece over which slopes change by more than over the cell, times this, is split.
constexpr double split_share = 1;
/// Of a cell with more pieces only those are split that are this much coarser than it; of one with
/// still more, none: the cell is split rather than they.
constexpr std::size_t many_pieces = 128;
constexpr double coarse_share = 64;
constexpr std::size_t split_piece_limit = 192;
/// Narrow cells are few, where much touches one plane: so many times more are looked at in them.
constexpr double narrow_cell = 1e-4;
constexpr std::size_t narrow_times = 4;
constexpr double very_narrow_cell = 1e-6;
constexpr std::size_t very_narrow_times = 16;

}  // namespace

void CellView::turn_to(const std::array<dvec3, 4>& corners, const dvec3& q,
                       std::span<const dvec3> beacons) {
  d_ = corners;
  q_ = q;
  beacons_.clear();
  for (const dvec3& beacon : beacons) beacons_.push_back(heights({beacon, 1}, q_, d_));
  find_envelope();
  // What beats a piece may be its own point, told as another element's.
  depth_ = noise_ + pieces_.geometry().tie() * longest_direction();
  seen_.clear();
  values_.clear();
  highest_ = {};
}

void CellView::find_envelope() {
  envelope_.find(beacons_);
  limits_.clear();
  for (const BeaconEnvelope::Vertex& v : envelope_.vertices()) {
    const dvec3 d = d_[0] + v.s * (d_[2] - d_[0]) + v.t * (d_[1] - d_[0]);
    limits_.push_back({d, v.height + glm::dot(q_, d)});
  }
}

/// By which a piece has to be below the envelope, with what it stands for.
double CellView::depth_of(const MapPiece& piece) const {
  const bool stands = pieces_.element_of(piece).likeness.stands_for_others;
  return depth_ + (stands ? pieces_.covered_above() * longest_direction() : 0);
}

/// The box of its control points is below the envelope of the beacons: tells less than is_beaten(),
/// at once.
bool CellView::box_is_beaten(const MapPiece& piece) const {
  const double depth = depth_of(piece);
  const dvec3 center = 0.5 * (piece.box.lower + piece.box.upper);
  const dvec3 half = 0.5 * (piece.box.upper - piece.box.lower);
  return std::all_of(limits_.begin(), limits_.end(), [&](const Limit& limit) {
    return glm::dot(center, limit.d) + glm::dot(half, glm::abs(limit.d)) < limit.height - depth;
  });
}

/// Its control points are below the envelope.
bool CellView::is_beaten(const SeenPiece& seen, const MapPiece& piece) const {
  const double depth = depth_of(piece);
  const auto& corners = envelope_.vertices();
  for (std::size_t c = 0; c < 4; ++c) {
    if (!(seen.top[c] < corners[c].height - depth)) return false;
  }
  const dvec4* p = piece.net.points;
  const Corners* y = values(seen);
  return std::all_of(corners.begin() + 4, corners.end(), [&](const BeaconEnvelope::Vertex& v) {
    for (int k = 0; k < piece.net.shape.size(); ++k) {
      if (!(height_at(y[k], v.s, v.t) < (v.height - depth) * p[k].w)) return false;
    }
    return true;
  });
}

std::size_t CellView::crowding() const {
  const double width = glm::distance(d_[0], d_[3]);
  return width < very_narrow_cell ? very_narrow_times : width < narrow_cell ? narrow_times : 1;
}

double CellView::longest_direction() const {
  double longest = 0;
  for (const dvec3& d : d_) longest = std::max(longest, glm::length(d));
  return longest;
}

bool CellView::is_surpassed(const MapElement& element) const {
  const std::vector<Likeness::Other>& others = element.likeness.to_others;
  return std::any_of(others.begin(), others.end(), [&](const Likeness::Other& other) {
    return std::all_of(d_.begin(), d_.end(), [&](const dvec3& d) {
      return glm::dot(other.off, d) > noise_ + other.apart * glm::length(d);
    });
  });
}

void CellView::look(const MapPiece& piece) {
  ++looked_;
  if (is_surpassed(pieces_.element_of(piece)) || box_is_beaten(piece)) return;
  const dvec4* p = piece.net.points;
  SeenPiece seen{&piece, values_.size(), {}, {}};
  seen.top.fill(-infinity);
  seen.low.fill(infinity);
  const bool rational = pieces_.element_of(piece).rational;
  const int size = piece.net.shape.size();
  values_.resize(seen.values + std::size_t(size));
  Corners* y = values_.data() + seen.values;
  for (int k = 0; k < size; ++k) {
    y[k] = heights(p[k], q_, d_);
    const double scale = rational ? 1 / p[k].w : 1;
    for (std::size_t c = 0; c < 4; ++c) {
      seen.top[c] = std::max(seen.top[c], y[k][c] * scale);
      seen.low[c] = std::min(seen.low[c], y[k][c] * scale);
    }
  }
  if (is_beaten(seen, piece)) {
    values_.resize(seen.values);
  } else {
    seen_.push_back(seen);
  }
}

void CellView::finish() {
  highest_.fill(0);
  for (const SeenPiece& seen : seen_) {
    for (std::size_t c = 0; c < 4; ++c) highest_[c] = std::max(highest_[c], seen.top[c]);
  }
  std::erase_if(seen_, [&](const SeenPiece& seen) {
    const PieceSlopes slopes(pieces_, seen, values(seen), noise_);
    return slopes.surely_rise() || slopes.surely_bend_up() || rises_inward(seen);
  });
}

/// A surface or an edge that ends at the piece rises from all of it, in all directions of the cell.
/// What is higher there may be covered, and the piece what stands for it.
bool CellView::rises_inward(const SeenPiece& seen) const {
  const MapPiece& piece = *seen.piece;
  if (pieces_.element_of(piece).likeness.stands_for_others) return false;
  return std::any_of(piece.inward.begin(), piece.inward.end(), [&](const StoredNet& net) {
    const dvec4* p = net.points;
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

/// The one that is highest in the middle of the cell.
void CellView::add_highest_corner(const SeenPiece& seen) {
  const MapPiece& piece = *seen.piece;
  const int p = piece.net.shape.p;
  const int q = piece.net.shape.q;
  Corners best = {};
  double highest = -infinity;
  for (const int i : {0, p}) {
    for (const int j : {0, q}) {
      const int k = i * (q + 1) + j;
      Corners y = values(seen)[k];
      for (double& height : y) height /= piece.net.points[k].w;
      const double middle = y[1] + y[2];
      if (!(middle > highest)) continue;
      highest = middle;
      best = y;
    }
  }
  beacons_.push_back(best);
}

bool CellView::sharpen(double depth, const std::vector<double>& shares) {
  for (const SeenPiece& seen : seen_) add_highest_corner(seen);
  std::sort(beacons_.begin(), beacons_.end());
  beacons_.erase(std::unique(beacons_.begin(), beacons_.end()), beacons_.end());
  find_envelope();
  std::size_t left = 0;
  for (std::size_t k = 0; k < beacons_.size(); ++k) {
    if (envelope_.is_highest(k)) beacons_[left++] = beacons_[k];
  }
  beacons_.resize(left);
  depth_ = noise_ + (depth + pieces_.geometry().tie()) * longest_direction();
  before_.swap(seen_);
  seen_.clear();
  bool any = false;
  for (std::size_t k = 0; k < before_.size(); ++k) {
    const SeenPiece& seen = before_[k];
    const std::optional<Direction> split =
        PieceSlopes(pieces_, seen, values(seen), noise_).bends_both_ways(8 * depth * shares[k]);
    if (!split) {
      look(*seen.piece);
      continue;
    }
    any = true;
    for (const MapPiece* half : seen.piece->halves(*split)) look(*half);
  }
  any = any || seen_.size() < before_.size();
  finish();
  return any;
}

bool CellView::refine() {
  if (seen_.size() > split_piece_limit) return false;
  const double share = seen_.size() > many_pieces ? coarse_share : split_share;
  before_.swap(seen_);
  seen_.clear();
  bool any = false;
  for (const SeenPiece& seen : before_) {
    const std::optional<Direction> split =
        PieceSlopes(pieces_, seen, values(seen), noise_).wanted_split(share, scratch_);
    if (!split) {
      seen_.push_back(seen);
      continue;
    }
    any = true;
    for (const MapPiece* half : seen.piece->halves(*split)) look(*half);
  }
  if (any) finish();
  return any;
}

}  // namespace taut
