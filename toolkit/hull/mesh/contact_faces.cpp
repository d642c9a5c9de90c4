#include "taut/hull/mesh/contact_faces.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace taut {
namespace {

bool lies_on(const dvec2& uv, Side side) {
  return (along_v(side) ? uv.x : uv.y) == (at_upper_end(side) ? 1 : 0);
}

}  // namespace

void touch(TouchedFaces& faces, const TouchedFace& face) {
  if (face.face < 0) return;
  const auto place =
      std::lower_bound(faces.begin(), faces.end(), face.face,
                       [](const TouchedFace& a, int number) { return a.face < number; });
  if (place != faces.end() && place->face == face.face) {
    place->sides |= face.sides;
  } else {
    faces.insert(place, face);
  }
}

ContactFaces::ContactFaces(const ContactGeometry& geometry, const HullBoundary& boundary)
    : geometry_(geometry), boundary_(boundary) {
  add_arcs();
  add_regions();
  add_facets();
  std::stable_sort(regions_.begin(), regions_.end(), [](const Region& a, const Region& b) {
    return std::tie(a.instance, a.patch) < std::tie(b.instance, b.patch);
  });
  std::stable_sort(stretches_.begin(), stretches_.end(), [](const Stretch& a, const Stretch& b) {
    return std::tie(a.instance, a.piece) < std::tie(b.instance, b.piece);
  });
  std::stable_sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.instance, a.vertex) < std::tie(b.instance, b.vertex);
  });
}

void ContactFaces::add_corner(const Contact& contact, const TouchedFace& face) {
  if (face.face < 0 || contact.instance < 0) return;
  const Contact c = geometry_.canonical(contact);
  if (c.kind == SourceKind::vertex) corners_.push_back({c.instance, c.element, face});
}

void ContactFaces::add_arcs() {
  for (const SeparatingArc& arc : boundary_.arcs) {
    scrolls_.emplace_back(arc.pieces.size(), -1);
    trims_.emplace_back(arc.pieces.size(), std::array<int, 2>{-1, -1});
  }
  for (int f = 0; f < int(boundary_.faces.size()); ++f) {
    const ArcRange& range = boundary_.faces[std::size_t(f)].scroll;
    if (range.arc < 0) continue;
    const SeparatingArc& arc = boundary_.arcs[std::size_t(range.arc)];
    for (int k = 0; k < range.count; ++k) {
      const std::size_t piece = std::size_t(range.first + k) % arc.pieces.size();
      scrolls_[std::size_t(range.arc)][piece] = f;
      const std::vector<Ruling>& rulings = arc.pieces[piece].rulings;
      for (std::size_t i = 0; i < 2; ++i) {
        const TouchedFace own = {f, 1U << i};
        add_corner(rulings.front().contact[i], own);
        add_corner(rulings.back().contact[i], own);
        const Contact& c = rulings.front().contact[i];
        if (c.kind != SourceKind::edge) continue;
        const auto [low, high] = std::minmax_element(
            rulings.begin(), rulings.end(),
            [i](const Ruling& a, const Ruling& b) { return a.contact[i].u < b.contact[i].u; });
        stretches_.push_back({c.instance, c.element, low->contact[i].u, high->contact[i].u, own});
      }
    }
  }
}

void ContactFaces::add_stretch(const EdgeStretch& stretch, int face) {
  const auto [low, high] = std::minmax(stretch.from, stretch.to);
  stretches_.push_back({stretch.instance, stretch.piece, low, high, {face, 0}});
}

void ContactFaces::add_facets() {
  for (int f = 0; f < int(boundary_.faces.size()); ++f) {
    const HullFace& face = boundary_.faces[std::size_t(f)];
    for (const Contact& c : face.contacts) add_corner(c, {f, 0});
    for (const EdgeStretch& side : face.sides) {
      if (side.piece >= 0) add_stretch(side, f);
    }
  }
}

void ContactFaces::add_border(const PatchRegion& region, int face, const TrimStretch& stretch) {
  const auto contact = [&](double t) {
    const dvec2 uv = on_side(stretch.side, t);
    return Contact{region.instance, SourceKind::face, region.patch, uv.x, uv.y};
  };
  std::vector<int> faces = {face};
  if (stretch.curve >= 0) {
    for (const int f : boundary_.curves[std::size_t(stretch.curve)].faces) faces.push_back(f);
  }
  const Patch& patch = geometry_.part(contact(0)).patches()[std::size_t(region.patch)];
  const Border& border = patch.borders[std::size_t(stretch.side)];
  for (const int f : faces) {
    if (f < 0) continue;
    add_corner(contact(stretch.from), {f, 0});
    add_corner(contact(stretch.to), {f, 0});
    if (border.piece < 0) continue;
    const auto along = [&](double t) { return border.piece_reversed ? 1 - t : t; };
    add_stretch({region.instance, border.piece, along(stretch.from), along(stretch.to)}, f);
  }
}

void ContactFaces::add_regions() {
  const ContactSystem system(geometry_);
  for (int f = 0; f < int(boundary_.faces.size()); ++f) {
    for (const PatchRegion& region : boundary_.faces[std::size_t(f)].regions) {
      geometry_.check_stop();
      regions_.push_back({region.instance, region.patch, f, outline_of(system, boundary_, region)});
      for (const std::vector<TrimStretch>& loop : region.loops) {
        for (const TrimStretch& stretch : loop) {
          if (stretch.arc < 0) {
            add_border(region, f, stretch);
          } else {
            trims_[std::size_t(stretch.arc)][std::size_t(stretch.piece)]
                  [std::size_t(stretch.contact)] = f;
          }
        }
      }
    }
  }
}

