#include "taut/subdivision/smooth_caps.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "taut/subdivision/reparametrize.h"
#include "taut/subdivision/triangle_points.h"

namespace taut {
namespace {

using Points = std::vector<dvec3>;

double binomial(std::size_t n, std::size_t k) {
  double result = 1;
  for (std::size_t i = 1; i <= k; ++i) result = result * double(n - k + i) / double(i);
  return result;
}

Points derivative(const Points& c) {
  Points d(c.size() - 1);
  for (std::size_t k = 0; k < d.size(); ++k) d[k] = double(d.size()) * (c[k + 1] - c[k]);
  return d;
}

Points product(std::span<const double> a, const Points& b) {
  const std::size_t m = a.size() - 1;
  const std::size_t n = b.size() - 1;
  Points c(m + n + 1, dvec3(0.0));
  for (std::size_t i = 0; i <= m; ++i) {
    for (std::size_t j = 0; j <= n; ++j) {
      c[i + j] += binomial(m, i) * binomial(n, j) / binomial(m + n, i + j) * a[i] * b[j];
    }
  }
  return c;
}

/// Value and first derivative at both ends: a cubic.
Points hermite(const dvec3& x0, const dvec3& dx0, const dvec3& x1, const dvec3& dx1) {
  return {x0, x0 + dx0 / 3.0, x1 - dx1 / 3.0, x1};
}

/// The parts of vectors around a vertex, of equal angles, that turn as often as one of `turns`.
void keep_turns(Points& x, std::span<const int> turns) {
  const std::size_t n = x.size();
  const double angle = 2 * std::numbers::pi / double(n);
  Points kept(n, dvec3(0.0));
  for (const int turn : turns) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        const double share = (turn == 0 ? 1.0 : 2.0) / double(n);
        // Of n / 2 turns only the cosine is told.
        const double factor = std::size_t(2 * turn) == n ? 0.5 * share : share;
        const auto steps = double((j + n - k) % n);
        kept[j] += factor * std::cos(double(turn) * angle * steps) * x[k];
      }
    }
  }
  x = std::move(kept);
}

