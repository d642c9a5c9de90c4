#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "input.h"
#include "taut/envelope/envelope_images.h"
#include "taut/hull/result/hull.h"
#include "taut/hull/result/hull_options.h"

namespace taut::tool {

/// What `taut hull` is asked for.
struct HullArguments {
  InputArguments inputs;
  std::vector<std::string> outputs;  ///< "-" is standard output
  std::string report;
  std::string method = "precise";
  std::optional<double> relative;
  std::optional<double> tolerance;
  std::optional<double> resolution;
  std::optional<int> max_vertices;
  std::optional<double> max_seconds;
  std::optional<std::size_t> max_memory;
  int size = EnvelopeOptions().size;

  /// The format of an output as an extension, with its dot; empty if none is named.
  std::string format_of(const std::string& output) const;
};

/// The hull within the tolerance asked for or, with the reason, the best that was found.
struct Outcome {
  std::shared_ptr<const Hull> hull;
  /// Of points and polygons with more vertices than the budget, the hull itself, of which the other
  /// has but the best mesh.
  std::shared_ptr<const Hull> whole;
  std::optional<std::string> failure;
  bool met_limit = false;  ///< that is the reason

  /// What is known of the exact hull.
  const Hull& exact() const { return whole ? *whole : *hull; }
  void meet(const std::string& limit) {
    failure = failure ? *failure + "; " + limit : limit;
    met_limit = true;
  }
};

}  // namespace taut::tool
