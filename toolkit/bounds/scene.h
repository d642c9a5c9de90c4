#pragma once

#include <memory>
#include <vector>

#include "taut/bounds/coons_bvh.h"
#include "taut/core/progress.h"
#include "taut/surface/model.h"

namespace taut {

/// A place on the model: an instance's patch with (u, v) in [0, 1]^2, a piece of a free curve with
/// t in [0, 1] as u, or a free point. What support queries return and start from.
struct Contact {
  int instance = -1;  ///< -1: no contact
  SourceKind kind = SourceKind::face;
  int element = -1;  ///< index of the patch, piece or vertex in the instance's part
  double u = 0;
  double v = 0;
};

/// Both lie on the same patch, piece or vertex.
inline bool same_element(const Contact& a, const Contact& b) {
  return a.instance == b.instance && a.kind == b.kind && a.element == b.element;
}

inline dvec2 parameters(const Contact& c) { return {c.u, c.v}; }

/// A contact in the terms of the model: its source and the source's own parameters.
struct SourceContact {
  int source = -1;
  SourceKind kind = SourceKind::face;
  double u = 0;
  double v = 0;
};

/// How the model's coordinates relate to the scene's frame: x_frame = (x - center) * scale.
/// The scale is a power of two, so scaling is exact.
struct SceneFrame {
  dvec3 center = dvec3(0.0);
  double scale = 1;

  dvec3 to_frame(const dvec3& x) const { return (x - center) * scale; }
  dvec3 to_model(const dvec3& x) const { return x / scale + center; }
  double length_to_model(double length) const { return length / scale; }
  double length_to_frame(double length) const { return length * scale; }
};

/// The frame of a scene whose model has this control box (Model::control_box).
SceneFrame scene_frame(const Box& control_box);

struct SceneOptions {
  int threads = 0;
  Progress progress;
};

/// A model prepared for queries: every part's CBVHs, built once and shared by its instances, and
/// bounding volume hierarchies over the patches of a part and over the instances.
///
/// Exact copies are there once: parts that are equal share what is built, and an instance that
/// repeats an earlier one exactly, an equal part in the same pose, is not looked at by queries. It
/// keeps its sources, and contacts on it have their points.
///
/// Everything inside is in a frame of its own, centred and scaled by a power of two to a size
/// near one, so that models tiny, huge or far from the origin lose nothing (turned instances far
/// from the origin lose the rounding of their rotation, which bounds account for). Immutable; safe
/// to query concurrently. Holds the model by value.
class Scene {
 public:
  /// @throws InvalidInput if the model holds no geometry
  explicit Scene(Model model, const SceneOptions& options = {});
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const Model& model() const;
  const SceneFrame& frame() const;
  /// Box of the geometry itself, in model coordinates: by support queries along the axes.
  const Box& box() const;
  /// Length of the box's diagonal, in model units. Zero for a single point.
  double diagonal() const;

  /// The instances that queries look at, ascending: those that repeat none.
  const std::vector<int>& distinct_instances() const;
  /// The first instance that this one repeats exactly, or itself.
  int first_instance(int instance) const;
  /// Patches of the distinct instances.
  int patch_count() const;

  /// The contact's point in model coordinates, rounded.
  dvec3 point(const Contact& contact) const;
  /// The contact in the model's terms. A contact on a border that is an edge belongs to that edge,
  /// one at a corner that is a vertex to that vertex. Seams and their vertices are no sources: what
  /// lies on one belongs to the edge that passes through it, else to the face of the first of the
  /// patches there that is not ruled, else of the first.
  SourceContact source(const Contact& contact) const;

  /// Bytes held by the CBVHs and hierarchies.
  std::size_t memory() const;

  struct Content;  // defined in scene_content.h, for the bounds layer
  const Content& content() const { return *content_; }

 private:
  std::unique_ptr<Content> content_;
};

}  // namespace taut
