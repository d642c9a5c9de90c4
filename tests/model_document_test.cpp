#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "models.h"
#include "taut/core/error.h"
#include "taut/core/tolerances.h"
#include "taut/io/document/read_document.h"
#include "taut/io/document/write_document.h"
#include "taut/io/model/read_model.h"
#include "temporary_folder.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and files

constexpr DocumentEncoding encodings[] = {DocumentEncoding::json, DocumentEncoding::cbor};

Model read(std::string_view text, DocumentEncoding encoding = DocumentEncoding::json) {
  Model model;
  read_document("f", text, encoding, model);
  return model;
}

void expect_same(const NurbsCurve& a, const NurbsCurve& b) {
  EXPECT_EQ(a.degree, b.degree);
  EXPECT_EQ(a.knots, b.knots);
  EXPECT_EQ(a.points, b.points);
}

void expect_same(const Part& a, const Part& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.faces().size(), b.faces().size());
  for (std::size_t i = 0; i < a.faces().size(); ++i) {
    const Face& f = a.faces()[i];
    const Face& g = b.faces()[i];
    EXPECT_EQ(f.name, g.name);
    EXPECT_EQ(f.first_patch, g.first_patch);
    EXPECT_EQ(f.patch_count, g.patch_count);
    ASSERT_EQ(f.loops.size(), g.loops.size());
    for (std::size_t k = 0; k < f.loops.size(); ++k) {
      ASSERT_EQ(f.loops[k].curves.size(), g.loops[k].curves.size());
      for (std::size_t j = 0; j < f.loops[k].curves.size(); ++j) {
        expect_same(f.loops[k].curves[j], g.loops[k].curves[j]);
      }
    }
  }
  ASSERT_EQ(a.patches().size(), b.patches().size());
  for (std::size_t i = 0; i < a.patches().size(); ++i) {
    const Patch& p = a.patches()[i];
    const Patch& q = b.patches()[i];
    EXPECT_EQ(p.bezier.degree_u, q.bezier.degree_u);
    EXPECT_EQ(p.bezier.points, q.bezier.points) << "patch " << i;
    EXPECT_TRUE(p.u.lower == q.u.lower && p.u.upper == q.u.upper);
    EXPECT_TRUE(p.v.lower == q.v.lower && p.v.upper == q.v.upper);
    EXPECT_EQ(p.face, q.face);
    EXPECT_EQ(p.corner_vertex, q.corner_vertex);
    for (std::size_t s = 0; s < 4; ++s) {
      EXPECT_EQ(p.borders[s].kind, q.borders[s].kind);
      EXPECT_EQ(p.borders[s].neighbor, q.borders[s].neighbor);
    }
  }
  ASSERT_EQ(a.edges().size(), b.edges().size());
  for (std::size_t i = 0; i < a.edges().size(); ++i) {
    EXPECT_EQ(a.edges()[i].name, b.edges()[i].name);
    EXPECT_EQ(a.edges()[i].faces, b.edges()[i].faces);
  }
  ASSERT_EQ(a.pieces().size(), b.pieces().size());
  for (std::size_t i = 0; i < a.pieces().size(); ++i) {
    EXPECT_EQ(a.pieces()[i].bezier.points, b.pieces()[i].bezier.points) << "piece " << i;
    EXPECT_TRUE(a.pieces()[i].t.lower == b.pieces()[i].t.lower);
  }
  EXPECT_EQ(a.polygons(), b.polygons());
  EXPECT_EQ(a.vertices(), b.vertices());
  EXPECT_EQ(a.point_count(), b.point_count());
}

void expect_same(const Model& a, const Model& b) {
  ASSERT_EQ(a.parts().size(), b.parts().size());
  for (std::size_t i = 0; i < a.parts().size(); ++i) expect_same(a.parts()[i], b.parts()[i]);
  ASSERT_EQ(a.instances().size(), b.instances().size());
  for (std::size_t i = 0; i < a.instances().size(); ++i) {
    EXPECT_EQ(a.instances()[i].part, b.instances()[i].part);
    EXPECT_EQ(a.instances()[i].pose.rotation, b.instances()[i].pose.rotation);
    EXPECT_EQ(a.instances()[i].pose.translation, b.instances()[i].pose.translation);
  }
}

