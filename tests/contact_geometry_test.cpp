#include "taut/bounds/contact_geometry.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "freeform.h"
#include "models.h"
#include "surface_checks.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

using rmat3 = glm::mat<3, 3, real>;

/// A curve's point and derivatives in long double.
struct ReferenceCurveJet {
  rvec3 c, ct, ctt;
};

ReferenceCurveJet reference_curve_jet(const BezierCurve& curve, real t) {
  const auto sum = [&](int k) {
    rvec4 result(0);
    for (int i = 0; i <= curve.degree(); ++i) {
      result += bernstein_derivative(curve.degree(), i, k, t) * rvec4(curve.points[std::size_t(i)]);
    }
    return result;
  };
  const rvec4 p = sum(0);
  const rvec4 pt = sum(1);
  const rvec4 ptt = sum(2);
  ReferenceCurveJet j;
  j.c = rvec3(p) / p.w;
  j.ct = (rvec3(pt) - pt.w * j.c) / p.w;
  j.ctt = (rvec3(ptt) - ptt.w * j.c - 2 * pt.w * j.ct) / p.w;
  return j;
}

/// Where an instance's points and derivatives are in the scene's frame, in long double.
struct Placed {
  rmat3 turn;
  rvec3 shift, center;
  real scale;

  Placed(const Scene& scene, int instance)
      : turn(scene.model().instances()[std::size_t(instance)].pose.rotation),
        shift(scene.model().instances()[std::size_t(instance)].pose.translation),
        center(scene.frame().center),
        scale(scene.frame().scale) {}

  rvec3 point(const rvec3& x) const { return (turn * x + shift - center) * scale; }
  rvec3 direction(const rvec3& d) const { return turn * d * scale; }
};

real error(const dvec3& x, const rvec3& truth) { return glm::length(rvec3(x) - truth); }

/// Patches, curves and points of all degrees up to five about `at`, three times: at rest, and
/// turned and moved by about as much as `at` is far from the origin.
Scene scattered(unsigned seed, double at) {
  Random random(seed);
  Part part;
  const dvec3 shift = at * random_direction(random);
  for (int k = 0; k < 6; ++k) {
    Shape shape =
        of_patch(random_patch(random, {1, 5}, k % 2 == 0 ? 1 : log_uniform(random, 1.1, 20)));
    shape.curves.push_back(as_nurbs(random_curve(random, pick(random, 1, 5), 1 + k % 2)));
    shape = shifted(shape, shift + random_point(random));
    part.add_surface(shape.surfaces[0], "face");
    part.add_curve(shape.curves[0], "edge");
    part.add_point(shift + random_point(random));
  }
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  for (int k = 0; k < 2; ++k) {
    const dmat3 turn = random_rotation(random);
    model.add_instance(0, {turn, shift - turn * shift + 2.0 * random_point(random)});
  }
  return Scene(std::move(model), {.threads = 1, .progress = {}});
}

struct JetErrors {
  real patch = 0, curve = 0, vertex = 0;  // of points
  real first = 0, second = 0, third = 0;  // of derivatives, by their own sizes and one
};

