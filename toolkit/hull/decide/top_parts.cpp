#include "taut/hull/decide/top_parts.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "taut/bounds/contact_exits.h"
#include "taut/bounds/scene_content.h"
#include "taut/bounds/vector_net.h"
#include "taut/core/disjoint_sets.h"
#include "taut/hull/decide/placed_net.h"

namespace taut {
namespace {

/// Parts of a model that are split for one plane.
constexpr int looked_at_parts = 4000;
/// Of those that are found heights differ by no more than this share of the depth.
constexpr double height_share = 0.25;

Box box_of(const std::vector<dvec4>& net) {
  Box box;
  for (const dvec4& p : net) box.include(euclidean(p));
  return box;
}

Interval heights(const std::vector<dvec4>& net, const dvec3& d) {
  Interval result = {infinity, -infinity};
  for (const dvec4& p : net) {
    const double h = glm::dot(euclidean(p), d);
    result = {std::min(result.lower, h), std::max(result.upper, h)};
  }
  return result;
}

/// Along which the longest of a net's rows and columns runs.
Direction longest_way(NetShape shape, const std::vector<dvec4>& net) {
  const int row = shape.q + 1;
  const auto length = [&](int first, int count, int step) {
    double sum = 0;
    for (int k = first + step; k <= first + count * step; k += step) {
      sum += glm::distance(euclidean(net[std::size_t(k - step)]), euclidean(net[std::size_t(k)]));
    }
    return sum;
  };
  double along_u = 0;
  double along_v = 0;
  for (int j = 0; j <= shape.q; ++j) along_u = std::max(along_u, length(j, shape.p, row));
  for (int i = 0; i <= shape.p; ++i) along_v = std::max(along_v, length(i * row, shape.q, 1));
  return along_u >= along_v ? Direction::u : Direction::v;
}

/// The contact as one of each edge and patch that ends in it.
std::vector<Contact> forms(const ContactGeometry& geometry, const Contact& c) {
  std::vector<Contact> all = {c};
  if (c.kind == SourceKind::vertex) all = piece_ends(geometry, c);
  for (std::size_t k = 0, edges = all.size(); k < edges; ++k) {
    const Contact edge = all[k];
    if (edge.kind != SourceKind::edge) continue;
    for (const auto& side : geometry.sides(edge)) all.push_back(on_side(edge, side));
  }
  return all;
}

Interval between(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

/// A chain of boxes, each no farther from the next than so much, leads from the first to the
/// second.
bool first_two_hang_together(const std::vector<Box>& boxes, double distance) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto box = [&](int k) -> const Box& { return boxes[std::size_t(k)]; };
  Box all;
  for (const Box& b : boxes) all.include(b.lower);
  const dvec3 size = all.upper - all.lower;
  const int along = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return box(a).lower[along] < box(b).lower[along]; });
  DisjointSets chains(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box& own = box(order[i]);
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Box& other = box(order[j]);
      if (other.lower[along] > own.upper[along] + distance) break;
      if (glm::length(box_gaps(own, other)) <= distance) chains.unite(order[i], order[j]);
    }
  }
  return chains.find(0) == chains.find(1);
}

}  // namespace

TopParts::TopParts(const ContactGeometry& geometry) : geometry_(geometry) {
  const SceneContent& content = geometry.scene().content();
  for (const int i : content.distinct_instances) {
    for (const SceneElement& e : content.part_of(i).elements) {
      geometry.check_stop();
      const Contact own = {i, e.kind, e.index, 0, 0};
      if (e.kind == SourceKind::edge ? geometry.is_straight(own) : geometry.is_ruled(own)) continue;
      index_.emplace(place(own), int(parts_.size()));
      parts_.push_back({e.shape, placed_net(content, i, e)});
    }
    add_edges(i);
  }
  find_bodies();
}

/// Those of ruled patches alone, which are not looked at.
void TopParts::add_edges(int instance) {
  const int count = int(geometry_.part({instance, SourceKind::edge, 0, 0, 0}).pieces().size());
  for (int k = 0; k < count; ++k) {
    const Contact own = {instance, SourceKind::edge, k, 0, 0};
    if (index_.count(place(own)) > 0 || geometry_.is_repeated(own) || geometry_.is_straight(own) ||
        !geometry_.sides(own).empty()) {
      continue;
    }
    std::vector<dvec4> net = geometry_.curve(own).points;
    index_.emplace(place(own), int(parts_.size()));
    parts_.push_back({{int(net.size()) - 1, 0}, std::move(net)});
  }
}

