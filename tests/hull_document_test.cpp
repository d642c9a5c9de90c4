#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "boundaries.h"
#include "models.h"
#include "reference.h"
#include "taut/core/error.h"
#include "taut/core/tolerances.h"
#include "taut/hull/convex_hull.h"
#include "taut/io/document/boundary_document.h"
#include "taut/io/document/polyhedral_document.h"
#include "taut/io/document/read_hull.h"
#include "taut/io/document/write_hull.h"
#include "taut/io/report/report.h"
#include "temporary_folder.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and files

constexpr DocumentEncoding hull_encodings[] = {DocumentEncoding::json, DocumentEncoding::cbor};

HullDocument document(const KnownBoundary& known) {
  return hull_document(known.scene, known.boundary, {"a file"});
}

/// From the document alone, by de Casteljau in long double.
rvec3 rebuilt(const HullDocument& hull, const HullDocument::Contact& c) {
  const HullDocument::Source& source = hull.sources[std::size_t(c.source)];
  for (const HullDocument::Patch& patch : source.patches) {
    std::vector<real> local;
    for (std::size_t k = 0; k < patch.domain.size(); ++k) {
      const Interval& i = patch.domain[k];
      local.push_back((real(c.uv[k]) - i.lower) / (real(i.upper) - i.lower));
    }
    if (std::any_of(local.begin(), local.end(), [](real t) { return t < 0 || t > 1; })) continue;
    std::vector<dvec4> points;
    for (const dvec4& p : patch.points) points.push_back(homogeneous(dvec3(p), p.w));
    if (source.kind == SourceKind::vertex) return rvec3(dvec3(patch.points[0]));
    if (source.kind == SourceKind::edge) return reference_point(BezierCurve{points}, local[0]);
    const BezierPatch bezier{patch.rows - 1, patch.columns - 1, points};
    return reference_point(bezier, local[0], local[1]);
  }
  ADD_FAILURE() << "no patch has these parameters";
  return rvec3(0.0);
}

double error_of(const HullDocument& hull, const HullDocument::Contact& c) {
  return double(glm::length(rebuilt(hull, c) - rvec3(c.p))) / hull.diagonal;
}

/// The sides of a facet lead from contact to contact within its plane.
void expect_sides(const HullDocument& hull, const HullDocument::Face& facet) {
  ASSERT_EQ(facet.sides.size(), facet.contacts.size());
  for (std::size_t k = 0; k < facet.sides.size(); ++k) {
    const HullDocument::Side& side = facet.sides[k];
    if (side.source < 0) continue;
    const dvec3& begin = facet.contacts[k].p;
    const dvec3& end = facet.contacts[(k + 1) % facet.contacts.size()].p;
    EXPECT_LE(error_of(hull, {side.source, side.from, begin}), 1e-15);
    EXPECT_LE(error_of(hull, {side.source, side.to, end}), 1e-15);
    std::vector<double> between;
    for (std::size_t i = 0; i < side.from.size(); ++i) {
      between.push_back(0.3 * side.from[i] + 0.7 * side.to[i]);
    }
    const dvec3 x(rebuilt(hull, {side.source, between, dvec3(0.0)}));
    EXPECT_NEAR(glm::dot(x, facet.normal), facet.offset, 1e-15);
    EXPECT_LT(glm::dot(glm::cross(end - begin, x - begin), facet.normal), 0) << "to the right";
  }
}

/// Through both encodings: the same text, and the same bytes once written again (zeros of a report
/// may have become integers).
void expect_round_trip(const HullDocument& hull) {
  const std::string text = to_document(hull, DocumentEncoding::json);
  for (const DocumentEncoding encoding : hull_encodings) {
    const HullDocument back = read_hull(to_document(hull, encoding), "f", encoding);
    EXPECT_TRUE(to_document(back, DocumentEncoding::json) == text);
    const std::string again = to_document(back, encoding);
    EXPECT_TRUE(to_document(read_hull(again, "f", encoding), encoding) == again);
  }
}

