#include "taut/envelope/image_grid.h"

#include "taut/core/parallel.h"

namespace taut {
namespace {

/// How far outside of the circle pixels are seen, in pixels.
constexpr double seen_margin = 2.5;

}  // namespace

ImageGrid::ImageGrid(const EnvelopeContent& content, Hemisphere hemisphere,
                     const Progress& progress)
    : hemisphere_(hemisphere), size_(int(content.side())) {
  const auto count = std::size_t(size_) * std::size_t(size_);
  seen_.assign(count, 0);
  bridging_.assign(2 * count, 0);
  const double radius = 0.5 * content.size + seen_margin;
  const auto inside = [&](int column, int row) {
    const dvec2 p(column + 0.5 - 0.5 * size_, row + 0.5 - 0.5 * size_);
    return glm::dot(p, p) <= radius * radius;
  };
  const auto drawn = [&](int p) {
    return content.at(pixel(p)).element != OffscreenCanvas::nothing;
  };
  parallel_for(std::size_t(size_), 4, content.threads, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (int row = int(begin); row < int(end); ++row) {
      for (int column = 0; column < size_; ++column) {
        const int p = row * size_ + column;
        if (!inside(column, row) || !drawn(p)) continue;
        seen_[std::size_t(p)] = 1;
        const auto check = [&](int other_column, int other_row, SideNumber side) {
          if (other_column == size_ || other_row == size_) return;
          const int q = other_row * size_ + other_column;
          if (!inside(other_column, other_row) || !drawn(q)) return;
          bridging_[std::size_t(side)] = is_bridging(content, pixel(p), pixel(q)) ? 1 : 0;
        };
        check(column + 1, row, 2 * p);
        check(column, row + 1, 2 * p + 1);
      }
    }
  });
}

bool ImageGrid::has_block(int upper_left) const {
  if (upper_left % size_ == size_ - 1 || upper_left / size_ == size_ - 1) return false;
  for (const int p : block(upper_left).pixel) {
    if (!is_seen(p)) return false;
  }
  return true;
}

}  // namespace taut
