#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "taut/io/text/output_buffer.h"

namespace taut {

/// A file that appears whole or not at all: it is written under a temporary name beside the target
/// and takes the target's name when published. Without that the destructor removes it, or
/// abandon_files().
class OutputFile : public OutputBuffer {
 public:
  /// @throws IoError if the folder cannot be written to, as do all that follow where they fail
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile() override;

  /// Brings everything to the disk: what can still fail later is the name.
  void finish();
  /// Replaces the target. @pre finished
  void publish();
  /// Removes the target that publish() made.
  void withdraw();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void drain() override;
  [[noreturn]] void fail(std::string_view what, const std::string& why) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty when published
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace taut
