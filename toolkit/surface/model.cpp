#include "taut/surface/model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

void include(Box& box, const std::vector<dvec4>& points) {
  for (const dvec4& p : points) box.include(euclidean(p));
}

/// Far points, or points with tiny weights, may be finite one by one and yet have differences that
/// overflow; all that follows takes differences. @throws InvalidInput
void validate_extent(const Box& box, const std::string& name) {
  if (!std::isfinite(diagonal(box))) throw InvalidInput(name + ": the extent overflows");
}

/// @throws InvalidInput
void validate(const RigidMotion& pose, const std::string& name) {
  const dmat3 residual = glm::transpose(pose.rotation) * pose.rotation - dmat3(1.0);
  // Asked in a form that NaN fails.
  bool rotation = std::abs(glm::determinant(pose.rotation) - 1) <= rotation_tolerance;
  bool translation = true;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      rotation = rotation && std::abs(residual[i][j]) <= rotation_tolerance;
    translation = translation && std::isfinite(pose.translation[i]);
  }
  if (!rotation) {
    throw InvalidInput(name + ": the rotation is not orthogonal with determinant 1");
  }
  if (!translation) throw InvalidInput(name + ": the translation is not finite");
}

/// The box that holds the part at this place, too.
Box with(Box box, const Part& part, const RigidMotion& pose) {
  const Box& own = part.control_box();
  if (own.empty()) return box;
  for (int k = 0; k < 8; ++k) {
    box.include(
        pose({(k & 1) != 0 ? own.upper.x : own.lower.x, (k & 2) != 0 ? own.upper.y : own.lower.y,
              (k & 4) != 0 ? own.upper.z : own.lower.z}));
  }
  return box;
}

/// Ends of a single Bezier piece no farther from each other than so much of its length may be one.
constexpr double closing_share = 1e-3;

/// Some of a net's control points, a step of so many apart.
struct PointRow {
  const dvec4* first;
  std::size_t count, stride;

  dvec3 at(std::size_t k) const { return euclidean(first[k * stride]); }
  double length() const {
    double sum = 0;
    for (std::size_t k = 1; k < count; ++k) sum += glm::distance(at(k - 1), at(k));
    return sum;
  }
  /// It ends where it begins; one that is a point does.
  bool is_closed() const { return glm::distance(at(0), at(count - 1)) <= closing_share * length(); }
};

std::array<Interval, 2> halves(const Interval& t) {
  const double middle = 0.5 * t.lower + 0.5 * t.upper;
  return {Interval{t.lower, middle}, Interval{middle, t.upper}};
}
bool can_be_halved(const Interval& t) {
  const double middle = halves(t)[0].upper;
  return t.lower < middle && middle < t.upper;
}
constexpr std::array<Interval, 2> unit_halves = {Interval{0, 0.5}, Interval{0.5, 1}};

/// The Bezier pieces of a curve; a single one that is closed is halved, so that no piece goes on
/// into itself.
std::vector<CurvePiece> pieces_of(const NurbsCurve& curve) {
  std::vector<CurvePiece> pieces = decompose(curve);
  if (pieces.size() != 1) return pieces;
  const CurvePiece whole = pieces.front();
  if (!can_be_halved(whole.t) ||
      !PointRow{whole.bezier.points.data(), whole.bezier.points.size(), 1}.is_closed()) {
    return pieces;
  }
  pieces.clear();
  for (std::size_t k = 0; k < 2; ++k) {
    pieces.push_back({restricted(whole.bezier, unit_halves[k]), halves(whole.t)[k]});
  }
  return pieces;
}

/// The patch goes on into itself over its sides u = 0 and u = 1 (along_u) or the other two: these
/// are one, and no point.
bool goes_on_into_itself(const BezierPatch& p, bool along_u) {
  const std::size_t rows = to_size(p.degree_u) + 1;
  const std::size_t columns = to_size(p.degree_v) + 1;
  const std::size_t across = along_u ? columns : rows;
  double longest = 0;
  for (std::size_t k = 0; k < across; ++k) {
    const PointRow row = along_u ? PointRow{&p.points[k], rows, columns}
                                 : PointRow{&p.points[k * columns], columns, 1};
    if (!row.is_closed()) return false;
    longest = std::max(longest, row.length());
  }
  const PointRow side = {&p.points[0], across, along_u ? 1 : columns};
  return longest > 0 && side.length() > closing_share * longest;
}

