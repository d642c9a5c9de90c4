// The PLY of a hull in MeshLab 2020.09 (Debian 12), where meshlabserver is installed.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <regex>
#include <set>
#include <string>

#include "taut/hull/convex_hull.h"
#include "taut/hull/measures.h"
#include "taut/io/read_model.h"
#include "taut/io/write_mesh.h"
#include "temporary_folder.h"

namespace {

using namespace taut;

using MeshLab = taut_test::TemporaryFolder;

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
  if (!installed("meshlabserver") || !installed("xvfb-run")) {
    GTEST_SKIP() << "meshlabserver or xvfb-run is not installed";
  }
  Model model;
  read_model(TAUT_DATA "/teapot.bpt", model);
  const Scene scene(std::move(model));
  HullOptions options;
  options.tolerance = 1e-3 * scene.diagonal();
  const Hull hull = sampled_hull(scene, options);
  write_mesh(path("hull.ply"), hull.mesh);
  file("measure.mlx",
       "<!DOCTYPE FilterScript><FilterScript><filter name=\"Compute Topological Measures\"/>"
       "<filter name=\"Compute Geometric Measures\"/></FilterScript>");
  const std::string text =
      output_of("cd '" + folder_.string() +
                "' && xvfb-run -a meshlabserver -i hull.ply -s measure.mlx -o back.ply -m fc 2>&1");

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

}  // namespace
