#pragma once

#include <array>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull_document.h"
#include "taut/surface/bezier.h"

namespace taut {

/// A point of a hull document's source with its derivatives over a whole Bezier patch or curve, in
/// model units, relative to DocumentGeometry::origin().
struct SourceJet {
  int dimension = 0;  ///< parameters: 2 on a face, 1 on an edge, 0 at a vertex
  dvec3 x = dvec3(0.0);
  std::array<dvec3, 2> dx = {dvec3(0.0), dvec3(0.0)};
  dvec3 dxx = dvec3(0.0), dxy = dvec3(0.0), dyy = dvec3(0.0);
};

/// A place on one of a source's Bezier patches, curves or points: its number and the parameters in
/// [0, 1] there.
struct SourcePlace {
  int patch = -1;
  dvec2 t = dvec2(0.0);
};

/// The geometry that a hull document holds, as polynomials: nothing of the model is used but a
/// point near it, from which coordinates are measured lest digits are lost far from the origin.
class DocumentGeometry {
 public:
  /// The document must outlive it. `rounding`: what that of coordinates may do to lengths, as a
  /// fraction of the diagonal.
  DocumentGeometry(const HullDocument& hull, const dvec3& origin, double rounding);

  const HullDocument& hull() const { return hull_; }
  const dvec3& origin() const { return origin_; }
  /// Lengths as fractions of the diagonal, shares of parameters and angles that are no larger are
  /// those between two computations of the same.
  double noise() const { return exact_noise + rounding_; }
  const HullDocument::Source& source(int place) const {
    return hull_.sources[static_cast<std::size_t>(place)];
  }
  /// The point of a document relative to the origin.
  dvec3 local(const dvec3& p) const { return p - origin_; }

  /// All places with these parameters of the source: several where patches meet, none outside of
  /// its domain.
  std::vector<SourcePlace> places(int source, const dvec2& uv) const;
  std::vector<SourcePlace> places(const HullDocument::Contact& c) const;
  /// The source's parameters of a place, and back, also beside the patch.
  dvec2 parameters(int source, const SourcePlace& place) const;
  dvec2 place(int source, int patch, const dvec2& uv) const;
  /// Of one of its patches, in the source's parameters.
  dvec2 domain_size(int source, int patch) const;
  SourceJet jet(int source, const SourcePlace& place) const;
  /// Those of all pieces of an edge that meet the interval of its parameters, turned either way:
  /// what is between lies in their convex hull.
  std::vector<dvec3> control_points(int edge, const Interval& parameters) const;
  /// Unit normal along sign * (Su x Sv), by its limit where the patch degenerates; zero if none.
  dvec3 normal(int source, const SourcePlace& place, int sign) const;

 private:
  static constexpr double exact_noise = 1e-12;

  const HullDocument& hull_;
  dvec3 origin_;
  double rounding_;
  /// Per source and patch, as homogeneous control points.
  std::vector<std::vector<BezierPatch>> nets_;
};

/// The parameters of a contact, as many as there are.
dvec2 parameters(const HullDocument::Contact& c);

}  // namespace taut
