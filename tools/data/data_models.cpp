#include "data_models.h"

#include <cmath>
#include <utility>

#include "shapes.h"
#include "taut/core/tolerances.h"

namespace taut::shapes {
namespace {

/// Faces and edges get the names, or numbers where these do not suffice.
Part part(const std::string& name, const Shape& shape, const std::vector<std::string>& names = {}) {
  Part part;
  part.name = name;
  std::size_t used = 0;
  const auto next_name = [&](const char* kind) {
    const std::size_t i = used++;
    return i < names.size() ? names[i] : std::string(kind) + " " + std::to_string(i);
  };
  for (const NurbsSurface& surface : shape.surfaces) part.add_surface(surface, next_name("face"));
  for (const NurbsCurve& curve : shape.curves) part.add_curve(curve, next_name("curve"));
  part.add_points(shape.points);
  return part;
}

Model model(Part part) {
  Model model;
  model.add_part(std::move(part), smooth_join_angle);
  return model;
}

/// The part once at each place.
Model placed(Part part, const std::vector<dvec3>& places) {
  Model result = model(std::move(part));
  result.clear_instances();
  for (const dvec3& place : places) result.add_instance(0, {dmat3(1.0), place});
  return result;
}

}  // namespace

std::vector<DataModel> data_models() {
  std::vector<DataModel> all;
  const auto add = [&](const std::string& name, Model model) {
    model.set_unit("mm");
    all.push_back({name, std::move(model)});
  };
  add("bilinear_saddle", model(part("saddle", bilinear_saddle(), {"z = x y"})));
  add("box",
      model(part("box", box(1, 2, 3), {"x = 0", "y = 0", "z = 0", "x = 1", "y = 2", "z = 3"})));
  add("cone", model(part("cone", solid_cone(1, 2), {"lateral", "bottom"})));
  add("cylinder", model(part("cylinder", solid_cylinder(1, 2), {"lateral", "bottom", "top"})));
  add("dented_ellipsoid", model(part("dented ellipsoid", dented_ellipsoid(), {"surface"})));
  add("ellipsoid", model(part("ellipsoid", ellipsoid(3, 2, 1), {"surface"})));
  add("filleted_box", model(part("filleted box", filleted_box(1, 2, 3, 0.2))));
  add("oloid", model(part("oloid", oloid(), {"circle in z = 0", "circle in y = 0"})));
  add("saddle", model(part("saddle", saddle(), {"z = x^2 - y^2"})));
  add("three_spheres", placed(part("sphere", sphere(0.5), {"surface"}),
                              {{0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0}}));
  add("torus", model(part("torus", torus(2, 0.5), {"surface"})));
  add("twisted_cubic",
      model(part("twisted cubic", {{}, {twisted_cubic()}, {}}, {"(t, t^2, t^3)"})));
  add("two_equal_spheres", placed(part("sphere", sphere(1), {"surface"}), {{0, 0, 0}, {0, 0, 3}}));
  add("two_spheres", model(part("spheres", two_spheres(1, 0.5, 3), {"radius 1", "radius 0.5"})));
  return all;
}

}  // namespace taut::shapes
