// Formats of what the command reads and writes: points by several names, gzipped files, pipes,
// units, and what shells complete.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "command_folder.h"

namespace {

using taut_test::content;
using taut_test::Result;

class Formats : public taut_test::CommandFolder {
 protected:
  std::string points_of(const std::string& file) const {
    const Result info = run("info " + file + " --json");
    EXPECT_EQ(info.exit_code, 0) << info.err;
    if (info.exit_code != 0) return "";
    return nlohmann::json::parse(info.out)["files"][0]["points"].dump();
  }
  /// Compresses a file with gzip and returns its name.
  std::string gzipped(const std::string& name) const {
    EXPECT_EQ(std::system(("gzip -n '" + path(name).string() + "'").c_str()), 0);
    return name + ".gz";
  }
};

TEST_F(Formats, PointsByAnyOfTheirNames) {
  EXPECT_EQ(points_of(plant("a.csv", "x,y,z\n1,2,3\n4,5,6\n")), "2");
  EXPECT_EQ(points_of(plant("b.csv", "\"X\";\"Y\";\"Z\";\"label\"\n1;2;3;a\n4;5;6;b\n")), "2");
  EXPECT_EQ(points_of(plant("a.txt", "1 2 3\n4\t5\t6\n")), "2");
  EXPECT_EQ(points_of(plant("a.pts", "2\n1 2 3 -100 1 2 3\n4 5 6 -100 1 2 3\n")), "2");
  EXPECT_EQ(points_of(plant("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n")), "4");
  expect_failure("info " + plant("c.csv", "id,x,y,z\n1,2,3,4\n"), 3, "c.csv:1: ");
}

TEST_F(Formats, GzippedFilesByTheirInnerName) {
  EXPECT_EQ(points_of(gzipped(plant("a.csv", "1,2,3\n4,5,6\n"))), "2");
  ASSERT_EQ(run("hull a.csv.gz " + teapot_ + " -o h.ply --relative 1e-2").exit_code, 0);
  EXPECT_EQ(
      run("verify " + gzipped("h.ply") + " a.csv.gz " + teapot_ + " --relative 1e-2").exit_code, 0);
  EXPECT_EQ(run("info - --from csv < a.csv.gz").exit_code, 0);
  // What is in it is read as it is.
  plant("deep", "1,2,3\n");
  for (int k = 0; k < 3; ++k) fs::rename(path(gzipped("deep")), path("deep"));
  expect_failure("info - --from csv < deep", 3, "1:");
  expect_failure("hull a.csv.gz -o b.ply.gz", 2, "b.ply.gz");
  const std::string whole = content(path("a.csv.gz"));
  expect_failure("info " + plant("cut.csv.gz", whole.substr(0, whole.size() - 9)), 3,
                 "cut.csv.gz: is gzipped, and cut off");
  std::string damaged = whole;
  damaged[12] = static_cast<char>(damaged[12] ^ 0x55);
  expect_failure("info " + plant("bad.csv.gz", damaged), 3, "bad.csv.gz: is gzipped, and ");
}

TEST_F(Formats, TheTwoEndsOfAPipe) {
  const std::string points = plant("p", "0,0,0\n1,0,0\n0,1,0\n0,0,1\n");
  const Result hull = run("hull - -o - --from csv --to off <" + points);
  EXPECT_EQ(hull.exit_code, 0) << hull.err;
  EXPECT_TRUE(hull.out.starts_with("OFF\n4 4 6\n")) << hull.out;
  const Result verified = run("verify - - --from off <" + points);
  EXPECT_EQ(verified.exit_code, 2);
  expect_failure("hull - -o - --from csv <" + points, 2, "--to");
  const Result model = run("info - -o - --from csv --to taut.json <" + points);
  EXPECT_EQ(nlohmann::json::parse(model.out)["format"], "taut-model") << model.err;
  expect_failure("info - -o - --from csv <" + points, 2, "--to");
}

TEST_F(Formats, VectorsApartAsPointsAre) {
  for (const char* text :
       {"0 0 1\n", "0,0,1\n", "0; 0 ;1;\n", " 0\t0\t1 # up\n", "0 , 0 , 1\r\n"}) {
    const std::string file = plant("v", text);
    EXPECT_EQ(run("support " + teapot_ + " --directions " + file).out,
              run("support " + teapot_ + " --directions -", "echo 0 0 1 |").out)
        << text;
    EXPECT_EQ(run("contains " + teapot_ + " --points " + file).out.rfind("inside", 0), 0U) << text;
  }
  expect_failure("contains " + teapot_ + " --points " + plant("w", "1,5 2,5 3,5\n"), 3,
                 "w:1: columns stand apart in more than one way");
  expect_failure("contains " + teapot_ + " --points " + plant("w", "1,,2\n"), 3, "w:1: ");
}

TEST_F(Formats, UnitsAreKeptAndShown) {
  const std::string points = R"("parts": [{"vertices": [[0, 0, 0], [1, 0, 0], [0, 2, 0]]}]})";
  const std::string begin = R"({"format": "taut-model", "version": 1, )";
  plant("inch.taut.json", begin + R"("unit": "inch", )" + points);
  plant("none.taut.json", begin + points);
  const Result info = run("info inch.taut.json -o copy.taut.json");
  EXPECT_EQ(info.err, "");
  EXPECT_NE(info.out.find("  unit      inch\n"), std::string::npos) << info.out;
  EXPECT_NE(content(path("copy.taut.json")).find("\"unit\": \"inch\""), std::string::npos);
  EXPECT_NE(run("hull copy.taut.json -o h.ply").out.find("diagonal 2.23607 inch\n"),
            std::string::npos);
  EXPECT_EQ(run("info none.taut.json -o copy.taut.json").out.find("unit"), std::string::npos);
  EXPECT_EQ(content(path("copy.taut.json")).find("unit"), std::string::npos);
  EXPECT_TRUE(
      nlohmann::json::parse(run("info none.taut.json --json").out)["input"]["unit"].is_null());
  plant("mm.taut.json", begin + R"("unit": "mm", )" + points);
  const Result both = run("hull inch.taut.json mm.taut.json -o h.ply");
  EXPECT_NE(both.err.find("the unit is \"mm\", that of what was read before \"inch\""),
            std::string::npos)
      << both.err;
}

/// The shell is at hand.
bool has_shell(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

TEST_F(Formats, FishCompletes) {
  if (!has_shell("fish")) GTEST_SKIP() << "fish is not at hand";
  const auto offered = [&](const std::string& line) {
    return taut_test::run_line("fish --no-config -c \"source '" TAUT_SOURCE_DIR
                               "/tools/taut/completion.fish'; complete -C '" +
                                   line + "'\"",
                               path("errors"))
        .out;
  };
  const std::string taut = TAUT_EXECUTABLE " ";
  EXPECT_NE(offered(taut + "su").find("support"), std::string::npos) << offered(taut + "su");
  EXPECT_NE(offered(taut + "hull --max-v").find("--max-vertices"), std::string::npos);
  EXPECT_NE(offered(taut + "hull --method s").find("sampled"), std::string::npos);
}

TEST_F(Formats, ZshCompletes) {
  if (!has_shell("zsh")) GTEST_SKIP() << "zsh is not at hand";
  const auto offered = [&](const std::string& words, const std::string& prefix) {
    const std::string script = plant(
        "complete.zsh", "compadd() { shift; print -l -- $@ }\n_files() { print FILES }\nwords=(" +
                            words + ")\nCURRENT=$#words\nPREFIX='" + prefix +
                            "'\nsource '" TAUT_SOURCE_DIR "/tools/taut/completion.zsh'\n");
    return taut_test::run_line("zsh -f '" + path(script).string() + "'", path("errors")).out;
  };
  const std::string taut = TAUT_EXECUTABLE " ";
  EXPECT_NE(offered(taut + "su", "su").find("\nsupport\n"), std::string::npos);
  EXPECT_NE(offered(taut + "hull --m", "--m").find("\n--max-vertices\n"), std::string::npos);
  EXPECT_EQ(offered(taut + "hull --method s", "s"), "precise\nsampled\nenvelope\n");
  EXPECT_EQ(offered(taut + "hull --report r", "r"), "FILES\n");
}

}  // namespace
