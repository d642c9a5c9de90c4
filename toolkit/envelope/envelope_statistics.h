#pragma once

#include <string>

namespace taut {

/// What drawing the images took, and what was met.
struct EnvelopeStatistics {
  std::string driver;  ///< of the drawing library, with its version
  long triangles = 0;  ///< drawn, of both images
  /// Pixels decided in double precision: at which two contacts were so close that depths of 32 bits
  /// do not tell, or beside which another element is seen.
  long decided_pixels = 0;
  /// Pixels that no surface, edge or vertex covered, and that show the nearest of some points that
  /// are sampled beforehand. None, unless surfaces turn faster than triangles are made fine.
  long filled_pixels = 0;
  /// Pixels without anything. None.
  long empty_pixels = 0;
  double seconds_triangles = 0;  ///< making triangles
  double seconds_draw = 0;       ///< drawing them
  double seconds_decide = 0;     ///< deciding in double precision
};

}  // namespace taut