/// Mixed derivatives of the cells at the vertex, those of neighbours adding up to `sums` on the
/// spoke between them, but not on the first one if that is sharp; as near as may be to the given
/// ones.
Points twists(const Points& given, const Points& sums, bool sharp) {
  const auto n = Eigen::Index(given.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd off(n, 3);
  off.row(0).setZero();
  for (Eigen::Index j = sharp ? 1 : 0; j < n; ++j) {
    const Eigen::Index before = (j + n - 1) % n;
    a(j, j) = a(j, before) = 1;
    const dvec3 d = sums[std::size_t(j)] - given[std::size_t(j)] - given[std::size_t(before)];
    for (int k = 0; k < 3; ++k) off(j, k) = d[k];
  }
  const Eigen::MatrixXd change = a.completeOrthogonalDecomposition().solve(off);
  Points result = given;
  for (Eigen::Index j = 0; j < n; ++j) {
    result[std::size_t(j)] += dvec3(change(j, 0), change(j, 1), change(j, 2));
  }
  return result;
}

/// What is known of a cell's cap at its first spoke c: at the vertex (t = 0) and at the other end.
struct SpokeEnds {
  dvec3 vertex, end;        ///< c
  dvec3 leaving, arriving;  ///< c'
  dvec3 bend;               ///< c'' at the vertex, of the given caps
  dvec3 across;             ///< r at the end
  dvec3 turn;               ///< r' at the end
  dvec3 twist;              ///< r' at the vertex, of the given caps
};

/// The spokes and the derivatives across them.
class Fan {
 public:
  /// `end_bend`: c'' at the other ends, where that is given too; `w` is the w above. `beyond`: of
  /// the first spoke, if it is sharp, with the derivatives into the last cell.
  Fan(std::vector<SpokeEnds> ends, const Points& end_bends, std::vector<double> w,
      const std::optional<SpokeEnds>& beyond)
      : ends_(std::move(ends)), w_(std::move(w)) {
    const std::size_t n = ends_.size();
    Points leaving(n), bends(n);
    for (std::size_t j = 0; j < n; ++j) {
      leaving[j] = ends_[j].leaving;
      bends[j] = ends_[j].bend;
    }
    constexpr std::array<int, 1> once = {1};
    keep_turns(leaving, once);
    constexpr std::array<int, 3> up_to_twice = {0, 1, 2};
    if (n > 5) keep_turns(bends, up_to_twice);
    for (std::size_t j = 0; j < n; ++j) {
      const SpokeEnds& e = ends_[j];
      const bool with_bend = !end_bends.empty();
      const double degree = with_bend ? 5 : 4;
      Points c(with_bend ? 6 : 5);
      c[0] = e.vertex;
      c[1] = c[0] + leaving[j] / degree;
      c[2] = bends[j] / (degree * (degree - 1)) + 2.0 * c[1] - c[0];
      const std::size_t last = c.size() - 1;
      c[last] = e.end;
      c[last - 1] = c[last] - e.arriving / degree;
      if (with_bend) c[last - 2] = end_bends[j] / 20.0 + 2.0 * c[last - 1] - c[last];
      curves_.push_back(std::move(c));
    }
    Points given(n), sums(n);
    std::vector<Points> turned(n);  // w c'
    for (std::size_t j = 0; j < n; ++j) {
      turned[j] = product(w_, derivative(curves_[j]));
      sums[j] = derivative(turned[j]).front();
      given[j] = ends_[j].twist;
    }
    const Points twist = twists(given, sums, beyond.has_value());
    for (std::size_t j = 0; j < n; ++j) {
      const SpokeEnds& e = ends_[j];
      const Points slope = derivative(turned[j]);
      const dvec3 start = 0.5 * (leaving[(j + 1) % n] - leaving[(j + n - 1) % n]);
      Points half = hermite(start, twist[j] - 0.5 * slope.front(),
                            e.across - 0.5 * turned[j].back(), e.turn - 0.5 * slope.back());
      half = elevated_curve(std::move(half), turned[j].size() - 1);
      Points right(half.size()), left(half.size());
      for (std::size_t k = 0; k < half.size(); ++k) {
        right[k] = 0.5 * turned[j][k] + half[k];
        left[k] = 0.5 * turned[j][k] - half[k];
      }
      right_.push_back(std::move(right));
      left_.push_back(std::move(left));
    }
    if (!beyond) return;
    const auto across = [&](const dvec3& start, const dvec3& twisted, const SpokeEnds& e) {
      return elevated_curve(hermite(start, twisted, e.across, e.turn), turned[0].size() - 1);
    };
    right_[0] = across(leaving[1], twist[0], ends_[0]);
    left_[0] = across(leaving[n - 1], twist[n - 1], *beyond);
  }

  /// Spoke j, the first one of cell j, and the derivatives from it into cell j and into the one
  /// before.
  const Points& curve(std::size_t j) const { return curves_[j]; }
  const Points& right(std::size_t j) const { return right_[j]; }
  const Points& left(std::size_t j) const { return left_[j]; }

 private:
  std::vector<SpokeEnds> ends_;
  std::vector<double> w_;
  std::vector<Points> curves_, right_, left_;
};

/// The corner of a net as it is at a dart: the vertex where it belongs, the first derivatives in
/// its tangent plane, the mixed one as it was.
template <class AnyNet>
void move_to(AnyNet& net, const VertexLimit& dart) {
  const dvec3 vertex = net.at(0, 0);
  const auto moved = [&](const dvec3& x) {
    const dvec3 d = x - vertex;
    return dart.x + d - glm::dot(d, dart.normal) * dart.normal;
  };
  const dvec3 first = moved(net.at(1, 0)) - net.at(1, 0);
  const dvec3 second = moved(net.at(0, 1)) - net.at(0, 1);
  net.at(1, 1) += first + second - (dart.x - vertex);
  net.at(1, 0) += first;
  net.at(0, 1) += second;
  net.at(0, 0) = dart.x;
}

/// A square net of points along v within along u.
class PointNet {
 public:
  explicit PointNet(std::size_t degree) : degree_(degree), points_((degree + 1) * (degree + 1)) {}
  PointNet(std::size_t degree, Points points) : degree_(degree), points_(std::move(points)) {}
  dvec3& at(std::size_t i, std::size_t j) { return points_[i * (degree_ + 1) + j]; }
  const dvec3& at(std::size_t i, std::size_t j) const { return points_[i * (degree_ + 1) + j]; }
  Points take() { return std::move(points_); }

  PointNet mirrored() const {
    PointNet result(degree_);
    for (std::size_t i = 0; i <= degree_; ++i) {
      for (std::size_t j = 0; j <= degree_; ++j) result.at(i, j) = at(j, i);
    }
    return result;
  }

 private:
  std::size_t degree_;
  Points points_;
};

constexpr std::size_t quad_degree = 5;

PointNet raised(const PointNet& cubic) {
  PointNet result(quad_degree);
  std::array<Points, 4> rows;
  for (std::size_t i = 0; i < 4; ++i) {
    rows[i] = elevated_curve({cubic.at(i, 0), cubic.at(i, 1), cubic.at(i, 2), cubic.at(i, 3)},
                             quad_degree);
  }
  for (std::size_t j = 0; j <= quad_degree; ++j) {
    const Points column =
        elevated_curve({rows[0][j], rows[1][j], rows[2][j], rows[3][j]}, quad_degree);
    for (std::size_t i = 0; i <= quad_degree; ++i) result.at(i, j) = column[i];
  }
  return result;
}

/// Of the cell's first spoke, v = 0.
SpokeEnds spoke_ends(const PointNet& p) {
  SpokeEnds e;
  e.vertex = p.at(0, 0);
  e.end = p.at(3, 0);
  e.leaving = 3.0 * (p.at(1, 0) - p.at(0, 0));
  e.arriving = 3.0 * (p.at(3, 0) - p.at(2, 0));
  e.bend = 6.0 * (p.at(2, 0) - 2.0 * p.at(1, 0) + p.at(0, 0));
  e.across = 3.0 * (p.at(3, 1) - p.at(3, 0));
  e.turn = 9.0 * (p.at(3, 1) - p.at(3, 0) - p.at(2, 1) + p.at(2, 0));
  e.twist = 9.0 * (p.at(1, 1) - p.at(1, 0) - p.at(0, 1) + p.at(0, 0));
  return e;
}

/// The rows next to the spokes are set; the points inside follow them.
void move_inside(PointNet& net, const PointNet& given) {
  const auto change = [&](std::size_t i, std::size_t j) { return net.at(i, j) - given.at(i, j); };
  for (std::size_t i = 2; i <= 3; ++i) {
    for (std::size_t j = 2; j <= 3; ++j) {
      const double s = double(i - 1) / 3;
      const double t = double(j - 1) / 3;
      const dvec3 across_u = (1 - s) * change(1, j) + s * change(4, j);
      const dvec3 across_v = (1 - t) * change(i, 1) + t * change(i, 4);
      const dvec3 corners = (1 - s) * ((1 - t) * change(1, 1) + t * change(1, 4)) +
                            s * ((1 - t) * change(4, 1) + t * change(4, 4));
      net.at(i, j) = given.at(i, j) + across_u + across_v - corners;
    }
  }
}

constexpr std::size_t triangle_degree = 6;

/// A triangle's points by their counts towards the second and the third corner.
class Triangle {
 public:
  explicit Triangle(std::size_t degree)
      : degree_(degree), points_((degree + 1) * (degree + 2) / 2, dvec3(0.0)) {}
  Triangle(std::size_t degree, Points points) : degree_(degree), points_(std::move(points)) {}
  dvec3& at(std::size_t i, std::size_t j) { return points_[triangle_point(degree_, i, j)]; }
  const dvec3& at(std::size_t i, std::size_t j) const {
    return points_[triangle_point(degree_, i, j)];
  }
  Points take() { return std::move(points_); }

  Triangle mirrored() const {
    Triangle result(degree_);
    for (std::size_t j = 0; j <= degree_; ++j) {
      for (std::size_t i = 0; i + j <= degree_; ++i) result.at(i, j) = at(j, i);
    }
    return result;
  }

  Triangle raised() const {
    Triangle up(degree_ + 1);
    const auto n = double(degree_ + 1);
    for (std::size_t j = 0; j <= degree_ + 1; ++j) {
      for (std::size_t i = 0; i + j <= degree_ + 1; ++i) {
        dvec3& x = up.at(i, j);
        const std::size_t k = degree_ + 1 - i - j;
        if (i > 0) x += double(i) / n * at(i - 1, j);
        if (j > 0) x += double(j) / n * at(i, j - 1);
        if (k > 0) x += double(k) / n * at(i, j);
      }
    }
    return up;
  }

 private:
  std::size_t degree_;
  Points points_;
};

/// The triangle's point (2, 0) with which its first spoke has this second derivative at the end.
dvec3 bent(const Triangle& p, const dvec3& end_bend) {
  return end_bend / 12.0 - p.at(4, 0) + 2.0 * p.at(3, 0);
}

/// Of the cell's first spoke, from its first corner to its second.
SpokeEnds spoke_ends(const Triangle& p, const dvec3& end_bend) {
  SpokeEnds e;
  e.vertex = p.at(0, 0);
  e.end = p.at(4, 0);
  e.leaving = 4.0 * (p.at(1, 0) - p.at(0, 0));
  e.arriving = 4.0 * (p.at(4, 0) - p.at(3, 0));
  e.bend = 12.0 * (p.at(2, 0) - 2.0 * p.at(1, 0) + p.at(0, 0));
  e.across = 4.0 * (p.at(3, 1) - p.at(3, 0));
  e.turn = 12.0 * (p.at(3, 1) - p.at(2, 1) - p.at(3, 0) + bent(p, end_bend));
  e.twist = 12.0 * (p.at(1, 1) - p.at(1, 0) - p.at(0, 1) + p.at(0, 0));
  return e;
}

/// c'' at the end of the triangle's first spoke.
dvec3 own_end_bend(const Triangle& p) {
  return 12.0 * (p.at(4, 0) - 2.0 * p.at(3, 0) + p.at(2, 0));
}

/// c'' at the end of the spoke between two cells with which their mixed derivatives there, as the
/// outer sides tell them, add up to (w c')' (w(1) = 1, w' = `slope`).
dvec3 end_bend(const Triangle& right, const Triangle& left, double slope) {
  const dvec3& end = right.at(4, 0);
  const dvec3& before = right.at(3, 0);
  const dvec3 arriving = 4.0 * (end - before);
  const dvec3 point = slope / 12 * arriving + end - (right.at(3, 1) + left.at(1, 3)) +
                      right.at(2, 1) + left.at(1, 2);
  return 12.0 * (end - 2.0 * before + point);
}

}  // namespace

