// The command taut as a user meets it: the built program is run, its output and exit code read.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "command_folder.h"
#include "taut/io/mesh/read_mesh.h"
#include "temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using taut_test::content;
using taut_test::Result;

class Cli : public taut_test::CommandFolder {};

/// A polygon mesh as an OFF file.
std::string off_text(const taut::PolygonMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "OFF\n" << mesh.points.size() << " " << mesh.polygons.size() << " 0\n";
  for (const taut::dvec3& p : mesh.points) text << p.x << " " << p.y << " " << p.z << "\n";
  for (const std::vector<int>& polygon : mesh.polygons) {
    text << polygon.size();
    for (const int v : polygon) text << " " << v;
    text << "\n";
  }
  return text.str();
}

const std::vector<std::string> commands = {"hull",   "info",    "support", "contains",
                                           "verify", "plugins", "help"};

TEST_F(Cli, HelpBeginsWithExamples) {
  EXPECT_EQ(run("--help").exit_code, 0);
  EXPECT_EQ(run("--version").out.rfind("taut 0.", 0), 0U);
  for (const std::string& command : commands) {
    const Result result = run(command + " --help");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_LT(result.out.find("Examples:\n  "), result.out.find("Usage:")) << command;
    for (const char* option : {"--json", "--quiet", "--threads", "--progress", "--version"}) {
      EXPECT_NE(result.out.find(option), std::string::npos) << command << " " << option;
    }
    EXPECT_EQ(run(command + " --version").out, run("--version").out);
  }
  EXPECT_NE(run("hull --help").out.find("precise (default)"), std::string::npos);
}

TEST_F(Cli, HullWritesAllOutputsAndReport) {
  const Result result =
      run("hull " + teapot_ + " -o a.ply -o b.stl -o c.off --relative 1e-3 --report r.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* name : {"a.ply", "b.stl", "c.off", "r.json"}) {
    EXPECT_NE(result.out.find(name), std::string::npos) << result.out;
    EXPECT_TRUE(fs::exists(path(name))) << name;
  }
  EXPECT_EQ(file_count(), 4U);
  EXPECT_GT(taut::read_mesh(path("a.ply")).points.size(), 100U);
  // Without positions rounded to float.
  EXPECT_EQ(run("verify a.ply " + teapot_ + " --relative 1e-3").exit_code, 0);
  EXPECT_EQ(run("verify c.off " + teapot_ + " --relative 1e-3").exit_code, 0);
}

TEST_F(Cli, HullReportHasTheNamesOfTheContract) {
  const Result result = run("hull " + teapot_ + " --json --report r.json --tolerance 0.01");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, content(path("r.json")));
  const Json report = Json::parse(result.out);
  for (const char* key : {"/taut",
                          "/input/files/0",
                          "/input/faces",
                          "/input/edges",
                          "/input/vertices",
                          "/input/patches",
                          "/input/diagonal",
                          "/input/box/1/2",
                          "/method",
                          "/dimension",
                          "/hull/resolution",
                          "/hull/resolution_source",
                          "/hull/tolerant",
                          "/hull/tolerant_bound",
                          "/hull/gap_bound",
                          "/mesh/vertices",
                          "/mesh/edges",
                          "/mesh/faces",
                          "/mesh/volume",
                          "/mesh/area",
                          "/mesh/tolerance",
                          "/mesh/distance_bound",
                          "/queries/support",
                          "/queries/newton_iterations",
                          "/seconds/read",
                          "/seconds/build",
                          "/seconds/sample",
                          "/seconds/cull",
                          "/seconds/trace",
                          "/seconds/stitch",
                          "/seconds/mesh",
                          "/seconds/measure",
                          "/seconds/write",
                          "/seconds/total",
                          "/peak_bytes",
                          "/warnings",
                          "/hull/patches",
                          "/hull/scrolls",
                          "/hull/facets",
                          "/hull/curves",
                          "/hull/unresolved",
                          "/hull/volume",
                          "/hull/area",
                          "/hull/centroid/2",
                          "/hull/inertia/2/2",
                          "/hull/mean_width",
                          "/culling/leaves",
                          "/culling/kept"}) {
    EXPECT_TRUE(report.contains(Json::json_pointer(key))) << key;
  }
  EXPECT_EQ(report["input"]["patches"], 32);
  EXPECT_EQ(report["method"], "precise");
  EXPECT_EQ(report["dimension"], 3);
  EXPECT_EQ(report["mesh"]["tolerance"], 0.01);
  EXPECT_GT(report["mesh"]["distance_bound"], 0);
  EXPECT_LE(report["mesh"]["distance_bound"], 0.01);
  const long v = report["mesh"]["vertices"], e = report["mesh"]["edges"];
  const long f = report["mesh"]["faces"];
  EXPECT_EQ(v - e + f, 2);
  EXPECT_GT(report["mesh"]["volume"], 10);
  EXPECT_GT(report["peak_bytes"], 1000000);
}

TEST_F(Cli, HullTellsWhatIsUnresolved) {
  for (const char* name : {"three_spheres", "dented_ellipsoid", "torus", "saddle", "cone"}) {
    const std::string model = TAUT_SOURCE_DIR "/data/" + std::string(name) + ".taut.json";
    const Result result =
        run("hull " + model + " -o h.ply -o h.hull.json --relative 1e-3 --report r.json");
    EXPECT_EQ(result.exit_code, 0) << name << "\n" << result.err;
    const Json report = Json::parse(content(path("r.json")));
    const Json& hull = report["hull"];
    EXPECT_EQ(Json::parse(content(path("h.hull.json")))["report"]["hull"], hull) << name;
    const long unresolved = hull["unresolved"];
    EXPECT_EQ(hull.contains("volume"), unresolved == 0) << name;
    EXPECT_EQ(hull.contains("mean_width"), unresolved == 0) << name;
    if (unresolved == 0) {
      EXPECT_EQ(report["warnings"], Json::array()) << name;
      EXPECT_EQ(result.err, "") << name;
      EXPECT_EQ(run("verify h.hull.json " + model).exit_code, 0) << name;
    } else {
      EXPECT_EQ(report["warnings"][0]["code"], "unresolved") << name;
      EXPECT_TRUE(result.err.starts_with("taut: warning: " + std::to_string(unresolved) + " spot"))
          << name << "\n"
          << result.err;
      EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
      EXPECT_NE(result.out.find(" of the mesh\n"), std::string::npos) << result.out;
    }
    EXPECT_EQ(run("verify h.ply " + model + " --relative 1e-3").exit_code, 0) << name;
  }
}

