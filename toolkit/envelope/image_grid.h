#pragma once

#include <vector>

#include "taut/envelope/pixel_pairs.h"

namespace taut {

/// The pixels of one image with their neighbours to the right and below, and between which of them
/// separating curves run. What is farther than a few pixels outside of the inscribed circle is left
/// out.
class ImageGrid {
 public:
  /// A side between two neighbouring pixels: 2 * pixel to the right of it, 2 * pixel + 1 below.
  using SideNumber = int;

  /// @throws Cancelled
  ImageGrid(const EnvelopeContent& content, Hemisphere hemisphere, const Progress& progress);

  Hemisphere hemisphere() const { return hemisphere_; }
  /// Of the image as it is drawn.
  int size() const { return size_; }
  EnvelopePixel pixel(int number) const {
    return {hemisphere_, number % size_ - image_margin, number / size_ - image_margin};
  }
  /// Near or inside of the circle.
  bool is_seen(int pixel) const { return seen_[std::size_t(pixel)] != 0; }
  /// A separating curve runs through the side.
  bool bridges(SideNumber side) const { return bridging_[std::size_t(side)] != 0; }

  /// A block of 2 x 2 pixels, by its upper left one: its pixels in a loop, and the sides from each
  /// to the next.
  struct Block {
    std::array<int, 4> pixel;
    std::array<SideNumber, 4> side;
  };
  Block block(int upper_left) const {
    const int p = upper_left;
    return {{p, p + 1, p + 1 + size_, p + size_},
            {2 * p, 2 * (p + 1) + 1, 2 * (p + size_), 2 * p + 1}};
  }
  /// All four pixels of the block are there and seen.
  bool has_block(int upper_left) const;

 private:
  Hemisphere hemisphere_;
  int size_;
  std::vector<char> seen_;
  std::vector<char> bridging_;
};

}  // namespace taut
