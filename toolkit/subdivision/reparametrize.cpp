#include "taut/subdivision/reparametrize.h"

#include <algorithm>
#include <vector>

#include "taut/core/integers.h"
#include "taut/subdivision/triangle_points.h"
#include "taut/surface/bernstein.h"

namespace taut {
namespace {

double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Bernstein coefficients of a polynomial in one variable.
using Coefficients = std::vector<double>;

/// What the product of two coefficients of degrees m and n, the second one's index running first,
/// counts with.
std::vector<double> product_factors(int m, int n) {
  const std::vector<double> first = binomials(m);
  const std::vector<double> second = binomials(n);
  const std::vector<double> whole = binomials(m + n);
  std::vector<double> factors;
  factors.reserve(first.size() * second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < second.size(); ++j) {
      factors.push_back(first[i] * second[j] / whole[i + j]);
    }
  }
  return factors;
}

Coefficients product(const Coefficients& a, const Coefficients& b) {
  const int m = static_cast<int>(a.size()) - 1;
  const int n = static_cast<int>(b.size()) - 1;
  const std::vector<double> factors = product_factors(m, n);
  Coefficients c(to_size(m + n + 1));
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j) {
      c[to_size(i + j)] += factors[to_size(i * (n + 1) + j)] * a[to_size(i)] * b[to_size(j)];
    }
  }
  return c;
}

/// Bernstein coefficients of a polynomial in two variables, along t within along s.
struct Net {
  int degree = 0;  ///< in both
  std::vector<double> c = {1};

  double at(int i, int j) const { return c[to_size(i * (degree + 1) + j)]; }
  double& at(int i, int j) { return c[to_size(i * (degree + 1) + j)]; }
};

Net product(const Net& a, const Net& b) {
  Net r;
  r.degree = a.degree + b.degree;
  r.c.assign(to_size((r.degree + 1) * (r.degree + 1)), 0.0);
  const std::vector<double> factors = product_factors(a.degree, b.degree);
  const auto factor = [&](int i, int k) { return factors[to_size(i * (b.degree + 1) + k)]; };
  for (int i = 0; i <= a.degree; ++i) {
    for (int k = 0; k <= b.degree; ++k) {
      const double u = factor(i, k);
      for (int j = 0; j <= a.degree; ++j) {
        for (int l = 0; l <= b.degree; ++l) {
          const double v = factor(j, l);
          r.at(i + k, j + l) += u * v * a.at(i, j) * b.at(k, l);
        }
      }
    }
  }
  return r;
}

/// A step of de Casteljau's algorithm on a triangular net of this degree, at least 1.
std::vector<dvec3> inner_net(const std::vector<dvec3>& net, std::size_t degree, const dvec3& at) {
  std::vector<dvec3> inner(degree * (degree + 1) / 2);
  for (std::size_t j = 0; j < degree; ++j) {
    for (std::size_t i = 0; i + j < degree; ++i) {
      inner[triangle_point(degree - 1, i, j)] = at.x * net[triangle_point(degree, i, j)] +
                                                at.y * net[triangle_point(degree, i + 1, j)] +
                                                at.z * net[triangle_point(degree, i, j + 1)];
    }
  }
  return inner;
}

}  // namespace

/// With B_i^m(s w) = sum over k >= i of B_i^k(w) B_k^m(s).
BezierPatch tapered(const BezierPatch& patch, double w0, double w1) {
  const int m = patch.degree_u;
  const int n = patch.degree_v;
  BezierPatch result;
  result.degree_u = m;
  result.degree_v = m + n;
  result.points.assign(to_size((m + 1) * (m + n + 1)), dvec4(0, 0, 0, 1));
  const Coefficients ends[2] = {{1 - w0, 1 - w1}, {w0, w1}};
  for (int k = 0; k <= m; ++k) {
    std::vector<dvec3> row(to_size(m + n + 1), dvec3(0.0));
    for (int i = 0; i <= k; ++i) {
      // B_i^k(w(t)), raised to degree m in t.
      Coefficients b(to_size(m - k + 1), binomial(k, i));
      for (int f = 0; f < k; ++f) b = product(b, ends[f < i ? 1 : 0]);
      for (int a = 0; a <= m; ++a) {
        for (int j = 0; j <= n; ++j) {
          const double weight = binomial(m, a) * binomial(n, j) / binomial(m + n, a + j);
          row[to_size(a + j)] += weight * b[to_size(a)] * dvec3(patch.at(i, j));
        }
      }
    }
    for (int j = 0; j <= m + n; ++j) result.at(k, j) = homogeneous(row[to_size(j)]);
  }
  return result;
}

