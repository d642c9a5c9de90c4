#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sound_hull.h"
#include "taut/io/document_geometry.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

Shape tetrahedron() { return {{}, {}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }

void expect_sound(const Shape& shape, const char* name) {
  const Sound sound = sound_hull(shape);
  const HullVerification v = verified(sound.hull, sound.scene);
  EXPECT_TRUE(v.is_hull(exact)) << name << ": " << text_of(v);
}

/// Turned, tiny, huge and far away.
void expect_sound_anywhere(const Shape& shape, const char* name) {
  expect_sound(shape, name);
  expect_sound(mapped(shape, skew_rotation()), name);
  expect_sound(scaled(shape, 1e-6), name);
  expect_sound(scaled(shape, 1e6), name);
  expect_sound(shifted(shape, dvec3(1e3, -2e3, 3e3)), name);
  expect_sound(shifted(shape, dvec3(3e6, 2e6, -1e6)), name);
}

TEST(VerifySoundHulls, Tetrahedron) { expect_sound_anywhere(tetrahedron(), "tetrahedron"); }
TEST(VerifySoundHulls, TwoSpheres) { expect_sound_anywhere(two_spheres(1, 0.5, 3), "spheres"); }
TEST(VerifySoundHulls, Oloid) { expect_sound_anywhere(oloid(), "oloid"); }
TEST(VerifySoundHulls, DentedEllipsoid) { expect_sound_anywhere(dented_ellipsoid(), "dented"); }
TEST(VerifySoundHulls, Teapot) { expect_sound(teapot(), "teapot"); }
/// Edges that end where only the face on one side does.
TEST(VerifySoundHulls, SpheresWithAnOloid) {
  const Shape turned = mapped(oloid(), skew_rotation());
  expect_sound(two_spheres(1, 0.5, 3) + shifted(turned, dvec3(1, 2, 0)), "spheres and oloid");
}
TEST(VerifySoundHulls, PatchesWithCurvesAndPoints) {
  for (const unsigned seed : {1U, 2U, 4U, 5U, 8U, 11U, 13U}) {
    Random random(seed);
    Shape shape;
    for (unsigned k = 0; k < 1 + seed % 3; ++k) {
      const double weights = seed % 4 != 0 ? 1 : 3;
      shape.surfaces.push_back(as_nurbs(random_patch(random, 2 + int(seed % 2), 3, weights)));
      shape.curves.push_back(as_nurbs(random_curve(random, 3, 1)));
      shape.points.push_back(random_point(random));
    }
    expect_sound(shape, std::to_string(seed).c_str());
  }
}
TEST(VerifySoundHulls, BlobsWithFreeEnds) {
  for (const unsigned seed : {1U, 2U, 3U}) expect_sound(blob(seed), "blob");
}

/// A fault and the check that must find it.
struct Damage {
  const char* name;
  const char* finder;
  std::function<void(HullDocument&)> damage;
};

void expect_found(const Sound& sound, const std::vector<Damage>& damages) {
  ASSERT_TRUE(verified(sound.hull, sound.scene).is_hull(exact))
      << text_of(verified(sound.hull, sound.scene));
  for (const Damage& d : damages) {
    HullDocument hull = sound.hull;
    d.damage(hull);
    const HullVerification v = verified(hull, sound.scene);
    EXPECT_FALSE(v.is_hull(exact)) << d.name;
    EXPECT_TRUE(failed(v).contains(d.finder)) << d.name << ": " << text_of(v);
  }
}

std::size_t first_of(const HullDocument& hull, FaceKind kind) {
  for (std::size_t i = 0; i < hull.faces.size(); ++i) {
    if (hull.faces[i].kind == kind) return i;
  }
  throw std::logic_error("no such face");
}

HullDocument::Face& scroll_of(HullDocument& hull) {
  return hull.faces[first_of(hull, FaceKind::scroll)];
}
HullDocument::Face& patch_of(HullDocument& hull) {
  return hull.faces[first_of(hull, FaceKind::patch)];
}
HullDocument::Face& facet_of(HullDocument& hull) {
  return hull.faces[first_of(hull, FaceKind::facet)];
}

using DirectedCurve = HullDocument::DirectedCurve;

/// Takes curves out; what names them no longer does.
void remove_curve(HullDocument& hull, int curve) {
  const auto renumber = [&](int& c) { c -= c > curve ? 1 : 0; };
  const auto from_outline = [&](std::vector<DirectedCurve>& outline) {
    std::erase_if(outline, [&](const DirectedCurve& c) { return c.first == curve; });
    for (DirectedCurve& c : outline) renumber(c.first);
  };
  for (HullDocument::Face& face : hull.faces) {
    for (HullDocument::Loop& loop : face.loops) from_outline(loop.curves);
    from_outline(face.outline);
    for (std::vector<int>& side : face.curves) {
      std::erase(side, curve);
      for (int& c : side) renumber(c);
    }
  }
  hull.curves.erase(hull.curves.begin() + curve);
}

void remove_face(HullDocument& hull, int face) {
  hull.faces.erase(hull.faces.begin() + face);
  for (HullDocument::Curve& curve : hull.curves) {
    for (int& f : curve.faces) f = f == face ? -1 : f - (f > face ? 1 : 0);
  }
}

/// The number behind a key in the report, times a factor and plus a step.
void change_number(std::string& report, const std::string& key, double factor, double step) {
  const std::size_t hull = report.find("\"hull\": {");
  const std::size_t at = report.find("\"" + key + "\": ", hull) + key.size() + 4;
  const std::size_t end = report.find_first_of(",\n", at);
  std::ostringstream number;
  number.precision(17);
  number << std::stod(report.substr(at, end - at)) * factor + step;
  report.replace(at, end - at, number.str());
}

/// Faults in the hull of two spheres: two patches about a closed scroll.
TEST(VerifyFaults, InTheHullOfTwoSpheresAreFound) {
  const Sound sound = sound_hull(two_spheres(1, 0.5, 3));
  const double size = sound.hull.diagonal;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_found(
      sound,
      {{"a curve is missing", "regions", [](auto& h) { remove_curve(h, 0); }},
       {"a patch is missing", "complete",
        [](auto& h) { remove_face(h, int(first_of(h, FaceKind::patch))); }},
       {"a scroll is missing", "complete",
        [](auto& h) { remove_face(h, int(first_of(h, FaceKind::scroll))); }},
       {"a scroll is missing with its curves", "vector_area",
        [](auto& h) {
          remove_face(h, int(first_of(h, FaceKind::scroll)));
          remove_curve(h, 1);
          remove_curve(h, 0);
        }},
       {"the same, and the patches have no loops", "euler",
        [](auto& h) {
          remove_face(h, int(first_of(h, FaceKind::scroll)));
          h.curves.clear();
          for (auto& face : h.faces) face.loops.clear();
        }},
       {"a loop runs backwards", "regions",
        [](auto& h) {
          auto& uv = patch_of(h).loops[0].uv;
          std::reverse(uv.begin(), uv.end());
        }},
       {"a loop's curve runs backwards", "closed",
        [](auto& h) { patch_of(h).loops[0].curves[0].second *= -1; }},
       {"a region's outline runs backwards", "regions",
        [](auto& h) {
          auto& loop = patch_of(h).regions[0].loops[0];
          std::reverse(loop.begin(), loop.end());
        }},
       {"a loop's point is moved", "off_outline",
        [](auto& h) { patch_of(h).loops[0].uv[5].y += 1e-6; }},
       {"a region's point is moved", "off_outline",
        [](auto& h) { patch_of(h).regions[0].loops[0][3] += dvec2(1e-6); }},
       {"a region is missing", "covered", [](auto& h) { patch_of(h).regions.pop_back(); }},
       {"a region stands twice", "regions",
        [](auto& h) { patch_of(h).regions.push_back(patch_of(h).regions[0]); }},
       {"a region's sign is wrong", "patch_outside",
        [](auto& h) { patch_of(h).regions[0].sign *= -1; }},
       {"a scroll is shifted", "off_source",
        [&](auto& h) {
          for (auto& r : scroll_of(h).rulings) {
            r.a.p.x += 1e-9 * size;
            r.b.p.x += 1e-9 * size;
          }
        }},
       {"a scroll's parameters are shifted", "off_source",
        [](auto& h) {
          for (auto& r : scroll_of(h).rulings) r.a.uv[1] += 1e-9;
        }},
       {"a ruling's normal is turned", "tangency",
        [](auto& h) {
          auto& n = scroll_of(h).rulings[7].n;
          n = unit(n + 1e-8 * tangent_frame(n)[0]);
        }},
       {"a ruling's normal is too long", "tangency",
        [](auto& h) { scroll_of(h).rulings[7].n *= 1 + 1e-9; }},
       {"rulings are in the wrong order", "order",
        [](auto& h) { std::swap(scroll_of(h).rulings[4], scroll_of(h).rulings[5]); }},
       {"a ruling is missing", "off_outline",
        [](auto& h) { scroll_of(h).rulings.erase(scroll_of(h).rulings.begin() + 5); }},
       {"the scroll runs backwards", "order",
        [](auto& h) {
          auto& rulings = scroll_of(h).rulings;
          std::reverse(rulings.begin(), rulings.end());
        }},
       {"parameters are outside of the domain", "off_source",
        [](auto& h) { scroll_of(h).rulings[3].a.uv[1] = -0.25; }},
       {"a number is none", "numbers", [&](auto& h) { scroll_of(h).rulings[3].b.p.y = nan; }},
       {"a curve's point is moved", "off_outline",
        [&](auto& h) { h.curves[0].points[3].z += 1e-9 * size; }},
       {"a curve's faces are exchanged", "closed",
        [](auto& h) { std::swap(h.curves[0].faces[0], h.curves[0].faces[1]); }},
       {"two curves' faces are exchanged", "closed",
        [](auto& h) { std::swap(h.curves[0].faces, h.curves[1].faces); }},
       {"a curve is called a join", "kinds",
        [](auto& h) { h.curves[0].kind = HullCurveKind::join; }},
       {"a curve is called an edge", "kinds",
        [](auto& h) { h.curves[0].kind = HullCurveKind::edge; }},
       {"a curve is called a ruling", "kinds",
        [](auto& h) { h.curves[0].kind = HullCurveKind::ruling; }},
       {"a curve is passed twice", "closed",
        [](auto& h) {
          auto& curves = patch_of(h).loops[0].curves;
          curves.push_back(curves[0]);
        }},
       {"a control point is moved", "off_model",
        [&](auto& h) { h.sources[0].patches[1].points[4].x += 1e-9 * size; }},
       {"a weight is changed", "off_model",
        [](auto& h) { h.sources[0].patches[1].points[4].w *= 1 + 1e-9; }},
       {"a source has another's id", "off_model",
        [](auto& h) { std::swap(h.sources[0].id, h.sources[1].id); }},
       {"a source has no one's id", "sources", [](auto& h) { h.sources[0].id = 1000; }},
       {"the diagonal is wrong", "off_model", [](auto& h) { h.diagonal *= 1 + 1e-9; }},
       {"the dimension is wrong", "report", [](auto& h) { h.dimension = 2; }},
       {"the number of patches is wrong", "report",
        [](auto& h) { change_number(h.report, "patches", 1, 1); }},
       {"the number of curves is wrong", "report",
        [](auto& h) { change_number(h.report, "curves", 1, -1); }},
       {"something is unresolved", "report",
        [](auto& h) { change_number(h.report, "unresolved", 1, 1); }},
       {"the volume is wrong", "report",
        [](auto& h) { change_number(h.report, "volume", 1 + 1e-6, 0); }},
       {"the area is wrong", "report",
        [](auto& h) { change_number(h.report, "area", 1 - 1e-8, 0); }},
       {"the mean width is wrong", "report",
        [](auto& h) { change_number(h.report, "mean_width", 1 + 1e-8, 0); }},
       {"the report is none", "report", [](auto& h) { h.report = "{"; }}});
}

/// Faults of facets.
TEST(VerifyFaults, InATetrahedronAreFound) {
  const Sound sound = sound_hull(tetrahedron());
  const double size = sound.hull.diagonal;
  expect_found(
      sound,
      {{"a facet's offset is wrong", "flatness",
        [&](auto& h) { h.faces[1].offset += 1e-9 * size; }},
       {"a facet is shifted", "hull_outside",
        [&](auto& h) {
          h.faces[1].offset += 1e-9 * size;
          for (auto& p : h.faces[1].boundary) p += 1e-9 * size * h.faces[1].normal;
          for (auto& c : h.faces[1].contacts) c.p += 1e-9 * size * h.faces[1].normal;
        }},
       {"a contact is moved", "off_source",
        [&](auto& h) { h.faces[1].contacts[0].p.x += 1e-9 * size; }},
       {"a contact has another source", "off_source",
        [](auto& h) { h.faces[1].contacts[0].source ^= 1; }},
       {"a corner is moved", "off_outline",
        [&](auto& h) {
          const dvec3 along = h.faces[1].boundary[1] - h.faces[1].boundary[0];
          h.faces[1].boundary[0] += 1e-9 * along;
        }},
       {"the boundary runs backwards", "outlines",
        [](auto& h) { std::reverse(h.faces[1].boundary.begin(), h.faces[1].boundary.end()); }},
       {"a facet is turned over", "model_outside",
        [](auto& h) {
          h.faces[1].normal *= -1.0;
          h.faces[1].offset *= -1.0;
        }},
       {"a facet stands twice", "closed", [](auto& h) { h.faces.push_back(h.faces[1]); }},
       {"another facet lies inside", "euler",
        [](auto& h) {
          HullDocument::Face face = h.faces[1];
          face.outline.clear();
          face.offset -= 0.1;
          for (auto& p : face.boundary) p -= 0.1 * face.normal;
          h.faces.push_back(face);
        }},
       {"a facet is missing", "complete", [](auto& h) { remove_face(h, 2); }},
       {"a facet and its curves' sides are missing", "euler",
        [](auto& h) {
          remove_face(h, 3);
          for (auto& c : h.curves) {
            for (int& f : c.faces) f = std::max(f, 0);
          }
        }},
       {"a ruling is bent", "kinds",
        [](auto& h) {
          auto& points = h.curves[0].points;
          points.insert(points.begin() + 1, 0.5 * (points[0] + points[1]) + dvec3(1e-3));
        }},
       {"a ruling is called a bitangent", "kinds",
        [](auto& h) { h.curves[0].kind = HullCurveKind::bitangent; }}});
}

/// Faults of scrolls with ends, of patches with free ends and of edges.
TEST(VerifyFaults, InCurvedHullsAreFound) {
  expect_found(
      sound_hull(dented_ellipsoid()),
      {{"a dent's patch is filled", "regions",
        [](auto& h) {
          for (auto& region : patch_of(h).regions) {
            const auto& domain = h.sources[0].patches[std::size_t(region.patch)].domain;
            const Interval& u = domain[0];
            const Interval& v = domain[1];
            region.loops = {
                {{u.lower, v.lower}, {u.upper, v.lower}, {u.upper, v.upper}, {u.lower, v.upper}}};
          }
        }},
       {"the same, without a loop, scroll and curves", "patch_outside",
        [](auto& h) {
          remove_face(h, int(first_of(h, FaceKind::scroll)));
          h.curves.clear();
          patch_of(h).loops.clear();
          for (auto& region : patch_of(h).regions) {
            const auto& domain = h.sources[0].patches[std::size_t(region.patch)].domain;
            const Interval& u = domain[0];
            const Interval& v = domain[1];
            region.loops = {
                {{u.lower, v.lower}, {u.upper, v.lower}, {u.upper, v.upper}, {u.lower, v.upper}}};
          }
        }},
       {"a patch is split", "euler",
        [](auto& h) {
          HullDocument::Face half = patch_of(h);
          half.loops.clear();
          half.regions.resize(3);
          patch_of(h).regions.erase(patch_of(h).regions.begin(), patch_of(h).regions.begin() + 3);
          h.faces.push_back(half);
        }},
       {"a patch is split along a join", "kinds", [](auto& h) {
          h.faces.push_back(patch_of(h));
          const int first = int(first_of(h, FaceKind::patch));
          h.curves.push_back({HullCurveKind::join,
                              {first, int(h.faces.size()) - 1},
                              -1,
                              {h.curves[0].points[0], h.curves[0].points[1]}});
        }}});
  expect_found(sound_hull(oloid()),
               {{"an edge is called a ruling", "kinds",
                 [](auto& h) {
                   for (auto& c : h.curves) {
                     if (c.kind == HullCurveKind::edge) c.kind = HullCurveKind::ruling;
                   }
                 }},
                {"an edge's point is moved", "off_outline",
                 [](auto& h) {
                   for (auto& c : h.curves) {
                     if (c.kind == HullCurveKind::edge) c.points[1] *= 1 + 1e-9;
                   }
                 }},
                {"rulings are in the wrong order", "order",
                 [](auto& h) { std::swap(scroll_of(h).rulings[4], scroll_of(h).rulings[5]); }},
                {"a ruling's parameter is moved", "tangency",
                 [](auto& h) { scroll_of(h).rulings[4].a.uv[0] += 1e-9; }}});
  expect_found(sound_hull(teapot()),
               {{"a scroll is missing", "complete",
                 [](auto& h) { remove_face(h, int(first_of(h, FaceKind::scroll))); }},
                {"a facet's contact is moved", "off_source",
                 [](auto& h) { facet_of(h).contacts[0].p *= 1 + 1e-9; }},
                {"a facet's plane is turned", "tangency",
                 [](auto& h) {
                   dvec3& n = facet_of(h).normal;
                   n = unit(n + 1e-8 * tangent_frame(n)[0]);
                 }},
                {"a patch's regions are left out", "covered",
                 [](auto& h) { patch_of(h).regions.clear(); }}});
}

TEST(VerifyFaults, HullsOfOtherModelsAreFound) {
  const Sound sound = sound_hull(two_spheres(1, 0.5, 3));
  for (const double change : {1e-9, 1e-3}) {
    const Scene other = make_scene(two_spheres(1 + change, 0.5, 3));
    EXPECT_TRUE(failed(verified(sound.hull, other)).contains("off_model"));
    EXPECT_FALSE(verified(sound.hull, other).is_hull(exact));
  }
  const Scene more = make_scene(two_spheres(1, 0.5, 3) + shifted(sphere(), dvec3(5, 0, 0)));
  const HullVerification v = verified(sound.hull, more);
  EXPECT_GT(v.uncovered, 0);
  EXPECT_GT(v.model_outside, 0.1);
}

/// Each fault is told in a line that names its place.
TEST(VerifyFaults, AreNamed) {
  Sound sound = sound_hull(two_spheres(1, 0.5, 3));
  sound.hull.curves[1].kind = HullCurveKind::join;
  change_number(sound.hull.report, "unresolved", 1, 2);
  const HullVerification v = verified(sound.hull, sound.scene);
  ASSERT_EQ(v.faults.size(), 2U) << text_of(v);
  EXPECT_EQ(v.faults[0].text, "curves[1]: a join not between sources");
  EXPECT_EQ(v.faults[1].text, "report: unresolved is 2, not 0");
}

}  // namespace
}  // namespace taut
