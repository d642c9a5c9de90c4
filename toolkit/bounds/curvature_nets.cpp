#include "taut/bounds/curvature_nets.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "taut/bounds/normal_net.h"
#include "taut/bounds/scaled_net.h"
#include "taut/bounds/vector_net.h"

namespace taut {
namespace {

/// What a net that is zero at a pole, but for rounding and for how well the planes there agree, may
/// be there as a share of what its factors' sizes allow.
constexpr double pole_rounding = 1e-9;

double size_of(double x) { return std::abs(x); }
double size_of(const dvec3& x) { return glm::length(x); }

template <class Entry>
double largest(const std::vector<Entry>& entries) {
  double result = 0;
  for (const Entry& e : entries) result = std::max(result, size_of(e));
  return result;
}

/// Divides by the distance from the side, to a power. False if the net does not vanish there, to
/// within `zero`.
template <class Entry>
bool divide(ScaledNet<Entry>& net, Side side, int power, double zero) {
  for (; power > 0; --power) {
    const bool of_u = along_v(side);
    const NetShape less{net.shape.p - (of_u ? 1 : 0), net.shape.q - (of_u ? 0 : 1)};
    if (less.p < 0 || less.q < 0) return false;
    ScaledNet<Entry> quotient(less);
    const int di = of_u && !at_upper_end(side) ? 1 : 0;
    const int dj = !of_u && !at_upper_end(side) ? 1 : 0;
    for (int i = 0; i <= less.p; ++i) {
      for (int j = 0; j <= less.q; ++j) quotient.at(i, j) = net.at(i + di, j + dj);
    }
    const int last = of_u ? net.shape.q : net.shape.p;
    const int end = at_upper_end(side) ? (of_u ? net.shape.p : net.shape.q) : 0;
    const std::vector<double> factors = binomials(last);
    for (int k = 0; k <= last; ++k) {
      const Entry& entry = of_u ? net.at(end, k) : net.at(k, end);
      if (size_of(entry) > zero * factors[std::size_t(k)]) return false;
    }
    net = std::move(quotient);
  }
  return true;
}

/// Of a derivative of a Bernstein sum, over the differences of its control points.
double derivative_factor(int degree, int order) {
  return order == 2 ? degree * (degree - 1) : order == 1 ? degree : 1;
}

/// Xab of a homogeneous patch, with derivatives `du` times along u and `dv` along v.
ScaledNet<dvec4> derivative(const BezierPatch& patch, const std::vector<dvec4>& x, int du, int dv) {
  const NetShape shape{patch.degree_u - du, patch.degree_v - dv};
  if (shape.p < 0 || shape.q < 0) return ScaledNet<dvec4>({0, 0});
  const double factor =
      derivative_factor(patch.degree_u, du) * derivative_factor(patch.degree_v, dv);
  const auto at = [&](int i, int j) { return x[patch.index(i, j)]; };
  const auto difference = [&](int i, int j) {
    if (du == 2) return at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j);
    if (dv == 2) return at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2);
    return at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j);
  };
  return scaled<dvec4>(shape, [&](int i, int j) { return factor * difference(i, j); });
}

/// w Xab - wab X; of patches whose weights are all one and the same, Xab / w, of a lower degree.
ScaledNet<dvec3> second_derivative(const BezierPatch& patch, const std::vector<dvec4>& x, int du,
                                   int dv) {
  const ScaledNet<dvec4> xab = derivative(patch, x, du, dv);
  const int p = patch.degree_u;
  const int q = patch.degree_v;
  if (is_polynomial(patch.points)) {
    ScaledNet<dvec3> result(xab.shape);
    std::transform(xab.entries.begin(), xab.entries.end(), result.entries.begin(),
                   [&](const dvec4& a) { return dvec3(a) / x.front().w; });
    return result;
  }
  ScaledNet<dvec3> result({p + xab.shape.p, q + xab.shape.q});
  const auto points = scaled<dvec4>({p, q}, [&](int i, int j) { return x[patch.index(i, j)]; });
  add_product(points, xab, 0, 0, result,
              [](const dvec4& a, const dvec4& b) { return a.w * dvec3(b) - b.w * dvec3(a); });
  return result;
}

