// Files of hulls in MeshLab 2020.09 (Debian 12), where meshlabserver is installed. (Its reader of
// OBJ stops at an assertion of its own for any file with faces.)

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "boundaries.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/result/measures.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/io/mesh/read_mesh.h"
#include "taut/io/mesh/write_mesh.h"
#include "taut/io/model/read_model.h"
#include "taut/io/model/write_project.h"
#include "temporary_folder.h"

namespace {

using namespace taut;

bool installed(const std::string& command) {
  return std::system(("command -v " + command + " >/dev/null 2>&1").c_str()) == 0;
}

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    text.append(buffer.data(), count);
  }
  pclose(pipe);
  return text;
}

class MeshLab : public taut_test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    if (!installed("meshlabserver") || !installed("xvfb-run")) {
      GTEST_SKIP() << "meshlabserver or xvfb-run is not installed";
    }
    file("measure.mlx",
         "<!DOCTYPE FilterScript><FilterScript><filter name=\"Compute Topological Measures\"/>"
         "<filter name=\"Compute Geometric Measures\"/></FilterScript>");
  }

  /// What MeshLab says of the file; it writes it again to back.ply.
  std::string measured(const std::string& name) const {
    return output_of("cd '" + folder_.string() + "' && xvfb-run -a meshlabserver -i " + name +
                     " -s measure.mlx -o back.ply -m fc 2>&1");
  }
};

double number_after(const std::string& text, const std::string& label) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(label + "\\s*([-+0-9.e]+)"))) return NAN;
  return std::stod(match[1]);
}

/// The colours of the faces of a binary PLY of triangles as MeshLab writes it.
std::set<std::string> face_colors(const std::string& ply, std::size_t faces) {
  // Per face: a count, three indices, red green blue alpha; the faces end the file.
  constexpr std::size_t face_size = 1 + 3 * 4 + 4;
  std::set<std::string> colors;
  if (ply.find("property uchar red") == std::string::npos) return colors;
  for (std::size_t f = 0; f < faces; ++f) {
    colors.insert(ply.substr(ply.size() - (f + 1) * face_size + 13, 3));
  }
  return colors;
}

TEST_F(MeshLab, OpensTheHullWithItsColors) {
  Model model;
  read_model(TAUT_DATA "/teapot.bpt", model);
  const Scene scene(std::move(model));
  HullOptions options;
  options.tolerance = 1e-3 * scene.diagonal();
  const Hull hull = sampled_hull(scene, options);
  write_mesh(path("hull.ply"), hull.mesh);
  const std::string text = measured("hull.ply");

  // Polygons arrive as triangles, so the faces follow from the vertices.
  const auto vertices = double(hull.mesh.n_vertices());
  EXPECT_EQ(number_after(text, "\nV:"), vertices) << text;
  EXPECT_EQ(number_after(text, "F:"), 2 * vertices - 4) << text;
  EXPECT_EQ(number_after(text, "Boundary Edges"), 0) << text;
  EXPECT_EQ(number_after(text, "Genus is"), 0) << text;
  EXPECT_NE(text.find("two-manifold"), std::string::npos) << text;
  const Measures measures = measure(polygons(hull.mesh));
  EXPECT_NEAR(number_after(text, "Mesh Volume  is"), measures.volume, 1e-5 * measures.volume);
  EXPECT_NEAR(number_after(text, "Mesh Surface Area is"), measures.area, 1e-5 * measures.area);
  EXPECT_NEAR(number_after(text, "Center of Mass  is"), measures.centroid.x, 1e-5);

  const auto colors =
      face_colors(taut_test::content(path("back.ply")), std::size_t(2 * vertices - 4));
  EXPECT_GE(colors.size(), 4u) << "patches of several sources, scrolls and facets differ";
  EXPECT_EQ(colors.count("\xff\xff\xff"), 0u) << "white is what MeshLab shows without colours";
}

HullMesh hull_of(const std::vector<dvec3>& points) {
  Model model;
  Part part;
  part.add_points(points);
  model.add_instance(model.add_part(std::move(part), smooth_join_angle), {});
  return convex_hull(model).mesh;
}

