#include "taut/bounds/gauss_map.h"

#include <cmath>
#include <string>

#include "taut/bounds/patch_nets.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"

namespace taut {
namespace {

/// 4^8 nodes a patch, and as many cells on each face of the sphere's cube.
constexpr int level_limit = 8;

/// A pyramid that spreads less than this share of a cell of the sphere is not refined: it meets
/// hardly more cells than its children would.
constexpr double narrow_share = 0.25;

bool is_narrow(const NormalPyramid& pyramid, double width) {
  return glm::distance(pyramid.corners[0], pyramid.corners[2]) < width &&
         glm::distance(pyramid.corners[1], pyramid.corners[3]) < width;
}

/// One patch's quadtree, breadth first within each split: children stand together.
class TreeBuilder {
 public:
  TreeBuilder(const SceneElement& element, int index, int levels)
      : nets_(element), index_(index), levels_(levels), quarters_(std::size_t(levels)) {
    nodes_.push_back({index_, {}, -1, nets_.bounds(nets_.root(), 0)});
    if (nets_.ruled()) return;
    fill(0, nets_.root());
  }

  bool ruled() const { return nets_.ruled(); }
  std::vector<GaussNode>& nodes() { return nodes_; }

 private:
  void fill(std::size_t index, const CellNets& nets) {
    const PatchCell cell = nodes_[index].cell;
    if (cell.level == levels_ || !nodes_[index].bounds.signs.any()) return;
    const auto& pyramid = nodes_[index].bounds.pyramid;
    if (pyramid && is_narrow(*pyramid, narrow_share * std::ldexp(2.0, -levels_))) return;
    auto& quarters = quarters_[std::size_t(cell.level)];
    nets_.quarter_points(nets.points, quarters);
    nets_.quarter_normals(nets.normals, quarters);
    const std::size_t first = nodes_.size();
    nodes_[index].first_child = std::int32_t(first);
    for (std::uint32_t k = 0; k < 4; ++k) {
      nodes_.push_back({index_, cell.child(k), -1, nets_.bounds(quarters[k], cell.level + 1)});
    }
    for (std::size_t k = 0; k < 4; ++k) fill(first + k, quarters[k]);
  }

  PatchNets nets_;
  int index_;
  int levels_;
  std::vector<std::array<CellNets, 4>> quarters_;
  std::vector<GaussNode> nodes_;
};

}  // namespace

GaussMap::GaussMap(const Scene& scene, const GaussMapOptions& options) : levels_(options.levels) {
  if (options.levels < 0 || options.levels > level_limit) {
    throw InvalidInput("levels of a Gauss map must be 0 .. 8, not " +
                       std::to_string(options.levels));
  }
  for (const ScenePart& part : scene.content().parts) {
    options.progress.check();
    maps_.push_back(make_part(part, options));
  }
}

GaussMap::PartMap GaussMap::make_part(const ScenePart& part, const GaussMapOptions& options) {
  std::vector<int> patches;
  for (std::size_t k = 0; k < part.elements.size(); ++k) {
    if (part.elements[k].kind == SourceKind::face) patches.push_back(int(k));
  }
  PartMap map;
  map.root_count = int(patches.size());
  std::vector<std::vector<GaussNode>> trees(patches.size());
  std::vector<char> ruled(patches.size());
  parallel_for(patches.size(), 4, options.threads, [&](std::size_t begin, std::size_t end) {
    options.progress.check();
    for (std::size_t k = begin; k < end; ++k) {
      TreeBuilder builder(part.elements[std::size_t(patches[k])], patches[k], options.levels);
      trees[k] = std::move(builder.nodes());
      ruled[k] = builder.ruled();
    }
  });
  map.ruled.assign(ruled.begin(), ruled.end());
  std::size_t count = 0;
  for (const auto& tree : trees) count += tree.size();
  map.nodes.reserve(count);
  // The roots first, then each tree's other nodes.
  for (const auto& tree : trees) map.nodes.push_back(tree.front());
  for (std::size_t k = 0; k < trees.size(); ++k) {
    const std::int32_t shift = std::int32_t(map.nodes.size()) - 1;
    const auto shifted = [&](GaussNode node) {
      if (node.first_child >= 0) node.first_child += shift;
      return node;
    };
    map.nodes[k] = shifted(map.nodes[k]);
    for (std::size_t i = 1; i < trees[k].size(); ++i) map.nodes.push_back(shifted(trees[k][i]));
  }
  sort_into_cells(map, options.levels);
  return map;
}

/// Counting sort by cell, in the order of the nodes.
void GaussMap::sort_into_cells(PartMap& map, int levels) {
  std::vector<std::uint32_t> cell_of;
  std::vector<Entry> entries;
  std::vector<DirectionCell> cells;
  const std::size_t cell_count = std::size_t(6) << (2 * levels);
  map.first.assign(cell_count + 1, 0);
  for (std::size_t k = 0; k < map.nodes.size(); ++k) {
    const GaussNode& node = map.nodes[k];
    if (node.first_child >= 0) continue;
    if (k < std::size_t(map.root_count) && map.ruled[k]) continue;
    for (const bool opposite : {false, true}) {
      if (!(opposite ? node.bounds.signs.minus : node.bounds.signs.plus)) continue;
      cells.clear();
      if (node.bounds.pyramid) {
        cells_met(*node.bounds.pyramid, opposite, levels, cells);
        for (const DirectionCell& cell : cells) cell_of.push_back(cell.index());
      } else {
        for (std::size_t c = 0; c < cell_count; ++c) cell_of.push_back(std::uint32_t(c));
      }
      entries.resize(cell_of.size(), {std::int32_t(k), opposite});
    }
  }
  for (const std::uint32_t cell : cell_of) ++map.first[cell + 1];
  for (std::size_t c = 0; c < cell_count; ++c) map.first[c + 1] += map.first[c];
  map.entries.resize(entries.size());
  std::vector<std::uint32_t> next(map.first.begin(), map.first.end() - 1);
  for (std::size_t k = 0; k < entries.size(); ++k) map.entries[next[cell_of[k]]++] = entries[k];
}

std::span<const GaussMap::Entry> GaussMap::entries(int part, const DirectionCell& cell) const {
  const PartMap& map = maps_[std::size_t(part)];
  const int below = 2 * (levels_ - cell.level);
  const std::size_t begin = map.first[std::size_t(cell.index()) << below];
  const std::size_t end = map.first[(std::size_t(cell.index()) + 1) << below];
  return std::span(map.entries).subspan(begin, end - begin);
}

std::vector<GaussMap::Entry> GaussMap::entries(int part, const dvec3& n) const {
  std::vector<Entry> result;
  for (const Entry& entry : entries(part, DirectionCell::of(n, levels_))) {
    const NormalBounds& b = nodes(part)[std::size_t(entry.node)].bounds;
    if (!b.pyramid || b.pyramid->may_contain(entry.opposite ? -n : n)) result.push_back(entry);
  }
  return result;
}

std::size_t GaussMap::memory() const {
  std::size_t bytes = sizeof(*this);
  for (const PartMap& map : maps_) {
    bytes += map.nodes.size() * sizeof(GaussNode) + map.entries.size() * sizeof(Entry) +
             map.first.size() * sizeof(std::uint32_t) + map.ruled.size() / 8;
  }
  return bytes;
}

}  // namespace taut
