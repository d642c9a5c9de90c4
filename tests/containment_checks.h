#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "models.h"
#include "reference.h"
#include "taut/bounds/model_support.h"
#include "taut/containment/location.h"

namespace taut_test {

/// A body whose hull has a signed distance in closed form, in long double.
struct KnownHull {
  std::string name;
  Shape shape;
  std::function<real(const rvec3& x)> distance;
};

inline real distance_to_segment(const rvec3& x, const rvec3& a, const rvec3& b) {
  const real t = glm::dot(x - a, b - a) / glm::dot(b - a, b - a);
  return glm::distance(x, a + std::clamp(t, real(0), real(1)) * (b - a));
}

inline real distance_to_box(const rvec3& x, const rvec3& size) {
  const rvec3 beyond = glm::max(-x, x - size);
  const real inside = std::max({beyond.x, beyond.y, beyond.z});
  return inside <= 0 ? inside : glm::length(glm::max(beyond, rvec3(0)));
}

/// All of them are the Minkowski sum of a ball with something flat or thin, or a box. With a flat
/// set K, max over n of x . n - h_K(n) is the distance from it, so that of K + r B is that less r.
inline std::vector<KnownHull> known_hulls() {
  return {
      {"sphere", sphere(), [](const rvec3& x) { return glm::length(x) - 1; }},
      {"box", box(1, 2, 3),
       [](const rvec3& x) {
         return distance_to_box(x, {1, 2, 3});
       }},
      {"capsule", two_spheres(1, 1, 3),
       [](const rvec3& x) {
         return distance_to_segment(x, {0, 0, 0}, {0, 0, 3}) - 1;
       }},
      {"torus", torus(2, 0.5),
       [](const rvec3& x) {
         const real r = std::max(real(0), std::hypot(x.x, x.y) - 2);
         return std::hypot(r, x.z) - real(0.5);
       }},
  };
}

/// A point with what is known of it.
struct Probe {
  dvec3 x;
  taut::Location truth;
};

/// Points on the boundary of a scene's hull, with outward normals: support points of random
/// directions, of the axes and diagonals and of directions very near to these.
struct BoundaryPoint {
  dvec3 x;
  dvec3 n;
};
inline std::vector<BoundaryPoint> boundary_points(const taut::Scene& scene, Random& random,
                                                  int count) {
  taut::SupportQuery query(scene);
  std::vector<BoundaryPoint> points;
  for (int k = 0; k < count; ++k) {
    dvec3 n = random_direction(random);
    if (k % 4 == 1) n = dvec3{pick(random, -1, 1), pick(random, -1, 1), pick(random, -1, 1)};
    if (n == dvec3(0.0)) n = dvec3(0, 0, 1);
    if (k % 8 == 1) n += log_uniform(random, 1e-15, 1e-3) * random_direction(random);
    n = taut::unit(n);
    points.push_back({support(query, scene, n).point, n});
  }
  return points;
}

/// Distances from a boundary that points are to have, as shares of the diagonal.
inline double probe_distance(Random& random, int k) {
  constexpr double decades[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
  return k % 2 == 0 ? decades[(k / 2) % 10] : log_uniform(random, 1e-12, 1e-3);
}

/// Points next to the boundary of a known hull, off along the normal, along an axis, and anywhere,
/// with their closed form's answer. Those between 1e-13 and 9e-13 of the diagonal, for which none
/// is asked for, are left out.
inline std::vector<Probe> known_probes(const KnownHull& hull, const taut::Scene& scene,
                                       Random& random, int count) {
  std::vector<Probe> probes;
  const real diagonal = scene.diagonal();
  for (int round = 0; int(probes.size()) < count; ++round) {
    for (const BoundaryPoint& p : boundary_points(scene, random, 512)) {
      const int k = pick(random, 0, 1'000'000);
      const double d = scene.diagonal() * probe_distance(random, k) * (k % 3 == 0 ? -1 : 1);
      dvec3 x = p.x;
      if (k % 7 == 0) {
        x[k % 3] += d;
      } else if (k % 7 == 1) {
        x += std::abs(d) * random_direction(random);
      } else if (k % 7 != 2) {
        x += d * p.n;
      }
      const real truth = hull.distance(rvec3(x)) / diagonal;
      if (std::abs(truth) <= 0.9e-13L) {
        probes.push_back({x, taut::Location::on});
      } else if (std::abs(truth) >= 9e-13L) {
        probes.push_back({x, truth > 0 ? taut::Location::outside : taut::Location::inside});
      }
    }
  }
  probes.resize(std::size_t(count));
  return probes;
}

/// Points next to boundary points whose outward normals are known: outside along the normal, where
/// x . n - h(n) is the distance; inside on the way to `middle`, about which a ball of that radius
/// lies in the hull, so that a share t of the way is at least t times the radius deep; and on it.
inline Probe probe(const BoundaryPoint& p, const dvec3& middle, double radius, double distance,
                   int kind) {
  if (kind % 8 == 0) return {p.x, taut::Location::on};
  if (kind % 2 == 0) return {p.x + distance * p.n, taut::Location::outside};
  return {p.x + distance / radius * (middle - p.x), taut::Location::inside};
}

inline std::vector<Probe> probes_of(const taut::Scene& scene, const dvec3& middle, double radius,
                                    Random& random, int count) {
  std::vector<Probe> probes;
  while (int(probes.size()) < count) {
    for (const BoundaryPoint& p : boundary_points(scene, random, 512)) {
      const int k = pick(random, 0, 1'000'000);
      const double d = scene.diagonal() * probe_distance(random, k / 8);
      probes.push_back(probe(p, middle, radius, d, k));
    }
  }
  probes.resize(std::size_t(count));
  return probes;
}

/// Points of the oloid's boundary by closed form: of a ruling, or of the edge at its end. The plane
/// x cos t + y sin t + w z = 1 touches the circle about the origin in A = (cos t, sin t, 0); it
/// touches the other one, about (1, 0, 0), if w^2 = 1 - 2 cos t, in B = (1, 0, 0) + (cos t, 0, w) /
/// (1 - cos t). For smaller |w| it touches the hull in A alone.
inline BoundaryPoint oloid_point(Random& random) {
  const real pi = std::acos(real(-1));
  // The ends of the arc, where rulings end in the other circle's middle, and the middle of it.
  const real t =
      pick(random, 0, 4) == 0 ? pi / 3 * pick(random, 1, 3) : uniform(random, 1.048, 3.14);
  const real side = pick(random, 0, 1) == 0 ? 1 : -1;
  const real w = std::sqrt(std::max(real(0), 1 - 2 * std::cos(t))) * (pick(random, 0, 1) * 2 - 1);
  const rvec3 a(std::cos(t), side * std::sin(t), 0);
  const rvec3 b = rvec3(1, 0, 0) + rvec3(std::cos(t), 0, w) / (1 - std::cos(t));
  if (pick(random, 0, 3) == 0) {
    return {dvec3(a), dvec3(glm::normalize(rvec3(a.x, a.y, w * real(uniform(random, -1, 1)))))};
  }
  const real share = pick(random, 0, 3) == 0 ? real(pick(random, 0, 2)) / 2 : uniform(random, 0, 1);
  return {dvec3(a + share * (b - a)), dvec3(glm::normalize(rvec3(a.x, a.y, w)))};
}

inline std::vector<Probe> oloid_probes(const taut::Scene& scene, Random& random, int count) {
  std::vector<Probe> probes;
  while (int(probes.size()) < count) {
    const int k = pick(random, 0, 1'000'000);
    const double d = scene.diagonal() * probe_distance(random, k / 8);
    probes.push_back(probe(oloid_point(random), {0.5, 0, 0}, 0.3, d, k));
  }
  return probes;
}

/// How many of the probes a containment answers wrongly, with the first of them named.
template <class Containment>
int wrong_answers(const Containment& containment, const std::vector<Probe>& probes) {
  std::vector<dvec3> points;
  for (const Probe& probe : probes) points.push_back(probe.x);
  const std::vector<taut::Location> found = containment.locate(points);
  int wrong = 0;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    if (found[k] == probes[k].truth) continue;
    if (wrong++ > 0) continue;
    const dvec3& x = points[k];
    ADD_FAILURE() << "(" << x.x << ", " << x.y << ", " << x.z << ") is " << int(found[k])
                  << " instead of " << int(probes[k].truth);
  }
  return wrong;
}

}  // namespace taut_test
