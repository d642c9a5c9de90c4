#pragma once

#include <queue>
#include <span>
#include <vector>

#include "taut/bounds/support_polish.h"
#include "taut/bounds/support_query.h"
#include "taut/containment/contact_curvature.h"
#include "taut/core/nearest_in_simplex.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// A polytope of support points of a scene, in the scene's frame.
struct SupportPolytope {
  PointHull hull;               ///< of no dimension below 3 where the scene is flat
  std::vector<Sample> samples;  ///< per point of the hull
  /// A ball in the hull; of radius zero where that is not known.
  dvec3 middle = dvec3(0.0);
  double radius = 0;
  /// Directions across the span of a scene that spans less than space: its hull has no inside.
  std::vector<dvec3> across = {};
};

/// The polytope of samples, without those that repeat another but for rounding: slivers between
/// them would bound nothing.
SupportPolytope support_polytope(const Scene& scene, const std::vector<Sample>& samples);

/// What is asked about a point, in the scene's frame. A search ends when it has the distance to
/// within `accuracy` or, where a tolerance is given, when it knows whether the point is farther
/// from the boundary than that.
struct DistanceGoal {
  double accuracy = 0;
  double tolerance = -1;  ///< negative: none
};

/// Proven bounds of a signed distance and what was found; in the scene's frame.
struct DistanceRange {
  double value = 0;
  double lower = 0;
  double upper = 0;
};

/// What rounding may do to a contact's point in the scene's frame, where coordinates are at most
/// about two, and to its value in any direction.
double contact_rounding(const Scene& scene);

/// Signed distances of points from the boundary of a scene's convex hull.
///
/// With h the support function, the signed distance of x is max over unit n of x . n - h(n),
/// outside and inside. So every support query gives a lower bound, and the convex hull of any
/// support points an upper one: outside, by its distance; inside, since then the ball about x that
/// lies in it lies in the hull.
///
/// Outside, the maximum is one of a concave function: projection_step() in turns with the step of
/// Gilbert, Johnson and Keerthi (towards x from the nearest point of the simplex of contacts).
/// Inside it has local maxima, which a branch and bound over the facets of the support points'
/// polytope tells apart: the facet nearest to x is replaced by those to the support point in its
/// normal's direction, until none can be nearer than the best direction found.
///
/// Holds scratch memory, so use one object a thread; scene and polytope must outlive it.
class HullDistance {
 public:
  HullDistance(const Scene& scene, const SupportPolytope& start);

  /// `near`: samples of a facet close to x, with the facet's normal n; may be empty.
  DistanceRange operator()(const dvec3& x, const DistanceGoal& goal, std::span<const Sample> near,
                           const dvec3& n);

  long queries() const { return query_.queries(); }

 private:
  struct Atom {
    CurvedContact curved;
    bool has_hessian = false;
    Contact contact;
    dvec3 offset;  ///< of the point from x
  };
  struct Nearest {
    double height;  ///< of x above the facet, at most
    int facet;
    int stamp;
    bool operator<(const Nearest& other) const { return height < other.height; }
  };

  struct FacetPlane {
    dvec3 n;  ///< unit; zero where the facet is too thin to tell
    double height;
    double rounding;  ///< of the height
  };

  Atom ask(const dvec3& n, const Contact& hint);
  Atom atom(const Sample& sample) const;
  bool done() const;
  Atom moved(const Atom& a, const dvec3& n);
  NearestInSimplex nearest_atom_simplex() const;
  NearestInSimplex take(const Atom& found, const dvec3& n, const NearestInSimplex& nearest,
                        bool newton);
  void project(std::span<const Sample> near, const dvec3& n);
  dvec3 next_direction(const NearestInSimplex& nearest, const dvec3& n, bool& newton) const;
  void expand();
  void polish();
  void insert_seeds();
  bool insert(const Sample& sample, const dvec3& point, int facet);
  void take_created();
  FacetPlane plane(int facet) const;
  double distance_bound(double height, const std::array<dvec3, 3>& offsets) const;
  void push(int facet);

  const Scene& scene_;
  const SupportPolytope& start_;
  SupportQuery query_;
  SupportPolish polish_;

  dvec3 x_ = dvec3(0.0);
  double rounding_ = 0;  ///< of x . n
  double point_rounding_;
  DistanceGoal goal_;
  DistanceRange range_;
  dvec3 best_n_ = dvec3(0.0);
  Contact best_contact_;
  std::vector<Atom> atoms_;

  SupportPolytope polytope_;
  std::vector<int> stamps_;
  std::vector<Nearest> heap_;
  std::array<Sample, 3> facet_samples_;  ///< of the facet that was looked at last
  std::array<Sample, 3> best_samples_;   ///< of the one whose normal is the best direction
};

}  // namespace taut
