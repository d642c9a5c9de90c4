#include "taut/hull/tied_end.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "taut/hull/level_way.h"

namespace taut {
namespace {

/// Takes two contacts to each other over a way on which support values do not tell where they are.
class TiedMerging {
 public:
  explicit TiedMerging(const CurvePoint& point) : geometry_(point.geometry()), at_(point.at) {
    end_.pieces.emplace_back();
    push();
  }

  MergedEnd run(const std::vector<WayCrossing>& way);

 private:
  void push() { end_.pieces.back().rulings.push_back(at_.ruling()); }
  void turn_to(std::size_t i);
  void cross(std::size_t i, const Contact& from, const Contact& to);

  const ContactGeometry& geometry_;
  CommonSupport at_;
  MergedEnd end_;
};

/// The direction becomes contact i's normal; the other contact moves with it, if towards it.
void TiedMerging::turn_to(std::size_t i) {
  const dvec3 before = at_.n;
  at_.n = limit_normal({at_.jet[i], at_.jet[i]}, before);
  const std::optional<dvec2> rate = parameter_rate(at_.jet[1 - i], before, at_.n - before);
  if (!rate) return;
  const ContactJet& j = at_.jet[1 - i];
  const dvec3 motion = rate->x * j.dx[0] + rate->y * j.dx[1];
  const dvec3 way = at_.jet[i].x - j.x;
  if (glm::length(motion) > 0.25 * glm::length(way) || glm::dot(motion, way) < 0) return;
  Contact& other = at_.contact[1 - i];
  other.u = std::clamp(other.u + rate->x, 0.0, 1.0);
  other.v = std::clamp(other.v + rate->y, 0.0, 1.0);
  at_.evaluate(geometry_);
}

/// Contact i goes on over a border.
void TiedMerging::cross(std::size_t i, const Contact& from, const Contact& to) {
  at_.contact[i] = from;
  at_.evaluate(geometry_);
  turn_to(i);
  push();
  at_.contact[i] = to;
  at_.evaluate(geometry_);
  end_.pieces.emplace_back();
  push();
}

/// They meet on the way from a face onto an edge, or about the middle.
MergedEnd TiedMerging::run(const std::vector<WayCrossing>& way) {
  std::size_t middle = way.size() / 2;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const bool one = way[k].from.kind == SourceKind::face;
    const bool other = way[k].to.kind == SourceKind::face;
    if (one != other) middle = k;
  }
  for (std::size_t k = 0; k < middle; ++k) cross(0, way[k].from, way[k].to);
  for (std::size_t k = way.size(); k-- > middle + 1;) cross(1, way[k].to, way[k].from);
  if (way.empty()) {
    at_.contact[0] = at_.contact[1];
  } else {
    at_.contact[0] = way[middle].from;
    at_.contact[1] = way[middle].to;
  }
  at_.evaluate(geometry_);
  at_.n = limit_normal({at_.jet[0], at_.jet[1]}, at_.n);
  push();
  Ruling& last = end_.pieces.back().rulings.back();
  last.point[1] = last.point[0];
  return std::move(end_);
}

}  // namespace

std::optional<MergedEnd> tied_end(const CurvePoint& point) {
  const CommonSupport& at = point.at;
  const auto way = level_way(point.geometry(), at.contact[0], at.contact[1], at.n);
  if (!way) return std::nullopt;
  return TiedMerging(point).run(*way);
}

}  // namespace taut
