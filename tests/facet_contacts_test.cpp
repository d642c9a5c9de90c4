#include "taut/hull/contact/facet_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models.h"
#include "taut/bounds/contact_forms.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/solve/facet_corners.h"
#include "taut/hull/solve/level_pieces.h"

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

/// @name Planes that contain curves
/// @{

Shape ring(const dvec2& center, double radius) {
  const dvec3 c(center, 0.0);
  return {{}, {circle(c, {radius, 0, 0}, {0, radius, 0})}, {}};
}

Shape points(const std::vector<dvec3>& all) { return {{}, {}, all}; }

/// A point beneath the plane z = 0, so that the scene has an inside.
Shape below() { return points({{0.2, 0.1, -1}}); }

/// Two discs whose centres lie d apart, d > R - r.
double area_of_two_discs(double R, double r, double d) {
  const double angle = std::acos((R - r) / d);
  return R * R * (pi - angle) + r * r * angle + std::sqrt(d * d - (R - r) * (R - r)) * (R + r);
}

struct CurvedFacet {
  const char* name;
  Shape shape;
  dvec3 n;
  double area;
  int curved, straight;  // sides
};

std::vector<CurvedFacet> curved_facets() {
  const dvec3 up(0, 0, 1);
  const Shape disc_of_one = ring({0, 0}, 1);
  const Shape half = {{}, {half_circle(dvec3(0.0), {1, 0, 0}, {0, 1, 0})}, {}};
  const double with_a_point = area_of_two_discs(1, 0, 3);
  const Shape beside = shifted(sphere(0.5), {3, 0, -0.5});
  const Shape inside = points({{0.3, 0.1, 0}, {-0.2, 0.5, 0}, {0, 0, 0}});
  return {
      {"lid of a cylinder", cylinder(1, 2), up, pi, 4, 0},
      {"its other lid", solid_cylinder(1, 2), -up, pi, 4, 0},
      {"torus", torus(2, 0.5), up, 4 * pi, 4, 0},
      {"frustum", frustum(1, 0.5, 2), up, pi / 4, 4, 0},
      {"stadium", disc_of_one + ring({3, 0}, 1) + below(), up, pi + 6, 4, 2},
      {"overlapping discs", disc_of_one + ring({1, 0}, 1) + below(), up, pi + 2, 4, 2},
      {"discs of two sizes", disc_of_one + ring({3, 0}, 0.5) + below(), up,
       area_of_two_discs(1, 0.5, 3), 4 + 2, 2},
      {"a disc within another", disc_of_one + ring({0.2, 0.1}, 0.5) + below(), up, pi, 4, 0},
      {"a point outside", disc_of_one + points({{3, 0, 0}}) + below(), up, with_a_point, 4, 2},
      {"a ball beside", disc_of_one + beside, up, with_a_point, 4, 2},
      {"four points outside",
       disc_of_one + points({{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}}) + below(), up, 18, 0,
       4},
      {"half disc", half + below(), up, pi / 2, 2, 1},
      {"half disc and a point", half + points({{-1, 0, 0}}) + below(), up, pi / 2 + 1, 2, 2},
      {"contacts inside", disc_of_one + inside + below(), up, pi, 4, 0},
      {"a ball that touches inside", disc_of_one + shifted(sphere(0.3), {0.2, 0.1, -0.3}), up, pi,
       4, 0},
      {"a segment inside",
       disc_of_one + Shape{{}, {segment({0.5, 0, 0}, {0, 0.5, 0})}, {}} + below(), up, pi, 4, 0},
      {"a segment across", disc_of_one + Shape{{}, {segment({3, 0, 0}, {-3, 0, 0})}, {}} + below(),
       up, 2 * with_a_point - pi, 4, 4},
      {"a wall of the paraboloid", paraboloid(), {1, 0, 0}, 4.0 / 3, 1, 1},
      {"a wall of the saddle", saddle(), {0, 1, 0}, 4.0 / 3, 1, 1},
  };
}

std::vector<Contact> pieces_of(const ContactGeometry& geometry, SupportQuery& query,
                               const dvec3& n) {
  return level_pieces(geometry, query, n, geometry.tie()).pieces;
}

