// Envelope images of shapes whose envelopes are known, against support queries and closed forms.

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <stop_token>
#include <string>
#include <vector>

#include "envelope_checks.h"
#include "error_checks.h"
#include "freeform.h"
#include "hull_checks.h"
#include "taut/bounds/contact_geometry.h"
#include "taut/core/error.h"
#include "taut/envelope/envelope_hull.h"
#include "taut/envelope/envelope_picture.h"
#include "taut/envelope/offscreen_canvas.h"
#include "taut/envelope/trace_envelope.h"

namespace {

using namespace taut;       // NOLINT: a test
using namespace taut_test;  // NOLINT

constexpr int small = 128;

EnvelopeImages draw(const Scene& scene, int size = small, int threads = 2) {
  return EnvelopeImages(scene, {.size = size, .threads = threads, .progress = {}});
}

Model points_model(const std::vector<dvec3>& points) {
  Part part;
  part.add_points(points);
  Model model;
  model.add_part(std::move(part), 1e-3);
  return model;
}

TEST(StereographicView, PlacesDirectionsByItsFormula) {
  Random random(3);
  for (const Hemisphere hemisphere : hemispheres) {
    const StereographicView view{hemisphere, 256};
    for (int k = 0; k < 1000; ++k) {
      const dvec3 n = random_direction(random);
      if (view.pole() * n.z < -0.9) continue;
      const dvec2 p = view.pixel(n);
      EXPECT_LT(glm::distance(view.direction_at(p.x, p.y), n), 1e-14);
      EXPECT_NEAR(p.x, 127.5 + 128 * n.x / (1 + view.pole() * n.z), 1e-11);
      EXPECT_NEAR(p.y, 127.5 - 128 * n.y / (1 + view.pole() * n.z), 1e-11);
    }
  }
  const StereographicView north{Hemisphere::north, 256};
  EXPECT_EQ(north.pixel({0, 0, 1}), dvec2(127.5, 127.5));
  EXPECT_EQ(north.pixel({1, 0, 0}), dvec2(255.5, 127.5));
  EXPECT_EQ(north.pixel({0, 1, 0}), dvec2(127.5, -0.5));
}

/// A triangle over the whole image whose values are those of one point.
std::vector<OffscreenCanvas::Vertex> whole_image(const dvec3& x, std::uint32_t element,
                                                 std::uint32_t triangle) {
  std::vector<OffscreenCanvas::Vertex> result;
  for (const auto& [px, py] : {std::pair(-1.0F, -1.0F), {3.0F, -1.0F}, {-1.0F, 3.0F}}) {
    result.push_back({px,
                      py,
                      {float(x.x), float(x.y), float(x.z)},
                      {result.empty() ? 1.0F : 0.0F, result.size() == 1 ? 1.0F : 0.0F},
                      {0, 0, 0},
                      element,
                      triangle});
  }
  return result;
}

TEST(OffscreenCanvas, KeepsNumbersExactlyAndTheLargestValue) {
  constexpr int size = 16;
  OffscreenCanvas canvas(size);
  EXPECT_TRUE(canvas.driver().starts_with("llvmpipe") || canvas.driver().starts_with("softpipe"));
  const StereographicView view{Hemisphere::north, size};
  const dvec3 a(0.5, 0.25, 0);
  const dvec3 b(-0.25, 0, 0.5);
  constexpr std::uint32_t far = 0xfffffffdU;
  canvas.begin(1, 1, 1);
  canvas.add(whole_image(a, 7, far));
  canvas.add(whole_image(b, far, 16777217));  // no float holds that number
  const OffscreenCanvas::Layer first = canvas.draw_first();
  const OffscreenCanvas::Layer second = canvas.draw_second();
  int of_a = 0;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const auto k = std::size_t(row * size + column);
      const dvec3 n = view.direction_at(column, row);
      const bool a_wins = glm::dot(a, n) > glm::dot(b, n);
      of_a += a_wins ? 1 : 0;
      EXPECT_EQ(first.pixels[k].element, a_wins ? 7 : far);
      EXPECT_EQ(first.pixels[k].triangle, a_wins ? far : 16777217U);
      EXPECT_EQ(second.pixels[k].element, a_wins ? far : 7);
      EXPECT_NEAR(first.depths[k], (1 - glm::dot(a_wins ? a : b, n)) / 2, 1e-6);
      EXPECT_NEAR(second.depths[k], (1 - glm::dot(a_wins ? b : a, n)) / 2, 1e-6);
    }
  }
  EXPECT_GT(of_a, 20);
  EXPECT_LT(of_a, size * size - 20);
  canvas.begin(-1, 1, 1);
  const OffscreenCanvas::Layer none = canvas.draw_first();
  for (const auto& p : none.pixels) EXPECT_EQ(p.element, OffscreenCanvas::nothing);
}

