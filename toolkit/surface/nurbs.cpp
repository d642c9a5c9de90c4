#include "taut/surface/nurbs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// @pre the degree is valid
void validate_knot_count(std::size_t count, int degree, const std::string& name) {
  const std::size_t least = 2 * to_size(degree + 1);
  if (count < least || count > to_size(std::numeric_limits<int>::max())) {
    throw InvalidInput(name + ": " + std::to_string(count) + " knots where degree " +
                       std::to_string(degree) + " needs at least " + std::to_string(least));
  }
}

void validate_point_count(std::size_t count, std::size_t expected, const std::string& name) {
  if (count != expected) {
    throw InvalidInput(name + ": " + std::to_string(count) +
                       " control points where the knots ask for " + std::to_string(expected));
  }
}

/// @pre degree and number of knots are valid
void validate_knots(const std::vector<double>& knots, int degree, const std::string& name) {
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i])) {
      throw InvalidInput(name + ": knot " + std::to_string(i) + " is not finite");
    }
    if (i > 0 && knots[i] < knots[i - 1]) {
      throw InvalidInput(name + ": knot " + std::to_string(i) + " is below the one before it");
    }
  }
  if (!std::isfinite(knots.back() - knots.front())) {
    throw InvalidInput(name + ": the range of the knots overflows");
  }
  const std::size_t order = to_size(degree) + 1;
  if (!(knots[order - 1] < knots[knots.size() - order])) {
    throw InvalidInput(name + ": the domain is empty");
  }
  for (std::size_t i = order; i < knots.size(); ++i) {
    if (knots[i - order] == knots[i]) {
      throw InvalidInput(name + ": the multiplicity of knot " + std::to_string(i) +
                         " is above degree + 1");
    }
  }
}

/// The knots of one direction, seen as the spans that hold Bezier pieces.
class Spans {
 public:
  Spans(const std::vector<double>& knots, int degree) : knots_(knots), degree_(to_size(degree)) {
    for (std::size_t i = degree_; i + degree_ + 1 < knots.size(); ++i) {
      if (knots[i] < knots[i + 1]) spans_.push_back(i);
    }
  }

  std::size_t count() const { return spans_.size(); }
  Interval interval(std::size_t s) const { return {knots_[spans_[s]], knots_[spans_[s] + 1]}; }

  /// The Bezier points of span s; both runs of points are strided.
  void convert(std::size_t s, const dvec4* from, std::size_t from_stride, dvec4* to,
               std::size_t to_stride) const {
    for (std::size_t k = 0; k <= degree_; ++k) {
      to[k * to_stride] = blossom(s, k, from, from_stride);
    }
  }

 private:
  /// The blossom at (a, .., a, b, .., b) with k times b, for the span [a, b], by de Boor's
  /// recurrence with a new argument in every step. All factors lie in [0, 1] since every knot that
  /// takes part is outside the open span: positive weights stay positive.
  dvec4 blossom(std::size_t s, std::size_t k, const dvec4* points, std::size_t stride) const {
    const std::size_t p = degree_;
    const std::size_t first = spans_[s] - p;
    std::array<dvec4, max_degree + 1> d;
    for (std::size_t j = 0; j <= p; ++j) d[j] = points[(first + j) * stride];
    for (std::size_t r = 1; r <= p; ++r) {
      const double x = r <= k ? interval(s).upper : interval(s).lower;
      for (std::size_t j = p; j >= r; --j) {
        const double lower = knots_[first + j];
        const double upper = knots_[first + j + p + 1 - r];
        const double f = (x - lower) / (upper - lower);
        d[j] = (1 - f) * d[j - 1] + f * d[j];
      }
    }
    return d[p];
  }

  const std::vector<double>& knots_;
  std::size_t degree_;
  std::vector<std::size_t> spans_;
};

Interval domain(const std::vector<double>& knots, int degree) {
  const std::size_t p = to_size(degree);
  return {knots[p], knots[knots.size() - p - 1]};
}

