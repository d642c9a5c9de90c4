#include "directions.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <string_view>

#include "standard_input.h"
#include "taut/core/error.h"
#include "text.h"

namespace taut::tool {
namespace {

/// Three numbers and a comment are shorter; what is longer is no such file.
constexpr std::size_t max_line_length = 4096;

/// Reads lines from a file or standard input, which may be a terminal or a pipe: it wakes up now
/// and then to see whether it should stop.
class LineReader {
 public:
  LineReader(const std::string& path, const Stop& stop)
      : name_(path == "-" ? standard_input : path),
        descriptor_(path == "-" ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC)),
        stop_(stop) {
    if (descriptor_ < 0) throw IoError(name_ + ": cannot be read: " + system_reason());
  }
  ~LineReader() {
    if (descriptor_ != STDIN_FILENO) close(descriptor_);
  }
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// The next line without its end; false at the end of the file.
  bool next(std::string& line) {
    line.clear();
    ++line_;
    for (;;) {
      const std::size_t end = rest_.find('\n');
      if (line.size() + std::min(end, rest_.size()) > max_line_length) {
        throw IoError(place() + "line is longer than " + number(long(max_line_length)) +
                      " characters");
      }
      line += rest_.substr(0, end);
      if (end != std::string_view::npos) {
        rest_.remove_prefix(end + 1);
        return true;
      }
      if (!fill()) return !line.empty();
    }
  }

  /// "FILE:LINE: " of the last line.
  std::string place() const { return name_ + ":" + number(line_) + ": "; }

 private:
  bool fill() {
    const std::size_t count = read_some(descriptor_, buffer_, name_, stop_);
    rest_ = std::string_view(buffer_.data(), count);
    return count > 0;
  }

  std::string name_;
  int descriptor_;
  Stop stop_;
  std::array<char, 65536> buffer_;
  std::string_view rest_;
  long line_ = 0;
};

/// The columns of a line up to a comment. They stand apart by blanks, or by one comma or semicolon
/// each, the same way within a line, as in files of points.
std::vector<std::string_view> columns(std::string_view line, const std::string& place) {
  constexpr std::string_view blanks = " \t\r\v\f";
  line = line.substr(0, line.find('#'));
  const auto skip_blanks = [&] {
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  };
  std::vector<std::string_view> found;
  std::string separators;  // the kinds of them that were met
  for (skip_blanks(); !line.empty(); skip_blanks()) {
    const std::size_t end = std::min(line.find_first_of(" \t\r\v\f,;"), line.size());
    found.push_back(line.substr(0, end));
    line.remove_prefix(end);
    skip_blanks();
    if (line.empty()) break;
    const bool by_blanks = line.front() != ',' && line.front() != ';';
    const char separator = by_blanks ? ' ' : line.front();
    if (!by_blanks) line.remove_prefix(1);
    if (separators.find(separator) == std::string::npos) separators += separator;
  }
  if (separators.size() > 1) {
    throw IoError(place + "columns stand apart in more than one way; decimal commas are not read");
  }
  return found;
}

/// Three finite numbers; `what` they are.
dvec3 parse_vector(const std::vector<std::string_view>& fields, const std::string& place,
                   const std::string& what) {
  if (fields.size() != 3) {
    throw IoError(place + "a " + what + " has three numbers, found " +
                  counted(long(fields.size()), "word", "words"));
  }
  dvec3 vector(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string_view field = fields[std::size_t(axis)];
    const auto value = parse_number(field);
    if (!value) throw IoError(place + "'" + printable(field, 40) + "' is no number");
    if (!std::isfinite(*value)) {
      throw InvalidInput(place + "'" + printable(field, 40) + "' is not finite");
    }
    vector[axis] = *value;
  }
  return vector;
}

/// Calls take with the vector of each line and its place.
template <class Take>
void read_vectors(const std::string& path, const Stop& stop, const std::string& what, Take take) {
  LineReader reader(path, stop);
  std::string line;
  while (reader.next(line)) {
    const auto fields = columns(line, reader.place());
    if (!fields.empty()) take(parse_vector(fields, reader.place(), what), reader.place());
  }
}

}  // namespace

std::vector<dvec3> read_directions(const std::string& path, const Stop& stop) {
  std::vector<dvec3> directions;
  read_vectors(path, stop, "direction", [&](const dvec3& direction, const std::string& place) {
    if (direction == dvec3(0.0)) throw InvalidInput(place + "the zero vector is no direction");
    directions.push_back(direction);
  });
  return directions;
}

std::vector<dvec3> read_points(const std::string& path, const Stop& stop) {
  std::vector<dvec3> points;
  read_vectors(path, stop, "point",
               [&](const dvec3& point, const std::string&) { points.push_back(point); });
  return points;
}

}  // namespace taut::tool
