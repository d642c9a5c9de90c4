#include <cmath>
#include <numbers>

#include "taut/envelope/gauss_triangles.h"

namespace taut {
namespace {

/// Steps of a band about its tangent, so that each is below largest_turn.
constexpr int steps_around = 96;

/// Steps that are looked at together first.
constexpr int steps_a_sector = 8;

/// Intervals of a piece are halved at most so often.
constexpr int finest_piece_level = 12;

/// Levels that are never left out, so that what happens inside shows.
constexpr int coarsest_piece_level = 2;

/// Directions towards which the curve is bent by more than this share of its bend are left out.
constexpr double inner_share = 0.05;

/// The bands of one piece.
class EdgeBands {
 public:
  EdgeBands(const ContactGeometry& geometry, const Contact& piece, int element,
            const InnerPoints& inner, const GaussTriangleOptions& options, GaussTriangles& result)
      : geometry_(geometry),
        piece_(piece),
        element_(element),
        inner_(inner),
        options_(options),
        result_(result) {}

  void run();

 private:
  struct Point {
    double t;
    dvec3 x;
    dvec3 along;  ///< unit tangent
    dvec3 bend;   ///< second derivative
    /// Orthogonal to the tangent, turning as little as can be from point to point.
    dvec3 e0, e1;
    std::vector<int> nodes;  ///< around

    dvec3 direction(int k) const {
      const double angle = 2 * std::numbers::pi * k / steps_around;
      return std::cos(angle) * e0 + std::sin(angle) * e1;
    }
  };

  Point at(double t) const;
  void sample(const Point& a, const Point& b, int level);
  bool is_fine(const Point& a, const Point& b, const Point& middle) const;
  void make_frames();
  bool is_outer(const Point& p, int k) const;
  bool is_hidden(const Point& a, const Point& b, int k, int steps) const;
  void band(Point& a, Point& b);
  void draw_end(const Point& p, double forward);

