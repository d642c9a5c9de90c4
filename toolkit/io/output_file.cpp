#include "taut/io/output_file.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include "taut/core/error.h"

namespace taut {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  // Opened only where no file is, so that two writers and what a crash left do not meet.
  constexpr int attempts = 1000;
  for (int i = 0; i < attempts && !file_; ++i) {
    temporary_ = path_;
    temporary_ += ".tmp" + std::to_string(i);
    file_.reset(std::fopen(temporary_.string().c_str(), "wbx"));
    if (!file_ && errno != EEXIST) break;
  }
  if (!file_) {
    const int error = errno;
    temporary_.clear();
    fail("cannot be written", reason(error));
  }
}

OutputFile::~OutputFile() {
  file_.reset();
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void OutputFile::drain() {
  if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size()) {
    fail("cannot be written", reason(errno));
  }
  buffer_.clear();
}

void OutputFile::finish() {
  drain();
  if (std::fclose(file_.release()) != 0) fail("cannot be written", reason(errno));
}

void OutputFile::publish() {
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) fail("cannot be replaced", error.message());
  temporary_.clear();
}

void OutputFile::withdraw() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void OutputFile::fail(std::string_view what, const std::string& why) const {
  throw IoError(path_.string() + ": " + std::string(what) + ": " + why);
}

}  // namespace taut