JetErrors jet_errors(const Scene& scene) {
  JetErrors e;
  const auto raise = [](real& worst, real value) { worst = std::max(worst, value); };
  const ContactGeometry geometry(scene);
  Random random(3);
  const auto relative = [](const dvec3& x, const rvec3& truth) {
    return error(x, truth) / (1 + glm::length(truth));
  };
  for (int i = 0; i < int(scene.model().instances().size()); ++i) {
    const Placed placed(scene, i);
    const Part& part = geometry.part({i, SourceKind::face, 0, 0, 0});
    for (int p = 0; p < int(part.patches().size()); ++p) {
      for (int k = 0; k < 6; ++k) {
        const Contact c{i, SourceKind::face, p, k == 0 ? 0 : uniform(random, 0, 1),
                        k == 1 ? 1 : uniform(random, 0, 1)};
        const ReferenceJet truth = reference_jet(part.patches()[std::size_t(p)].bezier, c.u, c.v);
        const ContactJet j = geometry.jet(c);
        EXPECT_EQ(j.dimension, 2);
        EXPECT_EQ(geometry.point(c), j.x);
        raise(e.patch, error(j.x, placed.point(truth.S)));
        raise(e.first, relative(j.dx[0], placed.direction(truth.Su)));
        raise(e.first, relative(j.dx[1], placed.direction(truth.Sv)));
        raise(e.second, relative(j.dxx, placed.direction(truth.Suu)));
        raise(e.second, relative(j.dxy, placed.direction(truth.Suv)));
        raise(e.second, relative(j.dyy, placed.direction(truth.Svv)));
        // Third derivatives by central differences of the exact second ones.
        const PatchJet3 third = geometry.patch_jet(c);
        EXPECT_EQ(third.S, j.x);
        EXPECT_EQ(third.Suv, j.dxy);
        const real h = 1e-7L;
        const BezierPatch& b = part.patches()[std::size_t(p)].bezier;
        const auto in_u = [&](rvec3 ReferenceJet::*member) {
          return placed.direction(reference_jet(b, c.u + h, c.v).*member -
                                  reference_jet(b, c.u - h, c.v).*member) /
                 (2 * h);
        };
        const auto in_v = [&](rvec3 ReferenceJet::*member) {
          return placed.direction(reference_jet(b, c.u, c.v + h).*member -
                                  reference_jet(b, c.u, c.v - h).*member) /
                 (2 * h);
        };
        raise(e.third, relative(third.Suuu, in_u(&ReferenceJet::Suu)));
        raise(e.third, relative(third.Suuv, in_v(&ReferenceJet::Suu)));
        raise(e.third, relative(third.Suvv, in_u(&ReferenceJet::Svv)));
        raise(e.third, relative(third.Svvv, in_v(&ReferenceJet::Svv)));
      }
    }
    for (int p = 0; p < int(part.pieces().size()); ++p) {
      for (const double t : {0.0, 1.0, uniform(random, 0, 1), uniform(random, 0, 1)}) {
        const Contact c{i, SourceKind::edge, p, t, 0};
        const ReferenceCurveJet truth =
            reference_curve_jet(part.pieces()[std::size_t(p)].bezier, t);
        const ContactJet j = geometry.jet(c);
        EXPECT_EQ(j.dimension, 1);
        raise(e.curve, error(j.x, placed.point(truth.c)));
        raise(e.first, relative(j.dx[0], placed.direction(truth.ct)));
        raise(e.second, relative(j.dxx, placed.direction(truth.ctt)));
        EXPECT_EQ(j.dx[1], dvec3(0.0));
        EXPECT_EQ(j.dxy, dvec3(0.0));
        EXPECT_EQ(j.dyy, dvec3(0.0));
      }
    }
    for (int p = 0; p < int(part.vertices().size()); ++p) {
      const ContactJet j = geometry.jet({i, SourceKind::vertex, p, 0, 0});
      EXPECT_EQ(j.dimension, 0);
      EXPECT_EQ(j.dx[0], dvec3(0.0));
      raise(e.vertex, error(j.x, placed.point(rvec3(part.vertices()[std::size_t(p)]))));
    }
  }
  return e;
}

TEST(ContactGeometry, JetsOfPlacedElements) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const JetErrors e = jet_errors(scattered(seed, 0));
    EXPECT_LT(e.patch, 2e-15) << seed;
    EXPECT_LT(e.curve, 2e-15) << seed;
    EXPECT_LT(e.vertex, 2e-15) << seed;
    EXPECT_LT(e.first, 1e-14) << seed;
    EXPECT_LT(e.second, 1e-13) << seed;
    EXPECT_LT(e.third, 1e-8) << seed;  // of the differences
  }
}

/// Control points are stored to rounding of their coordinates and poses turn them; derivatives do
/// not know how far from the origin they are taken.
TEST(ContactGeometry, JetsFarFromTheOrigin) {
  Random random(11);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const double at = log_uniform(random, 10, 1e7);
    const Scene scene = scattered(seed, at);
    const JetErrors e = jet_errors(scene);
    const real rounding = 16 * rounding_unit * real(at * scene.frame().scale) + 2e-15L;
    EXPECT_LT(e.patch, rounding) << at;
    EXPECT_LT(e.curve, rounding) << at;
    EXPECT_LT(e.vertex, rounding) << at;
  }
}

