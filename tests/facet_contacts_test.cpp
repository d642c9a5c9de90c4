#include "taut/hull/facet_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact_exits.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Shape spheres(double radius, const std::vector<dvec3>& centers) {
  Shape shape;
  for (const dvec3& c : centers) shape = shape + shifted(sphere(radius), c);
  return shape;
}

std::vector<dvec3> polygon(int corners, double z = 0) {
  std::vector<dvec3> all;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.1) / corners;
    all.emplace_back(2 * std::cos(angle), 2 * std::sin(angle), z);
  }
  return all;
}

/// The facet of a direction, checked: its contacts are in the plane, at their points, and the
/// corners of a convex polygon, counter-clockwise.
std::optional<FacetContacts> checked(const Scene& scene, const dvec3& n,
                                     const std::vector<Contact>& known = {}) {
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  std::optional<FacetContacts> f = facet_contacts(geometry, query, n, known);
  if (!f) return f;
  EXPECT_EQ(f->contacts.size(), f->points.size());
  const double h = query(n).h;
  const std::size_t count = f->points.size();
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_LT(glm::distance(geometry.point(f->contacts[k]), f->points[k]), 1e-15);
    EXPECT_NEAR(glm::dot(f->points[k], n), h, 1e-12);
    if (count < 3) continue;
    const dvec3 a = f->points[(k + 1) % count] - f->points[k];
    const dvec3 b = f->points[(k + 2) % count] - f->points[(k + 1) % count];
    EXPECT_GT(glm::dot(glm::cross(a, b), n), 0) << k;
  }
  return f;
}

std::size_t corners(const Shape& shape, const dvec3& n) {
  const Scene scene = make_scene(shape);
  const std::optional<FacetContacts> f = checked(scene, glm::normalize(n));
  return f ? f->contacts.size() : 0;
}

TEST(FacetContacts, OneContactIsNoFacet) {
  EXPECT_EQ(corners(sphere(1), {0.3, 0.4, 0.5}), 1U);
  EXPECT_EQ(corners(sphere(1), {0, 0, 1}), 1U);  // a pole, in four patches
  EXPECT_EQ(corners(sphere(1), {1, 0, 0}), 1U);  // a corner of four patches
  EXPECT_EQ(corners(box(1, 2, 3), {1, 1, 1}), 1U);
  EXPECT_EQ(corners(Shape{{}, {twisted_cubic()}, {}}, {-1, -1, -1}), 1U);
}

TEST(FacetContacts, TwoContacts) {
  EXPECT_EQ(corners(spheres(0.5, {{0, 0, 0}, {2, 0, 0}}), {0, 1, 2}), 2U);
  EXPECT_EQ(corners(box(1, 2, 3), {1, 1, 0}), 2U);  // the ends of an edge
  EXPECT_EQ(corners(cylinder(1, 2), {1, 2, 0}), 2U);
}

TEST(FacetContacts, EqualSpheres) {
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    for (const int count : {3, 4, 5, 8, 12}) {
      const Shape shape = mapped(spheres(0.3, polygon(count)), turn, {1, 2, 3});
      EXPECT_EQ(corners(shape, turn * dvec3(0, 0, 1)), std::size_t(count));
      EXPECT_EQ(corners(shape, turn * dvec3(0, 0, -1)), std::size_t(count));
    }
  }
}

TEST(FacetContacts, SpheresOnACube) {
  std::vector<dvec3> all;
  for (int k = 0; k < 8; ++k) all.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
  for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
    for (int axis = 0; axis < 3; ++axis) {
      dvec3 n(0.0);
      n[axis] = 1;
      EXPECT_EQ(corners(mapped(spheres(0.5, all), turn), turn * n), 4U);
      EXPECT_EQ(corners(mapped(spheres(0.5, all), turn), turn * -n), 4U);
    }
    EXPECT_EQ(corners(mapped(spheres(0.5, all), turn), turn * dvec3(1, 1, 1)), 1U);
  }
}

TEST(FacetContacts, CornersOfBoxesAndPoints) {
  for (const dvec3& n : {dvec3(1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, 1)}) {
    EXPECT_EQ(corners(box(1, 2, 3), n), 4U);
    EXPECT_EQ(corners(mapped(box(1, 2, 3), skew_rotation()), skew_rotation() * n), 4U);
  }
  // Curves and points together: a prism's end.
  Shape mixed{{}, {segment({0, 0, 1}, {1, 0.1, 1})}, {{0.5, 1, 1}, {0.2, 0.9, 1}, {0, 0, 0}}};
  EXPECT_EQ(corners(mixed, {0, 0, 1}), 4U);
  // As many as there may be, and one more.
  EXPECT_EQ(corners({{}, {}, polygon(int(facet_corner_limit))}, {0, 0, 1}), facet_corner_limit);
  EXPECT_EQ(corners({{}, {}, polygon(int(facet_corner_limit) + 1)}, {0, 0, 1}), 0U);
}

/// Contacts that are no corners of the contact set do not appear.
TEST(FacetContacts, InnerContactsAreNoCorners) {
  std::vector<dvec3> grid;
  for (int k = 0; k < 9; ++k) grid.emplace_back(2 * (k % 3), 2 * (k / 3), 0);
  EXPECT_EQ(corners({{}, {}, grid}, {0, 0, 1}), 4U);
  EXPECT_EQ(corners(spheres(0.4, grid), {0, 0, 1}), 4U);
  std::vector<dvec3> star = polygon(6);
  star.emplace_back(0.1, 0.1, 0);
  EXPECT_EQ(corners(spheres(0.4, star), {0, 0, 1}), 6U);
}

