#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "taut/io/mesh/mesh_readers.h"
#include "taut/io/text/binary_scanner.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

/// Gives equal points the same number, in the order of their first coming.
class PointIndex {
 public:
  int operator()(const dvec3& point) {
    // A zero's sign makes no other point.
    const dvec3 key = point + dvec3(0.0);
    const auto [entry, is_new] = index_.try_emplace(key, static_cast<int>(points.size()));
    if (is_new) points.push_back(point);
    return entry->second;
  }

  std::vector<dvec3> points;

 private:
  struct Hash {
    std::size_t operator()(const dvec3& p) const {
      std::uint64_t hash = 0;
      for (int i = 0; i < 3; ++i) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(p[i])) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32;
      }
      return static_cast<std::size_t>(hash);
    }
  };
  std::unordered_map<dvec3, int, Hash> index_;
};

constexpr std::size_t header_bytes = 80;
constexpr std::size_t triangle_bytes = 4 * 3 * 4 + 2;
constexpr std::size_t triangles_per_update = 16384;

/// Whether the announced number of triangles fills the file exactly. Many binary files begin with
/// the word "solid" too, so the length is asked first.
bool has_binary_length(const std::string& file, std::string_view data) {
  if (data.size() < header_bytes + 4) return false;
  BinaryScanner scanner(file, data, header_bytes, ByteOrder::little);
  return scanner.next<std::uint32_t>() * std::uint64_t{triangle_bytes} == scanner.bytes_left();
}

PolygonMesh read_binary(const std::string& file, std::string_view data, const Progress& progress) {
  BinaryScanner scanner(file, data, 0, ByteOrder::little);
  scanner.skip(header_bytes);
  const auto count = scanner.next<std::uint32_t>();
  if (count > scanner.bytes_left() / triangle_bytes) {
    scanner.refuse(std::to_string(count) + " triangles announced, more than the remaining " +
                   std::to_string(scanner.bytes_left()) + " bytes can hold");
  }
  PolygonMesh mesh;
  mesh.polygons.reserve(count);
  PointIndex index;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i % triangles_per_update == 0) {
      progress.update("read", static_cast<double>(i) / static_cast<double>(count));
    }
    scanner.skip(3 * 4);  // the normal
    for (int& corner : mesh.polygons.emplace_back(3)) {
      dvec3 p;
      for (int k = 0; k < 3; ++k) {
        p[k] = static_cast<double>(scanner.next<float>());
        if (!std::isfinite(p[k])) {
          scanner.refuse("a coordinate of triangle " + std::to_string(i) + " is not finite");
        }
      }
      corner = index(p);
    }
    scanner.skip(2);  // attributes
  }
  mesh.points = std::move(index.points);
  return mesh;
}

/// In either case, as keywords are. @pre the keyword is of small letters
bool is_keyword(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return (a | 0x20) == b; });
}

/// Begins with "solid" and has no zero byte where a binary file has its number of triangles, or
/// padding before it.
bool looks_like_text(std::string_view data) {
  constexpr std::string_view solid = "solid";
  TextScanner scanner("", data);
  if (scanner.at_end()) return false;
  return is_keyword(data.substr(scanner.offset(), solid.size()), solid) &&
         data.substr(0, header_bytes + 4).find('\0') == data.npos;
}

/// The text form.
class AsciiReader {
 public:
  AsciiReader(const std::string& file, std::string_view data) : scanner_(file, data) {}

  PolygonMesh read(const Progress& progress) {
    PolygonMesh mesh;
    bool open = false;
    const double bytes = static_cast<double>(scanner_.bytes_left());
    while (!scanner_.at_end()) {
      if (mesh.polygons.size() % triangles_per_update == 0) {
        progress.update("read", 1 - static_cast<double>(scanner_.bytes_left()) / bytes);
      }
      const Word word = scanner_.next("facet");
      if (is(word, "solid") || is(word, "endsolid")) {
        open = is(word, "solid");
        scanner_.skip_line();  // a name of any words
      } else if (is(word, "facet")) {
        mesh.polygons.push_back(read_triangle());
      } else {
        scanner_.fail(word.line, "facet or endsolid expected, found " + in_quotes(word.text));
      }
    }
    if (open) scanner_.fail(scanner_.line(), "the file ends where endsolid is expected");
    mesh.points = std::move(index_.points);
    return mesh;
  }

 private:
  static bool is(const Word& word, std::string_view keyword) {
    return is_keyword(word.text, keyword);
  }

  void expect(std::string_view keyword) {
    const Word word = scanner_.next(keyword);
    if (!is(word, keyword)) {
      scanner_.fail(word.line, std::string(keyword) + " expected, found " + in_quotes(word.text));
    }
  }

  std::vector<int> read_triangle() {
    expect("normal");
    for (int k = 0; k < 3; ++k) scanner_.next("a normal");  // of any value, often zero or NaN
    expect("outer");
    expect("loop");
    std::vector<int> triangle(3);
    for (int& corner : triangle) {
      expect("vertex");
      dvec3 p;
      for (int k = 0; k < 3; ++k) p[k] = scanner_.next_number("a coordinate");
      corner = index_(p);
    }
    expect("endloop");
    expect("endfacet");
    return triangle;
  }

  TextScanner scanner_;
  PointIndex index_;
};

}  // namespace

PolygonMesh read_stl(const std::string& file, std::string_view data, const Progress& progress) {
  if (has_binary_length(file, data) || !looks_like_text(data)) {
    return read_binary(file, data, progress);
  }
  return AsciiReader(file, data).read(progress);
}

}  // namespace taut
