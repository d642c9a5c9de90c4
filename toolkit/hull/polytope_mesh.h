#pragma once

#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/hull_mesh.h"
#include "taut/hull/point_hull.h"

namespace taut {

/// A point sampled on the hull: the direction that it supports, and where it lies on the model.
struct Sample {
  dvec3 n;
  Contact contact;
};

/// The mesh of a polytope, unlabelled: coplanar facets as polygons, extreme points only. The
/// polytope's coordinates are the mesh's times `scale`, a power of two; `point_of` becomes, for
/// each vertex of the mesh, its number among the hull's points.
HullMesh bare_mesh(const PointHull& hull, double scale, PointHull::Polygons polygons,
                   std::vector<int>& point_of);

/// The mesh of a polytope whose vertices are samples of a scene, with the origin of every vertex
/// and face.
///
/// Coplanar facets become polygons, vertices that are not extreme go. The kinds of faces are read
/// off the samples: a face whose plane supports the model (`gaps`, per facet, not above
/// flat_gap) is a facet; an edge runs along the surface if the model has a point as near to its
/// middle as the polytope is to the hull, sought from either end, and bridges a gap otherwise; a
/// face with no bridging edge is part of a patch, with all its edges bridging it stands for a
/// facet, else it lies on a scroll. At a coarse tolerance that is a guess; it never moves a vertex.
///
/// @pre the hull's points are model coordinates times the scene's scale; samples and vertex_bounds
/// (in model units) per point of the hull, gaps per facet place
HullMesh polytope_mesh(const Scene& scene, const PointHull& hull,
                       const std::vector<Sample>& samples, const std::vector<double>& gaps,
                       double flat_gap, const std::vector<double>& vertex_bounds);

}  // namespace taut