/// Through both encodings, one after the other: the same model, and the same bytes once written.
void expect_round_trip(const Model& model) {
  for (const DocumentEncoding encoding : encodings) {
    const std::string text = to_document(model, encoding);
    const Model back = read(text, encoding);
    expect_same(model, back);
    EXPECT_EQ(to_document(back, encoding), text);
  }
}

NurbsSurface random_spline(Random& random, double weight_range) {
  NurbsSurface surface{pick(random, 1, 4), pick(random, 1, 4), {}, {}, {}};
  const auto knots = [&](int degree) {
    std::vector<double> result;
    double knot = uniform(random, -1, 1);
    for (int n = pick(random, 2, 5); n > 0; --n) {
      const int multiplicity = pick(random, 1, degree + 1);
      result.insert(result.end(), std::size_t(result.size() <= 1 ? degree + 1 : multiplicity),
                    knot);
      knot += log_uniform(random, 1e-3, 10);
    }
    result.insert(result.end(), std::size_t(degree) + 1, knot);
    return result;
  };
  surface.knots_u = knots(surface.degree_u);
  surface.knots_v = knots(surface.degree_v);
  for (int k = surface.count_u() * surface.count_v(); k > 0; --k) {
    const double w = weight_range > 1 ? log_uniform(random, 1 / weight_range, weight_range) : 1;
    surface.points.push_back(homogeneous(random_point(random), w));
  }
  return surface;
}

/// One of everything.
Model rich_model() {
  Random random(3);
  Part surfaces;
  surfaces.name = "name \"with\" \\ and \xc3\xa4";
  const NurbsCurve turn = circle({0.5, 0.5, 0}, {0.25, 0, 0}, {0, 0.25, 0});
  surfaces.add_surface(random_spline(random, 9), "trimmed", {TrimLoop{{turn}}, TrimLoop{{turn}}});
  surfaces.add_surface(sphere().surfaces[0], "");
  surfaces.add_curve(circle({1, 2, 3}, {1.0 / 3, 0, 0}, {0, 0, 1}), "free");
  surfaces.add_curve(segment({0, 0, 0}, {1, 1e-300, 1e300}), "far");
  surfaces.add_point({0.1, -0.0, 0.3});
  surfaces.add_point({5e-324, 1.7976931348623157e308 / 4, 1});
  Part polygons;
  polygons.name = "polygons";
  polygons.add_points(std::vector<dvec3>{{9, 9, 9}});
  polygons.add_polygons(
      {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}}, {{0, 1, 2, 3}, {2, 1, 0}}});
  polygons.add_polygons({{{0, 0, 5}, {1, 0, 5}, {1, 1, 5}}, {{0, 1, 2}}});
  Model model;
  model.add_part(std::move(surfaces), smooth_join_angle);
  model.add_part(std::move(polygons), smooth_join_angle);
  model.add_part(Part(), smooth_join_angle);
  model.add_instance(1, {skew_rotation(), {0.1, 1e-17, -3}});
  model.add_instance(0, {});
  return model;
}

TEST(ModelDocument, RoundTripsKeepEveryBit) {
  expect_round_trip(Model());
  expect_round_trip(rich_model());
  for (const Shape& shape :
       {sphere(), torus(2, 0.5), mapped(oloid(), skew_rotation()), filleted_box(1, 2, 3, 0.2),
        teapot(), mapped(sphere() + cone(1, 2), skew_rotation(), {1e3, 0.1, 7})}) {
    expect_round_trip(make_model(shape));
  }
}

TEST(ModelDocument, RoundTripsOfRandomSplines) {
  Random random(7);
  for (int k = 0; k < 60; ++k) {
    Part part;
    part.add_surface(random_spline(random, k % 2 == 0 ? 1 : 100), "random");
    part.add_curve({3, {0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 3}, random_curve(random, 6, 50).points}, "c");
    Model model;
    model.add_part(std::move(part), smooth_join_angle);
    expect_round_trip(model);
  }
}

