#pragma once

#include <memory>
#include <vector>

#include "taut/bounds/contact.h"
#include "taut/bounds/scene_frame.h"
#include "taut/core/progress.h"
#include "taut/surface/model.h"

namespace taut {

struct SceneContent;  // in scene_content.h, for the bounds layer

/// How a scene is built.
struct SceneOptions {
  int threads = 0;    ///< 0: all
  Progress progress;  ///< told of the share done, and asked to stop
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
  /// Leaves the other one to be assigned to or destroyed.
  Scene(Scene&&) noexcept;
  /// Leaves the other one to be assigned to or destroyed.
  Scene& operator=(Scene&&) noexcept;

  /// The model as it was given.
  const Model& model() const;
  /// The scene's own frame.
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

  /// What queries read.
  const SceneContent& content() const { return *content_; }
  /// Queries read what a scene holds and know nothing of the scene.
  operator const SceneContent&() const { return *content_; }

 private:
  std::unique_ptr<SceneContent> content_;
};

}  // namespace taut
