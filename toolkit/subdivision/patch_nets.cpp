#include "taut/subdivision/patch_nets.h"

#include <Eigen/Dense>
#include <cmath>
#include <cstddef>

#include "taut/core/integers.h"

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;

/// Calls visit(i, j) for the points of a quartic triangle in their order.
template <class Visit>
void for_each_quartic_point(const Visit& visit) {
  for (int j = 0; j <= 4; ++j) {
    for (int i = 0; i + j <= 4; ++i) visit(i, j);
  }
}

double quartic_bernstein(int i, int j, double u, double v) {
  constexpr std::array<double, 5> factorial = {1, 1, 2, 6, 24};
  const int k = 4 - i - j;
  return 24 / (factorial[to_size(i)] * factorial[to_size(j)] * factorial[to_size(k)]) *
         std::pow(u, i) * std::pow(v, j) * std::pow(1 - u - v, k);
}

}  // namespace

std::vector<dvec3> bezier_net(std::array<dvec3, 16> p, int boundary) {
  // Point (column i along u, row j along v) is p[4 j + i].
  const auto extend = [&](int edge, int from, int step_across, int step_along) {
    if ((boundary & edge) == 0) return;
    for (int k = 0; k < 4; ++k) {
      dvec3* const x = p.data() + from + k * step_along;
      *x = 2.0 * x[step_across] - x[2 * step_across];
    }
  };
  extend(1, 0, 4, 1);
  extend(4, 12, -4, 1);
  extend(2, 3, -1, 4);
  extend(8, 0, 1, 4);
  const auto convert = [](const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    return std::array<dvec3, 4>{(a + 4.0 * b + c) / 6.0, (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0,
                                (b + 4.0 * c + d) / 6.0};
  };
  std::array<std::array<dvec3, 4>, 4> rows;  // [j][i]
  for (std::size_t j = 0; j < 4; ++j) {
    rows[j] = convert(p[4 * j], p[4 * j + 1], p[4 * j + 2], p[4 * j + 3]);
  }
  std::vector<dvec3> net(16);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto column = convert(rows[0][i], rows[1][i], rows[2][i], rows[3][i]);
    for (std::size_t j = 0; j < 4; ++j) net[4 * i + j] = column[j];
  }
  return net;
}

LoopMatrix loop_to_bezier(const Far::PatchTable& table,
                          const Far::PatchTable::PatchHandle& handle) {
  Eigen::Matrix<double, quartic_points, quartic_points> bernstein;
  Eigen::Matrix<double, quartic_points, loop_points> basis;
  int row = 0;
  for_each_quartic_point([&](int a, int b) {
    const double u = a / 4.0;
    const double v = b / 4.0;
    double weights[loop_points];
    table.EvaluateBasis(handle, u, v, weights);
    for (int k = 0; k < loop_points; ++k) basis(row, k) = weights[k];
    int column = 0;
    for_each_quartic_point(
        [&](int i, int j) { bernstein(row, column++) = quartic_bernstein(i, j, u, v); });
    ++row;
  });
  basis = bernstein.fullPivLu().solve(basis).eval();
  LoopMatrix result;
  for (int r = 0; r < quartic_points; ++r) {
    for (int k = 0; k < loop_points; ++k) {
      result[to_size(r)][to_size(k)] = std::round(48 * basis(r, k)) / 48;
    }
  }
  return result;
}

std::vector<dvec3> quartic_of_gregory(const std::array<dvec3, gregory_points>& net,
                                      const std::array<bool, 3>& regular) {
  std::array<dvec3, 3> inside;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const std::size_t last = (k + 2) % 3;
    const dvec3& begins = net[5 * k + 3];
    const dvec3& ends = net[5 * k + 4];
    const bool one = regular[k] && regular[next] != regular[last];
    inside[k] = !one ? 0.5 * (begins + ends) : regular[next] ? begins : ends;
  }
  return {net[0],  net[1],    net[15],   net[7], net[5],  //
          net[2],  inside[0], inside[1], net[6],          //
          net[17], inside[2], net[16],                    //
          net[11], net[12],                               //
          net[10]};
}

}  // namespace taut
