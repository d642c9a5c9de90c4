// Readers of models: .bpt, .obj, and the polygons of other formats as models.

#include "taut/io/model/read_model.h"

#include <algorithm>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <locale>
#include <random>
#include <stop_token>
#include <tuple>
#include <vector>

#include "taut/io/mesh/read_mesh.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/text_scanner.h"
#include "temporary_folder.h"

namespace {

using taut::InvalidInput;
using taut::IoError;
using taut::Model;
using taut::Part;
using taut::Patch;
using taut_test::message_of;

class ReadModel : public taut_test::TemporaryFolder {
 protected:
  Model read(const std::string& name, std::string_view text) const {
    Model model;
    taut::read_model(file(name, text), model, options_);
    return model;
  }
  /// The only part of a file's model.
  Part part(const std::string& name, std::string_view text) const {
    const Model model = read(name, text);
    EXPECT_EQ(model.parts().size(), 1U);
    return model.parts().front();
  }
  /// The message after "FILE".
  template <class Error>
  std::string message(const std::string& name, std::string_view text) const {
    return message_behind<Error>(name, [&] { read(name, text); });
  }
  /// Collects the codes of the warnings of later reads.
  void collect_warnings() {
    options_.progress.warn = [this](std::string_view code, std::string_view text) {
      warnings_.emplace_back(code);
      warning_texts_.emplace_back(text);
    };
  }

  taut::ReadOptions options_;
  std::vector<std::string> warnings_, warning_texts_;
};

/// A malformed file and what is said about it, after the file's name.
struct Malformed {
  std::string text;
  std::string message;
};

std::vector<taut::dvec3> euclidean_points(const Patch& patch) {
  std::vector<taut::dvec3> points;
  for (const taut::dvec4& p : patch.bezier.points) points.push_back(taut::euclidean(p));
  return points;
}

// ---------------------------------------------------------------- .bpt

TEST_F(ReadModel, TeapotOfThisRepository) {
  Model model;
  taut::read_model(std::string(TAUT_SOURCE_DIR) + "/data/teapot.bpt", model);
  ASSERT_EQ(model.parts().size(), 1U);
  const Part& part = model.parts()[0];
  EXPECT_EQ(part.name, "teapot.bpt");
  ASSERT_EQ(part.faces().size(), 32U);
  EXPECT_EQ(part.patches().size(), 32U);
  EXPECT_EQ(part.faces()[0].name, "patch 1");
  EXPECT_EQ(part.faces()[31].name, "patch 32");
  const Patch& rim = part.patches()[0];
  EXPECT_EQ(rim.bezier.degree_u, 3);
  EXPECT_EQ(rim.bezier.degree_v, 3);
  EXPECT_EQ(taut::euclidean(rim.bezier.at(1, 0)), taut::dvec3(1.4, -0.784, 2.4));
  EXPECT_EQ(taut::euclidean(rim.bezier.at(0, 1)), taut::dvec3(1.3375, 0, 2.53125));
  EXPECT_EQ(part.control_box().lower, taut::dvec3(-3, -2, 0));
  EXPECT_EQ(part.control_box().upper, taut::dvec3(3.525, 2, 3.15));
}

TEST_F(ReadModel, TeapotAgreesWithOneFromElsewhere) {
  const char* folder = std::getenv("TAUT_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_MODELS is not set";
  const std::filesystem::path other = std::filesystem::path(folder) / "A14_teapot_newell.bpt";
  if (!std::filesystem::exists(other)) GTEST_SKIP() << other << " is not there";
  Model model;
  taut::read_model(std::string(TAUT_SOURCE_DIR) + "/data/teapot.bpt", model);
  taut::read_model(other, model);
  const auto& ours = model.parts()[0].patches();
  const auto& theirs = model.parts()[1].patches();
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].bezier.points, theirs[i].bezier.points) << "patch " << i + 1;
  }
}

TEST_F(ReadModel, BptIndexOfFirstDegreeRunsFastest) {
  const Part part = this->part("a.bpt", "1\n1 2\n0 0 0  1 0 0  0 1 5  1 1 5  0 2 0  1 2 0\n");
  const taut::BezierPatch& patch = part.patches()[0].bezier;
  EXPECT_EQ(patch.degree_u, 1);
  EXPECT_EQ(patch.degree_v, 2);
  EXPECT_EQ(taut::euclidean(patch.at(1, 0)), taut::dvec3(1, 0, 0));
  EXPECT_EQ(taut::euclidean(patch.at(0, 1)), taut::dvec3(0, 1, 5));
  EXPECT_EQ(taut::euclidean(patch.at(1, 2)), taut::dvec3(1, 2, 0));
}

TEST_F(ReadModel, BptWaysToWriteTheSame) {
  const auto expected =
      euclidean_points(part("a.bpt", "1\n1 1\n0 0 0\n1.5 0 0\n0 -1 0\n1 1 0.25\n").patches()[0]);
  EXPECT_EQ(expected[2], taut::dvec3(1.5, 0, 0));
  for (const std::string text :
       {"1\r\n1 1\r\n0 0 0\r\n1.5 0 0\r\n0 -1 0\r\n1 1 0.25\r\n",
        "1\r1 1\r0 0 0\r1.5 0 0\r0 -1 0\r1 1 0.25",
        "\xEF\xBB\xBF# a comment\n1 # patch\n\n\t1 1 0 0 0 +1.5 0 0\f0 -1 0 1 1 +.25",
        "1 1 1  0e5 -0 1e-400  15e-1 0 0  0 -1.000 0  1. 1E0 2.5e-01"}) {
    EXPECT_EQ(euclidean_points(part("a.bpt", text).patches()[0]), expected) << text;
  }
}

TEST_F(ReadModel, NumbersDoNotFollowTheLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  // Not installed everywhere; where it is not, this changes nothing.
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
  const Part part = this->part("a.bpt", "1\n1 1\n0 0 0 0.1 0 0 0 1 0 1 1 0\n");
  std::setlocale(LC_NUMERIC, "C");
  std::locale::global(before);
  EXPECT_EQ(taut::euclidean(part.patches()[0].bezier.at(1, 0)).x, 0.1);
}

TEST_F(ReadModel, BptThatIsNotItsFormat) {
  for (const auto& [text, expected] : std::vector<Malformed>{
           {"", ":1: the file ends where the number of patches is expected"},
           {"\n\n# only a comment", ":3: the file ends where the number of patches is expected"},
           {"teapot", ":1: the number of patches expected, found \"teapot\""},
           {"1.5\n", ":1: the number of patches expected, found \"1.5\""},
           {"1\n1 1\n0 0 0\n1 0 0\n0 x 0\n1 1 0\n", ":5: a coordinate expected, found \"x\""},
           {"1\n1 1\n0 0 0\n1 0 0\n0 0 0\n1 1    \n",
            ":7: the file ends where a coordinate is expected"},
           {"1\n1 1\n0 0 0 1 0 0 0 1 0 1 1 0\n1 1\n",
            ":4: more follows the last of the 1 patches that were announced"},
           {"1\n1 1\n0 0 0 1,5 0 0 0 1 0 1 1 0\n", ":3: a coordinate expected, found \"1,5\""},
           {"1\n1 1\n0 0 0 1e 0 0 0 1 0 1 1 0\n", ":3: a coordinate expected, found \"1e\""},
           {"1\n1 1\n0 0 0 0x1 0 0 0 1 0 1 1 0\n", ":3: a coordinate expected, found \"0x1\""},
           {"1\n1 1\n0 0 0 +-1 0 0 0 1 0 1 1 0\n", ":3: a coordinate expected, found \"+-1\""},
           {std::string("1\n1 1\n0 0 0 \0\x01 0 0 0 1 0 1 1 0\n", 32),
            ":3: a coordinate expected, found \"??\""}}) {
    EXPECT_EQ(message<IoError>("a.bpt", text), expected);
  }
}

