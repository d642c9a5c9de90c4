#include "taut/io/model/read_bpt.h"

#include <string>

#include "taut/core/tolerances.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

// Bytes of one number and of the smallest patch: each number is a digit and what separates it.
constexpr std::size_t number_bytes = 2;
constexpr std::size_t patch_bytes = (2 + 4 * 3) * number_bytes;

int read_degree(TextScanner& scanner) {
  const Word word = scanner.next("a degree");
  const long degree = scanner.integer(word, "a degree");
  if (degree < 1 || degree > max_degree) {
    scanner.refuse(word.line, "degree " + std::to_string(degree) + " is not in 1 .. " +
                                  std::to_string(max_degree));
  }
  return static_cast<int>(degree);
}

dvec3 read_point(TextScanner& scanner) {
  dvec3 p;
  for (int i = 0; i < 3; ++i) p[i] = scanner.next_number("a coordinate");
  return p;
}

BezierPatch read_patch(TextScanner& scanner) {
  BezierPatch patch;
  patch.degree_u = read_degree(scanner);
  patch.degree_v = read_degree(scanner);
  patch.points.resize(patch.index(patch.degree_u, patch.degree_v) + 1);
  for (int j = 0; j <= patch.degree_v; ++j) {
    for (int i = 0; i <= patch.degree_u; ++i) patch.at(i, j) = homogeneous(read_point(scanner));
  }
  return patch;
}

}  // namespace

Part read_bpt(const std::string& file, std::string_view data, const Progress& progress) {
  TextScanner scanner(file, data);
  const Word word = scanner.next("the number of patches");
  const std::size_t count = scanner.count(word, patch_bytes, "patches");
  if (count == 0) scanner.refuse(word.line, "there are no patches");

  Part part;
  for (std::size_t i = 0; i < count; ++i) {
    progress.update("read", static_cast<double>(i) / static_cast<double>(count));
    scanner.at_end();
    const long line = scanner.line();
    const BezierPatch patch = read_patch(scanner);
    scanner.placed(line,
                   [&] { part.add_surface(as_nurbs(patch), "patch " + std::to_string(i + 1)); });
  }
  if (!scanner.at_end()) {
    scanner.fail(scanner.line(), "more follows the last of the " + std::to_string(count) +
                                     " patches that were announced");
  }
  return part;
}

}  // namespace taut
