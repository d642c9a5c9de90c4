#include "taut/hull/contact_exits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "models.h"
#include "taut/bounds/support_query.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

struct Climbs {
  int tried = 0, none = 0, reached = 0;
  double fallen = 0;  ///< largest loss of height on the way
  double above = 0;   ///< largest height above the support value
};

/// Climbs from the contacts of directions turned by up to `angle`; at pi, from anywhere.
Climbs climb_nearby(const Shape& shape, double angle, int directions) {
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  SupportQuery query(scene);
  Random random(1);
  Climbs result;
  for (int k = 0; k < directions; ++k) {
    const dvec3 n = random_direction(random);
    const double turn = std::tan(std::min(0.5 * angle, 1.5));
    const dvec3 start = glm::normalize(n + turn * random_direction(random));
    const Contact from = geometry.canonical(query(start).contact);
    const std::optional<Contact> to = climbed(geometry, from, n);
    ++result.tried;
    if (!to) {
      ++result.none;
      continue;
    }
    const double h = query(n).h;
    const double value = glm::dot(geometry.point(*to), n);
    result.above = std::max(result.above, value - h);
    result.fallen = std::max(result.fallen, glm::dot(geometry.point(from), n) - value);
    if (value > h - 1e-12) ++result.reached;
  }
  return result;
}

/// On a convex surface every local maximum is the maximum: climbs from anywhere end there.
void expect_all_reach(const Shape& shape) {
  for (const Shape& placed : {shape, mapped(shape, skew_rotation(), dvec3(1, 2, 3))}) {
    const Climbs c = climb_nearby(placed, 3, 300);
    EXPECT_EQ(c.none, 0);
    EXPECT_EQ(c.reached, c.tried);
    EXPECT_LT(c.above, 1e-13);
  }
}

TEST(Climb, OverThePolesOfEllipsoids) {
  expect_all_reach(sphere(1));
  expect_all_reach(ellipsoid(3, 2, 1));
}

TEST(Climb, OverTheEdgesOfBoxesAndCylinders) {
  expect_all_reach(box(1, 2, 3));
  expect_all_reach(solid_cylinder(1, 2));
}

/// The spheres' poles are corners of cylinders and planes.
TEST(Climb, ReachesTheSupportFromNearby) {
  const Climbs pot = climb_nearby(teapot(), 0.02, 1000);
  EXPECT_LE(pot.none, 2);
  EXPECT_GE(pot.reached, 960);  // the others are beyond separating curves
  EXPECT_LT(pot.fallen, 1e-12);
  EXPECT_LT(pot.above, 1e-13);
  const Climbs dents = climb_nearby(blob(2), 0.02, 300);
  EXPECT_EQ(dents.none, 0);
  EXPECT_GE(dents.reached, 285);
  EXPECT_LT(dents.fallen, 1e-12);
}

TEST(Climb, OnCurves) {
  // A circle, and a closed curve of pieces: one maximum each.
  const Shape ring{{}, {circle({1, 2, 3}, {1, 0.2, 0}, {0, 0.5, 0.5})}, {}};
  const Climbs c = climb_nearby(ring, 3, 300);
  EXPECT_EQ(c.none, 0);
  EXPECT_EQ(c.reached, c.tried);
  // The ends of open curves are vertices.
  const Climbs open = climb_nearby({{}, {twisted_cubic()}, {}}, 0.01, 300);
  EXPECT_EQ(open.none, 0);
  EXPECT_GE(open.reached, 280);
}

TEST(Climb, StartsAtPolesAndCorners) {
  Random random(2);
  for (const Shape& shape : {sphere(1), box(1, 1, 1), solid_cylinder(1, 1)}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    SupportQuery query(scene);
    const int count = int(scene.model().parts()[0].patches().size());
    for (int k = 0; k < 200; ++k) {
      const Contact from{0, SourceKind::face, pick(random, 0, count - 1),
                         double(pick(random, 0, 1)), double(pick(random, 0, 1))};
      const dvec3 n = random_direction(random);
      const std::optional<Contact> to = climbed(geometry, from, n);
      ASSERT_TRUE(to) << k;
      EXPECT_NEAR(glm::dot(geometry.point(*to), n), query(n).h, 1e-12) << k;
    }
  }
}

