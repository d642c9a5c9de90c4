#include "models.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/support_query.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: shapes

constexpr unsigned blobs = 20;

TEST(Blob, IsClosedAndSmooth) {
  for (unsigned seed = 1; seed <= blobs; ++seed) {
    const Model model = make_model(blob(seed));
    const Part& part = model.parts()[0];
    EXPECT_EQ(part.patches().size(), 24u);
    EXPECT_TRUE(part.edges().empty()) << seed;
    EXPECT_TRUE(part.vertices().empty()) << seed;
    int poles = 0;
    for (const Patch& patch : part.patches()) {
      for (const Border& border : patch.borders) {
        EXPECT_NE(border.kind, BorderKind::edge) << seed;
        poles += border.kind == BorderKind::collapsed ? 1 : 0;
      }
    }
    EXPECT_EQ(poles, 12) << seed;
  }
}

TEST(Blob, IsRegularAndDented) {
  constexpr int steps = 8;
  int dented = 0;
  for (unsigned seed = 1; seed <= blobs; ++seed) {
    const Scene scene = make_scene(blob(seed));
    const ContactGeometry geometry(scene);
    SupportQuery query(scene);
    double deepest = 0;
    double flattest = 1;
    for (int k = 0; k < 24; ++k) {
      for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
          const Contact c{0, SourceKind::face, k, (i + 0.5) / steps, (j + 0.5) / steps};
          const ContactJet at = geometry.jet(c);
          const dvec3 N = glm::cross(at.dx[0], at.dx[1]);
          flattest =
              std::min(flattest, glm::length(N) / (glm::length(at.dx[0]) * glm::length(at.dx[1])));
          // Which side is out does not matter: a dent's point is below on both.
          const dvec3 n = glm::normalize(N);
          deepest = std::max(
              deepest, std::min(query(n).h - glm::dot(at.x, n), query(-n).h + glm::dot(at.x, n)));
        }
      }
    }
    EXPECT_GT(flattest, 0.1) << seed;
    dented += deepest > 0.01 * scene.frame().scale * scene.diagonal() ? 1 : 0;
  }
  EXPECT_GE(dented, 15);
}

TEST(Blob, SeedsDiffer) {
  const auto points = [](unsigned seed) { return blob(seed).surfaces[0].points; };
  EXPECT_EQ(points(3), points(3));
  EXPECT_NE(points(3), points(4));
}

TEST(PosedTeapots, AreInstancesOfOnePart) {
  const Model model = posed_teapots(1, 16);
  EXPECT_EQ(model.parts().size(), 1u);
  EXPECT_EQ(model.instances().size(), 16u);
  EXPECT_EQ(model.patch_count(), 16 * 32);
  const Box one = model.parts()[0].control_box();
  const double size = diagonal(model.control_box()) / diagonal(one);
  EXPECT_GT(size, 1.5);
  EXPECT_LT(size, 4);
}

}  // namespace
}  // namespace taut
