#pragma once

#include "taut/envelope/stereographic.h"

namespace taut {

/// A pixel of one of the two images.
struct EnvelopePixel {
  Hemisphere hemisphere = Hemisphere::north;
  int column = 0;
  int row = 0;
};

}  // namespace taut
