#include "taut/hull/stitch/stitch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <span>
#include <tuple>

#include "taut/core/disjoint_sets.h"
#include "taut/hull/solve/tolerant_places.h"
#include "taut/hull/stitch/boundary_closure.h"
#include "taut/hull/stitch/curve_chains.h"
#include "taut/hull/stitch/edge_incidence.h"
#include "taut/hull/stitch/trim_stretches.h"
#include "taut/hull/stitch/whole_patches.h"

namespace taut {
namespace {

/// Both contacts are vertices: a crease.
bool vertices_only(const ArcPiece& piece) {
  const Ruling& r = piece.rulings.front();
  return r.contact[0].kind == SourceKind::vertex && r.contact[1].kind == SourceKind::vertex;
}

/// From one facet to the next all rulings are one segment, which supports in all their normals to
/// within `tie`: a crease, be its ends vertices or where edges go on smoothly into it. Where an
/// edge is all but level contacts on it may be found beside that on the way, no farther than
/// `extent`.
bool stands_still(const SeparatingArc& arc, double tie, double extent) {
  if (arc.facet[0] < 0 || arc.facet[1] < 0) return false;
  const Ruling& first = arc.pieces.front().rulings.front();
  const Ruling& last = arc.pieces.back().rulings.back();
  if (std::max(glm::distance(first.point[0], last.point[0]),
               glm::distance(first.point[1], last.point[1])) > std::max(tie, same_curve_end)) {
    return false;
  }
  const auto is_there = [&](const Ruling& r, std::size_t i) {
    const dvec3 moved = r.point[i] - first.point[i];
    const double far = r.contact[i].kind == SourceKind::face ? tie : extent;
    return glm::length(moved) <= far && std::abs(glm::dot(moved, r.n)) <= tie;
  };
  return std::all_of(arc.pieces.begin(), arc.pieces.end(), [&](const ArcPiece& piece) {
    return std::all_of(piece.rulings.begin(), piece.rulings.end(),
                       [&](const Ruling& r) { return is_there(r, 0) && is_there(r, 1); });
  });
}

class Stitcher {
 public:
  Stitcher(const ContactGeometry& geometry, SupportQuery& query, SeparatingGraph graph)
      : geometry_(geometry),
        graph_(std::move(graph)),
        boundary_(begin(geometry, graph_)),
        stretches_(geometry, graph_, regions_of(geometry, query, graph_, boundary_.unresolved),
                   boundary_.unresolved),
        rounded_(is_rounded(geometry.scene(), graph_.depth)),
        same_end_(std::max(rounded_ ? rounded_curve_end : same_curve_end, graph_.depth)) {}

  HullBoundary run(const Progress& progress);

 private:
  static HullBoundary begin(const ContactGeometry& geometry, const SeparatingGraph& graph) {
    HullBoundary boundary;
    boundary.frame = geometry.scene().frame();
    boundary.unresolved = graph.unresolved;
    return boundary;
  }

  static std::vector<TrimRegion> regions_of(const ContactGeometry& geometry, SupportQuery& query,
                                            const SeparatingGraph& graph,
                                            std::vector<Unresolved>& unresolved) {
    std::vector<TrimRegion> regions =
        trim_regions(geometry, graph, unresolved, std::sqrt(graph.depth));
    add_whole_patches(geometry, query, graph, regions, unresolved);
    return regions;
  }

  void make_patches();
  void make_scrolls();
  void make_facets();
  std::vector<CurveElement> bitangents() const;
  std::vector<int> patches_along(int arc, int contact) const;
  std::vector<dvec3> contact_points(int arc, int contact, const std::vector<int>& pieces) const;
  void make_joins();
  void make_creases();
  CurveElement crease(const EdgeIncidence::Stretch& c) const;
  /// A ruling between two faces, as they follow each other along an arc.
  struct Cut {
    int before, after;
    Ruling ruling;
  };
  std::vector<Cut> cuts() const;
  std::vector<dvec3> corners_of_scrolls() const;
  void find_corners() { corners_ = corners_of_scrolls(); }
  void make_rulings();
  void make_scroll_curves();
  int curve_of(int stretch) const { return stretches_.curve_of(stretch); }
  std::pair<std::vector<int>, bool> outline_from(int start) const;
  StretchPlace place_in_face(int stretch) const;
  void make_loops();
  void add_chains(HullCurveKind kind, const std::vector<CurveElement>& elements);
  int add_curve(HullCurveKind kind, int left, int right, int source, std::vector<dvec3> points,
                bool closed);
  void take_regions();
  void take_arcs();
  int face_of(int region) const { return face_of_region_[std::size_t(region)]; }
  int face_at(int stretch) const { return face_of(stretches_.region_of(stretch)); }
  int scroll_of(int arc, int piece) const {
    return scroll_of_[std::size_t(arc)][std::size_t(piece)];
  }
  void fail(const dvec3& n, const char* reason) { boundary_.unresolved.push_back({n, reason}); }