std::vector<Points> smooth_quad_caps(std::span<const Points> nets,
                                     const std::optional<VertexLimit>& dart) {
  const std::size_t n = nets.size();
  const double turn = 2 * std::cos(2 * std::numbers::pi / double(n));
  std::vector<SpokeEnds> ends;
  std::vector<PointNet> given;
  ends.reserve(n);
  given.reserve(n);
  for (const Points& points : nets) given.emplace_back(std::size_t{3}, points);
  std::optional<SpokeEnds> beyond;
  if (dart) {
    for (PointNet& net : given) move_to(net, *dart);
    beyond = spoke_ends(given.back().mirrored());
  }
  for (const PointNet& net : given) ends.push_back(spoke_ends(net));
  const Fan fan(std::move(ends), {}, {turn, 0, 0}, beyond);
  std::vector<Points> result;
  for (std::size_t j = 0; j < n; ++j) {
    const PointNet old = raised(given[j]);
    PointNet net = old;
    const std::size_t next = (j + 1) % n;
    const Points first = elevated_curve(fan.curve(j), quad_degree);
    const Points second = elevated_curve(fan.curve(next), quad_degree);
    for (std::size_t k = 0; k <= quad_degree - 2; ++k) {
      net.at(k, 0) = first[k];
      net.at(0, k) = second[k];
    }
    for (std::size_t k = 1; k <= quad_degree - 2; ++k) {
      net.at(k, 1) = first[k] + fan.right(j)[k] / double(quad_degree);
      net.at(1, k) = second[k] + fan.left(next)[k] / double(quad_degree);
    }
    move_inside(net, old);
    result.push_back(net.take());
  }
  return result;
}

