#pragma once

#include "taut/surface/polygon_mesh.h"

namespace taut {

/// Volume, area, centroid and inertia of the solid that a closed mesh bounds, in model units.
struct Measures {
  double volume = 0;  ///< in model units, cubed
  /// Of the surface, in model units, squared; of a planar hull's document of one side.
  double area = 0;
  /// Of the solid; of the surface where the volume is zero.
  dvec3 centroid = dvec3(0.0);
  /// Inertia tensor of the solid about the centroid for unit density; zero where volume is zero.
  dmat3 inertia = dmat3(0.0);
};

/// By the divergence theorem over fans of triangles, relative to the box's centre, summed in long
/// double: relative error about 1e-15. Of thin solids the volume errs by about 1e-19 (where long
/// double has 64 bits) of the area times the size.
/// @pre closed and oriented outward; polygons are planar
Measures measure(const PolygonMesh& mesh);

}  // namespace taut
