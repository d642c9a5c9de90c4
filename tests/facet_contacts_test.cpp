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
