#include "taut/verify/check_support.h"

#include <cmath>

#include "taut/bounds/support_query.h"
#include "taut/core/parallel.h"
#include "taut/verify/hull_faults.h"

namespace taut {

std::vector<SupportClaim> listed_claims(const DocumentGeometry& geometry) {
  std::vector<SupportClaim> claims;
  for (const HullDocument::Face& face : geometry.hull().faces) {
    const auto add = [&](const dvec3& n, const dvec3& p) {
      claims.push_back({n, glm::dot(geometry.local(p), n), face.tolerant});
    };
    for (const HullDocument::Ruling& r : face.rulings) {
      const dvec3 n = unit(r.n);
      for (const dvec3& p : {r.a.p, r.b.p}) add(n, p);
    }
    if (face.kind != FaceKind::facet) continue;
    const dvec3 n = unit(face.normal);
    claims.push_back({n, face.offset - glm::dot(face.normal, geometry.origin()), face.tolerant});
    // Of others all points are in the plane.
    if (face.tolerant == 0) continue;
    for (const HullDocument::Contact& c : face.contacts) add(n, c.p);
    for (const dvec3& p : face.boundary) add(n, p);
  }
  return claims;
}

std::vector<SupportClaim> claims_between(const DocumentGeometry& geometry,
                                         const DocumentOutlines& outlines) {
  std::vector<SupportClaim> claims;
  const auto add_panel = [&](const RulingInterval& interval, const RulingPanel& panel,
                             double bound) {
    // The first and the last one of the interval are listed.
    for (std::size_t i = 1; i < panel.nodes().size() && panel.nodes()[i] < 1; ++i) {
      const RulingState& state = panel.states()[i];
      for (std::size_t k = 0; k < 2; ++k) {
        const SourceJet j = geometry.jet(interval.source[k], {interval.patch[k], state.t[k]});
        claims.push_back({state.n, glm::dot(j.x, state.n), bound});
      }
    }
  };
  for (std::size_t f = 0; f < outlines.intervals().size(); ++f) {
    for (const RulingInterval& interval : outlines.intervals()[f]) {
      if (!interval.solved) continue;
      for (const RulingPanel& panel : interval.panels) {
        add_panel(interval, panel, geometry.hull().faces[f].tolerant);
      }
    }
  }
  return claims;
}

SupportGaps support_gaps(const std::vector<SupportClaim>& claims, const Scene& scene,
                         const VerifyOptions& options) {
  const SceneFrame& frame = scene.frame();
  std::vector<double> gap(claims.size());
  constexpr std::size_t grain = 64;
  parallel_for(claims.size(), grain, options.threads, [&](std::size_t begin, std::size_t end) {
    options.progress.check();
    SupportQuery query(scene, options.progress.stop);
    Contact near;
    for (std::size_t i = begin; i < end; ++i) {
      if (!(glm::length(claims[i].n) > 0.5)) {
        gap[i] = infinity;
        continue;
      }
      const Support s = query(claims[i].n, near);
      near = s.contact;
      gap[i] = frame.length_to_model(s.h) - claims[i].h;
    }
  });
  SupportGaps worst;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    raise(worst.above, gap[i] - claims[i].bound);
    raise(worst.below, -gap[i]);
  }
  return worst;
}

}  // namespace taut
