#include <cmath>

#include "families.h"
#include "patterns.h"
#include "sweeps.h"

namespace taut_test {
namespace {

Natural cylinder_of(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 50);
  return {solid_cylinder(r, h), {pi * r * r * h, {0, 1, 2, 2}, pi * r / 2 + h / 2}};
}

Natural cone_of(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 50);
  return {solid_cone(r, h), {pi * r * r * h / 3, {0, 1, 1, 1}}};
}

Natural frustum_of(Random& random) {
  const double R = uniform(random, 15, 25), r = uniform(random, 5, 12), h = uniform(random, 10, 50);
  return {frustum(R, r, h), {pi * h * (R * R + R * r + r * r) / 3, {0, 1, 2, 2}}};
}

Natural ball(Random& random) {
  const double r = uniform(random, 5, 20);
  return {sphere(r), {4 * pi / 3 * cube(r), {1, 0, 0, 0}, 2 * r}};
}

Natural ring_torus(Random& random) {
  const double R = uniform(random, 15, 30), r = uniform(random, 2, 10);
  const double volume = 2 * pi * R * R * r + pi * pi * R * r * r + 4 * pi / 3 * cube(r);
  return {torus(R, r), {volume, {1, 0, 2, 2}, pi * R / 2 + 2 * r}};
}

Natural shaft(Random& random) {
  std::vector<dvec3> profile = {{0, 0, 0}};
  double z = 0;
  for (int k = 0; k < 3; ++k) {
    const double r = uniform(random, 5, 9) + 3 * k;
    profile.emplace_back(r, 0, z);
    z += uniform(random, 10, 20);
    profile.emplace_back(r, 0, z);
  }
  profile.emplace_back(0, 0, z);
  return {revolved_all(rounded(profile, uniform(random, 0.5, 1), false))};
}

Natural bottle(Random& random) {
  std::vector<dvec3> profile = {{uniform(random, 15, 20), 0, 0}};
  for (int k = 1; k < 7; ++k) {
    profile.emplace_back(k < 4 ? uniform(random, 14, 22) : uniform(random, 4, 9), 0, 10 * k);
  }
  return {revolved_all({segment({0, 0, 0}, profile[0]), spline(profile)})};
}

Natural cup(Random& random) {
  const double R = uniform(random, 15, 25), h = uniform(random, 20, 40), t = uniform(random, 1, 2);
  const std::vector<dvec3> profile = {{0, 0, 0},     {0.8 * R, 0, 0},     {R, 0, h},
                                      {R - t, 0, h}, {0.8 * R - t, 0, t}, {0, 0, t}};
  return {revolved_all(rounded(profile, 0.45 * t, false)), {unknown, {2, 1, 2, 4}}};
}

/// Two caps of one sphere's radius, rim to rim.
Natural lens(Random& random) {
  const double height = uniform(random, 0.1, 0.5), R = uniform(random, 20, 50);
  const Shape cap = scaled(shifted(spherical_cap(height), {0, 0, height - 1}), R);
  return {with_mirror(cap, mirror_z),
          {2 * pi * square(height * R) * (R - height * R / 3), {2, 0, 0, 1}}};
}

Natural wheel(Random& random) {
  const double R = uniform(random, 25, 40), h = uniform(random, 5, 10), rim = uniform(random, 2, 3);
  const std::vector<dvec3> profile = {{0, 0, -h / 4},    {R - 6, 0, -h / 4}, {R - 6, 0, -h / 2},
                                      {R, 0, -h / 2},    {R, 0, h / 2},      {R - 6, 0, h / 2},
                                      {R - 6, 0, h / 4}, {0, 0, h / 4}};
  return {revolved_all(rounded(profile, 0.3 * rim, false)), {unknown, {2, 1, 2, 4}}};
}

/// Bosses on a circle on a disc.
Natural bolt_circle(Random& random) {
  const double R = uniform(random, 20, 30), h = uniform(random, 3, 6), r = uniform(random, 2, 4);
  const int count = pick(random, 3, 8);
  const Shape boss = shifted(solid_cylinder(r, 2 * h), {R - r - 1, 0, 0});
  return {solid_cylinder(R, h) + patterned(boss, count)};
}

Natural bolt(Random& random) {
  const double r = uniform(random, 3, 6), h = uniform(random, 20, 40), key = uniform(random, 6, 9);
  const std::vector<dvec3> hexagon = ring(6, [&](int) { return key; });
  const bool inside = r < std::sqrt(3) / 2 * key;
  return {
      prism(rounded(hexagon, 0, true), 4, dvec3(0.0)) + shifted(solid_cylinder(r, h), {0, 0, -h}),
      {unknown, inside ? Counts{0, 6, 14, 36} : Counts()}};
}

}  // namespace

Natural capsule(Random& random) {
  const double r = uniform(random, 5, 15), h = uniform(random, 10, 40);
  const std::vector<NurbsCurve> profile = {arc({0, 0, -r}, {r, 0, -r}, {r, 0, 0}),
                                           segment({r, 0, 0}, {r, 0, h}),
                                           arc({r, 0, h}, {r, 0, h + r}, {0, 0, h + r})};
  return {revolved_all(profile),
          {pi * r * r * h + 4 * pi / 3 * cube(r), {2, 1, 0, 2}, 2 * r + h / 2}};
}

std::vector<Family> turned_parts() {
  return {
      {"cylinder", cylinder_of},
      {"cone", cone_of},
      {"frustum", frustum_of},
      {"ball", ball},
      {"torus", ring_torus},
      {"shaft", shaft},
      {"bottle", bottle},
      {"cup", cup},
      {"capsule", capsule},
      {"lens", lens},
      {"wheel", wheel},
      {"bolt_circle", bolt_circle},
      {"bolt", bolt},
  };
}

}  // namespace taut_test
