#include "taut/hull/solve/free_ends.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "taut/bounds/contact_exits.h"
#include "taut/hull/solve/free_end_places.h"
#include "taut/hull/solve/free_end_roots.h"

namespace taut {
namespace {

using Kind = FreeEnd::Kind;

/// Elements over a border that is no farther are tried too.
constexpr double beside_border = 0.1;

/// Roots about a contact: the one nearest to a free end that is known roughly.
class Polish {
 public:
  Polish(const ContactGeometry& geometry, const FreeEnd& near)
      : geometry_(geometry), near_(near), x_(geometry.point(near.contact)) {}

  std::optional<FreeEnd> run() {
    const Contact& c = near_.contact;
    if (near_.kind == Kind::face && c.kind == SourceKind::face) face();
    if (near_.kind == Kind::edge && c.kind == SourceKind::edge) edge();
    if (near_.kind == Kind::border && c.kind == SourceKind::edge) border();
    if (near_.kind == Kind::end && c.kind == SourceKind::vertex) end();
    if (near_.kind == Kind::corner && c.kind == SourceKind::vertex) {
      for (const FreeEnd& found : corner_ends(geometry_, c)) keep(found);
    }
    return best_;
  }

 private:
  void face() {
    for (const Contact& c : contacts_around()) {
      if (const auto root = cusp_near(geometry_, c, reach)) keep(cusp_end(geometry_, *root));
      for (const Side side : all_sides) {
        if (distance_from(c, side) > beside_border) continue;
        if (geometry_.patch(c).borders[std::size_t(side)].kind == BorderKind::smooth)
          on_border(c, side);
      }
    }
  }
  void edge() {
    for (const Contact& c : contacts_around()) {
      const auto twist = [&](double t) { return twist_at(geometry_, c, t); };
      const std::optional<double> t = root_near(twist, c.u, reach, noise_step(geometry_, c));
      for (const double sign : {1.0, -1.0}) {
        if (t) keep(edge_end(geometry_, c, *t, sign));
        for (int end = 0; end < 2; ++end) {
          if (std::abs(c.u - end) <= beside_border) keep(piece_end(geometry_, c, end, sign));
        }
      }
    }
  }
  void border() {
    for (const Contact& c : contacts_around()) {
      for (const ContactGeometry::PieceSide& side : geometry_.sides(c)) {
        const dvec2 uv = on_side(side.side, side.reversed ? 1 - c.u : c.u);
        on_border({side.instance < 0 ? c.instance : side.instance, SourceKind::face, side.patch,
                   uv.x, uv.y},
                  side.side);
      }
    }
  }
  void end() {
    for (const Contact& c : piece_ends(geometry_, near_.contact)) {
      for (const double sign : {1.0, -1.0}) keep(piece_end(geometry_, c, int(c.u), sign));
    }
  }
  void on_border(const Contact& c, Side side) {
    const std::optional<double> t =
        root_near(parabolic_along(geometry_, c, side), along_v(side) ? c.v : c.u, reach,
                  noise_step(geometry_, c));
    if (t) keep(border_end(geometry_, c, side, *t));
  }

  /// The contact, and those on neighbouring elements over smooth joins nearby.
  std::vector<Contact> contacts_around() const;
  void keep(const std::optional<FreeEnd>& end);

  /// In parameters.
  static constexpr double reach = 0.5;
  static constexpr std::size_t most_around = 8;

  const ContactGeometry& geometry_;
  FreeEnd near_;
  dvec3 x_;
  std::optional<FreeEnd> best_;
  double least_ = free_end_reach;
};

std::vector<Contact> Polish::contacts_around() const {
  std::vector<Contact> found = {near_.contact};
  const auto add = [&](const std::optional<Contact>& c) {
    if (!c || c->kind != near_.contact.kind) return;
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const Contact& other) { return same_element(*c, other); });
    if (!known && found.size() < most_around) found.push_back(*c);
  };
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Contact c = found[k];
    const bool face = c.kind == SourceKind::face;
    for (int i = 0; i < (face ? 4 : 2); ++i) {
      const Side side = all_sides[std::size_t(i)];
      const double distance = face ? distance_from(c, side) : std::abs(c.u - i);
      if (distance > beside_border) continue;
      add(beyond(geometry_, c, {face ? ContactExit::Kind::side : ContactExit::Kind::end, i}));
    }
  }
  return found;
}

void Polish::keep(const std::optional<FreeEnd>& end) {
  if (!end) return;
  const double distance =
      std::max(glm::distance(geometry_.point(end->contact), x_), glm::distance(end->n, near_.n));
  if (distance > least_) return;
  least_ = distance;
  best_ = end;
}

}  // namespace

std::optional<FreeEnd> polished(const ContactGeometry& geometry, const FreeEnd& near) {
  return Polish(geometry, near).run();
}

}  // namespace taut
