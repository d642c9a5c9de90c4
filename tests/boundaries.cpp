#include "boundaries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact/contact_system.h"

namespace taut_test {

using namespace taut;  // NOLINT: its own

TrimStretch on_border(Side side, double from, double to) {
  TrimStretch stretch;
  stretch.side = side;
  stretch.from = from;
  stretch.to = to;
  return stretch;
}

std::vector<TrimStretch> whole_outline() {
  return {on_border(Side::v0, 0, 1), on_border(Side::u1, 0, 1), on_border(Side::v1, 1, 0),
          on_border(Side::u0, 1, 0)};
}

int outward_sign(const ContactGeometry& geometry, int patch, const dvec3& inside) {
  const ContactJet j = geometry.jet({0, SourceKind::face, patch, 0.5, 0.5});
  return glm::dot(glm::cross(j.dx[0], j.dx[1]), j.x - inside) > 0 ? 1 : -1;
}

KnownBoundary tetrahedron_boundary(const dvec3& shift) {
  const dvec3 corner = dvec3(5, 6, 7) + shift;
  KnownBoundary known{make_scene({{},
                                  {},
                                  {corner, corner + dvec3(1, 0, 0), corner + dvec3(0, 1, 0),
                                   corner + dvec3(0, 0, 1)}}),
                      {}};
  const ContactGeometry geometry(known.scene);
  const auto contact = [](int vertex) { return Contact{0, SourceKind::vertex, vertex, 0, 0}; };
  const int corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::array<std::array<int, 4>, 4> left{};  // of the way from one vertex to another
  for (int f = 0; f < 4; ++f) {
    HullFace& face = known.boundary.faces.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const int v = corners[f][k];
      face.contacts.push_back(contact(v));
      face.points.push_back(geometry.point(contact(v)));
      left[std::size_t(v)][std::size_t(corners[f][(k + 1) % 3])] = f;
    }
    face.n = unit(glm::cross(face.points[1] - face.points[0], face.points[2] - face.points[0]));
    face.offset = glm::dot(face.n, face.points[0]);
  }
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) {
      HullCurve& curve = known.boundary.curves.emplace_back();
      curve.faces = {left[std::size_t(a)][std::size_t(b)], left[std::size_t(b)][std::size_t(a)]};
      curve.points = {geometry.point(contact(a)), geometry.point(contact(b))};
    }
  }
  return known;
}

