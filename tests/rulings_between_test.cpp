#include "taut/hull/contact/rulings_between.h"

#include <gtest/gtest.h>

#include <cmath>

#include "freeform.h"
#include "models.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// z = -(x^4 - x^2 y + c y^2), c = 1, touched twice by planes along y = 2 x^2, with the godron in
/// the origin.
class Godron {
 public:
  Godron() : scene_(make_scene(godron(1, 1, 1))), geometry_(scene_), system_(geometry_) {}

  const ContactGeometry& geometry() const { return geometry_; }
  const ContactSystem& system() const { return system_; }

  /// The one whose contacts have x = -+ half: exact up to the rounding of its parameters.
  Ruling ruling(double half) const {
    const double y = 2 * half * half;
    Ruling r;
    // The gradient of z is (0, x^2 - 2 y).
    r.n = glm::normalize(dvec3(0, 2 * y - half * half, 1));
    for (std::size_t i = 0; i < 2; ++i) {
      const double x = i == 0 ? -half : half;
      r.contact[i] = {0, SourceKind::face, 0, 0.5 * (x + 1), 0.5 * (y + 1)};
      r.point[i] = geometry_.point(r.contact[i]);
    }
    return r;
  }
  /// Largest miss of the equations of two contacts.
  double residual(const Ruling& r) const {
    double largest = std::abs(glm::dot(r.point[0] - r.point[1], r.n));
    for (const Contact& c : r.contact) {
      const ContactJet j = geometry_.jet(c);
      for (const dvec3& d : j.dx) largest = std::max(largest, std::abs(glm::dot(d, r.n)));
    }
    return largest;
  }

 private:
  Scene scene_;
  ContactGeometry geometry_;
  ContactSystem system_;
};

/// From a tenth of the patch down to where the system is singular to within rounding.
TEST(RulingsBetween, ExactUpToAFreeEnd) {
  const Godron g;
  const Ruling end = g.ruling(0);
  for (const double half : {0.1, 0.02, 5e-3, 1e-3, 2e-4, 1e-5}) {
    const Ruling longer = g.ruling(half);
    for (const double s : {0.01, 0.15, 0.35, 0.5, 0.65, 0.85, 0.99}) {
      const std::optional<Ruling> out = ruling_between(g.system(), end, longer, s);
      const std::optional<Ruling> in = ruling_between(g.system(), longer, end, 1 - s);
      ASSERT_TRUE(out && in) << half << ' ' << s;
      EXPECT_LT(g.residual(*out), 1e-13) << half << ' ' << s;
      EXPECT_LT(g.residual(*in), 1e-13) << half << ' ' << s;
      // The length is that share of the longer one's, in units that shrink with the patch.
      const double length = glm::distance(longer.point[0], longer.point[1]);
      EXPECT_NEAR(glm::distance(out->point[0], out->point[1]), s * length, 1e-9 * length);
      // Rounding moves the contacts along the curve, the less the farther they are apart.
      const Ruling true_one = g.ruling(s * half);
      const double noise = std::min(1e-6, 1e-13 / std::pow(s * length, 3));
      EXPECT_LT(glm::distance(out->point[0], true_one.point[0]), noise + 1e-12) << half << ' ' << s;
    }
  }
}

/// A linear mix of the two would miss by the square of their distance.
TEST(RulingsBetween, ExactBetweenShortOnes) {
  const Godron g;
  for (const double half : {0.1, 1e-2, 1e-3}) {
    const Ruling from = g.ruling(half);
    const Ruling to = g.ruling(0.5 * half);
    for (const double s : {0.1, 0.5, 0.9}) {
      const std::optional<Ruling> r = ruling_between(g.system(), from, to, s);
      ASSERT_TRUE(r) << half << ' ' << s;
      EXPECT_LT(g.residual(*r), 1e-13) << half << ' ' << s;
    }
    EXPECT_EQ(ruling_between(g.system(), from, to, 0)->n, from.n);
    EXPECT_EQ(ruling_between(g.system(), from, to, 1)->n, to.n);
    EXPECT_EQ(ruling_between(g.system(), from, from, 0.5)->n, from.n);
  }
}

/// A contact that goes over a plane, as where an arc ends in one of its contacts, while the other
/// one stays: from where the two are one, and farther on.
TEST(RulingsBetween, StraightWhereNIsTheSameAtBothEnds) {
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    const Scene scene = make_scene(mapped(godron(1, 1, 1) + box(2, 2, 1), turn));
    const ContactGeometry geometry(scene);
    const ContactSystem system(geometry);
    const Contact face = {0, SourceKind::face, 1, 0, 0};
    const ContactJet corner = geometry.jet(face);
    Ruling from;
    from.n = glm::normalize(glm::cross(corner.dx[0], corner.dx[1]));
    from.contact = {geometry.canonical(face), face};
    from.point = {corner.x, corner.x};
    Ruling to = from;
    for (const dvec2& uv : {dvec2(0.5, 0.25), dvec2(1.0, 0.75)}) {
      to.contact[1].u = uv.x;
      to.contact[1].v = uv.y;
      to.point[1] = geometry.point(to.contact[1]);
      const MovingRuling middle = RulingsBetween(system, from, to).interpolated(0.5);
      EXPECT_EQ(middle.at.n, from.n);
      EXPECT_EQ(middle.dn, dvec3(0.0));
      EXPECT_LT(glm::distance(middle.at.jet[0].x, corner.x), 1e-15);
      EXPECT_LT(glm::distance(middle.at.jet[1].x, 0.5 * (from.point[1] + to.point[1])), 1e-15);
      from = to;
    }
  }
}

/// Two segments that no curve of rulings joins: none, rather than a mix.
TEST(RulingsBetween, NoneWhereThereIsNoCurve) {
  const Godron g;
  const Ruling from = g.ruling(0.1);
  Ruling to = g.ruling(0.1);
  std::swap(to.contact[0], to.contact[1]);
  std::swap(to.point[0], to.point[1]);
  EXPECT_FALSE(ruling_between(g.system(), from, to, 0.5));
}

/// Beyond a free end there are no more; a little beyond the other one there are.
TEST(RulingsBetween, GoesOnButNotBeyondAFreeEnd) {
  const Godron g;
  const Ruling end = g.ruling(0);
  const Ruling longer = g.ruling(0.05);
  EXPECT_FALSE(ruling_between(g.system(), end, longer, -0.1));
  EXPECT_FALSE(ruling_between(g.system(), longer, end, 1.1));
  const std::optional<Ruling> beyond = ruling_between(g.system(), end, longer, 1.1);
  ASSERT_TRUE(beyond);
  EXPECT_LT(g.residual(*beyond), 1e-13);
}

}  // namespace
}  // namespace taut
