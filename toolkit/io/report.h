#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/hull/measures.h"

namespace taut {

struct Warning {
  std::string code;
  std::string text;
};

/// Everything that a run of `taut hull` tells (contract: Report). Lengths in model units.
struct Report {
  struct Input {
    std::vector<std::string> files;
    int faces = 0, edges = 0, vertices = 0, patches = 0;
    double diagonal = 0;
    Box box;
  } input;
  std::string method;
  int dimension = 3;
  /// The true hull, as far as the method knows it: `sampled` bounds the gap only.
  struct ExactHull {
    std::optional<double> gap_bound;
  } hull;
  struct Mesh {
    long vertices = 0, edges = 0, faces = 0;
    Measures measures;
    double tolerance = 0;
    double distance_bound = 0;
    /// What was written; `rounding` as WrittenMesh has it, to be added to distance_bound.
    struct File {
      std::string file;
      double rounding = 0;
    };
    std::vector<File> files;
  } mesh;
  struct Queries {
    long support = 0, newton_iterations = 0;
  } queries;
  struct Seconds {
    double read = 0, build = 0, sample = 0, mesh = 0, write = 0, total = 0;
  } seconds;
  long peak_bytes = 0;
  std::vector<Warning> warnings;
};

/// The report as JSON text, two spaces of indentation; numbers round-trip.
std::string to_json(const Report& report);

}  // namespace taut
