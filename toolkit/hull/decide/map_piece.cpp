#include "taut/hull/decide/map_piece.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "taut/bounds/vector_net.h"

namespace taut {

void even_weights(NetShape shape, std::span<dvec4> net) {
  const int p = shape.p;
  const int q = shape.q;
  const auto w = [&](int i, int j) { return net[std::size_t(i * (q + 1) + j)].w; };
  const double along_u = p > 0 ? std::pow(w(0, 0) * w(0, q) / (w(p, 0) * w(p, q)), 0.5 / p) : 1;
  const double along_v = q > 0 ? std::pow(w(0, 0) * w(p, 0) / (w(0, q) * w(p, q)), 0.5 / q) : 1;
  double fu = 1 / std::sqrt(w(0, 0) * w(p, q));
  for (int i = 0; i <= p; ++i, fu *= along_u) {
    double f = fu;
    for (int j = 0; j <= q; ++j, f *= along_v) net[std::size_t(i * (q + 1) + j)] *= f;
  }
}

struct MapPiece::Halves {
  Halves(const MapPiece& whole, Direction across);
  MapPiece lower, upper;
};

MapPiece::Halves::Halves(const MapPiece& whole, Direction across) : lower(whole), upper(whole) {
  const bool along_u = across == Direction::u;
  const auto halve = [&](const StoredNet& in_lower, const StoredNet& in_upper) {
    dvec4* const points = upper.own(in_upper);
    const NetShape shape = in_upper.shape;
    along_u ? halve_u(shape, points, lower.own(in_lower))
            : halve_v(shape, points, lower.own(in_lower));
  };
  halve(lower.exact, upper.exact);
  for (std::size_t k = 0; k < whole.inward.size(); ++k) halve(lower.inward[k], upper.inward[k]);
  const Interval& range = along_u ? whole.u : whole.v;
  const double middle = 0.5 * (range.lower + range.upper);
  (along_u ? lower.u : lower.v).upper = middle;
  (along_u ? upper.u : upper.v).lower = middle;
  lower.finish();
  upper.finish();
}

MapPiece::MapPiece(const Root& root) : element(root.element), u(root.u), v(root.v) {
  std::size_t size = (root.rational ? 2 : 1) * root.net.points.size();
  for (const Root::Net& other : root.inward) size += other.points.size();
  points_.reserve(size);  // they stay where they are
  const auto stored = [&](const Root::Net& from) {
    const StoredNet result{from.shape, points_.data() + points_.size()};
    points_.insert(points_.end(), from.points.begin(), from.points.end());
    return result;
  };
  exact = stored(root.net);
  net = root.rational ? stored(root.net) : exact;
  inward.reserve(root.inward.size());
  for (const Root::Net& other : root.inward) inward.push_back(stored(other));
  finish();
}

/// Without its halves.
MapPiece::MapPiece(const MapPiece& other)
    : element(other.element),
      u(other.u),
      v(other.v),
      net(other.net),
      exact(other.exact),
      inward(other.inward),
      points_(other.points_) {
  const auto move = [&](StoredNet& stored) {
    stored.points = points_.data() + (stored.points - other.points_.data());
  };
  move(net);
  move(exact);
  for (StoredNet& stored : inward) move(stored);
}

MapPiece::~MapPiece() {
  for (const auto& made : halves_) delete made.load(std::memory_order_relaxed);
}

/// Once the nets but that with even weights are known.
void MapPiece::finish() {
  const std::size_t size = std::size_t(net.shape.size());
  if (net.points != exact.points) {
    std::copy_n(exact.points, size, own(net));
    even_weights(net.shape, {own(net), size});
  }
  box = {};
  for (std::size_t k = 0; k < size; ++k) box.include(euclidean(net.points[k]));
}

/// Of two threads that make them at once the one that comes second takes those of the first.
std::array<const MapPiece*, 2> MapPiece::halves(Direction across) const {
  std::atomic<const Halves*>& made = halves_[across == Direction::u ? 0 : 1];
  const Halves* known = made.load(std::memory_order_acquire);
  if (known == nullptr) {
    auto fresh = std::make_unique<const Halves>(*this, across);
    if (made.compare_exchange_strong(known, fresh.get(), std::memory_order_acq_rel)) {
      known = fresh.release();
    }
  }
  return {&known->lower, &known->upper};
}

}  // namespace taut
