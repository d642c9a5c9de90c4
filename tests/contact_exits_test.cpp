#include "taut/bounds/contact_exits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "freeform.h"
#include "models.h"
#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_forms.h"
#include "taut/bounds/poles.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/contact/exit_margins.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/level_sides.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// Two caps that meet in a sharp rim.
Shape lens() {
  return shifted(spherical_cap(0.6), {0, 0, -0.4}) +
         shifted(mapped(spherical_cap(0.6), {1, 0, 0, 0, -1, 0, 0, 0, -1}), {0, 0, 0.4});
}

/// A cap on its plane lid.
Shape dome() { return spherical_cap(0.6) + disc(std::sqrt(1 - 0.4 * 0.4), 0.4); }

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

TEST(Climb, OverSharpEdges) {
  expect_all_reach(lens());
  expect_all_reach(dome());
}

/// From beside a seam, over the rim: a step that ends on the seam ends there exactly.
TEST(Climb, FromBesideASeam) {
  const Scene scene = make_scene(lens());
  const ContactGeometry geometry(scene);
  const Contact from{0, SourceKind::face, 1, 0.011948842165175831, 0.87358421731147251};
  EXPECT_TRUE(
      climbed(geometry, from, {0.64265242485209073, 0.70762547808354426, -0.29370741154891439}));
}

TEST(Climb, StaysOffStraightEdgesAndRuledPatches) {
  Random random(8);
  // At a box's vertex, whatever the direction; off a straight edge, at its higher end.
  const Scene block = make_scene(box(1, 2, 3));
  const ContactGeometry corners(block);
  for (int k = 0; k < 100; ++k) {
    const dvec3 n = random_direction(random);
    const Contact vertex{0, SourceKind::vertex, pick(random, 0, 7), 0, 0};
    const std::optional<Contact> same = climbed(corners, vertex, n);
    ASSERT_TRUE(same);
    EXPECT_TRUE(same_element(*same, vertex));
    const Contact edge{0, SourceKind::edge, pick(random, 0, 11), uniform(random, 0.1, 0.9), 0};
    const std::optional<Contact> end = climbed(corners, edge, n);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->kind, SourceKind::vertex);
    double highest = -2;
    for (const double t : {0.0, 1.0}) {
      const Contact at{0, SourceKind::edge, edge.element, t, 0};
      highest = std::max(highest, glm::dot(corners.point(at), n));
    }
    EXPECT_NEAR(glm::dot(corners.point(*end), n), highest, 1e-15);
  }
  // On each circle of a cylinder, at its highest point, though the other circle may be higher.
  const Scene can = make_scene(solid_cylinder(1, 2));
  const ContactGeometry circles(can);
  const double scale = can.frame().scale;
  int overtopped = 0;
  for (int k = 0; k < 100; ++k) {
    const dvec3 n = random_direction(random);
    const Contact from{0, SourceKind::edge, pick(random, 0, 7), uniform(random, 0, 1), 0};
    const std::optional<Contact> to = climbed(circles, from, n);
    ASSERT_TRUE(to);
    EXPECT_EQ(to->kind, SourceKind::edge);
    EXPECT_NEAR(circles.point(*to).z, circles.point(from).z, 1e-15);
    const double z = circles.point(from).z;
    EXPECT_NEAR(glm::dot(circles.point(*to), n), scale * std::hypot(n.x, n.y) + z * n.z, 1e-14);
    overtopped += z * n.z < 0 ? 1 : 0;
  }
  EXPECT_GT(overtopped, 20);
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

/// Strips of z = -a x^2 - b y^2 - kink |x| over |y| <= 1, between these values of x.
Shape parabolic_strips(const std::vector<double>& x, double a, double b, double kink) {
  Shape result;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const std::array<double, 3> along = {x[k], 0.5 * (x[k] + x[k + 1]), x[k + 1]};
    const std::array<double, 3> squares = {x[k] * x[k], x[k] * x[k + 1], x[k + 1] * x[k + 1]};
    BezierPatch strip{2, 2, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double z = -a * squares[i] - b * (j == 1 ? -1 : 1) - kink * std::abs(along[i]);
        strip.points.emplace_back(along[i], j - 1, z, 1);
      }
    }
    result.surfaces.push_back(as_nurbs(strip));
  }
  return result;
}

