#include "taut/surface/nearly_ruled.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "taut/core/integers.h"
#include "taut/surface/bernstein.h"

namespace taut {
namespace {

/// Upper bound of how far points move where weights are replaced by products of two factors: those
/// along the first line of each parameter.
double distance_by_weights(const BezierPatch& patch) {
  double most = 0;
  Box box;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) {
      const double product = patch.at(i, 0).w * patch.at(0, j).w / patch.at(0, 0).w;
      most = std::max(most, std::abs(patch.at(i, j).w / product - 1));
      box.include(euclidean(patch.at(i, j)));
    }
  }
  return most < 1 ? 2 * most / (1 - most) * diagonal(box) : infinity;
}

/// Of the points of lines along u from the segments between their ends, by points that divide these
/// all alike.
double distance_from_lines_alike(const BezierPatch& patch) {
  const int last = patch.degree_u;
  const auto x = [&](int i, int j) { return euclidean(patch.at(i, j)); };
  double farthest = 0;
  for (int i = 1; i < last; ++i) {
    double along = 0, square = 0;
    for (int j = 0; j <= patch.degree_v; ++j) {
      const dvec3 segment = x(last, j) - x(0, j);
      along += glm::dot(x(i, j) - x(0, j), segment);
      square += glm::dot(segment, segment);
    }
    const double share = square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
    for (int j = 0; j <= patch.degree_v; ++j) {
      farthest = std::max(farthest, glm::distance(x(i, j), glm::mix(x(0, j), x(last, j), share)));
    }
  }
  return farthest + distance_by_weights(patch);
}

/// The same, whatever speed each line has. With d(v) the segment and e(u, v) the way from its
/// start, a point is |e x d| / |d| off the line, and beyond an end by -e . d / |d| or
/// -(d - e) . d / |d| at most; all of these are bounded by their Bernstein coefficients. Infinity
/// where weights differ, or where segments may be points.
double distance_from_lines(const BezierPatch& patch) {
  if (!is_polynomial(patch.points)) return infinity;
  const int last = patch.degree_u;
  const int degree = patch.degree_v;
  const std::vector<double> single = binomials(degree);
  const std::vector<double> twice = binomials(2 * degree);
  const auto x = [&](int i, int j) { return euclidean(patch.at(i, j)); };
  const auto segment = [&](int j) { return x(last, j) - x(0, j); };
  double shortest = infinity, off = 0, beyond = 0;
  for (int k = 0; k <= 2 * degree; ++k) {
    const auto coefficient = [&](const auto& of) {
      auto sum = of(0, 0) * 0.0;
      for (int j = std::max(0, k - degree); j <= std::min(k, degree); ++j) {
        sum += single[to_size(j)] * single[to_size(k - j)] / twice[to_size(k)] * of(j, k - j);
      }
      return sum;
    };
    const double square =
        coefficient([&](int j, int l) { return glm::dot(segment(j), segment(l)); });
    shortest = std::min(shortest, square);
    for (int i = 1; i < last; ++i) {
      const auto way = [&](int j) { return x(i, j) - x(0, j); };
      off = std::max(
          off,
          glm::length(coefficient([&](int j, int l) { return glm::cross(way(j), segment(l)); })));
      const double along = coefficient([&](int j, int l) { return glm::dot(way(j), segment(l)); });
      beyond = std::max({beyond, -along, along - square});
    }
  }
  return shortest > 0 ? (off + beyond) / std::sqrt(shortest) : infinity;
}

/// Bernstein coefficients of Su x Sv. @pre a polynomial patch
std::vector<dvec3> normal_coefficients(const BezierPatch& patch) {
  const int p = patch.degree_u;
  const int q = patch.degree_v;
  const auto x = [&](int i, int j) { return euclidean(patch.at(i, j)); };
  const std::vector<double> p1 = binomials(p - 1), p0 = binomials(p), pp = binomials(2 * p - 1);
  const std::vector<double> q1 = binomials(q - 1), q0 = binomials(q), qq = binomials(2 * q - 1);
  std::vector<dvec3> result(to_size(4 * p * q), dvec3(0.0));
  for (int i = 0; i < p; ++i) {
    for (int j = 0; j <= q; ++j) {
      const dvec3 along_u = double(p) * p1[to_size(i)] * q0[to_size(j)] * (x(i + 1, j) - x(i, j));
      for (int k = 0; k <= p; ++k) {
        for (int l = 0; l < q; ++l) {
          const dvec3 along_v =
              double(q) * p0[to_size(k)] * q1[to_size(l)] * (x(k, l + 1) - x(k, l));
          const double share = pp[to_size(i + k)] * qq[to_size(j + l)];
          result[to_size((i + k) * 2 * q + j + l)] += glm::cross(along_u, along_v) / share;
        }
      }
    }
  }
  return result;
}

/// The direction to which vectors are at right angles as nearly as to any.
dvec3 across_all(const std::vector<dvec3>& vectors) {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const dvec3& n : vectors) {
    const Eigen::Vector3d v(n.x, n.y, n.z);
    squares += v * v.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares);
  const Eigen::Vector3d least = solver.eigenvectors().col(0);
  return {least[0], least[1], least[2]};
}

}  // namespace

double distance_from_ruled(const BezierPatch& patch, Direction direction) {
  if (direction == Direction::v) return distance_from_ruled(transposed(patch), Direction::u);
  return std::min(distance_from_lines_alike(patch), distance_from_lines(patch));
}

double square_of_lines(const BezierPatch& patch, Direction direction) {
  if (direction == Direction::v) return square_of_lines(transposed(patch), Direction::u);
  double sum = 0;
  for (int j = 0; j <= patch.degree_v; ++j) {
    const dvec3 segment = euclidean(patch.at(patch.degree_u, j)) - euclidean(patch.at(0, j));
    sum += glm::dot(segment, segment);
  }
  return sum / (patch.degree_v + 1);
}

/// Where normals n are at angles to the lines' direction e of sine |n . e| <= s < 1, the curve on
/// the patch that goes as e does, but for what e has along n, ends on the border, and leaves the
/// line through any of its points by no more than s / sqrt(1 - s^2) times the way along it. So the
/// point is no farther from the segment between its ends, on both sides, than half of that times
/// the patch's extent.
NearCylinder near_cylinder(const BezierPatch& patch) {
  NearCylinder result;
  if (!is_polynomial(patch.points)) return result;
  const std::vector<dvec3> normals = normal_coefficients(patch);
  result.along = across_all(normals);
  dvec3 sum(0.0);
  for (const dvec3& n : normals) sum += n;
  const dvec3 middle = unit(sum);
  double along = 0, least = infinity;
  for (const dvec3& n : normals) {
    along = std::max(along, std::abs(glm::dot(n, result.along)));
    least = std::min(least, glm::dot(n, middle));
  }
  Interval extent{infinity, -infinity};
  for (const dvec4& p : patch.points) {
    const double t = glm::dot(euclidean(p), result.along);
    extent = {std::min(extent.lower, t), std::max(extent.upper, t)};
  }
  result.length = extent.upper - extent.lower;
  if (least > 0) result.turned = along / least;
  if (!(result.turned < 1)) return result;
  result.distance =
      0.5 * result.length * result.turned / std::sqrt(1 - result.turned * result.turned);
  return result;
}

}  // namespace taut
