#include "taut/containment/closed_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "taut/core/error.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

const char* name_of(Side side) {
  switch (side) {
    case Side::u0:
      return "u = 0";
    case Side::u1:
      return "u = 1";
    case Side::v0:
      return "v = 0";
    default:
      return "v = 1";
  }
}

/// "face 2 ("lid"), side v = 0", with the number of the patch where the face has several.
std::string name_of(const Part& part, const Patch& patch, std::size_t number, Side side) {
  const std::string& name = part.faces()[std::size_t(patch.face)].name;
  const auto patches = std::count_if(part.patches().begin(), part.patches().end(),
                                     [&](const Patch& other) { return other.face == patch.face; });
  std::string text = "face " + std::to_string(patch.face);
  if (!name.empty()) text += " (\"" + printable(name) + "\")";
  if (patches > 1) text += ", patch " + std::to_string(number);
  return text + ", side " + name_of(side);
}

std::string open_patches(const Part& part) {
  long open = 0;
  std::string first;
  for (std::size_t k = 0; k < part.patches().size(); ++k) {
    const Patch& patch = part.patches()[k];
    if (patch.repeats >= 0) continue;
    for (const Side side : all_sides) {
      const Border& border = patch.borders[std::size_t(side)];
      if (border.kind == BorderKind::collapsed || border.neighbor >= 0) continue;
      if (open++ > 0) continue;
      const bool several =
          border.edge >= 0 && part.edges()[std::size_t(border.edge)].faces.size() > 2;
      first = name_of(part, patch, k, side) + (several ? ", where more than two meet" : "");
    }
  }
  if (open == 0) return {};
  return "the surface is open along " + std::to_string(open) + (open == 1 ? " side" : " sides") +
         " of patches, the first: " + first;
}

std::string open_polygons(const Part& part) {
  std::map<std::pair<int, int>, int> uses;
  for (const std::vector<int>& polygon : part.polygons()) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const int a = polygon[k];
      const int b = polygon[(k + 1) % polygon.size()];
      if (a != b) ++uses[{std::min(a, b), std::max(a, b)}];
    }
  }
  const auto open = [](const auto& use) { return use.second != 2; };
  const long count = std::count_if(uses.begin(), uses.end(), open);
  if (count == 0) return {};
  const auto first = std::find_if(uses.begin(), uses.end(), open);
  return "the surface is open along " + std::to_string(count) +
         " sides of polygons or has more than two there, the first from vertex " +
         std::to_string(first->first.first) + " to " + std::to_string(first->first.second);
}

/// The polygons' normal times twice the area (Newell).
dvec3 area_vector(const Part& part, const std::vector<int>& polygon) {
  const dvec3& origin = part.vertices()[std::size_t(polygon[0])];
  dvec3 sum(0.0);
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    sum += glm::cross(part.vertices()[std::size_t(polygon[k])] - origin,
                      part.vertices()[std::size_t(polygon[k + 1])] - origin);
  }
  return sum;
}

std::string bent_polygon(const Part& part) {
  const Box& box = part.control_box();
  const dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  const double rounding = coordinate_rounding * (reach.x + reach.y + reach.z);
  for (std::size_t f = 0; f < part.polygons().size(); ++f) {
    const std::vector<int>& polygon = part.polygons()[f];
    if (polygon.size() == 3) continue;
    const dvec3 n = unit(area_vector(part, polygon));
    for (const int v : polygon) {
      const dvec3 from = part.vertices()[std::size_t(v)] - part.vertices()[std::size_t(polygon[0])];
      if (std::abs(glm::dot(from, n)) > rounding) {
        return "polygon " + std::to_string(f) + " is not planar";
      }
    }
  }
  return {};
}

/// Bound of the distance of two curves, parameter by parameter. With the weights of both made one
/// at the first control point, |X / w - X' / w'| <= (|X - X'| + |x'| |w - w'|) / w about a middle.
double distance_bound(BezierCurve a, BezierCurve b) {
  const int degree = std::max(a.degree(), b.degree());
  if (a.degree() < degree) a = elevated(a, degree);
  if (b.degree() < degree) b = elevated(b, degree);
  const dvec3 middle = euclidean(a.points.front());
  double space = 0;
  double weight = 0;
  double radius = 0;
  double least = 1;
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    const dvec4 p = a.points[k] / a.points.front().w;
    const dvec4 q = b.points[k] / b.points.front().w;
    space = std::max(space, glm::distance(dvec3(p) - p.w * middle, dvec3(q) - q.w * middle));
    weight = std::max(weight, std::abs(p.w - q.w));
    radius = std::max(radius, glm::distance(euclidean(q), middle));
    least = std::min(least, p.w);
  }
  return (space + radius * weight) / least;
}

}  // namespace

std::string why_not_closed(const Model& model) {
  bool surface = false;
  for (std::size_t k = 0; k < model.parts().size(); ++k) {
    const Part& part = model.parts()[k];
    const std::string name = part.name.empty() ? "" : printable(part.name) + ": ";
    if (!part.patches().empty()) surface = true;
    if (!part.polygons().empty()) surface = true;
    for (const std::string& reason :
         {open_patches(part), open_polygons(part), bent_polygon(part)}) {
      if (!reason.empty()) return name + reason;
    }
  }
  return surface ? "" : "it has no surface";
}

double largest_crack(const Part& part) {
  double largest = 0;
  for (const Patch& patch : part.patches()) {
    if (patch.repeats >= 0) continue;
    for (const Side side : all_sides) {
      const Border& border = patch.borders[std::size_t(side)];
      if (border.neighbor < 0) continue;
      const Patch& other = part.patches()[std::size_t(border.neighbor)];
      BezierCurve there = taut::border(other.bezier, border.neighbor_side);
      if (border.reversed) there = reversed(there);
      largest = std::max(largest, distance_bound(taut::border(patch.bezier, side), there));
    }
  }
  return std::min(largest, join_distance * diagonal(part.control_box()));
}

}  // namespace taut