TEST_F(Cli, MeanWidthBelowDimensionThree) {
  const auto mean_width = [&](const std::string& points) {
    return Json::parse(run("hull " + plant("p.xyz", points) + " --json").out)["hull"]["mean_width"]
        .get<double>();
  };
  EXPECT_NEAR(mean_width("0 0 1\n3 0 1\n3 4 1\n0 4 1\n"), 14 / 4.0, 1e-14);
  EXPECT_NEAR(mean_width("0 0 1\n3 4 1\n"), 2.5, 1e-14);
  EXPECT_EQ(mean_width("1 2 3\n"), 0);
}

/// Points of a grid, rounded, so that edges of the hull are slivers whose normals are rounded; the
/// right value is that of exact arithmetic.
TEST_F(Cli, MeanWidthOfAGridThatIsRounded) {
  const std::string points =
      "-1.333991 -3.243868 -0.743447\n"
      "2.716230 -1.258002 0.228605\n"
      "6.766450 0.727863 1.200657\n"
      "2.936855 -11.322555 -2.034201\n"
      "5.072278 -15.361898 -2.679578\n"
      "-3.626649 -7.309095 17.114409\n"
      "0.423572 -5.323229 18.086461\n"
      "4.473793 -3.337363 19.058513\n"
      "10.880061 -15.455393 17.122382\n";
  const Json report = Json::parse(run("hull " + plant("p.xyz", points) + " --json").out);
  EXPECT_NEAR(report["hull"]["mean_width"].get<double>(), 19.442105919462399, 1e-13);
}

TEST_F(Cli, ExactHullsOfFlatCurves) {
  const auto curve = [&](const char* name, const char* middle) {
    return plant(name, std::string("v 0 0 0\nv ") + middle +
                           "\nv 2 0 0\ncstype bezier\ndeg 2\n"
                           "curv 0 1 1 2 3\nparm u 0 1\nend\n");
  };
  const std::string arc = curve("arc.obj", "1 2 0");
  EXPECT_EQ(run("hull " + arc + " -o a.ply -o a.hull.json -q").exit_code, 0);
  EXPECT_EQ(run("verify a.hull.json " + arc).exit_code, 0);
  const std::string line = curve("line.obj", "1 0 0");
  EXPECT_EQ(run("hull " + line + " -o b.ply -o b.hull.json -q").exit_code, 0);
  EXPECT_EQ(run("verify b.hull.json " + line).exit_code, 0);
  const Json segment = Json::parse(content(path("b.hull.json")));
  EXPECT_EQ(segment["dimension"], 1);
  EXPECT_EQ(segment["faces"].size(), 0U);
  EXPECT_EQ(segment["curves"].size(), 1U);
  EXPECT_EQ(run("verify b.hull.json " + arc).exit_code, 1);
}

TEST_F(Cli, QuietHullSaysNothing) {
  const Result result = run("hull " + teapot_ + " -o a.ply --relative 1e-2 --quiet");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
  EXPECT_TRUE(fs::exists(path("a.ply")));
}

TEST_F(Cli, PlainProgressGoesToStderr) {
  const Result result = run("hull " + teapot_ + " -o a.ply --relative 1e-3 --progress plain");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find(" %\n"), std::string::npos) << result.err;
  EXPECT_EQ(run("hull " + teapot_ + " -o b.ply --relative 1e-3 --progress never").err, "");
}

TEST_F(Cli, SameBytesForAnyNumberOfThreads) {
  const std::string hull = "hull " + teapot_ + " --relative 1e-4 ";
  ASSERT_EQ(run(hull + "-o one.ply --threads 1").exit_code, 0);
  ASSERT_EQ(run(hull + "-o four.ply --threads 4").exit_code, 0);
  EXPECT_EQ(content(path("one.ply")), content(path("four.ply")));
}