TEST(OffscreenCanvas, RefusesSizesThatTheDriverDoesNotDraw) {
  for (const int size : {0, -1, 1 << 20}) {
    EXPECT_NE(message_of<BackendError>([&] { OffscreenCanvas canvas(size); }).find("pixels a side"),
              std::string::npos)
        << size;
  }
}

TEST(EnvelopeImages, RefuseSizesOutOfRange) {
  const Scene scene = make_scene(sphere());
  for (const int size : {-5, 0, 7, 16001}) {
    EXPECT_THROW(draw(scene, size), InvalidInput) << size;
  }
}

TEST(EnvelopeImages, StopWhereAsked) {
  const Scene scene = make_scene(sphere());
  std::stop_source source;
  source.request_stop();
  Progress progress;
  progress.stop = source.get_token();
  EXPECT_THROW(EnvelopeImages(scene, {.size = small, .threads = 1, .progress = progress}),
               Cancelled);
}

/// What images of any model must be: without holes, and right where sources do not change nearby.
void expect_sound(const Scene& scene, const std::string& name, int size = small,
                  long directions = 2000) {
  SCOPED_TRACE(name);
  const EnvelopeImages images = draw(scene, size);
  EXPECT_EQ(images.statistics().empty_pixels, 0);
  EXPECT_EQ(images.statistics().filled_pixels, 0);
  EXPECT_GT(images.statistics().triangles, 0);
  const SourceCounts counts = count_sources(images, directions, 17);
  EXPECT_GT(counts.right, directions * 4 / 5);
  EXPECT_EQ(counts.wrong, 0);
  // And contacts are contacts.
  Random random(5);
  SupportQuery query(scene);
  const ContactGeometry geometry(scene);
  double worst = 0;
  for (int k = 0; k < 300; ++k) {
    const EnvelopePixel p = images.pixel(random_direction(random));
    const dvec3 n = images.direction(p);
    const dvec3 x = geometry.point(images.contact(p));
    const Support s = query(n);
    worst = std::max(worst, s.h - glm::dot(x, n));
    EXPECT_LE(glm::dot(x, n), s.h_bound + 1e-12);
  }
  // A contact that is not the highest is so by less than what depths and borders leave undecided.
  EXPECT_LT(worst, 1e-4);
}

