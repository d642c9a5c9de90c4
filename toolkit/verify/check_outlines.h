#pragma once

#include "taut/verify/hull_faults.h"
#include "taut/verify/region_outlines.h"

namespace taut {

/// Checks where the curves of a hull document run, and what lies along them:
/// - "kinds": a join is between patches of two sources, a bitangent along one patch, an edge on an
///   edge of the model, a ruling straight and along no patch;
/// - "order": the rulings of a scroll follow each other without turning back;
/// - "regions": the tracks of scrolls on a patch bound one of its regions each, on the same side,
///   and each loop of a patch has the parameters of its curves;
/// - "outlines": a facet's outline is convex and what its curves make it, and so are its sides.
///
/// Returns the largest distance by which a curve is off one of its two faces, or a face's own
/// outline off its curves, beyond the bounds that these faces state. `tolerance`: in model units,
/// for what is one point or a straight line. `resolution`: likewise, for the order of rulings and
/// contacts of tolerant faces.
double check_outlines(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                      double tolerance, double resolution, HullFaults& faults);

}  // namespace taut
