#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "taut/envelope/envelope_map.h"

namespace taut {

/// Red, green and blue.
using Color = std::array<std::uint8_t, 3>;

/// An image of three bytes a pixel, rows from the top.
struct Picture {
  int width = 0;              ///< columns
  int height = 0;             ///< rows
  std::vector<Color> pixels;  ///< row by row

  /// The colour of a pixel. @pre it is in the image
  Color& at(int column, int row) {
    return pixels[std::size_t(row) * std::size_t(width) + std::size_t(column)];
  }
  /// The colour of a pixel. @pre it is in the image
  const Color& at(int column, int row) const {
    return pixels[std::size_t(row) * std::size_t(width) + std::size_t(column)];
  }
};

/// A colour for each source that the images show, no two alike and none that lines are drawn in.
std::map<int, Color> source_colors(const EnvelopeImages& images);

/// Curves and points on the sphere of directions that are drawn over the images.
struct EnvelopeOverlay {
  std::vector<std::vector<dvec3>> curves;  ///< polylines of unit directions
  std::vector<dvec3> points;               ///< unit directions
};

/// One of the images in colours that a person can read: every pixel in its source's colour, over it
/// the separating curves in black, three pixels wide, and triple points as white discs; just
/// outside of the inscribed circle a grey line. Pixels of the hemisphere farther than two pixels
/// from all curves are not painted over. An overlay is drawn one pixel wide on top, curves in white
/// and points in red.
Picture envelope_picture(const EnvelopeImages& images, const EnvelopeMap& map,
                         const std::map<int, Color>& colors, Hemisphere hemisphere,
                         const EnvelopeOverlay& overlay = {});

/// The picture as a PNG file's bytes. @throws BackendError if libpng fails
std::string to_png(const Picture& picture);

}  // namespace taut