TEST(EnvelopeImages, HaveNoHolesAndTheRightSources) {
  expect_sound(make_scene(sphere()), "sphere");
  expect_sound(make_scene(ellipsoid(3, 2, 1)), "ellipsoid");
  expect_sound(make_scene(torus(2, 0.5)), "torus");
  expect_sound(make_scene(half_torus(2, 0.5)), "half torus");
  expect_sound(make_scene(oloid()), "oloid");
  expect_sound(make_scene(two_spheres(1, 0.5, 3)), "two spheres");
  expect_sound(make_scene(box(1, 2, 3)), "box");
  expect_sound(make_scene(filleted_box(1, 2, 3, 0.2)), "filleted box");
  expect_sound(make_scene(solid_cylinder(1, 2)), "cylinder");
  expect_sound(make_scene(cone(1, 2)), "cone");
  expect_sound(make_scene(paraboloid()), "paraboloid");
  expect_sound(make_scene(saddle()), "saddle");
  expect_sound(make_scene(bilinear_saddle()), "bilinear saddle");
  expect_sound(make_scene(dented()), "dented");
  expect_sound(make_scene(dented_ellipsoid()), "dented ellipsoid");
  expect_sound(make_scene(lemon()), "lemon");
  expect_sound(make_scene(ogive()), "ogive");
  expect_sound(make_scene(bean()), "bean");
  expect_sound(make_scene(tied_curve(0.3)), "tied curve");
  Shape cubic;
  cubic.curves = {twisted_cubic()};
  expect_sound(make_scene(cubic), "twisted cubic");
}

/// Pixels of the circle whose source is not that of a support query at their very centre.
long wrong_centers(const EnvelopeImages& images, long& pixels) {
  SupportQuery query(images.scene());
  Contact near;
  long wrong = 0;
  for (const Hemisphere hemisphere : hemispheres) {
    for (int row = 0; row < images.size(); ++row) {
      for (int column = 0; column < images.size(); ++column) {
        const EnvelopePixel p{hemisphere, column, row};
        const dvec3 n = images.direction(p);
        if (hemisphere_of(n) != hemisphere) continue;
        const Support s = query(n, near);
        near = s.contact;
        ++pixels;
        wrong += images.source(p) != images.scene().source(s.contact).source ? 1 : 0;
      }
    }
  }
  return wrong;
}

TEST(EnvelopeImages, DoublePrecisionDecidesWhatDepthsDoNotTell) {
  // Where a surface goes over into its border, their values differ by the square of the distance:
  // depths alone are wrong about some thirty pixels here.
  for (const Shape& shape : {paraboloid(), spherical_cap(0.6)}) {
    const Scene scene = make_scene(mapped(shape, skew_rotation()));
    const EnvelopeImages images = draw(scene, 200);
    EXPECT_GT(images.statistics().decided_pixels, 100);
    long pixels = 0;
    EXPECT_LE(wrong_centers(images, pixels), 5);
    EXPECT_GT(pixels, 60000);
  }
}

TEST(EnvelopeImages, TurnedMovedAndScaledModelsAreSoundToo) {
  const dmat3 turn = skew_rotation();
  expect_sound(make_scene(mapped(torus(2, 0.5), turn)), "turned torus");
  expect_sound(make_scene(mapped(filleted_box(1, 2, 3, 0.2), turn)), "turned filleted box");
  expect_sound(make_scene(mapped(oloid(), turn)), "turned oloid");
  expect_sound(make_scene(scaled(blob(4), 1e-6)), "small blob");
  expect_sound(make_scene(shifted(scaled(blob(5), 1e6), dvec3(1e7, -2e7, 3e6))), "far blob");
  expect_sound(make_scene(mapped(sphere(), dmat3(1000, 0, 0, 0, 1, 0, 0, 0, 1))), "needle");
}

TEST(EnvelopeImages, PointsAndFlatModels) {
  const std::vector<dvec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  expect_sound(Scene(points_model({{1, 2, 3}})), "point");
  expect_sound(Scene(points_model({{1, 2, 3}, {2, 4, 4}})), "segment");
  expect_sound(Scene(points_model(corners)), "square");
  expect_sound(Scene(points_model({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})), "tetrahedron");
  Random random(8);
  std::vector<dvec3> cloud;
  for (int k = 0; k < 3000; ++k) cloud.push_back(random_point(random));
  expect_sound(Scene(points_model(cloud)), "cloud");
  Shape flat;
  flat.curves = {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})};
  expect_sound(make_scene(flat), "disc");
}

