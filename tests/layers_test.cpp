// The include directions of the repository, read from the sources themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// The folders of toolkit/ and those that each may include apart from itself.
const std::map<std::string, std::set<std::string>> layers = {
    {"core", {}},
    {"surface", {"core"}},
    {"subdivision", {"core", "surface"}},
    {"bounds", {"core", "surface"}},
    {"hull", {"core", "surface", "bounds"}},
    {"envelope", {"core", "surface", "bounds", "hull"}},
    {"containment", {"core", "surface", "bounds", "hull"}},
    {"io", {"core", "surface", "subdivision", "bounds", "hull"}},
};

/// A third-party library and the only folders, of toolkit/ and plugins/, that may include it.
/// Tests and tools are free: they compare with other libraries.
struct Home {
  std::string library;
  std::regex header;
  std::vector<std::string> folders;
};

const std::vector<Home> homes = {
    {"oneTBB", std::regex("(tbb|oneapi)/.*"), {"toolkit/core/"}},
    {"OpenSubdiv", std::regex("opensubdiv/.*"), {"toolkit/subdivision/"}},
    {"OpenMesh", std::regex("OpenMesh/.*"), {"toolkit/hull/", "toolkit/io/"}},
    {"OSMesa", std::regex("(GL|EGL|GLES[0-9])/.*|.*osmesa.*"), {"toolkit/envelope/"}},
    {"libpng", std::regex("(libpng.*/)?png(conf|libconf)?\\.h"), {"toolkit/envelope/"}},
    {"Embree", std::regex("embree.*"), {"toolkit/containment/"}},
    {"pugixml", std::regex("pug(ixml|iconfig)\\..*"), {"toolkit/io/"}},
    {"OpenCASCADE", std::regex(".*\\.hxx|opencascade/.*"), {"plugins/occt/"}},
};

/// An #include directive: <path> or "path".
struct Include {
  int line = 0;
  bool quoted = false;
  std::string path;
};

bool starts_with_any(std::string_view text, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const std::string& b) { return text.starts_with(b); });
}

bool is_source(const fs::path& file) {
  static const std::set<std::string> extensions = {".h", ".hh",  ".hpp", ".hxx", ".inl",
                                                   ".c", ".cpp", ".cc",  ".cxx"};
  return extensions.contains(file.extension().string());
}

std::vector<Include> includes(const fs::path& file) {
  static const std::regex directive("\\s*#\\s*include\\s*([<\"])([^>\"]+)[>\"].*");
  std::vector<Include> found;
  std::ifstream stream(file);
  std::string text;
  std::smatch match;
  for (int line = 1; std::getline(stream, text); ++line) {
    if (std::regex_match(text, match, directive)) {
      found.push_back({line, match[1] == "\"", match[2]});
    }
  }
  return found;
}

/// What is wrong with a file of toolkit/LAYER/ including another file of this repository; else "".
std::string direction_violation(const std::string& layer, const Include& include) {
  static const std::regex toolkit_path("taut/([a-z_]+)/[^/]+");
  std::smatch match;
  if (!std::regex_match(include.path, match, toolkit_path)) {
    return include.quoted || include.path.starts_with("taut/") ? "is no \"taut/LAYER/FILE\"" : "";
  }
  const std::string used = match[1];
  if (used == layer || layers.at(layer).contains(used)) return "";
  return "is not below layer " + layer;
}

/// What is wrong with a file including a third-party header; else "".
std::string home_violation(const std::string& file, const Include& include) {
  for (const Home& home : homes) {
    if (std::regex_match(include.path, home.header) && !starts_with_any(file, home.folders)) {
      return "is " + home.library + ", whose home is " + home.folders.front();
    }
  }
  return "";
}

/// The headers that are installed, as they are included: those that the layers' CMakeLists.txt name
/// as PUBLIC_HEADERS.
std::set<std::string> public_headers() {
  std::istringstream list(TAUT_PUBLIC_HEADERS);
  std::set<std::string> headers;
  for (std::string header; list >> header;) headers.insert(header);
  return headers;
}

bool is_at_home(const std::string& file, const Include& include) {
  return std::any_of(homes.begin(), homes.end(), [&](const Home& home) {
    return std::regex_match(include.path, home.header) && starts_with_any(file, home.folders);
  });
}