TEST(ModelDocument, PiecesOfTheSameControlPointsShareThem) {
  const std::string text = to_document(make_model(sphere()), DocumentEncoding::json);
  EXPECT_NE(
      text.find("\"knots\": [[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], [0, 0, 0, 1, 1, 2, 2, 2]]"),
      std::string::npos)
      << text;
}

constexpr const char* example = R"({"format": "taut-model", "version": 1, "unit": "mm",
 "parts": [{"name": "one",
   "surfaces": [{"id": 7, "name": "square", "degree": [1, 2],
     "knots": [[0, 0, 2, 2], [0, 0, 0, 1, 1, 1]],
     "points": [[[0, 0, 0], [0, 1, 0.5, 3], [0, 2, 0]], [[4, 0, 0], [4, 1, 0], [4, 2, 0, 1]]],
     "loops": [[{"degree": 1, "knots": [0, 0, 1, 2, 3, 3],
                 "points": [[0, 0], [1, 0, 2], [1, 1], [0, 0]]}]]}],
   "edges": [{"degree": 1, "knots": [0, 0, 1, 1], "points": [[0, 0, 0], [4, 0, 0]], "faces": [7]},
             {"degree": 1, "knots": [0, 0, 1, 1], "points": [[0, 0, 9], [4, 0, 9, 2]]},
             {"degree": 1, "knots": [0, 0, 1, 1], "points": [[0, 0, 8], [4, 0, 8]], "faces": []}],
   "vertices": [[1, 2, 3]],
   "cages": [{"scheme": "bilinear", "points": [[0, 0, 1], [1, 0, 1], [0, 1, 1]],
              "faces": [[0, 1, 2]], "creases": [[0, 1, 2.5]], "corners": [],
              "boundary": "edge_and_corner"},
             {"scheme": "bilinear", "points": [[0, 0, 1], [1, 0, 1], [0, 1, 1]],
              "faces": [[2, 1, 0]]}]}, {}],
 "instances": [{"part": 0, "rotation": [0, -1, 0, 1, 0, 0, 0, 0, 1], "translation": [5, 6, 7]},
               {"part": 0}]})";

TEST(ModelDocument, ReadsWhatTheFormatSays) {
  const Model model = read(example);
  ASSERT_EQ(model.parts().size(), 2U);
  const Part& part = model.parts()[0];
  EXPECT_EQ(part.name, "one");
  EXPECT_EQ(model.parts()[1].name, "part 1");
  ASSERT_EQ(part.faces().size(), 1U);
  EXPECT_EQ(part.faces()[0].name, "square");
  ASSERT_EQ(part.patches().size(), 1U);
  EXPECT_EQ(part.patches()[0].u.upper, 2);
  EXPECT_EQ(part.patches()[0].bezier.at(0, 1), dvec4(0, 3, 1.5, 3));
  EXPECT_EQ(part.patches()[0].bezier.at(1, 0), dvec4(4, 0, 0, 1));
  const NurbsCurve& loop = part.faces()[0].loops.at(0).curves.at(0);
  EXPECT_EQ(loop.points[1], dvec4(2, 0, 0, 2));
  std::vector<const Edge*> free;
  for (const Edge& edge : part.edges()) {
    if (edge.faces.empty()) free.push_back(&edge);
  }
  ASSERT_EQ(free.size(), 2U);
  EXPECT_EQ(free[0]->name, "curve 1");
  EXPECT_EQ(part.pieces()[0].bezier.points[1], dvec4(8, 0, 18, 2));
  ASSERT_EQ(part.point_count(), 7);
  EXPECT_EQ(part.vertices()[0], dvec3(1, 2, 3));
  EXPECT_EQ(part.polygons(), (std::vector<std::vector<int>>{{1, 2, 3}, {6, 5, 4}}));
  ASSERT_EQ(model.instances().size(), 2U);
  EXPECT_EQ(model.instances()[0].pose(dvec3(1, 0, 0)), dvec3(5, 7, 7));
  EXPECT_EQ(model.instances()[1].pose.rotation, dmat3(1.0));
  expect_round_trip(model);
}

