#include "taut/hull/decide/cell_decider.h"

#include <algorithm>
#include <array>
#include <utility>

#include "taut/bounds/scene_content.h"
#include "taut/core/tolerances.h"
#include "taut/hull/decide/hanging_branches.h"

namespace taut {
namespace {

/// Support points of cells above that are compared with.
constexpr std::size_t beacon_limit = 20;
/// Branches of which each adds a point.
constexpr std::size_t branch_beacons = 4;
/// Rounds of splitting pieces in a cell before it is split.
constexpr int refinement_limit = 12;
/// Pieces of a cell up to which those that bend both ways are split.
constexpr std::size_t sharpened_limit = 48;
/// What is below the convex hull of the rest by this share of the resolution is left out then.
constexpr double sharp_share = 0.5;
/// Pieces of a cell beyond which it is split rather than looked at.
constexpr std::size_t looked_at_limit = 200;
/// Contacts in line, at most.
constexpr std::size_t line_limit = 8;
/// Heights are differences of two support values, and of sums of some coefficients.
constexpr double noise_units = 4;

Box box_of(const Branch& branch) { return {branch.lower, branch.upper}; }

/// A point of a contact tells by its place which of them it is of.
bool boxes_part(const std::vector<Branch>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      if (box_gaps(box_of(all[i]), box_of(all[j])) == dvec3(0.0)) return false;
    }
  }
  return true;
}

}  // namespace

CellDecider::CellDecider(const MapPieces& pieces, const DirectionMapOptions& options)
    : pieces_(pieces),
      options_(options),
      query_(pieces.geometry().scene(), options.stop),
      view_(pieces, noise_units * pieces.geometry().scene().content().rounding),
      domination_(pieces.budget_left() * options.resolution),
      index_(pieces, options.resolution),
      concavity_(pieces, options.resolution),
      ridge_(pieces, options.resolution),
      differences_(pieces, view_, branches_, cover_share * options.resolution),
      planes_(view_, branches_, options.resolution),
      border_(view_, branches_, query_) {}

LookedAtCell CellDecider::decide(const OpenCell& open) {
  options_.stop.check();
  const long queries = query_.queries();
  const long looked = view_.looked();
  LookedAtCell result;
  result.cell = open.cell;
  result.beacons = open.beacons;
  MapCell& cell = result.cell;
  const std::array<dvec3, 4> d = DirectionMap::corners(cell);
  const Support support = query_(unit(d[0] + d[3]), open.hint);
  cell.contact = support.contact;
  contact_ = support.contact;
  std::vector<dvec3>& beacons = result.beacons;
  beacons.push_back(support.point);
  while (beacons.size() > beacon_limit) beacons.erase(beacons.begin());
  turn_to(cell, support.point, beacons);
  drop_low(beacons);
  for (const MapPiece* piece : *open.pieces) view_.look(*piece);
  view_.finish();
  const std::optional<MapCellKind> kind = kind_of_cell(cell, result.pieces);
  if (kind) {
    finish(cell, *kind);
    if (cell.has_plane()) result.pieces = pieces_left();
  } else {
    result.splits = true;
    add_branch_points(beacons);
    // Of pieces that were split in vain there would be ever more.
    std::vector<const MapPiece*> sharp = pieces_left();
    if (sharp.size() <= result.pieces.size()) result.pieces = std::move(sharp);
  }
  result.candidates = view_.looked() - looked;
  result.queries = query_.queries() - queries;
  return result;
}

void CellDecider::turn_to(const MapCell& cell, const dvec3& q, const std::vector<dvec3>& beacons) {
  axes_ = face_axes(cell.face);
  view_.turn_to(DirectionMap::corners(cell), q, beacons);
  differences_.turn_to(axes_.first, axes_.second);
  planes_.turn_to(axes_);
}

