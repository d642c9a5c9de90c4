// Writers of hull meshes: PLY, OBJ, OFF, STL.

#include "taut/io/mesh/write_mesh.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <vector>

#include "taut/core/error.h"
#include "taut/core/predicates.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/io/mesh/read_mesh.h"
#include "taut/verify/verify.h"
#include "temporary_folder.h"

namespace {

using taut::dvec3;
using taut::FaceKind;
using taut::HullMesh;
using taut::IoError;
using taut::PolygonMesh;
using taut_test::content;
using taut_test::message_of;

using Polygons = std::vector<std::vector<int>>;

HullMesh mesh_of(const std::vector<dvec3>& points, const Polygons& polygons) {
  HullMesh mesh;
  std::vector<OpenMesh::VertexHandle> handles;
  for (const dvec3& p : points) handles.push_back(mesh.add_vertex({p.x, p.y, p.z}));
  for (const auto& polygon : polygons) {
    std::vector<OpenMesh::VertexHandle> corners;
    for (const int i : polygon) corners.push_back(handles[static_cast<std::size_t>(i)]);
    EXPECT_TRUE(mesh.add_face(corners).is_valid());
  }
  return mesh;
}

/// A box whose coordinates need every bit of a double, with all that a hull mesh can carry.
HullMesh box() {
  const double a = 1.0 / 3, b = 0.1, c = -std::numbers::pi;
  std::vector<dvec3> points;
  for (int i = 0; i < 8; ++i) {
    points.emplace_back((i & 1) != 0 ? a : -b, (i & 2) != 0 ? b : -a, (i & 4) != 0 ? -c : c);
  }
  HullMesh mesh = mesh_of(
      points, {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
  for (const auto v : mesh.vertices()) {
    const int i = v.idx();
    mesh.data(v).source = i - 1;
    mesh.data(v).u = i / 7.0;
    mesh.data(v).v = -i / 11.0;
    mesh.data(v).quality = static_cast<float>(i) / 13;
    mesh.set_normal(v, {i / 17.0, 0.5, -1});
  }
  const FaceKind kinds[] = {FaceKind::patch, FaceKind::scroll, FaceKind::facet};
  for (const auto f : mesh.faces()) {
    mesh.data(f).kind = kinds[f.idx() % 3];
    mesh.data(f).source = f.idx() % 3 == 0 ? f.idx() : -1;
    mesh.data(f).hull_face = 5 - f.idx();
  }
  return mesh;
}

/// A prism over a regular polygon.
HullMesh prism(int corners) {
  std::vector<dvec3> points;
  std::vector<int> bottom, top;
  Polygons polygons;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
    points.emplace_back(std::cos(angle), std::sin(angle), 1);
    bottom.insert(bottom.begin(), 2 * i);
    top.push_back(2 * i + 1);
    const int next = (i + 1) % corners;
    polygons.push_back({2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
  }
  polygons.push_back(bottom);
  polygons.push_back(top);
  HullMesh mesh = mesh_of(points, polygons);
  for (const auto f : mesh.faces()) mesh.data(f).hull_face = f.idx();
  return mesh;
}

/// The pyramid over a square whose sides have `inner` further vertices each, all exactly on them,
/// as are its other faces'.
HullMesh pyramid_with_collinear_vertices(int inner) {
  const int n = inner + 1;
  const int corners[4][2] = {{0, 0}, {n, 0}, {n, n}, {0, n}};
  std::vector<dvec3> points;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < n; ++i) {
      const int* a = corners[side];
      const int* b = corners[(side + 1) % 4];
      points.emplace_back(a[0] + (b[0] - a[0]) * i / n, a[1] + (b[1] - a[1]) * i / n, 0);
    }
  }
  const int apex = 4 * n;
  points.emplace_back(1, 1, 2);
  Polygons polygons(5);
  for (int i = 4 * n; i-- > 0;) polygons[4].push_back(i);
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i <= n; ++i) {
      polygons[static_cast<std::size_t>(side)].push_back((side * n + i) % (4 * n));
    }
    polygons[static_cast<std::size_t>(side)].push_back(apex);
  }
  return mesh_of(points, polygons);
}

