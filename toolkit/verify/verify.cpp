#include "taut/verify/verify.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <tuple>

#include "taut/bounds/support_query.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"
#include "taut/core/predicates.h"
#include "taut/core/tolerances.h"
#include "taut/hull/polytope/point_hull.h"
#include "taut/hull/polytope/polytope_support.h"
#include "taut/hull/result/measures.h"

namespace taut {
namespace {

/// A directed edge of a polygon; sorting brings an edge and its reverse together.
struct DirectedEdge {
  int low, high;
  bool forward;  ///< runs from low to high
  int polygon;
};

std::vector<DirectedEdge> directed_edges(const PolygonMesh& mesh) {
  std::vector<DirectedEdge> edges;
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    const std::vector<int>& polygon = mesh.polygons[f];
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const int a = polygon[k];
      const int b = polygon[(k + 1) % polygon.size()];
      edges.push_back({std::min(a, b), std::max(a, b), a < b, int(f)});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const DirectedEdge& a, const DirectedEdge& b) {
    return std::tie(a.low, a.high, a.forward, a.polygon) <
           std::tie(b.low, b.high, b.forward, b.polygon);
  });
  return edges;
}

/// Disjoint sets over 0 .. size - 1.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// The mesh times a power of two, which no predicate notices.
PolygonMesh scaled(PolygonMesh mesh, double scale) {
  for (dvec3& p : mesh.points) p *= scale;
  return mesh;
}

/// Checks the mesh in model coordinates times the scene's scale, where no product leaves the range
/// of doubles.
class Verifier {
 public:
  Verifier(const PolygonMesh& mesh, const Scene& scene, const VerifyOptions& options)
      : mesh_(scaled(mesh, scene.frame().scale)),
        scene_(scene),
        options_(options),
        edges_(directed_edges(mesh)) {}

  Verification run();

 private:
  const dvec3& point(int v) const { return mesh_.points[std::size_t(v)]; }
  const std::vector<int>& polygon(int f) const { return mesh_.polygons[std::size_t(f)]; }

  void check_topology();
  void check_fans();
  void find_planes();
  void check_convexity();
  void measure_distances();

  /// Calls visit with the uses of every undirected edge.
  template <class Visit>
  void for_each_edge(Visit visit) const {
    for (std::size_t i = 0; i < edges_.size();) {
      std::size_t j = i;
      while (j < edges_.size() && edges_[j].low == edges_[i].low &&
             edges_[j].high == edges_[i].high) {
        ++j;
      }
      visit(std::span<const DirectedEdge>(edges_).subspan(i, j - i));
      i = j;
    }
  }

  PolygonMesh mesh_;
  const Scene& scene_;
  const VerifyOptions& options_;
  std::vector<DirectedEdge> edges_;
  std::vector<std::array<int, 3>> corners_;  ///< per polygon: three not on a line, or -1
  Verification result_;
};

void Verifier::check_topology() {
  result_.closed = result_.manifold = result_.oriented = !edges_.empty();
  Sets components(mesh_.polygons.size());
  long edge_count = 0;
  for_each_edge([&](std::span<const DirectedEdge> uses) {
    ++edge_count;
    if (uses.size() != 2) result_.closed = false;
    if (uses.size() > 2 || uses[0].low == uses[0].high) result_.manifold = false;
    if (uses.size() != 2 || uses[0].forward == uses[1].forward) result_.oriented = false;
    for (const DirectedEdge& use : uses) {
      components.join(std::size_t(uses[0].polygon), std::size_t(use.polygon));
    }
  });
  std::vector<bool> used(mesh_.points.size(), false);
  for (const auto& p : mesh_.polygons) {
    for (const int v : p) used[std::size_t(v)] = true;
  }
  const long euler =
      std::count(used.begin(), used.end(), true) - edge_count + long(mesh_.polygons.size());
  result_.topological_sphere = euler == 2;
  for (std::size_t f = 1; f < mesh_.polygons.size(); ++f) {
    if (components.root(f) != components.root(0)) result_.topological_sphere = false;
  }
  check_fans();
  // The two sides of a planar hull hold no volume, up to rounding.
  const Measures measures = measure(mesh_);
  Box box;
  for (const dvec3& p : mesh_.points) box.include(p);
  const dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  const double rounding = flat_width + coordinate_rounding * (reach.x + reach.y + reach.z);
  if (result_.oriented) result_.oriented = measures.volume > -rounding * measures.area;
}

