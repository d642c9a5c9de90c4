#include "taut/io/obj/obj_tags.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

namespace taut {

/// A statement's parts.
struct ObjTagReader::Tag {
  std::string_view name;
  std::vector<long> integers;
  std::vector<double> numbers;
  std::vector<std::string_view> words;
  long line = 0;

  Tag(const TextScanner& scanner, const std::vector<Word>& s);

  [[noreturn]] void fail(const TextScanner& scanner, const std::string& what) const {
    scanner.fail(line, "the tag " + in_quotes(name) + " " + what);
  }
};

ObjTagReader::Tag::Tag(const TextScanner& scanner, const std::vector<Word>& s) : line(s[0].line) {
  if (s.size() < 3) scanner.fail(line, "t takes a name, three counts and values");
  name = s[1].text;
  std::array<std::size_t, 3> counts = {};
  std::string_view rest = s[2].text;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? rest.find('/') : rest.size();
    if (end == rest.npos) fail(scanner, "has no three counts: " + in_quotes(s[2].text));
    const long count = scanner.integer({rest.substr(0, end), line}, "a count");
    if (count < 0 || static_cast<std::size_t>(count) > s.size()) {
      fail(scanner, "has counts that do not match its values");
    }
    counts[k] = static_cast<std::size_t>(count);
    rest.remove_prefix(k < 2 ? end + 1 : end);
  }
  if (counts[0] + counts[1] + counts[2] != s.size() - 3) {
    fail(scanner, "has counts that do not match its values");
  }
  std::size_t i = 3;
  for (; i < 3 + counts[0]; ++i) integers.push_back(scanner.integer(s[i], "an integer"));
  for (; i < 3 + counts[0] + counts[1]; ++i) numbers.push_back(scanner.number(s[i], "a number"));
  for (; i < s.size(); ++i) words.push_back(s[i].text);
}

bool ObjTagReader::add(const TextScanner& scanner, const std::vector<Word>& statement) {
  const Tag tag(scanner, statement);
  const auto first_integer = [&](long from, long to) {
    if (tag.integers.size() != 1 || tag.integers[0] < from || tag.integers[0] > to) {
      tag.fail(scanner,
               "takes one integer of " + std::to_string(from) + " .. " + std::to_string(to));
    }
    return tag.integers[0];
  };
  // Which of two.
  const auto word = [&](const std::array<std::string_view, 2>& known) {
    if (tag.words.size() == 1 && tag.integers.empty()) {
      const auto found = std::find(known.begin(), known.end(), tag.words[0]);
      if (found != known.end()) return found - known.begin();
    }
    tag.fail(scanner, "takes one word of " + std::string(known[0]) + ", " + std::string(known[1]));
  };
  if (tag.name == "crease") {
    add_crease(scanner, tag);
  } else if (tag.name == "corner") {
    add_corners(scanner, tag);
  } else if (tag.name == "hole") {
    for (const long face : tag.integers) {
      if (face < 0 || face > std::numeric_limits<int>::max()) {
        scanner.refuse(tag.line, "there is no face " + std::to_string(face));
      }
      if (face > last_face_.index) last_face_ = {face, tag.line};
      tags_.holes.push_back(static_cast<int>(face));
    }
  } else if (tag.name == "interpolateboundary") {
    constexpr std::array rules = {CageBoundary::none, CageBoundary::edge_and_corner,
                                  CageBoundary::edge_only};
    tags_.boundary = rules[static_cast<std::size_t>(first_integer(0, 2))];
  } else if (tag.name == "creasemethod") {
    tags_.chaikin = word({"normal", "chaikin"}) == 1;
  } else if (tag.name == "smoothtriangles") {
    // OpenSubdiv's shapes have a word here, renderers' exports an integer.
    tags_.smooth_triangles =
        tag.words.empty() ? first_integer(0, 2) != 0 : word({"catmark", "smooth"}) == 1;
  } else {
    // Face-varying data do not change the surface.
    return tag.name.starts_with("facevarying");
  }
  return true;
}

int ObjTagReader::vertex(const TextScanner& scanner, long index, long line) {
  if (index < 0 || index > std::numeric_limits<int>::max()) {
    scanner.refuse(line, "there is no vertex " + std::to_string(index));
  }
  if (index > last_vertex_.index) last_vertex_ = {index, line};
  return static_cast<int>(index);
}

void ObjTagReader::add_crease(const TextScanner& scanner, const Tag& tag) {
  const std::size_t edges = tag.integers.empty() ? 0 : tag.integers.size() - 1;
  if (edges == 0 || (tag.numbers.size() != 1 && tag.numbers.size() != edges)) {
    tag.fail(scanner, "takes two vertices or more, and one sharpness or one for each edge");
  }
  for (std::size_t k = 0; k < edges; ++k) {
    const double sharpness = tag.numbers[tag.numbers.size() == 1 ? 0 : k];
    if (sharpness < 0) scanner.refuse(tag.line, "a sharpness is negative");
    const int a = vertex(scanner, tag.integers[k], tag.line);
    const int b = vertex(scanner, tag.integers[k + 1], tag.line);
    if (a == b) scanner.refuse(tag.line, "a crease has one vertex at both ends");
    tags_.creases.push_back({{a, b}, sharpness});
  }
}

void ObjTagReader::add_corners(const TextScanner& scanner, const Tag& tag) {
  const std::size_t count = tag.integers.size();
  if (count == 0 || (tag.numbers.size() != 1 && tag.numbers.size() != count)) {
    tag.fail(scanner, "takes vertices, and one sharpness or one for each");
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double sharpness = tag.numbers[tag.numbers.size() == 1 ? 0 : k];
    if (sharpness < 0) scanner.refuse(tag.line, "a sharpness is negative");
    tags_.corners.push_back({vertex(scanner, tag.integers[k], tag.line), sharpness});
  }
}

void ObjTagReader::check(const TextScanner& scanner, std::size_t vertices,
                         std::size_t faces) const {
  if (last_vertex_.index >= 0 && static_cast<std::size_t>(last_vertex_.index) >= vertices) {
    scanner.refuse(last_vertex_.line, "a tag names vertex " + std::to_string(last_vertex_.index) +
                                          " (from 0), but there are " + std::to_string(vertices));
  }
  if (last_face_.index >= 0 && static_cast<std::size_t>(last_face_.index) >= faces) {
    scanner.refuse(last_face_.line, "a tag names face " + std::to_string(last_face_.index) +
                                        " (from 0), but there are " + std::to_string(faces));
  }
}

}  // namespace taut
