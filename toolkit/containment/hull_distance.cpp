#include "taut/containment/hull_distance.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/scene_content.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Directions that a projection tries, and facets that a branch and bound replaces, before they
/// settle for what they have. Usual are five and a hundred.
constexpr int projection_limit = 64;
constexpr int facet_limit = 3000;

/// Turns, one to the other, of the two searches: a point may look inside to the one and outside to
/// the other only within rounding.
constexpr int turn_limit = 4;

/// Directions after which a point that none of them separates is left to the other search.
constexpr int failure_limit = 12;

/// Steps without any gain after which more are in vain.
constexpr int idle_limit = 3;

/// Contacts this near to each other, in the scene's frame, are one.
constexpr double same_point = 1e-13;

/// Points of the polytope from which searches start are farther from each other than this.
constexpr double same_start_point = 1e-7;

/// Nearer to a vertex of the polytope, in the scene's frame, points make nothing but slivers.
constexpr double sliver = 1e-12;

/// So do points nearer to a vertex than this share of the distance sought, which they change by
/// less.
constexpr double sliver_share = 0.01;

/// Farther outside than this, in the scene's frame, projections are the better search.
constexpr double next_to_boundary = 1e-6;

/// Newton steps that a distance is polished by.
constexpr int polish_limit = 3;

/// A step by less than this angle changes x . n - h(n) by less than its rounding.
constexpr double converged_angle = 1e-8;

/// Next to the boundary distances are sought to this share of themselves.
constexpr double near_hull_share = 0.05;

/// A gap that no query can close.
constexpr double least_hull_gap = 2 * support_slack;

}  // namespace

SupportPolytope support_polytope(const Scene& scene, const std::vector<Sample>& samples) {
  SupportPolytope polytope{PointHull(Box{dvec3(-2.0), dvec3(2.0)}), {}};
  std::vector<dvec3> points;
  dvec3 sum(0.0);
  for (const Sample& s : samples) {
    const dvec3 x = scene.content().frame_point(s.contact);
    const bool repeated = std::any_of(points.begin(), points.end(), [&](const dvec3& other) {
      return glm::distance(other, x) < same_start_point;
    });
    if (repeated) continue;
    points.push_back(x);
    sum += x;
    polytope.samples.push_back(s);
  }
  polytope.hull.add(points);
  if (polytope.hull.dimension() < 3) return polytope;
  polytope.middle = sum / double(points.size());
  polytope.radius = infinity;
  for (const PointHull::Facet& facet : polytope.hull.facets()) {
    if (!facet.alive) continue;
    const double height = facet.side.determinant(polytope.middle) + facet.side.determinant_bound();
    polytope.radius = std::min(polytope.radius, -height / glm::length(facet.side.normal()));
  }
  polytope.radius = std::max(0.0, polytope.radius);
  return polytope;
}

HullDistance::HullDistance(const Scene& scene, const SupportPolytope& start)
    : scene_(scene),
      start_(start),
      query_(scene),
      point_rounding_(contact_rounding(scene)),
      polytope_(start) {}

double contact_rounding(const Scene& scene) {
  return 16 * rounding_unit + scene.content().rounding;
}

/// Queries a direction, and takes what it tells of the distance.
HullDistance::Atom HullDistance::ask(const dvec3& n, const Contact& hint) {
  const Support s = query_(n, hint);
  const double height = glm::dot(x_, n);
  if (height - s.h > range_.value) {
    range_.value = height - s.h;
    best_n_ = n;
    best_contact_ = s.contact;
  }
  range_.lower = std::max(range_.lower, height - s.h_bound - rounding_);
  return atom({n, s.contact});
}

HullDistance::Atom HullDistance::atom(const Sample& sample) const {
  Atom a;
  a.contact = sample.contact;
  a.curved.n = sample.n;
  a.curved.point = scene_.content().frame_point(sample.contact);
  a.offset = a.curved.point - x_;
  if (const auto h = support_hessian(scene_, sample.contact, sample.n)) {
    a.curved.hessian = *h;
    a.has_hessian = true;
  }
  return a;
}

bool HullDistance::done() const {
  if (goal_.tolerance >= 0 && (range_.lower > goal_.tolerance || range_.upper < -goal_.tolerance)) {
    return true;
  }
  const double share = near_hull_share * std::abs(range_.value);
  return range_.upper - range_.value <= std::max(std::min(goal_.accuracy, share), least_hull_gap);
}

