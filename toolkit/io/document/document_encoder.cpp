#include "taut/io/document/document_encoder.h"

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

using Json = nlohmann::json;

/// With quotation marks, what is no UTF-8 replaced.
std::string quoted(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

class JsonEncoder final : public DocumentEncoder {
 public:
  void begin_object() override { open('{'); }
  void key(std::string_view key) override {
    separate();
    out_ += '"';
    out_ += key;
    out_ += "\": ";
    first_ = true;
  }
  void end_object() override { close('}'); }
  void begin_array(std::size_t /*count*/) override { open('['); }
  void end_array() override { close(']'); }
  void integer(std::int64_t value) override {
    separate();
    out_ += std::to_string(value);
  }
  void number(double value) override {
    separate();
    out_ += shortest(value + 0.0);
  }
  void boolean(bool value) override {
    separate();
    out_ += value ? "true" : "false";
  }
  void null() override {
    separate();
    out_ += "null";
  }
  void text(const std::string& text) override {
    separate();
    out_ += quoted(text);
  }
  void line() override { line_ = true; }
  std::string take() override { return std::move(out_) + "\n"; }

 private:
  void open(char bracket) {
    separate();
    out_ += bracket;
    first_ = true;
  }
  void close(char bracket) {
    line_ = false;
    first_ = false;
    out_ += bracket;
  }
  /// Comma, space and line before a key or value.
  void separate() {
    if (!first_) out_ += line_ ? "," : ", ";
    if (line_) out_ += '\n';
    first_ = false;
    line_ = false;
  }

  std::string out_;
  bool first_ = true;
  bool line_ = false;
};

class CborEncoder final : public DocumentEncoder {
 public:
  void begin_object() override { byte(0xbf); }
  void key(std::string_view key) override { raw_text(key); }
  void end_object() override { byte(0xff); }
  void begin_array(std::size_t count) override { head(4, count); }
  void end_array() override {}
  void integer(std::int64_t value) override {
    if (value >= 0) {
      head(0, std::uint64_t(value));
    } else {
      head(1, std::uint64_t(-(value + 1)));
    }
  }
  void number(double value) override {
    const double x = value + 0.0;
    if (const auto single = float(x); double(single) == x) {
      byte(0xfa);
      big_endian(std::bit_cast<std::uint32_t>(single), 4);
    } else {
      byte(0xfb);
      big_endian(std::bit_cast<std::uint64_t>(x), 8);
    }
  }
  void boolean(bool value) override { byte(value ? 0xf5 : 0xf4); }
  void null() override { byte(0xf6); }
  void text(const std::string& text) override {
    raw_text(Json::parse(quoted(text)).get_ref<const std::string&>());
  }
  void line() override {}
  std::string take() override { return std::move(out_); }

 private:
  void byte(unsigned value) { out_ += char(value); }
  void big_endian(std::uint64_t bits, int bytes) {
    for (int i = bytes - 1; i >= 0; --i) byte(unsigned(bits >> (8 * i) & 0xff));
  }
  void head(unsigned major, std::uint64_t n) {
    const int size = n < 24 ? 0 : n < 1U << 8 ? 1 : n < 1U << 16 ? 2 : n < 1ULL << 32 ? 4 : 8;
    const unsigned low = size == 0 ? unsigned(n) : 24 + unsigned(std::countr_zero(unsigned(size)));
    byte(major << 5 | low);
    big_endian(n, size);
  }
  void raw_text(std::string_view text) {
    head(3, text.size());
    out_ += text;
  }

  std::string out_;
};

}  // namespace

void write_value(DocumentEncoder& out, const DocumentValue& value) {
  if (const auto* array = std::get_if<DocumentValue::Array>(&value.value)) {
    out.begin_array(array->size());
    for (const DocumentValue& element : *array) write_value(out, element);
    out.end_array();
  } else if (const auto* object = std::get_if<DocumentValue::Object>(&value.value)) {
    out.begin_object();
    for (const DocumentMember& member : *object) {
      out.key(member.key);
      write_value(out, member.value);
    }
    out.end_object();
  } else if (const auto* string = std::get_if<std::string>(&value.value)) {
    out.text(*string);
  } else if (const auto* flag = std::get_if<bool>(&value.value)) {
    out.boolean(*flag);
  } else if (const auto* integer = std::get_if<std::int64_t>(&value.value)) {
    out.integer(*integer);
  } else if (const auto* real = std::get_if<double>(&value.value); real && std::isfinite(*real)) {
    out.number(*real);
  } else {
    out.null();
  }
}

std::unique_ptr<DocumentEncoder> make_encoder(DocumentEncoding encoding) {
  if (encoding == DocumentEncoding::json) return std::make_unique<JsonEncoder>();
  return std::make_unique<CborEncoder>();
}

}  // namespace taut
