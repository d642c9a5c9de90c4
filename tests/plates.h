#pragma once

#include <vector>

#include "models.h"

namespace taut_test {

/// Horizontal circles of one radius, in pairs above each other: what a plate of bosses comes down
/// to. Their hull is that of the centres plus a disc.
struct Plate {
  double radius = 1;
  double thickness = 1;
  std::vector<dvec3> centers;  ///< of the lower circles
  Shape shape() const;
};

/// Of four corners, the third of which is raised.
Plate plate_of_four(double radius, double thickness, double shift_x, double shift_y, double raised);
/// Such plates at random.
Plate random_plate(unsigned seed);

struct PlateMeasures {
  double volume = 0;
  double mean_width = 0;
  /// Faces of the hull's boundary: one for each edge of the centres' hull that is not horizontal,
  /// one for each of its facets that is not, and two lids.
  int scrolls = 0;
  int facets = 0;
};

/// By Minkowski's formulas for polytope plus disc, and its faces.
PlateMeasures measures_of(const Plate& plate);

}  // namespace taut_test
