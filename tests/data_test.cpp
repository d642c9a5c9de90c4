// The folder data/: its model documents are those that tools/data writes, and each is described.

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "data_models.h"
#include "taut/io/document/write_document.h"
#include "taut/io/model/read_model.h"
#include "temporary_folder.h"

namespace taut {
namespace {

namespace fs = std::filesystem;
using taut_test::content;
using taut_test::TemporaryFolder;

class Data : public TemporaryFolder {};

TEST_F(Data, IsWhatTheGeneratorWrites) {
  std::set<std::string> written;
  for (const auto& [name, model] : shapes::data_models()) {
    const std::string file = name + ".taut.json";
    EXPECT_TRUE(written.insert(file).second) << name << " stands twice";
    write_model(path(file), model);
    EXPECT_EQ(content(path(file)), content(fs::path(TAUT_DATA) / file))
        << file << ": run write_data";
  }
  for (const auto& entry : fs::directory_iterator(TAUT_DATA)) {
    const std::string file = entry.path().filename().string();
    EXPECT_TRUE(!file.ends_with(".taut.json") || written.contains(file)) << file;
  }
}

TEST_F(Data, IsReadAndDescribed) {
  const std::string description = content(fs::path(TAUT_DATA) / "README.md");
  int files = 0;
  for (const auto& entry : fs::directory_iterator(TAUT_DATA)) {
    const std::string file = entry.path().filename().string();
    if (file == "README.md") continue;
    ++files;
    EXPECT_NE(description.find("| `" + file + "` |"), std::string::npos) << file;
    if (!file.ends_with(".taut.json")) continue;
    Model model;
    read_model(entry.path(), model);
    EXPECT_FALSE(model.empty()) << file;
    EXPECT_EQ(to_document(model, DocumentEncoding::json), content(entry.path())) << file;
  }
  EXPECT_GE(files, 15);
}

}  // namespace
}  // namespace taut
