#include "taut/hull/decide/pieces.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/poles.h"
#include "taut/bounds/scene_content.h"
#include "taut/bounds/vector_net.h"
#include "taut/core/disjoint_sets.h"
#include "taut/hull/decide/nearly_straight.h"
#include "taut/hull/decide/placed_net.h"
#include "taut/hull/decide/translates.h"

namespace taut {
namespace {

/// The derivative across a side, into the patch, as a net along the side.
std::vector<dvec4> inward_net(NetShape shape, const std::vector<dvec4>& points, Side side,
                              bool reversed) {
  const int row = shape.q + 1;
  const auto at = [&](int i, int j) { return points[std::size_t(i * row + j)]; };
  std::vector<dvec4> result;
  const int count = along_v(side) ? shape.q : shape.p;
  const int last = along_v(side) ? shape.p : shape.q;
  const int own = at_upper_end(side) ? last : 0;
  const int next = at_upper_end(side) ? last - 1 : 1;
  for (int k = 0; k <= count; ++k) {
    result.push_back(along_v(side) ? at(next, k) - at(own, k) : at(k, next) - at(k, own));
  }
  if (reversed) std::reverse(result.begin(), result.end());
  return result;
}

}  // namespace

MapPieces::MapPieces(const ContactGeometry& geometry, double resolution,
                     const std::function<void(double)>& report)
    : geometry_(geometry), resolution_(resolution), joins_(geometry) {
  const Scene& scene = geometry.scene();
  const Model& model = scene.model();
  std::vector<Contact> copies;
  first_.resize(model.instances().size(), {-1, -1, -1});
  for (const int i : scene.distinct_instances()) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    const std::array<std::size_t, 3> counts = {part.patches().size(), part.pieces().size(),
                                               part.vertices().size()};
    for (const SourceKind kind : {SourceKind::face, SourceKind::edge, SourceKind::vertex}) {
      first_[std::size_t(i)][std::size_t(kind)] = int(index_.size());
      index_.resize(index_.size() + counts[std::size_t(kind)], -1);
      for (int k = 0; k < int(counts[std::size_t(kind)]); ++k) {
        geometry.check_stop();
        const Contact c{i, kind, k, 0, 0};
        if (geometry.is_repeated(c)) copies.push_back(c);
        if (geometry.is_repeated(c) || joins_.passes(c)) continue;
        const std::size_t before = elements_.size();
        if (kind == SourceKind::face) {
          const Patch& patch = part.patches()[std::size_t(k)];
          if (patch.repeats >= 0) continue;
          const bool is_ruled = geometry.is_ruled(c);
          any_bent_ = any_bent_ || (is_ruled && !patch.ruled());
          if (!is_ruled) add_face(c);
        } else if (kind == SourceKind::edge) {
          add_edge(c);
        } else {
          add_vertex(c);
        }
        if (elements_.size() > before) {
          index_[std::size_t(first_[std::size_t(i)][std::size_t(kind)] + k)] = int(before);
        }
      }
    }
  }
  find_beside();
  find_beyond(report);
  find_surfaces();
  Likenesses found = find_translates(*this, cover_share * resolution);
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    elements_[k].likeness = std::move(found.of_elements[k]);
  }
  rounds_ = std::move(found.rounds);
  cover_straight(resolution);
  const bool are_apart = geometry.copies_apart() > geometry.tie();
  any_covered_ = any_bent_ || are_apart ||
                 std::any_of(elements_.begin(), elements_.end(),
                             [](const auto& e) { return e.likeness.covered; });
  if (are_apart) std::for_each(copies.begin(), copies.end(), [&](const auto& c) { let_stand(c); });
  let_neighbors_stand();
}

