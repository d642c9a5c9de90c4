#pragma once

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// How n begins at a ruling of a separating curve.
enum class RulingStart {
  plain,     ///< as the contacts do
  straight,  ///< with the square of a contact's way, while the other one moves as n does
  stands,    ///< with the square of both contacts' ways; a vertex does not move
};

/// At the ruling, towards the other one. A contact's way counts squared at the end of an edge that
/// does not bend there, and off a side across which its patch is level.
RulingStart start_at(const ContactGeometry& geometry, const Ruling& r, const Ruling& other);

/// One of the contacts lies on a side of its patch that is a straight edge. Planes that turn about
/// the edge touch the patch there first: along the edge it is flat.
bool begins_on_segment(const ContactGeometry& geometry, const Ruling& r);

}  // namespace taut
