// The command taut envelope, and taut hull --method envelope, as a user meets them.

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "run_command.h"
#include "temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using taut_test::content;
using taut_test::Result;
using taut_test::run_line;
using taut_test::TemporaryFolder;

class EnvelopeCommand : public TemporaryFolder {
 protected:
  Result run(const std::string& arguments, const std::string& before = "") const {
    const fs::path errors = fs::path(folder_.string() + ".stderr");
    return run_line(
        "cd '" + folder_.string() + "' && " + before + " '" TAUT_EXECUTABLE "' " + arguments,
        errors);
  }
  void expect_done(const std::string& arguments, const std::string& before = "") const {
    const Result result = run(arguments, before);
    EXPECT_EQ(result.exit_code, 0) << before << " " << arguments << "\n" << result.err;
    EXPECT_EQ(result.err, "") << arguments;
  }
  void expect_failure(const std::string& arguments, int exit_code, const std::string& words,
                      const std::string& before = "") const {
    const Result result = run(arguments, before);
    EXPECT_EQ(result.exit_code, exit_code) << arguments << "\n" << result.err;
    EXPECT_TRUE(result.err.starts_with("taut: ")) << result.err;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  }
  std::string all_files(const std::string& prefix) const {
    return content(path(prefix + "-north.png")) + content(path(prefix + "-south.png")) +
           content(path(prefix + ".json"));
  }

  const std::string spheres_ = TAUT_SOURCE_DIR "/data/two_spheres.taut.json";
  const std::string teapot_ = TAUT_SOURCE_DIR "/data/teapot.bpt";
};

/// The pixels of a PNG file, three bytes each.
std::vector<unsigned char> pixels_of(const std::string& bytes, unsigned& width, unsigned& height) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  width = image.width;
  height = image.height;
  std::vector<unsigned char> pixels(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  return pixels;
}

TEST_F(EnvelopeCommand, WritesImagesThatItsDocumentExplains) {
  expect_done("envelope '" + spheres_ + "' -o two --size 128 --quiet");
  EXPECT_EQ(file_count(), 3U);
  const Json document = Json::parse(content(path("two.json")));
  EXPECT_EQ(document["size"], 128);
  ASSERT_EQ(document["regions"].size(), 2U);
  ASSERT_EQ(document["curves"].size(), 1U);
  EXPECT_EQ(document["triple_points"].size(), 0U);
  // The spheres' curve: n.z is the same everywhere on it.
  const Json& curve = document["curves"][0];
  EXPECT_EQ(curve["closed"], true);
  EXPECT_EQ(curve["sources"].size(), 2U);
  EXPECT_EQ(curve["n"].size(), curve["contacts"].size());
  const double z = curve["n"][0][2];
  for (const Json& n : curve["n"]) EXPECT_NEAR(n[2].get<double>(), z, 1e-9);
  for (const Json& both : curve["contacts"]) {
    ASSERT_EQ(both.size(), 2U);
    for (const Json& c : both) {
      EXPECT_EQ(c["uv"].size(), 2U);
      EXPECT_EQ(c["p"].size(), 3U);
    }
  }
  // Of the two spheres one supports above the curve and one below; pixels say the same.
  std::array<std::set<Json>, 2> colors;
  for (const std::string hemisphere : {"north", "south"}) {
    unsigned width = 0;
    unsigned height = 0;
    const auto pixels = pixels_of(content(path("two-" + hemisphere + ".png")), width, height);
    ASSERT_EQ(width, 128U);
    ASSERT_EQ(height, 128U);
    const Json& axes = document["axes"][hemisphere];
    const double pole = axes["pole"];
    for (int k = 0; k < 2000; ++k) {
      const double angle = 2.4 * k;
      const double nz = pole * (k + 0.5) / 2000;
      if (std::abs(nz - z) < 0.1) continue;
      const double r = std::sqrt(1 - nz * nz);
      const auto place = [&](const Json& axis, double n) {
        return int(std::lround(axis["offset"].get<double>() +
                               axis["scale"].get<double>() * n / (1 + pole * nz)));
      };
      const int column = std::min(place(axes["column"], r * std::cos(angle)), 127);
      const int row = std::min(place(axes["row"], r * std::sin(angle)), 127);
      const auto at = std::size_t(3 * (row * 128 + column));
      colors[nz > z ? 0 : 1].insert(Json{pixels[at], pixels[at + 1], pixels[at + 2]});
    }
  }
  ASSERT_EQ(colors[0].size(), 1U);
  ASSERT_EQ(colors[1].size(), 1U);
  EXPECT_NE(*colors[0].begin(), *colors[1].begin());
  for (const auto& set : colors) {
    EXPECT_TRUE(document["regions"][0]["color"] == *set.begin() ||
                document["regions"][1]["color"] == *set.begin());
  }
}

TEST_F(EnvelopeCommand, SameBytesForAnyNumberOfThreads) {
  expect_done("envelope '" + teapot_ + "' -o a --size 200 --quiet --threads 1");
  expect_done("envelope '" + teapot_ + "' -o b --size 200 --quiet --threads 2", "LP_NUM_THREADS=0");
  expect_done("envelope '" + teapot_ + "' -o c --size 200 --quiet", "LP_NUM_THREADS=1");
  EXPECT_GT(all_files("a").size(), 10000U);
  EXPECT_TRUE(all_files("a") == all_files("b"));
  EXPECT_TRUE(all_files("a") == all_files("c"));
}

