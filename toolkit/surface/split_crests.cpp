#include "taut/surface/split_crests.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/surface/connect_progress.h"
#include "taut/surface/crests.h"
#include "taut/surface/flatness.h"
#include "taut/surface/nearest_parameter.h"
#include "taut/surface/point_grid.h"
#include "taut/surface/side_joins.h"

namespace taut {
namespace {

/// Cuts of one row, beyond which its crests are taken to wind without end.
constexpr std::size_t cut_limit = 16;

/// How often cuts are looked for that go on from earlier ones.
constexpr int round_limit = 8;

/// A face's grid of patches. Its rows are numbered: the patches of an interval of u, then of v.
struct FaceGrid {
  int first_patch = 0;
  int count_u = 0, count_v = 0;
  int first_row = 0;
  /// Patches of a refined face of a cage are no grid: rows do not go through them.
  bool can_be_cut = true;

  FaceGrid(const Face& face, const std::vector<Patch>& patches, int row)
      : first_patch(face.first_patch),
        first_row(row),
        can_be_cut(face.cage < 0 || face.patch_count == 1) {
    const Patch* const first = patches.data() + face.first_patch;
    while (count_v < face.patch_count && first[count_v].u.lower == first[0].u.lower) ++count_v;
    count_u = count_v == 0 ? 0 : face.patch_count / count_v;
  }
  int row_count() const { return count_u + count_v; }
  int patch(int i, int j) const { return first_patch + i * count_v + j; }
  /// The row that a curve u = const (direction u) or v = const of the patch runs through.
  int row_of(int patch, Direction direction) const {
    const int k = patch - first_patch;
    return first_row + (direction == Direction::u ? k / count_v : count_u + k % count_v);
  }
  Direction direction_of(int row) const {
    return row - first_row < count_u ? Direction::u : Direction::v;
  }
  std::vector<int> patches_of(int row) const {
    std::vector<int> result;
    result.reserve(to_size(std::max(count_u, count_v)));
    const int k = row - first_row;
    if (k < count_u) {
      for (int j = 0; j < count_v; ++j) result.push_back(patch(k, j));
    } else {
      for (int i = 0; i < count_u; ++i) result.push_back(patch(i, k - count_u));
    }
    return result;
  }
};

/// A curve across all patches of a row.
struct Cut {
  int row = -1;
  double s = 0;
};

class RowSplitter {
 public:
  RowSplitter(std::vector<Face>& faces, std::vector<Patch>& patches, const Box& box, double bent,
              const Progress& progress)
      : faces_(faces),
        patches_(patches),
        box_(box),
        progress_(progress),
        tolerance_(join_tolerance(box, bent)) {}

  void split_at_crests(double grid) {
    find_grids();
    const std::vector<Cut> crests = find_crests(grid);
    if (crests.empty()) return;
    find_joins();
    cut_along(crests);
  }
  /// False if there is none.
  bool split_at_junctions() {
    find_grids();
    if (!can_cut_any()) return false;
    find_joins();
    return cut_along(find_junctions());
  }

 private:
  void find_grids();
  void find_joins();
  bool can_cut_any() const {
    return std::any_of(grids_.begin(), grids_.end(),
                       [](const FaceGrid& g) { return g.can_be_cut; });
  }
  std::vector<Cut> find_crests(double grid) const;
  std::vector<Cut> find_junctions() const;
  bool ends_on(int side, const BezierCurve& host) const;
  bool lies_on(const BezierCurve& curve, const dvec3& x) const {
    return same_point(point(curve, nearest_parameter(curve, x)), x, tolerance_);
  }
  bool cut_along(const std::vector<Cut>& cuts);
  void add_with_continuations(const Cut& first);
  bool add(const Cut& cut, std::vector<Cut>& added);
  bool too_thin(const Cut& cut) const;
  void push_continuations(const Cut& cut, std::vector<Cut>& next) const;
  std::array<int, 2> crossed_sides(int patch, Direction direction) const;
  const FaceGrid& grid_of(int patch) const {
    return grids_[to_size(patches_[to_size(patch)].face)];
  }
  const FaceGrid& grid_of_row(int row) const { return grids_[to_size(face_of_row_[to_size(row)])]; }
  void split();
  void split_face(std::size_t f, std::vector<Patch>& result) const;