TEST(ContactGeometry, DirectionsGoToTheInstanceAndBack) {
  const Scene scene = scattered(5, 3);
  const ContactGeometry geometry(scene);
  Random random(6);
  for (int i = 0; i < 3; ++i) {
    const dmat3& turn = scene.model().instances()[std::size_t(i)].pose.rotation;
    for (int k = 0; k < 10; ++k) {
      const dvec3 n = random_direction(random);
      EXPECT_LT(glm::distance(geometry.to_frame(i, n), turn * n), 1e-15);
      EXPECT_LT(glm::distance(geometry.to_local(i, geometry.to_frame(i, n)), n), 1e-15);
    }
  }
}

/// Elements that contacts at the corners, the middles of the sides and inside of all patches have.
struct Canonical {
  int faces = 0, edges = 0, vertices = 0;
};

Canonical canonical_forms(const Shape& shape) {
  Model model = make_model(shape);
  model.add_instance(0, {skew_rotation(), dvec3(0.1, -0.2, 0.3)});
  const Scene scene(std::move(model), {.threads = 1, .progress = {}});
  const ContactGeometry geometry(scene);
  Canonical found;
  for (int i = 0; i < 2; ++i) {
    const Part& part = geometry.part({i, SourceKind::face, 0, 0, 0});
    const auto check = [&](const Contact& from) {
      const Contact c = geometry.canonical(from);
      const Contact again = geometry.canonical(c);
      EXPECT_EQ(c.instance, i);
      EXPECT_TRUE(same_element(c, again) && c.u == again.u && c.v == again.v);
      EXPECT_LT(glm::distance(geometry.point(c), geometry.point(from)), 1e-7);
      ++(c.kind == SourceKind::face   ? found.faces
         : c.kind == SourceKind::edge ? found.edges
                                      : found.vertices);
      return c;
    };
    for (int p = 0; p < int(part.patches().size()); ++p) {
      for (const double u : {0.0, 0.3, 1.0}) {
        for (const double v : {0.0, 0.6, 1.0}) check({i, SourceKind::face, p, u, v});
      }
      // Only what lies on a border exactly is told as something else.
      const Contact beside{i, SourceKind::face, p, 1e-15, 0.5};
      EXPECT_TRUE(same_element(geometry.canonical(beside), beside));
    }
    for (int p = 0; p < int(part.pieces().size()); ++p) {
      for (const double t : {0.0, 0.3, 1.0}) {
        const Contact c = check({i, SourceKind::edge, p, t, 0});
        EXPECT_EQ(c.kind == SourceKind::vertex,
                  t != 0.3 && part.pieces()[std::size_t(p)].end_vertex[t == 0 ? 0 : 1] >= 0);
      }
    }
    for (int p = 0; p < int(part.vertices().size()); ++p) {
      const Contact c{i, SourceKind::vertex, p, 0, 0};
      EXPECT_TRUE(same_element(geometry.canonical(c), c));
    }
  }
  EXPECT_EQ(found.faces % 2 + found.edges % 2 + found.vertices % 2, 0);
  return {found.faces / 2, found.edges / 2, found.vertices / 2};
}

TEST(ContactGeometry, CanonicalFormsOfABox) {
  // Six faces with a middle, four sides and four corners; twelve edges with two ends.
  const Canonical c = canonical_forms(box(1, 2, 3));
  EXPECT_EQ(c.faces, 6);
  EXPECT_EQ(c.edges, 24 + 12);
  EXPECT_EQ(c.vertices, 24 + 24);
}

TEST(ContactGeometry, CanonicalFormsOnClosedEdges) {
  // Two circles of four pieces that no vertex parts; seams between the patches.
  const Canonical c = canonical_forms(cylinder(1, 2));
  EXPECT_EQ(c.vertices, 0);
  EXPECT_EQ(c.edges, 4 * 2 * 3 + 8 * 3);
  EXPECT_EQ(c.faces, 4 * 3);
}

TEST(ContactGeometry, CanonicalFormsAtATipAndAtPoles) {
  // Of each patch three places collapse onto the tip.
  const Canonical tip = canonical_forms(cone(1, 2));
  EXPECT_EQ(tip.vertices, 4 * 3);
  EXPECT_EQ(tip.edges, 4 * 3 + 4 * 3);
  EXPECT_EQ(tip.faces, 4 * 3);
  const Canonical poles = canonical_forms(sphere(1));
  EXPECT_EQ(poles.faces, 8 * 9);
  EXPECT_EQ(poles.edges + poles.vertices, 0);
}

