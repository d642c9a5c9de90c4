#include "taut/io/text/output_file.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include "taut/core/error.h"
#include "taut/io/text/whole_file.h"

namespace taut {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

/// What abandon_files() removes.
struct Unpublished {
  std::timed_mutex mutex;  // held while files come and go
  std::vector<const std::filesystem::path*> files;

  void remove(const std::filesystem::path& file) {
    files.erase(std::remove(files.begin(), files.end(), &file), files.end());
  }
};

/// Never destroyed: a process may end while files are written.
Unpublished& unpublished() {
  static auto& files = *new Unpublished;
  return files;
}

}  // namespace

void abandon_files() {
  // For good: nothing is published any more.
  if (!unpublished().mutex.try_lock_for(std::chrono::seconds(1))) return;
  for (const std::filesystem::path* file : unpublished().files) {
    std::error_code ignored;
    std::filesystem::remove(*file, ignored);
  }
}

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  OutputFile file(path);
  file.text(content);
  file.finish();
  file.publish();
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  // Opened only where no file is, so that two writers and what a crash left do not meet.
  constexpr int attempts = 1000;
  const std::lock_guard lock(unpublished().mutex);
  unpublished().files.reserve(unpublished().files.size() + 1);  // no file stays if there is no room
  for (int i = 0; i < attempts && !file_; ++i) {
    temporary_ = path_;
    temporary_ += ".tmp" + std::to_string(i);
    file_.reset(std::fopen(temporary_.string().c_str(), "wbx"));
    if (!file_ && errno != EEXIST) break;
  }
  if (!file_) {
    const int error = errno;
    temporary_.clear();
    std::error_code ignored;
    const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
    const bool refuses = error == ENOENT && std::filesystem::is_directory(folder, ignored);
    fail("cannot be written",
         refuses ? "the folder " + folder.string() + " takes no new files" : reason(error));
  }
  unpublished().files.push_back(&temporary_);
}

OutputFile::~OutputFile() {
  file_.reset();
  if (temporary_.empty()) return;
  const std::lock_guard lock(unpublished().mutex);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
  unpublished().remove(temporary_);
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
  const std::lock_guard lock(unpublished().mutex);
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) fail("cannot be replaced", error.message());
  unpublished().remove(temporary_);
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
