#pragma once

#include <array>
#include <map>
#include <utility>
#include <vector>

#include "taut/hull/decide/direction_map.h"
#include "taut/hull/trace/partings.h"

namespace taut {

/// What supports a model at the corners of cells of its map of directions; asked once for each.
class MapSupport {
 public:
  /// `extent`: contacts no farther from each other are one. All must outlive it.
  MapSupport(const ContactGeometry& geometry, SupportQuery& query, double extent)
      : geometry_(geometry), query_(query), extent_(extent) {}

  /// The sides of a cell at the ends of which different ones of its contacts support, farther from
  /// each other than the extent.
  std::vector<std::pair<SupportSample, SupportSample>> partings(const MapCell& cell);

 private:
  const SupportSample& at(const dvec3& d);

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  double extent_;
  std::map<std::array<long long, 3>, SupportSample> samples_;
  Contact hint_;
};

}  // namespace taut