TouchedFaces ContactFaces::beside(int arc, int piece, int contact) const {
  TouchedFaces faces;
  touch(faces, {scroll(arc, piece), 1U << unsigned(contact)});
  touch(faces, {patch(arc, piece, contact), 0});
  return faces;
}

void ContactFaces::touch_regions(int instance, int patch, const dvec2& uv, bool inside_only,
                                 TouchedFaces& faces) const {
  const auto place = std::pair(instance, patch);
  const auto before = [](const Region& r) { return std::pair(r.instance, r.patch); };
  auto region = std::lower_bound(regions_.begin(), regions_.end(), place,
                                 [&](const Region& r, const auto& p) { return before(r) < p; });
  int best = -1;
  double deepest = -std::numeric_limits<double>::infinity();
  for (; region != regions_.end() && before(*region) == place; ++region) {
    const auto next = region + 1;
    const bool alone = best < 0 && (next == regions_.end() || before(*next) != place);
    const double d = alone && !inside_only ? 0 : depth_in(region->outline, uv);
    if (!(d > deepest)) continue;
    deepest = d;
    best = region->face;
  }
  if (best >= 0 && (deepest >= 0 || !inside_only)) touch(faces, {best, 0});
}

TouchedFaces ContactFaces::on_patch(const Contact& c) const {
  TouchedFaces faces;
  const std::vector<Patch>& patches = geometry_.part(c).patches();
  const dvec2 uv(c.u, c.v);
  for (const Side side : all_sides) {
    const Border& border = patches[std::size_t(c.element)].borders[std::size_t(side)];
    if (!lies_on(uv, side) || border.kind != BorderKind::smooth) continue;
    const double t = along_v(side) ? c.v : c.u;
    if (border.piece >= 0) {
      touch_stretches(c.instance, border.piece, border.piece_reversed ? 1 - t : t, faces);
    }
    if (border.neighbor < 0) continue;
    touch_regions(c.instance, border.neighbor,
                  on_side(border.neighbor_side, border.reversed ? 1 - t : t), true, faces);
  }
  touch_regions(c.instance, c.element, uv, !faces.empty(), faces);
  return faces;
}

void ContactFaces::touch_stretches(int instance, int piece, double t, TouchedFaces& faces) const {
  const auto place = std::pair(instance, piece);
  const auto before = [](const Stretch& s) { return std::pair(s.instance, s.piece); };
  auto s = std::lower_bound(stretches_.begin(), stretches_.end(), place,
                            [&](const Stretch& a, const auto& p) { return before(a) < p; });
  for (; s != stretches_.end() && before(*s) == place; ++s) {
    if (s->from <= t && t <= s->to) touch(faces, s->face);
  }
}

TouchedFaces ContactFaces::touched(const Contact& contact) const {
  if (contact.instance < 0) return {};
  const Contact c = geometry_.canonical(contact);
  if (c.kind == SourceKind::face) return on_patch(c);
  TouchedFaces faces;
  const auto place = std::pair(c.instance, c.element);
  if (c.kind == SourceKind::edge) {
    touch_stretches(c.instance, c.element, c.u, faces);
  } else {
    auto s = std::lower_bound(
        corners_.begin(), corners_.end(), place,
        [](const Corner& a, const auto& p) { return std::pair(a.instance, a.vertex) < p; });
    for (; s != corners_.end() && std::pair(s->instance, s->vertex) == place; ++s) {
      touch(faces, s->face);
    }
  }
  return faces;
}

/// How deep inside a region of the patch the place is, negative outside of all.
double ContactFaces::deepest(int instance, int patch, const dvec2& uv) const {
  const auto place = std::pair(instance, patch);
  auto region = std::lower_bound(
      regions_.begin(), regions_.end(), place,
      [](const Region& r, const auto& p) { return std::pair(r.instance, r.patch) < p; });
  double result = -std::numeric_limits<double>::infinity();
  for (; region != regions_.end() && std::pair(region->instance, region->patch) == place;
       ++region) {
    result = std::max(result, depth_in(region->outline, uv));
  }
  return result;
}

/// The ends of stretches are only as exact as curves are. Curves that run along a side of a patch
/// may be told as ones of the patch.
bool ContactFaces::is_near_stretch(const Contact& c) const {
  if (std::any_of(stretches_.begin(), stretches_.end(), [&](const Stretch& s) {
        return s.instance == c.instance && s.piece == c.element && s.from - outline_slack <= c.u &&
               c.u <= s.to + outline_slack;
      })) {
    return true;
  }
  const std::vector<ContactGeometry::PieceSide>& sides = geometry_.sides(geometry_.first(c));
  return std::any_of(sides.begin(), sides.end(), [&](const ContactGeometry::PieceSide& s) {
    const int instance = s.instance < 0 ? c.instance : s.instance;
    const double t = s.reversed ? 1 - c.u : c.u;
    return deepest(instance, s.patch, on_side(s.side, t)) >= -outline_slack;
  });
}

bool ContactFaces::surely_uncovered(const Contact& contact) const {
  const Contact c = geometry_.canonical(contact);
  if (c.kind != SourceKind::face) {
    return touched(c).empty() && (c.kind != SourceKind::edge || !is_near_stretch(c));
  }
  const dvec2 uv(c.u, c.v);
  double depth = deepest(c.instance, c.element, uv);
  for (const Side side : all_sides) {
    const Border& border =
        geometry_.part(c).patches()[std::size_t(c.element)].borders[std::size_t(side)];
    if (!lies_on(uv, side) || border.kind != BorderKind::smooth || border.neighbor < 0) continue;
    const double t = along_v(side) ? c.v : c.u;
    depth = std::max(depth, deepest(c.instance, border.neighbor,
                                    on_side(border.neighbor_side, border.reversed ? 1 - t : t)));
  }
  return depth < -outline_slack;
}

}  // namespace taut