namespace {

constexpr int steps = 16;                        ///< of a quarter, less than 0.1 apart
constexpr double scroll_height = (1 - 0.5) / 3;  ///< of the scroll's normals

/// The ruling at an angle about the axis, in the terms of the quarter's patches.
Ruling ruling_at(const ContactSystem& system, const dmat3& rotation, int quarter, int step) {
  const double angle = (quarter + double(step) / steps) * std::numbers::pi / 2;
  const double radius = std::sqrt(1 - scroll_height * scroll_height);
  const dvec3 across = rotation * dvec3(-std::sin(angle), std::cos(angle), 0);
  CommonSupport s;
  s.n = rotation * dvec3(radius * std::cos(angle), radius * std::sin(angle), scroll_height);
  for (const int first : {0, 8}) {
    s.add(system.geometry(), {0, SourceKind::face, first + 2 * quarter, double(step) / steps, 0.9});
  }
  const bool found = system.solve(s, [&](const CommonSupport& now) {
    LinearEquation equation;
    equation.residual = glm::dot(now.n, across);
    equation.n = across;
    return equation;
  });
  if (!found) throw std::logic_error("no ruling at this angle");
  for (Contact& c : s.contact) {
    if (step == 0) c.u = 0;
    if (step == steps) c.u = 1;
  }
  s.evaluate(system.geometry());
  return s.ruling();
}

TrimStretch on_arc(int piece, int contact) {
  TrimStretch stretch;
  stretch.arc = 0;
  stretch.piece = piece;
  stretch.contact = contact;
  stretch.reversed = contact == 1;
  stretch.curve = contact;
  return stretch;
}

/// A stretch of a region as it is passed about the face.
struct FaceStretch {
  StretchPlace place;
  int curve;
  dvec3 begin, end;
};

std::vector<FaceStretch> stretches_of(const ContactGeometry& geometry, const HullBoundary& boundary,
                                      const HullFace& face) {
  std::vector<FaceStretch> found;
  for (std::size_t r = 0; r < face.regions.size(); ++r) {
    const PatchRegion& region = face.regions[r];
    const auto on_side_at = [&](Side side, double t) {
      const dvec2 uv = on_side(side, t);
      return geometry.point({region.instance, SourceKind::face, region.patch, uv.x, uv.y});
    };
    for (std::size_t l = 0; l < region.loops.size(); ++l) {
      for (std::size_t k = 0; k < region.loops[l].size(); ++k) {
        const TrimStretch& s = region.loops[l][k];
        dvec3 begin, end;
        if (s.arc >= 0) {
          const auto& rulings =
              boundary.arcs[std::size_t(s.arc)].pieces[std::size_t(s.piece)].rulings;
          begin = rulings.front().point[std::size_t(s.contact)];
          end = rulings.back().point[std::size_t(s.contact)];
        } else {
          begin = on_side_at(s.side, s.from);
          end = on_side_at(s.side, s.to);
        }
        if (s.reversed != (region.sign < 0)) std::swap(begin, end);
        found.push_back({{r, l, k}, s.curve, begin, end});
      }
    }
  }
  return found;
}

/// Puts the stretches about each patch in order, along its curves.
void list_outlines(const ContactGeometry& geometry, HullBoundary& boundary) {
  for (HullFace& face : boundary.faces) {
    std::vector<FaceStretch> left = stretches_of(geometry, boundary, face);
    for (const auto& loop : face.loops) {
      std::vector<StretchPlace>& outline = face.outlines.emplace_back();
      for (const auto& [own, sense] : loop) {
        const int curve = own;  // for the lambdas
        const std::vector<dvec3>& points = boundary.curves[std::size_t(curve)].points;
        dvec3 at = sense > 0 ? points.front() : points.back();
        const auto count = std::count_if(left.begin(), left.end(),
                                         [&](const auto& s) { return s.curve == curve; });
        for (auto k = count; k > 0; --k) {
          const auto gap = [&](const FaceStretch& s) {
            return s.curve == curve ? glm::distance(s.begin, at) : 1e9;
          };
          const auto next =
              std::min_element(left.begin(), left.end(),
                               [&](const auto& a, const auto& b) { return gap(a) < gap(b); });
          outline.push_back(next->place);
          at = next->end;
          left.erase(next);
        }
      }
    }
  }
}

PatchRegion region(int patch, std::vector<TrimStretch> loop) {
  return {0, patch, -1, {std::move(loop)}};
}

}  // namespace