/// Control cages are written as they were read, with their tags.
TEST(ModelDocument, KeepsControlCages) {
  const std::string text = R"({"format": "taut-model", "version": 1, "parts": [{"cages": [
    {"scheme": "catmark", "points": [[0, 0, 1], [1, 0, 1], [1, 1, 0], [0, 1, 1], [2, 0, 1], [2, 1, 2]],
     "faces": [[0, 1, 2, 3], [1, 4, 5, 2]], "creases": [[1, 2, 2.5]], "corners": [[0, 10]],
     "holes": [1], "boundary": "edge_only", "crease_method": "chaikin",
     "triangle_rule": "smooth"},
    {"scheme": "loop", "points": [[0, 0, 1], [1, 0, 1], [0, 1, 1]], "faces": [[0, 1, 2]]}]}]})";
  const Model model = read(text);
  ASSERT_EQ(model.parts()[0].cages().size(), 2U);
  for (const DocumentEncoding encoding : encodings) {
    const Model again = read(to_document(model, encoding), encoding);
    expect_same(model.parts()[0], again.parts()[0]);
    ASSERT_EQ(again.parts()[0].cages().size(), 2U);
    const ControlCage& cage = *again.parts()[0].cages()[0].cage;
    EXPECT_EQ(cage.scheme, CageScheme::catmark);
    EXPECT_EQ(cage.boundary, CageBoundary::edge_only);
    EXPECT_TRUE(cage.chaikin && cage.smooth_triangles);
    EXPECT_EQ(cage.points.size(), 6U);
    EXPECT_EQ(cage.faces, (std::vector<std::vector<int>>{{0, 1, 2, 3}, {1, 4, 5, 2}}));
    ASSERT_EQ(cage.creases.size(), 1U);
    EXPECT_EQ(cage.creases[0].sharpness, 2.5);
    ASSERT_EQ(cage.corners.size(), 1U);
    EXPECT_EQ(cage.corners[0].vertex, 0);
    EXPECT_EQ(cage.holes, std::vector<int>{1});
    EXPECT_EQ(again.parts()[0].cages()[1].cage->scheme, CageScheme::loop);
  }
}

TEST(ModelDocument, AddsToWhatIsThere) {
  Model model = rich_model();
  const std::size_t parts = model.parts().size();
  const std::size_t instances = model.instances().size();
  read_document("f", example, DocumentEncoding::json, model);
  ASSERT_EQ(model.instances().size(), instances + 2);
  EXPECT_EQ(model.instances()[instances].part, int(parts));
  EXPECT_EQ(model.instances()[3].pose.rotation, skew_rotation());

  const std::string none = R"({"format": "taut-model", "version": 1, "parts": [{}, {}]})";
  read_document("f", none, DocumentEncoding::json, model);
  EXPECT_EQ(model.instances().size(), instances + 4);

  const std::string bad = R"({"format": "taut-model", "version": 1,
    "parts": [{"vertices": [[1, 2, 3]]}], "instances": [{"part": 1}]})";
  const std::string before = to_document(model, DocumentEncoding::json);
  EXPECT_THROW(read_document("f", bad, DocumentEncoding::json, model), InvalidInput);
  EXPECT_EQ(to_document(model, DocumentEncoding::json), before);
}

TEST(ModelDocument, WarnsOfUnknownKeysAndUnits) {
  std::vector<std::string> warnings;
  ReadOptions options;
  options.progress.warn = [&](std::string_view code, std::string_view text) {
    warnings.push_back(std::string(code) + " " + std::string(text));
  };
  Model model;
  const std::string text = R"({"format": "taut-model", "version": 1, "unit": "inch", "by": [[{}]],
    "parts": [{"colour": 1}, {"colour": 2, "vertices": [[1, 2, 3]]}]})";
  read_document("f", text, DocumentEncoding::json, model, options);
  EXPECT_EQ(warnings,
            (std::vector<std::string>{
                "unknown-key f: the key \"by\" of a document is unknown and passed over",
                "unknown-key f: the key \"colour\" of a part is unknown and passed over"}));
  warnings.clear();
  std::string many = R"({"format": "taut-model", "version": 1, "parts": []})";
  for (int k = 0; k < 1000; ++k) many.insert(1, "\"k" + std::to_string(k) + "\": 0, ");
  read_document("f", many, DocumentEncoding::json, model, options);
  EXPECT_LT(warnings.size(), 30U);
}