/// None if it is to be split. `left`: the pieces before those that bend both ways were.
std::optional<MapCellKind> CellDecider::kind_of_cell(const MapCell& cell,
                                                     std::vector<const MapPiece*>& left) {
  std::optional<MapCellKind> kind = decided(true);
  // Of three contacts one may not reach the others, and of more the border is to tell: finer
  // pieces tell more.
  const auto is_open_row = [&] { return kind == MapCellKind::in_line && line_.empty(); };
  const auto is_settled = [&] { return kind && *kind != MapCellKind::node && !is_open_row(); };
  for (int round = 0; round < refinement_limit && !is_settled() && view_.refine(); ++round) {
    kind = decided(false);
  }
  if (!kind) kind = decided_last();
  left = pieces_left();
  if (!kind) kind = decided_sharply(cell.level);
  if (is_open_row() && !planes_.is_spot() && is_facet()) kind = MapCellKind::facet;
  if (kind == MapCellKind::node || is_open_row()) kind = kind_by_border();
  // What others are dominated by touches one plane: elsewhere they may be what supports.
  if (kind == MapCellKind::node && !dominated_.empty() && !planes_.is_near(planes_.node().normal)) {
    kind.reset();
  }
  if (!kind && cell.level >= options_.level_limit) kind = MapCellKind::undecided;
  return kind;
}

std::vector<const MapPiece*> CellDecider::pieces_left() const {
  std::vector<const MapPiece*> left;
  left.reserve(view_.seen().size());
  for (const SeenPiece& s : view_.seen()) left.push_back(s.piece);
  return left;
}

void CellDecider::finish(MapCell& cell, MapCellKind kind) const {
  cell.kind = kind;
  if (cell.has_plane()) {
    const CellPlanes::Plane plane = kind == MapCellKind::facet ? *facet_ : planes_.node();
    cell.normal = plane.normal;
    cell.width = plane.width;
  }
  for (const Branch& b : branches_.all()) cell.contacts.push_back(box_of(b));
  cell.apart = int(cell.contacts.size());
  cell.contacts.insert(cell.contacts.end(), dominated_.begin(), dominated_.end());
  if (kind != MapCellKind::region && kind != MapCellKind::undecided) {
    cell.translates = differences_.translates();
    cell.rounds = differences_.rounds();
  }
  if (kind == MapCellKind::in_line) put_in_line(cell);
}

/// Points that are nowhere the highest in a cell are so nowhere in its quarters.
void CellDecider::drop_low(std::vector<dvec3>& beacons) const {
  std::vector<dvec3> left;
  for (std::size_t k = 0; k < beacons.size(); ++k) {
    if (view_.is_highest(k)) left.push_back(beacons[k]);
  }
  beacons.swap(left);
}

/// What surpasses the rest of a branch, or of others, though it may not support itself.
void CellDecider::add_branch_points(std::vector<dvec3>& beacons) {
  if (branches_.all().size() > branch_beacons) return;
  branch_points_.find(view_, branches_);
  for (std::size_t b = 0; b < branches_.all().size(); ++b) {
    const auto& points = branch_points_.points(b);
    beacons.insert(beacons.end(), points.begin(), points.end());
  }
}

void CellDecider::put_in_line(MapCell& cell) const {
  const std::vector<Box> contacts = cell.contacts;
  const std::vector<MapCell::Round> rounds = cell.rounds;
  for (std::size_t k = 0; k < line_.size(); ++k) {
    const auto from = std::size_t(line_[k]);
    cell.contacts[k] = contacts[from];
    if (!rounds.empty()) cell.rounds[k] = rounds[from];
  }
  cell.translates.clear();  // rounds, and boxes that part, tell more
}

std::optional<MapCellKind> CellDecider::decided(bool before_splits) {
  dominated_.clear();
  if (view_.seen().size() > view_.crowding() * looked_at_limit) {
    branches_.clear();
    if (is_facet()) return MapCellKind::facet;
    return is_flat() ? std::optional(MapCellKind::flat) : std::nullopt;
  }
  branches_.find(view_);
  // Something supports: what is taken for granted of the model does not hold.
  if (branches_.all().empty()) return MapCellKind::undecided;
  if (const auto kind = kind_of_branches(false)) return kind;
  // All that is near all the planes hangs together.
  if (is_flat()) {
    const bool is_one = hang_together(view_, branches_, options_.resolution);
    return is_one ? MapCellKind::region : MapCellKind::flat;
  }
  return before_splits && !planes_.is_spot() && is_facet() ? std::optional(MapCellKind::facet)
                                                           : std::nullopt;
}

