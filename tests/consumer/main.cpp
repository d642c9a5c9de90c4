#include "taut/hull/convex_hull.h"
#include "taut/hull/result/measures.h"
#include "taut/io/model/read_model.h"

/// consumer MODEL VOLUME: is the volume of the model's convex hull VOLUME, within one percent?
int main(int, char** argv) {
  taut::Model model;
  taut::read_model(argv[1], model);
  const taut::Hull hull = taut::convex_hull(model);
  const double expected = std::stod(argv[2]);
  const double volume = taut::measure(taut::polygons(hull.mesh)).volume;
  return std::abs(volume - expected) < 0.01 * expected ? 0 : 1;
}
