#include "taut/subdivision/cage_level.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/subdivision/extraction.h"
#include "taut/subdivision/loop_corner.h"
#include "taut/subdivision/patch_nets.h"
#include "taut/subdivision/refiner.h"
#include "taut/subdivision/sheets.h"

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// Weights of caps that OpenSubdiv makes at a time: some tens of megabytes.
constexpr std::size_t most_weights = std::size_t{1} << 17U;

/// A point as OpenSubdiv combines it.
struct Primvar {
  dvec3 x = dvec3(0.0);
  // NOLINTBEGIN(readability-identifier-naming): the names are OpenSubdiv's
  void Clear(void* = nullptr) { x = dvec3(0.0); }
  void AddWithWeight(const Primvar& other, double weight) { x += weight * other.x; }
  void AddWithWeight(const Primvar& other, float weight) { x += double(weight) * other.x; }
  // NOLINTEND(readability-identifier-naming)
};

/// A point that OpenSubdiv names in its tables.
template <class Point>
const Point& at(const std::vector<Point>& points, int i) {
  if (i < 0 || to_size(i) >= points.size()) {
    throw BackendError("OpenSubdiv gives a face of the cage a cap of points that are not there");
  }
  return points[to_size(i)];
}

Sdc::Options::VtxBoundaryInterpolation interpolation(CageBoundary boundary) {
  switch (boundary) {
    case CageBoundary::edge_only:
      return Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
    case CageBoundary::none:
      return Sdc::Options::VTX_BOUNDARY_NONE;
    default:
      return Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
  }
}

/// The number of the middle of an edge with these ends that is met for the first time on its level.
int middle_number(int a, int b, EdgeMiddles& middles) {
  if (a != b && !middles.are_several(a, b)) return middles.add(a, b);
  const int middle = middles.add_vertex();
  if (a == b) middles.add_several(a, middle);
  return middle;
}

/// The numbers of the vertices that the first `own` faces of a level have on the next one.
std::vector<int> child_numbers(const Far::TopologyLevel& level, const Far::TopologyLevel& next,
                               CageScheme scheme, int own, const std::vector<int>& numbers,
                               EdgeMiddles& middles) {
  std::vector<int> result(to_size(next.GetNumVertices()), -1);
  for (int f = 0; f < own; ++f) {
    const auto vertices = level.GetFaceVertices(f);
    for (int k = 0; k < vertices.size(); ++k) {
      result[to_size(level.GetVertexChildVertex(vertices[k]))] = numbers[to_size(vertices[k])];
    }
    const auto edges = level.GetFaceEdges(f);
    for (int k = 0; k < edges.size(); ++k) {
      const auto ends = level.GetEdgeVertices(edges[k]);
      const int a = numbers[to_size(ends[0])];
      const int b = numbers[to_size(ends[1])];
      int& middle = result[to_size(level.GetEdgeChildVertex(edges[k]))];
      if (middle < 0) middle = middle_number(a, b, middles);
    }
    if (scheme != CageScheme::loop) {
      result[to_size(level.GetFaceChildVertex(f))] = middles.add_vertex();
    }
    const auto inner = level.GetFaceChildEdges(f);
    for (int k = 0; k < inner.size(); ++k) {
      const auto ends = next.GetEdgeVertices(inner[k]);
      middles.add_inner(result[to_size(ends[0])], result[to_size(ends[1])]);
    }
  }
  return result;
}

/// The bicubic net of a table's patch, of the points that the table counts.
std::vector<dvec3> quad_net(const Far::PatchTable& table, int array, int patch,
                            const std::vector<Primvar>& points) {
  const auto vertices = table.GetPatchVertices(array, patch);
  std::array<dvec3, 16> net;
  for (int k = 0; k < 16; ++k) {
    net[to_size(k)] = vertices[k] < 0 ? dvec3(0.0) : at(points, vertices[k]).x;
  }
  return bezier_net(net, table.GetPatchParam(array, patch).GetBoundary());
}