/// What takes longer, for pieces that are as fine as they become.
std::optional<MapCellKind> CellDecider::decided_last() {
  if (view_.seen().size() > view_.crowding() * looked_at_limit) return std::nullopt;
  if (!planes_.is_spot() && is_facet()) return MapCellKind::facet;
  if (are_one()) return MapCellKind::region;
  if (const auto kind = kind_of_branches(true)) return kind;
  return kind_without_dominated();
}

/// From what supports in the cell, or all but: pieces are split where they bend both ways, the
/// more often the smaller the cell has had to become.
std::optional<MapCellKind> CellDecider::decided_sharply(int level) {
  for (int round = 1; round < level / 2; ++round) {
    if (view_.seen().size() > sharpened_limit) return std::nullopt;
    if (!view_.sharpen(sharp_share * options_.resolution, shares_of_branches()))
      return std::nullopt;
    branches_.find(view_);
    if (are_one()) return MapCellKind::region;
    if (const auto kind = kind_of_branches(true)) return kind;
  }
  return std::nullopt;
}

/// Of the seen pieces, in the extents of their branches: where slopes grow over a piece they do so
/// for all that is beyond it.
std::vector<double> CellDecider::shares_of_branches() const {
  std::vector<double> shares(view_.seen().size(), 1);
  for (const Branch& branch : branches_.all()) {
    const double whole = glm::distance(branch.lower, branch.upper);
    for (const int chart : branch.charts) {
      for (const int k : branches_.chart(chart).pieces) {
        const Box& box = view_.seen()[std::size_t(k)].piece->box;
        const double own = glm::distance(box.lower, box.upper);
        if (own < whole) shares[std::size_t(k)] = own / whole;
      }
    }
  }
  return shares;
}

/// Branches are parts of a surface that has one contact.
bool CellDecider::are_one() {
  if (branches_.all().size() < 2 || !are_of_one_surface()) return false;
  if (!index_.are_one_of_more(view_, branches_)) return false;
  branches_.unite();
  return true;
}

bool CellDecider::are_of_one_surface() const {
  const std::vector<Branch>& all = branches_.all();
  const auto surface = [&](const Branch& branch) {
    int found = -1;
    for (const int chart : branch.charts) {
      found = std::max(found, pieces_.element(branches_.chart(chart).element).surface);
    }
    return found;
  };
  const int first = surface(all.front());
  return first >= 0 && std::all_of(all.begin(), all.end(),
                                   [&](const Branch& branch) { return surface(branch) == first; });
}

/// Without the branches that others stand for to within what is left of the resolution. (The only
/// one that is left would have to be told from these.)
std::optional<MapCellKind> CellDecider::kind_without_dominated() {
  const std::vector<Branch> all = branches_.all();
  if (all.size() < 3) return std::nullopt;
  branch_points_.find(view_, branches_);
  const std::vector<bool> left = domination_.left(view_, branch_points_, branches_);
  const auto count = std::count(left.begin(), left.end(), true);
  if (count < 2 || count == std::ptrdiff_t(all.size())) return std::nullopt;
  branches_.keep(left);
  const std::optional<MapCellKind> kind = kind_of_branches(true);
  for (std::size_t b = 0; b < all.size() && kind; ++b) {
    if (!left[b]) dominated_.push_back(box_of(all[b]));
  }
  return kind;
}

std::optional<MapCellKind> CellDecider::kind_of_branches(bool extends) {
  const std::vector<Branch>& all = branches_.all();
  const std::optional<MapCellKind> kind = kind_of_contacts(all);
  if (!kind) return std::nullopt;
  for (const Branch& branch : all) {
    if (!differences_.is_round(branch) && !index_.is_one(view_, branches_, branch) &&
        !concavity_.is_one(view_, branches_, branch) &&
        !(extends && index_.is_one_of_more(view_, branches_, branch)) &&
        !(extends && index_.is_one_of_pieces(view_, branches_, branch)) &&
        !(extends && ridge_.are_one(view_, branches_, branch))) {
      return std::nullopt;
    }
  }
  return kind;
}

