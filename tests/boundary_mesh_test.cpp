#include "taut/hull/mesh/boundary_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "boundaries.h"
#include "boundary_checks.h"
#include "hull_checks.h"
#include "taut/hull/contact/contact_system.h"
#include "taut/hull/polyhedral/polyhedral_hull.h"
#include "taut/hull/sample/sampled_hull.h"

namespace taut {
namespace {

using namespace taut_test;  // NOLINT: models and checks

/// A closed convex surface, of these patches, which is the hull.
std::shared_ptr<HullBoundary> whole_surface(const ContactGeometry& geometry, const dvec3& center,
                                            int patches) {
  auto boundary = std::make_shared<HullBoundary>();
  HullFace face;
  face.kind = FaceKind::patch;
  face.source = 0;
  for (int p = 0; p < patches; ++p) {
    face.regions.push_back({0, p, outward_sign(geometry, p, center), {whole_outline()}});
  }
  boundary->faces.push_back(face);
  return boundary;
}

/// The hull of two spheres of radii r > s on the z axis, the second d above the first, by the
/// separating curve n . z = (r - s) / d. Face 0 lies on the first, 1 on the second, 2 between.
class TwoSpheres {
 public:
  TwoSpheres(const Scene& scene, double r, double s, double d)
      : geometry_(scene), system_(geometry_), height_((r - s) / d) {
    centers_ = {scene.frame().to_frame({0, 0, 0}), scene.frame().to_frame({0, 0, d})};
    make_arc();
    make_faces();
  }

  std::shared_ptr<HullBoundary> boundary = std::make_shared<HullBoundary>();
  const ContactGeometry& geometry() const { return geometry_; }

 private:
  static constexpr int quarters = 4;
  static constexpr int rulings = 3;  // of a quarter: few, so that many samples lie between two

  dvec3 direction(double phi) const {
    const double c = std::sqrt(1 - height_ * height_);
    return {c * std::cos(phi), c * std::sin(phi), height_};
  }

  /// The patch of one of the spheres, revolved from the x axis, that the direction's contact lies
  /// in, u growing with the angle and v downwards.
  int patch_at(int sphere, int quarter, bool upper) const {
    return 2 * quarters * sphere + 2 * quarter + (upper ? 0 : 1);
  }

  void make_arc() {
    SeparatingArc arc;
    arc.closed = true;
    for (int q = 0; q < quarters; ++q) {
      ArcPiece piece;
      for (int k = 0; k < rulings; ++k) {
        const double phi = pi / 2 * (q + double(k) / (rulings - 1));
        Ruling start;
        start.n = direction(phi);
        for (int i = 0; i < 2; ++i) {
          const double u = double(k) / (rulings - 1);
          start.contact[std::size_t(i)] = {0, SourceKind::face, patch_at(i, q, height_ > 0), u,
                                           1 - std::abs(height_)};
        }
        CommonSupport support(geometry_, start);
        const dvec3 across(-std::sin(phi), std::cos(phi), 0);
        const bool solved = system_.solve(support, [&](const CommonSupport& at) {
          LinearEquation e;
          e.residual = glm::dot(at.n, across);
          e.n = across;
          return e;
        });
        EXPECT_TRUE(solved);
        for (Contact& c : support.contact) c.u = std::clamp(c.u, 0.0, 1.0);
        piece.rulings.push_back(support.ruling());
      }
      arc.pieces.push_back(piece);
    }
    boundary->arcs.push_back(arc);
  }

  void make_faces() {
    for (int i = 0; i < 2; ++i) {
      HullCurve curve;
      curve.kind = HullCurveKind::bitangent;
      curve.faces = i == 0 ? std::array{2, 0} : std::array{1, 2};
      curve.closed = true;
      for (const ArcPiece& piece : boundary->arcs[0].pieces) {
        for (const Ruling& r : piece.rulings) curve.points.push_back(r.point[std::size_t(i)]);
      }
      boundary->curves.push_back(curve);

      HullFace patch;
      patch.kind = FaceKind::patch;
      patch.source = i;
      patch.loops = {{{i, i == 0 ? -1 : 1}}};
      for (int q = 0; q < quarters; ++q) patch.regions.push_back(trimmed(i, q));
      for (int q = 0; q < quarters && i == 0; ++q) {
        const int p = patch_at(0, q, false);
        patch.regions.push_back({0, p, outward_sign(geometry_, p, centers_[0]), {whole_outline()}});
      }
      boundary->faces.push_back(patch);
    }
    HullFace scroll;
    scroll.kind = FaceKind::scroll;
    scroll.scroll = {0, 0, quarters};
    scroll.scroll_curves = {std::vector{0}, std::vector{1}};
    boundary->faces.push_back(scroll);
  }

