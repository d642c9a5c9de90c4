#pragma once

#include <array>
#include <atomic>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "taut/bounds/repeated_elements.h"
#include "taut/bounds/scene.h"
#include "taut/core/stop.h"

namespace taut {

/// A contact's point and its derivatives with respect to the contact's parameters, in the scene's
/// frame (Scene::frame).
struct ContactJet {
  int dimension = 0;     ///< parameters: 2 on a face (u, v), 1 on an edge (u), 0 at a vertex
  dvec3 x = dvec3(0.0);  ///< the point
  std::array<dvec3, 2> dx = {dvec3(0.0), dvec3(0.0)};  ///< first derivatives, as many as parameters
  dvec3 dxx = dvec3(0.0);  ///< second derivatives, of those parameters that there are
  dvec3 dxy = dvec3(0.0);  ///< likewise
  dvec3 dyy = dvec3(0.0);  ///< likewise
};

/// None of the numbers is infinite or no number.
inline bool is_finite(const dvec3& x) {
  return glm::length(x) < std::numeric_limits<double>::infinity();
}

/// Rates of the contact's parameters where the direction n in which it supports turns by dn. None
/// where x . n has no strict maximum there.
std::optional<dvec2> parameter_rate(const ContactJet& j, const dvec3& n, const dvec3& dn);

/// The normal curvature of the contact's element where n supports, the least of those along its
/// tangents, is below `least`. Vertices are not flat.
bool is_flat(const ContactJet& j, const dvec3& n, double least);
/// The least in the scene's frame with which a contact's motion is told.
inline constexpr double least_curvature = 1e-8;

/// A model's elements in the scene's frame, and how they meet: what all contacts look like.
///
/// Contacts here are of three kinds: on a patch (kind face), on a piece of any edge, border, seam
/// or free (kind edge, parameter u), at any vertex (kind vertex). Ruled patches have none but on
/// their borders.
class ContactGeometry {
 public:
  /// The scene must outlive it. `stop`: makes evaluations throw Cancelled from then on, so that all
  /// that works on contacts stops. `same`: elements that miss each other by no more, in the scene's
  /// frame, are one, edges straight that are no farther from a segment than four times as much, and
  /// patches ruled that are no farther from one that is than seven times; rounding apart.
  explicit ContactGeometry(const Scene& scene, Stop stop = {}, double same = 0);

  /// What the contacts are of.
  const Scene& scene() const { return scene_; }
  /// Values of contacts that differ by no more, in the scene's frame, are one: support_tie, or more
  /// where the model is so far from the origin that its coordinates are rounded to more.
  double tie() const { return tie_; }
  /// What the rounding of the model's coordinates may do to points, to planes through them and to
  /// slopes at joins of surfaces, in the scene's frame (coordinate_rounding).
  double rounding() const { return rounding_; }
  /// The part of which the contact's element is. @pre the contact exists
  const Part& part(const Contact& c) const;
  /// What works long on contacts and evaluates none asks now and then. @throws Cancelled
  void check_stop() const { stop_.check(); }
  /// What makes evaluations throw Cancelled.
  const Stop& stop() const { return stop_; }

  /// @pre the contact exists; parameters may leave [0, 1] by a little @throws Cancelled, as the
  /// next two do
  ContactJet jet(const Contact& c) const;
  /// Third derivatives too, of a contact on a patch.
  PatchJet3 patch_jet(const Contact& c) const;
  /// Of a contact on a piece.
  CurveJet curve_jet(const Contact& c) const;
  /// The contact's point. @pre as of jet()
  dvec3 point(const Contact& c) const { return jet(c).x; }

  /// The contact in the lowest kind that it lies on exactly: at a corner that is a vertex, or on a
  /// side collapsed onto one, the vertex; on a border that is an edge, the edge's piece; at the end
  /// of a piece, its vertex.
  Contact canonical(const Contact& c) const;

