#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "taut/bounds/contact.h"

namespace taut {

/// What is decided of the supporting planes with normals in a cell.
enum class MapCellKind {
  region,     ///< one contact for each of them
  arc,        ///< one of two, which exchange along a curve that is the graph of a function, or not
  node,       ///< one of three, which all touch one plane at most
  facet,      ///< all lie within the resolution of one plane that touches the model, whose normal
              ///< is in the cell or beside it
  flat,       ///< all lie within the resolution of all the planes
  undecided,  ///< none of these is proven
  in_line,    ///< one of several, of which each exchanges with the next only, along curves that
              ///< are graphs over one axis, or not
};
inline constexpr std::size_t map_cell_kinds = 7;

/// A cell of a quadtree over a face of the cube of directions: [i, i + 1] x [j, j + 1] in units of
/// 2^(1 - level) from -1.
struct MapCell {
  int face = 0;                               ///< 0 .. 5
  int level = 0;                              ///< 0: the whole face
  std::uint32_t i = 0;                        ///< 0 .. 2^level - 1
  std::uint32_t j = 0;                        ///< 0 .. 2^level - 1
  MapCellKind kind = MapCellKind::undecided;  ///< what is decided
  /// Boxes of what may touch, in the scene's frame, one for each contact that is told apart, and
  /// behind them those of what is above their convex hull by no more than the resolution, if at
  /// all; none where there was too much to look at.
  std::vector<Box> contacts;
  int apart = 0;  ///< contacts that are told apart
  /// Supports in the direction of the middle of the cell's corners; none if the cell was not looked
  /// at.
  Contact contact = {};
  /// Which of the contacts, the first like it, each is a translate of, and by how much it is moved:
  /// itself, not at all, if it is like none. Of several contacts only.
  struct Translate {
    int of = 0;             ///< a contact, by number
    dvec3 by = dvec3(0.0);  ///< in the scene's frame
  };
  std::vector<Translate> translates;  ///< per contact, or none
  /// Where all contacts are of round shapes (RoundShape), and several, these: what touches a plane
  /// across d is as high as center . d + |root d|.
  struct Round {
    dvec3 center;  ///< in the scene's frame
    dmat3 root;    ///< see Round
  };
  std::vector<Round> rounds;  ///< per contact, or none
  /// kinds node and facet: normal of the plane that touches all of them, outwards.
  dvec3 normal = dvec3(0.0);
  /// Of these: how far what touches the plane reaches from a line in it, at least.
  double width = 0;

  /// It is a node or facet.
  bool has_plane() const { return kind == MapCellKind::node || kind == MapCellKind::facet; }
  /// Of kinds node and facet: their planes may be one, at this resolution.
  bool shares_plane(const MapCell& other, double resolution) const;
  /// Number of the contact that supports in a direction in which x does. @pre there are contacts
  std::size_t contact_of(const dvec3& d, const dvec3& x) const;
  /// The same of those that are told apart alone: where another one supports these do, too, to
  /// within the resolution.
  std::size_t told_contact_of(const dvec3& d, const dvec3& x) const;
};

}  // namespace taut
