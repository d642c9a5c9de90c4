#include "taut/bounds/contact_geometry.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "taut/bounds/scene_content.h"
#include "taut/core/progress.h"
#include "taut/core/tolerances.h"
#include "taut/surface/nearest_parameter.h"

namespace taut {
namespace {

/// What a list has of the contact's element. A contact of another kind, or of none of the elements,
/// is a mistake of ours.
template <class Item>
const Item& own_of(const std::vector<Item>& all, const Contact& c,
                   [[maybe_unused]] SourceKind kind) {
  assert(c.kind == kind && c.element >= 0 && std::size_t(c.element) < all.size());
  return all[std::size_t(c.element)];
}

/// The points in the scene's units about the part's centre, as queries see them; w (x - c) is
/// rounded once.
std::vector<dvec4> moved(const std::vector<dvec4>& points, const dvec3& center, double scale) {
  std::vector<dvec4> result;
  result.reserve(points.size());
  for (const dvec4& p : points) {
    result.emplace_back(scale * std::fma(-p.w, center.x, p.x),
                        scale * std::fma(-p.w, center.y, p.y),
                        scale * std::fma(-p.w, center.z, p.z), p.w);
  }
  return result;
}

/// Makes the points of a collapsed side one point, where rounding has left some length of it, which
/// would turn the normals about it.
void collapse(BezierPatch& patch, Side side, double tie) {
  std::vector<dvec4*> points;
  const int last = along_v(side) ? patch.degree_v : patch.degree_u;
  points.reserve(std::size_t(last) + 1);
  for (int k = 0; k <= last; ++k) {
    const int u = at_upper_end(side) ? patch.degree_u : 0;
    const int v = at_upper_end(side) ? patch.degree_v : 0;
    points.push_back(along_v(side) ? &patch.at(u, k) : &patch.at(k, v));
  }
  const dvec3 x = euclidean(*points.front());
  const bool rounded = std::all_of(points.begin(), points.end(), [&](const dvec4* p) {
    return glm::distance(euclidean(*p), x) <= tie;
  });
  if (!rounded) return;
  for (dvec4* p : points) *p = homogeneous(x, p->w);
}

/// Whether the control points lie on the segment between two points, to within rounding: on the
/// line, and not beyond an end, where a curve may turn back.
bool is_on_segment(const BezierCurve& curve, const dvec3& from, const dvec3& to, double rounding) {
  const dvec3 along = unit(to - from);
  return std::all_of(curve.points.begin(), curve.points.end(), [&](const dvec4& p) {
    const dvec3 off = euclidean(p) - from;
    const double t = glm::dot(off, along);
    return glm::length(glm::cross(off, along)) <= rounding && t >= -rounding &&
           t <= glm::distance(from, to) + rounding;
  });
}

/// The vertex in which a piece ends, or the straight pieces do that go on from it; -1 if there is
/// none.
int last_vertex(const std::vector<EdgePiece>& pieces, const std::vector<bool>& segments, int piece,
                std::size_t end) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const EdgePiece& own = pieces[std::size_t(piece)];
    if (own.end_vertex[end] >= 0) return own.end_vertex[end];
    const int next = own.end_neighbor[end];
    if (next < 0 || !segments[std::size_t(next)]) return -1;
    end = pieces[std::size_t(next)].end_neighbor[0] == piece ? 1 : 0;
    piece = next;
  }
  return -1;
}

/// Edges are told straight when they are off by no more than this, in units of how far elements
/// that are one miss each other: that is an eighth of the resolution where these are asked for, and
/// what rounding moves points by is up to half of it.
constexpr double straight_share = 4;

/// Patches are told ruled likewise: seven eighths of the resolution are what rounding may do to the
/// distance of a point from a line or plane of others (cover_share).
constexpr double ruled_share = cover_share / tie_share;

/// And copies: what rounding may do to the distance of two points that are one.
constexpr double copy_share = cover_share / tie_share;

}  // namespace

