#include "cages.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/subdivision/add_cage.h"

namespace taut_test {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

constexpr double turn = 2 * std::numbers::pi;

struct Primvar {
  dvec3 x = dvec3(0.0);
  void Clear(void* = nullptr) { x = dvec3(0.0); }
  void AddWithWeight(const Primvar& other, double weight) { x += weight * other.x; }
};

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
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  const auto scheme = cage.scheme == CageScheme::loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
  return std::unique_ptr<Far::TopologyRefiner>(
      Factory::Create(d, Factory::Options(scheme, options)));
}

}  // namespace

ControlCage cube_cage() {
  ControlCage cage;
  for (int k = 0; k < 8; ++k) {
    cage.points.emplace_back((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
  }
  cage.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return cage;
}

ControlCage tetrahedron_cage(CageScheme scheme) {
  ControlCage cage;
  cage.scheme = scheme;
  cage.points = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
  cage.faces = {{0, 1, 3}, {0, 3, 2}, {0, 2, 1}, {1, 2, 3}};
  return cage;
}

ControlCage torus_cage(int m, int n) {
  ControlCage cage;
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      const double a = turn * i / m;
      const double b = turn * j / n;
      const double r = 2 + 0.8 * std::cos(b);
      cage.points.emplace_back(r * std::cos(a), r * std::sin(a), 0.8 * std::sin(b));
    }
  }
  const auto at = [&](int i, int j) { return i % m * n + j % n; };
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      cage.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return cage;
}

ControlCage triangle_torus_cage(int m, int n) {
  ControlCage cage = torus_cage(m, n);
  cage.scheme = CageScheme::loop;
  std::vector<std::vector<int>> triangles;
  for (const auto& f : cage.faces) {
    triangles.push_back({f[0], f[1], f[2]});
    triangles.push_back({f[0], f[2], f[3]});
  }
  cage.faces = triangles;
  return cage;
}

ControlCage dome_cage(CageScheme scheme, int valence) {
  ControlCage cage;
  cage.scheme = scheme;
  const bool quads = scheme == CageScheme::catmark;
  const int ring = quads ? 2 * valence : valence;
  cage.points = {{0.05, 0.03, 1.1}, {-0.02, 0.04, -1.2}};
  for (const double z : {0.6, -0.6}) {
    for (int i = 0; i < ring; ++i) {
      const double a = turn * i / ring;
      // The corners of the top's quads lie farther out.
      const double r = quads && i % 2 == 1 ? 1.1 : 1;
      cage.points.emplace_back(1.2 * r * std::cos(a), r * std::sin(a), z + 0.04 * std::cos(a));
    }
  }
  const auto upper = [&](int i) { return 2 + i % ring; };
  const auto lower = [&](int i) { return 2 + ring + i % ring; };
  for (int i = 0; i < ring; ++i) {
    if (quads) {
      cage.faces.push_back({upper(i), lower(i), lower(i + 1), upper(i + 1)});
      if (i % 2 != 0) continue;
      cage.faces.push_back({0, upper(i), upper(i + 1), upper(i + 2)});
      cage.faces.push_back({1, lower(i + 2), lower(i + 1), lower(i)});
    } else {
      cage.faces.push_back({upper(i), lower(i), lower(i + 1)});
      cage.faces.push_back({upper(i), lower(i + 1), upper(i + 1)});
      cage.faces.push_back({0, upper(i), upper(i + 1)});
      cage.faces.push_back({1, lower(i + 1), lower(i)});
    }
  }
  for (dvec3& p : cage.points) p = skew_rotation() * p;
  return cage;
}

ControlCage sheet_cage(int m, int n) {
  ControlCage cage;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = 2.0 * i / m - 1;
      const double y = 2.0 * j / n - 1;
      cage.points.emplace_back(x, y, 0.6 - 0.3 * x * x - 0.4 * y * y + 0.1 * x * y);
    }
  }
  const auto at = [&](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < n; ++j) {
      cage.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return cage;
}

std::vector<LimitPoint> limit_points(const ControlCage& cage, int levels) {
  const std::unique_ptr<Far::TopologyRefiner> refiner = refiner_of(cage);
  Far::TopologyRefiner::UniformOptions uniform(levels);
  uniform.fullTopologyInLastLevel = true;
  refiner->RefineUniform(uniform);
  const Far::PrimvarRefinerReal<double> interpolate(*refiner);
  std::vector<Primvar> points(cage.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].x = cage.points[i];
  for (int level = 1; level <= levels; ++level) {
    std::vector<Primvar> next(std::size_t(refiner->GetLevel(level).GetNumVertices()));
    interpolate.Interpolate(level, points, next);
    points = std::move(next);
  }
  std::vector<Primvar> x(points.size());
  std::vector<Primvar> du(points.size());
  std::vector<Primvar> dv(points.size());
  interpolate.Limit(points, x, du, dv);
  const Far::TopologyLevel finest = refiner->GetLevel(levels);
  std::vector<LimitPoint> result;
  for (int v = 0; v < finest.GetNumVertices(); ++v) {
    const auto faces = finest.GetVertexFaces(v);
    bool used = false;
    for (int k = 0; k < faces.size(); ++k) used = used || !finest.IsFaceHole(faces[k]);
    const auto i = std::size_t(v);
    if (used) result.push_back({x[i].x, taut::unit(glm::cross(du[i].x, dv[i].x))});
  }
  return result;
}

taut::Model cage_model(const ControlCage& cage, double accuracy) {
  taut::Part part;
  taut::add_cage(part, cage, "cage", {accuracy, {}});
  taut::Model model;
  model.add_part(std::move(part), taut::smooth_join_angle);
  return model;
}

}  // namespace taut_test