TEST(Climb, ArrivesWithoutWayWhereItStands) {
  // At the maximum itself, also with parameters a little outside, which are taken back.
  const Scene scene = make_scene(sphere(1));
  const ContactGeometry geometry(scene);
  const Contact at{0, SourceKind::face, 3, 0.25, 0.5};
  const std::optional<Contact> same = climbed(geometry, at, unit_normal(geometry, at));
  ASSERT_TRUE(same);
  EXPECT_LT(glm::distance(geometry.point(*same), geometry.point(at)), 1e-14);
  Contact outside = at;
  outside.u = 1 + 1e-9;
  EXPECT_TRUE(climbed(geometry, outside, unit_normal(geometry, at)));
}

/// All contacts in the middle of the elements' borders with the exits that lead over these.
struct Gate {
  Contact contact;
  ContactExit exit;
};

std::vector<Gate> gates(const ContactGeometry& geometry) {
  using Kind = ContactExit::Kind;
  std::vector<Gate> all;
  const Part& part = geometry.scene().model().parts()[0];
  const auto add = [&](const Contact& c) {
    for (const ContactExit& exit : exits(geometry, c)) {
      Contact at = c;
      if (exit.kind == Kind::side) {
        const Side side = all_sides[std::size_t(exit.index)];
        (side == Side::u0 || side == Side::u1 ? at.u : at.v) =
            side == Side::u1 || side == Side::v1 ? 1 : 0;
      } else if (exit.kind == Kind::end) {
        at.u = exit.index;
      }
      all.push_back({at, exit});
    }
  };
  for (int p = 0; p < int(part.patches().size()); ++p) {
    add({0, SourceKind::face, p, 0.3, 0.6});
  }
  for (int p = 0; p < int(part.pieces().size()); ++p) add({0, SourceKind::edge, p, 0.7, 0});
  for (int p = 0; p < int(part.vertices().size()); ++p) add({0, SourceKind::vertex, p, 0, 0});
  return all;
}