std::optional<dvec2> parameter_rate(const ContactJet& j, const dvec3& n, const dvec3& dn) {
  if (j.dimension == 0) return dvec2(0.0);
  const dvec2 slope(glm::dot(j.dx[0], dn), glm::dot(j.dx[1], dn));
  const double uu = glm::dot(j.dxx, n);
  if (!(uu < 0)) return std::nullopt;
  if (j.dimension == 1) return dvec2(-slope.x / uu, 0);
  const double uv = glm::dot(j.dxy, n);
  const double vv = glm::dot(j.dyy, n);
  const double det = uu * vv - uv * uv;
  if (!(det > 0)) return std::nullopt;
  return dvec2(uv * slope.y - vv * slope.x, uv * slope.x - uu * slope.y) / det;
}

bool is_flat(const ContactJet& j, const dvec3& n, double least) {
  if (j.dimension == 0) return false;
  const double uu = glm::dot(j.dxx, n) / glm::dot(j.dx[0], j.dx[0]);
  if (j.dimension == 1) return uu > -least;
  const double uv = glm::dot(j.dxy, n) / (glm::length(j.dx[0]) * glm::length(j.dx[1]));
  const double vv = glm::dot(j.dyy, n) / glm::dot(j.dx[1], j.dx[1]);
  return uu * vv - uv * uv < least * std::abs(uu + vv);
}

ContactGeometry::ContactGeometry(const Scene& scene, Stop stop, double same)
    : scene_(scene), stop_(std::move(stop)) {
  const Box box = scene.model().control_box();
  const dvec3 farthest = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  rounding_ =
      coordinate_rounding * scene.frame().length_to_frame(farthest.x + farthest.y + farthest.z);
  tie_ = std::max(support_tie, rounding_);
  bent_ = ruled_share * same / scene.frame().scale;
  const SceneContent& content = scene.content();
  const std::vector<Part>& parts = scene.model().parts();
  parts_.resize(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (content.parts[k].repeats) continue;
    const Part& part = parts[k];
    const dvec3& center = content.parts[k].center;
    const double scale = content.frame.scale;
    PartElements& own = parts_[k];
    own.patches.reserve(part.patches().size());
    own.pieces.reserve(part.pieces().size());
    own.vertices.reserve(part.vertices().size());
    own.sides.resize(part.pieces().size());
    own.ruled_sides.resize(part.pieces().size());
    own.ends.resize(part.vertices().size());
    for (std::size_t i = 0; i < part.patches().size(); ++i) {
      check_stop();
      const Patch& patch = part.patches()[i];
      const BezierPatch& b = patch.bezier;
      own.patches.push_back({b.degree_u, b.degree_v, moved(b.points, center, scale)});
      for (const Side side : all_sides) {
        const Border& border = patch.borders[std::size_t(side)];
        if (border.kind == BorderKind::collapsed) collapse(own.patches.back(), side, tie_);
        if (border.piece < 0 || patch.repeats >= 0) continue;
        auto& sides = lines(patch).any() ? own.ruled_sides : own.sides;
        sides[std::size_t(border.piece)].push_back({-1, int(i), side, border.piece_reversed});
      }
    }
    for (std::size_t i = 0; i < part.pieces().size(); ++i) {
      check_stop();
      const EdgePiece& piece = part.pieces()[i];
      own.pieces.push_back({moved(piece.bezier.points, center, scale)});
      for (int end = 0; end < 2; ++end) {
        const int vertex = piece.end_vertex[std::size_t(end)];
        if (vertex >= 0) own.ends[std::size_t(vertex)].push_back({-1, int(i), end});
      }
    }
    for (const dvec3& p : part.vertices()) own.vertices.push_back(scale * (p - center));
    find_straight(part, straight_share * same, own);
  }
  find_repeated_elements(same);
}

PlacedElement ContactGeometry::placed(const Contact& c) const {
  const PartElements& own = elements(c);
  const SceneInstance& instance = scene_.content().instances[std::size_t(c.instance)];
  PlacedElement result{c.kind, c.instance, c.element, 0, 0, {}};
  if (c.kind == SourceKind::face) {
    const BezierPatch& patch = own_of(own.patches, c, SourceKind::face);
    result.degree_u = patch.degree_u;
    result.degree_v = patch.degree_v;
    result.points = patch.points;
  } else if (c.kind == SourceKind::edge) {
    result.points = own_of(own.pieces, c, SourceKind::edge).points;
    result.degree_u = int(result.points.size()) - 1;
  } else {
    result.points = {homogeneous(own_of(own.vertices, c, SourceKind::vertex))};
  }
  for (dvec4& p : result.points) {
    const dvec3 x = instance.rotated ? instance.rotation * dvec3(p) : dvec3(p);
    p = {x + p.w * instance.translation, p.w};
  }
  return result;
}