std::vector<Points> smooth_triangle_caps(std::span<const Points> nets,
                                         const std::optional<VertexLimit>& dart) {
  const std::size_t n = nets.size();
  const double turn = 2 * std::cos(2 * std::numbers::pi / double(n));
  std::vector<Triangle> given;
  for (const Points& points : nets) given.emplace_back(std::size_t{4}, points);
  std::vector<SpokeEnds> ends;
  Points end_bends;
  for (std::size_t j = 0; j < n; ++j) {
    const bool sharp = dart && j == 0;
    end_bends.push_back(sharp ? own_end_bend(given[j])
                              : end_bend(given[j], given[(j + n - 1) % n], 1 - turn));
  }
  std::optional<SpokeEnds> beyond;
  if (dart) {
    for (std::size_t j = 0; j < n; ++j) {
      move_to(given[j], *dart);
      if (j > 0) given[j].at(2, 0) = given[j - 1].at(0, 2) = bent(given[j], end_bends[j]);
    }
    beyond = spoke_ends(given.back().mirrored(), end_bends[0]);
  }
  for (std::size_t j = 0; j < n; ++j) ends.push_back(spoke_ends(given[j], end_bends[j]));
  const Fan fan(std::move(ends), end_bends, {turn, 1}, beyond);
  std::vector<Points> result;
  for (std::size_t j = 0; j < n; ++j) {
    const Triangle old = given[j].raised().raised();
    Triangle net = old;
    constexpr std::size_t d = triangle_degree;
    const std::size_t next = (j + 1) % n;
    const Points first = elevated_curve(fan.curve(j), d);
    const Points second = elevated_curve(fan.curve(next), d);
    for (std::size_t k = 0; k <= d - 2; ++k) {
      net.at(k, 0) = first[k];
      net.at(0, k) = second[k];
    }
    for (std::size_t k = 1; k <= d - 3; ++k) {
      net.at(k, 1) = first[k] + fan.right(j)[k] / double(d);
      net.at(1, k) = second[k] + fan.left(next)[k] / double(d);
    }
    const auto change = [&](std::size_t a, std::size_t b) { return net.at(a, b) - old.at(a, b); };
    net.at(2, 2) += (change(2, 1) + change(1, 2) + change(3, 1) + change(1, 3)) / 4.0;
    result.push_back(net.take());
  }
  return result;
}

}  // namespace taut