/// The example with the first `from` replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = example;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ModelDocument, SaysWhereItIsMalformed) {
  const auto expect = [](const std::string& text, const std::string& words) {
    const std::string message = message_of<IoError>([&] { read(text); });
    EXPECT_NE(message.find(words), std::string::npos) << message << "\nnot: " << words;
  };
  expect("", "f:1: ");
  expect("{\n\"format\": tru}", "f:2: ");
  expect(std::string(example) + "\n]", "f:19: ");
  expect("[]", "f: an object expected");
  expect("{}", "f: the key \"format\" is missing");
  expect(with("taut-model", "taut-hull"), "f: format: this is no model document");
  expect(with("\"version\": 1", "\"version\": 2"), "f: version: version 2 is not known");
  expect(with("\"version\": 1", "\"version\": \"1\""), "f: version: an integer expected");
  expect(with("\"unit\": \"mm\"", "\"unit\": 1"), "f: unit: a text expected");
  expect(with("\"parts\"", "\"party\""), "f: the key \"parts\" is missing");
  expect(with("[0, 0, 2, 2]", "[0, 0, 2, true]"),
         "f: parts[0].surfaces[0].knots[0][3]: a number expected");
  expect(with("[[0, 0, 2, 2], ", "["), "f: parts[0].surfaces[0].knots: 1 elements where 2");
  expect(with("[1, 2]", "[1.5, 2]"), "f: parts[0].surfaces[0].degree[0]: an integer expected");
  expect(with("[4, 0, 0]", "[4, 0]"), "f: parts[0].surfaces[0].points[1][0]: 2 numbers where 3");
  expect(with("\"bilinear\"", "\"cubic\""), "no scheme is called so");
  expect(with("\"name\": \"one\"", "\"name\": \"one\", \"name\": 1"), "\"name\" stands twice");
  expect(with("0, 0, 0, 0, 1]", "0, 0, 0, 0]"), "f: instances[0].rotation: 8 elements where 9");
}

TEST(ModelDocument, SaysWhichNumberIsNoGeometry) {
  const auto expect = [](const std::string& text, const std::string& words) {
    const std::string message = message_of<InvalidInput>([&] { read(text); });
    EXPECT_NE(message.find(words), std::string::npos) << message << "\nnot: " << words;
  };
  expect(with("[1, 2]", "[0, 2]"), "f: parts[0].surfaces[0].degree[0]: 0 is not in 1 .. 31");
  expect(with("[1, 2]", "[1, 32]"), "f: parts[0].surfaces[0].degree[1]: 32 is not in 1 .. 31");
  expect(with("[1, 2]", "[1, 1e300]"), "is not in 1 .. 31");
  expect(with("[0, 0, 2, 2]", "[0, 0, 2, 1]"), "f: parts[0].surfaces[0].knots[0][3]: 1 is below");
  expect(with("[0, 0, 2, 2]", "[0, 0, 0, 0]"), "f: parts[0].surfaces[0]: u: the domain is empty");
  expect(with("[0, 0, 2, 2]", "[0, 0, 1, 2, 2]"), "f: parts[0].surfaces[0]: 6 control points");
  expect(with("[0, 0, 2, 2]", "[0, 0]"), "2 knots where degree 1 needs at least 4");
  expect(with("0.5, 3]", "0.5, 0]"), "points[0][1][3]: the weight is not positive");
  expect(with("0.5, 3]", "0.5, -3]"), "points[0][1][3]: the weight is not positive");
  expect(with("0.5, 3]", "0.5, 1e308], [1e308, 2, 3, 9]"), "3 points where the first row has 4");
  expect(with("[4, 0, 0], ", "[1e308, 0, 0, 9], "), "control point 3 is not finite");
  expect(with("[4, 0, 0], ", "[1e999, 0, 0], "), "f:5: ");
  expect(with("[1, 0, 2]", "[1, 0, 0]"), "loops[0][0].points[1][2]: the weight is not positive");
  expect(with("\"faces\": [7]", "\"faces\": [6]"), "edges[0].faces[0]: no surface has the id 6");
  expect(with("[[0, 1, 2]]", "[[0, 1, 3]]"), "cages[0].faces[0][2]: 3 is not in 0 .. 2");
  expect(with("[[0, 1, 2]]", "[[0, -1, 2]]"), "cages[0].faces[0][1]: -1 is not in 0 .. 2");
  expect(with("[[0, 1, 2]]", "[[0, 1]]"), "cages[0].faces[0]: the polygon has fewer");
  expect(with("[[1, 2, 3]]", "[[1, 2, 3], [-1.7e308, 1.7e308, 0]]"), "extent overflows");
  expect(with("{\"part\": 0}", "{\"part\": 2}"), "f: instances[1].part: 2 is not in 0 .. 1");
  expect(with("{\"part\": 0}", "{\"part\": 1e300}"), "f: instances[1].part: is not in 0 .. 1");
  expect(with("[0, -1, 0, 1, 0,", "[0, 1, 0, 1, 0,"), "f: instances[0]: instance 0: the rotation");
  expect(with("\"loops\": [[", "\"ulps\": [[6, 0, 0, 0]], \"loops\": [["), "6 is not in 0 .. 5");
  expect(with("\"loops\": [[", "\"ulps\": [[0, 9, 0, 0]], \"loops\": [["), "9 is not in -2 .. 2");
  expect(with("\"loops\": [[", "\"loops\": [[], ["), "loops[0]: the loop has no curves");
}