TEST_F(ReadModel, BptThatIsNoGeometry) {
  const std::string huge(400, '9');
  for (const auto& [text, expected] : std::vector<Malformed>{
           {"0\n", ":1: there are no patches"},
           {"-1\n", ":1: the number of patches is negative: \"-1\""},
           {"99999999999999999999\n",
            ":1: the number of patches is out of range: \"99999999999999999999\""},
           {"1\n0 3\n0 0 0 0 0 0 0 0 0 0 0 0", ":2: degree 0 is not in 1 .. 31"},
           {"1\n3 32\n0 0 0 0 0 0 0 0 0 0 0 0", ":2: degree 32 is not in 1 .. 31"},
           {"1\n3 -3\n0 0 0 0 0 0 0 0 0 0 0 0", ":2: degree -3 is not in 1 .. 31"},
           {"1\n1 1\n0 0 0\n1 nan 0\n0 0 0\n1 1 0\n", ":4: a coordinate is not finite: \"nan\""},
           {"1\n1 1\n0 0 0\n1 -INF 0\n0 0 0\n1 1 0\n", ":4: a coordinate is not finite: \"-INF\""},
           {"1\n1 1\n0 0 0\n1 -1.#IND 0\n0 0 0\n1 1 0\n",
            ":4: a coordinate is not finite: \"-1.#IND\""},
           {"1\n1 1\n0 0 0\n1 1e999 0\n0 0 0\n1 1 0\n", ":4: a coordinate is too large: \"1e999\""},
           {"1\n1 1\n0 0 0\n1 " + huge + " 0\n0 0 0\n1 1 0\n",
            ":4: a coordinate is too large: \"" + huge.substr(0, 40) + "...\""}}) {
    EXPECT_EQ(message<InvalidInput>("a.bpt", text), expected);
  }
}

TEST_F(ReadModel, BptThatAnnouncesTooMuch) {
  const std::string text = "1000000000\n3 3\n" + std::string(84, '0');
  EXPECT_EQ(message<InvalidInput>("a.bpt", text),
            ":1: 1000000000 patches announced, more than the remaining 89 bytes can hold");
}

TEST_F(ReadModel, BptWhoseExtentOverflows) {
  const std::string what =
      message<InvalidInput>("a.bpt", "1\n\n1 1\n-1e308 0 0 1.7e308 0 0 -1e308 1 0 1.7e308 1 0\n");
  EXPECT_TRUE(what.starts_with(":3: patch 1")) << what;
}

// ---------------------------------------------------------------- files

TEST_F(ReadModel, FilesThatCannotBeRead) {
  Model model;
  const auto message = [&](const std::filesystem::path& p) {
    return message_of<IoError>([&] { taut::read_model(p, model); });
  };
  EXPECT_EQ(message(path("none.bpt")),
            path("none.bpt").string() + ": cannot be opened: No such file or directory");
  std::filesystem::create_directory(path("folder.bpt"));
  EXPECT_EQ(message(path("folder.bpt")),
            path("folder.bpt").string() + ": is a folder; name a file in it");
  const std::string known =
      "; known are .bpt, .csv, .mlp, .obj, .off, .ply, .pts, .stl, .taut.cbor, .taut.json, .txt, "
      ".xyz";
  EXPECT_EQ(
      message(file("a.weird", "")),
      path("a.weird").string() + ": no format of models has the extension \".weird\"" + known);
  EXPECT_EQ(message(file("a", "")),
            path("a").string() + ": its name has no extension that tells the format" + known);
  EXPECT_EQ(message(file("a.step", "")),
            path("a.step").string() +
                ": STEP, IGES and BREP files are read by the plugin occt, which is not at hand; "
                "export free-form surfaces as .obj, or the model as .stl");
  EXPECT_TRUE(model.parts().empty());
}

TEST_F(ReadModel, FileAboveTheLimitIsNotRead) {
  std::filesystem::resize_file(file("huge.bpt", "1\n"), (std::uintmax_t{1} << 31) + 1);
  Model model;
  EXPECT_EQ(message_of<taut::LimitExceeded>([&] { taut::read_model(path("huge.bpt"), model); }),
            path("huge.bpt").string() + ": is larger than 2048 MiB, the most that is read");
}

TEST_F(ReadModel, ExtensionInAnyCase) {
  EXPECT_EQ(part("A.BPT", "1 1 1 0 0 0 1 0 0 0 1 0 1 1 0").faces().size(), 1U);
  EXPECT_EQ(taut::extension("folder.x/A.Ply"), ".ply");
  EXPECT_EQ(taut::extension("folder.x/a"), "");
  EXPECT_EQ(taut::extension("folder.x/a.b.JSON"), ".json");
  EXPECT_EQ(taut::extension("a.b.Taut.json"), ".taut.json");
  EXPECT_EQ(taut::extension("a.taut.cbor"), ".taut.cbor");
  EXPECT_EQ(taut::extension("a.hull.json"), ".hull.json");
  EXPECT_EQ(taut::extension("taut.json"), ".json");
}

TEST_F(ReadModel, AddsOnePartPerFile) {
  Model model;
  const auto path = file("a.bpt", "1 1 1 0 0 0 1 0 0 0 1 0 1 1 0");
  taut::read_model(path, model);
  taut::read_model(path, model);
  EXPECT_EQ(model.parts().size(), 2U);
  EXPECT_EQ(model.instances().size(), 2U);
}

TEST_F(ReadModel, ModelIsUnchangedByAnError) {
  Model model;
  taut::read_model(file("a.bpt", "1 1 1 0 0 0 1 0 0 0 1 0 1 1 0"), model);
  const int sources = model.source_count();
  const auto bad = file("b.bpt", "2 1 1 0 0 0 1 0 0 0 1 0 1 1 0 1 1 0 0 0 1 0 0 0 1 0 1 1 nan");
  EXPECT_THROW(taut::read_model(bad, model), InvalidInput);
  EXPECT_EQ(model.parts().size(), 1U);
  EXPECT_EQ(model.instances().size(), 1U);
  EXPECT_EQ(model.source_count(), sources);
}

TEST_F(ReadModel, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  options_.progress.stop = stop.get_token();
  EXPECT_THROW(read("a.bpt", "1 1 1 0 0 0 1 0 0 0 1 0 1 1 0"), taut::Cancelled);
  EXPECT_THROW(read("a.obj", "v 0 0 0\n"), taut::Cancelled);
}

// ---------------------------------------------------------------- .obj

/// `count` vertices on no regular grid.
std::string vertices(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += "v " + std::to_string(i * 3 % 7) + " " + std::to_string(i * i % 11) + " " +
            std::to_string(i) + " " + std::to_string(1 + i % 3) + "\n";
  }
  return text;
}

std::string numbers(int first, int last) {
  std::string text;
  for (int i = first; i <= last; ++i) text += " " + std::to_string(i);
  return text;
}

/// B-spline basis function by its definition (de Boor 1978, IX.14), right-continuous.
long double basis(const std::vector<double>& t, std::size_t i, int degree, long double x) {
  if (degree == 0) return t[i] <= x && x < t[i + 1] ? 1 : 0;
  const std::size_t p = static_cast<std::size_t>(degree);
  long double sum = 0;
  if (t[i] < t[i + p]) sum += (x - t[i]) / (t[i + p] - t[i]) * basis(t, i, degree - 1, x);
  if (t[i + 1] < t[i + p + 1]) {
    sum += (t[i + p + 1] - x) / (t[i + p + 1] - t[i + 1]) * basis(t, i + 1, degree - 1, x);
  }
  return sum;
}