/// The quartic net of a table's patch. `regular`: which of its corners are; `known`: matrices for
/// kinds of boundary, to which others are added.
std::vector<dvec3> triangle_net(const Far::PatchTable& table, int array, int patch,
                                const std::vector<Primvar>& points,
                                const std::array<bool, 3>& regular,
                                std::map<int, LoopMatrix>& known) {
  const auto vertices = table.GetPatchVertices(array, patch);
  if (vertices.size() == gregory_points) {
    std::array<dvec3, gregory_points> net;
    for (int k = 0; k < gregory_points; ++k) net[to_size(k)] = at(points, vertices[k]).x;
    return quartic_of_gregory(net, regular);
  }
  const int boundary = table.GetPatchParam(array, patch).GetBoundary();
  auto matrix = known.find(boundary);
  if (matrix == known.end()) {
    const Far::PatchTable::PatchHandle handle{array, patch, patch * loop_points};
    matrix = known.emplace(boundary, loop_to_bezier(table, handle)).first;
  }
  std::vector<dvec3> net(quartic_points, dvec3(0.0));
  for (int r = 0; r < quartic_points; ++r) {
    for (int k = 0; k < loop_points; ++k) {
      net[to_size(r)] += matrix->second[to_size(r)][to_size(k)] * at(points, vertices[k]).x;
    }
  }
  return net;
}

/// Where OpenSubdiv's caps at a vertex can be relied on.
enum class SoundCaps { here, on_refined_levels, on_no_level };

}  // namespace

struct CageLevel::Topology {
  CageScheme scheme = CageScheme::catmark;
  Sdc::Options options;
  bool is_refined = false;
  std::unique_ptr<Far::TopologyRefiner> refiner;
  std::vector<dvec3> points;
  std::vector<int> numbers;  ///< of vertices over all levels, -1 if not of a cell
  /// Vertices that are semi-sharp or at the end of a semi-sharp edge.
  std::vector<bool> near_semi_sharp;

  Far::TopologyLevel level() const { return refiner->GetLevel(0); }

  template <class Faces>
  void build(const Faces& faces) {
    refiner = make_refiner(faces, scheme, options);
    const Far::TopologyLevel base = level();
    near_semi_sharp.assign(points.size(), false);
    for (int v = 0; v < base.GetNumVertices(); ++v) {
      if (base.IsVertexSemiSharp(v)) near_semi_sharp[to_size(v)] = true;
    }
    for (int e = 0; e < base.GetNumEdges(); ++e) {
      if (!base.IsEdgeSemiSharp(e)) continue;
      const auto ends = base.GetEdgeVertices(e);
      for (int k = 0; k < 2; ++k) near_semi_sharp[to_size(ends[k])] = true;
    }
  }

