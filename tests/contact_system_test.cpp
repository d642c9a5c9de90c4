#include "taut/hull/contact/contact_system.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "models.h"
#include "taut/bounds/support_query.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// An element with its support function and where that is attained, in a frame of its own.
struct Element {
  Shape shape;
  std::function<double(const dvec3& n)> h;
};

Element ball(double radius, const dvec3& center) {
  return {shifted(sphere(radius), center),
          [=](const dvec3& n) { return radius + glm::dot(center, n); }};
}

Element ring(const dvec3& center, const dvec3& a, const dvec3& b) {
  return {{{}, {circle(center, a, b)}, {}}, [=](const dvec3& n) {
            return glm::dot(center, n) + std::hypot(glm::dot(a, n), glm::dot(b, n));
          }};
}

Element dot(const dvec3& x) {
  return {{{}, {}, {x}}, [=](const dvec3& n) { return glm::dot(x, n); }};
}

/// Elements as parts of one scene, each placed by a pose of its own.
struct Group {
  std::vector<Element> elements;
  Scene scene;

  explicit Group(const std::vector<Element>& all) : elements(all), scene(joined(all)) {}

  static Scene joined(const std::vector<Element>& all) {
    Model model;
    for (const Element& e : all) {
      Part part;
      for (const NurbsSurface& s : e.shape.surfaces) part.add_surface(s, "face");
      for (const NurbsCurve& c : e.shape.curves) part.add_curve(c, "edge");
      for (const dvec3& p : e.shape.points) part.add_point(p);
      model.add_part(std::move(part), 1e-3);
    }
    return Scene(std::move(model), {.threads = 1, .progress = {}});
  }

  /// The element's contact in a direction: its part's instance has the same number.
  Contact contact(int k, const dvec3& n) const {
    const Element& e = elements[std::size_t(k)];
    const Scene own = make_scene(e.shape);
    Contact c = SupportQuery(own)(n).contact;
    c.instance = k;
    return c;
  }
  /// In model units, of closed forms.
  double h(int k, const dvec3& n) const { return elements[std::size_t(k)].h(n); }
};

CommonSupport support(const ContactGeometry& geometry, const Group& group, const dvec3& n) {
  CommonSupport s;
  s.n = glm::normalize(n);
  for (int k = 0; k < int(group.elements.size()); ++k) s.add(geometry, group.contact(k, s.n));
  return s;
}

/// Newton's iterates on the way to a solution, as (n, x_i) in one list of coordinates.
using Iterates = std::vector<std::vector<double>>;
std::vector<double> coordinates(const CommonSupport& s) {
  std::vector<double> all = {s.n.x, s.n.y, s.n.z};
  for (int i = 0; i < s.count; ++i) {
    const dvec3& x = s.jet[std::size_t(i)].x;
    all.insert(all.end(), {x.x, x.y, x.z});
  }
  return all;
}

/// Solved from a start whose parameters and direction are off by `size`, across the plane of
/// directions through n and across `along`; with the errors of all iterates.
bool solve_pair(const ContactSystem& system, CommonSupport& s, const dvec3& along,
                Iterates* iterates = nullptr) {
  return system.solve(s, [&](const CommonSupport& now) {
    if (iterates != nullptr) iterates->push_back(coordinates(now));
    LinearEquation e;
    e.n = along;
    e.residual = glm::dot(now.n, along);
    return e;
  });
}

