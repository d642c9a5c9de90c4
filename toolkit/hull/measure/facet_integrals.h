#pragma once

#include "taut/hull/measure/boundary_integrals.h"
#include "taut/hull/measure/crease_origins.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Adds the integrals over a facet: the polygon of its contacts, and what lies between its sides
/// and the curved ones, with these ones' share of the creases there. `origin` is a point inside.
void add_facet(const ContactGeometry& geometry, const HullFace& face, const dvec3& origin,
               const CreaseOrigins& creases, Sums& sums);

/// All faces are polygons, and the curves the segments between two: what facetted_boundary() and
/// polyhedral_boundary() make.
bool is_polyhedron(const HullBoundary& boundary);

/// Adds the total mean curvature of a polyhedron's edges: half the sum of their lengths times the
/// angles by which the normal turns there (Santalo 1976, chapter 13), inward where it turns back.
/// Normals of facets that are too thin to tell them matter little: what they add along one side
/// they take along the other.
void add_creases(const HullBoundary& boundary, Sums& sums);

}  // namespace taut
