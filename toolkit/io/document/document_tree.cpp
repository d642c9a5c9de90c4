#include "taut/io/document/document_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

using Json = nlohmann::json;

/// Puts a document together from its parts in the order of the file.
class TreeBuilder {
 public:
  using Fail = std::function<void(const std::string& what)>;
  /// `fail` throws.
  explicit TreeBuilder(Fail fail) : fail_(std::move(fail)) {}

  template <class Value>
  void add(Value value) {
    place() = DocumentValue{std::move(value)};
  }
  template <class Container>
  void open() {
    if (std::ssize(open_) >= max_document_depth) {
      fail_("nested deeper than " + std::to_string(max_document_depth) + " levels");
    }
    DocumentValue& opened = place();
    opened.value = Container();
    // Stays where it is: what holds it does not grow until it is closed.
    open_.push_back({&opened, {}, {}});
  }
  void close() { open_.pop_back(); }
  void key(std::string text) {
    Open& object = open_.back();
    if (!object.keys.insert(text).second) fail_("the key " + in_quotes(text) + " stands twice");
    object.key = std::move(text);
  }
  DocumentValue take() { return std::move(root_); }

 private:
  struct Open {
    DocumentValue* value = nullptr;
    std::string key;             // of what comes next
    std::set<std::string> keys;  // so far
  };

  DocumentValue& place() {
    if (open_.empty()) return root_;
    Open& open = open_.back();
    if (auto* array = std::get_if<DocumentValue::Array>(&open.value->value)) {
      return array->emplace_back();
    }
    auto& object = std::get<DocumentValue::Object>(open.value->value);
    return object.emplace_back(DocumentMember{std::move(open.key), {}}).value;
  }

  Fail fail_;
  DocumentValue root_;
  std::vector<Open> open_;
};

/// What is wrong, without the library's own prefix, on one line.
std::string reason(const std::string& message) {
  const std::size_t column = message.find("column ");
  const std::size_t bracket = message.find("] ");
  const std::size_t colon = column == message.npos ? message.npos : message.find(": ", column);
  std::string text = colon != message.npos     ? message.substr(colon + 2)
                     : bracket != message.npos ? message.substr(bracket + 2)
                                               : message;
  constexpr std::size_t most = 200;
  if (text.size() > most) text = text.substr(0, most) + "...";
  for (char& c : text) {
    if (c < 0x20 || c == 0x7f) c = '?';
  }
  return text;
}

/// Receives what the library's parser finds; that parser does not recurse.
class JsonEvents final : public nlohmann::json_sax<Json> {
 public:
  JsonEvents(const std::string& file, std::string_view text)
      : file_(file),
        text_(text),
        tree_([&](const std::string& what) { throw IoError(file_ + ": " + what); }) {}

  bool null() override { return add(std::monostate()); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override {
    constexpr auto most = std::numeric_limits<std::int64_t>::max();
    return value <= number_unsigned_t(most) ? add(std::int64_t(value)) : add(double(value));
  }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }  // not in JSON
  bool start_object(std::size_t /*count*/) override {
    tree_.open<DocumentValue::Object>();
    return true;
  }
  bool key(string_t& value) override {
    tree_.key(std::move(value));
    return true;
  }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*count*/) override {
    tree_.open<DocumentValue::Array>();
    return true;
  }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    const auto end = text_.begin() + std::ptrdiff_t(std::min(position, text_.size()));
    const std::string place =
        file_ + ":" + std::to_string(1 + std::count(text_.begin(), end, '\n')) + ": ";
    constexpr int number_overflow = 406;
    if (error.id == number_overflow) throw InvalidInput(place + reason(error.what()));
    throw IoError(place + reason(error.what()));
  }

  DocumentValue take() { return tree_.take(); }

 private:
  template <class Value>
  bool add(Value value) {
    tree_.add(std::move(value));
    return true;
  }
  bool close() {
    tree_.close();
    return true;
  }

  const std::string& file_;
  std::string_view text_;
  TreeBuilder tree_;
};

/// CBOR by hand: the library's reader recurses without limit in strings of strings.
class CborReader {
 public:
  CborReader(const std::string& file, std::string_view bytes)
      : file_(file), bytes_(bytes), tree_([&](const std::string& what) { fail(what); }) {}

  DocumentValue read() {
    value(next());
    if (at_ < bytes_.size()) {
      ++at_;
      fail("more follows the document");
    }
    return tree_.take();
  }

 private:
  enum Major { positive, negative, byte_string, text_string, array, map, tag, simple };
  static constexpr unsigned indefinite = 31;
  static constexpr unsigned char end_mark = 0xff;