TEST_F(Cli, WrongUsageIsRefusedBeforeAnyWork) {
  // The model is not there: what complains about the command line did not look for it.
  const std::string hull = "hull nowhere.bpt ";
  expect_failure("", 2, "no command");
  expect_failure("stretch", 2, "no command 'stretch'");
  expect_failure("hull", 2, "INPUT");
  expect_failure(hull, 2, "-o FILE");
  expect_failure(hull + "-o a.ply --relative 1e-3 --tolerance 1", 2, "--relative");
  expect_failure(hull + "-o a.ply --relative 0", 2, "--relative");
  expect_failure(hull + "-o a.ply --relative 1e-3x", 2, "--relative");
  expect_failure(hull + "-o a.ply --tolerance -1", 2, "--tolerance");
  expect_failure(hull + "-o a.ply --tolerance nan", 2, "--tolerance");
  expect_failure(hull + "-o a.ply --tolerance inf", 2, "--tolerance");
  expect_failure(hull + "-o a.ply --resolution -1e-9", 2, "--resolution");
  expect_failure(hull + "-o a.ply --resolution 1.5", 2, "--resolution");
  expect_failure(hull + "-o a.ply --resolution nan", 2, "--resolution");
  expect_failure("info nowhere.bpt --resolution fine", 2, "--resolution");
  expect_failure(hull + "-o a.ply -o a.hull.json --method sampled", 2, "a.hull.json: ");
  expect_failure(hull + "-o - --format hull.cbor --method sampled", 2, "holds the exact hull");
  expect_failure(hull + "-o a.mlp -o a-hull.ply", 2, "a-hull.ply: is named twice");
  expect_failure(hull + "-o - --format mlp", 2, "several files");
  expect_failure(hull + "-o a.ply --method guess", 2, "--method");
  expect_failure(hull + "-o a.ply --threads -1", 2, "--threads");
  expect_failure(hull + "-o a.ply --progress loud", 2, "--progress");
  expect_failure(hull + "-o a.ply --frob", 2, "--frob");
  expect_failure(hull + "-o a.xyz", 2, ".xyz");
  expect_failure(hull + "-o a.ply -o b", 2, "no extension");
  expect_failure(hull + "-o a.bpt", 2, ".bpt");
  expect_failure(hull + "-o a.ply -o ./a.ply", 2, "twice");
  expect_failure("hull a.obj -o " + plant("a.obj", "") + "", 2, "input");
  expect_failure("support nowhere.bpt", 2, "--directions");
  expect_failure("verify a.ply", 2, "INPUT");
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(Cli, PlacesThatCannotBeWrittenAreRefusedBeforeAnyWork) {
  fs::create_directory(path("folder.ply"));
  plant("file", "");
  expect_failure("hull nowhere.bpt -o missing/a.ply", 3, "missing/a.ply: ");
  expect_failure("hull nowhere.bpt -o file/a.ply", 3, "file/a.ply: ");
  expect_failure("hull nowhere.bpt -o folder.ply", 3, "folder.ply: ");
  expect_failure("hull nowhere.bpt -o missing/a.ply --report missing/r.json", 3, "missing/a.ply: ");
}

TEST_F(Cli, FilesThatCannotBeReadAreNamed) {
  expect_failure("hull nowhere.bpt -o a.ply", 3, "nowhere.bpt: ");
  expect_failure("info nowhere.bpt", 3, "nowhere.bpt: ");
  expect_failure("verify nowhere.ply " + teapot_, 3, "nowhere.ply: ");
  expect_failure("support " + teapot_ + " --directions nowhere", 3, "nowhere: ");
  expect_failure("info " + plant("a.weird", "1"), 3, ".weird");
  expect_failure("info " + plant("words.bpt", "patches\n"), 3, "words.bpt:1: ");
}

TEST_F(Cli, NumbersThatAreNoGeometryAreRefused) {
  expect_failure("info " + plant("nan.bpt", "1\n1 1\n0 0 0\n1 0 0\n0 nan 0\n1 1 0\n"), 4,
                 "nan.bpt:5: ");
}

TEST_F(Cli, ToleranceOutOfReachExitsWithFiveAndTheBestResult) {
  const Result result = run(
      "hull " + teapot_ + " --max-vertices 500 --relative 1e-4 -o a.ply -o b.stl --report r.json");
  EXPECT_EQ(result.exit_code, 5) << result.err;
  EXPECT_TRUE(result.err.starts_with("taut: ")) << result.err;
  EXPECT_NE(result.err.find("the hull written is within"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::exists(path("a.ply")) && fs::exists(path("b.stl")));
  const Json report = Json::parse(content(path("r.json")));
  EXPECT_GT(report["mesh"]["distance_bound"], report["mesh"]["tolerance"]);
  EXPECT_EQ(report["warnings"][0]["code"], "not-converged");
  const double reached = report["mesh"]["distance_bound"];
  std::ostringstream relative;
  relative << 1.01 * reached / report["input"]["diagonal"].get<double>();
  EXPECT_EQ(run("verify a.ply " + teapot_ + " --relative " + relative.str()).exit_code, 0);
  EXPECT_EQ(run("verify a.ply " + teapot_).exit_code, 1);
}

TEST_F(Cli, LimitsThatAreNoneAreWrongUsage) {
  for (const char* wrong : {"abc", "0", "-1", "nan", "inf", "1e999", "''"}) {
    const std::string seconds = std::string("--max-seconds=") + wrong;
    expect_failure("hull " + teapot_ + " -o a.ply " + seconds, 2, "--max-seconds");
  }
  for (const char* wrong :
       {"abc", "0", "-1", "nan", "inf", "1e30", "G", "2X", "2 G", "0.1", "''"}) {
    const std::string memory = std::string("'--max-memory=") + wrong + "'";
    expect_failure("hull " + teapot_ + " -o a.ply " + memory, 2, "--max-memory");
  }
  EXPECT_FALSE(fs::exists(path("a.ply")));
}

TEST_F(Cli, LimitsMetBeforeThereIsAHullExitWithSixAndNothing) {
  const std::string points = plant("points.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n");
  for (const std::string& input : {teapot_, points}) {
    const std::string hull = "hull " + input + " -o a.ply --report r.json ";
    expect_failure(hull + "--max-seconds 1e-9", 6, "the limit of 1e-09 s was met before");
    expect_failure(hull + "--max-memory 1.5K", 6,
                   "the limit of 1536 bytes of memory was met before");
    expect_failure(hull + "--method sampled --max-memory 1m", 6, "1 MiB of memory was met before");
    EXPECT_FALSE(fs::exists(path("a.ply")) || fs::exists(path("r.json"))) << input;
  }
}

/// More vertices than there is room for.
TEST_F(Cli, LimitsMetLaterExitWithSixAndTheBestHull) {
  const std::string hull = "hull " + teapot_ + " -o a.ply --report r.json ";
  ASSERT_EQ(run(hull + "--relative 1e-2").exit_code, 0);
  const double taken = Json::parse(content(path("r.json")))["peak_bytes"];
  std::ostringstream limit;
  limit << "-o a.hull.json --relative 1e-7 --max-memory " << std::lround(taken) + (1L << 25);
  const Result result = run(hull + limit.str());
  EXPECT_EQ(result.exit_code, 6) << result.err;
  EXPECT_TRUE(result.err.starts_with("taut: the limit of ")) << result.err;
  EXPECT_NE(result.err.find("of memory was met: the hull written is within "), std::string::npos)
      << result.err;
  EXPECT_TRUE(fs::remove(path("a.hull.json")));
  const Json report = Json::parse(content(path("r.json")));
  EXPECT_EQ(report["warnings"][0]["code"], "limit-met");
  EXPECT_EQ(report["hull"]["unresolved"], 0);
  const double reached = report["mesh"]["distance_bound"];
  EXPECT_GT(reached, report["mesh"]["tolerance"]);
  std::ostringstream relative;
  relative << 1.01 * reached / report["input"]["diagonal"].get<double>();
  EXPECT_EQ(run("verify a.ply " + teapot_ + " --relative " + relative.str()).exit_code, 0);
  // What is measured is a body within that distance.
  const double accuracy = report["hull"]["measures_accuracy"];
  const Json best = Json::parse(run("hull " + teapot_ + " --json").out)["hull"];
  for (const char* measure : {"volume", "area", "mean_width"}) {
    const double whole = best[measure];
    EXPECT_NEAR(report["hull"][measure], whole, accuracy * whole) << measure;
  }
}

TEST_F(Cli, CagesKnownToLessThanTheToleranceExitWithFiveToo) {
  const std::string cube = plant("cube.obj",
                                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\n"
                                 "v 0 1 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n"
                                 "f 4 1 5 8\n");
  const std::string hull = "hull " + cube + " --scheme catmark -o a.ply --report r.json ";
  struct Case {
    std::string accuracy;
    int exit_code;
    bool is_missed;  // the tolerance
  };
  // 3.4e-5 is within the tolerance, but not within the coarsest resolution that is not asked for.
  for (const auto& [accuracy, exit_code, is_missed] :
       {Case{"1e-2", 5, true}, Case{"1e-3", 5, true}, Case{"1e-4", 5, false},
        Case{"1e-4 --resolution 1e-4", 0, false}, Case{"1e-5", 0, false}, Case{"1e-9", 0, false}}) {
    const Result result = run(hull + "--relative 1e-4 --cage-accuracy " + accuracy);
    EXPECT_EQ(result.exit_code, exit_code) << accuracy << result.err;
    const Json report = Json::parse(content(path("r.json")));
    const Json& mesh = report["mesh"];
    EXPECT_EQ(mesh["distance_bound"] > mesh["tolerance"], is_missed) << accuracy;
    EXPECT_EQ(report["warnings"].empty(), exit_code == 0) << accuracy;
  }
}

TEST_F(Cli, MemoryLimitExitsWithSix) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the address sanitizer needs more address space";
#endif
  {
    std::ofstream directions(path("many"), std::ios::binary);
    for (int i = 0; i < 4'000'000; ++i) directions << "0 0 1\n";
  }
  const Result result = run("support " + teapot_ + " --directions many", "ulimit -v 131072 &&");
  EXPECT_EQ(result.exit_code, 6);
  EXPECT_EQ(result.err, "taut: out of memory\n");
  EXPECT_EQ(result.out, "");
}

TEST_F(Cli, InfoCounts) {
  const Result text = run("info " + teapot_);
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_NE(text.out.find("3x3: 32"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("rational  no"), std::string::npos) << text.out;
  const Json info = Json::parse(run("info --json " + teapot_ + " " + teapot_).out);
  ASSERT_EQ(info["files"].size(), 2U);
  EXPECT_EQ(info["files"][0]["faces"], 32);
  EXPECT_EQ(info["files"][0]["degrees"], Json::parse(R"([{"degree": [3, 3], "patches": 32}])"));
  EXPECT_EQ(info["files"][0]["rational"], false);
  EXPECT_EQ(info["input"]["faces"], 64);
  EXPECT_EQ(info["input"]["box"], info["files"][0]["box"]);
}

/// A bilinear patch of this size whose coordinates have six decimals.
std::string rounded_patch(double size) {
  const auto corner = [&](double x, double y, double z) {
    std::array<char, 80> line;
    std::snprintf(line.data(), line.size(), "%.6f %.6f %.6f\n", size * x, size * y, size * z);
    return std::string(line.data());
  };
  return "1\n1 1\n" + corner(0.1234567, 0.7654321, 0.3) + corner(1.1928374, 0.8172635, 0.4192837) +
         corner(0.2718281, 1.8182845, 0.5904523) + corner(1.3141592, 1.9535897, 0.6932384);
}

/// A box turned and rounded to six decimals: its sides are not quite flat.
std::string rounded_box() {
  const double c = std::cos(0.7), s = std::sin(0.7), d = std::cos(0.4), e = std::sin(0.4);
  const auto corner = [&](double x, double y, double z) {
    std::array<char, 80> line;
    std::snprintf(line.data(), line.size(), "%.6f %.6f %.6f\n", c * x - s * y,
                  d * (s * x + c * y) - e * z, e * (s * x + c * y) + d * z);
    return std::string(line.data());
  };
  std::string text = "6\n";
  for (const double side : {0.0, 1.0}) {
    const std::string across[] = {
        corner(3 * side, 0, 0) + corner(3 * side, 2, 0) + corner(3 * side, 0, 1) +
            corner(3 * side, 2, 1),
        corner(0, 2 * side, 0) + corner(3, 2 * side, 0) + corner(0, 2 * side, 1) +
            corner(3, 2 * side, 1),
        corner(0, 0, side) + corner(3, 0, side) + corner(0, 2, side) + corner(3, 2, side)};
    for (const std::string& points : across) text += "1 1\n" + points;
  }
  return text;
}

/// In the summary, the report, the document and the project; and verify holds faces to it.
TEST_F(Cli, TolerantFacesAreTold) {
  const std::string box = plant("box.bpt", rounded_box());
  const Result result = run("hull " + box + " -o b.hull.json -o b.mlp --report r.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find(" faces off by up to "), std::string::npos) << result.out;
  EXPECT_NE(content(path("b.mlp")).find("b-tolerant.ply"), std::string::npos);
  Json hull = Json::parse(content(path("b.hull.json")));
  int tolerant = 0;
  double bound = 0;
  for (const Json& face : hull["faces"]) {
    tolerant += face.contains("tolerant") ? 1 : 0;
    bound = std::max(bound, face.value("tolerant", 0.0));
  }
  EXPECT_GT(tolerant, 0);
  EXPECT_LT(bound, 4e-6);
  const Json report = Json::parse(content(path("r.json")))["hull"];
  EXPECT_EQ(report["tolerant"], tolerant);
  EXPECT_EQ(report["tolerant_bound"].get<double>(), bound);

  EXPECT_EQ(run("verify b.hull.json " + box).exit_code, 0) << run("verify b.hull.json " + box).out;
  for (Json& face : hull["faces"]) {
    if (face.contains("tolerant")) face["tolerant"] = 0.5 * face["tolerant"].get<double>();
  }
  hull["report"] = Json::object();
  plant("half.hull.json", hull.dump());
  const Result half = run("verify half.hull.json " + box);
  EXPECT_EQ(half.exit_code, 1);
  EXPECT_NE(half.err.find("not flat"), std::string::npos) << half.out << half.err;
}

TEST_F(Cli, InfoTellsTheResolution) {
  const Result clean = run("info " + teapot_);
  EXPECT_NE(clean.out.find("1e-08 of the diagonal"), std::string::npos) << clean.out;
  EXPECT_NE(clean.out.find("worst join  "), std::string::npos) << clean.out;
  const std::string patch = plant("patch.bpt", rounded_patch(1));
  const Result text = run("info " + patch);
  EXPECT_EQ(text.err, "");
  EXPECT_NE(text.out.find("resolution  2e-06: coordinates have 6 decimals"), std::string::npos)
      << text.out;
  const Json file = Json::parse(run("info --json " + patch).out)["files"][0];
  EXPECT_DOUBLE_EQ(file["resolution"].get<double>(), 2e-6);
  EXPECT_EQ(file["resolution_source"], "coordinates");
  EXPECT_EQ(file["worst_join"], 0);
  EXPECT_EQ(file["grid"], Json::parse(R"({"kind": "decimals", "decimals": 6, "step": 1e-6})"));
  const Json asked = Json::parse(run("info --json --resolution 1e-3 " + patch).out)["files"][0];
  EXPECT_DOUBLE_EQ(asked["resolution"].get<double>(), 1e-3 * asked["diagonal"].get<double>());
  EXPECT_EQ(asked["resolution_source"], "option");
}

TEST_F(Cli, CoarseResolutionIsCappedWithAWarning) {
  const std::string patch = plant("patch.bpt", rounded_patch(0.01));
  const Result result = run("hull " + patch + " --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = Json::parse(result.out);
  EXPECT_DOUBLE_EQ(report["hull"]["resolution"].get<double>(),
                   1e-5 * report["input"]["diagonal"].get<double>());
  ASSERT_EQ(report["warnings"].size(), 1U);
  EXPECT_EQ(report["warnings"][0]["code"], "coarse-resolution");
  EXPECT_NE(result.err.find("--resolution"), std::string::npos) << result.err;
  const Json fine = Json::parse(run("hull " + patch + " --json --resolution 0").out);
  EXPECT_EQ(fine["hull"]["resolution_source"], "option");
  EXPECT_LT(fine["hull"]["resolution"].get<double>(), 1e-15);
  EXPECT_EQ(fine["warnings"].size(), 0U);
}

TEST_F(Cli, SupportAnswersEachDirection) {
  plant("directions", "# up, down\n0 0 2\n\n  0 0 -1e-3  # down\r\n+1 1e0 1");
  const Result result = run("support " + teapot_ + " --directions directions");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::vector<std::array<std::string, 7>> answers;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::array<std::string, 7> fields;
    for (std::string& field : fields) words >> field;
    std::string more;
    EXPECT_FALSE(words >> more) << line;
    answers.push_back(fields);
  }
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0][0], "3.1499999999999999");  // of 17 digits
  EXPECT_EQ(std::stod(answers[1][0]), 0);
  const double h =
      (std::stod(answers[2][1]) + std::stod(answers[2][2]) + std::stod(answers[2][3])) /
      std::sqrt(3.0);
  EXPECT_NEAR(std::stod(answers[2][0]), h, 1e-14);

  EXPECT_EQ(run("support " + teapot_ + " --directions -", "cat directions |").out, result.out);
  const Json json = Json::parse(run("support --json " + teapot_ + " --directions directions").out);
  ASSERT_EQ(json["support"].size(), 3U);
  EXPECT_EQ(json["support"][0]["h"], 3.15);
  EXPECT_GE(json["queries"]["support"], 3);
  EXPECT_TRUE(json["seconds"].contains("support"));
}

/// The lines of taut contains.
std::vector<std::pair<std::string, double>> locations(const std::string& text) {
  std::istringstream lines(text);
  std::vector<std::pair<std::string, double>> answers;
  std::string location;
  for (double distance = 0; lines >> location >> distance;) {
    answers.emplace_back(location, distance);
  }
  return answers;
}

TEST_F(Cli, ContainsAnswersEachPoint) {
  plant("points", "# in, out\n0 0 1\n\n  0 0 3.65  # above\r\n0 0 3.15");
  const Result result = run("contains " + teapot_ + " --points points");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto answers = locations(result.out);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0].first, "inside");
  EXPECT_NEAR(answers[0].second, -1, 1e-11);
  EXPECT_EQ(answers[1].first, "outside");
  EXPECT_NEAR(answers[1].second, 0.5, 1e-11);
  EXPECT_EQ(answers[2].first, "on");
  EXPECT_NEAR(answers[2].second, 0, 1e-12);
  EXPECT_EQ(run("contains " + teapot_ + " --points -", "cat points |").out, result.out);
  EXPECT_EQ(run("contains " + teapot_ + " --points points --threads 1").out, result.out);
  EXPECT_EQ(run("contains " + teapot_ + " --points points --on-tolerance 0.6").out.find("outside"),
            std::string::npos);

  const Json json = Json::parse(run("contains --json " + teapot_ + " --points points").out);
  ASSERT_EQ(json["points"].size(), 3U);
  EXPECT_EQ(json["points"][1]["location"], "outside");
  EXPECT_LE(json["points"][1]["distance_bounds"][0], json["points"][1]["distance"]);
  EXPECT_EQ(json["of"], "hull");
  EXPECT_EQ(json["inside"], 1);
  EXPECT_EQ(json["on"], 1);
  EXPECT_EQ(json["outside"], 1);
  EXPECT_GE(json["queries"]["support"], 3);
  EXPECT_TRUE(json["seconds"].contains("contains"));
}