TEST(HullDocument, Tetrahedron) {
  const HullDocument hull = document(tetrahedron_boundary());
  EXPECT_EQ(hull.dimension, 3);
  EXPECT_DOUBLE_EQ(hull.diagonal, std::sqrt(3.0));
  ASSERT_EQ(hull.sources.size(), 4U);
  ASSERT_EQ(hull.faces.size(), 4U);
  ASSERT_EQ(hull.curves.size(), 6U);
  for (const HullDocument::Source& source : hull.sources) {
    EXPECT_EQ(source.kind, SourceKind::vertex);
    EXPECT_EQ(source.file, "a file");
    ASSERT_EQ(source.patches.size(), 1U);
    EXPECT_TRUE(source.patches[0].domain.empty());
  }
  for (std::size_t f = 0; f < 4; ++f) {
    const HullDocument::Face& face = hull.faces[f];
    EXPECT_EQ(face.kind, FaceKind::facet);
    ASSERT_EQ(face.contacts.size(), 3U);
    ASSERT_EQ(face.outline.size(), 3U);
    ASSERT_EQ(face.boundary.size(), 3U);
    for (const HullDocument::Contact& c : face.contacts) {
      EXPECT_TRUE(c.uv.empty());
      EXPECT_EQ(error_of(hull, c), 0);
      EXPECT_NEAR(glm::dot(face.normal, c.p), face.offset, 1e-14);
    }
    dvec3 area(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      area += glm::cross(face.boundary[k], face.boundary[(k + 1) % 3]);
      const auto [curve, sense] = face.outline[k];
      EXPECT_EQ(hull.curves[std::size_t(curve)].faces[sense > 0 ? 0 : 1], int(f));
    }
    EXPECT_GT(glm::dot(area, face.normal), 0.9) << "counter-clockwise";
  }
  expect_round_trip(hull);
}

TEST(HullDocument, TwoSpheres) {
  const HullDocument hull = document(two_spheres_boundary());
  ASSERT_EQ(hull.sources.size(), 2U);
  EXPECT_EQ(hull.sources[0].kind, SourceKind::face);
  EXPECT_EQ(hull.sources[1].patches.size(), 8U);
  ASSERT_EQ(hull.faces.size(), 3U);
  const HullDocument::Face& scroll = hull.faces[2];
  EXPECT_EQ(scroll.curves[0], std::vector<int>{0});
  EXPECT_EQ(scroll.curves[1], std::vector<int>{1});
  // Where the patch changes, within the piece's sixteen steps and at the ends.
  ASSERT_EQ(scroll.rulings.size(), 4 * 17U);
  for (const HullDocument::Ruling& r : scroll.rulings) {
    EXPECT_NEAR(r.n.z, 1.0 / 6, 1e-15);
    EXPECT_LE(glm::distance(r.a.p, r.n), 1e-15);
    EXPECT_LE(glm::distance(r.b.p, 0.5 * r.n + dvec3(0, 0, 3)), 2e-15);
    EXPECT_LE(error_of(hull, r.a), 1e-15);
    EXPECT_LE(error_of(hull, r.b), 1e-15);
  }
  EXPECT_EQ(scroll.rulings[16].n, scroll.rulings[17].n);

  for (std::size_t k = 0; k < 2; ++k) {
    const HullDocument::Face& patch = hull.faces[k];
    EXPECT_EQ(patch.source, int(k));
    ASSERT_EQ(patch.loops.size(), 1U);
    EXPECT_EQ(patch.loops[0].curves,
              (std::vector<HullDocument::DirectedCurve>{{int(k), k == 0 ? -1 : 1}}));
    // Four quarters of a circle, one after the other; at the seam u begins again.
    const std::vector<dvec2>& uv = patch.loops[0].uv;
    ASSERT_EQ(uv.size(), 4 * 16U + 1);
    EXPECT_EQ(uv.front().x, k == 0 ? 4 : 0);
    for (std::size_t i = 1; i < uv.size(); ++i) {
      EXPECT_NEAR(uv[i].x - uv[i - 1].x, k == 0 ? -1.0 / 16 : 1.0 / 16, 0.01);
      EXPECT_NEAR(uv[i].y, uv[0].y, 1e-14);
    }
    // The regions' loops bound them to the left and make up the patch's area.
    EXPECT_EQ(patch.regions.size(), k == 0 ? 8U : 4U);
    double area = 0;
    for (const HullDocument::Region& region : patch.regions) {
      EXPECT_EQ(region.sign, -1);
      ASSERT_EQ(region.loops.size(), 1U);
      const std::vector<dvec2>& loop = region.loops[0];
      EXPECT_NE(loop.front(), loop.back());
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const dvec2 a = loop[i], b = loop[(i + 1) % loop.size()];
        area += 0.5 * (a.x * b.y - a.y * b.x);
      }
    }
    EXPECT_NEAR(area, 4 * (k == 0 ? 2 - uv[0].y : uv[0].y), 1e-12);
  }
  expect_round_trip(hull);
}