TEST_F(MeshLab, OpensProjects) {
  const taut_test::KnownBoundary known = taut_test::two_spheres_boundary();
  const Hull hull = sampled_hull(known.scene);
  write_project(path("p.mlp"), hull.mesh, hull_curves(known.scene.frame(), known.boundary),
                known.scene.model());
  // Each layer alone, and the project that names them: the server then writes the first one.
  const std::string curves = measured("p-curves.ply");
  EXPECT_EQ(number_after(curves, "\nV:"), 2 * 65) << curves;
  EXPECT_EQ(number_after(curves, "F:"), 0) << curves;
  EXPECT_EQ(number_after(curves, "Unreferenced Vertices"), 0) << "edges refer to them\n" << curves;
  const std::string model = measured("p-model.ply");
  EXPECT_EQ(number_after(model, "\nV:"), 16 * 121) << model;
  EXPECT_EQ(number_after(model, "F:"), 16 * 190) << model;
  const std::string project =
      output_of("cd '" + folder_.string() +
                "' && xvfb-run -a meshlabserver -p p.mlp -s measure.mlx -w back.mlp 2>&1");
  const std::string back = taut_test::content(path("back.mlp"));
  for (const char* layer : {"p-hull", "p-curves", "p-model"}) {
    EXPECT_NE(back.find(layer), std::string::npos) << project << "\n" << back;
  }
}

TEST_F(MeshLab, OpensStl) {
  Model model;
  read_model(TAUT_DATA "/torus.taut.json", model);
  HullOptions options;
  options.relative = 1e-3;
  const Hull hull = convex_hull(model, options);
  write_mesh(path("hull.stl"), hull.mesh);
  const PolygonMesh written = read_mesh(path("hull.stl"));
  const std::string text = measured("hull.stl");
  EXPECT_EQ(number_after(text, "\nV:"), double(written.points.size())) << text;
  EXPECT_EQ(number_after(text, "F:"), double(written.polygons.size())) << text;
  EXPECT_EQ(number_after(text, "Boundary Edges"), 0) << text;
  EXPECT_EQ(number_after(text, "Genus is"), 0) << text;
  const Measures measures = measure(polygons(hull.mesh));
  EXPECT_NEAR(number_after(text, "Mesh Volume  is"), measures.volume, 1e-5 * measures.volume);
}

TEST_F(MeshLab, OpensPlanarHulls) {
  const HullMesh pentagon = hull_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1.5, 0}, {0, 1, 0}});
  for (const std::string name : {"hull.ply", "hull.off", "hull.stl"}) {
    write_mesh(path(name), pentagon);
    const std::string text = measured(name);
    EXPECT_EQ(number_after(text, "\nV:"), 5) << text;
    EXPECT_EQ(number_after(text, "F:"), 6) << text;
    EXPECT_EQ(number_after(text, "Boundary Edges"), 0) << text;
    EXPECT_NEAR(number_after(text, "Mesh Surface Area is"), 2.5, 1e-6) << text;
  }
}

TEST_F(MeshLab, OpensSegmentsAndPoints) {
  const HullMesh hulls[] = {hull_of({{1, 2, 3}}), hull_of({{0, 0, 0}, {1, 2, 2}})};
  for (const HullMesh& mesh : hulls) {
    for (const std::string name : {"hull.ply", "hull.off", "hull.obj"}) {
      write_mesh(path(name), mesh);
      const std::string text = measured(name);
      EXPECT_EQ(number_after(text, "\nV:"), double(mesh.n_vertices())) << text;
      EXPECT_EQ(number_after(text, "F:"), 0) << text;
      EXPECT_EQ(number_after(text, "Mesh Bounding Box Diag"), mesh.n_vertices() == 2 ? 3 : 0);
      // Of an edge that was read, the ends are referenced.
      const bool edge = mesh.n_edges() == 1 && name != "hull.off";
      EXPECT_EQ(number_after(text, "Unreferenced Vertices"), edge ? 0 : double(mesh.n_vertices()));
    }
  }
}

}  // namespace
