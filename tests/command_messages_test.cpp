// What the command says, in the words that its users have.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "command_folder.h"

namespace {

using taut_test::Result;

class Messages : public taut_test::CommandFolder {
 protected:
  void expect_said(const std::string& text, const std::string& words) const {
    EXPECT_NE(text.find(words), std::string::npos) << words << "\nis not in\n" << text;
  }
};

const std::string tetrahedron_points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string two_curves =
    "v 0 0 0\nv 1 2 0\nv 2 0 0\nv 0 0 3\nv 1 2 3\nv 2 0 4\ncstype bezier\ndeg 2\n"
    "curv 0 1 1 2 3\nparm u 0 1\nend\ncurv 0 1 4 5 6\nparm u 0 1\nend\n";

TEST_F(Messages, SayWhatWasRead) {
  const Result points = run("hull " + plant("p.xyz", tetrahedron_points) + " -o h.ply");
  expect_said(points.out, "\n          4 points, diagonal ");
  expect_said(points.out, "\nmesh      4 faces, 4 vertices\n");
  const Result curves = run("hull " + plant("c.obj", two_curves) + " -o h.ply --relative 1e-2");
  expect_said(curves.out, "\n          2 curves, diagonal ");
  expect_said(curves.out, "vertices, method precise\n");
  const Result faces = run("hull " + teapot_ + " -o h.ply --relative 1e-2 --method sampled");
  expect_said(faces.out, "\n          32 faces, 32 patches, diagonal ");
  expect_said(faces.out, "vertices, method sampled\n");
}

TEST_F(Messages, SayHowFarAHullIsOff) {
  const std::string model = plant("p.xyz", tetrahedron_points);
  ASSERT_EQ(run("hull " + model + " -o h.ply").exit_code, 0);
  const Result same = run("verify h.ply " + model);
  expect_said(same.out, "contains the model          yes  to within ");
  const Result other = run("verify h.ply " + plant("q.xyz", "0 0 0\n3 0 0\n0 1 0\n0 0 1\n"));
  EXPECT_EQ(other.exit_code, 1);
  expect_said(other.out, "contains the model          no   off by 0.6");
  expect_said(other.err,
              "taut: h.ply: is not the convex hull of the model within 0.0001 of its diagonal: the "
              "model reaches out of the mesh by 0.6");
  const Result smaller = run("verify h.ply " + plant("r.xyz", "0 0 0\n.5 0 0\n0 1 0\n0 0 1\n"));
  expect_said(smaller.err, "the mesh reaches out of the model's hull by 0.3");
}

TEST_F(Messages, NameTheOpenSideOfAFace) {
  const Result result =
      run("contains " + teapot_ + " --points " + plant("p", "0 0 1\n") + " --of model");
  EXPECT_EQ(result.exit_code, 4);
  expect_said(result.err, "the first: face 0 (\"patch 1\"), side ");
}

TEST_F(Messages, NameAWayForFormatsThatAreNotRead) {
  std::filesystem::create_directory(path("folder"));
  expect_failure("info folder", 3, "folder: is a folder; name a file in it");
  expect_failure("info " + plant("a", "1"), 3, "a: its name has no extension");
  for (const char* name : {"a.step", "a.STP", "a.iges", "a.brep"}) {
    expect_failure("hull " + plant(name, "1") + " -o h.ply", 3, "are read by the plugin occt");
  }
  expect_failure("info " + plant("a.itd", "1"), 3, "are read by the plugin irit");
}

TEST_F(Messages, CountWords) {
  const std::string support = "support " + teapot_ + " --directions ";
  expect_failure(support + plant("a", "1\n"), 3,
                 "a:1: a direction has three numbers, found 1 word\n");
  expect_failure(support + plant("b", "1 2 3 4\n"), 3, "found 4 words\n");
}

TEST_F(Messages, AreaOfFlatHullsIsThatOfOneSide) {
  const std::string square = plant("s.xyz", "0 0 0\n3 0 0\n3 3 0\n0 3 0\n");
  const Result result = run("hull " + square + " -o h.ply --report r.json");
  expect_said(result.out, "\narea      9, one side\n");
  EXPECT_EQ(result.out.find("volume"), std::string::npos) << result.out;
  const auto report = nlohmann::json::parse(taut_test::content(path("r.json")));
  for (const char* of : {"hull", "mesh"}) {
    EXPECT_DOUBLE_EQ(report[of]["area"].get<double>(), 9) << of;
    EXPECT_DOUBLE_EQ(report[of]["area_of_both_sides"].get<double>(), 18) << of;
  }
}

TEST_F(Messages, PointsThatAreLeftOutAreCounted) {
  const std::string thin =
      plant("thin.xyz",
            "-0.7131742512670298 -3.635254037844387 0\n-2.445225058835907 -2.635254037844385 0\n"
            "4.286825748732971 5.0249999999999995 0\n2.554774941164094 6.0249999999999995 0\n"
            "-5 -3 0\n-5 -2.999999999999999 0\n-3 -3 0\n-3 -2.999999999999999 0\n");
  const Result rounded = run("hull " + thin + " -o h.ply");
  expect_said(rounded.out, "\nmesh      2 faces, 4 vertices\n");
  expect_said(rounded.out, "\nrounding  left out 1 extreme point, nearer than ");
  const Result all = run("hull " + thin + " -o h.ply --resolution 0");
  expect_said(all.out, "\nmesh      2 faces, 5 vertices\n");
  expect_said(all.out, "\nresolution 0: ");
  EXPECT_EQ(all.out.find("rounding"), std::string::npos) << all.out;
}

TEST_F(Messages, TolerancesOutOfReachOfDoublesAreRefusedAtOnce) {
  const Result result = run("hull " + teapot_ + " -o h.ply --relative 1e-14");
  EXPECT_EQ(result.exit_code, 2);
  expect_said(result.err, "is below what double precision can prove of this model; the least is ");
  // What is exact anyway takes any.
  const std::string points = plant("p.xyz", tetrahedron_points);
  EXPECT_EQ(run("hull " + points + " -o h.ply --relative 1e-14").exit_code, 0);
}

TEST_F(Messages, BudgetsOfVerticesAreKept) {
  for (const char* method : {"precise", "sampled", "envelope"}) {
    const Result result = run(
        "hull " + teapot_ + " -o h.ply --max-vertices 60 --size 64 --method " + method + " --json");
    EXPECT_EQ(result.exit_code, 0) << method << result.err;
    EXPECT_LE(nlohmann::json::parse(result.out)["mesh"]["vertices"], 60) << method;
  }
  std::string ball;
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2 * i + 1) / 200.0;
    const double r = std::sqrt(1 - z * z);
    ball += std::to_string(r * std::cos(2.4 * i)) + " " + std::to_string(r * std::sin(2.4 * i)) +
            " " + std::to_string(z) + "\n";
  }
  const std::string points = plant("ball.xyz", ball);
  const Result few = run("hull " + points + " -o h.ply --max-vertices 20 --json");
  EXPECT_EQ(few.exit_code, 0) << few.err;
  const auto report = nlohmann::json::parse(few.out);
  EXPECT_EQ(report["mesh"]["vertices"], 20);
  EXPECT_GT(report["hull"]["volume"], report["mesh"]["volume"]);
  EXPECT_EQ(run("hull " + points + " -o h.ply --max-vertices 20 --tolerance 0.01").exit_code, 5);
  expect_failure("hull " + points + " -o h.ply --max-vertices 3", 2, "3 is no number from 4 to ");
}

TEST_F(Messages, HelpOfACommand) {
  const Result help = run("help hull");
  EXPECT_EQ(help.exit_code, 0) << help.err;
  EXPECT_EQ(help.out, run("hull --help").out);
  EXPECT_EQ(run("help").out, run("--help").out);
  expect_failure("help stretch", 2, "there is no command 'stretch'");
}

}  // namespace
