#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

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
  /// The middle of the edge, a new vertex if the edge has none yet.
  int add(int a, int b) {
    const auto [entry, is_new] = middles_.try_emplace(key(a, b), count_);
    if (is_new) ++count_;
    return entry->second;
  }

  /// @name Edges that their ends do not tell apart
  /// The two halves of an edge from a vertex to itself, and edges inside of faces between the same
  /// middles, as of two triangles that share two sides. Each has a middle of its own.
  /// @{
  /// Of an edge inside of a face.
  void add_inner(int a, int b) {
    if (!inner_.insert(key(a, b)).second) add_several(a, b);
  }
  void add_several(int a, int b) { several_.insert(key(a, b)); }
  /// More than one edge has these ends.
  bool are_several(int a, int b) const { return several_.count(key(a, b)) > 0; }
  /// @}

  /// One number for two vertices, in either order.
  static std::uint64_t key(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }

 private:
  int count_;
  std::unordered_map<std::uint64_t, int> middles_;
  std::unordered_set<std::uint64_t> inner_, several_;
};

}  // namespace taut