/// The rational B-spline surface through the vertices() in their order, u index fastest.
taut::dvec3 reference_point(const std::vector<double>& knots_u, int degree_u,
                            const std::vector<double>& knots_v, int degree_v, bool rational,
                            double u, double v) {
  const std::size_t count_u = knots_u.size() - static_cast<std::size_t>(degree_u) - 1;
  const std::size_t count_v = knots_v.size() - static_cast<std::size_t>(degree_v) - 1;
  long double sum[4] = {0, 0, 0, 0};
  for (std::size_t j = 0; j < count_v; ++j) {
    for (std::size_t i = 0; i < count_u; ++i) {
      const int k = static_cast<int>(j * count_u + i);
      const long double b = basis(knots_u, i, degree_u, u) * basis(knots_v, j, degree_v, v) *
                            (rational ? 1 + k % 3 : 1);
      const int point[4] = {k * 3 % 7, k * k % 11, k, 1};
      for (int c = 0; c < 4; ++c) sum[c] += b * point[c];
    }
  }
  return {static_cast<double>(sum[0] / sum[3]), static_cast<double>(sum[1] / sum[3]),
          static_cast<double>(sum[2] / sum[3])};
}

/// The point of a face from the patch that covers (u, v).
taut::dvec3 face_point(const Part& part, double u, double v) {
  for (const Patch& p : part.patches()) {
    if (p.u.lower <= u && u <= p.u.upper && p.v.lower <= v && v <= p.v.upper) {
      return taut::point(p.bezier, (u - p.u.lower) / (p.u.upper - p.u.lower),
                         (v - p.v.lower) / (p.v.upper - p.v.lower));
    }
  }
  ADD_FAILURE() << "no patch covers " << u << ", " << v;
  return {};
}

TEST_F(ReadModel, ObjBezierSurface) {
  const Part part = this->part(
      "a.obj", vertices(12) +
                   "g spout\ncstype bezier\ndeg 2 3\nsurf 0 1 0 1 1 2 3 4 5 6 7 8 9 10 11 12\n"
                   "parm u 0 1\nparm v 0 1\nend\n");
  ASSERT_EQ(part.faces().size(), 1U);
  EXPECT_EQ(part.name, "a.obj");
  EXPECT_EQ(part.faces()[0].name, "spout");
  const taut::BezierPatch& patch = part.patches()[0].bezier;
  EXPECT_EQ(patch.degree_u, 2);
  EXPECT_EQ(patch.degree_v, 3);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(patch.at(i, j).w, 1);  // not rational: weights do not count
      EXPECT_EQ(patch.at(i, j).z, 3 * j + i);
    }
  }
}

TEST_F(ReadModel, ObjBezierWithoutParmIsOnePiece) {
  const Part part =
      this->part("a.obj", vertices(4) + "cstype bezier\ndeg 1 1\nsurf 2 3 5 7 1 2 3 4\nend\n");
  ASSERT_EQ(part.patches().size(), 1U);
  EXPECT_EQ(part.patches()[0].u.lower, 2);
  EXPECT_EQ(part.patches()[0].v.upper, 7);
  EXPECT_EQ(part.faces()[0].name, "surface 1");
}

TEST_F(ReadModel, ObjPiecewiseBezier) {
  // Two pieces by three, degrees 2 and 1: 5 by 4 control points.
  const Part part =
      this->part("a.obj", vertices(20) + "cstype bezier\ndeg 2 1\nsurf 0 3 0 1" + numbers(1, 20) +
                              "\nparm u 0 1 3\nparm v 0 0.25 0.5 1\nend\n");
  ASSERT_EQ(part.faces().size(), 1U);
  ASSERT_EQ(part.patches().size(), 6U);
  EXPECT_EQ(part.faces()[0].patch_count, 6);
  for (const Patch& patch : part.patches()) {
    const int su = patch.u.lower == 0 ? 0 : 1;
    const int sv = static_cast<int>(patch.v.lower * 4);
    EXPECT_EQ(patch.u.upper, su == 0 ? 1 : 3);
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(patch.bezier.at(i, j).z, (sv + j) * 5 + 2 * su + i);
      }
    }
  }
}

TEST_F(ReadModel, ObjSplineSurfaceAgreesWithBasisFunctions) {
  const std::vector<double> knots_u = {0, 0, 0, 0, 1, 2.5, 2.5, 4, 4, 4, 4};  // 7 points
  const std::vector<double> knots_v = {-1, 0, 0.5, 1.25, 2, 3, 4};            // 4, not clamped
  const std::string body =
      numbers(1, 28) + "\nparm u 0 0 0 0 1 2.5 2.5 4 4 4 4\nparm v -1 0 .5 1.25 2 3 4\nend\n";
  std::mt19937 random(1);
  for (const bool rational : {false, true}) {
    for (const auto& [range, u, v] :
         std::vector<std::tuple<std::string, taut::Interval, taut::Interval>>{
             {"0 4 0.5 2", {0, 4}, {0.5, 2}},
             {"0.25 3.125 0.5 2", {0.25, 3.125}, {0.5, 2}},
             {"1 2.5 0.75 1.875", {1, 2.5}, {0.75, 1.875}},
             {"2.75 3 1 1.0625", {2.75, 3}, {1, 1.0625}}}) {
      const Part part = this->part("a.obj", vertices(28) + "cstype " + (rational ? "rat " : "") +
                                                "bspline\ndeg 3 2\nsurf " + range + body);
      ASSERT_EQ(part.faces().size(), 1U);
      EXPECT_EQ(part.patches().front().u.lower, u.lower);
      EXPECT_EQ(part.patches().back().u.upper, u.upper);
      EXPECT_EQ(part.patches().front().v.lower, v.lower);
      EXPECT_EQ(part.patches().back().v.upper, v.upper);
      for (int k = 0; k < 100; ++k) {
        const double s = std::uniform_real_distribution(u.lower, u.upper)(random);
        const double t = std::uniform_real_distribution(v.lower, v.upper)(random);
        const taut::dvec3 expected = reference_point(knots_u, 3, knots_v, 2, rational, s, t);
        EXPECT_LT(glm::length(face_point(part, s, t) - expected), 1e-13 * 20)
            << range << " at " << s << ", " << t;
      }
    }
  }
}

TEST_F(ReadModel, ObjRangeOverSeveralPiecesKeepsOneFace) {
  const std::string text = vertices(7) + "cstype bspline\ndeg 3\ncurv 0.5 3.5" + numbers(1, 7) +
                           "\nparm u 0 0 0 0 1 2 3 4 4 4 4\nend\n";
  const Part part = this->part("a.obj", text);
  ASSERT_EQ(part.edges().size(), 1U);
  EXPECT_EQ(part.edges()[0].piece_count, 4);
  EXPECT_EQ(part.pieces().front().t.lower, 0.5);
  EXPECT_EQ(part.pieces().back().t.upper, 3.5);
}

TEST_F(ReadModel, ObjRationalCircleIsRound) {
  // Spec's weights: coordinates are Euclidean, w stands beside them.
  const Part part = this->part("a.obj",
                               "v 1 0 0 1\nv 1 1 0 0.70710678118654752\nv 0 1 0 1\no arc\n"
                               "cstype rat bezier\ndeg 2\ncurv 0 1 1 2 3\nparm u 0 1\nend\n");
  ASSERT_EQ(part.edges().size(), 1U);
  EXPECT_EQ(part.edges()[0].name, "arc");
  for (const double t : {0.0, 0.125, 0.5, 0.8, 1.0}) {
    EXPECT_NEAR(glm::length(taut::point(part.pieces()[0].bezier, t)), 1, 4e-16) << t;
  }
}

TEST_F(ReadModel, ObjWaysToReferToVertices) {
  const std::string begin = "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 ";
  const auto expected =
      euclidean_points(part("a.obj", vertices(4) + begin + "1 2 3 4\nend\n").patches()[0]);
  for (const std::string& text : std::vector<std::string>{
           vertices(4) + begin + "-4 -3 -2 -1\nend\n",
           vertices(4) + begin + "1/1 2/2 3/3 4/4\nend\n",
           vertices(4) + begin + "1/1/1 2//7 -2/-1/-1 4//\nend\n",
           vertices(4) + begin + "1 2\\\n 3 \\\r\n4\nend\n",
           begin + "1 2 3 4\nend\n" + vertices(4),  // vertices may follow
           "v 9 9 9\n" + vertices(4) + begin + "-4 -3 -2 -1\nend\nv 8 8 8\n"}) {
    EXPECT_EQ(euclidean_points(part("a.obj", text).patches()[0]), expected) << text;
  }
}