/// Straight pieces that go on into each other between two vertices are one segment.
void ContactGeometry::find_straight(const Part& part, double same, PartElements& own) const {
  std::vector<bool> segments;
  segments.reserve(own.pieces.size());
  for (const BezierCurve& piece : own.pieces) {
    check_stop();
    segments.push_back(is_on_segment(piece, euclidean(piece.points.front()),
                                     euclidean(piece.points.back()),
                                     std::max({coordinate_rounding, rounding_, same})));
  }
  own.straight.assign(own.pieces.size(), {-1, -1});
  for (std::size_t k = 0; k < own.pieces.size(); ++k) {
    if (!segments[k]) continue;
    const int first = last_vertex(part.pieces(), segments, int(k), 0);
    const int last = last_vertex(part.pieces(), segments, int(k), 1);
    if (first < 0 || last < 0) continue;
    // Joints may have kinks small enough to count as smooth.
    if (is_on_segment(own.pieces[k], own.vertices[std::size_t(first)],
                      own.vertices[std::size_t(last)], std::max(tie_, same))) {
      own.straight[k] = {first, last};
    }
  }
}

void ContactGeometry::find_repeated_elements(double same) {
  const Model& model = scene_.model();
  std::vector<PlacedElement> all;
  for (const int i : scene_.distinct_instances()) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    const auto add = [&](SourceKind kind, std::size_t count) {
      for (int k = 0; k < int(count); ++k) {
        check_stop();
        all.push_back(placed({i, kind, k, 0, 0}));
      }
    };
    add(SourceKind::face, part.patches().size());
    add(SourceKind::edge, part.pieces().size());
    add(SourceKind::vertex, part.vertices().size());
  }
  repeated_elements_ = RepeatedElements(all, std::max(tie_, copy_share * same));
  for (const Contact& c : repeated_elements_.all()) share(c);
  place_points(all);
}

/// Points beside which no edge ends, and that lie on an edge, are points of it.
void ContactGeometry::place_points(const std::vector<PlacedElement>& all) {
  struct Lone {
    dvec3 x;
    Contact vertex;
  };
  std::vector<Lone> points;
  for (const PlacedElement& e : all) {
    const Contact c{e.instance, e.kind, e.element, 0, 0};
    if (e.kind != SourceKind::vertex || is_repeated(c) || !ends(c).empty()) continue;
    points.push_back({dvec3(e.points[0]), c});
  }
  if (points.empty()) return;
  std::stable_sort(points.begin(), points.end(),
                   [](const Lone& a, const Lone& b) { return a.x.x < b.x.x; });
  for (const PlacedElement& e : all) {
    check_stop();
    const Contact c{e.instance, e.kind, e.element, 0, 0};
    if (e.kind != SourceKind::edge || is_repeated(c)) continue;
    Box box;
    for (const dvec4& p : e.points) box.include(euclidean(p));
    const dvec3 lower = box.lower - dvec3(tie_);
    const dvec3 upper = box.upper + dvec3(tie_);
    const BezierCurve curve{e.points};
    auto p = std::lower_bound(points.begin(), points.end(), lower.x,
                              [](const Lone& a, double x) { return a.x.x < x; });
    for (; p != points.end() && p->x.x <= upper.x; ++p) {
      if (glm::any(glm::lessThan(p->x, lower)) || glm::any(glm::greaterThan(p->x, upper))) continue;
      const double t = nearest_parameter(curve, p->x);
      if (glm::distance(taut::point(curve, t), p->x) > tie_) continue;
      repeated_elements_.place(p->vertex, {c.instance, c.kind, c.element, t, 0});
    }
  }
}

