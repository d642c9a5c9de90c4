#include "taut/surface/crests.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "taut/core/tolerances.h"
#include "taut/surface/flatness.h"

namespace taut {
namespace {

/// The patch with the curves across the crests' direction seen as curves u = s.
struct Across {
  const BezierPatch& patch;
  Direction direction;

  dvec2 uv(double s, double t) const {
    return direction == Direction::u ? dvec2(s, t) : dvec2(t, s);
  }
  int degree_across() const { return direction == Direction::u ? patch.degree_u : patch.degree_v; }
  int degree_along() const { return direction == Direction::u ? patch.degree_v : patch.degree_u; }

  dvec3 normal(double s, double t) const {
    const dvec2 at = uv(s, t);
    const PatchJet1 j = jet1(patch, at.x, at.y);
    return glm::cross(j.Su, j.Sv);
  }

  /// The normal at one place of the curve s, away from the borders, where patches collapse.
  dvec3 first_normal(double s) const { return unit(normal(s, 0.21)); }
  /// Sine of the angle between it and the normal at another place, not at the first one's mirror
  /// image, about the axis of which it turns: zero at a crest, and of either sign in all
  /// coordinates beside most.
  dvec3 turn(double s) const { return turn_from(first_normal(s), s); }
  dvec3 turn_from(const dvec3& first, double s) const {
    return glm::cross(first, unit(normal(s, 0.73)));
  }
};

/// Whether all of `turn` seems to vanish where the coordinate does, between parameters at which its
/// signs differ: most signs change where the others stay. At a crest what is left is of second
/// order in the step.
bool may_vanish(const Across& across, int axis, double a, const dvec3& fa, double b,
                const dvec3& fb) {
  const double s = (a * fb[axis] - b * fa[axis]) / (fb[axis] - fa[axis]);
  return glm::length(across.turn(s)) <= 0.5 * std::max(glm::length(fa), glm::length(fb));
}

/// Root of a coordinate of `turn` between parameters where its signs differ, to the last bits
/// (false position, Illinois' variant).
double turn_root(const Across& across, int axis, double a, double fa, double b, double fb) {
  constexpr int step_limit = 60;
  double s = a;
  for (int k = 0; k < step_limit && b - a > rounding_unit; ++k) {
    s = (a * fb - b * fa) / (fb - fa);
    if (!(s > a && s < b)) s = 0.5 * (a + b);
    if (s == a || s == b) break;
    const double fs = across.turn(s)[axis];
    if (std::abs(fs) <= rounding_unit) break;
    if ((fs > 0) == (fb > 0)) {
      b = s;
      fb = fs;
      fa *= 0.5;
    } else {
      a = s;
      fa = fs;
      fb *= 0.5;
    }
  }
  return s;
}

/// The root of a coordinate of `turn` between parameters where its signs differ, if all of `turn`
/// may vanish there; where the surface turns sharply the way to it is halved until that is seen.
void add_root(const Across& across, int axis, double a, const dvec3& fa, double b, const dvec3& fb,
              int halvings, std::vector<double>& roots) {
  if ((fa[axis] > 0) == (fb[axis] > 0)) return;
  if (may_vanish(across, axis, a, fa, b, fb)) {
    roots.push_back(turn_root(across, axis, a, fa[axis], b, fb[axis]));
    return;
  }
  if (halvings == 0) return;
  const double middle = 0.5 * (a + b);
  const dvec3 f = across.turn(middle);
  add_root(across, axis, a, fa, middle, f, halvings - 1, roots);
  add_root(across, axis, middle, f, b, fb, halvings - 1, roots);
}

struct Turn {
  double s = 0;
  dvec3 normal = dvec3(0.0);
  dvec3 f = dvec3(0.0);
};

Turn turn_at(const Across& across, double s) {
  const dvec3 n = across.first_normal(s);
  return {s, n, across.turn_from(n, s)};
}

/// Largest turn of the normal between neighbours, as a cosine: signs may change and change back
/// where it turns by more.
constexpr double sharp_turn = 0.95;

/// Adds those between two, and the second one.
void add_turns(const Across& across, const Turn& a, const Turn& b, int halvings,
               std::vector<Turn>& turns) {
  if (halvings > 0 && glm::dot(a.normal, b.normal) < sharp_turn) {
    const Turn middle = turn_at(across, 0.5 * (a.s + b.s));
    add_turns(across, a, middle, halvings - 1, turns);
    add_turns(across, middle, b, halvings - 1, turns);
    return;
  }
  turns.push_back(b);
}

/// Halvings between parameters at which `turn` is known.
constexpr int turn_halvings = 8;

/// At equally spaced parameters, and at more where the surface turns sharply.
std::vector<Turn> turns_of(const Across& across) {
  const int count = 4 * across.degree_across() + 8;
  std::vector<Turn> turns = {turn_at(across, 0)};
  for (int k = 1; k <= count; ++k) {
    const Turn last = turns.back();
    add_turns(across, last, turn_at(across, double(k) / count), turn_halvings, turns);
  }
  return turns;
}

/// Roots of one coordinate of `turn`; values that may be rounding have no sign.
void add_roots(const Across& across, const std::vector<Turn>& turns, int axis,
               std::vector<double>& roots) {
  std::optional<std::size_t> before;
  for (std::size_t k = 0; k < turns.size(); ++k) {
    const Turn& here = turns[k];
    if (std::abs(here.f[axis]) <= crest_angle) continue;
    // More than one value without a sign between two of them is a coordinate that vanishes.
    if (before && k - *before <= 2) {
      const Turn& last = turns[*before];
      add_root(across, axis, last.s, last.f, here.s, here.f, turn_halvings, roots);
    }
    before = k;
  }
}

/// What rounding to a grid does to a crest's heights and, times the degree, its derivatives, in
/// steps of the grid: half a step moves a control point, and derivatives are of differences of two.
constexpr double grid_steps = 4;

double size_of(const std::vector<dvec4>& points) {
  Box box;
  for (const dvec4& p : points) box.include(euclidean(p));
  return diagonal(box);
}

/// What rounding does to a patch's points, and to its normals along a curve. Curves as short as
/// those about a pole are no crests.
struct Rounding {
  Rounding(const Across& across, double s, double grid)
      : point(std::max(coordinate_rounding * largest_coordinate(across.patch.points),
                       grid_steps * grid)) {
    const dvec2 at = across.uv(s, 0.5);
    const PatchJet1 j = jet1(across.patch, at.x, at.y);
    const double speed = glm::length(across.direction == Direction::u ? j.Su : j.Sv);
    angle = point *
            (across.degree_across() / speed + across.degree_along() / size_of(across.patch.points));
  }
  /// Over the tangent plane, of a point so far from the place.
  double of_height(double distance) const { return point + angle * distance; }