void perturb(const ContactGeometry& geometry, CommonSupport& s, double size, Random& random) {
  s.n = glm::normalize(s.n + size * random_direction(random));
  for (int i = 0; i < s.count; ++i) {
    Contact& c = s.contact[std::size_t(i)];
    if (c.kind != SourceKind::vertex) c.u += size * uniform(random, -1, 1);
    if (c.kind == SourceKind::face) c.v += size * uniform(random, -1, 1);
  }
  s.evaluate(geometry);
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0;
  for (std::size_t k = 0; k < a.size(); ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

/// The kinds of contacts, such as "FE".
std::string kinds(const CommonSupport& s) {
  std::string name;
  for (int i = 0; i < s.count; ++i) {
    const SourceKind kind = s.contact[std::size_t(i)].kind;
    name += kind == SourceKind::face ? 'F' : kind == SourceKind::edge ? 'E' : 'V';
  }
  return name;
}

struct Pair {
  std::string kinds;
  std::vector<Element> elements;
};

std::vector<Pair> pairs() {
  const Element big = ball(1, {0.1, -0.2, 0.3});
  const Element small = ball(0.5, {3, 0.4, -0.1});
  const Element wheel = ring({3, 0.4, -0.1}, {0.1, 0.9, 0.2}, {-0.3, 0.2, 0.7});
  const Element hoop = ring({0.1, -0.2, 0.3}, {0, 1.2, -0.1}, {0.2, 0.1, 1.1});
  const Element tip = dot({3, 0.4, -0.1});
  return {{"FF", {big, small}},  {"FE", {big, wheel}}, {"FV", {big, tip}},
          {"EE", {hoop, wheel}}, {"EV", {hoop, tip}},  {"VV", {dot({0.1, -0.2, 0.3}), tip}}};
}

/// A direction in which the two tie, in the plane across `along`, by bisection of closed forms.
struct Tie {
  dvec3 along, n;
};
Tie random_tie(const Group& group, Random& random) {
  // Planes through both centres' line cut the curve.
  const dvec3 towards = dvec3(3, 0.4, -0.1) - dvec3(0.1, -0.2, 0.3);
  const dvec3 along = glm::normalize(glm::cross(towards, random_direction(random)));
  const auto frame = tangent_frame(along);
  const auto at = [&](double angle) {
    return std::cos(angle) * frame[0] + std::sin(angle) * frame[1];
  };
  const auto gap = [&](double angle) { return group.h(0, at(angle)) - group.h(1, at(angle)); };
  double lower = 0;
  double step = 0.01;
  while ((gap(lower) > 0) == (gap(lower + step) > 0)) lower += step;
  double upper = lower + step;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (lower + upper);
    ((gap(middle) > 0) == (gap(lower) > 0) ? lower : upper) = middle;
  }
  return {along, at(0.5 * (lower + upper))};
}

TEST(ContactSystem, ConvergesQuadraticallyForAllPairs) {
  Random random(1);
  for (const Pair& pair : pairs()) {
    const Group group(pair.elements);
    const ContactGeometry geometry(group.scene);
    const ContactSystem system(geometry);
    for (int k = 0; k < 10; ++k) {
      const auto [along, n] = random_tie(group, random);
      const CommonSupport truth = support(geometry, group, n);
      ASSERT_EQ(kinds(truth), pair.kinds);
      CommonSupport s = truth;
      perturb(geometry, s, 0.02, random);
      Iterates iterates;
      ASSERT_TRUE(solve_pair(system, s, along, &iterates)) << pair.kinds << k;
      EXPECT_LT(glm::distance(s.n, n), 1e-13) << pair.kinds << k;
      EXPECT_LT(glm::dot(s.d(), s.n), 1e-13);
      EXPECT_LE(iterates.size(), 6U) << pair.kinds << k;
      // Errors fall by at least their squares, times a constant of the curvatures, down to
      // rounding.
      const std::vector<double> end = coordinates(s);
      for (std::size_t i = 0; i + 1 < iterates.size(); ++i) {
        const double before = distance(iterates[i], end);
        const double after = distance(iterates[i + 1], end);
        EXPECT_LT(after, 100 * before * before + 1e-14) << pair.kinds << k << " step " << i;
      }
    }
  }
}

TEST(ContactSystem, ConvergesForAllTriples) {
  Random random(2);
  const auto element = [](char kind, const dvec3& at) {
    if (kind == 'F') return ball(0.4, at);
    if (kind == 'E') return ring(at, {0.5, 0.1, 0}, {-0.1, 0.3, 0.3});
    return dot(at);
  };
  const std::array<dvec3, 3> places = {dvec3(0.1, 0.2, 0.3), dvec3(2.2, 0, -0.1),
                                       dvec3(0.9, 2.1, 0.2)};
  for (const std::string all :
       {"FFF", "FFE", "FFV", "FEE", "FEV", "FVV", "EEE", "EEV", "EVV", "VVV"}) {
    std::vector<Element> elements;
    for (std::size_t k = 0; k < 3; ++k) elements.push_back(element(all[k], places[k]));
    const Group group(elements);
    const ContactGeometry geometry(group.scene);
    const ContactSystem system(geometry);
    for (const double side : {1.0, -1.0}) {
      // From the plane of the contacts, again and again: a Newton step in the direction alone.
      dvec3 n(0, 0, side);
      for (int k = 0; k < 8; ++k) {
        const CommonSupport s = support(geometry, group, n);
        const dvec3 m = unit(glm::cross(s.jet[1].x - s.jet[0].x, s.jet[2].x - s.jet[0].x));
        n = glm::dot(m, n) < 0 ? -m : m;
      }
      const CommonSupport truth = support(geometry, group, n);
      ASSERT_EQ(kinds(truth), all);
      EXPECT_NEAR(group.h(0, n), group.h(1, n), 1e-14);
      EXPECT_NEAR(group.h(0, n), group.h(2, n), 1e-14);
      CommonSupport s = truth;
      perturb(geometry, s, 0.02, random);
      const long before = system.iterations();
      ASSERT_TRUE(system.solve(s)) << all;
      EXPECT_LE(system.iterations() - before, 6) << all;
      EXPECT_LT(distance(coordinates(s), coordinates(truth)), 1e-13) << all;
    }
  }
}

TEST(ContactSystem, ConeOfTwoSpheres) {
  // n . e = (r1 - r2) / D.
  const Group group({ball(1, {0, 0, 0}), ball(0.5, {0, 0, 3})});
  const ContactGeometry geometry(group.scene);
  const ContactSystem system(geometry);
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const double angle = uniform(random, 0, 2 * std::numbers::pi);
    const dvec3 start(std::cos(angle), std::sin(angle), 0.05);
    CommonSupport s = support(geometry, group, start);
    ASSERT_TRUE(solve_pair(system, s, dvec3(-std::sin(angle), std::cos(angle), 0)));
    EXPECT_NEAR(s.n.z, 0.5 / 3, 1e-15);
    EXPECT_NEAR(glm::length(s.d()) / group.scene.frame().scale, std::sqrt(9 - 0.25), 1e-14);
  }
}

