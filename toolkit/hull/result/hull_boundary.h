#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/result/face_kind.h"

namespace taut {

/// A direction at which two contacts support at once, and the segment between them.
struct Ruling {
  dvec3 n = dvec3(0.0);                                   ///< unit, outward
  std::array<Contact, 2> contact;                         ///< the two that support
  std::array<dvec3, 2> point = {dvec3(0.0), dvec3(0.0)};  ///< in the scene's frame
};

/// Part of a separating curve along which each of its two contacts stays in one element: a Bezier
/// patch, a piece of an edge or a vertex. Both bounding elements are closed, so contacts may lie on
/// their borders at the ends.
struct ArcPiece {
  /// In order, two or more; one where the next piece goes on from it. Where seen from outside of
  /// the sphere of directions, those supported by contact 0 lie to the right, those supported by
  /// contact 1 to the left.
  std::vector<Ruling> rulings;
  /// How far the rulings are below the supporting planes, in the scene's frame, as far as the
  /// places tell that were looked at (find_tolerant_places); 0: no more than rounding makes them,
  /// and contacts are no farther than the resolution from where the planes touch.
  double tolerant = 0;
};

/// A separating curve between two of its ends: a closed one has none (the last ruling of its last
/// piece has the n of the first of its first). Consecutive pieces share n and points where they
/// meet, to within their bounds, not the element in which one of the contacts is expressed.
struct SeparatingArc {
  std::vector<ArcPiece> pieces;  ///< in order
  bool closed = false;           ///< it has no ends
  /// The facet (number of its face in HullBoundary) in which the curve begins and ends; -1: the two
  /// contacts merge there in a free end, at which the last ruling has length zero.
  std::array<int, 2> facet = {-1, -1};
};

/// A stretch of consecutive pieces of an arc; of a closed arc it may run over its end. @c count
/// pieces, the first is @c first, modulo their number.
struct ArcRange {
  int arc = -1;   ///< of the boundary's arcs; -1: none
  int first = 0;  ///< of its pieces
  int count = 0;  ///< of pieces
};

/// A stretch of a piece of an edge, from one of its parameters to another (from > to: backwards).
struct EdgeStretch {
  int instance = -1;  ///< of the model
  int piece = -1;     ///< -1: none
  double from = 0;    ///< parameter in [0, 1] where it begins
  double to = 0;      ///< parameter in [0, 1] where it ends

