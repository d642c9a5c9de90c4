#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "sound_hull.h"
#include "taut/verify/document_geometry.h"

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
TEST(VerifySoundHulls, SolidCylinder) { expect_sound_anywhere(solid_cylinder(1, 2), "cylinder"); }
TEST(VerifySoundHulls, Torus) { expect_sound_anywhere(torus(2, 0.5), "torus"); }
TEST(VerifySoundHulls, Cap) { expect_sound_anywhere(spherical_cap(0.6), "cap"); }
TEST(VerifySoundHulls, Paraboloid) { expect_sound_anywhere(paraboloid(), "paraboloid"); }
TEST(VerifySoundHulls, FilletedBox) { expect_sound(filleted_box(1, 2, 3, 0.2), "filleted box"); }
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
/// The ruling that those before and after it are the farthest from.
auto most_alone(HullDocument::Face& scroll) {
  auto& rulings = scroll.rulings;
  const auto way = [&](std::size_t k) {
    return std::min(glm::distance(rulings[k - 1].n, rulings[k].n),
                    glm::distance(rulings[k].n, rulings[k + 1].n));
  };
  std::size_t found = 1;
  for (std::size_t k = 2; k + 1 < rulings.size(); ++k) {
    if (way(k) > way(found)) found = k;
  }
  return rulings.begin() + std::ptrdiff_t(found);
}

HullDocument::Face& patch_of(HullDocument& hull) {
  return hull.faces[first_of(hull, FaceKind::patch)];
}