/// What rounding does to entries of second_derivative(), however small these are beside the control
/// points x = p - w c: these are off by some units of their sizes and, where weights differ, of w
/// c, a second difference by four times that and the rounding of four more sums. Where weights
/// differ it is their combinations with weights and points that cancel.
double second_rounding(const BezierPatch& patch, const std::vector<dvec4>& x, const dvec3& center,
                       int du, int dv) {
  double size = 0, heaviest = 0;
  for (const dvec4& p : x) {
    size = std::max(size, glm::length(dvec3(p)));
    heaviest = std::max(heaviest, p.w);
  }
  const double factor =
      derivative_factor(patch.degree_u, du) * derivative_factor(patch.degree_v, dv);
  constexpr double of_differences = 4 * (4 + 4);
  if (is_polynomial(patch.points)) {
    return of_differences * rounding_unit * factor * size / heaviest;
  }
  const double moved = size + heaviest * glm::length(center);
  // Two products of up to four times the sizes, each a mean of so many terms.
  const double roundings = 2 * of_differences + 8 * (2 * patch.degree_u + 2 * patch.degree_v + 8);
  return roundings * rounding_unit * factor * heaviest * moved;
}

}  // namespace

CurvatureNets::CurvatureNets(const BezierPatch& patch, const std::array<bool, 4>& poles) {
  Box box;
  for (const dvec4& p : patch.points) box.include(euclidean(p));
  std::vector<dvec4> x = patch.points;
  const dvec3 center = box.center();
  for (dvec4& p : x) p -= dvec4(p.w * center, 0.0);
  const NormalNet net = normal_net(patch);
  const auto normals = scaled<dvec3>(
      net.shape, [&](int i, int j) { return net.vectors[std::size_t(i * (net.shape.q + 1) + j)]; });
  const double normal_size = largest(net.vectors);
  bool sound = true;
  const auto divided = [&](auto scaled_net, std::array<int, 2> powers, double size) {
    for (const Side side : all_sides) {
      if (!poles[std::size_t(side)]) continue;
      // By the number of derivatives along the pole.
      const int power = powers[along_v(side) ? 1 : 0];
      sound = divide(scaled_net, side, power, pole_rounding * size) && sound;
    }
    return scaled_net;
  };
  const auto form = [&](int du, int dv) {
    const ScaledNet<dvec3> second = second_derivative(patch, x, du, dv);
    ScaledNet<double> product({normals.shape.p + second.shape.p, normals.shape.q + second.shape.q});
    add_product(normals, second, 0, 0, product,
                [](const dvec3& a, const dvec3& b) { return glm::dot(a, b); });
    const double second_size = largest(unscaled(second));
    // N shrinks once towards a pole, derivatives along it once each, and twice along it once more.
    const ScaledNet<double> quotient =
        divided(product, {1 + du, 1 + dv}, normal_size * second_size);
    // Sums of products of entries, each of a sum of a few. A division by the distance from a side
    // makes the entry next to it as many times larger as the degree.
    const double roundings = 8.0 * (product.shape.p + product.shape.q + 8);
    const double growth = std::pow(product.shape.p + 1.0, product.shape.p - quotient.shape.p) *
                          std::pow(product.shape.q + 1.0, product.shape.q - quotient.shape.q);
    const double of_products =
        (net.rounding_bound + roundings * rounding_unit * normal_size) * second_size;
    const double of_second = normal_size * second_rounding(patch, x, center, du, dv);
    return Net<double>{quotient.shape, unscaled(quotient), (of_products + of_second) * growth,
                       normal_size * second_size * growth};
  };
  uu_ = form(2, 0);
  uv_ = form(1, 1);
  vv_ = form(0, 2);
  const NetShape common{std::max({uu_.shape.p, uv_.shape.p, vv_.shape.p}),
                        std::max({uu_.shape.q, uv_.shape.q, vv_.shape.q})};
  uu_ = uu_.raised(common);
  uv_ = uv_.raised(common);
  vv_ = vv_.raised(common);
  const ScaledNet<dvec3> quotient = divided(normals, {1, 1}, normal_size);
  normals_ = {quotient.shape, unscaled(quotient),
              net.rounding_bound * (net.shape.p + 1.0) * (net.shape.q + 1.0),
              largest(unscaled(quotient))};
  if (!sound) uu_.error = std::numeric_limits<double>::infinity();
}