  const ContactGeometry& geometry_;
  SeparatingGraph graph_;
  HullBoundary boundary_;
  TrimStretches stretches_;
  std::vector<int> face_of_region_;
  std::vector<std::size_t> place_of_region_;  // among those of its face
  std::vector<std::vector<int>> scroll_of_;   // per arc and piece; -1 of creases
  std::vector<int> facet_of_;                 // per node
  bool rounded_;
  double same_end_;             // of curves
  std::vector<dvec3> corners_;  // in which curves end
  /// By arc, piece and contact: the curves along it, with their order.
  std::map<std::tuple<int, int, int>, std::vector<std::pair<double, int>>> along_scroll_;
};

/// Patches of the hull: regions joined across seams within a source face.
void Stitcher::make_patches() {
  const int count = int(stretches_.regions().size());
  DisjointSets sets(stretches_.regions().size());
  for (int k = 0; k < stretches_.count(); ++k) {
    geometry_.check_stop();
    if (stretches_.twin(k) < 0) continue;
    const int a = stretches_.region_of(k);
    const int b = stretches_.region_of(stretches_.twin(k));
    if (stretches_.source_of(a) == stretches_.source_of(b)) sets.unite(a, b);
  }
  face_of_region_.assign(std::size_t(count), -1);
  for (int r = 0; r < count; ++r) {
    const int first = sets.find(r);
    if (first != r) {
      face_of_region_[std::size_t(r)] = face_of(first);
      continue;
    }
    face_of_region_[std::size_t(r)] = int(boundary_.faces.size());
    HullFace face;
    face.kind = FaceKind::patch;
    face.source = stretches_.source_of(r);
    boundary_.faces.push_back(std::move(face));
  }
  std::vector<std::size_t> regions_of(boundary_.faces.size(), 0);
  for (const int face : face_of_region_)
    place_of_region_.push_back(regions_of[std::size_t(face)]++);
}

/// Scrolls: runs of pieces of an arc that are no creases.
void Stitcher::make_scrolls() {
  const double tie = rounded_ ? graph_.depth : geometry_.tie();
  const double extent = rounded_ ? std::sqrt(graph_.depth) : same_curve_end;
  for (int a = 0; a < int(graph_.arcs.size()); ++a) {
    const SeparatingArc& arc = graph_.arcs[std::size_t(a)];
    const int count = int(arc.pieces.size());
    scroll_of_.emplace_back(std::size_t(count), -1);
    if (stands_still(arc, tie, extent)) continue;
    std::vector<int>& own = scroll_of_.back();
    // A closed arc begins behind a crease, if there is one.
    int start = 0;
    for (int k = 0; k < count && arc.closed; ++k) {
      if (vertices_only(arc.pieces[std::size_t(k)])) start = (k + 1) % count;
    }
    int current = -1;
    for (int k = 0; k < count; ++k) {
      const int piece = (start + k) % count;
      if (vertices_only(arc.pieces[std::size_t(piece)])) {
        current = -1;
        continue;
      }
      if (current < 0) {
        current = int(boundary_.faces.size());
        HullFace face;
        face.kind = FaceKind::scroll;
        face.scroll = {a, piece, 0};
        boundary_.faces.push_back(std::move(face));
      }
      own[std::size_t(piece)] = current;
      ++boundary_.faces[std::size_t(current)].scroll.count;
    }
  }
}

void Stitcher::make_facets() {
  for (const FacetNode& node : graph_.nodes) {
    if (node.is_crossing) {
      facet_of_.push_back(-1);
      continue;
    }
    facet_of_.push_back(int(boundary_.faces.size()));
    HullFace face;
    face.kind = FaceKind::facet;
    face.n = node.n;
    face.offset = glm::dot(node.points.front(), node.n);
    for (std::size_t k = 0; k < node.points.size(); ++k) {
      // Corners are one for each of the contacts that touch each other in them.
      const bool repeated = !node.is_curved(k) && node.points.size() > 1 &&
                            node.points[k] == node.points[(k + 1) % node.points.size()];
      if (repeated) continue;
      face.contacts.push_back(node.contacts[k]);
      face.points.push_back(node.points[k]);
      if (!node.sides.empty()) face.sides.push_back(node.sides[k]);
    }
    boundary_.faces.push_back(std::move(face));
  }
}

int Stitcher::add_curve(HullCurveKind kind, int left, int right, int source,
                        std::vector<dvec3> points, bool closed) {
  HullCurve curve;
  curve.kind = kind;
  curve.faces = {left, right};
  curve.points = std::move(points);
  curve.closed = closed;
  curve.source = source;
  boundary_.curves.push_back(std::move(curve));
  return int(boundary_.curves.size()) - 1;
}

/// Per piece of the arc the patch of the hull along which its contact runs, or -1.
std::vector<int> Stitcher::patches_along(int arc, int contact) const {
  const std::size_t count = graph_.arcs[std::size_t(arc)].pieces.size();
  std::vector<int> result(count, -1);
  for (std::size_t k = 0; k < count; ++k) {
    const std::span<const int> along = stretches_.along(arc, int(k), contact);
    if (!along.empty()) result[k] = face_at(along.front());
  }
  return result;
}

/// The points of a contact along some pieces of an arc that follow each other.
std::vector<dvec3> Stitcher::contact_points(int arc, int contact,
                                            const std::vector<int>& pieces) const {
  std::vector<dvec3> points;
  for (const int piece : pieces) {
    for (const Ruling& r : graph_.arcs[std::size_t(arc)].pieces[std::size_t(piece)].rulings) {
      const dvec3& x = r.point[std::size_t(contact)];
      if (points.empty() || points.back() != x) points.push_back(x);
    }
  }
  return points;
}

/// Where a contact of a scroll runs along a patch: runs of pieces with the same two faces, with the
/// patch to the left.
std::vector<CurveElement> Stitcher::bitangents() const {
  std::vector<CurveElement> elements;
  for (int a = 0; a < int(graph_.arcs.size()); ++a) {
    const SeparatingArc& arc = graph_.arcs[std::size_t(a)];
    const int count = int(arc.pieces.size());
    for (int contact = 0; contact < 2; ++contact) {
      const std::vector<int> patch = patches_along(a, contact);
      const auto run_on = [&](int k, int next) {
        return patch[std::size_t(k)] >= 0 && patch[std::size_t(k)] == patch[std::size_t(next)] &&
               scroll_of(a, k) == scroll_of(a, next);
      };
      int start = 0;
      bool closed = arc.closed;
      for (int k = 0; k < count && arc.closed; ++k) {
        if (run_on(k, (k + 1) % count)) continue;
        start = (k + 1) % count;
        closed = false;
      }
      for (int k = 0; k < count;) {
        const int first = (start + k) % count;
        if (patch[std::size_t(first)] < 0) {
          ++k;
          continue;
        }
        std::vector<int> pieces;
        do {
          pieces.push_back((start + k) % count);
          ++k;
        } while (k < count && run_on(pieces.back(), (start + k) % count));
        CurveElement e;
        e.left = patch[std::size_t(first)];
        e.right = scroll_of(a, first);
        e.points = contact_points(a, contact, pieces);
        if (closed) e.points.back() = e.points.front();
        if (contact == 0) std::reverse(e.points.begin(), e.points.end());
        for (const int piece : pieces) {
          const std::span<const int> along = stretches_.along(a, piece, contact);
          e.stretches.insert(e.stretches.end(), along.begin(), along.end());
          e.contacts.push_back({a, piece, contact});
        }
        elements.push_back(std::move(e));
      }
    }
  }
  return elements;
}

/// Chains elements, and adds the curves that they make.
void Stitcher::add_chains(HullCurveKind kind, const std::vector<CurveElement>& elements) {
  for (const CurveChain& chain : chains(elements, corners_, same_end_)) {
    const CurveElement& e = elements[chain.elements.front()];
    const int curve =
        add_curve(kind, e.left, e.right, e.source, points_along(chain, elements), chain.closed);
    for (const std::size_t k : chain.elements) {
      for (const int s : elements[k].stretches) stretches_.set_curve(s, curve);
      for (const ScrollContact& c : elements[k].contacts) {
        along_scroll_[{c.arc, c.piece, c.contact}].emplace_back(c.order, curve);
      }
    }
  }
}

void Stitcher::make_joins() {
  std::vector<CurveElement> elements;
  for (int k = 0; k < stretches_.count(); ++k) {
    geometry_.check_stop();
    const int twin = stretches_.twin(k);
    if (twin < 0) continue;
    const int source = stretches_.source_of(stretches_.region_of(k));
    const int other = stretches_.source_of(stretches_.region_of(twin));
    if (face_at(k) >= face_at(twin) || source == other) continue;
    CurveElement e;
    e.left = face_at(k);
    e.right = face_at(twin);
    e.points = stretches_.polyline(k);
    e.stretches = {k, twin};
    elements.push_back(std::move(e));
  }
  add_chains(HullCurveKind::join, elements);
}

/// Of a stretch of an edge, or seam, with something to both sides.
CurveElement Stitcher::crease(const EdgeIncidence::Stretch& c) const {
  const auto face = [&](const EdgeIncidence::Neighbor& t) {
    return t.arc >= 0    ? scroll_of(t.arc, t.piece)
           : t.node >= 0 ? facet_of_[std::size_t(t.node)]
                         : face_of(t.region);
  };
  CurveElement e;
  e.left = face(c.low);
  e.right = face(c.high);
  e.points.reserve(border_points + 1);
  for (int k = 0; k <= border_points; ++k) {
    const double share = double(k) / border_points;
    const double t = k == border_points ? c.to : (1 - share) * c.from + share * c.to;
    e.points.push_back(geometry_.point({c.instance, SourceKind::edge, c.piece, t, 0}));
  }
  for (const EdgeIncidence::Neighbor& t : {c.low, c.high}) {
    if (t.region >= 0) e.stretches.push_back(stretches_.number(t.region, t.loop, t.index));
    // Along the arc the parameter grows or falls.
    if (t.arc >= 0) e.contacts.push_back({t.arc, t.piece, t.contact, t.sense * c.from});
  }
  return e;
}

/// Where faces meet in edges, and patches with scrolls along seams or inside.
void Stitcher::make_creases() {
  std::vector<CurveElement> edges;
  std::vector<CurveElement> inside = bitangents();
  for (const EdgeIncidence::Stretch& c :
       EdgeIncidence(geometry_, graph_, stretches_.regions()).overlay()) {
    const Contact at{c.instance, SourceKind::edge, c.piece, 0.5 * (c.from + c.to), 0};
    if (c.low.empty() || c.high.empty()) {
      fail(unit(geometry_.point(at)), "an edge lies on the hull on one side only");
      continue;
    }
    CurveElement e = crease(c);
    const int edge = geometry_.part(at).pieces()[std::size_t(c.piece)].edge;
    if (edge >= 0) {
      e.source = geometry_.scene().model().source_id({SourceKind::edge, c.instance, edge});
    }
    const bool lies_to_the_right =
        e.right >= 0 && boundary_.faces[std::size_t(e.right)].kind == FaceKind::patch;
    if (edge < 0 && lies_to_the_right) {
      std::swap(e.left, e.right);
      std::reverse(e.points.begin(), e.points.end());
    }
    (edge >= 0 ? edges : inside).push_back(std::move(e));
  }
  const auto is_patch = [&](int face) {
    return face >= 0 && boundary_.faces[std::size_t(face)].kind == FaceKind::patch;
  };
  for (const CurveElement& e : inside) {
    if (is_patch(e.left) == is_patch(e.right)) {
      fail(unit(e.points.front()), "a smooth surface is left on both sides of a curve, or none");
    }
  }
  add_chains(HullCurveKind::edge, edges);
  add_chains(HullCurveKind::bitangent, inside);
}

/// The ends of scrolls: segments between a scroll and a facet, another scroll beyond a crease,
/// or two facets.
std::vector<Stitcher::Cut> Stitcher::cuts() const {
  std::vector<Cut> cuts;
  for (int a = 0; a < int(graph_.arcs.size()); ++a) {
    const SeparatingArc& arc = graph_.arcs[std::size_t(a)];
    const int count = int(arc.pieces.size());
    const auto scroll = [&](int piece) { return scroll_of(a, piece); };
    const auto facet = [&](int end) {
      const int node = arc.facet[std::size_t(end)];
      return node < 0 ? -1 : facet_of_[std::size_t(node)];
    };
    if (!arc.closed) {
      int before = facet(0);
      bool open = before >= 0;  // a ruling is due between `before` and what comes next
      for (int k = 0; k < count; ++k) {
        const int next = scroll(k);
        if (next < 0) {
          open = true;
          continue;
        }
        if (open) cuts.push_back({before, next, arc.pieces[std::size_t(k)].rulings.front()});
        before = next;
        open = false;
      }
      const int last = facet(1);
      if (open || last >= 0) {
        cuts.push_back({before, last, arc.pieces.back().rulings.back()});
      }
    } else {
      for (int k = 0; k < count; ++k) {
        const int next = (k + 1) % count;
        if (scroll(k) >= 0 || scroll(next) < 0) continue;
        int before = k;
        while (scroll(before) < 0) before = (before + count - 1) % count;
        cuts.push_back(
            {scroll(before), scroll(next), arc.pieces[std::size_t(next)].rulings.front()});
      }
    }
  }
  return cuts;
}

/// Along n x d the faces follow each other; from contact 0 to contact 1 the next is to the right.
void Stitcher::make_rulings() {
  for (const Cut& cut : cuts()) {
    add_curve(HullCurveKind::ruling, cut.before, cut.after, -1,
              {cut.ruling.point[0], cut.ruling.point[1]}, false);
  }
}

/// Where a ruling ends between two parts of one scroll, or between its beginning and its end, the
/// curves along it have a corner, and where its two contacts are one, those along the one end.
std::vector<dvec3> Stitcher::corners_of_scrolls() const {
  std::vector<dvec3> corners;
  for (const SeparatingArc& arc : graph_.arcs) {
    const Ruling& first = arc.pieces.front().rulings.front();
    const Ruling& last = arc.pieces.back().rulings.back();
    for (const Ruling* end : {&first, &last}) {
      if (end->point[0] == end->point[1]) corners.push_back(end->point[0]);
    }
    for (const std::size_t i : {0u, 1u}) {
      const bool leads_back = glm::distance(first.point[i], last.point[i]) < same_end_;
      if (leads_back && !arc.closed) corners.push_back(first.point[i]);
    }
  }
  for (const Cut& cut : cuts()) {
    if (cut.before != cut.after) continue;
    corners.insert(corners.end(), cut.ruling.point.begin(), cut.ruling.point.end());
  }
  return corners;
}

/// The curves along a scroll's contacts, in the order of its rulings.
void Stitcher::make_scroll_curves() {
  for (HullFace& face : boundary_.faces) {
    if (face.kind != FaceKind::scroll) continue;
    const int count = int(graph_.arcs[std::size_t(face.scroll.arc)].pieces.size());
    for (int contact = 0; contact < 2; ++contact) {
      std::vector<int>& curves = face.scroll_curves[std::size_t(contact)];
      for (int k = 0; k < face.scroll.count; ++k) {
        const auto found =
            along_scroll_.find({face.scroll.arc, (face.scroll.first + k) % count, contact});
        if (found == along_scroll_.end()) continue;
        std::stable_sort(found->second.begin(), found->second.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [order, curve] : found->second) {
          if (curves.empty() || curves.back() != curve) curves.push_back(curve);
        }
      }
      if (curves.size() > 1 && curves.front() == curves.back()) curves.pop_back();
    }
  }
}

/// The stretches about a face from this one on, which is part of a curve, and whether they close;
/// seams within the source face are passed over.
std::pair<std::vector<int>, bool> Stitcher::outline_from(int start) const {
  const int limit = 4 * stretches_.count();
  std::vector<int> outline;
  int at = start;
  int steps = 0;
  do {
    outline.push_back(at);
    do {
      at = stretches_.next(at);
      if (curve_of(at) < 0 && stretches_.twin(at) >= 0) at = stretches_.twin(at);
      if (++steps > limit) return {std::move(outline), false};
    } while (curve_of(at) < 0);
  } while (at != start);
  return {std::move(outline), true};
}

/// The outlines of patches, as curves and as stretches.
void Stitcher::make_loops() {
  std::vector<bool> done(std::size_t(stretches_.count()), false);
  const auto directed = [&](int stretch) {
    const int curve = curve_of(stretch);
    const HullCurve& c = boundary_.curves[std::size_t(curve)];
    return std::pair(curve, c.faces[0] == face_at(stretch) ? 1 : -1);
  };
  for (int start = 0; start < int(done.size()); ++start) {
    geometry_.check_stop();
    if (done[std::size_t(start)] || curve_of(start) < 0) continue;
    auto [outline, closes] = outline_from(start);
    for (const int stretch : outline) done[std::size_t(stretch)] = true;
    if (!closes) {
      fail(dvec3(0.0), "the outline of a patch does not close");
      continue;
    }
    // From where a curve begins, if it is not one all around.
    const auto last_before = std::adjacent_find(
        outline.begin(), outline.end(), [&](int a, int b) { return directed(a) != directed(b); });
    if (last_before != outline.end()) {
      std::rotate(outline.begin(), std::next(last_before), outline.end());
    }
    HullFace& face = boundary_.faces[std::size_t(face_at(start))];
    const auto is_closed = [&](const std::pair<int, int>& curve) {
      return curve.first < 0 || boundary_.curves[std::size_t(curve.first)].closed;
    };
    std::pair<int, int> last = {-1, 0};
    for (const int stretch : outline) {
      const std::pair<int, int> curve = directed(stretch);
      // Closed curves that touch are outlines of their own.
      if (curve != last && (is_closed(curve) || is_closed(last))) {
        face.loops.emplace_back();
        face.outlines.emplace_back();
      }
      if (curve != last) face.loops.back().push_back(curve);
      face.outlines.back().push_back(place_in_face(stretch));
      last = curve;
    }
  }
}

/// The place of a stretch as take_regions() puts it there.
StretchPlace Stitcher::place_in_face(int stretch) const {
  const TrimStretches::Place& at = stretches_.place(stretch);
  const TrimRegion& region = stretches_.regions()[std::size_t(at.region)];
  const std::size_t last = region.loops[at.loop].size() - 1;
  return {place_of_region_[std::size_t(at.region)], at.loop,
          region.sign < 0 ? last - at.index : at.index};
}

/// Moves the regions to their faces.
void Stitcher::take_regions() {
  std::vector<TrimRegion> regions = stretches_.take();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    TrimRegion& from = regions[r];
    PatchRegion to{from.instance, from.patch, from.sign, std::move(from.loops)};
    if (from.sign < 0) {  // so that the region lies to the left in (u, v)
      for (auto& loop : to.loops) {
        std::reverse(loop.begin(), loop.end());
        for (TrimStretch& s : loop) {
          s.reversed = !s.reversed;
          std::swap(s.from, s.to);
        }
      }
    }
    boundary_.faces[std::size_t(face_of(int(r)))].regions.push_back(std::move(to));
  }
}

/// Moves the arcs, which end in faces now.
void Stitcher::take_arcs() {
  boundary_.arcs = std::move(graph_.arcs);
  for (SeparatingArc& arc : boundary_.arcs) {
    for (int& facet : arc.facet) facet = facet < 0 ? -1 : facet_of_[std::size_t(facet)];
  }
}

HullBoundary Stitcher::run(const Progress& progress) {
  constexpr std::array stages = {
      &Stitcher::make_patches, &Stitcher::make_scrolls,       &Stitcher::make_facets,
      &Stitcher::find_corners, &Stitcher::make_joins,         &Stitcher::make_creases,
      &Stitcher::make_rulings, &Stitcher::make_scroll_curves, &Stitcher::make_loops,
      &Stitcher::take_regions, &Stitcher::take_arcs};
  for (std::size_t k = 0; k < stages.size(); ++k) {
    progress.update("stitch", double(k + 1) / double(stages.size() + 1));
    (this->*stages[k])();
  }
  check_closure(boundary_, same_end_);
  return std::move(boundary_);
}

}  // namespace

HullBoundary stitch(const ContactGeometry& geometry, SupportQuery& query, SeparatingGraph graph,
                    const Progress& progress) {
  return Stitcher(geometry, query, std::move(graph)).run(progress);
}

}  // namespace taut