TEST_F(ReadModel, ObjVerticesWithColours) {
  const Part part = this->part("a.obj",
                               "v 0 0 0 .1 .2 .3\nv 1 0 0 .1 .2 .3\nv 0 1 0 2 .1 .2 .3\nv 1 1 0\n"
                               "cstype rat bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n");
  const taut::BezierPatch& patch = part.patches()[0].bezier;
  EXPECT_EQ(patch.at(1, 0).w, 1);
  EXPECT_EQ(patch.at(0, 1).w, 2);
}

TEST_F(ReadModel, ObjNamesOfFaces) {
  const std::string surf = "surf 0 1 0 1 1 2 3 4\nend\n";
  const Part part =
      this->part("a.obj", vertices(4) + "cstype bezier\ndeg 1 1\n" + surf + "g lid knob\n" + surf +
                              surf + "o body\n" + surf + "g\n" + surf);
  std::vector<std::string> names;
  for (const taut::Face& face : part.faces()) names.push_back(face.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"surface 1", "lid knob", "lid knob", "body", "surface 5"}));
}

TEST_F(ReadModel, ObjPassesOverWhatIsNoGeometry) {
  collect_warnings();
  const Part part = this->part(
      "a.obj", "# comment\nmtllib a.mtl\n" + vertices(4) +
                   "vt 0 0\nvn 0 0 1\nusemtl red\ns 1\nlod 3\nbevel on\nctech cparm 5\n"
                   "stech cparma 5 5\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n"
                   "con 1 0 1 1 1 0 1 1\n");
  EXPECT_EQ(part.faces().size(), 1U);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(ReadModel, ObjWarnsOfWhatIsLeftOut) {
  collect_warnings();
  const Part part = this->part("a.obj", vertices(4) +
                                            "what 1\nwhat 2\ncstype bezier\ndeg 1 1\ncdc 1\n"
                                            "surf 0 1 0 1 1 2 3 4\nscrv 0 1 1\nsp 1\nsp 1\nend\n");
  EXPECT_EQ(part.faces().size(), 1U);
  EXPECT_EQ(part.edges().size(), 4U);  // the surface's borders
  EXPECT_EQ(warnings_, (std::vector<std::string>{"unknown-statement", "unknown-statement",
                                                 "special-geometry", "special-geometry"}));
  ASSERT_EQ(warning_texts_.size(), 4U);
  EXPECT_EQ(warning_texts_[0], path("a.obj").string() + ":5: \"what\": is not known and left out");
}

TEST_F(ReadModel, ObjWarnsOfFewKindsOnly) {
  collect_warnings();
  std::string text = vertices(4);
  for (int i = 0; i < 1000; ++i) text += "kind" + std::to_string(i) + "\n";
  part("a.obj", text + "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n");
  EXPECT_LE(warnings_.size(), 20U);
}

TEST_F(ReadModel, ObjThatIsNotItsFormat) {
  const std::string v4 = vertices(4);
  const std::string type = v4 + "cstype bezier\ndeg 1 1\n";
  const std::string spline = v4 + "cstype bspline\ndeg 1 1\n";
  for (const auto& [text, expected] : std::vector<Malformed>{
           {"v 1 2\n", ":1: v takes three coordinates"},
           {"v 1 2 zwei\n", ":1: a coordinate expected, found \"zwei\""},
           {"cstype\n", ":1: cstype takes a type, perhaps after the word rat"},
           {"cstype bezier rat\n", ":1: cstype takes a type, perhaps after the word rat"},
           {"cstype rat taylor\n", ":1: cstype taylor is not supported; bezier and bspline are"},
           {"cstype bmatrix\n", ":1: cstype bmatrix is not supported; bezier and bspline are"},
           {"cstype cardinal\n", ":1: cstype cardinal is not supported; bezier and bspline are"},
           {"cstype spline\n", ":1: bezier or bspline expected, found \"spline\""},
           {"deg\n", ":1: deg takes one or two degrees"},
           {"deg two\n", ":1: a degree expected, found \"two\""},
           {v4 + "deg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n", ":6: surf stands before any cstype"},
           {v4 + "cstype bezier\nsurf 0 1 0 1 1 2 3 4\nend\n", ":6: surf stands before any deg"},
           {v4 + "cstype bezier\ndeg 1\nsurf 0 1 0 1 1 2 3 4\nend\n",
            ":7: surf needs two degrees, the last deg gives one"},
           {type + "surf 0 1 0 1\nend\n", ":7: surf takes s0 s1 t0 t1 and vertices"},
           {type + "curv 0 1\nend\n", ":7: curv takes t0 t1 and vertices"},
           {type + "surf 0 1 0 1 1 2 a 4\nend\n", ":7: a vertex expected, found \"a\""},
           {type + "surf 0 1 0 1 1 2 3/x 4\nend\n", ":7: a vertex expected, found \"3/x\""},
           {type + "surf 0 1 0 1 1 2 /3 4\nend\n", ":7: a vertex expected, found \"\""},
           {type + "surf 0 1 0 1 1 2 3 4\n", ":7: the surf that begins here has no end"},
           {type + "surf 0 1 0 1 1 2 3 4\nsurf 0 1 0 1 1 2 3 4\nend\n",
            ":8: surf stands before the end of the surf of line 7"},
           {type + "surf 0 1 0 1 1 2 3 4\ndeg 2 2\nend\n",
            ":8: deg stands before the end of the surf of line 7"},
           {type + "end\n", ":7: end stands in no curv or surf"},
           {type + "parm u 0 1\n", ":7: parm stands in no curv or surf"},
           {type + "trim 0 1 1\n", ":7: trim stands in no curv or surf"},
           {type + "surf 0 1 0 1 1 2 3 4\nparm w 0 1\nend\n",
            ":8: parm takes u or v and two parameters or more"},
           {type + "surf 0 1 0 1 1 2 3 4\nparm u 0\nend\n",
            ":8: parm takes u or v and two parameters or more"},
           {type + "surf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm u 0 1\nend\n",
            ":9: parm u stands here a second time"},
           {type + "curv 0 1 1 2\nparm v 0 1\nend\n", ":8: a curve has no parm v"},
           {type + "curv2 1\nend\n", ":7: curv2 takes two parameter points or more"},
           {type + "surf 0 1 0 1 1 2 3\nend\n", ":7: 3 vertices where degree and parm ask for 4"},
           {type + "surf 0 1 0 1 1 2 3 4\nparm u 0 1 2\nend\n",
            ":7: 4 vertices where degree and parm ask for 6"},
           {spline + "surf 0 1 0 1 1 2 3 4\nparm u 0 0 1 1\nend\n",
            ":7: a bspline needs parm v with its knots"},
           {spline + "surf 0 1 0 1 1 2 3 4\nparm u 0 0 1\nparm v 0 0 1 1\nend\n",
            ":8: parm u has 3 knots; degree 1 needs at least 4"}}) {
    EXPECT_EQ(message<IoError>("a.obj", text), expected) << text;
  }
}

TEST_F(ReadModel, ObjThatIsNoGeometry) {
  const std::string v4 = vertices(4);
  const std::string type = v4 + "cstype bezier\ndeg 1 1\n";
  const std::string spline = v4 + "cstype bspline\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\n";
  for (const auto& [text, expected] : std::vector<Malformed>{
           {"v 1 2 NaN\n", ":1: a coordinate is not finite: \"NaN\""},
           {"v 1 2 3 inf\n", ":1: a weight is not finite: \"inf\""},
           {"deg 0\n", ":1: degree 0 is not in 1 .. 31"},
           {"deg 3 99\n", ":1: degree 99 is not in 1 .. 31"},
           {type + "surf 0 1 0 1 0 2 3 4\nend\n", ":7: vertex 0 is referred to, but 4 came before"},
           {type + "surf 0 1 0 1 -5 2 3 4\nend\n",
            ":7: vertex -5 is referred to, but 4 came before"},
           {type + "surf 0 1 0 1 -9223372036854775808 2 3 4\nend\n",
            ":7: vertex -9223372036854775808 is referred to, but 4 came before"},
           {type + "surf 0 1 0 1 5 2 3 4\nend\n", ":7: vertex 5 is referred to, but there are 4"},
           {type + "surf 0 1 0 1 9223372036854775807 2 3 4\nend\n",
            ":7: vertex 9223372036854775807 is referred to, but there are 4"},
           {type + "surf 1 1 0 1 1 2 3 4\nend\n",
            ":7: the range of parameters is empty: \"1\" to \"1\""},
           {type + "surf nan 1 0 1 1 2 3 4\nend\n", ":7: a parameter is not finite: \"nan\""},
           {type + "surf 0 1 0 1 1 2 3 4\nparm u 0 0\nend\n",
            ":8: parm u has two equal breakpoints"},
           {type + "surf 0 2 0 1 1 2 3 4\nparm u 0 1\nend\n",
            ":7: the range of parameters, 0 to 2, exceeds that of parm, 0 to 1"},
           {spline + "parm u 0 1 0 1\nparm v 0 0 1 1\nend\n",
            ":8: parameter \"0\" is below the one before it"},
           {spline + "parm u 0 0 1 1\nparm v 0 0 0.5 0.5\nend\n",
            ":7: the range of parameters, 0 to 1, exceeds that of parm, 0 to 0.5"},
           {"v 0 0 0 0\nv 1 0 0 -1\ncstype rat bezier\ndeg 1\ncurv 0 1 1 2\nend\n",
            ":1: the weight of vertex 1 is not positive, and the rational element of line 5 uses "
            "it"},
           {"vp 0 0\ncstype bezier\ndeg 1\ncurv2 1 2\nend\n",
            ":4: parameter point 2 is referred to, but 1 came before"}}) {
    EXPECT_EQ(message<InvalidInput>("a.obj", text), expected) << text;
  }
  const std::string what =
      message<InvalidInput>("a.obj", spline + "parm u 0 0 0 0\nparm v 0 0 1 1\nend\n");
  EXPECT_TRUE(what.starts_with(":7: surface 1")) << what;
}

TEST_F(ReadModel, ObjWhosePiecesWouldFillMemory) {
  // 300 x 300 control points on uniform knots of degree 31 are 72 000 pieces of 1024 points.
  std::string text = "v 0 0 0\ncstype bspline\ndeg 31 31\nsurf 31 300 31 300";
  for (int i = 0; i < 300 * 300; ++i) text += " 1";
  text += "\nparm u" + numbers(0, 331) + "\nparm v" + numbers(0, 331) + "\nend\n";
  EXPECT_EQ(message<taut::LimitExceeded>("a.obj", text),
            ":4: the Bezier pieces of this file have more than 67108864 control points");
}

TEST_F(ReadModel, ObjPolygonsPointsAndPolylines) {
  collect_warnings();
  // Vertices 1, 4 and 9 are used by nothing; 8 by a point only.
  const Part part = this->part("a.obj",
                               "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 9 9 9\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
                               "v 2 0 0\nv 9 9 9\nf 2/1 3//2 5 6\nf 2 2 2\nfo 2 3 -3\n"
                               "g wire\nl 3 7/1 6\ng\nl -3 2\np 8 2\np 2\n");
  EXPECT_EQ(part.point_count(), 6);
  const std::vector<taut::dvec3> expected = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                             {0, 1, 0}, {0, 0, 1}, {2, 0, 0}};
  EXPECT_EQ(std::vector(part.vertices().begin(), part.vertices().begin() + 6), expected);
  EXPECT_EQ(part.polygons(), (std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 0, 0}, {0, 1, 4}}));
  EXPECT_EQ(part.control_box().upper, taut::dvec3(2, 1, 1));
  ASSERT_EQ(part.edges().size(), 2U);
  EXPECT_EQ(part.edges()[0].name, "wire");
  EXPECT_EQ(part.edges()[0].piece_count, 2);
  EXPECT_EQ(part.pieces()[1].t.upper, 2);
  EXPECT_EQ(taut::point(part.pieces()[0].bezier, 0.5), taut::dvec3(0.5, 0, 0.5));
  EXPECT_EQ(part.edges()[1].name, "curve 2");
  EXPECT_EQ(part.edges()[1].piece_count, 1);
  EXPECT_TRUE(part.faces().empty());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(ReadModel, ObjPolygonsBesideSurfaces) {
  const Part part = this->part(
      "a.obj",
      vertices(4) + "v 0 0 9\nf 1 2 5\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n");
  EXPECT_EQ(part.faces().size(), 1U);
  EXPECT_EQ(part.polygons().size(), 1U);
  EXPECT_EQ(part.point_count(), 3);
}

