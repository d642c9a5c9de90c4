#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "taut/bounds/direction_cells.h"
#include "taut/bounds/patch_cell.h"
#include "taut/bounds/scene.h"

namespace taut {

struct ScenePart;

/// How deep a Gauss map goes.
struct GaussMapOptions {
  /// Levels of the patches' quadtrees below their roots, at most, and of the sphere's. 0 .. 8
  int levels = 3;
  int threads = 0;    ///< 0: all
  Progress progress;  ///< told of the share done, and asked to stop
};

/// A node of a patch's quadtree. Its points are bounded by the patch's CBVH or control points.
struct GaussNode {
  int element = -1;               ///< index among the part's elements; a face's patch
  PatchCell cell;                 ///< of the patch
  std::int32_t first_child = -1;  ///< of four consecutive nodes; -1 for a leaf
  NormalBounds bounds;            ///< of the cell
};

/// The Gauss map of the parts of a scene, as a hierarchy: for every patch a quadtree of cells with
/// pyramids of their normals and the signs with which curvature lets them touch a supporting plane;
/// and a quadtree over the sphere of directions that knows which cells may touch a plane with a
/// normal there.
///
/// All is in the parts' own frames, so that instances share it and rigid motions leave it as it is.
/// Surfaces need not be oriented: a cell counts for its normals and for their opposites. Cells of
/// one sign of curvature count for one, saddles for none. Curves and points have no normals of
/// their own, nor do ruled patches (PatchNets): they are not here.
///
/// Leaves are at the level asked for, or higher where nothing below could differ: no sign is left,
/// or the pyramid is so narrow that it lies within few cells of the sphere.
class GaussMap {
 public:
  /// @throws InvalidInput for levels out of range, Cancelled
  explicit GaussMap(const Scene& scene, const GaussMapOptions& options = {});

  /// Levels of the quadtrees below their roots, as the options ask.
  int levels() const { return levels_; }

  /// The nodes of a part. The roots come first, one for each patch of a face.
  std::span<const GaussNode> nodes(int part) const { return maps_[std::size_t(part)].nodes; }
  /// Patches of the part's faces.
  int root_count(int part) const { return maps_[std::size_t(part)].root_count; }
  /// Roots of ruled patches have no children (PatchNets).
  bool ruled(int part, int root) const { return maps_[std::size_t(part)].ruled[std::size_t(root)]; }

  /// A leaf and a sign with which it may touch a plane.
  struct Entry {
    std::int32_t node;  ///< its number among the part's nodes
    bool opposite;      ///< with the opposite of its normals
  };
  /// All leaves that may touch, from inside the leaf or smoothly at its border, a supporting plane
  /// whose normal lies in the cell; entries may repeat if the cell is above the finest level.
  /// @pre cell.level <= levels()
  std::span<const Entry> entries(int part, const DirectionCell& cell) const;
  /// The leaves whose pyramids may contain one direction, in the part's frame.
  std::vector<Entry> entries(int part, const dvec3& n) const;

  /// Bytes held.
  std::size_t memory() const;

 private:
  struct PartMap {
    std::vector<GaussNode> nodes;
    int root_count = 0;
    std::vector<bool> ruled;
    std::vector<Entry> entries;        // by cells of the finest level, in their order
    std::vector<std::uint32_t> first;  // of each cell's entries, and the end
  };
  static PartMap make_part(const ScenePart& part, const GaussMapOptions& options);
  static void sort_into_cells(PartMap& map, int levels);

  int levels_ = 0;
  std::vector<PartMap> maps_;
};

}  // namespace taut
