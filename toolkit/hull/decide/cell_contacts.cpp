#include "taut/hull/decide/cell_contacts.h"

#include <algorithm>
#include <cmath>

#include "taut/hull/decide/direction_cube.h"

namespace taut {
namespace {

/// Steps of a search for where two contacts exchange, by the planes of the points on either side.
constexpr int exchange_steps = 12;

}  // namespace

bool CellContacts::is_closed(int k) const {
  const MapCell& c = cell(k);
  return c.kind == MapCellKind::region || c.kind == MapCellKind::arc ||
         c.kind == MapCellKind::in_line ||
         (c.kind == MapCellKind::node && c.contacts.size() == std::size_t(c.apart));
}

bool CellContacts::has_more(int k) const {
  const MapCell& c = cell(k);
  return c.kind == MapCellKind::arc && c.contacts.size() > std::size_t(c.apart);
}

bool CellContacts::is_of_facet(int k) const {
  const MapCell& c = cell(k);
  return c.kind == MapCellKind::facet ||
         (c.kind == MapCellKind::node && c.contacts.size() > std::size_t(c.apart));
}

int CellContacts::winner(int k, const dvec3& d) {
  const bool is_one = cell(k).contacts.size() < 2 || cell(k).kind == MapCellKind::region;
  return is_one ? 0 : int(cell(k).told_contact_of(d, point(d)));
}

std::vector<int> CellContacts::passed(int k, const dvec3& from, const dvec3& to) {
  if (cell(k).kind != MapCellKind::in_line) return passed_by_height(k, from, to, -infinity);
  const int last = winner(k, to);
  std::vector<int> all = {winner(k, from)};
  while (all.back() != last) all.push_back(all.back() + (last < all.back() ? -1 : 1));
  return all;
}

std::vector<int> CellContacts::passed_by_height(int k, const dvec3& from, const dvec3& to,
                                                double least) {
  const int first = winner(k, from);
  const int last = winner(k, to);
  if (first == last) return {first};
  const std::optional<dvec3> between =
      has_line(k) ? where_another_supports(k, from, to, least) : std::nullopt;
  if (!between) return {first, last};
  if (cell(k).kind == MapCellKind::node) return {first, winner(k, *between), last};
  std::vector<int> all = passed_by_height(k, from, *between, least);
  const std::vector<int> rest = passed_by_height(k, *between, to, least);
  all.insert(all.end(), rest.begin() + 1, rest.end());
  return all;
}

/// Between two directions, about where the contacts that support in these are as high as each
/// other; none where no other one is above them by more than so much.
std::optional<dvec3> CellContacts::where_another_supports(int k, const dvec3& from, const dvec3& to,
                                                          double least) {
  std::array<dvec3, 2> d = {unit(from), unit(to)};
  const std::array<int, 2> contact = {winner(k, from), winner(k, to)};
  for (int step = 0; step < exchange_steps; ++step) {
    const dvec3 apart = point(d[0]) - point(d[1]);
    const std::array<double, 2> lead = {glm::dot(apart, d[0]), -glm::dot(apart, d[1])};
    if (!(lead[0] > 0 && lead[1] > 0)) break;
    const dvec3 n = unit(lead[1] * d[0] + lead[0] * d[1]);
    const int there = winner(k, n);
    const double above = glm::dot(point(n) - point(d[0]), n);
    const bool is_other = there != contact[0] && there != contact[1];
    if (is_other && above > least) return n;
    if (is_other || above <= map_.resolution) break;
    d[there == contact[0] ? 0 : 1] = n;
  }
  return std::nullopt;
}

/// The point that supports in a direction, which is asked for from several cells.
const dvec3& CellContacts::point(const dvec3& d) {
  const auto [known, is_new] = points_.try_emplace(place_on_cube(d), dvec3(0.0));
  if (is_new) {
    const Support s = query_(unit(d), hint_);
    hint_ = s.contact;
    known->second = s.point;
  }
  return known->second;
}

}  // namespace taut