  const ContactGeometry& geometry_;
  Contact piece_;
  int element_;
  const InnerPoints& inner_;
  const GaussTriangleOptions& options_;
  GaussTriangles& result_;
  std::vector<Point> points_;
};

EdgeBands::Point EdgeBands::at(double t) const {
  Contact c = piece_;
  c.u = t;
  ContactJet j = geometry_.jet(c);
  Point p{t, j.x, unit(j.dx[0]), j.dxx, dvec3(0.0), dvec3(0.0), {}};
  if (p.along == dvec3(0.0)) {
    // The parameter halts there: the tangent a little inside.
    c.u = t < 0.5 ? t + 1e-6 : t - 1e-6;
    p.along = unit(geometry_.jet(c).dx[0]);
  }
  return p;
}

/// Whether values halfway are as interpolated, in the directions in which that is worst: those in
/// which the chord is bent.
bool EdgeBands::is_fine(const Point& a, const Point& b, const Point& middle) const {
  if (glm::dot(a.along, b.along) < std::cos(largest_turn)) return false;
  const auto [e0, e1] = tangent_frame(middle.along);
  const auto error = [&](const dvec3& n) {
    const dvec3 na = unit(n - glm::dot(n, a.along) * a.along);
    const dvec3 nb = unit(n - glm::dot(n, b.along) * b.along);
    const double value = 0.5 * glm::dot(a.x + b.x, n) + glm::dot(na - nb, a.x - b.x) / 8;
    return std::abs(glm::dot(middle.x, n) - value);
  };
  return error(e0) <= options_.value_tolerance && error(e1) <= options_.value_tolerance;
}

void EdgeBands::sample(const Point& a, const Point& b, int level) {
  const Point middle = at(0.5 * (a.t + b.t));
  if (level < finest_piece_level && (level < coarsest_piece_level || !is_fine(a, b, middle))) {
    sample(a, middle, level + 1);
    sample(middle, b, level + 1);
  } else {
    points_.push_back(b);
  }
}

void EdgeBands::make_frames() {
  dvec3 e0 = tangent_frame(points_.front().along)[0];
  for (Point& p : points_) {
    const dvec3 rest = e0 - glm::dot(e0, p.along) * p.along;
    // Where the tangent turns back on itself any frame serves.
    p.e0 = glm::length(rest) > 1e-3 ? unit(rest) : tangent_frame(p.along)[0];
    p.e1 = glm::cross(p.along, p.e0);
    e0 = p.e0;
  }
}

/// The curve is not bent towards the direction there, so that the direction may be supported.
bool EdgeBands::is_outer(const Point& p, int k) const {
  return glm::dot(p.bend, p.direction(k)) <= inner_share * glm::length(p.bend);
}

/// Nothing can be seen between the two points in so many steps from the k-th on.
bool EdgeBands::is_hidden(const Point& a, const Point& b, int k, int steps) const {
  const std::array<dvec3, 2> x = {a.x, b.x};
  const std::array<dvec3, 4> n = {a.direction(k), a.direction(k + steps), b.direction(k),
                                  b.direction(k + steps)};
  return inner_.surely_hides(x, n);
}

void EdgeBands::band(Point& a, Point& b) {
  const auto node = [&](Point& p, int k) {
    int& number = p.nodes[std::size_t(k % steps_around)];
    if (number < 0) number = result_.add_node({p.direction(k), p.x, {p.t, 0}});
    return number;
  };
  bool hidden = false;
  for (int k = 0; k < steps_around; ++k) {
    if (k % steps_a_sector == 0) hidden = is_hidden(a, b, k, steps_a_sector);
    if (hidden) continue;
    const bool outer = is_outer(a, k) || is_outer(a, k + 1) || is_outer(b, k) || is_outer(b, k + 1);
    if (!outer || is_hidden(a, b, k, 1)) continue;
    const int a0 = node(a, k);
    const int a1 = node(a, k + 1);
    const int b0 = node(b, k);
    const int b1 = node(b, k + 1);
    result_.add_triangle(element_, a0, b0, b1);
    result_.add_triangle(element_, a0, b1, a1);
  }
}

/// A strip along the last circle of directions, against cracks to where the edge goes on.
void EdgeBands::draw_end(const Point& p, double forward) {
  const dvec3 shift = forward * options_.border_width * p.along;
  const auto node = [&](const dvec3& n) { return result_.add_node({unit(n), p.x, {p.t, 0}}); };
  for (int k = 0; k < steps_around; ++k) {
    if (!(is_outer(p, k) || is_outer(p, k + 1)) || is_hidden(p, p, k, 1)) continue;
    const dvec3 m = p.direction(k);
    const dvec3 n = p.direction(k + 1);
    const int far = node(n + shift);
    const int near = node(m);
    result_.add_triangle(element_, near, node(n), far, false);
    result_.add_triangle(element_, near, far, node(m + shift), false);
  }
}

void EdgeBands::run() {
  const Point first = at(0);
  const Point last = at(1);
  points_.push_back(first);
  sample(first, last, 0);
  std::erase_if(points_, [](const Point& p) { return p.along == dvec3(0.0); });
  if (points_.size() < 2) return;
  make_frames();
  for (Point& p : points_) p.nodes.assign(steps_around, -1);
  for (std::size_t k = 0; k + 1 < points_.size(); ++k) band(points_[k], points_[k + 1]);
  // At a vertex the vertex's cell reaches over.
  const EdgePiece& piece = geometry_.part(piece_).pieces()[std::size_t(piece_.element)];
  for (const double forward : {-1.0, 1.0}) {
    if (piece.end_neighbor[0] >= 0) draw_end(points_.front(), forward);
    if (piece.end_neighbor[1] >= 0) draw_end(points_.back(), forward);
  }
}

}  // namespace

void add_edge_bands(const ContactGeometry& geometry, const Contact& piece, int element,
                    const InnerPoints& inner, const GaussTriangleOptions& options,
                    GaussTriangles& result) {
  if (geometry.is_straight(piece)) return;
  EdgeBands(geometry, piece, element, inner, options, result).run();
}

}  // namespace taut
