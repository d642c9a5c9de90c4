#include "taut/subdivision/cage_level.h"

#include <opensubdiv/far/error.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "taut/core/error.h"

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

std::size_t to_size(int n) { return static_cast<std::size_t>(n); }
int to_int(std::size_t n) { return static_cast<int>(n); }

/// A point as OpenSubdiv combines it.
struct Primvar {
  dvec3 x = dvec3(0.0);
  // NOLINTBEGIN(readability-identifier-naming): the names are OpenSubdiv's
  void Clear(void* = nullptr) { x = dvec3(0.0); }
  void AddWithWeight(const Primvar& other, double weight) { x += weight * other.x; }
  void AddWithWeight(const Primvar& other, float weight) { x += double(weight) * other.x; }
  // NOLINTEND(readability-identifier-naming)
};

/// Faces with their tags, as OpenSubdiv takes them.
struct Description {
  std::vector<int> sizes;
  std::vector<int> vertices;
  std::vector<int> crease_vertices;
  std::vector<float> crease_sharpness;
  std::vector<int> corner_vertices;
  std::vector<float> corner_sharpness;
  std::vector<int> holes;
  std::size_t point_count = 0;
};

Sdc::SchemeType scheme_type(CageScheme scheme) {
  return scheme == CageScheme::loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
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

/// What OpenSubdiv says of a mistake goes into the exception, not to the terminal.
std::string& last_error() {
  thread_local std::string message;
  return message;
}

void keep_error(Far::ErrorType, const char* message) { last_error() = message; }
void pass_warning(const char*) {}

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Description& description,
                                                   CageScheme scheme, const Sdc::Options& options) {
  static const bool silenced = [] {
    Far::SetErrorCallback(keep_error);
    Far::SetWarningCallback(pass_warning);
    return true;
  }();
  static_cast<void>(silenced);
  Far::TopologyDescriptor d;
  d.numVertices = to_int(description.point_count);
  d.numFaces = to_int(description.sizes.size());
  d.numVertsPerFace = description.sizes.data();
  d.vertIndicesPerFace = description.vertices.data();
  d.numCreases = to_int(description.crease_sharpness.size());
  d.creaseVertexIndexPairs = description.crease_vertices.data();
  d.creaseWeights = description.crease_sharpness.data();
  d.numCorners = to_int(description.corner_sharpness.size());
  d.cornerVertexIndices = description.corner_vertices.data();
  d.cornerWeights = description.corner_sharpness.data();
  d.numHoles = to_int(description.holes.size());
  d.holeIndices = description.holes.data();
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  last_error().clear();
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(d, Factory::Options(scheme_type(scheme), options)));
  if (!refiner) {
    throw BackendError("OpenSubdiv does not take the cage" +
                       (last_error().empty() ? std::string() : ": " + last_error()));
  }
  return refiner;
}

/// Some faces of a level as a cage of their own.
class Extraction {
 public:
  explicit Extraction(const Far::TopologyLevel& level)
      : level_(level), number_(to_size(level.GetNumVertices()), -1) {}

  void add_face(int face, bool hole) {
    if (hole) out_.holes.push_back(to_int(out_.sizes.size()));
    const auto vertices = level_.GetFaceVertices(face);
    out_.sizes.push_back(vertices.size());
    for (int i = 0; i < vertices.size(); ++i) out_.vertices.push_back(number(vertices[i]));
    const auto edges = level_.GetFaceEdges(face);
    for (int i = 0; i < edges.size(); ++i) edges_.push_back(edges[i]);
  }

  Description take() {
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    for (const int e : edges_) {
      const float sharpness = level_.GetEdgeSharpness(e);
      if (sharpness <= 0) continue;
      const auto ends = level_.GetEdgeVertices(e);
      for (int k = 0; k < 2; ++k) out_.crease_vertices.push_back(number_[to_size(ends[k])]);
      out_.crease_sharpness.push_back(sharpness);
    }
    for (std::size_t i = 0; i < originals_.size(); ++i) {
      const float sharpness = level_.GetVertexSharpness(originals_[i]);
      if (sharpness <= 0) continue;
      out_.corner_vertices.push_back(to_int(i));
      out_.corner_sharpness.push_back(sharpness);
    }
    out_.point_count = originals_.size();
    return std::move(out_);
  }

  /// The level's vertices, in the order of the new ones.
  const std::vector<int>& originals() const { return originals_; }