std::vector<double> bezier_knots(int degree) {
  std::vector<double> knots(2 * to_size(degree + 1), 0.0);
  std::fill(knots.begin() + degree + 1, knots.end(), 1.0);
  return knots;
}

}  // namespace

Interval NurbsCurve::domain() const { return taut::domain(knots, degree); }
Interval NurbsSurface::domain_u() const { return domain(knots_u, degree_u); }
Interval NurbsSurface::domain_v() const { return domain(knots_v, degree_v); }

void validate(const NurbsCurve& curve, const std::string& name) {
  validate_degree(curve.degree, name);
  validate_knot_count(curve.knots.size(), curve.degree, name);
  validate_point_count(curve.points.size(), curve.knots.size() - to_size(curve.degree) - 1, name);
  validate_knots(curve.knots, curve.degree, name);
  validate_points(curve.points, name);
}

void validate(const NurbsSurface& surface, const std::string& name) {
  const std::string name_u = name + ": u";
  const std::string name_v = name + ": v";
  validate_degree(surface.degree_u, name_u);
  validate_degree(surface.degree_v, name_v);
  validate_knot_count(surface.knots_u.size(), surface.degree_u, name_u);
  validate_knot_count(surface.knots_v.size(), surface.degree_v, name_v);
  validate_point_count(surface.points.size(),
                       to_size(surface.count_u()) * to_size(surface.count_v()), name);
  validate_knots(surface.knots_u, surface.degree_u, name_u);
  validate_knots(surface.knots_v, surface.degree_v, name_v);
  validate_points(surface.points, name);
}

std::vector<CurvePiece> decompose(const NurbsCurve& curve) {
  const Spans spans(curve.knots, curve.degree);
  std::vector<CurvePiece> pieces(spans.count());
  for (std::size_t s = 0; s < spans.count(); ++s) {
    pieces[s].t = spans.interval(s);
    pieces[s].bezier.points.resize(to_size(curve.degree) + 1);
    spans.convert(s, curve.points.data(), 1, pieces[s].bezier.points.data(), 1);
  }
  return pieces;
}

std::vector<PatchPiece> decompose(const NurbsSurface& surface) {
  const Spans spans_u(surface.knots_u, surface.degree_u);
  const Spans spans_v(surface.knots_v, surface.degree_v);
  const std::size_t rows = to_size(surface.degree_u) + 1;
  const std::size_t columns = to_size(surface.degree_v) + 1;
  const std::size_t count_v = to_size(surface.count_v());

  std::vector<PatchPiece> pieces;
  pieces.reserve(spans_u.count() * spans_v.count());
  std::vector<dvec4> strip(rows * count_v);  // Bezier along u, still B-spline along v
  for (std::size_t su = 0; su < spans_u.count(); ++su) {
    for (std::size_t j = 0; j < count_v; ++j) {
      spans_u.convert(su, &surface.points[j], count_v, &strip[j], count_v);
    }
    for (std::size_t sv = 0; sv < spans_v.count(); ++sv) {
      BezierPatch patch{surface.degree_u, surface.degree_v, std::vector<dvec4>(rows * columns)};
      for (std::size_t i = 0; i < rows; ++i) {
        spans_v.convert(sv, &strip[i * count_v], 1, &patch.points[i * columns], 1);
      }
      pieces.push_back({std::move(patch), spans_u.interval(su), spans_v.interval(sv)});
    }
  }
  return pieces;
}

NurbsCurve as_nurbs(const BezierCurve& curve) {
  return {curve.degree(), bezier_knots(curve.degree()), curve.points};
}

NurbsSurface as_nurbs(const BezierPatch& patch) {
  return {patch.degree_u, patch.degree_v, bezier_knots(patch.degree_u),
          bezier_knots(patch.degree_v), patch.points};
}

}  // namespace taut