template <class Entry>
CurvatureNets::Net<Entry> CurvatureNets::Net<Entry>::raised(NetShape to) const {
  const auto own = scaled<Entry>(
      shape, [&](int i, int j) { return entries[std::size_t(i * (shape.q + 1) + j)]; });
  const auto one = scaled<double>({to.p - shape.p, to.q - shape.q}, [](int, int) { return 1.0; });
  ScaledNet<Entry> product(to);
  add_product(own, one, 0, 0, product, [](const Entry& a, double b) { return b * a; });
  // Convex combinations, each of so many terms with factors of a few roundings.
  const double roundings = (one.shape.p + 1.0) * (one.shape.q + 1.0) + 8;
  return {to, unscaled(product), error + roundings * rounding_unit * size, size};
}

Interval CurvatureNets::range(const std::vector<double>& entries, double error) {
  const auto [least, most] = std::minmax_element(entries.begin(), entries.end());
  return {*least - error, *most + error};
}

Interval CurvatureNets::range(const Net<double>& net, const Interval& u, const Interval& v) {
  std::vector<double> entries = net.entries;
  restrict_net(net.shape, entries.data(), u, v);
  return range(entries, net.error);
}

SecondForm CurvatureNets::over(const Interval& u, const Interval& v) const {
  return {range(uu_, u, v), range(uv_, u, v), range(vv_, u, v)};
}

SecondForm CurvatureNets::over() const {
  return {range(uu_.entries, uu_.error), range(uv_.entries, uv_.error),
          range(vv_.entries, vv_.error)};
}

/// At a point the form is a convex combination of those of the nets' entries, and what is between
/// definite forms of one sign is definite. Where parameter lines are all but parallel these are all
/// but singular; that they are not is then told by the determinant's net, and the sign at a corner.
int CurvatureNets::definite_sign() const {
  const auto form = [&](std::size_t k) {
    return SecondForm{uu_.around(k), uv_.around(k), vv_.around(k)};
  };
  const auto all = [&](const auto& is_so) {
    for (std::size_t k = 0; k < uu_.entries.size(); ++k) {
      if (!is_so(form(k))) return false;
    }
    return true;
  };
  if (all([](const SecondForm& f) { return f.surely_negative(); })) return -1;
  if (all([](const SecondForm& f) { return f.surely_positive(); })) return 1;
  // The form there.
  const std::size_t last = uu_.entries.size() - 1;
  const auto row = std::size_t(uu_.shape.q);
  const std::array corners = {std::size_t{0}, row, last - row, last};
  const auto at_corners = [&](const auto& is_so) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::size_t k) { return is_so(form(k)); });
  };
  if (at_corners([](const SecondForm& f) { return f.surely_negative(); })) {
    return least_determinant() > 0 ? -1 : 0;
  }
  if (at_corners([](const SecondForm& f) { return f.surely_positive(); })) {
    return least_determinant() > 0 ? 1 : 0;
  }
  return 0;
}

