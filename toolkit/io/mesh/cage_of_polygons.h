#pragma once

#include "taut/io/text/read_options.h"
#include "taut/surface/control_cage.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// Polygons as the control cage of a subdivision surface without tags. Points that no polygon uses
/// have no part in it.
/// @pre the scheme is not bilinear
ControlCage cage_of(PolygonMesh mesh, Scheme scheme);

}  // namespace taut
