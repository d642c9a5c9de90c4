#pragma once

#include <opensubdiv/far/topologyLevel.h>

#include <vector>

#include "taut/subdivision/refiner.h"

namespace taut {

/// Some faces of a level as a cage of their own.
class Extraction {
 public:
  explicit Extraction(const OpenSubdiv::Far::TopologyLevel& level);

  void add_face(int face, bool hole);
  Description take();
  /// The level's vertices, in the order of the new ones.
  const std::vector<int>& originals() const { return originals_; }

 private:
  int number(int vertex);

  const OpenSubdiv::Far::TopologyLevel& level_;
  std::vector<int> number_;
  std::vector<int> originals_;
  std::vector<int> edges_;
  Description out_;
};

/// Some faces and, behind them, all others that touch their vertices.
std::vector<int> with_surroundings(const OpenSubdiv::Far::TopologyLevel& level,
                                   std::vector<int> faces);

}  // namespace taut