/// Of uu vv - uv^2, over all of the square.
double CurvatureNets::least_determinant() const {
  if (least_determinant_) return *least_determinant_;
  const auto net = [&](const std::vector<double>& entries) {
    return scaled<double>(
        uu_.shape, [&](int i, int j) { return entries[std::size_t(i * (uu_.shape.q + 1) + j)]; });
  };
  ScaledNet<double> determinant({2 * uu_.shape.p, 2 * uu_.shape.q});
  const auto uv = net(uv_.entries);
  add_product(net(uu_.entries), net(vv_.entries), 0, 0, determinant, std::multiplies());
  add_product(uv, uv, 0, 0, determinant, [](double a, double b) { return -a * b; });
  // Convex combinations of products, at most as many as entries.
  const double uu = largest(uu_.entries) + uu_.error;
  const double vv = largest(vv_.entries) + vv_.error;
  const double mixed = largest(uv_.entries) + uv_.error;
  const double roundings = (uu_.shape.p + 1.0) * (uu_.shape.q + 1.0) + 16;
  const double error = uu * vv_.error + vv * uu_.error + 2 * mixed * uv_.error +
                       roundings * rounding_unit * (uu * vv + mixed * mixed);
  least_determinant_ = range(unscaled(determinant), error).lower;
  return *least_determinant_;
}

/// By the least eigenvalue of an entry, which its errors change by no more than their sum. Or, of
/// forms of which this tells little as they are singular along lines, by the determinant: where it
/// is negative the one eigenvalue is its quotient by the other, which is more than the trace.
double CurvatureNets::shortfall_bound(int sign) const {
  double shortfall = 0;
  double trace = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < uu_.entries.size(); ++k) {
    const double a = sign * uu_.entries[k];
    const double c = sign * vv_.entries[k];
    const double least = 0.5 * (a + c) - std::hypot(0.5 * (a - c), uv_.entries[k]);
    shortfall = std::max(shortfall, uu_.error + uv_.error + vv_.error - least);
    trace = std::min(trace, a + c - uu_.error - vv_.error);
  }
  if (shortfall == 0 || !(trace > 0)) return shortfall;
  return std::min(shortfall, std::max(0.0, -least_determinant()) / trace);
}

CurvatureNets::NormalBounds CurvatureNets::normal_bounds() const {
  NormalBounds result;
  dvec3 sum(0.0);
  for (const dvec3& n : normals_.entries) sum += n;
  result.axis = unit(sum);
  result.least = std::numeric_limits<double>::infinity();
  for (const dvec3& n : normals_.entries) {
    const double along = glm::dot(n, result.axis) - normals_.error;
    const double across = glm::length(glm::cross(n, result.axis)) + normals_.error;
    result.least = std::min(result.least, along);
    result.angle = std::max(result.angle, std::atan2(across, along));
  }
  return result;
}

/// Convex combinations, one after the other along a line of the net, each of one rounding.
template <class Entry>
CurvatureNets::Net<Entry> CurvatureNets::Net<Entry>::upper_half(Direction direction,
                                                                Net<Entry>& lower) const {
  Net<Entry> upper = *this;
  const bool of_u = direction == Direction::u;
  upper.error += (of_u ? shape.p : shape.q) * rounding_unit * size;
  lower = upper;
  if (of_u) {
    halve_u(shape, upper.entries.data(), lower.entries.data());
  } else {
    halve_v(shape, upper.entries.data(), lower.entries.data());
  }
  return upper;
}

std::array<CurvatureNets, 2> CurvatureNets::halves(Direction direction) const {
  std::array<CurvatureNets, 2> result = {CurvatureNets(), CurvatureNets()};
  auto& [lower, upper] = result;
  upper.normals_ = normals_.upper_half(direction, lower.normals_);
  upper.uu_ = uu_.upper_half(direction, lower.uu_);
  upper.uv_ = uv_.upper_half(direction, lower.uv_);
  upper.vv_ = vv_.upper_half(direction, lower.vv_);
  return result;
}

std::optional<NormalPyramid> CurvatureNets::normals() const {
  return normal_pyramid(normals_.entries, normals_.error);
}

std::optional<NormalPyramid> CurvatureNets::normals(const Interval& u, const Interval& v) const {
  std::vector<dvec3> vectors = normals_.entries;
  restrict_net(normals_.shape, vectors.data(), u, v);
  return normal_pyramid(vectors, normals_.error);
}

}  // namespace taut
