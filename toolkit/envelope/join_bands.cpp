#include "taut/envelope/gauss_triangles.h"

namespace taut {
namespace {

/// Steps along a join.
constexpr int join_steps = 8;

}  // namespace

void add_join_bands(const ContactGeometry& geometry, const Contact& patch, int element,
                    const GaussTriangleOptions& options, GaussTriangles& result) {
  struct Rung {
    dvec3 x, own, other;
    dvec2 uv;
  };
  const auto at = [&](int index, const dvec2& uv) {
    return Contact{patch.instance, SourceKind::face, index, uv.x, uv.y};
  };
  for (const Side side : all_sides) {
    const Border& border = geometry.patch(patch).borders[std::size_t(side)];
    if (border.kind != BorderKind::smooth || border.neighbor <= patch.element) continue;
    std::vector<Rung> rungs;
    bool differ = false;
    for (int k = 0; k <= join_steps; ++k) {
      const double t = double(k) / join_steps;
      const Contact here = at(patch.element, on_side(side, t));
      const Contact there =
          at(border.neighbor, on_side(border.neighbor_side, border.reversed ? 1 - t : t));
      const ContactJet j = geometry.jet(here);
      const dvec3 n = surface_normal(geometry, here, j).n;
      dvec3 m = surface_normal(geometry, there, geometry.jet(there)).n;
      if (glm::dot(n, m) < 0) m = -m;
      if (n == dvec3(0.0) || m == dvec3(0.0)) continue;
      differ = differ || glm::distance(n, m) > options.direction_tolerance;
      rungs.push_back({j.x, n, m, {here.u, here.v}});
    }
    if (!differ) continue;
    for (const double sign : {1.0, -1.0}) {
      std::vector<std::array<int, 2>> nodes;
      nodes.reserve(rungs.size());
      for (const Rung& r : rungs) {
        nodes.push_back({result.add_node({sign * r.own, r.x, r.uv}),
                         result.add_node({sign * r.other, r.x, r.uv})});
      }
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        result.add_triangle(element, nodes[k][0], nodes[k + 1][0], nodes[k + 1][1], false);
        result.add_triangle(element, nodes[k][0], nodes[k + 1][1], nodes[k][1], false);
      }
    }
  }
}

}  // namespace taut