/// Makes the first patch's regions the whole of their Bezier patches.
void fill_regions(HullDocument& hull) {
  for (auto& region : patch_of(hull).regions) {
    const auto& domain = hull.sources[0].patches[std::size_t(region.patch)].domain;
    const Interval& u = domain[0];
    const Interval& v = domain[1];
    region.loops = {
        {{u.lower, v.lower}, {u.upper, v.lower}, {u.upper, v.upper}, {u.lower, v.upper}}};
  }
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
        [](auto& h) { scroll_of(h).rulings.erase(most_alone(scroll_of(h))); }},
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
       {"a wrong volume is said to be inaccurate", "report",
        [](auto& h) {
          change_number(h.report, "volume", 1 + 1e-6, 0);
          const std::string hull = "\"hull\": {";
          h.report.insert(h.report.find(hull) + hull.size(), "\"measures_accuracy\": 1, ");
        }},
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
  expect_found(sound_hull(dented_ellipsoid()),
               {{"a dent's patch is filled", "regions", [](auto& h) { fill_regions(h); }},
                {"the same, without a loop, scroll and curves", "patch_outside",
                 [](auto& h) {
                   remove_face(h, int(first_of(h, FaceKind::scroll)));
                   h.curves.clear();
                   patch_of(h).loops.clear();
                   fill_regions(h);
                 }},
                {"a patch is split", "euler",
                 [](auto& h) {
                   HullDocument::Face half = patch_of(h);
                   half.loops.clear();
                   half.regions.resize(3);
                   patch_of(h).regions.erase(patch_of(h).regions.begin(),
                                             patch_of(h).regions.begin() + 3);
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

using Side = HullDocument::Side;

/// The first curved side of a facet.
Side& curved_side_of(HullDocument::Face& facet) {
  for (Side& side : facet.sides) {
    if (side.source >= 0) return side;
  }
  throw std::logic_error("no curved side");
}

Side& curved_side_of(HullDocument& hull) {
  for (HullDocument::Face& face : hull.faces) {
    const bool curved = std::any_of(face.sides.begin(), face.sides.end(),
                                    [](const Side& side) { return side.source >= 0; });
    if (curved) return curved_side_of(face);
  }
  throw std::logic_error("no facet with a curved side");
}

/// The facet that the curved side is of.
HullDocument::Face& round_facet_of(HullDocument& hull) {
  for (HullDocument::Face& face : hull.faces) {
    if (!face.sides.empty()) return face;
  }
  throw std::logic_error("no facet with a curved side");
}

HullDocument::Curve& closed_curve_of(HullDocument& hull) {
  for (HullDocument::Curve& curve : hull.curves) {
    if (curve.points.size() > 2) return curve;
  }
  throw std::logic_error("no curve");
}

/// What may go wrong with any facet that has a curved side.
std::vector<Damage> faults_of_curved_sides(double size) {
  return {{"a side's beginning is moved", "off_source",
           [](auto& h) { curved_side_of(h).from[0] += 1e-9; }},
          {"a side's end is moved", "off_source",
           [](auto& h) {
             Side& side = curved_side_of(h);
             for (std::size_t k = 0; k < side.to.size(); ++k) {
               side.to[k] += 1e-9 * (side.from[k] - side.to[k]);
             }
           }},
          {"a side is called straight", "off_outline", [](auto& h) { curved_side_of(h) = {}; }},
          {"all sides are called straight", "off_outline",
           [](auto& h) { round_facet_of(h).sides.clear(); }},
          {"a side is none", "off_source",
           [](auto& h) {
             Side& side = curved_side_of(h);
             side.to = side.from;
           }},
          {"a side runs backwards", "off_source",
           [](auto& h) {
             Side& side = curved_side_of(h);
             std::swap(side.from, side.to);
           }},
          {"contacts and sides are in the opposite order", "outlines",
           [](auto& h) {
             HullDocument::Face& facet = round_facet_of(h);
             std::reverse(facet.contacts.begin(), facet.contacts.end());
             std::reverse(facet.sides.begin(), facet.sides.end());
             std::rotate(facet.sides.begin(), facet.sides.begin() + 1, facet.sides.end());
             for (Side& side : facet.sides) std::swap(side.from, side.to);
           }},
          {"the boundary runs backwards", "outlines",
           [](auto& h) {
             auto& boundary = round_facet_of(h).boundary;
             std::reverse(boundary.begin(), boundary.end());
           }},
          {"a boundary's point is moved", "off_outline",
           [=](auto& h) {
             auto& boundary = round_facet_of(h).boundary;
             const dvec3 along = unit(boundary[2] - boundary[1]);
             boundary[1] += 1e-9 * size * along;
           }},
          {"the rim is passed backwards", "closed",
           [](auto& h) { round_facet_of(h).outline[0].second *= -1; }},
          {"a facet is left out", "complete",
           [](auto& h) { remove_face(h, int(&round_facet_of(h) - h.faces.data())); }},
          {"a facet's offset is wrong", "flatness",
           [=](auto& h) { round_facet_of(h).offset += 1e-9 * size; }},
          {"a facet is shifted", "hull_outside",
           [=](auto& h) {
             auto& facet = round_facet_of(h);
             facet.offset += 1e-9 * size;
             for (auto& p : facet.boundary) p += 1e-9 * size * facet.normal;
             for (auto& c : facet.contacts) c.p += 1e-9 * size * facet.normal;
           }},
          {"a facet's plane is turned", "flatness",
           [](auto& h) {
             dvec3& n = round_facet_of(h).normal;
             n = unit(n + 1e-9 * tangent_frame(n)[0]);
           }},
          {"a curve is lifted", "off_outline",
           [=](auto& h) {
             for (dvec3& p : closed_curve_of(h).points) {
               p += 1e-9 * size * tangent_frame(round_facet_of(h).normal)[0];
             }
           }},
          {"a curve is called a join", "kinds",
           [](auto& h) {
             HullDocument::Curve& curve = closed_curve_of(h);
             curve.kind = HullCurveKind::join;
             curve.source = -1;
           }},
          {"a curve is called a ruling", "kinds",
           [](auto& h) {
             HullDocument::Curve& curve = closed_curve_of(h);
             curve.kind = HullCurveKind::ruling;
             curve.source = -1;
           }},
          {"a facet's label is left out, or another one than none", "labels", [](auto& h) {
             HullDocument::Face& facet = round_facet_of(h);
             facet.source = facet.source >= 0 ? -1 : 0;
           }}};
}

void exchange_labels(HullDocument& hull, FaceKind kind) {
  std::vector<HullDocument::Face*> faces;
  for (HullDocument::Face& face : hull.faces) {
    if (face.kind == kind && face.source >= 0) faces.push_back(&face);
  }
  std::swap(faces.at(0)->source, faces.at(1)->source);
}

TEST(VerifyFaults, InASolidCylinderAreFound) {
  const Sound sound = sound_hull(solid_cylinder(1, 2));
  expect_found(sound, faults_of_curved_sides(sound.hull.diagonal));
  expect_found(
      sound,
      {{"a scroll's source is not told", "labels", [](auto& h) { scroll_of(h).source = -1; }},
       {"a scroll's source is a facet's", "labels",
        [](auto& h) { scroll_of(h).source = facet_of(h).source; }},
       {"a facet's source is the scroll's", "labels",
        [](auto& h) { facet_of(h).source = scroll_of(h).source; }},
       {"a scroll's source is an edge", "labels",
        [](auto& h) { scroll_of(h).source = h.curves[0].source; }},
       {"facets' sources are exchanged", "labels",
        [](auto& h) { exchange_labels(h, FaceKind::facet); }},
       {"two facets are exchanged", "closed", [](auto& h) { std::swap(h.faces[1], h.faces[2]); }},
       {"a curve's source is missing", "kinds", [](auto& h) { h.curves[0].source = -1; }},
       {"a curve is another edge", "off_outline",
        [](auto& h) { h.curves[0].source = h.curves[1].source; }},
       {"an edge is called a bitangent", "kinds",
        [](auto& h) { h.curves[0].kind = HullCurveKind::bitangent; }},
       {"a scroll's curve is missing", "closed", [](auto& h) { scroll_of(h).curves[1].clear(); }},
       {"a scroll's sides are exchanged", "off_outline",
        [](auto& h) { std::swap(scroll_of(h).curves[0], scroll_of(h).curves[1]); }}});
}

TEST(VerifyFaults, InATorusAreFound) {
  const Sound sound = sound_hull(torus(2, 0.5));
  expect_found(sound, faults_of_curved_sides(sound.hull.diagonal));
  const auto inner = [](HullDocument& h) {
    HullDocument::Face face;
    face.kind = FaceKind::patch;
    face.source = 0;
    const std::set<int> outer = [&] {
      std::set<int> patches;
      for (const auto& region : patch_of(h).regions) patches.insert(region.patch);
      return patches;
    }();
    for (int i = 0; i < int(h.sources[0].patches.size()); ++i) {
      if (outer.contains(i)) continue;
      const auto& domain = h.sources[0].patches[std::size_t(i)].domain;
      const Interval& u = domain[0];
      const Interval& v = domain[1];
      face.regions.push_back({i, patch_of(h).regions[0].sign, {}});
      face.regions.back().loops = {
          {{u.lower, v.lower}, {u.upper, v.lower}, {u.upper, v.upper}, {u.lower, v.upper}}};
    }
    return face;
  };
  expect_found(
      sound,
      {{"the inner side is another patch", "patch_outside",
        [&](auto& h) { h.faces.push_back(inner(h)); }},
       {"the inner side is part of the patch", "patch_outside",
        [&](auto& h) {
          for (const auto& region : inner(h).regions) patch_of(h).regions.push_back(region);
        }},
       {"the inner side stands for the outer one", "covered",
        [&](auto& h) { patch_of(h).regions = inner(h).regions; }},
       {"discs are exchanged", "closed", [](auto& h) { std::swap(h.faces[1], h.faces[2]); }},
       {"a seam is called an edge", "kinds",
        [](auto& h) { h.curves[0].kind = HullCurveKind::edge; }},
       {"curves are exchanged", "flatness",
        [](auto& h) { std::swap(h.curves[0].points, h.curves[1].points); }},
       {"a disc has the patch's source", "labels", [](auto& h) { facet_of(h).source = 0; }}});
}

TEST(VerifyFaults, InACapAreFound) {
  const Sound sound = sound_hull(spherical_cap(0.6));
  expect_found(sound, faults_of_curved_sides(sound.hull.diagonal));
}

TEST(VerifyFaults, InAParaboloidAreFound) {
  const Sound sound = sound_hull(paraboloid());
  expect_found(sound, faults_of_curved_sides(sound.hull.diagonal));
  expect_found(sound, {{"a straight side runs along an edge", "flatness", [](auto& h) {
                          HullDocument::Face& facet = h.faces.back();
                          facet.sides.resize(facet.contacts.size());
                          facet.sides[0] = curved_side_of(h);
                        }}});
}

TEST(VerifyFaults, InAFilletedBoxAreFound) {
  const Sound sound = sound_hull(filleted_box(1, 2, 3, 0.2));
  const double size = sound.hull.diagonal;
  expect_found(
      sound,
      {{"facets' sources are exchanged", "labels",
        [](auto& h) { exchange_labels(h, FaceKind::facet); }},
       {"scrolls' sources are exchanged", "labels",
        [](auto& h) { exchange_labels(h, FaceKind::scroll); }},
       {"patches' sources are exchanged", "off_outline",
        [](auto& h) { exchange_labels(h, FaceKind::patch); }},
       {"a facet's source is not told", "labels", [](auto& h) { facet_of(h).source = -1; }},
       {"a scroll's source is not told", "labels", [](auto& h) { scroll_of(h).source = -1; }},
       {"a scroll is left out", "complete",
        [](auto& h) { remove_face(h, int(first_of(h, FaceKind::scroll))); }},
       {"a facet is left out", "complete",
        [](auto& h) { remove_face(h, int(first_of(h, FaceKind::facet))); }},
       {"two scrolls are exchanged", "closed",
        [](auto& h) {
          const std::size_t first = first_of(h, FaceKind::scroll);
          std::swap(h.faces[first], h.faces[first + 1]);
        }},
       {"a border's point is moved along it", "off_outline",
        [&](auto& h) {
          auto& points = closed_curve_of(h).points;
          points[3] += 1e-5 * size * unit(points[4] - points[3]);
        }},
       {"a border's point is moved across", "off_outline",
        [&](auto& h) {
          const dvec3& n = scroll_of(h).rulings[3].n;
          closed_curve_of(h).points[3] += 1e-9 * size * n;
        }},
       {"a border is called a join", "kinds",
        [](auto& h) { closed_curve_of(h).kind = HullCurveKind::ruling; }},
       {"a ruling is moved along its border", "tangency",
        [](auto& h) {
          for (double& u : most_alone(scroll_of(h))->a.uv) {
            if (u > 0 && u < 1) u += 1e-6;
          }
        }},
       {"a facet's offset is wrong", "flatness",
        [&](auto& h) { facet_of(h).offset -= 1e-9 * size; }}});
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
  EXPECT_EQ(v.faults[0].text, "curves[1]: a join not between two patches");
  EXPECT_EQ(v.faults[1].text, "report: unresolved is 2, not 0");
}

}  // namespace
}  // namespace taut
