#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "taut/io/mesh/mesh_readers.h"
#include "taut/io/text/binary_scanner.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::float64:
      return 8;
    default:
      return 4;
  }
}

/// A value of every element, or a list of values behind its length.
struct Property {
  std::string name;
  Type type = Type::float32;
  std::optional<Type> length_type;
};

bool lists_vertices(const Property& p) {
  return p.length_type && (p.name == "vertex_indices" || p.name == "vertex_index");
}

struct Element {
  std::string name;
  std::size_t count = 0;
  long line = 0;
  std::vector<Property> properties;
};

enum class Encoding { ascii, binary_little_endian, binary_big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
};

class HeaderReader {
 public:
  explicit HeaderReader(TextScanner& scanner) : scanner_(scanner) {}
  Header read();

 private:
  void read_line(const std::vector<Word>& line);
  Encoding encoding(const Word& word) const;
  Type type(const Word& word) const;
  Property property(const std::vector<Word>& line) const;
  std::vector<Word> words();
  void check_room();
  void check_faces();

  TextScanner& scanner_;
  Header header_;
  bool has_format_ = false;
};

/// The values of the elements as text.
class AsciiValues {
 public:
  explicit AsciiValues(const TextScanner& scanner) : scanner_(scanner) {}

  double real(Type) { return scanner_.next_number("a coordinate"); }
  std::int64_t integer(Type) { return scanner_.integer(take("an integer"), "an integer"); }
  void skip(Type, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) scanner_.next("a value");
  }
  std::size_t bytes_left() const { return scanner_.bytes_left(); }
  bool can_hold(Type, std::size_t count) const { return count <= (scanner_.bytes_left() + 1) / 2; }
  [[noreturn]] void refuse(const std::string& what) const { scanner_.refuse(word_.line, what); }

 private:
  const Word& take(std::string_view expected) { return word_ = scanner_.next(expected); }

  TextScanner scanner_;
  Word word_;
};

/// The values of the elements as bytes.
class BinaryValues {
 public:
  explicit BinaryValues(const BinaryScanner& scanner) : scanner_(scanner) {}

  double real(Type type);
  std::int64_t integer(Type type);
  void skip(Type type, std::size_t count) { scanner_.skip(count * size_of(type)); }
  std::size_t bytes_left() const { return scanner_.bytes_left(); }
  bool can_hold(Type type, std::size_t count) const {
    return count <= scanner_.bytes_left() / size_of(type);
  }
  [[noreturn]] void refuse(const std::string& what) const { scanner_.refuse(what); }

 private:
  BinaryScanner scanner_;
};

Header HeaderReader::read() {
  if (scanner_.rest_of_line().substr(0, 3) != "ply") scanner_.fail(1, "a PLY file begins with ply");
  while (true) {
    const std::vector<Word> line = words();
    if (line.empty()) continue;
    if (line[0].text == "end_header") break;
    read_line(line);
  }
  if (!has_format_) scanner_.fail(scanner_.line() - 1, "the header has no format");
  check_room();
  check_faces();
  return std::move(header_);
}

/// The words of the next line, which ends in a line end even where data follow that look like text.
std::vector<Word> HeaderReader::words() {
  if (scanner_.bytes_left() == 0) {
    scanner_.fail(scanner_.line(), "the file ends where end_header is expected");
  }
  const long line = scanner_.line();
  const std::string_view text = scanner_.rest_of_line();
  std::vector<Word> words;
  std::size_t end = 0;
  while (true) {
    const std::size_t begin = text.find_first_not_of(" \t", end);
    if (begin == text.npos) return words;
    end = std::min(text.find_first_of(" \t", begin), text.size());
    words.push_back({text.substr(begin, end - begin), line});
  }
}