std::vector<dvec3> points_of(const HullMesh& mesh) {
  std::vector<dvec3> points;
  for (const auto v : mesh.vertices()) points.push_back(taut::position(mesh, v));
  return points;
}

Polygons polygons_of(const HullMesh& mesh) {
  Polygons polygons;
  for (const auto f : mesh.faces()) {
    polygons.emplace_back();
    for (const auto v : mesh.fv_ccw_range(f)) polygons.back().push_back(v.idx());
  }
  return polygons;
}

/// Every edge is run through once in each direction.
bool is_closed(const PolygonMesh& mesh) {
  std::map<std::pair<int, int>, int> uses;
  for (const auto& polygon : mesh.polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      ++uses[{polygon[i], polygon[(i + 1) % polygon.size()]}];
    }
  }
  return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    return use.second == 1 && uses.contains({use.first.second, use.first.first});
  });
}

double volume(const PolygonMesh& mesh) {
  double sum = 0;
  for (const auto& p : mesh.polygons) {
    const auto at = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(p[i])]; };
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      sum += glm::dot(at(0), glm::cross(at(i), at(i + 1))) / 6;
    }
  }
  return sum;
}

bool has_area(const PolygonMesh& mesh, const std::vector<int>& p) {
  const auto at = [&](std::size_t i) { return mesh.points[static_cast<std::size_t>(p[i])]; };
  for (std::size_t i = 2; i < p.size(); ++i) {
    if (!taut::collinear(at(0), at(1), at(i))) return true;
  }
  return false;
}

class WriteMesh : public taut_test::TemporaryFolder {
 protected:
  PolygonMesh round_trip(const std::string& name, const HullMesh& mesh) const {
    taut::write_mesh(path(name), mesh);
    return taut::read_mesh(path(name));
  }
};

const std::vector<std::string> exact_formats = {"a.ply", "a.obj", "a.off"};
const std::vector<std::string> all_formats = {"a.ply", "a.obj", "a.off", "a.stl"};

TEST_F(WriteMesh, RoundTripsEveryBit) {
  const HullMesh mesh = box();
  for (const std::string& name : exact_formats) {
    const PolygonMesh read = round_trip(name, mesh);
    EXPECT_EQ(read.points, points_of(mesh)) << name;
    Polygons expected = polygons_of(mesh);
    // OBJ orders by hull face, which falls from face to face here.
    if (name == "a.obj") std::reverse(expected.begin(), expected.end());
    EXPECT_EQ(read.polygons, expected) << name;
  }
}

TEST_F(WriteMesh, RoundTripsExtremeNumbers) {
  const std::vector<dvec3> points = {{5e-324, -0.0, 1.7976931348623157e308},
                                     {1e22, -2.2250738585072014e-308, 123456789.12345679},
                                     {0.1 + 0.2, 1.0 / 3, -1e-5},
                                     {1e-300, -1e300, 2.2250738585072009e-308}};
  const HullMesh mesh = mesh_of(points, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {3, 2, 1}});
  for (const std::string& name : exact_formats) {
    const PolygonMesh read = round_trip(name, mesh);
    ASSERT_EQ(read.points.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(read.points[i][k]),
                  std::bit_cast<std::uint64_t>(points[i][k]))
            << name;
      }
    }
  }
}

TEST_F(WriteMesh, ClosedMeshesStayClosed) {
  for (const HullMesh& mesh :
       {box(), prism(3), prism(255), prism(256), prism(1000), pyramid_with_collinear_vertices(2)}) {
    const PolygonMesh original = {points_of(mesh), polygons_of(mesh)};
    ASSERT_TRUE(is_closed(original));
    for (const std::string& name : all_formats) {
      const PolygonMesh read = round_trip(name, mesh);
      EXPECT_TRUE(is_closed(read)) << name;
      EXPECT_TRUE(name == "a.stl" || read.points.size() == original.points.size()) << name;
      EXPECT_NEAR(volume(read), volume(original), 1e-6 * volume(original)) << name;
    }
  }
}

