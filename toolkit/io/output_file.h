#pragma once

#include <array>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace taut {

/// A file that appears whole or not at all: it is written under a temporary name beside the target
/// and takes the target's name when published. Without that the destructor removes it.
class OutputFile {
 public:
  /// @throws IoError if the folder cannot be written to, as do all that follow where they fail
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  OutputFile& text(std::string_view text);
  OutputFile& text(long number);
  /// The shortest decimal form that reads back as the same double.
  OutputFile& text(double number);
  /// The number's bytes, the lowest first.
  template <class Number>
  OutputFile& binary(Number number);

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
  void flush();
  [[noreturn]] void fail(std::string_view what, const std::string& why) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty when published
  std::unique_ptr<std::FILE, Close> file_;
  std::string buffer_;
};

template <class Number>
OutputFile& OutputFile::binary(Number number) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if constexpr (std::endian::native == std::endian::little) {
    return text({bytes.data(), bytes.size()});
  } else {
    return text(std::string(bytes.rbegin(), bytes.rend()));
  }
}

}  // namespace taut
