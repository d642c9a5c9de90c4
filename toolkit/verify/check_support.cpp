#include "taut/verify/check_support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "taut/bounds/support_query.h"
#include "taut/core/integers.h"
#include "taut/core/parallel.h"
#include "taut/core/tolerances.h"
#include "taut/verify/hull_faults.h"

namespace taut {
namespace {

/// Places on a side from which its farthest point is sought, and halvings of what is between them.
constexpr int side_places = 32;
constexpr int side_halvings = 40;

/// A side of a planar hull along one of the model's edges.
class CurvedSide {
 public:
  CurvedSide(const DocumentGeometry& geometry, const HullDocument::Side& side)
      : geometry_(geometry),
        source_(side.source),
        from_(side.from[0]),
        to_(side.to[0]),
        control_points_(geometry.control_points(side.source, {from_, to_})) {}

  /// Whether it reaches farther than h in a direction; false is certain.
  bool may_reach_beyond(double h, const dvec3& n) const {
    return std::any_of(control_points_.begin(), control_points_.end(),
                       [&](const dvec3& p) { return glm::dot(p, n) > h; });
  }
  double reach(const dvec3& n) const;

 private:
  SourceJet jet(double share) const {
    const std::vector<SourcePlace> places =
        geometry_.places(source_, dvec2(Interval{from_, to_}.at(share), 0));
    return places.empty() ? SourceJet{} : geometry_.jet(source_, places.front());
  }

  const DocumentGeometry& geometry_;
  int source_;
  double from_, to_;
  std::vector<dvec3> control_points_;
};

/// How far it reaches in a direction, from its places: to its farthest point by bisection of the
/// slope beside the farthest place.
double CurvedSide::reach(const dvec3& n) const {
  const double sense = to_ > from_ ? 1 : -1;
  double best = -infinity;
  int at = 0;
  for (int i = 0; i <= side_places; ++i) {
    const double h = glm::dot(jet(double(i) / side_places).x, n);
    if (h > best) {
      best = h;
      at = i;
    }
  }
  double low = double(std::max(at - 1, 0)) / side_places;
  double high = double(std::min(at + 1, side_places)) / side_places;
  for (int i = 0; i < side_halvings; ++i) {
    const double middle = 0.5 * (low + high);
    const SourceJet j = jet(middle);
    best = std::max(best, glm::dot(j.x, n));
    (sense * glm::dot(j.dx[0], n) > 0 ? low : high) = middle;
  }
  return best;
}

/// Asks the model about claims, one after the other.
class ClaimJudge {
 public:
  ClaimJudge(const Scene& scene, const Stop& stop) : frame_(scene.frame()), query_(scene, stop) {}

  /// Of what has a bound first without the insides of lines that are bent by a small share of it,
  /// along which planes touch for long, and are slow to be told: if that proves the claim, it
  /// holds.
  SupportGaps operator()(const SupportClaim& claim) {
    if (!(glm::length(claim.n) > 0.5)) return {infinity, infinity};
    const double off = tie_share * frame_.length_to_frame(claim.bound);
    if (off > 0) {
      const SupportGaps gaps = gaps_of(claim, off);
      if (gaps.above <= 0 && gaps.below <= frame_.length_to_model(support_slack)) return gaps;
    }
    return gaps_of(claim, 0);
  }

 private:
  SupportGaps gaps_of(const SupportClaim& claim, double off) {
    query_.leave_out_lines(off);
    const Support s = query_(claim.n, near_);
    near_ = s.contact;
    return {frame_.length_to_model(s.highest()) - claim.h - claim.bound,
            claim.h - frame_.length_to_model(s.h)};
  }

  const SceneFrame& frame_;
  SupportQuery query_;
  Contact near_;
};

}  // namespace

std::vector<SupportClaim> outline_claims(const DocumentGeometry& geometry, int count,
                                         const VerifyOptions& options) {
  if (geometry.hull().faces.empty()) return {};
  const HullDocument::Face& face = geometry.hull().faces.front();
  const std::array<dvec3, 2> frame = tangent_frame(unit(face.normal));
  std::vector<CurvedSide> sides;
  for (const HullDocument::Side& side : face.sides) {
    if (side.from.size() == 1 && side.to.size() == 1) sides.emplace_back(geometry, side);
  }
  std::vector<SupportClaim> claims(to_size(count));
  const auto claim_at = [&](std::size_t k) {
    const double angle = 2 * std::numbers::pi * double(k) / count;
    SupportClaim claim{std::cos(angle) * frame[0] + std::sin(angle) * frame[1], -infinity,
                       face.tolerant};
    for (const HullDocument::Contact& c : face.contacts) {
      claim.h = std::max(claim.h, glm::dot(geometry.local(c.p), claim.n));
    }
    options.progress.check();
    for (const CurvedSide& side : sides) {
      if (side.may_reach_beyond(claim.h, claim.n)) claim.h = std::max(claim.h, side.reach(claim.n));
    }
    return claim;
  };
  parallel_for(claims.size(), 1, options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) claims[k] = claim_at(k);
  });
  return claims;
}

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
  std::vector<SupportGaps> gaps(claims.size());
  constexpr std::size_t grain = 64;
  parallel_for(
      claims.size(), grain, options.threads,
      [&](std::size_t begin, std::size_t end) {
        options.progress.check();
        ClaimJudge judge(scene, options.progress.stop);
        for (std::size_t i = begin; i < end; ++i) gaps[i] = judge(claims[i]);
      },
      [&](std::size_t done) {
        options.progress.update("verify", double(done) / double(claims.size()));
      });
  SupportGaps worst;
  for (const SupportGaps& gap : gaps) {
    raise(worst.above, gap.above);
    raise(worst.below, gap.below);
  }
  return worst;
}

}  // namespace taut
