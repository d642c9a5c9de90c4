#include <algorithm>
#include <cmath>

#include "taut/envelope/gauss_triangles.h"
#include "taut/hull/polytope/point_hull.h"

namespace taut {
namespace {

/// Triangles of cells are halved until their sides turn by less, in radians.
constexpr double cell_turn = 0.06;

/// How far from the points those are put, as a share of their size, that make a flat set solid: so
/// little that the cells they take away are filled by their neighbours' overlap.
constexpr double apex_height = 1e-6;

/// A hull of the points in space, or, of points in a plane or on a line, of them and of more on
/// either side of their middle, numbered behind. @pre the points are not all one
PointHull solid_hull(const std::vector<CellPoint>& points) {
  std::vector<dvec3> all;
  all.reserve(points.size());
  Box box;
  dvec3 middle(0.0);
  for (const CellPoint& p : points) {
    all.push_back(p.x);
    box.include(p.x);
    middle += p.x / double(points.size());
  }
  const double size = diagonal(box);
  PointHull hull({box.lower - dvec3(size), box.upper + dvec3(size)});
  hull.add(all);
  for (const int axis : {0, 1, 2}) {
    if (hull.dimension() == 3) break;
    dvec3 shift(0.0);
    shift[axis] = apex_height * size;
    const std::array<dvec3, 2> apexes = {middle + shift, middle - shift};
    hull.add(apexes);
  }
  return hull;
}

/// A triangle of a cell, along great circles. Sides are halved by their length alone, so that cells
/// meet without cracks.
void add_triangle(const CellPoint& point, const dvec3& a, const dvec3& b, const dvec3& c,
                  GaussTriangles& result) {
  const double ab = glm::dot(a, b);
  const double bc = glm::dot(b, c);
  const double ca = glm::dot(c, a);
  const double longest = std::min({ab, bc, ca});
  if (longest >= std::cos(cell_turn)) {
    const auto node = [&](const dvec3& n) {
      return result.add_node({n, point.x - point.bias * n, {point.contact.u, point.contact.v}});
    };
    result.add_triangle(point.element, node(a), node(b), node(c), false);
    return;
  }
  const auto halve = [&](const dvec3& p, const dvec3& q, const dvec3& other) {
    const dvec3 middle = unit(p + q);
    add_triangle(point, p, middle, other, result);
    add_triangle(point, middle, q, other, result);
  };
  if (longest == ab) {
    halve(a, b, c);
  } else if (longest == bc) {
    halve(b, c, a);
  } else {
    halve(c, a, b);
  }
}

/// A strip along a side of a cell, against cracks to its neighbour.
void add_strip(const CellPoint& point, const dvec3& a, const dvec3& b, double width,
               GaussTriangles& result) {
  if (glm::dot(a, b) < std::cos(cell_turn)) {
    const dvec3 middle = unit(a + b);
    add_strip(point, a, middle, width, result);
    add_strip(point, middle, b, width, result);
    return;
  }
  const dvec3 way = b - a;
  const dvec3 along = glm::length(way) > 0 ? width * unit(way) : width * tangent_frame(a)[0];
  const dvec3 across = glm::cross(a, along);
  add_triangle(point, unit(a - along - across), unit(b + along - across), unit(b + along + across),
               result);
  add_triangle(point, unit(a - along - across), unit(b + along + across), unit(a - along + across),
               result);
}

/// The whole sphere.
void add_sphere(const CellPoint& point, GaussTriangles& result) {
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        add_triangle(point, {x, 0, 0}, {0, y, 0}, {0, 0, z}, result);
      }
    }
  }
}

/// The cells of a hull's vertices.
class PointCells {
 public:
  PointCells(const PointHull& hull, const GaussTriangleOptions& options, GaussTriangles& result)
      : hull_(hull), options_(options), result_(result), facet_at_(hull.points().size(), -1) {
    for (int f = 0; f < int(hull.facets().size()); ++f) {
      if (!hull.facet(f).alive) continue;
      for (const int v : hull.facet(f).vertex) facet_at_[std::size_t(v)] = f;
    }
    for (const dvec3& x : hull.points()) inside_ += x / double(hull.points().size());
  }

  void draw(const CellPoint& point, int vertex);

 private:
  std::vector<dvec3> outline(int vertex) const;

  const PointHull& hull_;
  const GaussTriangleOptions& options_;
  GaussTriangles& result_;
  std::vector<int> facet_at_;  ///< per vertex: one of its facets
  dvec3 inside_ = dvec3(0.0);
};

/// The normals of the facets about a vertex, in order, and between each two of them the direction
/// halfway, across their common edge.
std::vector<dvec3> PointCells::outline(int vertex) const {
  std::vector<dvec3> loop;
  const int first = facet_at_[std::size_t(vertex)];
  for (int f = first;;) {
    const PointHull::Facet& facet = hull_.facet(f);
    const auto k = std::size_t(std::find(facet.vertex.begin(), facet.vertex.end(), vertex) -
                               facet.vertex.begin());
    const dvec3 n = unit(facet.side.normal());
    // Across the edge that ends in the vertex.
    const std::size_t from = (k + 2) % 3;
    const int next = facet.neighbor[from];
    const dvec3 m = unit(hull_.facet(next).side.normal());
    const dvec3 edge = unit(hull_.point(vertex) - hull_.point(facet.vertex[from]));
    loop.push_back(n);
    loop.push_back(glm::dot(n, m) > -0.5 ? unit(n + m) : unit(glm::cross(edge, n)));
    f = next;
    if (f == first) return loop;
  }
}

void PointCells::draw(const CellPoint& point, int vertex) {
  if (facet_at_[std::size_t(vertex)] < 0) return;  // not extreme
  std::vector<dvec3> loop = outline(vertex);
  dvec3 middle(0.0);
  for (const dvec3& n : loop) middle += n;
  // About a half space the directions cancel.
  middle = glm::length(middle) > 0.1 ? unit(middle) : unit(point.x - inside_);
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const dvec3& next = loop[(k + 1) % loop.size()];
    add_triangle(point, middle, loop[k], next, result_);
    add_strip(point, loop[k], next, options_.border_width, result_);
  }
}

}  // namespace

std::vector<int> add_point_cells(const std::vector<CellPoint>& points,
                                 const GaussTriangleOptions& options, GaussTriangles& result) {
  if (points.empty()) return {};
  const bool all_one = std::all_of(points.begin(), points.end(),
                                   [&](const CellPoint& p) { return p.x == points[0].x; });
  if (all_one) {
    std::vector<int> first(points.size(), int(result.triangles.size()));
    add_sphere(points[0], result);
    std::fill(first.begin() + 1, first.end(), int(result.triangles.size()));
    return first;
  }
  std::vector<int> first;
  const PointHull hull = solid_hull(points);
  PointCells cells(hull, options, result);
  for (std::size_t k = 0; k < points.size(); ++k) {
    first.push_back(int(result.triangles.size()));
    cells.draw(points[k], int(k));
  }
  return first;
}

}  // namespace taut
