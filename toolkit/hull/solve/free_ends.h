#pragma once

#include <optional>

#include "taut/bounds/contact_geometry.h"

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

/// The free end near the given one (to within free_end_reach), to full precision: by Newton's
/// method, over smooth joins where it leads there. None if it does not converge nearby. Whether it
/// supports the model is not asked.
std::optional<FreeEnd> polished(const ContactGeometry& geometry, const FreeEnd& near);

/// How far polished() may move a contact and turn n, in the scene's frame.
inline constexpr double free_end_reach = 0.02;

}  // namespace taut
