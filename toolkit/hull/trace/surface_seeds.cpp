#include "taut/hull/trace/surface_seeds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_exits.h"
#include "taut/bounds/poles.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/trace/merging.h"

namespace taut {
namespace {

/// Halvings of a side after which a curve that Newton's method does not find is given up.
constexpr int side_halvings = 36;

struct SeedSample {
  bool supports = false;
  dvec3 n = dvec3(0.0);  ///< zero where the patch has no normal
  Contact winner;
};

/// Whether the patch's point supports the model in the direction of its normal, or what does.
SeedSample looked(const ContactGeometry& geometry, SupportQuery& query, const Contact& c,
                  int sign) {
  const dvec3 n = double(sign) * unit_normal(geometry, c);
  if (n == dvec3(0.0)) return {};
  const Support top = query(n, c);
  if (top.h <= glm::dot(geometry.point(c), n) + geometry.tie()) return {true, n, c};
  return {false, n, geometry.canonical(top.contact)};
}

/// Looks as looked() does, but without a query at points that support in nearly the same direction
/// as one that was looked at before: corners of patches that meet there smoothly.
class Lookout {
 public:
  Lookout(const ContactGeometry& geometry, SupportQuery& query)
      : geometry_(geometry),
        query_(query),
        diameter_(geometry.scene().frame().length_to_frame(geometry.scene().diagonal())) {}

  SeedSample operator()(const Contact& c, int sign) {
    const dvec3 n = double(sign) * unit_normal(geometry_, c);
    if (n == dvec3(0.0)) return {};
    const dvec3 x = geometry_.point(c);
    Known& known = known_[cube_of(x)];
    // For y anywhere on the model (y - x) . n is (y - x) . m + (y - x) . (n - m).
    const double excess = known.h - glm::dot(x, known.n) + diameter_ * glm::distance(n, known.n);
    if (excess <= geometry_.tie()) return {true, n, c};
    const Support top = query_(n, c);
    if (top.h > glm::dot(x, n) + geometry_.tie()) {
      return {false, n, geometry_.canonical(top.contact)};
    }
    known = {n, top.h};
    return {true, n, c};
  }

 private:
  /// A direction and its support value.
  struct Known {
    dvec3 n = dvec3(0.0);
    double h = std::numeric_limits<double>::infinity();
  };
  using Cube = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cube& cube) const {
      std::uint64_t hash = 0;
      for (const std::int64_t k : cube) hash = (hash ^ std::uint64_t(k)) * 0x9e3779b97f4a7c15;
      return std::size_t(hash ^ (hash >> 32U));
    }
  };

  /// Points that are the same but for rounding are in one, but for a few at the sides of two.
  static Cube cube_of(const dvec3& x) {
    const auto at = [](double t) { return std::int64_t(std::floor(std::ldexp(t, cube_level))); };
    return {at(x.x), at(x.y), at(x.z)};
  }
  /// Of sizes 2^-level, in the scene's frame.
  static constexpr int cube_level = 30;

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  double diameter_;
  std::unordered_map<Cube, Known, Hash> known_;
};

bool in_unit_square(const Contact& c) { return c.u >= 0 && c.u <= 1 && c.v >= 0 && c.v <= 1; }

}  // namespace