/// Nor do they where the search begins with them.
TEST(FacetContacts, InnerContactsThatAreKnownGo) {
  const Scene scene = make_scene(
      {{}, {}, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}, {1, 0, 0}, {1, 1, -1}}});
  const auto vertex = [](int k) { return Contact{0, SourceKind::vertex, k, 0, 0}; };
  for (const std::vector<Contact>& known : {std::vector<Contact>{vertex(4)},
                                            {vertex(5)},
                                            {vertex(0), vertex(4)},
                                            {vertex(0), vertex(5), vertex(2)},
                                            {vertex(0), vertex(1), vertex(4)}}) {
    const std::optional<FacetContacts> f = checked(scene, {0, 0, 1}, known);
    EXPECT_TRUE(f && f->contacts.size() == 4);
  }
}

TEST(FacetContacts, ContactAlongACurveGivesNone) {
  EXPECT_EQ(corners(torus(2, 0.5), {0, 0, 1}), 0U);
  EXPECT_EQ(corners(solid_cylinder(1, 2), {0, 0, 1}), 0U);
  EXPECT_EQ(corners(Shape{{}, {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {{0, 0, -1}}}, {0, 0, 1}),
            0U);
}

TEST(FacetContacts, BeginsWithTheContactsKnown) {
  const Shape shape = spheres(0.4, polygon(5));
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  const dvec3 n(0, 0, 1);
  const std::optional<FacetContacts> all = checked(scene, n);
  ASSERT_TRUE(all && all->contacts.size() == 5);
  // Any one, two or three of them, in any order.
  for (std::size_t a = 0; a < 5; ++a) {
    const auto one = checked(scene, n, {all->contacts[a]});
    EXPECT_TRUE(one && one->contacts.size() == 5) << a;
    for (std::size_t b = 0; b < 5; ++b) {
      if (b == a) continue;
      const auto two = checked(scene, n, {all->contacts[a], all->contacts[b]});
      EXPECT_TRUE(two && two->contacts.size() == 5) << a << b;
      for (std::size_t c = 0; c < 5; ++c) {
        if (c == a || c == b) continue;
        const auto three =
            checked(scene, n, {all->contacts[a], all->contacts[b], all->contacts[c]});
        EXPECT_TRUE(three && three->contacts.size() == 5) << a << b << c;
      }
    }
  }
}

/// Of balls in general position, from a ruling between the first two a little before the facet.
TEST(CommonPlane, FindsThreeContacts) {
  const dmat3 turn = skew_rotation();
  const std::vector<dvec3> centers = {turn * dvec3(0, 0, 0), turn * dvec3(2, 0, 0.1),
                                      turn * dvec3(0.9, 1.8, -0.2)};
  const Scene scene = make_scene(spheres(0.5, centers));
  const ContactGeometry geometry(scene);
  const ContactSystem system(geometry);
  SupportQuery query(scene);
  // The balls are not turned, so that their poles are elsewhere.
  const dvec3 truth = unit(glm::cross(centers[1] - centers[0], centers[2] - centers[0]));
  Random random(1);
  for (int k = 0; k < 50; ++k) {
    const dvec3 axis = glm::normalize(centers[1] - centers[0]);
    dvec3 n = glm::normalize(truth + 0.1 * random_direction(random));
    n = glm::normalize(n - glm::dot(n, axis) * axis);
    const auto contact = [&](std::size_t ball) {
      const dvec3 middle = (centers[0] + centers[1] + centers[2]) / 3.0;
      const dvec3 off = unit(centers[ball] - middle);
      // Leaning outward only its own ball supports; from there the climb leads to n.
      const std::optional<Contact> c =
          climbed(geometry, query(glm::normalize(n + 0.6 * off)).contact, n);
      EXPECT_TRUE(c);
      return c.value_or(Contact());
    };
    CommonSupport s;
    s.n = n;
    s.add(geometry, contact(0));
    s.add(geometry, contact(1));
    const std::optional<CommonSupport> plane = common_plane(system, query, s, contact(2));
    ASSERT_TRUE(plane) << k;
    EXPECT_EQ(plane->count, 3);
    EXPECT_LT(glm::distance(plane->n, truth), 1e-14);
    EXPECT_LE(query(plane->n).h, glm::dot(plane->jet[2].x, plane->n) + support_tie);
  }
}

/// Where another contact surpasses the plane of the first three it takes the third one's place.
TEST(CommonPlane, ExchangesTheThirdContact) {
  const Scene scene =
      make_scene({{}, {}, {{0, 0, 0}, {1, 0, 0}, {0.5, 1, -0.5}, {0.5, 2, -0.7}, {0, 0, -3}}});
  const ContactGeometry geometry(scene);
  const ContactSystem system(geometry);
  SupportQuery query(scene);
  const auto vertex = [](int k) { return Contact{0, SourceKind::vertex, k, 0, 0}; };
  CommonSupport s;
  s.n = glm::normalize(dvec3(0, 0.1, 1));
  s.add(geometry, vertex(0));
  s.add(geometry, vertex(1));
  const std::optional<CommonSupport> plane = common_plane(system, query, s, vertex(2));
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->contact[2].element, 3);
  EXPECT_LT(glm::distance(plane->n, unit(dvec3(0, 0.7, 2))), 1e-15);
}

}  // namespace
}  // namespace taut