  PatchRegion trimmed(int sphere, int quarter) const {
    const int p = patch_at(sphere, quarter, true);
    const std::vector<Ruling>& piece = boundary->arcs[0].pieces[std::size_t(quarter)].rulings;
    TrimStretch arc;
    arc.arc = 0;
    arc.piece = quarter;
    arc.contact = sphere;
    arc.reversed = sphere == 1;
    arc.curve = sphere;
    const double begin = piece.front().contact[std::size_t(sphere)].v;
    const double end = piece.back().contact[std::size_t(sphere)].v;
    std::vector<TrimStretch> loop = whole_outline();
    if (sphere == 1) {
      loop[1].to = end;
      loop[2] = arc;
      loop[3].from = begin;
    } else {
      loop[0] = arc;
      loop[1].from = end;
      loop[3].to = begin;
    }
    return {0, p, outward_sign(geometry_, p, centers_[std::size_t(sphere)]), {loop}};
  }

  ContactGeometry geometry_;
  ContactSystem system_;
  double height_;
  std::array<dvec3, 2> centers_;
};

/// Kinds and sources of mesh faces are those of their hull faces, and feature edges where these
/// meet.
void expect_labelled(const Hull& hull) {
  const std::vector<HullFace>& faces = hull.boundary->faces;
  for (const auto f : hull.mesh.faces()) {
    const auto& data = hull.mesh.data(f);
    ASSERT_GE(data.hull_face, 0);
    ASSERT_LT(data.hull_face, int(faces.size()));
    EXPECT_EQ(data.kind, faces[std::size_t(data.hull_face)].kind);
    EXPECT_EQ(data.source, faces[std::size_t(data.hull_face)].source);
  }
  for (const auto e : hull.mesh.edges()) {
    const auto face_at = [&](unsigned side) {
      return hull.mesh.data(hull.mesh.face_handle(hull.mesh.halfedge_handle(e, side))).hull_face;
    };
    EXPECT_EQ(hull.mesh.data(e).feature, face_at(0) != face_at(1));
  }
}

/// Areas of the mesh by hull face.
std::map<int, double> areas(const Hull& hull) {
  std::map<int, double> result;
  for (const auto f : hull.mesh.faces()) {
    std::vector<dvec3> p;
    for (const auto v : hull.mesh.fv_range(f)) p.push_back(position(hull.mesh, v));
    double& area = result[hull.mesh.data(f).hull_face];
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
      area += 0.5 * glm::length(glm::cross(p[k] - p[0], p[k + 1] - p[0]));
    }
  }
  return result;
}

TEST(BoundaryMesh, TwoSpheres) {
  const Scene scene = make_scene(two_spheres(1, 0.5, 2));
  const TwoSpheres spheres(scene, 1, 0.5, 2);
  const double sine = 0.25;
  const double cosine = std::sqrt(1 - sine * sine);
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(tolerance);
    const Hull hull = boundary_mesh(scene, spheres.geometry(), spheres.boundary,
                                    {.relative = tolerance, .threads = 1, .progress = {}});
    expect_certified(scene, hull, tolerance, {6.250460383704693, 17.86780821729195});
    expect_labelled(hull);
    const std::map<int, double> found = areas(hull);
    EXPECT_EQ(found.size(), 3U);
    const double d = hull.distance_bound;
    // The chords cut off less than their sagitta along each circle, 2 pi r cos.
    const double slack = 20 * d;
    EXPECT_NEAR(found.at(0), 2 * pi * (1 + sine), slack);
    EXPECT_NEAR(found.at(1), 2 * pi * 0.25 * (1 - sine), slack);
    EXPECT_NEAR(found.at(2), pi * cosine * 1.5 * 2 * cosine, slack);
    // Chords and rulings are edges: no face of the mesh crosses them.
    int crossing = 0;
    for (const auto f : hull.mesh.faces()) {
      const bool between = hull.mesh.data(f).kind == FaceKind::scroll;
      for (const auto v : hull.mesh.fv_range(f)) {
        const double z = position(hull.mesh, v).z;
        const bool on_curve = std::min(std::abs(z - sine), std::abs(z - 2 - 0.5 * sine)) < 1e-9;
        const int source = hull.mesh.data(v).source;
        if (between ? !on_curve : source != hull.mesh.data(f).source) ++crossing;
      }
    }
    EXPECT_EQ(crossing, 0);
    double shortest = 1;
    for (const auto e : hull.mesh.edges()) {
      shortest = std::min(shortest, hull.mesh.calc_edge_length(e));
    }
    EXPECT_GT(shortest, tolerance * scene.diagonal() / 32);
    // No more faces than the sampled hull has, but for those along the curves.
    const Hull sampled = sampled_hull(scene, {.relative = tolerance, .threads = 1, .progress = {}});
    EXPECT_LT(double(hull.mesh.n_faces()), 1.4 * double(sampled.mesh.n_faces()));
  }
}