TEST_F(ReadModel, ObjSubdivisionTagsAndSchemes) {
  const std::string cage = vertices(4) +
                           "s off\nf 1 2 3 4\nt crease 2/1/0 0 1 1.5\nt corner 1/1/0 2 3\n"
                           "t interpolateboundary 1/0/0 1\n";
  const Part tagged = part("a.obj", cage);
  ASSERT_EQ(tagged.cages().size(), 1U);
  const taut::ControlCage& control = *tagged.cages()[0].cage;
  EXPECT_EQ(control.scheme, taut::CageScheme::catmark);
  ASSERT_EQ(control.creases.size(), 1U);
  EXPECT_EQ(control.creases[0].vertices, (std::array<int, 2>{0, 1}));
  EXPECT_EQ(control.creases[0].sharpness, 1.5);
  ASSERT_EQ(control.corners.size(), 1U);
  EXPECT_EQ(control.corners[0].vertex, 2);
  EXPECT_EQ(tagged.faces().size(), 1U);
  const std::string off = "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2";
  EXPECT_EQ(read("a.off", off).face_count(), 1);
  for (const taut::Scheme scheme : {taut::Scheme::catmark, taut::Scheme::loop}) {
    options_.scheme = scheme;
    const Part triangle = part("a.off", off);
    ASSERT_EQ(triangle.cages().size(), 1U);
    EXPECT_EQ(triangle.faces().size(), 1U);
    EXPECT_TRUE(triangle.polygons().empty());
    // What has no polygons has no cage.
    EXPECT_EQ(read("a.obj", vertices(4) + "p 1 2\nt crease 2/1/0 0 1 2\n").vertex_count(), 2);
    EXPECT_EQ(read("a.off", "OFF 1 0 0 1 2 3").vertex_count(), 1);
    EXPECT_EQ(read("a.xyz", "1 2 3").vertex_count(), 1);
  }
  options_.scheme = taut::Scheme::bilinear;
  EXPECT_EQ(part("a.obj", cage).polygons().size(), 1U);
}

