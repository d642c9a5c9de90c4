#include "refined_cage.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

namespace taut_test {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

using taut::CageBoundary;
using taut::CageScheme;

struct Primvar {
  dvec3 x = dvec3(0.0);
  // NOLINTBEGIN(readability-identifier-naming): the names are OpenSubdiv's
  void Clear(void* = nullptr) { x = dvec3(0.0); }
  void AddWithWeight(const Primvar& other, double weight) { x += weight * other.x; }
  // NOLINTEND(readability-identifier-naming)
};

Sdc::Options options_of(const ControlCage& cage) {
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(
      cage.boundary == CageBoundary::none        ? Sdc::Options::VTX_BOUNDARY_NONE
      : cage.boundary == CageBoundary::edge_only ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                                 : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetCreasingMethod(cage.chaikin ? Sdc::Options::CREASE_CHAIKIN
                                         : Sdc::Options::CREASE_UNIFORM);
  options.SetTriangleSubdivision(cage.smooth_triangles ? Sdc::Options::TRI_SUB_SMOOTH
                                                       : Sdc::Options::TRI_SUB_CATMARK);
  return options;
}

/// Faces whose surface counts.
std::vector<int> solid_faces(const Far::TopologyLevel& level) {
  std::vector<int> faces;
  for (int f = 0; f < level.GetNumFaces(); ++f) {
    if (!level.IsFaceHole(f)) faces.push_back(f);
  }
  return faces;
}

}  // namespace

std::unique_ptr<Far::TopologyRefiner> refiner_of(const ControlCage& cage) {
  std::vector<int> sizes;
  std::vector<int> vertices;
  for (const auto& face : cage.faces) {
    sizes.push_back(int(face.size()));
    vertices.insert(vertices.end(), face.begin(), face.end());
  }
  std::vector<int> creases;
  std::vector<float> crease_weights;
  for (const auto& crease : cage.creases) {
    creases.insert(creases.end(), crease.vertices.begin(), crease.vertices.end());
    crease_weights.push_back(float(crease.sharpness));
  }
  std::vector<int> corners;
  std::vector<float> corner_weights;
  for (const auto& corner : cage.corners) {
    corners.push_back(corner.vertex);
    corner_weights.push_back(float(corner.sharpness));
  }
  Far::TopologyDescriptor d;
  d.numVertices = int(cage.points.size());
  d.numFaces = int(sizes.size());
  d.numVertsPerFace = sizes.data();
  d.vertIndicesPerFace = vertices.data();
  d.numCreases = int(crease_weights.size());
  d.creaseVertexIndexPairs = creases.data();
  d.creaseWeights = crease_weights.data();
  d.numCorners = int(corner_weights.size());
  d.cornerVertexIndices = corners.data();
  d.cornerWeights = corner_weights.data();
  d.numHoles = int(cage.holes.size());
  d.holeIndices = cage.holes.data();
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  const auto scheme = cage.scheme == CageScheme::loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(d, Factory::Options(scheme, options_of(cage))));
  if (!refiner) throw std::runtime_error("OpenSubdiv does not take the cage");
  return refiner;
}

RefinedCage::RefinedCage(const ControlCage& cage, int levels)
    : refiner_(refiner_of(cage)), level_(levels) {
  rules_.scheme = cage.scheme;
  rules_.boundary = cage.boundary;
  rules_.chaikin = cage.chaikin;
  rules_.smooth_triangles = cage.smooth_triangles;
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = true;
  refiner_->RefineUniform(uniform);
  const Far::PrimvarRefinerReal<double> interpolate(*refiner_);
  std::vector<Primvar> points(cage.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].x = cage.points[i];
  for (int k = 1; k <= levels; ++k) {
    std::vector<Primvar> next(std::size_t(refiner_->GetLevel(k).GetNumVertices()));
    interpolate.Interpolate(k, points, next);
    points = std::move(next);
  }
  for (const Primvar& p : points) points_.push_back(p.x);
  faces_ = solid_faces(level());
}

bool RefinedCage::has_simple_edges() const {
  const Far::TopologyLevel topology = level();
  std::set<std::pair<int, int>> known;
  for (int e = 0; e < topology.GetNumEdges(); ++e) {
    const auto ends = topology.GetEdgeVertices(e);
    if (!known.insert(std::minmax({int(ends[0]), int(ends[1])})).second) return false;
  }
  return true;
}