/// Of edges. What straight ones stand for is off by what these are off by too, if it is not
/// straight itself.
void MapPieces::cover_straight(double resolution) {
  const NearlyStraight straight = nearly_straight(*this, cover_share * resolution);
  std::set<int> others;  // groups
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    const Likeness& likeness = elements_[k].likeness;
    if (likeness.covered && !straight.edges[k]) others.insert(likeness.group);
  }
  const NearlyStraight very = nearly_straight(*this, (1 - cover_share) * resolution);
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    Likeness& likeness = elements_[k].likeness;
    const bool is_of_others = likeness.group >= 0 && others.count(likeness.group) > 0;
    if (is_of_others ? very.edges[k] : straight.edges[k]) likeness.covered = true;
    if (straight.ends[k]) likeness.stands_for_others = true;
  }
}

/// A patch that is no element is told by its borders, and these, if they are none, by their ends.
void MapPieces::let_stand(const Contact& c) {
  const int element = find_first(c);
  if (element >= 0) elements_[std::size_t(element)].likeness.stands_for_others = true;
  if (element < 0 && c.kind == SourceKind::face) let_ends_stand(c);
  if (element < 0 && c.kind == SourceKind::edge) {
    for (const int end : geometry_.piece(c).end_vertex) {
      if (end >= 0) let_stand({c.instance, SourceKind::vertex, end, 0, 0});
    }
  }
}

/// Borders of a patch with its corners, ends of an edge's piece with what it goes on into.
void MapPieces::let_ends_stand(const Contact& c) {
  const auto let = [&](SourceKind kind, int index) {
    if (index >= 0) let_stand({c.instance, kind, index, 0, 0});
  };
  if (c.kind == SourceKind::face) {
    const Patch& patch = geometry_.patch(c);
    for (const Border& border : patch.borders) {
      let(SourceKind::edge, border.piece);
      let(SourceKind::vertex, border.vertex);
    }
    for (const int vertex : patch.corner_vertex) let(SourceKind::vertex, vertex);
  } else if (c.kind == SourceKind::edge) {
    const EdgePiece& piece = geometry_.piece(c);
    for (const int end : piece.end_vertex) let(SourceKind::vertex, end);
    for (const int next : piece.end_neighbor) let(SourceKind::edge, next);
  }
}

/// The highest point of what stands for others may be that of what is beside it: contacts differ by
/// as little as shapes do.
void MapPieces::let_neighbors_stand() {
  const std::vector<MapElement> before = elements_;
  for (const MapElement& element : before) {
    if (!element.likeness.stands_for_others) continue;
    const auto let_element = [&](int k) {
      if (k >= 0) elements_[std::size_t(k)].likeness.stands_for_others = true;
    };
    let_ends_stand(element.contact);
    for (const MapElement::Beyond& beyond : element.beyond) let_element(beyond.element);
    for (const auto& next : element.next) let_element(next[0]);
  }
}

std::vector<Contact> MapPieces::covered_patches() const {
  std::vector<Contact> found;
  for (const MapElement& e : elements_) {
    const Contact& c = e.contact;
    if (c.kind != SourceKind::face || !e.likeness.covered) continue;
    const auto is_covered = [&](SourceKind kind, int index) {
      const int own = index < 0 ? -1 : find({c.instance, kind, index, 0, 0});
      return own < 0 || element(own).likeness.covered;
    };
    const Patch& patch = geometry_.patch(c);
    const bool all = std::all_of(patch.borders.begin(), patch.borders.end(), [&](const Border& b) {
      return is_covered(SourceKind::edge, b.piece) && is_covered(SourceKind::vertex, b.vertex);
    });
    const auto& corners = patch.corner_vertex;
    if (all && std::all_of(corners.begin(), corners.end(),
                           [&](int v) { return is_covered(SourceKind::vertex, v); })) {
      found.push_back(c);
    }
  }
  return found;
}