/// Of the patches, four times two of each sphere, u turns about the axis, and v runs from the upper
/// pole to the equator and from there to the lower pole. The normal is along -(Su x Sv).
KnownBoundary two_spheres_boundary(const dmat3& rotation, const dvec3& shift) {
  KnownBoundary known{make_scene(mapped(two_spheres(1, 0.5, 3), rotation, shift)), {}};
  const ContactGeometry geometry(known.scene);
  const ContactSystem system(geometry);
  HullBoundary& boundary = known.boundary;
  SeparatingArc& arc = boundary.arcs.emplace_back();
  arc.closed = true;
  boundary.faces.resize(3);
  boundary.curves.resize(2);
  for (int quarter = 0; quarter < 4; ++quarter) {
    ArcPiece& piece = arc.pieces.emplace_back();
    for (int step = 0; step <= steps; ++step) {
      Ruling& ruling = piece.rulings.emplace_back(ruling_at(system, rotation, quarter, step));
      // Pieces share n and the points, to the last bit.
      const Ruling* same = step == 0 && quarter > 0
                               ? &arc.pieces[std::size_t(quarter) - 1].rulings.back()
                           : step == steps && quarter == 3 ? &arc.pieces[0].rulings.front()
                                                           : &ruling;
      ruling.n = same->n;
      ruling.point = same->point;
      for (std::size_t k = 0; k < 2; ++k) {
        std::vector<dvec3>& points = boundary.curves[k].points;
        if (step > 0 || quarter == 0) points.push_back(piece.rulings.back().point[k]);
      }
    }
    const double v0 = piece.rulings[0].contact[0].v, v1 = piece.rulings[0].contact[1].v;
    boundary.faces[0].regions.push_back(
        region(2 * quarter, {on_arc(quarter, 0), on_border(Side::u1, v0, 1),
                             on_border(Side::v1, 1, 0), on_border(Side::u0, 1, v0)}));
    boundary.faces[0].regions.push_back(
        region(2 * quarter + 1, {on_border(Side::v0, 0, 1), on_border(Side::u1, 0, 1),
                                 on_border(Side::v1, 1, 0), on_border(Side::u0, 1, 0)}));
    boundary.faces[1].regions.push_back(
        region(8 + 2 * quarter, {on_border(Side::v0, 0, 1), on_border(Side::u1, 0, v1),
                                 on_arc(quarter, 1), on_border(Side::u0, v1, 0)}));
  }
  for (int k = 0; k < 2; ++k) {
    HullCurve& curve = boundary.curves[std::size_t(k)];
    curve.kind = HullCurveKind::bitangent;
    curve.closed = true;
    curve.faces = k == 0 ? std::array<int, 2>{2, 0} : std::array<int, 2>{1, 2};
    HullFace& patch = boundary.faces[std::size_t(k)];
    patch.kind = FaceKind::patch;
    patch.source = k;
    patch.loops = {{{k, k == 0 ? -1 : 1}}};
  }
  HullFace& scroll = boundary.faces[2];
  scroll.kind = FaceKind::scroll;
  scroll.scroll = {0, 0, 4};
  scroll.scroll_curves = {std::vector<int>{0}, std::vector<int>{1}};
  list_outlines(geometry, boundary);
  return known;
}

namespace {

/// A circle about the z axis in a part at rest: its pieces by their quarter, counter-clockwise from
/// above.
struct Circle {
  std::array<int, 4> piece{};
  bool reversed = false;  ///< all of them run clockwise

  double at(double s) const { return reversed ? 1 - s : s; }
  Contact contact(std::size_t quarter, double s) const {
    return {0, SourceKind::edge, piece[quarter], at(s), 0};
  }
};

/// At this height, of the part mapped by x -> R x + shift.
Circle circle_at(const Part& part, double z, const dmat3& rotation, const dvec3& shift) {
  Circle circle;
  for (int k = 0; k < int(part.pieces().size()); ++k) {
    const auto at = [&](double t) {
      const dvec3 x = point(part.pieces()[std::size_t(k)].bezier, t);
      return glm::transpose(rotation) * (x - shift);
    };
    const dvec3 middle = at(0.5);
    if (std::abs(middle.z - z) > 1e-9) continue;
    const std::size_t quarter = middle.y > 0 ? (middle.x > 0 ? 0 : 1) : (middle.x < 0 ? 2 : 3);
    circle.piece[quarter] = k;
    circle.reversed = glm::cross(at(0), at(1)).z < 0;
  }
  return circle;
}

/// The facet that a circle bounds, from above or from below.
HullFace disc_facet(const ContactGeometry& geometry, const Circle& circle, const dvec3& n,
                    bool above) {
  HullFace facet;
  facet.n = n;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t quarter = above ? k : 3 - k;
    const double from = above ? 0 : 1;
    facet.contacts.push_back(circle.contact(quarter, from));
    facet.points.push_back(geometry.point(facet.contacts.back()));
    facet.sides.push_back({0, circle.piece[quarter], circle.at(from), circle.at(1 - from)});
  }
  facet.offset = glm::dot(n, facet.points[0]);
  return facet;
}

