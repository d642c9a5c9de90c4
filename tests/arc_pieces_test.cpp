#include "taut/hull/solve/arc_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "freeform.h"
#include "models.h"
#include "taut/bounds/contact_exits.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

/// Contacts on the x axis and on a parallel to it, one opposite the other.
Ruling ruling_at(double x, double aside = 0) {
  Ruling r;
  r.n = {0, 0, 1};
  r.point = {dvec3(x, aside, 0), dvec3(x, 1 + aside, 0)};
  return r;
}

std::vector<double> places_of(const std::vector<Ruling>& rulings) {
  std::vector<double> places;
  places.reserve(rulings.size());
  for (const Ruling& r : rulings) places.push_back(r.point[0].x);
  return places;
}

TEST(ArcPieces, TurnsBackTheWayTheyCameAreLeftOut) {
  std::vector<Ruling> rulings;
  for (const double x : {0.0, 1.0, 2.5, 2.0, 3.0, 2.9, 4.0}) rulings.push_back(ruling_at(x));
  drop_turns(rulings, 1e-6);
  const std::vector<double> places = places_of(rulings);
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
  EXPECT_EQ(places.front(), 0);
  EXPECT_EQ(places.back(), 4);

  rulings = {ruling_at(0), ruling_at(1), ruling_at(0)};
  drop_turns(rulings, 1e-6);
  EXPECT_EQ(places_of(rulings), std::vector<double>({0, 0}));
}

/// As round a thin region, however few rulings there are.
TEST(ArcPieces, WaysAroundAreKept) {
  std::vector<Ruling> rulings = {ruling_at(0), ruling_at(1, 0.01), ruling_at(0, 0.02)};
  drop_turns(rulings, 1e-3);
  EXPECT_EQ(rulings.size(), 3U);
}

/// An arc may end in a ruling of its own, next to the last one that was found.
TEST(ArcPieces, SinglePlacesAreAppended) {
  std::vector<ArcPiece> pieces = {{{ruling_at(0), ruling_at(1)}}};
  append(pieces, {{{ruling_at(1), ruling_at(2)}}});
  append(pieces, {{{ruling_at(2)}}});
  append(pieces, {{{ruling_at(3)}}});
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_EQ(places_of(pieces.front().rulings), std::vector<double>({0, 1, 2, 3}));
}

/// Contacts that leave a corner of a patch and come back to it have not left it.
TEST(ArcPieces, ContactsThatComeBackToACornerStayThere) {
  const auto piece = [](double aside) {
    ArcPiece result = {{ruling_at(0), ruling_at(0, aside), ruling_at(0)}};
    for (Ruling& r : result.rulings) {
      for (Contact& c : r.contact) c = {0, SourceKind::face, 0, 1, 1};
    }
    result.rulings[1].contact[0].u = 0.5;
    return result;
  };
  std::vector<ArcPiece> pieces = {piece(1e-4), piece(1e-2)};
  tell_corners(pieces, 1e-7, 1e-3, 1e-8);
  EXPECT_EQ(pieces[0].rulings[1].contact[0].u, 1);
  EXPECT_EQ(pieces[0].rulings[1].point[0], dvec3(0.0));
  EXPECT_EQ(pieces[1].rulings[1].contact[0].u, 0.5);
}

/// Unless they are higher beside it.
TEST(ArcPieces, ContactsThatComeBackFromAboveACornerHaveLeftIt) {
  for (const double high : {0.5e-8, 2e-8}) {
    std::vector<ArcPiece> pieces = {{{ruling_at(0), ruling_at(0, 1e-4), ruling_at(0)}}};
    for (Ruling& r : pieces[0].rulings) {
      for (Contact& c : r.contact) c = {0, SourceKind::face, 0, 1, 1};
    }
    pieces[0].rulings[1].point[0].z = high;
    tell_corners(pieces, 1e-7, 1e-3, 1e-8);
    EXPECT_EQ(pieces[0].rulings[1].point[0].z, high > 1e-8 ? high : 0) << high;
  }
}

