// Every reader over the corpus of its format, and the command over the files that are malformed.
// Names say what is expected: bad_* is refused, warn_* is read with a warning, fuzz_* may be
// either, all others are read without one.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "fuzz/read_one.h"
#include "run_command.h"
#include "temporary_folder.h"

namespace taut_test {

/// For GoogleTest.
static void PrintTo(const Reader& reader, std::ostream* stream) { *stream << reader.corpus(); }

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(TAUT_FUZZ_CORPUS) / folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool begins(const fs::path& file, const char* prefix) {
  return file.filename().string().starts_with(prefix);
}

std::string case_name(std::string text) {
  for (char& c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return text;
}

/// Far more than any of the inputs takes whose outcome is told; the others may be stopped.
constexpr std::chrono::milliseconds longest(120'000);
constexpr std::chrono::milliseconds stopped_after(500);

class CorpusOf : public testing::TestWithParam<Reader> {};

TEST_P(CorpusOf, IsReadOrRefusedAsItShould) {
  const Reader& reader = GetParam();
  const std::vector<fs::path> files = files_of(reader.corpus());
  EXPECT_GT(files.size(), 10U);
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename().string());
    Outcome outcome;
    try {
      const auto limit = begins(file, "fuzz_") ? stopped_after : longest;
      outcome = read_one(reader, content(file), file.string(), limit);
    } catch (const Finding& finding) {
      ADD_FAILURE() << finding.what();
      continue;
    }
    // What is wrong with a model may be passed over in a mesh.
    if (begins(file, "fuzz_") || reader.kind == Reader::Kind::mesh) continue;
    EXPECT_FALSE(outcome.stopped);
    EXPECT_EQ(outcome.accepted, !begins(file, "bad_")) << outcome.error;
    EXPECT_EQ(outcome.accepted && !outcome.warnings.empty(), begins(file, "warn_"));
  }
}

std::string reader_name(const testing::TestParamInfo<Reader>& info) {
  static const std::vector<std::string> kinds = {"_as_model", "_as_mesh", "", ""};
  return case_name(info.param.corpus() + kinds[static_cast<std::size_t>(info.param.kind)]);
}

INSTANTIATE_TEST_SUITE_P(Readers, CorpusOf, testing::ValuesIn(readers()), reader_name);

TEST(Corpus, HoldsEveryFormat) {
  for (const auto& entry : fs::directory_iterator(TAUT_FUZZ_CORPUS)) {
    const std::string folder = entry.path().filename().string();
    EXPECT_TRUE(std::any_of(readers().begin(), readers().end(), [&](const Reader& r) {
      return r.corpus() == folder;
    })) << folder;
  }
}

class CommandOverCorpusOf : public testing::TestWithParam<std::string> {
 protected:
  /// The exact hulls that are no malformed files are that of the corpus' tetrahedron.
  bool is_hull() const { return GetParam().starts_with("hull."); }
  bool is_cage() const { return GetParam() == "catmark" || GetParam() == "loop"; }
  Result run(const fs::path& file) const {
    const fs::path errors =
        fs::path(testing::TempDir()) / ("taut_corpus_" + case_name(GetParam()) + ".stderr");
    const std::string saddle = TAUT_FUZZ_CORPUS "/bpt/saddle.bpt";
    const std::string before = GetParam() == "directions" ? "support '" + saddle + "' --directions "
                               : is_hull()                ? "verify "
                               : is_cage()                ? "info --scheme " + GetParam() + " "
                                                          : "info ";
    const std::string after = is_hull() ? " '" TAUT_FUZZ_CORPUS "/off/tetrahedron.off'" : "";
    const std::string line = "'" TAUT_EXECUTABLE "' " + before + "'" + file.string() + "'" + after;
    return run_line(line, errors);
  }
};

bool is_warning(const std::string& line) { return line.starts_with("taut: warning: "); }

TEST_P(CommandOverCorpusOf, GivesOneLineAndExitCode) {
  for (const fs::path& file : files_of(GetParam())) {
    if (!begins(file, "bad_") && !begins(file, "warn_")) continue;
    const Result result = run(file);
    SCOPED_TRACE(file.filename().string() + "\n" + result.err);
    std::vector<std::string> lines;
    std::istringstream stream(result.err);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    ASSERT_FALSE(lines.empty());
    if (begins(file, "warn_")) {
      EXPECT_EQ(result.exit_code, 0);
      EXPECT_TRUE(std::all_of(lines.begin(), lines.end(), is_warning));
      continue;
    }
    EXPECT_TRUE(result.exit_code == 3 || result.exit_code == 4) << result.exit_code;
    EXPECT_EQ(result.out, "");
    // What comes before the error may be warned of.
    EXPECT_TRUE(std::all_of(lines.begin(), lines.end() - 1, is_warning));
    EXPECT_FALSE(is_warning(lines.back()));
    EXPECT_TRUE(lines.back().starts_with("taut: "));
    EXPECT_NE(lines.back().find(file.filename().string()), std::string::npos);
  }
}

std::string folder_name(const testing::TestParamInfo<std::string>& info) {
  return case_name(info.param);
}

INSTANTIATE_TEST_SUITE_P(Formats, CommandOverCorpusOf,
                         testing::Values("bpt", "catmark", "directions", "hull.cbor", "hull.json",
                                         "loop", "mlp", "obj", "off", "ply", "stl", "taut.cbor",
                                         "taut.json", "xyz"),
                         folder_name);

}  // namespace
}  // namespace taut_test
