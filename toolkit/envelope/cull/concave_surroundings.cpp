#include "taut/envelope/cull/concave_surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "taut/bounds/scene_content.h"
#include "taut/envelope/cull/concave_patch.h"

namespace taut {
namespace {

/// Radii of the disc, in that of the cell, tried one after the other. At twice the cell's radius a
/// paraboloid is as high as the cell's tangent planes.
constexpr std::array<double, 3> disc_radii = {2, 3, 5};
/// By how much larger discs are tried, one after the other, to be of use to other cells.
constexpr double disc_growth = 2;
/// Caps over a patch that are looked at, the latest.
constexpr std::size_t latest_caps = 32;
/// Where a cap reaches so many of a cell's radii beyond it in vain, others will not do.
constexpr double wide = 16;
/// Nodes of patches' trees that are held, some kilobytes each, and cells after which they are
/// counted again.
constexpr std::size_t node_limit = 16384;
constexpr long cells_between_counts = 64;
/// Pieces of caps that are held.
constexpr std::size_t held_pieces = 1 << 19;
/// Points of a cap that are compared with, those nearest to the cell.
constexpr std::size_t compared_points = 32;

double width(const Interval& t) { return t.upper - t.lower; }

}  // namespace

/// The cell that is asked about.
struct ConcaveSurroundings::Subject {
  int instance;
  int part;
  int patch;
  ParameterRectangle cell;
  const NormalPyramid& pyramid;
  double sign;
  std::array<dvec3, 4> corners;  ///< of the outward normals' pyramid, in the scene's frame
  std::vector<dvec3> points;     ///< the cell's control points, in the part's frame
  dvec3 middle;                  ///< of the cell