PatchPiece half_of(const PatchPiece& p, bool along_u, std::size_t k) {
  const Interval whole{0, 1};
  if (along_u) return {restricted(p.bezier, unit_halves[k], whole), halves(p.u)[k], p.v};
  return {restricted(p.bezier, whole, unit_halves[k]), p.u, halves(p.v)[k]};
}

/// The Bezier patches of a surface, v within u; where each would go on into itself along u, or
/// along v, all are halved.
std::vector<PatchPiece> pieces_of(const NurbsSurface& surface) {
  std::vector<PatchPiece> pieces = decompose(surface);
  // One that ends in its own other side is alone between the two.
  const auto go_on_into_themselves = [&](bool along_u) {
    return std::all_of(pieces.begin(), pieces.end(), [&](const PatchPiece& p) {
      const Interval own = along_u ? p.u : p.v;
      const Interval all = along_u ? surface.domain_u() : surface.domain_v();
      return own.lower == all.lower && own.upper == all.upper && can_be_halved(own) &&
             goes_on_into_itself(p.bezier, along_u);
    });
  };
  const bool in_u = go_on_into_themselves(true);
  const bool in_v = go_on_into_themselves(false);
  if (in_u) {
    std::vector<PatchPiece> parts;
    for (const std::size_t k : {0, 1}) {
      for (const PatchPiece& p : pieces) parts.push_back(half_of(p, true, k));
    }
    pieces = std::move(parts);
  }
  if (in_v) {
    std::vector<PatchPiece> parts;
    for (const PatchPiece& p : pieces) {
      for (const std::size_t k : {0, 1}) parts.push_back(half_of(p, false, k));
    }
    pieces = std::move(parts);
  }
  return pieces;
}

std::size_t face_count_of(const Part& part) { return part.faces().size() + part.polygons().size(); }

/// Those of seams are no sources.
std::size_t vertex_count_of(const Part& part) {
  return part.vertices().size() - to_size(part.seam_vertex_count());
}

std::size_t source_count_of(const Part& part) {
  return face_count_of(part) + part.edges().size() + vertex_count_of(part);
}

template <class Count>
int sum_over_instances(const Model& model, const Count& count) {
  std::size_t sum = 0;
  for (const Instance& instance : model.instances()) {
    sum += count(model.parts()[to_size(instance.part)]);
  }
  return to_int(sum);
}

}  // namespace

void Part::add_surface(const NurbsSurface& surface, std::string face_name,
                       std::vector<TrimLoop> loops) {
  assert(!connected_);
  const std::string shown_name = printable(face_name);
  validate(surface, shown_name);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::string loop_name = shown_name + ": trim loop " + std::to_string(i);
    if (loops[i].curves.empty()) throw InvalidInput(loop_name + " has no curves");
    for (const NurbsCurve& curve : loops[i].curves) validate(curve, loop_name);
  }
  std::vector<PatchPiece> pieces = pieces_of(surface);
  Box box = box_;
  for (const PatchPiece& piece : pieces) include(box, piece.bezier.points);
  validate_extent(box, shown_name);

  const int face = to_int(faces_.size());
  faces_.push_back(
      {std::move(face_name), to_int(patches_.size()), to_int(pieces.size()), std::move(loops)});
  for (PatchPiece& piece : pieces) {
    Patch patch;
    patch.bezier = std::move(piece.bezier);
    patch.u = piece.u;
    patch.v = piece.v;
    patch.face = face;
    patches_.push_back(std::move(patch));
  }
  stored_coordinates_.add(surface.points);
  box_ = box;
}

