#include "taut/verify/coverage.h"

#include <algorithm>

#include "taut/core/integers.h"
#include "taut/verify/closest_on_curve.h"
#include "taut/verify/closest_on_surface.h"

namespace taut {
namespace {

std::vector<dvec3> points_of_curves(const HullDocument& hull) {
  std::vector<dvec3> points;
  for (const HullDocument::Curve& curve : hull.curves) {
    points.insert(points.end(), curve.points.begin(), curve.points.end());
  }
  return points;
}

bool may_be_within(const Box& box, const dvec3& p, double distance) {
  return !glm::any(glm::lessThan(p, box.lower - distance)) &&
         !glm::any(glm::lessThan(box.upper + distance, p));
}

}  // namespace

Coverage::Coverage(const DocumentGeometry& geometry, const DocumentOutlines& outlines,
                   const Scene& scene, double limit)
    : geometry_(geometry),
      outlines_(outlines),
      scene_(scene),
      limit_(limit),
      place_of_source_(to_size(scene.model().source_count()), -1),
      points_(points_of_curves(geometry.hull())),
      curves_(points_) {
  const std::vector<HullDocument::Source>& sources = geometry.hull().sources;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    place_of_source_[to_size(sources[i].id)] = int(i);
    std::vector<Box>& boxes = boxes_.emplace_back(sources[i].patches.size());
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      for (const dvec4& p : sources[i].patches[k].points) {
        boxes[k].include(geometry.local(dvec3(p)));
      }
    }
  }
}

bool Coverage::covers(const dvec3& n, const Contact& contact) const {
  const dvec3 p = scene_.point(contact);
  if (curves_.distance(p) <= limit_) return true;
  const int instances = int(scene_.model().instances().size());
  Contact copy = contact;
  for (copy.instance = 0; copy.instance < instances; ++copy.instance) {
    const bool same =
        scene_.first_instance(copy.instance) == scene_.first_instance(contact.instance);
    if (same && names(copy)) return true;
  }
  return lists_as_high(n, p) || is_near(p);
}

bool Coverage::names(const Contact& contact) const {
  const SourceContact c = scene_.source(contact);
  if (c.kind != SourceKind::face && place_of_source_[to_size(c.source)] >= 0) return true;
  if (contact.kind != SourceKind::face) return false;
  const Model& model = scene_.model();
  const Part& part = model.parts()[to_size(model.instances()[to_size(contact.instance)].part)];
  const Patch& patch = part.patches()[to_size(contact.element)];
  const int source = model.source_id({SourceKind::face, contact.instance, patch.face});
  const int place = place_of_source_[to_size(source)];
  return place >= 0 && outlines_.covers(place, {patch.u.at(contact.u), patch.v.at(contact.v)});
}

bool Coverage::lists_as_high(const dvec3& n, const dvec3& p) const {
  return std::any_of(points_.begin(), points_.end(),
                     [&](const dvec3& x) { return glm::dot(p - x, n) <= limit_; });
}

bool Coverage::is_near(const dvec3& p) const {
  const dvec3 x = geometry_.local(p);
  const std::vector<HullDocument::Source>& sources = geometry_.hull().sources;
  for (std::size_t s = 0; s < sources.size(); ++s) {
    if (sources[s].kind == SourceKind::face) continue;
    for (std::size_t i = 0; i < boxes_[s].size(); ++i) {
      if (!may_be_within(boxes_[s][i], x, limit_)) continue;
      const auto jet = [&](double t) { return geometry_.jet(int(s), {int(i), dvec2(t, 0)}); };
      const bool is_point = sources[s].kind == SourceKind::vertex;
      const double distance =
          is_point ? glm::distance(jet(0).x, x) : closest_on_curve(x, 0, 1, jet).distance;
      if (distance <= limit_) return true;
    }
  }
  return std::any_of(
      outlines_.regions().begin(), outlines_.regions().end(), [&](const RegionOutline& region) {
        const int source = geometry_.hull().faces[to_size(region.face)].source;
        const int patch = region.region->patch;
        if (!may_be_within(boxes_[to_size(source)][to_size(patch)], x, limit_)) return false;
        const auto jet = [&](const dvec2& t) { return geometry_.jet(source, {patch, t}); };
        const std::array<int, 2> parts =
            sampled_parts(sources[to_size(source)].patches[to_size(patch)]);
        const ClosestOnSurface nearest = closest_on_surface(x, jet, parts);
        if (nearest.distance > limit_) return false;
        const dvec2 uv = geometry_.parameters(source, {patch, nearest.t});
        if (region.may_contain(uv)) return true;
        // A copy's points may be beyond the outline by as much as these are off the patch.
        const dvec2 border = geometry_.place(source, patch, region.nearest(uv));
        return glm::distance(jet(border).x, x) <= limit_;
      });
}

}  // namespace taut
