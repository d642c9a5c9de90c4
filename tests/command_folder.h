#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "run_command.h"
#include "temporary_folder.h"

namespace taut_test {

/// A fixture that runs the built command in a folder of the test's own.
class CommandFolder : public TemporaryFolder {
 protected:
  /// `arguments` as a shell reads them; `before` stands before the command.
  Result run(const std::string& arguments, const std::string& before = "") const {
    const std::filesystem::path errors = folder_.string() + ".stderr";
    const std::string line =
        "cd '" + folder_.string() + "' && " + before + " '" TAUT_EXECUTABLE "' " + arguments;
    return run_line(line, errors);
  }

  /// Expects a failure: the exit code, one line on stderr, and nothing on stdout.
  void expect_failure(const std::string& arguments, int exit_code, const std::string& words) const {
    const Result result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << arguments << "\n" << result.err;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_TRUE(result.err.starts_with("taut: ")) << arguments << "\n" << result.err;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(words), std::string::npos) << arguments << "\n" << result.err;
  }

  /// Writes a file and returns its name.
  std::string plant(const std::string& name, const std::string& text) const {
    return file(name, text).filename().string();
  }

  const std::string teapot_ = TAUT_SOURCE_DIR "/data/teapot.bpt";
};

}  // namespace taut_test
