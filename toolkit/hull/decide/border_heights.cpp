#include "taut/hull/decide/border_heights.h"

#include <algorithm>

#include "taut/bounds/vector_net.h"
#include "taut/hull/decide/height_growth.h"

namespace taut {
namespace {

/// No two of the surfaces or edges that end at a chart, both in the branch, grow from it at once:
/// the sum of their vectors, in like lengths, falls. Else the chart were the floor of a fold.
bool fold_outwards(const HeightGrowth& growth, const std::vector<std::vector<dvec4>>& inward) {
  const auto longest = [](const std::vector<dvec4>& vectors) {
    double length = 0;
    for (const dvec4& v : vectors) length = std::max(length, glm::length(dvec3(v)));
    return length;
  };
  for (std::size_t a = 0; a < inward.size(); ++a) {
    for (std::size_t b = a + 1; b < inward.size(); ++b) {
      if (inward[a].size() != inward[b].size()) return false;
      const double share = longest(inward[a]) / longest(inward[b]);
      for (std::size_t k = 0; k < inward[a].size(); ++k) {
        if (!growth.along(-inward[a][k] - share * inward[b][k])) return false;
      }
    }
  }
  return true;
}

}  // namespace

void BorderHeights::show(int index) {
  const Chart& chart = branches_->chart(index);
  sides_.turn_to(chart.element, chart.u, chart.v);
}

bool BorderHeights::rise_from(int chart) {
  const SourceKind kind = branches_->chart(chart).kind;
  return kind == SourceKind::face   ? rise_from_face(chart)
         : kind == SourceKind::edge ? rise_from_edge(chart)
                                    : rise_from_vertex(chart);
}

bool BorderHeights::rise_from(int chart, Side side) {
  show(chart);
  return sides_.rise(*view_, side, tilt_);
}

/// From the border of a patch's rectangle inwards, where nothing is glued to it.
bool BorderHeights::rise_from_face(int index) {
  const auto is_border = [&](Side side) { return glue_->is_border(index, side); };
  if (std::none_of(all_sides.begin(), all_sides.end(), is_border)) return true;
  show(index);
  return std::all_of(all_sides.begin(), all_sides.end(), [&](Side side) {
    return !is_border(side) || sides_.rise(*view_, side, tilt_) ||
           sides_.have_no_low(*view_, side, tilt_);
  });
}

/// From the ends of an interval inwards, and from the surfaces beside it onto the edge.
bool BorderHeights::rise_from_edge(int index) {
  const Chart& chart = branches_->chart(index);
  const MapElement& element = pieces_.element(chart.element);
  pieces_.restricted(chart.element, chart.u, {0, 1}, net_);
  const std::size_t last = net_.size() - 1;
  for (const int end : {0, 1}) {
    if (!glue_->is_border(index, end)) continue;
    HeightGrowth growth(*view_);
    const dvec4& own = end == 0 ? net_.front() : net_.back();
    growth.include(own);
    if (!growth.along((end == 0 ? net_[1] : net_[last - 1]) - own)) return false;
  }
  HeightGrowth growth(*view_);
  for (const dvec4& p : net_) growth.include(p);
  const MapPiece& root = *element.root;
  std::vector<std::vector<dvec4>> inside;
  for (std::size_t k = 0; k < root.inward.size(); ++k) {
    const StoredNet& net = root.inward[k];
    const dvec4* p = net.points;
    std::vector<dvec4> inward(p, p + net.shape.size());
    restrict_net(net.shape, inward.data(), chart.u, Interval{0, 1});
    if (glue_->are_beside(index, element.beside[k])) {
      inside.push_back(std::move(inward));
    } else if (!std::all_of(inward.begin(), inward.end(),
                            [&](const dvec4& vector) { return growth.along(-vector); })) {
      return false;
    }
  }
  return fold_outwards(growth, inside);
}

/// The edges at a vertex fall away from it, but for those that belong to the branch.
bool BorderHeights::rise_from_vertex(int index) const {
  const MapElement& element = pieces_.element(branches_->chart(index).element);
  const MapPiece& root = *element.root;
  HeightGrowth growth(*view_);
  growth.include(*root.net.points);
  std::vector<std::vector<dvec4>> inside;
  for (std::size_t k = 0; k < root.inward.size(); ++k) {
    const dvec4 tangent = *root.inward[k].points;
    if (glue_->are_beside(index, element.beside[k])) {
      inside.push_back({tangent});
    } else if (!growth.along(-tangent)) {
      return false;
    }
  }
  return fold_outwards(growth, inside);
}

RectangleSides::Corner BorderHeights::corner(const CornerRings::Corner& c) {
  show(c.chart);
  return sides_.corner(c.next, c.other);
}

bool BorderHeights::rise_from(const JoinEnd& end) {
  const RectangleSides::Corner own = corner(end.at);
  HeightGrowth growth(*view_, tilt_);
  growth.include(own.point);
  if (growth.along({own.along, 0})) return true;
  if (!end.fan) return false;
  bool inwards = true;
  dvec3 both(0.0);
  for (const CornerRings::Corner& c : *end.fan) {
    const RectangleSides::Corner last = corner(c);
    const dvec3 border = unit(last.along);
    both += border;
    inwards = inwards &&
              growth.along({last.along_other - glm::dot(last.along_other, border) * border, 0});
  }
  const auto& d = view_->corners();
  return inwards || std::all_of(d.begin(), d.end(), [&](const dvec3& n) {
           return glm::dot(both, n) + tilt_ * glm::length(both) <= slack_;
         });
}

}  // namespace taut
