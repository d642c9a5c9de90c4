#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "temporary_folder.h"

namespace taut_test {

/// What one run of a command gave.
struct Result {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs a line of the shell; `errors` is a file that its stderr goes through.
inline Result run_line(const std::string& line, const std::filesystem::path& errors) {
  Result result;
  std::FILE* pipe = popen((line + " 2>'" + errors.string() + "'").c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer;
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.out.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  result.err = content(errors);
  std::filesystem::remove(errors);
  return result;
}

}  // namespace taut_test
