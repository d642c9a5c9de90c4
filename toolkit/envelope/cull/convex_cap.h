#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "taut/bounds/normal_pyramid.h"
#include "taut/bounds/scene.h"
#include "taut/core/progress.h"
#include "taut/core/stop.h"
#include "taut/envelope/cull/concave_patch.h"
#include "taut/envelope/cull/osculating_paraboloid.h"

namespace taut {

/// The patches of a scene's parts as ConcavePatches, made when they are first asked for. One object
/// a thread; the scene must outlive it.
class ConcaveSurfaces {
 public:
  /// `stop`: makes walks over them throw Cancelled.
  explicit ConcaveSurfaces(const Scene& scene, Stop stop = {})
      : scene_(scene), stop_(std::move(stop)) {}

  const std::vector<Patch>& patches(int part) const;
  ConcavePatch& patch(int part, int patch);
  std::size_t node_count() const;
  void forget() { held_.clear(); }
  /// Numbers of walks over them, see ConcavePatch::Mark.
  long next_walk() { return ++walks_; }
  void check_stop() const { stop_.check(); }

 private:
  const Scene& scene_;
  Stop stop_;
  long walks_ = 0;
  std::map<std::pair<int, int>, std::unique_ptr<ConcavePatch>> held_;  // by part and patch
};

/// Where a part's surface is proven to be concave, as seen along an axis m.
///
/// Let D be a disc in the plane normal to m about a cell of a patch, in coordinates in which the
/// surface falls off evenly in all directions. Walk from the cell as far as the surface lies over
/// D. Where the surface is curved one way all along, with all normals within a right angle of m,
/// and has no edge over D, it lies over D without a fold or an end: D being simply connected, what
/// is joined to the cell is the graph of one function over D, of class C1 and piecewise of negative
/// second derivatives, a concave one. Every tangent plane of it is above all of it.
///
/// Joins that are declared smooth (FacePatch) are taken to be so: what they miss is within the
/// model's deviation bound. In corners that are no vertices, and at poles, the angles of the
/// patches are taken to sum to a full turn.
struct ConvexCap {
  /// A rectangle of a patch that lies over the disc, on the graph.
  struct Piece {
    int patch;
    ParameterRectangle cell;
    dvec2 middle;  ///< where its middle is in the disc
  };

  dvec3 axis;
  OsculatingParaboloid map;
  double radius;
  std::vector<Piece> pieces;  ///< by patch; they do not overlap

  /// The rectangle surely lies on the graph.
  bool covers(int patch, const ParameterRectangle& cell) const;
  /// Outward normals of a rectangle that lies on the graph are, as those of its pieces, within a
  /// right angle of the axis. Surely so if the pyramid holds them, times `sign`.
  bool faces(const NormalPyramid& pyramid, double sign) const;
};

/// The cap over a disc about a cell. None if it is not certain that the surface is concave over
/// the disc and goes on all over it.
std::optional<ConvexCap> convex_cap(ConcaveSurfaces& surfaces, int part, int patch,
                                    const ParameterRectangle& cell, const dvec3& axis,
                                    const OsculatingParaboloid& map, double radius);

}  // namespace taut
