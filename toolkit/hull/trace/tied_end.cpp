#include "taut/hull/trace/tied_end.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "taut/hull/trace/level_way.h"

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
  void cross(std::size_t i, const Contact& from, const Contact& to);

  const ContactGeometry& geometry_;
  CommonSupport at_;
  MergedEnd end_;
};

/// Contact i goes on over a border, in the same direction: in it the whole way is level.
void TiedMerging::cross(std::size_t i, const Contact& from, const Contact& to) {
  at_.contact[i] = from;
  at_.evaluate(geometry_);
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
