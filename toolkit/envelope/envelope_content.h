#pragma once

#include <vector>

#include "taut/bounds/contact_climb.h"
#include "taut/envelope/envelope_pixel.h"
#include "taut/envelope/envelope_statistics.h"
#include "taut/envelope/gauss_triangles.h"
#include "taut/envelope/offscreen_canvas.h"

namespace taut {

/// Images are drawn by so many pixels larger on all sides than they are shown, so that what lies on
/// the circle where it touches the square is seen from both sides. Pixels there have columns and
/// rows below zero, or from the size on.
inline constexpr int image_margin = 4;

struct EnvelopeContent {
  explicit EnvelopeContent(const Scene& the_scene)
      : scene(the_scene), geometry(the_scene), elements(the_scene.model()) {}

  const Scene& scene;
  ContactGeometry geometry;
  ElementNumbers elements;
  int size = 0;
  int threads = 0;
  EnvelopeStatistics statistics;
  GaussTriangles triangles;
  int first_filler = 0;                      ///< of the triangles
  std::vector<int> element_sources;          ///< per element, as support queries tell them
  std::vector<std::vector<char>> is_corner;  ///< per part and vertex: a patch has it as a corner
  /// Per hemisphere: the element that is seen, and the triangle from which to climb to the contact.
  std::array<std::vector<OffscreenCanvas::Pixel>, 2> images;

  /// Of the images as they are drawn.
  std::size_t side() const { return std::size_t(size + 2 * image_margin); }
  const OffscreenCanvas::Pixel& at(const EnvelopePixel& p) const {
    return images[std::size_t(p.hemisphere)][std::size_t(p.row + image_margin) * side() +
                                             std::size_t(p.column + image_margin)];
  }
  dvec3 direction(const EnvelopePixel& p) const {
    return StereographicView{p.hemisphere, size}.direction_at(p.column, p.row);
  }
  /// The contact as support queries tell it: at the end of a free curve, where no surface has a
  /// corner, a contact of the curve.
  Contact told(const Contact& c) const;
  /// Where a triangle has the direction, as it is interpolated.
  Contact start(std::uint32_t triangle, const dvec3& n) const;
  ClimbedContact climbed(const EnvelopePixel& p) const {
    return climb(geometry, start(at(p).triangle, direction(p)), direction(p));
  }
};

}  // namespace taut