/// Closed forms of a boundary by hand, the areas per face of it.
struct KnownHull {
  const char* name;
  KnownBoundary known;
  Known measures;
  std::vector<double> areas;
};

std::vector<KnownHull> hulls_with_curved_facets() {
  const dmat3 R = skew_rotation();
  const dvec3 shift(0.3, -1, 2);
  std::vector<KnownHull> hulls;
  for (const bool turned : {false, true}) {
    const dmat3 pose = turned ? R : dmat3(1.0);
    const dvec3 place = turned ? shift : dvec3(0.0);
    hulls.push_back({"cylinder",
                     cylinder_boundary(pose, place),
                     {6.283185307179586, 18.84955592153876},
                     {pi, pi, 4 * pi}});
    hulls.push_back({"cap",
                     cap_boundary(0.6, pose, place),
                     {0.9047786842338605, 6.408849013323178},
                     {2 * pi * 0.6, pi * 0.6 * 1.4}});
  }
  const double discs = 2 * pi * 4;
  for (const bool whole : {false, true}) {
    hulls.push_back({whole ? "torus" : "half torus",
                     whole ? torus_boundary(2, 0.5) : half_torus_boundary(2, 0.5),
                     {18.02477159050215, 48.01354268448686},
                     {48.01354268448686 - discs, discs / 2, discs / 2}});
  }
  const double wall = 4.0 / 3;
  hulls.push_back({"paraboloid",
                   paraboloid_boundary(),
                   {16.0 / 3, 16.7795900563457},
                   {16.7795900563457 - 4 - 4 * wall, wall, wall, wall, wall, 4}});
  return hulls;
}

/// Corners of the mesh's faces on facets lie in the facets' planes.
double off_their_planes(const Scene& scene, const Hull& hull) {
  double largest = 0;
  for (const auto f : hull.mesh.faces()) {
    const HullFace& face = hull.boundary->faces[std::size_t(hull.mesh.data(f).hull_face)];
    if (face.kind != FaceKind::facet) continue;
    for (const auto v : hull.mesh.fv_range(f)) {
      const dvec3 x = scene.frame().to_frame(position(hull.mesh, v));
      largest = std::max(largest, std::abs(glm::dot(face.n, x) - face.offset));
    }
  }
  return largest;
}

TEST(BoundaryMesh, FacetsWithCurvedSides) {
  for (const KnownHull& hull_of : hulls_with_curved_facets()) {
    const Scene& scene = hull_of.known.scene;
    const ContactGeometry geometry(scene);
    const auto boundary = std::make_shared<const HullBoundary>(hull_of.known.boundary);
    // Finer ones take long to check where patches are meshed.
    const bool patches = boundary->count(FaceKind::patch) > 0;
    for (const double tolerance : {1e-3, patches ? 2e-4 : 1e-5}) {
      SCOPED_TRACE(testing::Message() << hull_of.name << " at " << tolerance);
      std::vector<Sample> uncovered_samples;
      const Hull hull =
          boundary_mesh(scene, geometry, boundary,
                        {.relative = tolerance, .threads = 1, .progress = {}}, &uncovered_samples);
      expect_certified(scene, hull, tolerance, hull_of.measures, 300);
      expect_labelled(hull);
      EXPECT_TRUE(uncovered_samples.empty());
      EXPECT_LT(off_their_planes(scene, hull), 1e-14);
      const std::map<int, double> found = areas(hull);
      EXPECT_EQ(found.size(), hull_of.areas.size());
      for (const auto& [face, area] : found) {
        // What the chords of its outline cut off.
        const double slack = 10 * hull.distance_bound * scene.diagonal();
        EXPECT_NEAR(area, hull_of.areas.at(std::size_t(face)), slack) << face;
      }
    }
  }
}

