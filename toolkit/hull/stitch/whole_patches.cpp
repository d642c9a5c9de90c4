#include "taut/hull/stitch/whole_patches.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/supporting_plane.h"
#include "taut/hull/stitch/edge_incidence.h"

namespace taut {
namespace {

/// Gauss curvature, in the scene's frame, below which a surface is flat or developable.
constexpr double flat_curvature = 1e-10;

class WholePatches {
 public:
  WholePatches(const ContactGeometry& geometry, SupportQuery& query, const SeparatingGraph& graph,
               std::vector<TrimRegion>& regions, std::vector<Unresolved>& unresolved)
      : geometry_(geometry),
        query_(query),
        graph_(graph),
        depth_(graph.depth),
        regions_(regions),
        unresolved_(unresolved) {
    for (const TrimRegion& r : regions) known_.emplace(r.instance, r.patch, r.sign);
  }

  void run() {
    if (!has_curved_patches()) return;
    if (regions_.empty() && graph_.arcs.empty() && graph_.nodes.empty()) begin();
    do {
      spread();
    } while (pass_edges() || pass_vertices());
  }

 private:
  /// A patch, and the side of it that is the hull's outside.
  struct Sided {
    Contact middle;
    int sign = 1;
  };

  /// Ruled ones are parts of scrolls and facets.
  bool has_curved_patches() const {
    const Model& model = geometry_.scene().model();
    return std::any_of(model.parts().begin(), model.parts().end(), [&](const Part& part) {
      return std::any_of(part.patches().begin(), part.patches().end(),
                         [&](const Patch& patch) { return !geometry_.lines(patch).any(); });
    });
  }

  dvec3 normal(const Contact& c, int sign) const {
    const ContactJet j = geometry_.jet(c);
    return double(sign) * unit(glm::cross(j.dx[0], j.dx[1]));
  }
  Contact middle_of(int instance, int patch) const {
    return geometry_.first({instance, SourceKind::face, patch, 0.5, 0.5});
  }
  bool is_known(const Sided& s) const {
    return known_.count({s.middle.instance, s.middle.element, s.sign}) > 0;
  }
  bool supports(const Sided& s) const {
    if (geometry_.is_ruled(s.middle)) return false;
    const dvec3 n = normal(s.middle, s.sign);
    if (is_in_facet(s, n)) return false;
    const double h = glm::dot(geometry_.point(s.middle), n);
    return n != dvec3(0.0) && is_supporting(geometry_, query_, n, h, s.middle, depth_);
  }

  /// The patch lies in the plane of a facet to within the depth, so that it is part of that: on the
  /// side that n tells.
  bool is_in_facet(const Sided& s, const dvec3& n) const {
    return std::any_of(graph_.nodes.begin(), graph_.nodes.end(), [&](const FacetNode& node) {
      if (node.is_crossing || glm::dot(node.n, n) <= 0) return false;
      const double least = glm::dot(node.points.front(), node.n) - geometry_.tie() - depth_;
      if (glm::dot(geometry_.point(s.middle), node.n) < least) return false;
      const std::vector<dvec4> points = geometry_.placed(s.middle).points;
      return std::all_of(points.begin(), points.end(),
                         [&](const dvec4& p) { return glm::dot(euclidean(p), node.n) >= least; });
    });
  }

  /// False if it is there already.
  bool add(const Sided& s) {
    if (!known_.emplace(s.middle.instance, s.middle.element, s.sign).second) return false;
    const ContactJet j = geometry_.jet(s.middle);
    const dvec3 n = normal(s.middle, s.sign);
    const double uv = glm::dot(j.dxy, n);
    const double det = glm::dot(j.dxx, n) * glm::dot(j.dyy, n) - uv * uv;
    const double size = glm::length(j.dx[0]) * glm::length(j.dx[1]);
    if (std::abs(det) <= flat_curvature * size * size) {
      unresolved_.push_back({n, "a flat or developable face lies on the hull"});
    }
    regions_.push_back({s.middle.instance, s.middle.element, s.sign, {whole_border(s.sign)}});
    return true;
  }

  /// Where the model supports in some direction, and not in this one alone.
  void begin() {
    for (const dvec3& n : {dvec3(0, 0, 1), dvec3(0.48, 0.6, -0.64), dvec3(-0.64, 0.48, 0.6)}) {
      const Contact c = geometry_.first(geometry_.canonical(query_(n, {}).contact));
      if (c.kind == SourceKind::face) {
        const int sign = glm::dot(normal(c, 1), n) > 0 ? 1 : -1;
        const Sided s = {middle_of(c.instance, c.element), sign};
        if (supports(s)) add(s);
      } else {
        for (const Contact& patch : patches_about(c)) add_supporting(patch);
      }
      if (!regions_.empty()) return;
    }
  }

