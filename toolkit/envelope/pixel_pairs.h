#pragma once

#include <optional>
#include <span>

#include "taut/envelope/envelope_content.h"
#include "taut/envelope/envelope_map.h"

namespace taut {

/// Whether two neighbouring pixels, which may be of different images, show contacts on different
/// branches of the model: a separating curve runs between them.
bool is_bridging(const EnvelopeContent& content, const EnvelopePixel& p, const EnvelopePixel& q);

/// Where the separating curve runs, between the two pixels' centres; contact 0 is that of p.
EnvelopeCurvePoint curve_point(const EnvelopeContent& content, const EnvelopePixel& p,
                               const EnvelopePixel& q);

/// The plane that touches in the contacts that are seen at three pixels, or more, of different
/// branches, if there is one whose direction is within `reach` of the pixels' mean.
std::optional<EnvelopeTriplePoint> common_plane(const EnvelopeContent& content,
                                                std::span<const EnvelopePixel> pixels,
                                                double reach);

/// The plane about which the contacts at these pixels, in a loop, lie without a surface inside: one
/// that touches along a curve.
std::optional<EnvelopeTriplePoint> plane_over_hole(const EnvelopeContent& content,
                                                   std::span<const EnvelopePixel> loop,
                                                   double reach);

}  // namespace taut
