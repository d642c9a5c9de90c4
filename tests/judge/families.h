#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "expected.h"
#include "models.h"
#include "taut/surface/control_cage.h"

namespace taut_test {

/// What files do to the points of a model.
enum class Variant { clean, turned, float32, decimals };
inline constexpr Variant all_variants[] = {Variant::clean, Variant::turned, Variant::float32,
                                           Variant::decimals};
const char* name_of(Variant variant);
/// Its numbers are no longer those of the model drawn.
bool rounds(Variant variant);

/// A model as people make it.
struct Natural {
  Shape shape = {};
  Expected expected = {};
  std::optional<taut::ControlCage> cage = {};
};

/// As it is; turned at random; turned and rounded to float32, or to six decimals.
Natural placed(Natural natural, Variant variant, Random& random);

struct Family {
  std::string name;
  std::function<Natural(Random&)> make;
};

struct FamilyGroup {
  std::string name;
  std::vector<Family> families;
};

/// Natural models, exactly as drawn: sizes at random, about ten to a hundred units.
const std::vector<FamilyGroup>& family_groups();
/// The model of a family of that name, not a cage, with the first random numbers of a seed.
taut::Scene scene_of(const std::string& family, Variant variant, unsigned long seed = 1);

/// @name The groups' families
/// @{
std::vector<Family> prismatic_parts();
std::vector<Family> turned_parts();
std::vector<Family> swept_parts();
std::vector<Family> sheets();
std::vector<Family> assemblies();
std::vector<Family> curves_and_points();
std::vector<Family> cages();
/// @}

/// Of which others are made too.
Natural rounded_box(Random& random);
Natural capsule(Random& random);

}  // namespace taut_test
