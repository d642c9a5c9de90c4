// What the README and the description of formats show is what is compiled and read.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "taut/io/document/read_hull.h"
#include "taut/io/model/read_model.h"
#include "taut/io/report/report.h"
#include "temporary_folder.h"

namespace {

using WrittenJson = nlohmann::json;
using taut_test::content;

const std::filesystem::path sources = TAUT_SOURCE_DIR;

/// The blocks of code of a language in a text of Markdown.
std::vector<std::string> blocks(const std::string& text, const std::string& language) {
  const std::string begin = "\n```" + language + "\n";
  std::vector<std::string> found;
  for (std::size_t at = text.find(begin); at != text.npos; at = text.find(begin, at)) {
    at += begin.size();
    const std::size_t end = text.find("\n```\n", at);
    found.push_back(text.substr(at, end + 1 - at));
  }
  return found;
}

/// The first of the blocks of formats.md that has the key.
std::string format_example(const std::string& key, const WrittenJson& value) {
  for (const std::string& block : blocks(content(sources / "toolkit/io/formats.md"), "json")) {
    const WrittenJson json = WrittenJson::parse(block);
    if (json.contains(key) && (value.is_null() || json[key] == value)) return block;
  }
  ADD_FAILURE() << "no example with " << key;
  return "{}";
}

/// All keys of objects in it, with those of the objects that they are in.
void collect_keys(const WrittenJson& json, const std::string& path, std::set<std::string>& keys) {
  if (json.is_array() && !json.empty()) return collect_keys(json[0], path, keys);
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    const std::string own = path.empty() ? key : path + "." + key;
    keys.insert(own);
    collect_keys(value, own, keys);
  }
}

TEST(WrittenExamples, OfTheReadmeAreCompiled) {
  const std::vector<std::string> shown = blocks(content(sources / "README.md"), "cpp");
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[0], content(sources / "tests/examples/hull_of_file.cpp"));
  EXPECT_EQ(shown[1], content(sources / "tests/examples/hull_of_own.cpp"));
}

TEST(WrittenExamples, ModelDocumentIsRead) {
  std::vector<std::string> warnings;
  taut::ReadOptions options;
  options.progress.warn = [&](std::string_view, std::string_view text) {
    warnings.emplace_back(text);
  };
  taut::Model model;
  taut::read_model(format_example("format", "taut-model"), "example", ".taut.json", model, options);
  EXPECT_EQ(warnings, std::vector<std::string>());
  EXPECT_EQ(model.unit(), "mm");
  EXPECT_EQ(model.parts().size(), 2U);
}

TEST(WrittenExamples, HullDocumentIsRead) {
  const taut::HullDocument hull = taut::read_hull(format_example("format", "taut-hull"), "example",
                                                  taut::DocumentEncoding::json, {});
  EXPECT_EQ(hull.faces.size(), 4U);
  EXPECT_EQ(hull.curves.size(), 6U);
}

TEST(WrittenExamples, ReportHasTheKeysThatAreWritten) {
  taut::Report report;
  report.input.box.include(taut::dvec3(1));
  report.hull.counts.emplace();
  report.hull.resolution.emplace();
  report.hull.tolerant.emplace();
  report.hull.measures.emplace();
  report.hull.mean_width = report.hull.measures_accuracy = report.hull.gap_bound = 1.0;
  report.culling.emplace();
  report.directions.emplace();
  report.mesh.files.push_back({"a.ply", 0});
  report.warnings.push_back({"code", "text"});
  std::set<std::string> written;
  collect_keys(WrittenJson::parse(taut::to_json(report)), "", written);
  std::set<std::string> shown;
  collect_keys(WrittenJson::parse(format_example("method", {})), "", shown);
  EXPECT_EQ(shown, written);
}

TEST(WrittenExamples, PluginTellsWhatItIs) {
  const WrittenJson plugin = WrittenJson::parse(format_example("reads", {}));
  for (const char* key : {"name", "version", "reads", "writes"}) EXPECT_TRUE(plugin.contains(key));
}

}  // namespace