TEST_F(WriteMesh, LargePolygonsAreSplit) {
  for (const int corners : {255, 256, 257, 509, 5000}) {
    const HullMesh mesh = prism(corners);
    for (const std::string& name : exact_formats) {
      const PolygonMesh read = round_trip(name, mesh);
      EXPECT_EQ(read.points, points_of(mesh)) << name;
      EXPECT_EQ(read.polygons.size() == mesh.n_faces(), corners <= 255);
      std::size_t total = 0;
      for (const auto& polygon : read.polygons) {
        EXPECT_LE(polygon.size(), 255U);
        EXPECT_TRUE(has_area(read, polygon));
        total += polygon.size();
      }
      // Every diagonal adds one polygon and two corners.
      EXPECT_EQ(total - 2 * (read.polygons.size() - mesh.n_faces()),
                6 * static_cast<std::size_t>(corners));
    }
  }
}

TEST_F(WriteMesh, PiecesOfSplitPolygonsAreConvex) {
  const PolygonMesh read = round_trip("a.off", prism(1000));
  for (const auto& p : read.polygons) {
    const auto at = [&](std::size_t i) {
      return read.points[static_cast<std::size_t>(p[i % p.size()])];
    };
    if (at(0).z != at(1).z || at(1).z != at(2).z) continue;  // a side
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double turn = glm::cross(at(i + 1) - at(i), at(i + 2) - at(i + 1)).z;
      EXPECT_GT(at(0).z == 1 ? turn : -turn, 0);
    }
  }
}

TEST_F(WriteMesh, SplittingMakesNoFlatPieces) {
  for (const int inner : {1, 2, 3, 7, 100}) {
    const HullMesh mesh = pyramid_with_collinear_vertices(inner);
    for (const std::string& name : all_formats) {
      const PolygonMesh read = round_trip(name, mesh);
      for (const auto& polygon : read.polygons) EXPECT_TRUE(has_area(read, polygon)) << name;
    }
  }
}

// ---------------------------------------------------------------- dimensions below 3

taut::Model model_of(const std::vector<dvec3>& points) {
  taut::Model model;
  taut::Part part;
  part.add_points(points);
  model.add_instance(model.add_part(std::move(part), taut::smooth_join_angle), {});
  return model;
}

HullMesh hull_of(const std::vector<dvec3>& points) {
  return taut::convex_hull(model_of(points)).mesh;
}

std::vector<dvec3> circle(int corners) {
  std::vector<dvec3> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    points.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  return points;
}

const std::vector<dvec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

void expect_perfect(const PolygonMesh& mesh, const std::vector<dvec3>& points, double tolerance,
                    const std::string& name) {
  const taut::Scene scene(model_of(points));
  const taut::Verification found = taut::verify(mesh, scene);
  EXPECT_TRUE(found.closed && found.manifold && found.oriented && found.topological_sphere) << name;
  EXPECT_TRUE(found.no_zero_area) << name;
  EXPECT_TRUE(found.convex) << name;
  // What verify() measures is rounded itself.
  const double slack = taut::support_slack * scene.diagonal();
  EXPECT_LE(found.model_outside, tolerance + slack) << name;
  EXPECT_LE(found.mesh_outside, tolerance + slack) << name;
}