TEST(Climb, OverManyPatches) {
  std::vector<double> x(101);
  std::iota(x.begin(), x.end(), 0);
  const Scene scene = make_scene(parabolic_strips(x, 1e-3, 0.1, 0));
  const ContactGeometry geometry(scene);
  const std::optional<Contact> top =
      climbed(geometry, {0, SourceKind::face, 0, 0.5, 0.5}, unit(dvec3(2e-3 * 98.25, 0, 1)));
  ASSERT_TRUE(top);
  EXPECT_LT(glm::distance(scene.frame().to_model(geometry.point(*top)),
                          dvec3(98.25, 0, -1e-3 * 98.25 * 98.25)),
            1e-9);
}

/// Along a join that is a ridge, if one that counts as smooth: the maximum on it is met, though no
/// direction near it is normal to a patch there.
TEST(Climb, AlongARidge) {
  const Scene scene = make_scene(parabolic_strips({-1, 0, 1}, 0.3, 0.4, 2e-4));
  const ContactGeometry geometry(scene);
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    const double y = uniform(random, -0.9, 0.9);
    const double lean = uniform(random, -1e-4, 1e-4);
    const dvec3 n = unit(dvec3(lean, 0.8 * y, 1));
    const Contact from{0, SourceKind::face, pick(random, 0, 1), uniform(random, 0.1, 0.9),
                       uniform(random, 0.1, 0.9)};
    const ClimbedContact top = climb(geometry, from, n);
    EXPECT_LT(glm::distance(scene.frame().to_model(top.x), dvec3(0, y, -0.4 * y * y)), 1e-8) << k;
    EXPECT_EQ(top.h, glm::dot(top.x, n));
    EXPECT_EQ(geometry.point(top.contact), top.x);
    // Where the direction leaves the ridge, the climb does.
    const dvec3 aside = unit(dvec3(std::copysign(0.1, lean), 0.8 * y, 1));
    const std::optional<Contact> off = climbed(geometry, top.contact, aside);
    ASSERT_TRUE(off) << k;
    EXPECT_LT(glm::length(glm::cross(unit_normal(geometry, *off), aside)), 1e-9) << k;
  }
}