 private:
  int number(int vertex) {
    int& n = number_[to_size(vertex)];
    if (n < 0) {
      n = to_int(originals_.size());
      originals_.push_back(vertex);
    }
    return n;
  }

  const Far::TopologyLevel& level_;
  std::vector<int> number_;
  std::vector<int> originals_;
  std::vector<int> edges_;
  Description out_;
};

/// The numbers of the vertices that the first `own` faces of a level have on the next one.
std::vector<int> child_numbers(const Far::TopologyLevel& level, int child_count, CageScheme scheme,
                               int own, const std::vector<int>& numbers, EdgeMiddles& middles) {
  std::vector<int> result(to_size(child_count), -1);
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
      if (middle < 0) middle = a == b ? middles.add_vertex() : middles.add(a, b);
    }
    if (scheme == CageScheme::loop) continue;
    result[to_size(level.GetFaceChildVertex(f))] = middles.add_vertex();
  }
  return result;
}

/// Some faces and, behind them, all others that touch their vertices.
std::vector<int> with_surroundings(const Far::TopologyLevel& level, std::vector<int> faces) {
  std::vector<bool> taken(to_size(level.GetNumFaces()));
  for (const int f : faces) taken[to_size(f)] = true;
  const std::size_t own = faces.size();
  for (std::size_t i = 0; i < own; ++i) {
    const auto vertices = level.GetFaceVertices(faces[i]);
    for (int k = 0; k < vertices.size(); ++k) {
      const auto around = level.GetVertexFaces(vertices[k]);
      for (int j = 0; j < around.size(); ++j) {
        if (taken[to_size(around[j])]) continue;
        taken[to_size(around[j])] = true;
        faces.push_back(around[j]);
      }
    }
  }
  return faces;
}

/// A B-spline's 16 control points to the Bezier points of its piece; `boundary`: bits of the sides
/// v = 0, u = 1, v = 1, u = 0, beyond which the spline is continued straight.
std::vector<dvec3> bezier_net(std::array<dvec3, 16> p, int boundary) {
  // Point (column i along u, row j along v) is p[4 j + i].
  const auto extend = [&](int edge, int from, int step_across, int step_along) {
    if ((boundary & edge) == 0) return;
    for (int k = 0; k < 4; ++k) {
      dvec3* const x = p.data() + from + k * step_along;
      *x = 2.0 * x[step_across] - x[2 * step_across];
    }
  };
  extend(1, 0, 4, 1);
  extend(4, 12, -4, 1);
  extend(2, 3, -1, 4);
  extend(8, 0, 1, 4);
  const auto convert = [](const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    return std::array<dvec3, 4>{(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0,
                                (b + 4.0 * c + d) / 6.0};
  };
  std::array<std::array<dvec3, 4>, 4> rows;  // [j][i]
  for (std::size_t j = 0; j < 4; ++j) {
    rows[j] = convert(p[4 * j], p[4 * j + 1], p[4 * j + 2], p[4 * j + 3]);
  }
  std::vector<dvec3> net(16);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto column = convert(rows[0][i], rows[1][i], rows[2][i], rows[3][i]);
    for (std::size_t j = 0; j < 4; ++j) net[4 * i + j] = column[j];
  }
  return net;
}

constexpr int loop_points = 12;
constexpr int quartic_points = 15;

/// Calls visit(i, j) for the points of a quartic triangle in their order.
template <class Visit>
void for_each_quartic_point(const Visit& visit) {
  for (int j = 0; j <= 4; ++j) {
    for (int i = 0; i + j <= 4; ++i) visit(i, j);
  }
}

double quartic_bernstein(int i, int j, double u, double v) {
  constexpr std::array<double, 5> factorial = {1, 1, 2, 6, 24};
  const int k = 4 - i - j;
  return 24 / (factorial[to_size(i)] * factorial[to_size(j)] * factorial[to_size(k)]) *
         std::pow(u, i) * std::pow(v, j) * std::pow(1 - u - v, k);
}

using LoopMatrix = Eigen::Matrix<double, quartic_points, loop_points>;