bool RefinedCage::has_limit(int vertex) const {
  const Far::TopologyLevel topology = level();
  if (topology.IsVertexSemiSharp(vertex)) return false;
  const auto edges = topology.GetVertexEdges(vertex);
  int sharp = 0;
  for (int k = 0; k < edges.size(); ++k) {
    if (topology.IsEdgeSemiSharp(edges[k])) return false;
    if (topology.IsEdgeInfSharp(edges[k])) ++sharp;
  }
  if (topology.IsVertexInfSharp(vertex)) return true;
  const bool between_two_faces = edges.size() == 2 && topology.GetVertexFaces(vertex).size() == 2;
  const bool wrong_mask = rules_.scheme == CageScheme::catmark && between_two_faces && sharp == 0;
  return sharp != 1 && !wrong_mask;
}

std::vector<LimitPoint> RefinedCage::limits() const {
  std::vector<Primvar> points(points_.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].x = points_[i];
  std::vector<Primvar> x(points.size());
  std::vector<Primvar> du(points.size());
  std::vector<Primvar> dv(points.size());
  Far::PrimvarRefinerReal<double>(*refiner_).Limit(points, x, du, dv);
  std::vector<LimitPoint> result(points.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = {x[i].x, taut::unit(glm::cross(du[i].x, dv[i].x))};
  }
  return result;
}

/// The faces and, behind them as holes, all others that touch them. Its tags say what the rules of
/// the boundary have made of it.
ControlCage RefinedCage::cut(const std::vector<int>& faces) const {
  const Far::TopologyLevel topology = level();
  ControlCage out = rules_;
  out.boundary = CageBoundary::edge_only;
  std::vector<int> number(points_.size(), -1);
  std::vector<int> vertices;
  std::vector<int> edges;
  std::vector<bool> taken(std::size_t(topology.GetNumFaces()));
  const auto add = [&](int face) {
    if (taken[std::size_t(face)]) return false;
    taken[std::size_t(face)] = true;
    std::vector<int>& corners = out.faces.emplace_back();
    const auto own_vertices = topology.GetFaceVertices(face);
    const auto own_edges = topology.GetFaceEdges(face);
    for (int k = 0; k < own_vertices.size(); ++k) {
      int& n = number[std::size_t(own_vertices[k])];
      if (n < 0) {
        n = int(vertices.size());
        vertices.push_back(own_vertices[k]);
        out.points.push_back(points_[std::size_t(own_vertices[k])]);
      }
      corners.push_back(n);
      edges.push_back(own_edges[k]);
    }
    return true;
  };
  for (const int f : faces) add(f);
  const std::size_t own_vertices = vertices.size();
  for (std::size_t i = 0; i < own_vertices; ++i) {
    const auto around = topology.GetVertexFaces(vertices[i]);
    for (int k = 0; k < around.size(); ++k) {
      if (add(around[k])) out.holes.push_back(int(out.faces.size()) - 1);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const int e : edges) {
    const double sharpness = topology.GetEdgeSharpness(e);
    if (sharpness <= 0) continue;
    const auto ends = topology.GetEdgeVertices(e);
    out.creases.push_back(
        {{number[std::size_t(ends[0])], number[std::size_t(ends[1])]}, sharpness});
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const bool sharp = topology.IsVertexNonManifold(vertices[i]) &&
                       topology.GetVertexRule(vertices[i]) == Sdc::Crease::RULE_CORNER;
    const double sharpness =
        sharp ? taut::infinite_sharpness : topology.GetVertexSharpness(vertices[i]);
    if (sharpness > 0) out.corners.push_back({int(i), sharpness});
  }
  return out;
}

RefinedCage RefinedCage::refined(const std::vector<int>& faces) const {
  return RefinedCage(cut(faces), 1);
}

std::vector<LimitPoint> limit_points(const ControlCage& cage, int levels) {
  const RefinedCage refined(cage, levels);
  const std::vector<LimitPoint> limits = refined.limits();
  std::vector<bool> used(limits.size());
  for (const int f : refined.faces()) {
    const auto corners = refined.level().GetFaceVertices(f);
    for (int k = 0; k < corners.size(); ++k) used[std::size_t(corners[k])] = true;
  }
  std::vector<LimitPoint> result;
  for (std::size_t v = 0; v < limits.size(); ++v) {
    if (used[v]) result.push_back(limits[v]);
  }
  return result;
}

}  // namespace taut_test