TEST(Climb, StartsAtPolesAndCorners) {
  Random random(2);
  for (const Shape& shape : {sphere(1), lens(), dome()}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    SupportQuery query(scene);
    const int count = int(scene.model().parts()[0].patches().size());
    for (int k = 0; k < 200; ++k) {
      const Contact from{0, SourceKind::face, pick(random, 0, count - 1),
                         double(pick(random, 0, 1)), double(pick(random, 0, 1))};
      if (geometry.is_ruled(from)) continue;
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
  const dvec3 n = unit(geometry.point(at));
  const std::optional<Contact> same = climbed(geometry, at, n);
  ASSERT_TRUE(same);
  EXPECT_LT(glm::distance(geometry.point(*same), geometry.point(at)), 1e-14);
  Contact outside = at;
  outside.u = 1 + 1e-9;
  EXPECT_TRUE(climbed(geometry, outside, n));
  // Off the minimum, which is stationary too.
  const std::optional<Contact> other = climbed(geometry, at, -n);
  ASSERT_TRUE(other);
  EXPECT_LT(glm::distance(geometry.point(*other), -geometry.point(at)), 1e-14);
}

/// All contacts in the middle of the elements' borders with the exits that lead over these. Ruled
/// patches have no contacts of their own.
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
    if (!part.patches()[std::size_t(p)].ruled()) add({0, SourceKind::face, p, 0.3, 0.6});
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

dvec3 center_of(const ContactGeometry& geometry) {
  return geometry.scene().frame().to_frame(geometry.scene().box().center());
}

/// The face's normal at a contact on its edge, of a body that holds its centre inside.
dvec3 outward_normal(const ContactGeometry& geometry, const Contact& edge,
                     const ContactGeometry::PieceSide& s) {
  const dvec2 uv = on_side(s.side, s.reversed ? 1 - edge.u : edge.u);
  const dvec3 n = unit_normal(geometry, {edge.instance, SourceKind::face, s.patch, uv.x, uv.y});
  return glm::dot(n, geometry.point(edge) - center_of(geometry)) < 0 ? -n : n;
}

TEST(ContactExits, MarginsVanishAtTheBordersAndArePositiveInside) {
  using Kind = ContactExit::Kind;
  int creases = 0;
  for (const Shape& shape : {box(1, 2, 3), lens(), dome(), filleted_box(1, 2, 3, 0.2),
                             Shape{{}, {twisted_cubic()}, {}}}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    const bool solid = !scene.model().parts()[0].patches().empty();
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
        std::vector<ContactGeometry::PieceSide> sides = geometry.sides(inside);
        const auto& ruled = geometry.ruled_sides(inside);
        sides.insert(sides.end(), ruled.begin(), ruled.end());
        ASSERT_EQ(sides.size(), 2U);
        const auto normal = [&](const ContactGeometry::PieceSide& s) {
          return outward_normal(geometry, inside, s);
        };
        const dvec3 own = normal(sides[std::size_t(gate.exit.index)]);
        const dvec3 other = normal(sides[1 - std::size_t(gate.exit.index)]);
        EXPECT_NEAR(exit_margin(geometry, alone(geometry, inside, own), 0, gate.exit).residual, 0,
                    1e-14);
        const dvec3 between = glm::normalize(own + other);
        const double bend = glm::length(glm::cross(own, between));
        EXPECT_NEAR(exit_margin(geometry, alone(geometry, inside, between), 0, gate.exit).residual,
                    bend, 1e-14);
        creases += bend > 0.1 ? 1 : 0;
      } else if (solid && gate.exit.kind == Kind::edge) {
        const ContactGeometry::PieceEnd& end = geometry.ends(inside)[std::size_t(gate.exit.index)];
        const Contact at{0, SourceKind::edge, end.piece, double(end.end), 0};
        if (scene.model().parts()[0].pieces()[std::size_t(end.piece)].edge < 0) {
          // A seam, at whose ends one plane alone supports.
          const dvec3 n = outward_normal(geometry, at, geometry.sides(at)[0]);
          EXPECT_NEAR(exit_margin(geometry, alone(geometry, inside, n), 0, gate.exit).residual, 0,
                      1e-14);
          continue;
        }
        const dvec3 n = unit(geometry.point(inside) - center_of(geometry));
        EXPECT_GT(exit_margin(geometry, alone(geometry, inside, n), 0, gate.exit).residual, 0.1);
      }
    }
  }
  EXPECT_GE(creases, 8 + 4);  // of the lens and the dome
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
      ASSERT_NEAR(e.residual, 0, 1e-14);
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

TEST(MoveTogether, OverJoinsEdgesAndVertices) {
  const Scene scene = make_scene(lens());
  const ContactGeometry geometry(scene);
  int moved = 0;
  for (const Gate& gate : gates(geometry)) {
    if (gate.exit.kind == ContactExit::Kind::face || gate.exit.kind == ContactExit::Kind::edge) {
      continue;
    }
    const std::optional<Contact> over = beyond(geometry, gate.contact, gate.exit);
    if (!over) continue;  // the poles of the caps
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

void expect_contact(const Contact& is, const Contact& expected) {
  EXPECT_TRUE(same_element(is, expected)) << int(is.kind) << ' ' << is.element << " for "
                                          << int(expected.kind) << ' ' << expected.element;
  EXPECT_DOUBLE_EQ(is.u, expected.u);
  EXPECT_DOUBLE_EQ(is.v, expected.v);
}

TEST(Snapped, OntoBordersEndsAndCorners) {
  constexpr double near = 1e-9;
  const Scene scene = make_scene(mapped(paraboloid(), skew_rotation()));
  const ContactGeometry geometry(scene);
  const ContactJet corner = geometry.jet({0, SourceKind::face, 0, 0, 0});
  const double half_u = 0.5 * near / glm::length(corner.dx[0]);
  const double half_v = 0.5 * near / glm::length(corner.dx[1]);
  const auto face = [](double u, double v) { return Contact{0, SourceKind::face, 0, u, v}; };
  struct Case {
    const char* name;
    Contact from, at;  // at: whose canonical form it becomes
  };
  const std::vector<Case> cases = {
      {"inside", face(0.3, 0.6), face(0.3, 0.6)},
      {"on a border", face(0, 0.6), face(0, 0.6)},
      {"beside u = 0", face(half_u, 0.6), face(0, 0.6)},
      {"a little outside", face(-half_u, 0.6), face(0, 0.6)},
      {"beside v = 1", face(0.3, 1 - half_v), face(0.3, 1)},
      {"beside a corner", face(half_u, half_v), face(0, 0)},
      {"just too far", face(4 * half_u, 0.6), face(4 * half_u, 0.6)},
      {"near one border only", face(4 * half_u, half_v), face(4 * half_u, 0)},
      {"an edge's end", {0, SourceKind::edge, 1, 1 - half_u, 0}, {0, SourceKind::edge, 1, 1, 0}},
      {"far from it", {0, SourceKind::edge, 1, 0.999, 0}, {0, SourceKind::edge, 1, 0.999, 0}},
      {"a vertex", {0, SourceKind::vertex, 2, 0, 0}, {0, SourceKind::vertex, 2, 0, 0}},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    expect_contact(snapped(geometry, each.from, near), geometry.canonical(each.at));
  }
  // By distances, not parameters: along a long patch the same parameter is far from the border.
  const Scene wide = make_scene(mapped(paraboloid(), dmat3(1000, 0, 0, 0, 1, 0, 0, 0, 1)));
  const ContactGeometry stretched(wide);
  const double share = 1e-3;
  const double across = glm::length(stretched.jet(face(0.5, 0)).dx[1]);
  expect_contact(snapped(stretched, face(0.5, share), 1.5 * share * across),
                 stretched.canonical(face(0.5, 0)));
  expect_contact(snapped(stretched, face(share, 0.5), 1.5 * share * across), face(share, 0.5));
}

/// Onto the collapsed side of a cone's tip from parameters that are anything but near to it.
TEST(Snapped, OntoTipsWhereAllParametersMeet) {
  const Scene scene = make_scene(cone(1, 2));
  const ContactGeometry geometry(scene);
  const Contact tip = geometry.canonical({0, SourceKind::face, 2, 0.4, 1});
  ASSERT_EQ(tip.kind, SourceKind::vertex);
  expect_contact(snapped(geometry, {0, SourceKind::face, 2, 0.4, 1 - 1e-11}, 1e-9), tip);
}

TEST(ExpressedIn, OverEveryBorder) {
  for (const Shape& shape :
       {sphere(1), torus(2, 0.5), lens(), filleted_box(1, 2, 3, 0.2), paraboloid(),
        Shape{{}, {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})}, {}}}) {
    const Scene scene = make_scene(mapped(shape, skew_rotation()));
    const ContactGeometry geometry(scene);
    int crossed = 0;
    for (const Gate& gate : gates(geometry)) {
      const std::optional<Contact> over = beyond(geometry, gate.contact, gate.exit);
      if (!over) continue;
      for (const bool back : {false, true}) {
        const Contact& from = back ? *over : gate.contact;
        const Contact& to = back ? gate.contact : *over;
        // Into another element: where it stands does not matter.
        const std::optional<Contact> c =
            expressed_in(geometry, from, {to.instance, to.kind, to.element, 0.37, 0.21});
        if (back && from.kind == SourceKind::edge && to.kind == SourceKind::face &&
            geometry.is_ruled(to))
          continue;
        ASSERT_TRUE(c) << "kind " << int(from.kind) << " exit " << int(gate.exit.kind) << back;
        EXPECT_TRUE(same_element(*c, to));
        EXPECT_LT(glm::distance(geometry.point(*c), geometry.point(from)), 1e-15);
        ++crossed;
      }
    }
    EXPECT_GE(crossed, 8);
  }
}

TEST(ExpressedIn, NoneWhereTheyDoNotMeet) {
  Model model = make_model(lens());
  model.add_instance(0, {dmat3(1.0), {5, 0, 0}});
  const Scene scene(std::move(model), {.threads = 1, .progress = {}});
  const ContactGeometry geometry(scene);
  const Contact on_rim{0, SourceKind::edge, 0, 0.3, 0};
  // In itself it is as it was.
  expect_contact(expressed_in(geometry, on_rim, on_rim).value_or(Contact()), on_rim);
  int meets = 0;
  for (int p = 0; p < 8; ++p) {
    const std::optional<Contact> c =
        expressed_in(geometry, on_rim, {0, SourceKind::face, p, 0.5, 0.5});
    if (!c) continue;
    ++meets;
    EXPECT_LT(glm::distance(geometry.point(*c), geometry.point(on_rim)), 1e-15);
  }
  EXPECT_EQ(meets, 2);
  EXPECT_FALSE(expressed_in(geometry, on_rim, {1, SourceKind::edge, 0, 0.3, 0}));
  EXPECT_FALSE(expressed_in(geometry, on_rim, {0, SourceKind::edge, 1, 0.3, 0}));
  // Inside of a patch it lies in no border.
  for (int p = 0; p < 4; ++p) {
    EXPECT_FALSE(expressed_in(geometry, {0, SourceKind::edge, p, 0.3, 0},
                              {0, SourceKind::edge, (p + 1) % 4, 0, 0}));
    EXPECT_FALSE(
        expressed_in(geometry, {0, SourceKind::face, p, 0.3, 0.4}, {0, SourceKind::edge, p, 0, 0}));
  }
}

/// A vertex in the patch whose collapsed side it is, at the parameter that is asked for.
TEST(ExpressedIn, CollapsedSides) {
  const Scene scene = make_scene(cone(1, 2));
  const ContactGeometry geometry(scene);
  const Contact tip = geometry.canonical({0, SourceKind::face, 0, 0.5, 1});
  ASSERT_EQ(tip.kind, SourceKind::vertex);
  for (int p = 0; p < 4; ++p) {
    const std::optional<Contact> c =
        expressed_in(geometry, tip, {0, SourceKind::face, p, 0.3, 0.8});
    ASSERT_TRUE(c);
    expect_contact(*c, {0, SourceKind::face, p, 0.3, 1});
  }
}

TEST(AtRest, MovesToTheHigherEndOfWhatIsStraight) {
  const Scene scene = make_scene(solid_cylinder(1, 2));
  const ContactGeometry geometry(scene);
  const int count = int(scene.model().parts()[0].patches().size());
  Random random(12);
  int moved = 0;
  for (int p = 0; p < count; ++p) {
    for (int k = 0; k < 20; ++k) {
      const Contact c{0, SourceKind::face, p, uniform(random, 0.1, 0.9), uniform(random, 0.1, 0.9)};
      // A direction that supports there, or one that leans a little to either side.
      const dvec3 x = geometry.point(c);
      const bool lateral = geometry.patch(c).ruled_v && !geometry.patch(c).ruled_u;
      const dvec3 across = lateral ? unit(dvec3(x.x, x.y, 0)) : dvec3(0, 0, x.z > 0 ? 1 : -1);
      for (const double lean : {1e-3, -1e-3}) {
        const dvec3 n = unit(across + lean * (lateral ? dvec3(0, 0, 1) : dvec3(1, 0, 0)));
        const Contact rest = at_rest(geometry, c, n);
        if (rest.kind == SourceKind::face) {  // the middle of a disc
          EXPECT_FALSE(lateral);
          EXPECT_LT(glm::length(dvec2(geometry.point(rest))), 1e-15);
        }
        EXPECT_GE(glm::dot(geometry.point(rest), n), glm::dot(x, n) - 1e-15);
        if (lateral) {
          EXPECT_GT(geometry.point(rest).z * lean, 0);
          ++moved;
        }
      }
      // Level ends are equally high: the nearer one.
      if (lateral) {
        const Contact rest = at_rest(geometry, c, across);
        EXPECT_EQ(rest.kind, SourceKind::edge);
        EXPECT_GT(geometry.point(rest).z * x.z, 0);
      }
    }
  }
  EXPECT_EQ(moved, 4 * 20 * 2);
}

TEST(AtRest, OfEdgesAndWhatIsNotRuled) {
  const dvec3 n = unit(dvec3(0.3, 0.4, 0.5));
  const Scene block = make_scene(box(1, 2, 3));
  const ContactGeometry geometry(block);
  for (int p = 0; p < 12; ++p) {
    const Contact low{0, SourceKind::edge, p, 0, 0};
    const Contact high{0, SourceKind::edge, p, 1, 0};
    const bool rises = glm::dot(geometry.point(high) - geometry.point(low), n) > 0;
    expect_contact(at_rest(geometry, {0, SourceKind::edge, p, 0.4, 0}, n),
                   geometry.canonical(rises ? high : low));
  }
  // From inside of a plane face to its highest corner.
  for (int p = 0; p < 6; ++p) {
    const Contact rest = at_rest(geometry, {0, SourceKind::face, p, 0.4, 0.7}, n);
    EXPECT_EQ(rest.kind, SourceKind::vertex);
    for (const dvec2 uv : {dvec2(0, 0), dvec2(0, 1), dvec2(1, 0), dvec2(1, 1)}) {
      const dvec3 corner = geometry.point({0, SourceKind::face, p, uv.x, uv.y});
      EXPECT_GE(glm::dot(geometry.point(rest) - corner, n), -1e-15);
    }
  }
  // What is curved stays where it is.
  const Scene round = make_scene(lens());
  const ContactGeometry curved(round);
  for (const Contact& c :
       {Contact{0, SourceKind::face, 1, 0.3, 0.4}, Contact{0, SourceKind::edge, 1, 0.3, 0}}) {
    expect_contact(at_rest(curved, c, n), c);
  }
}

/// Both pieces of a curve, from end to end; then it is at its own end.
TEST(FoundOnEdge, FollowsTheEdge) {
  const BezierCurve arc{{{-1, 0, 0, 1}, {0, 2, 0, 1}, {1, 0, 0, 1}}};
  const Scene scene = make_scene(split({{}, {as_nurbs(arc)}, {}}, 0.5, 0.5));
  const ContactGeometry geometry(scene);
  ASSERT_EQ(geometry.part({0}).pieces().size(), 2U);
  SupportQuery query(scene);
  const Contact end = geometry.canonical(query(dvec3(-1, 0, 0)).contact);
  ASSERT_EQ(end.kind, SourceKind::vertex);
  const std::vector<Contact> pieces = piece_ends(geometry, end);
  ASSERT_EQ(pieces.size(), 1U);
  std::vector<dvec3> ends;
  const auto visit = [&](const Contact& begin, const Contact& last) {
    ends.push_back(geometry.point(begin));
    ends.push_back(geometry.point(last));
    return EdgeVisit::on;
  };
  EXPECT_FALSE(found_on_edge(geometry, pieces.front(), visit));
  ASSERT_EQ(ends.size(), 4U);
  EXPECT_EQ(ends[0], geometry.point(end));
  EXPECT_EQ(ends[1], ends[2]);
  EXPECT_EQ(ends[3], query(dvec3(1, 0, 0)).point);
  int visits = 0;
  const auto found = [&](const Contact&, const Contact&) {
    return ++visits == 2 ? EdgeVisit::found : EdgeVisit::on;
  };
  EXPECT_TRUE(found_on_edge(geometry, pieces.front(), found));
  EXPECT_EQ(visits, 2);
}

/// z = -y^2 / 2 - x^3 / 6 over x from 0 to 1, as a graph over (u, v) with x = u, y = v + u / 2 -
/// 1/2: level across x = 0, in a direction oblique to the parameter u.
Shape oblique_shelf() {
  BezierPatch patch{3, 2, {}};
  for (int i = 0; i <= 3; ++i) {
    for (int j = 0; j <= 2; ++j) {
      // The blossom at i ones in u and j in v, the other arguments being zero.
      const double u = i / 3.0;
      const double v = j / 2.0 - 0.5;
      const double uu = i * (i - 1) / 6.0;
      const double vv = j == 1 ? -0.25 : 0.25;
      const double square = vv + u * v + uu / 4;
      const double cube = i == 3 ? 1 : 0;
      patch.points.push_back(homogeneous({u, v + u / 2, -square / 2 - cube / 6}));
    }
  }
  return {{as_nurbs(patch)}, {}, {}};
}

TEST(LevelSides, InDirectionsObliqueToTheParameters) {
  const Shape shelf = oblique_shelf();
  const dvec3 up(0, 0, 1);
  std::set<Side> found;
  for (const Shape& shape :
       {shelf, with_reversed_parameters(shelf), with_exchanged_parameters(shelf),
        with_exchanged_parameters(with_reversed_parameters(shelf))}) {
    const Scene scene = make_scene(shape);
    const ContactGeometry geometry(scene);
    const auto in_model = [&](const Contact& c) {
      return scene.frame().to_model(geometry.point(c));
    };
    for (const Side side : all_sides) {
      const dvec2 uv = on_side(side, 0.5);
      const Contact middle{0, SourceKind::face, 0, uv.x, uv.y};
      const bool is_origin = glm::length(in_model(middle)) < 1e-14;
      EXPECT_EQ(is_level_across(geometry, middle, side, up), is_origin);
      if (!is_origin) continue;
      found.insert(side);
    }
  }
  EXPECT_EQ(found.size(), 4U);
}

}  // namespace
}  // namespace taut
