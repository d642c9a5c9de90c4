#pragma once

#include "taut/bounds/support_query.h"
#include "taut/hull/result/hull_mesh.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// Directions in which vertices of a mesh support the scene, one each.
///
/// On an edge or at a vertex many directions support: that of the mean of the facets about it, on
/// an edge turned across it, if it is one of them; else, and on surfaces, the sample's own. Where
/// the model reaches above the vertex there, as it may within the resolution, that is turned until
/// the model does not.
class VertexNormals {
 public:
  /// The scene must outlive it. `stop`: makes it throw Cancelled.
  explicit VertexNormals(const Scene& scene, Stop stop = {});

  /// Unit. The support in that direction is above the vertex by no more than support_slack and
  /// rounding; by the least that was found if the vertex lies deeper inside of the hull than that.
  /// @pre the vertex lies at the sample
  dvec3 operator()(const HullMesh& mesh, OpenMesh::VertexHandle v, const Sample& sample);

 private:
  dvec3 mean(const HullMesh& mesh, OpenMesh::VertexHandle v, const Contact& c) const;
  dvec3 turned(const dvec3& x, const Sample& sample);

  const Scene& scene_;
  SupportQuery query_;
  double slack_;  ///< in the scene's frame
};

}  // namespace taut