void Part::add_patches(std::vector<FacePatch> patches, std::string face_name) {
  assert(!connected_);
  const std::string shown_name = printable(face_name);
  Box box = box_;
  for (const FacePatch& patch : patches) {
    validate(patch.bezier, shown_name);
    include(box, patch.bezier.points);
  }
  if (!patches.empty()) validate_extent(box, shown_name);

  const int face = to_int(faces_.size());
  faces_.push_back({std::move(face_name), to_int(patches_.size()), to_int(patches.size()), {}});
  for (std::size_t k = 0; k < patches.size(); ++k) {
    Patch patch;
    patch.bezier = std::move(patches[k].bezier);
    patch.smooth_sides = patches[k].smooth_sides;
    patch.stand_in = patches[k].stand_in;
    const double begin = 2 * static_cast<double>(k);
    patch.u = {begin, begin + 1};
    patch.face = face;
    patches_.push_back(std::move(patch));
  }
  box_ = box;
}

void Part::add_cage(CageOfPart cage, int first_face) {
  for (std::size_t f = to_size(first_face); f < faces_.size(); ++f) {
    faces_[f].cage = to_int(cages_.size());
  }
  stored_coordinates_.add(cage.cage->points);
  cages_.push_back(std::move(cage));
}

void Part::add_curve(const NurbsCurve& curve, std::string edge_name) {
  assert(!connected_);
  const std::string shown_name = printable(edge_name);
  validate(curve, shown_name);
  std::vector<CurvePiece> pieces = pieces_of(curve);
  Box box = box_;
  for (const CurvePiece& piece : pieces) include(box, piece.bezier.points);
  validate_extent(box, shown_name);

  const int edge = to_int(edges_.size());
  edges_.push_back({std::move(edge_name), to_int(pieces_.size()), to_int(pieces.size()), {}});
  for (CurvePiece& piece : pieces) {
    EdgePiece edge_piece;
    edge_piece.bezier = std::move(piece.bezier);
    edge_piece.t = piece.t;
    edge_piece.edge = edge;
    pieces_.push_back(std::move(edge_piece));
  }
  stored_coordinates_.add(curve.points);
  box_ = box;
}

void Part::add_point(const dvec3& point) { add_points({&point, 1}); }

void Part::add_points(std::span<const dvec3> points) {
  assert(!connected_);
  const std::string shown_name = printable(name);
  const auto name_of = [&](std::size_t i) {
    return shown_name + (name.empty() ? "" : ": ") + "point " +
           std::to_string(vertices_.size() + i);
  };
  if (points.size() > std::size_t(std::numeric_limits<int>::max()) - vertices_.size()) {
    throw LimitExceeded(shown_name + ": more than " +
                        std::to_string(std::numeric_limits<int>::max()) + " points");
  }
  Box box = box_;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(points[i][k])) throw InvalidInput(name_of(i) + " is not finite");
    }
    box.include(points[i]);
  }
  if (!points.empty()) validate_extent(box, name_of(0));
  vertices_.insert(vertices_.end(), points.begin(), points.end());
  stored_coordinates_.add(points);
  box_ = box;
}

void Part::add_polygons(const PolygonMesh& mesh) {
  for (std::size_t i = 0; i < mesh.polygons.size(); ++i) {
    const std::vector<int>& polygon = mesh.polygons[i];
    const std::string polygon_name = "polygon " + std::to_string(i);
    if (polygon.size() < 3) throw InvalidInput(polygon_name + " has fewer than three corners");
    for (const int v : polygon) {
      if (v < 0 || to_size(v) >= mesh.points.size()) {
        throw InvalidInput(polygon_name + ": there is no point " + std::to_string(v));
      }
    }
  }
  const int first = to_int(vertices_.size());
  add_points(mesh.points);
  polygons_.insert(polygons_.end(), mesh.polygons.begin(), mesh.polygons.end());
  if (first == 0) return;
  for (std::size_t i = polygons_.size() - mesh.polygons.size(); i < polygons_.size(); ++i) {
    for (int& v : polygons_[i]) v += first;
  }
}

int Model::add_part(Part part, double smooth_angle, const Progress& progress) {
  if (!part.connected()) part.connect(smooth_angle, progress);
  const std::string shown_name = "part " + printable(part.name);
  validate_room(part, shown_name);
  validate_extent(with(box_, part, {}), shown_name);
  const int index = to_int(parts_.size());
  parts_.push_back(std::move(part));
  add_instance(index, {});
  return index;
}

