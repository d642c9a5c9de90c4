#include "taut/surface/coordinate_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "taut/core/integers.h"

namespace taut {
namespace {

using Float32 = std::numeric_limits<float>;
static_assert(Float32::is_iec559);

/// Numbers of fewer decimals are meant: millimetres, or metres, in a designer's units.
constexpr int fewest_decimals = 6;
/// And so are those of fewer than four digits.
constexpr double fewest_digits = 999.5;
/// Of every 256 numbers that were rounded to float32 one does not use the last 8 bits, of every 100
/// that were rounded to decimals one does not use the last two.
constexpr std::uint32_t last_bits = 0xff;
constexpr int last_decimals = 2;

/// Decimal numbers of up to 15 digits are told apart by doubles, and found again from their
/// products with a weight: four roundings make 0.45 of the last digit.
constexpr double most_digits = 1e15;

constexpr auto powers_of_ten = [] {
  std::array<double, StoredCoordinates::most_decimals + 1> powers = {1};
  for (std::size_t k = 1; k < powers.size(); ++k) powers[k] = 10 * powers[k - 1];
  return powers;
}();

/// A number of k decimals, as a reader would round it: that nearest to x, or infinity where it has
/// too many digits.
double with_decimals(double x, double power) {
  const double digits = std::nearbyint(x * power);
  return std::abs(digits) < most_digits ? digits / power : infinity;
}

}  // namespace

void StoredCoordinates::add(std::span<const dvec3> points) {
  for (const dvec3& p : points) {
    for (int i = 0; i < 3; ++i) add(p[i], 1);
  }
}

void StoredCoordinates::add(std::span<const dvec4> points) {
  for (const dvec4& p : points) {
    for (int i = 0; i < 3; ++i) add(p[i], p.w);
  }
}

/// A number lies on a grid if the nearest one on it gives the same product.
void StoredCoordinates::add(double product, double weight) {
  if (!all_float32_ && !all_decimal_) return;
  ++count_;
  largest_ = std::max(largest_, std::abs(product / weight));
  if (all_float32_) add_float32(product, weight);
  if (all_decimal_) add_decimal(product, weight);
}

void StoredCoordinates::add_float32(double product, double weight) {
  const double x = product / weight;
  const float nearest = std::abs(x) <= double(Float32::max()) ? float(x) : float(infinity);
  all_float32_ = double(nearest) * weight == product;
  constexpr float all_whole = 0x1p24F;
  const bool needs_none = std::abs(nearest) <= all_whole && std::trunc(nearest) == nearest;
  if (!needs_none && (std::bit_cast<std::uint32_t>(nearest) & last_bits) != 0) ++using_last_bits_;
}

/// The search begins where it ended for those before, which most often have as many.
void StoredCoordinates::add_decimal(double product, double weight) {
  const double x = product / weight;
  const auto number = [&](int k) { return with_decimals(x, powers_of_ten[to_size(k)]); };
  const auto needs_no_more = [&](int k) { return number(k) * weight == product; };
  int k = decimals_;
  if (needs_no_more(k)) {
    while (k > 0 && needs_no_more(k - 1)) --k;
  } else {
    while (k <= most_decimals && !needs_no_more(k)) ++k;
  }
  all_decimal_ = k <= most_decimals;
  if (!all_decimal_) return;
  decimals_ = std::max(decimals_, k);
  const double in_binary = number(k) * double(1 << k);
  const bool needs_none = std::abs(x) * powers_of_ten[to_size(k)] < fewest_digits ||
                          std::nearbyint(in_binary) == in_binary;
  if (!needs_none) ++needing_decimals_[to_size(k)];
}

CoordinateGrid StoredCoordinates::grid() const {
  if (count_ == 0) return {};
  if (all_float32_ && 2 * using_last_bits_ >= count_) {
    const int exponent = std::max(std::ilogb(float(largest_)) + 1, Float32::min_exponent);
    return {CoordinateGrid::Kind::float32, 0, std::ldexp(1.0, exponent - Float32::digits)};
  }
  if (all_decimal_ && decimals_ >= fewest_decimals) {
    long using_last = 0;
    for (int k = decimals_; k > decimals_ - last_decimals; --k) {
      using_last += needing_decimals_[to_size(k)];
    }
    if (2 * using_last >= count_) {
      return {CoordinateGrid::Kind::decimals, decimals_, 1 / powers_of_ten[to_size(decimals_)]};
    }
  }
  return {};
}

}  // namespace taut