  double radius(const OsculatingParaboloid& map) const {
    double result = 0;
    const dvec2 from = map(middle);
    for (const dvec3& p : points) result = std::max(result, glm::distance(map(p), from));
    return result;
  }
};

ConcaveSurroundings::ConcaveSurroundings(const Scene& scene, Stop stop)
    : scene_(scene), reach_(scene, stop), surfaces_(scene, std::move(stop)) {}

void ConcaveSurroundings::begin_anew() {
  caps_.clear();
  caps_over_.clear();
  pieces_ = 0;
}

/// Lest memory grow with the model: what is forgotten is only found out again.
void ConcaveSurroundings::forget_some() {
  if (++cells_ % cells_between_counts == 0 && surfaces_.node_count() > node_limit) {
    surfaces_.forget();
  }
  if (pieces_ > held_pieces) begin_anew();
}

bool ConcaveSurroundings::surely_on(int instance, int patch, const PatchCell& cell,
                                    const NormalPyramid& pyramid, double sign) {
  forget_some();
  const SceneInstance& placed = scene_.content().instances[std::size_t(instance)];
  const BezierPatch& bezier = surfaces_.patch(placed.part, patch).bezier();
  Subject subject{instance, placed.part, patch, {cell.u(), cell.v()}, pyramid, sign, {}, {}, {}};
  for (std::size_t k = 0; k < 4; ++k) {
    const dvec3& n = pyramid.corners[k];
    subject.corners[k] =
        sign * (placed.rotated ? glm::transpose(glm::inverse(placed.rotation)) * n : n);
  }
  for (const dvec4& p : restricted(bezier, subject.cell.u, subject.cell.v).points) {
    subject.points.push_back(euclidean(p));
  }
  const dvec2 middle = subject.cell.middle();
  subject.middle = point(bezier, middle.x, middle.y);
  const Answer answer = ask_known(subject);
  return answer == Answer::on || (answer == Answer::none && look_about(subject));
}

/// The caps known that hold the cell, the widest about it first.
ConcaveSurroundings::Answer ConcaveSurroundings::ask_known(const Subject& cell) {
  const auto found = caps_over_.find({cell.part, cell.patch});
  if (found == caps_over_.end()) return Answer::none;
  std::vector<std::pair<double, int>> candidates;
  const std::vector<int>& over = found->second;
  const std::size_t old = over.size() - std::min(over.size(), latest_caps);
  for (std::size_t i = old; i < over.size(); ++i) {
    const int k = over[i];
    const ConvexCap& cap = caps_[std::size_t(k)];
    const double clear = cap.radius - glm::length(cap.map(cell.middle));
    const double ratio = clear / cell.radius(cap.map);
    if (ratio >= disc_radii.front()) candidates.emplace_back(-ratio, k);
  }
  std::sort(candidates.begin(), candidates.end());
  for (const auto& [ratio, k] : candidates) {
    const ConvexCap& cap = caps_[std::size_t(k)];
    if (!cap.faces(cell.pyramid, cell.sign) || !cap.covers(cell.patch, cell.cell)) continue;
    if (is_above_others(cell, cap)) return Answer::on;
    return -ratio >= wide ? Answer::hopeless : Answer::none;
  }
  return Answer::none;
}

/// Caps about the cell itself.
bool ConcaveSurroundings::look_about(const Subject& cell) {
  const dvec3 axis = cell.sign * cell.pyramid.axis;
  const std::optional<OsculatingParaboloid> map =
      OsculatingParaboloid::about(surfaces_.patch(cell.part, cell.patch), cell.cell.middle(), axis);
  if (!map) return false;
  const double size = cell.radius(*map);
  std::optional<ConvexCap> largest;
  bool on = false;
  const auto look = [&](double radius) {
    std::optional<ConvexCap> cap =
        convex_cap(surfaces_, cell.part, cell.patch, cell.cell, axis, *map, radius * size);
    if (!cap) return false;
    largest = std::move(cap);
    return true;
  };
  bool grows = true;
  double radius = 0;
  for (std::size_t k = 0; grows && !on && k < disc_radii.size(); ++k) {
    radius = disc_radii[k];
    grows = look(radius);
    on = grows && is_above_others(cell, *largest);
  }
  if (!on) return false;
  for (; grows; grows = look(radius)) radius *= disc_growth;
  keep(cell.part, std::move(*largest));
  return true;
}

void ConcaveSurroundings::keep(int part, ConvexCap cap) {
  int last = -1;
  for (const ConvexCap::Piece& piece : cap.pieces) {
    if (piece.patch != last) caps_over_[{part, piece.patch}].push_back(int(caps_.size()));
    last = piece.patch;
  }
  pieces_ += cap.pieces.size();
  caps_.push_back(std::move(cap));
}

/// A point of the cell or of the cap is above all else, in all directions between the corners.
bool ConcaveSurroundings::is_above_others(const Subject& cell, const ConvexCap& cap) {
  std::vector<dvec3> points;
  const auto add_point = [&](int of, double u, double v) {
    points.push_back(scene_.content().frame_point({cell.instance, SourceKind::face, of, u, v}));
  };
  for (const double s : {0.0, 0.5, 1.0}) {
    for (const double t : {0.0, 0.5, 1.0}) {
      add_point(cell.patch, cell.cell.u.at(s), cell.cell.v.at(t));
    }
  }
  std::vector<PatchRectangle> regions;
  std::vector<std::pair<double, std::size_t>> near;
  double narrowest = std::min(width(cell.cell.u), width(cell.cell.v));
  const dvec2 from = cap.map(cell.middle);
  for (std::size_t k = 0; k < cap.pieces.size(); ++k) {
    const ConvexCap::Piece& piece = cap.pieces[k];
    near.emplace_back(glm::distance(piece.middle, from), k);
    regions.push_back({cell.instance, piece.patch, piece.cell.u, piece.cell.v});
    narrowest = std::min({narrowest, width(piece.cell.u), width(piece.cell.v)});
  }
  if (near.size() > compared_points) {
    std::nth_element(near.begin(), near.begin() + compared_points, near.end());
    near.resize(compared_points);
  }
  for (const auto& [distance, k] : near) {
    const dvec2 p = cap.pieces[k].cell.middle();
    add_point(cap.pieces[k].patch, p.x, p.y);
  }
  return reach_.surely_below(points, cell.corners, regions, 1 - std::ilogb(narrowest));
}

}  // namespace taut