TEST_F(Cli, ContainsOfAModelNeedsAClosedOne) {
  const std::string torus = TAUT_DATA "/torus.taut.json";
  const std::string points = plant("p", "2 0 0\n0 0 0\n2.5 0 0\n");
  const auto of_hull = locations(run("contains " + torus + " --points p").out);
  const auto of_model = locations(run("contains " + torus + " --of model --points p").out);
  ASSERT_EQ(of_hull.size(), 3U);
  ASSERT_EQ(of_model.size(), 3U);
  EXPECT_EQ(of_hull[1].first, "inside");
  EXPECT_NEAR(of_hull[1].second, -0.5, 1e-11);
  EXPECT_EQ(of_model[0].first, "inside");
  EXPECT_NEAR(of_model[0].second, -0.5, 1e-11);
  EXPECT_EQ(of_model[1].first, "outside");
  EXPECT_NEAR(of_model[1].second, 1.5, 1e-11);
  EXPECT_EQ(of_model[2].first, "on");
  expect_failure("contains " + teapot_ + " --of model --points p", 4, "not closed");
  expect_failure("contains " + teapot_ + " --of surface --points p", 2, "surface");
  expect_failure("contains " + teapot_, 2, "--points");
  expect_failure("contains " + teapot_ + " --points p --on-tolerance 0", 2, "on-tolerance");
  expect_failure("contains " + teapot_ + " --points nowhere", 3, "nowhere: ");
  expect_failure("contains " + teapot_ + " --points " + plant("b", "0 0 0\n1 2\n"), 3, "b:2: ");
  expect_failure("contains " + teapot_ + " --points " + plant("i", "0 0 inf\n"), 4, "i:1: ");
  expect_failure("contains - --points - --format off <" + plant("c.off", "OFF\n"), 2, "both");
}