/// Newton's step if it is wanted and there is one, else towards x.
dvec3 HullDistance::next_direction(const NearestInSimplex& nearest, const dvec3& n,
                                   bool& newton) const {
  if (newton) {
    std::vector<CurvedContact> contacts;
    for (int k = 0; k < nearest.size; ++k) {
      const Atom& a = atoms_[std::size_t(nearest.carrier[std::size_t(k)])];
      newton = newton && a.has_hessian;
      contacts.push_back(a.curved);
      contacts.back().weight = nearest.weight[std::size_t(k)];
    }
    if (newton) {
      if (const auto next = projection_step(contacts, x_, n)) return *next;
    }
    newton = false;
  }
  return -nearest.direction;
}

/// The contact of the same element that supports in another direction, as far as the element goes.
HullDistance::Atom HullDistance::moved(const Atom& a, const dvec3& n) {
  if (a.contact.kind == SourceKind::vertex) {
    Atom same = a;
    same.curved.n = n;
    return same;
  }
  const SceneContent& content = scene_.content();
  const SceneInstance& instance = content.instances[std::size_t(a.contact.instance)];
  const ScenePart& part = content.part_of(a.contact.instance);
  polish_.take(part.elements[std::size_t(content.element(a.contact))],
               instance.rotated ? n * instance.rotation : n);
  Contact contact = a.contact;
  const PolishedSupport top = polish_.polish({contact.u, contact.v});
  contact.u = top.uv.x;
  contact.v = top.uv.y;
  return atom({n, contact});
}

NearestInSimplex HullDistance::nearest_atom_simplex() const {
  std::vector<dvec3> offsets;
  offsets.reserve(atoms_.size());
  for (const Atom& a : atoms_) offsets.push_back(a.offset);
  return nearest_in_simplex(offsets);
}

/// Takes a contact that was found in direction n to those that carry the nearest point. After
/// Newton's step the carriers go with the direction, where that brings the nearest point nearer.
NearestInSimplex HullDistance::take(const Atom& found, const dvec3& n,
                                    const NearestInSimplex& nearest, bool newton) {
  std::vector<Atom> carriers;
  carriers.reserve(std::size_t(nearest.size) + 1);
  for (int k = 0; k < nearest.size; ++k) {
    carriers.push_back(atoms_[std::size_t(nearest.carrier[std::size_t(k)])]);
  }
  if (newton) {
    atoms_ = {found};
    for (const Atom& c : carriers) {
      const Atom there = moved(c, n);
      const bool known = std::any_of(atoms_.begin(), atoms_.end(), [&](const Atom& a) {
        return glm::distance(a.curved.point, there.curved.point) < same_point;
      });
      if (!known) atoms_.push_back(there);
    }
    const NearestInSimplex next = nearest_atom_simplex();
    if (next.contains_origin || glm::length(next.point) < glm::length(nearest.point)) return next;
  }
  atoms_ = std::move(carriers);
  atoms_.push_back(found);
  return nearest_atom_simplex();
}

/// Seeks the direction that separates x from the hull, or supports where x is next to the boundary.
void HullDistance::project(std::span<const Sample> near, const dvec3& n0) {
  atoms_.clear();
  for (const Sample& s : near) atoms_.push_back(atom(s));
  dvec3 n = n0;
  if (atoms_.empty()) atoms_.push_back(ask(n, {}));
  NearestInSimplex nearest = nearest_atom_simplex();
  bool newton = true;
  bool stalled = false;  // Newton's method has given all it can
  int failures = 0;
  int idle = 0;
  for (int step = 0; step < projection_limit; ++step) {
    if (nearest.contains_origin) return;
    const double length = glm::length(nearest.point);
    range_.upper = std::min(range_.upper, length + rounding_ + point_rounding_);
    if (done() || nearest.direction == dvec3(0.0)) return;
    newton = newton && !stalled;
    const dvec3 next = next_direction(nearest, n, newton);
    const double before = range_.value;
    const Atom found = ask(next, atoms_[std::size_t(nearest.carrier[0])].contact);
    if (done()) return;
    const bool better = range_.value > before;
    const bool turned = glm::length(next - n) > converged_angle;
    nearest = take(found, next, nearest, newton);
    stalled = newton && !turned && glm::length(nearest.point) > 0.5 * length;
    // Next to the boundary but not outside: the other search has to prove it.
    if (range_.value <= 0 && (stalled || ++failures > failure_limit)) return;
    const bool closer = glm::length(nearest.point) < length;
    idle = newton || better || closer ? 0 : idle + 1;
    if (idle > idle_limit) return;
    newton = !newton || better || !turned;
    if (better || !turned) n = next;
  }
}