TEST(ModelDocument, NumbersThatJsonCannotHold) {
  std::string text = to_document(rich_model(), DocumentEncoding::cbor);
  const std::string number("\xfb\x3f\xb9\x99\x99\x99\x99\x99\x9a", 9);  // 0.1
  const std::size_t at = text.find(number);
  ASSERT_NE(at, std::string::npos);
  for (const std::string nan : {"\xfb\x7f\xf8", "\xfb\x7f\xf0", "\xfb\xff\xf0"}) {
    std::string bad = text;
    bad.replace(at, 9, nan + std::string(6, '\0'));
    const std::string message =
        message_of<InvalidInput>([&] { read(bad, DocumentEncoding::cbor); });
    EXPECT_NE(message.find("is not finite"), std::string::npos) << message;
  }
  // Numbers of half the size, indefinite texts and lists, tags and other forms of the same.
  const std::string other =
      "\xd9\xd9\xf7\xbf\x7f\x63"
      "for"
      "\x63"
      "mat\xff\x6ataut-model\x67version\xfb\x3f\xf0" +
      std::string(6, '\0') + "\x65parts\x9f\xa1\x68vertices\x81\x83\xf9\x3c" +
      std::string(1, '\0') + "\xf9\xc0" + std::string(1, '\0') + "\x19\x01" + std::string(1, '\0') +
      "\xff\xff";
  const Model model = read(other, DocumentEncoding::cbor);
  EXPECT_EQ(model.parts().at(0).vertices().at(0), dvec3(1, -2, 256));
}