void HeaderReader::read_line(const std::vector<Word>& line) {
  const std::string_view keyword = line[0].text;
  if (keyword == "comment" || keyword == "obj_info") return;
  if (keyword == "format" && line.size() == 3) {
    header_.encoding = encoding(line[1]);
    has_format_ = true;
  } else if (keyword == "element" && line.size() == 3) {
    const std::size_t count = scanner_.count(line[2], 1, "elements");
    header_.elements.push_back({std::string(line[1].text), count, line[0].line, {}});
  } else if (keyword == "property" && !header_.elements.empty()) {
    header_.elements.back().properties.push_back(property(line));
  } else {
    scanner_.fail(line[0].line, "is no line of a PLY header: " + in_quotes(keyword));
  }
}

Encoding HeaderReader::encoding(const Word& word) const {
  if (word.text == "ascii") return Encoding::ascii;
  if (word.text == "binary_little_endian") return Encoding::binary_little_endian;
  if (word.text == "binary_big_endian") return Encoding::binary_big_endian;
  scanner_.fail(word.line, "format " + in_quotes(word.text) + " is not known");
}

Type HeaderReader::type(const Word& word) const {
  static const std::map<std::string_view, Type> types = {
      {"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
      {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
      {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
      {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
      {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
      {"float64", Type::float64}};
  const auto found = types.find(word.text);
  if (found == types.end())
    scanner_.fail(word.line, "type " + in_quotes(word.text) + " is not known");
  return found->second;
}

Property HeaderReader::property(const std::vector<Word>& line) const {
  const bool list = line.size() == 5 && line[1].text == "list";
  if (!list && line.size() != 3) scanner_.fail(line[0].line, "a property has a type and a name");
  Property property;
  property.name = line.back().text;
  property.type = type(line[line.size() - 2]);
  if (list) {
    property.length_type = type(line[2]);
    if (property.length_type == Type::float32 || property.length_type == Type::float64) {
      scanner_.fail(line[0].line, "the length of a list is no integer");
    }
  }
  return property;
}

/// Refuses numbers of elements that the rest of the file cannot hold.
void HeaderReader::check_room() {
  const bool ascii = header_.encoding == Encoding::ascii;
  for (const Element& element : header_.elements) {
    std::size_t bytes = 0;
    for (const Property& p : element.properties) {
      bytes += ascii ? 2 : size_of(p.length_type.value_or(p.type));
    }
    if (bytes > 0 && element.count > (scanner_.bytes_left() + 1) / bytes) {
      scanner_.refuse(element.line, std::to_string(element.count) + " of " +
                                        printable(element.name) +
                                        " announced, more than the remaining " +
                                        std::to_string(scanner_.bytes_left()) + " bytes can hold");
    }
  }
}

/// Refuses faces of which the vertices are not told, or not by lists.
void HeaderReader::check_faces() {
  for (const Element& element : header_.elements) {
    if (element.name != "face" || element.count == 0) continue;
    const bool told =
        std::any_of(element.properties.begin(), element.properties.end(), lists_vertices);
    if (!told) scanner_.refuse(element.line, "faces have no list of vertex_indices");
  }
}

double BinaryValues::real(Type type) {
  const double value = type == Type::float64   ? scanner_.next<double>()
                       : type == Type::float32 ? static_cast<double>(scanner_.next<float>())
                                               : static_cast<double>(integer(type));
  if (!std::isfinite(value)) refuse("a coordinate is not finite");
  return value;
}

std::int64_t BinaryValues::integer(Type type) {
  switch (type) {
    case Type::int8:
      return scanner_.next<std::int8_t>();
    case Type::uint8:
      return scanner_.next<std::uint8_t>();
    case Type::int16:
      return scanner_.next<std::int16_t>();
    case Type::uint16:
      return scanner_.next<std::uint16_t>();
    case Type::int32:
      return scanner_.next<std::int32_t>();
    case Type::uint32:
      return scanner_.next<std::uint32_t>();
    default:
      refuse("an index is no integer");
  }
}

template <class Values>
class ElementReader {
 public:
  ElementReader(const Header& header, Values values) : header_(header), values_(values) {}

  PolygonMesh read(const Progress& progress) {
    reserve();
    const double bytes = static_cast<double>(values_.bytes_left());
    for (const Element& e : header_.elements) {
      // Elements without properties take no room, so their number is no more than a word.
      for (std::size_t i = 0; i < (e.properties.empty() ? 0 : e.count); ++i) {
        constexpr std::size_t elements_per_update = 65536;
        if (i % elements_per_update == 0) {
          progress.update("read", 1 - static_cast<double>(values_.bytes_left()) / bytes);
        }
        if (e.name == "vertex") mesh_.points.emplace_back(0.0);
        for (const Property& property : e.properties) read_property(e, property);
      }
    }
    return std::move(mesh_);
  }

 private:
  /// The header's numbers are checked against the room in the file, if by the shortest elements.
  void reserve() {
    constexpr std::size_t polygon_bytes = 4;
    for (const Element& e : header_.elements) {
      if (e.name == "vertex") {
        vertex_count_ = e.count;
        mesh_.points.reserve(e.count);
      } else if (e.name == "face") {
        mesh_.polygons.reserve(std::min(e.count, values_.bytes_left() / polygon_bytes));
      }
    }
  }

  void read_property(const Element& e, const Property& p) {
    if (!p.length_type) {
      const int axis = e.name == "vertex" ? axis_of(p.name) : -1;
      if (axis >= 0) {
        mesh_.points.back()[axis] = values_.real(p.type);
      } else {
        values_.skip(p.type, 1);
      }
      return;
    }
    const std::int64_t length = values_.integer(*p.length_type);
    if (length < 0) values_.refuse("the length of a list is negative: " + std::to_string(length));
    if (!values_.can_hold(p.type, static_cast<std::size_t>(length))) {
      values_.refuse("a list of " + std::to_string(length) + " does not fit into the file");
    }
    if (e.name == "face" && lists_vertices(p)) {
      read_polygon(p.type, static_cast<std::size_t>(length));
    } else {
      values_.skip(p.type, static_cast<std::size_t>(length));
    }
  }

  void read_polygon(Type type, std::size_t corners) {
    if (corners < 3) values_.refuse("a face has fewer than three vertices");
    std::vector<int>& polygon = mesh_.polygons.emplace_back(corners);
    for (int& corner : polygon) {
      const std::int64_t index = values_.integer(type);
      if (index < 0 || static_cast<std::size_t>(index) >= vertex_count_) {
        values_.refuse("vertex index " + std::to_string(index) + " is not below " +
                       std::to_string(vertex_count_));
      }
      corner = static_cast<int>(index);
    }
  }

  static int axis_of(std::string_view name) {
    return name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : -1;
  }

  const Header& header_;
  Values values_;
  PolygonMesh mesh_;
  std::size_t vertex_count_ = 0;
};

/// Whether an element has just one property of the name.
bool has_one(const Element& e, std::string_view name) {
  return std::count_if(e.properties.begin(), e.properties.end(),
                       [&](const Property& p) { return p.name == name && !p.length_type; }) == 1;
}

void check_vertices(const TextScanner& scanner, const Header& header) {
  long found = 0;
  for (const Element& e : header.elements) {
    if (e.name != "vertex") continue;
    if (++found > 1) scanner.fail(e.line, "the element vertex stands here a second time");
    for (const char* axis : {"x", "y", "z"}) {
      if (!has_one(e, axis)) {
        scanner.fail(e.line, std::string("vertices do not have one property ") + axis);
      }
    }
  }
  if (found == 0) scanner.fail(scanner.line() - 1, "the header has no element vertex");
}

}  // namespace

PolygonMesh read_ply(const std::string& file, std::string_view data, const Progress& progress) {
  TextScanner scanner(file, data);
  const Header header = HeaderReader(scanner).read();
  check_vertices(scanner, header);
  if (header.encoding == Encoding::ascii) {
    return ElementReader(header, AsciiValues(scanner)).read(progress);
  }
  const ByteOrder order =
      header.encoding == Encoding::binary_big_endian ? ByteOrder::big : ByteOrder::little;
  return ElementReader(header, BinaryValues({file, data, scanner.offset(), order})).read(progress);
}

}  // namespace taut