  double point = 0;
  double angle = 0;
};

}  // namespace

bool is_crest(const BezierPatch& patch, Direction direction, double s, double grid) {
  const Across across{patch, direction};
  const double size = size_of(patch.points);
  const auto at = [&](double t) { return across.uv(s, t); };
  const dvec2 middle = at(0.5);
  const Rounding rounding(across, s, grid);
  const double height = crest_height * size + rounding.of_height(size);
  const double angle = crest_angle + rounding.angle;
  const dvec3 n = unit_normal(patch, middle.x, middle.y);
  const double h = glm::dot(n, point(patch, middle.x, middle.y));
  if (n == dvec3(0.0)) return false;
  // As many places as determine the polynomials that the rational ones have as numerators, all of
  // them inside: at its ends the curve may run into a pole.
  const int m = 4 * across.degree_along() + 2;
  for (int k = 0; k < m; ++k) {
    const dvec2 uv = at(0.5 - 0.5 * std::cos(std::numbers::pi * (k + 0.5) / m));
    if (glm::length(unit_normal(patch, uv.x, uv.y) - n) > angle) return false;
    if (std::abs(glm::dot(n, point(patch, uv.x, uv.y)) - h) > height) return false;
  }
  return !is_straight(parameter_curve(patch, direction, s));
}

bool may_support(const BezierPatch& patch, Direction direction, double s,
                 std::span<const dvec3> points, double tolerance, double grid) {
  const Across across{patch, direction};
  const dvec2 middle = across.uv(s, 0.5);
  const dvec3 n = unit_normal(patch, middle.x, middle.y);
  const dvec3 x = point(patch, middle.x, middle.y);
  const Rounding rounding(across, s, grid);
  bool above = false;
  bool below = false;
  for (const dvec3& p : points) {
    const double height = glm::dot(n, p - x);
    const double allowed = std::max(tolerance, rounding.of_height(glm::distance(p, x)));
    above = above || height > allowed;
    below = below || height < -allowed;
    if (above && below) return false;
  }
  return true;
}

std::vector<double> inner_crests(const BezierPatch& patch, Direction direction, double grid) {
  const Across across{patch, direction};
  const std::vector<Turn> turns = turns_of(across);
  std::vector<double> roots;
  for (const int axis : {0, 1, 2}) add_roots(across, turns, axis, roots);
  std::sort(roots.begin(), roots.end());
  std::vector<double> crests;
  for (const double s : roots) {
    const double from = crests.empty() ? 0 : crests.back();
    if (s - from <= least_crest_share || 1 - s <= least_crest_share) continue;
    if (is_crest(patch, direction, s, grid)) crests.push_back(s);
  }
  return crests;
}

}  // namespace taut
