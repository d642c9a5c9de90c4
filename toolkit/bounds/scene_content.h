#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "taut/bounds/contact.h"
#include "taut/bounds/coons_bvh.h"
#include "taut/bounds/scalar_net.h"
#include "taut/bounds/scene_frame.h"

namespace taut {

/// What lies between two parallel planes: lower <= x . normal <= upper.
struct Slab {
  dvec3 normal = dvec3(0.0);  ///< unit; zero: there are no planes
  double lower = 0;
  double upper = 0;
  /// Upper bound of x . n over what of a box lies between the planes, up to rounding. A box's
  /// bound, about a piece of surface, errs by the box's size where the piece is oblique to the
  /// axes; this one, if the planes are along the piece, by that size times the planes' angle with
  /// n's, and the planes' distance.
  double upper_bound(const dvec3& center, const dvec3& half, const dvec3& n) const {
    const double share = glm::dot(normal, n);
    const dvec3 rest = n - share * normal;
    return share * (share > 0 ? upper : lower) + glm::dot(center, rest) +
           glm::dot(half, glm::abs(rest));
  }
};

/// A binary hierarchy of axis-parallel boxes over numbered boxes or points, with some of them a
/// leaf, which lie side by side so that one loop bounds them all. Boxes may be cut by slabs.
struct BoxTree {
  static constexpr int leaf_size = 16;

  struct Node {
    dvec3 center;
    dvec3 half;
    std::int32_t first;  ///< inner: the first of two consecutive children; leaf: of its items
    std::int32_t count;  ///< of a leaf's items, 0 for an inner node
    /// Upper bound of x . n over the box, up to rounding.
    double upper_bound(const dvec3& n, const dvec3& abs_n) const {
      return glm::dot(center, n) + glm::dot(half, abs_n);
    }
    Slab slab = {};
    /// Upper bound of x . n over what of the box lies in the slab.
    double slab_bound(const dvec3& n) const { return slab.upper_bound(center, half, n); }
  };
  std::vector<Node> nodes;  ///< the root first; empty without items

  /// In the order of the leaves.
  std::vector<int> items;
  /// Of the items' boxes, by coordinate; points have no half-widths.
  std::array<std::vector<double>, 3> center, half;
  std::vector<Slab> slabs;  ///< of the items; none where none were given

  BoxTree() = default;
  explicit BoxTree(std::span<const Box> boxes);
  /// Each item lies in its box and its slab. @pre as many of either
  BoxTree(std::span<const Box> boxes, std::span<const Slab> slabs);
  explicit BoxTree(std::span<const dvec3> points);

  /// Upper bounds of x . n over the boxes of a leaf's items, up to rounding.
  void upper_bounds(const Node& leaf, const dvec3& n, const dvec3& abs_n,
                    double (&bounds)[leaf_size]) const {
    const auto first = static_cast<std::size_t>(leaf.first);
    for (int k = 0; k < leaf.count; ++k) {
      const std::size_t i = first + static_cast<std::size_t>(k);
      bounds[k] = center[0][i] * n.x + center[1][i] * n.y + center[2][i] * n.z +
                  (half[0][i] * abs_n.x + half[1][i] * abs_n.y + half[2][i] * abs_n.z);
    }
  }
  /// Over what of the box of an item, the i-th in the order of the leaves, lies in its slab.
  /// @pre slabs were given
  double slab_bound(std::size_t i, const dvec3& n) const {
    return slabs[i].upper_bound({center[0][i], center[1][i], center[2][i]},
                                {half[0][i], half[1][i], half[2][i]}, n);
  }
};

/// Homogeneous control points in the scene's units about the part's centre, coordinate by
/// coordinate; weights of polynomial nets are one.
struct SceneNet {
  std::vector<double> x, y, z, w;