  bool is_near_semi_sharp(int face) const {
    const auto vertices = level().GetFaceVertices(face);
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](int v) { return near_semi_sharp[to_size(v)]; });
  }

  bool is_dart(int vertex) const {
    const Far::TopologyLevel base = level();
    if (base.GetVertexRule(vertex) != Sdc::Crease::RULE_DART) return false;
    const auto edges = base.GetVertexEdges(vertex);
    return std::any_of(edges.begin(), edges.end(), [&](int e) { return base.IsEdgeInfSharp(e); });
  }

  /// An inner vertex of two faces, which so have two sides in common, or of three triangles.
  bool is_inner_with_few_faces(int vertex) const {
    const Far::TopologyLevel base = level();
    return !base.IsVertexBoundary(vertex) &&
           base.GetVertexFaces(vertex).size() <= (scheme == CageScheme::loop ? 3 : 2);
  }

  /// An inner vertex of two faces of which one of the two edges is infinitely sharp: a dart, at
  /// latest when others have become smooth.
  bool is_dart_of_two_faces(int vertex) const {
    const Far::TopologyLevel base = level();
    if (base.IsVertexBoundary(vertex) || base.IsVertexInfSharp(vertex)) return false;
    const auto edges = base.GetVertexEdges(vertex);
    return base.GetVertexFaces(vertex).size() == 2 && edges.size() == 2 &&
           base.IsEdgeInfSharp(edges[0]) != base.IsEdgeInfSharp(edges[1]);
  }

  /// Where OpenSubdiv (3.5) makes sound caps at a vertex. It makes the rows of a cap's matrix too
  /// short, and writes past its end, where the infinitely sharp edge at a dart leads to an
  /// irregular vertex; it makes them too long, and leaves in them what was there, where an edge
  /// leads to one from an inner vertex of two faces or, of a Loop cage, of three. Only the control
  /// cage has such edges; but at a dart of two faces it writes past the end on every level.
  SoundCaps sound_caps(int vertex) const {
    if (is_dart_of_two_faces(vertex)) return SoundCaps::on_no_level;
    const bool unsound = is_dart(vertex) || is_inner_with_few_faces(vertex);
    return unsound && !is_refined ? SoundCaps::on_refined_levels : SoundCaps::here;
  }

  bool has_patch(int face) const {
    const auto vertices = level().GetFaceVertices(face);
    return std::all_of(vertices.begin(), vertices.end(),
                       [&](int v) { return sound_caps(v) == SoundCaps::here; });
  }

  /// Faces at a face's vertices, for each of which a point of the face's cap has two weights at
  /// most.
  std::size_t weights(int face) const {
    const Far::TopologyLevel base = level();
    const auto vertices = base.GetFaceVertices(face);
    return std::accumulate(
        vertices.begin(), vertices.end(), std::size_t{0},
        [&](std::size_t sum, int v) { return sum + to_size(base.GetVertexFaces(v).size()); });
  }

  /// Of some faces, one at least.
  std::unique_ptr<Far::PatchTable> patch_table(std::span<const int> faces) const {
    Far::PatchTableFactory::Options patches(0);
    patches.SetEndCapType(scheme == CageScheme::loop
                              ? Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS
                              : Far::PatchTableFactory::Options::ENDCAP_BSPLINE_BASIS);
    patches.useInfSharpPatch = true;
    patches.useSingleCreasePatch = false;
    patches.generateLegacySharpCornerPatches = false;
    patches.generateVaryingTables = false;
    patches.SetPatchPrecision<double>();
    refiner->Unrefine();
    refiner->RefineAdaptive(patches.GetRefineAdaptiveOptions());
    return std::unique_ptr<Far::PatchTable>(
        Far::PatchTableFactory::Create(*refiner, patches, {faces.data(), to_int(faces.size())}));
  }

  /// The level's points and, behind them, those of its caps.
  std::vector<Primvar> patch_points(const Far::PatchTable& table) const {
    std::vector<Primvar> all(points.size() + to_size(table.GetNumLocalPoints()));
    for (std::size_t i = 0; i < points.size(); ++i) all[i].x = points[i];
    if (table.GetNumLocalPoints() == 0) return all;
    // Relative to one of the points: sums of weights are off 1 by up to some 1e-14.
    const Far::StencilTableReal<double>& stencils = *table.GetLocalPointStencilTable<double>();
    for (int i = 0; i < stencils.GetNumStencils(); ++i) {
      const Far::StencilReal<double> stencil = stencils.GetStencil(i);
      const Far::Index* const vertices = stencil.GetVertexIndices();
      const dvec3 origin = at(points, vertices[0]);
      dvec3 x(0.0);
      for (int k = 0; k < stencil.GetSize(); ++k) {
        x += stencil.GetWeights()[k] * (at(points, vertices[k]) - origin);
      }
      all[points.size() + to_size(i)].x = origin + x;
    }
    return all;
  }

  /// The faces by their numbers among OpenSubdiv's parametric faces: of a polygon that is no quad
  /// each corner has one.
  std::vector<int> faces_of_parameters() const {
    const Far::TopologyLevel base = level();
    const int regular = scheme == CageScheme::loop ? 3 : 4;
    std::vector<int> result;
    result.reserve(to_size(base.GetNumFaces()));
    for (int f = 0; f < base.GetNumFaces(); ++f) {
      const int size = base.GetFaceVertices(f).size();
      result.insert(result.end(), size == regular ? 1 : to_size(size), f);
    }
    return result;
  }

  /// Of a triangle: the corners about which the surface is a box spline.
  std::array<bool, 3> regular_corners(int face) const {
    const Far::TopologyLevel base = level();
    const auto vertices = base.GetFaceVertices(face);
    std::array<bool, 3> result = {};
    for (int k = 0; k < 3; ++k) {
      const int v = vertices[k];
      const int valence = base.GetVertexEdges(v).size();
      result[to_size(k)] = base.IsVertexBoundary(v) ? valence == 4 : valence == 6;
    }
    return result;
  }

  bool is_sharp(int edge) const {
    const Far::TopologyLevel base = level();
    return base.IsEdgeInfSharp(edge) || base.IsEdgeBoundary(edge) || base.IsEdgeNonManifold(edge);
  }

  std::array<bool, 4> smooth_sides(int face) const {
    const auto edges = level().GetFaceEdges(face);
    std::array<bool, 4> smooth = {};
    if (edges.size() > 4) return smooth;
    for (int k = 0; k < edges.size(); ++k) smooth[to_size(k)] = !is_sharp(edges[k]);
    return smooth;
  }

  /// The point of the cubic spline that a crease is, before that of a vertex on it, from which the
  /// edge leads on: where the vertex is a corner, the one that makes the spline end there. None if
  /// the crease does not go on.
  std::optional<dvec3> before_on_crease(int edge, int vertex) const {
    if (near_semi_sharp[to_size(vertex)]) return std::nullopt;
    const Far::TopologyLevel base = level();
    const auto beyond = [&](int e) -> const dvec3& {
      const auto ends = base.GetEdgeVertices(e);
      return points[to_size(ends[ends[0] == vertex ? 1 : 0])];
    };
    const Sdc::Crease::Rule rule = base.GetVertexRule(vertex);
    if (rule == Sdc::Crease::RULE_CORNER) return 2.0 * points[to_size(vertex)] - beyond(edge);
    if (rule != Sdc::Crease::RULE_CREASE) return std::nullopt;
    const auto edges = base.GetVertexEdges(vertex);
    for (int k = 0; k < edges.size(); ++k) {
      if (edges[k] != edge && is_sharp(edges[k])) return beyond(edges[k]);
    }
    return std::nullopt;
  }
};