TEST_F(ReadModel, ObjSubdivisionTags) {
  const std::string cage = vertices(4) + "f 1 2 3 4\n";
  const auto control = [&](const std::string& tags) {
    return *part("a.obj", cage + tags).cages()[0].cage;
  };
  EXPECT_EQ(control("t crease 3/2/0 0 1 2 1 2\n").creases[1].sharpness, 2);
  EXPECT_EQ(control("t crease 3/1/0 0 1 2 4\n").creases[1].sharpness, 4);
  EXPECT_EQ(control("t interpolateboundary 1/0/0 2\n").boundary, taut::CageBoundary::edge_only);
  EXPECT_TRUE(control("t creasemethod 0/0/1 chaikin\n").chaikin);
  EXPECT_FALSE(control("t creasemethod 0/0/1 normal\n").chaikin);
  EXPECT_TRUE(control("t smoothtriangles 1/0/0 2\n").smooth_triangles);
  EXPECT_TRUE(control("t smoothtriangles 0/0/1 smooth\n").smooth_triangles);
  EXPECT_FALSE(control("t smoothtriangles 0/0/1 catmark\n").smooth_triangles);
  EXPECT_EQ(control("t vertexedit 1/0/0 2\n").faces.size(), 1U);
  const auto at_fault = [&](const std::string& tag) {
    return message<InvalidInput>("a.obj", cage + tag);
  };
  EXPECT_EQ(at_fault("t crease 2/1/0 0 4 1\n").substr(0, 4), ":6: ");
  EXPECT_EQ(at_fault("t hole 1/0/0 1\n").substr(0, 4), ":6: ");
  EXPECT_EQ(at_fault("t corner 1/1/0 0 -1\n").substr(0, 4), ":6: ");
  const auto malformed = [&](const std::string& tag) {
    return message<IoError>("a.obj", cage + tag);
  };
  EXPECT_EQ(malformed("t crease\n").substr(0, 4), ":6: ");
  EXPECT_EQ(malformed("t crease 2/1 0 1 1\n").substr(0, 4), ":6: ");
  EXPECT_EQ(malformed("t crease 2/2/0 0 1 1\n").substr(0, 4), ":6: ");
  EXPECT_EQ(malformed("t corner 1/1/0\n").substr(0, 4), ":6: ");
  EXPECT_EQ(malformed("t smoothtriangles 0/0/1 rough\n"),
            ":6: the tag \"smoothtriangles\" takes one word of catmark, smooth");
  EXPECT_EQ(malformed("t creasemethod 1/0/0 1\n").substr(0, 4), ":6: ");
}

/// Errors and warnings of cages begin with the file, once.
TEST_F(ReadModel, NamesTheFileOfACageOnce) {
  options_.scheme = taut::Scheme::loop;
  EXPECT_EQ(message<InvalidInput>("a.obj", vertices(4) + "f 1 2 3 4\n"),
            ": face 0 is no triangle, as the scheme loop needs");
  options_.scheme = taut::Scheme::catmark;
  collect_warnings();
  read("b.obj", vertices(4) + "f 1 1 2 3\n");
  ASSERT_FALSE(warning_texts_.empty());
  EXPECT_EQ(warning_texts_.back(),
            path("b.obj").string() + ": 1 faces of the cage have a vertex more than once");
}

TEST_F(ReadModel, ObjCageFromElsewhere) {
  const char* folder = std::getenv("TAUT_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_MODELS is not set";
  const auto path = std::filesystem::path(folder) / "A15_osd_car_creases_boundary.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  Model model;
  options_.scheme = taut::Scheme::bilinear;
  taut::read_model(path, model, options_);
  const std::size_t polygons = model.parts()[0].polygons().size();
  EXPECT_GT(polygons, 100U);
  EXPECT_EQ(polygons, taut::read_mesh(path).polygons.size());
}

/// The control points of a loop's curves, (w u, w v, w).
std::vector<taut::dvec3> loop_points(const taut::TrimLoop& loop) {
  std::vector<taut::dvec3> points;
  for (const taut::NurbsCurve& curve : loop.curves) {
    for (const taut::dvec4& p : curve.points) {
      EXPECT_EQ(p.z, 0);
      points.emplace_back(p.x, p.y, p.w);
    }
  }
  return points;
}

const std::string trim_curves =
    "vp 0.25 0.25\nvp 0.75 0.25 9\nvp 0.75 0.75\nvp .5 .5\nvp 0.5 0.625 2\nvp .625 .5\n"
    "cstype bspline\ndeg 1\ncurv2 1 2 3\nparm u 0 0 1 2 2\nend\n"
    "cstype bezier\ncurv2 -4 1\nend\n"
    "cstype rat bezier\ndeg 2\ncurv2 4 5 6\nparm u 3 5\nend\ncstype bezier\ndeg 1 1\n"
    "curv2 6 4\nparm u 0 1\nend\n";

TEST_F(ReadModel, ObjTrimLoops) {
  collect_warnings();
  const Part part =
      this->part("a.obj", vertices(4) + trim_curves +
                              "surf 0 1 0 1 1 2 3 4\ntrim 0 2 1 0 1 2\nhole 3 5 3 0 1 -1\nend\n"
                              "surf 0 1 0 1 1 2 3 4\nend\n");
  EXPECT_TRUE(warnings_.empty());
  ASSERT_EQ(part.faces().size(), 2U);
  EXPECT_TRUE(part.faces()[1].loops.empty());
  EXPECT_TRUE(part.edges().size() == 4U || part.edges().size() == 8U);  // no curv2 among them
  const std::vector<taut::TrimLoop>& loops = part.faces()[0].loops;
  ASSERT_EQ(loops.size(), 2U);
  ASSERT_EQ(loops[0].curves.size(), 2U);
  EXPECT_EQ(loops[0].curves[0].degree, 1);
  EXPECT_EQ(loops[0].curves[0].knots, (std::vector<double>{0, 0, 1, 2, 2}));
  EXPECT_EQ(
      loop_points(loops[0]),
      (std::vector<taut::dvec3>{
          {0.25, 0.25, 1}, {0.75, 0.25, 1}, {0.75, 0.75, 1}, {0.75, 0.75, 1}, {0.25, 0.25, 1}}));
  // A hole, clockwise as it is written.
  EXPECT_EQ(loops[1].curves[0].knots, (std::vector<double>{3, 3, 3, 5, 5, 5}));
  EXPECT_EQ(loop_points(loops[1]),
            (std::vector<taut::dvec3>{
                {0.5, 0.5, 1}, {1, 1.25, 2}, {0.625, 0.5, 1}, {0.625, 0.5, 1}, {0.5, 0.5, 1}}));
}

TEST_F(ReadModel, ObjTrimLoopsAreTurnedToTheirSense) {
  const Part part =
      this->part("a.obj", vertices(4) + trim_curves +
                              "surf 0 1 0 1 1 2 3 4\nhole 0 2 1 0 1 2\ntrim 3 5 3 0 1 4\nend\n");
  const std::vector<taut::TrimLoop>& loops = part.faces()[0].loops;
  ASSERT_EQ(loops.size(), 2U);
  ASSERT_EQ(loops[0].curves.size(), 2U);
  EXPECT_EQ(
      loop_points(loops[0]),
      (std::vector<taut::dvec3>{
          {0.25, 0.25, 1}, {0.75, 0.75, 1}, {0.75, 0.75, 1}, {0.75, 0.25, 1}, {0.25, 0.25, 1}}));
  EXPECT_EQ(loops[0].curves[1].knots, (std::vector<double>{0, 0, 1, 2, 2}));
  EXPECT_EQ(loop_points(loops[1]).front(), taut::dvec3(0.5, 0.5, 1));
  EXPECT_EQ(loop_points(loops[1])[3], taut::dvec3(1, 1.25, 2));
  EXPECT_EQ(loops[1].curves[1].knots, (std::vector<double>{3, 3, 3, 5, 5, 5}));
}

/// The point of a curve in parameter space.
taut::dvec3 curve_point(const taut::NurbsCurve& curve, double t) {
  for (const taut::CurvePiece& piece : taut::decompose(curve)) {
    if (piece.t.lower <= t && t <= piece.t.upper) {
      return taut::point(piece.bezier, (t - piece.t.lower) / (piece.t.upper - piece.t.lower));
    }
  }
  ADD_FAILURE() << "no piece covers " << t;
  return {};
}

TEST_F(ReadModel, ObjTrimLoopTurnedIsTheSameCurve) {
  // A closed B-spline on knots that are not clamped, once as the outer loop, once as a hole.
  const Part part = this->part(
      "a.obj", vertices(4) +
                   "vp .2 .2\nvp .8 .3 2\nvp .7 .8\nvp .3 .7 .5\ncstype rat bspline\ndeg 3\n"
                   "curv2 1 2 3 4 1 2 3\nparm u -3 -2 -1 0 1 2.5 3 4 5 6.5 7\nend\n"
                   "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\ntrim 0 4 1\nhole 0 4 1\nend\n");
  const taut::NurbsCurve& outer = part.faces()[0].loops[0].curves[0];
  const taut::NurbsCurve& hole = part.faces()[0].loops[1].curves[0];
  EXPECT_EQ(outer.knots, (std::vector<double>{-3, -2, -1, 0, 1, 2.5, 3, 4, 5, 6.5, 7}));
  EXPECT_EQ(hole.domain().lower, 0);
  EXPECT_EQ(hole.domain().upper, 4);
  for (int i = 0; i <= 32; ++i) {
    const double t = i / 8.0;
    EXPECT_LT(glm::length(curve_point(outer, t) - curve_point(hole, 4 - t)), 1e-15) << t;
  }
}

TEST_F(ReadModel, ObjTrimSenseAtAllSizesAndAngles) {
  std::mt19937 random(7);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution(a, b)(random);
  };
  for (int k = 0; k < 300; ++k) {
    // A thin star about a far point, in either sense.
    const double size = std::pow(10, uniform(-150, 150));
    const double far = uniform(0, 100), thin = std::pow(10, uniform(-6, 0));
    const double angle = uniform(0, 7);
    const int corners = 3 + k % 6;
    const int sense = random() % 2 == 0 ? 1 : -1;
    std::string text = vertices(4);
    for (int i = 0; i < corners; ++i) {
      const double a = sense * 6.283185307179586 * (i + uniform(0, 0.4)) / corners;
      const double r = uniform(0.5, 1), x = r * std::cos(a), y = thin * r * std::sin(a);
      text += "vp " + taut::shortest(size * (far + x * std::cos(angle) - y * std::sin(angle))) +
              " " + taut::shortest(size * (x * std::sin(angle) + y * std::cos(angle))) + "\n";
    }
    text += "cstype bspline\ndeg 1 1\ncurv2" + numbers(1, corners) + " 1\nparm u 0" +
            numbers(0, corners) + " " + std::to_string(corners) + "\nend\ncstype bezier\n" +
            "surf 0 1 0 1 1 2 3 4\ntrim 0 " + std::to_string(corners) + " 1\nend\n";
    const taut::NurbsCurve curve = part("a.obj", text).faces()[0].loops[0].curves[0];
    long double area = 0;
    for (std::size_t i = 1; i + 2 < curve.points.size(); ++i) {
      const taut::dvec3 o(curve.points[0]), p(curve.points[i]), q(curve.points[i + 1]);
      const long double px = p.x - static_cast<long double>(o.x),
                        py = p.y - static_cast<long double>(o.y);
      const long double qx = q.x - static_cast<long double>(o.x),
                        qy = q.y - static_cast<long double>(o.y);
      area += px * qy - py * qx;
    }
    EXPECT_GT(area, 0) << text;
  }
}

