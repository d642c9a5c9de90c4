#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "models.h"
#include "taut/surface/control_cage.h"

namespace taut_test {

/// What files do to the points of a model.
enum class Variant { clean, turned, float32, decimals };
inline constexpr Variant all_variants[] = {Variant::clean, Variant::turned, Variant::float32,
                                           Variant::decimals};
const char* name_of(Variant variant);

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A model as people make it.
struct Natural {
  Shape shape = {};
  double volume = unknown;  ///< of its hull, by a closed form
  std::optional<taut::ControlCage> cage = {};
};

/// As it is; turned at random; turned and rounded to float32, or to six decimals.
Natural placed(Natural natural, Variant variant, Random& random);

struct Family {
  std::string name;
  std::function<Natural(Random&)> make;
};

/// Natural models, exactly as drawn: sizes at random, about ten to a hundred units.
const std::vector<Family>& families();

}  // namespace taut_test
