#pragma once

#include <optional>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/cull/culling.h"

namespace taut {

/// A direction in which the two contacts of a separating curve merge, where the curve ends. It is
/// intrinsic to the model: its place and n are roots of the derivatives there, and only whether
/// anything else lies above its plane depends on the rest (Arnold's A3 and B3; mathematics: generic
/// list).
struct FreeEnd {
  enum class Kind {
    face,  ///< A3 in a surface: a cusp of Gauss; also on a smooth join where the third derivatives
           ///< or the curvatures jump
    edge,  ///< A3 on an edge: the torsion vanishes, or changes sign where pieces join
    border,  ///< B3 on an edge: the parabolic curve of a face meets it
    end,     ///< B3 at a vertex: an edge's contact runs into its end along its osculating plane
    corner,  ///< two edges' contacts run into the vertex between them, n normal to both: where no
             ///< face is between them, or one that is a saddle there
  };
  dvec3 n = dvec3(0.0);  ///< unit, outward, in the scene's frame
  Contact contact;       ///< the merged one: on a patch, an edge's piece or at a vertex
  Kind kind = Kind::face;
  /// Unit tangent along which the contacts part: in both senses from an A3, from a border into the
  /// face, from a vertex along the edge, at a corner from one edge to the other.
  dvec3 along = dvec3(0.0);
};

/// All free ends of the scene's hull: those in the mixed cells, on the borders of their patches, on
/// all edges' pieces and at their ends. Each supports the model to within tie(), by a support
/// query, and is a simple root: where a whole curve of contacts shares one direction (the circle on
/// which a torus lies) there is none, nor where an edge is straight. Collapsed sides are left out,
/// and edges that are planar.
///
/// Cells whose Bernstein nets prove that the second form is singular nowhere are excluded. In each
/// of the others, a 64th of the patch wide, Newton's method starts from the middle, and from the
/// chord of the parabolic curve where the cubic changes sign along it. So none is missed but where
/// the method fails from both, or where two ends lie that near. Borders and edges are sampled at a
/// distance of a 64th too, for changes of sign and for dips that may hide two.
/// @pre the cells are of the scene
std::vector<FreeEnd> free_ends(const ContactGeometry& geometry, SupportQuery& query,
                               const std::vector<CulledCell>& cells);

/// The free end near the given one (to within free_end_reach), to full precision: by Newton's
/// method, over smooth joins where it leads there. None if it does not converge nearby. Whether it
/// supports the model is not asked.
std::optional<FreeEnd> polished(const ContactGeometry& geometry, const FreeEnd& near);

/// How far polished() may move a contact and turn n, in the scene's frame.
inline constexpr double free_end_reach = 0.02;

}  // namespace taut