TEST_F(WriteMesh, LowerDimensionsAreVerifiedHulls) {
  const std::vector<std::vector<dvec3>> models = {{{0.1, 2, 3}},
                                                  {{0, 0.1, 0}, {1, 1, 1}},
                                                  {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                                  square,
                                                  circle(8),
                                                  circle(256),
                                                  circle(1000)};
  for (const auto& points : models) {
    const HullMesh mesh = hull_of(points);
    for (const std::string& name : exact_formats) {
      const PolygonMesh read = round_trip(name, mesh);
      EXPECT_EQ(read.points, points_of(mesh)) << name;
      expect_perfect(read, points, 0, name);
    }
  }
}

/// Half a unit in the last place of floats, and of nothing else.
TEST_F(WriteMesh, RoundingOfFloatsIsKnownExactly) {
  const auto rounding = [](const dvec3& p) { return taut::float_rounding(std::vector<dvec3>{p}); };
  EXPECT_EQ(rounding({1e6, 0.1, 0.1}), 0.03125);
  EXPECT_EQ(rounding({-1048576, 0.1, 0.1}), 0.0625);
  EXPECT_EQ(rounding({0.1, 0.1, 0.1}), 0);
  EXPECT_EQ(rounding({1e300, -1e300, 0.1}), 0);
  EXPECT_EQ(rounding({0, 0.1, 0.1}), std::numeric_limits<float>::denorm_min() / 2.0);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> size(-40, 40), share(-1, 1);
  for (int k = 0; k < 10'000; ++k) {
    const double scale = std::exp2(size(random));
    const dvec3 p = scale * dvec3(share(random), share(random), share(random));
    const dvec3 rounded = dvec3(glm::vec3(p));
    const double bound = rounding(rounded);
    EXPECT_LE(glm::distance(p, rounded), bound * (1 + 1e-9));
    taut::Box about;
    about.include(rounded);
    EXPECT_LE(bound, taut::float_rounding_bound(about));
  }
}

TEST_F(WriteMesh, SegmentsHaveAnEdge) {
  const HullMesh segment = hull_of({{0, 0, 0}, {1, 0.5, 0}, {2, 1, 0}});
  for (const std::string& name : exact_formats) taut::write_mesh(path(name), segment);
  EXPECT_EQ(content(path("a.obj")), "# Convex hull by Taut\nv 0 0 0\nv 2 1 0\nl 1 2\n");
  EXPECT_EQ(content(path("a.off")), "OFF\n2 0 1\n0 0 0\n2 1 0\n");
  const std::string ply = content(path("a.ply"));
  EXPECT_NE(ply.find("element face 0\n"), ply.npos);
  EXPECT_NE(ply.find("element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"),
            ply.npos);
  EXPECT_TRUE(ply.ends_with(std::string("\0\0\0\0\1\0\0\0", 8)));
  EXPECT_EQ(file_count(), 3U) << "no faces, no materials";
}

TEST_F(WriteMesh, PointsAreVertices) {
  const HullMesh point = hull_of({{1, 2, 3}, {1, 2, 3}});
  for (const std::string& name : exact_formats) taut::write_mesh(path(name), point);
  EXPECT_EQ(content(path("a.obj")), "# Convex hull by Taut\nv 1 2 3\np 1\n");
  EXPECT_EQ(content(path("a.off")), "OFF\n1 0 0\n1 2 3\n");
  const std::string ply = content(path("a.ply"));
  EXPECT_NE(ply.find("element vertex 1\n"), ply.npos);
  EXPECT_EQ(ply.find("element edge"), ply.npos);
}

TEST_F(WriteMesh, HullsKeepTheirExtremePointsToTheLastBit) {
  const std::vector<dvec3> points = {
      {0.1 + 0.2, 0, 0}, {-1.0 / 3, 1e-300, 0}, {0, std::numbers::e, 5e-324}, {0, 0, 2.0 / 3}};
  for (const std::string& name : exact_formats) {
    std::vector<dvec3> left = points;
    for (const dvec3& p : round_trip(name, hull_of(points)).points) {
      std::erase_if(left, [&](const dvec3& q) {
        using Bits = std::array<std::uint64_t, 3>;
        return std::bit_cast<Bits>(p) == std::bit_cast<Bits>(q);
      });
    }
    EXPECT_TRUE(left.empty()) << name;
  }
}

// ---------------------------------------------------------------- to memory

TEST_F(WriteMesh, MemoryHoldsTheSameBytes) {
  for (const HullMesh& mesh : {box(), prism(20'000)}) {
    for (const char* format : {".ply", ".off", ".stl"}) {
      const double rounding = taut::write_mesh(path(std::string("a") + format), mesh).rounding;
      std::string data = "before";
      EXPECT_EQ(taut::write_mesh(data, "-", format, mesh).rounding, rounding);
      EXPECT_EQ(data, "before" + content(path(std::string("a") + format)));
    }
  }
}

TEST_F(WriteMesh, ObjInMemoryIsWithoutMaterials) {
  std::string data;
  taut::write_mesh(data, "-", ".obj", box());
  EXPECT_EQ(data.find("mtl"), data.npos) << data;
  EXPECT_EQ(taut::read_mesh(data, "-", ".obj").points, points_of(box()));
}

TEST_F(WriteMesh, MemoryIsUntouchedByFailures) {
  std::string data = "before";
  EXPECT_EQ(message_of<IoError>([&] { taut::write_mesh(data, "standard output", "", box()); }),
            "standard output: no format of meshes has the extension \"\"; known are .obj, .off, "
            ".ply, .stl");
  EXPECT_THROW(taut::write_mesh(data, "-", ".stl", hull_of({{0, 0, 0}})), IoError);
  EXPECT_EQ(data, "before");
}

// ---------------------------------------------------------------- PLY

/// Takes little-endian numbers from a text.
class Bytes {
 public:
  explicit Bytes(std::string text) : text_(std::move(text)) {}
  template <class Number>
  Number next() {
    std::array<char, sizeof(Number)> bytes;
    for (char& byte : bytes) byte = text_.at(at_++);
    if (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<Number>(bytes);
  }
  bool at_end() const { return at_ == text_.size(); }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

TEST_F(WriteMesh, PlyHasTheRecordsOfTheContract) {
  const HullMesh mesh = box();
  taut::write_mesh(path("a.ply"), mesh);
  const std::string text = content(path("a.ply"));
  const std::size_t end = text.find("end_header\n") + 11;
  std::string header;
  std::istringstream lines(text.substr(0, end));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("comment")) header += line + "\n";
  }
  EXPECT_EQ(header,
            "ply\nformat binary_little_endian 1.0\nelement vertex 8\n"
            "property double x\nproperty double y\nproperty double z\n"
            "property double nx\nproperty double ny\nproperty double nz\n"
            "property float quality\nproperty double u\nproperty double v\nproperty int source\n"
            "element face 6\nproperty list uchar int vertex_indices\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property uchar kind\nproperty int source\nproperty int hull_face\nend_header\n");

  Bytes bytes(text.substr(end));
  for (const auto v : mesh.vertices()) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(bytes.next<double>(), taut::position(mesh, v)[i]);
    for (const double n : mesh.normal(v)) EXPECT_EQ(bytes.next<double>(), n);
    EXPECT_EQ(bytes.next<float>(), mesh.data(v).quality);
    EXPECT_EQ(bytes.next<double>(), mesh.data(v).u);
    EXPECT_EQ(bytes.next<double>(), mesh.data(v).v);
    EXPECT_EQ(bytes.next<std::int32_t>(), mesh.data(v).source);
  }
  std::set<std::array<int, 3>> colors;
  for (const auto f : mesh.faces()) {
    EXPECT_EQ(bytes.next<std::uint8_t>(), 4);
    for (const auto v : mesh.fv_ccw_range(f)) EXPECT_EQ(bytes.next<std::int32_t>(), v.idx());
    std::array<int, 3> color;
    for (int& c : color) c = bytes.next<std::uint8_t>();
    colors.insert(color);
    EXPECT_EQ(bytes.next<std::uint8_t>(), static_cast<int>(mesh.data(f).kind));
    EXPECT_EQ(bytes.next<std::int32_t>(), mesh.data(f).source);
    EXPECT_EQ(bytes.next<std::int32_t>(), mesh.data(f).hull_face);
  }
  EXPECT_TRUE(bytes.at_end());
  // Patches of the sources 0 and 3, a scroll, a facet.
  EXPECT_EQ(colors.size(), 4U);
}

TEST_F(WriteMesh, SameBytesEveryTime) {
  for (const std::string& name : all_formats) {
    taut::write_mesh(path(name), box());
    const std::string first = content(path(name));
    taut::write_mesh(path(name), box());
    EXPECT_EQ(content(path(name)), first);
  }
}

// ---------------------------------------------------------------- OBJ

TEST_F(WriteMesh, ObjGroupsByHullFace) {
  HullMesh mesh = box();
  for (const auto f : mesh.faces()) mesh.data(f).hull_face = f.idx() % 3;
  taut::write_mesh(path("hull.v1.obj"), mesh);
  EXPECT_EQ(file_count(), 2U);
  std::istringstream lines(content(path("hull.v1.obj")));
  std::string structure;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("mtllib") || line.starts_with("g ") || line.starts_with("usemtl")) {
      structure += line + "\n";
    } else if (line.starts_with("f ")) {
      structure += "f\n";
    }
  }
  EXPECT_EQ(structure,
            "mtllib hull.v1.mtl\n"
            "g face_0\nusemtl patch_0\nf\nusemtl patch_3\nf\n"
            "g face_1\nusemtl scroll\nf\nf\n"
            "g face_2\nusemtl facet\nf\nf\n");
}

