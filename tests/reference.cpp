#include "reference.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <set>

namespace taut_test {
namespace {

using boost::multiprecision::cpp_bin_float_quad;
using boost::multiprecision::cpp_rational;
using taut::dvec3;
using taut::dvec4;

constexpr real infinity = std::numeric_limits<real>::infinity();

std::vector<rvec4> widened(const std::vector<dvec4>& points) {
  std::vector<rvec4> result;
  for (const dvec4& p : points) result.emplace_back(p);
  return result;
}

rvec4 de_casteljau(std::vector<rvec4> b, real t) {
  for (std::size_t n = b.size(); n > 1; --n) {
    for (std::size_t i = 0; i + 1 < n; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
  }
  return b[0];
}

/// Value, first and second derivative of a Bernstein polynomial.
std::array<real, 3> scalar_jet(std::vector<real> b, real t) {
  const std::size_t n = b.size() - 1;
  const auto reduce = [&](std::size_t to) {
    for (std::size_t m = b.size() - 1; m > to; --m) {
      for (std::size_t i = 0; i + 1 <= m; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
      b.pop_back();
    }
  };
  std::array<real, 3> jet{};
  if (n >= 2) {
    reduce(2);
    jet[2] = real(n * (n - 1)) * (b[2] - 2 * b[1] + b[0]);
  }
  if (n >= 1) {
    reduce(1);
    jet[1] = real(n) * (b[1] - b[0]);
  }
  reduce(0);
  jet[0] = b[0];
  return jet;
}

struct Jet {
  real g, gu, gv, guu, guv, gvv;
};

Jet net_jet(const std::vector<real>& b, int p, int q, real u, real v) {
  std::array<std::vector<real>, 3> columns;
  for (int i = 0; i <= p; ++i) {
    const auto row = b.begin() + i * (q + 1);
    const auto jet = scalar_jet(std::vector<real>(row, row + q + 1), v);
    for (std::size_t k = 0; k < 3; ++k) columns[k].push_back(jet[k]);
  }
  const auto along0 = scalar_jet(columns[0], u);
  const auto along1 = scalar_jet(columns[1], u);
  const auto along2 = scalar_jet(columns[2], u);
  return {along0[0], along0[1], along1[0], along0[2], along1[1], along2[0]};
}

/// A sub-rectangle of an element with the nets of x . n and the weight.
struct Cell {
  std::size_t element;
  int p, q;
  real u, v, du, dv;
  std::vector<real> N, W;
  real bound;

  void find_bound() {
    bound = -infinity;
    for (std::size_t k = 0; k < N.size(); ++k) bound = std::max(bound, N[k] / W[k]);
  }
  /// Largest differences of neighbouring control values: where to split.
  real variation_u() const {
    const auto row = std::size_t(q + 1);
    real most = p > 0 ? 0 : -1;
    for (std::size_t k = 0; k + row < N.size(); ++k) {
      most = std::max(most, std::abs(N[k + row] / W[k + row] - N[k] / W[k]));
    }
    return most;
  }
  real variation_v() const {
    const auto row = std::size_t(q + 1);
    real most = q > 0 ? 0 : -1;
    for (std::size_t k = 0; k + 1 < N.size(); ++k) {
      if ((k + 1) % row != 0) most = std::max(most, std::abs(N[k + 1] / W[k + 1] - N[k] / W[k]));
    }
    return most;
  }
  /// The largest value at a corner, which lies on the element.
  real attained(real& at_u, real& at_v) const {
    real best = -infinity;
    for (const int i : {0, p}) {
      for (const int j : {0, q}) {
        const std::size_t k = std::size_t(i * (q + 1) + j);
        if (N[k] / W[k] > best) {
          best = N[k] / W[k];
          at_u = i == 0 ? u : u + du;
          at_v = j == 0 ? v : v + dv;
        }
      }
    }
    return best;
  }
};

void halve(std::vector<real>& b, std::vector<real>& upper, int first, int stride, int n) {
  const auto at = [&](int i) { return std::size_t(first + i * stride); };
  // The triangle of de Casteljau: its left side is the lower half, its right side the upper one.
  upper[at(n)] = b[at(n)];
  for (int r = 1; r <= n; ++r) {
    for (int i = n; i >= r; --i) b[at(i)] = (b[at(i - 1)] + b[at(i)]) / 2;
    upper[at(n - r)] = b[at(n)];
  }
}

std::pair<Cell, Cell> split(Cell lower, bool along_u) {
  Cell upper = lower;
  for (auto net : {&Cell::N, &Cell::W}) {
    if (along_u) {
      for (int j = 0; j <= lower.q; ++j) halve(lower.*net, upper.*net, j, lower.q + 1, lower.p);
    } else {
      for (int i = 0; i <= lower.p; ++i) {
        halve(lower.*net, upper.*net, i * (lower.q + 1), 1, lower.q);
      }
    }
  }
  if (along_u) {
    lower.du /= 2;
    upper.du = lower.du;
    upper.u += lower.du;
  } else {
    lower.dv /= 2;
    upper.dv = lower.dv;
    upper.v += lower.dv;
  }
  lower.find_bound();
  upper.find_bound();
  return {std::move(lower), std::move(upper)};
}

/// Local ascent on an element, any start; returns a value that is attained.
real ascend(const Cell& root, real u, real v) {
  const auto value = [&](real a, real b) {
    return net_jet(root.N, root.p, root.q, a, b).g / net_jet(root.W, root.p, root.q, a, b).g;
  };
  real h = value(u, v);
  for (int step = 0; step < 20; ++step) {
    std::vector<real> g(root.N.size());
    for (std::size_t k = 0; k < g.size(); ++k) g[k] = root.N[k] - h * root.W[k];
    const Jet j = net_jet(g, root.p, root.q, u, v);
    // Newton where concave, coordinates at a bound that they press against held.
    const bool hold_u = (u <= 0 && j.gu <= 0) || (u >= 1 && j.gu >= 0) || root.p == 0;
    const bool hold_v = (v <= 0 && j.gv <= 0) || (v >= 1 && j.gv >= 0) || root.q == 0;
    real du = 0;
    real dv = 0;
    const real det = j.guu * j.gvv - j.guv * j.guv;
    if (!hold_u && !hold_v && j.guu < 0 && det > 0) {
      du = (j.guv * j.gv - j.gvv * j.gu) / det;
      dv = (j.guv * j.gu - j.guu * j.gv) / det;
    } else {
      if (!hold_u && j.guu < 0) du = -j.gu / j.guu;
      if (!hold_v && j.gvv < 0 && (hold_u || !(j.guu < 0))) dv = -j.gv / j.gvv;
    }
    const real next_u = std::clamp<real>(u + du, 0, 1);
    const real next_v = std::clamp<real>(v + dv, 0, 1);
    const real next = value(next_u, next_v);
    if (!(next > h)) break;
    h = next;
    u = next_u;
    v = next_v;
  }
  return h;
}

}  // namespace

rvec3 reference_point(const taut::BezierCurve& curve, real t) {
  const rvec4 p = de_casteljau(widened(curve.points), t);
  return rvec3(p) / p.w;
}

rvec3 reference_point(const taut::BezierPatch& patch, real u, real v) {
  std::vector<rvec4> column;
  for (int i = 0; i <= patch.degree_u; ++i) {
    const auto row = patch.points.begin() + i * (patch.degree_v + 1);
    column.push_back(de_casteljau(widened({row, row + patch.degree_v + 1}), v));
  }
  const rvec4 p = de_casteljau(column, u);
  return rvec3(p) / p.w;
}

real distance_to_tetrahedron(const rvec3& x, const std::array<dvec3, 4>& corners) {
  // The nearest point lies inside a simplex of one to four corners; all of them are tried.
  real best = infinity;
  std::array<rvec3, 4> c;
  for (std::size_t k = 0; k < 4; ++k) c[k] = rvec3(corners[k]) - x;
  for (unsigned mask = 1; mask < 16; ++mask) {
    std::vector<rvec3> p;
    for (unsigned k = 0; k < 4; ++k) {
      if ((mask >> k & 1U) != 0) p.push_back(c[k]);
    }
    rvec3 nearest = p[0];
    if (p.size() == 2) {
      const rvec3 e = p[1] - p[0];
      const real t = glm::dot(e, e) > 0 ? -glm::dot(p[0], e) / glm::dot(e, e) : 0;
      nearest = p[0] + std::clamp<real>(t, 0, 1) * e;
    } else if (p.size() >= 3) {
      // Barycentric coordinates of the projection; a degenerate simplex is left to its sides.
      const rvec3 a = p[1] - p[0];
      const rvec3 b = p[2] - p[0];
      const rvec3 n = glm::cross(a, b);
      const real nn = glm::dot(n, n);
      if (p.size() == 3) {
        if (!(nn > 0)) continue;
        const real s = glm::dot(glm::cross(-p[0], b), n) / nn;
        const real t = glm::dot(glm::cross(a, -p[0]), n) / nn;
        if (s < 0 || t < 0 || s + t > 1) continue;
        nearest = p[0] + s * a + t * b;
      } else {
        const rvec3 d = p[3] - p[0];
        const real det = glm::dot(n, d);
        if (det == 0) continue;
        const real r = glm::dot(n, -p[0]) / det;
        const real s = glm::dot(glm::cross(-p[0], b), d) / det;
        const real t = glm::dot(glm::cross(a, -p[0]), d) / det;
        if (r < 0 || s < 0 || t < 0 || r + s + t > 1) continue;
        nearest = p[0] + s * a + t * b + r * d;
      }
    }
    best = std::min(best, glm::length(nearest));
  }
  return best;
}

ReferenceSupport::ReferenceSupport(const taut::Model& model, const dvec3& origin) {
  for (const taut::Instance& instance : model.instances()) {
    const taut::Part& part = model.parts()[std::size_t(instance.part)];
    const auto add = [&](int p, int q, const std::vector<dvec4>& points) {
      Element element{p, q, {}};
      for (const dvec4& x : points) {
        rvec4 placed;
        placed.w = real(x.w);
        for (int i = 0; i < 3; ++i) {
          cpp_bin_float_quad sum = instance.pose.translation[i];
          sum -= origin[i];
          for (int j = 0; j < 3; ++j) {
            sum +=
                cpp_bin_float_quad(instance.pose.rotation[j][i]) * cpp_bin_float_quad(x[j]) / x.w;
          }
          size_ = std::max(size_, std::abs(static_cast<real>(sum)));
          placed[i] = static_cast<real>(sum * x.w);
        }
        element.points.push_back(placed);
      }
      elements_.push_back(std::move(element));
    };
    for (const taut::Patch& patch : part.patches()) {
      add(patch.bezier.degree_u, patch.bezier.degree_v, patch.bezier.points);
    }
    // The borders of patches and their corners are in the patches already.
    for (const taut::EdgePiece& piece : part.pieces()) {
      if (piece.edge < 0) break;  // seams
      if (!part.edges()[std::size_t(piece.edge)].faces.empty()) continue;
      add(piece.bezier.degree(), 0, piece.bezier.points);
    }
    for (int k = 0; k < part.point_count(); ++k) {
      add(0, 0, {taut::homogeneous(part.vertices()[std::size_t(k)])});
    }
  }
}

SupportRange ReferenceSupport::operator()(const dvec3& n, real accuracy) const {
  constexpr int cell_limit = 100'000;
  const rvec3 direction(n);
  std::vector<Cell> cells;
  const auto lower_bound = [&](int a, int b) {
    return cells[std::size_t(a)].bound < cells[std::size_t(b)].bound;
  };
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    Cell cell{e, elements_[e].p, elements_[e].q, 0, 0, 1, 1, {}, {}, 0};
    for (const rvec4& p : elements_[e].points) {
      cell.N.push_back(glm::dot(rvec3(p), direction));
      cell.W.push_back(p.w);
    }
    cell.find_bound();
    cells.push_back(std::move(cell));
  }
  const std::vector<Cell> roots = cells;
  std::priority_queue<int, std::vector<int>, decltype(lower_bound)> queue(lower_bound);
  SupportRange range{-infinity, infinity};
  for (std::size_t k = 0; k < cells.size(); ++k) queue.push(int(k));
  const auto raise = [&](const Cell& cell) {
    real u = 0;
    real v = 0;
    if (!(cell.attained(u, v) > range.lower)) return;
    range.lower = std::max(cell.attained(u, v), ascend(roots[cell.element], u, v));
  };
  for (const Cell& cell : roots) raise(cell);
  const real close = accuracy * size_;
  for (int count = 0;; ++count) {
    const int top = queue.top();
    const real bound = cells[std::size_t(top)].bound;
    if (bound <= range.lower + close || count >= cell_limit) {
      range.upper = std::max(bound, range.lower);
      return range;
    }
    queue.pop();
    Cell& cell = cells[std::size_t(top)];
    const bool along_u = cell.variation_u() >= cell.variation_v();
    auto [lower, upper] = split(std::move(cell), along_u);
    raise(lower);
    raise(upper);
    cells[std::size_t(top)] = std::move(lower);
    cells.push_back(std::move(upper));
    queue.push(top);
    queue.push(int(cells.size()) - 1);
  }
}

namespace {

using Exact3 = std::array<cpp_rational, 3>;

Exact3 to_exact(const dvec3& p) { return {p.x, p.y, p.z}; }

Exact3 operator-(const Exact3& a, const Exact3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

cpp_rational dot(const Exact3& a, const Exact3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool is_zero(const Exact3& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

/// A plane with its outward normal, by the first three corners that are not collinear.
struct ExactPlane {
  Exact3 point;
  Exact3 normal;
  /// Sign of the height of x: by long double where that is certain.
  int side(const dvec3& x, const rvec3& rounded_normal, const dvec3& origin) const {
    const rvec3 d = rvec3(x) - rvec3(origin);
    const real value = glm::dot(rounded_normal, d);
    const real error =
        1e-15L * (std::abs(rounded_normal.x * d.x) + std::abs(rounded_normal.y * d.y) +
                  std::abs(rounded_normal.z * d.z));
    if (std::abs(value) > error) return value > 0 ? 1 : -1;
    return dot(normal, to_exact(x) - point).sign();
  }
};

}  // namespace

MeshFacts mesh_facts(const taut::PolygonMesh& mesh) {
  MeshFacts facts;
  std::map<std::pair<int, int>, int> half_edges;  // directed edge -> polygon
  bool simple = true;
  std::vector<int> corners(mesh.points.size(), 0);
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    const std::vector<int>& p = mesh.polygons[f];
    for (std::size_t k = 0; k < p.size(); ++k) {
      ++corners[std::size_t(p[k])];
      simple = half_edges.emplace(std::pair(p[k], p[(k + 1) % p.size()]), int(f)).second && simple;
    }
    if (p.size() < 3) simple = false;
  }
  for (const auto& [edge, f] : half_edges) {
    simple = simple && half_edges.contains({edge.second, edge.first});
  }
  facts.all_points_used = std::all_of(corners.begin(), corners.end(), [](int c) { return c > 0; });
  facts.euler = long(mesh.points.size()) - long(half_edges.size() / 2) + long(mesh.polygons.size());
  // One fan a vertex: turning about it from any half-edge passes all its corners.
  if (simple) {
    std::vector<int> start(mesh.points.size(), -1);
    for (const auto& [edge, f] : half_edges) start[std::size_t(edge.first)] = edge.second;
    for (std::size_t v = 0; v < mesh.points.size() && simple; ++v) {
      if (start[v] < 0) continue;
      int turned = 0;
      int to = start[v];
      do {
        const std::vector<int>& p = mesh.polygons[std::size_t(half_edges.at({int(v), to}))];
        const auto here = std::find(p.begin(), p.end(), int(v));
        to = here == p.begin() ? p.back() : *(here - 1);
        ++turned;
      } while (to != start[v] && turned <= corners[v]);
      simple = turned == corners[v];
    }
  }
  facts.closed_manifold = simple && !mesh.polygons.empty();
  if (!facts.closed_manifold) return facts;

  std::vector<ExactPlane> planes;
  std::vector<rvec3> rounded;
  facts.no_zero_area = true;
  facts.planar = true;
  facts.strictly = true;
  for (const std::vector<int>& p : mesh.polygons) {
    const Exact3 a = to_exact(mesh.points[std::size_t(p[0])]);
    Exact3 normal{};
    for (std::size_t k = 1; k + 1 < p.size() && is_zero(normal); ++k) {
      normal = cross(to_exact(mesh.points[std::size_t(p[k])]) - a,
                     to_exact(mesh.points[std::size_t(p[k + 1])]) - a);
    }
    facts.no_zero_area = facts.no_zero_area && !is_zero(normal);
    for (std::size_t k = 0; k < p.size(); ++k) {
      const Exact3 x = to_exact(mesh.points[std::size_t(p[k])]);
      const Exact3 y = to_exact(mesh.points[std::size_t(p[(k + 1) % p.size()])]);
      const Exact3 z = to_exact(mesh.points[std::size_t(p[(k + 2) % p.size()])]);
      if (p.size() > 3) {
        facts.planar = facts.planar && dot(normal, x - a) == 0;
        facts.strictly = facts.strictly && dot(cross(y - x, z - y), normal) > 0;
      }
    }
    planes.push_back({a, normal});
    rounded.emplace_back(static_cast<real>(normal[0]), static_cast<real>(normal[1]),
                         static_cast<real>(normal[2]));
  }
  facts.edges_convex = true;
  for (const auto& [edge, f] : half_edges) {
    const std::vector<int>& other =
        mesh.polygons[std::size_t(half_edges.at({edge.second, edge.first}))];
    bool below = false;
    for (const int v : other) {
      const int side =
          planes[std::size_t(f)].side(mesh.points[std::size_t(v)], rounded[std::size_t(f)],
                                      mesh.points[std::size_t(mesh.polygons[std::size_t(f)][0])]);
      if (side > 0) facts.edges_convex = false;
      if (side < 0) below = true;
    }
    if (!below) facts.strictly = false;
  }
  return facts;
}

real mesh_support(const taut::PolygonMesh& mesh, const dvec3& n, const dvec3& origin) {
  real h = -infinity;
  for (const dvec3& p : mesh.points) h = std::max(h, glm::dot(rvec3(p) - rvec3(origin), rvec3(n)));
  return h;
}

}  // namespace taut_test