TEST_F(Cli, VerifyAsksWhetherPointsAreContained) {
  ASSERT_EQ(run("hull " + teapot_ + " -o hull.ply -o hull.hull.json --relative 1e-3").exit_code, 0);
  const Json good = Json::parse(run("verify --json hull.ply --relative 1e-3 " + teapot_).out);
  EXPECT_EQ(good["vertices_in_hull"], true);
  EXPECT_LT(good["vertices_outside"], 1e-12);
  EXPECT_EQ(good["model_points_in_mesh"], true);
  EXPECT_GT(good["model_points_outside"], 1e-5);
  EXPECT_LT(good["model_points_outside"], 1e-3);
  const Json exact = Json::parse(run("verify --json hull.hull.json " + teapot_).out);
  EXPECT_EQ(exact["points_on_hull"], true);
  EXPECT_LT(exact["points_off_hull"], 1e-12);

  // A vertex that is moved out by a hundredth, and a mesh that is too small by as much.
  taut::PolygonMesh mesh = taut::read_mesh(path("hull.ply"));
  const taut::PolygonMesh whole = mesh;
  mesh.points[0] *= 1.05;
  plant("out.off", off_text(mesh));
  const Json out = Json::parse(run("verify --json out.off " + teapot_).out);
  EXPECT_EQ(out["vertices_in_hull"], false);
  EXPECT_GT(out["vertices_outside"], 1e-3);
  mesh = whole;
  for (taut::dvec3& p : mesh.points) p *= 0.98;
  plant("small.off", off_text(mesh));
  const Json small = Json::parse(run("verify --json small.off " + teapot_).out);
  EXPECT_EQ(small["model_points_in_mesh"], false);
  EXPECT_GT(small["model_points_outside"], 1e-3);
}