/// What is wrong with a header including something; else "". Those that are not installed may
/// include a library at its home.
std::string header_violation(const std::string& file, const Include& include) {
  static const std::regex standard("[a-z_0-9]+");
  if (include.quoted || std::regex_match(include.path, standard)) return "";
  if (starts_with_any(include.path, {"taut/", "glm/"})) return "";
  if (file == "toolkit/hull/hull_mesh.h" && include.path.starts_with("OpenMesh/")) return "";
  const std::string included_as = "taut/" + file.substr(std::string("toolkit/").size());
  if (!public_headers().contains(included_as) && is_at_home(file, include)) return "";
  return "is third-party, in a header";
}

/// One line for each include below `root`/toolkit and `root`/plugins that breaks a rule:
/// "toolkit/core/error.h:3: <GL/gl.h> is ...". `files` counts what was read.
std::vector<std::string> violations(const fs::path& root, int& files) {
  std::vector<std::string> found;
  files = 0;
  for (const char* folder : {"toolkit", "plugins"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      ++files;
      const fs::path relative = entry.path().lexically_relative(root);
      const std::string file = relative.generic_string();
      const std::string layer = std::next(relative.begin())->string();
      const bool in_toolkit = file.starts_with("toolkit/");
      if (in_toolkit && !layers.contains(layer)) {
        found.push_back(file + ": is in no layer");
        continue;
      }
      for (const Include& include : includes(entry.path())) {
        std::vector<std::string> faults = {home_violation(file, include)};
        if (in_toolkit) faults.push_back(direction_violation(layer, include));
        if (in_toolkit && relative.extension() == ".h") {
          faults.push_back(header_violation(file, include));
        }
        for (const std::string& fault : faults) {
          if (fault.empty()) continue;
          found.push_back(file + ":" + std::to_string(include.line) + ": " + include.path + " " +
                          fault);
        }
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// One line for each include of a header of the toolkit that is not public, where only public ones
/// may be included: in public headers, tools and plugins.
std::vector<std::string> uses_of_private_headers(const fs::path& root,
                                                 const std::set<std::string>& headers) {
  std::vector<std::string> found;
  for (const char* folder : {"toolkit", "tools", "plugins"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      const std::string file = entry.path().lexically_relative(root).generic_string();
      const std::string inside = entry.path().lexically_relative(root / folder).generic_string();
      if (folder == std::string("toolkit") && !headers.contains("taut/" + inside)) continue;
      for (const Include& include : includes(entry.path())) {
        if (!include.path.starts_with("taut/") || headers.contains(include.path)) continue;
        found.push_back(file + ":" + std::to_string(include.line) + ": " + include.path +
                        " is none of its layer's PUBLIC_HEADERS");
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string joined(const std::vector<std::string>& lines) {
  std::ostringstream text;
  for (const std::string& line : lines) text << line << '\n';
  return text.str();
}

/// A repository in a temporary folder, into which a test plants files.
class Layers : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = fs::path(testing::TempDir()) / (std::string("taut_layers_") + test->name());
    fs::remove_all(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void plant(const std::string& file, const std::string& included) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file, std::ios::app) << "#include " << included << "\n";
  }
  std::vector<std::string> planted_violations() const {
    int files = 0;
    return violations(root_, files);
  }
  /// Plants one include alone and counts what is found.
  std::size_t violations_of(const std::string& file, const std::string& included) const {
    fs::remove_all(root_);
    plant(file, included);
    return planted_violations().size();
  }

  fs::path root_;
};

TEST_F(Layers, RepositoryKeepsDirections) {
  int files = 0;
  const std::vector<std::string> found = violations(TAUT_SOURCE_DIR, files);
  EXPECT_TRUE(found.empty()) << joined(found);
  EXPECT_GT(files, 10);
}

TEST_F(Layers, FindsPlantedDirection) {
  for (const auto& [layer, below] : layers) {
    for (const auto& [used, unused] : layers) {
      const bool allowed = used == layer || below.contains(used);
      EXPECT_EQ(violations_of("toolkit/" + layer + "/a.cpp", "\"taut/" + used + "/b.h\""),
                allowed ? 0U : 1U)
          << layer << " includes " << used;
    }
  }
}

TEST_F(Layers, FindsPlantedEscapeFromToolkit) {
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "\"tools/taut/main.h\""), 1U);
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "\"tests/reference.h\""), 1U);
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "\"plugins/occt/read.h\""), 1U);
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "\"../hull/verify.h\""), 1U);
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "\"taut/hull/../../tools/a.h\""), 1U);
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "<taut/nothing/a.h>"), 1U);
  EXPECT_EQ(violations_of("toolkit/nothing/a.cpp", "<vector>"), 1U);
  EXPECT_EQ(violations_of("plugins/occt/a.cpp", "\"read.h\""), 0U);
}