/// The facet's normal from its two shorter sides, which are exact but for one rounding each, so
/// that their product is off by a few rounding units of theirs.
HullDistance::FacetPlane HullDistance::plane(int facet) const {
  const std::array<int, 3>& vertex = polytope_.hull.facet(facet).vertex;
  std::array<dvec3, 3> corner, side;
  for (std::size_t k = 0; k < 3; ++k) corner[k] = polytope_.hull.point(vertex[k]);
  for (std::size_t k = 0; k < 3; ++k) side[k] = corner[(k + 2) % 3] - corner[(k + 1) % 3];
  // side[k] lies opposite to corner k.
  std::size_t longest = 0;
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (glm::length(side[k]) > glm::length(side[longest])) longest = k;
    if (glm::distance(corner[k], x_) < glm::distance(corner[nearest], x_)) nearest = k;
  }
  const dvec3& a = side[(longest + 1) % 3];
  const dvec3& b = side[(longest + 2) % 3];
  const dvec3 n = glm::cross(a, b);
  const double length = glm::length(n);
  if (!(length > 0)) return {dvec3(0.0), infinity, infinity};
  const double turn = 8 * rounding_unit * glm::length(a) * glm::length(b) / length;
  const dvec3 from = x_ - corner[nearest];
  return {n / length, glm::dot(from, n) / length, (turn + 4 * rounding_unit) * glm::length(from)};
}

void HullDistance::push(int facet) {
  const FacetPlane p = plane(facet);
  heap_.push_back({p.height + p.rounding, facet, stamps_[std::size_t(facet)]});
  std::push_heap(heap_.begin(), heap_.end());
}

void HullDistance::take_created() {
  stamps_.resize(polytope_.hull.facets().size(), 0);
  for (const int f : polytope_.hull.replaced()) ++stamps_[std::size_t(f)];
  for (const int f : polytope_.hull.created()) {
    ++stamps_[std::size_t(f)];
    push(f);
  }
}

bool HullDistance::insert(const Sample& sample, const dvec3& point, int facet) {
  if (!polytope_.hull.insert(point, facet)) return false;
  polytope_.samples.push_back(sample);
  take_created();
  return true;
}

/// What the projection has found, and support points about the best direction as near to it as its
/// distance asks for: a triangle of them is a facet between x and the boundary.
void HullDistance::insert_seeds() {
  const double least = std::max(sliver, sliver_share * std::min(std::abs(range_.value), 1.0));
  const auto insert_anywhere = [&](const Sample& sample, const dvec3& point) {
    const auto& points = polytope_.hull.points();
    const bool repeated = std::any_of(points.begin(), points.end(), [&](const dvec3& other) {
      return glm::distance(other, point) < least;
    });
    if (repeated) return;
    const auto& facets = polytope_.hull.facets();
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (!facets[f].alive || facets[f].side.side(point) != Sign::positive) continue;
      insert(sample, point, int(f));
      return;
    }
  };
  for (const Atom& a : atoms_) insert_anywhere({a.curved.n, a.contact}, a.curved.point);
  if (best_contact_.instance < 0) return;
  const double angle = std::sqrt(std::clamp(-range_.value, least_hull_gap, 1e-2));
  const auto tangents = tangent_frame(best_n_);
  const dvec3 n = best_n_;
  const Contact hint = best_contact_;
  insert_anywhere({n, hint}, scene_.content().frame_point(hint));
  for (const double turn : {0.3, 2.4, 4.5}) {
    const dvec3 m = unit(n + angle * (std::cos(turn) * tangents[0] + std::sin(turn) * tangents[1]));
    const Atom a = ask(m, hint);
    insert_anywhere({m, a.contact}, a.curved.point);
  }
}

