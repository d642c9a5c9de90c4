#pragma once

#include <opensubdiv/far/topologyLevel.h>

#include <vector>

#include "taut/subdivision/refiner.h"

namespace taut {

/// Sheets of faces that meet in edges that are no manifold, parted there and in the ends of these:
/// infinitely sharp as they are, each sheet has its own boundary along them.
class Sheets {
 public:
  explicit Sheets(const OpenSubdiv::Far::TopologyLevel& level);

  const Description& description() const { return description_; }
  /// The level's vertices, in the order of the new ones.
  const std::vector<int>& originals() const { return originals_; }

 private:
  void part_vertex(int v);
  int add_copy(int v);
  bool are_joined(int v, int a, int b) const;
  void add_creases();

  const OpenSubdiv::Far::TopologyLevel& level_;
  Description description_;
  std::vector<int> first_;  // of each face's vertices
  std::vector<int> originals_;
};

}  // namespace taut
