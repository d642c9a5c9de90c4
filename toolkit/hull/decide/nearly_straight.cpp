#include "taut/hull/decide/nearly_straight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace taut {
namespace {

/// Pieces that go on into each other from a vertex on, in the direction away from it.
class Chain {
 public:
  Chain(const MapPieces& pieces, const Contact& first, int from_end)
      : pieces_(pieces), geometry_(pieces.geometry()) {
    start_ = vertex(first, from_end);
    if (start_ >= 0) follow(first, from_end);
  }

  /// It ends in vertices, and all on the way are elements.
  bool is_whole() const { return start_ >= 0 && end_ >= 0; }
  int start() const { return start_; }
  int end() const { return end_; }
  const std::vector<int>& elements() const { return elements_; }

 private:
  /// The element of a vertex in which the piece ends, -1 if there is none.
  int vertex(const Contact& piece, int end) const {
    const int v = geometry_.piece(piece).end_vertex[std::size_t(end)];
    return v < 0 ? -1 : pieces_.find_first({piece.instance, SourceKind::vertex, v, 0, 0});
  }

  void follow(Contact at, int from_end) {
    for (;;) {
      const int element = pieces_.find(at);
      if (element < 0 || std::count(elements_.begin(), elements_.end(), element) > 0) return;
      elements_.push_back(element);
      const int next = geometry_.piece(at).end_neighbor[std::size_t(1 - from_end)];
      if (next < 0) {
        end_ = vertex(at, 1 - from_end);
        return;
      }
      const std::array<int, 2>& back =
          geometry_.piece({at.instance, SourceKind::edge, next, 0, 0}).end_neighbor;
      if (back[0] == back[1]) return;  // it cannot be told which end is the nearer
      from_end = back[0] == at.element ? 0 : 1;
      at.element = next;
    }
  }

  const MapPieces& pieces_;
  const ContactGeometry& geometry_;
  int start_ = -1, end_ = -1;
  std::vector<int> elements_;
};

dvec3 place(const MapPieces& pieces, int vertex) {
  return euclidean(*pieces.element(vertex).root->exact.points);
}

/// The vertices that are not covered farthest along a line to either side, of those near it: within
/// the budget where that of two points on it leaves the line itself.
std::array<int, 2> ends_of_line(const MapPieces& pieces, const std::vector<int>& vertices,
                                const dvec3& a, const dvec3& b, double budget) {
  const dvec3 along = b - a;
  std::array<int, 2> ends = {-1, -1};
  std::array<double, 2> range = {infinity, -infinity};
  for (const int v : vertices) {
    const dvec3 x = place(pieces, v);
    const double t = glm::dot(x - a, along) / glm::dot(along, along);
    const double off = glm::distance(x, a + t * along);
    if (off > budget * (1 + std::abs(t))) continue;
    if (t < range[0]) {
      range[0] = t;
      ends[0] = v;
    }
    if (t > range[1]) {
      range[1] = t;
      ends[1] = v;
    }
  }
  return ends;
}

/// The vertices between which a chain is straight: of one between covered vertices those that stand
/// for them may lie beyond. None if it is not straight.
std::optional<std::array<int, 2>> ends_if_straight(const MapPieces& pieces, const Chain& chain,
                                                   const std::vector<int>& vertices,
                                                   double budget) {
  std::array<int, 2> ends = {chain.start(), chain.end()};
  const auto is_covered = [&](int vertex) { return pieces.element(vertex).likeness.covered; };
  if (std::any_of(ends.begin(), ends.end(), is_covered)) {
    ends = ends_of_line(pieces, vertices, place(pieces, ends[0]), place(pieces, ends[1]), budget);
    if (ends[0] < 0) return std::nullopt;
  }
  const dvec3 a = place(pieces, ends[0]);
  const dvec3 b = place(pieces, ends[1]);
  const bool is_straight =
      std::all_of(chain.elements().begin(), chain.elements().end(), [&](int k) {
        const StoredNet& net = pieces.element(k).root->exact;
        const dvec4* p = net.points;
        return std::all_of(p, p + net.shape.size(), [&](const dvec4& x) {
          return distance_to_segment(euclidean(x), a, b) <= budget;
        });
      });
  return is_straight ? std::optional(ends) : std::nullopt;
}

}  // namespace

NearlyStraight nearly_straight(const MapPieces& pieces, double budget) {
  const std::size_t count = pieces.elements().size();
  NearlyStraight result{std::vector<bool>(count, false), std::vector<bool>(count, false)};
  std::vector<int> vertices;
  for (int k = 0; k < int(count); ++k) {
    const MapElement& element = pieces.element(k);
    const bool is_vertex = element.contact.kind == SourceKind::vertex;
    if (is_vertex && !element.likeness.covered) vertices.push_back(k);
  }
  for (int k = 0; k < int(count); ++k) {
    const Contact& c = pieces.element(k).contact;
    if (c.kind != SourceKind::edge || result.edges[std::size_t(k)]) continue;
    for (const int from_end : {0, 1}) {
      const Chain chain(pieces, c, from_end);
      if (!chain.is_whole()) continue;
      const auto ends = ends_if_straight(pieces, chain, vertices, budget);
      if (!ends) continue;
      for (const int element : chain.elements()) result.edges[std::size_t(element)] = true;
      for (const int end : *ends) result.ends[std::size_t(end)] = true;
    }
  }
  return result;
}

}  // namespace taut
