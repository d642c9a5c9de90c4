#include "judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "cages.h"
#include "taut/bounds/contact_geometry.h"
#include "taut/core/error.h"
#include "taut/core/stopwatch.h"
#include "taut/hull/convex_hull.h"
#include "taut/hull/measure/boundary_measures.h"
#include "taut/io/document/boundary_document.h"
#include "taut/verify/verify_hull.h"

namespace taut_test {

using namespace taut;  // NOLINT: what is judged

namespace {

/// Directions, at random, in which mesh and reference are compared.
constexpr int random_directions = 200;
/// Rulings and facets that are compared with the reference, and directions beside each.
constexpr std::size_t directions_asked = 20;
constexpr std::array<double, 3> asides = {1e-9, 1e-6, 1e-3};
constexpr std::size_t places_about = 8;
/// In diagonals: what exact places may miss, and verify() and closed forms find wrong.
constexpr double exact_place = 1e-10;
constexpr double verified_length = 1e-9;
/// What borders may miss each other by, in diagonals, where ways lead over them.
constexpr double gap = 1e-7;
/// Relative differences of volumes from closed forms, exact and rounded.
constexpr double exact_volume = 1e-9;
constexpr double rounded_volume = 1e-5;
/// What other places near by may rise beside a place, by the turn, in diagonals: they are other
/// claims', and as far from this one at most.
constexpr double beside_place = 0.01;

std::string text(const char* what, double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%s by %.2g", what, value);
  return buffer.data();
}

/// A direction in which the boundary supports, and the points that it says do.
struct Claim {
  dvec3 n;
  std::vector<dvec3> points;
  /// The next ruling's of a curve, else the same: between the two these points or others near by
  /// support.
  dvec3 next_n;
};

std::vector<Claim> claims_of(const HullBoundary& boundary) {
  std::vector<Claim> result;
  for (const SeparatingArc& arc : boundary.arcs) {
    for (const ArcPiece& piece : arc.pieces) {
      for (std::size_t k = 0; k < piece.rulings.size(); ++k) {
        const Ruling& r = piece.rulings[k];
        const Ruling& next = piece.rulings[std::min(k + 1, piece.rulings.size() - 1)];
        result.push_back({r.n, {r.point[0], r.point[1]}, next.n});
      }
    }
  }
  std::map<std::array<double, 6>, dvec3> sides;  // of facets, with their normals
  for (const HullFace& face : boundary.faces) {
    if (face.kind != FaceKind::facet) continue;
    result.push_back({face.n, face.points, face.n});
    for (std::size_t k = 0; k < face.points.size(); ++k) {
      const dvec3& a = face.points[k];
      const dvec3& b = face.points[(k + 1) % face.points.size()];
      sides[{a.x, a.y, a.z, b.x, b.y, b.z}] = face.n;
      const auto other = sides.find({b.x, b.y, b.z, a.x, a.y, a.z});
      if (other != sides.end()) result.push_back({face.n, {a, b}, other->second});
    }
  }
  for (Claim& claim : result) {
    for (dvec3& x : claim.points) x = boundary.frame.to_model(x);
  }
  return result;
}

double highest(const std::vector<dvec3>& points, const dvec3& n) {
  double h = -infinity;
  for (const dvec3& x : points) h = std::max(h, glm::dot(x, n));
  return h;
}

std::string wrong_mesh(const Hull& hull, const SupportReference& reference, Random& random) {
  std::vector<dvec3> points;
  for (const auto v : hull.mesh.vertices()) points.push_back(position(hull.mesh, v));
  const double size = reference.diagonal();
  for (int k = 0; k < random_directions; ++k) {
    const dvec3 n = random_direction(random);
    const double lacks = (reference(n).h - highest(points, n) - hull.distance_bound) / size;
    if (lacks > exact_place) return text("the mesh leaves its bound", lacks);
  }
  return "";
}

/// The highest value to which a way leads from points of claims about the direction: from the
/// highest of them.
double climbed_from_claims(const std::vector<Claim>& claims, const SupportReference& reference,
                           const dvec3& n, double aside) {
  std::vector<dvec3> from;
  for (const Claim& claim : claims) {
    const dvec3 way = claim.next_n - claim.n;
    const double square = glm::dot(way, way);
    const double t = square > 0 ? std::clamp(glm::dot(n - claim.n, way) / square, 0.0, 1.0) : 0;
    if (glm::distance(unit(claim.n + t * way), n) > 3 * aside) continue;
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

std::string wrong_places(const HullBoundary& boundary, const SupportReference& reference,
                         Random& random) {
  const std::vector<Claim> claims = claims_of(boundary);
  std::vector<Claim> asked = claims;
  std::shuffle(asked.begin(), asked.end(), random);
  if (asked.size() > directions_asked) asked.resize(directions_asked);
  const double size = reference.diagonal();
  for (const Claim& claim : asked) {
    const double h = reference(claim.n).h;
    for (const dvec3& x : claim.points) {
      const double below = (h - glm::dot(x, claim.n)) / size;
      if (below > exact_place) return text("a place is surpassed", below);
    }
    for (const double aside : asides) {
      const dvec3 n = unit(claim.n + aside * random_direction(random));
      const double climbed = climbed_from_claims(claims, reference, n, aside);
      const double risen = (reference(n).h - climbed) / size;
      if (risen > exact_place + beside_place * aside) {
        return text("beside a place the model rises", risen);
      }
    }
  }
  return "";
}

Verdict judged(const Natural& natural, Variant variant, Random& random) {
  const Natural stored = placed(natural, variant, random);
  Verdict verdict;
  const Scene scene(stored.cage ? cage_model(*stored.cage) : make_model(stored.shape));
  const Stopwatch watch;
  Hull hull;
  try {
    hull = convex_hull(scene);
  } catch (const HullNotConverged& stop) {
    hull = *stop.best;
  }
  verdict.seconds = watch.seconds();
  verdict.bound = hull.distance_bound / scene.diagonal();
  const bool compared = !stored.cage;
  const SupportReference reference(stored.shape);
  if (compared) verdict.wrong = wrong_mesh(hull, reference, random);
  if (!hull.boundary) return verdict;
  const HullBoundary& boundary = *hull.boundary;
  verdict.unresolved = int(boundary.unresolved.size());
  verdict.closed = boundary.unresolved.empty();
  verdict.patches = boundary.count(FaceKind::patch);
  verdict.scrolls = boundary.count(FaceKind::scroll);
  verdict.facets = boundary.count(FaceKind::facet);
  verdict.curves = int(boundary.curves.size());
  if (!verdict.closed) return verdict;
  VerifyOptions options;
  options.random_directions = 500;
  verdict.verified =
      verify(hull_document(scene, boundary), scene, options).is_hull(verified_length);
  if (compared && verdict.wrong.empty()) {
    verdict.wrong = wrong_places(boundary, reference, random);
  }
  const bool rounded = variant == Variant::float32 || variant == Variant::decimals;
  if (verdict.wrong.empty() && std::isfinite(natural.volume)) {
    const double volume = measure(scene, ContactGeometry(scene), boundary).volume;
    const double off = std::abs(volume / natural.volume - 1);
    if (off > (rounded ? rounded_volume : exact_volume)) verdict.wrong = text("volume off", off);
  }
  return verdict;
}

}  // namespace taut_test