/// About as many as chords whose sagitta is nearly half the tolerance, however sharp the rim is.
TEST(BoundaryMesh, NoMoreCornersOnRimsThanTheyNeed) {
  for (const double height : {0.6, 0.3, 0.1}) {
    SCOPED_TRACE(height);
    const KnownBoundary known = cap_boundary(height);
    const Hull hull = boundary_mesh(known.scene, ContactGeometry(known.scene),
                                    std::make_shared<const HullBoundary>(known.boundary),
                                    {.relative = 1e-4, .threads = 1, .progress = {}});
    int corners = 0;
    for (const auto v : hull.mesh.vertices()) {
      corners += std::abs(hull.mesh.point(v)[2] - (1 - height)) < 1e-12 ? 1 : 0;
    }
    const double radius = std::sqrt(height * (2 - height));
    const double sagitta = 0.45 * 1e-4 * known.scene.diagonal();
    EXPECT_LT(corners, 1.1 * pi / std::acos(1 - sagitta / radius));
  }
}

TEST(BoundaryMesh, WholeEllipsoid) {
  const Scene scene = make_scene(ellipsoid(3, 2, 1));
  const ContactGeometry geometry(scene);
  const auto boundary = whole_surface(geometry, dvec3(0.0), 8);
  const Hull hull =
      boundary_mesh(scene, geometry, boundary, {.relative = 1e-3, .threads = 1, .progress = {}});
  expect_certified(scene, hull, 1e-3, {25.13274122871835, 48.88214630258206});
  expect_labelled(hull);
  EXPECT_EQ(areas(hull).size(), 1U);
}

TEST(BoundaryMesh, NothingKnown) {
  const Scene scene = make_scene(two_spheres(1, 0.5, 2));
  const ContactGeometry geometry(scene);
  auto boundary = std::make_shared<HullBoundary>();
  boundary->unresolved.push_back({dvec3(0, 0, 1), "nothing was tried"});
  const HullOptions options = {.relative = 1e-3, .threads = 1, .progress = {}};
  const Hull hull = boundary_mesh(scene, geometry, boundary, options);
  expect_certified(scene, hull, 1e-3, {6.250460383704693, 17.86780821729195});
  const Hull sampled = sampled_hull(scene, options);
  ASSERT_EQ(hull.mesh.n_faces(), sampled.mesh.n_faces());
  for (const auto f : hull.mesh.faces()) {
    EXPECT_EQ(hull.mesh.data(f).hull_face, sampled.mesh.data(f).hull_face);
    EXPECT_EQ(hull.mesh.data(f).kind, sampled.mesh.data(f).kind);
  }
}

TEST(BoundaryMesh, APatchIsMissing) {
  const Scene scene = make_scene(two_spheres(1, 0.5, 2));
  const TwoSpheres spheres(scene, 1, 0.5, 2);
  auto boundary = std::make_shared<HullBoundary>(*spheres.boundary);
  boundary->faces[1].regions.clear();
  boundary->unresolved.push_back({dvec3(0, 0, 1), "a patch is missing"});
  const Hull hull = boundary_mesh(scene, spheres.geometry(), boundary,
                                  {.relative = 1e-3, .threads = 1, .progress = {}});
  expect_certified(scene, hull, 1e-3, {6.250460383704693, 17.86780821729195});
  for (const auto f : hull.mesh.faces()) {
    const auto& data = hull.mesh.data(f);
    ASSERT_GE(data.hull_face, 0);
    const bool guessed = data.hull_face >= int(boundary->faces.size());
    if (guessed || data.kind != FaceKind::patch) continue;
    EXPECT_EQ(data.hull_face, 0);
    EXPECT_EQ(data.source, 0);
  }
  double known = 0;
  for (const auto& [face, area] : areas(hull)) known += face < 3 ? area : 0;
  EXPECT_NEAR(known, 17.86780821729195 - 2 * pi * 0.25 * 0.75, 0.1);
}

