#include "taut/hull/result/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: random geometry

PolygonMesh box_mesh(const dvec3& lower, const dvec3& upper) {
  PolygonMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.points.emplace_back((k & 1) != 0 ? upper.x : lower.x, (k & 2) != 0 ? upper.y : lower.y,
                             (k & 4) != 0 ? upper.z : lower.z);
  }
  mesh.polygons = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return mesh;
}

/// Tetrahedron (0, a x, b y, c z).
PolygonMesh corner_mesh(double a, double b, double c) {
  return {{{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// Upright prism on a regular polygon of circumradius R, from z = 0 to z = h.
PolygonMesh prism_mesh(int corners, double R, double h) {
  PolygonMesh mesh;
  std::vector<int> bottom, top;
  for (int k = 0; k < corners; ++k) {
    const double t = 2 * pi * k / corners;
    mesh.points.emplace_back(R * std::cos(t), R * std::sin(t), 0);
    mesh.points.emplace_back(R * std::cos(t), R * std::sin(t), h);
    const int next = 2 * ((k + 1) % corners);
    mesh.polygons.push_back({2 * k, next, next + 1, 2 * k + 1});
    bottom.push_back(2 * k);
    top.push_back(2 * k + 1);
  }
  std::reverse(bottom.begin(), bottom.end());
  mesh.polygons.push_back(bottom);
  mesh.polygons.push_back(top);
  return mesh;
}

/// Corners on the unit sphere, on `rings` - 1 circles of latitude and at the poles.
PolygonMesh globe_mesh(int rings) {
  const int around = 2 * rings;
  PolygonMesh mesh;
  mesh.points.emplace_back(0, 0, -1);
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      const double v = pi * i / rings;
      const double u = 2 * pi * j / around;
      mesh.points.emplace_back(std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), -std::cos(v));
    }
  }
  mesh.points.emplace_back(0, 0, 1);
  const int last = int(mesh.points.size()) - 1;
  const auto at = [&](int i, int j) {
    return i == 0 ? 0 : i == rings ? last : 1 + (i - 1) * around + j % around;
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < around; ++j) {
      std::vector<int> polygon = {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)};
      polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
      if (polygon.front() == polygon.back()) polygon.pop_back();
      mesh.polygons.push_back(polygon);
    }
  }
  return mesh;
}

PolygonMesh mapped(PolygonMesh mesh, const dmat3& matrix, const dvec3& shift = dvec3(0.0)) {
  for (dvec3& p : mesh.points) p = matrix * p + shift;
  return mesh;
}

void expect_near(const dvec3& a, const dvec3& b, double error, const std::string& name) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], error) << name << ", coordinate " << i;
}

void expect_near(const dmat3& a, const dmat3& b, double error, const std::string& name) {
  for (int i = 0; i < 3; ++i) expect_near(a[i], b[i], error, name + ", column");
}

/// Errors are relative to the measures of the solid's own size.
void expect_measures(const PolygonMesh& mesh, const Measures& truth, double accuracy,
                     const std::string& name, double centroid_error = 0) {
  const Measures m = measure(mesh);
  EXPECT_NEAR(m.volume, truth.volume, accuracy * truth.volume) << name;
  EXPECT_NEAR(m.area, truth.area, accuracy * truth.area) << name;
  expect_near(m.centroid, truth.centroid, accuracy * std::sqrt(truth.area) + centroid_error,
              name + ": centroid");
  const double trace = truth.inertia[0][0] + truth.inertia[1][1] + truth.inertia[2][2];
  expect_near(m.inertia, truth.inertia, accuracy * trace, name + ": inertia");
  EXPECT_EQ(m.inertia, glm::transpose(m.inertia)) << name;
}

dmat3 diagonal_matrix(double x, double y, double z) { return {x, 0, 0, 0, y, 0, 0, 0, z}; }

Measures box_measures(const dvec3& center, double a, double b, double c) {
  const double m = a * b * c;
  return {m, 2 * (a * b + b * c + c * a), center,
          m / 12 * diagonal_matrix(b * b + c * c, c * c + a * a, a * a + b * b)};
}

Measures corner_measures(double a, double b, double c) {
  const double m = a * b * c / 6;
  // Integrals of x x and x y over it: 3/80 and -1/80 of the volume about the centroid.
  const auto moment = [&](double p, double q) { return 3.0 / 80 * m * (p * p + q * q); };
  const auto product = [&](double p, double q) { return m / 80 * p * q; };
  const double slant = std::sqrt(a * a * b * b + b * b * c * c + c * c * a * a);
  return {m,
          (a * b + b * c + c * a + slant) / 2,
          {a / 4, b / 4, c / 4},
          {moment(b, c), product(a, b), product(a, c),  //
           product(a, b), moment(c, a), product(b, c),  //
           product(a, c), product(b, c), moment(a, b)}};
}