/// The Bezier points of a box spline's triangle, from its twelve control points, by its basis at as
/// many parameters. The matrix is of 48ths, to which it is rounded.
LoopMatrix loop_to_bezier(const Far::PatchTable& table,
                          const Far::PatchTable::PatchHandle& handle) {
  Eigen::Matrix<double, quartic_points, quartic_points> bernstein;
  LoopMatrix basis;
  int row = 0;
  for_each_quartic_point([&](int a, int b) {
    const double u = a / 4.0;
    const double v = b / 4.0;
    double weights[loop_points];
    table.EvaluateBasis(handle, u, v, weights);
    for (int k = 0; k < loop_points; ++k) basis(row, k) = weights[k];
    int column = 0;
    for_each_quartic_point(
        [&](int i, int j) { bernstein(row, column++) = quartic_bernstein(i, j, u, v); });
    ++row;
  });
  LoopMatrix m = bernstein.fullPivLu().solve(basis);
  return (m * 48.0).array().round() / 48.0;
}

/// Of OpenSubdiv's quartic Gregory triangle: of each corner itself, the points next to it on the
/// sides that begin and that end there, and two for the one inside that is next to it, those for
/// the same two sides; then the sides' middle points.
constexpr int gregory_points = 18;

/// The quartic triangle with the Gregory triangle's borders. It has its tangent planes, too, along
/// sides between regular corners; between others the two points inside are averaged.
std::vector<dvec3> quartic_of_gregory(const std::array<dvec3, gregory_points>& net,
                                      const std::array<bool, 3>& regular) {
  std::array<dvec3, 3> inside;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const std::size_t last = (k + 2) % 3;
    const dvec3& begins = net[5 * k + 3];
    const dvec3& ends = net[5 * k + 4];
    const bool one = regular[k] && regular[next] != regular[last];
    inside[k] = !one ? 0.5 * (begins + ends) : regular[next] ? begins : ends;
  }
  return {net[0],  net[1],    net[15],   net[7], net[5],  //
          net[2],  inside[0], inside[1], net[6],          //
          net[17], inside[2], net[16],                    //
          net[11], net[12],                               //
          net[10]};
}

/// Sheets of faces that meet in edges that are no manifold, parted there and in the ends of these:
/// infinitely sharp as they are, each sheet has its own boundary along them.
class Sheets {
 public:
  explicit Sheets(const Far::TopologyLevel& level) : level_(level) {
    for (int f = 0; f < level.GetNumFaces(); ++f) {
      const auto vertices = level.GetFaceVertices(f);
      description_.sizes.push_back(vertices.size());
      first_.push_back(to_int(description_.vertices.size()));
      description_.vertices.insert(description_.vertices.end(), to_size(vertices.size()), -1);
      if (level.IsFaceHole(f)) description_.holes.push_back(f);
    }
    for (int v = 0; v < level.GetNumVertices(); ++v) part_vertex(v);
    add_creases();
    description_.point_count = originals_.size();
  }

  const Description& description() const { return description_; }
  /// The level's vertices, in the order of the new ones.
  const std::vector<int>& originals() const { return originals_; }

 private:
  /// A copy for each set of faces about the vertex that manifold edges connect.
  void part_vertex(int v) {
    const auto faces = level_.GetVertexFaces(v);
    const auto places = level_.GetVertexFaceLocalIndices(v);
    std::vector<int> copy(to_size(faces.size()), -1);
    for (int i = 0; i < faces.size(); ++i) {
      if (copy[to_size(i)] >= 0) continue;
      const int number = add_copy(v);
      std::vector<int> reached = {i};
      copy[to_size(i)] = number;
      for (std::size_t k = 0; k < reached.size(); ++k) {
        for (int j = 0; j < faces.size(); ++j) {
          if (copy[to_size(j)] >= 0 || !are_joined(v, faces[reached[k]], faces[j])) continue;
          copy[to_size(j)] = number;
          reached.push_back(j);
        }
      }
    }
    for (int i = 0; i < faces.size(); ++i) {
      description_.vertices[to_size(first_[to_size(faces[i])] + places[i])] = copy[to_size(i)];
    }
  }

  int add_copy(int v) {
    const int number = to_int(originals_.size());
    originals_.push_back(v);
    const bool corner =
        level_.IsVertexNonManifold(v) && level_.GetVertexRule(v) == Sdc::Crease::RULE_CORNER;
    const float sharpness = corner ? float(infinite_sharpness) : level_.GetVertexSharpness(v);
    if (sharpness > 0) {
      description_.corner_vertices.push_back(number);
      description_.corner_sharpness.push_back(sharpness);
    }
    return number;
  }

