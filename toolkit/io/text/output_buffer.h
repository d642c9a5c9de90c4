#pragma once

#include <array>
#include <bit>
#include <string>
#include <string_view>

#include "taut/io/text/text_scanner.h"

namespace taut {

/// Text and numbers in the order in which they are to stand in a file.
class OutputBuffer {
 public:
  OutputBuffer() = default;
  virtual ~OutputBuffer() = default;
  OutputBuffer(const OutputBuffer&) = delete;
  OutputBuffer& operator=(const OutputBuffer&) = delete;

  OutputBuffer& text(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() >= full_bytes) drain();
    return *this;
  }
  OutputBuffer& text(long number) { return text(std::to_string(number)); }
  /// The shortest decimal form that reads back as the same double.
  OutputBuffer& text(double number) { return text(shortest(number)); }
  /// The number's bytes, the lowest first.
  template <class Number>
  OutputBuffer& binary(Number number);

  /// What was put in, save for what went elsewhere.
  const std::string& content() const { return buffer_; }

 protected:
  /// Passes the content on, where there is a place for it, and takes it out.
  virtual void drain() {}

  std::string buffer_;

 private:
  static constexpr std::size_t full_bytes = std::size_t{1} << 20;
};

template <class Number>
OutputBuffer& OutputBuffer::binary(Number number) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if constexpr (std::endian::native == std::endian::little) {
    return text({bytes.data(), bytes.size()});
  } else {
    return text(std::string(bytes.rbegin(), bytes.rend()));
  }
}

}  // namespace taut