/// The polygon corners about a vertex are one fan iff edges join them all.
void Verifier::check_fans() {
  std::vector<std::size_t> first(mesh_.polygons.size() + 1, 0);
  for (std::size_t f = 0; f < mesh_.polygons.size(); ++f) {
    first[f + 1] = first[f] + mesh_.polygons[f].size();
  }
  Sets corners(first.back());
  const auto corner = [&](int f, int v) {
    const std::vector<int>& p = polygon(f);
    return first[std::size_t(f)] +
           static_cast<std::size_t>(std::find(p.begin(), p.end(), v) - p.begin());
  };
  for_each_edge([&](std::span<const DirectedEdge> uses) {
    for (const DirectedEdge& use : uses) {
      for (const int v : {use.low, use.high}) {
        corners.join(corner(uses[0].polygon, v), corner(use.polygon, v));
      }
    }
  });
  std::vector<std::size_t> fan(mesh_.points.size(), first.back());
  for (std::size_t f = 0; f < mesh_.polygons.size(); ++f) {
    for (const int v : mesh_.polygons[f]) {
      const std::size_t root = corners.root(corner(int(f), v));
      std::size_t& seen = fan[std::size_t(v)];
      if (seen != first.back() && seen != root) result_.manifold = false;
      seen = root;
    }
  }
}

/// Three corners of each polygon that are not on a line, in the polygon's sense.
void Verifier::find_planes() {
  result_.no_zero_area = true;
  for (const std::vector<int>& p : mesh_.polygons) {
    std::array<int, 3> found = {-1, -1, -1};
    std::size_t b = 1;
    while (b < p.size() && point(p[b]) == point(p[0])) ++b;
    for (std::size_t c = b + 1; c < p.size(); ++c) {
      if (!collinear(point(p[0]), point(p[b]), point(p[c]))) {
        found = {p[0], p[b], p[c]};
        break;
      }
    }
    if (found[0] < 0) result_.no_zero_area = false;
    corners_.push_back(found);
  }
}

void Verifier::check_convexity() {
  result_.convex = result_.closed && result_.manifold && result_.oriented && result_.no_zero_area &&
                   result_.topological_sphere;
  const auto none_above = [&](int f, int g) {
    const auto& c = corners_[std::size_t(f)];
    return std::all_of(polygon(g).begin(), polygon(g).end(), [&](int v) {
      const Sign side = orientation(point(c[0]), point(c[1]), point(c[2]), point(v));
      return f == g ? side == Sign::zero : side != Sign::positive;
    });
  };
  for (std::size_t f = 0; f < mesh_.polygons.size() && result_.convex; ++f) {
    result_.convex = none_above(int(f), int(f));
  }
  for_each_edge([&](std::span<const DirectedEdge> uses) {
    if (result_.convex) result_.convex = none_above(uses[0].polygon, uses[1].polygon);
  });
}

/// The support function of points, each query started from the answer to the last one.
class PointSupport {
 public:
  explicit PointSupport(const std::vector<dvec3>& points) : points_(points), hull_(box_of(points)) {
    hull_.add(points);
    if (hull_.dimension() == 3) climb_.emplace(hull_);
  }

  /// max (p - origin) . n; `near` is the vertex where it was attained last, -1 at first.
  double value(const dvec3& n, const dvec3& origin, int& near) const {
    if (climb_) {
      near = near < 0 ? (*climb_)(n) : (*climb_)(n, near);
      return glm::dot(hull_.point(near) - origin, n);
    }
    double h = -std::numeric_limits<double>::infinity();
    for (const dvec3& p : points_) h = std::max(h, glm::dot(p - origin, n));
    return h;
  }