TEST(HullDocument, Cylinder) {
  const HullDocument hull = document(cylinder_boundary());
  ASSERT_EQ(hull.sources.size(), 3U);
  EXPECT_EQ(hull.sources[0].kind, SourceKind::face);
  for (const std::size_t k : {1, 2}) {
    EXPECT_EQ(hull.sources[k].kind, SourceKind::edge);
    ASSERT_EQ(hull.sources[k].patches.size(), 4U);
    EXPECT_EQ(hull.sources[k].patches[0].rows, 1);
    EXPECT_EQ(hull.sources[k].patches[0].columns, 3);
  }
  EXPECT_EQ(hull.faces[2].source, 0);
  EXPECT_EQ(hull.faces[2].curves[0], (std::vector<int>{0, 1}));
  for (const HullDocument::Ruling& r : hull.faces[2].rulings) {
    EXPECT_LE(error_of(hull, r.a), 1e-15);
    EXPECT_LE(error_of(hull, r.b), 1e-15);
    EXPECT_LE(glm::distance(r.b.p - r.a.p, dvec3(0, 0, 2)), 1e-15);
  }
  using Curves = std::vector<HullDocument::DirectedCurve>;
  EXPECT_EQ(hull.faces[0].outline, (Curves{{0, -1}, {1, -1}}));
  EXPECT_EQ(hull.faces[1].outline, (Curves{{2, 1}}));
  for (const std::size_t k : {0, 1}) {
    const HullDocument::Face& facet = hull.faces[k];
    EXPECT_EQ(facet.offset, k == 0 ? 0 : 2);
    ASSERT_EQ(facet.boundary.size(), 64U);
    dvec3 area(0.0);
    for (std::size_t i = 0; i < 64; ++i) {
      area += 0.5 * glm::cross(facet.boundary[i], facet.boundary[(i + 1) % 64]);
    }
    EXPECT_NEAR(glm::dot(area, facet.normal), 3.14, 0.01);
    EXPECT_EQ(facet.sides.size(), 4U);
    expect_sides(hull, facet);
  }
  expect_round_trip(hull);
}

TEST(HullDocument, CapClosedByItsDisc) {
  const HullDocument hull = document(cap_boundary(0.6));
  ASSERT_EQ(hull.faces.size(), 2U);
  ASSERT_EQ(hull.curves.size(), 1U);
  EXPECT_EQ(hull.curves[0].faces, (std::array<int, 2>{0, 1}));
  EXPECT_EQ(hull.sources[std::size_t(hull.curves[0].source)].kind, SourceKind::edge);
  using Curves = std::vector<HullDocument::DirectedCurve>;
  EXPECT_EQ(hull.faces[0].loops.at(0).curves, (Curves{{0, 1}}));
  const HullDocument::Face& disc = hull.faces[1];
  EXPECT_EQ(disc.outline, (Curves{{0, -1}}));
  EXPECT_EQ(disc.contacts.size(), 4U);
  EXPECT_EQ(disc.boundary.size(), 64U);
  EXPECT_NEAR(disc.offset, -0.4, 1e-15);
  expect_sides(hull, disc);
  expect_round_trip(hull);
}

TEST(HullDocument, SidesAlongSeams) {
  const HullDocument hull = document(torus_boundary(2, 0.5));
  ASSERT_EQ(hull.sources.size(), 1U);
  for (const std::size_t f : {1, 2}) {
    const HullDocument::Face& disc = hull.faces[f];
    EXPECT_EQ(disc.outline.size(), 1U);
    for (const HullDocument::Contact& c : disc.contacts) {
      EXPECT_EQ(c.uv.size(), 2U);
      EXPECT_LE(error_of(hull, c), 1e-15);
    }
    expect_sides(hull, disc);
  }
  for (const HullDocument::Curve& curve : hull.curves) {
    EXPECT_EQ(curve.kind, HullCurveKind::bitangent);
    EXPECT_EQ(curve.source, -1);
  }
  expect_round_trip(hull);
}