  /// Middles of the patches that end in an edge, or at a vertex.
  std::vector<Contact> patches_about(const Contact& c) const {
    std::vector<Contact> edges = {c};
    if (c.kind == SourceKind::vertex) edges = piece_ends(geometry_, c);
    std::vector<Contact> all;
    for (const Contact& edge : edges) {
      const Contact own = geometry_.first(edge);
      if (own.kind != SourceKind::edge) continue;
      for (const ContactGeometry::PieceSide& side : geometry_.sides(own)) {
        const Contact on = on_side(own, side);
        all.push_back(middle_of(on.instance, on.element));
      }
    }
    if (c.kind == SourceKind::vertex) add_tips(c, all);
    return all;
  }

  /// Of patches with a side that collapses onto the vertex, where no edge need end.
  void add_tips(const Contact& vertex, std::vector<Contact>& all) const {
    const std::vector<Patch>& patches = geometry_.part(vertex).patches();
    for (int p = 0; p < int(patches.size()); ++p) {
      const auto& borders = patches[std::size_t(p)].borders;
      const bool ends_there = std::any_of(borders.begin(), borders.end(), [&](const Border& b) {
        return b.kind == BorderKind::collapsed && b.vertex == vertex.element;
      });
      if (ends_there) all.push_back(middle_of(vertex.instance, p));
    }
  }

  bool add_supporting(const Contact& middle) {
    for (const int sign : {1, -1}) {
      const Sided s = {middle, sign};
      if (!is_known(s) && supports(s)) return add(s);
    }
    return false;
  }

  /// Over smooth joins.
  void spread() {
    for (; spread_ < regions_.size(); ++spread_) {
      const TrimRegion region = regions_[spread_];
      for (const auto& loop : region.loops) {
        for (const TrimStretch& s : loop) {
          if (s.arc < 0) pass_join(region, s);
        }
      }
    }
  }

  void pass_join(const TrimRegion& region, const TrimStretch& s) {
    const Contact here = on_side(region.instance, region.patch, s.side, 0.5 * (s.from + s.to));
    const Border& border = geometry_.patch(here).borders[std::size_t(s.side)];
    if (border.kind != BorderKind::smooth || border.piece >= 0 || border.neighbor < 0) return;
    const double t = along_v(s.side) ? here.v : here.u;
    const Contact beyond = geometry_.first(on_side(
        region.instance, border.neighbor, border.neighbor_side, border.reversed ? 1 - t : t));
    if (beyond.kind != SourceKind::face || geometry_.is_ruled(beyond)) return;
    const int sign = glm::dot(normal(beyond, 1), normal(here, region.sign)) > 0 ? 1 : -1;
    add({middle_of(beyond.instance, beyond.element), sign});
  }

  /// Over edges with nothing on their other side. False if there are none.
  bool pass_edges() {
    bool found = false;
    for (const EdgeIncidence::Stretch& s : EdgeIncidence(geometry_, graph_, regions_).overlay()) {
      if (s.low.empty() == s.high.empty()) continue;
      const Contact edge = {s.instance, SourceKind::edge, s.piece, 0.5 * (s.from + s.to), 0};
      for (const ContactGeometry::PieceSide& side : geometry_.sides(edge)) {
        const Contact on = on_side(edge, side);
        // Walked along with the region to the left.
        const bool ahead = (side.side == Side::v0 || side.side == Side::u1) != side.reversed;
        const Sided there = {middle_of(on.instance, on.element), ahead == s.low.empty() ? 1 : -1};
        if (is_known(there) || !supports(there)) continue;
        found = add(there) || found;
        break;
      }
    }
    return found;
  }

  /// At vertices where separating curves touch the model. False if there are none.
  bool pass_vertices() {
    bool found = false;
    for (const Contact& vertex : vertices()) {
      for (const Contact& patch : patches_about(vertex)) found = add_supporting(patch) || found;
    }
    return found;
  }

  std::vector<Contact> vertices() const {
    std::set<std::pair<int, int>> seen;
    std::vector<Contact> all;
    const auto look = [&](const Contact& c) {
      if (c.kind == SourceKind::vertex && seen.emplace(c.instance, c.element).second) {
        all.push_back(c);
      }
    };
    for (const SeparatingArc& arc : graph_.arcs) {
      for (const ArcPiece& piece : arc.pieces) {
        for (const Contact& c : piece.rulings.front().contact) look(c);
      }
    }
    for (const FacetNode& node : graph_.nodes) {
      for (const Contact& c : node.contacts) look(c);
    }
    return all;
  }

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  const SeparatingGraph& graph_;
  const double depth_;
  std::vector<TrimRegion>& regions_;
  std::vector<Unresolved>& unresolved_;
  std::set<std::tuple<int, int, int>> known_;
  std::size_t spread_ = 0;  ///< regions whose joins are done
};

}  // namespace

void add_whole_patches(const ContactGeometry& geometry, SupportQuery& query,
                       const SeparatingGraph& graph, std::vector<TrimRegion>& regions,
                       std::vector<Unresolved>& unresolved) {
  WholePatches(geometry, query, graph, regions, unresolved).run();
}

}  // namespace taut