TEST(ContactGeometry, SidesAndEndsMeetTheirPiecesAndVertices) {
  Shape fan;  // three faces that meet in one edge, each its own way round
  const dvec3 a(0, 0, 0);
  const dvec3 b(0, 0.1, 1);
  const auto bilinear = [](const std::array<dvec3, 4>& corners) {
    BezierPatch patch{1, 1, {}};
    for (const dvec3& p : corners) patch.points.push_back(homogeneous(p));
    return patch;
  };
  fan = of_patch(bilinear({a, b, dvec3(1, 0, 0), dvec3(1, 0, 1)})) +
        of_patch(bilinear({b, dvec3(-1, 1, 1), a, dvec3(-1, 1, 0)})) +
        of_patch(bilinear({dvec3(-1, -1, 1), dvec3(-1, -1, 0), b, a}));
  struct Case {
    Shape shape;
    std::vector<int> sides, ruled, ends;  // numbers of pieces and vertices by numbers of these
  };
  const std::vector<Case> cases = {
      {box(1, 2, 3), {12}, {0, 0, 12}, {0, 0, 0, 8}},
      {solid_cylinder(1, 2), {8}, {0, 0, 8}, {}},
      {cone(1, 2), {4}, {0, 4}, {1}},
      {spherical_cap(0.6), {0, 4}, {4}, {}},
      {spherical_cap(0.6) + disc(std::sqrt(1 - 0.4 * 0.4), 0.4), {0, 4}, {0, 4}, {}},
      {torus(2, 0.5), {0, 0, 8}, {8}, {}},  // the crests
      {fan, {10}, {0, 9, 0, 1}, {0, 0, 6, 0, 2}},
      {{{}, {segment(a, b), twisted_cubic()}, {dvec3(2, 2, 2)}}, {2}, {2}, {1, 2, 1}},
  };
  for (const Case& each : cases) {
    const Scene scene = make_scene(each.shape);
    const ContactGeometry geometry(scene);
    const Part& part = scene.model().parts()[0];
    std::vector<int> sides(each.sides.size());
    std::vector<int> ruled(each.ruled.size());
    std::vector<int> ends(each.ends.size());
    for (int p = 0; p < int(part.pieces().size()); ++p) {
      const Contact piece{0, SourceKind::edge, p, 0, 0};
      std::vector<ContactGeometry::PieceSide> all = geometry.sides(piece);
      const auto& of_ruled = geometry.ruled_sides(piece);
      ++sides.at(all.size());
      ++ruled.at(of_ruled.size());
      for (const auto& s : all) EXPECT_FALSE(geometry.is_ruled({0, SourceKind::face, s.patch}));
      for (const auto& s : of_ruled) EXPECT_TRUE(geometry.is_ruled({0, SourceKind::face, s.patch}));
      all.insert(all.end(), of_ruled.begin(), of_ruled.end());
      for (const ContactGeometry::PieceSide& s : all) {
        for (const double t : {0.0, 0.2, 1.0}) {
          const double along = s.reversed ? 1 - t : t;
          Contact c{0, SourceKind::face, s.patch, along, along};
          if (s.side == Side::u0 || s.side == Side::u1) {
            c.u = s.side == Side::u0 ? 0 : 1;
          } else {
            c.v = s.side == Side::v0 ? 0 : 1;
          }
          EXPECT_LT(
              glm::distance(geometry.point(c), geometry.point({0, SourceKind::edge, p, t, 0})),
              1e-7);
          if (t == 0.2) {
            const Contact back = geometry.canonical(c);
            EXPECT_TRUE(back.kind == SourceKind::edge && back.element == p);
            EXPECT_NEAR(back.u, t, 1e-15);
          }
        }
      }
    }
    for (int v = 0; v < int(part.vertices().size()); ++v) {
      const auto& own = geometry.ends({0, SourceKind::vertex, v, 0, 0});
      ++ends.at(own.size());
      for (const ContactGeometry::PieceEnd& e : own) {
        EXPECT_LT(glm::distance(geometry.point({0, SourceKind::vertex, v, 0, 0}),
                                geometry.point({0, SourceKind::edge, e.piece, double(e.end), 0})),
                  1e-7);
      }
    }
    EXPECT_EQ(sides, each.sides);
    EXPECT_EQ(ruled, each.ruled);
    EXPECT_EQ(ends, each.ends);
  }
}

