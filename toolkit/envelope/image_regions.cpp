#include "taut/envelope/image_regions.h"

#include <algorithm>
#include <cmath>

#include "taut/core/disjoint_sets.h"

namespace taut {
namespace {

/// Depths of regions are counted so far.
constexpr int deepest = 3;

/// Pixels of the two images are compared so far on either side of the circle, in pixels.
constexpr double equator_width = 1.5;

class Regions {
 public:
  Regions(const EnvelopeContent& content, const std::array<ImageGrid, 2>& grids)
      : content_(content),
        grids_(grids),
        size_(grids[0].size()),
        count_(size_ * size_),
        sets_(std::size_t(2 * count_)) {}

  void run(EnvelopeMap& map) {
    for (const ImageGrid& grid : grids_) unite_neighbors(grid);
    unite_across_equator();
    number_.assign(std::size_t(2 * count_), -1);
    for (const ImageGrid& grid : grids_) {
      std::vector<int>& numbers = map.region_numbers[std::size_t(grid.hemisphere())];
      numbers.assign(std::size_t(map.size) * std::size_t(map.size), -1);
      for (int p = 0; p < count_; ++p) {
        if (!grid.is_seen(p) || !is_inside(grid, p)) continue;
        const EnvelopePixel pixel = grid.pixel(p);
        numbers[std::size_t(pixel.row * map.size + pixel.column)] =
            count_pixel(grid, p, map.regions);
      }
    }
  }

 private:
  int global(const ImageGrid& grid, int p) const {
    return p + (grid.hemisphere() == Hemisphere::south ? count_ : 0);
  }
  int source(const ImageGrid& grid, int p) const {
    return content_.element_sources[content_.at(grid.pixel(p)).element];
  }
  /// In the inscribed circle; its border belongs to the north.
  bool is_inside(const ImageGrid& grid, int p) const {
    const double z = content_.direction(grid.pixel(p)).z;
    return grid.hemisphere() == Hemisphere::north ? z >= 0 : z < 0;
  }

  void unite_neighbors(const ImageGrid& grid) {
    const auto unite = [&](int p, int q, int side) {
      if (!grid.is_seen(q) || grid.bridges(side) || source(grid, p) != source(grid, q)) return;
      sets_.unite(global(grid, p), global(grid, q));
    };
    for (int p = 0; p < count_; ++p) {
      if (!grid.is_seen(p)) continue;
      if (p % size_ + 1 < size_) unite(p, p + 1, 2 * p);
      if (p + size_ < count_) unite(p, p + size_, 2 * p + 1);
    }
  }

  void unite_across_equator() {
    const ImageGrid& north = grids_[0];
    const ImageGrid& south = grids_[1];
    const double radius = 0.5 * content_.size;
    const StereographicView view{Hemisphere::south, content_.size};
    for (int p = 0; p < count_; ++p) {
      if (!north.is_seen(p)) continue;
      const EnvelopePixel pixel = north.pixel(p);
      const double r = glm::length(dvec2(pixel.column + 0.5, pixel.row + 0.5) - dvec2(radius));
      if (std::abs(r - radius) > equator_width) continue;
      const dvec2 place = view.pixel(content_.direction(pixel));
      const int column = int(std::lround(place.x)) + image_margin;
      const int row = int(std::lround(place.y)) + image_margin;
      if (column < 0 || row < 0 || column >= size_ || row >= size_) continue;
      const int q = row * size_ + column;
      if (!south.is_seen(q) || source(north, p) != source(south, q)) continue;
      if (sets_.find(p) == sets_.find(q + count_)) continue;
      if (!is_bridging(content_, pixel, south.pixel(q))) sets_.unite(p, q + count_);
    }
  }

  /// How many pixels around the pixel are of its region too.
  int depth(const ImageGrid& grid, int p) {
    const int own = sets_.find(global(grid, p));
    for (int d = 1; d <= deepest; ++d) {
      for (int row = p / size_ - d; row <= p / size_ + d; ++row) {
        for (int column = p % size_ - d; column <= p % size_ + d; ++column) {
          if (column < 0 || row < 0 || column >= size_ || row >= size_) return d - 1;
          const int q = row * size_ + column;
          if (!grid.is_seen(q) || sets_.find(global(grid, q)) != own) return d - 1;
        }
      }
    }
    return deepest;
  }

  /// Counts the pixel to its region. The region's number.
  int count_pixel(const ImageGrid& grid, int p, std::vector<EnvelopeRegion>& regions) {
    int& number = number_[std::size_t(sets_.find(global(grid, p)))];
    if (number < 0) {
      number = int(regions.size());
      regions.push_back({source(grid, p), 0, grid.pixel(p), 0});
    }
    EnvelopeRegion& region = regions[std::size_t(number)];
    ++region.pixels;
    if (region.depth >= deepest) return number;
    const int own = depth(grid, p);
    if (own <= region.depth) return number;
    region.depth = own;
    region.inside = grid.pixel(p);
    return number;
  }

  const EnvelopeContent& content_;
  const std::array<ImageGrid, 2>& grids_;
  int size_;
  int count_;
  DisjointSets sets_;
  std::vector<int> number_;  ///< per set
};

}  // namespace

void find_regions(const EnvelopeContent& content, const std::array<ImageGrid, 2>& grids,
                  EnvelopeMap& map) {
  Regions(content, grids).run(map);
}

}  // namespace taut
