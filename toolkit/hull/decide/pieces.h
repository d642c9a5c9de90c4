#pragma once

#include <array>
#include <optional>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/scalar_net.h"

namespace taut {

/// A net of homogeneous control points or derivatives in a store of them; v within u.
struct StoredNet {
  NetShape shape;
  std::size_t first = 0;
};

/// Part of an element: a rectangle of a patch, an interval of a piece of an edge, or a vertex.
struct MapPiece {
  int element = -1;
  Interval u, v;
  /// Its control points; of a rational one in parameters in which weights are most alike.
  StoredNet net;
  StoredNet exact;  ///< in the element's own parameters
  /// Of an edge or vertex: derivatives along the surfaces and edges that end there, away from it.
  std::vector<StoredNet> inward;
  std::array<int, 2> halves_u = {-1, -1};
  std::array<int, 2> halves_v = {-1, -1};
  Box box = {};  ///< of its control points
};

/// Scales a rational net so that the weights at its four corners are as alike as changes of
/// parameters that keep the rectangle can make them.
void even_weights(NetShape shape, std::vector<dvec4>& net);

/// What may hold contacts of its own: a patch that is not ruled, a piece of an edge that is not
/// straight, a vertex; of elements that coincide the first.
struct MapElement {
  Contact contact;
  bool rational = false;
  int root = -1;
  /// Indexed by Side, of a patch: the largest angle between the tangent planes on the two sides of
  /// a smooth join, as measured at some places.
  std::array<double, 4> kink = {};
  std::array<bool, 4> collapsed = {};  ///< sides that are one point
  /// Of an edge or vertex: the elements that MapPiece::inward belongs to, -1 for those without
  /// contacts of their own.
  std::vector<int> beside;
  /// No contact is its alone (covered_translates, nearly_straight).
  bool covered = false;
};

/// The elements of a scene, in its frame, with trees of their pieces that grow as they are asked.
/// One object a thread; the geometry must outlive it.
class MapPieces {
 public:
  /// `resolution`: what is nearer may be taken for one, in the scene's frame.
  MapPieces(const ContactGeometry& geometry, double resolution);

  const ContactGeometry& geometry() const { return geometry_; }
  const std::vector<MapElement>& elements() const { return elements_; }
  const MapElement& element(int index) const { return elements_[std::size_t(index)]; }
  /// Index of the element, or -1 where it holds no contacts of its own.
  int find(const Contact& c) const;
  /// Index of the first of the elements that coincide with the contact's, if it is of its kind.
  int find_first(const Contact& c) const;
  /// A piece of an edge runs against the first of those that coincide with it.
  bool runs_against_first(const Contact& c) const;

  /// The share of the resolution by which what is left out in a cell may be above the rest: that
  /// for which others stand everywhere is above them too.
  double budget_left() const;

  const MapPiece& piece(int index) const { return pieces_[std::size_t(index)]; }
  const MapElement& element_of(const MapPiece& piece) const { return element(piece.element); }
  const dvec4* points(const StoredNet& net) const { return points_.data() + net.first; }
  std::size_t piece_count() const { return pieces_.size(); }
  /// One of the two halves of a piece across a parameter. @pre it has the parameter
  std::array<int, 2> halves(int piece, Direction across);
  /// The element's control points over a rectangle.
  void restricted(int element, const Interval& u, const Interval& v,
                  std::vector<dvec4>& points) const;

 private:
  int add(MapPiece piece, bool rational);
  StoredNet store(NetShape shape, const std::vector<dvec4>& points);
  void add_face(const Contact& c);
  void add_edge(const Contact& c);
  void add_vertex(const Contact& c);
  void find_beside();
  std::vector<dvec4> placed(const Contact& c, const std::vector<dvec4>& points) const;
  std::vector<dvec4> placed_patch(const Contact& c, NetShape& shape) const;
  double kink(const Contact& c, Side side) const;
  double straight_budget(const std::vector<bool>& covered) const;

  const ContactGeometry& geometry_;
  std::vector<MapElement> elements_;
  std::vector<MapPiece> pieces_;
  std::vector<dvec4> points_;
  std::vector<std::array<int, 3>> first_;  // per instance and kind, into index_
  std::vector<int> index_;
};

}  // namespace taut
