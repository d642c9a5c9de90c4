#include "taut/core/predicates.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "taut/core/tolerances.h"

// Three stages, each tried only where the one before could not decide:
//
//   floating_point  the determinant in double; its sign is certain beyond a bound of its error
//   double_double   the same in twice the precision
//   integer         the determinant itself, in integers of any length
//
// Points that were meant to be coplanar and then rounded are settled by double_double; what
// reaches the integers is coplanar but for adversaries. Shewchuk's expansions (1997) have no place
// between the two: for coordinates of like size they took as long as the integers, for others
// twice as long, and they under- and overflow.
//
// Below, u is the rounding unit 2^-53. A sum or difference rounds by a factor 1 + u at most and
// never underflows inexactly: it is a multiple of 2^-1074. A product rounds by a factor 1 + u at
// most, or underflows by e = 2^-1075 at most. If anything overflows, the bound or the value is
// infinite or NaN; each test is written so that it is then false, and the next stage decides.

namespace taut {
namespace {

struct Decision {
  Sign sign;
  PredicateStage stage;
};

Sign sign_of(double x) { return x > 0 ? Sign::positive : x < 0 ? Sign::negative : Sign::zero; }

// ---- floating_point ----

/// The smallest normal number, 2^-1022: its product with u is e, so that what underflow can lose is
/// covered by adding it to a sum that is then multiplied by some u.
constexpr double tau = std::numeric_limits<double>::min();

/// Error of Minor::value, relative to Minor::magnitude.
///
/// Each of the two products carries four factors 1 + u: two differences, the product, the
/// subtraction. Hence 4u; a fifth u exceeds all terms in u^2, those of the magnitude included. By
/// underflow the two products and the bound lose 3e at most, and 5 u tau = 5e.
constexpr double planar_bound = 5 * rounding_unit;

/// Error of Cross::dot, relative to Cross::magnitude.
///
/// Each of the six products carries eight factors 1 + u: three differences, two products, the
/// subtraction in the minor, the two sums of the minors. Hence 8u; a ninth u exceeds all terms in
/// u^2. By underflow a minor loses 2e, hence the dot product 2e |d|, and 9 u tau |d| = 9e |d|; the
/// three products with d and the bound lose 4e, and 9 u tau = 9e.
constexpr double spatial_bound = 9 * rounding_unit;

/// The 2x2 determinant ad - bc, and the size of its products.
struct Minor {
  Minor(double a, double b, double c, double d) {
    const double ad = a * d;
    const double bc = b * c;
    value = ad - bc;
    magnitude = (std::abs(ad) + std::abs(bc)) + tau;
  }
  double value;
  double magnitude;
};

/// The cross product v x w.
struct Cross {
  Cross(const dvec3& v, const dvec3& w)
      : x(v.y, v.z, w.y, w.z), y(v.z, v.x, w.z, w.x), z(v.x, v.y, w.x, w.y) {}

  double dot(const dvec3& d) const { return (x.value * d.x + y.value * d.y) + z.value * d.z; }
  /// The size of the six products of dot(d), or of any smaller d.
  double magnitude(const dvec3& d) const {
    return ((x.magnitude * std::abs(d.x) + y.magnitude * std::abs(d.y)) +
            z.magnitude * std::abs(d.z)) +
           tau;
  }