TEST(ContactExits, AreInverseToEachOther) {
  const Shape bent =
      of_patch(BezierPatch{1, 1, {{0, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}, {1, 1, 1, 1}}});
  int number = 0;
  for (const Shape& shape :
       {sphere(1), torus(2, 0.5), box(1, 2, 3), solid_cylinder(1, 2), solid_cone(1, 2),
        filleted_box(1, 2, 3, 0.2), teapot(), bent, Shape{{}, {twisted_cubic()}, {}},
        Shape{{}, {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {}},
        Shape{{}, {segment({0, 0, 0}, {1, 0, 0}), segment({1, 0, 0}, {0.3, 1, 0.2})}, {}}}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    for (const Gate& gate : gates(geometry)) {
      const std::optional<Contact> over = beyond(geometry, gate.contact, gate.exit);
      if (gate.exit.kind == ContactExit::Kind::side &&
          is_pole(geometry, gate.contact, all_sides[std::size_t(gate.exit.index)])) {
        EXPECT_FALSE(over);
        continue;
      }
      ASSERT_TRUE(over) << number;
      EXPECT_LT(glm::distance(geometry.point(*over), geometry.point(gate.contact)), 1e-7);
      // Collapsed sides lie at vertices, which lead back to edges alone, and not to straight ones.
      if (over->kind == SourceKind::vertex &&
          (gate.contact.kind == SourceKind::face || geometry.is_straight(gate.contact))) {
        continue;
      }
      bool back = false;
      for (const ContactExit& exit : exits(geometry, *over)) {
        if (exit.kind == ContactExit::Kind::end && over->u != exit.index) continue;
        if (exit.kind == ContactExit::Kind::side) {
          const Side side = all_sides[std::size_t(exit.index)];
          const double at = side == Side::u0 || side == Side::u1 ? over->u : over->v;
          if (at != (side == Side::u1 || side == Side::v1 ? 1 : 0)) continue;
        }
        const std::optional<Contact> c = beyond(geometry, *over, exit);
        back |= c && same_element(*c, gate.contact) && std::abs(c->u - gate.contact.u) < 1e-15 &&
                std::abs(c->v - gate.contact.v) < 1e-15;
      }
      EXPECT_TRUE(back) << "shape " << number << ", kind " << int(gate.contact.kind) << ", exit "
                        << int(gate.exit.kind) << gate.exit.index;
    }
    ++number;
  }
}

CommonSupport alone(const ContactGeometry& geometry, const Contact& c, const dvec3& n) {
  CommonSupport s;
  s.n = n;
  s.add(geometry, c);
  return s;
}

TEST(ContactExits, MarginsVanishAtTheBordersAndArePositiveInside) {
  using Kind = ContactExit::Kind;
  for (const Shape& shape : {box(1, 2, 3), solid_cylinder(1, 2), filleted_box(1, 2, 3, 0.2),
                             Shape{{}, {twisted_cubic()}, {}}}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    const bool solid = !scene.model().parts()[0].patches().empty();
    const auto& patches = scene.model().parts()[0].patches();
    for (const Gate& gate : gates(geometry)) {
      Contact inside = gate.contact;
      if (gate.exit.kind == Kind::side || gate.exit.kind == Kind::end) {
        EXPECT_EQ(exit_margin(geometry, alone(geometry, inside, {0, 0, 1}), 0, gate.exit).residual,
                  0);
        inside.u = 0.3;
        inside.v = inside.kind == SourceKind::face ? 0.6 : 0;
        EXPECT_GT(exit_margin(geometry, alone(geometry, inside, {0, 0, 1}), 0, gate.exit).residual,
                  0.2);
      } else if (solid && gate.exit.kind == Kind::face) {
        // Zero at the face's own normal, positive towards the other's.
        const auto& sides = geometry.sides(inside);
        ASSERT_EQ(sides.size(), 2U);
        const auto normal = [&](const ContactGeometry::PieceSide& s) {
          const double t = s.reversed ? 1 - inside.u : inside.u;
          const bool across = s.side == Side::u0 || s.side == Side::u1;
          const double end = s.side == Side::u1 || s.side == Side::v1 ? 1 : 0;
          const BezierPatch& b = patches[std::size_t(s.patch)].bezier;
          const dvec3 m = across ? unit_normal(b, end, t) : unit_normal(b, t, end);
          // These bodies hold their centre inside.
          const dvec3 center = geometry.scene().frame().to_frame(scene.box().center());
          return glm::dot(m, geometry.point(inside) - center) < 0 ? -m : m;
        };
        const dvec3 own = normal(sides[std::size_t(gate.exit.index)]);
        const dvec3 other = normal(sides[1 - std::size_t(gate.exit.index)]);
        EXPECT_NEAR(exit_margin(geometry, alone(geometry, inside, own), 0, gate.exit).residual, 0,
                    1e-14);
        const dvec3 between = glm::normalize(own + other);
        EXPECT_GT(exit_margin(geometry, alone(geometry, inside, between), 0, gate.exit).residual,
                  0.1);
      } else if (solid && gate.exit.kind == Kind::edge) {
        const dvec3 center = geometry.scene().frame().to_frame(scene.box().center());
        const dvec3 n = glm::normalize(geometry.point(inside) - center);
        EXPECT_GT(exit_margin(geometry, alone(geometry, inside, n), 0, gate.exit).residual, 0.1);
      }
    }
  }
}

/// The linearisation against differences; that of the angle to a face holds where it is zero.
TEST(ContactExits, MarginsAreLinearised) {
  Random random(4);
  for (const Shape& shape : {solid_cylinder(1, 2), solid_cone(1, 2), spherical_cap(0.6),
                             of_patch(random_patch(random, 3, 2, 3))}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    for (const Gate& gate : gates(geometry)) {
      dvec3 n = random_direction(random);
      CommonSupport s = alone(geometry, gate.contact, n);
      // Onto the margin's zero.
      LinearEquation e = exit_margin(geometry, s, 0, gate.exit);
      if (glm::length(e.n) == 0 && e.parameter[0] == dvec2(0.0)) continue;  // a collapsed side
      s.n = glm::normalize(n - e.residual * e.n);
      e = exit_margin(geometry, s, 0, gate.exit);
      ASSERT_NEAR(e.residual, 0, 1e-15);
      const double h = 1e-6;
      const dvec3 turn = random_direction(random);
      CommonSupport turned = s;
      turned.n = s.n + h * turn;
      EXPECT_NEAR((exit_margin(geometry, turned, 0, gate.exit).residual - e.residual) / h,
                  glm::dot(e.n, turn), 1e-8);
      for (int a = 0; a < s.jet[0].dimension; ++a) {
        double difference = 0;
        for (const double side : {1.0, -1.0}) {
          CommonSupport moved = s;
          (a == 0 ? moved.contact[0].u : moved.contact[0].v) += side * h;
          moved.evaluate(geometry);
          difference += side * exit_margin(geometry, moved, 0, gate.exit).residual / (2 * h);
        }
        EXPECT_NEAR(difference, e.parameter[0][a], 1e-7)
            << "exit " << int(gate.exit.kind) << gate.exit.index << " parameter " << a;
      }
    }
  }
}

TEST(Poles, AreToldFromTipsAndCorners) {
  const auto poles = [](const Shape& shape) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    int count = 0;
    for (int p = 0; p < int(scene.model().parts()[0].patches().size()); ++p) {
      for (const Side side : all_sides) {
        Contact c{0, SourceKind::face, p, 0.4, 0.4};
        if (!is_pole(geometry, c, side)) continue;
        ++count;
        EXPECT_FALSE(pole_side(geometry, c));
        (side == Side::u0 || side == Side::u1 ? c.u : c.v) =
            side == Side::u1 || side == Side::v1 ? 1 : 0;
        EXPECT_EQ(pole_side(geometry, c), side);
        EXPECT_NEAR(glm::length(unit_normal(geometry, c)), 1, 1e-15);
      }
    }
    return count;
  };
  EXPECT_EQ(poles(sphere(1)), 8);
  EXPECT_EQ(poles(mapped(sphere(1), skew_rotation(), dvec3(1e3, 0, 0))), 8);
  EXPECT_EQ(poles(cone(1, 2)), 0);
  EXPECT_EQ(poles(torus(2, 1)), 0);
  EXPECT_EQ(poles(box(1, 1, 1)), 0);
}

