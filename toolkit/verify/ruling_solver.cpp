#include "taut/verify/ruling_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Where rulings are solved for: the extrema of Chebyshev polynomials of degree 10, of which every
/// second one is an extremum of that of degree 5.
constexpr std::array<double, 11> node = {
    0,   0.0244717418524232303, 0.0954915028125262857, 0.20610737385376343,   0.3454915028125262857,
    0.5, 0.6545084971874737143, 0.7938926261462365,    0.9045084971874737143, 0.9755282581475768,
    1};

/// The order in which they are solved for: each from a polynomial through those before.
constexpr std::array<std::size_t, 9> order = {5, 2, 8, 1, 9, 3, 7, 4, 6};

/// Slopes as fractions of the diagonal, and heights, of rulings that are solutions.
constexpr double solved_residual = 1e-12;
/// Those of sides that are tangent to planes.
constexpr double level_slope = 1e-9;

/// Parameters along which a surface does not move, as a fraction of the diagonal: at poles.
constexpr double still = 1e-12;

/// Parameters of contacts are in [0, 1] but for this.
constexpr double beside_domain = 1e-9;

/// Polynomials of half the degree miss rulings by the root of what all miss them by.
constexpr double accuracy = 1e-13;

/// On half of a stretch polynomials of degree five miss smooth functions by 1/64.
constexpr double least_gain = 0.25;

/// Where a contact's element ends in the other's, both may be in one point, which is no ruling: as
/// a share of the shorter one of those that it is between.
constexpr double shortest_between = 0.1;

constexpr int max_depth = 10;
constexpr int max_steps = 20;

// Two coordinates of the normal, and up to two of each contact.
constexpr int max_unknowns = 6;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_unknowns, max_unknowns>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_unknowns, 1>;

const dvec3& second(const SourceJet& j, int p, int q) {
  return p != q ? j.dxy : p == 0 ? j.dxx : j.dyy;
}

}  // namespace

RulingSolver::RulingSolver(const DocumentGeometry& geometry, RulingInterval& interval)
    : geometry_(geometry), interval_(interval), size_(geometry.hull().diagonal) {
  find_parameters();
}

double RulingSolver::slope_along(std::size_t k, int parameter, const RulingState& at) const {
  return std::abs(glm::dot(jet(k, at).dx[to_size(parameter)], at.n)) / size_;
}

bool RulingSolver::moves(std::size_t k, int parameter, const RulingState& at) const {
  return glm::length(jet(k, at).dx[to_size(parameter)]) > still * size_;
}

void RulingSolver::find_parameters() {
  const RulingState& from = interval_.first;
  const RulingState& to = interval_.last;
  for (std::size_t k = 0; k < 2; ++k) {
    const int dimension = jet(k, from).dimension;
    for (int p = 0; p < dimension; ++p) {
      if (!moves(k, p, from) && !moves(k, p, to) && !moves(k, p, 0.5 * (from + to))) continue;
      all_[k].push_back(p);
      const double t = from.t[k][p];
      const bool on_border = dimension == 2 && t == to.t[k][p] && (t == 0 || t == 1);
      if (!on_border) on_side_[k].push_back(p);
      const bool level =
          slope_along(k, p, from) <= level_slope && slope_along(k, p, to) <= level_slope;
      if (on_border && level) level_[k].push_back(p);
    }
  }
}

/// Contacts on a side at both ends stay there: held by it, or because surfaces are symmetric about
/// it or ruled across it. Where nothing holds them they may leave it in between.
bool RulingSolver::run() {
  if (run_along(on_side_, level_)) return true;
  const bool held = level_[0].empty() && level_[1].empty();
  return !held && run_along(all_, {});
}

bool RulingSolver::run_along(const Parameters& free, const Parameters& level) {
  free_ = free;
  level_here_ = level;
  interval_.panels.clear();
  return add_panels(0, interval_.first, 1, interval_.last, std::numeric_limits<double>::infinity(),
                    max_depth);
}

/// `before`: what polynomials of half the degree miss over twice the stretch.
bool RulingSolver::add_panels(double s0, const RulingState& from, double s1, const RulingState& to,
                              double before, int depth) {
  RulingPanel panel(s0, s1);
  const std::optional<double> missed = fill(panel, from, to);
  // Where it hardly falls it is what rounding moves rulings by.
  const bool noise = missed && *missed > least_gain * before;
  if (missed && (panel.settled || noise || depth == 0)) {
    interval_.panels.push_back(std::move(panel));
    return true;
  }
  if (depth == 0) return false;
  const double middle = 0.5 * (s0 + s1);
  const std::optional<RulingState> half = solve(from, to - from, 0.5, 0.5 * (from + to));
  const double now = missed.value_or(std::numeric_limits<double>::infinity());
  return half && add_panels(s0, from, middle, *half, now, depth - 1) &&
         add_panels(middle, *half, s1, to, now, depth - 1);
}