/// Along a circle, between the face within and that beyond.
HullCurve circle_curve(const KnownBoundary& known, const ContactGeometry& geometry,
                       const Circle& circle, HullCurveKind kind, std::array<int, 2> faces) {
  HullCurve curve;
  curve.kind = kind;
  curve.faces = faces;
  curve.closed = true;
  if (kind == HullCurveKind::edge) curve.source = known.scene.source(circle.contact(0, 0.5)).source;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    for (int k = quarter == 0 ? 0 : 1; k <= steps; ++k) {
      curve.points.push_back(geometry.point(circle.contact(quarter, double(k) / steps)));
    }
  }
  return curve;
}

/// Patches of a part, whole: those that `belongs` says of the point in their middle. `curve_of`
/// names the curve along a border's piece. `inside` is a point of the model inside.
template <class CurveOf, class Belongs>
HullFace whole_surface(const KnownBoundary& known, const ContactGeometry& geometry,
                       const dvec3& inside, CurveOf curve_of, Belongs belongs) {
  HullFace face;
  face.kind = FaceKind::patch;
  face.source = 0;
  const std::vector<Patch>& patches = known.scene.model().parts()[0].patches();
  for (int p = 0; p < int(patches.size()); ++p) {
    const dvec3 middle = geometry.point({0, SourceKind::face, p, 0.5, 0.5});
    if (!belongs(known.scene.frame().to_model(middle))) continue;
    PatchRegion own = region(p, whole_outline());
    own.sign = outward_sign(geometry, p, known.scene.frame().to_frame(inside));
    for (TrimStretch& stretch : own.loops[0]) {
      const Border& border = patches[std::size_t(p)].borders[std::size_t(stretch.side)];
      if (border.piece >= 0) stretch.curve = curve_of(border.piece);
    }
    face.regions.push_back(std::move(own));
  }
  return face;
}

bool any_patch(const dvec3&) { return true; }

/// The outer half of a torus, part of the shape or all of it, and the discs that touch it along its
/// rims, curves of this kind.
KnownBoundary outer_torus_boundary(const Shape& shape, double R, double r, HullCurveKind kind) {
  KnownBoundary known{make_scene(shape), {}};
  const ContactGeometry geometry(known.scene);
  const Part& part = known.scene.model().parts()[0];
  const std::array<Circle, 2> rims = {circle_at(part, r, dmat3(1.0), dvec3(0.0)),
                                      circle_at(part, -r, dmat3(1.0), dvec3(0.0))};
  const auto curve_of = [&](int piece) {
    for (int k = 0; k < 2; ++k) {
      const auto& pieces = rims[std::size_t(k)].piece;
      if (std::find(pieces.begin(), pieces.end(), piece) != pieces.end()) return k;
    }
    return -1;
  };
  const auto outer = [&](const dvec3& x) { return std::hypot(x.x, x.y) > R; };
  HullBoundary& boundary = known.boundary;
  boundary.faces = {whole_surface(known, geometry, dvec3(0.0), curve_of, outer),
                    disc_facet(geometry, rims[0], {0, 0, 1}, true),
                    disc_facet(geometry, rims[1], {0, 0, -1}, false)};
  boundary.faces[0].loops = {{{0, -1}}, {{1, 1}}};
  boundary.curves = {circle_curve(known, geometry, rims[0], kind, {1, 0}),
                     circle_curve(known, geometry, rims[1], kind, {0, 2})};
  list_outlines(geometry, boundary);
  return known;
}

}  // namespace

