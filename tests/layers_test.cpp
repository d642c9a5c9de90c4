// The include directions of the repository, read from the sources themselves.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
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
    {"verify", {"core", "surface", "bounds", "hull"}},
    {"io", {"core", "surface", "subdivision", "bounds", "hull"}},
};

/// The rooms of a layer, its folders, and those that each may include, and so all that these may.
/// What lies beside the rooms may include all of them; no room includes it.
using Rooms = std::map<std::string, std::set<std::string>>;

const std::map<std::string, Rooms> rooms_of = {
    {"hull",
     {
         {"result", {}},
         {"polytope", {"result"}},
         {"planar", {"polytope"}},
         {"contact", {"planar"}},
         {"decide", {"result"}},
         {"solve", {"contact", "decide"}},
         {"stitch", {"solve"}},
         {"sample", {"polytope"}},
         {"mesh", {"sample", "stitch"}},
         {"measure", {"stitch"}},
         {"polyhedral", {"sample"}},
     }},
    {"envelope",
     {
         {"cull", {}},
     }},
    {"io",
     {
         {"text", {}},
         {"mesh", {"text"}},
         {"obj", {"mesh"}},
         {"document", {"text"}},
         {"model", {"obj", "document"}},
         {"report", {}},
     }},
};

/// The layers that may include some rooms of hull only.
const std::map<std::string, std::set<std::string>> rooms_of_hull_for = {
    {"envelope", {"result", "polytope", "sample"}},
    {"containment", {"result", "polytope", "sample"}},
    {"verify", {"result", "polytope"}},
};

/// A third-party library and the only folders, of toolkit/ and plugins/, that may include it.
/// Tests and tools are free: they compare with other libraries.
struct Home {
  std::string library;
  std::regex header;
  std::vector<std::string> folders;
};

