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
  std::string code;  ///< "coarse-resolution", ...
  std::string text;  ///< for a person
};

/// Everything that a run of `taut hull` tells (contract: Report). Lengths in model units.
struct Report {
  /// The model as it was read.
  struct Input {
    std::vector<std::string> files;  ///< as they were named
    int faces = 0;                   ///< over all instances
    int edges = 0;                   ///< over all instances
    int vertices = 0;                ///< over all instances
    int patches = 0;                 ///< Bezier patches, over all instances
    /// Of the edges, those of no face; of the vertices, those that were given as points.
    int curves = 0;
    int points = 0;       ///< see curves
    std::string unit;     ///< of lengths, "mm"; empty: none is known
    double diagonal = 0;  ///< of the box
    Box box;              ///< of the geometry itself
  } input;                ///< the model
  std::string method;     ///< "precise", "sampled" or "envelope"
  /// Below 3, areas are those of one side.
  int dimension = 3;
  /// The true hull, as far as the method knows it: `sampled` bounds the gap only.
  struct ExactHull {
    /// Faces by kind, curves between them, and spots that were not resolved.
    struct Counts {
      int patches = 0;     ///< faces of the kind patch
      int scrolls = 0;     ///< faces of the kind scroll
      int facets = 0;      ///< faces of the kind facet
      int curves = 0;      ///< between faces
      int unresolved = 0;  ///< spots
    };
    std::optional<Counts> counts;          ///< none where no boundary is known
    std::optional<Resolution> resolution;  ///< at which places are told apart
    /// Faces whose places are below the supporting planes, by no more than the bound.
    struct Tolerant {
      int faces = 0;     ///< how many
      double bound = 0;  ///< the largest
    };
    std::optional<Tolerant> tolerant;  ///< none where no boundary is known
    std::optional<Measures> measures;  ///< of the exact hull, if known
    std::optional<double> mean_width;  ///< of the exact hull, if known
    /// Estimated relative accuracy of volume, area and mean width (BoundaryMeasures).
    std::optional<double> measures_accuracy;
    std::optional<double> gap_bound;  ///< proven, in model units
    /// Hull::points_left_out.
    long dropped = 0;
  } hull;  ///< the true hull
  /// The mesh that was found, and the files that hold it.
  struct Mesh {
    long vertices = 0;          ///< of the mesh
    long edges = 0;             ///< of the mesh
    long faces = 0;             ///< of the mesh
    Measures measures;          ///< of the mesh itself
    double tolerance = 0;       ///< 0: none, but a budget of vertices
    double distance_bound = 0;  ///< proven, from the true hull
    /// What was written; `rounding` as WrittenMesh has it, to be added to distance_bound.
    struct File {
      std::string file;     ///< as it was named
      double rounding = 0;  ///< 0 of doubles
    };
    std::vector<File> files;  ///< in the order of the options
  } mesh;                     ///< the mesh
  /// Pieces of the model that were looked at in cells of the map of directions, those that are left
  /// in them, and cells that were not decided. None where there is no map.
  struct Culling {
    long leaves = 0;    ///< pieces looked at
    long kept = 0;      ///< pieces left
    long searched = 0;  ///< cells not decided
  };
  std::optional<Culling> culling;  ///< see Culling
  /// Cells of the map of directions, pieces of the model looked at in them, and cells that were not
  /// decided. None where there is no map.
  struct Directions {
    long cells = 0;       ///< of the map
    long candidates = 0;  ///< pieces looked at
    long undecided = 0;   ///< cells
  };
  std::optional<Directions> directions;  ///< see Directions
  /// Faces of control cages whose surface is no single polynomial, and those of them that were
  /// refined since they may touch the hull; what is left changes the support function by no more
  /// than the bound. None where there are no cages.
  struct Subdivision {
    long irregular_faces = 0;    ///< of the cages
    long refined_faces = 0;      ///< of these
    double deviation_bound = 0;  ///< in model units
  };
  std::optional<Subdivision> subdivision;  ///< see Subdivision
  /// Support queries, and their steps.
  struct Queries {
    long support = 0;            ///< queries
    long newton_iterations = 0;  ///< steps
  } queries;                     ///< support queries
  /// Of each phase and of all.
  struct Seconds {
    double read = 0;              ///< the inputs
    double build = 0;             ///< the scene
    double sample = 0;            ///< support points
    double cull = 0;              ///< the map of directions
    double trace = 0;             ///< arcs and nodes
    double stitch = 0;            ///< faces
    double mesh = 0;              ///< the mesh
    double measure = 0;           ///< integrals
    double write = 0;             ///< the outputs
    double total = 0;             ///< of the whole run
  } seconds;                      ///< of wall-clock time
  long peak_bytes = 0;            ///< of main memory, at most
  std::vector<Warning> warnings;  ///< in the order in which they came
};

/// The report as JSON text, two spaces of indentation; numbers round-trip.
std::string to_json(const Report& report);

}  // namespace taut
