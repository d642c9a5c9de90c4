#include "taut/hull/stitch/trim_loops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "taut/hull/contact/facet_contacts.h"

namespace taut {
namespace {

/// Parameters that agree to this are the same place of a border.
constexpr double same_border_parameter = 1e-9;

/// The trace of a contact along a piece of a half-arc, in the walk's direction.
struct TrimArc {
  TrimStretch stretch;
  dvec2 from = dvec2(0.0);
  dvec2 to = dvec2(0.0);
  dvec2 after = dvec2(0.0);   ///< next to where it begins
  dvec2 before = dvec2(0.0);  ///< next to where it ends
  dvec3 n = dvec3(0.0);       ///< where the trim arc begins
  int patch = -1;             ///< number of the oriented patch that it lies on
  int next = -1;  ///< trim arc of the same oriented patch that it runs into; -1: the border
};

/// One side of a Bezier patch, by the sign of its normal.
struct OrientedPatch {
  int instance, patch, sign;
  std::vector<int> trim_arcs;
  /// Where trim arcs meet the border, by position around it; with the way on which they leave it,
  /// or come to it, in the parameters.
  struct Meeting {
    double position;
    int trim_arc;
    bool arrives;
    dvec2 inward;
  };
  std::vector<Meeting> meetings;
};

/// Position around the unit square, counter-clockwise from (0, 0), in [0, 4); that of a corner if
/// it is there to within same_border_parameter.
double position(const dvec2& p) {
  const std::array<double, 4> off = {p.y, 1 - p.x, 1 - p.y, p.x};
  const auto side = std::min_element(off.begin(), off.end()) - off.begin();
  const std::array<double, 4> along = {p.x, p.y, 1 - p.x, 1 - p.y};
  const double at = double(side) + std::clamp(along[std::size_t(side)], 0.0, 1.0);
  const double corner = std::round(at);
  return std::fmod(std::abs(at - corner) < same_border_parameter ? corner : at, 4.0);
}

/// Gives meetings that are in one place the same position: where curves touch the border in a
/// common end, rounding does not tell which comes first.
void join_places(std::vector<OrientedPatch::Meeting>& meetings) {
  std::sort(meetings.begin(), meetings.end(),
            [](const auto& a, const auto& b) { return a.position < b.position; });
  for (std::size_t k = 1; k < meetings.size(); ++k) {
    const double before = meetings[k - 1].position;
    if (meetings[k].position - before < same_border_parameter) meetings[k].position = before;
  }
}

/// The angle of a way into the unit square with the way along the border from a position on, walked
/// counter-clockwise (sense 1) or clockwise (-1); one along the border may be off it by rounding.
double angle_at(double position, double sense, const dvec2& inward) {
  constexpr std::array<dvec2, 4> along = {dvec2(1, 0), dvec2(0, 1), dvec2(-1, 0), dvec2(0, -1)};
  const double side = sense > 0 ? std::floor(position) : std::ceil(position) - 1;
  const dvec2 way = sense * along[std::size_t(side + 4) % 4];
  const double off = std::max(0.0, sense * (way.x * inward.y - way.y * inward.x));
  return std::atan2(off, glm::dot(way, inward));
}

constexpr std::array<Side, 4> sides_around = {Side::v0, Side::u1, Side::v1, Side::u0};

/// The border's stretch between two positions of one side, in either direction.
TrimStretch on_border(int side, double from, double to) {
  TrimStretch s;
  s.side = sides_around[std::size_t(side)];
  s.from = side < 2 ? from : 1 - from;
  s.to = side < 2 ? to : 1 - to;
  return s;
}

class Trimmer {
 public:
  Trimmer(const ContactGeometry& geometry, const SeparatingGraph& graph,
          std::vector<Unresolved>& unresolved, double extent)
      : geometry_(geometry), graph_(graph), unresolved_(unresolved), extent_(extent) {}

  std::vector<TrimRegion> run() {
    for (int a = 0; a < int(graph_.arcs.size()); ++a) {
      for (int contact = 0; contact < 2; ++contact) add_trim_arcs({a, contact});
    }
    link();
    for (OrientedPatch& oriented : patches_) trim(oriented);
    return std::move(regions_);
  }