  Minor x, y, z;
};

// ---- double_double ----

/// The sum head + tail, with |tail| <= u |head|.
struct DoubleDouble {
  double head;
  double tail;
};

/// a + b without error (Knuth 1969; Shewchuk 1997, theorem 7).
DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

/// a * b without error, but for underflow. Where the processor has no fused multiply-add the
/// library's is as correct; where it has, a call is still faster than Dekker's product.
DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

DoubleDouble operator-(const DoubleDouble& x) { return {-x.head, -x.tail}; }

/// Error at most 3 u^2 (|x| + |y|) and higher orders: the tails are at most u each, so that their
/// sum rounds by u^2, and its sum with the tail of the heads by 2 u^2.
DoubleDouble operator+(const DoubleDouble& x, const DoubleDouble& y) {
  const DoubleDouble heads = two_sum(x.head, y.head);
  return two_sum(heads.head, heads.tail + (x.tail + y.tail));
}

/// Error at most 8 u^2 |x y| and higher orders: the product of the tails, left out, 1; the mixed
/// products 1 each, their sum 2; its sum with the tail of the heads' product 3.
DoubleDouble operator*(const DoubleDouble& x, const DoubleDouble& y) {
  const DoubleDouble heads = two_product(x.head, y.head);
  return two_sum(heads.head, heads.tail + (x.head * y.tail + x.tail * y.head));
}

/// Error of determinant(v, w) relative to Minor::magnitude: 8 + 3 of the above, and room for the
/// higher orders and for the head that stands for the sum.
constexpr double planar_bound_2 = 16 * rounding_unit * rounding_unit;

/// Error of determinant(v, w, d) relative to Cross::magnitude: 8 + 3 in the minors, 8 in their
/// products with d, 3 + 3 in the sums, and room as above.
constexpr double spatial_bound_2 = 32 * rounding_unit * rounding_unit;

/// No product underflows if the heads and tails of the differences are zero or at least this.
///
/// A double of size 2^k or more is a multiple of 2^(k-52), and the product of three such of
/// 2^(3k-156); rounding keeps that. With k = -306 this is 2^-1074, and every multiple of 2^-1074
/// that is too small for a normal number is a subnormal one.
constexpr double smallest_component = 0x1p-306;

template <std::size_t n>
bool safe_from_underflow(const std::array<DoubleDouble, n>& x) {
  const auto safe = [](double c) { return c == 0 || std::abs(c) >= smallest_component; };
  return std::all_of(x.begin(), x.end(),
                     [&](const DoubleDouble& c) { return safe(c.head) && safe(c.tail); });
}

using Difference2 = std::array<DoubleDouble, 2>;
using Difference3 = std::array<DoubleDouble, 3>;

Difference2 difference(const dvec2& p, const dvec2& q) {
  return {two_sum(p.x, -q.x), two_sum(p.y, -q.y)};
}

Difference3 difference(const dvec3& p, const dvec3& q) {
  return {two_sum(p.x, -q.x), two_sum(p.y, -q.y), two_sum(p.z, -q.z)};
}

double determinant(const Difference2& v, const Difference2& w) {
  return (v[0] * w[1] + -(v[1] * w[0])).head;
}

double determinant(const Difference3& v, const Difference3& w, const Difference3& d) {
  const auto minor = [&](std::size_t i, std::size_t j) { return v[i] * w[j] + -(v[j] * w[i]); };
  return ((minor(1, 2) * d[0] + minor(2, 0) * d[1]) + minor(0, 1) * d[2]).head;
}

// ---- integer ----

using boost::multiprecision::cpp_int;

/// x[i] - x[0] for i > 0, in a unit that is a power of two. Each axis may have its own, since a
/// positive factor changes the sign of no determinant; so a flat model in large coordinates costs
/// no more than another.
template <std::size_t n>
std::array<cpp_int, n - 1> differences(const std::array<double, n>& x) {
  std::array<std::int64_t, n> mantissa;
  std::array<int, n> exponent;
  int unit = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < n; ++i) {
    mantissa[i] = static_cast<std::int64_t>(std::ldexp(std::frexp(x[i], &exponent[i]), 53));
    if (mantissa[i] != 0) unit = std::min(unit, exponent[i]);
  }
  const auto integer = [&](std::size_t i) {
    cpp_int result = mantissa[i];
    if (mantissa[i] != 0) result <<= exponent[i] - unit;
    return result;
  };
  const cpp_int origin = integer(0);
  std::array<cpp_int, n - 1> result;
  for (std::size_t i = 1; i < n; ++i) result[i - 1] = integer(i) - origin;
  return result;
}

Sign integer_sign(const dvec2& a, const dvec2& b, const dvec2& c) {
  const auto x = differences<3>({a.x, b.x, c.x});
  const auto y = differences<3>({a.y, b.y, c.y});
  const cpp_int determinant = x[0] * y[1] - y[0] * x[1];
  return static_cast<Sign>(determinant.sign());
}

Sign integer_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  const auto x = differences<4>({a.x, b.x, c.x, d.x});
  const auto y = differences<4>({a.y, b.y, c.y, d.y});
  const auto z = differences<4>({a.z, b.z, c.z, d.z});
  const cpp_int determinant = (y[0] * z[1] - z[0] * y[1]) * x[2] +
                              (z[0] * x[1] - x[0] * z[1]) * y[2] +
                              (x[0] * y[1] - y[0] * x[1]) * z[2];
  return static_cast<Sign>(determinant.sign());
}

