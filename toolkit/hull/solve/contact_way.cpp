#include "taut/hull/solve/contact_way.h"

#include <algorithm>

#include "taut/bounds/contact_exits.h"

namespace taut {
namespace {

/// Steps of Newton's method to where a segment passes a side.
constexpr int side_steps = 3;
/// Elements that lead so many times farther off than the way is long are not passed.
constexpr double astray = 2;

/// From element to element over borders, by the length of the way so far and what is left straight
/// to its end (A*); ways over lower borders only where no other leads there.
class WaySearch {
 public:
  WaySearch(const ContactGeometry& geometry, const Contact& from, const Contact& to, const dvec3& n,
            double depth)
      : geometry_(geometry),
        to_(to),
        aim_(geometry.point(to)),
        n_(n),
        least_(std::min(glm::dot(geometry.point(from), n), glm::dot(aim_, n)) - depth),
        ways_({{from, -1, from, 0, glm::distance(geometry.point(from), aim_)}}) {}

  /// Borders that are passed, in each the contact as one of the element before and one of that
  /// beyond. None if there are more than some elements between the two.
  std::vector<std::array<Contact, 2>> run() {
    for (int at = 0; at >= 0 && int(ways_.size()) < most_passed; at = shortest()) {
      way(at).done = true;
      if (same_element(way(at).at, to_)) return steps_to(at);
      for (const ContactExit& exit : exits(geometry_, way(at).at)) go_on(at, exit);
    }
    return {};
  }

 private:
  struct Way {
    Contact at;
    int before = -1;
    Contact border;     ///< of the element before
    double gone = 0;    ///< length of the way
    double left = 0;    ///< from where it goes
    double low = 0;     ///< how far below the depth a border was on the way, at most
    bool done = false;  ///< it has been gone on from

    bool comes_before(const Way& other) const {
      return low != other.low ? low < other.low : gone + left < other.gone + other.left;
    }
  };
  Way& way(int k) { return ways_[std::size_t(k)]; }

  int shortest() {
    int best = -1;
    for (int k = 0; k < int(ways_.size()); ++k) {
      if (!way(k).done && (best < 0 || way(k).comes_before(way(best)))) best = k;
    }
    return best;
  }

  void go_on(int from, const ContactExit& exit) {
    const Way here = way(from);
    Contact border = at_exit(here.at, exit);
    if (exit.kind == ContactExit::Kind::side) {
      border = passed_on_side(geometry_, border, Side(exit.index), geometry_.point(here.at), aim_);
    }
    const std::optional<Contact> over = beyond(geometry_, border, exit);
    if (!over) return;
    const dvec3 x = geometry_.point(*over);
    const Way next = {*over,
                      from,
                      border,
                      here.gone + glm::distance(geometry_.point(here.at), x),
                      glm::distance(x, aim_),
                      std::max(here.low, least_ - glm::dot(x, n_))};
    const double reach = astray * ways_.front().left;
    if (from > 0 && next.left > reach && !same_element(*over, to_)) return;
    const auto known = std::find_if(ways_.begin(), ways_.end(),
                                    [&](const Way& w) { return same_element(w.at, *over); });
    if (known == ways_.end()) {
      ways_.push_back(next);
    } else if (!known->done && next.comes_before(*known)) {
      *known = next;
    }
  }

  std::vector<std::array<Contact, 2>> steps_to(int end) {
    std::vector<std::array<Contact, 2>> steps;
    for (int k = end; way(k).before >= 0; k = way(k).before) {
      steps.push_back({way(k).border, way(k).at});
    }
    std::reverse(steps.begin(), steps.end());
    return steps;
  }

  const ContactGeometry& geometry_;
  const Contact& to_;
  const dvec3 aim_, n_;
  const double least_;
  std::vector<Way> ways_;
};

}  // namespace

/// Where the segment from one point to another passes a side of a patch, nearly: of the side's
/// points the nearest to the segment's line, from the contact on the side on.
Contact passed_on_side(const ContactGeometry& geometry, Contact c, Side side, const dvec3& from,
                       const dvec3& to) {
  const dvec3 way = unit(to - from);
  const auto off = [&](const dvec3& x) { return x - glm::dot(x, way) * way; };
  double& t = along_v(side) ? c.v : c.u;
  for (int k = 0; k < side_steps; ++k) {
    const ContactJet j = geometry.jet(c);
    const dvec3 rate = off(j.dx[along_v(side) ? 1 : 0]);
    const double square = glm::dot(rate, rate);
    if (!(square > 0)) break;
    t = std::clamp(t - glm::dot(rate, off(j.x - from)) / square, 0.0, 1.0);
  }
  return c;
}

ContactWay::ContactWay(const ContactGeometry& geometry, const Contact& from, const Contact& to,
                       const dvec3& n, double depth)
    : from_(from), to_(to) {
  if (same_element(from, to)) return;
  borders_ = WaySearch(geometry, from, to, n, depth).run();
  const dvec3 start = geometry.point(from);
  const dvec3 way = geometry.point(to) - start;
  double passed = 0;
  for (const auto& border : borders_) {
    const double along = glm::dot(geometry.point(border[0]) - start, way);
    if (along > 0) passed = std::max(passed, std::min(along / glm::dot(way, way), 1.0));
    shares_.push_back(passed);
  }
}

Contact ContactWay::at(double share) const {
  const auto next = std::lower_bound(shares_.begin(), shares_.end(), share);
  return at(share, std::size_t(next - shares_.begin()));
}

Contact ContactWay::at(double share, std::size_t passed) const {
  Contact c = passed > 0 ? borders_[passed - 1][1] : from_;
  const Contact& next = passed < borders_.size() ? borders_[passed][0] : to_;
  if (!same_element(c, next)) return c;
  const double begin = passed > 0 ? shares_[passed - 1] : 0;
  const double end = passed < shares_.size() ? shares_[passed] : 1;
  const double t = end > begin ? (share - begin) / (end - begin) : 0;
  c.u = glm::mix(c.u, next.u, t);
  c.v = glm::mix(c.v, next.v, t);
  return c;
}

}  // namespace taut
