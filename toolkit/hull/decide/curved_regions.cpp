#include "taut/hull/decide/curved_regions.h"

#include <algorithm>

namespace taut {
namespace {

/// Halvings after which a rectangle's curvature is left open.
constexpr int curvature_level_limit = 12;

bool overlap(const Interval& a, const Interval& b) {
  return a.lower < b.upper && b.lower < a.upper;
}

bool contains(const Interval& a, const Interval& b) {
  return a.lower <= b.lower && b.upper <= a.upper;
}

double width(const Interval& t) { return t.upper - t.lower; }

}  // namespace

CurvedRegions::CurvedRegions(const MapPieces& pieces)
    : pieces_(pieces), trees_(pieces.elements().size()) {}

CurvedRegions::Tree& CurvedRegions::tree(int element) {
  Tree& tree = trees_[std::size_t(element)];
  if (!tree.empty()) return tree;
  const MapElement& e = pieces_.element(element);
  const Patch& patch = pieces_.geometry().patch(e.contact);
  const StoredNet& net = pieces_.piece(e.root).exact;
  BezierPatch bezier{net.shape.p, net.shape.q, {}};
  const dvec4* p = pieces_.points(net);
  bezier.points.assign(p, p + net.shape.size());
  std::array<bool, 4> poles;
  for (const Side side : all_sides) {
    const Border& border = patch.borders[std::size_t(side)];
    poles[std::size_t(side)] = border.kind == BorderKind::collapsed && border.vertex < 0;
  }
  Node root;
  root.nets = std::make_unique<CurvatureNets>(bezier, poles);
  tree.push_back(std::move(root));
  return tree;
}

/// That of the part of the rectangle in the node.
int CurvedRegions::sign(Tree& tree, int index, const Interval& u, const Interval& v) {
  {
    Node& node = tree[std::size_t(index)];
    if (!node.known) {
      node.known = true;
      node.sign = node.nets->definite_sign();
      if (node.sign != 0) node.nets.reset();
    }
    if (node.sign != 0 || node.level == curvature_level_limit) return node.sign;
    // Halves are curved both ways too, if the rectangle is all there is of the node.
    if (contains(u, node.u) && contains(v, node.v) && width(u) > 4 * width(node.u) &&
        width(v) > 4 * width(node.v)) {
      return 0;
    }
    if (node.first_half < 0) {
      const bool of_u = width(node.u) >= width(node.v);
      const auto nets = node.nets->halves(of_u ? Direction::u : Direction::v);
      node.nets.reset();
      const int first = int(tree.size());
      node.first_half = first;
      const Node whole{node.u, node.v, node.level + 1, false, 0, -1, nullptr};
      for (std::size_t k : {0u, 1u}) {
        Node half{
            whole.u, whole.v, whole.level, false, 0, -1, std::make_unique<CurvatureNets>(nets[k])};
        Interval& range = of_u ? half.u : half.v;
        const double middle = 0.5 * (range.lower + range.upper);
        (k == 0 ? range.upper : range.lower) = middle;
        tree.push_back(std::move(half));
      }
    }
  }
  int result = 0;
  const int first = tree[std::size_t(index)].first_half;
  for (const int half : {first, first + 1}) {
    if (!overlap(tree[std::size_t(half)].u, u) || !overlap(tree[std::size_t(half)].v, v)) continue;
    const int own = sign(tree, half, u, v);
    if (own == 0 || (result != 0 && own != result)) return 0;
    result = own;
  }
  return result;
}

bool CurvedRegions::are_definite(int element, const Interval& u, const Interval& v) {
  if (pieces_.geometry().patch(pieces_.element(element).contact).stand_in) return false;
  return sign(tree(element), 0, u, v) != 0;
}

}  // namespace taut