TEST(HullDocument, FacetsOfTwoContacts) {
  const HullDocument hull = document(paraboloid_boundary());
  ASSERT_EQ(hull.faces.size(), 6U);
  for (std::size_t f = 1; f < 5; ++f) {
    const HullDocument::Face& wall = hull.faces[f];
    EXPECT_EQ(wall.contacts.size(), 2U);
    EXPECT_EQ(wall.outline.size(), 2U);
    EXPECT_EQ(wall.boundary.size(), 17U);
    expect_sides(hull, wall);
    EXPECT_GE(wall.sides[0].source, 0);
    EXPECT_EQ(wall.sides[1].source, -1);
    const HullDocument back =
        read_hull(to_document(hull, DocumentEncoding::cbor), "f", DocumentEncoding::cbor);
    EXPECT_EQ(back.faces[f].sides[0].to, wall.sides[0].to);
    EXPECT_EQ(back.faces[f].sides[1].source, -1);
  }
  EXPECT_TRUE(hull.faces[5].sides.empty());
  expect_round_trip(hull);
}

TEST(HullDocument, PlacedInstancesFarFromTheOrigin) {
  const dvec3 shift(100, -200, 50);
  const KnownBoundary known = two_spheres_boundary(skew_rotation(), shift);
  const HullDocument hull = document(known);
  for (const HullDocument::Ruling& r : hull.faces[2].rulings) {
    // Of coordinates of some hundreds.
    EXPECT_LE(error_of(hull, r.a), 3e-14);
    EXPECT_LE(glm::distance(r.a.p, r.n + shift), 1e-13);
  }
  expect_round_trip(hull);

  Model model;
  model.add_part(Model(known.scene.model()).parts()[0], smooth_join_angle);
  model.clear_instances();
  const dmat3 turn = skew_rotation();
  model.add_instance(0, {turn, dvec3(1, 2, 3)});
  const HullDocument placed =
      hull_document(Scene(std::move(model)), known.boundary, {"first", "second"});
  for (std::size_t k = 0; k < hull.sources.size(); ++k) {
    EXPECT_EQ(placed.sources[k].file, "first");
    for (std::size_t i = 0; i < hull.sources[k].patches.size(); ++i) {
      const dvec4 p = hull.sources[k].patches[i].points[4];
      const dvec4 q = placed.sources[k].patches[i].points[4];
      EXPECT_EQ(p.w, q.w);
      EXPECT_LE(glm::distance(turn * dvec3(p) + dvec3(1, 2, 3), dvec3(q)), 1e-12);
    }
  }
}

Hull hull_of(const std::vector<dvec3>& points, Model& model) {
  model = make_model({{}, {}, points});
  return convex_hull(model);
}

TEST(HullDocument, OfPolyhedralHulls) {
  struct Case {
    std::vector<dvec3> points;
    int dimension;
    std::size_t faces, curves, sources;
  };
  const Case cases[] = {
      {{{1, 2, 3}, {1, 2, 3}}, 0, 0, 0, 1},
      {{{0, 0, 0}, {1, 2, 2}, {0.5, 1, 1}}, 1, 0, 1, 2},
      {{{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}, {1, 1, 1}}, 2, 1, 4, 4},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}}, 3, 5, 8, 5},
  };
  for (const Case& c : cases) {
    Model model;
    const Hull hull = hull_of(c.points, model);
    const HullDocument made = hull_document(model, hull.mesh);
    EXPECT_EQ(made.dimension, c.dimension);
    EXPECT_EQ(made.faces.size(), c.faces);
    EXPECT_EQ(made.curves.size(), c.curves);
    EXPECT_EQ(made.sources.size(), c.sources);
    for (std::size_t f = 0; f < made.faces.size(); ++f) {
      const HullDocument::Face& face = made.faces[f];
      ASSERT_EQ(face.outline.size(), face.boundary.size());
      for (std::size_t k = 0; k < face.outline.size(); ++k) {
        const HullDocument::Curve& curve = made.curves[std::size_t(face.outline[k].first)];
        const bool along = face.outline[k].second > 0;
        EXPECT_EQ(curve.faces[along ? 0 : 1], int(f));
        EXPECT_EQ(along ? curve.points.front() : curve.points.back(), face.boundary[k]);
        EXPECT_EQ(face.contacts[k].p, face.boundary[k]);
        EXPECT_EQ(error_of(made, face.contacts[k]), 0);
      }
    }
    expect_round_trip(made);
  }
}

