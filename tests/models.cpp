#include "models.h"

#include <array>
#include <cmath>

#include "taut/core/tolerances.h"
#include "taut/io/model/read_model.h"

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

Model posed_teapots(unsigned seed, int count) {
  Model model = make_model(teapot());
  const taut::Box box = model.control_box();
  const dvec3 center = box.center();
  const double half = 0.25 * std::cbrt(double(count)) * taut::diagonal(box);
  Random random(seed);
  model.clear_instances();
  for (int k = 0; k < count; ++k) {
    taut::RigidMotion pose;
    pose.rotation = random_rotation(random);
    pose.translation = half * random_point(random) - pose.rotation * center;
    model.add_instance(0, pose);
  }
  return model;
}

Shape blob(unsigned seed) {
  constexpr int around = 6;  // spans of u, periodic
  constexpr int down = 4;    // spans of v, pole to pole
  Random random(seed);

  struct Dent {
    dvec3 direction;
    double depth, width;
  };
  std::vector<Dent> dents(std::size_t(pick(random, 1, 3)));
  for (Dent& dent : dents) {
    // About the equator, where control points can move freely.
    const double t = uniform(random, 0, 2 * pi);
    const double z = uniform(random, -0.5, 0.5);
    const double r = std::sqrt(1 - z * z);
    dent = {
        {r * std::cos(t), r * std::sin(t), z}, uniform(random, 0.6, 1), uniform(random, 0.5, 0.8)};
  }
  const dvec3 wave = 2.0 * random_direction(random);
  const double phase = uniform(random, 0, 2 * pi);
  const auto radius = [&](const dvec3& direction) {
    double r = 1 + 0.15 * std::sin(glm::dot(wave, direction) + phase);
    for (const Dent& dent : dents) {
      const double off = std::acos(glm::clamp(glm::dot(direction, dent.direction), -1.0, 1.0));
      r *= 1 - dent.depth * std::exp(-(off * off) / (dent.width * dent.width));
    }
    return r;
  };

  // Rows of control points: pole, ring in the pole's tangent plane, three free rows, ring, pole.
  std::array<std::array<dvec3, down + 3>, around> net;
  const double start = uniform(random, 0, 2 * pi);
  const auto angle = [&](int i) { return start + 2 * pi * i / around; };
  for (int i = 0; i < around; ++i) {
    for (int row = 2; row <= down; ++row) {
      const double t = angle(i) + uniform(random, -0.15, 0.15);
      const double s = pi * (row - 1) / down + uniform(random, -0.1, 0.1);
      const dvec3 d(std::sin(s) * std::cos(t), std::sin(s) * std::sin(t), std::cos(s));
      net[std::size_t(i)][std::size_t(row)] = radius(d) * d;
    }
  }
  for (const int sign : {1, -1}) {
    const auto row = std::size_t(sign > 0 ? 0 : down + 2);
    const auto ring = std::size_t(sign > 0 ? 1 : down + 1);
    const double r = uniform(random, 0.7, 1);
    const double pole_y = uniform(random, -0.1, 0.1);
    const dvec3 pole{uniform(random, -0.1, 0.1), pole_y, sign * r};
    // Two vectors that span the tangent plane, not quite orthogonal nor level.
    const auto off = [&] { return uniform(random, -0.08, 0.08); };
    const double x = uniform(random, 0.3, 0.45);
    const double y = uniform(random, 0.3, 0.45);
    const double a_z = off();
    const dvec3 a{x, off(), a_z};
    const double b_z = off();
    const dvec3 b{off(), y, b_z};
    for (int i = 0; i < around; ++i) {
      net[std::size_t(i)][row] = pole;
      net[std::size_t(i)][ring] = pole + std::cos(angle(i)) * a + std::sin(angle(i)) * b;
    }
  }

  NurbsSurface surface{3, 3, {}, {0, 0, 0}, {}};
  for (int k = -3; k <= around + 3; ++k) surface.knots_u.push_back(k);
  for (int k = 0; k <= down; ++k) surface.knots_v.push_back(k);
  surface.knots_v.insert(surface.knots_v.end(), 3, double(down));
  for (int i = 0; i < around + 3; ++i) {
    for (const dvec3& p : net[std::size_t(i % around)]) {
      surface.points.push_back(taut::homogeneous(p));
    }
  }
  const dvec3 translation = 0.3 * random_point(random);
  return mapped({{surface}, {}, {}}, random_rotation(random), translation);
}

BezierPatch random_patch(Random& random, int degree_u, int degree_v, double weight_range) {
  BezierPatch patch{degree_u, degree_v, {}};
  for (int k = 0; k < (degree_u + 1) * (degree_v + 1); ++k) {
    const double w = weight_range > 1 ? log_uniform(random, 1 / weight_range, weight_range) : 1;
    patch.points.push_back(taut::homogeneous(random_point(random), w));
  }
  return patch;
}

BezierPatch random_patch(Random& random, DegreeRange degrees, double weight_range) {
  const int degree_u = pick(random, degrees.lower, degrees.upper);
  const int degree_v = pick(random, degrees.lower, degrees.upper);
  return random_patch(random, degree_u, degree_v, weight_range);
}

BezierCurve random_curve(Random& random, int degree, double weight_range) {
  return {random_patch(random, degree, 0, weight_range).points};
}

}  // namespace taut_test