TEST(ContactSystem, RulingsOfTheOloid) {
  // They all have the length sqrt(3) (Dirnboeck, Stachel 1997).
  const Scene scene = make_scene(oloid());
  const ContactGeometry geometry(scene);
  const ContactSystem system(geometry);
  SupportQuery query(scene);
  Random random(4);
  int found = 0;
  for (int k = 0; k < 40; ++k) {
    // Two contacts on both sides of a random direction's curve, by bisection.
    dvec3 a = random_direction(random);
    dvec3 b = random_direction(random);
    const auto far_apart = [&](const Support& x, const Support& y) {
      return glm::distance(x.point, y.point) > 0.5 * scene.frame().scale;
    };
    if (!far_apart(query(a), query(b)) || glm::dot(a, b) < -0.9) continue;
    for (int h = 0; h < 40; ++h) {
      const dvec3 middle = glm::normalize(a + b);
      (far_apart(query(a), query(middle)) ? b : a) = middle;
    }
    if (!far_apart(query(a), query(b))) continue;
    CommonSupport s;
    s.n = a;
    s.add(geometry, query(a).contact);
    s.add(geometry, query(b).contact);
    const dvec3 across = glm::normalize(glm::cross(a, s.d()));
    const dvec3 along = glm::normalize(across - glm::dot(across, a) * a);
    ASSERT_TRUE(solve_pair(system, s, along));
    EXPECT_NEAR(glm::length(s.d()) / scene.frame().scale, std::sqrt(3.0), 1e-13);
    ++found;
  }
  EXPECT_GT(found, 10);
}

TEST(ContactSystem, TangentTurnsAlongTheRuling) {
  Random random(5);
  for (const Pair& pair : pairs()) {
    const Group group(pair.elements);
    const ContactGeometry geometry(group.scene);
    const ContactSystem system(geometry);
    for (int k = 0; k < 10; ++k) {
      const CommonSupport s = support(geometry, group, random_tie(group, random).n);
      const std::optional<CurveTangent> t = system.tangent(s);
      ASSERT_TRUE(t);
      EXPECT_NEAR(glm::dot(t->n, t->n) + glm::dot(t->x[0], t->x[0]) + glm::dot(t->x[1], t->x[1]), 1,
                  1e-14);
      // n turns by n x d.
      const dvec3 sense = unit(glm::cross(s.n, s.d()));
      EXPECT_LT(glm::length(glm::cross(t->n, sense)), 1e-12) << pair.kinds;
      EXPECT_GT(glm::dot(t->n, sense), 0) << pair.kinds;
      // Against differences of two solutions.
      const double h = 1e-5;
      std::array<CommonSupport, 2> beside = {s, s};
      for (const int side : {0, 1}) {
        const double length = side == 0 ? -h : h;
        CommonSupport& to = beside[std::size_t(side)];
        ASSERT_TRUE(system.solve(to, [&](const CommonSupport& now) {
          LinearEquation e;
          e.n = sense;
          e.residual = glm::dot(now.n, sense) - length * glm::length(t->n);
          return e;
        }));
      }
      for (std::size_t i = 0; i < 2; ++i) {
        const dvec3 rate = (beside[1].jet[i].x - beside[0].jet[i].x) / (2 * h);
        EXPECT_LT(glm::distance(rate, t->x[i]), 1e-7) << pair.kinds;
        const dvec3 moved = t->parameter[i].x * s.jet[i].dx[0] + t->parameter[i].y * s.jet[i].dx[1];
        EXPECT_LT(glm::distance(moved, t->x[i]), 1e-13);
      }
      // With the contacts exchanged the curve runs the other way.
      CommonSupport turned = s;
      std::swap(turned.contact[0], turned.contact[1]);
      turned.evaluate(geometry);
      const std::optional<CurveTangent> back = system.tangent(turned);
      ASSERT_TRUE(back);
      EXPECT_LT(glm::length(back->n + t->n), 1e-12);
      EXPECT_LT(glm::length(back->x[1] + t->x[0]), 1e-12);
    }
  }
}

