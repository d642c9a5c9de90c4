#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "taut/surface/control_cage.h"

namespace taut {

class Extraction;

/// Faces with their tags, as OpenSubdiv takes them.
struct Description {
  std::vector<int> sizes;
  std::vector<int> vertices;
  std::vector<int> crease_vertices;
  std::vector<float> crease_sharpness;
  std::vector<int> corner_vertices;
  std::vector<float> corner_sharpness;
  std::vector<int> holes;
  std::size_t point_count = 0;
};

/// @name OpenSubdiv's refiners
/// @throws BackendError if it does not take the faces
/// @{
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(
    const Description& description, CageScheme scheme, const OpenSubdiv::Sdc::Options& options);
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> make_refiner(
    const Extraction& extraction, CageScheme scheme, const OpenSubdiv::Sdc::Options& options);
/// @}

}  // namespace taut