  /// By a manifold edge at the vertex; one face is joined to itself.
  bool are_joined(int v, int a, int b) const {
    if (a == b) return true;
    const auto edges = level_.GetVertexEdges(v);
    return std::any_of(edges.begin(), edges.end(), [&](int e) {
      const auto faces = level_.GetEdgeFaces(e);
      return !level_.IsEdgeNonManifold(e) && faces.size() == 2 &&
             ((faces[0] == a && faces[1] == b) || (faces[0] == b && faces[1] == a));
    });
  }

  void add_creases() {
    for (int f = 0; f < level_.GetNumFaces(); ++f) {
      const auto edges = level_.GetFaceEdges(f);
      for (int k = 0; k < edges.size(); ++k) {
        const float sharpness = level_.GetEdgeSharpness(edges[k]);
        if (sharpness <= 0) continue;
        const int first = first_[to_size(f)];
        for (const int corner : {k, (k + 1) % edges.size()}) {
          description_.crease_vertices.push_back(description_.vertices[to_size(first + corner)]);
        }
        description_.crease_sharpness.push_back(sharpness);
      }
    }
  }

  const Far::TopologyLevel& level_;
  Description description_;
  std::vector<int> first_;  // of each face's vertices
  std::vector<int> originals_;
};

}  // namespace

struct CageLevel::Topology {
  CageScheme scheme = CageScheme::catmark;
  Sdc::Options options;
  std::unique_ptr<Far::TopologyRefiner> refiner;
  std::vector<dvec3> points;
  std::vector<int> numbers;  ///< of vertices over all levels, -1 if not of a cell
  /// Vertices that are semi-sharp or at the end of a semi-sharp edge.
  std::vector<bool> near_semi_sharp;

  Far::TopologyLevel level() const { return refiner->GetLevel(0); }