/// After x -> rotation * x + shift.
Measures moved(const Measures& m, const dmat3& rotation, const dvec3& shift) {
  return {m.volume, m.area, rotation * m.centroid + shift,
          rotation * m.inertia * glm::transpose(rotation)};
}

TEST(Measures, Box) {
  expect_measures(box_mesh({0, 0, 0}, {1, 2, 3}), box_measures({0.5, 1, 1.5}, 1, 2, 3), 1e-15,
                  "box");
  expect_measures(box_mesh({-1, -1, -1}, {1, 1, 1}), box_measures({0, 0, 0}, 2, 2, 2), 1e-15,
                  "cube");
}

TEST(Measures, Tetrahedron) {
  expect_measures(corner_mesh(1, 1, 1), corner_measures(1, 1, 1), 2e-15, "unit corner");
  expect_measures(corner_mesh(1, 2, 5), corner_measures(1, 2, 5), 2e-15, "corner");
}

TEST(Measures, OctahedronAndIcosahedron) {
  const PolygonMesh octahedron = {
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  expect_measures(octahedron, {4.0 / 3, 4 * std::sqrt(3.0), dvec3(0.0), dmat3(4.0 / 15)}, 2e-15,
                  "octahedron");
  const double phi = std::numbers::phi;
  const PolygonMesh icosahedron = {
      {{-1, phi, 0},
       {1, phi, 0},
       {-1, -phi, 0},
       {1, -phi, 0},
       {0, -1, phi},
       {0, 1, phi},
       {0, -1, -phi},
       {0, 1, -phi},
       {phi, 0, -1},
       {phi, 0, 1},
       {-phi, 0, -1},
       {-phi, 0, 1}},
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  const double volume = 10 * (3 + std::sqrt(5.0)) / 3;  // edges of length 2
  expect_measures(icosahedron,
                  {volume, 20 * std::sqrt(3.0), dvec3(0.0), dmat3(0.4 * phi * phi * volume)}, 3e-15,
                  "icosahedron");
}

TEST(Measures, PrismsOnPolygonsOfManyCorners) {
  for (const int n : {3, 4, 5, 17, 1000, 100'000}) {
    const double R = 1.5;
    const double h = 0.7;
    const double angle = 2 * pi / n;
    const double base = 0.5 * n * R * R * std::sin(angle);
    const double m = base * h;
    const double polar = m * R * R * (2 + std::cos(angle)) / 6;
    const double across = polar / 2 + m * h * h / 12;
    const Measures truth = {m,
                            2 * base + n * h * 2 * R * std::sin(angle / 2),
                            {0, 0, h / 2},
                            diagonal_matrix(across, across, polar)};
    expect_measures(prism_mesh(n, R, h), truth, 1e-14, std::to_string(n) + " corners");
  }
}

TEST(Measures, PolyhedraInASphereConvergeToIt) {
  Measures previous;
  for (const int rings : {25, 50, 100, 200}) {
    const Measures m = measure(globe_mesh(rings));
    const double missing = 4 * pi / 3 - m.volume;
    EXPECT_GT(missing, 0);
    EXPECT_LT(missing, 20.0 / (rings * rings));
    expect_near(m.centroid, dvec3(0.0), 1e-14, "centre");
    if (previous.volume > 0) {
      // Errors fall by four: Richardson's extrapolation takes them away.
      const auto limit = [](double coarse, double fine) { return fine + (fine - coarse) / 3; };
      const double error = 1e4 / std::pow(rings, 4);
      EXPECT_NEAR(limit(previous.volume, m.volume), 4 * pi / 3, error);
      EXPECT_NEAR(limit(previous.area, m.area), 4 * pi, error);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(limit(previous.inertia[i][i], m.inertia[i][i]), 8 * pi / 15, error);
        EXPECT_NEAR(m.inertia[i][(i + 1) % 3], 0, 1e-14);
      }
    }
    previous = m;
  }
}

TEST(Measures, RotatedAndShifted) {
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const dmat3 turn = random_rotation(random);
    const dvec3 shift = 3.0 * random_point(random);
    const std::string name = "case " + std::to_string(k);
    expect_measures(mapped(corner_mesh(1, 2, 3), turn, shift),
                    moved(corner_measures(1, 2, 3), turn, shift), 1e-14, name);
    expect_measures(mapped(box_mesh({0, 0, 0}, {1, 2, 3}), turn, shift),
                    moved(box_measures({0.5, 1, 1.5}, 1, 2, 3), turn, shift), 1e-14, name);
  }
}

TEST(Measures, FarFromTheOriginNothingIsLost) {
  for (const double far : {0x1p20, 0x1p30, 0x1p40, 0x1p50}) {
    // Such coordinates are exact, and the centroids too.
    const dvec3 lower(far, -far, far + 8);
    expect_measures(box_mesh(lower, lower + dvec3(2, 4, 8)),
                    box_measures(lower + dvec3(1, 2, 4), 2, 4, 8), 1e-15, "box");
    expect_measures(mapped(corner_mesh(4, 8, 16), dmat3(1.0), lower),
                    moved(corner_measures(4, 8, 16), dmat3(1.0), lower), 2e-15, "corner");
  }
}

TEST(Measures, TinyAndHuge) {
  for (const double size : {0x1p-200, 0x1p-100, 0x1p-20, 0x1p20, 0x1p100, 0x1p200}) {
    // Powers of two: the answers are those of size one to the bit.
    const Measures one = measure(corner_mesh(1, 2, 3));
    const Measures m = measure(corner_mesh(size, 2 * size, 3 * size));
    EXPECT_NEAR(m.volume / size / size / size, one.volume, 1e-15) << size;
    EXPECT_NEAR(m.area / size / size, one.area, 1e-14) << size;
    expect_near(m.centroid / size, one.centroid, 1e-15, "centroid");
    expect_near(m.inertia / size / size / size / size / size, one.inertia, 1e-15, "inertia");
  }
}

TEST(Measures, CentroidOfSizesWhoseVolumeIsOutOfRange) {
  for (const double size : {1e-300, 1e-250, 1e-110, 1e-70, 1e70, 1e110, 1e250, 1e300}) {
    const Measures m = measure(corner_mesh(size, 2 * size, 3 * size));
    expect_near(m.centroid / size, {0.25, 0.5, 0.75}, 1e-15, "size " + std::to_string(size));
    EXPECT_GE(m.volume, 0);
    EXPECT_FALSE(std::isnan(m.area));
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(m.inertia[i][i], 0) << size;
      EXPECT_FALSE(std::isnan(m.inertia[i][(i + 1) % 3])) << size;
    }
  }
}