std::vector<Contact> MapPieces::covered_edges() const {
  std::vector<Contact> found;
  for (const MapElement& e : elements_) {
    const Contact& c = e.contact;
    if (c.kind != SourceKind::edge || !e.likeness.covered) continue;
    const auto& sides = geometry_.ruled_sides(c);
    const bool goes_on = std::any_of(sides.begin(), sides.end(), [&](const auto& side) {
      const int instance = side.instance < 0 ? c.instance : side.instance;
      const Patch& patch = geometry_.patch({instance, SourceKind::face, side.patch, 0, 0});
      const int end = patch.borders[std::size_t(opposite(side.side))].piece;
      const int own = end < 0 ? -1 : find({instance, SourceKind::edge, end, 0, 0});
      return own >= 0 && !element(own).likeness.covered;
    });
    if (goes_on) found.push_back(c);
  }
  return found;
}

double MapPieces::budget_left() const { return any_covered_ ? 1 - cover_share : cover_share; }

void MapPieces::find_beside() {
  for (MapElement& element : elements_) {
    const Contact& c = element.contact;
    if (c.kind == SourceKind::edge) {
      for (const auto* list : {&geometry_.sides(c), &geometry_.ruled_sides(c)}) {
        for (const ContactGeometry::PieceSide& side : *list) {
          const int instance = side.instance < 0 ? c.instance : side.instance;
          element.beside.push_back(find({instance, SourceKind::face, side.patch, 0, 0}));
        }
      }
    } else if (c.kind == SourceKind::vertex) {
      for (const ContactGeometry::PieceEnd& end : geometry_.ends(c)) {
        const int instance = end.instance < 0 ? c.instance : end.instance;
        element.beside.push_back(find_first({instance, SourceKind::edge, end.piece, 0, 0}));
      }
    }
  }
}

void MapPieces::find_beyond(const std::function<void(double)>& report) {
  std::size_t done = 0;
  for (MapElement& element : elements_) {
    geometry_.check_stop();
    if (report) report(double(done++) / double(elements_.size()));
    const Contact& c = element.contact;
    for (const Side side : all_sides) {
      if (c.kind != SourceKind::face) break;
      const std::optional<SmoothJoins::Side> beyond = joins_.beyond(c, side);
      if (!beyond) continue;
      element.kink[std::size_t(side)] = joins_.kink(c, side);
      if (beyond->patch.instance < 0) continue;
      element.beyond[std::size_t(side)] = {find(beyond->patch), beyond->side, beyond->reversed};
    }
    for (const int end : {0, 1}) {
      if (c.kind != SourceKind::edge) break;
      const std::optional<SmoothJoins::End> beyond = joins_.beyond(c, end);
      if (beyond) element.next[std::size_t(end)] = {find(beyond->piece), beyond->end};
      element.kink[std::size_t(end)] = joins_.kink(c, end);
    }
  }
}

void MapPieces::find_surfaces() {
  DisjointSets sets(elements_.size());
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    for (const MapElement::Beyond& beyond : elements_[k].beyond) {
      if (beyond.element >= 0) sets.unite(int(k), beyond.element);
    }
  }
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    if (elements_[k].contact.kind == SourceKind::face) elements_[k].surface = sets.find(int(k));
  }
}

int MapPieces::find(const Contact& c) const {
  const int first = first_[std::size_t(c.instance)][std::size_t(c.kind)];
  return first < 0 ? -1 : index_[std::size_t(first + c.element)];
}

int MapPieces::find_first(const Contact& c) const {
  const Contact first = geometry_.first(c);
  return first.kind == c.kind ? find(first) : -1;
}

bool MapPieces::is_pole(const MapElement& element, Side side) const {
  const Contact& c = element.contact;
  const Border& border = geometry_.patch(c).borders[std::size_t(side)];
  return border.kind == BorderKind::collapsed &&
         (border.vertex < 0 || is_passed({c.instance, SourceKind::vertex, border.vertex, 0, 0}));
}

bool MapPieces::runs_against_first(const Contact& c) const {
  return geometry_.first({c.instance, c.kind, c.element, 0, 0}).u > 0.5;
}

