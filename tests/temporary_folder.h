#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "error_checks.h"

namespace taut_test {

/// A fixture with an empty folder of its own that goes with the test.
class TemporaryFolder : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        ("taut_" + std::to_string(getpid()) + "_" + test->test_suite_name() + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  /// Writes a file and returns its path.
  std::filesystem::path file(const std::string& name, std::string_view content) const {
    // A file that is truncated goes to the disk when it is closed, a new one need not.
    std::filesystem::remove(path(name));
    std::ofstream stream(path(name), std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    return path(name);
  }

  /// What behind a file's path the message of the `Error` says that the call throws.
  template <class Error, class Call>
  std::string message_behind(const std::string& name, const Call& call) const {
    const std::string what = message_of<Error>(call);
    const std::string file = path(name).string();
    EXPECT_TRUE(what.starts_with(file)) << what;
    EXPECT_EQ(what.find('\n'), what.npos) << what;
    return what.substr(std::min(file.size(), what.size()));
  }

  std::size_t file_count() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_)) ++count;
    return count;
  }

  std::filesystem::path folder_;
};

inline std::string content(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace taut_test
