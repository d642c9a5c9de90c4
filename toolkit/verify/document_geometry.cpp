#include "taut/verify/document_geometry.h"

#include <algorithm>

#include "taut/core/integers.h"

namespace taut {

dvec2 parameters(const HullDocument::Contact& c) {
  return {c.uv.empty() ? 0 : c.uv[0], c.uv.size() < 2 ? 0 : c.uv[1]};
}

DocumentGeometry::DocumentGeometry(const HullDocument& hull, const dvec3& origin, double rounding)
    : hull_(hull), origin_(origin), rounding_(rounding) {
  nets_.reserve(hull.sources.size());
  for (const HullDocument::Source& source : hull.sources) {
    std::vector<BezierPatch>& nets = nets_.emplace_back();
    nets.reserve(source.patches.size());
    for (const HullDocument::Patch& patch : source.patches) {
      BezierPatch& net = nets.emplace_back();
      net.degree_u = patch.rows - 1;
      net.degree_v = patch.columns - 1;
      net.points.reserve(patch.points.size());
      for (const dvec4& p : patch.points) net.points.push_back(homogeneous(local(dvec3(p)), p.w));
    }
  }
}

std::vector<SourcePlace> DocumentGeometry::places(int place, const dvec2& uv) const {
  std::vector<SourcePlace> found;
  const std::vector<HullDocument::Patch>& patches = source(place).patches;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    SourcePlace here{int(i), dvec2(0.0)};
    bool inside = true;
    for (std::size_t k = 0; k < patches[i].domain.size(); ++k) {
      const Interval& interval = patches[i].domain[k];
      const double value = uv[int(k)];
      double t = (value - interval.lower) / (interval.upper - interval.lower);
      if (value == interval.upper) t = 1;
      inside = inside && 0 <= t && t <= 1;
      here.t[int(k)] = t;
    }
    if (inside) found.push_back(here);
  }
  return found;
}

std::vector<SourcePlace> DocumentGeometry::places(const HullDocument::Contact& c) const {
  return places(c.source, taut::parameters(c));
}

dvec2 DocumentGeometry::parameters(int place, const SourcePlace& at) const {
  dvec2 uv(0.0);
  const std::vector<Interval>& domain = source(place).patches[to_size(at.patch)].domain;
  for (std::size_t k = 0; k < domain.size(); ++k) {
    uv[int(k)] = domain[k].lower + at.t[int(k)] * (domain[k].upper - domain[k].lower);
  }
  return uv;
}

dvec2 DocumentGeometry::place(int at, int patch, const dvec2& uv) const {
  dvec2 t(0.0);
  const std::vector<Interval>& domain = source(at).patches[to_size(patch)].domain;
  for (std::size_t k = 0; k < domain.size(); ++k) {
    t[int(k)] = (uv[int(k)] - domain[k].lower) / (domain[k].upper - domain[k].lower);
  }
  return t;
}

dvec2 DocumentGeometry::domain_size(int at, int patch) const {
  dvec2 size(1.0);
  const std::vector<Interval>& domain = source(at).patches[to_size(patch)].domain;
  for (std::size_t k = 0; k < domain.size(); ++k) size[int(k)] = domain[k].upper - domain[k].lower;
  return size;
}

SourceJet DocumentGeometry::jet(int place, const SourcePlace& at) const {
  const BezierPatch& net = nets_[to_size(place)][to_size(at.patch)];
  switch (source(place).kind) {
    case SourceKind::vertex:
      return {0, euclidean(net.points[0])};
    case SourceKind::edge: {
      const CurveJet j = taut::jet(BezierCurve{net.points}, at.t.x);
      return {1, j.c, {j.ct, dvec3(0.0)}, j.ctt};
    }
    default: {
      const PatchJet2 j = jet2(net, at.t.x, at.t.y);
      return {2, j.S, {j.Su, j.Sv}, j.Suu, j.Suv, j.Svv};
    }
  }
}

std::vector<dvec3> DocumentGeometry::control_points(int edge, const Interval& parameters) const {
  const double least = std::min(parameters.lower, parameters.upper);
  const double most = std::max(parameters.lower, parameters.upper);
  std::vector<dvec3> points;
  const std::vector<HullDocument::Patch>& pieces = source(edge).patches;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Interval& domain = pieces[i].domain.front();
    if (domain.upper < least || domain.lower > most) continue;
    for (const dvec4& p : nets_[to_size(edge)][i].points) points.push_back(euclidean(p));
  }
  return points;
}

dvec3 DocumentGeometry::normal(int place, const SourcePlace& at, int sign) const {
  return double(sign) * unit_normal(nets_[to_size(place)][to_size(at.patch)], at.t.x, at.t.y);
}

}  // namespace taut