TEST(Poles, ClimbsBesideThem) {
  for (const bool turned : {false, true}) {
    const Shape shape = turned ? mapped(ellipsoid(3, 2, 1), skew_rotation()) : ellipsoid(3, 2, 1);
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    SupportQuery query(scene);
    const dvec3 axis = turned ? skew_rotation() * dvec3(0, 0, 1) : dvec3(0, 0, 1);
    const Contact top = query(axis).contact;
    const std::optional<Side> side = pole_side(geometry, top);
    ASSERT_TRUE(side);
    EXPECT_NEAR(std::abs(glm::dot(unit_normal(geometry, top), axis)), 1, 1e-12);
    Random random(5);
    for (int k = 0; k < 100; ++k) {
      const double turn = log_uniform(random, 1e-6, 0.1);
      const dvec3 n = glm::normalize(axis + turn * random_direction(random));
      const std::optional<Contact> c = beside_pole(geometry, top, n);
      ASSERT_TRUE(c) << turn;
      EXPECT_NEAR(glm::dot(geometry.point(*c), n), query(n).h, 1e-13) << turn;
    }
  }
}

TEST(MoveTogether, OverJoinsEdgesAndVertices) {
  const Scene scene = make_scene(solid_cylinder(1, 2));
  const ContactGeometry geometry(scene);
  int moved = 0;
  for (const Gate& gate : gates(geometry)) {
    if (gate.exit.kind == ContactExit::Kind::face || gate.exit.kind == ContactExit::Kind::edge) {
      continue;
    }
    const std::optional<Contact> over = beyond(geometry, gate.contact, gate.exit);
    if (!over) continue;  // the poles of the discs
    Contact a = gate.contact;
    const double inwards = 1e-4;
    if (gate.exit.kind == ContactExit::Kind::side) {
      const Side side = all_sides[std::size_t(gate.exit.index)];
      (side == Side::u0   ? a.u
       : side == Side::u1 ? a.u
                          : a.v) += side == Side::u0 || side == Side::v0 ? inwards : -inwards;
    } else {
      a.u += gate.exit.index == 0 ? inwards : -inwards;
    }
    for (const bool swapped : {false, true}) {
      Contact first = swapped ? *over : a;
      Contact second = swapped ? a : *over;
      move_together(geometry, first, second);
      EXPECT_LT(glm::distance(geometry.point(first), geometry.point(second)), 1e-12);
      EXPECT_TRUE(same_element(swapped ? second : first, a));
      ++moved;
    }
  }
  EXPECT_GT(moved, 50);
  // Where there is no border between them, and in one element, they stay.
  Contact a{0, SourceKind::face, 0, 0.3, 0.3};
  Contact b = a;
  b.u = 0.6;
  move_together(geometry, a, b);
  EXPECT_TRUE(a.u == 0.3 && b.u == 0.6);
}

}  // namespace
}  // namespace taut