TEST(Measures, NoCornerIsSpecial) {
  // Fans from any corner of the polygons, polygons in any order.
  Random random(2);
  const PolygonMesh mesh = prism_mesh(9, 1, 2);
  const Measures expected = measure(mesh);
  for (int k = 0; k < 50; ++k) {
    PolygonMesh other = mesh;
    std::shuffle(other.polygons.begin(), other.polygons.end(), random);
    for (auto& p : other.polygons) {
      std::rotate(p.begin(), p.begin() + pick(random, 0, int(p.size()) - 1), p.end());
    }
    expect_measures(other, expected, 2e-15, "case " + std::to_string(k));
  }
}

TEST(Measures, PolygonsThatAreNotConvex) {
  // An L from (0, 0) to (2, 2) without (1, 1)..(2, 2), of height 1.
  const std::vector<dvec2> outline = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (std::size_t first = 0; first < outline.size(); ++first) {
    PolygonMesh mesh;
    std::vector<int> bottom, top;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const dvec2 p = outline[(k + first) % outline.size()];
      mesh.points.emplace_back(p, 0);
      mesh.points.emplace_back(p, 1);
      const int a = int(2 * k);
      const int b = int(2 * ((k + 1) % outline.size()));
      mesh.polygons.push_back({a, b, b + 1, a + 1});
      top.push_back(a + 1);
      bottom.insert(bottom.begin(), a);
    }
    mesh.polygons.push_back(top);
    mesh.polygons.push_back(bottom);
    const Measures m = measure(mesh);
    EXPECT_NEAR(m.volume, 3, 1e-14) << first;
    EXPECT_NEAR(m.area, 14, 1e-13) << first;
    expect_near(m.centroid, {5.0 / 6, 5.0 / 6, 0.5}, 1e-14, "L");
  }
}

TEST(Measures, FlatMeshesHaveTheSurfacesCentroid) {
  const PolygonMesh two_sided = {{{1, 1, 5}, {4, 1, 5}, {1, 4, 5}}, {{0, 1, 2}, {0, 2, 1}}};
  const Measures m = measure(two_sided);
  EXPECT_EQ(m.volume, 0);
  EXPECT_NEAR(m.area, 9, 1e-14);
  expect_near(m.centroid, {2, 2, 5}, 1e-14, "flat");
  EXPECT_EQ(m.inertia, dmat3(0.0));
}

TEST(Measures, NothingAndOnePoint) {
  const Measures none = measure({});
  EXPECT_EQ(none.volume, 0);
  EXPECT_EQ(none.area, 0);
  EXPECT_EQ(none.inertia, dmat3(0.0));
  const PolygonMesh point = {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}};
  const Measures one = measure(point);
  EXPECT_EQ(one.volume, 0);
  EXPECT_EQ(one.area, 0);
  EXPECT_EQ(one.centroid, dvec3(1, 2, 3));
}

TEST(Measures, InwardOrientationHasNegativeVolume) {
  PolygonMesh mesh = box_mesh({0, 0, 0}, {1, 2, 3});
  for (auto& p : mesh.polygons) std::reverse(p.begin(), p.end());
  EXPECT_NEAR(measure(mesh).volume, -6, 1e-14);
}

}  // namespace
}  // namespace taut