void Model::add_instance(int part, const RigidMotion& pose) {
  const std::string name = "instance " + std::to_string(instances_.size());
  if (part < 0 || to_size(part) >= parts_.size()) {
    throw InvalidInput(name + ": there is no part " + std::to_string(part));
  }
  validate(pose, name);
  const Part& placed = parts_[to_size(part)];
  validate_room(placed, name);
  const Box box = with(box_, placed, pose);
  validate_extent(box, name);
  box_ = box;
  instances_.push_back({part, pose});
  first_source_.push_back(source_count_);
  source_count_ += to_int(source_count_of(placed));
  patch_count_ += to_int(placed.patches().size());
}

void Model::clear_instances() {
  instances_.clear();
  first_source_.clear();
  source_count_ = 0;
  patch_count_ = 0;
  box_ = {};
}

void Model::validate_room(const Part& part, const std::string& name) const {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (source_count_of(part) > most - to_size(source_count_) ||
      part.patches().size() > most - to_size(patch_count_)) {
    throw LimitExceeded(name + ": the model would have more than " + std::to_string(most) +
                        " sources or patches");
  }
}

int Model::source_count() const { return source_count_; }

Source Model::source(int id) const {
  // Instances without sources share their first number with the next one; the last of them has it.
  const auto next = std::upper_bound(first_source_.begin(), first_source_.end(), id);
  Source source;
  source.instance = to_int(static_cast<std::size_t>(next - first_source_.begin())) - 1;
  source.index = id - first_source_[to_size(source.instance)];
  const Part& part = parts_[to_size(instances_[to_size(source.instance)].part)];
  const int faces = to_int(face_count_of(part));
  const int edges = to_int(part.edges().size());
  if (source.index < faces) return source;
  source.index -= faces;
  source.kind = SourceKind::edge;
  if (source.index < edges) return source;
  source.index -= edges;
  source.kind = SourceKind::vertex;
  return source;
}

int Model::source_id(const Source& source) const {
  const Part& part = parts_[to_size(instances_[to_size(source.instance)].part)];
  int id = first_source_[to_size(source.instance)] + source.index;
  if (source.kind != SourceKind::face) id += to_int(face_count_of(part));
  if (source.kind == SourceKind::vertex) id += to_int(part.edges().size());
  return id;
}

bool Model::polyhedral() const {
  return std::all_of(parts_.begin(), parts_.end(), [](const Part& p) { return p.polyhedral(); });
}

bool Model::empty() const {
  return std::all_of(instances_.begin(), instances_.end(), [&](const Instance& instance) {
    return parts_[to_size(instance.part)].control_box().empty();
  });
}

Box Model::control_box() const {
  Box box;
  for (const Instance& instance : instances_) {
    const Part& part = parts_[to_size(instance.part)];
    if (instance.pose.at_rest()) {
      box.include(part.control_box());
      continue;
    }
    const auto include_all = [&](const std::vector<dvec4>& points) {
      for (const dvec4& p : points) box.include(instance.pose(euclidean(p)));
    };
    for (const Patch& patch : part.patches()) include_all(patch.bezier.points);
    for (const EdgePiece& piece : part.pieces()) include_all(piece.bezier.points);
    for (int i = 0; i < part.point_count(); ++i) {
      box.include(instance.pose(part.vertices()[to_size(i)]));
    }
  }
  return box;
}

int Model::face_count() const {
  return sum_over_instances(*this, [](const Part& part) { return face_count_of(part); });
}
int Model::edge_count() const {
  return sum_over_instances(*this, [](const Part& part) { return part.edges().size(); });
}
int Model::vertex_count() const {
  return sum_over_instances(*this, [](const Part& part) { return vertex_count_of(part); });
}
int Model::patch_count() const { return patch_count_; }
double Model::deviation_bound() const {
  double bound = 0;
  for (const Part& part : parts_) bound = std::max(bound, part.deviation_bound());
  return bound;
}

}  // namespace taut
