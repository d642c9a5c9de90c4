#include "taut/io/mesh/obj_reference.h"

#include <algorithm>
#include <string>

namespace taut {
namespace {

/// "", "/vt", "//vn" or "/vt/vn", of whole numbers; some writers leave out the last ones.
bool are_further_indices(std::string_view text) {
  for (int k = 0; k < 2 && !text.empty(); ++k) {
    if (text.front() != '/') return false;
    text.remove_prefix(1);
    const bool negative = text.starts_with('-');
    if (negative) text.remove_prefix(1);
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    if (negative && digits == 0) return false;
    text.remove_prefix(digits);
  }
  return text.empty();
}

std::string_view without_article(std::string_view kind) { return kind.substr(kind.find(' ') + 1); }

}  // namespace

int ObjReferences::add(const TextScanner& scanner, const Word& word, std::size_t count) {
  const std::size_t index = obj_index(scanner, word, count);
  if (index >= most_) {
    most_ = index + 1;
    line_ = word.line;
  }
  return static_cast<int>(index);
}

void ObjReferences::check(const TextScanner& scanner, std::size_t count) const {
  if (most_ <= count) return;
  scanner.refuse(line_, "vertex " + std::to_string(most_) + " is referred to, but there are " +
                            std::to_string(count));
}

std::size_t obj_index(const TextScanner& scanner, const Word& word, std::size_t count,
                      std::string_view kind) {
  const std::size_t slash = std::min(word.text.find('/'), word.text.size());
  if (!are_further_indices(word.text.substr(slash))) {
    scanner.fail(word.line, std::string(kind) + " expected, found " + in_quotes(word.text));
  }
  const long number = scanner.integer({word.text.substr(0, slash), word.line}, kind);
  if (number > 0) return static_cast<std::size_t>(number) - 1;
  // Compared without turning the sign, which the smallest long would not survive.
  if (number == 0 || number < -static_cast<long>(count)) {
    scanner.refuse(word.line, std::string(without_article(kind)) + " " + std::to_string(number) +
                                  " is referred to, but " + std::to_string(count) + " came before");
  }
  return count - static_cast<std::size_t>(-number);
}

std::size_t earlier_obj_index(const TextScanner& scanner, const Word& word, std::size_t count,
                              std::string_view kind) {
  const std::size_t index = obj_index(scanner, word, count, kind);
  if (index < count) return index;
  scanner.refuse(word.line, std::string(without_article(kind)) + " " + std::to_string(index + 1) +
                                " is referred to, but " + std::to_string(count) + " came before");
}

dvec3 obj_point(const TextScanner& scanner, const std::vector<Word>& statement) {
  if (statement.size() < 4) scanner.fail(statement[0].line, "v takes three coordinates");
  dvec3 p;
  for (int i = 0; i < 3; ++i) {
    p[i] = scanner.number(statement[static_cast<std::size_t>(i) + 1], "a coordinate");
  }
  return p;
}

void add_obj_polygon(const TextScanner& scanner, const std::vector<Word>& statement,
                     std::size_t count, ObjReferences& references,
                     std::vector<std::vector<int>>& polygons) {
  if (statement.size() < 4) {
    scanner.refuse(statement[0].line, "a face has fewer than three vertices");
  }
  std::vector<int>& polygon = polygons.emplace_back();
  polygon.reserve(statement.size() - 1);
  for (std::size_t i = 1; i < statement.size(); ++i) {
    polygon.push_back(references.add(scanner, statement[i], count));
  }
}

}  // namespace taut