CageLevel::CageLevel() : topology_(std::make_unique<Topology>()) {}
CageLevel::~CageLevel() = default;
CageLevel::CageLevel(CageLevel&&) noexcept = default;
CageLevel& CageLevel::operator=(CageLevel&&) noexcept = default;

CageLevel::CageLevel(const ControlCage& cage) : CageLevel() {
  Description description;
  description.point_count = cage.points.size();
  description.sizes.reserve(cage.faces.size());
  for (const std::vector<int>& face : cage.faces) {
    description.sizes.push_back(to_int(face.size()));
    description.vertices.insert(description.vertices.end(), face.begin(), face.end());
  }
  const auto clamped = [](double s) { return static_cast<float>(std::min(s, infinite_sharpness)); };
  for (const CageCrease& crease : cage.creases) {
    description.crease_vertices.insert(description.crease_vertices.end(), crease.vertices.begin(),
                                       crease.vertices.end());
    description.crease_sharpness.push_back(clamped(crease.sharpness));
  }
  for (const CageCorner& corner : cage.corners) {
    description.corner_vertices.push_back(corner.vertex);
    description.corner_sharpness.push_back(clamped(corner.sharpness));
  }
  description.holes = cage.holes;
  topology_->scheme = cage.scheme;
  topology_->points = cage.points;
  topology_->numbers.resize(cage.points.size());
  std::iota(topology_->numbers.begin(), topology_->numbers.end(), 0);
  Sdc::Options& options = topology_->options;
  options.SetVtxBoundaryInterpolation(interpolation(cage.boundary));
  options.SetCreasingMethod(cage.chaikin ? Sdc::Options::CREASE_CHAIKIN
                                         : Sdc::Options::CREASE_UNIFORM);
  options.SetTriangleSubdivision(cage.smooth_triangles ? Sdc::Options::TRI_SUB_SMOOTH
                                                       : Sdc::Options::TRI_SUB_CATMARK);
  topology_->build(description);
  // From here on, tags say what the rule makes of the boundary.
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  count_non_manifold();
  if (non_manifold_edges_ + non_manifold_vertices_ > 0) {
    const Sheets sheets(topology_->level());
    topology_->points.clear();
    for (const int v : sheets.originals()) topology_->points.push_back(cage.points[to_size(v)]);
    topology_->numbers = sheets.originals();
    topology_->build(sheets.description());
  }
  const Far::TopologyLevel base = topology_->level();
  for (int v = 0; v < base.GetNumVertices(); ++v) {
    if (topology_->sound_caps(v) != SoundCaps::on_no_level) continue;
    throw InvalidInput("vertex " + std::to_string(topology_->numbers[to_size(v)]) +
                       " of the cage has two faces that share two edges, of which one is "
                       "infinitely sharp: OpenSubdiv has no limit surface there");
  }
  cells_.reserve(cage.faces.size());
  for (int f = 0; f < base.GetNumFaces(); ++f) {
    if (!base.IsFaceHole(f)) cells_.push_back({f, f, -1});
  }
}