  std::size_t value_count(bool rational) const { return x.size() * (rational ? 2 : 1); }
  /// The control points' values in a direction and, of a rational net, behind them their weights.
  void values(const dvec3& n, bool rational, double* b) const {
    const std::size_t size = x.size();
    for (std::size_t k = 0; k < size; ++k) b[k] = x[k] * n.x + y[k] * n.y + z[k] * n.z;
    if (rational) std::copy(w.begin(), w.end(), b + size);
  }
};

/// What queries run over, points apart: a patch of a face or a piece of a free curve (degrees
/// (p, 0)).
struct SceneElement {
  SourceKind kind;
  int index;  ///< into the part's patches or pieces
  NetShape shape;
  bool rational;
  double reach;  ///< largest |x| + |y| + |z| of the control points
  SceneNet net;
  CoonsBvh bvh;
  /// By how much a patch's lines along u, along v, or others that end on its border miss being
  /// straight (Patch::lines), in the scene's frame: not at all where it is ruled. Both of a plane.
  double off_u = infinity;
  double off_v = infinity;
  double off_oblique = infinity;
  bool ruled() const { return std::min({off_u, off_v, off_oblique}) == 0; }
  bool stand_in = false;  ///< see Patch
};

/// A cell of an element's CBVH at which searches start: flat enough that its net bounds it well.
struct SceneCell {
  int element;
  CoonsCell coons;
  SceneNet net;
};

/// A side of a patch that lies on a piece of a seam; the piece runs against it if `reversed`.
struct SeamSide {
  int patch = -1;
  Side side = Side::u0;
  bool reversed = false;
};

/// A part in the scene's units, about a centre of its own; nothing but the centre where the part
/// repeats another: no instance refers to it then.
struct ScenePart {
  dvec3 center;
  bool repeats = false;  ///< an earlier part is equal
  std::vector<SceneElement> elements;
  std::vector<SceneCell> cells;
  std::vector<int> element_of_patch, element_of_piece;  ///< -1: not queried
  BoxTree tree;                                         ///< over the cells
  BoxTree point_tree;                  ///< over the part's points, in the part's units
  int first_seam = 0;                  ///< index of the first piece of a seam
  std::vector<SeamSide> seams;         ///< what stands for those pieces, in their order
  std::vector<Contact> seam_vertices;  ///< and for their vertices, but for the instance
};

struct SceneInstance {
  int part;   ///< the first that is equal to the model's
  int first;  ///< the first instance that is exactly the same
  bool rotated;
  dmat3 rotation;
  dvec3 translation;  ///< of the part's centre, in the scene's frame
};

struct SceneContent {
  Model model;
  SceneFrame frame;
  std::vector<ScenePart> parts;
  std::vector<SceneInstance> instances;
  std::vector<int> distinct_instances;
  BoxTree tree;  ///< over the distinct instances
  Box box;
  double diagonal = 0;
  double rounding = 0;  ///< of a support value x . n, in the scene's frame

  const ScenePart& part_of(int instance) const {
    return parts[std::size_t(instances[std::size_t(instance)].part)];
  }
  /// Index among the part's elements; -1 for points and for borders, which lie in patches.
  int element(const Contact& contact) const;
  /// Whether the contact is one that queries look for: no border, no corner of a surface.
  bool can_support(const Contact& contact) const;
  /// The contact's point in the scene's units, about the part's centre.
  dvec3 local_point(const Contact& contact) const;
  /// The contact's point in the scene's frame.
  dvec3 frame_point(const Contact& contact) const;
};

/// The CBVHs' tolerance in the scene's frame: a leaf's Coons patch is closer to the surface than
/// this. Where nets finish the proof, a finer one only costs memory (see the benchmark).
inline constexpr double coons_tolerance = 1e-3;

/// Searches start at the CBVH cells that deviate from their corners by less than this, in the
/// scene's frame: coarser ones cost splits at every query, finer ones memory and boxes to test.
inline constexpr double cell_deviation = 0.1;

/// Levels of the CBVH above those cells, at most.
inline constexpr int cell_level_limit = 4;

}  // namespace taut
