#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/hull/result/measures.h"
#include "taut/surface/resolution.h"

namespace taut {

/// What a run warned of: a code fit for scripts, and a sentence.
struct Warning {
  std::string code;
  std::string text;
};

/// Everything that a run of `taut hull` tells (contract: Report). Lengths in model units.
struct Report {
  /// The model as it was read.
  struct Input {
    std::vector<std::string> files;
    int faces = 0, edges = 0, vertices = 0, patches = 0;
    /// Of the edges, those of no face; of the vertices, those that were given as points.
    int curves = 0, points = 0;
    std::string unit;  ///< of lengths, "mm"; empty: none is known
    double diagonal = 0;
    Box box;
  } input;
  std::string method;
  /// Below 3, areas are those of one side.
  int dimension = 3;
  /// The true hull, as far as the method knows it: `sampled` bounds the gap only.
  struct ExactHull {
    /// Faces by kind, curves between them, and spots that were not resolved.
    struct Counts {
      int patches = 0, scrolls = 0, facets = 0, curves = 0, unresolved = 0;
    };
    std::optional<Counts> counts;
    std::optional<Resolution> resolution;
    /// Faces whose places are below the supporting planes, by no more than the bound.
    struct Tolerant {
      int faces = 0;
      double bound = 0;
    };
    std::optional<Tolerant> tolerant;
    std::optional<Measures> measures;
    std::optional<double> mean_width;
    /// Estimated relative accuracy of volume, area and mean width (BoundaryMeasures).
    std::optional<double> measures_accuracy;
    std::optional<double> gap_bound;
    /// Hull::points_left_out.
    long dropped = 0;
  } hull;
  /// The mesh that was found, and the files that hold it.
  struct Mesh {
    long vertices = 0, edges = 0, faces = 0;
    Measures measures;
    double tolerance = 0;  ///< 0: none, but a budget of vertices
    double distance_bound = 0;
    /// What was written; `rounding` as WrittenMesh has it, to be added to distance_bound.
    struct File {
      std::string file;
      double rounding = 0;
    };
    std::vector<File> files;
  } mesh;
  /// Pieces of the model that were looked at in cells of the map of directions, those that are left
  /// in them, and cells that were not decided. None where there is no map.
  struct Culling {
    long leaves = 0, kept = 0, searched = 0;
  };
  std::optional<Culling> culling;
  /// Cells of the map of directions, pieces of the model looked at in them, and cells that were not
  /// decided. None where there is no map.
  struct Directions {
    long cells = 0, candidates = 0, undecided = 0;
  };
  std::optional<Directions> directions;
  /// Faces of control cages whose surface is no single polynomial, and those of them that were
  /// refined since they may touch the hull; what is left changes the support function by no more
  /// than the bound. None where there are no cages.
  struct Subdivision {
    long irregular_faces = 0, refined_faces = 0;
    double deviation_bound = 0;
  };
  std::optional<Subdivision> subdivision;
  /// Support queries, and their steps.
  struct Queries {
    long support = 0, newton_iterations = 0;
  } queries;
  /// Of each phase and of all.
  struct Seconds {
    double read = 0, build = 0, sample = 0, cull = 0, trace = 0, stitch = 0;
    double mesh = 0, measure = 0, write = 0, total = 0;
  } seconds;
  long peak_bytes = 0;
  std::vector<Warning> warnings;
};

/// The report as JSON text, two spaces of indentation; numbers round-trip.
std::string to_json(const Report& report);

}  // namespace taut
