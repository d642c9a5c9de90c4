#pragma once

#include <map>
#include <utility>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/cull/culling.h"
#include "taut/hull/result/hull_boundary.h"

namespace taut {

/// Where on the patches known contacts run, as rectangles in their parameters; those on a patch's
/// border are on what it joins smoothly there, too.
class CellCrossings {
 public:
  /// It must outlive this.
  explicit CellCrossings(const ContactGeometry& geometry) : geometry_(geometry) {}

  /// Both contacts of the arc, ruling by ruling.
  void add(const SeparatingArc& arc);
  void add(const Contact& contact) { add(contact, contact); }
  void add(const EdgeStretch& stretch);

  /// A rectangle of a contact meets the cell, borders included, with so many of its sizes around
  /// it.
  bool crosses(const CulledCell& cell, double margin = 0) const;

 private:
  struct Rectangle {
    Interval u, v;
  };
  void add(const Contact& from, const Contact& to);
  void add(int instance, int patch, const Rectangle& rectangle);
  void add_beyond(int instance, int patch, const Rectangle& rectangle);
  bool is_known(int instance, int patch, const Rectangle& rectangle) const;

  const ContactGeometry& geometry_;
  std::map<std::pair<int, int>, std::vector<Rectangle>> rectangles_;  // by instance and patch
};

}  // namespace taut