TEST_F(ReadModel, ObjTrimCurvesOverTheirRange) {
  const Part part = this->part(
      "a.obj", vertices(4) + trim_curves + "surf 0 1 0 1 1 2 3 4\ntrim 0.5 1.25 1 0.5 1 2\nend\n");
  const taut::NurbsCurve& curve = part.faces()[0].loops[0].curves[0];
  EXPECT_EQ(curve.domain().lower, 0.5);
  EXPECT_EQ(curve.domain().upper, 1.25);
  EXPECT_EQ(loop_points(part.faces()[0].loops[0]), (std::vector<taut::dvec3>{{0.5, 0.25, 1},
                                                                             {0.75, 0.25, 1},
                                                                             {0.75, 0.25, 1},
                                                                             {0.75, 0.375, 1},
                                                                             {0.5, 0.5, 1},
                                                                             {0.25, 0.25, 1}}));
}

TEST_F(ReadModel, ObjTrimThatIsNotItsFormat) {
  // The curves end on line 30.
  const std::string surf = vertices(4) + trim_curves + "surf 0 1 0 1 1 2 3 4\n";
  const auto line = std::to_string(std::count(surf.begin(), surf.end(), '\n') + 1);
  for (const auto& [text, expected] : std::vector<Malformed>{
           {surf + "trim\nend\n", ": trim takes a range and a curv2, once or several times"},
           {surf + "hole 0 1\nend\n", ": hole takes a range and a curv2, once or several times"},
           {surf + "trim 0 1 1 0\nend\n",
            ": trim takes a range and a curv2, once or several times"},
           {surf + "trim 0 1 one\nend\n", ": a curv2 expected, found \"one\""},
           {surf + "trim zero 1 1\nend\n", ": a parameter expected, found \"zero\""}}) {
    EXPECT_EQ(message<IoError>("a.obj", text), ":" + line + expected);
  }
  for (const auto& [text, expected] : std::vector<Malformed>{
           {surf + "trim 0 1 5\nend\n", ": curv2 5 is referred to, but 4 came before"},
           {surf + "trim 0 1 -5\nend\n", ": curv2 -5 is referred to, but 4 came before"},
           {surf + "trim 1 0 1\nend\n", ": the range of parameters is empty: \"1\" to \"0\""},
           {surf + "trim 0 nan 1\nend\n", ": a parameter is not finite: \"nan\""},
           {surf + "trim 0 3 1\nend\n",
            ": the range of parameters, 0 to 3, exceeds that of parm, 0 to 2"}}) {
    EXPECT_EQ(message<InvalidInput>("a.obj", text), ":" + line + expected);
  }
  const std::string type = "cstype rat bezier\ndeg 1 1\n";
  for (const auto& [text, expected] : std::vector<Malformed>{
           {"vp\n", ":1: vp takes a parameter or more"},
           {"vp 1 b\n", ":1: a parameter expected, found \"b\""},
           {"vp 0 0\nvp 1 0\ncurv2 1 2\nend\n", ":3: curv2 stands before any cstype"},
           {"vp 0 0\nvp 1 0\ncstype bezier\ncurv2 1 2\nend\n", ":4: curv2 stands before any deg"},
           {vertices(4) + "cstype bezier\ndeg 1 1\ncurv 0 1 1 2\ntrim 0 1 1\nend\n",
            ":8: a curve has no trim"},
           {vertices(4) + "vp 0 0\nvp 1 0\n" + type +
                "curv2 1 2 1\nend\nsurf 0 1 0 1 1 2 3 4\ntrim 0 1 1\nend\n",
            ":9: 3 vertices where degree and parm ask for 2"}}) {
    EXPECT_EQ(message<IoError>("a.obj", text), expected);
  }
  for (const auto& [text, expected] : std::vector<Malformed>{
           {"vp 0 inf\n", ":1: a parameter is not finite: \"inf\""},
           {"vp 0 0 nan\n", ":1: a weight is not finite: \"nan\""},
           {"v 0 0 0\nv 1 0 0\nvp 0 0 -1\nvp 1 0\n" + type +
                "curv2 1 2\nend\nsurf 0 1 0 1 1 2 1 2\ntrim 0 1 1\nend\n",
            ":3: the weight of parameter point 1 is not positive, and the rational element of line "
            "7 uses it"}}) {
    EXPECT_EQ(message<InvalidInput>("a.obj", text), expected);
  }
}