TEST_F(Cli, DirectionsErrorsNameTheLine) {
  const std::string support = "support " + teapot_ + " --directions ";
  expect_failure(support + plant("a", "1 0 0\n1 0\n"), 3, "a:2: ");
  expect_failure(support + plant("b", "# x\n\n1 0 0 0\n"), 3, "b:3: ");
  expect_failure(support + plant("c", "1 0 zero\n"), 3, "c:1: ");
  expect_failure(support + plant("d", "1 0 0\n0 0 -0\n"), 4, "d:2: ");
  expect_failure(support + plant("e", "1 nan 0"), 4, "e:1: ");
  expect_failure(support + plant("f", "1 0 0\r\n1e999 0 0\r\n"), 4, "f:2: ");
  expect_failure(support + plant("g", std::string(100000, ' ')), 3, "g:1: ");
  expect_failure(support + folder_.string(), 3, folder_.string() + ": ");
}

TEST_F(Cli, VerifyFindsDamage) {
  ASSERT_EQ(run("hull " + teapot_ + " -o hull.ply -q").exit_code, 0);
  const Result good = run("verify hull.ply " + teapot_);
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_EQ(good.out.find(" no"), std::string::npos) << good.out;
  const Json report = Json::parse(run("verify --json hull.ply " + teapot_).out);
  for (const char* key : {"is_hull", "closed", "manifold", "oriented", "convex", "no_zero_area"}) {
    EXPECT_EQ(report[key], true) << key;
  }
  EXPECT_LE(report["model_outside"], 1e-4);

  const taut::PolygonMesh hull = taut::read_mesh(path("hull.ply"));
  const auto verify_damaged = [&](const taut::PolygonMesh& mesh) {
    plant("damaged.off", off_text(mesh));
    const Result result = run("verify --json damaged.off " + teapot_);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_NE(result.err.find("taut: damaged.off: "), std::string::npos) << result.err;
    Json json = Json::parse(result.out);
    EXPECT_EQ(json["is_hull"], false);
    return json;
  };
  taut::PolygonMesh flipped = hull;
  std::reverse(flipped.polygons[7].begin(), flipped.polygons[7].end());
  EXPECT_EQ(verify_damaged(flipped)["oriented"], false);
  taut::PolygonMesh dented = hull;
  dented.points[20] += 1e-3 * 8.2 * glm::normalize(taut::dvec3(0.2, 0, 1.5) - dented.points[20]);
  EXPECT_EQ(verify_damaged(dented)["convex"], false);
  taut::PolygonMesh open = hull;
  open.polygons.pop_back();
  EXPECT_EQ(verify_damaged(open)["closed"], false);
  // A smaller copy is convex and lacks nothing but size.
  taut::PolygonMesh small = hull;
  for (taut::dvec3& p : small.points) p *= 0.5;
  const Json json = verify_damaged(small);
  EXPECT_EQ(json["convex"], true);
  EXPECT_EQ(json["contains_model"], false);
  EXPECT_GT(json["model_outside"], 0.1);
}

TEST_F(Cli, ExactHullsAsDocumentsAndProjects) {
  const std::string cube = plant("cube.off", R"(OFF 8 1 0
0 0 0  2 0 0  2 2 0  0 2 0  0 0 2  2 0 2  2 2 2  0 2 2
4 0 3 2 1
)");
  const Result result =
      run("hull " + cube + " -o c.hull.json -o c.hull.cbor -o c.mlp --report r.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("solid: 0 patches, 0 scrolls, 6 facets, 12 curves\n"),
            std::string::npos)
      << result.out;
  EXPECT_EQ(file_count(), 8U);
  const Json report = Json::parse(content(path("r.json")));
  EXPECT_EQ(report["hull"]["facets"], 6);
  EXPECT_EQ(report["hull"]["unresolved"], 0);
  EXPECT_EQ(report["hull"]["volume"], 8);
  EXPECT_NEAR(report["hull"]["mean_width"], 3, 1e-14);
  const Json hull = Json::parse(content(path("c.hull.json")));
  EXPECT_EQ(hull["format"], "taut-hull");
  EXPECT_EQ(hull["faces"].size(), 6U);
  EXPECT_EQ(hull["curves"].size(), 12U);
  EXPECT_EQ(hull["sources"][0]["file"], "cube.off");
  EXPECT_EQ(hull["report"]["method"], "precise");
  EXPECT_EQ(hull["report"]["hull"], report["hull"]);
  EXPECT_EQ(Json::from_cbor(content(path("c.hull.cbor")))["faces"], hull["faces"]);
  EXPECT_EQ(Json::parse(run("hull " + cube + " -o - --format hull.json").out)["faces"],
            hull["faces"]);
  EXPECT_EQ(run("verify c-hull.ply " + cube).exit_code, 0);
  EXPECT_EQ(run("info c.mlp").exit_code, 0);
  EXPECT_EQ(run("hull " + teapot_ + " -o t.mlp --relative 1e-2 -q").exit_code, 0);
  EXPECT_TRUE(fs::exists(path("t-model.ply")));
}

