#include <gtest/gtest.h>

#include <cmath>

#include "support_checks.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and reference answers

// More than 100,000 directions in all: values within support_accuracy of the diagonal, bounds never
// below. Every direction is asked cold of both kinds of bounds, and with the neighbour's contact as
// hint.

/// Rational quarter circles meet the circle to a few rounding units.
constexpr double circle_rounding = 1e-15;

void sweep(const Scene& scene, const SupportTruth& truth,
           const std::vector<dvec3>& sweep_directions, const std::string& name,
           double model_error = 0, double bound_excess = support_accuracy) {
  SupportQuery nets(scene);
  SupportQuery coons(scene, {}, SupportBounds::coons);
  SupportQuery warm(scene);
  SupportErrors of_nets, of_coons, of_warm;
  Contact near;
  for (const dvec3& n : sweep_directions) {
    const SupportRange range = truth(n);
    const SupportTruth known = [&](const dvec3&) { return range; };
    check_support(scene, known, n, nets(n), of_nets);
    check_support(scene, known, n, coons(n), of_coons);
    const Support s = warm(n, near);
    near = s.contact;
    check_support(scene, known, n, s, of_warm);
  }
  expect_correct(of_nets, name + " (nets)", model_error, bound_excess);
  expect_correct(of_coons, name + " (coons)", model_error, bound_excess);
  expect_correct(of_warm, name + " (hints)", model_error, bound_excess);
}

/// `count` directions: special ones, some that miss a pole by 1e-1 .. 1e-16, random others.
std::vector<dvec3> sweep_directions(unsigned seed, std::size_t count) {
  Random random(seed);
  std::vector<dvec3> result = special_directions(random);
  const std::size_t at_poles = result.size() + count / 50;
  while (result.size() < at_poles) {
    const dvec3 pole(0, 0, pick(random, 0, 1) == 0 ? 1 : -1);
    result.push_back(unit(pole + log_uniform(random, 1e-16, 0.1) * random_direction(random)));
  }
  while (result.size() < count) result.push_back(random_direction(random));
  result.resize(count);
  return result;
}

TEST(SupportSweep, Sphere) {
  const Scene scene = make_scene(sphere());
  sweep(scene, closed_form(scene, [](const rvec3& n) { return glm::length(n); }),
        sweep_directions(1, 14'000), "sphere", circle_rounding);
}

TEST(SupportSweep, Torus) {
  const Scene scene = make_scene(torus(2, 0.5));
  const auto h = [](const rvec3& n) {
    return 2 * std::sqrt(n.x * n.x + n.y * n.y) + 0.5L * glm::length(n);
  };
  sweep(scene, closed_form(scene, h), sweep_directions(2, 12'000), "torus", circle_rounding);
}

TEST(SupportSweep, Ellipsoid) {
  const Scene scene = make_scene(ellipsoid(3, 2, 1));
  const auto h = [](const rvec3& n) { return glm::length(rvec3(3, 2, 1) * n); };
  sweep(scene, closed_form(scene, h), sweep_directions(3, 12'000), "ellipsoid", circle_rounding);
}

TEST(SupportSweep, Circles) {
  const Scene scene = make_scene(oloid());
  const auto h = [](const rvec3& n) {
    return std::max(std::hypot(n.x, n.y), n.x + std::hypot(n.x, n.z));
  };
  sweep(scene, closed_form(scene, h), sweep_directions(4, 12'000), "circles", circle_rounding);
}

TEST(SupportSweep, Teapot) {
  const Scene scene = make_scene(teapot());
  sweep(scene, reference(scene), sweep_directions(5, 20'000), "teapot");
}

TEST(SupportSweep, RationalPatchesOfDegreesOneToSeven) {
  Random random(6);
  for (int p = 1; p <= 7; ++p) {
    for (int q = 1; q <= 7; ++q) {
      for (const double weights : {1.0, log_uniform(random, 1.1, 30)}) {
        const Scene scene = make_scene(of_patch(random_patch(random, p, q, weights)));
        std::vector<dvec3> tried = random_directions(random, 309);
        for (int axis = 0; axis < 3; ++axis) {
          dvec3 n(0.0);
          n[axis] = pick(random, 0, 1) == 0 ? 1 : -1;
          tried.push_back(n);
        }
        sweep(scene, reference(scene), tried,
              "degrees " + std::to_string(p) + " x " + std::to_string(q) + ", weights up to " +
                  std::to_string(weights));
      }
    }
  }
}

}  // namespace
}  // namespace taut