 private:
  using Loop = std::vector<TrimStretch>;

  /// None of pieces along which the contact stays in one place.
  void add_trim_arcs(const HalfArc& half);
  int patch_of(const Contact& c, const dvec3& n);
  std::optional<int> after_half_arc(const HalfArc& half) const;
  void link();
  void meet(int trim_arc, bool arrives);
  void trim(OrientedPatch& oriented);
  void add_border(const OrientedPatch& oriented, double from, double to, Loop& loop) const;
  void add_regions(const OrientedPatch& oriented, std::vector<Loop> loops);
  std::vector<dvec2> polyline(const Loop& loop) const;
  bool is_sliver(const OrientedPatch& oriented, const std::vector<dvec2>& outline) const;
  void fail(const dvec3& n, const char* reason) { unresolved_.push_back({n, reason}); }

  const ContactGeometry& geometry_;
  const SeparatingGraph& graph_;
  std::vector<Unresolved>& unresolved_;
  const double extent_;  ///< contacts no farther from each other may be one
  std::vector<TrimArc> trim_arcs_;
  std::vector<std::vector<int>> trim_arcs_of_;  // per half-arc 2 * arc + contact; -1: on no patch
  std::vector<OrientedPatch> patches_;
  std::map<std::tuple<int, int, int>, int> patch_index_;
  std::vector<TrimRegion> regions_;
};

int Trimmer::patch_of(const Contact& c, const dvec3& n) {
  const ContactJet j = geometry_.jet(c);
  const int sign = glm::dot(glm::cross(j.dx[0], j.dx[1]), n) < 0 ? -1 : 1;
  const auto [at, is_new] =
      patch_index_.try_emplace({c.instance, c.element, sign}, int(patches_.size()));
  if (is_new) patches_.push_back({c.instance, c.element, sign, {}, {}});
  return at->second;
}

void Trimmer::add_trim_arcs(const HalfArc& half) {
  const SeparatingArc& arc = graph_.arcs[std::size_t(half.arc)];
  const bool backward = half.contact == 0;
  const int count = int(arc.pieces.size());
  trim_arcs_of_.emplace_back();
  for (int k = 0; k < count; ++k) {
    const int piece = backward ? count - 1 - k : k;
    const std::vector<Ruling>& rulings = arc.pieces[std::size_t(piece)].rulings;
    const auto i = std::size_t(half.contact);
    if (rulings.front().contact[i].kind != SourceKind::face) {
      trim_arcs_of_.back().push_back(-1);
      continue;
    }
    const bool stays = std::all_of(rulings.begin(), rulings.end(), [&](const Ruling& r) {
      return parameters(r.contact[i]) == parameters(rulings.front().contact[i]);
    });
    if (stays) continue;
    const Ruling& first = backward ? rulings.back() : rulings.front();
    const Ruling& last = backward ? rulings.front() : rulings.back();
    TrimArc trim_arc;
    trim_arc.stretch.arc = half.arc;
    trim_arc.stretch.piece = piece;
    trim_arc.stretch.contact = half.contact;
    trim_arc.stretch.reversed = backward;
    trim_arc.from = parameters(first.contact[i]);
    trim_arc.to = parameters(last.contact[i]);
    trim_arc.n = first.n;
    const std::size_t last_but_one = rulings.size() < 2 ? 0 : rulings.size() - 2;
    trim_arc.after = parameters(rulings[backward ? last_but_one : 1 % rulings.size()].contact[i]);
    trim_arc.before = parameters(rulings[backward ? 1 % rulings.size() : last_but_one].contact[i]);
    const Ruling& middle = rulings[rulings.size() / 2];
    Contact inside = middle.contact[i];
    if (rulings.size() == 2) {
      inside.u = 0.5 * (trim_arc.from.x + trim_arc.to.x);
      inside.v = 0.5 * (trim_arc.from.y + trim_arc.to.y);
    }
    trim_arc.patch = patch_of(inside, middle.n);
    patches_[std::size_t(trim_arc.patch)].trim_arcs.push_back(int(trim_arcs_.size()));
    trim_arcs_of_.back().push_back(int(trim_arcs_.size()));
    trim_arcs_.push_back(trim_arc);
  }
}

void Trimmer::meet(int trim_arc, bool arrives) {
  const TrimArc& s = trim_arcs_[std::size_t(trim_arc)];
  const dvec2& p = arrives ? s.to : s.from;
  const double off = std::min({p.x, 1 - p.x, p.y, 1 - p.y});
  if (off > same_border_parameter) fail(s.n, "a trim curve ends inside a patch");
  patches_[std::size_t(s.patch)].meetings.push_back(
      {position(p), trim_arc, arrives, (arrives ? s.before : s.after) - p});
}

/// The first trim arc of those that go on where this one ends, -1 if that is on no patch.
std::optional<int> Trimmer::after_half_arc(const HalfArc& half) const {
  HalfArc after = half;
  do {
    after = next_half_arc(graph_, after);
    if (after.arc < 0) return std::nullopt;
    const std::vector<int>& own = trim_arcs_of_[std::size_t(2 * after.arc + after.contact)];
    if (!own.empty()) return own.front();
  } while (after.arc != half.arc || after.contact != half.contact);
  return std::nullopt;
}

/// Lets each trim arc run into the next, or into the border.
void Trimmer::link() {
  for (int a = 0; a < int(graph_.arcs.size()); ++a) {
    for (int contact = 0; contact < 2; ++contact) {
      const std::vector<int>& own = trim_arcs_of_[std::size_t(2 * a + contact)];
      const SeparatingArc& arc = graph_.arcs[std::size_t(a)];
      if (own.empty() && arc.closed) {
        fail(arc.pieces.front().rulings.front().n, "a closed curve stays in one place");
      }
      for (std::size_t k = 0; k < own.size(); ++k) {
        int next = -1;
        if (k + 1 < own.size()) {
          next = own[k + 1];
        } else {
          const std::optional<int> after = after_half_arc({a, contact});
          if (!after) {
            if (own[k] >= 0)
              fail(trim_arcs_[std::size_t(own[k])].n, "a separating curve ends nowhere");
            continue;
          }
          next = *after;
        }
        const int trim_arc = own[k];
        if (trim_arc < 0 && next < 0) continue;
        if (trim_arc >= 0 && next >= 0) {
          TrimArc& s = trim_arcs_[std::size_t(trim_arc)];
          const TrimArc& t = trim_arcs_[std::size_t(next)];
          if (s.patch == t.patch && glm::distance(s.to, t.from) < same_border_parameter) {
            s.next = next;
            continue;
          }
        }
        if (trim_arc >= 0) meet(trim_arc, true);
        if (next >= 0) meet(next, false);
      }
    }
  }
}

/// The border's stretches from one position to another in the walk's direction.
void Trimmer::add_border(const OrientedPatch& oriented, double from, double to, Loop& loop) const {
  const double sense = oriented.sign;
  double length = sense * (to - from);
  if (length < 0) length += 4;
  if (length < same_border_parameter || length > 4 - same_border_parameter) return;
  double at = from;
  while (length > same_border_parameter) {
    int side = int(std::floor(at));
    double local = at - side;
    if (sense < 0 && local == 0) {
      side = (side + 3) % 4;
      local = 1;
    }
    const double room = sense > 0 ? 1 - local : local;
    const double step = std::min(room, length);
    const double end = step == room ? (sense > 0 ? 1.0 : 0.0) : local + sense * step;
    loop.push_back(on_border(side, local, end));
    length -= step;
    at = sense > 0 && end == 1 ? double((side + 1) % 4) : side + end;
  }
}

void Trimmer::trim(OrientedPatch& oriented) {
  auto& meetings = oriented.meetings;
  join_places(meetings);
  const double sense = oriented.sign;
  // In one place those come first between which and the border before it a region may lie.
  std::sort(meetings.begin(), meetings.end(), [&](const auto& a, const auto& b) {
    if (a.position != b.position) return sense * a.position < sense * b.position;
    const double angle = angle_at(a.position, sense, a.inward);
    const double other = angle_at(b.position, sense, b.inward);
    return angle != other           ? angle > other
           : a.arrives != b.arrives ? a.arrives
                                    : a.trim_arc < b.trim_arc;
  });
  const std::size_t count = meetings.size();
  // The trim arcs that leave the border after each that arrives.
  std::map<int, std::pair<int, std::size_t>> after;  // arriving: leaving, meeting
  for (std::size_t k = 0; k < count; ++k) {
    if (!meetings[k].arrives) continue;
    const auto& next = meetings[(k + 1) % count];
    if (next.arrives) {
      fail(trim_arcs_[std::size_t(meetings[k].trim_arc)].n,
           "trim curves do not alternate on a border");
      return;
    }
    after[meetings[k].trim_arc] = {next.trim_arc, k};
  }
  std::vector<Loop> loops;
  std::vector<bool> done(oriented.trim_arcs.size(), false);
  std::map<int, std::size_t> place;
  for (std::size_t k = 0; k < oriented.trim_arcs.size(); ++k) place[oriented.trim_arcs[k]] = k;
  for (const int start : oriented.trim_arcs) {
    if (done[place[start]]) continue;
    Loop loop;
    int at = start;
    do {
      if (done[place[at]]) {
        fail(trim_arcs_[std::size_t(at)].n, "a trim loop runs into another");
        return;
      }
      done[place[at]] = true;
      const TrimArc& s = trim_arcs_[std::size_t(at)];
      loop.push_back(s.stretch);
      if (s.next >= 0) {
        at = s.next;
        continue;
      }
      const auto found = after.find(at);
      if (found == after.end()) {
        fail(s.n, "a trim loop does not close");
        return;
      }
      const auto& [leaving, meeting] = found->second;
      add_border(oriented, meetings[meeting].position, meetings[(meeting + 1) % count].position,
                 loop);
      at = leaving;
    } while (at != start);
    loops.push_back(std::move(loop));
  }
  add_regions(oriented, std::move(loops));
}

std::vector<dvec2> Trimmer::polyline(const Loop& loop) const {
  std::vector<dvec2> points;
  for (const TrimStretch& s : loop) {
    if (s.arc < 0) {
      points.push_back(on_side(s.side, s.from));
      continue;
    }
    std::vector<Ruling> rulings =
        graph_.arcs[std::size_t(s.arc)].pieces[std::size_t(s.piece)].rulings;
    if (s.reversed) std::reverse(rulings.begin(), rulings.end());
    for (std::size_t k = 0; k + 1 < rulings.size(); ++k) {
      points.push_back(parameters(rulings[k].contact[std::size_t(s.contact)]));
    }
  }
  return points;
}

double signed_area(const std::vector<dvec2>& p) {
  double area = 0;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const dvec2& a = p[k];
    const dvec2& b = p[(k + 1) % p.size()];
    area += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return area;
}

bool winds_about(const std::vector<dvec2>& polygon, const dvec2& x) {
  bool inside = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const dvec2& a = polygon[k];
    const dvec2& b = polygon[(k + 1) % polygon.size()];
    if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x)) {
      inside = !inside;
    }
  }
  return inside;
}

