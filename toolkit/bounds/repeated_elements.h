#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "taut/bounds/scene.h"

namespace taut {

/// A patch, piece or vertex of an instance by its control points, in one frame for all.
struct PlacedElement {
  SourceKind kind = SourceKind::face;  ///< what it is
  int instance = -1;                   ///< whose it is
  int element = -1;           ///< index of the patch, piece or vertex in the instance's part
  int degree_u = 0;           ///< 0 of a vertex
  int degree_v = 0;           ///< 0 of a piece or a vertex
  std::vector<dvec4> points;  ///< homogeneous control points
};

/// Which elements of a scene coincide: copies of models, faces that touch each other all over, the
/// common edge of two solids.
class RepeatedElements {
 public:
  RepeatedElements() = default;
  /// Two elements of a kind are the same if their control points are, within the tolerance, and
  /// their weights, up to a common factor: for patches also after reversing and exchanging u and v,
  /// for pieces after reversing.
  RepeatedElements(const std::vector<PlacedElement>& elements, double tolerance);

  /// Lets a vertex be a point of an edge, unless it is one already.
  void place(const Contact& vertex, const Contact& on_edge) {
    places_.try_emplace(key(vertex), on_edge);
  }

  /// No element is the same as an earlier one, or placed on an edge.
  bool empty() const { return repeats_.empty() && places_.empty(); }
  /// How far control points are from those that they repeat, at most.
  double farthest() const { return farthest_; }
  /// An earlier element is the same.
  bool repeats(const Contact& c) const {
    return !empty() && (repeats_.contains(key(c)) || places_.contains(key(c)));
  }
  /// The contact's point on the first of the equal elements, or on the edge on which it was placed.
  Contact first(const Contact& c) const;
  /// The element repeats another one with its first parameter reversed.
  bool reversed(const Contact& c) const;
  /// All that repeat another, in their order.
  std::vector<Contact> all() const;

 private:
  /// How (u, v) of the repeated element come from those of the other: exchanged, then reversed.
  struct Repeat {
    int instance, element;
    bool swapped = false;
    bool reversed_u = false;
    bool reversed_v = false;
  };
  using Key = std::tuple<int, int, int>;
  static Key key(const Contact& c) { return {int(c.kind), c.instance, c.element}; }

  std::map<Key, Repeat> repeats_;
  std::map<Key, Contact> places_;
  double farthest_ = 0;
};

}  // namespace taut
