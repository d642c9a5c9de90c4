#include "taut/bounds/support_polish.h"

#include <array>
#include <cmath>

#include "taut/bounds/second_order.h"
#include "taut/surface/rulings.h"

namespace taut {
namespace {

/// A value that is the same, up to rounding, at this share of a parameter's range from an end and
/// at the end itself is constant between.
constexpr double flat_length = 1e-3;

/// A second derivative whose determinant is this share of its diagonal's product has no direction
/// in which the value stays constant.
constexpr double curved = 1e-6;

}  // namespace

void SupportPolish::take(const SceneElement& element, const dvec3& n) {
  element_ = &element;
  nets_.resize(element.net.value_count(element.rational));
  element.net.values(n, element.rational, nets_.data());
}

template <class Net>
double SupportPolish::value(const Net& net, double u, double v) const {
  const double* N = nets_.data();
  return element_->rational ? net.value(N, u, v) / net.value(N + net.size(), u, v)
                            : net.value(N, u, v);
}

PolishedSupport SupportPolish::polish(const dvec2& start) {
  return with_scalar_net(element_->shape, [&](const auto& net) { return polish(net, start); });
}

dvec2 SupportPolish::end_of_flat(const dvec2& uv, double h) const {
  return with_scalar_net(element_->shape, [&](const auto& net) { return end_of_flat(net, uv, h); });
}

template <class Net>
PolishedSupport SupportPolish::polish(const Net& net, const dvec2& start) {
  const bool rational = element_->rational;
  const std::size_t size = std::size_t(net.size());
  const double* N = nets_.data();
  const double* W = N + size;
  PolishedSupport result;
  double u = start.x;
  double v = start.y;
  double h = rational ? value(net, u, v) : -infinity;
  dvec2 before = start;
  result.h = -infinity;
  for (int step = 0; step < newton_step_limit && !result.converged; ++step) {
    const double* g = N;
    if (rational) {
      g_.resize(size);
      for (std::size_t k = 0; k < size; ++k) g_[k] = N[k] - h * W[k];
      g = g_.data();
    }
    const NetJet jet = net.jet(g, u, v);
    if (!rational) h = jet.g;
    if (h < result.h - gain_worth_taking) break;  // the step overshot
    result.h = h;
    before = {u, v};
    ++result.steps;
    newton_step(jet, u, v);
    result.converged = std::abs(u - before.x) + std::abs(v - before.y) < newton_step_end;
    result.curved =
        jet.guu < 0 && jet.guu * jet.gvv - jet.guv * jet.guv > curved * jet.guu * jet.gvv;
    if (rational) h = value(net, u, v);
  }
  // A converged step changes h in second order only; else the last point that was evaluated counts.
  result.uv = result.converged ? dvec2(u, v) : before;
  return result;
}

template <class Net>
dvec2 SupportPolish::end_of_flat(const Net& net, const dvec2& uv, double h) const {
  const auto is_flat = [&](double u, double v) {
    return value(net, u, v) >= h - gain_worth_taking;
  };
  const auto is_far = [](double x) { return x > flat_length && x < 1 - flat_length; };
  dvec2 at = uv;
  for (const double end : {0.0, 1.0}) {
    if (net.p() > 0 && is_far(at.x) && is_flat(end, at.y)) at.x = end;
    if (net.q() > 0 && is_far(at.y) && is_flat(at.x, end)) at.y = end;
  }
  return at;
}

std::optional<Contact> end_of_ruling(const SceneContent& scene, const Contact& contact,
                                     const dvec3& n, double h) {
  const int index = scene.instances[std::size_t(contact.instance)].part;
  const Part& part = scene.model.parts()[std::size_t(index)];
  const PatchPoint at{contact.element, {contact.u, contact.v}};
  const std::optional<dvec3> along = ruling_direction(part.patches()[std::size_t(at.patch)], at.uv);
  if (!along) return std::nullopt;
  std::array<std::vector<PatchPoint>, 2> paths;
  for (const std::size_t k : {0u, 1u}) {
    paths[k] = ruling_path(part, at, k == 0 ? *along : -*along);
    if (paths[k].empty()) return std::nullopt;  // the contact is the ruling's end
  }
  for (const std::vector<PatchPoint>& path : paths) {
    const PatchPoint& end = path.back();
    const Contact there{contact.instance, contact.kind, end.patch, end.uv.x, end.uv.y};
    if (glm::dot(scene.frame_point(there), n) >= h - support_slack) return there;
  }
  return std::nullopt;
}

}  // namespace taut