std::vector<CellPatch> CageLevel::patches(const Progress& progress) const {
  const Topology& topology = *topology_;
  std::vector<CellPatch> result(cells_.size());
  std::vector<int> cell_of(to_size(topology.level().GetNumFaces()), -1);
  std::vector<int> faces;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    result[c].smooth = topology.smooth_sides(cells_[c].face);
    const int own = cells_[c].face;
    if (topology.scheme == CageScheme::loop) {
      if (auto points = lone_triangle(topology.level(), topology.points, own)) {
        result[c].kind = CellPatch::Kind::regular;
        result[c].points = std::move(*points);
        result[c].degree = 4;
        continue;
      }
    }
    if (!topology.has_patch(own)) continue;
    cell_of[to_size(own)] = to_int(c);
    faces.push_back(own);
  }
  const std::vector<int> face_of = topology.faces_of_parameters();
  std::map<int, LoopMatrix> loop_matrices;
  // A few at a time where many are about one vertex: all of these count for each of them.
  for (std::size_t first = 0, end = 0; first < faces.size(); first = end) {
    progress.check();
    for (std::size_t weights = 0; end < faces.size() && weights < most_weights; ++end) {
      weights += topology.weights(faces[end]);
    }
    const std::span<const int> some = std::span(faces).subspan(first, end - first);
    const std::unique_ptr<Far::PatchTable> table = topology.patch_table(some);
    const std::vector<Primvar> points = topology.patch_points(*table);
    for (int array = 0; array < table->GetNumPatchArrays(); ++array) {
      for (int i = 0; i < table->GetNumPatches(array); ++i) {
        const Far::PatchParam param = table->GetPatchParam(array, i);
        const int face = face_of[to_size(param.GetFaceId())];
        CellPatch& patch = result[to_size(cell_of[to_size(face)])];
        patch.semi_sharp = topology.is_near_semi_sharp(face);
        const bool exact = param.IsRegular() && !patch.semi_sharp;
        patch.kind = exact ? CellPatch::Kind::regular : CellPatch::Kind::cap;
        if (topology.scheme == CageScheme::catmark) {
          patch.points = quad_net(*table, array, i, points);
        } else {
          patch.points =
              triangle_net(*table, array, i, points, topology.regular_corners(face), loop_matrices);
          patch.degree = 4;
        }
      }
    }
  }
  return result;
}