TEST(EnvelopeMap, KnowsTheStructureOfKnownHulls) {
  struct Known {
    const char* name;
    Shape shape;
    std::size_t regions;
    int chains;
    std::size_t triple_points;
  };
  const Shape three = shifted(sphere(0.5), {1, 0, 0}) + shifted(sphere(0.5), {-1, 0.2, 0.3}) +
                      shifted(sphere(0.5), {0, 1.5, -0.4});
  const std::vector<Known> all = {
      {"sphere", sphere(), 1, 0, 0},
      {"two spheres", two_spheres(1, 0.5, 3), 2, 1, 0},
      {"two equal spheres", two_spheres(1, 1, 3), 2, 1, 0},
      {"three spheres", three, 3, 3, 2},
      {"torus", torus(2, 0.5), 1, 0, 2},
      {"turned torus", mapped(torus(2, 0.5), skew_rotation()), 1, 0, 2},
      {"oloid", oloid(), 2, 1, 0},
      {"box", box(1, 2, 3), 8, 12, 6},
      {"turned box", mapped(box(1, 2, 3), skew_rotation()), 8, 12, 6},
      {"filleted box", filleted_box(1, 2, 3, 0.2), 8, 12, 6},
      {"cylinder", cylinder(1, 2), 2, 1, 2},
      {"cone", cone(1, 2), 2, 1, 1},
      {"bilinear saddle", bilinear_saddle(), 4, 6, 4},
      {"dented ellipsoid", dented_ellipsoid(), 1, 1, 0},
  };
  for (const Known& known : all) {
    SCOPED_TRACE(known.name);
    const Scene scene = make_scene(known.shape);
    const EnvelopeMap map = trace_envelope(draw(scene, 256));
    EXPECT_EQ(map.regions.size(), known.regions);
    EXPECT_EQ(map.chain_count(), known.chains);
    EXPECT_EQ(map.triple_points.size(), known.triple_points);
    long pixels = 0;
    for (const EnvelopeRegion& r : map.regions) pixels += r.pixels;
    // Two discs of radius 128.
    EXPECT_NEAR(double(pixels), 2 * M_PI * 128 * 128, 300);
  }
}

/// Curves of few pixels, which cross the equator or end at it.
TEST(EnvelopeMap, CurvesOfManyPoints) {
  Random random(3);
  std::vector<dvec3> points;
  for (int k = 0; k < 3000; ++k) points.push_back(random_direction(random));
  const Scene scene = make_scene({{}, {}, points});
  for (const int size : {64, 256}) {
    for (const EnvelopeCurve& curve : trace_envelope(draw(scene, size)).curves) {
      EXPECT_FALSE(curve.points.empty());
      for (const EnvelopeCurvePoint& p : curve.points) EXPECT_NEAR(glm::length(p.n), 1, 1e-12);
    }
  }
}

TEST(EnvelopeMap, CurveOfTwoSpheresIsTheirCircle) {
  // Planes touch both where n.z = (r1 - r2) / d, the bigger sphere below.
  const Scene scene = make_scene(two_spheres(1, 0.5, 3));
  const EnvelopeImages images = draw(scene, 256);
  const EnvelopeMap map = trace_envelope(images);
  ASSERT_EQ(map.curves.size(), 1U);
  const EnvelopeCurve& curve = map.curves[0];
  EXPECT_TRUE(curve.closed);
  EXPECT_GT(curve.points.size(), 400U);
  const double c = -(1 - 0.5) / 3;
  for (const EnvelopeCurvePoint& p : curve.points) {
    EXPECT_NEAR(std::abs(p.n.z), std::abs(c), 1e-9);
    EXPECT_NEAR(glm::distance(p.point[0], p.point[1]), std::sqrt(9 - 0.25), 1e-7);
    EXPECT_NEAR(glm::dot(p.point[0] - p.point[1], p.n), 0, 1e-9);
  }
  // Its points are in order, about a pixel apart.
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const dvec3& next = curve.points[(k + 1) % curve.points.size()].n;
    EXPECT_LT(pixels_between(images, curve.points[k].n, next), 1.5);
  }
}

