#pragma once

#include "taut/envelope/envelope_map.h"

namespace taut {

/// Reads regions, separating curves and triple points off the images alone.
///
/// Between two neighbouring pixels runs a separating curve if their contacts are no local maxima of
/// one another's surfaces: if climbing from the one over the surface, towards what supports at the
/// other's centre, does not lead there. Its point between the two is the direction in which both
/// support the same, to within the interpolation between the pixels. Where the curves of three or
/// more contacts meet, or the contacts around leave a hole that no surface fills, there is a triple
/// point, polished to the plane through its contacts. Features narrower than a pixel are not seen,
/// nor are curves whose two contacts are closer than contacts move from pixel to pixel.
/// @throws Cancelled
EnvelopeMap trace_envelope(const EnvelopeImages& images, const Progress& progress = {});

}  // namespace taut
