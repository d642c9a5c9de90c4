#include "taut/hull/sample/vertex_normals.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "taut/core/tolerances.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

/// Directions asked for, after which the best one is taken. Along a smooth curve each halves the
/// angle.
constexpr std::size_t directions_limit = 64;

/// The nearest unit vector to n whose products with all of these are no more than the slack; NaN if
/// there is none. @pre only that with the last is more of the nearest one for those before
dvec3 nearest_below(const dvec3& n, const std::vector<dvec3>& all, double slack) {
  dvec3 nearest(std::numeric_limits<double>::quiet_NaN());
  double highest = -infinity;
  const auto offer = [&](const dvec3& to) {
    const dvec3 own = unit(to);
    const double cosine = glm::dot(own, n);
    const auto below = [&](const dvec3& d) { return glm::dot(d, own) <= slack; };
    if (!(cosine > highest) || !std::all_of(all.begin(), all.end(), below)) return;
    highest = cosine;
    nearest = own;
  };
  const dvec3& last = all.back();
  offer(n - glm::dot(n, last) / glm::dot(last, last) * last);
  for (const dvec3& d : all) {
    const dvec3 both = glm::cross(d, last);
    offer(glm::dot(both, n) < 0 ? -both : both);
  }
  return nearest;
}

}  // namespace

VertexNormals::VertexNormals(const Scene& scene, Stop stop)
    : scene_(scene),
      query_(scene, std::move(stop)),
      slack_(support_slack + scene.frame().length_to_frame(vertex_rounding(scene))) {}

/// The mean of the facets about a vertex on an edge, across it, or at a corner.
dvec3 VertexNormals::mean(const HullMesh& mesh, OpenMesh::VertexHandle v, const Contact& c) const {
  HullMesh::Normal sum;
  mesh.calc_vertex_normal_correct(v, sum);
  const dvec3 n(sum[0], sum[1], sum[2]);
  if (c.kind != SourceKind::edge) return n;
  const Model& model = scene_.model();
  const Instance& instance = model.instances()[std::size_t(c.instance)];
  const Part& part = model.parts()[std::size_t(instance.part)];
  const BezierCurve& curve = part.pieces()[std::size_t(c.element)].bezier;
  const dvec3 along = unit(instance.pose.rotation * jet(curve, c.u).ct);
  return n - glm::dot(n, along) * along;
}

/// A direction n supports at x if n . (y - x) <= 0 for all points y of the model, of which the
/// highest ones are found one after the other.
dvec3 VertexNormals::turned(const dvec3& x, const Sample& sample) {
  if (sample.answered) return sample.n;
  dvec3 n = sample.n;
  dvec3 best = n;
  double least = infinity;
  std::vector<dvec3> to;
  while (to.size() < directions_limit) {
    const Support highest = query_(n, sample.contact);
    const double above = highest.h - glm::dot(n, x);
    if (!(above > slack_)) return n;
    if (above < least) {
      least = above;
      best = n;
    }
    to.push_back(highest.point - x);
    n = nearest_below(sample.n, to, slack_);
    if (!(glm::dot(n, n) > 0)) break;
  }
  return best;
}

dvec3 VertexNormals::operator()(const HullMesh& mesh, OpenMesh::VertexHandle v,
                                const Sample& sample) {
  const dvec3 x = scene_.frame().to_frame(position(mesh, v));
  if (sample.contact.kind != SourceKind::face) {
    const dvec3 sum = mean(mesh, v, sample.contact);
    const dvec3 n = unit(sum);
    if (glm::dot(sum, sum) > 0 && query_(n, sample.contact).h - glm::dot(n, x) <= slack_) return n;
  }
  return turned(x, sample);
}

}  // namespace taut
