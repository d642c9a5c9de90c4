#include "taut/surface/equal_parts.h"

#include <algorithm>
#include <array>
#include <map>

namespace taut {
namespace {

template <class Item, class Equal>
bool all_equal(const std::vector<Item>& a, const std::vector<Item>& b, const Equal& equal) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

bool equal(const Interval& a, const Interval& b) {
  return a.lower == b.lower && a.upper == b.upper;
}

bool equal(const Border& a, const Border& b) {
  return a.kind == b.kind && a.neighbor == b.neighbor && a.neighbor_side == b.neighbor_side &&
         a.reversed == b.reversed && a.edge == b.edge && a.piece == b.piece &&
         a.piece_reversed == b.piece_reversed && a.vertex == b.vertex;
}

bool equal(const BezierPatch& a, const BezierPatch& b) {
  return a.degree_u == b.degree_u && a.degree_v == b.degree_v && a.points == b.points;
}

bool equal_kinds(const Patch& a, const Patch& b) {
  return a.ruled_u == b.ruled_u && a.ruled_v == b.ruled_v &&
         a.ruled_obliquely == b.ruled_obliquely && a.stand_in == b.stand_in;
}

bool equal_repeats(const Patch& a, const Patch& b) {
  return a.repeats == b.repeats && a.swapped == b.swapped && a.reversed_u == b.reversed_u &&
         a.reversed_v == b.reversed_v;
}

bool equal(const Patch& a, const Patch& b) {
  const auto same_border = [](const Border& x, const Border& y) { return equal(x, y); };
  return a.face == b.face && equal(a.bezier, b.bezier) && equal(a.u, b.u) && equal(a.v, b.v) &&
         equal_kinds(a, b) && equal_repeats(a, b) && a.smooth_sides == b.smooth_sides &&
         a.corner_vertex == b.corner_vertex &&
         std::equal(a.borders.begin(), a.borders.end(), b.borders.begin(), same_border);
}

bool equal(const EdgePiece& a, const EdgePiece& b) {
  return a.edge == b.edge && equal(a.t, b.t) && a.end_vertex == b.end_vertex &&
         a.end_neighbor == b.end_neighbor && a.bezier.points == b.bezier.points;
}

bool equal(const Edge& a, const Edge& b) {
  return a.first_piece == b.first_piece && a.piece_count == b.piece_count && a.faces == b.faces;
}

/// Trimmed faces are equal to none.
bool equal(const Face& a, const Face& b) {
  return a.first_patch == b.first_patch && a.patch_count == b.patch_count && a.loops.empty() &&
         b.loops.empty();
}

bool equal(const Part& a, const Part& b) {
  const auto same = [](const auto& x, const auto& y) { return equal(x, y); };
  return a.point_count() == b.point_count() && a.seam_vertex_count() == b.seam_vertex_count() &&
         a.deviation_bound() == b.deviation_bound() && all_equal(a.patches(), b.patches(), same) &&
         all_equal(a.pieces(), b.pieces(), same) && a.vertices() == b.vertices() &&
         all_equal(a.faces(), b.faces(), same) && all_equal(a.edges(), b.edges(), same) &&
         a.polygons() == b.polygons();
}

/// The same for parts that are equal, and for hardly any others.
std::array<double, 8> mark(const Part& part) {
  const Box& box = part.control_box();
  return {box.lower.x,
          box.lower.y,
          box.lower.z,
          box.upper.x,
          box.upper.y,
          box.upper.z,
          double(part.patches().size()),
          double(part.vertices().size())};
}

}  // namespace

std::vector<int> equal_parts(const std::vector<Part>& parts) {
  std::map<std::array<double, 8>, std::vector<int>> seen;
  std::vector<int> result;
  result.reserve(parts.size());
  for (int k = 0; k < int(parts.size()); ++k) {
    const Part& part = parts[std::size_t(k)];
    std::vector<int>& alike = seen[mark(part)];
    const auto found = std::find_if(alike.begin(), alike.end(), [&](int other) {
      return equal(parts[std::size_t(other)], part);
    });
    result.push_back(found == alike.end() ? k : *found);
    if (found == alike.end()) alike.push_back(k);
  }
  return result;
}

}  // namespace taut
