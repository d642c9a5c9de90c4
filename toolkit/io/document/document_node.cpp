#include "taut/io/document/document_node.h"

#include <algorithm>
#include <cmath>

#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

constexpr std::size_t most_unknown_kinds = 16;

}  // namespace

void DocumentNotes::unknown_key(std::string_view kind, const std::string& key) {
  if (unknown_.size() > most_unknown_kinds) return;
  if (!unknown_.insert(std::string(kind) + " " + key).second) return;
  warning("unknown-key", unknown_.size() > most_unknown_kinds
                             ? "more keys are unknown, which are passed over"
                             : "the key " + in_quotes(key) + " of a " + std::string(kind) +
                                   " is unknown and passed over");
}

template <class Type>
const Type& DocumentNode::get(const char* type) const {
  const Type* found = std::get_if<Type>(&value_.value);
  if (found == nullptr) fail(std::string(type) + " expected");
  return *found;
}

void DocumentNode::expect_keys(std::string_view kind,
                               std::initializer_list<std::string_view> known) const {
  for (const DocumentMember& member : get<DocumentValue::Object>("an object")) {
    if (std::find(known.begin(), known.end(), member.key) == known.end()) {
      notes_.unknown_key(kind, member.key);
    }
  }
}

std::optional<DocumentNode> DocumentNode::find(std::string_view key) const {
  for (const DocumentMember& member : get<DocumentValue::Object>("an object")) {
    if (member.key == key) return DocumentNode(*this, member.key, member.value);
  }
  return {};
}

DocumentNode DocumentNode::at(std::string_view key) const {
  const std::optional<DocumentNode> found = find(key);
  if (!found) fail("the key \"" + std::string(key) + "\" is missing");
  return *found;
}

std::size_t DocumentNode::size() const { return get<DocumentValue::Array>("an array").size(); }

DocumentNode DocumentNode::operator[](std::size_t i) const {
  return {*this, i, get<DocumentValue::Array>("an array")[i]};
}

void DocumentNode::expect_size(std::size_t size) const {
  if (this->size() == size) return;
  fail(std::to_string(this->size()) + " elements where " + std::to_string(size) + " are expected");
}

double DocumentNode::number() const {
  if (const auto* integer = std::get_if<std::int64_t>(&value_.value)) return double(*integer);
  const double value = get<double>("a number");
  if (!std::isfinite(value)) refuse("is not finite");
  return value;
}

int DocumentNode::integer(int lower, int upper) const {
  const auto range = [&] {
    return "is not in " + std::to_string(lower) + " .. " + std::to_string(upper);
  };
  std::int64_t value = 0;
  if (const auto* real = std::get_if<double>(&value_.value)) {
    // What some writers make of an integer.
    if (!(std::abs(*real) <= 0x1p53)) refuse(range());
    value = std::int64_t(*real);
    if (double(value) != *real) fail("an integer expected");
  } else {
    value = get<std::int64_t>("an integer");
  }
  if (value < lower || value > upper) refuse(std::to_string(value) + " " + range());
  return int(value);
}

const std::string& DocumentNode::string() const { return get<std::string>("a text"); }

dvec3 DocumentNode::vector() const {
  expect_size(3);
  return {(*this)[0].number(), (*this)[1].number(), (*this)[2].number()};
}

std::vector<dvec3> DocumentNode::vectors() const {
  std::vector<dvec3> result(size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (*this)[i].vector();
  return result;
}

std::string DocumentNode::path() const {
  if (parent_ == nullptr) return "";
  const std::string before = parent_->path();
  if (key_.data() == nullptr) return before + "[" + std::to_string(index_) + "]";
  return before + (before.empty() ? "" : ".") + std::string(key_);
}

std::string DocumentNode::place() const {
  const std::string there = path();
  return notes_.file() + (there.empty() ? "" : ": " + there);
}

}  // namespace taut