/// Next to the end of an edge that leaves its tangent slowly all is as high as its vertex: contacts
/// there are the vertex's, and what goes on along the edge begins at its end.
TEST(ArcPieces, ContactsNextToAVertexThatIsAsHighAreItsOwn) {
  Shape shape;
  shape.curves.push_back({3,
                          {0, 0, 0, 0, 1, 1, 1, 1},
                          {{0, 0, 0, 1}, {1. / 3, 0, 0, 1}, {2. / 3, 0, 0, 1}, {1, 0, -1, 1}}});
  shape.curves.push_back(segment({0, 1, 0}, {1, 1, -1}));
  const Scene scene = make_scene(shape);
  const ContactGeometry geometry(scene);
  const auto ruling = [&](double u) {
    Ruling r;
    r.n = {0, 0, 1};
    r.contact = {Contact{0, SourceKind::edge, 0, u, 0}, Contact{0, SourceKind::edge, 1, 0, 0}};
    for (const std::size_t i : {0u, 1u}) r.point[i] = geometry.point(r.contact[i]);
    return r;
  };
  std::vector<ArcPiece> pieces = {{{ruling(0), ruling(2e-6), ruling(1e-6)}},
                                  {{ruling(1e-6), ruling(0.5)}}};
  tell_vertices(geometry, pieces, 1e-4);
  for (const Ruling& r : pieces.front().rulings) {
    EXPECT_EQ(r.contact[0].kind, SourceKind::vertex);
    EXPECT_EQ(r.point[0], geometry.point(ruling(0).contact[0]));
  }
  EXPECT_EQ(pieces.back().rulings.front().point[0], pieces.front().rulings.back().point[0]);
  // What ends beside the vertex, and nothing goes on from there, has left it.
  std::vector<ArcPiece> ends = {{{ruling(0), ruling(1e-6)}}};
  tell_vertices(geometry, ends, 1e-4);
  EXPECT_EQ(ends[0].rulings[1].contact[0].kind, SourceKind::edge);
}

/// Of an edge, to within what may be nothing.
TEST(ArcPieces, ContactsThatComeBackToAPlaceOfAnEdgeStayThere) {
  const auto piece = [](double back) {
    ArcPiece result = {{ruling_at(0), ruling_at(0, 1e-4), ruling_at(0, back)}};
    for (Ruling& r : result.rulings) {
      for (Contact& c : r.contact) c = {0, SourceKind::edge, 0, 0.25 + r.point[0].y, 0};
    }
    return result;
  };
  std::vector<ArcPiece> pieces = {piece(1e-8), piece(1e-5)};
  pieces[1].rulings.front() = pieces[0].rulings.back();
  tell_corners(pieces, 1e-7, 1e-3, 1e-8);
  for (const Ruling& r : pieces[0].rulings) EXPECT_EQ(r.contact[0].u, 0.25);
  // What goes on does so from there.
  EXPECT_EQ(pieces[1].rulings[0].contact[0].u, 0.25);
  EXPECT_EQ(pieces[1].rulings[1].contact[0].u, 0.25 + 1e-4);
  // The last piece ends where the arc does.
  std::vector<ArcPiece> last = {piece(1e-8)};
  tell_corners(last, 1e-7, 1e-3, 1e-8);
  EXPECT_EQ(last[0].rulings[1].contact[0].u, 0.25 + 1e-4);
  // At an end of it they may be a vertex's.
  std::vector<ArcPiece> at_end = {piece(0)};
  for (Ruling& r : at_end[0].rulings) r.contact[0].u -= 0.25;
  tell_corners(at_end, 1e-7, 1e-3, 1e-8);
  EXPECT_NEAR(at_end[0].rulings[1].contact[0].u, 1e-4, 1e-15);
}

