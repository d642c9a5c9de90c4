#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/progress.h"
#include "taut/io/text_scanner.h"

namespace taut {

/// A vertex of an OBJ file; the weight counts in rational curves and surfaces only.
struct ObjVertex {
  dvec3 point;
  double weight = 1;
  long line = 0;
};

/// A `curv` or `surf` as it is written, with the state that it stands in.
struct ObjElement {
  bool surface = false;
  bool rational = false;
  bool spline = false;  ///< a B-spline; otherwise Bezier
  int degree_u = 0;
  int degree_v = 0;  ///< 0: `deg` gave one degree only
  Interval u, v;     ///< the ranges of the parameters, of a curve in u
  /// From 0, not negative; u index fastest. They may exceed the number of vertices.
  std::vector<std::size_t> vertices;
  /// Of `parm`: knots of a B-spline, breakpoints of Bezier pieces; empty where it gives none.
  std::vector<double> parameters_u, parameters_v;
  long parameters_line_u = 0, parameters_line_v = 0;
  std::string name;  ///< of the last `g` or `o`, may be empty
  long line = 0;
};

/// What an OBJ file holds of free-form geometry, in the file's own terms.
struct ObjFile {
  std::vector<ObjVertex> vertices;
  std::vector<ObjElement> elements;
  std::size_t polygons = 0;
};

/// Reads all statements; checks numbers and the order of statements, not what they mean together.
/// @throws IoError, InvalidInput with place; Cancelled
ObjFile parse_obj(TextScanner& scanner, const Progress& progress);

/// The vertex index of a reference "v", "v/vt" or "v/vt/vn", counted from 0; `count` vertices were
/// read before it, from the last of which negative references count.
/// @throws IoError if it is no such reference, InvalidInput if it lies before the first vertex
std::size_t obj_vertex_index(const TextScanner& scanner, const Word& word, std::size_t count);

/// The coordinates of a `v` statement. @throws IoError, InvalidInput with place
dvec3 obj_point(const TextScanner& scanner, const std::vector<Word>& statement);

}  // namespace taut