TEST_F(WriteMesh, ObjMaterialsAreAllThere) {
  taut::write_mesh(path("hull.obj"), box());
  std::set<std::string> used, defined;
  std::istringstream obj(content(path("hull.obj"))), mtl(content(path("hull.mtl")));
  for (std::string line; std::getline(obj, line);) {
    if (line.starts_with("usemtl ")) used.insert(line.substr(7));
  }
  for (std::string line; std::getline(mtl, line);) {
    if (line.starts_with("newmtl ")) defined.insert(line.substr(7));
    if (!line.starts_with("Kd ")) continue;
    std::istringstream numbers(line.substr(3));
    double r = -1, g = -1, b = -1;
    numbers >> r >> g >> b;
    for (const double c : {r, g, b}) EXPECT_TRUE(0 <= c && c <= 1) << line;
  }
  EXPECT_EQ(used, defined);
  EXPECT_EQ(used, (std::set<std::string>{"facet", "patch_0", "patch_3", "scroll"}));
}

// ---------------------------------------------------------------- OFF, STL

TEST_F(WriteMesh, OffCountsItsEdges) {
  for (const int corners : {4, 300}) {
    const HullMesh mesh = prism(corners);
    const PolygonMesh read = round_trip("a.off", mesh);
    std::istringstream lines(content(path("a.off")));
    std::string keyword;
    std::size_t vertices = 0, faces = 0, edges = 0;
    lines >> keyword >> vertices >> faces >> edges;
    EXPECT_EQ(keyword, "OFF");
    EXPECT_EQ(vertices, read.points.size());
    EXPECT_EQ(faces, read.polygons.size());
    EXPECT_EQ(vertices + faces, edges + 2);  // Euler
  }
}

