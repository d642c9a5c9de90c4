// Several outputs of one run: what can be written is, what cannot is told.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "command_folder.h"

namespace {

namespace fs = std::filesystem;
using taut_test::Result;

class Outputs : public taut_test::CommandFolder {
 protected:
  const std::string arc_ =
      "v 0 0 0\nv 1 2 0\nv 2 0 0\ncstype bezier\ndeg 2\ncurv 0 1 1 2 3\nparm u 0 1\nend\n";
  const std::string point_ = "0 0 0\n";
};

TEST_F(Outputs, ThatHaveNoPlaceDoNotKeepOthersBack) {
  const Result result =
      run("hull " + teapot_ +
          " --relative 1e-2 -o missing/a.ply -o b.ply -o /proc/c.ply --report r.json");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(
      result.err.rfind("taut: missing/a.ply: cannot be written: there is no folder missing\n", 0),
      0U)
      << result.err;
  EXPECT_NE(result.err.find("\ntaut: /proc/c.ply: cannot be written: "), std::string::npos)
      << result.err;
  EXPECT_EQ(result.err.find("No such file"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("wrote     b.ply\nwrote     r.json\n"), std::string::npos)
      << result.out;
  EXPECT_TRUE(fs::exists(path("b.ply")));
  const auto report = nlohmann::json::parse(taut_test::content(path("r.json")));
  EXPECT_EQ(report["mesh"]["files"].size(), 1U);
  EXPECT_EQ(report["warnings"].size(), 2U);
  EXPECT_EQ(report["warnings"][0]["code"], "not-written");
}

TEST_F(Outputs, ThatTheHullCannotFillDoNotKeepOthersBack) {
  const Result result = run("hull " + plant("p.xyz", point_) + " -o a.stl -o a.ply");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("a.stl"), std::string::npos) << result.err;
  EXPECT_TRUE(fs::exists(path("a.ply")) && !fs::exists(path("a.stl")));
}

TEST_F(Outputs, OfASegmentOfCurvesTellItsCountsAndMeasures) {
  const std::string line =
      plant("line.obj", "v 0 0 0\nv 1 2 2\ncstype bezier\ndeg 1\ncurv 0 1 1 2\nparm u 0 1\nend\n");
  const Result result = run("hull " + line + " -o s.hull.json --report r.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json hull = nlohmann::json::parse(taut_test::content(path("r.json")))["hull"];
  EXPECT_EQ(hull["facets"], 0);
  EXPECT_EQ(hull["curves"], 1);
  EXPECT_EQ(hull["area"], 0.0);
  EXPECT_NEAR(hull["mean_width"], 1.5, 1e-11);
  EXPECT_LE(hull["measures_accuracy"], 1e-11);
  EXPECT_EQ(run("verify s.hull.json " + line).exit_code, 0);
}

TEST_F(Outputs, ExitWithTheCodeOfTheWorst) {
  const Result result =
      run("hull " + teapot_ + " --max-vertices 60 --relative 1e-6 -o a.ply -o missing/b.ply");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.err.find("taut: missing/b.ply"), result.err.rfind("taut: ")) << result.err;
  EXPECT_NE(result.err.find(" was not reached with 60 vertices"), std::string::npos) << result.err;
}

TEST_F(Outputs, OfABudgetTellWhatWasAskedForAndWhatIsWritten) {
  for (const char* method : {"precise", "sampled", "envelope"}) {
    const Result result = run("hull " + teapot_ + " --method " + method +
                              " --max-vertices 60 --tolerance 2e-5 -o a.ply");
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_NE(result.err.find("the tolerance was not reached with 60 vertices: the hull written "
                              "is within 0."),
              std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find(" of the true one, 2e-05 was asked for"), std::string::npos)
        << result.err;
  }
}

TEST_F(Outputs, NameTheLayersOfAProject) {
  const Result result = run("hull " + teapot_ + " --relative 1e-2 -o t.mlp");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* name : {"t-hull.ply", "t-curves.ply", "t-model.ply", "t.mlp"}) {
    EXPECT_NE(result.out.find(std::string("wrote     ") + name + "\n"), std::string::npos)
        << result.out;
    EXPECT_TRUE(fs::exists(path(name))) << name;
  }
  EXPECT_EQ(result.out.find("t-tolerant.ply"), std::string::npos);
}

TEST_F(Outputs, OfModelsAreTold) {
  const std::string line = plant("line.xyz", "0 0 0\n1 0 0\n");
  const Result told = run("info " + line + " -o line.taut.json");
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_TRUE(told.out.ends_with("\nwrote line.taut.json\n")) << told.out;
  EXPECT_EQ(told.err, "");
  EXPECT_EQ(run("info " + line + " -o line.taut.json --quiet").out.find("wrote"),
            std::string::npos);
}

TEST_F(Outputs, StlKeepsTheToleranceAndPassesVerify) {
  // A sphere's octant far from the origin: floats there take a share of the tolerance.
  const std::string patch = plant(
      "far.bpt",
      "1\n2 2\n1000 0 0\n1000 5 0\n1000 10 0\n1005 0 4\n1005 5 6\n1005 10 4\n1010 0 0\n1010 5 0\n"
      "1010 10 0\n");
  const Result hull = run("hull " + patch + " -o h.stl --relative 2e-5 --json");
  ASSERT_EQ(hull.exit_code, 0) << hull.err;
  const auto mesh = nlohmann::json::parse(hull.out)["mesh"];
  EXPECT_LE(mesh["distance_bound"].get<double>() + mesh["files"][0]["rounding"].get<double>(),
            mesh["tolerance"].get<double>());
  const Result verified = run("verify h.stl " + patch + " --relative 2e-5");
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  EXPECT_NE(verified.out.find("the file holds floats"), std::string::npos);
  // Less than floats can hold.
  const Result fine = run("hull " + patch + " -o h.stl --relative 1e-6");
  EXPECT_EQ(fine.exit_code, 5);
  EXPECT_NE(fine.err.find("h.stl holds floats, which move vertices"), std::string::npos)
      << fine.err;
}

}  // namespace
