#pragma once

#include <array>
#include <vector>

#include "taut/envelope/envelope_images.h"

namespace taut {

/// A connected set of pixels that show one source, across the equator and unbroken by any
/// separating curve. Pixels outside of the inscribed circle do not count.
struct EnvelopeRegion {
  int source = -1;  ///< Model::source
  long pixels = 0;  ///< how many
  /// A pixel of the region, one of those that lie deepest inside.
  EnvelopePixel inside;
  /// How many pixels around that one are of the region too, in all eight directions: a region of
  /// depth d holds a square of 2 d + 1 pixels. Counted up to 3.
  int depth = 0;
};

/// A direction at which two contacts support at once.
struct EnvelopeCurvePoint {
  dvec3 n = dvec3(0.0);                                   ///< unit, outward
  std::array<Contact, 2> contact;                         ///< that support there
  std::array<dvec3, 2> point = {dvec3(0.0), dvec3(0.0)};  ///< in model coordinates
};

/// A polyline along a separating curve, between whose points there is about a pixel. To each of its
/// sides one source supports.
struct EnvelopeCurve {
  std::array<int, 2> sources = {-1, -1};   ///< Model::source, of the two contacts
  std::vector<EnvelopeCurvePoint> points;  ///< in order
  bool closed = false;                     ///< the last point is followed by the first
  /// Curves of one chain go on into each other, in their order, where a source changes.
  int chain = -1;
};

/// A plane that touches the model in three or more contacts, or along a curve.
struct EnvelopeTriplePoint {
  dvec3 n = dvec3(0.0);           ///< unit, outward
  std::vector<Contact> contacts;  ///< three or more
  std::vector<dvec3> points;      ///< in model coordinates
};

/// What two envelope images show.
struct EnvelopeMap {
  std::vector<EnvelopeRegion> regions;             ///< by number
  std::vector<EnvelopeCurve> curves;               ///< those of a chain one after another
  std::vector<EnvelopeTriplePoint> triple_points;  ///< in no order

  /// Width and height of the images.
  int size = 0;
  /// Per hemisphere and pixel, row by row, the number of its region; -1 outside of the circle.
  std::array<std::vector<int>, 2> region_numbers;

  /// The number of the pixel's region; -1 outside of the circle.
  int region_at(const EnvelopePixel& p) const {
    return region_numbers[std::size_t(p.hemisphere)]
                         [std::size_t(p.row) * std::size_t(size) + std::size_t(p.column)];
  }
  /// How many chains the curves make up.
  int chain_count() const { return curves.empty() ? 0 : curves.back().chain + 1; }
};

}  // namespace taut