TEST_F(EnvelopeCommand, NeedsNoDisplayAndNoHome) {
  expect_done("envelope '" + spheres_ + "' -o a --size 32 --quiet",
              "env -u DISPLAY -u WAYLAND_DISPLAY -u XAUTHORITY HOME=/nonexistent");
}

TEST_F(EnvelopeCommand, WorksAsAUserToo) {
  fs::permissions(folder_, fs::perms::all);
  const std::string user = "setpriv --reuid=65534 --regid=65534 --clear-groups";
  if (run_line(user + " test -r '" + spheres_ + "' -a -x '" TAUT_EXECUTABLE "'", path("errors"))
          .exit_code != 0) {
    GTEST_SKIP() << "not root, or files that others cannot read";
  }
  expect_done("envelope '" + spheres_ + "' -o a --size 32 --quiet",
              user + " env HOME=/nonexistent");
  EXPECT_EQ(file_count(), 3U);
}

TEST_F(EnvelopeCommand, TheOtherDriverDrawsToo) {
  expect_done("envelope '" + spheres_ + "' -o a --size 32 --quiet", "GALLIUM_DRIVER=softpipe");
  expect_done("envelope '" + spheres_ + "' -o b --size 32 --quiet");
  EXPECT_EQ(Json::parse(content(path("a.json")))["regions"],
            Json::parse(content(path("b.json")))["regions"]);
}

TEST_F(EnvelopeCommand, AllElseWorksWithoutOsmesa) {
  // A file that is no library stands before the library.
  fs::create_directory(path("lib"));
  file("lib/libOSMesa.so.8", "no library");
  const std::string without = "LD_LIBRARY_PATH='" + path("lib").string() + "'";
  expect_failure("envelope '" + spheres_ + "' -o a", 3, "libOSMesa.so.8", without);
  expect_failure("hull '" + spheres_ + "' -o a.ply --method envelope", 3, "libOSMesa.so.8",
                 without);
  expect_done("hull '" + spheres_ + "' -o a.ply --relative 1e-2 --quiet", without);
  EXPECT_FALSE(fs::exists(path("a.json")));
}

TEST_F(EnvelopeCommand, TellsWhatItDid) {
  const Result result = run("envelope '" + teapot_ + "' -o a --size 200 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = Json::parse(result.out);
  EXPECT_EQ(report["size"], 200);
  EXPECT_EQ(report["pixels"]["empty"], 0);
  EXPECT_EQ(report["pixels"]["filled"], 0);
  EXPECT_EQ(report["triple_points"], 10);
  EXPECT_EQ(report["files"].size(), 3U);
  EXPECT_GT(report["seconds"]["draw"].get<double>(), 0);
}

TEST_F(EnvelopeCommand, OverlayIsDrawn) {
  expect_done("envelope '" + teapot_ + "' -o a --size 200 --quiet");
  expect_done("envelope '" + teapot_ + "' -o b --size 200 --quiet --overlay precise");
  EXPECT_EQ(content(path("a.json")), content(path("b.json")));
  const auto white = [&](const std::string& name) {
    unsigned width = 0;
    unsigned height = 0;
    const auto pixels = pixels_of(content(path(name)), width, height);
    int count = 0;
    for (std::size_t k = 0; k < pixels.size(); k += 3) {
      count += pixels[k] == 255 && pixels[k + 1] == 255 && pixels[k + 2] == 255 ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(white("b-north.png"), white("a-north.png") + 300);
}

TEST_F(EnvelopeCommand, HullOfTheImagesIsVerified) {
  const Result result =
      run("hull '" + teapot_ + "' -o a.ply --method envelope --size 256 --relative 1e-3 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json report = Json::parse(result.out);
  EXPECT_EQ(report["method"], "envelope");
  const double diagonal = report["input"]["diagonal"];
  EXPECT_LE(report["mesh"]["distance_bound"].get<double>(), 1e-3 * diagonal);
  EXPECT_EQ(run("verify a.ply '" + teapot_ + "' --relative 1e-3").exit_code, 0);
}

TEST_F(EnvelopeCommand, RefusesWhatItCannotDo) {
  expect_failure("envelope '" + spheres_ + "'", 2, "--output");
  expect_failure("envelope '" + spheres_ + "' -o -", 2, "PREFIX");
  expect_failure("envelope '" + spheres_ + "' -o a --size 7", 2, "--size");
  expect_failure("envelope '" + spheres_ + "' -o a --size 16001", 2, "--size");
  expect_failure("envelope '" + spheres_ + "' -o a --overlay sampled", 2, "--overlay");
  expect_failure("envelope '" + spheres_ + "' -o missing/a", 3, "missing");
  expect_failure("envelope nothing.bpt -o a", 3, "nothing.bpt");
  fs::create_directory(path("a.json"));
  expect_failure("envelope '" + spheres_ + "' -o a", 3, "a.json");
}

}  // namespace