TEST(ContactSystem, AddsThePointsGradient) {
  const Group group({ball(1, {0, 0, 0}), ball(0.5, {0, 0, 3})});
  const ContactGeometry geometry(group.scene);
  Random random(6);
  CommonSupport s = support(geometry, group, dvec3(1, 0.3, 0.1));
  const dvec3 g = random_direction(random);
  LinearEquation e;
  e.add_point(s, 1, g);
  e.add_point(s, 1, g);  // they add up
  const double h = 1e-6;
  CommonSupport there = s;
  there.contact[1].u += h;
  there.contact[1].v -= 2 * h;
  there.evaluate(geometry);
  const double rate = 2 * glm::dot(there.jet[1].x - s.jet[1].x, g) / h;
  EXPECT_NEAR(e.parameter[1].x - 2 * e.parameter[1].y, rate, 1e-5);
  EXPECT_EQ(e.parameter[0], dvec2(0.0));
}

TEST(ContactSystem, RulingBetweenIsExact) {
  Random random(7);
  for (const Pair& pair : pairs()) {
    const Group group(pair.elements);
    const ContactGeometry geometry(group.scene);
    const ContactSystem system(geometry);
    for (int k = 0; k < 6; ++k) {
      const CommonSupport s = support(geometry, group, random_tie(group, random).n);
      const dvec3 sense = unit(glm::cross(s.n, s.d()));
      CommonSupport next = s;
      ASSERT_TRUE(system.solve(next, [&](const CommonSupport& now) {
        LinearEquation e;
        e.n = sense;
        e.residual = glm::dot(now.n, sense) - 0.05;
        return e;
      }));
      const Ruling from = s.ruling();
      const Ruling to = next.ruling();
      EXPECT_EQ(ruling_between(system, from, to, 0)->n, from.n);
      EXPECT_EQ(ruling_between(system, from, to, 1)->n, to.n);
      const dvec3 dn = to.n - from.n;
      const std::array<dvec3, 2> dx = {to.point[0] - from.point[0], to.point[1] - from.point[1]};
      const double square = glm::dot(dn, dn) + glm::dot(dx[0], dx[0]) + glm::dot(dx[1], dx[1]);
      for (const double at : {-0.1, 1e-9, 0.25, 0.5, 0.9, 1.1}) {
        const std::optional<Ruling> found = ruling_between(system, from, to, at);
        ASSERT_TRUE(found);
        const Ruling& r = *found;
        const double h0 = group.h(0, r.n);
        EXPECT_NEAR(h0, group.h(1, r.n), 2e-15 * std::abs(h0) + 2e-15) << pair.kinds;
        const double share =
            (glm::dot(r.n - from.n, dn) + glm::dot(r.point[0] - from.point[0], dx[0]) +
             glm::dot(r.point[1] - from.point[1], dx[1])) /
            square;
        EXPECT_NEAR(share, at, 1e-12);
        for (std::size_t i = 0; i < 2; ++i) {
          EXPECT_EQ(geometry.point(r.contact[i]), r.point[i]);
          const double height = glm::dot(r.point[i], r.n) / group.scene.frame().scale +
                                glm::dot(group.scene.frame().center, r.n);
          EXPECT_NEAR(height, h0, 1e-14) << pair.kinds;  // and so it supports its element
        }
      }
    }
  }
}

