#pragma once

#include "taut/envelope/stereographic.h"

namespace taut {

/// A pixel of one of the two images.
struct EnvelopePixel {
  Hemisphere hemisphere = Hemisphere::north;  ///< whose image it is in
  int column = 0;                             ///< from the left, from 0
  int row = 0;                                ///< from the top, from 0
};

}  // namespace taut
