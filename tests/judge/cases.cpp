#include "cases.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "cages.h"
#include "taut/io/model/read_model.h"

namespace taut_test {
namespace {

using nlohmann::json;

/// A volume with how far it may be off.
Expected volume(double value, double off, const Counts& counts = {}) {
  return {value, counts, unknown, unknown, off / value};
}

/// Of plates. By Minkowski's formulas; the faces as measures_of(Plate) counts them.
Expected plate(double volume, double mean_width, int scrolls, int facets) {
  return {volume, {0, scrolls, facets}, mean_width};
}

Expected counted(const Counts& counts) { return {unknown, counts}; }

std::vector<Case> natural_cases() {
  return {
      {"natural/01_rectangle_f32.taut.json", {unknown, {}, unknown, 2400, 1e-6}},
      {"natural/02_box_9dec.taut.json", volume(24000, 1e-5, {0, 0, 6, 12})},
      {"natural/03_quarter_cylinder_9dec.taut.json",
       volume(30 * (25 * pi - 50), 1e-5, {0, 1, 3, 6})},
      {"natural/04_cylinder_wall_p6.taut.json", volume(3000 * pi, 1e-2, {0, 1, 2, 2})},
      {"natural/05_cylinder_kinked_joins_1e-6.taut.json", volume(3000 * pi, 1e-2, {0, -1, 2})},
      {"natural/06_cone_f32.taut.json", volume(2000 * pi / 3, 1e-3, {0, 1, 1, 1})},
      {"natural/07_hemisphere_p6.taut.json", volume(2000 * pi / 3, 1e-3, {1, 0, 1, 1})},
      {"natural/08_sphere_p7.taut.json", volume(4000 * pi / 3, 1e-3, {1, 0, 0, 0})},
      {"natural/09_torus_p6.taut.json", volume(18024.77159, 1e-2, {1, 0, 2, 2})},
      {"natural/10_two_circles_p6.taut.json", volume(12315.0432, 1e-2, {0, 1, 2, 2})},
      {"natural/11_lens_p6.taut.json", volume(34557.1831, 1e-2, {2, 3, 0, 4})},
      {"natural/12_dome_bicubic_f32.taut.json", counted({1, 4, 5})},
      {"natural/13_dome_twice.taut.json"},
      {"natural/14_dome_mirrored_in_z.taut.json"},
      {"natural/15_ship_mirrored.taut.json"},
      {"natural/16_coaxial_walls_overlap_seam_turned.taut.json",
       volume(4000 * pi, 1e-5, {0, 1, 2, 2})},
      {"natural/17_sphere_twice_turned.taut.json", volume(4000 * pi / 3, 1e-5, {1, 0, 0, 0})},
      {"natural/18_cylinder_with_rim_edges.taut.json", volume(3000 * pi, 1e-5, {0, 1, 2, 2})},
      {"natural/19_elbow_and_pipe_2_patches.taut.json"},
      {"natural/20_ruled_wing_2_patches.taut.json"},
      {"natural/21_propeller_3_patches.taut.json"},
      {"natural/22_thread_3_strips.taut.json"},
      {"natural/23_crash_torus_corner_2_patches.taut.json"},
      {"natural/24_crash_conrod_3_patches.taut.json"},
      {"natural/25_sliver_bicubic_slow.taut.json"},
  };
}

std::vector<Case> plate_cases() {
  return {
      {"plates/plate_tilted_0.taut.json", plate(2844.7478590677, 40.8114874418, 9, 9)},
      {"plates/plate_tilted_3.taut.json", plate(2074.3629562285, 37.6367644145, 9, 9)},
      {"plates/plate_bad_8.taut.json", plate(698.0480146770, 36.2939508380, 9, 9)},
      {"plates/plate_bad_14.taut.json", plate(645.9992945267, 36.2474394682, 9, 9)},
      {"plates/plate_bad_59.taut.json", plate(1949.5795026913, 36.8611535381, 9, 9)},
  };
}

std::vector<Case> everyday_cases() {
  const Expected two_sides = {unknown, {}, unknown, 2 * 29737.349, 1e-7};
  return {
      {"everyday/plate_of_four_cylinders.taut.json", plate(2994.8495559215, 44.8915926536, 4, 6)},
      {"everyday/plate_one_raised.taut.json", plate(2262.6448699933, 38.5420559318, 9, 9)},
      {"everyday/cubic_curve.taut.json"},
      {"everyday/two_circles.taut.json"},
      {"everyday/ellipse_rectangle_pentagon.taut.json", two_sides},
      {"everyday/flat_bilinear.taut.json"},
      {"everyday/sphere_at_1m.taut.json"},
  };
}

std::vector<Case> cage_cases() {
  using taut::Scheme;
  return {
      {"cages/back_to_back.obj", {}, Scheme::catmark},
      {"cages/back_to_back.obj", {}, Scheme::loop},
      {"cages/back_to_back_quads.obj", {}, Scheme::catmark},
      {"cages/back_to_back_fin.obj", {}, Scheme::catmark},
      {"cages/far_corner.obj", {}, Scheme::catmark},
      {"cages/repeated_pole_12.obj", {}, Scheme::catmark},
      {"cages/repeated_pole_96.obj", {}, Scheme::catmark},
  };
}

dvec4 control_point(const json& p) {
  const double weight = p.size() > 3 ? p[3].get<double>() : 1;
  return taut::homogeneous({p[0].get<double>(), p[1].get<double>(), p[2].get<double>()}, weight);
}

}  // namespace

std::string Case::name() const {
  return file.substr(0, file.find('.')) + (scheme == taut::Scheme::loop ? "_loop" : "");
}

const std::vector<CaseGroup>& case_groups() {
  static const std::vector<CaseGroup> all = {{"natural", natural_cases()},
                                             {"plates", plate_cases()},
                                             {"everyday", everyday_cases()},
                                             {"cages", cage_cases()}};
  return all;
}

std::optional<std::filesystem::path> folder_of_cases() {
  const char* const models = std::getenv("TAUT_MODELS");
  if (models == nullptr) return std::nullopt;
  const std::filesystem::path folder = std::filesystem::path(models) / ".." / "cases";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

Subject read_case(const std::filesystem::path& folder, const Case& from) {
  Subject subject;
  subject.expected = from.expected;
  taut::ReadOptions options;
  options.scheme = from.scheme;
  taut::read_model(folder / from.file, subject.model, options);
  if (from.scheme) {
    subject.cage = cage_of(subject.model);
  } else {
    subject.shape = shape_of_document(folder / from.file);
  }
  return subject;
}

Shape shape_of_document(const std::filesystem::path& file) {
  Shape shape;
  const json document = json::parse(std::ifstream(file));
  for (const json& part : document.at("parts")) {
    for (const json& s : part.at("surfaces")) {
      NurbsSurface surface{
          s.at("degree")[0], s.at("degree")[1], s.at("knots")[0], s.at("knots")[1], {}};
      for (const json& row : s.at("points")) {
        for (const json& p : row) surface.points.push_back(control_point(p));
      }
      shape.surfaces.push_back(surface);
    }
    for (const json& e : part.at("edges")) {
      NurbsCurve curve{e.at("degree"), e.at("knots"), {}};
      for (const json& p : e.at("points")) curve.points.push_back(control_point(p));
      shape.curves.push_back(curve);
    }
    for (const json& p : part.at("vertices")) shape.points.emplace_back(control_point(p));
  }
  return shape;
}

}  // namespace taut_test