bool is_finite(const CommonSupport& s) {
  for (const double x : coordinates(s)) {
    if (!std::isfinite(x)) return false;
  }
  return true;
}

/// What solve() and tangent() say of a singular system is either no, or finite.
TEST(ContactSystem, SingularSystemsGiveNoNumbers) {
  struct Case {
    const char* name;
    Shape shape;
    Contact a, b;
    dvec3 n;
  };
  const Contact on_face{0, SourceKind::face, 0, 0.3, 0.4};
  const Contact on_edge{0, SourceKind::edge, 0, 0.3, 0};
  const Contact at_vertex{0, SourceKind::vertex, 0, 0, 0};
  Contact at_pole = on_face;
  at_pole.v = 0;
  Contact at_other = at_pole;
  at_other.v = 1;
  const BezierPatch point_like{1, 1, std::vector<dvec4>(4, dvec4(1, 2, 3, 1))};
  const std::vector<Case> cases = {
      {"twice the same", sphere(1), on_face, on_face, {0.2, 0.3, 0.9}},
      {"twice the same vertex",
       {{}, {}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
       at_vertex,
       at_vertex,
       {1, 0, 0}},
      {"planes", box(1, 1, 1), on_face, {0, SourceKind::face, 5, 0.5, 0.5}, {0, 0, 1}},
      {"straight edges",
       {{}, {segment({0, 0, 0}, {1, 0, 0})}, {{0, 1, 0}}},
       on_edge,
       at_vertex,
       {0, 0, 1}},
      {"poles", sphere(1), at_pole, at_other, {0, 0, 1}},
      {"a patch that is a point",
       of_patch(point_like) + sphere(1),
       on_face,
       {0, SourceKind::face, 1, 0.5, 0.5},
       {0, 0, 1}},
  };
  for (const Case& each : cases) {
    const Scene scene = make_scene(each.shape);
    const ContactGeometry geometry(scene);
    const ContactSystem system(geometry);
    CommonSupport s;
    s.n = glm::normalize(each.n);
    s.add(geometry, each.a);
    s.add(geometry, each.b);
    const std::optional<CurveTangent> t = system.tangent(s);
    if (t) {
      EXPECT_TRUE(std::isfinite(glm::dot(t->n, t->n) + glm::dot(t->x[0], t->x[0]) +
                                glm::dot(t->x[1], t->x[1])))
          << each.name;
    }
    CommonSupport pair = s;
    const bool solved = solve_pair(system, pair, tangent_frame(s.n)[0]);
    EXPECT_TRUE(!solved || is_finite(pair)) << each.name;
    CommonSupport triple = s;
    triple.add(geometry, each.b);
    EXPECT_TRUE(!system.solve(triple) || is_finite(triple)) << each.name;
    // An equation that says nothing.
    CommonSupport open = s;
    EXPECT_FALSE(system.solve(open, [](const CommonSupport&) {
      LinearEquation e;
      e.residual = 1;
      return e;
    })) << each.name;
  }
}

TEST(ContactSystem, GivesUpWhereThereIsNoSolution) {
  // A ball inside of another: they never tie.
  const Group group({ball(2, {0, 0, 0}), ball(1, {0.3, 0, 0})});
  const ContactGeometry geometry(group.scene);
  const ContactSystem system(geometry);
  Random random(8);
  for (int k = 0; k < 20; ++k) {
    CommonSupport s = support(geometry, group, random_direction(random));
    const bool solved = solve_pair(system, s, random_direction(random));
    // The far sides of the balls tie as little.
    EXPECT_FALSE(solved) << k;
  }
}

/// Two surfaces or curves that support in directions about n, started a little off.
std::optional<CommonSupport> crossing_near(const Group& group, const ContactGeometry& geometry,
                                           const dvec3& n) {
  CommonSupport s;
  s.n = unit(n);
  for (int k = 0; k < 2; ++k) s.add(geometry, group.contact(k, s.n));
  return ContactSystem(geometry).crossing(s);
}

/// A torus about the origin and an axis, by a rotation that takes z there.
Element tube(const dmat3& turn) {
  return {mapped(torus(1, 0.25), turn), [=](const dvec3& n) {
            const double z = glm::dot(n, turn[2]);
            return std::sqrt(std::max(0.0, 1 - z * z)) + 0.25;
          }};
}

struct CrossingCase {
  std::string name;
  std::vector<Element> elements;
  dvec3 n, x;  // in the model
};

std::vector<CrossingCase> crossing_cases() {
  std::vector<CrossingCase> all;
  const dmat3 quarter(1, 0, 0, 0, 0, -1, 0, 1, 0);  // takes z to y
  for (const bool turned : {false, true}) {
    const dmat3 R = turned ? skew_rotation() : dmat3(1.0);
    const dvec3 shift = turned ? dvec3(0.4, -0.3, 0.2) : dvec3(0.0);
    const std::string name = turned ? ", turned" : "";
    // The circles' starts, where pieces end, lie elsewhere.
    const auto about = [&](const dvec3& across) {
      return ring(shift, R * (0.6 * dvec3(1, 0, 0) + 0.8 * across),
                  R * (-0.8 * dvec3(1, 0, 0) + 0.6 * across));
    };
    const dmat3 around(0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1);  // off the seams
    for (const double side : {1.0, -1.0}) {
      const dvec3 n = R * dvec3(side, 0, 0);
      all.push_back({"circles" + name, {about({0, 1, 0}), about({0, 0, 1})}, n, shift + n});
      all.push_back({"tori" + name, {tube(R * around), tube(R * quarter * around)}, n, 1.25 * n});
    }
  }
  return all;
}

TEST(Crossing, WhereTwoContactsAreOnePoint) {
  Random random(21);
  for (const CrossingCase& each : crossing_cases()) {
    SCOPED_TRACE(each.name);
    const Group group(each.elements);
    const ContactGeometry geometry(group.scene);
    const dvec3 x = group.scene.frame().to_frame(each.x);
    for (int k = 0; k < 20; ++k) {
      const auto s = crossing_near(group, geometry, each.n + 0.2 * random_direction(random));
      ASSERT_TRUE(s) << k;
      EXPECT_LT(glm::distance(s->n, each.n), 1e-14);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(glm::distance(s->jet[i].x, x), 1e-14);
        EXPECT_EQ(s->contact[i].instance, int(i));
      }
    }
  }
}

