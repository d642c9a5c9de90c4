#include "families.h"
#include "patterns.h"
#include "plates.h"
#include "sweeps.h"

namespace taut_test {
namespace {

Natural box_on_cylinder(Random& random) {
  const double r = uniform(random, 8, 12), h = uniform(random, 10, 20);
  return {solid_cylinder(r, h) + shifted(box(16, 16, 8), {-8, -8, h})};
}
Natural overlapping_balls(Random& random) {
  Shape shape;
  for (int k = 0; k < 5; ++k) {
    const double r = uniform(random, 4, 9);
    shape = shape + shifted(sphere(r), 12.0 * random_point(random));
  }
  return {shape};
}
Natural balls_in_a_row(Random& random) {
  const double r = uniform(random, 4, 9), d = uniform(random, 10, 20);
  Shape shape;
  for (int k = 0; k < 3; ++k) shape = shape + shifted(sphere(r), {d * k, 0, 0});
  return {shape, {2 * d * pi * r * r + 4 * pi / 3 * cube(r), {2, 1, 0, 2}, 2 * r + d}};
}
Natural walls_of_nearly_one_radius(Random& random) {
  const double r = uniform(random, 8, 12), more = r * log_uniform(random, 1e-8, 1e-3);
  const double h = uniform(random, 10, 20);
  return {cylinder(r, h) + shifted(cylinder(r + more, h), {0, 0, h})};
}
Natural copies_all_but_in_place(Random& random) {
  const double off = log_uniform(random, 1e-9, 1e-3);
  const Natural one = rounded_box(random);
  return {one.shape + shifted(one.shape, off * random_direction(random))};
}
Natural copies_turned_a_little(Random& random) {
  const Natural one = capsule(random);
  const double angle = 1e-8;
  const dmat3 turn(1, 0, -angle, 0, 1, 0, angle, 0, 1);
  return {one.shape + mapped(one.shape, turn)};
}
Natural ball_of_two_seams(Random& random) {
  const double r = uniform(random, 5, 20);
  return {sphere(r) + mapped(sphere(r), random_rotation(random)),
          {4 * pi / 3 * cube(r), {1, 0, 0, 0}, 2 * r}};
}
Natural overlapping_walls(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 20);
  const Shape other = mapped(cylinder(r, h), turn_about_z(uniform(random, 0.1, 1)), {0, 0, h / 2});
  return {cylinder(r, h) + other, {1.5 * pi * r * r * h, {0, 1, 2, 2}}};
}
/// A can with its rims as edges of their own, off the faces by little.
Natural cut_by_edges(Random& random) {
  const double r = uniform(random, 5, 20), h = uniform(random, 10, 20);
  const double off = log_uniform(random, 1e-9, 1e-5);
  Shape shape = solid_cylinder(r, h);
  for (const double z : {0.0, h}) {
    shape.curves.push_back(circle({off, 0, z - off}, {r, 0, 0}, {0, r, 0}));
  }
  return {shape};
}
Natural plate_of_bosses(Random& random) {
  const Plate plate = random_plate(unsigned(pick(random, 1, 1000)));
  const PlateMeasures measures = measures_of(plate);
  return {plate.shape(),
          {measures.volume, {0, measures.scrolls, measures.facets}, measures.mean_width}};
}

}  // namespace

std::vector<Family> assemblies() {
  return {
      {"box_on_cylinder", box_on_cylinder},
      {"overlapping_balls", overlapping_balls},
      {"balls_in_a_row", balls_in_a_row},
      {"walls_of_nearly_one_radius", walls_of_nearly_one_radius},
      {"copies_all_but_in_place", copies_all_but_in_place},
      {"copies_turned_a_little", copies_turned_a_little},
      {"ball_of_two_seams", ball_of_two_seams},
      {"overlapping_walls", overlapping_walls},
      {"cut_by_edges", cut_by_edges},
      {"plate_of_bosses", plate_of_bosses},
  };
}

}  // namespace taut_test
