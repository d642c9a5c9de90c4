#include "taut/io/model/write_project.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "boundaries.h"
#include "models.h"
#include "taut/core/error.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/sample/sampled_hull.h"
#include "taut/io/mesh/read_mesh.h"
#include "taut/io/model/read_model.h"
#include "temporary_folder.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and files

class WriteProject : public TemporaryFolder {};

TEST_F(WriteProject, LayersAreReadBack) {
  const KnownBoundary known = two_spheres_boundary();
  const Hull hull = sampled_hull(known.scene);
  const std::vector<Polyline> curves = hull_curves(known.scene.frame(), known.boundary);
  write_project(path("a & \"b\".mlp"), hull.mesh, curves, known.scene.model());
  EXPECT_EQ(file_count(), 4U);

  Model model;
  read_model(path("a & \"b\".mlp"), model);
  ASSERT_EQ(model.parts().size(), 3U);
  EXPECT_EQ(model.parts()[0].vertices().size(), hull.mesh.n_vertices());
  EXPECT_EQ(model.parts()[0].polygons().size(), hull.mesh.n_faces());
  // Two circles of 64 steps, about the spheres' axis.
  const std::vector<dvec3>& points = model.parts()[1].vertices();
  EXPECT_EQ(points.size(), 2 * 65U);
  EXPECT_NEAR(points[7].z, 1.0 / 6, 1e-15);
  EXPECT_NEAR(points[70].z, 3 + 0.5 / 6, 1e-15);
  // Quarters of 100 squares, of which those at the pole are triangles.
  const PolygonMesh spheres = read_mesh(path("a & \"b\"-model.ply"));
  EXPECT_EQ(spheres.polygons.size(), 16 * (200U - 10));
  for (const dvec3& p : spheres.points) {
    EXPECT_NEAR(std::min(glm::length(p), glm::distance(p, dvec3(0, 0, 3)) + 0.5), 1, 1e-14);
  }
}

TEST_F(WriteProject, OfCurvesPointsAndPolygons) {
  Model model;
  read_model("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 2 5\n", "p", ".obj",
             model);
  const Hull hull = convex_hull(model);
  EXPECT_EQ(hull_curves(hull.mesh).size(), 8U);
  write_project(path("p.mlp"), hull.mesh, hull_curves(hull.mesh), model);
  EXPECT_EQ(read_mesh(path("p-model.ply")).polygons.size(), 3U);
  EXPECT_EQ(read_mesh(path("p-hull.ply")).polygons.size(), 5U);

  const Model oloid_model = make_model(oloid());
  const Hull curved = convex_hull(oloid_model);
  write_project(path("o.mlp"), curved.mesh, {}, oloid_model);
  EXPECT_FALSE(std::filesystem::exists(path("o-curves.ply")));
  Model back;
  read_model(path("o.mlp"), back);
  ASSERT_EQ(back.parts().size(), 2U);
  EXPECT_EQ(back.parts()[1].vertices().size(), 8 * 25U);

  const Model segment = make_model({{}, {}, {{0, 0, 0}, {1, 2, 3}}});
  const Hull flat = convex_hull(segment);
  EXPECT_EQ(hull_curves(flat.mesh).size(), 1U);
  write_project(path("s.mlp"), flat.mesh, hull_curves(flat.mesh), segment);
}

TEST_F(WriteProject, TolerantFacesHaveALayer) {
  KnownBoundary known = cylinder_boundary();
  const Hull hull = sampled_hull(known.scene);
  const auto write = [&](const char* name) {
    const SceneFrame& frame = known.scene.frame();
    write_project(path(name), hull.mesh, hull_curves(frame, known.boundary), known.scene.model(),
                  tolerant_curves(frame, known.boundary));
  };
  write("exact.mlp");
  EXPECT_FALSE(std::filesystem::exists(path("exact-tolerant.ply")));
  EXPECT_EQ(taut_test::content(path("exact.mlp")).find("tolerant"), std::string::npos);

  known.boundary.faces[1].tolerant = 1e-8;  // the disc at the top
  write("off.mlp");
  Model model;
  read_model(path("off.mlp"), model);
  ASSERT_EQ(model.parts().size(), 4U);
  EXPECT_EQ(model.parts()[3].vertices().size(), 65U);
  for (const dvec3& p : model.parts()[3].vertices()) EXPECT_NEAR(p.z, 2, 1e-14);
}

TEST_F(WriteProject, AllOrNothing) {
  const KnownBoundary known = tetrahedron_boundary();
  const Hull hull = convex_hull(known.scene);
  const auto write = [&](const std::string& name) {
    write_project(path(name), hull.mesh, hull_curves(known.scene.frame(), known.boundary),
                  known.scene.model());
  };
  std::filesystem::create_directory(path("a-model.ply"));
  file("a-model.ply/inside", "");
  EXPECT_NE(message_of<IoError>([&] { write("a.mlp"); }).find("a-model.ply"), std::string::npos);
  EXPECT_EQ(file_count(), 1U);
  message_of<IoError>([&] { write("none/a.mlp"); });
  EXPECT_EQ(file_count(), 1U);
}

}  // namespace
}  // namespace taut