TEST(BoundaryMesh, SameBitsForAnyNumberOfThreads) {
  const Scene scene = make_scene(two_spheres(1, 0.5, 2));
  const TwoSpheres spheres(scene, 1, 0.5, 2);
  const auto mesh_of = [&](int threads) {
    return boundary_mesh(scene, spheres.geometry(), spheres.boundary,
                         {.relative = 1e-3, .threads = threads, .progress = {}});
  };
  const Hull one = mesh_of(1);
  const Hull more = mesh_of(3);
  EXPECT_EQ(one.distance_bound, more.distance_bound);
  EXPECT_EQ(polygons(one.mesh).points, polygons(more.mesh).points);
  EXPECT_EQ(polygons(one.mesh).polygons, polygons(more.mesh).polygons);
  for (const auto f : one.mesh.faces()) {
    EXPECT_EQ(one.mesh.data(f).hull_face, more.mesh.data(f).hull_face);
  }
}

TEST(BoundaryMesh, Polyhedra) {
  const std::vector<dvec3> tetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0.1, 0.2, 3}};
  std::vector<dvec3> cube;
  for (int k = 0; k < 27; ++k) cube.emplace_back(k % 3, k / 3 % 3, k / 9);
  for (const bool turned : {false, true}) {
    for (const auto& [points, faces] : {std::pair(tetrahedron, 4), std::pair(cube, 6)}) {
      const Shape at_rest{{}, {}, points};
      const Shape shape = turned ? mapped(at_rest, skew_rotation(), {0.3, 7, -2}) : at_rest;
      const Model model = make_model(shape);
      const Hull exact = polyhedral_hull(model);
      ASSERT_NE(exact.boundary, nullptr);
      EXPECT_EQ(exact.boundary->count(FaceKind::facet), faces);
      EXPECT_EQ(int(exact.boundary->curves.size()), faces == 4 ? 6 : 12);
      expect_labelled(exact);
      const Scene scene(model);
      EXPECT_EQ(exact.boundary->frame.center, scene.frame().center);
      EXPECT_EQ(exact.boundary->frame.scale, scene.frame().scale);
      const BoundaryFacts facts = boundary_facts(scene, exact, 300);
      EXPECT_TRUE(facts.sound()) << facts;
      const ContactGeometry geometry(scene);
      const Hull hull = boundary_mesh(scene, geometry, exact.boundary,
                                      {.relative = 1e-3, .threads = 1, .progress = {}});
      expect_certified(scene, hull, 1e-3, {});
      expect_labelled(hull);
      EXPECT_EQ(int(areas(hull).size()), faces);
      EXPECT_EQ(int(hull.mesh.n_vertices()), faces == 4 ? 4 : 8);
    }
  }
}

TEST(BoundaryChecks, TwoSpheresAreSound) {
  const Scene scene = make_scene(two_spheres(1, 0.5, 2));
  const TwoSpheres spheres(scene, 1, 0.5, 2);
  Hull hull;
  hull.boundary = spheres.boundary;
  const BoundaryFacts facts = boundary_facts(scene, hull, 300);
  EXPECT_TRUE(facts.sound()) << facts;
  EXPECT_LT(5 * facts.undecided, facts.points) << facts;
}

TEST(BoundaryChecks, WholeEllipsoidIsSound) {
  const Scene scene = make_scene(ellipsoid(3, 2, 1));
  const ContactGeometry geometry(scene);
  Hull hull;
  hull.boundary = whole_surface(geometry, dvec3(0.0), 8);
  const BoundaryFacts facts = boundary_facts(scene, hull, 300);
  EXPECT_TRUE(facts.sound()) << facts;
}