TEST(ModelDocument, NestingAndAnnouncedSizesTakeNoMemory) {
  const std::size_t n = 3'000'000;
  const auto expect_json = [](const std::string& text) { EXPECT_THROW(read(text), IoError); };
  const auto expect_cbor = [](const std::string& text) {
    const std::string message = message_of<IoError>([&] { read(text, DocumentEncoding::cbor); });
    EXPECT_TRUE(message.starts_with("f:byte ")) << message;
  };
  std::string objects;
  for (int k = 0; k < 100'000; ++k) objects += "{\"a\":";
  expect_json(std::string(n, '['));
  expect_json(objects);
  expect_json("{\"format\": " + std::string(n, '['));
  for (const char head : {'\x9f', '\x81', '\x7f', '\x5f', '\xbf', '\xc0', '\xd8', '\xdb'}) {
    expect_cbor(std::string(n, head));
  }
  for (const std::string head : {"\x9b", "\xbb", "\x7b", "\x5b"}) {
    expect_cbor(head + std::string("\x10\0\0\0\0\0\0\0", 8) + std::string(100, '\0'));
    expect_cbor(head + std::string(8, '\xff') + std::string(100, '\0'));
  }
  expect_cbor("");
  expect_cbor("\xff");
  expect_cbor("\xa1\x01\x01");
  expect_cbor(std::string("\xf6\0", 2));
}

TEST(ModelDocument, RefusesTooManyPiecePoints) {
  const int spans = 260;
  std::string knots = "[";
  for (int k = 0; k < spans + 63; ++k) knots += (k > 0 ? "," : "") + std::to_string(k);
  knots += "]";
  std::string row = "[";
  for (int k = 0; k < spans + 31; ++k) row += k > 0 ? ",[0,0,0]" : "[0,0,0]";
  row += "]";
  std::string rows = row;
  for (int k = 1; k < spans + 31; ++k) rows += "," + row;
  const std::string text = R"({"format": "taut-model", "version": 1, "parts": [{"surfaces": [
    {"degree": [31, 31], "knots": [)" +
                           knots + "," + knots + "], \"points\": [" + rows + "]}]}]}";
  EXPECT_THROW(read(text), LimitExceeded);
}

TEST(ModelDocument, DamagedFilesAreErrorsOrModels) {
  Random random(11);
  for (const DocumentEncoding encoding : encodings) {
    const std::string text = to_document(rich_model(), encoding);
    const std::size_t end = text.find_last_not_of('\n');
    for (std::size_t size = 0; size <= end; ++size) {
      EXPECT_THROW(read(std::string_view(text).substr(0, size), encoding), IoError) << size;
    }
    int models = 0;
    for (int k = 0; k < 5000; ++k) {
      std::string damaged = text;
      for (int hits = pick(random, 1, 3); hits > 0; --hits) {
        damaged[std::size_t(pick(random, 0, int(text.size()) - 1))] = char(pick(random, 0, 255));
      }
      try {
        read(damaged, encoding);
        ++models;
      } catch (const InvalidInput&) {
      } catch (const IoError&) {
      }
    }
    EXPECT_GT(models, 0);
  }
}

TEST(ModelDocument, NamesThatAreNoUtf8AreMended) {
  Part part;
  part.name = "caf\xe9";
  part.add_point({1, 2, 3});
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  for (const DocumentEncoding encoding : encodings) {
    EXPECT_EQ(read(to_document(model, encoding), encoding).parts()[0].name, "caf\xef\xbf\xbd");
  }
}

TEST(ModelDocument, CancelsAndRefusesOverflow) {
  std::stop_source stop;
  stop.request_stop();
  ReadOptions options;
  options.progress.stop = stop.get_token();
  Model model;
  EXPECT_THROW(read_document("f", example, DocumentEncoding::json, model, options), Cancelled);

  Part part;
  const NurbsCurve loop{1, {0, 0, 1, 1}, {{1e300, 0, 0, 1e-300}, {1, 0, 0, 1e-300}}};
  part.add_surface(box(1, 1, 1).surfaces[0], "face", {TrimLoop{{loop}}});
  model.add_part(std::move(part), smooth_join_angle);
  EXPECT_THROW(to_document(model, DocumentEncoding::json), InvalidInput);
}

class ModelDocumentFile : public TemporaryFolder {};

TEST_F(ModelDocumentFile, WritesWholeFilesByTheirExtension) {
  const Model model = rich_model();
  for (const char* name : {"a.taut.json", "b.TAUT.CBOR", "c.x.taut.cbor"}) {
    write_model(path(name), model);
    Model back;
    read_model(path(name), back);
    expect_same(model, back);
  }
  EXPECT_EQ(content(path("a.taut.json")), to_document(model, DocumentEncoding::json));
  EXPECT_EQ(content(path("b.TAUT.CBOR")), to_document(model, DocumentEncoding::cbor));
  EXPECT_EQ(file_count(), 3U);
  for (const char* name : {"a.json", "a.cbor", "taut.json", "a.taut", "a.hull.json", "a"}) {
    EXPECT_THROW(write_model(path(name), model), IoError) << name;
  }
  EXPECT_THROW(write_model(path("none/a.taut.json"), model), IoError);
  EXPECT_EQ(file_count(), 3U);
  const std::string message = message_of<IoError>([&] {
    Model bad;
    read_model(file("bad.taut.json", "{\"format\":\n 1,}"), bad);
  });
  EXPECT_NE(message.find("bad.taut.json:2: "), std::string::npos) << message;
}

}  // namespace
}  // namespace taut