KnownBoundary cylinder_boundary(const dmat3& rotation, const dvec3& shift) {
  KnownBoundary known{make_scene(mapped(cylinder(1, 2), rotation, shift)), {}};
  const ContactGeometry geometry(known.scene);
  const Part& part = known.scene.model().parts()[0];
  HullBoundary& boundary = known.boundary;
  boundary.curves.resize(3);
  std::array<Circle, 2> circles;
  for (std::size_t k = 0; k < 2; ++k) {
    circles[k] = circle_at(part, k == 0 ? 0 : 2, rotation, shift);
    const dvec3 n = rotation * dvec3(0, 0, k == 0 ? -1 : 1);
    boundary.faces.push_back(disc_facet(geometry, circles[k], n, k == 1));
  }
  SeparatingArc& arc = boundary.arcs.emplace_back();
  arc.closed = true;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    ArcPiece& piece = arc.pieces.emplace_back();
    for (int step = 0; step <= steps; ++step) {
      Ruling& ruling = piece.rulings.emplace_back();
      for (std::size_t k = 0; k < 2; ++k) {
        ruling.contact[k] = circles[k].contact(quarter, double(step) / steps);
        ruling.point[k] = geometry.point(ruling.contact[k]);
      }
      const dvec3 x =
          glm::transpose(rotation) * (known.scene.frame().to_model(ruling.point[0]) - shift);
      ruling.n = rotation * unit({x.x, x.y, 0});
      if (step == 0 && quarter > 0) ruling.n = arc.pieces[quarter - 1].rulings.back().n;
      const std::array<std::size_t, 2> curves = {quarter < 2 ? 0U : 1U, 2U};
      for (std::size_t k = 0; k < 2; ++k) {
        std::vector<dvec3>& points = boundary.curves[curves[k]].points;
        if (step > 0 || points.empty()) points.push_back(ruling.point[k]);
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    boundary.curves[k].kind = HullCurveKind::edge;
    boundary.curves[k].faces = k < 2 ? std::array<int, 2>{2, 0} : std::array<int, 2>{1, 2};
    boundary.curves[k].source = known.scene.source(arc.pieces[0].rulings[5].contact[k / 2]).source;
  }
  boundary.curves[2].closed = true;
  HullFace& scroll = boundary.faces.emplace_back();
  scroll.kind = FaceKind::scroll;
  scroll.source = 0;
  scroll.scroll = {0, 0, 4};
  scroll.scroll_curves = {std::vector<int>{0, 1}, std::vector<int>{2}};
  return known;
}

KnownBoundary cap_boundary(double height, const dmat3& rotation, const dvec3& shift) {
  KnownBoundary known{make_scene(mapped(spherical_cap(height), rotation, shift)), {}};
  const ContactGeometry geometry(known.scene);
  const Circle rim = circle_at(known.scene.model().parts()[0], 1 - height, rotation, shift);
  const dvec3 inside = rotation * dvec3(0, 0, 1 - 0.5 * height) + shift;
  HullBoundary& boundary = known.boundary;
  boundary.faces = {whole_surface(
                        known, geometry, inside, [](int) { return 0; }, any_patch),
                    disc_facet(geometry, rim, rotation * dvec3(0, 0, -1), false)};
  boundary.faces[0].loops = {{{0, 1}}};
  boundary.curves = {circle_curve(known, geometry, rim, HullCurveKind::edge, {0, 1})};
  list_outlines(geometry, boundary);
  return known;
}

KnownBoundary half_torus_boundary(double R, double r) {
  const NurbsCurve profile = half_circle({R, 0, 0}, {r, 0, 0}, {0, 0, r});
  return outer_torus_boundary({{revolved(profile)}, {}, {}}, R, r, HullCurveKind::edge);
}

KnownBoundary torus_boundary(double R, double r) {
  return outer_torus_boundary(torus(R, r), R, r, HullCurveKind::bitangent);
}

namespace {

/// Between two facets, along a segment between vertices.
SeparatingArc crease_arc(const ContactGeometry& geometry, const HullBoundary& boundary,
                         std::array<int, 2> facets, const Contact& a, const Contact& b) {
  SeparatingArc arc;
  arc.facet = facets;
  const dvec3& from = boundary.faces[std::size_t(facets[0])].n;
  const dvec3& to = boundary.faces[std::size_t(facets[1])].n;
  Ruling ruling;
  ruling.contact = {a, b};
  // Contact 1 is to support to the left.
  const dvec3 left = glm::cross(from, to - from);
  if (glm::dot(left, geometry.point(b) - geometry.point(a)) < 0) ruling.contact = {b, a};
  ruling.point = {geometry.point(ruling.contact[0]), geometry.point(ruling.contact[1])};
  for (int k = 0; k <= steps; ++k) {
    ruling.n = unit((1 - double(k) / steps) * from + double(k) / steps * to);
    if (k == 0) arc.pieces.emplace_back();
    arc.pieces[0].rulings.push_back(ruling);
  }
  return arc;
}

/// A wall between a parabola, passed with it to the left, and its chord.
HullFace wall_facet(const ContactGeometry& geometry, const dvec3& n, const EdgeStretch& parabola) {
  HullFace wall;
  wall.n = n;
  for (const double t : {parabola.from, parabola.to}) {
    wall.contacts.push_back(
        geometry.canonical({parabola.instance, SourceKind::edge, parabola.piece, t, 0}));
    wall.points.push_back(geometry.point(wall.contacts.back()));
  }
  wall.sides = {parabola, {}};
  wall.offset = glm::dot(n, wall.points[0]);
  return wall;
}

}  // namespace

/// The outward normal is along -(Su x Sv), so that the walls lie to the left of the patch's outline
/// in the (u, v) plane, as seen from outside.
KnownBoundary paraboloid_boundary() {
  KnownBoundary known{make_scene(paraboloid()), {}};
  const ContactGeometry geometry(known.scene);
  const Patch& patch = known.scene.model().parts()[0].patches()[0];
  HullBoundary& boundary = known.boundary;
  boundary.faces.push_back(whole_surface(
      known, geometry, dvec3(0, 0, 1), [](int) { return -1; }, any_patch));
  boundary.faces[0].loops.emplace_back();
  HullFace lid;
  lid.n = dvec3(0, 0, 1);
  std::vector<TrimStretch>& outline = boundary.faces[0].regions[0].loops[0];
  for (int k = 0; k < 4; ++k) {
    TrimStretch& stretch = outline[std::size_t(k)];
    const Border& border = patch.borders[std::size_t(stretch.side)];
    EdgeStretch parabola{0, border.piece, stretch.from, stretch.to};
    if (border.piece_reversed) std::swap(parabola.from, parabola.to);
    const std::array<dvec3, 4> normals = {dvec3(0, -1, 0), {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    boundary.faces.push_back(wall_facet(geometry, normals[std::size_t(k)], parabola));
    const HullFace& wall = boundary.faces.back();
    lid.contacts.push_back(wall.contacts[0]);
    lid.points.push_back(wall.points[0]);
    HullCurve& curve = boundary.curves.emplace_back();
    curve.kind = HullCurveKind::edge;
    curve.faces = {1 + k, 0};
    curve.source = known.scene.source({0, SourceKind::edge, border.piece, 0.5, 0}).source;
    for (int i = 0; i <= steps; ++i) {
      const double t = Interval{parabola.from, parabola.to}.at(double(i) / steps);
      curve.points.push_back(geometry.point({0, SourceKind::edge, border.piece, t, 0}));
    }
    stretch.curve = 2 * k;
    boundary.faces[0].loops[0].insert(boundary.faces[0].loops[0].begin(), {2 * k, -1});
    HullCurve& chord = boundary.curves.emplace_back();
    chord.faces = {1 + k, 5};
    chord.points = {wall.points[1], wall.points[0]};
  }
  lid.offset = lid.points[0].z;
  boundary.faces.push_back(lid);
  for (int k = 0; k < 4; ++k) {
    const std::vector<Contact>& ends = boundary.faces[std::size_t(1 + k)].contacts;
    boundary.arcs.push_back(crease_arc(geometry, boundary, {1 + k, 5}, ends[0], ends[1]));
  }
  list_outlines(geometry, boundary);
  return known;
}

}  // namespace taut_test