TEST_F(Cli, VerifyReadsExactHulls) {
  const std::string points = plant("p.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n");
  ASSERT_EQ(run("hull " + points + " -o h.hull.json -o h.hull.cbor -q").exit_code, 0);
  const Result good = run("verify h.hull.json " + points + " --relative 1e-14");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_EQ(good.out.find(" no"), std::string::npos) << good.out;
  EXPECT_EQ(run("verify - " + points + " --format hull.cbor <h.hull.cbor").exit_code, 0);
  const Json report = Json::parse(run("verify --json h.hull.cbor " + points).out);
  for (const char* key : {"is_hull", "complete", "closed", "topological_sphere", "covered"}) {
    EXPECT_EQ(report[key], true) << key;
  }
  EXPECT_EQ(report["euler"], 2);
  EXPECT_LE(report["model_outside"], 1e-15);

  Json hull = Json::parse(content(path("h.hull.json")));
  hull["curves"][2]["faces"][0] = -1;
  plant("open.hull.json", hull.dump());
  const Result open = run("verify open.hull.json " + points);
  EXPECT_EQ(open.exit_code, 1);
  EXPECT_NE(open.err.find("faces are missing; not closed"), std::string::npos) << open.err;
  hull = Json::parse(content(path("h.hull.json")));
  hull["report"]["hull"]["unresolved"] = 3;
  plant("unresolved.hull.json", hull.dump());
  const Result unresolved = run("verify unresolved.hull.json " + points);
  EXPECT_EQ(unresolved.exit_code, 1);
  EXPECT_NE(unresolved.err.find("report: unresolved is 3, not 0"), std::string::npos)
      << unresolved.err;
  hull["faces"][0]["offset"] = double(hull["faces"][0]["offset"]) + 1e-9;
  plant("off.hull.json", hull.dump());
  EXPECT_EQ(run("verify off.hull.json " + points).exit_code, 1) << "an exact hull is exact";
  const std::string others = plant("q.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 2\n");
  EXPECT_EQ(run("verify h.hull.json " + others).exit_code, 1);
  const std::string others_kinds = plant("flat.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Result unlike = run("verify h.hull.json " + others_kinds);
  EXPECT_EQ(unlike.exit_code, 1);
  EXPECT_NE(unlike.out.find("width of the model          ?\n"), std::string::npos) << unlike.out;
  EXPECT_EQ(Json::parse(run("verify h.hull.json --json " + others_kinds).out)["covered"], Json());
  expect_failure("verify " + plant("bad.hull.json", "{}") + " " + points, 3, "bad.hull.json: ");
}

TEST_F(Cli, InfoConvertsToModelDocuments) {
  EXPECT_EQ(run("info " + teapot_ + " -o a.taut.json").exit_code, 0);
  EXPECT_EQ(run("info a.taut.json " + teapot_ + " -o both.taut.cbor").exit_code, 0);
  EXPECT_EQ(run("info a.taut.json -o again.taut.json").exit_code, 0);
  EXPECT_EQ(content(path("a.taut.json")), content(path("again.taut.json")));
  const Json one = Json::parse(run("info --json " + teapot_).out);
  const Json both = Json::parse(run("info --json both.taut.cbor").out);
  EXPECT_EQ(both["input"]["patches"], 64);
  EXPECT_EQ(both["input"]["edges"], 2 * one["input"]["edges"].get<int>());
  EXPECT_EQ(both["input"]["box"], one["input"]["box"]);

  expect_failure("info " + teapot_ + " -o a.json", 2, "a.json: a model is written as .taut.json");
  expect_failure("info " + teapot_ + " -o -", 2, "--to taut.json");
  expect_failure("info a.taut.json -o ./a.taut.json", 2, "is an input");
  expect_failure("info " + teapot_ + " -o none/a.taut.json", 3, "there is no folder none");
  EXPECT_EQ(file_count(), 3U);
}

TEST_F(Cli, HullsBelowDimensionThree) {
  struct Case {
    const char* points;
    int dimension;
    const char* hull;
    int vertices, edges, faces;
  };
  const Case cases[] = {{"1 2 3\n1 2 3\n", 0, "point", 1, 0, 0},
                        {"0 0 0\n1 2 3\n0.5 1 1.5\n", 1, "segment", 2, 1, 0},
                        {"0 0 1\n2 0 1\n2 2 1\n0 2 1\n1 0 1\n1 1 1\n", 2, "planar", 4, 4, 2}};
  for (const Case& c : cases) {
    const std::string name = plant("p.xyz", c.points);
    const Result result = run("hull " + name + " -o h.ply --report r.json");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find(std::string("hull      ") + c.hull), std::string::npos) << result.out;
    EXPECT_EQ(result.err, "");
    const Json report = Json::parse(content(path("r.json")));
    EXPECT_EQ(report["dimension"], c.dimension);
    EXPECT_EQ(report["mesh"]["vertices"], c.vertices);
    EXPECT_EQ(report["mesh"]["edges"], c.edges);
    EXPECT_EQ(report["mesh"]["faces"], c.faces);
    EXPECT_EQ(report["mesh"]["distance_bound"], 0);
    EXPECT_EQ(report["mesh"]["volume"], 0);
    EXPECT_EQ(run("verify h.ply " + name).exit_code, 0);
  }
  expect_failure("hull " + plant("none.xyz", "# none\n") + " -o n.ply", 4, "no geometry");
  expect_failure("hull " + plant("two.xyz", "0 0 0\n1 1 1\n") + " -o n.stl", 3, "segment");
  EXPECT_FALSE(fs::exists(path("n.ply")));
  EXPECT_FALSE(fs::exists(path("n.stl")));
}

