#pragma once

#include <optional>
#include <vector>

#include "taut/hull/decide/branches.h"
#include "taut/hull/decide/direction_cube.h"

namespace taut {

/// Planes that touch all that is left in a cell.
class CellPlanes {
 public:
  /// The view and its branches must outlive it.
  CellPlanes(const CellView& view, const Branches& branches, double resolution)
      : view_(view), branches_(branches), rho_(resolution) {}

  void turn_to(const FaceAxes& axes) { axes_ = axes; }

  struct Plane {
    dvec3 normal = dvec3(0.0);  ///< outwards
    double width = 0;           ///< how far what touches it reaches from a line in it, at least
  };
  /// One that all that is left is within the resolution of, with a normal in the cell or beside it.
  std::optional<Plane> facet();
  /// That which touches three branches. @pre there are three
  Plane node() const;
  /// The normal is in the cell or beside it.
  bool is_near(const dvec3& normal) const;
  /// What is left is near one plane because it is small: a few levels below it is near all planes.
  bool is_spot() const;

 private:
  void collect_points();
  double width() const;

  const CellView& view_;
  const Branches& branches_;
  double rho_;
  FaceAxes axes_ = {};
  std::vector<dvec3> points_;  // scratch
};

}  // namespace taut
