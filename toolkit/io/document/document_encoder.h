#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "taut/io/document/document_encoding.h"
#include "taut/io/document/document_tree.h"

namespace taut {

/// Writes a document, value by value, in the order of the file.
class DocumentEncoder {
 public:
  virtual ~DocumentEncoder() = default;

  virtual void begin_object() = 0;
  /// Followed by its value. @pre an object is open, and the key is plain ASCII
  virtual void key(std::string_view key) = 0;
  virtual void end_object() = 0;
  /// `count` values follow.
  virtual void begin_array(std::size_t count) = 0;
  virtual void end_array() = 0;
  virtual void integer(std::int64_t value) = 0;
  /// The number to the last bit, zero without its sign. @pre finite
  virtual void number(double value) = 0;
  virtual void boolean(bool value) = 0;
  virtual void null() = 0;
  /// Bytes that are no UTF-8 are replaced.
  virtual void text(const std::string& text) = 0;
  /// What comes next may begin a line.
  virtual void line() = 0;
  /// All that was written.
  virtual std::string take() = 0;
};

/// Writes a whole value; numbers that are not finite as null. @pre keys are plain ASCII
void write_value(DocumentEncoder& out, const DocumentValue& value);

std::unique_ptr<DocumentEncoder> make_encoder(DocumentEncoding encoding);

}  // namespace taut
