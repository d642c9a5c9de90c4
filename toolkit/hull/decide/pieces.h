#pragma once

#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/hull/decide/map_piece.h"
#include "taut/hull/decide/round_shape.h"
#include "taut/hull/decide/smooth_joins.h"

namespace taut {

/// What elements are to those like them.
struct Likeness {
  /// No contact is the element's alone: it lies in the convex hull of others.
  bool covered = false;
  /// It is one of these others, or something in which one of them ends or that it goes on into: it
  /// stays though it may be lower than what is covered, by as much as budgets allow.
  bool stands_for_others = false;
  /// The round shape that the element is part of, -1 of none.
  int round = -1;
  /// Translates of each other have one number and places, by which they are moved; -1 of those
  /// that have none.
  int group = -1;
  dvec3 place = dvec3(0.0);
  /// The way from the element to another one, which moved there it is nowhere farther from.
  struct Other {
    dvec3 off = dvec3(0.0);
    double apart = 0;
  };
  /// To the nearest of its translates that are not covered.
  std::vector<Other> to_others;
};

/// What may hold contacts of its own: a patch that is not ruled, a piece of an edge that is not
/// straight, a vertex; of elements that coincide the first.
struct MapElement {
  Contact contact;
  bool rational = false;
  const MapPiece* root = nullptr;
  /// Indexed by Side, of a patch: what it goes on into smoothly, and the largest angle between the
  /// tangent planes there, as measured at some places; of an edge, at ends 0 and 1, between the
  /// tangents.
  struct Beyond {
    int element = -1;  ///< also where that holds no contacts of its own
    Side side = Side::u0;
    bool reversed = false;
  };
  std::array<Beyond, 4> beyond = {};
  std::array<double, 4> kink = {};
  /// Of a patch: those with the same number go on into each other.
  int surface = -1;
  /// Of an edge, where it passes a vertex: the element and the end at which it goes on, or -1.
  std::array<std::array<int, 2>, 2> next = {{{-1, -1}, {-1, -1}}};
  std::array<bool, 4> collapsed = {};  ///< sides that are one point
  /// Of an edge or vertex: the elements that MapPiece::inward belongs to, -1 for those without
  /// contacts of their own.
  std::vector<int> beside;
  Likeness likeness;
};

/// The elements of a scene, in its frame, with the roots of their trees of pieces. The geometry
/// must outlive it.
class MapPieces {
 public:
  /// `resolution`: what is nearer may be taken for one, in the scene's frame. `report` is told the
  /// share that is done.
  MapPieces(const ContactGeometry& geometry, double resolution,
            const std::function<void(double share)>& report = {});

  const ContactGeometry& geometry() const { return geometry_; }
  const std::vector<MapElement>& elements() const { return elements_; }
  const MapElement& element(int index) const { return elements_[std::size_t(index)]; }
  const RoundShape& round(int index) const { return rounds_[std::size_t(index)]; }
  /// Index of the element, or -1 where it holds no contacts of its own.
  int find(const Contact& c) const;
  /// Index of the first of the elements that coincide with the contact's, if it is of its kind.
  int find_first(const Contact& c) const;
  /// The surface is smooth at the vertex, or only curves pass it: it holds no contacts of its own.
  bool is_passed(const Contact& vertex) const { return joins_.passes(geometry_.first(vertex)); }
  /// The side of a patch is one point at which the surface is smooth. @pre a patch
  bool is_pole(const MapElement& element, Side side) const;
  /// A piece of an edge runs against the first of those that coincide with it.
  bool runs_against_first(const Contact& c) const;

  /// The share of the resolution by which what is left out in a cell may be above the rest: that
  /// for which others stand everywhere is above them too.
  double budget_left() const;
  /// By how much points may be above all that is not covered, in the scene's frame.
  double covered_above() const { return any_covered_ ? resolution_ : 0; }

  /// Patches that are covered with all their borders and corners.
  std::vector<Contact> covered_patches() const;
  /// Edges' pieces that are covered, though lines of a ruled patch go on from there to others that
  /// are not.
  std::vector<Contact> covered_edges() const;

  /// And by how much those of ruled patches that are bent.
  double bent_above() const { return any_bent_ ? resolution_ : 0; }

  /// Of all there is, also of what has no contacts of its own.
  std::vector<dvec3> control_points() const;

  const MapElement& element_of(const MapPiece& piece) const { return element(piece.element); }
  /// The element's control points over a rectangle.
  void restricted(int element, const Interval& u, const Interval& v,
                  std::vector<dvec4>& points) const;

 private:
  void add(MapElement element, MapPiece::Root root);
  void add_face(const Contact& c);
  void add_edge(const Contact& c);
  void add_vertex(const Contact& c);
  void find_beside();
  void find_beyond(const std::function<void(double)>& report);
  void find_surfaces();
  std::vector<dvec4> placed_patch(const Contact& c, NetShape& shape) const;
  void cover_straight(double resolution);
  void let_stand(const Contact& c);
  void let_ends_stand(const Contact& c);
  void let_neighbors_stand();

  const ContactGeometry& geometry_;
  double resolution_;
  SmoothJoins joins_;
  std::vector<MapElement> elements_;
  bool any_bent_ = false;     // ruled ones, within the resolution only
  bool any_covered_ = false;  // or bent
  std::vector<RoundShape> rounds_;
  std::deque<MapPiece> roots_;
  std::vector<std::array<int, 3>> first_;  // per instance and kind, into index_
  std::vector<int> index_;
};

}  // namespace taut
