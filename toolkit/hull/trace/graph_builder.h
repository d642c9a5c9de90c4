#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/facet_contacts.h"
#include "taut/hull/cull/culling.h"
#include "taut/hull/trace/cell_crossings.h"
#include "taut/hull/trace/free_ends.h"
#include "taut/hull/trace/separating_graph.h"
#include "taut/hull/trace/surface_seeds.h"

namespace taut {

/// A separating graph while it is traced: arcs and nodes are added and connected, and starts of
/// further curves are compared with what is known by then.
class GraphBuilder {
 public:
  /// Stands for a node where an arc ends in none.
  static constexpr int free_end = -1;

  /// It must outlive this.
  explicit GraphBuilder(const ContactSystem& system)
      : system_(system), geometry_(system.geometry()), crossings_(geometry_) {}

  const SeparatingGraph& graph() const { return graph_; }
  const FacetNode& node(int k) const { return graph_.nodes[std::size_t(k)]; }
  /// What was built, without nodes that are rulings (is_ruling()). This is of no use then.
  SeparatingGraph take();

  /// Adds an arc; its number.
  int add(SeparatingArc arc);
  /// Adds a facet; its node's number.
  int add_node(const dvec3& n, FacetContacts facet);
  /// The node at which two surfaces or curves touch, a new one if there is none yet.
  int crossing_at(const dvec3& n, const Contact& contact);
  /// All of the stretch is in contact with a facet's plane.
  void add_contact(const EdgeStretch& stretch) { crossings_.add(stretch); }
  /// Plugs an arc's end into the side of the node that it crosses.
  void connect(int arc, int end, int node);
  /// One spot is told once.
  void fail(const dvec3& n, const char* reason);

  /// The facet of a plane with these contacts, if there is one.
  std::optional<int> node_of(const dvec3& n, const std::vector<Contact>& contacts) const;
  /// Whether an arc is there already across the side of the node, or into the free end, at which
  /// these pieces arrive.
  bool is_taken(int node, const std::vector<ArcPiece>& pieces) const;
  /// Whether an arc goes through the seed.
  bool is_traced(const CommonSupport& seed) const;
  /// Whether the arcs' contacts cross the side an odd number of times.
  bool is_crossed(const SupportChange& change) const;
  /// Whether the seed's contacts, in a direction near that of a facet with curved sides, are in its
  /// plane.
  bool lies_in_facet(const CommonSupport& seed) const;
  /// The same of any facet, as far as heights tell.
  bool ties_with_facet(const CommonSupport& seed) const;
  /// Whether the seed's contacts are in line with the ruling of a traced curve, and in its plane:
  /// as where what touches the plane is a segment, of which the ruling is part.
  bool lies_in_ruling(const CommonSupport& seed) const;
  /// The same of the corners of a node that no arc has reached.
  bool is_ruling(int node) const;
  /// Whether the seed is, to within what poles leave open, two contacts of a facet: the curve
  /// through it leaves the facet.
  bool is_at_facet(const CommonSupport& seed) const;
  /// Whether the seed is two contacts of a facet, or hardly off them.
  bool is_facet(const CommonSupport& seed) const;
  /// Whether an arc ends in the free end.
  bool is_reached(const FreeEnd& end) const;
  /// The mixed cells for which no known contact accounts, with so many of their sizes around them.
  std::vector<CulledCell> uncrossed(const std::vector<CulledCell>& cells, double margin) const;

 private:
  bool lies_in_ruling(const dvec3& n, const std::vector<dvec3>& points, double turn_slack) const;
  std::optional<Ruling> ruling_towards(const Ruling& from, const Ruling& to, const dvec3& n) const;
  struct PieceContact {
    int arc, piece, contact;
  };
  int side_of(int node, const dvec3& first, const dvec3& second) const;
  bool is_told(const Ruling& r, std::size_t i, const Contact& c, const dvec3& x,
               const dvec3& n) const;
  bool is_end_known(const std::vector<ArcPiece>& pieces) const;
  void settle_in(const FacetNode& node, std::size_t side, int end, Ruling& r) const;
  void settle_in_end(int arc, Ruling& r) const;
  static bool meets_corner(const FacetNode& node, const Ruling& r);
  static int add_corner(FacetNode& node, const Ruling& r, int end);
  void connect_crossing(int arc, int end, int node);
  static bool is_within(const FacetNode& node, const dvec3& x);
  bool lies_in(const FacetNode& node, const dvec3& n, const std::vector<Contact>& contacts) const;
  bool ties_with(const FacetNode& node, const dvec3& n, const std::vector<Contact>& contacts) const;
  bool has_contacts(const FacetNode& node, const std::vector<Contact>& contacts,
                    double slack = 0) const;
  static bool is_beside(const FacetNode& node, const CommonSupport& seed, double off);

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SeparatingGraph graph_;
  CellCrossings crossings_;                                          // of all arcs and nodes
  std::map<std::pair<int, int>, std::vector<PieceContact>> traces_;  // by instance and patch
  std::vector<Box> boxes_;                                           // of the arcs' directions
};

}  // namespace taut