/// The outline's points, finely, each side without its end.
std::vector<dvec3> outline_of(const ContactGeometry& geometry, const FacetContacts& f) {
  constexpr int steps = 256;
  std::vector<dvec3> all;
  for (std::size_t k = 0; k < f.points.size(); ++k) {
    if (!f.is_curved(k)) {
      all.push_back(f.points[k]);
      continue;
    }
    const EdgeStretch& s = f.sides[k];
    all.reserve(all.size() + steps);
    for (int i = 0; i < steps; ++i) {
      const double t = s.from + (s.to - s.from) * i / steps;
      all.push_back(geometry.point({s.instance, SourceKind::edge, s.piece, t, 0}));
    }
  }
  return all;
}

/// Sides lie between their contacts, the outline turns to the left, and all of it supports.
void expect_sound(const ContactGeometry& geometry, const FacetContacts& f, const dvec3& n,
                  double h) {
  const std::size_t count = f.contacts.size();
  ASSERT_EQ(f.points.size(), count);
  ASSERT_EQ(f.sides.size(), count);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_LT(glm::distance(geometry.point(f.contacts[k]), f.points[k]), 1e-15);
    const Contact own = geometry.canonical(f.contacts[k]);
    EXPECT_TRUE(same_element(own, f.contacts[k]));
    if (!f.is_curved(k)) continue;
    const EdgeStretch& s = f.sides[k];
    const auto at = [&](double t) {
      return geometry.point({s.instance, SourceKind::edge, s.piece, t, 0});
    };
    EXPECT_LT(glm::distance(at(s.from), f.points[k]), 1e-12);
    EXPECT_LT(glm::distance(at(s.to), f.points[(k + 1) % count]), 1e-12);
  }
  const std::vector<dvec3> outline = outline_of(geometry, f);
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const dvec3& a = outline[k];
    const dvec3& b = outline[(k + 1) % outline.size()];
    const dvec3& c = outline[(k + 2) % outline.size()];
    EXPECT_NEAR(glm::dot(a, n), h, 1e-12);
    EXPECT_GT(glm::dot(glm::cross(unit(b - a), unit(c - b)), n), -1e-9);
  }
}

double area_of(const std::vector<dvec3>& outline, const dvec3& n) {
  dvec3 sum(0.0);
  for (std::size_t k = 0; k < outline.size(); ++k) {
    sum += glm::cross(outline[k] - outline[0], outline[(k + 1) % outline.size()] - outline[0]);
  }
  return 0.5 * glm::dot(sum, n);
}

void expect_facet(const Scene& scene, const dvec3& n, const CurvedFacet& each,
                  const std::vector<Contact>& known) {
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  const std::vector<Contact> pieces = pieces_of(geometry, query, n);
  ASSERT_FALSE(pieces.empty());
  const std::optional<FacetContacts> f = facet_contacts(geometry, query, n, known, pieces);
  ASSERT_TRUE(f);
  EXPECT_TRUE(f->is_facet());
  EXPECT_EQ(f->is_curved(), each.curved > 0);
  int curved = 0;
  for (std::size_t k = 0; k < f->contacts.size(); ++k) curved += f->is_curved(k) ? 1 : 0;
  EXPECT_EQ(curved, each.curved);
  EXPECT_EQ(int(f->contacts.size()), each.curved + each.straight);
  expect_sound(geometry, *f, n, query(n).h);
  const double scale = scene.frame().scale;
  // Chords of a 256th of a side leave out 1 / 256^2 of what lies beneath a parabola.
  EXPECT_NEAR(area_of(outline_of(geometry, *f), n) / (scale * scale), each.area, 2e-5 * each.area);
}

TEST(CurvedFacets, OfPlanesWithCurves) {
  for (const CurvedFacet& each : curved_facets()) {
    for (const dmat3& turn : {dmat3(1.0), skew_rotation()}) {
      SCOPED_TRACE(each.name);
      const Scene scene = make_scene(mapped(each.shape, turn, {0.1, -0.2, 0.3}));
      const dvec3 n = glm::normalize(turn * each.n);
      expect_facet(scene, n, each, {});
      const ContactGeometry geometry(scene);
      SupportQuery query(scene);
      expect_facet(scene, n, each, {at_rest(geometry, query(n).contact, n)});
    }
  }
}