/// The part that a contact is on: of a vertex one that ends there.
int TopParts::part_of(const Contact& c) const {
  const auto own = index_.find(place(c));
  if (own != index_.end()) return own->second;
  if (c.kind == SourceKind::edge) {
    for (const ContactGeometry::PieceSide& side : geometry_.sides(c)) {
      const auto patch = index_.find(place(on_side(c, side)));
      if (patch != index_.end()) return patch->second;
    }
  } else if (c.kind == SourceKind::vertex) {
    for (const Contact& end : piece_ends(geometry_, c)) {
      if (const int part = part_of(end); part >= 0) return part;
    }
  }
  return -1;
}

void TopParts::find_bodies() {
  DisjointSets sets(parts_.size());
  std::map<std::array<int, 2>, int> at_vertices;
  for (const auto& [own, part] : index_) {
    geometry_.check_stop();
    const auto unite = [&, &first = part](const Place& other) {
      const auto found = index_.find(other);
      if (found != index_.end()) sets.unite(first, found->second);
    };
    const Contact c = {own[0], SourceKind(own[1]), own[2], 0, 0};
    if (c.kind == SourceKind::face) {
      for (const Border& border : geometry_.patch(c).borders) {
        unite({c.instance, int(c.kind), border.neighbor});
      }
      continue;
    }
    const EdgePiece& piece = geometry_.piece(c);
    for (const int next : piece.end_neighbor) unite({c.instance, int(c.kind), next});
    for (const int vertex : piece.end_vertex) {
      if (vertex < 0) continue;
      const auto [known, is_new] = at_vertices.try_emplace({c.instance, vertex}, part);
      if (!is_new) sets.unite(part, known->second);
    }
  }
  for (int k = 0; k < int(parts_.size()); ++k) bodies_.push_back(sets.find(k));
}

bool TopParts::find(int body, const dvec3& d, double height, double depth,
                    std::vector<Box>& found) const {
  std::vector<Part> waiting;
  const auto look = [&](const Part& part) {
    const Interval of_part = heights(part.net, d);
    if (of_part.upper < height - depth) return;
    const double lowest = height - (1 + height_share) * depth;
    of_part.lower >= lowest ? found.push_back(box_of(part.net)) : waiting.push_back(part);
  };
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    if (bodies_[k] == body) look(parts_[k]);
  }
  for (int looked = 0; !waiting.empty(); ++looked) {
    if (looked == looked_at_parts) return false;
    Part upper = std::move(waiting.back());
    waiting.pop_back();
    Part lower = upper;
    const bool along_u = longest_way(upper.shape, upper.net) == Direction::u;
    along_u ? halve_u(upper.shape, upper.net.data(), lower.net.data())
            : halve_v(upper.shape, upper.net.data(), lower.net.data());
    for (const Part* half : {&lower, &upper}) look(*half);
  }
  return true;
}

/// What is between their parameters in an element of both is nowhere lower.
bool TopParts::hang_together_in_one_element(const dvec3& d, const Contact& a, const Contact& b,
                                            double lowest) const {
  const std::vector<Contact> others = forms(geometry_, b);
  for (const Contact& own : forms(geometry_, a)) {
    for (const Contact& other : others) {
      const auto part = index_.find(place(own));
      if (place(own) != place(other) || part == index_.end()) continue;
      const Part& whole = parts_[std::size_t(part->second)];
      const BezierPatch patch{whole.shape.p, whole.shape.q, whole.net};
      const BezierPatch way =
          restricted(patch, between(own.u, other.u),
                     own.kind == SourceKind::face ? between(own.v, other.v) : Interval{0, 1});
      if (heights(way.points, d).lower >= lowest) return true;
    }
  }
  return false;
}

bool TopParts::hang_together(const dvec3& d, const Contact& a, const Contact& b,
                             double depth) const {
  const int own = part_of(a);
  const int other = part_of(b);
  if (own < 0 || other < 0) return false;
  const int body = bodies_[std::size_t(own)];
  if (bodies_[std::size_t(other)] != body) return false;
  const dvec3 x = geometry_.point(a);
  const dvec3 y = geometry_.point(b);
  const double height = std::max(glm::dot(x, d), glm::dot(y, d));
  if (hang_together_in_one_element(d, a, b, height - (1 + height_share) * depth)) return true;
  std::vector<Box> found = {{x, x}, {y, y}};
  if (!find(body, d, height, depth, found)) return false;
  return first_two_hang_together(found, depth);
}

}  // namespace taut