TEST(ContactGeometry, CurvesArePlacedPieces) {
  const Scene scene = scattered(4, 5);
  const ContactGeometry geometry(scene);
  int checked = 0;
  for (int i = 0; i < int(scene.model().instances().size()); ++i) {
    const Part& part = geometry.part({i, SourceKind::edge, 0, 0, 0});
    for (int p = 0; p < int(part.pieces().size()); ++p) {
      const BezierCurve curve = geometry.curve({i, SourceKind::edge, p, 0, 0});
      for (const double t : {0.0, 0.3, 1.0}) {
        EXPECT_LT(glm::distance(point(curve, t), geometry.point({i, SourceKind::edge, p, t, 0})),
                  2e-15);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 100);
}

TEST(ContactGeometry, StraightPiecesAndRuledPatches) {
  struct Case {
    const char* name;
    Shape shape;
    int straight, ruled;  // of the pieces and patches
  };
  const std::vector<Case> cases = {
      {"box", box(1, 2, 3), 12, 6},
      {"cylinder", solid_cylinder(1, 2), 0, 12},
      {"cap", spherical_cap(0.6), 0, 0},
      {"paraboloid", paraboloid(), 0, 0},
      {"saddle of lines", bilinear_saddle(), 4, 1},
      {"filleted box", filleted_box(1, 2, 3, 0.2), 0, 18},
      {"a cubic that is a segment",
       {{},
        {as_nurbs(BezierCurve{{{0, 0, 0, 1}, {0.1, 0.1, 0, 1}, {0.5, 0.5, 0, 1}, {1, 1, 0, 1}}})},
        {{0, 1, 2}}},
       1,
       0},
      {"a curve that is bent a little",
       {{},
        {as_nurbs(BezierCurve{{{0, 0, 0, 1}, {0.5, 0.5 + 1e-9, 0, 1}, {1, 1, 0, 1}}})},
        {{0, 1, 2}}},
       0,
       0},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    const Scene scene = make_scene(mapped(each.shape, skew_rotation()));
    const ContactGeometry geometry(scene);
    const Part& part = scene.model().parts()[0];
    int straight = 0;
    int ruled = 0;
    for (int p = 0; p < int(part.pieces().size()); ++p) {
      straight += geometry.is_straight({0, SourceKind::edge, p, 0, 0}) ? 1 : 0;
    }
    for (int p = 0; p < int(part.patches().size()); ++p) {
      ruled += geometry.is_ruled({0, SourceKind::face, p, 0, 0}) ? 1 : 0;
    }
    EXPECT_EQ(straight, each.straight);
    EXPECT_EQ(ruled, each.ruled);
  }
}

/// The contact near c that supports in a direction, by Newton's method on the slopes' squares.
Contact moved_to(const ContactGeometry& geometry, Contact c, const dvec3& n) {
  for (int k = 0; k < 20; ++k) {
    const ContactJet j = geometry.jet(c);
    const glm::dmat2 hessian(glm::dot(j.dxx, n), glm::dot(j.dxy, n), glm::dot(j.dxy, n),
                             j.dimension == 2 ? glm::dot(j.dyy, n) : 1);
    const dvec2 step = glm::inverse(hessian) * dvec2(glm::dot(j.dx[0], n), glm::dot(j.dx[1], n));
    c.u -= step.x;
    c.v -= step.y;
  }
  return c;
}

TEST(ParameterRate, AgreesWithDifferences) {
  const Scene scene = make_scene(mapped(ellipsoid(3, 2, 1), skew_rotation()) +
                                 Shape{{}, {circle({1, 2, 3}, {1, 0.2, 0}, {0, 0.5, 0.5})}, {}});
  const ContactGeometry geometry(scene);
  Random random(9);
  for (const SourceKind kind : {SourceKind::face, SourceKind::edge}) {
    for (int k = 0; k < 50; ++k) {
      const Contact c{0, kind, pick(random, 0, 3), uniform(random, 0.2, 0.8),
                      kind == SourceKind::face ? uniform(random, 0.2, 0.8) : 0};
      const ContactJet j = geometry.jet(c);
      // A direction that supports there: along the normal, or across the curve and outward.
      dvec3 n = glm::cross(j.dx[0], j.dx[1]);
      if (kind == SourceKind::edge) n = -j.dxx + glm::dot(j.dxx, unit(j.dx[0])) * unit(j.dx[0]);
      n = unit(n);
      if (glm::dot(j.dxx, n) > 0) n = -n;
      dvec3 dn = random_direction(random);
      dn -= glm::dot(dn, n) * n;
      const std::optional<dvec2> rate = parameter_rate(j, n, dn);
      ASSERT_TRUE(rate);
      const double h = 1e-5;
      const Contact ahead = moved_to(geometry, c, n + h * dn);
      const Contact behind = moved_to(geometry, c, n - h * dn);
      EXPECT_NEAR((ahead.u - behind.u) / (2 * h), rate->x, 1e-8);
      EXPECT_NEAR((ahead.v - behind.v) / (2 * h), rate->y, 1e-8);
    }
  }
}

/// Points of the model on an edge are the edge's, others their own.
TEST(ContactGeometry, PointsOnEdges) {
  Shape shape = solid_cylinder(1, 2);
  shape.points = {{std::cos(0.3), std::sin(0.3), 2}, {1, 0, 0}, {1 + 1e-9, 0, 1}, {0, 0, 2}};
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  const std::array<bool, 4> on_edge = {true, true, false, false};
  for (int k = 0; k < 4; ++k) {
    const Contact point{0, SourceKind::vertex, k, 0, 0};
    const Contact c = geometry.canonical(point);
    EXPECT_EQ(geometry.is_repeated(point), on_edge[std::size_t(k)]) << k;
    EXPECT_EQ(c.kind == SourceKind::edge, on_edge[std::size_t(k)]) << k;
    EXPECT_LE(glm::distance(geometry.point(c), geometry.point(point)), geometry.tie()) << k;
  }
}

/// Straight pieces that go on into each other are one segment between its vertices.
TEST(ContactGeometry, SegmentsOfSeveralPieces) {
  const Scene scene = make_scene(split(box(1, 2, 3), 0.3, 0.6));
  const ContactGeometry geometry(scene);
  const Part& part = scene.model().parts()[0];
  ASSERT_GT(part.pieces().size(), 12U);
  for (int k = 0; k < int(part.pieces().size()); ++k) {
    const Contact c{0, SourceKind::edge, k, 0.5, 0};
    ASSERT_TRUE(geometry.is_straight(c)) << k;
    const dvec3 d =
        geometry.point(geometry.straight_end(c, 1)) - geometry.point(geometry.straight_end(c, 0));
    const dvec3 along = geometry.jet(c).dx[0];
    EXPECT_LE(glm::length(glm::cross(d, along)), 1e-15) << k;
    EXPECT_GT(glm::dot(d, along), 0) << k;
  }
}

TEST(ParameterRate, NoneWithoutAStrictMaximum) {
  const dvec3 n(0, 0, 1);
  const dvec3 dn(1, 0, 0);
  ContactJet j;
  EXPECT_EQ(parameter_rate(j, n, dn), dvec2(0.0));  // a vertex rests
  j.dimension = 1;
  j.dx[0] = {1, 0, 0};
  EXPECT_FALSE(parameter_rate(j, n, dn));  // a straight curve
  j.dxx = {0, 0, 0.5};
  EXPECT_FALSE(parameter_rate(j, n, dn));  // a minimum
  j.dxx = {0, 0, -0.5};
  EXPECT_EQ(parameter_rate(j, n, dn), dvec2(2, 0));
  j.dimension = 2;
  j.dx[1] = {0, 1, 0};
  EXPECT_FALSE(parameter_rate(j, n, dn));  // a cylinder
  j.dyy = {0, 0, 1};
  EXPECT_FALSE(parameter_rate(j, n, dn));  // a saddle
  j.dyy = {0, 0, -0.5};
  EXPECT_EQ(parameter_rate(j, n, dn), dvec2(2, 0));
  j.dxy = {0, 0, 0.5};
  EXPECT_FALSE(parameter_rate(j, n, dn));  // a saddle's limit
}

}  // namespace
}  // namespace taut
