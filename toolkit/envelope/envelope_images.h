#pragma once

#include <memory>

#include "taut/bounds/scene.h"
#include "taut/core/progress.h"
#include "taut/envelope/envelope_pixel.h"
#include "taut/envelope/envelope_statistics.h"

namespace taut {

/// How envelope images are drawn.
struct EnvelopeOptions {
  /// Width and height of each image, in pixels. 8 .. 16384, or as many as the driver draws.
  int size = 1024;
  /// Threads of everything but the drawing itself, 0 for all. The images do not depend on it.
  int threads = 0;
  Progress progress;  ///< told of the share done, and asked to stop
};

struct EnvelopeContent;  // in envelope_content.h, for this layer

/// The upper envelope of a scene's support functions as two images of the sphere of directions
/// (Kim, Kim, Kim, Elber: Precise convex hull computation for freeform models, section 3.1): which
/// of its patches, edges and vertices supports in each direction, and where.
///
/// Every contact is drawn at the direction that it supports: patches by their Gauss map over
/// adaptive triangulations of their parameters, edges as bands, vertices as spherical polygons; the
/// support value goes to the depth buffer, and the numbers of element and triangle are kept,
/// exactly. Where two values are closer than depths tell, contacts recomputed in double precision
/// decide. So what is at a pixel is what supports at its centre, but for features that lie between
/// pixels' centres, and joins of patches to a quarter of a pixel.
///
/// The scene must outlive the images. Safe to ask concurrently.
class EnvelopeImages {
 public:
  /// Draws them. @throws InvalidInput if the size is out of range, BackendError if OSMesa does not
  /// draw (OffscreenCanvas), Cancelled
  explicit EnvelopeImages(const Scene& scene, const EnvelopeOptions& options = {});
  ~EnvelopeImages();
  /// Leaves the other one to be destroyed.
  EnvelopeImages(EnvelopeImages&&) noexcept;

  /// Whose images they are.
  const Scene& scene() const;
  /// Width and height of each, in pixels.
  int size() const;
  /// How directions map to the image of the hemisphere.
  StereographicView view(Hemisphere hemisphere) const { return {hemisphere, size()}; }
  /// What drawing took.
  const EnvelopeStatistics& statistics() const;

  /// The direction at the pixel's centre.
  dvec3 direction(const EnvelopePixel& p) const {
    return view(p.hemisphere).direction_at(p.column, p.row);
  }
  /// The pixel nearest to a direction, in the image of its hemisphere.
  EnvelopePixel pixel(const dvec3& n) const;
  /// The source that is seen at the pixel (Model::source).
  int source(const EnvelopePixel& p) const;
  /// The contact that is seen at the pixel, recomputed in double precision.
  Contact contact(const EnvelopePixel& p) const;

  /// For this layer.
  const EnvelopeContent& content() const { return *content_; }

 private:
  std::unique_ptr<const EnvelopeContent> content_;
};

}  // namespace taut