void MapPieces::add(MapElement element, MapPiece::Root root) {
  root.element = int(elements_.size());
  root.rational = element.rational;
  element.root = &roots_.emplace_back(root);
  elements_.push_back(std::move(element));
}

std::vector<dvec4> MapPieces::placed_patch(const Contact& c, NetShape& shape) const {
  const SceneContent& content = geometry_.scene().content();
  const SceneElement& e = content.part_of(c.instance).elements[std::size_t(content.element(c))];
  shape = e.shape;
  return placed_net(content, c.instance, e);
}

std::vector<dvec3> MapPieces::control_points() const {
  const SceneContent& content = geometry_.scene().content();
  std::vector<dvec3> result;
  for (const int i : content.distinct_instances) {
    for (const SceneElement& e : content.part_of(i).elements) {
      geometry_.check_stop();
      for (const dvec4& p : placed_net(content, i, e)) result.push_back(euclidean(p));
    }
  }
  for (const MapElement& e : elements_) {
    if (e.contact.kind == SourceKind::vertex) result.push_back(geometry_.point(e.contact));
  }
  return result;
}

void MapPieces::add_face(const Contact& c) {
  NetShape shape;
  const std::vector<dvec4> points = placed_patch(c, shape);
  MapElement element;
  element.contact = c;
  element.rational = !is_polynomial(points);
  for (const Side side : all_sides) {
    element.collapsed[std::size_t(side)] =
        geometry_.patch(c).borders[std::size_t(side)].kind == BorderKind::collapsed;
  }
  MapPiece::Root root;
  root.u = root.v = {0, 1};
  root.net = {shape, points};
  add(std::move(element), std::move(root));
}

void MapPieces::add_edge(const Contact& c) {
  if (geometry_.is_straight(c)) return;
  const auto& sides = geometry_.sides(c);
  const auto& ruled = geometry_.ruled_sides(c);
  // The contacts of a seam are those of the surface beside it, unless it has none.
  if (geometry_.piece(c).edge < 0 && !sides.empty()) return;
  BezierCurve curve = geometry_.curve(c);
  if (is_polynomial(curve.points)) {
    for (dvec4& p : curve.points) p = homogeneous(euclidean(p));
  }
  MapElement element;
  element.contact = c;
  element.rational = !is_polynomial(curve.points);
  MapPiece::Root root;
  root.u = {0, 1};
  root.net = {{curve.degree(), 0}, curve.points};
  for (const auto* list : {&sides, &ruled}) {
    for (const ContactGeometry::PieceSide& side : *list) {
      NetShape shape;
      const int instance = side.instance < 0 ? c.instance : side.instance;
      const std::vector<dvec4> points =
          placed_patch({instance, SourceKind::face, side.patch, 0, 0}, shape);
      std::vector<dvec4> inward = inward_net(shape, points, side.side, side.reversed);
      const int degree = int(inward.size()) - 1;
      root.inward.push_back({{degree, 0}, std::move(inward)});
    }
  }
  add(std::move(element), std::move(root));
}

void MapPieces::add_vertex(const Contact& c) {
  MapPiece::Root root;
  root.net = {{0, 0}, {homogeneous(geometry_.point(c))}};
  for (const ContactGeometry::PieceEnd& end : geometry_.ends(c)) {
    root.inward.push_back({{0, 0}, {dvec4(tangent_from(geometry_, c, end), 0)}});
  }
  MapElement element;
  element.contact = c;
  add(std::move(element), std::move(root));
}

void MapPieces::restricted(int element, const Interval& u, const Interval& v,
                           std::vector<dvec4>& points) const {
  const StoredNet& net = elements_[std::size_t(element)].root->exact;
  points.assign(net.points, net.points + net.shape.size());
  restrict_net(net.shape, points.data(), u, net.shape.q > 0 ? v : Interval{0, 1});
}

}  // namespace taut