/// It is nowhere wider than a contact extends, so that its area does not tell on which side of it
/// the region is.
bool Trimmer::is_sliver(const OrientedPatch& oriented, const std::vector<dvec2>& outline) const {
  const auto jet = [&](const dvec2& p) {
    return geometry_.jet({oriented.instance, SourceKind::face, oriented.patch, p.x, p.y});
  };
  double length = 0;
  double widest = 0;
  dvec3 before = jet(outline.back()).x;
  for (const dvec2& p : outline) {
    const ContactJet j = jet(p);
    length += glm::distance(before, j.x);
    before = j.x;
    widest = std::max(widest, glm::length(glm::cross(j.dx[0], j.dx[1])));
  }
  return std::abs(signed_area(outline)) * widest <= extent_ * length;
}

/// Loops that run about a region, with those around its holes. One about a sliver that is in no
/// other is the border of a region of its own, whichever way rounding makes it run.
void Trimmer::add_regions(const OrientedPatch& oriented, std::vector<Loop> loops) {
  const std::size_t first = regions_.size();
  std::vector<std::vector<dvec2>> outlines;
  std::vector<std::pair<Loop, dvec2>> holes;
  for (Loop& loop : loops) {
    std::vector<dvec2> outline = polyline(loop);
    if (outline.empty()) {
      fail(trim_arcs_[std::size_t(oriented.trim_arcs.front())].n, "a trim loop has no length");
      return;
    }
    if (oriented.sign * signed_area(outline) > 0) {
      regions_.push_back({oriented.instance, oriented.patch, oriented.sign, {std::move(loop)}});
      outlines.push_back(std::move(outline));
    } else {
      holes.emplace_back(std::move(loop), outline.front());
    }
  }
  std::vector<Loop> slivers;
  bool whole = false;
  if (oriented.meetings.empty() && !holes.empty()) {
    // Nothing meets the border: it lies on the hull all around, or nowhere.
    const auto inside_other = [&](const dvec2& x) {
      return std::any_of(outlines.begin(), outlines.end(),
                         [&](const auto& outline) { return winds_about(outline, x); });
    };
    whole = std::any_of(holes.begin(), holes.end(),
                        [&](const auto& hole) { return !inside_other(hole.second); });
    if (whole) {
      regions_.push_back(
          {oriented.instance, oriented.patch, oriented.sign, {whole_border(oriented.sign)}});
      outlines.push_back({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    }
  }
  for (auto& [loop, point] : holes) {
    std::size_t owner = outlines.size();
    for (std::size_t k = 0; k < outlines.size(); ++k) {
      if (!winds_about(outlines[k], point)) continue;
      if (owner == outlines.size() ||
          std::abs(signed_area(outlines[k])) < std::abs(signed_area(outlines[owner]))) {
        owner = k;
      }
    }
    if (owner == outlines.size()) {
      if (is_sliver(oriented, polyline(loop))) {
        slivers.push_back(std::move(loop));
        continue;
      }
      fail(trim_arcs_[std::size_t(oriented.trim_arcs.front())].n, "a trim loop lies in no other");
      return;
    }
    regions_[first + owner].loops.push_back(std::move(loop));
  }
  for (Loop& loop : slivers) {
    regions_.push_back({oriented.instance, oriented.patch, oriented.sign, {std::move(loop)}});
  }
}

}  // namespace

HalfArc next_half_arc(const SeparatingGraph& graph, const HalfArc& half) {
  const SeparatingArc& arc = graph.arcs[std::size_t(half.arc)];
  if (arc.closed) return half;
  const int end = half.contact;  // contact 1 is walked to the end, contact 0 to the beginning
  const int node = arc.facet[std::size_t(end)];
  if (node < 0) return {half.arc, 1 - half.contact};
  const std::vector<FacetNode::Slot>& slots = graph.nodes[std::size_t(node)].slots;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i].arc != half.arc || slots[i].end != end) continue;
    // Along curved sides the contact moves on to the next corner.
    std::size_t k = i;
    do {
      k = (k + slots.size() - 1) % slots.size();
    } while (graph.nodes[std::size_t(node)].is_curved(k));
    const FacetNode::Slot& next = slots[k];
    if (next.arc < 0) return {};
    return {next.arc, next.end == 0 ? 1 : 0};
  }
  return {};
}

std::vector<TrimStretch> whole_border(int sign) {
  std::vector<TrimStretch> loop;
  loop.reserve(4);
  for (int k = 0; k < 4; ++k) {
    loop.push_back(sign > 0 ? on_border(k, 0, 1) : on_border(3 - k, 1, 0));
  }
  return loop;
}

std::vector<TrimRegion> trim_regions(const ContactGeometry& geometry, const SeparatingGraph& graph,
                                     std::vector<Unresolved>& unresolved, double extent) {
  return Trimmer(geometry, graph, unresolved, extent).run();
}

}  // namespace taut
