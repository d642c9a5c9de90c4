#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"
#include "taut/hull/sample/sampled_polytope.h"

namespace taut {

/// The mesh of a polytope, unlabelled: coplanar facets as polygons, extreme points only. The
/// polytope's coordinates are the mesh's times `scale`, a power of two; `point_of` becomes, for
/// each vertex of the mesh, its number among the hull's points. @throws Cancelled
HullMesh bare_mesh(const PointHull& hull, double scale, PointHull::Polygons polygons,
                   std::vector<int>& point_of, const Progress& progress = {});

/// Where a face of a mesh lies.
struct FaceLabel {
  FaceKind kind = FaceKind::facet;  ///< of the hull's face
  int source = -1;                  ///< Model::source, -1 where it spans between several
  int hull_face = -1;               ///< number of the hull's face
};

/// What is known of the faces of a polytope's mesh.
struct KnownLabels {
  /// The label of the face with these corners, points of the hull by number, if known. `bridges`
  /// tells whether one of its edges bridges a gap, as the samples tell.
  std::function<std::optional<FaceLabel>(std::span<const int> corners,
                                         const std::function<bool()>& bridges)>
      label;
  /// Numbers of hull faces that `label` gives are below this.
  int count = 0;
};

/// The solid hull that a polytope is whose vertices are samples of a scene, with its mesh and the
/// origin of every vertex and face.
///
/// Coplanar facets become polygons, vertices that are not extreme go. Kinds of faces that are not
/// known are read off the samples: a face whose plane supports the model (its gap is not above
/// flat_width) is a facet; an edge runs along the surface if the model has a point as near to its
/// middle as the polytope is to the hull, sought from either end, and bridges a gap otherwise; a
/// face with no bridging edge is part of a patch, with all its edges bridging it stands for a
/// facet, else it lies on a scroll. At a coarse tolerance that is a guess; it never moves a vertex.
/// @pre the limits of the progress are lifted where the polytope has met one
/// @throws HullNotConverged if the polytope has failed, HullLimitExceeded if it has met a limit
Hull polytope_hull(const Scene& scene, const HullOptions& options, const SampledPolytope& polytope,
                   const KnownLabels& known = {});

/// @throws HullNotConverged with the hull for a failure, HullLimitExceeded for a limit
void throw_if_failed(Hull& hull, const std::optional<std::string>& failure,
                     const std::optional<std::string>& limit);

}  // namespace taut
