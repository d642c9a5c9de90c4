#include <cstdio>

#include "taut/core/error.h"
#include "taut/hull/convex_hull.h"
#include "taut/io/mesh/write_mesh.h"
#include "taut/io/model/read_model.h"

int main(int argc, char** argv) try {
  if (argc != 3) return std::puts("usage: hull_of_file MODEL MESH.ply"), 2;
  taut::Model model;
  taut::read_model(argv[1], model);
  const taut::Hull hull = taut::convex_hull(model, {.relative = 1e-4});
  // hull.mesh is an OpenMesh half-edge mesh, within hull.distance_bound of the true hull;
  // hull.kind tells whether that is solid, planar, a segment, a point or empty;
  // hull.boundary holds the exact faces and curves.
  taut::write_mesh(argv[2], hull.mesh);
  std::printf("%zu vertices, at most %g off\n", hull.mesh.n_vertices(), hull.distance_bound);
  return 0;
} catch (const taut::Error& error) {
  std::printf("%s\n", error.what());
  return 1;
}