  std::vector<Face>& faces_;
  std::vector<Patch>& patches_;
  const Box& box_;
  const Progress& progress_;
  const double tolerance_;
  std::vector<FaceGrid> grids_;  // per face
  std::vector<int> face_of_row_;
  std::vector<std::vector<double>> cuts_;  // per row
  std::vector<SideCurve> sides_;
  std::vector<Join> joins_;
  std::vector<int> join_of_;  // per side
};

void RowSplitter::find_grids() {
  grids_.reserve(faces_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const FaceGrid grid(faces_[f], patches_, to_int(face_of_row_.size()));
    face_of_row_.insert(face_of_row_.end(), to_size(grid.row_count()), to_int(f));
    grids_.push_back(grid);
  }
  cuts_.resize(face_of_row_.size());
}

std::vector<Cut> RowSplitter::find_crests(double grid) const {
  std::vector<Cut> result;
  if (!can_cut_any()) return result;
  const std::vector<dvec3> points = corner_points(patches_);
  for (int p = 0; p < to_int(patches_.size()); ++p) {
    report_connect(progress_, to_size(p), patches_.size());
    const Patch& patch = patches_[to_size(p)];
    if (!grid_of(p).can_be_cut || patch.may_be_ruled()) continue;
    for (const Direction direction : {Direction::u, Direction::v}) {
      const int row = grid_of(p).row_of(p, direction);
      // Where numbers are rounded, each patch of a row has its own crest for the row's.
      const auto is_known = [&](const Cut& cut) {
        return grid > 0 && cut.row == row && is_crest(patch.bezier, direction, cut.s, grid);
      };
      for (const double s : inner_crests(patch.bezier, direction, grid)) {
        if (!may_support(patch.bezier, direction, s, points, tolerance_, grid)) continue;
        if (std::none_of(result.begin(), result.end(), is_known)) result.push_back({row, s});
      }
    }
  }
  return result;
}

void RowSplitter::find_joins() {
  sides_ = side_curves(patches_, tolerance_);
  joins_ = match_sides(patches_, sides_, box_, tolerance_, progress_);
  join_of_.assign(sides_.size(), -1);
  for (std::size_t j = 0; j < joins_.size(); ++j) {
    for (const Use& use : joins_[j]) join_of_[to_size(use.side)] = to_int(j);
  }
}

/// Whether a side runs along the host from its one end or the other: its middle lies on the host,
/// or the host ends in between.
bool RowSplitter::ends_on(int side, const BezierCurve& host) const {
  const BezierCurve& own = sides_[to_size(side)].curve;
  if (lies_on(host, point(own, 0.5))) return true;
  return std::any_of(host.points.begin(), host.points.end(), [&](const dvec4& p) {
    const bool end = &p == &host.points.front() || &p == &host.points.back();
    return end && lies_on(own, euclidean(p));
  });
}

/// Where sides that meet no other one end inside of others, along which they run.
std::vector<Cut> RowSplitter::find_junctions() const {
  struct End {
    dvec3 x;
    int side;
  };
  std::vector<int> open;
  std::vector<End> ends;
  for (const Join& join : joins_) {
    if (join.size() != 1) continue;
    const BezierCurve& curve = sides_[to_size(join[0].side)].curve;
    open.push_back(join[0].side);
    ends.push_back({euclidean(curve.points.front()), join[0].side});
    ends.push_back({euclidean(curve.points.back()), join[0].side});
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const End& a, const End& b) { return a.x.x < b.x.x; });
  std::vector<Cut> result;
  for (const int side : open) {
    const BezierCurve& host = sides_[to_size(side)].curve;
    // No point inside of a straight side is extreme.
    if (is_straight(host)) continue;
    Box box;
    for (const dvec4& p : host.points) box.include(euclidean(p));
    const dvec3 lower = box.lower - dvec3(tolerance_);
    const dvec3 upper = box.upper + dvec3(tolerance_);
    auto end = std::lower_bound(ends.begin(), ends.end(), lower.x,
                                [](const End& e, double x) { return e.x.x < x; });
    for (; end != ends.end() && end->x.x <= upper.x; ++end) {
      if (end->side / 4 == side / 4 || glm::any(glm::lessThan(end->x, lower)) ||
          glm::any(glm::greaterThan(end->x, upper))) {
        continue;
      }
      const double t = nearest_parameter(host, end->x);
      const dvec3 x = point(host, t);
      if (!same_point(x, end->x, tolerance_) ||
          same_point(x, euclidean(host.points.front()), 2 * tolerance_) ||
          same_point(x, euclidean(host.points.back()), 2 * tolerance_) ||
          !ends_on(end->side, host)) {
        continue;
      }
      const bool along = along_v(all_sides[to_size(side % 4)]);
      const int p = side / 4;
      result.push_back({grid_of(p).row_of(p, along ? Direction::v : Direction::u), t});
    }
  }
  return result;
}

/// False if none was possible.
bool RowSplitter::cut_along(const std::vector<Cut>& cuts) {
  for (const Cut& cut : cuts) add_with_continuations(cut);
  const bool any = std::any_of(cuts_.begin(), cuts_.end(),
                               [](const std::vector<double>& row) { return !row.empty(); });
  for (std::vector<double>& row : cuts_) std::sort(row.begin(), row.end());
  if (any) split();
  return any;
}

/// The sides that curves u = const (direction u) or v = const of the patch end at.
std::array<int, 2> RowSplitter::crossed_sides(int patch, Direction direction) const {
  const bool u = direction == Direction::u;
  return {4 * patch + int(u ? Side::v0 : Side::u0), 4 * patch + int(u ? Side::v1 : Side::u1)};
}

bool RowSplitter::too_thin(const Cut& cut) const {
  const FaceGrid& grid = grid_of_row(cut.row);
  const double share = std::min(cut.s, 1 - cut.s);
  for (const int patch : grid.patches_of(cut.row)) {
    for (const int side : crossed_sides(patch, grid.direction_of(cut.row))) {
      const SideCurve& s = sides_[to_size(side)];
      if (s.collapsed) continue;
      // A strip is about as wide as its share of the side; some tolerances keep it from collapsing.
      Box box;
      for (const dvec4& p : s.curve.points) box.include(euclidean(p));
      if (share * diagonal(box) <= 16 * tolerance_) return true;
    }
  }
  return false;
}

/// False if the row cannot be cut, or has too many.
bool RowSplitter::add(const Cut& cut, std::vector<Cut>& added) {
  if (!grid_of_row(cut.row).can_be_cut || cuts_[to_size(cut.row)].size() >= cut_limit ||
      too_thin(cut)) {
    return false;
  }
  cuts_[to_size(cut.row)].push_back(cut.s);
  added.push_back(cut);
  return true;
}

void RowSplitter::push_continuations(const Cut& cut, std::vector<Cut>& next) const {
  const FaceGrid& grid = grid_of_row(cut.row);
  for (const int patch : grid.patches_of(cut.row)) {
    for (const int side : crossed_sides(patch, grid.direction_of(cut.row))) {
      const int j = join_of_[to_size(side)];
      if (j < 0) continue;
      const Join& join = joins_[to_size(j)];
      const auto own =
          std::find_if(join.begin(), join.end(), [&](const Use& use) { return use.side == side; });
      for (const Use& use : join) {
        if (use.side == side) continue;
        const int p = use.side / 4;
        const bool along = along_v(all_sides[to_size(use.side % 4)]);
        next.push_back({grid_of(p).row_of(p, along ? Direction::v : Direction::u),
                        use.reversed == own->reversed ? cut.s : 1 - cut.s});
      }
    }
  }
}

/// The cut and all that it goes on in or, if they cannot all be made, none.
void RowSplitter::add_with_continuations(const Cut& first) {
  std::vector<Cut> added;
  std::vector<Cut> next = {first};
  while (!next.empty()) {
    const Cut cut = next.back();
    next.pop_back();
    const std::vector<double>& there = cuts_[to_size(cut.row)];
    if (std::any_of(there.begin(), there.end(),
                    [&](double s) { return std::abs(s - cut.s) <= least_crest_share; })) {
      continue;
    }
    if (!add(cut, added)) {
      // The latest of a row's cuts stand at its end.
      for (const Cut& a : added) cuts_[to_size(a.row)].pop_back();
      return;
    }
    push_continuations(cut, next);
  }
}

/// The ends of the parts into which cuts divide [0, 1].
std::vector<double> with_ends(std::vector<double> cuts) {
  cuts.insert(cuts.begin(), 0.0);
  cuts.push_back(1.0);
  return cuts;
}

void RowSplitter::split_face(std::size_t f, std::vector<Patch>& result) const {
  const FaceGrid& grid = grids_[f];
  for (int i = 0; i < grid.count_u; ++i) {
    const std::vector<double> u = with_ends(cuts_[to_size(grid.first_row + i)]);
    for (std::size_t k = 0; k + 1 < u.size(); ++k) {
      for (int j = 0; j < grid.count_v; ++j) {
        const std::vector<double> v = with_ends(cuts_[to_size(grid.first_row + grid.count_u + j)]);
        const Patch& whole = patches_[to_size(grid.patch(i, j))];
        for (std::size_t l = 0; l + 1 < v.size(); ++l) {
          Patch part = whole;
          part.bezier = restricted(whole.bezier, {u[k], u[k + 1]}, {v[l], v[l + 1]});
          part.u = {whole.u.at(u[k]), whole.u.at(u[k + 1])};
          part.v = {whole.v.at(v[l]), whole.v.at(v[l + 1])};
          result.push_back(std::move(part));
        }
      }
    }
  }
}

void RowSplitter::split() {
  std::vector<Patch> result;
  result.reserve(patches_.size());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const int first = to_int(result.size());
    split_face(f, result);
    faces_[f].first_patch = first;
    faces_[f].patch_count = to_int(result.size()) - first;
  }
  patches_ = std::move(result);
}

}  // namespace

std::vector<dvec3> corner_points(const std::vector<Patch>& patches) {
  std::vector<dvec3> points;
  points.reserve(4 * patches.size());
  for (const Patch& patch : patches) {
    const BezierPatch& b = patch.bezier;
    for (const int i : {0, b.degree_u}) {
      for (const int j : {0, b.degree_v}) points.push_back(euclidean(b.at(i, j)));
    }
  }
  return points;
}

void split_crests(std::vector<Face>& faces, std::vector<Patch>& patches, const Box& box,
                  double bent, double grid, const Progress& progress) {
  RowSplitter(faces, patches, box, bent, progress).split_at_crests(grid);
}

void split_junctions(std::vector<Face>& faces, std::vector<Patch>& patches, const Box& box,
                     double bent, const Progress& progress) {
  // A cut may end inside of a side that met none before.
  std::vector<Face> cut_faces = faces;
  std::vector<Patch> cut_patches = patches;
  for (int round = 0; round < round_limit; ++round) {
    if (RowSplitter(cut_faces, cut_patches, box, bent, progress).split_at_junctions()) continue;
    if (round == 0) return;
    faces = std::move(cut_faces);
    patches = std::move(cut_patches);
    return;
  }
}

}  // namespace taut