TEST_F(Cli, StandardInputAndOutput) {
  const std::string cube = plant("cube.off", R"(OFF
8 6 0
0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
)");
  const Result hull = run("hull - -o - --format off <" + cube);
  EXPECT_EQ(hull.exit_code, 0) << hull.err;
  EXPECT_TRUE(hull.out.starts_with("OFF\n8 6 12\n")) << hull.out;
  EXPECT_EQ(run("verify - " + cube + " --format .off <" + plant("h.off", hull.out)).exit_code, 0);
  EXPECT_EQ(run("info - --format off <" + cube).exit_code, 0);
  EXPECT_NE(run("support - --format off --directions " + plant("d.txt", "1 1 1\n") + " <" + cube)
                .out.find("1.7320508075688"),
            std::string::npos);
  expect_failure("hull - -o h.ply <" + cube, 2, "--from");
  expect_failure("hull " + cube + " -o -", 2, "--to");
  expect_failure("hull " + cube + " -o - --format ply --json", 2, "standard output");
  expect_failure("hull - - -o h.ply --format off <" + cube, 2, "once");
  expect_failure("support - --directions - --format off <" + cube, 2, "both");
  expect_failure("hull - -o h.ply --format off <" + plant("bad.off", "OFF\n1\n"), 3,
                 "standard input:");
}

TEST_F(Cli, ControlCages) {
  const std::string cage = plant("sheet.obj",
                                 "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\n"
                                 "t interpolateboundary 1/0/0 1\n");
  EXPECT_NE(run("info " + cage).out.find("scheme catmark"), std::string::npos);
  EXPECT_EQ(run("info " + cage + " --scheme bilinear").out.find("catmark"), std::string::npos);
  const auto report = run("hull " + cage + " -o h.ply --json");
  EXPECT_EQ(report.exit_code, 0);
  EXPECT_NE(report.out.find("\"subdivision\""), std::string::npos);
  expect_failure("hull " + cage + " --scheme loop -o h.ply", 4, "no triangle");
}

TEST_F(Cli, CagesAndTrimmedFacesAreRefusedClearly) {
  const std::string cage = plant("cage.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  expect_failure("hull " + cage + " --scheme cubic -o h.ply", 2, "cubic");
  EXPECT_EQ(run("hull " + cage + " --scheme bilinear -o h.ply").exit_code, 0);
  const std::string trimmed = plant("trimmed.obj", R"(v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 1
vp 0.2 0.2
vp 0.8 0.2
vp 0.5 0.8
vp 0.2 0.2
cstype bspline
deg 1
curv2 1 2 3 4
parm u 0 0 1 2 3 3
end
cstype bezier
deg 1 1
surf 0 1 0 1 1 2 3 4
parm u 0 1
parm v 0 1
trim 0 3 1
end
)");
  expect_failure("hull " + trimmed + " -o t.ply", 4, "is trimmed");
  const Result info = run("info " + trimmed + " --json");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  const Json json = Json::parse(info.out);
  EXPECT_EQ(json["files"][0]["trimmed"], 1);
  EXPECT_TRUE(json["files"][0]["box"].is_null());
  EXPECT_EQ(run("info " + trimmed + " -o t.taut.json").exit_code, 0);
  expect_failure("hull t.taut.json -o t.ply", 4, "is trimmed");
}

TEST_F(Cli, StlReportsItsRounding) {
  ASSERT_EQ(run("hull " + teapot_ + " -o h.stl -o h.ply --report r.json").exit_code, 0);
  const Json files = Json::parse(content(path("r.json")))["mesh"]["files"];
  EXPECT_EQ(files[0]["file"], "h.stl");
  EXPECT_GT(files[0]["rounding"], 1e-8);
  EXPECT_LT(files[0]["rounding"], 1e-6);
  EXPECT_EQ(files[1]["rounding"], 0);
  // Far from the origin floats lose more than was asked for.
  const std::string far = plant("far.xyz", "1e6 0 0.1\n1e6 1 0\n1000001 0 0\n1000000.3 0 1\n");
  const Result result = run("hull " + far + " -o far.stl --tolerance 1e-6");
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_NE(result.err.find("far.stl holds floats"), std::string::npos) << result.err;
}

TEST_F(Cli, PluginsListsFormats) {
  const Result text = run("plugins");
  EXPECT_EQ(text.exit_code, 0);
  const Json json = Json::parse(run("plugins --json").out);
  for (const Json& format : json["formats"]) {
    EXPECT_NE(text.out.find(format["extension"].get<std::string>()), std::string::npos);
  }
  EXPECT_GE(json["formats"].size(), 5U);
}

TEST_F(Cli, FullDeviceIsAnError) {
  EXPECT_EQ(run("info " + teapot_ + " >/dev/full").exit_code, 3);
  EXPECT_EQ(run("hull " + teapot_ + " --relative 1e-2 --report /dev/full").exit_code, 3);
}

/// Starts taut, sends the signal once it has said `word` on stderr, and returns the exit code. Its
/// standard input stays open and silent.
int exit_code_after_signal(int signal, std::vector<std::string> arguments,
                           const std::string& word) {
  std::array<int, 2> input, errors;
  if (pipe(input.data()) != 0 || pipe(errors.data()) != 0) return -1;
  std::string program = TAUT_EXECUTABLE;
  std::vector<char*> argv = {program.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    dup2(input[0], STDIN_FILENO);
    dup2(errors[1], STDERR_FILENO);
    for (const int end : {input[0], input[1], errors[0], errors[1]}) close(end);
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  close(input[0]);
  close(errors[1]);
  std::string seen;
  std::array<char, 256> buffer;
  bool sent = false;
  for (ssize_t count = 0; (count = read(errors[0], buffer.data(), buffer.size())) > 0;) {
    seen.append(buffer.data(), static_cast<std::size_t>(count));
    if (!sent && seen.find(word) != std::string::npos) sent = kill(child, signal) == 0;
  }
  int status = 0;
  waitpid(child, &status, 0);
  close(input[1]);
  close(errors[0]);
  EXPECT_TRUE(sent) << seen;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST_F(Cli, InterruptLeavesNothing) {
  const std::vector<std::string> hull = {
      "hull", teapot_, "-o", path("a.ply").string(), "--relative", "1e-6", "--progress", "plain"};
  EXPECT_EQ(exit_code_after_signal(SIGINT, hull, "sample"), 130);
  EXPECT_EQ(exit_code_after_signal(SIGTERM, hull, "sample"), 143);
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(Cli, InterruptEndsWaitingForInput) {
  const std::vector<std::string> support = {"support", teapot_, "--directions", "-", "-v"};
  EXPECT_EQ(exit_code_after_signal(SIGINT, support, "standard input"), 130);
}

}  // namespace
