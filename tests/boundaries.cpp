#include "boundaries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "models.h"
#include "taut/core/tolerances.h"
#include "taut/hull/contact_system.h"

namespace taut_test {

using namespace taut;  // NOLINT: its own

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

constexpr int steps = 16;                 ///< of a quarter, less than 0.1 apart
constexpr double height = (1 - 0.5) / 3;  ///< of the scroll's normals

/// The ruling at an angle about the axis, in the terms of the quarter's patches.
Ruling ruling_at(const ContactSystem& system, const dmat3& rotation, int quarter, int step) {
  const double angle = (quarter + double(step) / steps) * std::numbers::pi / 2;
  const double radius = std::sqrt(1 - height * height);
  const dvec3 across = rotation * dvec3(-std::sin(angle), std::cos(angle), 0);
  CommonSupport s;
  s.n = rotation * dvec3(radius * std::cos(angle), radius * std::sin(angle), height);
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

TrimStretch on_border(Side side, double from, double to) {
  TrimStretch stretch;
  stretch.side = side;
  stretch.from = from;
  stretch.to = to;
  return stretch;
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
  return known;
}

KnownBoundary cylinder_boundary() {
  KnownBoundary known{make_scene(cylinder(1, 2)), {}};
  const ContactGeometry geometry(known.scene);
  const Part& part = known.scene.model().parts()[0];
  HullBoundary& boundary = known.boundary;
  boundary.faces.resize(3);
  boundary.curves.resize(3);
  // The pieces by their quarter and height, which run all the same way.
  std::array<std::array<int, 4>, 2> pieces{};
  for (int k = 0; k < int(part.pieces().size()); ++k) {
    const dvec3 middle = point(part.pieces()[std::size_t(k)].bezier, 0.5);
    const int quarter = middle.y > 0 ? (middle.x > 0 ? 0 : 1) : (middle.x < 0 ? 2 : 3);
    pieces[middle.z > 1 ? 1 : 0][std::size_t(quarter)] = k;
  }
  SeparatingArc& arc = boundary.arcs.emplace_back();
  arc.closed = true;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    ArcPiece& piece = arc.pieces.emplace_back();
    for (int step = 0; step <= steps; ++step) {
      Ruling& ruling = piece.rulings.emplace_back();
      for (std::size_t k = 0; k < 2; ++k) {
        ruling.contact[k] = {0, SourceKind::edge, pieces[k][quarter], double(step) / steps, 0};
        ruling.point[k] = geometry.point(ruling.contact[k]);
      }
      const dvec3 x = known.scene.frame().to_model(ruling.point[0]);
      ruling.n = unit({x.x, x.y, 0});
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
  for (std::size_t k = 0; k < 2; ++k) {
    HullFace& facet = boundary.faces[k];
    facet.n = dvec3(0, 0, k == 0 ? -1 : 1);
    for (const std::size_t quarter : {0, 1, 2}) {
      facet.contacts.push_back({0, SourceKind::edge, pieces[k][quarter], 0.5, 0});
      facet.points.push_back(geometry.point(facet.contacts.back()));
    }
    facet.offset = glm::dot(facet.n, facet.points[0]);
  }
  std::reverse(boundary.faces[0].contacts.begin(), boundary.faces[0].contacts.end());
  std::reverse(boundary.faces[0].points.begin(), boundary.faces[0].points.end());
  HullFace& scroll = boundary.faces[2];
  scroll.kind = FaceKind::scroll;
  scroll.source = 0;
  scroll.scroll = {0, 0, 4};
  scroll.scroll_curves = {std::vector<int>{0, 1}, std::vector<int>{2}};
  return known;
}

}  // namespace taut_test