/// From any of its corners, and from contacts inside of it.
TEST(CurvedFacets, BeginWithTheContactsKnown) {
  const Shape shape = ring({0, 0}, 1) + points({{3, 0, 0}, {0.1, 0.2, 0}, {0, -0.5, 0}}) + below();
  const CurvedFacet expected = {"", shape, {0, 0, 1}, area_of_two_discs(1, 0, 3), 4, 2};
  const Scene scene = make_scene(shape);
  for (int a = 0; a < 3; ++a) {
    const Contact one{0, SourceKind::vertex, a, 0, 0};
    expect_facet(scene, {0, 0, 1}, expected, {one});
    for (int p = 0; p < 4; ++p) {
      const Contact on_the_ring{0, SourceKind::edge, p, 0.3, 0};
      expect_facet(scene, {0, 0, 1}, expected, {one, on_the_ring});
      expect_facet(scene, {0, 0, 1}, expected, {on_the_ring, one});
    }
  }
}

/// Pieces of one part in two places, and of a part that is there twice.
TEST(CurvedFacets, OfInstances) {
  const CurvedFacet stadium = {"", {}, {0, 0, 1}, pi + 6, 4, 2};
  Model model = make_model(cylinder(1, 2));
  model.add_instance(0, {dmat3(1.0), {3, 0, 0}});
  expect_facet(Scene(model, {.threads = 1, .progress = {}}), {0, 0, 1}, stadium, {});
  model.add_instance(0, {dmat3(1.0), {3, 0, 0}});
  expect_facet(Scene(model, {.threads = 1, .progress = {}}), {0, 0, 1}, stadium, {});
  model.add_instance(0, {dmat3(1.0), {1.5, 0, -1}});  // lower
  expect_facet(Scene(model, {.threads = 1, .progress = {}}), {0, 0, 1}, stadium, {});
}

TEST(CurvedFacets, WhatIsAFacet) {
  FacetContacts f;
  EXPECT_FALSE(f.is_facet() || f.is_curved());
  f.contacts.resize(2);
  f.points.resize(2);
  EXPECT_FALSE(f.is_facet());
  f.sides = {{}, {0, 3, 0.2, 0.7}};
  EXPECT_TRUE(f.is_facet() && f.is_curved() && f.is_curved(1));
  EXPECT_FALSE(f.is_curved(0));
  f.sides = {{}, {}};
  EXPECT_FALSE(f.is_facet() || f.is_curved());
  f.contacts.resize(3);
  EXPECT_TRUE(f.is_facet());
}

/// @}

/// The edges of a box in two pieces each: those run along its top's sides that no arc leaves
/// across.
TEST(FacetCorners, StraightSidesRunAlongEdges) {
  const Scene scene = make_scene(split(box(1, 2, 3), 0.25, 0.5));
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  std::vector<Contact> corners;
  for (const dvec3& n : {dvec3(-1, -1, 9), dvec3(1, -1, 9), dvec3(1, 1, 9), dvec3(-1, 1, 9)}) {
    corners.push_back(geometry.canonical(query(unit(n)).contact));
  }
  FacetNode top{{0, 0, 1}, corners, {}, {}, {}};
  for (const Contact& c : corners) top.points.push_back(geometry.point(c));
  top.slots.assign(4, {});
  FacetNode with_arcs = top;
  for (FacetNode::Slot& slot : with_arcs.slots) slot.arc = 0;
  run_along_edges(geometry, 1e-9, with_arcs);
  EXPECT_EQ(with_arcs.contacts.size(), 4U);
  EXPECT_TRUE(with_arcs.sides.empty());

  top.slots[2].arc = 0;
  run_along_edges(geometry, 1e-9, top);
  ASSERT_EQ(top.sides.size(), 7U);
  ASSERT_EQ(top.slots.size(), 7U);
  double around = 0;
  for (std::size_t k = 0; k < 7; ++k) {
    const dvec3& next = top.points[(k + 1) % 7];
    EXPECT_EQ(top.is_curved(k), top.slots[k].arc < 0);
    around += glm::distance(top.points[k], next);
    EXPECT_LE(glm::distance(geometry.point(top.contacts[k]), top.points[k]), 1e-15);
    if (!top.is_curved(k)) continue;
    const EdgeStretch& s = top.sides[k];
    EXPECT_LE(glm::distance(geometry.point(s.at(s.from)), top.points[k]), 1e-15);
    EXPECT_LE(glm::distance(geometry.point(s.at(s.to)), next), 1e-15);
  }
  EXPECT_NEAR(around, scene.frame().length_to_frame(6), 1e-14);
}

}  // namespace
}  // namespace taut