 private:
  static Box box_of(const std::vector<dvec3>& points) {
    Box box;
    for (const dvec3& p : points) box.include(p);
    return box;
  }

  const std::vector<dvec3>& points_;
  PointHull hull_;
  std::optional<PolytopeSupport> climb_;  ///< where the points span space
};

/// Facet normals, vertex normals (which look for what a corner may hide) and random directions.
std::vector<dvec3> directions(const PolygonMesh& mesh, const std::vector<dvec3>& normals,
                              const VerifyOptions& options) {
  std::vector<dvec3> result = normals;
  std::vector<dvec3> at_vertex(mesh.points.size(), dvec3(0.0));
  for (std::size_t f = 0; f < normals.size(); ++f) {
    for (const int v : mesh.polygons[f]) at_vertex[std::size_t(v)] += normals[f];
  }
  for (const dvec3& n : at_vertex) result.push_back(unit(n));
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> gaussian;
  for (int k = 0; k < options.random_directions; ++k) {
    const double x = gaussian(random);
    const double y = gaussian(random);
    result.push_back(unit({x, y, gaussian(random)}));
  }
  std::erase_if(result, [](const dvec3& n) { return n == dvec3(0.0); });
  return result;
}

void Verifier::measure_distances() {
  const dvec3 center = scene_.frame().scale * scene_.frame().center;
  std::vector<dvec3> normals(mesh_.polygons.size(), dvec3(0.0));
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const std::vector<int>& p = mesh_.polygons[f];
    for (std::size_t k = 1; k + 1 < p.size(); ++k) {
      normals[f] += glm::cross(point(p[k]) - point(p[0]), point(p[k + 1]) - point(p[0]));
    }
    normals[f] = unit(normals[f]);
  }
  const PointSupport mesh_support(mesh_.points);
  int top = -1;
  for (std::size_t f = 0; f < normals.size(); ++f) {
    if (result_.convex) break;  // exactly so: nothing to measure
    const double above = mesh_support.value(normals[f], point(mesh_.polygons[f][0]), top);
    result_.largest_violation = std::max(result_.largest_violation, above);
  }

  const std::vector<dvec3> tried = directions(mesh_, normals, options_);
  result_.directions = int(tried.size());
  std::vector<double> difference(tried.size());
  parallel_for(tried.size(), 256, options_.threads, [&](std::size_t begin, std::size_t end) {
    SupportQuery query(scene_, options_.progress.stop);
    Contact near;
    int near_vertex = -1;
    for (std::size_t k = begin; k < end; ++k) {
      options_.progress.check();
      const Support s = query(tried[k], near);
      near = s.contact;
      difference[k] = s.h - mesh_support.value(tried[k], center, near_vertex);
    }
  });
  for (const double d : difference) {
    result_.model_outside = std::max(result_.model_outside, d);
    result_.mesh_outside = std::max(result_.mesh_outside, -d);
  }
}

Verification Verifier::run() {
  for (const auto& p : mesh_.polygons) {
    for (const int v : p) {
      if (v < 0 || v >= int(mesh_.points.size())) {
        throw InvalidInput("polygon vertex " + std::to_string(v) + " is out of range");
      }
    }
    if (p.size() < 3) throw InvalidInput("a polygon has fewer than three corners");
  }
  if (mesh_.points.empty()) throw InvalidInput("the mesh has no vertices");
  if (mesh_.polygons.empty() && mesh_.points.size() <= 2) {
    // A point or a segment has no boundary that could be wrong.
    result_.closed = result_.manifold = result_.oriented = result_.topological_sphere = true;
    result_.no_zero_area = result_.convex = true;
  } else {
    check_topology();
    find_planes();
    check_convexity();
  }
  measure_distances();
  for (double* length :
       {&result_.largest_violation, &result_.model_outside, &result_.mesh_outside}) {
    *length = scene_.frame().length_to_model(*length);
  }
  return result_;
}

}  // namespace

Verification verify(const PolygonMesh& mesh, const Scene& scene, const VerifyOptions& options) {
  return Verifier(mesh, scene, options).run();
}

}  // namespace taut
