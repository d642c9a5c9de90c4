#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace taut {

/// The vertices of a cage and of all its levels of refinement by number, and which of them are the
/// middles of edges. A vertex keeps its number on the levels below.
class EdgeMiddles {
 public:
  /// @pre vertices 0 .. count - 1 are the cage's
  explicit EdgeMiddles(int count) : count_(count) {}

  int vertex_count() const { return count_; }
  int add_vertex() { return count_++; }

  /// The middle of the edge between two vertices, or -1 if the edge is not refined.
  int find(int a, int b) const {
    const auto found = middles_.find(key(a, b));
    return found == middles_.end() ? -1 : found->second;
  }
  /// The same, a new vertex if it is not known yet.
  int add(int a, int b) {
    const auto [entry, is_new] = middles_.try_emplace(key(a, b), count_);
    if (is_new) ++count_;
    return entry->second;
  }

  /// One number for two vertices, in either order.
  static std::uint64_t key(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }

 private:
  int count_;
  std::unordered_map<std::uint64_t, int> middles_;
};

}  // namespace taut
