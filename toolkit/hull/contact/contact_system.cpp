#include "taut/hull/contact/contact_system.h"

#include <Eigen/Dense>
#include <cmath>

namespace taut {
namespace {

/// Tangents shorter than this, in the scene's frame, are near a pole or of a thin patch; their
/// rounding is that of longer ones.
constexpr double small_tangent = 0.05;

/// Share of the largest singular value below which one is taken for zero in steps of least length:
/// a start that is off by less than a ten thousandth there misses residuals by less than a ten
/// thousandth of it, and rounding does not move contacts by more than about as little.
constexpr double least_singular = 1e-9;

constexpr int max_unknowns = 2 + 2 * CommonSupport::capacity;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_unknowns,
                             max_unknowns>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, max_unknowns, 1>;

/// The linearised equations of contacts at a direction. Unknowns: the coordinates of dn in the
/// tangent frame, and for every parameter the length that the contact's point moves by.
struct Linearized {
  std::array<dvec3, 2> frame;
  std::array<std::array<double, 2>, CommonSupport::capacity> scale{};  // |dx/da|
  std::array<int, CommonSupport::capacity> first{};                    // unknown of each contact
  Matrix matrix;
  Vector right;
  int unknowns = 2;
  int rows = 0;

  explicit Linearized(const CommonSupport& s) : frame(tangent_frame(s.n)) {
    for (int i = 0; i < s.count; ++i) {
      const auto k = std::size_t(i);
      first[k] = unknowns;
      unknowns += s.jet[k].dimension;
      for (std::size_t a = 0; a < 2; ++a) {
        const double length = glm::length(s.jet[k].dx[a]);
        scale[k][a] = length > 0 ? length : 1;
      }
    }
    matrix = Matrix::Zero(unknowns, unknowns);
    right = Vector::Zero(unknowns);
    for (int i = 0; i < s.count; ++i) add_stationary(s, i);
    for (int i = 1; i < s.count; ++i) add_tie(s, i);
  }

  void add_direction(const dvec3& gradient) {
    matrix(rows, 0) = glm::dot(gradient, frame[0]);
    matrix(rows, 1) = glm::dot(gradient, frame[1]);
  }
  double& at(int contact, int parameter) {
    return matrix(rows, first[std::size_t(contact)] + parameter);
  }

  void add_stationary(const CommonSupport& s, int i) {
    const ContactJet& j = s.jet[std::size_t(i)];
    const auto& size = scale[std::size_t(i)];
    const double xx = glm::dot(j.dxx, s.n);
    const double xy = glm::dot(j.dxy, s.n);
    const double yy = glm::dot(j.dyy, s.n);
    for (int a = 0; a < j.dimension; ++a) {
      if (s.kept[std::size_t(i)] == a) {
        at(i, a) = 1;
        ++rows;
        continue;
      }
      const double own = size[std::size_t(a)];
      add_direction(j.dx[std::size_t(a)] / own);
      at(i, 0) = (a == 0 ? xx : xy) / (own * size[0]);
      if (j.dimension == 2) at(i, 1) = (a == 0 ? xy : yy) / (own * size[1]);
      right[rows] = -glm::dot(j.dx[std::size_t(a)], s.n) / own;
      ++rows;
    }
  }

  void add_tie(const CommonSupport& s, int i) {
    const dvec3 d = s.jet[0].x - s.jet[std::size_t(i)].x;
    add_direction(d);
    for (int a = 0; a < s.jet[0].dimension; ++a) {
      at(0, a) = glm::dot(s.jet[0].dx[std::size_t(a)], s.n) / scale[0][std::size_t(a)];
    }
    for (int a = 0; a < s.jet[std::size_t(i)].dimension; ++a) {
      at(i, a) = -glm::dot(s.jet[std::size_t(i)].dx[std::size_t(a)], s.n) /
                 scale[std::size_t(i)][std::size_t(a)];
    }
    right[rows] = -glm::dot(d, s.n);
    ++rows;
  }

  void add(const CommonSupport& s, const LinearEquation& e) {
    add_direction(e.n);
    for (int i = 0; i < s.count; ++i) {
      const auto k = std::size_t(i);
      for (int a = 0; a < s.jet[k].dimension; ++a) {
        at(i, a) = e.parameter[k][a] / scale[k][std::size_t(a)];
      }
    }
    right[rows] = -e.residual;
    ++rows;
  }