TEST_F(WriteMesh, StlIsBinaryWithNormals) {
  taut::write_mesh(path("a.stl"), box());
  const std::string text = content(path("a.stl"));
  EXPECT_EQ(text.size(), 84U + 12 * 50);
  EXPECT_FALSE(text.starts_with("solid"));
  Bytes bytes(text.substr(80));
  EXPECT_EQ(bytes.next<std::uint32_t>(), 12U);
  for (int i = 0; i < 12; ++i) {
    std::array<dvec3, 4> p;
    for (dvec3& q : p) {
      for (int k = 0; k < 3; ++k) q[k] = static_cast<double>(bytes.next<float>());
    }
    EXPECT_EQ(bytes.next<std::uint16_t>(), 0);
    const dvec3 normal = glm::normalize(glm::cross(p[2] - p[1], p[3] - p[1]));
    EXPECT_LT(glm::length(normal - p[0]), 1e-6);
  }
  EXPECT_TRUE(bytes.at_end());
}

TEST_F(WriteMesh, StlRefusesWhatFloatsCannotHold) {
  const HullMesh mesh = mesh_of({{0, 0, 0}, {1e39, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}});
  EXPECT_EQ(message_of<IoError>([&] { taut::write_mesh(path("a.stl"), mesh); }),
            path("a.stl").string() +
                ": a coordinate of vertex 1 is beyond the floats of STL; .ply holds it");
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(WriteMesh, StlHoldsTrianglesOnly) {
  const std::pair<HullMesh, std::string> cases[] = {
      {hull_of({{1, 2, 3}}), "a point"},
      {hull_of({{0, 0, 0}, {1, 2, 3}}), "a segment"},
      {hull_of({{1e9, 1, 0}, {1e9, 2, 0}, {1e9 + 1, 1, 0}}), "a segment in floats"},
      {hull_of({{1e9, 1e9, 0}, {1e9, 1e9 + 1, 0}, {1e9 + 1, 1e9, 0}}), "a point in floats"},
      {HullMesh(), "empty"}};
  for (const auto& [mesh, what] : cases) {
    EXPECT_EQ(message_of<IoError>([&, &mesh = mesh] { taut::write_mesh(path("a.stl"), mesh); }),
              path("a.stl").string() + ": an STL file holds triangles only, and the hull is " +
                  what + "; .ply holds it");
  }
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(WriteMesh, PlanarStlHasTwoSidesOfTriangles) {
  for (const auto& points : {square, circle(8), circle(9), circle(100), circle(1000)}) {
    const double rounding = taut::write_mesh(path("a.stl"), hull_of(points)).rounding;
    const PolygonMesh read = taut::read_mesh(path("a.stl"));
    EXPECT_EQ(read.points.size(), points.size());
    EXPECT_EQ(read.polygons.size(), 2 * (points.size() - 2));
    EXPECT_EQ(volume(read), 0);
    expect_perfect(read, points, rounding, std::to_string(points.size()));
  }
}

TEST_F(WriteMesh, TiltedPlanarStlIsClosedAndConvex) {
  for (const int corners : {3, 4, 8, 100, 1000}) {
    std::vector<dvec3> points;
    for (const dvec3& p : circle(corners)) points.emplace_back(p.x, 0.6 * p.y, 0.8 * p.y + p.x / 3);
    const HullMesh mesh = hull_of(points);
    ASSERT_EQ(mesh.n_faces(), 2U);
    const double rounding = taut::write_mesh(path("a.stl"), mesh).rounding;
    const PolygonMesh read = taut::read_mesh(path("a.stl"));
    EXPECT_GE(volume(read), 0) << "rounding leaves a sliver";
    EXPECT_LE(volume(read), 7 * rounding) << "the area is below 3.3";
    expect_perfect(read, points, rounding, std::to_string(corners));
  }
}

TEST_F(WriteMesh, SolidsThatFloatsFlattenAreStillClosed) {
  std::vector<dvec3> points;
  for (const dvec3& p : circle(50)) {
    points.emplace_back(p.x, p.y, 1e8 + p.x);
    points.emplace_back(0.5 * p.x, 0.5 * p.y, 1e8 - 1);
  }
  const HullMesh mesh = hull_of(points);
  EXPECT_GT(volume({points_of(mesh), polygons_of(mesh)}), 0);
  const double rounding = taut::write_mesh(path("a.stl"), mesh).rounding;
  EXPECT_NEAR(rounding, 1, 1e-6);
  const PolygonMesh read = taut::read_mesh(path("a.stl"));
  for (const dvec3& p : read.points) EXPECT_EQ(p.z, 1e8);
  expect_perfect(read, points, rounding, "");
}

/// The farthest that a vertex lies from its float.
long double largest_move(const HullMesh& mesh) {
  long double largest = 0;
  for (const dvec3& p : points_of(mesh)) {
    long double squares = 0;
    for (int i = 0; i < 3; ++i) {
      const long double move = static_cast<long double>(p[i]) - static_cast<float>(p[i]);
      squares += move * move;
    }
    largest = std::max(largest, std::sqrt(squares));
  }
  return largest;
}

TEST_F(WriteMesh, StlIsConvexAtAllPlacesAndSizes) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> gaussian;
  std::uniform_real_distribution<double> exponent(-1, 7);
  for (int trial = 0; trial < 60; ++trial) {
    const double size = trial % 3 == 0 ? 1e-30 : trial % 3 == 1 ? 1 : 1e20;
    const dvec3 place = size * std::pow(10, exponent(random)) *
                        dvec3(gaussian(random), gaussian(random), gaussian(random));
    const double flatness = trial % 2 == 0 ? 1 : std::pow(10, -exponent(random));
    const dvec3 axis = taut::unit({gaussian(random), gaussian(random), gaussian(random)});
    std::vector<dvec3> points;
    for (int i = 0; i < 500; ++i) {
      dvec3 p = taut::unit({gaussian(random), gaussian(random), gaussian(random)});
      p -= (1 - flatness) * glm::dot(p, axis) * axis;
      points.push_back(place + size * p);
    }
    const HullMesh mesh = hull_of(points);
    const double rounding = taut::write_mesh(path("a.stl"), mesh).rounding;
    EXPECT_GE(rounding, largest_move(mesh));
    EXPECT_LE(rounding, largest_move(mesh) * (1 + 1e-14L));
    expect_perfect(taut::read_mesh(path("a.stl")), points, rounding, std::to_string(trial));
  }
}

TEST_F(WriteMesh, StlLeavesOutVerticesThatAreNotExtreme) {
  const PolygonMesh read = round_trip("a.stl", pyramid_with_collinear_vertices(4));
  EXPECT_EQ(read.points.size(), 5U);
  EXPECT_EQ(read.polygons.size(), 6U);
}

TEST_F(WriteMesh, RoundingIsNeverUnderstated) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-320, 38);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<dvec3> points = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    dvec3& p = points.emplace_back(0);
    for (int i = 0; i < 3; ++i) {
      p[i] = mantissa(random) * std::pow(10, trial < 100 ? -300 - trial / 5.0 : exponent(random));
    }
    const HullMesh mesh = mesh_of(points, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
    const double rounding = taut::write_mesh(path("a.stl"), mesh).rounding;
    EXPECT_GE(rounding, largest_move(mesh));
    EXPECT_LE(rounding, largest_move(mesh) * (1 + 1e-14L) + 1e-323L);
  }
}

