#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/core/progress.h"

namespace taut {

/// What is decided of the supporting planes with normals in a cell.
enum class MapCellKind {
  region,     ///< one contact for each of them
  arc,        ///< one of two, which exchange along a curve that is the graph of a function, or not
  node,       ///< one of three, which all touch one plane at most
  facet,      ///< all lie within the resolution of one plane, whose normal is in the cell
  flat,       ///< all lie within the resolution of all the planes
  undecided,  ///< none of these is proven
  in_line,    ///< one of several, of which each exchanges with the next only, along curves that
              ///< are graphs over one axis, or not
};
inline constexpr std::size_t map_cell_kinds = 7;

/// A cell of a quadtree over a face of the cube of directions: [i, i + 1] x [j, j + 1] in units of
/// 2^(1 - level) from -1.
struct MapCell {
  int face = 0;
  int level = 0;
  std::uint32_t i = 0, j = 0;
  MapCellKind kind = MapCellKind::undecided;
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
    int of = 0;
    dvec3 by = dvec3(0.0);
  };
  std::vector<Translate> translates;
  /// Where all contacts are of round shapes (RoundShape), and several, these: what touches a plane
  /// across d is as high as center . d + |root d|.
  struct Round {
    dvec3 center;
    dmat3 root;
  };
  std::vector<Round> rounds;
  /// kinds node and facet: normal of the plane that touches all of them, outwards.
  dvec3 normal = dvec3(0.0);
  /// Of these: how far what touches the plane reaches from a line in it, at least.
  double width = 0;

  /// Of kinds node and facet: their planes may be one, at this resolution.
  bool shares_plane(const MapCell& other, double resolution) const;
  /// Number of the contact that supports in a direction in which x does. @pre there are contacts
  std::size_t contact_of(const dvec3& d, const dvec3& x) const;
};

struct DirectionMapStatistics {
  long cells = 0;       ///< decided or split
  long candidates = 0;  ///< pieces of the model that were looked at
  long queries = 0;     ///< support queries
  std::array<long, map_cell_kinds> of_kind = {};
  int deepest = 0;  ///< level of a cell
};

/// The upper envelope of support functions over the sphere of directions, cell by cell: which parts
/// of a model touch the supporting planes with normals there.
struct DirectionMap {
  /// The cells that are not split, which cover the sphere; by face, and along a Z-shaped curve.
  std::vector<MapCell> cells;
  DirectionMapStatistics statistics;
  double resolution = 0;  ///< at which it is decided, in the scene's frame

  /// Two contacts no farther from each other than this may be one, though a cell tells them apart:
  /// on a surface that curves as much as the scene, of size one, is large, heights of one contact
  /// differ over so much by no more than the resolution.
  double contact_extent() const { return std::sqrt(resolution); }

  /// Directions of the corners of a cell in the order (0, 0), (0, 1), (1, 0), (1, 1) of its axes,
  /// on a cube that is turned so that what models are symmetric in is nothing to it.
  static std::array<dvec3, 4> corners(const MapCell& cell);
  /// A point of a face of the cube, with coordinates in [-1, 1].
  static dvec3 direction(int face, double s, double t);
  /// Where a direction meets the cube.
  struct Place {
    int face = 0;
    double s = 0, t = 0;
  };
  static Place place(const dvec3& d);
};

struct DirectionMapOptions {
  /// In the scene's frame: what is nearer than this may be taken for one. > 0
  double resolution = 0;
  /// Levels of cells, cells, and pieces of the model looked at in them, after which what is left
  /// stays undecided.
  int level_limit = 30;
  long cell_limit = 1'000'000;
  long candidate_limit = 1'000'000'000;
  std::stop_token stop;
};

/// Splits cells, level by level, until each is decided or a limit is reached.
///
/// A cell keeps the pieces of the model that may touch a plane with a normal in it: of patches
/// those where the heights x . d grow in no one direction for all d of the cell, of edges those
/// from which no surface rises, and none that are below the convex hull of sampled points
/// (BeaconEnvelope). Pieces that hang together are a branch; a branch has one contact for each
/// direction by the index of the gradient of the heights, or where they are concave but for the
/// resolution (ContactIndex, NearConcavity). Branches for which others stand to within the
/// resolution are left out (BranchDomination). All bounds are of Bernstein coefficients, for all
/// directions of the cell at once, rounding included.
///
/// Ruled patches and straight edges have no contacts but at their ends.
/// @throws Cancelled
DirectionMap direction_map(const ContactGeometry& geometry, const DirectionMapOptions& options);

}  // namespace taut
