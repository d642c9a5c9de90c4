#include "taut/hull/solve/contact_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "models.h"

namespace taut_test {
namespace {

using namespace taut;

/// The unit square in n x n bilinear patches, patch i n + j at [i, i + 1] x [j, j + 1] / n.
NurbsSurface square_of_patches(int n) {
  NurbsSurface s{1, 1, {0}, {0}, {}};
  for (int k = 0; k <= n; ++k) {
    s.knots_u.push_back(double(k) / n);
    s.knots_v.push_back(double(k) / n);
  }
  s.knots_u.push_back(1);
  s.knots_v.push_back(1);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) s.points.emplace_back(double(i) / n, double(j) / n, 0, 1);
  }
  return s;
}

class ContactWays : public testing::Test {
 protected:
  static constexpr int n = 8;
  Contact at(double x, double y) const {
    const int i = std::min(int(x * n), n - 1), j = std::min(int(y * n), n - 1);
    return {0, SourceKind::face, i * n + j, x * n - i, y * n - j};
  }
  const Scene scene_ = make_scene({{square_of_patches(n)}, {}, {}});
  const ContactGeometry geometry_{scene_};
};

/// Where it passes borders it is on the segment: no corner that is nearer to its end is on the way.
TEST_F(ContactWays, AreStraight) {
  const dvec3 up(0, 0, 1);
  const double unit = scene_.frame().length_to_frame(1);
  for (const auto& [x, y, to_x, to_y] :
       {std::array{0.02, 0.03, 0.97, 0.55}, std::array{0.9, 0.06, 0.31, 0.93},
        std::array{0.1, 0.2, 0.11, 0.99}, std::array{0.7, 0.7, 0.2, 0.68}}) {
    const Contact from = at(x, y), to = at(to_x, to_y);
    const dvec3 begin = geometry_.point(from), end = geometry_.point(to);
    const ContactWay way(geometry_, from, to, up, 1e-9);
    ASSERT_TRUE(way.is_known());
    double before = 0;
    for (std::size_t k = 0; k < way.borders().size(); ++k) {
      const auto& [own, over] = way.borders()[k];
      const dvec3 p = geometry_.point(own);
      EXPECT_LT(glm::distance(p, geometry_.point(over)), 1e-15);
      EXPECT_LT(glm::distance(p, glm::mix(begin, end, way.share(k))), 1e-12 * unit);
      EXPECT_GE(way.share(k), before);
      before = way.share(k);
    }
    EXPECT_EQ(way.share(way.borders().size()), infinity);
    EXPECT_TRUE(same_element(way.borders().back()[1], to));
    for (int k = 0; k <= 20; ++k) {
      const double share = k / 20.0;
      EXPECT_LT(glm::distance(geometry_.point(way.at(share)), glm::mix(begin, end, share)),
                1e-12 * unit)
          << share;
    }
  }
}

TEST_F(ContactWays, WithinAnElementHaveNoBorders) {
  const ContactWay way(geometry_, at(0.26, 0.26), at(0.3, 0.28), {0, 0, 1}, 0);
  EXPECT_TRUE(way.is_known());
  EXPECT_TRUE(way.borders().empty());
  EXPECT_EQ(way.share(0), infinity);
  EXPECT_LT(glm::distance(geometry_.point(way.at(0.5)), geometry_.point(at(0.28, 0.27))), 1e-14);
}

/// From one sheet to another there are no borders.
TEST_F(ContactWays, BetweenPartsAreNotKnown) {
  const Shape one{{square_of_patches(2)}, {}, {}};
  const Scene scene = make_scene(one + shifted(one, {0, 0, 1}));
  const ContactGeometry geometry(scene);
  const ContactWay way(geometry, {0, SourceKind::face, 0, 0.5, 0.5},
                       {0, SourceKind::face, 4, 0.5, 0.5}, {0, 0, 1}, 1e-9);
  EXPECT_FALSE(way.is_known());
}

}  // namespace
}  // namespace taut_test
