#pragma once

#include <cstddef>

namespace taut {

/// An index or a count as the standard library's containers take them. @pre n >= 0
constexpr std::size_t to_size(int n) { return static_cast<std::size_t>(n); }

/// A size or an index of a container as Taut's own types hold them. @pre n < 2^31
constexpr int to_int(std::size_t n) { return static_cast<int>(n); }

}  // namespace taut
