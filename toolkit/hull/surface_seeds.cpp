#include "taut/hull/surface_seeds.h"

#include <map>
#include <tuple>

#include "taut/hull/arc_tracer.h"
#include "taut/hull/contact_exits.h"
#include "taut/hull/facet_contacts.h"

namespace taut {
namespace {

/// Halvings that lead near enough to the curve for Newton's method, at first and where it fails.
constexpr int first_halvings = 3;
constexpr int halving_limit = 36;

class SeedFinder {
 public:
  SeedFinder(const ContactSystem& system, SupportQuery& query)
      : system_(system), geometry_(system.geometry()), query_(query) {}

  std::vector<CommonSupport> run(const std::vector<CulledCell>& cells) {
    for (const CulledCell& c : cells) {
      if (c.state != CellState::mixed) continue;
      const Interval u = c.cell.u();
      const Interval v = c.cell.v();
      const std::array<dvec2, 4> corners = {dvec2(u.lower, v.lower), dvec2(u.upper, v.lower),
                                            dvec2(u.upper, v.upper), dvec2(u.lower, v.upper)};
      for (const int sign : {1, -1}) {
        if (!(sign > 0 ? c.signs.plus : c.signs.minus)) continue;
        for (std::size_t k = 0; k < 4; ++k) {
          cross({c.instance, c.patch, sign}, corners[k], corners[(k + 1) % 4]);
        }
      }
    }
    return std::move(seeds_);
  }

 private:
  struct Sheet {
    int instance, patch, sign;
  };
  struct Sighting {
    bool supports = false;
    dvec3 n = dvec3(0.0);
    Contact contact;  ///< that supports in n
  };
  using Place = std::tuple<int, int, int, double, double>;

  static Contact contact(const Sheet& s, const dvec2& at) {
    return {s.instance, SourceKind::face, s.patch, at.x, at.y};
  }
  Sighting looked(const Sheet& s, const dvec2& at);
  const Sighting& seen(const Sheet& s, const dvec2& at);
  void cross(const Sheet& s, const dvec2& a, const dvec2& b);

  const ContactSystem& system_;
  const ContactGeometry& geometry_;
  SupportQuery& query_;
  std::map<Place, Sighting> sightings_;
  std::map<std::pair<Place, Place>, bool> crossed_;
  std::vector<CommonSupport> seeds_;
};

SeedFinder::Sighting SeedFinder::looked(const Sheet& s, const dvec2& at) {
  const Contact c = contact(s, at);
  const dvec3 n = double(s.sign) * unit_normal(geometry_, c);
  if (n == dvec3(0.0)) return {};
  const Support top = query_(n, c);
  const bool supports = top.h <= glm::dot(geometry_.point(c), n) + support_tie;
  return {supports, n, supports ? c : geometry_.canonical(top.contact)};
}

const SeedFinder::Sighting& SeedFinder::seen(const Sheet& s, const dvec2& at) {
  const auto [found, is_new] =
      sightings_.try_emplace({s.instance, s.patch, s.sign, at.x, at.y}, Sighting());
  if (is_new) found->second = looked(s, at);
  return found->second;
}

/// Finds a seed between two places of which one supports.
void SeedFinder::cross(const Sheet& s, const dvec2& a, const dvec2& b) {
  const Sighting at_a = seen(s, a);
  const Sighting at_b = seen(s, b);
  if (at_a.supports == at_b.supports || at_a.n == dvec3(0.0) || at_b.n == dvec3(0.0)) return;
  const Place pa{s.instance, s.patch, s.sign, a.x, a.y};
  const Place pb{s.instance, s.patch, s.sign, b.x, b.y};
  if (!crossed_.try_emplace(std::minmax(pa, pb), true).second) return;
  dvec2 on = at_a.supports ? a : b;
  dvec2 off = at_a.supports ? b : a;
  Sighting beyond = at_a.supports ? at_b : at_a;
  const int fixed = a.x == b.x ? 0 : 1;  // the parameter that is the same along the side
  for (int k = 0; k < halving_limit; ++k) {
    const dvec2 middle = 0.5 * (on + off);
    const Sighting there = looked(s, middle);
    if (there.n == dvec3(0.0)) return;
    if (there.supports) {
      on = middle;
    } else {
      off = middle;
      beyond = there;
    }
    if (k < first_halvings) continue;
    CommonSupport seed;
    seed.n = beyond.n;
    seed.add(geometry_, contact(s, off));
    seed.add(geometry_, beyond.contact);
    if (glm::length(seed.d()) < merge_distance) return;  // about a free end
    const bool solved = system_.solve(seed, [&](const CommonSupport& now) {
      LinearEquation e;
      e.residual = (fixed == 0 ? now.contact[0].u : now.contact[0].v) - on[fixed];
      e.parameter[0][fixed] = 1;
      return e;
    });
    if (!solved) continue;
    const double along = fixed == 0 ? seed.contact[0].v : seed.contact[0].u;
    const auto [low, high] = std::minmax(a[1 - fixed], b[1 - fixed]);
    if (along < low || along > high) continue;
    const std::optional<Contact> c = climbed(geometry_, seed.contact[1], seed.n);
    if (!c || glm::distance(geometry_.point(*c), seed.jet[1].x) > same_contact) continue;
    seed.contact[1] = *c;
    seed.evaluate(geometry_);
    if (glm::length(seed.d()) < merge_distance ||
        query_(seed.n, seed.contact[0]).h > glm::dot(seed.jet[0].x, seed.n) + support_tie) {
      continue;
    }
    seeds_.push_back(seed);
    return;
  }
}

}  // namespace

std::vector<CommonSupport> surface_seeds(const ContactSystem& system, SupportQuery& query,
                                         const std::vector<CulledCell>& cells) {
  return SeedFinder(system, query).run(cells);
}

}  // namespace taut
