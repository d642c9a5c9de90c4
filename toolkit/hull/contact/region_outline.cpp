#include "taut/hull/contact/region_outline.h"

#include <algorithm>
#include <optional>

#include "taut/core/geometry.h"
#include "taut/hull/contact/rulings_between.h"

namespace taut {
namespace {

/// How often the way between two rulings is halved at most.
constexpr int halvings = 4;

/// Corners of outlines of a patch.
class Outliner {
 public:
  Outliner(const ContactSystem& system, const HullBoundary& boundary, const PatchRegion& region)
      : system_(system), boundary_(boundary), patch_(region.patch) {}

  /// The corners of the stretch, in its order.
  std::vector<dvec2> operator()(const TrimStretch& stretch) const {
    if (stretch.arc < 0) {
      return {on_side(stretch.side, stretch.from), on_side(stretch.side, stretch.to)};
    }
    const SeparatingArc& arc = boundary_.arcs[std::size_t(stretch.arc)];
    const std::vector<Ruling>& rulings = arc.pieces[std::size_t(stretch.piece)].rulings;
    const auto side = std::size_t(stretch.contact);
    std::vector<dvec2> corners;
    for (std::size_t k = 0; k < rulings.size(); ++k) {
      if (k > 0) add_between(rulings[k - 1], rulings[k], side, corners);
      add(rulings[k], side, corners);
    }
    if (stretch.reversed) std::reverse(corners.begin(), corners.end());
    return corners;
  }

 private:
  bool is_on_patch(const Contact& c) const {
    return c.kind == SourceKind::face && c.element == patch_;
  }
  void add(const Ruling& r, std::size_t side, std::vector<dvec2>& corners) const {
    const Contact& c = r.contact[side];
    if (is_on_patch(c)) corners.emplace_back(c.u, c.v);
  }

  void add_between(const Ruling& from, const Ruling& to, std::size_t side,
                   std::vector<dvec2>& corners) const {
    const auto is_far = [&](const Ruling& a, const Ruling& b) {
      const Contact& p = a.contact[side];
      const Contact& q = b.contact[side];
      return is_on_patch(p) && is_on_patch(q) &&
             glm::distance(dvec2(p.u, p.v), dvec2(q.u, q.v)) > outline_slack;
    };
    if (!is_far(from, to)) return;
    const RulingsBetween between(system_, from, to);
    if (between.empty()) return;
    const auto divide = [&](const auto& self, double a, const Ruling& at_a, double b,
                            const Ruling& at_b, int left) -> void {
      if (left == 0 || !is_far(at_a, at_b)) return;
      const double s = 0.5 * (a + b);
      const std::optional<MovingRuling> middle = between(s);
      if (!middle) return;
      const Ruling r = middle->at.ruling();
      self(self, a, at_a, s, r, left - 1);
      add(r, side, corners);
      self(self, s, r, b, at_b, left - 1);
    };
    divide(divide, 0, from, 1, to, halvings);
  }

  const ContactSystem& system_;
  const HullBoundary& boundary_;
  int patch_;
};

double distance_to_segment(const dvec2& x, const dvec2& a, const dvec2& b) {
  const dvec2 edge = b - a;
  const double square = glm::dot(edge, edge);
  const double t = square > 0 ? std::clamp(glm::dot(x - a, edge) / square, 0.0, 1.0) : 0;
  return glm::distance(x, a + t * edge);
}

}  // namespace

RegionOutline outline_of(const ContactSystem& system, const HullBoundary& boundary,
                         const PatchRegion& region) {
  const Outliner corners_of(system, boundary, region);
  RegionOutline outline;
  for (const std::vector<TrimStretch>& loop : region.loops) {
    outline.emplace_back();
    for (const TrimStretch& stretch : loop) {
      const std::vector<dvec2> corners = corners_of(stretch);
      outline.back().insert(outline.back().end(), corners.begin(), corners.end());
    }
  }
  return outline;
}

/// Where an odd number of sides crosses the ray towards growing v, it is inside.
double depth_in(const RegionOutline& outline, const dvec2& x) {
  bool inside = false;
  double distance = infinity;
  for (const std::vector<dvec2>& loop : outline) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const dvec2& a = loop[k];
      const dvec2& b = loop[(k + 1) % loop.size()];
      distance = std::min(distance, distance_to_segment(x, a, b));
      if ((a.x > x.x) == (b.x > x.x)) continue;
      const double v = a.y + (x.x - a.x) / (b.x - a.x) * (b.y - a.y);
      if (v > x.y) inside = !inside;
    }
  }
  return inside ? distance : -distance;
}

}  // namespace taut