/// Lets the first element know what the repeated one has about it.
void ContactGeometry::share(const Contact& repeated) {
  if (repeated.kind == SourceKind::face) return;
  const Contact own = first(repeated);
  const Place place(own.instance, own.element);
  const PartElements& from = elements(repeated);
  const PartElements& to = elements(own);
  const auto merge = [&](auto& shared, const auto& own_list, const auto& more, const auto& add) {
    auto& list = shared.try_emplace(place, own_list[std::size_t(own.element)]).first->second;
    for (auto item : more[std::size_t(repeated.element)]) {
      item.instance = repeated.instance;
      add(item, list);
    }
  };
  if (repeated.kind == SourceKind::edge) {
    const bool reversed = repeated_elements_.reversed(repeated);
    const auto add = [&](PieceSide side, std::vector<PieceSide>& list) {
      if (is_repeated({side.instance, SourceKind::face, side.patch, 0, 0})) return;
      side.reversed = side.reversed != reversed;
      list.push_back(side);
    };
    merge(shared_sides_, to.sides, from.sides, add);
    merge(shared_ruled_sides_, to.ruled_sides, from.ruled_sides, add);
  } else {
    merge(shared_ends_, to.ends, from.ends, [&](PieceEnd end, std::vector<PieceEnd>& list) {
      if (!is_repeated({end.instance, SourceKind::edge, end.piece, 0, 0})) list.push_back(end);
    });
  }
}

const Part& ContactGeometry::part(const Contact& c) const {
  const Model& model = scene_.model();
  assert(c.instance >= 0 && std::size_t(c.instance) < model.instances().size());
  return model.parts()[std::size_t(model.instances()[std::size_t(c.instance)].part)];
}

const Patch& ContactGeometry::patch(const Contact& c) const {
  return own_of(part(c).patches(), c, SourceKind::face);
}

const ContactGeometry::PartElements& ContactGeometry::elements(const Contact& c) const {
  return parts_[std::size_t(scene_.content().instances[std::size_t(c.instance)].part)];
}

bool ContactGeometry::is_straight(const Contact& c) const {
  return own_of(elements(c).straight, c, SourceKind::edge)[0] >= 0;
}

bool ContactGeometry::is_beside_bent(const Contact& c) const {
  if (bent_ == 0 || c.kind != SourceKind::edge) return false;
  const std::vector<PieceSide>& ruled = ruled_sides(c);
  return std::any_of(ruled.begin(), ruled.end(), [&](const PieceSide& side) {
    const int instance = side.instance < 0 ? c.instance : side.instance;
    return !patch({instance, SourceKind::face, side.patch, 0, 0}).ruled();
  });
}

Contact ContactGeometry::straight_end(const Contact& c, int end) const {
  const int vertex = own_of(elements(c).straight, c, SourceKind::edge)[std::size_t(end)];
  return first({c.instance, SourceKind::vertex, vertex, 0, 0});
}

BezierCurve ContactGeometry::curve(const Contact& c) const { return {placed(c).points}; }

dvec3 ContactGeometry::to_local(int instance, const dvec3& n) const {
  const SceneInstance& own = scene_.content().instances[std::size_t(instance)];
  return own.rotated ? glm::transpose(own.rotation) * n : n;
}

dvec3 ContactGeometry::to_frame(int instance, const dvec3& direction) const {
  const SceneInstance& own = scene_.content().instances[std::size_t(instance)];
  return own.rotated ? own.rotation * direction : direction;
}

void ContactGeometry::start_evaluation() const { stop_.check(); }

ContactJet ContactGeometry::jet(const Contact& c) const {
  start_evaluation();
  const PartElements& own = elements(c);
  const SceneInstance& instance = scene_.content().instances[std::size_t(c.instance)];
  ContactJet result;
  if (c.kind == SourceKind::face) {
    const PatchJet2 j = jet2(own_of(own.patches, c, SourceKind::face), c.u, c.v);
    result = {2, j.S, {j.Su, j.Sv}, j.Suu, j.Suv, j.Svv};
  } else if (c.kind == SourceKind::edge) {
    const CurveJet j = taut::jet(own_of(own.pieces, c, SourceKind::edge), c.u);
    result = {1, j.c, {j.ct, dvec3(0.0)}, j.ctt, dvec3(0.0), dvec3(0.0)};
  } else {
    result.x = own_of(own.vertices, c, SourceKind::vertex);
  }
  if (instance.rotated) {
    const dmat3& R = instance.rotation;
    result.x = R * result.x;
    result.dx = {R * result.dx[0], R * result.dx[1]};
    result.dxx = R * result.dxx;
    result.dxy = R * result.dxy;
    result.dyy = R * result.dyy;
  }
  result.x += instance.translation;
  return result;
}

