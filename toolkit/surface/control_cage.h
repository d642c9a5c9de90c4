#pragma once

#include <array>
#include <vector>

#include "taut/core/geometry.h"

namespace taut {

enum class CageScheme {
  catmark,  ///< Catmull-Clark: bicubic where the cage is regular
  loop,     ///< Loop, of triangles only: quartic box splines where the cage is regular
};

/// What the limit surface does at the cage's boundary.
enum class CageBoundary {
  edge_and_corner,  ///< ends in a cubic curve, in a corner where one face stands alone
  edge_only,        ///< ends in a cubic curve
  none,             ///< faces at the boundary have no surface
};

/// An edge, by its ends, with its sharpness: smooth at 0, infinitely sharp from infinite_sharpness.
struct CageCrease {
  std::array<int, 2> vertices = {0, 0};  ///< its ends, by index
  double sharpness = 0;                  ///< not negative
};

/// A vertex with its sharpness, likewise.
struct CageCorner {
  int vertex = 0;        ///< by index
  double sharpness = 0;  ///< not negative
};

/// Sharpness from which creases and corners never become smooth.
inline constexpr double infinite_sharpness = 10;

/// The control cage of a subdivision surface, in OpenSubdiv's terms.
struct ControlCage {
  CageScheme scheme = CageScheme::catmark;                ///< how it is refined
  CageBoundary boundary = CageBoundary::edge_and_corner;  ///< of the limit surface
  /// Semi-sharp creases lose sharpness as their neighbours along the crease do (Chaikin), rather
  /// than each by one a level.
  bool chaikin = false;
  /// Triangles of a Catmull-Clark cage have weights of their own.
  bool smooth_triangles = false;
  std::vector<dvec3> points;  ///< of the vertices
  /// Vertex indices, at least three a face.
  std::vector<std::vector<int>> faces;
  std::vector<CageCrease> creases;  ///< in any order
  std::vector<CageCorner> corners;  ///< in any order
  /// Faces that have no surface, though they count for that of their neighbours.
  std::vector<int> holes;
};

/// @throws InvalidInput if an index is out of range, a face has fewer than three corners (of a Loop
/// cage: other than three), a point is not finite, a sharpness is negative or no number, or a
/// crease's ends are one
void validate(const ControlCage& cage);

/// "catmark" or "loop".
const char* name_of(CageScheme scheme);
/// "edge_and_corner", "edge_only" or "none".
const char* name_of(CageBoundary boundary);

}  // namespace taut
