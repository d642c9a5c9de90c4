#include "taut/subdivision/dart_limit.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace taut {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Numbers of the points of a ring.
struct Ring {
  Index n;
  bool quads;

  Index size() const { return quads ? 2 * n + 1 : n + 1; }
  Index end(Index i) const { return 1 + (i + n) % n; }
  Index corner(Index i) const { return 1 + n + (i + n) % n; }
  /// The point on the other side of the sharp edge.
  Index mirrored(Index k) const {
    if (k == 0) return 0;
    return k <= n ? end(1 - k) : corner(n - k);
  }
};

void set_sharp_edge(MatrixXd& s, const Ring& ring) {
  s.row(ring.end(0)).setZero();
  s(ring.end(0), 0) = s(ring.end(0), ring.end(0)) = 0.5;
}

MatrixXd catmark_matrix(const Ring& ring) {
  const auto n = double(ring.n);
  MatrixXd s = MatrixXd::Zero(ring.size(), ring.size());
  s(0, 0) = (n - 2) / n;
  for (Index i = 0; i < ring.n; ++i) {
    for (const Index k : {Index{0}, ring.end(i), ring.end(i + 1), ring.corner(i)}) {
      s(ring.corner(i), k) = 0.25;
    }
  }
  for (Index i = 0; i < ring.n; ++i) {
    s.row(ring.end(i)) = 0.25 * (s.row(ring.corner(i)) + s.row(ring.corner(i - 1)));
    s(ring.end(i), 0) += 0.25;
    s(ring.end(i), ring.end(i)) += 0.25;
    s(0, ring.end(i)) += 1 / (n * n);
    s.row(0) += s.row(ring.corner(i)) / (n * n);
  }
  set_sharp_edge(s, ring);
  return s;
}

MatrixXd loop_matrix(const Ring& ring) {
  const auto n = double(ring.n);
  const double turn = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n);
  const double share = (0.625 - turn * turn) / n;
  MatrixXd s = MatrixXd::Zero(ring.size(), ring.size());
  s(0, 0) = 1 - n * share;
  for (Index i = 0; i < ring.n; ++i) {
    s(0, ring.end(i)) = share;
    s(ring.end(i), 0) = s(ring.end(i), ring.end(i)) = 0.375;
    s(ring.end(i), ring.end(i - 1)) = s(ring.end(i), ring.end(i + 1)) = 0.125;
  }
  set_sharp_edge(s, ring);
  return s;
}

/// The left eigenvector of the eigenvalue that has this rank by modulus. @pre that one is simple
VectorXd left_eigenvector(const MatrixXd& s, std::size_t rank) {
  const Eigen::EigenSolver<MatrixXd> solver(s.transpose());
  const auto& values = solver.eigenvalues();
  std::vector<Index> order(std::size_t(values.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::abs(values[a]) > std::abs(values[b]); });
  return solver.eigenvectors().col(order[rank]).real();
}

}  // namespace

std::optional<VertexLimit> dart_limit(CageScheme scheme, std::span<const dvec3> ring) {
  const bool quads = scheme != CageScheme::loop;
  const auto size = Index(ring.size());
  const Ring about{quads ? (size - 1) / 2 : size - 1, quads};
  const MatrixXd s = quads ? catmark_matrix(about) : loop_matrix(about);
  // Of the even parts' eigenvalues 1 and the next are simple, of the odd parts' the greatest; of
  // all but 1 these two are the greatest (seen for 3 to 50 edges).
  MatrixXd even = 0.5 * s;
  MatrixXd odd = 0.5 * s;
  for (Index k = 0; k < size; ++k) {
    even.col(about.mirrored(k)) += 0.5 * s.col(k);
    odd.col(about.mirrored(k)) -= 0.5 * s.col(k);
  }
  const auto applied = [&](const VectorXd& weights) {
    dvec3 sum(0.0);
    for (Index k = 1; k < size; ++k) sum += weights[k] * (ring[std::size_t(k)] - ring[0]);
    return sum;
  };
  const VectorXd position = left_eigenvector(even, 0);
  const dvec3 along = applied(left_eigenvector(even, 1));
  const dvec3 across = applied(left_eigenvector(odd, 0));
  const dvec3 normal = glm::cross(along, across);
  const double sine = glm::length(normal) / (glm::length(along) * glm::length(across));
  constexpr double least_sine = 1e-9;
  if (!(sine > least_sine)) return std::nullopt;
  return VertexLimit{ring[0] + applied(position) / position.sum(), glm::normalize(normal)};
}

}  // namespace taut
