#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "taut/core/error.h"

namespace taut {

enum class ByteOrder { little, big };

/// Takes numbers from bytes. What is wrong is thrown as an error that begins with "FILE:byte N: ",
/// N counted from 0. The data must outlive the scanner.
class BinaryScanner {
 public:
  BinaryScanner(std::string file, std::string_view data, std::size_t offset, ByteOrder order)
      : file_(std::move(file)), data_(data), at_(offset), order_(order) {}

  std::size_t bytes_left() const { return data_.size() - at_; }

  /// @throws IoError at the end of the file
  void skip(std::size_t bytes) {
    if (bytes > bytes_left()) fail("the file ends early");
    last_ = at_;
    at_ += bytes;
  }

  template <class Number>
  Number next() {
    skip(sizeof(Number));
    std::array<char, sizeof(Number)> bytes;
    const bool as_here =
        (std::endian::native == std::endian::little) == (order_ == ByteOrder::little);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = data_[last_ + (as_here ? i : bytes.size() - 1 - i)];
    }
    return std::bit_cast<Number>(bytes);
  }

  /// The file is not what its format says. @throws IoError
  [[noreturn]] void fail(std::string_view what) const { throw IoError(message(at_, what)); }
  /// What was read last is no valid geometry. @throws InvalidInput
  [[noreturn]] void refuse(std::string_view what) const {
    throw InvalidInput(message(last_, what));
  }

 private:
  std::string message(std::size_t offset, std::string_view what) const {
    return file_ + ":byte " + std::to_string(offset) + ": " + std::string(what);
  }

  std::string file_;
  std::string_view data_;
  std::size_t at_ = 0;
  std::size_t last_ = 0;
  ByteOrder order_;
};

}  // namespace taut