PatchJet3 ContactGeometry::patch_jet(const Contact& c) const {
  start_evaluation();
  PatchJet3 j = jet3(own_of(elements(c).patches, c, SourceKind::face), c.u, c.v);
  const SceneInstance& instance = scene_.content().instances[std::size_t(c.instance)];
  if (instance.rotated) {
    for (dvec3* x :
         {&j.S, &j.Su, &j.Sv, &j.Suu, &j.Suv, &j.Svv, &j.Suuu, &j.Suuv, &j.Suvv, &j.Svvv}) {
      *x = instance.rotation * *x;
    }
  }
  j.S += instance.translation;
  return j;
}

CurveJet ContactGeometry::curve_jet(const Contact& c) const {
  start_evaluation();
  CurveJet j = taut::jet(own_of(elements(c).pieces, c, SourceKind::edge), c.u);
  const SceneInstance& instance = scene_.content().instances[std::size_t(c.instance)];
  if (instance.rotated) {
    for (dvec3* x : {&j.c, &j.ct, &j.ctt, &j.cttt}) *x = instance.rotation * *x;
  }
  j.c += instance.translation;
  return j;
}

Contact ContactGeometry::canonical(const Contact& contact) const {
  const Contact c = first(contact);
  const auto at_vertex = [&](int vertex) {
    return first({c.instance, SourceKind::vertex, vertex, 0, 0});
  };
  const auto on_piece = [&](int index, double t) {
    const EdgePiece& piece = part(c).pieces()[std::size_t(index)];
    if (t == 0 && piece.end_vertex[0] >= 0) return at_vertex(piece.end_vertex[0]);
    if (t == 1 && piece.end_vertex[1] >= 0) return at_vertex(piece.end_vertex[1]);
    return first({c.instance, SourceKind::edge, index, t, 0});
  };
  if (c.kind == SourceKind::vertex) return c;
  if (c.kind == SourceKind::edge) return on_piece(c.element, c.u);
  const Patch& patch = this->patch(c);
  const std::array<bool, 4> at = {c.u == 0, c.u == 1, c.v == 0, c.v == 1};
  for (const Side side : all_sides) {
    const Border& border = patch.borders[std::size_t(side)];
    if (at[std::size_t(side)] && border.kind == BorderKind::collapsed && border.vertex >= 0) {
      return at_vertex(border.vertex);
    }
  }
  if ((at[0] || at[1]) && (at[2] || at[3])) {
    const int vertex = patch.corner_vertex[2 * std::size_t(at[1]) + std::size_t(at[3])];
    if (vertex >= 0) return at_vertex(vertex);
  }
  for (const Side side : all_sides) {
    const Border& border = patch.borders[std::size_t(side)];
    if (!at[std::size_t(side)] || border.piece < 0) continue;
    const double t = along_v(side) ? c.v : c.u;
    return on_piece(border.piece, border.piece_reversed ? 1 - t : t);
  }
  return c;
}

const EdgePiece& ContactGeometry::piece(const Contact& c) const {
  return own_of(part(c).pieces(), c, SourceKind::edge);
}

const std::vector<ContactGeometry::PieceSide>& ContactGeometry::sides(const Contact& c) const {
  assert(c.kind == SourceKind::edge);
  const auto shared = shared_sides_.find({c.instance, c.element});
  if (shared != shared_sides_.end()) return shared->second;
  return own_of(elements(c).sides, c, SourceKind::edge);
}

const std::vector<ContactGeometry::PieceSide>& ContactGeometry::ruled_sides(
    const Contact& c) const {
  assert(c.kind == SourceKind::edge);
  const auto shared = shared_ruled_sides_.find({c.instance, c.element});
  if (shared != shared_ruled_sides_.end()) return shared->second;
  return own_of(elements(c).ruled_sides, c, SourceKind::edge);
}

const std::vector<ContactGeometry::PieceEnd>& ContactGeometry::ends(const Contact& c) const {
  assert(c.kind == SourceKind::vertex);
  const auto shared = shared_ends_.find({c.instance, c.element});
  if (shared != shared_ends_.end()) return shared->second;
  return own_of(elements(c).ends, c, SourceKind::vertex);
}

}  // namespace taut
