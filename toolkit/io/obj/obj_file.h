#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/progress.h"
#include "taut/io/obj/obj_tags.h"
#include "taut/io/text/text_scanner.h"

namespace taut {

/// A vertex of an OBJ file, or a point (u, v, 0) of a parameter plane; the weight counts in
/// rational curves and surfaces only.
struct ObjVertex {
  dvec3 point;
  double weight = 1;
  long line = 0;
};

/// A stretch of a curve in parameter space.
struct ObjTrimCurve {
  std::size_t curve = 0;  ///< index into ObjFile::parameter_curves
  Interval range;
};

/// A `trim` or `hole`.
struct ObjLoop {
  bool hole = false;
  std::vector<ObjTrimCurve> curves;
  long line = 0;
};

/// A `curv`, `surf` or `curv2` as it is written, with the state that it stands in; an `l` as the
/// B-spline of degree 1 that it is.
struct ObjElement {
  bool surface = false;
  bool rational = false;
  bool spline = false;  ///< a B-spline; otherwise Bezier
  int degree_u = 0;
  int degree_v = 0;  ///< 0: `deg` gave one degree only
  Interval u, v;     ///< the ranges of the parameters, of a curve in u; of a `curv2` no meaning
  /// From 0, not negative; u index fastest. They may exceed the number of vertices, but not, in a
  /// `curv2`, that of parameter points.
  std::vector<std::size_t> vertices;
  /// Of `parm`: knots of a B-spline, breakpoints of Bezier pieces; empty where it gives none.
  std::vector<double> parameters_u, parameters_v;
  long parameters_line_u = 0, parameters_line_v = 0;
  std::vector<ObjLoop> loops;
  std::string name;  ///< of the last `g` or `o`, may be empty
  long line = 0;
};

/// What an OBJ file holds of geometry, in the file's own terms.
struct ObjFile {
  std::vector<ObjVertex> vertices;
  std::vector<ObjVertex> parameter_points;
  std::vector<ObjElement> elements;
  std::vector<ObjElement> parameter_curves;
  std::vector<std::vector<int>> polygons;  ///< indices in range
  std::vector<int> points;                 ///< of `p`, likewise
  ObjTags tags;
  long tag_line = 0;  ///< of the first tag of a subdivision cage, or 0
};

/// Reads all statements; checks numbers and the order of statements, not what they mean together.
/// @throws IoError, InvalidInput with place; Cancelled
ObjFile parse_obj(TextScanner& scanner, const Progress& progress);

}  // namespace taut