  /// The edge's point with that parameter. @pre there is a piece
  Contact at(double t) const { return {instance, SourceKind::edge, piece, t, 0}; }
};

enum class HullCurveKind {
  bitangent,  ///< between a patch and a scroll or a facet, tangent to both
  edge,       ///< on an edge of the model: a crease of the hull, or the border of a patch
  join,       ///< between two patches, where two source faces meet smoothly
  ruling,     ///< a segment: the end of a scroll, or between two facets
};

/// A curve of the hull's boundary: a maximal one along which its kind and its two faces stay the
/// same.
struct HullCurve {
  HullCurveKind kind = HullCurveKind::ruling;  ///< what it is
  /// Numbers of faces: to the left and to the right of the curve, seen from outside. May be equal.
  /// -1: none; of a planar hull, always to the right.
  std::array<int, 2> faces = {-1, -1};
  /// Points along it from its beginning to its end, in the scene's frame; the first one again at
  /// the end of a closed curve. Dense enough that the curve is smooth between them.
  std::vector<dvec3> points;
  bool closed = false;  ///< without ends
  /// edge: the model's edge (Model::source). Else -1.
  int source = -1;
};

/// A directed stretch of the outline of a region in a Bezier patch's parameters: the trace of a
/// contact along a piece of an arc, or a stretch of the patch's border.
struct TrimStretch {
  /// The piece and which of its contacts lies in the patch, `reversed` if passed backwards; arc -1:
  /// a stretch of the border.
  int arc = -1;
  int piece = -1;         ///< of the arc
  int contact = 0;        ///< 0 or 1
  bool reversed = false;  ///< passed against the arc
  /// The border's free parameter, from .. to (from > to: backwards).
  Side side = Side::u0;
  double from = 0;  ///< in [0, 1]
  double to = 0;    ///< in [0, 1]
  /// The hull's curve that it is part of; -1 on seams within a source face and collapsed sides.
  int curve = -1;
};

/// A connected part of a Bezier patch that lies on the hull, [0, 1]^2 in its parameters at most.
struct PatchRegion {
  int instance = -1;  ///< of the model
  int patch = -1;     ///< of the instance's part
  /// The outward normal is along sign * (Su x Sv).
  int sign = 1;
  /// Closed loops of stretches, each beginning where the one before it ends, with the region to the
  /// left in the (u, v) plane.
  std::vector<std::vector<TrimStretch>> loops;
};

/// One of the stretches about the regions of a face of the hull.
struct StretchPlace {
  std::size_t region = 0;   ///< of the face's regions
  std::size_t loop = 0;     ///< of the region's loops
  std::size_t stretch = 0;  ///< of the loop's stretches
};

/// A face of the hull's boundary.
struct HullFace {
  FaceKind kind = FaceKind::facet;  ///< what it is
  /// Source that it lies on, -1 if none.
  int source = -1;
  /// patch: its parts on Bezier patches.
  std::vector<PatchRegion> regions;
  /// patch: its outlines, as curves (number, +1 along it or -1 against), the patch to the left seen
  /// from outside.
  std::vector<std::vector<std::pair<int, int>>> loops;
  /// patch: per outline the stretches that make up its curves, in order, from the beginning of the
  /// first curve on. Against their own direction if the region's sign is negative.
  std::vector<std::vector<StretchPlace>> outlines;
  /// scroll: its rulings.
  ArcRange scroll;
  /// scroll: the curves along contacts 0 and 1, in order; none along a vertex.
  std::array<std::vector<int>, 2> scroll_curves;
  /// facet: the supporting plane x . n = offset, in the scene's frame, and the contacts in which
  /// its sides meet, counter-clockwise from outside, with their points.
  dvec3 n = dvec3(0.0);
  double offset = 0;  ///< see n
  /// As ArcPiece::tolerant, of its places with the normals there.
  double tolerant = 0;
  std::vector<Contact> contacts;  ///< see n
  std::vector<dvec3> points;      ///< per contact, in the scene's frame
  /// facet: per contact the side from it to the next one (the same one again where there is but
  /// one): the stretch of an edge that it runs along, none where it is straight. Empty where all
  /// are straight.
  std::vector<EdgeStretch> sides;
};

/// A spot that could not be resolved, with the reason.
struct Unresolved {
  dvec3 n = dvec3(0.0);     ///< unit; zero where the reason is of all
  const char* reason = "";  ///< for a person
};

/// The exact boundary of a convex hull: trimmed patches of the model, developable scrolls and flat
/// facets, joined by curves. Complete if nothing is unresolved; otherwise faces may be missing, and
/// curves have -1 for those.
struct HullBoundary {
  /// The scene's frame, that of scene_frame() also where there is no scene.
  SceneFrame frame;
  /// Of the hull: 3, or 2 where its one face is a side of a planar one.
  int dimension = 3;
  std::vector<SeparatingArc> arcs;     ///< that scrolls and patches refer to
  std::vector<HullFace> faces;         ///< by number
  std::vector<HullCurve> curves;       ///< by number
  std::vector<Unresolved> unresolved;  ///< none of a complete boundary
  /// How far the support function of the true hull may exceed that of the faces' points, at most,
  /// in the scene's frame: the resolution, or of a mesh its distance. 0: by no more than rounding.
  double gap = 0;

  /// Faces of a kind.
  int count(FaceKind kind) const {
    int n = 0;
    for (const HullFace& face : faces) n += face.kind == kind ? 1 : 0;
    return n;
  }
};

/// How far faces are below the supporting planes, at most (HullFace::tolerant).
inline double deepest_tolerant(const HullBoundary& boundary) {
  double depth = 0;
  for (const HullFace& face : boundary.faces) depth = std::max(depth, face.tolerant);
  return depth;
}

}  // namespace taut