TEST(EnvelopeMap, TriplePointsOfABoxAreItsFaces) {
  const Scene scene = make_scene(mapped(box(1, 2, 3), skew_rotation()));
  const EnvelopeMap map = trace_envelope(draw(scene, 256));
  ASSERT_EQ(map.triple_points.size(), 6U);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const dvec3 n = sign * skew_rotation()[axis];
      const auto near = std::count_if(
          map.triple_points.begin(), map.triple_points.end(), [&](const EnvelopeTriplePoint& p) {
            return glm::distance(p.n, n) < 1e-12 && p.contacts.size() >= 3;
          });
      EXPECT_EQ(near, 1) << axis << ' ' << sign;
    }
  }
}

TEST(EnvelopeImages, SameBitsForAnyNumberOfThreads) {
  const Scene scene = make_scene(teapot());
  std::vector<std::string> bytes;
  for (const int threads : {1, 2, 0}) {
    const EnvelopeImages images = draw(scene, 200, threads);
    const EnvelopeMap map = trace_envelope(images);
    std::string all;
    for (const Hemisphere hemisphere : hemispheres) {
      all += to_png(envelope_picture(images, map, source_colors(images), hemisphere));
    }
    const auto append = [&](const auto& value) {
      all.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    for (const EnvelopeCurve& curve : map.curves) {
      for (const EnvelopeCurvePoint& p : curve.points) append(p.point);
    }
    for (const EnvelopeTriplePoint& p : map.triple_points) append(p.n);
    const Hull hull =
        envelope_hull(images, map, {.relative = 1e-3, .threads = threads, .progress = {}});
    append(hull.distance_bound);
    for (const auto v : hull.mesh.vertices()) append(hull.mesh.point(v));
    bytes.push_back(all);
  }
  EXPECT_GT(bytes[0].size(), 10000U);
  EXPECT_TRUE(bytes[0] == bytes[1]);
  EXPECT_TRUE(bytes[0] == bytes[2]);
}

TEST(EnvelopePicture, PixelsHaveTheirSourcesColours) {
  const Scene scene = make_scene(teapot());
  const EnvelopeImages images = draw(scene, 300);
  const EnvelopeMap map = trace_envelope(images);
  const std::map<int, Color> colors = source_colors(images);
  std::set<Color> distinct;
  for (const auto& [source, color] : colors) distinct.insert(color);
  EXPECT_EQ(distinct.size(), colors.size());
  EXPECT_GE(colors.size(), 28U);
  const std::array<Picture, 2> pictures = {
      envelope_picture(images, map, colors, Hemisphere::north),
      envelope_picture(images, map, colors, Hemisphere::south)};
  std::vector<std::vector<dvec3>> lines;
  for (const EnvelopeCurve& curve : map.curves) {
    lines.emplace_back();
    for (const auto& p : curve.points) lines.back().push_back(p.n);
  }
  for (const EnvelopeTriplePoint& p : map.triple_points) lines.push_back({p.n});
  const NearDirections near(images, lines);
  Random random(9);
  long checked = 0;
  long painted = 0;
  for (int k = 0; k < 5000; ++k) {
    const dvec3 n = random_direction(random);
    const EnvelopePixel p = images.pixel(n);
    const Color seen = pictures[std::size_t(p.hemisphere)].at(p.column, p.row);
    if (near.distance(images.direction(p)) <= 2) {
      painted += seen != colors.at(images.source(p)) ? 1 : 0;
      continue;
    }
    ++checked;
    EXPECT_EQ(seen, colors.at(images.source(p)));
  }
  EXPECT_GT(checked, 4000);
  EXPECT_GT(painted, 20);  // the lines are there
  // An overlay is seen.
  const EnvelopeOverlay overlay{{{dvec3(0, 0, 1), unit({0.3, 0, 1})}}, {unit({0, 0.5, 1})}};
  const Picture with = envelope_picture(images, map, colors, Hemisphere::north, overlay);
  const dvec2 on = images.view(Hemisphere::north).pixel(unit({0.15, 0, 1}));
  EXPECT_EQ(with.at(int(std::lround(on.x)), int(std::lround(on.y))), (Color{255, 255, 255}));
}

TEST(EnvelopePicture, PngHoldsItsPixels) {
  Picture picture{5, 3, {}};
  for (int k = 0; k < 15; ++k) {
    picture.pixels.push_back({std::uint8_t(17 * k), std::uint8_t(255 - k), std::uint8_t(k * k)});
  }
  const std::string bytes = to_png(picture);
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  EXPECT_EQ(image.width, 5U);
  EXPECT_EQ(image.height, 3U);
  std::vector<Color> read(15);
  ASSERT_NE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr), 0);
  EXPECT_TRUE(read == picture.pixels);
}

