#include "families.h"

#include <cmath>
#include <stdexcept>

namespace taut_test {

const char* name_of(Variant variant) {
  constexpr const char* names[] = {"clean", "turned", "float32", "decimals"};
  return names[std::size_t(variant)];
}

bool rounds(Variant variant) { return variant == Variant::float32 || variant == Variant::decimals; }

Natural placed(Natural natural, Variant variant, Random& random) {
  if (variant == Variant::clean) return natural;
  const dmat3 rotation = random_rotation(random);
  const dvec3 shift = 5.0 * random_point(random);
  const auto rounded_number = [&](double x) {
    return variant == Variant::float32    ? double(float(x))
           : variant == Variant::decimals ? std::round(1e6 * x) / 1e6
                                          : x;
  };
  const auto place = [&](dvec3 x) {
    x = rotation * x + shift;
    return dvec3(rounded_number(x.x), rounded_number(x.y), rounded_number(x.z));
  };
  const auto place_all = [&](auto& geometry) {
    for (dvec4& p : geometry.points) p = taut::homogeneous(place(taut::euclidean(p)), p.w);
  };
  for (NurbsSurface& surface : natural.shape.surfaces) place_all(surface);
  for (NurbsCurve& curve : natural.shape.curves) place_all(curve);
  for (dvec3& p : natural.shape.points) p = place(p);
  if (natural.cage) {
    for (dvec3& p : natural.cage->points) p = place(p);
  }
  return natural;
}

const std::vector<FamilyGroup>& family_groups() {
  static const std::vector<FamilyGroup> all = {
      {"prismatic", prismatic_parts()},
      {"turned", turned_parts()},
      {"swept", swept_parts()},
      {"sheets", sheets()},
      {"assemblies", assemblies()},
      {"curves_and_points", curves_and_points()},
      {"cages", cages()},
  };
  return all;
}

taut::Scene scene_of(const std::string& family, Variant variant, unsigned long seed) {
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& own : group.families) {
      if (own.name != family) continue;
      Random random(seed);
      const Natural drawn = own.make(random);
      return make_scene(placed(drawn, variant, random).shape);
    }
  }
  throw std::logic_error("no such family");
}

}  // namespace taut_test
