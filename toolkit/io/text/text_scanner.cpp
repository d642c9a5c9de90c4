#include "taut/io/text/text_scanner.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "taut/io/text/gunzip.h"

namespace taut {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// A table, since six comparisons for each character would take longer than the numbers do.
constexpr std::array<bool, 256> space_table() {
  std::array<bool, 256> table = {};
  for (const unsigned char c : {' ', '\t', '\n', '\r', '\v', '\f'}) table[c] = true;
  return table;
}

bool is_space(char c) {
  static constexpr std::array<bool, 256> table = space_table();
  return table[static_cast<unsigned char>(c)];
}

/// std::from_chars knows no '+'.
std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return plus ? text.substr(1) : text;
}

/// "1.#INF", "-1.#IND" and the like, as printed by Microsoft's C library.
bool is_microsoft_nonfinite(std::string_view text) {
  return text.find(".#I") != text.npos || text.find(".#Q") != text.npos ||
         text.find(".#S") != text.npos;
}

/// Whether a decimal number that std::from_chars finds out of range is too small for a double
/// rather than too large. @pre digits with at most one point, then perhaps an exponent; not zero
bool underflows(std::string_view number) {
  const std::size_t mantissa_end = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = std::min(number.find('.'), mantissa_end);
  const std::size_t leading = number.find_first_of("123456789");
  if (leading >= mantissa_end) return true;
  const double magnitude = leading < point ? static_cast<double>(point - leading)
                                           : -static_cast<double>(leading - point - 1);
  if (mantissa_end == number.size()) return magnitude < 0;
  long exponent = 0;
  const std::string_view digits = without_plus(number.substr(mantissa_end + 1));
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
  if (result.ec == std::errc::result_out_of_range) return digits.starts_with('-');
  return magnitude + static_cast<double>(exponent) < 0;
}

}  // namespace

std::string read_file(const std::filesystem::path& path, const Progress& progress) {
  const std::string name = path.string();
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw IoError(name + ": is a folder; name a file in it");
  if (std::filesystem::is_character_file(path, error)) throw IoError(name + ": is a device");
  const std::unique_ptr<std::FILE, Close> file(std::fopen(name.c_str(), "rb"));
  if (!file) throw IoError(name + ": cannot be opened: " + std::strerror(errno));

  const LimitExceeded too_large(name + ": is larger than " + std::to_string(max_file_bytes >> 20) +
                                " MiB, the most that is read");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > max_file_bytes) throw too_large;

  // Pipes tell no size and files may grow, so only what is read counts. One byte more than the
  // size lets a file that keeps its size end without another round.
  std::string data(error ? 1 << 16 : static_cast<std::size_t>(size) + 1, '\0');
  std::size_t used = 0;
  while (true) {
    const std::size_t got = std::fread(data.data() + used, 1, data.size() - used, file.get());
    used += got;
    if (used > max_file_bytes) throw too_large;
    if (used < data.size()) break;
    data.resize(2 * data.size());
  }
  if (std::ferror(file.get()) != 0) throw IoError(name + ": cannot be read");
  data.resize(used);
  if (is_gzipped(data)) return gunzipped(name, data, progress);
  return data;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, longest)) text += ' ' <= c && c <= '~' ? c : '?';
  return text + (word.size() > longest ? "...\"" : "\"");
}

std::string shortest(double value) {
  std::array<char, 32> digits;  // the longest has 24
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), result.ptr};
}

TextScanner::TextScanner(std::string file, std::string_view text)
    : file_(std::move(file)), text_(text) {
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
}

/// The offset behind the line end that begins at i, or i if there is none.
std::size_t TextScanner::line_end_at(std::size_t i) const {
  if (i < text_.size() && text_[i] == '\n') return i + 1;
  if (i < text_.size() && text_[i] == '\r') {
    return i + 1 < text_.size() && text_[i + 1] == '\n' ? i + 2 : i + 1;
  }
  return i;
}

