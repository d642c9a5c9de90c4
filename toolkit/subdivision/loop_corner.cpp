#include "taut/subdivision/loop_corner.h"

#include <opensubdiv/far/patchTableFactory.h>

#include <algorithm>
#include <array>
#include <memory>

#include "taut/core/integers.h"
#include "taut/subdivision/patch_nets.h"
#include "taut/subdivision/refiner.h"

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

using Place = std::array<int, 2>;

/// Where OpenSubdiv's control points of the triangle (0, 0), (1, 0), (0, 1) are in a lattice, and
/// their Bezier points.
struct LatticeTriangle {
  std::array<Place, loop_points> places;
  LoopMatrix matrix;
};

/// Learnt of the middle one of a lattice.
LatticeTriangle learnt_triangle() {
  constexpr int size = 6;
  constexpr int middle = 2;
  const auto number = [](int i, int j) { return size * i + j; };
  Description lattice;
  lattice.point_count = std::size_t{size} * size;
  int face = -1;
  for (int i = 0; i + 1 < size; ++i) {
    for (int j = 0; j + 1 < size; ++j) {
      if (i == middle && j == middle) face = int(lattice.sizes.size());
      for (const int v : {number(i, j), number(i + 1, j), number(i, j + 1), number(i + 1, j),
                          number(i + 1, j + 1), number(i, j + 1)}) {
        lattice.vertices.push_back(v);
      }
      lattice.sizes.insert(lattice.sizes.end(), 2, 3);
    }
  }
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  const auto refiner = make_refiner(lattice, CageScheme::loop, options);
  Far::PatchTableFactory::Options patches(0);
  patches.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
  patches.generateVaryingTables = false;
  patches.SetPatchPrecision<double>();
  refiner->RefineAdaptive(patches.GetRefineAdaptiveOptions());
  const std::unique_ptr<Far::PatchTable> table(
      Far::PatchTableFactory::Create(*refiner, patches, {&face, 1}));
  LatticeTriangle result;
  const auto vertices = table->GetPatchVertices(0, 0);
  for (int k = 0; k < loop_points; ++k) {
    result.places[to_size(k)] = {vertices[k] / size - middle, vertices[k] % size - middle};
  }
  result.matrix = loop_to_bezier(*table, {0, 0, 0});
  return result;
}

const LatticeTriangle& lattice_triangle() {
  static const LatticeTriangle triangle = learnt_triangle();
  return triangle;
}

bool is_crease(const Far::TopologyLevel& level, int edge) {
  return level.IsEdgeBoundary(edge) || level.IsEdgeInfSharp(edge);
}

/// Neither sharp nor a boundary.
bool is_smooth(const Far::TopologyLevel& level, int edge) {
  return !is_crease(level, edge) && !level.IsEdgeSemiSharp(edge);
}

/// The third vertex of the other triangle at a smooth edge of this one, or -1.
int opposite(const Far::TopologyLevel& level, int face, int edge) {
  const auto faces = level.GetEdgeFaces(edge);
  if (faces.size() != 2) return -1;
  const int other = faces[0] == face ? faces[1] : faces[0];
  const auto ends = level.GetEdgeVertices(edge);
  const auto vertices = level.GetFaceVertices(other);
  for (int k = 0; k < vertices.size(); ++k) {
    if (vertices[k] != ends[0] && vertices[k] != ends[1]) return vertices[k];
  }
  return -1;
}

/// The crease, or a boundary, goes smoothly through the vertex.
bool is_on_crease(const Far::TopologyLevel& level, int vertex) {
  if (level.GetVertexRule(vertex) != Sdc::Crease::RULE_CREASE || level.IsVertexSemiSharp(vertex)) {
    return false;
  }
  const auto edges = level.GetVertexEdges(vertex);
  return std::none_of(edges.begin(), edges.end(), [&](int e) { return level.IsEdgeSemiSharp(e); });
}

/// The triangles around a lone one (v, a, b), by the vertices that they add.
struct Neighbors {
  int v, a, b;
  int over;              ///< beyond (a, b)
  int after_a, after_b;  ///< on the crease, beyond a and b
};

std::optional<Neighbors> neighbors(const Far::TopologyLevel& level, int face, int corner) {
  const auto vertices = level.GetFaceVertices(face);
  Neighbors n{};
  n.v = vertices[corner];
  n.a = vertices[(corner + 1) % 3];
  n.b = vertices[(corner + 2) % 3];
  const int across = level.FindEdge(n.a, n.b);
  if (!is_crease(level, level.FindEdge(n.v, n.a)) || !is_crease(level, level.FindEdge(n.v, n.b)) ||
      !is_smooth(level, across) || !is_on_crease(level, n.v) || !is_on_crease(level, n.a) ||
      !is_on_crease(level, n.b)) {
    return std::nullopt;
  }
  n.over = opposite(level, face, across);
  if (n.over < 0) return std::nullopt;
  const auto faces = level.GetEdgeFaces(across);
  const int next = faces[0] == face ? faces[1] : faces[0];
  const auto beyond = [&](int end) {
    const int edge = level.FindEdge(end, n.over);
    if (!is_smooth(level, edge)) return -1;
    const int after = opposite(level, next, edge);
    return after >= 0 && is_crease(level, level.FindEdge(end, after)) ? after : -1;
  };
  n.after_a = beyond(n.a);
  n.after_b = beyond(n.b);
  return n.after_a < 0 || n.after_b < 0 ? std::nullopt : std::optional(n);
}

}  // namespace

std::optional<std::vector<dvec3>> lone_triangle(const Far::TopologyLevel& level,
                                                std::span<const dvec3> points, int face) {
  if (level.GetFaceVertices(face).size() != 3) return std::nullopt;
  int corner = 0;
  std::optional<Neighbors> found;
  while (corner < 3 && !(found = neighbors(level, face, corner))) ++corner;
  if (!found) return std::nullopt;
  const Neighbors& n = *found;
  const auto point = [&](int vertex) { return points[to_size(vertex)]; };
  const dvec3 v = point(n.v), a = point(n.a), b = point(n.b);
  const dvec3 over = point(n.over), after_a = point(n.after_a), after_b = point(n.after_b);
  // In the lattice with v, a, b at (0, 0), (1, 0), (0, 1).
  const auto at = [&](const Place& place) -> dvec3 {
    const auto is = [&](int i, int j) { return place == Place{i, j}; };
    if (is(0, 0)) return v;
    if (is(1, 0) || is(0, -1)) return a;
    if (is(0, 1) || is(-1, 0)) return b;
    if (is(1, -1)) return v + a - b;
    if (is(-1, 1)) return v + b - a;
    if (is(1, 1)) return over;
    if (is(2, 0)) return after_a;
    if (is(0, 2)) return after_b;
    if (is(2, -1)) return a + after_a - over;
    return b + after_b - over;
  };
  // The triangle's own lattice has its first corner at (0, 0).
  const auto turned = [&](const Place& place) {
    const std::array<int, 3> share = {1 - place[0] - place[1], place[0], place[1]};
    return Place{share[to_size((corner + 1) % 3)], share[to_size((corner + 2) % 3)]};
  };
  const LatticeTriangle& lattice = lattice_triangle();
  std::vector<dvec3> result(quartic_points, dvec3(0.0));
  for (std::size_t r = 0; r < result.size(); ++r) {
    for (std::size_t k = 0; k < loop_points; ++k) {
      result[r] += lattice.matrix[r][k] * at(turned(lattice.places[k]));
    }
  }
  return result;
}

}  // namespace taut
