#pragma once

#include <array>
#include <span>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/envelope/cull/culling.h"

namespace taut {

/// Triangles over the sphere of directions whose corners are contacts: what envelope images are
/// drawn from. Lengths in the scene's frame.
struct GaussTriangles {
  struct Node {
    dvec3 n;   ///< unit
    dvec3 x;   ///< the contact's point
    dvec2 uv;  ///< and its parameters
  };
  struct Triangle {
    int element = -1;  ///< number of the element (ElementNumbers)
    std::array<int, 3> node = {-1, -1, -1};
    /// The points are those that support the corners' directions, and values between them are
    /// interpolated to third order; else n and x are unrelated, and x . n is a lower bound of h.
    bool smooth = true;
  };
  std::vector<Node> nodes;
  std::vector<Triangle> triangles;

  int add_node(const Node& node) {
    nodes.push_back(node);
    return int(nodes.size()) - 1;
  }
  void add_triangle(int element, int a, int b, int c, bool smooth = true) {
    triangles.push_back({element, {a, b, c}, smooth});
  }
  void append(const GaussTriangles& other);
};

/// Numbers through all patches, pieces and vertices of a scene's instances.
class ElementNumbers {
 public:
  explicit ElementNumbers(const Model& model);

  int count() const { return first_.back(); }
  int number(const Contact& c) const;
  /// The contact of that number, at parameters zero. @pre 0 <= number < count()
  Contact contact(int number) const;

 private:
  const Part& part(std::size_t instance) const {
    return model_->parts()[std::size_t(model_->instances()[instance].part)];
  }

  const Model* model_;
  std::vector<int> first_;  ///< per instance, and the count
};

/// How fine the triangles are.
struct GaussTriangleOptions {
  /// Largest angle between a direction halfway and the mean of its neighbours', in radians.
  double direction_tolerance = 5e-4;
  /// Largest error of an interpolated value halfway, in the scene's frame.
  double value_tolerance = 1e-5;
  /// What is drawn along borders, against cracks between neighbours, reaches so far to either side,
  /// in radians.
  double border_width = 3e-3;
};

/// Largest angle between the directions at two corners of a triangle, in radians.
inline constexpr double largest_turn = 0.12;

/// Points of the model by which contacts are seen to lie below the envelope.
class InnerPoints {
 public:
  /// @pre points are not empty; in the scene's frame
  explicit InnerPoints(const std::vector<dvec3>& points);

  /// True is certain: in all directions between the given ones (non-negative combinations), one of
  /// the points is higher than everything between x (convex combinations), by more than `rise`.
  bool surely_hides(std::span<const dvec3> x, std::span<const dvec3> n, double rise = 0) const;
  /// True is certain: one of the points is higher than all values over the triangle.
  bool surely_hides(const GaussTriangles& triangles, const GaussTriangles::Triangle& t) const;
  /// Takes the triangles out that are hidden, and nodes that no other one has.
  void remove_hidden(GaussTriangles& triangles) const;

 private:
  static std::size_t cell_of(const dvec3& n);

  std::vector<dvec3> highest_;  ///< per cell of the sphere, the point that is highest in its middle
};

/// The Gauss map of some cells of a patch: over an adaptive triangulation of its parameters, the
/// normals Su x Sv and their opposites, as far as the cells' signs and the curvature let a
/// supporting plane touch and no inner point hides them; and along its sides narrow strips, so that
/// no crack opens to a neighbour.
/// @pre kind face, not ruled; the cells are the patch's and do not overlap
void add_face_triangles(const ContactGeometry& geometry, const Contact& patch, int element,
                        std::span<const CulledCell> cells, const InnerPoints& inner,
                        const GaussTriangleOptions& options, GaussTriangles& result);

/// What is between the normals of two patches along their smooth joins, where these differ: coarse
/// stand-ins for limit surfaces of cages meet in creases that are too flat to be edges. Nothing
/// where they differ by less than the direction tolerance. Of the two patches the first has them.
/// @pre kind face
void add_join_bands(const ContactGeometry& geometry, const Contact& patch, int element,
                    const GaussTriangleOptions& options, GaussTriangles& result);

/// The unit normal Su x Sv at a contact on a patch, whose jet is given, in the scene's frame; the
/// limit of unit_normal() where that vanishes, then `regular` is false. Zero if there is none.
struct SurfaceNormal {
  dvec3 n = dvec3(0.0);
  bool regular = true;
};
SurfaceNormal surface_normal(const ContactGeometry& geometry, const Contact& c,
                             const ContactJet& j);

/// The directions in which planes touch a piece of an edge: to each point those orthogonal to the
/// tangent, as far as the curve is bent away from them and no inner point hides them. Nothing of a
/// straight piece.
/// @pre kind edge
void add_edge_bands(const ContactGeometry& geometry, const Contact& piece, int element,
                    const InnerPoints& inner, const GaussTriangleOptions& options,
                    GaussTriangles& result);

/// A point whose directions of support are to be filled.
struct CellPoint {
  Contact contact;
  int element = -1;
  dvec3 x;
  /// Its values are lowered by this, so that it is seen only where nothing else is near.
  double bias = 0;
};

/// The cells of points: to each that is extreme among them, the directions in which it is the
/// farthest, a spherical polygon that is dual to the points' convex hull. Together they cover the
/// sphere; cells overlap their neighbours by border_width. Points in a plane or on a line have
/// cells that are lunes. Returns, for each point, the number of its first triangle.
std::vector<int> add_point_cells(const std::vector<CellPoint>& points,
                                 const GaussTriangleOptions& options, GaussTriangles& result);

}  // namespace taut