/// Fills a panel from one known ruling to another. What polynomials of half the degree miss; none
/// if a ruling is not found.
std::optional<double> RulingSolver::fill(RulingPanel& panel, const RulingState& from,
                                         const RulingState& to) const {
  const RulingState chord = to - from;
  const double width = panel.to - panel.from;
  std::array<RulingState, node.size()> states;
  RulingPanel known(0, 1);
  known.add(0, states.front() = from);
  known.add(1, states.back() = to);
  for (const std::size_t i : order) {
    const std::optional<RulingState> at = solve(from, chord, node[i], known.through(1, node[i])[0]);
    if (!at) return std::nullopt;
    known.add(node[i], states[i] = *at);
  }
  for (std::size_t i = 0; i < node.size(); ++i) panel.add(panel.from + width * node[i], states[i]);
  double missed = 0;
  for (std::size_t i = 1; i < node.size(); i += 2) {
    missed = std::max(missed, length(panel.through(2, panel.nodes()[i])[0] - states[i]));
  }
  panel.settled = missed * missed <= accuracy * length(chord);
  return missed;
}

/// The ruling at a share of the way between two others, as their states are apart.
std::optional<RulingState> RulingSolver::solve(const RulingState& from, const RulingState& chord,
                                               double share, const RulingState& guess) const {
  RulingState at = guess;
  at.n = unit(at.n);
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < max_steps; ++step) {
    const double off = dot(chord, at - from) - share * dot(chord, chord);
    const RulingState change = newton_step(at, chord, off);
    const double way = length(change);
    if (!(way <= length(chord))) return std::nullopt;
    // Where it stops to shrink there is nothing but rounding.
    if (way >= last && is_ruling(at)) break;
    last = way;
    at = at + change;
    at.n = unit(at.n);
    if (way <= rounding_unit) break;
  }
  if (!is_ruling(at) || length(at - guess) > length(chord)) return std::nullopt;
  const double shorter = std::min(span(interval_.first), span(interval_.last));
  return span(at) < shortest_between * shorter ? std::nullopt : std::optional(at);
}

/// Solves the equations' linear forms: slopes along the free parameters, height of one contact
/// above the other, and the way along the chord, of which `off` is too much.
RulingState RulingSolver::newton_step(const RulingState& at, const RulingState& chord,
                                      double off) const {
  const std::array<SourceJet, 2> jets = {jet(0, at), jet(1, at)};
  const std::array<dvec3, 2> turn = tangent_frame(at.n);
  const std::array<Eigen::Index, 2> column = {2, 2 + Eigen::Index(free_[0].size())};
  const Eigen::Index unknowns = column[1] + Eigen::Index(free_[1].size());
  const Eigen::Index height = unknowns - 2;
  const Eigen::Index way = unknowns - 1;
  Matrix A = Matrix::Zero(unknowns, unknowns);
  Vector b = Vector::Zero(unknowns);
  const dvec3 ruling = (jets[0].x - jets[1].x) / size_;
  for (Eigen::Index e = 0; e < 2; ++e) {
    A(height, e) = glm::dot(ruling, turn[std::size_t(e)]);
    A(way, e) = glm::dot(chord.n, turn[std::size_t(e)]);
  }
  b(height) = -glm::dot(ruling, at.n);
  b(way) = -off;
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < free_[k].size(); ++i) {
      const int p = free_[k][i];
      const Eigen::Index own = column[k] + Eigen::Index(i);
      const Eigen::Index row = own - 2;
      const dvec3 d = jets[k].dx[to_size(p)] / size_;
      b(row) = -glm::dot(d, at.n);
      for (Eigen::Index e = 0; e < 2; ++e) A(row, e) = glm::dot(d, turn[std::size_t(e)]);
      for (std::size_t j = 0; j < free_[k].size(); ++j) {
        A(row, column[k] + Eigen::Index(j)) =
            glm::dot(second(jets[k], p, free_[k][j]), at.n) / size_;
      }
      A(height, own) = (k == 0 ? 1 : -1) * glm::dot(d, at.n);
      A(way, own) = chord.t[k][p];
    }
  }
  const Vector x = A.fullPivLu().solve(b);
  RulingState change;
  change.n = x(0) * turn[0] + x(1) * turn[1];
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < free_[k].size(); ++i) {
      change.t[k][free_[k][i]] = x(column[k] + Eigen::Index(i));
    }
  }
  return change;
}

double RulingSolver::span(const RulingState& at) const {
  return glm::distance(jet(0, at).x, jet(1, at).x);
}

bool RulingSolver::is_ruling(const RulingState& at) const {
  const auto within = [](double t) { return -beside_domain <= t && t <= 1 + beside_domain; };
  double sum = std::abs(glm::dot(jet(0, at).x - jet(1, at).x, at.n)) / size_;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!within(at.t[k].x) || !within(at.t[k].y)) return false;
    for (const int p : free_[k]) sum += slope_along(k, p, at);
    for (const int p : level_here_[k]) {
      if (slope_along(k, p, at) > level_slope) return false;
    }
  }
  return sum <= solved_residual;
}

}  // namespace taut