TEST(EnvelopeHull, IsConvexClosedAndCertified) {
  struct Case {
    const char* name;
    Shape shape;
    double tolerance;
    taut_test::Known known;
  };
  const std::vector<Case> all = {
      {"sphere", sphere(), 1e-3, {4 * M_PI / 3, 4 * M_PI}},
      {"torus", torus(2, 0.5), 1e-3, {18.02477159050215, 48.01354268448686}},
      {"oloid", oloid(), 1e-3, {3.052418468424375, 4 * M_PI}},
      {"box", box(1, 2, 3), 1e-9, {6, 22}},
      {"two spheres", two_spheres(1, 0.5, 2), 1e-3, {6.250460383704693, 17.86780821729195}},
      {"saddle", saddle(), 1e-3, {16.0 / 3, 17.16487619369011}},
      {"teapot", teapot(), 1e-4, {32.504, -1}},
  };
  for (const Case& c : all) {
    SCOPED_TRACE(c.name);
    const Scene scene = make_scene(c.shape);
    const EnvelopeImages images = draw(scene, 256);
    const Hull hull = envelope_hull(images, trace_envelope(images),
                                    {.relative = c.tolerance, .threads = 1, .progress = {}});
    taut_test::Known known = c.known;
    if (std::string(c.name) == "teapot") known.volume = -1;
    expect_certified(scene, hull, c.tolerance, known, 300);
  }
}

TEST(EnvelopeHull, SaysWhereTheImagesAreTooCoarse) {
  // Bumps that lie between the pixels.
  Shape shape = sphere();
  shape.points = {unit({0.31, 0.22, 1}) * 1.0001};
  const Scene scene = make_scene(shape);
  const EnvelopeImages images = draw(scene, 8);
  try {
    envelope_hull(images, trace_envelope(images),
                  {.relative = 1e-6, .max_vertices = 300, .progress = {}});
    ADD_FAILURE() << "reached";
  } catch (const HullNotConverged& failure) {
    ASSERT_TRUE(failure.best);
    EXPECT_EQ(failure.best->kind, HullKind::solid);
    EXPECT_GT(failure.reached, 1e-6 * scene.diagonal());
    const PolygonMesh mesh = polygons(failure.best->mesh);
    expect_strict_polytope(mesh_facts(mesh));
    EXPECT_LE(gaps(scene, mesh, 500).highest, failure.reached);
  }
  EXPECT_THROW(envelope_hull(images, trace_envelope(images), {.relative = -1, .progress = {}}),
               InvalidInput);
}

TEST(EnvelopeHull, OfAFlatModelIsFlat) {
  Shape flat;
  flat.curves = {circle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})};
  const Scene scene = make_scene(flat);
  const EnvelopeImages images = draw(scene);
  const Hull hull =
      envelope_hull(images, trace_envelope(images), {.relative = 1e-3, .progress = {}});
  EXPECT_EQ(hull.kind, HullKind::planar);
  EXPECT_LE(hull.distance_bound, 1e-3 * scene.diagonal());
}

}  // namespace
