#include "taut/hull/decide/cell_contacts.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

/// Steps of a search for where two contacts exchange, by the planes of the points on either side.
constexpr int exchange_steps = 12;

}  // namespace

std::array<long long, 3> rounded_direction(const dvec3& d) {
  const dvec3 n = unit(d);
  // Cells are wider than 2^-30, and rounding is less than 2^-50.
  const auto rounded = [](double x) { return std::llround(std::ldexp(x, 40)); };
  return {rounded(n.x), rounded(n.y), rounded(n.z)};
}

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
  const int first = winner(k, from);
  const int last = winner(k, to);
  std::vector<int> all = {first};
  if (cell(k).kind == MapCellKind::in_line) {
    const int step = last < first ? -1 : 1;
    for (int c = first; c != last; c += step) all.push_back(c + step);
  } else if (last != first) {
    const int between = cell(k).kind == MapCellKind::node ? third(k, from, to) : first;
    if (between != first) all.push_back(between);
    all.push_back(last);
  }
  return all;
}

/// Of three contacts the one that supports where those at the ends of a side are as high as each
/// other; the one at its beginning where none does.
int CellContacts::third(int k, const dvec3& from, const dvec3& to) {
  std::array<dvec3, 2> d = {unit(from), unit(to)};
  const std::array<int, 2> contact = {winner(k, from), winner(k, to)};
  for (int step = 0; step < exchange_steps; ++step) {
    const dvec3 apart = point(d[0]) - point(d[1]);
    const std::array<double, 2> lead = {glm::dot(apart, d[0]), -glm::dot(apart, d[1])};
    if (!(lead[0] > 0 && lead[1] > 0)) break;
    const dvec3 n = unit(lead[1] * d[0] + lead[0] * d[1]);
    const int there = winner(k, n);
    if (there != contact[0] && there != contact[1]) return there;
    const double above = glm::dot(point(n) - point(d[0]), n);
    if (above <= map_.resolution) break;
    d[there == contact[0] ? 0 : 1] = n;
  }
  return contact[0];
}

/// The point that supports in a direction, which is asked for from several cells.
const dvec3& CellContacts::point(const dvec3& d) {
  const auto [known, is_new] = points_.try_emplace(rounded_direction(d), dvec3(0.0));
  if (is_new) {
    const Support s = query_(unit(d), hint_);
    hint_ = s.contact;
    known->second = s.point;
  }
  return known->second;
}

}  // namespace taut