// ---- All stages ----

/// The coplanar points that models are full of: two coincide, or all lie in a coordinate plane.
bool plainly_coplanar(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  const auto all_equal = [&](int i) { return a[i] == b[i] && a[i] == c[i] && a[i] == d[i]; };
  return d == a || d == b || d == c || a == b || a == c || b == c || all_equal(0) || all_equal(1) ||
         all_equal(2);
}

/// What floating_point left open; the magnitude is its Minor's.
Decision decide_rest(const dvec2& a, const dvec2& b, const dvec2& c, double magnitude) {
  const Difference2 ab = difference(b, a);
  const Difference2 ac = difference(c, a);
  if (safe_from_underflow(ab) && safe_from_underflow(ac)) {
    const double value = determinant(ab, ac);
    if (std::abs(value) > planar_bound_2 * magnitude) {
      return {sign_of(value), PredicateStage::double_double};
    }
  }
  return {integer_sign(a, b, c), PredicateStage::integer};
}

/// What floating_point left open; the magnitude is its Cross's.
Decision decide_rest(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d,
                     double magnitude) {
  if (plainly_coplanar(a, b, c, d)) return {Sign::zero, PredicateStage::floating_point};
  const Difference3 ab = difference(b, a);
  const Difference3 ac = difference(c, a);
  const Difference3 ad = difference(d, a);
  if (safe_from_underflow(ab) && safe_from_underflow(ac) && safe_from_underflow(ad)) {
    const double value = determinant(ab, ac, ad);
    if (std::abs(value) > spatial_bound_2 * magnitude) {
      return {sign_of(value), PredicateStage::double_double};
    }
  }
  return {integer_sign(a, b, c, d), PredicateStage::integer};
}

inline Decision decide(const dvec2& a, const dvec2& b, const dvec2& c) {
  const dvec2 ab = b - a;
  const dvec2 ac = c - a;
  const Minor minor(ab.x, ab.y, ac.x, ac.y);
  if (std::abs(minor.value) > planar_bound * minor.magnitude) {
    return {sign_of(minor.value), PredicateStage::floating_point};
  }
  return decide_rest(a, b, c, minor.magnitude);
}

inline Decision decide(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  const Cross normal(b - a, c - a);
  const dvec3 ad = d - a;
  const double value = normal.dot(ad);
  const double magnitude = normal.magnitude(ad);
  if (std::abs(value) > spatial_bound * magnitude) {
    return {sign_of(value), PredicateStage::floating_point};
  }
  return decide_rest(a, b, c, d, magnitude);
}

}  // namespace

Sign orientation(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  return decide(a, b, c, d).sign;
}

Sign orientation(const dvec2& a, const dvec2& b, const dvec2& c) { return decide(a, b, c).sign; }

bool collinear(const dvec3& a, const dvec3& b, const dvec3& c) {
  // Each coordinate of (b-a) x (c-a) is the determinant of a projection.
  const auto vanishes = [&](int i, int j) {
    return orientation(dvec2(a[i], a[j]), dvec2(b[i], b[j]), dvec2(c[i], c[j])) == Sign::zero;
  };
  return vanishes(1, 2) && vanishes(2, 0) && vanishes(0, 1);
}

PlaneSide::PlaneSide(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& extent)
    : a_(a), extent_(extent), b_(b), c_(c) {
  const Cross normal(b - a, c - a);
  normal_ = {normal.x.value, normal.y.value, normal.z.value};
  bound_ = spatial_bound * normal.magnitude(extent);
  // Infinity times an extent of zero.
  if (std::isnan(bound_)) bound_ = std::numeric_limits<double>::infinity();
}

PredicateStage orientation_stage(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  return decide(a, b, c, d).stage;
}

PredicateStage orientation_stage(const dvec2& a, const dvec2& b, const dvec2& c) {
  return decide(a, b, c).stage;
}

}  // namespace taut
