#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "taut/core/error.h"

namespace taut {

struct DocumentMember;

/// A value of a JSON or CBOR document.
struct DocumentValue {
  using Array = std::vector<DocumentValue>;
  /// In the order of the file; no key stands twice.
  using Object = std::vector<DocumentMember>;

  /// Nothing is null. Integers beyond 64 bits are doubles; doubles of a CBOR document may be NaN.
  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Object> value;
};

/// A key of an object and what stands there.
struct DocumentMember {
  std::string key;
  DocumentValue value;
};

/// Deepest nesting of arrays and objects that is read; a model document needs eleven levels.
inline constexpr int max_document_depth = 64;

/// The whole document. Memory is taken for what is there, not for what is announced.
/// @throws IoError if it is malformed (FILE:LINE: or FILE:byte N:), nested too deep, a key stands
/// twice in an object or (CBOR) is no text, or something else follows; InvalidInput if a number in
/// JSON overflows
DocumentValue parse_json(const std::string& file, std::string_view text);
/// Tags are passed over; byte strings are refused.
DocumentValue parse_cbor(const std::string& file, std::string_view bytes);

}  // namespace taut