/// Corners near to each other and one that is far from them, all far from the origin: they are in
/// the plane that the document tells, but for the rounding of their coordinates.
TEST(HullDocument, PlanesOfThinPolygonsFarOff) {
  Random random(5);
  const dvec3 n = random_direction(random);
  const auto [e, g] = tangent_frame(n);
  const dvec3 center = 4e5 * random_direction(random);
  std::vector<dvec3> points = {center};
  for (int k = 0; k < 8; ++k) {
    const dvec2 d(uniform(random, 0, 0.04), uniform(random, 0, 0.04));
    points.push_back(center + (10 + d.x) * e + d.y * g);
  }
  Model model;
  const HullDocument made = hull_document(model, hull_of(points, model).mesh);
  ASSERT_EQ(made.dimension, 2);
  const HullDocument::Face& face = made.faces.front();
  const double size = std::abs(center.x) + std::abs(center.y) + std::abs(center.z);
  for (const dvec3& p : face.boundary) {
    EXPECT_LE(std::abs(glm::dot(p - face.boundary[0], face.normal)), coordinate_rounding * size);
  }
}

/// Only where there is something to tell, in model units.
TEST(HullDocument, FacesKeepTheirTolerance) {
  KnownBoundary known = cylinder_boundary();
  const auto text_of = [&] { return to_document(document(known), DocumentEncoding::json); };
  EXPECT_EQ(text_of().find("tolerant"), std::string::npos);
  known.boundary.faces[0].tolerant = known.scene.frame().length_to_frame(3e-9);
  known.boundary.faces[2].tolerant = known.scene.frame().length_to_frame(1.0 / 3e7);
  EXPECT_NE(text_of().find("\"kind\": \"scroll\", \"source\": 0, \"tolerant\": "),
            std::string::npos);
  const HullDocument hull = document(known);
  EXPECT_NEAR(hull.faces[0].tolerant, 3e-9, 1e-23);
  EXPECT_EQ(hull.faces[1].tolerant, 0);
  for (const DocumentEncoding encoding : hull_encodings) {
    const HullDocument back = read_hull(to_document(hull, encoding), "f", encoding);
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_EQ(back.faces[f].tolerant, hull.faces[f].tolerant) << f;
    }
  }
  expect_round_trip(hull);

  HullDocument endless = hull;
  endless.faces[1].tolerant = std::numeric_limits<double>::infinity();
  const std::string bytes = to_document(endless, DocumentEncoding::cbor);
  const std::string message =
      message_of<InvalidInput>([&] { read_hull(bytes, "f", DocumentEncoding::cbor); });
  EXPECT_TRUE(message.starts_with("f: faces[1].tolerant: ")) << message;
}

TEST(HullDocument, KeepsTheReport) {
  HullDocument hull = document(tetrahedron_boundary());
  Report report;
  report.method = "precise";
  report.warnings = {{"a", "quote \" and \xc3\xbc"}};
  hull.report = to_json(report);
  const HullDocument back =
      read_hull(to_document(hull, DocumentEncoding::cbor), "f", DocumentEncoding::cbor);
  EXPECT_NE(back.report.find("\"method\": \"precise\""), std::string::npos) << back.report;
  expect_round_trip(hull);
}

class HullDocumentFile : public TemporaryFolder {};

