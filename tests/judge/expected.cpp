#include "expected.h"

#include <array>
#include <cstdio>

namespace taut_test {
namespace {

std::array<int, 4> all_of(const Counts& counts) {
  return {counts.patches, counts.scrolls, counts.facets, counts.curves};
}

}  // namespace

std::string text(const Counts& counts) {
  std::string result;
  for (const int count : all_of(counts)) {
    result += (result.empty() ? "" : "/") + (count < 0 ? "-" : std::to_string(count));
  }
  return result;
}

bool differ(const Counts& found, const Counts& expected) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (all_of(expected)[k] >= 0 && all_of(found)[k] != all_of(expected)[k]) return true;
  }
  return false;
}

std::string off_by(const char* what, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%s by %.2g", what, value);
  return buffer.data();
}

}  // namespace taut_test
