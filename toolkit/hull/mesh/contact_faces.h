#pragma once

#include <array>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/contact/region_outline.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// A face of a hull's boundary that a point touches. `sides`: of a scroll, bit i is set if the
/// point lies on the curve of its contacts i.
struct TouchedFace {
  int face = -1;
  unsigned sides = 0;
};

/// Faces that a point touches, ascending, none twice.
using TouchedFaces = std::vector<TouchedFace>;
void touch(TouchedFaces& faces, const TouchedFace& face);

/// Where on a hull's boundary contacts lie.
class ContactFaces {
 public:
  /// All must outlive it.
  ContactFaces(const ContactGeometry& geometry, const HullBoundary& boundary);

  /// The scroll that the piece of the arc belongs to, -1 if none.
  int scroll(int arc, int piece) const { return scrolls_[std::size_t(arc)][std::size_t(piece)]; }
  /// The face beyond the curve of one of the piece's contacts, -1 if none is known: where the
  /// contact runs inside a patch.
  int patch(int arc, int piece, int contact) const {
    return trims_[std::size_t(arc)][std::size_t(piece)][std::size_t(contact)];
  }

  /// The scroll and that face, for a point on the curve of that contact.
  TouchedFaces beside(int arc, int piece, int contact) const;

  /// The faces that a point of the hull touches as far as its contact tells: inside a patch the
  /// one of its regions that holds the contact or, within what the outlines' chords leave open,
  /// comes nearest; on edges, seams and smooth borders both sides' faces, at vertices all. None if
  /// nothing is known. Of curves inside patches the contact does not tell.
  TouchedFaces touched(const Contact& contact) const;

  /// The contact is surely on no face: farther from all outlines of its patch than their chords
  /// leave open, on a stretch of an edge or at a vertex that no face touches.
  bool surely_uncovered(const Contact& contact) const;

 private:
  struct Region {
    int instance, patch;
    int face;
    RegionOutline outline;
  };
  /// A face along part of an edge's or seam's piece.
  struct Stretch {
    int instance, piece;
    double from, to;
    TouchedFace face;
  };
  struct Corner {
    int instance, vertex;
    TouchedFace face;
  };

  void add_arcs();
  void add_regions();
  void add_facets();
  void add_border(const PatchRegion& region, int face, const TrimStretch& stretch);
  void add_corner(const Contact& contact, const TouchedFace& face);
  void add_stretch(const EdgeStretch& stretch, int face);
  void touch_regions(int instance, int patch, const dvec2& uv, bool inside_only,
                     TouchedFaces& faces) const;
  void touch_stretches(int instance, int piece, double t, TouchedFaces& faces) const;
  TouchedFaces on_patch(const Contact& c) const;
  bool is_near_stretch(const Contact& c) const;
  double deepest(int instance, int patch, const dvec2& uv) const;

  const ContactGeometry& geometry_;
  const HullBoundary& boundary_;
  std::vector<std::vector<int>> scrolls_;               // per arc and piece
  std::vector<std::vector<std::array<int, 2>>> trims_;  // and contact
  std::vector<Region> regions_;                         // sorted, as the others, by their place
  std::vector<Stretch> stretches_;
  std::vector<Corner> corners_;
};

}  // namespace taut
