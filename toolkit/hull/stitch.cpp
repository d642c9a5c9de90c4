#include "taut/hull/stitch.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <tuple>

#include "taut/hull/crease_tracks.h"
#include "taut/hull/ruled_faces.h"
#include "taut/hull/trim_loops.h"

namespace taut {
namespace {

/// Ends of curves nearer than this, in the scene's frame, are one point.
constexpr double same_point = 1e-7;
/// Two patches agree on where their common border leaves the hull to within this.
constexpr double same_parameter = 1e-6;
/// Points of a curve on a border of a patch.
constexpr int border_points = 8;

/// Sets of numbers that are joined step by step.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int root(int i) {
    while (parent_[std::size_t(i)] != i) {
      parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
      i = parent_[std::size_t(i)];
    }
    return i;
  }
  /// The smaller root becomes that of both.
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

/// A contact of a piece of an arc and, where several curves lie along it, their order.
struct ScrollContact {
  int arc, piece, contact;
  double order = 0;
};

/// A piece of a curve between two faces, to be chained with others.
struct CurveElement {
  int left = -1;
  int right = -1;
  int source = -1;
  std::vector<dvec3> points;
  /// The stretches (see Stitcher::StretchAt) along it: whose face is to the left, and to the right.
  int stretch_left = -1;
  int stretch_right = -1;
  /// The scrolls' contacts along it.
  std::vector<ScrollContact> contacts;
};

bool vertices_only(const ArcPiece& piece) {
  const Ruling& r = piece.rulings.front();
  return r.contact[0].kind == SourceKind::vertex && r.contact[1].kind == SourceKind::vertex;
}

class Stitcher {
 public:
  Stitcher(const ContactGeometry& geometry, SupportQuery& query, SeparatingGraph graph)
      : geometry_(geometry), query_(query), graph_(std::move(graph)) {
    boundary_.frame = geometry.scene().frame();
    boundary_.unresolved = graph_.unresolved;
  }

  HullBoundary run(const std::vector<CulledCell>& cells);

 private:
  /// A stretch of a region's outline.
  struct StretchAt {
    int region;
    std::size_t loop, index;
  };
  TrimStretch& stretch(const StretchAt& at) {
    return regions_[std::size_t(at.region)].loops[at.loop][at.index];
  }
  int number_of(const StretchAt& at) const {
    return first_of_loop_.at({at.region, at.loop}) + int(at.index);
  }
  const Border& border(const TrimRegion& region, Side side) const {
    return patch(region).borders[std::size_t(side)];
  }
  const Patch& patch(const TrimRegion& r) const {
    return geometry_.part(contact(r, {})).patches()[std::size_t(r.patch)];
  }
  static Contact contact(const TrimRegion& r, const dvec2& at) {
    return {r.instance, SourceKind::face, r.patch, at.x, at.y};
  }
  int source_of(const TrimRegion& r) const {
    return geometry_.scene().model().source_id({SourceKind::face, r.instance, patch(r).face});
  }
  dvec3 border_point(const TrimRegion& r, Side side, double t) const;
  std::vector<dvec3> border_polyline(const TrimRegion& r, const TrimStretch& s) const;
  dvec3 normal(const TrimRegion& r, Side side, double t) const;