BezierPatch quad_of_triangle(std::span<const dvec3> triangle, const std::array<dvec3, 4>& corners) {
  const int n = static_cast<int>(triangle_degree_of(triangle.size()));
  // The barycentric coordinates over the quadrilateral, and their powers.
  std::array<std::vector<Net>, 3> power;
  for (int b = 0; b < 3; ++b) {
    const Net coordinate{1, {corners[0][b], corners[1][b], corners[2][b], corners[3][b]}};
    auto& powers = power[to_size(b)];
    powers.resize(to_size(n + 1));
    for (std::size_t k = 1; k < powers.size(); ++k) powers[k] = product(powers[k - 1], coordinate);
  }
  BezierPatch result;
  result.degree_u = result.degree_v = n;
  std::vector<dvec3> sum(to_size((n + 1) * (n + 1)), dvec3(0.0));
  std::size_t point = 0;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i + j <= n; ++i, ++point) {
      const double multinomial = binomial(n, i) * binomial(n - i, j);
      const Net basis = product(product(power[0][to_size(n - i - j)], power[1][to_size(i)]),
                                power[2][to_size(j)]);
      for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] += multinomial * basis.c[k] * triangle[point];
      }
    }
  }
  result.points.reserve(sum.size());
  for (const dvec3& p : sum) result.points.push_back(homogeneous(p));
  return result;
}

dvec3 value_of_triangle(std::span<const dvec3> triangle, const dvec3& at) {
  std::vector<dvec3> net(triangle.begin(), triangle.end());
  for (std::size_t n = triangle_degree_of(triangle.size()); n > 0; --n) net = inner_net(net, n, at);
  return net.front();
}

/// Each point is the blossom at as many times each corner as it counts towards it.
std::vector<dvec3> sub_triangle(std::span<const dvec3> triangle,
                                const std::array<dvec3, 3>& corners) {
  const std::size_t n = triangle_degree_of(triangle.size());
  std::vector<dvec3> result(triangle.size());
  for (std::size_t j = 0; j <= n; ++j) {
    for (std::size_t i = 0; i + j <= n; ++i) {
      std::vector<dvec3> net(triangle.begin(), triangle.end());
      for (std::size_t degree = n; degree > 0; --degree) {
        const std::size_t step = n - degree;
        net = inner_net(net, degree, corners[step < i ? 1 : step < i + j ? 2 : 0]);
      }
      result[triangle_point(n, i, j)] = net.front();
    }
  }
  return result;
}

std::vector<dvec3> elevated_triangle(std::span<const dvec3> triangle) {
  const std::size_t n = triangle_degree_of(triangle.size()) + 1;
  std::vector<dvec3> result((n + 1) * (n + 2) / 2, dvec3(0.0));
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i + j < n; ++i) {
      const dvec3 p = triangle[triangle_point(n - 1, i, j)] / double(n);
      result[triangle_point(n, i, j)] += double(n - i - j) * p;
      result[triangle_point(n, i + 1, j)] += double(i + 1) * p;
      result[triangle_point(n, i, j + 1)] += double(j + 1) * p;
    }
  }
  return result;
}

std::vector<dvec3> elevated_curve(std::vector<dvec3> points, std::size_t degree) {
  for (std::size_t n = points.size(); n <= degree; ++n) {
    std::vector<dvec3> up(n + 1);
    for (std::size_t k = 0; k <= n; ++k) {
      const double s = double(k) / double(n);
      up[k] = k == 0 ? points[0] : k == n ? points[n - 1] : s * points[k - 1] + (1 - s) * points[k];
    }
    points = std::move(up);
  }
  return points;
}

BezierPatch reversed_u(const BezierPatch& patch) {
  BezierPatch result = patch;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) result.at(i, j) = patch.at(patch.degree_u - i, j);
  }
  return result;
}

BezierPatch reversed_v(const BezierPatch& patch) {
  BezierPatch result = patch;
  for (int i = 0; i <= patch.degree_u; ++i) {
    for (int j = 0; j <= patch.degree_v; ++j) result.at(i, j) = patch.at(i, patch.degree_v - j);
  }
  return result;
}

}  // namespace taut