/// If each branch has one contact.
std::optional<MapCellKind> CellDecider::kind_of_contacts(const std::vector<Branch>& all) {
  if (all.size() == 1) return MapCellKind::region;
  if (all.empty() || all.size() > line_limit) return std::nullopt;
  line_.clear();
  const bool part = boxes_part(all);
  if (part) order_.find(view_, branches_, axes_.first, axes_.second);
  if (all.size() == 2) {
    const bool is_arc = (part && order_.apart(0, 1)) || differences_.is_arc(all[0], all[1]);
    return is_arc ? std::optional(MapCellKind::arc) : std::nullopt;
  }
  if (all.size() > 3) return part ? kind_of_row() : std::nullopt;
  if ((part && order_.go_around(0, 1, 2)) || differences_.is_node(all[0], all[1], all[2])) {
    return MapCellKind::node;
  }
  const std::optional<std::array<int, 3>> line = differences_.line_of(all);
  if (!line) return part ? kind_of_row() : std::nullopt;
  line_.assign(line->begin(), line->end());
  return MapCellKind::in_line;
}

/// Along one of the axes: each stands out from those beside it, so that no others exchange; or
/// all between are on one side of lines from one to another, and the border tells.
std::optional<MapCellKind> CellDecider::kind_of_row() {
  for (const std::size_t axis : {0u, 1u}) {
    const std::optional<std::vector<int>> row = order_.row(axis);
    if (!row) continue;
    branch_points_.find(view_, branches_);
    bool all_stand_out = true;
    for (std::size_t k = 1; k + 1 < row->size() && all_stand_out; ++k) {
      all_stand_out = stands_out(view_, branch_points_, branches_, std::size_t((*row)[k]),
                                 std::size_t((*row)[k - 1]), std::size_t((*row)[k + 1]));
    }
    if (all_stand_out) line_ = *row;
    if (all_stand_out || order_.go_around_alike(*row)) return MapCellKind::in_line;
  }
  return std::nullopt;
}

/// Of what may be a node, or not, and of what may be in line.
std::optional<MapCellKind> CellDecider::kind_by_border() {
  const std::vector<Branch>& all = branches_.all();
  const auto open = all.size() == 3 ? std::optional(MapCellKind::node) : std::nullopt;
  // Of what is dominated it is not told where it supports.
  if (!dominated_.empty() || !boxes_part(all)) return open;
  order_.find(view_, branches_, axes_.first, axes_.second);
  const std::optional<CellBorder::Found> found = border_.find(order_, contact_);
  if (!found || found->is_node) return open;
  std::vector<bool> left(all.size(), false);
  for (const int k : found->supporting) left[std::size_t(k)] = true;
  line_ = found->supporting;
  for (int& k : line_) k = int(std::count(left.begin(), left.begin() + k, true));
  branches_.keep(left);
  constexpr std::array kinds = {MapCellKind::region, MapCellKind::arc};
  return line_.size() <= kinds.size() ? kinds[line_.size() - 1] : MapCellKind::in_line;
}

/// The plane touches the model, be its normal in the cell or beside it.
bool CellDecider::is_facet() {
  facet_ = planes_.facet();
  if (!facet_) return false;
  const dvec3 top = query_(facet_->normal, contact_).point;
  const double depth = 2 * options_.resolution + pieces_.covered_above();
  if (glm::dot(top - view_.q(), facet_->normal) > depth) facet_.reset();
  return facet_.has_value();
}

/// All that is left is within the resolution of the supporting planes of all directions; and what
/// is left for being below what others stand for no farther than that from the rest.
bool CellDecider::is_flat() const {
  const double depth = options_.resolution + pieces_.covered_above();
  return std::all_of(view_.seen().begin(), view_.seen().end(), [&](const SeenPiece& s) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(view_.highest()[c] - s.low[c] <= depth)) return false;
    }
    return true;
  });
}

}  // namespace taut
