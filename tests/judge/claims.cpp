#include "claims.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "expected.h"

namespace taut_test {

using namespace taut;  // NOLINT: what is judged

namespace {

/// Directions, at random, in which mesh and reference are compared.
constexpr int random_directions = 200;
/// Rulings and facets that are compared with the reference, and directions beside each.
constexpr std::size_t directions_asked = 20;
constexpr std::array<double, 3> asides = {1e-9, 1e-6, 1e-3};
constexpr std::size_t places_about = 8;
/// What exact places may miss, in diagonals.
constexpr double exact_place = 1e-10;
/// What borders may miss each other by, in diagonals, where ways lead over them.
constexpr double gap = 1e-7;
/// What other places near by may rise beside a place, by the turn, in diagonals: they are other
/// claims', and as far from this one at most.
constexpr double beside_place = 0.01;

/// A direction in which the boundary supports, and the points that it says do.
struct Claim {
  dvec3 n;
  std::vector<dvec3> points;
  /// The next ruling's of a curve, else the same: between the two these points or others near by
  /// support.
  dvec3 next_n;
  /// How far it says that they may be below the supporting plane, in model units.
  double tolerant = 0;
};

std::vector<Claim> claims_of(const HullBoundary& boundary) {
  std::vector<Claim> result;
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (std::size_t k = 0; k < piece.rulings.size(); ++k) {
        const Ruling& r = piece.rulings[k];
        const Ruling& next = piece.rulings[std::min(k + 1, piece.rulings.size() - 1)];
        result.push_back({r.n, {r.point[0], r.point[1]}, next.n, piece.tolerant});
      }
    }
  }
  std::map<std::array<double, 6>, std::pair<dvec3, double>> sides;  // of facets, with normals
  for (const HullFace& face : boundary.faces) {
    if (face.kind != FaceKind::facet) continue;
    result.push_back({face.n, face.points, face.n, face.tolerant});
    for (std::size_t k = 0; k < face.points.size(); ++k) {
      const dvec3& a = face.points[k];
      const dvec3& b = face.points[(k + 1) % face.points.size()];
      sides[{a.x, a.y, a.z, b.x, b.y, b.z}] = {face.n, face.tolerant};
      const auto other = sides.find({b.x, b.y, b.z, a.x, a.y, a.z});
      if (other == sides.end()) continue;
      const auto& [next_n, tolerant] = other->second;
      result.push_back({face.n, {a, b}, next_n, std::max(face.tolerant, tolerant)});
    }
  }
  for (Claim& claim : result) {
    for (dvec3& x : claim.points) x = boundary.frame.to_model(x);
    claim.tolerant = boundary.frame.length_to_model(claim.tolerant);
  }
  return result;
}

double highest(const std::vector<dvec3>& points, const dvec3& n) {
  double h = -infinity;
  for (const dvec3& x : points) h = std::max(h, glm::dot(x, n));
  return h;
}

/// Some of them, in an order of chance.
std::vector<Claim> asked_of(std::vector<Claim> claims, Random& random) {
  std::shuffle(claims.begin(), claims.end(), random);
  if (claims.size() > directions_asked) claims.resize(directions_asked);
  return claims;
}

/// The direction of a great arc, shorter than half of a circle, that is nearest to another.
dvec3 nearest_on_arc(const dvec3& from, const dvec3& to, const dvec3& n) {
  const dvec3 pole = glm::cross(from, to);
  const double square = glm::dot(pole, pole);
  if (square > 0) {
    const dvec3 within = n - glm::dot(n, pole) / square * pole;
    if (glm::dot(glm::cross(from, within), pole) >= 0 &&
        glm::dot(glm::cross(within, to), pole) >= 0) {
      return unit(within);
    }
  }
  return glm::distance(n, from) <= glm::distance(n, to) ? from : to;
}

/// The highest value to which a way leads from points of claims about the direction: from the
/// highest of them.
double climbed_from_claims(const std::vector<Claim>& claims, const SupportReference& reference,
                           const dvec3& n, double aside) {
  std::vector<dvec3> from;
  for (const Claim& claim : claims) {
    if (glm::distance(nearest_on_arc(claim.n, claim.next_n, n), n) > 3 * aside) continue;
    from.insert(from.end(), claim.points.begin(), claim.points.end());
  }
  std::sort(from.begin(), from.end(),
            [&](const dvec3& a, const dvec3& b) { return glm::dot(a, n) > glm::dot(b, n); });
  double climbed = -infinity;
  std::vector<dvec3> tried;
  for (const dvec3& x : from) {
    const bool known = std::any_of(tried.begin(), tried.end(), [&](const dvec3& y) {
      return glm::distance(x, y) < aside * reference.diagonal();
    });
    if (known || tried.size() == places_about) continue;
    tried.push_back(x);
    climbed = std::max(climbed, reference.climbed_from(x, n, gap * reference.diagonal()));
  }
  return climbed;
}

}  // namespace

std::string wrong_mesh(const Hull& hull, const Support& support, double size, double slack,
                       Random& random) {
  std::vector<dvec3> points;
  for (const auto v : hull.mesh.vertices()) points.push_back(position(hull.mesh, v));
  const double off = slack + exact_place * size;
  for (int k = 0; k < random_directions; ++k) {
    const dvec3 n = random_direction(random);
    const SupportRange range = support(n);
    const double h = highest(points, n);
    const double lacks = double(range.lower) - h;
    if (lacks > hull.distance_bound + off) {
      return off_by("the mesh leaves its bound", (lacks - hull.distance_bound) / size);
    }
    const double outside = h - double(range.upper);
    if (outside > off) return off_by("the mesh lies outside", outside / size);
  }
  return "";
}

std::string wrong_contacts(const HullBoundary& boundary, const Support& support, double size,
                           double slack, Random& random) {
  const double off = slack + exact_place * size;
  for (const Claim& claim : asked_of(claims_of(boundary), random)) {
    const SupportRange range = support(claim.n);
    for (const dvec3& x : claim.points) {
      const double below = double(range.lower) - glm::dot(x, claim.n);
      if (below > off + claim.tolerant) return off_by("a place is surpassed", below / size);
      const double above = glm::dot(x, claim.n) - double(range.upper);
      if (above > off) return off_by("a place lies outside", above / size);
    }
  }
  return "";
}

std::string wrong_places(const HullBoundary& boundary, const SupportReference& reference,
                         Random& random) {
  const std::vector<Claim> claims = claims_of(boundary);
  const double size = reference.diagonal();
  for (const Claim& claim : asked_of(claims, random)) {
    const double h = reference(claim.n).h;
    for (const dvec3& x : claim.points) {
      const double below = (h - glm::dot(x, claim.n) - claim.tolerant) / size;
      if (below > exact_place) return off_by("a place is surpassed", below);
    }
    for (const double aside : asides) {
      const dvec3 n = unit(claim.n + aside * random_direction(random));
      const double climbed = climbed_from_claims(claims, reference, n, aside);
      const double risen = (reference(n).h - climbed) / size;
      if (risen > exact_place + beside_place * aside + claim.tolerant / size) {
        return off_by("beside a place the model rises", risen);
      }
    }
  }
  return "";
}

}  // namespace taut_test