TEST(Crossing, NoneWhereTheyDoNotMeet) {
  struct Case {
    const char* name;
    std::vector<Element> elements;
  };
  const dvec3 x(0.6, 0.8, 0);
  const dvec3 y(-0.8, 0.6, 0);
  const dvec3 u(0.6, 0, 0.8);
  const dvec3 v(-0.8, 0, 0.6);
  const std::vector<Case> cases = {
      {"circles of two sizes", {ring(dvec3(0.0), x, y), ring(dvec3(0.0), 0.9 * u, 0.9 * v)}},
      {"just not", {ring(dvec3(0.0), x, y), ring({1e-9, 0, 0}, u, v)}},
      {"circles in parallel planes", {ring(dvec3(0.0), x, y), ring({0, 0, 1}, x, y)}},
      {"balls", {ball(1, {0, 0, 0}), ball(0.5, {0.2, 0.1, 0})}},
      {"points", {dot({0, 0, 0}), dot({1, 0, 0})}},
  };
  for (const Case& each : cases) {
    const Group group(each.elements);
    const ContactGeometry geometry(group.scene);
    EXPECT_FALSE(crossing_near(group, geometry, dvec3(1, 0.1, 0.05))) << each.name;
  }
}

/// Contacts of round bodies are told to the last digits; on a plane it is the other contact alone
/// that tells the direction, and nothing the place.
TEST(ContactSystem, UncertaintyIsThatOfThePlace) {
  for (const Pair& pair : pairs()) {
    const Group group(pair.elements);
    const ContactGeometry geometry(group.scene);
    const CommonSupport s = support(geometry, group, {0.1, 0.2, 1});
    EXPECT_GT(ContactSystem(geometry).uncertainty(s), 0) << pair.kinds;
    EXPECT_LT(ContactSystem(geometry).uncertainty(s), 1e-12) << pair.kinds;
  }
  BezierPatch square;
  square.degree_u = square.degree_v = 1;
  square.points = {{0, 0, 0, 1}, {0, 1, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}};
  Shape shape = of_patch(square);
  shape.points.emplace_back(2, 0.3, 0);
  const Scene flat = make_scene(shape);
  const ContactGeometry geometry(flat);
  CommonSupport s;
  s.n = dvec3(0, 0, 1);
  s.add(geometry, {0, SourceKind::face, 0, 0.5, 0.5});
  s.add(geometry, {0, SourceKind::vertex, flat.model().parts()[0].point_count() - 1, 0, 0});
  EXPECT_GT(ContactSystem(geometry).uncertainty(s), 1e-7);
}

}  // namespace
}  // namespace taut