std::vector<dvec3> CageLevel::enclosure(std::span<const std::size_t> cells) const {
  const Far::TopologyLevel base = topology_->level();
  std::vector<int> faces;
  for (const std::size_t c : cells) faces.push_back(cells_[c].face);
  std::vector<int> vertices;
  for (const int f : with_surroundings(base, std::move(faces))) {
    const auto own = base.GetFaceVertices(f);
    vertices.insert(vertices.end(), own.begin(), own.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<dvec3> points;
  points.reserve(vertices.size());
  for (const int v : vertices) points.push_back(topology_->points[to_size(v)]);
  return points;
}

std::span<const int> CageLevel::vertices(std::size_t cell) const {
  const auto vertices = topology_->level().GetFaceVertices(cells_[cell].face);
  return {vertices.begin(), to_size(vertices.size())};
}

std::optional<std::size_t> CageLevel::across(std::size_t cell, std::size_t side) const {
  const Far::TopologyLevel base = topology_->level();
  const int own = cells_[cell].face;
  const auto faces = base.GetEdgeFaces(base.GetFaceEdges(own)[to_int(side)]);
  if (faces.size() != 2) return std::nullopt;
  const int other = faces[0] == own ? faces[1] : faces[0];
  // Cells are in the order of their faces.
  const auto found = std::lower_bound(cells_.begin(), cells_.end(), other,
                                      [](const CageCell& c, int face) { return c.face < face; });
  if (found == cells_.end() || found->face != other) return std::nullopt;
  return std::size_t(found - cells_.begin());
}

std::optional<std::array<dvec3, 4>> CageLevel::crease(std::size_t cell, std::size_t side) const {
  const int face = cells_[cell].face;
  const auto vertices = topology_->level().GetFaceVertices(face);
  const int edge = topology_->level().GetFaceEdges(face)[to_int(side)];
  const int a = vertices[to_int(side)];
  const int b = vertices[(to_int(side) + 1) % vertices.size()];
  if (!topology_->is_sharp(edge)) return std::nullopt;
  const std::optional<dvec3> before = topology_->before_on_crease(edge, a);
  const std::optional<dvec3> after = topology_->before_on_crease(edge, b);
  if (!before || !after) return std::nullopt;
  const dvec3 p = point(a);
  const dvec3 q = point(b);
  return std::array<dvec3, 4>{p + ((*before - p) + (q - p)) / 6.0, p + (q - p) / 3.0,
                              q + (p - q) / 3.0, q + ((*after - q) + (p - q)) / 6.0};
}

bool CageLevel::is_apex(int vertex) const {
  const Far::TopologyLevel base = topology_->level();
  if (base.GetVertexRule(vertex) != Sdc::Crease::RULE_CORNER || base.IsVertexBoundary(vertex) ||
      topology_->near_semi_sharp[to_size(vertex)]) {
    return false;
  }
  const auto edges = base.GetVertexEdges(vertex);
  return std::count_if(edges.begin(), edges.end(), [&](int e) { return topology_->is_sharp(e); }) <
         2;
}

const dvec3& CageLevel::point(int vertex) const { return topology_->points[to_size(vertex)]; }

int CageLevel::number(int vertex) const { return topology_->numbers[to_size(vertex)]; }

CageLevel CageLevel::refined(std::span<const std::size_t> cells, EdgeMiddles& middles) const {
  const Topology& topology = *topology_;
  // The cells and what surrounds them, refined once.
  std::vector<int> faces;
  faces.reserve(cells.size());
  for (const std::size_t c : cells) faces.push_back(cells_[c].face);
  const std::size_t own = faces.size();
  topology.refiner->Unrefine();
  const Far::TopologyLevel base = topology.level();
  faces = with_surroundings(base, std::move(faces));
  const Extraction cut(base, std::move(faces), own);
  const std::unique_ptr<Far::TopologyRefiner> refiner =
      make_refiner(cut, topology.scheme, topology.options);
  Far::TopologyRefiner::UniformOptions uniform(1);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  std::vector<Primvar> coarse(cut.vertices().size());
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    coarse[i].x = topology.points[to_size(cut.vertices()[i])];
  }
  const Far::TopologyLevel fine = refiner->GetLevel(1);
  std::vector<Primvar> children(to_size(fine.GetNumVertices()));
  Far::PrimvarRefinerReal<double>(*refiner).Interpolate(1, coarse, children);

  // The children, with what surrounds these.
  CageLevel next;
  std::vector<int> child_faces;
  const Far::TopologyLevel parents = refiner->GetLevel(0);
  for (std::size_t i = 0; i < own; ++i) {
    const auto of_parent = parents.GetFaceChildFaces(to_int(i));
    const CageCell& parent = cells_[cells[i]];
    for (int k = 0; k < of_parent.size(); ++k) {
      next.cells_.push_back({to_int(child_faces.size()), parent.cage_face, parent.region});
      child_faces.push_back(of_parent[k]);
    }
  }
  const std::size_t own_children = child_faces.size();
  child_faces = with_surroundings(fine, std::move(child_faces));
  const Extraction part(fine, std::move(child_faces), own_children);
  next.topology_->scheme = topology.scheme;
  next.topology_->options = topology.options;
  next.topology_->is_refined = true;
  next.topology_->points.reserve(part.vertices().size());
  for (const int v : part.vertices()) {
    next.topology_->points.push_back(children[to_size(v)].x);
  }
  std::vector<int> coarse_numbers;
  coarse_numbers.reserve(cut.vertices().size());
  for (const int v : cut.vertices()) coarse_numbers.push_back(topology.numbers[to_size(v)]);
  const std::vector<int> numbers =
      child_numbers(parents, fine, topology.scheme, to_int(own), coarse_numbers, middles);
  next.topology_->numbers.reserve(part.vertices().size());
  for (const int v : part.vertices()) next.topology_->numbers.push_back(numbers[to_size(v)]);
  next.topology_->build(part);
  return next;
}

void CageLevel::count_non_manifold() {
  const Far::TopologyLevel base = topology_->level();
  for (int e = 0; e < base.GetNumEdges(); ++e) {
    non_manifold_edges_ += base.IsEdgeNonManifold(e) ? 1 : 0;
  }
  for (int v = 0; v < base.GetNumVertices(); ++v) {
    non_manifold_vertices_ += base.IsVertexNonManifold(v) ? 1 : 0;
  }
}

}  // namespace taut