  [[noreturn]] void fail(const std::string& what) const {
    throw IoError(file_ + ":byte " + std::to_string(at_ == 0 ? 0 : at_ - 1) + ": " + what);
  }
  std::size_t left() const { return bytes_.size() - at_; }
  unsigned char next() {
    if (left() == 0) {
      ++at_;
      fail("the file ends within the document");
    }
    return static_cast<unsigned char>(bytes_[at_++]);
  }
  std::uint64_t big_endian(int count) {
    std::uint64_t bits = 0;
    for (int i = 0; i < count; ++i) bits = bits << 8 | next();
    return bits;
  }
  std::uint64_t argument(unsigned low) {
    if (low < 24) return low;
    if (low > 27) fail("a length of no known kind");
    return big_endian(1 << (low - 24));
  }
  /// A number of things of at least `bytes` bytes each.
  std::uint64_t count(unsigned low, std::size_t bytes) {
    const std::uint64_t n = argument(low);
    if (n > left() / bytes) {
      fail(std::to_string(n) + " things are announced where " + std::to_string(left()) +
           " bytes are left");
    }
    return n;
  }

  void value(unsigned char head);
  std::string text(unsigned low);
  void items(unsigned low);
  void members(unsigned low);
  void other(unsigned low);

  const std::string& file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  TreeBuilder tree_;
};

void CborReader::value(unsigned char head) {
  for (; head >> 5 == tag; head = next()) argument(head & 31U);
  const unsigned low = head & 31U;
  constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
  switch (head >> 5) {
    case positive: {
      const std::uint64_t n = argument(low);
      return n <= most ? tree_.add(std::int64_t(n)) : tree_.add(double(n));
    }
    case negative: {
      const std::uint64_t n = argument(low);
      return n <= most ? tree_.add(-1 - std::int64_t(n)) : tree_.add(-1 - double(n));
    }
    case text_string:
      return tree_.add(text(low));
    case array:
      return items(low);
    case map:
      return members(low);
    case simple:
      return other(low);
    default:
      fail("byte strings are no part of a document");
  }
}

std::string CborReader::text(unsigned low) {
  std::string result;
  const auto append = [&](unsigned length_low) {
    const auto length = std::size_t(count(length_low, 1));
    result += bytes_.substr(at_, length);
    at_ += length;
  };
  if (low != indefinite) {
    append(low);
    return result;
  }
  for (unsigned char head = next(); head != end_mark; head = next()) {
    if (head >> 5 != text_string) fail("a piece of a text that is no text");
    append(head & 31U);
  }
  return result;
}

void CborReader::items(unsigned low) {
  tree_.open<DocumentValue::Array>();
  if (low == indefinite) {
    for (unsigned char head = next(); head != end_mark; head = next()) value(head);
  } else {
    for (std::uint64_t n = count(low, 1); n > 0; --n) value(next());
  }
  tree_.close();
}

void CborReader::members(unsigned low) {
  tree_.open<DocumentValue::Object>();
  const auto member = [&](unsigned char head) {
    if (head >> 5 != text_string) fail("a key that is no text");
    tree_.key(text(head & 31U));
    value(next());
  };
  if (low == indefinite) {
    for (unsigned char head = next(); head != end_mark; head = next()) member(head);
  } else {
    for (std::uint64_t n = count(low, 2); n > 0; --n) member(next());
  }
  tree_.close();
}

void CborReader::other(unsigned low) {
  switch (low) {
    case 20:
    case 21:
      return tree_.add(low == 21);
    case 22:  // null
    case 23:  // undefined
      return tree_.add(std::monostate());
    case 25: {
      const auto bits = static_cast<unsigned>(big_endian(2));
      const int exponent = int(bits >> 10 & 31U);
      const double mantissa = bits & 1023U;
      const double magnitude = exponent == 31
                                   ? (mantissa > 0 ? std::numeric_limits<double>::quiet_NaN()
                                                   : std::numeric_limits<double>::infinity())
                               : exponent == 0 ? std::ldexp(mantissa, -24)
                                               : std::ldexp(1024 + mantissa, exponent - 25);
      return tree_.add((bits >> 15) != 0 ? -magnitude : magnitude);
    }
    case 26:
      return tree_.add(double(std::bit_cast<float>(std::uint32_t(big_endian(4)))));
    case 27:
      return tree_.add(std::bit_cast<double>(big_endian(8)));
    default:
      fail("a value of no known kind");
  }
}

}  // namespace

DocumentValue parse_json(const std::string& file, std::string_view text) {
  JsonEvents events(file, text);
  Json::sax_parse(text.begin(), text.end(), &events);
  return events.take();
}

DocumentValue parse_cbor(const std::string& file, std::string_view bytes) {
  return CborReader(file, bytes).read();
}

}  // namespace taut