  dvec3 direction(const Vector& x) const { return x[0] * frame[0] + x[1] * frame[1]; }
  dvec2 parameters(const CommonSupport& s, const Vector& x, int i) const {
    const auto k = std::size_t(i);
    dvec2 change(0.0);
    for (int a = 0; a < s.jet[k].dimension; ++a) {
      change[a] = x[first[k] + a] / scale[k][std::size_t(a)];
    }
    return change;
  }
};

}  // namespace

CommonSupport::CommonSupport(const ContactGeometry& geometry, const Ruling& ruling) : n(ruling.n) {
  for (const Contact& c : ruling.contact) add(geometry, c);
}

void CommonSupport::add(const ContactGeometry& geometry, const Contact& c) {
  contact[std::size_t(count)] = c;
  jet[std::size_t(count)] = geometry.jet(c);
  ++count;
}

void CommonSupport::evaluate(const ContactGeometry& geometry) {
  for (int i = 0; i < count; ++i) jet[std::size_t(i)] = geometry.jet(contact[std::size_t(i)]);
}

Ruling CommonSupport::ruling() const { return {n, {contact[0], contact[1]}, {jet[0].x, jet[1].x}}; }

int kept_parameter(const Contact& a, const Contact& b) {
  if (a.kind == SourceKind::vertex || !same_element(a, b)) return CommonSupport::free;
  const auto is_end = [](double t) { return t == 0 || t == 1; };
  if (a.u == b.u && is_end(a.u)) return 0;
  return a.kind == SourceKind::face && a.v == b.v && is_end(a.v) ? 1 : CommonSupport::free;
}

void LinearEquation::add_point(const CommonSupport& s, int i, const dvec3& g) {
  const ContactJet& j = s.jet[std::size_t(i)];
  parameter[std::size_t(i)] += dvec2(glm::dot(j.dx[0], g), glm::dot(j.dx[1], g));
}

LinearEquation distance_equation(const CommonSupport& s, double length) {
  LinearEquation e;
  const dvec3 d = s.d() / length;
  e.residual = 0.5 * (glm::dot(s.d(), d) - length);
  e.add_point(s, 0, d);
  e.add_point(s, 1, -d);
  return e;
}

std::optional<double> ContactSystem::step(CommonSupport& s, const LinearEquation* extra,
                                          Steps steps) const {
  ++iterations_;
  Linearized l(s);
  if (extra != nullptr) l.add(s, *extra);
  Vector x;
  if (steps == Steps::full) {
    x = l.matrix.partialPivLu().solve(l.right);
  } else {
    Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
    decomposition.setThreshold(least_singular);
    x = decomposition.compute(l.matrix).solve(l.right);
  }
  const double length = x.norm();
  if (!(length < step_bound)) return std::nullopt;
  s.n = glm::normalize(s.n + l.direction(x));
  for (int i = 0; i < s.count; ++i) {
    const dvec2 change = l.parameters(s, x, i);
    s.contact[std::size_t(i)].u += change.x;
    s.contact[std::size_t(i)].v += change.y;
  }
  s.evaluate(geometry_);
  return length;
}

double ContactSystem::residual(const CommonSupport& s) const {
  double largest = largest_slope(s);
  for (int i = 1; i < s.count; ++i) {
    const dvec3 d = s.jet[0].x - s.jet[std::size_t(i)].x;
    largest = std::max(largest, std::abs(glm::dot(d, s.n)));
  }
  return largest;
}

double ContactSystem::largest_slope(const CommonSupport& s) {
  double largest = 0;
  for (std::size_t i = 0; i < std::size_t(s.count); ++i) {
    const ContactJet& j = s.jet[i];
    for (std::size_t a = 0; a < std::size_t(j.dimension); ++a) {
      if (s.kept[i] == int(a) && s.contact[i].kind == SourceKind::edge) continue;
      // About a pole tangents are as short as they like, their rounding is not.
      const double length = std::max(glm::length(j.dx[a]), small_tangent);
      largest = std::max(largest, std::abs(glm::dot(j.dx[a], s.n)) / length);
    }
  }
  return largest;
}

double ContactSystem::uncertainty(const CommonSupport& s) const {
  const Linearized l(s);
  const Eigen::JacobiSVD<Matrix> decomposition(l.matrix.topRows(l.rows));
  const double smallest = decomposition.singularValues().minCoeff();
  return smallest > 0 ? geometry_.rounding() / smallest : infinity;
}

bool ContactSystem::solve(CommonSupport& s) const {
  double last = infinity;
  for (int k = 0; k < step_limit; ++k) {
    const std::optional<double> length = step(s, nullptr);
    if (!length) return false;
    if (*length < converged_step || (*length<noise_step&& * length> 0.5 * last)) {
      return residual(s) < residual_limit;
    }
    last = *length;
  }
  return false;
}

std::optional<CommonSupport> ContactSystem::crossing(CommonSupport s, double depth) const {
  double last = infinity;
  for (int k = 0; k < step_limit; ++k) {
    ++iterations_;
    const std::array<dvec3, 2> frame = tangent_frame(s.n);
    // Columns: how x_0 - x_1 moves with n along the frame, contacts kept stationary.
    Eigen::Matrix2d motion;
    Eigen::Vector2d off;
    std::array<dvec2, 2> correction{};
    for (std::size_t i = 0; i < 2; ++i) {
      // What makes the contact stationary in n as it is.
      const ContactJet& j = s.jet[i];
      const std::optional<dvec2> rate = parameter_rate(j, s.n, s.n);
      if (!rate) return std::nullopt;
      correction[i] = *rate;
    }
    const auto moved = [&](std::size_t i, const dvec2& rate) {
      return rate.x * s.jet[i].dx[0] + rate.y * s.jet[i].dx[1];
    };
    const dvec3 d = s.d() + moved(0, correction[0]) - moved(1, correction[1]);
    for (int a = 0; a < 2; ++a) {
      dvec3 change(0.0);
      for (std::size_t i = 0; i < 2; ++i) {
        const auto rate = parameter_rate(s.jet[i], s.n, frame[std::size_t(a)]);
        change += (i == 0 ? 1.0 : -1.0) * moved(i, *rate);
      }
      for (int b = 0; b < 2; ++b) motion(b, a) = glm::dot(change, frame[std::size_t(b)]);
      off[a] = -glm::dot(d, frame[std::size_t(a)]);
    }
    const Eigen::Vector2d turn = motion.fullPivLu().solve(off);
    const dvec3 dn = turn[0] * frame[0] + turn[1] * frame[1];
    double length = glm::length(dn);
    if (!(length < step_bound)) return std::nullopt;
    for (std::size_t i = 0; i < 2; ++i) {
      const dvec2 change = correction[i] + *parameter_rate(s.jet[i], s.n, dn);
      s.contact[i].u += change.x;
      s.contact[i].v += change.y;
      length = std::max(length, glm::length(moved(i, change)));
    }
    s.n = glm::normalize(s.n + dn);
    s.evaluate(geometry_);
    if (length < converged_step || (length < noise_step && length > 0.5 * last)) {
      const double height = glm::dot(s.d(), s.n);
      const double apart = glm::length(s.d() - height * s.n);
      const bool touch = std::abs(height) < residual_limit + depth && apart < residual_limit &&
                         largest_slope(s) < residual_limit;
      return touch ? std::optional(s) : std::nullopt;
    }
    last = length;
  }
  return std::nullopt;
}

std::optional<CurveTangent> ContactSystem::tangent(const CommonSupport& s) const {
  const Linearized l(s);
  // Across all rows of the system without its free one: the last column of Q in A^T = Q R.
  const Matrix transposed = l.matrix.topRows(l.rows).transpose();
  const Vector x = Eigen::HouseholderQR<Matrix>(transposed).householderQ() *
                   Vector::Unit(l.unknowns, l.unknowns - 1);
  CurveTangent t;
  t.n = l.direction(x);
  double square = glm::dot(t.n, t.n);
  for (int i = 0; i < 2; ++i) {
    const auto k = std::size_t(i);
    t.parameter[k] = l.parameters(s, x, i);
    t.x[k] = t.parameter[k].x * s.jet[k].dx[0] + t.parameter[k].y * s.jet[k].dx[1];
    square += glm::dot(t.x[k], t.x[k]);
  }
  if (!(square > 0)) return std::nullopt;
  const double size = std::sqrt(square);
  const double sense = glm::dot(t.n, unit(glm::cross(s.n, s.d()))) / size;
  const double factor = std::copysign(1 / size, sense);
  t.n *= factor;
  for (std::size_t k = 0; k < 2; ++k) {
    t.parameter[k] *= factor;
    t.x[k] *= factor;
  }
  return t;
}

}  // namespace taut
