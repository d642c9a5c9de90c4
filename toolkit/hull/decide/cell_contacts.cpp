#include "taut/hull/decide/cell_contacts.h"

#include <algorithm>
#include <cmath>

namespace taut {

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
    all.push_back(last);
  }
  return all;
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