TEST_F(ReadModel, ObjTrimThatWouldFillMemory) {
  // A thousand points, referred to a hundred thousand times.
  std::string text = vertices(4) + "vp 0 0\ncstype bspline\ndeg 1 1\ncurv2";
  for (int i = 0; i < 1000; ++i) text += " 1";
  text += "\nparm u 0" + numbers(0, 999) + " 999\nend\ncstype bezier\nsurf 0 1 0 1 1 2 3 4\ntrim";
  for (int i = 0; i < 100000; ++i) text += " 0 999 1";
  text += "\nend\n";
  EXPECT_EQ(message<taut::LimitExceeded>("a.obj", text),
            ":13: the trimming loops of this file have more than " +
                std::to_string((1 << 20) + text.size()) + " control points");
}

TEST_F(ReadModel, ObjOtherElementsMalformed) {
  EXPECT_EQ(message<IoError>("a.obj", "v 0 0 0\np\n"), ":2: p takes a vertex or more");
  EXPECT_EQ(message<IoError>("a.obj", "v 0 0 0\np a\n"), ":2: a vertex expected, found \"a\"");
  for (const auto& [text, expected] : std::vector<Malformed>{
           {"", ": holds no geometry"},
           {"v 0 0 0\np 2\n", ":2: vertex 2 is referred to, but there are 1"},
           {"v 0 0 0\np 4294967297\n", ":2: vertex 4294967297 is referred to, but there are 1"},
           {"v 0 0 0\np 0\n", ":2: vertex 0 is referred to, but 1 came before"},
           {"v 0 0 0\nl 1 2\n", ":2: vertex 2 is referred to, but there are 1"},
           {"v 0 0 0\nl 1\n", ":2: a line has fewer than two vertices"},
           {"v 0 0 0\nf 1 1\n", ":2: a face has fewer than three vertices"},
           {"v 0 0 0\nf 1 1 2\n", ":2: vertex 2 is referred to, but there are 1"},
           {"v 1e308 0 0\nv -1e308 0 0\nf 1 1 2\n", ": point 0: the extent overflows"}}) {
    EXPECT_EQ(message<InvalidInput>("a.obj", text), expected) << text;
  }
}

// ---------------------------------------------------------------- polygons

/// A square and a triangle with a point that neither uses.
const std::string off_sample =
    "OFF\n6 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n5 5 5\n4 0 1 2 3\n3 0 1 4\n";
const std::string ply_sample =
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
    "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n5 5 5\n4 0 1 2 3\n3 0 1 4\n";

TEST_F(ReadModel, PolygonsOfOffAndPly) {
  for (const auto& [name, text] :
       {std::pair{"a.off", off_sample}, std::pair{"a.ply", ply_sample}}) {
    const Part part = this->part(name, text);
    EXPECT_EQ(part.name, name);
    EXPECT_EQ(part.polygons(), (std::vector<std::vector<int>>{{0, 1, 2, 3}, {0, 1, 4}}));
    EXPECT_EQ(part.vertices().size(), 6U);
    EXPECT_EQ(part.vertices()[5], taut::dvec3(5));
    EXPECT_EQ(part.point_count(), 6);
    EXPECT_TRUE(part.polyhedral());
  }
}

TEST_F(ReadModel, PolygonsOfStl) {
  const Part part = this->part("a.stl",
                               "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                               "vertex 0 1 0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\n"
                               "vertex 0 1 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
                               "endsolid\n");
  EXPECT_EQ(part.polygons(), (std::vector<std::vector<int>>{{0, 1, 2}, {2, 1, 2}}));
  EXPECT_EQ(part.vertices().size(), 3U);
}

TEST_F(ReadModel, PointsWithoutPolygons) {
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.off", "OFF 2 0 0 1 2 3 4 5 6"},
           {"a.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
            "property double z\nend_header\n1 2 3\n4 5 6\n"},
           {"a.obj", "v 1 2 3\nv 4 5 6\np 1 2\n"},
           {"a.xyz", "1 2 3\n4 5 6\n"}}) {
    const Part part = this->part(name, text);
    EXPECT_EQ(part.vertices(), (std::vector<taut::dvec3>{{1, 2, 3}, {4, 5, 6}})) << name;
    EXPECT_TRUE(part.polygons().empty()) << name;
  }
}

TEST_F(ReadModel, FilesWithoutPoints) {
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.off", "OFF 0 0 0"},
           {"a.ply",
            "ply\nformat ascii 1.0\nelement vertex 0\nproperty double x\nproperty double y\n"
            "property double z\nend_header\n"},
           {"a.obj", "# nothing\n"},
           {"a.stl", "solid\nendsolid\n"},
           {"a.stl", std::string(84, '\0')},
           {"a.xyz", "# nothing\n"},
           {"b.xyz", "0\n"}}) {
    EXPECT_EQ(message<InvalidInput>(name, text), ": holds no geometry") << name;
  }
}

TEST_F(ReadModel, FromMemory) {
  for (const auto& [format, text] :
       {std::pair{".off", off_sample}, std::pair{".ply", ply_sample},
        std::pair{".obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")},
        std::pair{".bpt", std::string("1 1 1 0 0 0 1 0 0 0 1 0 1 1 0")},
        std::pair{".xyz", std::string("0 0 0\n")}}) {
    Model model;
    taut::read_model(text, "standard input", format, model);
    ASSERT_EQ(model.parts().size(), 1U);
    EXPECT_EQ(model.parts()[0].name, "standard input");
    EXPECT_FALSE(model.empty());
  }
  Model model;
  EXPECT_EQ(
      message_of<IoError>([&] { taut::read_model("x 1 1", "standard input", ".off", model); }),
      "standard input:1: the number of vertices expected, found \"x\"");
  EXPECT_TRUE(message_of<IoError>([&] {
                taut::read_model("", "standard input", ".weird", model);
              }).starts_with("standard input: no format of models has the extension \".weird\""));
  EXPECT_TRUE(model.parts().empty());
}

// ---------------------------------------------------------------- anything

/// Whatever is done to a file, it is read or refused with one of the errors that are promised.
void expect_read_or_refused(const std::filesystem::path& path) {
  Model model;
  try {
    taut::read_model(path, model);
  } catch (const taut::Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(path.string())) << error.what();
  }
}

TEST_F(ReadModel, DamagedFiles) {
  const std::string bpt = "2\n1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 1e1\n2 1\n0 0 0\n1 0 0\n2 0 0\n" +
                          std::string("0 1 0\n1 1 -2.5\n2 1 0\n");
  const std::string obj = vertices(12) +
                          "cstype rat bspline\ndeg 2 2\nsurf 0 1 0.25 2 -12 -11 -10 -9 -8 -7 \\\n"
                          "-6/1 -5//2 -4 -3 -2 -1\nparm u 0 0 0 1 1 1\nparm v 0 0 0 1 2 2 2\nend\n"
                          "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nend\nf 1 2 3\nl 1 2\np 1\n"
                          "vp 0 0\nvp 1 0 2\nvp 1 1\ndeg 2 1\ncurv2 1 2 3\nparm u 0 1\nend\n"
                          "surf 0 1 0 1 1 2 3 4 5 6\ntrim 0 1 1 0.5 1 1\nhole 0 1 1\nend\n";
  std::mt19937 random(2);
  const std::string bytes = std::string("0123456789-+.eE/\\#\n\r \tnainf") + '\0' + '\xff';
  for (const auto& [name, text] :
       {std::pair{"a.bpt", bpt}, std::pair{"a.obj", obj}, std::pair{"a.off", off_sample},
        std::pair{"a.ply", ply_sample}, std::pair{"a.xyz", std::string("2\n1 2 3\n-4,5e1,6\n")}}) {
    for (std::size_t length = 0; length < text.size(); ++length) {
      expect_read_or_refused(file(name, text.substr(0, length)));
    }
    for (int k = 0; k < 2000; ++k) {
      std::string damaged = text;
      for (int n = 0; n <= k % 4; ++n)
        damaged[random() % damaged.size()] = bytes[random() % bytes.size()];
      expect_read_or_refused(file(name, damaged));
    }
  }
}

}  // namespace