const std::vector<Home> homes = {
    {"Boost.Multiprecision", std::regex("boost/multiprecision/.*"), {"toolkit/core/"}},
    {"Boost.Math", std::regex("boost/math/.*"), {"toolkit/verify/"}},
    {"oneTBB", std::regex("(tbb|oneapi)/.*"), {"toolkit/core/"}},
    {"OpenSubdiv", std::regex("opensubdiv/.*"), {"toolkit/subdivision/"}},
    {"OpenMesh", std::regex("OpenMesh/.*"), {"toolkit/hull/result/"}},
    {"OSMesa", std::regex("(GL|EGL|GLES[0-9])/.*|.*osmesa.*"), {"toolkit/envelope/"}},
    {"libpng", std::regex("(libpng.*/)?png(conf|libconf)?\\.h"), {"toolkit/envelope/"}},
    {"Embree", std::regex("embree.*"), {"toolkit/containment/"}},
    {"pugixml", std::regex("pug(ixml|iconfig)\\..*"), {"toolkit/io/model/"}},
    {"zlib", std::regex("z(lib|conf)\\.h"), {"toolkit/io/text/"}},
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

/// Where a file of the toolkit lies. Room "": beside the layer's rooms, or it has none.
struct Place {
  std::string layer;
  std::string room;

  bool operator==(const Place&) const = default;
  bool exists() const {
    if (!layers.contains(layer)) return false;
    return room.empty() || (rooms_of.contains(layer) && rooms_of.at(layer).contains(room));
  }
};

/// Of LAYER/FILE or LAYER/ROOM/FILE.
std::optional<Place> place_of(const std::string& path) {
  static const std::regex pattern("([a-z_]+)/(?:([a-z_]+)/)?[^/]+");
  std::smatch match;
  if (!std::regex_match(path, match, pattern)) return std::nullopt;
  return Place{match[1], match[2]};
}

/// Whether a room may include another one of its layer.
bool is_below(const Rooms& rooms, const std::string& used, const std::string& room) {
  const std::set<std::string>& below = rooms.at(room);
  return below.contains(used) ||
         std::any_of(below.begin(), below.end(),
                     [&](const std::string& next) { return is_below(rooms, used, next); });
}

/// What is wrong with a file at a place of the toolkit including another file of this repository;
/// else "".
std::string direction_violation(const Place& from, const Include& include) {
  const bool in_toolkit = include.path.starts_with("taut/");
  if (!include.quoted && !in_toolkit) return "";
  const auto used = in_toolkit ? place_of(include.path.substr(5)) : std::nullopt;
  if (!used || !used->exists()) return "is no \"taut/LAYER/FILE\" or \"taut/LAYER/ROOM/FILE\"";
  if (used->layer != from.layer) {
    if (!layers.at(from.layer).contains(used->layer)) return "is not below layer " + from.layer;
    const auto allowed = rooms_of_hull_for.find(from.layer);
    if (used->layer != "hull" || used->room.empty() || allowed == rooms_of_hull_for.end())
      return "";
    return allowed->second.contains(used->room) ? "" : "is in no room for layer " + from.layer;
  }
  if (from.room.empty() || *used == from) return "";
  if (!used->room.empty() && is_below(rooms_of.at(from.layer), used->room, from.room)) return "";
  return "is not below room " + from.room;
}

/// What is wrong with a file including a third-party header; else "".
std::string home_violation(const std::string& file, const Include& include) {
  for (const Home& home : homes) {
    const std::string folder = fs::path(file).parent_path().generic_string() + "/";
    if (std::regex_match(include.path, home.header) &&
        std::find(home.folders.begin(), home.folders.end(), folder) == home.folders.end()) {
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
  if (file == "toolkit/hull/result/hull_mesh.h" && include.path.starts_with("OpenMesh/")) return "";
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
      const bool in_toolkit = file.starts_with("toolkit/");
      const auto place = in_toolkit ? place_of(file.substr(8)) : std::nullopt;
      if (in_toolkit && (!place || !place->exists())) {
        found.push_back(file + ": is in no layer, or no room of one");
        continue;
      }
      for (const Include& include : includes(entry.path())) {
        std::vector<std::string> faults = {home_violation(file, include)};
        if (in_toolkit) faults.push_back(direction_violation(*place, include));
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

/// Where only public headers may be included: all of them in public headers, tools and plugins,
/// those of hull in other layers.
bool needs_public(const std::string& file, const Include& include,
                  const std::set<std::string>& headers) {
  if (!include.path.starts_with("taut/")) return false;
  if (!file.starts_with("toolkit/")) return true;
  if (headers.contains("taut/" + file.substr(8))) return true;
  return include.path.starts_with("taut/hull/") && !file.starts_with("toolkit/hull/");
}

/// One line for each include of a header of the toolkit that is not public, where only public ones
/// may be included.
std::vector<std::string> uses_of_private_headers(const fs::path& root,
                                                 const std::set<std::string>& headers) {
  std::vector<std::string> found;
  for (const char* folder : {"toolkit", "tools", "plugins"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file() || !is_source(entry.path())) continue;
      const std::string file = entry.path().lexically_relative(root).generic_string();
      for (const Include& include : includes(entry.path())) {
        if (headers.contains(include.path) || !needs_public(file, include, headers)) continue;
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

TEST_F(Layers, FindsPlantedDirectionBetweenRooms) {
  for (const auto& [layer, rooms] : rooms_of) {
    for (const auto& [room, below] : rooms) {
      const std::string file = "toolkit/" + layer + "/" + room + "/a.cpp";
      for (const auto& [used, unused] : rooms) {
        const bool allowed = used == room || is_below(rooms, used, room);
        EXPECT_EQ(violations_of(file, "\"taut/" + layer + "/" + used + "/b.h\""), allowed ? 0U : 1U)
            << room << " includes " << used;
        EXPECT_FALSE(used != room && allowed && is_below(rooms, room, used))
            << room << ", " << used;
      }
      EXPECT_EQ(violations_of(file, "\"taut/" + layer + "/b.h\""), 1U) << room;
      EXPECT_EQ(
          violations_of("toolkit/" + layer + "/a.cpp", "\"taut/" + layer + "/" + room + "/b.h\""),
          0U)
          << room;
    }
  }
  EXPECT_TRUE(is_below(rooms_of.at("hull"), "result", "solve"));
  EXPECT_FALSE(is_below(rooms_of.at("hull"), "sample", "solve"));
}

TEST_F(Layers, FindsPlantedUseOfARoomFromAnotherLayer) {
  EXPECT_EQ(violations_of("toolkit/envelope/a.cpp", "\"taut/hull/polytope/b.h\""), 0U);
  EXPECT_EQ(violations_of("toolkit/envelope/a.cpp", "\"taut/hull/convex_hull.h\""), 0U);
  EXPECT_EQ(violations_of("toolkit/envelope/a.cpp", "\"taut/hull/solve/b.h\""), 1U);
  EXPECT_EQ(violations_of("toolkit/containment/a.cpp", "\"taut/hull/contact/b.h\""), 1U);
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "\"taut/hull/contact/b.h\""), 0U);
  EXPECT_EQ(violations_of("toolkit/core/a.cpp", "\"taut/hull/result/b.h\""), 1U);
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
  EXPECT_EQ(violations_of("toolkit/hull/nothing/a.cpp", "<vector>"), 1U);
  EXPECT_EQ(violations_of("toolkit/core/nothing/a.cpp", "<vector>"), 1U);
  EXPECT_EQ(violations_of("toolkit/io/a.cpp", "\"taut/hull/nothing/a.h\""), 1U);
  EXPECT_EQ(violations_of("plugins/occt/a.cpp", "\"read.h\""), 0U);
}

TEST_F(Layers, FindsPlantedThirdPartyAwayFromHome) {
  const std::map<std::string, std::string> header_and_home = {
      {"<tbb/parallel_for.h>", "toolkit/core"},
      {"<opensubdiv/far/patchTable.h>", "toolkit/subdivision"},
      {"<OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>", "toolkit/hull/result"},
      {"<GL/osmesa.h>", "toolkit/envelope"},
      {"<png.h>", "toolkit/envelope"},
      {"<embree3/rtcore.h>", "toolkit/containment"},
      {"<boost/math/quadrature/gauss.hpp>", "toolkit/verify"},
      {"<pugixml.hpp>", "toolkit/io/model"},
      {"<zlib.h>", "toolkit/io/text"},
      {"<STEPControl_Reader.hxx>", "plugins/occt"},
  };
  std::vector<std::string> folders = {"plugins/occt", "plugins/irit"};
  for (const auto& [layer, below] : layers) folders.push_back("toolkit/" + layer);
  for (const auto& [layer, rooms] : rooms_of) {
    for (const auto& [room, below] : rooms) folders.push_back("toolkit/" + layer + "/" + room);
  }
  for (const auto& [header, home] : header_and_home) {
    for (const std::string& folder : folders) {
      EXPECT_EQ(violations_of(folder + "/a.cpp", header), folder == home ? 0U : 1U)
          << folder << " includes " << header;
    }
  }
}

TEST_F(Layers, FindsPlantedThirdPartyInPublicHeader) {
  EXPECT_EQ(violations_of("toolkit/subdivision/add_cage.h", "<opensubdiv/far/patchTable.h>"), 1U);
  EXPECT_EQ(violations_of("toolkit/subdivision/refiner.h", "<opensubdiv/far/patchTable.h>"), 0U);
  EXPECT_EQ(violations_of("toolkit/subdivision/refiner.h", "<Eigen/Core>"), 1U);
  EXPECT_EQ(violations_of("toolkit/hull/result/measures.h", "<OpenMesh/Core/Mesh/Traits.hh>"), 1U);
  EXPECT_EQ(violations_of("toolkit/hull/result/hull_mesh.h", "<OpenMesh/Core/Mesh/Traits.hh>"), 0U);
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
  plant("toolkit/io/a.cpp", "\"taut/core/closed.h\"");
  EXPECT_EQ(joined(uses_of_private_headers(root_, headers)), "");
  plant("toolkit/io/b.cpp", "\"taut/hull/closed.h\"");
  plant("toolkit/hull/open.h", "\"taut/hull/closed.h\"");
  plant("tools/taut/a.cpp", "\"taut/hull/closed.h\"");
  plant("plugins/irit/a.h", "\"taut/core/closed.h\"");
  EXPECT_EQ(joined(uses_of_private_headers(root_, headers)),
            "plugins/irit/a.h:1: taut/core/closed.h is none of its layer's PUBLIC_HEADERS\n"
            "toolkit/hull/open.h:2: taut/hull/closed.h is none of its layer's PUBLIC_HEADERS\n"
            "toolkit/io/b.cpp:1: taut/hull/closed.h is none of its layer's PUBLIC_HEADERS\n"
            "tools/taut/a.cpp:1: taut/hull/closed.h is none of its layer's PUBLIC_HEADERS\n");
}

TEST_F(Layers, NamesFileAndLine) {
  plant("toolkit/hull/a.cpp", "<vector>");
  plant("toolkit/hull/a.cpp", "\"taut/io/report.h\"");
  EXPECT_EQ(joined(planted_violations()),
            "toolkit/hull/a.cpp:2: taut/io/report.h is not below layer hull\n");
}

}  // namespace
