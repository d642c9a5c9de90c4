#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/hull/result/face_kind.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/surface/model.h"

namespace taut {

/// The exact boundary of a convex hull with the pieces of geometry that it lies on: what a hull
/// document (`.hull.json`, `.hull.cbor`) holds, in model coordinates. Every face can be rebuilt
/// from it to machine precision without the model.
///
/// Sources, faces and curves refer to each other by their places in these lists.
struct HullDocument {
  /// A rational Bezier patch, curve (one row) or point (one row of one) of a source, placed by its
  /// instance.
  struct Patch {
    /// Of the source's own parameters: two of a face, one of an edge, none of a vertex.
    std::vector<Interval> domain;
    int rows = 0;     ///< points along u
    int columns = 0;  ///< points along v, or along an edge
    /// Euclidean points with their weights, along v within along u.
    std::vector<dvec4> points;
  };
  /// A face, edge or vertex of the model that the hull touches.
  struct Source {
    int id = -1;                         ///< Model::source
    SourceKind kind = SourceKind::face;  ///< what it is
    std::string file;                    ///< empty if not known
    std::string name;                    ///< as the model has it, or empty
    /// In the order of the model's patches; none of a polygon.
    std::vector<Patch> patches;
  };
  /// A place on a source.
  struct Contact {
    int source = -1;  ///< its place in the sources
    /// The source's own parameters, as many as its domain has.
    std::vector<double> uv;
    dvec3 p = dvec3(0.0);  ///< in model coordinates
  };
  /// A segment that touches the model with both ends.
  struct Ruling {
    dvec3 n = dvec3(0.0);  ///< unit, outward
    Contact a;             ///< where the scroll's first side is
    Contact b;             ///< where its second side is
  };
  /// A curve within one of a source's Bezier patches, along which the source's parameters run
  /// straight from one place to another; source -1: a segment.
  struct Side {
    int source = -1;           ///< its place in the sources
    std::vector<double> from;  ///< parameters where it begins
    std::vector<double> to;    ///< parameters where it ends
  };
  /// A curve's number, and +1 if passed along it, -1 if against it.
  using DirectedCurve = std::pair<int, int>;
  /// An outline of a patch, seen from outside with the patch to the left.
  struct Loop {
    std::vector<DirectedCurve> curves;  ///< in order, each going on from the one before
    /// Points along it in the source's parameters, the first one not again. Where it passes a seam
    /// of the source, they go on with the parameters of the other side.
    std::vector<dvec2> uv;
  };
  /// The part of a patch of the hull that lies on one Bezier patch of its source.
  struct Region {
    int patch = -1;  ///< of the source's patches
    int sign = 1;    ///< the outward normal is along sign * (Su x Sv)
    /// Closed outlines in the source's parameters, the first point not again, with the region to
    /// the left in the (u, v) plane.
    std::vector<std::vector<dvec2>> loops;
  };
  /// A patch, scroll or facet; what is of one kind alone says so.
  struct Face {
    FaceKind kind = FaceKind::facet;  ///< what it is
    int source = -1;                  ///< that it lies on, -1 if none
    /// How far its places are below the supporting planes with the normals there, at most, in model
    /// units; 0: no more than rounding makes them, and contacts are no farther than the resolution
    /// from where the planes touch.
    double tolerant = 0;
    /// patch: its outlines; none of a patch that is the whole hull.
    std::vector<Loop> loops;
    std::vector<Region> regions;  ///< patch: what it is made of
    /// scroll: the curves along the contacts a and b, in order; none along a vertex.
    std::array<std::vector<int>, 2> curves;
    /// scroll: in order, dense enough to step from one to the next; of a closed one the last has
    /// the n of the first. Where a contact passes into another Bezier patch or source, the ruling
    /// stands twice, once in the terms of either, so that between neighbours in the list both
    /// contacts stay in one Bezier patch or curve, but for the pairs that share n.
    std::vector<Ruling> rulings;
    /// facet: the plane x . normal = offset.
    dvec3 normal = dvec3(0.0);
    double offset = 0;  ///< facet: see normal
    /// facet: counter-clockwise from outside.
    std::vector<Contact> contacts;
    /// facet: per contact the side from it to the next one (the same one again where there is but
    /// one): along an edge, or where it is a seam, along a border of a patch. Empty where all are
    /// segments.
    std::vector<Side> sides;
    /// facet: its outline as curves, the facet to the left seen from outside; none where curves are
    /// missing.
    std::vector<DirectedCurve> outline;
    /// facet: points along the outline, the first one not again.
    std::vector<dvec3> boundary;
  };
  /// What separates two faces.
  struct Curve {
    HullCurveKind kind = HullCurveKind::ruling;  ///< what it is
    /// To the left and to the right, seen from outside; -1 where a face is missing, and to the
    /// right of all curves of a planar hull, whose one face is a facet, one side of it.
    std::array<int, 2> faces = {-1, -1};
    int source = -1;  ///< edge: the model's edge; else -1
    /// From its beginning to its end; of a closed curve the last is the first.
    std::vector<dvec3> points;
  };

  double diagonal = 0;          ///< of the model's box
  int dimension = 3;            ///< of the hull, 0 to 3
  std::vector<Source> sources;  ///< those that occur, ascending ids
  std::vector<Face> faces;      ///< by their ids
  std::vector<Curve> curves;    ///< by their ids
  /// A JSON object as text, or empty.
  std::string report;
};

}  // namespace taut