/// What the polytope, above none of whose facets x is higher than above the one with these corners,
/// bounds the signed distance by. Inside, by that height. Outside, by the distance from the facet,
/// or since a share h / (h + r) of the way to the middle, about which a ball of radius r lies in
/// the polytope, leads into it.
double HullDistance::distance_bound(double height, const std::array<dvec3, 3>& offsets) const {
  if (height <= 0) return height;
  const double share = height / (height + start_.radius);
  return std::min(glm::length(nearest_in_simplex(offsets).point),
                  share * glm::distance(x_, start_.middle));
}

/// Replaces the facet nearest to x until it is as near as the boundary.
void HullDistance::expand() {
  polytope_ = start_;
  stamps_.assign(polytope_.hull.facets().size(), 0);
  heap_.clear();
  for (std::size_t f = 0; f < stamps_.size(); ++f) {
    if (polytope_.hull.facets()[f].alive) push(int(f));
  }
  insert_seeds();
  for (int step = 0; step < facet_limit; ++step) {
    const auto is_stale = [&](const Nearest& top) {
      return stamps_[std::size_t(top.facet)] != top.stamp || !polytope_.hull.facet(top.facet).alive;
    };
    while (is_stale(heap_.front())) {
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
    }
    const Nearest top = heap_.front();
    const PointHull::Facet& facet = polytope_.hull.facet(top.facet);
    const FacetPlane own = plane(top.facet);
    std::array<dvec3, 3> offsets;
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = std::size_t(facet.vertex[k]);
      offsets[k] = polytope_.hull.points()[v] - x_;
      facet_samples_[k] = polytope_.samples[v];
      if (glm::dot(facet_samples_[k].n, own.n) > glm::dot(facet_samples_[nearest].n, own.n)) {
        nearest = k;
      }
    }
    const double upper = distance_bound(top.height, offsets);
    range_.upper = std::min(range_.upper, upper + rounding_ + point_rounding_);
    if (done() || own.n == dvec3(0.0)) return;
    const double before = range_.value;
    const Atom found = ask(own.n, facet_samples_[nearest].contact);
    if (range_.value > before) best_samples_ = facet_samples_;
    if (range_.lower > 0 && range_.upper > next_to_boundary) return;
    const bool repeated = std::any_of(facet.vertex.begin(), facet.vertex.end(), [&](int v) {
      return glm::distance(polytope_.hull.point(v), found.curved.point) < sliver;
    });
    if (repeated) return;
    if (!insert({own.n, found.contact}, found.curved.point, top.facet)) return;
  }
}

DistanceRange HullDistance::operator()(const dvec3& x, const DistanceGoal& goal,
                                       std::span<const Sample> near, const dvec3& n) {
  x_ = x;
  goal_ = goal;
  rounding_ = 8 * rounding_unit * (glm::length(x) + 2);
  range_ = {-infinity, -infinity, infinity};
  best_contact_ = {};
  best_samples_ = {};
  dvec3 start = n == dvec3(0.0) ? unit(x) : n;
  if (start == dvec3(0.0)) start = {0, 0, 1};
  for (const dvec3& across : start_.across) ask(across, {});
  project(near, start);
  const bool is_flat = !start_.across.empty();
  const bool solid = !is_flat && start_.hull.dimension() == 3;
  for (int turn = 0; turn < turn_limit && solid && !done(); ++turn) {
    expand();
    if (done() || !(range_.lower > 0)) break;
    project(facet_samples_, best_n_);
  }
  if (goal.tolerance < 0) polish();
  if (is_flat) range_.value = std::max(range_.value, 0.0);
  return range_;
}

/// Inside, the best of the directions tried is as good as the bounds asked for; on smooth pieces
/// Newton's method from the contacts of that direction's facet makes it exact.
void HullDistance::polish() {
  if (best_contact_.instance < 0) return;
  for (const double regular : {1e-6, 1e-11}) {
    for (int step = 0; step < polish_limit; ++step) {
      std::vector<CurvedContact> contacts;
      const auto take = [&](const Atom& a) {
        if (a.has_hessian) contacts.push_back(a.curved);
      };
      take(atom({best_n_, best_contact_}));
      for (const Sample& s : best_samples_) {
        if (s.contact.instance >= 0) take(moved(atom(s), best_n_));
      }
      if (contacts.empty()) return;
      const auto next = projection_step(contacts, x_, best_n_, regular);
      const double before = range_.value;
      if (next) ask(*next, best_contact_);
      if (!(range_.value > before)) break;
    }
    if (done()) return;
  }
}

}  // namespace taut