void TextScanner::skip_space(bool over_lines, bool continuation) {
  while (at_ < text_.size()) {
    const char c = text_[at_];
    if (c == '\n' || c == '\r') {
      if (!over_lines) return;
      at_ = line_end_at(at_);
      ++line_;
    } else if (is_space(c)) {
      ++at_;
    } else if (c == '#') {
      at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
    } else if (continuation && c == '\\' && line_end_at(at_ + 1) != at_ + 1) {
      at_ = line_end_at(at_ + 1);
      ++line_;
    } else {
      return;
    }
  }
}

Word TextScanner::read_word(bool continuation) {
  const std::size_t begin = at_;
  while (at_ < text_.size() && !is_space(text_[at_])) {
    if (continuation && text_[at_] == '\\' && line_end_at(at_ + 1) != at_ + 1) break;
    ++at_;
  }
  return {text_.substr(begin, at_ - begin), line_};
}

bool TextScanner::at_end() {
  skip_space(true, false);
  return at_ == text_.size();
}

Word TextScanner::next(std::string_view expected) {
  if (at_end()) fail(line_, "the file ends where " + std::string(expected) + " is expected");
  return read_word(false);
}

double TextScanner::next_number(std::string_view expected) {
  if (at_end()) fail(line_, "the file ends where " + std::string(expected) + " is expected");
  // Nearly all numbers can be taken where they stand, without looking for the word's end before.
  double value = 0;
  const char* const end = text_.data() + text_.size();
  const auto [rest, error] = std::from_chars(text_.data() + at_, end, value);
  if (error == std::errc() && (rest == end || is_space(*rest)) && std::isfinite(value)) {
    at_ = static_cast<std::size_t>(rest - text_.data());
    return value;
  }
  return number(read_word(false), expected);
}

void TextScanner::skip_line() { rest_of_line(); }

std::string_view TextScanner::rest_of_line() {
  const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  const std::string_view rest = text_.substr(at_, end - at_);
  at_ = line_end_at(end);
  if (at_ != end) ++line_;
  return rest;
}

bool TextScanner::next_statement(std::vector<Word>& words) {
  words.clear();
  skip_space(true, true);
  while (at_ < text_.size() && line_end_at(at_) == at_) {
    words.push_back(read_word(true));
    skip_space(false, true);
  }
  return !words.empty();
}

double TextScanner::number(const Word& word, std::string_view expected) const {
  const std::string_view text = without_plus(word.text);
  const char* const end = text.data() + text.size();
  double value = 0;
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || (rest != end && !is_microsoft_nonfinite(text))) {
    fail(word.line, std::string(expected) + " expected, found " + in_quotes(word.text));
  }
  if (rest != end || !std::isfinite(value)) {
    refuse(word.line, std::string(expected) + " is not finite: " + in_quotes(word.text));
  }
  if (error == std::errc::result_out_of_range) {
    if (underflows(text)) return text.starts_with('-') ? -0.0 : 0.0;
    refuse(word.line, std::string(expected) + " is too large: " + in_quotes(word.text));
  }
  return value;
}

long TextScanner::integer(const Word& word, std::string_view expected) const {
  const std::string_view text = without_plus(word.text);
  const char* const end = text.data() + text.size();
  long value = 0;
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::invalid_argument || rest != end) {
    fail(word.line, std::string(expected) + " expected, found " + in_quotes(word.text));
  }
  if (error == std::errc::result_out_of_range) {
    refuse(word.line, std::string(expected) + " is out of range: " + in_quotes(word.text));
  }
  return value;
}

std::size_t TextScanner::count(const Word& word, std::size_t bytes, std::string_view things) const {
  const long value = integer(word, "the number of " + std::string(things));
  if (value < 0) {
    refuse(word.line,
           "the number of " + std::string(things) + " is negative: " + in_quotes(word.text));
  }
  const auto number = static_cast<std::size_t>(value);
  if (number > (bytes_left() + 1) / bytes) {
    refuse(word.line, std::to_string(value) + " " + std::string(things) +
                          " announced, more than the remaining " + std::to_string(bytes_left()) +
                          " bytes can hold");
  }
  return number;
}

void TextScanner::fail(long line, std::string_view what) const {
  throw IoError(file_ + ":" + std::to_string(line) + ": " + std::string(what));
}

void TextScanner::refuse(long line, std::string_view what) const {
  throw InvalidInput(file_ + ":" + std::to_string(line) + ": " + std::string(what));
}

}  // namespace taut
