#pragma once

#include <cstddef>

namespace taut {

// An index or a count, which is not negative, as the standard library's containers take them.
constexpr std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

// A size or an index of a container, of at most 2^31 - 1, as Taut's own types hold them.
constexpr int to_int(std::size_t n) { return static_cast<int>(n); }

}  // namespace taut
