#include "taut/hull/contact/contact_planes.h"

#include <algorithm>
#include <cmath>

#include "taut/bounds/supporting_plane.h"
#include "taut/hull/contact/facet_contacts.h"

namespace taut {
namespace {

/// Sine of the angle below which control points are in line.
constexpr double in_line_sine = 1e-6;
/// Slope below which pieces are level. A curve that leaves the plane by its third derivative ties
/// with it in height over 1e-4 of the part and more: tiny pieces there are told by slopes alone.
constexpr double least_slope = 1e-10;

std::vector<dvec3> control_points(const BezierCurve& curve) {
  std::vector<dvec3> points;
  points.reserve(curve.points.size());
  for (const dvec4& p : curve.points) points.push_back(euclidean(p));
  return points;
}

/// A plane through points, by the largest triangle with the longest chord from the first.
struct FittedPlane {
  dvec3 n = dvec3(0.0);  ///< zero where all lie nearly on a line
  dvec3 x = dvec3(0.0);
  double width = 0;  ///< the triangle's height

  explicit FittedPlane(const std::vector<dvec3>& points) : x(points.front()) {
    dvec3 chord(0.0);
    for (const dvec3& p : points) {
      if (glm::length(p - x) > glm::length(chord)) chord = p - x;
    }
    for (const dvec3& p : points) {
      const dvec3 cross = glm::cross(chord, p - x);
      if (glm::length(cross) > glm::length(n)) n = cross;
    }
    const double length = glm::length(chord);
    const double area = glm::length(n);
    n = area < in_line_sine * length * length ? dvec3(0.0) : unit(n);
    width = length > 0 ? area / length : 0;
  }

  bool contains(const std::vector<dvec3>& points, double tie, double turn) const {
    return std::all_of(points.begin(), points.end(), [&](const dvec3& p) {
      return std::abs(glm::dot(p - x, n)) <= tie + turn * glm::distance(p, x);
    });
  }

  /// None of the points leads away from the plane, as seen from the first.
  bool is_level(const std::vector<dvec3>& points, double rounding) const {
    const dvec3& first = points.front();
    return std::all_of(points.begin(), points.end(), [&](const dvec3& p) {
      return std::abs(glm::dot(p - first, n)) <=
             std::max(rounding, least_slope * glm::distance(p, first));
    });
  }
};

/// A plane of one piece or more, with their control points.
struct Candidate {
  FittedPlane plane;
  double sense = 1;
  std::vector<dvec3> points;
  std::vector<Contact> pieces;

  dvec3 n() const { return sense * plane.n; }
  double offset() const {
    double highest = glm::dot(points.front(), n());
    for (const dvec3& p : points) highest = std::max(highest, glm::dot(p, n()));
    return highest;
  }
};

class PlaneFinder {
 public:
  PlaneFinder(const ContactGeometry& geometry, SupportQuery& query,
              const std::vector<Sample>& samples)
      : geometry_(geometry), query_(query) {
    for (const Sample& s : samples) sampled_.push_back(geometry.point(s.contact));
  }

  std::vector<ContactPlane> run();

 private:
  void add_pieces();
  bool is_in(const Candidate& plane, const Candidate& own, double sense) const;
  static void put_into(Candidate& plane, const Candidate& own);
  void add(const Candidate& own);
  /// How far rounding may have turned a plane.
  double turn(const FittedPlane& plane) const { return geometry_.tie() / plane.width; }
  bool supports(const Candidate& c, double slack) {
    const dvec3 n = c.n();
    const double highest = c.offset() + geometry_.tie() + slack;
    const bool is_below = std::any_of(sampled_.begin(), sampled_.end(),
                                      [&](const dvec3& x) { return glm::dot(x, n) > highest; });
    return !is_below && is_supporting(geometry_, query_, n, c.offset(), c.pieces.front(), slack);
  }

  const ContactGeometry& geometry_;
  SupportQuery& query_;
  std::vector<dvec3> sampled_;
  std::vector<Candidate> pieces_;  // one each
  std::vector<Candidate> planes_;
};

/// The pieces that are plane and not straight, the widest first: they tell their planes best.
void PlaneFinder::add_pieces() {
  const Model& model = geometry_.scene().model();
  for (const int i : geometry_.scene().distinct_instances()) {
    const Part& part = model.parts()[std::size_t(model.instances()[std::size_t(i)].part)];
    for (int k = 0; k < int(part.pieces().size()); ++k) {
      const Contact piece{i, SourceKind::edge, k, 0, 0};
      if (geometry_.is_repeated(piece)) continue;
      std::vector<dvec3> points = control_points(geometry_.curve(piece));
      const FittedPlane plane(points);
      if (geometry_.is_straight(piece) || !plane.contains(points, geometry_.tie(), 0)) continue;
      if (!plane.is_level(points, geometry_.rounding())) continue;
      pieces_.push_back({plane, 1, std::move(points), {piece}});
    }
  }
  std::stable_sort(pieces_.begin(), pieces_.end(), [](const Candidate& a, const Candidate& b) {
    return a.plane.width > b.plane.width;
  });
}

/// The piece lies in the plane, on the same side of the model, as far as the piece tells a plane.
bool PlaneFinder::is_in(const Candidate& plane, const Candidate& own, double sense) const {
  const dvec3 n = sense * own.plane.n;
  const bool agrees =
      n == dvec3(0.0) || glm::distance(plane.n(), n) <= turn(plane.plane) + turn(own.plane);
  return agrees && plane.plane.contains(own.points, geometry_.tie(), turn(plane.plane)) &&
         plane.plane.is_level(own.points, geometry_.rounding());
}

void PlaneFinder::put_into(Candidate& plane, const Candidate& own) {
  plane.points.insert(plane.points.end(), own.points.begin(), own.points.end());
  plane.pieces.push_back(own.pieces.front());
  FittedPlane wider(plane.points);
  wider.n = aligned(wider.n, plane.plane.n);
  plane.plane = wider;
}

/// Puts the piece into the plane that it lies in, or makes a plane of it if that may support. A
/// piece that is too short to tell its plane may lie in several.
void PlaneFinder::add(const Candidate& own) {
  if (own.plane.n == dvec3(0.0)) {
    for (Candidate& plane : planes_) {
      if (is_in(plane, own, 1)) put_into(plane, own);
    }
    return;
  }
  for (const double sense : {1.0, -1.0}) {
    const auto known = std::find_if(planes_.begin(), planes_.end(), [&](const Candidate& plane) {
      return is_in(plane, own, sense);
    });
    if (known != planes_.end()) {
      put_into(*known, own);
      continue;
    }
    Candidate plane = own;
    plane.sense = sense;
    if (supports(plane, turn(plane.plane))) planes_.push_back(std::move(plane));
  }
}

std::vector<ContactPlane> PlaneFinder::run() {
  add_pieces();
  for (const Candidate& own : pieces_) add(own);
  std::vector<ContactPlane> result;
  for (Candidate& c : planes_) {
    if (c.plane.width > same_contact && supports(c, 0))
      result.push_back({c.n(), c.offset(), std::move(c.pieces)});
  }
  return result;
}

}  // namespace

std::vector<ContactPlane> contact_planes(const ContactGeometry& geometry, SupportQuery& query,
                                         const std::vector<Sample>& samples) {
  return PlaneFinder(geometry, query, samples).run();
}

}  // namespace taut