  void split_at_creases();
  void index_stretches();
  void match_joins();
  void make_patches();
  void make_scrolls();
  void make_facets();
  void make_bitangents();
  void make_joins();
  void make_creases();
  void make_rulings();
  void make_scroll_curves();
  void make_loops();
  void check();
  void chain(HullCurveKind kind, const std::vector<CurveElement>& elements);
  void add_chain(HullCurveKind kind, const std::vector<CurveElement>& elements,
                 const std::deque<std::size_t>& run, bool closed);
  int add_curve(HullCurveKind kind, int left, int right, int source, std::vector<dvec3> points,
                bool closed);
  int face_of(int region) { return face_of_region_[std::size_t(region)]; }
  void fail(const dvec3& n, const char* reason) { boundary_.unresolved.push_back({n, reason}); }

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  SeparatingGraph graph_;
  HullBoundary boundary_;
  std::vector<TrimRegion> regions_;
  std::vector<StretchAt> stretches_;
  std::map<std::pair<int, std::size_t>, int> first_of_loop_;  // by region and loop: a stretch
  std::vector<int> twin_;  // per stretch on a smooth border: that of the other side
  std::map<std::tuple<int, int, int>, std::vector<int>> trace_;  // arc, piece, contact: stretches
  std::vector<int> face_of_region_;
  std::vector<std::vector<int>> scroll_of_;  // per arc and piece; -1 between vertices
  std::vector<int> facet_of_;                // per node
  /// By arc, piece and contact: the curves along it, with their order.
  std::map<std::tuple<int, int, int>, std::vector<std::pair<double, int>>> along_scroll_;
};

dvec3 Stitcher::border_point(const TrimRegion& r, Side side, double t) const {
  return geometry_.point(contact(r, on_side(side, t)));
}

std::vector<dvec3> Stitcher::border_polyline(const TrimRegion& r, const TrimStretch& s) const {
  std::vector<dvec3> points;
  for (int k = 0; k <= border_points; ++k) {
    const double share = double(k) / border_points;
    points.push_back(
        border_point(r, s.side, k == border_points ? s.to : (1 - share) * s.from + share * s.to));
  }
  return points;
}

dvec3 Stitcher::normal(const TrimRegion& r, Side side, double t) const {
  const ContactJet j = geometry_.jet(contact(r, on_side(side, t)));
  return double(r.sign) * unit(glm::cross(j.dx[0], j.dx[1]));
}

void Stitcher::index_stretches() {
  stretches_.clear();
  trace_.clear();
  for (int r = 0; r < int(regions_.size()); ++r) {
    const auto& loops = regions_[std::size_t(r)].loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
      for (std::size_t k = 0; k < loops[l].size(); ++k) {
        const TrimStretch& s = loops[l][k];
        if (s.arc >= 0) trace_[{s.arc, s.piece, s.contact}].push_back(int(stretches_.size()));
        if (k == 0) first_of_loop_[{r, l}] = int(stretches_.size());
        stretches_.push_back({r, l, k});
      }
    }
  }
  twin_.assign(stretches_.size(), -1);
}

/// Finds, for every stretch on a smooth border, the same one of the neighbouring patch.
void Stitcher::match_joins() {
  std::map<std::tuple<int, int, int>, std::vector<int>> on;  // instance, patch, side: stretches
  for (int k = 0; k < int(stretches_.size()); ++k) {
    const TrimStretch& s = stretch(stretches_[std::size_t(k)]);
    const TrimRegion& r = regions_[std::size_t(stretches_[std::size_t(k)].region)];
    const bool on_border = s.arc < 0;
    if (on_border && border(r, s.side).kind == BorderKind::smooth && border(r, s.side).piece < 0) {
      on[{r.instance, r.patch, int(s.side)}].push_back(k);
    }
  }
  for (const auto& [key, own] : on) {
    for (const int k : own) {
      if (twin_[std::size_t(k)] >= 0) continue;
      const TrimStretch& s = stretch(stretches_[std::size_t(k)]);
      const TrimRegion& r = regions_[std::size_t(stretches_[std::size_t(k)].region)];
      const Border& b = border(r, s.side);
      const auto over = [&](double t) { return b.reversed ? 1 - t : t; };
      const auto found = on.find({r.instance, b.neighbor, int(b.neighbor_side)});
      int twin = -1;
      if (found != on.end()) {
        for (const int other : found->second) {
          if (other == k || twin_[std::size_t(other)] >= 0) continue;
          const TrimStretch& t = stretch(stretches_[std::size_t(other)]);
          // The neighbour passes it the other way.
          if (std::abs(over(s.from) - t.to) < same_parameter &&
              std::abs(over(s.to) - t.from) < same_parameter) {
            twin = other;
            break;
          }
        }
      }
      if (twin < 0) {
        fail(normal(r, s.side, 0.5 * (s.from + s.to)),
             "two patches disagree on how much of their join lies on the hull");
        continue;
      }
      twin_[std::size_t(k)] = twin;
      twin_[std::size_t(twin)] = k;
    }
  }
}