TEST(BoundaryChecks, FacetsWithCurvedSidesAreSound) {
  for (const KnownHull& hull_of : hulls_with_curved_facets()) {
    Hull hull;
    hull.boundary = std::make_shared<const HullBoundary>(hull_of.known.boundary);
    const BoundaryFacts facts = boundary_facts(hull_of.known.scene, hull, 300);
    EXPECT_TRUE(facts.sound()) << hull_of.name << ": " << facts;
  }
}

TEST(BoundaryChecks, FindWhatIsWrongWithSides) {
  const auto facts_of = [](KnownBoundary known, auto change) {
    change(known.boundary);
    Hull hull;
    hull.boundary = std::make_shared<const HullBoundary>(std::move(known.boundary));
    return boundary_facts(known.scene, hull, 10);
  };
  const auto none = [](HullBoundary&) {};
  EXPECT_EQ(facts_of(cap_boundary(0.6), none).open_facets, 0);
  EXPECT_EQ(
      facts_of(cap_boundary(0.6), [](HullBoundary& b) { b.faces[1].sides.pop_back(); }).open_facets,
      1);
  EXPECT_EQ(facts_of(cap_boundary(0.6),
                     [](HullBoundary& b) {
                       b.curves[0].faces = {0, 0};
                     })
                .open_facets,
            1);
  EXPECT_EQ(facts_of(paraboloid_boundary(), [](HullBoundary& b) { b.faces[2].sides.clear(); })
                .open_facets,
            1);
  EXPECT_EQ(facts_of(paraboloid_boundary(), [](HullBoundary& b) { b.curves[1].faces[1] = 0; })
                .open_facets,
            1);
  EXPECT_GT(facts_of(cap_boundary(0.6), [](HullBoundary& b) { b.faces[1].sides[2].to = 0.1; }).side,
            0.01);
  EXPECT_GT(facts_of(cap_boundary(0.6),
                     [](HullBoundary& b) {
                       b.faces[1].n = unit({0, 0.1, -1});
                     })
                .tie,
            0.01);
}

TEST(BoundaryChecks, FindFlatPatches) {
  const Scene scene = make_scene(solid_cylinder(1, 2));
  const ContactGeometry geometry(scene);
  Hull hull;
  hull.boundary = whole_surface(geometry, scene.frame().to_frame({0, 0, 1}), 4);
  EXPECT_GT(boundary_facts(scene, hull, 300).flat, 0);
}

TEST(BoundaryChecks, FindWhatIsWrong) {
  const Scene scene = make_scene(two_spheres(1, 0.5, 2));
  const TwoSpheres spheres(scene, 1, 0.5, 2);
  const auto facts_of = [&](auto change) {
    auto boundary = std::make_shared<HullBoundary>(*spheres.boundary);
    change(*boundary);
    Hull hull;
    hull.boundary = boundary;
    return boundary_facts(scene, hull, 300);
  };
  EXPECT_EQ(facts_of([](HullBoundary& b) { b.curves[0].faces[1] = -1; }).open_curves, 1);
  EXPECT_EQ(facts_of([](HullBoundary& b) { b.faces[0].loops[0][0].second = 1; }).misplaced, 1);
  EXPECT_NE(facts_of([](HullBoundary& b) { b.faces[1].loops.clear(); }).euler, 2);
  EXPECT_GT(facts_of([](HullBoundary& b) { b.arcs[0].pieces[1].rulings[1].n.x += 1e-6; }).tie,
            1e-7);
  EXPECT_GT(
      facts_of([](HullBoundary& b) { b.arcs[0].pieces[1].rulings[1].point[0].x -= 1e-6; }).point,
      1e-7);
  EXPECT_GT(facts_of([](HullBoundary& b) { b.curves[0].points[1] *= 1.5; }).overshoot, 0.01);
  const BoundaryFacts missing = facts_of([](HullBoundary& b) { b.faces[0].regions.pop_back(); });
  EXPECT_GT(missing.misses, 0);
  EXPECT_GT(missing.mismatches, 0);
  const BoundaryFacts inside_out = facts_of([](HullBoundary& b) {
    auto& loop = b.faces[1].regions[0].loops[0];
    std::reverse(loop.begin(), loop.end());
    for (TrimStretch& s : loop) {
      std::swap(s.from, s.to);
      s.reversed = !s.reversed;
    }
  });
  EXPECT_GT(inside_out.mismatches, 0);
}

}  // namespace
}  // namespace taut