TEST_F(HullDocumentFile, IsWrittenWholeOrNotAtAll) {
  const HullDocument hull = document(tetrahedron_boundary());
  for (const char* name : {"a.hull.json", "a.hull.cbor"}) {
    write_hull(path(name), hull);
    EXPECT_EQ(to_document(read_hull(path(name)), DocumentEncoding::json),
              to_document(hull, DocumentEncoding::json));
  }
  EXPECT_EQ(file_count(), 2U);
  EXPECT_NE(message_of<IoError>([&] { write_hull(path("a.json"), hull); }).find(".hull.json"),
            std::string::npos);
  message_of<IoError>([&] { write_hull(path("none/a.hull.json"), hull); });
  message_of<IoError>([&] { read_hull(path("none.hull.json")); });
  message_of<IoError>([&] { read_hull(file("b.ply", "ply")); });
  EXPECT_EQ(file_count(), 3U);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

/// The document of two spheres with a piece of its text replaced.
std::string damaged(const std::string& from, const std::string& to) {
  static const std::string whole =
      to_document(document(two_spheres_boundary()), DocumentEncoding::json);
  return replaced(whole, from, to);
}

TEST(HullDocument, WhatIsWrongIsSaidWithItsPlace) {
  struct Case {
    const char* from;
    const char* to;
    bool io;  ///< IoError, else InvalidInput
    const char* message;
  };
  const Case cases[] = {
      {"{\"format\"", "{\"format\",", true, "f:1: "},
      {"\"taut-hull\"", "\"taut-model\"", true, "f: format: this is no hull document"},
      {"\"version\": 1", "\"version\": 2", true, "f: version: version 2"},
      {"\"dimension\": 3", "\"dimension\": 4", false, "f: dimension: 4 is not in 0 .. 3"},
      {"\"dimension\": 3,", "", true, "f: the key \"dimension\" is missing"},
      {"\"diagonal\": ", "\"diagonal\": -", false, "f: diagonal: is negative"},
      {"\"id\": 1, \"kind\": \"face\"", "\"id\": 0, \"kind\": \"face\"", false,
       "f: sources[1].id: another source"},
      {"\"kind\": \"face\"", "\"kind\": \"facet\"", true, "f: sources[0].kind: \"facet\""},
      {"\"kind\": \"face\"", "\"kind\": \"edge\"", true, "f: sources[0].patches[0].domain: "},
      {"[[0, 1], [0, 1]]", "[[0, 0], [0, 1]]", false, "f: sources[0].patches[0].domain[0]: "},
      {"\"kind\": \"patch\", \"source\": 0", "\"kind\": \"patch\", \"source\": 2", false,
       "f: faces[0].source: no source has the id 2"},
      {"\"kind\": \"patch\", \"source\": 0", "\"kind\": \"patch\"", false,
       "f: faces[0]: a patch lies on a source"},
      {"{\"curves\": [[0, -1]]", "{\"curves\": [[0, 0]]", false,
       "f: faces[0].loops[0].curves[0][1]: is neither"},
      {"{\"curves\": [[0, -1]]", "{\"curves\": [[2, -1]]", false,
       "f: faces[0].loops[0].curves[0][0]: no curve has the id 2"},
      {"\"curves\": [0, 1]", "\"curves\": [0, [1, 7]]", false,
       "f: faces[2].curves[1][1]: no curve"},
      {"\"a\": {\"source\": 0, \"uv\": [", "\"a\": {\"source\": 0, \"uv\": [0, ", true,
       "f: faces[2].rulings[0].a.uv: 3 elements where 2"},
      {"\"patch\": 0, \"sign\": -1", "\"patch\": 8, \"sign\": -1", false,
       "f: faces[0].regions[0].patch: 8"},
      {"\"kind\": \"scroll\"", "\"kind\": \"scroll\", \"tolerant\": -1e-9", false,
       "f: faces[2].tolerant: is negative"},
      {"\"kind\": \"scroll\"", "\"kind\": \"scroll\", \"tolerant\": \"little\"", true,
       "f: faces[2].tolerant: "},
      {"\"faces\": [2, 0]", "\"faces\": [2, 3]", false, "f: curves[0].faces[1]: no face"},
      {"\"faces\": [2, 0]", "\"faces\": [2]", true, "f: curves[0].faces: 1 elements"},
  };
  for (const Case& c : cases) {
    const std::string text = damaged(c.from, c.to);
    const auto read = [&] { read_hull(text, "f", DocumentEncoding::json); };
    const std::string message = c.io ? message_of<IoError>(read) : message_of<InvalidInput>(read);
    EXPECT_TRUE(message.starts_with(c.message)) << c.to << ": " << message;
  }
  const std::string walls = to_document(document(paraboloid_boundary()), DocumentEncoding::json);
  const auto read_walls = [&](const char* from, const char* to) {
    read_hull(replaced(walls, from, to), "f", DocumentEncoding::json);
  };
  const std::string two = message_of<IoError>([&] { read_walls("\"to\": [", "\"to\": [0, "); });
  EXPECT_TRUE(two.starts_with("f: faces[1].sides[0].to: 2 elements where 1")) << two;
  const std::string key = message_of<IoError>([&] { read_walls("\"from\": [", "\"of\": ["); });
  EXPECT_TRUE(key.starts_with("f: faces[1].sides[0]")) << key;
  const std::string few =
      message_of<IoError>([&] { read_walls("\"sides\": [", "\"sides\": [null, "); });
  EXPECT_TRUE(few.starts_with("f: faces[1].sides: 3 elements where 2")) << few;
  // Missing faces are no error, and sides may have several curves.
  read_hull(damaged("\"faces\": [2, 0]", "\"faces\": [2, -1]"), "f", DocumentEncoding::json);
  const HullDocument several = read_hull(
      damaged("\"curves\": [0, 1]", "\"curves\": [null, [1, 0]]"), "f", DocumentEncoding::json);
  EXPECT_TRUE(several.faces[2].curves[0].empty());
  EXPECT_EQ(several.faces[2].curves[1], (std::vector<int>{1, 0}));
  expect_round_trip(several);
}

}  // namespace
}  // namespace taut
