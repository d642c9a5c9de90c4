#include "taut/hull/mesh/contact_faces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "boundaries.h"
#include "models.h"
#include "taut/bounds/support_query.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models

bool touches(const TouchedFaces& faces, int face) {
  return std::any_of(faces.begin(), faces.end(),
                     [&](const TouchedFace& f) { return f.face == face; });
}

int first_of(const HullBoundary& boundary, FaceKind kind) {
  const auto found = std::find_if(boundary.faces.begin(), boundary.faces.end(),
                                  [&](const HullFace& f) { return f.kind == kind; });
  return int(found - boundary.faces.begin());
}

TEST(ContactFaces, AreInOrderAndNoneTwice) {
  TouchedFaces faces;
  for (const int face : {3, 1, 3, 2, 1}) touch(faces, {face, 1U << (face - 1)});
  ASSERT_EQ(faces.size(), 3U);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(faces[std::size_t(k)].face, k + 1);
}

/// Contacts of directions that support on spheres touch their patches.
TEST(ContactFaces, OfPointsOfPatches) {
  const KnownBoundary known = two_spheres_boundary();
  const ContactGeometry geometry(known.scene);
  const ContactFaces faces(geometry, known.boundary);
  SupportQuery query(known.scene);
  for (const double sign : {1.0, -1.0}) {
    const Contact contact = query(unit(dvec3(0.1, 0.2, sign))).contact;
    const TouchedFaces touched = faces.touched(contact);
    ASSERT_EQ(touched.size(), 1U);
    const HullFace& face = known.boundary.faces[std::size_t(touched[0].face)];
    EXPECT_EQ(face.kind, FaceKind::patch);
    EXPECT_EQ(face.source, known.scene.source(contact).source);
    EXPECT_FALSE(faces.surely_uncovered(contact));
  }
}

/// The inner side of a torus touches nothing.
TEST(ContactFaces, WhatIsOnNoFaceIsAstray) {
  const KnownBoundary known = torus_boundary(2, 0.5);
  const ContactGeometry geometry(known.scene);
  const ContactFaces faces(geometry, known.boundary);
  const Model& model = known.scene.model();
  int on = 0, astray = 0;
  for (int patch = 0; patch < int(model.parts()[0].patches().size()); ++patch) {
    const Contact middle{0, SourceKind::face, patch, 0.5, 0.5};
    const dvec3 x = known.scene.point(middle);
    const bool outer = std::hypot(x.x, x.y) > 2;
    EXPECT_EQ(faces.surely_uncovered(middle), !outer) << patch;
    EXPECT_EQ(touches(faces.touched(middle), first_of(known.boundary, FaceKind::patch)), outer);
    ++(outer ? on : astray);
  }
  EXPECT_EQ(on, astray);
}

/// Both circles of a cylinder bound the scroll and a facet each.
TEST(ContactFaces, OfEdgesAreThoseOnBothSides) {
  const KnownBoundary known = cylinder_boundary();
  const ContactGeometry geometry(known.scene);
  const ContactFaces faces(geometry, known.boundary);
  SupportQuery query(known.scene);
  for (const double z : {1.0, -1.0}) {
    const Contact contact = query(unit(dvec3(0.6, 0.5, z))).contact;
    ASSERT_EQ(known.scene.source(contact).kind, SourceKind::edge);
    const TouchedFaces touched = faces.touched(contact);
    ASSERT_EQ(touched.size(), 2U);
    EXPECT_TRUE(touches(touched, first_of(known.boundary, FaceKind::scroll)));
  }
}

}  // namespace
}  // namespace taut
