#include "taut/io/model/read_xyz.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_word_end(char c) { return is_blank(c) || is_line_end(c) || c == ',' || c == ';'; }

/// Files have tens of millions of lines, so numbers are taken where they stand; words for the
/// scanner, which knows all that a number may be and says what is wrong, are made of the rest only.
class XyzReader {
 public:
  XyzReader(const std::string& file, std::string_view data)
      : scanner_(file, data),
        at_(data.data() + scanner_.offset()),
        end_(data.data() + data.size()) {}

  std::vector<dvec3> read(const Progress& progress);

 private:
  bool at_line_end() const { return at_ == end_ || is_line_end(*at_); }
  bool at_content_end() const { return at_line_end() || *at_ == '#'; }
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }
  std::size_t most_points() const;
  void pass_line_end();
  bool read_names();
  void read_line();
  double read_number();
  double read_unusual_number();
  char read_separator();
  void read_count(const Word& word);
  void check_count() const;

  TextScanner scanner_;
  const char* at_;
  const char* end_;
  long line_ = 1;
  std::vector<dvec3> points_;
  bool first_ = true;  ///< nothing but comments came before
  std::optional<std::size_t> announced_;
  long announced_line_ = 0;
};

std::vector<dvec3> XyzReader::read(const Progress& progress) {
  constexpr long lines_per_update = 65536;
  const double bytes = static_cast<double>(bytes_left());
  points_.reserve(most_points());
  while (at_ != end_) {
    if (line_ % lines_per_update == 1) {
      progress.update("read", 1 - static_cast<double>(bytes_left()) / bytes);
    }
    skip_blanks();
    if (!at_content_end()) read_line();
    while (!at_line_end()) ++at_;
    pass_line_end();
  }
  check_count();
  return std::move(points_);
}

/// By the number of lines and the shortest of them.
std::size_t XyzReader::most_points() const {
  constexpr std::size_t line_bytes = 6;
  const auto lines = std::max(std::count(at_, end_, '\n'), std::count(at_, end_, '\r')) + 1;
  return std::min(static_cast<std::size_t>(lines), (bytes_left() + 1) / line_bytes);
}

void XyzReader::pass_line_end() {
  if (at_ == end_) return;
  const bool carriage_return = *at_++ == '\r';
  if (carriage_return && at_ != end_ && *at_ == '\n') ++at_;
  ++line_;
}

/// Passes over the names of columns where they stand.
bool XyzReader::read_names() {
  constexpr std::string_view axes = "xyz";
  const char* const begin = at_;
  for (const char axis : axes) {
    const char* const end = std::find_if(at_, end_, is_word_end);
    std::string_view name(at_, static_cast<std::size_t>(end - at_));
    if (name.size() == 3 && name.front() == '"' && name.back() == '"') name = name.substr(1, 1);
    if (name.size() != 1 || (name[0] != axis && name[0] != axis - 'a' + 'A')) {
      at_ = begin;
      return false;
    }
    at_ = end;
    read_separator();
  }
  return true;
}

/// @pre the line has a word
void XyzReader::read_line() {
  if (first_ && read_names()) {
    first_ = false;
    return;
  }
  if (announced_ && points_.size() == *announced_) {
    scanner_.fail(line_, "more follows the last of the " + std::to_string(*announced_) +
                             " points that were announced");
  }
  dvec3 point;
  char separators[3] = {};
  for (int i = 0; i < 3; ++i) {
    if (at_content_end()) {
      scanner_.fail(line_, "three coordinates expected, found " + std::to_string(i));
    }
    const char* const begin = at_;
    point[i] = read_number();
    const Word word = {{begin, static_cast<std::size_t>(at_ - begin)}, line_};
    separators[i] = read_separator();
    if (first_ && i == 0 && at_content_end()) return read_count(word);
  }
  if (separators[0] != separators[1] || (!at_content_end() && separators[1] != separators[2])) {
    scanner_.fail(line_, "columns stand apart in more than one way; decimal commas are not read");
  }
  points_.push_back(point);
  first_ = false;
}

double XyzReader::read_number() {
  double value = 0;
  const auto [rest, error] = std::from_chars(at_, end_, value);
  if (error != std::errc() || (rest != end_ && !is_word_end(*rest)) || !std::isfinite(value)) {
    return read_unusual_number();
  }
  at_ = rest;
  return value;
}

double XyzReader::read_unusual_number() {
  const char* const begin = at_;
  at_ = std::find_if(at_, end_, is_word_end);
  const Word word = {{begin, static_cast<std::size_t>(at_ - begin)}, line_};
  try {
    return scanner_.number(word, "a coordinate");
  } catch (const IoError& error) {
    if (!announced_ || !points_.empty()) throw;
    throw IoError(std::string(error.what()) + "; files of molecules are not read");
  }
}

/// Passes over what stands between two columns; says whether it is a comma, a semicolon or ' '.
char XyzReader::read_separator() {
  skip_blanks();
  if (at_ == end_ || (*at_ != ',' && *at_ != ';')) return ' ';
  const char separator = *at_++;
  skip_blanks();
  return separator;
}

void XyzReader::read_count(const Word& word) {
  constexpr std::size_t point_bytes = 6;
  const long count = scanner_.integer(word, "the number of points");
  if (count < 0)
    scanner_.refuse(line_, "the number of points is negative: " + in_quotes(word.text));
  if (static_cast<std::size_t>(count) > (bytes_left() + 1) / point_bytes) {
    scanner_.refuse(line_, std::to_string(count) + " points announced, more than the remaining " +
                               std::to_string(bytes_left()) + " bytes can hold");
  }
  announced_ = static_cast<std::size_t>(count);
  announced_line_ = line_;
  first_ = false;
}

void XyzReader::check_count() const {
  if (!announced_ || points_.size() == *announced_) return;
  scanner_.fail(line_, "the file ends after " + std::to_string(points_.size()) + " of the " +
                           std::to_string(*announced_) + " points that line " +
                           std::to_string(announced_line_) + " announces");
}

}  // namespace

bool is_points_format(std::string_view format) {
  constexpr std::array<std::string_view, 4> all = {".csv", ".pts", ".txt", ".xyz"};
  return std::find(all.begin(), all.end(), format) != all.end();
}

std::vector<dvec3> read_xyz(const std::string& file, std::string_view data,
                            const Progress& progress) {
  return XyzReader(file, data).read(progress);
}

}  // namespace taut