  /// The contact's point on the first of the elements that coincide with the contact's, within
  /// tie(); of a point beside which no edge ends and that lies on an edge, on the edge.
  Contact first(const Contact& c) const {
    Contact own = c;
    if (c.instance >= 0) own.instance = scene_.first_instance(c.instance);
    return repeated_elements_.first(own);
  }
  /// The contact's element coincides with an earlier one. Contacts are told as ones of the first.
  bool is_repeated(const Contact& c) const {
    return scene_.first_instance(c.instance) != c.instance || repeated_elements_.repeats(c);
  }
  /// How far elements are from the first ones, at most.
  double copies_apart() const { return repeated_elements_.farthest(); }

  /// A side of a patch, not a ruled one, that lies on an edge's piece.
  struct PieceSide {
    int instance = -1;      ///< -1: the contact's
    int patch = -1;         ///< of the instance's part
    Side side = Side::u0;   ///< of the patch
    bool reversed = false;  ///< the piece runs against the border
  };
  /// An edge's piece that ends in a vertex.
  struct PieceEnd {
    int instance = -1;  ///< -1: the contact's
    int piece = -1;     ///< of the instance's part
    int end = 0;        ///< 0: begins there, 1: ends there
  };
  /// Sides along the piece, and along the pieces that repeat it.
  /// @pre kind edge, not repeated
  const std::vector<PieceSide>& sides(const Contact& c) const;
  /// Sides of ruled patches along the piece. @pre kind edge
  const std::vector<PieceSide>& ruled_sides(const Contact& c) const;
  /// @pre kind vertex, not repeated
  const std::vector<PieceEnd>& ends(const Contact& c) const;

  /// The piece is a straight segment between vertices, or part of one with others that it goes on
  /// into: these vertices are contacts, nothing inside.
  /// @pre kind edge
  bool is_straight(const Contact& c) const;
  /// The vertex at that end (0 or 1) of the segment. @pre straight
  Contact straight_end(const Contact& c, int end) const;
  /// Contacts inside of the patch are contacts of straight segments of it, and so of their ends.
  /// @pre kind face
  bool is_ruled(const Contact& c) const { return lines(patch(c)).any(); }
  /// By how much patches may miss being ruled, in the model's units.
  double bent() const { return bent_; }
  /// On an edge with a side of a patch that is told ruled but is not: contacts near it are told as
  /// the edge's.
  bool is_beside_bent(const Contact& c) const;
  /// Along which lines the patch is told ruled.
  RuledLines lines(const Patch& patch) const { return patch.lines(bent_); }

  /// @pre kind face
  const Patch& patch(const Contact& c) const;
  /// @pre kind edge
  const EdgePiece& piece(const Contact& c) const;
  /// The contact's element in the scene's frame.
  PlacedElement placed(const Contact& c) const;
  /// The piece in the scene's frame. @pre kind edge
  BezierCurve curve(const Contact& c) const;

  /// A direction in the scene's frame as one of the instance's part.
  dvec3 to_local(int instance, const dvec3& n) const;
  /// A direction of the instance's part in the scene's frame.
  dvec3 to_frame(int instance, const dvec3& direction) const;

 private:
  struct PartElements {
    std::vector<BezierPatch> patches;
    std::vector<BezierCurve> pieces;
    std::vector<dvec3> vertices;
    std::vector<std::array<int, 2>> straight;         // per piece, its segment's vertices or -1
    std::vector<std::vector<PieceSide>> sides;        // per piece
    std::vector<std::vector<PieceSide>> ruled_sides;  // per piece
    std::vector<std::vector<PieceEnd>> ends;          // per vertex
  };
  const PartElements& elements(const Contact& c) const;
  void start_evaluation() const;
  void find_straight(const Part& part, double same, PartElements& own) const;
  void find_repeated_elements(double same);
  void place_points(const std::vector<PlacedElement>& all);
  void share(const Contact& repeated);

  const Scene& scene_;
  Stop stop_;
  double rounding_ = 0;
  double tie_ = 0;
  double bent_ = 0;
  std::vector<PartElements> parts_;
  RepeatedElements repeated_elements_;
  /// Of elements that others repeat: by instance and element.
  using Place = std::pair<int, int>;
  std::map<Place, std::vector<PieceSide>> shared_sides_;
  std::map<Place, std::vector<PieceSide>> shared_ruled_sides_;
  std::map<Place, std::vector<PieceEnd>> shared_ends_;
};

}  // namespace taut