TEST_F(WriteMesh, OnlyStlRounds) {
  for (const std::string& name : exact_formats) {
    EXPECT_EQ(taut::write_mesh(path(name), box()).rounding, 0);
  }
  EXPECT_GT(taut::write_mesh(path("a.stl"), box()).rounding, 0);
  EXPECT_EQ(taut::write_mesh(path("a.stl"), hull_of(square)).rounding, 0);
}

// ---------------------------------------------------------------- failures

TEST_F(WriteMesh, UnknownExtension) {
  EXPECT_EQ(message_of<IoError>([&] { taut::write_mesh(path("a.step"), box()); }),
            path("a.step").string() +
                ": no format of meshes has the extension \".step\"; known are .obj, .off, .ply, "
                ".stl");
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(WriteMesh, NoSuchFolder) {
  for (const std::string& name : all_formats) {
    const std::string what =
        message_of<IoError>([&] { taut::write_mesh(path("none/" + name), box()); });
    EXPECT_TRUE(what.starts_with(path("none").string())) << what;
    EXPECT_TRUE(what.ends_with("cannot be written: No such file or directory")) << what;
  }
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(WriteMesh, TargetThatCannotBeReplacedLeavesNothing) {
  for (const std::string& name : all_formats) {
    std::filesystem::create_directories(path(name) / "full");
    EXPECT_THROW(taut::write_mesh(path(name), box()), IoError) << name;
    EXPECT_EQ(file_count(), 1U) << name;
    std::filesystem::remove_all(path(name));
  }
}

TEST_F(WriteMesh, LeftoversOfOthersAreNotTouched) {
  file("a.ply.tmp0", "of another run");
  taut::write_mesh(path("a.ply"), box());
  EXPECT_EQ(content(path("a.ply.tmp0")), "of another run");
  EXPECT_EQ(file_count(), 2U);
}

/// No file can grow beyond the limit while this lives: a disk that is full.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_ = {};
  void (*handler_)(int) = nullptr;
};

TEST_F(WriteMesh, FullDiskKeepsTheOldFileAndLeavesNothing) {
  // Fails when the file is closed, when its only block is written, and on the way.
  const std::pair<HullMesh, rlim_t> cases[] = {
      {box(), 300}, {prism(100), 4000}, {prism(20'000), 4000}};
  for (const std::string& name : all_formats) {
    for (const auto& [mesh, bytes] : cases) {
      file(name, "the old file");
      std::string what;
      {
        const FileSizeLimit limit(bytes);
        what = message_of<IoError>([&, &mesh = mesh] { taut::write_mesh(path(name), mesh); });
      }
      EXPECT_EQ(what, path(name).string() + ": cannot be written: File too large");
      EXPECT_EQ(content(path(name)), "the old file");
      EXPECT_EQ(file_count(), 1U);
      std::filesystem::remove(path(name));
    }
  }
}

}  // namespace
