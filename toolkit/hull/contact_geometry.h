#pragma once

#include <array>
#include <vector>

#include "taut/bounds/scene.h"

namespace taut {

/// A contact's point and its derivatives with respect to the contact's parameters, in the scene's
/// frame (Scene::frame).
struct ContactJet {
  int dimension = 0;  ///< parameters: 2 on a face (u, v), 1 on an edge (u), 0 at a vertex
  dvec3 x = dvec3(0.0);
  std::array<dvec3, 2> dx = {dvec3(0.0), dvec3(0.0)};
  dvec3 dxx = dvec3(0.0), dxy = dvec3(0.0), dyy = dvec3(0.0);
};

/// A model's elements in the scene's frame, and how they meet: what all contacts look like.
///
/// Contacts here are of three kinds: on a patch (kind face), on a piece of any edge, border or
/// free (kind edge, parameter u), at any vertex (kind vertex).
class ContactGeometry {
 public:
  /// The scene must outlive it.
  explicit ContactGeometry(const Scene& scene);

  const Scene& scene() const { return scene_; }
  const Part& part(const Contact& c) const;

  /// @pre the contact exists; parameters may leave [0, 1] by a little
  ContactJet jet(const Contact& c) const;
  /// Third derivatives too, of a contact on a patch.
  PatchJet3 patch_jet(const Contact& c) const;
  /// Of a contact on a piece.
  CurveJet curve_jet(const Contact& c) const;
  dvec3 point(const Contact& c) const { return jet(c).x; }

  /// The contact in the lowest kind that it lies on exactly: at a corner that is a vertex, or on a
  /// side collapsed onto one, the vertex; on a border that is an edge, the edge's piece; at the end
  /// of a piece, its vertex.
  Contact canonical(const Contact& c) const;

  /// A side of a patch that lies on an edge's piece.
  struct PieceSide {
    int patch = -1;
    Side side = Side::u0;
    bool reversed = false;  ///< the piece runs against the border
  };
  /// An edge's piece that ends in a vertex.
  struct PieceEnd {
    int piece = -1;
    int end = 0;  ///< 0: begins there, 1: ends there
  };
  /// @pre kind edge
  const std::vector<PieceSide>& sides(const Contact& c) const;
  /// @pre kind vertex
  const std::vector<PieceEnd>& ends(const Contact& c) const;

  /// The piece is a straight segment between vertices: its ends are contacts, nothing inside of it.
  /// @pre kind edge
  bool is_straight(const Contact& c) const;

  dvec3 to_local(int instance, const dvec3& n) const;
  dvec3 to_frame(int instance, const dvec3& direction) const;

 private:
  struct PartElements {
    std::vector<BezierPatch> patches;
    std::vector<BezierCurve> pieces;
    std::vector<dvec3> vertices;
    std::vector<bool> straight;                 // per piece
    std::vector<std::vector<PieceSide>> sides;  // per piece
    std::vector<std::vector<PieceEnd>> ends;    // per vertex
  };
  const PartElements& elements(const Contact& c) const;

  const Scene& scene_;
  std::vector<PartElements> parts_;
};

}  // namespace taut