/// Patches of the hull: regions joined across seams within a source face.
void Stitcher::make_patches() {
  UnionFind sets(regions_.size());
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    if (twin_[k] < 0) continue;
    const int a = stretches_[k].region;
    const int b = stretches_[std::size_t(twin_[k])].region;
    if (source_of(regions_[std::size_t(a)]) == source_of(regions_[std::size_t(b)])) sets.join(a, b);
  }
  face_of_region_.assign(regions_.size(), -1);
  for (int r = 0; r < int(regions_.size()); ++r) {
    const int root = sets.root(r);
    if (root == r) {
      face_of_region_[std::size_t(r)] = int(boundary_.faces.size());
      HullFace face;
      face.kind = FaceKind::patch;
      face.source = source_of(regions_[std::size_t(r)]);
      boundary_.faces.push_back(std::move(face));
    } else {
      face_of_region_[std::size_t(r)] = face_of_region_[std::size_t(root)];
    }
  }
}

/// Scrolls: runs of pieces of an arc that are not between two vertices.
void Stitcher::make_scrolls() {
  for (int a = 0; a < int(graph_.arcs.size()); ++a) {
    const SeparatingArc& arc = graph_.arcs[std::size_t(a)];
    const int count = int(arc.pieces.size());
    scroll_of_.emplace_back(std::size_t(count), -1);
    std::vector<int>& own = scroll_of_.back();
    // A closed arc begins behind a segment between vertices, if there is one.
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
    if (node.is_crossing()) {
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

/// Where a contact of a scroll runs along a patch: maximal runs of pieces with the same two faces.
void Stitcher::make_bitangents() {
  for (int a = 0; a < int(graph_.arcs.size()); ++a) {
    const SeparatingArc& arc = graph_.arcs[std::size_t(a)];
    const int count = int(arc.pieces.size());
    for (int contact = 0; contact < 2; ++contact) {
      const auto i = std::size_t(contact);
      std::vector<int> patch(std::size_t(count), -1);
      for (int k = 0; k < count; ++k) {
        const auto found = trace_.find({a, k, contact});
        if (found != trace_.end()) {
          patch[std::size_t(k)] = face_of(stretches_[std::size_t(found->second.front())].region);
        }
      }
      const auto run_on = [&](int k, int next) {
        return patch[std::size_t(k)] >= 0 && patch[std::size_t(k)] == patch[std::size_t(next)] &&
               scroll_of_[std::size_t(a)][std::size_t(k)] ==
                   scroll_of_[std::size_t(a)][std::size_t(next)];
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
        std::vector<dvec3> points;
        std::vector<int> pieces;
        for (;;) {
          const int piece = (start + k) % count;
          pieces.push_back(piece);
          for (const Ruling& r : arc.pieces[std::size_t(piece)].rulings) {
            if (points.empty() || points.back() != r.point[i]) points.push_back(r.point[i]);
          }
          ++k;
          if (k >= count || !run_on(piece, (start + k) % count)) break;
        }
        if (closed) points.back() = points.front();
        // Walked along with the patch to the left.
        if (contact == 0) std::reverse(points.begin(), points.end());
        const int scroll = scroll_of_[std::size_t(a)][std::size_t(first)];
        const int curve = add_curve(HullCurveKind::bitangent, patch[std::size_t(first)], scroll, -1,
                                    std::move(points), closed);
        for (const int piece : pieces) {
          for (const int s : trace_[{a, piece, contact}]) {
            stretch(stretches_[std::size_t(s)]).curve = curve;
          }
          along_scroll_[{a, piece, contact}].emplace_back(0.0, curve);
        }
      }
    }
  }
}

/// Chains elements with the same faces and source, head to tail.
void Stitcher::chain(HullCurveKind kind, const std::vector<CurveElement>& elements) {
  std::map<std::tuple<int, int, int>, std::vector<std::size_t>> alike;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    alike[{elements[k].left, elements[k].right, elements[k].source}].push_back(k);
  }
  std::vector<bool> used(elements.size(), false);
  const auto follows = [&](std::size_t a, std::size_t b) {
    return glm::distance(elements[a].points.back(), elements[b].points.front()) < same_point;
  };
  for (const auto& entry : alike) {
    const std::vector<std::size_t>& group = entry.second;
    const auto unused = [&](auto matches) {
      return std::find_if(group.begin(), group.end(),
                          [&](std::size_t k) { return !used[k] && matches(k); });
    };
    for (const std::size_t start : group) {
      if (used[start]) continue;
      std::deque<std::size_t> run = {start};
      used[start] = true;
      bool closed = follows(start, start);
      while (!closed) {
        const auto next = unused([&](std::size_t k) { return follows(run.back(), k); });
        if (next == group.end()) break;
        run.push_back(*next);
        used[*next] = true;
        closed = follows(*next, start);
      }
      while (!closed) {
        const auto before = unused([&](std::size_t k) { return follows(k, run.front()); });
        if (before == group.end()) break;
        run.push_front(*before);
        used[*before] = true;
      }
      add_chain(kind, elements, run, closed);
    }
  }
}

void Stitcher::add_chain(HullCurveKind kind, const std::vector<CurveElement>& elements,
                         const std::deque<std::size_t>& run, bool closed) {
  std::vector<dvec3> points;
  for (const std::size_t k : run) {
    const auto& own = elements[k].points;
    points.insert(points.end(), own.begin() + (points.empty() ? 0 : 1), own.end());
  }
  if (closed) points.back() = points.front();
  const CurveElement& e = elements[run.front()];
  const int curve = add_curve(kind, e.left, e.right, e.source, std::move(points), closed);
  for (const std::size_t k : run) {
    for (const int s : {elements[k].stretch_left, elements[k].stretch_right}) {
      if (s >= 0) stretch(stretches_[std::size_t(s)]).curve = curve;
    }
    for (const ScrollContact& c : elements[k].contacts) {
      along_scroll_[{c.arc, c.piece, c.contact}].emplace_back(c.order, curve);
    }
  }
}

void Stitcher::make_joins() {
  std::vector<CurveElement> elements;
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    if (twin_[k] < 0) continue;
    const int left = face_of(stretches_[k].region);
    const int right = face_of(stretches_[std::size_t(twin_[k])].region);
    const TrimRegion& r = regions_[std::size_t(stretches_[k].region)];
    const TrimRegion& other = regions_[std::size_t(stretches_[std::size_t(twin_[k])].region)];
    if (left >= right || source_of(r) == source_of(other)) continue;
    CurveElement e;
    e.left = left;
    e.right = right;
    e.points = border_polyline(r, stretch(stretches_[k]));
    e.stretch_left = int(k);
    e.stretch_right = twin_[k];
    elements.push_back(std::move(e));
  }
  chain(HullCurveKind::join, elements);
}

/// Splits the stretches on edges where what lies beyond the edge changes.
void Stitcher::split_at_creases() {
  const CreaseTracks tracks(geometry_, graph_, regions_);
  for (TrimRegion& r : regions_) {
    for (auto& loop : r.loops) {
      std::vector<TrimStretch> split;
      for (const TrimStretch& s : loop) {
        const Border& b = border(r, s.side);
        if (s.arc >= 0 || b.piece < 0) {
          split.push_back(s);
          continue;
        }
        double from = s.from;
        const Contact low = geometry_.first({r.instance, SourceKind::edge, b.piece, 0, 0});
        const bool reversed = b.piece_reversed != (low.u != 0);
        for (const double t : tracks.breaks(low.instance, low.element, reversed, s.from, s.to)) {
          split.push_back(s);
          split.back().from = from;
          split.back().to = t;
          from = t;
        }
        split.push_back(s);
        split.back().from = from;
      }
      loop = std::move(split);
    }
  }
}

/// Where faces meet in edges, and in seams.
void Stitcher::make_creases() {
  const CreaseTracks tracks(geometry_, graph_, regions_);
  std::vector<CurveElement> edges;
  std::vector<CurveElement> seams;
  const auto face = [&](const CreaseTracks::Track& t) {
    return t.arc >= 0    ? scroll_of_[std::size_t(t.arc)][std::size_t(t.piece)]
           : t.node >= 0 ? facet_of_[std::size_t(t.node)]
                         : face_of(t.region);
  };
  const auto stretch_at = [&](const CreaseTracks::Track& t) {
    return t.region < 0 ? -1 : number_of({t.region, t.loop, t.index});
  };
  for (const CreaseTracks::Stretch& c : tracks.overlay()) {
    const Contact at{c.instance, SourceKind::edge, c.piece, 0.5 * (c.from + c.to), 0};
    if (c.low.empty() || c.high.empty()) {
      fail(unit(geometry_.point(at)), "an edge lies on the hull on one side only");
      continue;
    }
    CurveElement e;
    e.left = face(c.low);
    e.right = face(c.high);
    const int edge = geometry_.part(at).pieces()[std::size_t(c.piece)].edge;
    if (edge >= 0) {
      const Model& model = geometry_.scene().model();
      e.source = model.source_id({SourceKind::edge, c.instance, edge});
    }
    e.points.reserve(border_points + 1);
    for (int k = 0; k <= border_points; ++k) {
      const double share = double(k) / border_points;
      const double t = k == border_points ? c.to : (1 - share) * c.from + share * c.to;
      e.points.push_back(geometry_.point({c.instance, SourceKind::edge, c.piece, t, 0}));
    }
    e.stretch_left = stretch_at(c.low);
    e.stretch_right = stretch_at(c.high);
    for (const CreaseTracks::Track& t : {c.low, c.high}) {
      // Along the arc the parameter grows or falls.
      if (t.arc >= 0) e.contacts.push_back({t.arc, t.piece, t.contact, t.sense * c.from});
    }
    (edge >= 0 ? edges : seams).push_back(std::move(e));
  }
  chain(HullCurveKind::edge, edges);
  chain(HullCurveKind::bitangent, seams);
}

/// The ends of scrolls: segments between a scroll and a facet, another scroll beyond a segment
/// between vertices, or two facets.
void Stitcher::make_rulings() {
  for (int a = 0; a < int(graph_.arcs.size()); ++a) {
    const SeparatingArc& arc = graph_.arcs[std::size_t(a)];
    const int count = int(arc.pieces.size());
    struct Cut {
      int before, after;  // faces
      Ruling ruling;
    };
    std::vector<Cut> cuts;
    const auto scroll = [&](int piece) { return scroll_of_[std::size_t(a)][std::size_t(piece)]; };
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
    for (const Cut& cut : cuts) {
      // Along n x d the faces follow each other; from contact 0 to contact 1 the next is to the
      // right.
      add_curve(HullCurveKind::ruling, cut.before, cut.after, -1,
                {cut.ruling.point[0], cut.ruling.point[1]}, false);
    }
  }
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

/// The outlines of patches as curves; seams within a source face are passed over.
void Stitcher::make_loops() {
  const auto next = [&](int k) {
    const StretchAt& at = stretches_[std::size_t(k)];
    const auto& loop = regions_[std::size_t(at.region)].loops[at.loop];
    return number_of({at.region, at.loop, (at.index + 1) % loop.size()});
  };
  const auto curve_of = [&](int k) { return stretch(stretches_[std::size_t(k)]).curve; };
  std::vector<bool> done(stretches_.size(), false);
  for (int start = 0; start < int(stretches_.size()); ++start) {
    if (done[std::size_t(start)] || curve_of(start) < 0) continue;
    std::vector<std::pair<int, int>> loop;
    int at = start;
    std::size_t steps = 0;
    do {
      done[std::size_t(at)] = true;
      const int curve = curve_of(at);
      const int face = face_of(stretches_[std::size_t(at)].region);
      const HullCurve& c = boundary_.curves[std::size_t(curve)];
      const int sense = c.faces[0] == face ? 1 : -1;
      if (loop.empty() || loop.back() != std::pair(curve, sense)) loop.emplace_back(curve, sense);
      do {
        at = next(at);
        if (curve_of(at) < 0 && twin_[std::size_t(at)] >= 0) at = twin_[std::size_t(at)];
        if (++steps > 4 * stretches_.size()) break;
      } while (curve_of(at) < 0);
    } while (at != start && steps <= 4 * stretches_.size());
    if (at != start) {
      fail(dvec3(0.0), "the outline of a patch does not close");
      continue;
    }
    if (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    const int face = face_of(stretches_[std::size_t(start)].region);
    boundary_.faces[std::size_t(face)].loops.push_back(std::move(loop));
  }
}

/// Every curve has two faces, and V - E + F, with every face counted by its own Euler
/// characteristic, is that of the sphere.
void Stitcher::check() {
  for (const HullCurve& c : boundary_.curves) {
    if (c.faces[0] < 0 || c.faces[1] < 0) {
      fail(unit(c.points.front()), "a curve has no two faces");
    }
  }
  std::vector<dvec3> vertices;
  int characteristic = 0;
  const auto add_vertex = [&](const dvec3& p) {
    for (const dvec3& q : vertices) {
      if (glm::distance(p, q) < same_point) return;
    }
    vertices.push_back(p);
  };
  for (const HullCurve& c : boundary_.curves) {
    if (c.closed) continue;
    --characteristic;
    add_vertex(c.points.front());
    add_vertex(c.points.back());
  }
  characteristic += int(vertices.size());
  for (const HullFace& f : boundary_.faces) {
    if (f.kind == FaceKind::patch) {
      characteristic += 2 - int(f.loops.size());
    } else if (f.kind == FaceKind::facet) {
      ++characteristic;
    } else {
      // A closed scroll is an annulus, unless it is a cone.
      const SeparatingArc& arc = graph_.arcs[std::size_t(f.scroll.arc)];
      const bool closed = arc.closed && f.scroll.count == int(arc.pieces.size());
      const bool cone = std::any_of(arc.pieces.front().rulings.front().contact.begin(),
                                    arc.pieces.front().rulings.front().contact.end(),
                                    [](const Contact& c) { return c.kind == SourceKind::vertex; });
      characteristic += closed && !cone ? 0 : 1;
    }
  }
  if (characteristic != 2 && boundary_.unresolved.empty()) {
    fail(dvec3(0.0), "the faces that were found do not close to a sphere");
  }
}

HullBoundary Stitcher::run(const std::vector<CulledCell>& cells) {
  regions_ = trim_regions(geometry_, query_, graph_, cells, boundary_.unresolved);
  split_at_creases();
  index_stretches();
  match_joins();
  make_patches();
  make_scrolls();
  make_facets();
  make_bitangents();
  make_joins();
  make_creases();
  make_rulings();
  make_scroll_curves();
  make_loops();
  check();
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    TrimRegion& from = regions_[r];
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
  boundary_.arcs = std::move(graph_.arcs);
  for (SeparatingArc& arc : boundary_.arcs) {
    for (int& facet : arc.facet) facet = facet < 0 ? -1 : facet_of_[std::size_t(facet)];
  }
  label_ruled_faces(geometry_, boundary_);
  return std::move(boundary_);
}

}  // namespace

HullBoundary stitch(const ContactGeometry& geometry, SupportQuery& query, SeparatingGraph graph,
                    const std::vector<CulledCell>& cells) {
  return Stitcher(geometry, query, std::move(graph)).run(cells);
}

}  // namespace taut
