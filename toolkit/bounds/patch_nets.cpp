#include "taut/bounds/patch_nets.h"

#include <algorithm>

#include "taut/bounds/second_form.h"
#include "taut/bounds/vector_net.h"

namespace taut {
namespace {

BezierPatch patch_of(const SceneElement& element) {
  BezierPatch patch{element.shape.p, element.shape.q, {}};
  const SceneNet& net = element.net;
  for (std::size_t k = 0; k < net.x.size(); ++k) {
    patch.points.emplace_back(net.x[k], net.y[k], net.z[k], net.w[k]);
  }
  return patch;
}

}  // namespace

PatchNets::PatchNets(const SceneElement& element) : element_(&element) {
  const BezierPatch patch = patch_of(element);
  NormalNet net = normal_net(patch);
  normal_shape_ = net.shape;
  root_ = {patch.points, std::move(net.vectors)};
  for (const dvec3& n : root_.normals) normal_size_ = std::max(normal_size_, glm::length(n));
  double size = 0;
  for (const dvec4& p : root_.points) size = std::max(size, glm::length(p));
  normal_rounding_ = net.rounding_bound;
  ruled_ = element.ruled() || normal_size_ <= normal_rounding_;
  // Means of two are rounded once, at most degree times a level and direction; 40 levels as for
  // support values.
  point_rounding_ = 40 * (element.shape.p + element.shape.q) * rounding_unit * size;
}

std::vector<dvec3> PatchNets::normals(const Interval& u, const Interval& v) const {
  std::vector<dvec3> result = root_.normals;
  restrict_net(normal_shape_, result.data(), u, v);
  return result;
}

std::vector<dvec4> PatchNets::points(const Interval& u, const Interval& v) const {
  std::vector<dvec4> result = root_.points;
  restrict_net(element_->shape, result.data(), u, v);
  return result;
}

void PatchNets::quarter_points(const std::vector<dvec4>& points,
                               std::array<CellNets, 4>& quarters) const {
  std::array<dvec4*, 4> to;
  for (std::size_t k = 0; k < 4; ++k) {
    quarters[k].points.resize(points.size());
    to[k] = quarters[k].points.data();
  }
  quarter(element_->shape, points.data(), to);
}

void PatchNets::quarter_normals(const std::vector<dvec3>& normals,
                                std::array<CellNets, 4>& quarters) const {
  std::array<dvec3*, 4> to;
  for (std::size_t k = 0; k < 4; ++k) {
    quarters[k].normals.resize(normals.size());
    to[k] = quarters[k].normals.data();
  }
  quarter(normal_shape_, normals.data(), to);
}

NormalBounds PatchNets::bounds(const CellNets& cell, int level) const {
  NormalBounds result;
  // The sides of the pyramid follow the way in which the normals change along u, or else v.
  const auto end = [&](int i, int j) -> const dvec3& {
    return cell.normals[std::size_t(i * (normal_shape_.q + 1) + j)];
  };
  const auto direction_of = [](const dvec3& a, const dvec3& b) { return unit(a + b); };
  const int p = normal_shape_.p;
  const int q = normal_shape_.q;
  const dvec3 along_u = direction_of(end(p, 0), end(p, q)) - direction_of(end(0, 0), end(0, q));
  const dvec3 along_v = direction_of(end(0, q), end(p, q)) - direction_of(end(0, 0), end(p, 0));
  const bool u_first = glm::dot(along_u, along_u) >= glm::dot(along_v, along_v);
  // Two roundings of a mean, one of the weights, at most degree times a level and direction.
  const double rounding =
      normal_rounding_ + 4.0 * (level + 1) * (p + q) * rounding_unit * normal_size_;
  result.pyramid = normal_pyramid(cell.normals, rounding, u_first ? along_u : along_v);
  if (!result.pyramid || element_->stand_in) return result;
  const SecondForm form = second_form(element_->shape, element_->rational, cell.points, cell.points,
                                      result.pyramid->corners, point_rounding_);
  result.signs = {form.may_be_negative(), form.may_be_positive()};
  result.definite = form.surely_negative() || form.surely_positive();
  return result;
}

}  // namespace taut