/// Along a join a contact is told as one of the patch into which its region extends: to the left of
/// contact 1, to the right of contact 0, seen from outside.
TEST(ArcPieces, AlongJoinsContactsAreOfTheirRegionsPatch) {
  const dmat3 turn = skew_rotation();
  const Scene scene = make_scene(mapped(dented_sheet(0.02), turn));
  const ContactGeometry geometry(scene);
  const Contact patch = {0, SourceKind::face, 0, 0, 0};
  for (const Side side : all_sides) {
    if (geometry.patch(patch).borders[std::size_t(side)].kind != BorderKind::smooth) continue;
    for (const std::size_t own : {0u, 1u}) {
      for (const bool ahead : {false, true}) {
        ArcPiece piece;
        for (const double t : {0.2, 0.5, 0.8}) {
          Ruling r;
          r.n = turn * dvec3(0, 0, 1);
          r.contact[own] = on_side(0, 0, side, ahead ? t : 1 - t);
          r.contact[1 - own] = {0, SourceKind::face, 100, 0.5, 0.5};
          for (const std::size_t i : {0u, 1u}) r.point[i] = geometry.point(r.contact[i]);
          piece.rulings.push_back(r);
        }
        const dvec3 way = piece.rulings[2].point[own] - piece.rulings[0].point[own];
        std::vector<ArcPiece> pieces = {piece};
        tell_along_joins(geometry, pieces, 0);
        Contact middle = pieces[0].rulings[1].contact[own];
        middle.u = middle.v = 0.5;
        const dvec3 inward = geometry.point(middle) - piece.rulings[1].point[own];
        const bool is_left = glm::dot(glm::cross(piece.rulings[1].n, way), inward) > 0;
        EXPECT_EQ(is_left, own == 1) << int(side) << own << ahead;
        EXPECT_EQ(pieces[0].rulings[1].contact[1 - own].element, 100);
      }
    }
  }
}

/// Along an edge a contact is the edge's where it has been before, whichever patch told it since.
TEST(ArcPieces, AlongAnEdgeContactsAreTheEdges) {
  const Scene scene = make_scene(mapped(box(3, 2, 1), skew_rotation()));
  const ContactGeometry geometry(scene);
  for (const Side side : all_sides) {
    const auto piece_to = [&](double from, double to, bool is_edge) {
      ArcPiece piece;
      for (const double t : {from, to}) {
        Ruling r;
        const Contact on = on_side(0, 0, side, t);
        r.contact = {is_edge ? geometry.canonical(on) : on,
                     Contact{0, SourceKind::face, 5, 0.5, 0.5}};
        for (const std::size_t i : {0u, 1u}) r.point[i] = geometry.point(r.contact[i]);
        piece.rulings.push_back(r);
      }
      return piece;
    };
    std::vector<ArcPiece> pieces = {piece_to(0.2, 0.4, true), piece_to(0.4, 0.5, false),
                                    piece_to(0.5, 0.8, true)};
    tell_along_edges(geometry, pieces);
    ASSERT_EQ(pieces.size(), 1U);
    for (const Ruling& r : pieces[0].rulings) EXPECT_EQ(r.contact[0].kind, SourceKind::edge);
    // What is the patch's all along, or leaves the edge, is the patch's.
    pieces = {piece_to(0.2, 0.4, false)};
    tell_along_edges(geometry, pieces);
    EXPECT_EQ(pieces[0].rulings[0].contact[0].kind, SourceKind::face);
    pieces = {piece_to(0.2, 0.4, true), piece_to(0.4, 0.5, false)};
    pieces[1].rulings[1].contact[0].u = pieces[1].rulings[1].contact[0].v = 0.5;
    tell_along_edges(geometry, pieces);
    EXPECT_EQ(pieces.size(), 2U);
  }
}

/// What leaves a place at right angles, as n does where a contact has come to rest, does not turn.
TEST(ArcPieces, CornersAreNoTurns) {
  std::vector<Ruling> rulings = {ruling_at(0), ruling_at(1e-4), ruling_at(1e-4)};
  rulings[2].n = unit(dvec3(0.1, 0, 1));
  drop_turns(rulings, 1e-3);
  EXPECT_EQ(rulings.size(), 3U);
}

}  // namespace
}  // namespace taut