  void build(const Description& description) {
    refiner = make_refiner(description, scheme, options);
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

  std::unique_ptr<Far::PatchTable> patch_table() const {
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
    return std::unique_ptr<Far::PatchTable>(Far::PatchTableFactory::Create(*refiner, patches));
  }

  /// The level's points and, behind them, those of its caps.
  std::vector<Primvar> patch_points(const Far::PatchTable& table) const {
    std::vector<Primvar> all(points.size() + to_size(table.GetNumLocalPoints()));
    for (std::size_t i = 0; i < points.size(); ++i) all[i].x = points[i];
    if (table.GetNumLocalPoints() == 0) return all;
    // Of Loop caps, weights are rounded to single precision, but so is their sum.
    const Far::StencilTableReal<double>& stencils = *table.GetLocalPointStencilTable<double>();
    for (int i = 0; i < stencils.GetNumStencils(); ++i) {
      const Far::StencilReal<double> stencil = stencils.GetStencil(i);
      const Far::Index* const vertices = stencil.GetVertexIndices();
      const dvec3 origin = points[to_size(vertices[0])];
      dvec3 x(0.0);
      for (int k = 0; k < stencil.GetSize(); ++k) {
        x += stencil.GetWeights()[k] * (points[to_size(vertices[k])] - origin);
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

  std::array<bool, 4> smooth_sides(int face) const {
    const Far::TopologyLevel base = level();
    const auto edges = base.GetFaceEdges(face);
    std::array<bool, 4> smooth = {};
    for (int k = 0; k < std::min(4, edges.size()); ++k) {
      smooth[to_size(k)] = !base.IsEdgeInfSharp(edges[k]) && !base.IsEdgeBoundary(edges[k]) &&
                           !base.IsEdgeNonManifold(edges[k]);
    }
    return smooth;
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
  cells_.reserve(cage.faces.size());
  for (int f = 0; f < base.GetNumFaces(); ++f) {
    if (!base.IsFaceHole(f)) cells_.push_back({f, f, -1});
  }
}

std::vector<CellPatch> CageLevel::patches() const {
  const Topology& topology = *topology_;
  const std::unique_ptr<Far::PatchTable> table = topology.patch_table();
  const std::vector<Primvar> points = topology.patch_points(*table);
  const std::vector<int> face_of = topology.faces_of_parameters();
  std::vector<int> cell_of(to_size(topology.level().GetNumFaces()), -1);
  for (std::size_t c = 0; c < cells_.size(); ++c) cell_of[to_size(cells_[c].face)] = to_int(c);

  std::vector<CellPatch> result(cells_.size());
  std::map<int, LoopMatrix> loop_matrices;
  for (int array = 0; array < table->GetNumPatchArrays(); ++array) {
    for (int i = 0; i < table->GetNumPatches(array); ++i) {
      const Far::PatchParam param = table->GetPatchParam(array, i);
      const int face = face_of[to_size(param.GetFaceId())];
      const int c = cell_of[to_size(face)];
      if (c < 0) continue;
      CellPatch& patch = result[to_size(c)];
      patch.semi_sharp = topology.is_near_semi_sharp(face);
      const bool exact = param.IsRegular() && !patch.semi_sharp;
      patch.kind = exact ? CellPatch::Kind::regular : CellPatch::Kind::cap;
      patch.smooth = topology.smooth_sides(face);
      const auto vertices = table->GetPatchVertices(array, i);
      if (topology.scheme == CageScheme::catmark) {
        std::array<dvec3, 16> net;
        for (int k = 0; k < 16; ++k) {
          net[to_size(k)] = vertices[k] < 0 ? dvec3(0.0) : points[to_size(vertices[k])].x;
        }
        patch.points = bezier_net(net, param.GetBoundary());
        continue;
      }
      if (vertices.size() == gregory_points) {
        std::array<dvec3, gregory_points> net;
        for (int k = 0; k < gregory_points; ++k) net[to_size(k)] = points[to_size(vertices[k])].x;
        patch.points = quartic_of_gregory(net, topology.regular_corners(face));
        patch.degree = 4;
        continue;
      }
      const Far::PatchTable::PatchHandle handle{array, i, i * loop_points};
      auto known = loop_matrices.find(param.GetBoundary());
      if (known == loop_matrices.end()) {
        known = loop_matrices.emplace(param.GetBoundary(), loop_to_bezier(*table, handle)).first;
      }
      patch.points.assign(quartic_points, dvec3(0.0));
      patch.degree = 4;
      for (int r = 0; r < quartic_points; ++r) {
        for (int k = 0; k < loop_points; ++k) {
          patch.points[to_size(r)] += known->second(r, k) * points[to_size(vertices[k])].x;
        }
      }
    }
  }
  return result;
}

void CageLevel::enclosure(std::size_t cell, std::vector<dvec3>& points) const {
  const Far::TopologyLevel base = topology_->level();
  points.clear();
  const std::vector<int> faces = with_surroundings(base, {cells_[cell].face});
  for (const int f : faces) {
    const auto vertices = base.GetFaceVertices(f);
    for (int k = 0; k < vertices.size(); ++k)
      points.push_back(topology_->points[to_size(vertices[k])]);
  }
}

std::span<const int> CageLevel::vertices(std::size_t cell) const {
  const auto vertices = topology_->level().GetFaceVertices(cells_[cell].face);
  return {vertices.begin(), to_size(vertices.size())};
}

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
  Extraction cut(base);
  for (std::size_t i = 0; i < faces.size(); ++i) cut.add_face(faces[i], i >= own);
  const Description description = cut.take();
  const std::unique_ptr<Far::TopologyRefiner> refiner =
      make_refiner(description, topology.scheme, topology.options);
  Far::TopologyRefiner::UniformOptions uniform(1);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  std::vector<Primvar> coarse(cut.originals().size());
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    coarse[i].x = topology.points[to_size(cut.originals()[i])];
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
  Extraction part(fine);
  for (std::size_t i = 0; i < child_faces.size(); ++i) {
    part.add_face(child_faces[i], i >= own_children);
  }
  const Description child_description = part.take();
  next.topology_->scheme = topology.scheme;
  next.topology_->options = topology.options;
  next.topology_->points.reserve(part.originals().size());
  for (const int v : part.originals()) {
    next.topology_->points.push_back(children[to_size(v)].x);
  }
  std::vector<int> coarse_numbers;
  coarse_numbers.reserve(cut.originals().size());
  for (const int v : cut.originals()) coarse_numbers.push_back(topology.numbers[to_size(v)]);
  const std::vector<int> numbers = child_numbers(parents, fine.GetNumVertices(), topology.scheme,
                                                 to_int(own), coarse_numbers, middles);
  next.topology_->numbers.reserve(part.originals().size());
  for (const int v : part.originals()) next.topology_->numbers.push_back(numbers[to_size(v)]);
  next.topology_->build(child_description);
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
