#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "taut/core/progress.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/result/sample.h"

namespace taut {

/// Edges of a polytope that are to stay, like chords of curves, whole or bisected.
class EdgeConstraints {
 public:
  /// A point that bisects an edge.
  struct Middle {
    Sample sample;  ///< its direction and contact
    dvec3 point;    ///< in model coordinates
  };

  virtual ~EdgeConstraints() = default;
  /// A point of the hull between two points, by number, if these are the ends of such an edge.
  virtual std::optional<Middle> middle(int a, int b) const = 0;
  /// The ends of those that are to be edges in the end.
  virtual std::vector<std::pair<int, int>> wanted() const = 0;
  /// What comes so near to one of them may hide it, in model units: strips as narrow, between two
  /// curves, do not matter.
  virtual double narrow() const { return 0; }
  /// The middle was inserted, with this number.
  virtual void bisect(int a, int b, int middle) = 0;
};

/// Inserts a middle into the polytope, above a facet; false, and nothing changes, if it is not.
using InsertMiddle = std::function<bool(const EdgeConstraints::Middle& middle, int facet)>;

/// Bisects an edge that is to stay between two of these facets, which are to go. False if there is
/// none.
bool bisect_between(const PointHull& polytope, const std::vector<int>& facets,
                    EdgeConstraints& constraints, const InsertMiddle& insert);

/// Bisects wanted edges that are none, until all are, have no middle or are hidden by what is near
/// there, or there are `most` points. `scale`: of the polytope, to model coordinates. False if no
/// point could be inserted. @throws Cancelled
bool restore_wanted(const PointHull& polytope, EdgeConstraints& constraints, double scale,
                    std::size_t most, const InsertMiddle& insert, const Progress& progress);

}  // namespace taut
