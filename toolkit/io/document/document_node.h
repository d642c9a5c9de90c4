#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "taut/core/geometry.h"
#include "taut/core/progress.h"
#include "taut/io/document/document_tree.h"

namespace taut {

/// What all nodes of a document share: its name, and the warnings that it has caused.
class DocumentNotes {
 public:
  DocumentNotes(std::string file, const Progress& progress)
      : file_(std::move(file)), progress_(progress) {}

  const std::string& file() const { return file_; }
  const Progress& progress() const { return progress_; }
  void warning(std::string_view code, const std::string& text) const {
    progress_.warning(code, file_ + ": " + text);
  }
  /// A warning for each kind of object and key, up to a limit.
  void unknown_key(std::string_view kind, const std::string& key);

 private:
  std::string file_;
  const Progress& progress_;
  std::set<std::string> unknown_;
};

/// A value of a document that knows its place, so that what is wrong can be said there:
/// "FILE: parts[0].surfaces[3].knots: what". What is not of the wanted type is an IoError.
///
/// A node refers to the one it was got from, which must outlive it.
class DocumentNode {
 public:
  DocumentNode(const DocumentValue& value, DocumentNotes& notes) : value_(value), notes_(notes) {}

  /// @name Objects
  /// @{
  /// Warns of all other keys; `kind` says what the object is: "surface".
  void expect_keys(std::string_view kind, std::initializer_list<std::string_view> known) const;
  std::optional<DocumentNode> find(std::string_view key) const;
  /// @throws IoError if there is no such key
  DocumentNode at(std::string_view key) const;
  /// @}

  /// @name Arrays
  /// @{
  std::size_t size() const;
  /// @pre i < size()
  DocumentNode operator[](std::size_t i) const;
  /// @throws IoError if it is no array of that size
  void expect_size(std::size_t size) const;
  /// @}

  /// @throws InvalidInput if it is not finite
  double number() const;
  /// @throws InvalidInput if it is not in lower .. upper
  int integer(int lower, int upper) const;
  const std::string& string() const;
  /// Three numbers.
  dvec3 vector() const;
  /// An array of such.
  std::vector<dvec3> vectors() const;

  const DocumentValue& value() const { return value_; }
  bool is_null() const { return std::holds_alternative<std::monostate>(value_.value); }
  bool is_array() const { return std::holds_alternative<DocumentValue::Array>(value_.value); }
  const DocumentNotes& notes() const { return notes_; }
  /// "FILE: parts[0].surfaces[3]"
  std::string place() const;
  [[noreturn]] void fail(const std::string& what) const { throw IoError(place() + ": " + what); }
  [[noreturn]] void refuse(const std::string& what) const {
    throw InvalidInput(place() + ": " + what);
  }
  /// Calls what knows nothing of documents, and gives its errors the place.
  template <class Call>
  void placed(const Call& call) const {
    try {
      call();
    } catch (const InvalidInput& error) {
      refuse(error.what());
    } catch (const BackendError& error) {
      throw BackendError(place() + ": " + error.what());
    } catch (const LimitExceeded& error) {
      throw LimitExceeded(place() + ": " + error.what());
    }
  }

 private:
  DocumentNode(const DocumentNode& parent, std::string_view key, const DocumentValue& value)
      : value_(value), notes_(parent.notes_), parent_(&parent), key_(key) {}
  DocumentNode(const DocumentNode& parent, std::size_t index, const DocumentValue& value)
      : value_(value), notes_(parent.notes_), parent_(&parent), index_(index) {}

  template <class Type>
  const Type& get(const char* type) const;
  std::string path() const;

  const DocumentValue& value_;
  DocumentNotes& notes_;
  const DocumentNode* parent_ = nullptr;
  std::string_view key_;  // where the parent is an object
  std::size_t index_ = 0;
};

}  // namespace taut
