#pragma once

#include <vector>

#include "taut/bounds/scene.h"
#include "taut/verify/region_outlines.h"
#include "taut/verify/verify.h"

namespace taut {

/// What a document claims of a direction: there is a point of height h over the origin, in model
/// units, and the model rises no farther above it than the bound that its face states.
struct SupportClaim {
  dvec3 n = dvec3(0.0);
  double h = 0;
  double bound = 0;
};

/// Those of all rulings and facets that are listed; of tolerant facets also those of their contacts
/// and of their boundaries.
std::vector<SupportClaim> listed_claims(const DocumentGeometry& geometry);
/// Those of rulings between the listed ones, which support as well.
std::vector<SupportClaim> claims_between(const DocumentGeometry& geometry,
                                         const DocumentOutlines& outlines);

/// Those of directions in the plane of a planar hull, `count` of them, as far as the outline
/// reaches by its sides and what these run along.
/// @throws Cancelled
std::vector<SupportClaim> outline_claims(const DocumentGeometry& geometry, int count,
                                         const VerifyOptions& options);

/// By how much the model rises above claims and their bounds, and by how much they rise above the
/// model, at most; in model units, infinite where a direction is none.
struct SupportGaps {
  double above = 0;
  double below = 0;
};
/// @pre the claims' heights are over the centre of the scene's frame
SupportGaps support_gaps(const std::vector<SupportClaim>& claims, const Scene& scene,
                         const VerifyOptions& options);

}  // namespace taut