std::vector<SupportChange> support_changes(const ContactGeometry& geometry, SupportQuery& query,
                                           std::span<const CulledCell> cells) {
  using Place = std::tuple<int, double, double>;
  // Of the cells of one patch.
  std::map<Place, SeedSample> support_samples;
  std::set<std::pair<Place, Place>> sides;
  std::pair<int, int> patch(-1, -1);
  Lookout look(geometry, query);
  std::vector<SupportChange> changes;
  for (const CulledCell& cell : cells) {
    if (patch != std::pair(cell.instance, cell.patch)) {
      patch = {cell.instance, cell.patch};
      support_samples.clear();
      sides.clear();
    }
    if (cell.state != CellState::mixed ||
        geometry.is_repeated({cell.instance, SourceKind::face, cell.patch, 0, 0})) {
      continue;
    }
    const Interval u = cell.cell.u();
    const Interval v = cell.cell.v();
    const std::array<dvec2, 4> corners = {dvec2(u.lower, v.lower), dvec2(u.upper, v.lower),
                                          dvec2(u.upper, v.upper), dvec2(u.lower, v.upper)};
    for (const int sign : {1, -1}) {
      if (!(sign > 0 ? cell.signs.plus : cell.signs.minus)) continue;
      std::array<Contact, 4> contacts;
      std::array<Place, 4> places;
      std::array<const SeedSample*, 4> seen{};
      for (std::size_t k = 0; k < 4; ++k) {
        const dvec2& at = corners[k];
        contacts[k] = {cell.instance, SourceKind::face, cell.patch, at.x, at.y};
        places[k] = {sign, at.x, at.y};
        const auto [found, is_new] = support_samples.try_emplace(places[k]);
        if (is_new) found->second = look(contacts[k], sign);
        seen[k] = &found->second;
      }
      for (std::size_t a = 0; a < 4; ++a) {
        const std::size_t b = (a + 1) % 4;
        if (seen[a]->supports == seen[b]->supports || seen[a]->n == dvec3(0.0) ||
            seen[b]->n == dvec3(0.0) || !sides.insert(std::minmax(places[a], places[b])).second) {
          continue;
        }
        const std::size_t on = seen[a]->supports ? a : b;
        const std::size_t off = seen[a]->supports ? b : a;
        changes.push_back({contacts[on], contacts[off], sign, seen[off]->n, seen[off]->winner});
      }
    }
  }
  return changes;
}

std::optional<CommonSupport> separating_seed(const ContactSystem& system, SupportQuery& query,
                                             const SupportChange& change) {
  const ContactGeometry& geometry = system.geometry();
  const double least = merging_distance(geometry);
  Contact on = change.on;
  SupportChange beyond = change;
  // The parameter that is the same along the side, and the other.
  const auto fixed = change.on.u == change.off.u ? &Contact::u : &Contact::v;
  const auto free = change.on.u == change.off.u ? &Contact::v : &Contact::u;
  const auto [low, high] = std::minmax(change.on.*free, change.off.*free);
  for (int k = 0; k < side_halvings; ++k) {
    Contact middle = on;
    middle.*free = 0.5 * (on.*free + beyond.off.*free);
    const SeedSample there = looked(geometry, query, middle, change.sign);
    if (there.n == dvec3(0.0)) return std::nullopt;
    if (there.supports) {
      on = middle;
    } else {
      beyond.off = middle;
      beyond.n = there.n;
      beyond.winner = there.winner;
    }
    CommonSupport seed;
    seed.n = beyond.n;
    seed.add(geometry, beyond.off);
    seed.add(geometry, beyond.winner);
    if (glm::length(seed.d()) < least) return std::nullopt;
    const auto solved = [&] {
      return system.solve(seed, [&](const CommonSupport& now) {
        LinearEquation e;
        e.residual = now.contact[0].*fixed - on.*fixed;
        (fixed == &Contact::u ? e.parameter[0].x : e.parameter[0].y) = 1;
        return e;
      });
    };
    if (!solved()) continue;
    // The other contact may have moved into a neighbouring element.
    const std::optional<Contact> other = climbed(geometry, seed.contact[1], seed.n);
    if (!other) continue;
    if (!same_element(*other, seed.contact[1]) || !in_unit_square(seed.contact[1])) {
      seed.contact[1] = *other;
      seed.evaluate(geometry);
      if (!solved()) continue;
    }
    if (seed.contact[0].*free < low || seed.contact[0].*free > high ||
        !in_unit_square(seed.contact[1]) || glm::length(seed.d()) < least ||
        query(seed.n, seed.contact[0]).h > glm::dot(seed.jet[0].x, seed.n) + geometry.tie()) {
      continue;
    }
    return seed;
  }
  return std::nullopt;
}

}  // namespace taut
