#include "models.h"

#include <cmath>

#include "taut/core/tolerances.h"
#include "taut/io/read_model.h"

namespace taut_test {

double uniform(Random& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

double log_uniform(Random& random, double lower, double upper) {
  return std::exp(uniform(random, std::log(lower), std::log(upper)));
}

int pick(Random& random, int lower, int upper) {
  return std::uniform_int_distribution<int>(lower, upper)(random);
}

dvec3 random_point(Random& random) {
  const double x = uniform(random, -1, 1);
  const double y = uniform(random, -1, 1);
  return {x, y, uniform(random, -1, 1)};
}

dvec3 random_direction(Random& random) {
  for (;;) {
    const dvec3 p = random_point(random);
    const double length = glm::length(p);
    if (length > 0.01 && length <= 1) return p / length;
  }
}

dmat3 random_rotation(Random& random) {
  const dvec3 a = random_direction(random);
  const dvec3 b = glm::normalize(glm::cross(a, random_direction(random)));
  return {a, b, glm::cross(a, b)};
}

dmat3 skew_rotation() {
  Random random(20);
  return random_rotation(random);
}

Model make_model(const Shape& shape) {
  taut::Part part;
  part.name = "test";
  for (const NurbsSurface& surface : shape.surfaces) part.add_surface(surface, "face");
  for (const NurbsCurve& curve : shape.curves) part.add_curve(curve, "edge");
  for (const dvec3& p : shape.points) part.add_point(p);
  Model model;
  model.add_part(std::move(part), taut::smooth_join_angle);
  return model;
}

taut::Scene make_scene(const Shape& shape, int threads) {
  return taut::Scene(make_model(shape), {.threads = threads, .progress = {}});
}

Shape teapot() {
  Model model;
  taut::read_model(TAUT_DATA "/teapot.bpt", model);
  Shape shape;
  for (const taut::Patch& patch : model.parts()[0].patches()) {
    shape.surfaces.push_back(taut::as_nurbs(patch.bezier));
  }
  return shape;
}

BezierPatch random_patch(Random& random, int degree_u, int degree_v, double weight_range) {
  BezierPatch patch{degree_u, degree_v, {}};
  for (int k = 0; k < (degree_u + 1) * (degree_v + 1); ++k) {
    const double w = weight_range > 1 ? log_uniform(random, 1 / weight_range, weight_range) : 1;
    patch.points.push_back(taut::homogeneous(random_point(random), w));
  }
  return patch;
}

BezierCurve random_curve(Random& random, int degree, double weight_range) {
  return {random_patch(random, degree, 0, weight_range).points};
}

}  // namespace taut_test