TEST_F(Layers, FindsPlantedThirdPartyAwayFromHome) {
  const std::map<std::string, std::string> header_and_home = {
      {"<tbb/parallel_for.h>", "toolkit/core"},
      {"<opensubdiv/far/patchTable.h>", "toolkit/subdivision"},
      {"<OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>", "toolkit/hull"},
      {"<GL/osmesa.h>", "toolkit/envelope"},
      {"<png.h>", "toolkit/envelope"},
      {"<embree3/rtcore.h>", "toolkit/containment"},
      {"<pugixml.hpp>", "toolkit/io"},
      {"<STEPControl_Reader.hxx>", "plugins/occt"},
  };
  std::vector<std::string> folders = {"plugins/occt", "plugins/irit"};
  for (const auto& [layer, below] : layers) folders.push_back("toolkit/" + layer);
  for (const auto& [header, home] : header_and_home) {
    for (const std::string& folder : folders) {
      const bool second_home = header.starts_with("<OpenMesh") && folder == "toolkit/io";
      EXPECT_EQ(violations_of(folder + "/a.cpp", header), folder == home || second_home ? 0U : 1U)
          << folder << " includes " << header;
    }
  }
}

TEST_F(Layers, FindsPlantedThirdPartyInPublicHeader) {
  EXPECT_EQ(violations_of("toolkit/subdivision/add_cage.h", "<opensubdiv/far/patchTable.h>"), 1U);
  EXPECT_EQ(violations_of("toolkit/subdivision/refiner.h", "<opensubdiv/far/patchTable.h>"), 0U);
  EXPECT_EQ(violations_of("toolkit/subdivision/refiner.h", "<Eigen/Core>"), 1U);
  EXPECT_EQ(violations_of("toolkit/hull/verify.h", "<OpenMesh/Core/Mesh/Traits.hh>"), 1U);
  EXPECT_EQ(violations_of("toolkit/hull/hull_mesh.h", "<OpenMesh/Core/Mesh/Traits.hh>"), 0U);
  EXPECT_EQ(violations_of("toolkit/io/report.h", "<nlohmann/json.hpp>"), 1U);
  EXPECT_EQ(violations_of("toolkit/io/report.h", "<unistd.h>"), 1U);
  EXPECT_EQ(violations_of("toolkit/io/report.cpp", "<nlohmann/json.hpp>"), 0U);
  EXPECT_EQ(violations_of("toolkit/core/geometry.h", "<glm/glm.hpp>"), 0U);
  EXPECT_EQ(violations_of("toolkit/core/geometry.h", "<cmath>"), 0U);
}

TEST_F(Layers, WhatIsInstalledNeedsNothingThatIsNot) {
  const std::set<std::string> headers = public_headers();
  EXPECT_GT(headers.size(), 15U);
  EXPECT_TRUE(headers.contains("taut/hull/convex_hull.h"));
  const std::vector<std::string> found = uses_of_private_headers(TAUT_SOURCE_DIR, headers);
  EXPECT_TRUE(found.empty()) << joined(found);
}

TEST_F(Layers, FindsPlantedUseOfPrivateHeader) {
  const std::set<std::string> headers = {"taut/hull/open.h", "taut/core/open.h"};
  plant("toolkit/hull/open.h", "\"taut/core/open.h\"");
  plant("toolkit/hull/closed.h", "\"taut/core/closed.h\"");
  plant("toolkit/hull/open.cpp", "\"taut/core/closed.h\"");
  EXPECT_EQ(joined(uses_of_private_headers(root_, headers)), "");
  plant("toolkit/hull/open.h", "\"taut/hull/closed.h\"");
  plant("tools/taut/a.cpp", "\"taut/hull/closed.h\"");
  plant("plugins/irit/a.h", "\"taut/core/closed.h\"");
  EXPECT_EQ(joined(uses_of_private_headers(root_, headers)),
            "plugins/irit/a.h:1: taut/core/closed.h is none of its layer's PUBLIC_HEADERS\n"
            "toolkit/hull/open.h:2: taut/hull/closed.h is none of its layer's PUBLIC_HEADERS\n"
            "tools/taut/a.cpp:1: taut/hull/closed.h is none of its layer's PUBLIC_HEADERS\n");
}

TEST_F(Layers, NamesFileAndLine) {
  plant("toolkit/hull/a.cpp", "<vector>");
  plant("toolkit/hull/a.cpp", "\"taut/io/report.h\"");
  EXPECT_EQ(joined(planted_violations()),
            "toolkit/hull/a.cpp:2: taut/io/report.h is not below layer hull\n");
}

}  // namespace
