#include "taut/bounds/reach_test.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "taut/bounds/scene_content.h"
#include "taut/bounds/vector_net.h"
#include "taut/core/progress.h"

namespace taut {
namespace {

/// Cells split before a test is given up. Those that succeed split 17 at most over all models of
/// the tests.
constexpr int split_limit = 64;

}  // namespace

class ReachTest::Search {
 public:
  Search(const SceneContent& scene, Stop stop) : scene_(scene), stop_(std::move(stop)) {}

  bool run(std::span<const dvec3> points, const std::array<dvec3, 4>& corners,
           std::span<const PatchRectangle> except, int finest) {
    except_.clear();
    for (const PatchRectangle& r : except) {
      except_.push_back({r, scene_.element({r.instance, SourceKind::face, r.patch, 0, 0})});
    }
    if (!std::is_sorted(except_.begin(), except_.end())) std::sort(except_.begin(), except_.end());
    finest_ = finest;
    splits_ = 0;
    frame_.set(corners);
    limits_.clear();
    for (const dvec3& p : points) {
      dvec4 limit;
      for (int k = 0; k < 4; ++k) {
        const dvec3& n = corners[std::size_t(k)];
        // Rounding of x . n, of p and of p . n.
        limit[k] = glm::dot(p, n) - 3 * scene_.rounding * glm::length(n);
      }
      limits_.push_back(limit);
    }
    offset_ = dvec4(0.0);
    return scene_.tree.nodes.empty() || instances_below(0);
  }

 private:
  /// The directions of the pyramid's four corners, in some frame.
  struct Directions {
    std::array<dvec3, 4> n, abs_n;

    void set(const std::array<dvec3, 4>& directions) {
      n = directions;
      for (std::size_t k = 0; k < 4; ++k) abs_n[k] = glm::abs(n[k]);
    }
    dvec4 heights(const dvec3& x) const {
      return {glm::dot(x, n[0]), glm::dot(x, n[1]), glm::dot(x, n[2]), glm::dot(x, n[3])};
    }
    dvec4 upper_bounds(const dvec3& center, const dvec3& half) const {
      return heights(center) + dvec4(glm::dot(half, abs_n[0]), glm::dot(half, abs_n[1]),
                                     glm::dot(half, abs_n[2]), glm::dot(half, abs_n[3]));
    }
    dvec4 upper_bounds(const dvec3& center, const dvec3& half, const Slab& slab) const {
      return {slab.upper_bound(center, half, n[0]), slab.upper_bound(center, half, n[1]),
              slab.upper_bound(center, half, n[2]), slab.upper_bound(center, half, n[3])};
    }
  };

  /// One of the points is above these four heights.
  bool below(const dvec4& heights) const {
    return std::any_of(limits_.begin(), limits_.end(), [&](const dvec4& limit) {
      return heights.x < limit.x && heights.y < limit.y && heights.z < limit.z &&
             heights.w < limit.w;
    });
  }
  bool box_below(const Directions& d, const dvec3& center, const dvec3& half) const {
    return below(d.upper_bounds(center, half) + offset_);
  }

  /// `slab`: null if the tree has no slabs.
  bool box_below(const Directions& d, const dvec3& center, const dvec3& half,
                 const Slab* slab) const {
    const dvec4 bounds = d.upper_bounds(center, half);
    if (below(bounds + offset_)) return true;
    return slab != nullptr &&
           below(glm::min(bounds, d.upper_bounds(center, half, *slab)) + offset_);
  }

  bool instances_below(std::size_t index) {
    const BoxTree::Node& node = scene_.tree.nodes[index];
    if (box_below(frame_, node.center, node.half)) return true;
    const auto first = std::size_t(node.first);
    if (node.count == 0) return instances_below(first) && instances_below(first + 1);
    for (std::size_t i = first; i < first + std::size_t(node.count); ++i) {
      const dvec3 center(scene_.tree.center[0][i], scene_.tree.center[1][i],
                         scene_.tree.center[2][i]);
      const dvec3 half(scene_.tree.half[0][i], scene_.tree.half[1][i], scene_.tree.half[2][i]);
      if (!box_below(frame_, center, half) && !instance_below(scene_.tree.items[i])) return false;
    }
    return true;
  }

  bool instance_below(int index) {
    const SceneInstance& instance = scene_.instances[std::size_t(index)];
    std::array<dvec3, 4> n = frame_.n;
    dvec4 offset;
    for (int k = 0; k < 4; ++k) {
      dvec3& direction = n[std::size_t(k)];
      offset[k] = glm::dot(instance.translation, direction);
      if (instance.rotated) direction = glm::transpose(instance.rotation) * direction;
    }
    local_.set(n);
    offset_ = offset;
    instance_ = index;
    part_ = &scene_.parts[std::size_t(instance.part)];
    const bool result = (part_->tree.nodes.empty() || cells_below(0)) &&
                        (part_->point_tree.nodes.empty() || points_below(0));
    offset_ = dvec4(0.0);
    return result;
  }

  bool cells_below(std::size_t index) {
    stop_.check();
    const BoxTree& tree = part_->tree;
    const BoxTree::Node& node = tree.nodes[index];
    const bool has_slabs = !tree.slabs.empty();
    if (box_below(local_, node.center, node.half, has_slabs ? &node.slab : nullptr)) return true;
    const auto first = std::size_t(node.first);
    if (node.count == 0) return cells_below(first) && cells_below(first + 1);
    for (std::size_t i = first; i < first + std::size_t(node.count); ++i) {
      const dvec3 center(tree.center[0][i], tree.center[1][i], tree.center[2][i]);
      const dvec3 half(tree.half[0][i], tree.half[1][i], tree.half[2][i]);
      const Slab* slab = has_slabs ? &tree.slabs[i] : nullptr;
      if (!box_below(local_, center, half, slab) && !cell_below(tree.items[i])) return false;
    }
    return true;
  }

  bool points_below(std::size_t index) {
    const BoxTree& tree = part_->point_tree;
    const BoxTree::Node& node = tree.nodes[index];
    if (box_below(local_, node.center, node.half)) return true;
    const auto first = std::size_t(node.first);
    if (node.count == 0) return points_below(first) && points_below(first + 1);
    for (std::size_t i = first; i < first + std::size_t(node.count); ++i) {
      const dvec3 x(tree.center[0][i], tree.center[1][i], tree.center[2][i]);
      if (!below(local_.heights(x) + offset_)) return false;
    }
    return true;
  }

  bool cell_below(int index) {
    const SceneCell& cell = part_->cells[std::size_t(index)];
    const SceneElement& element = part_->elements[std::size_t(cell.element)];
    const SceneNet& net = cell.net;
    heights_.resize(net.x.size());
    for (std::size_t k = 0; k < net.x.size(); ++k) {
      heights_[k] = local_.heights({net.x[k], net.y[k], net.z[k]}) + net.w[k] * offset_;
    }
    own_ = exceptions_of(instance_, cell.element);
    const double* w = element.rational ? net.w.data() : nullptr;
    return net_below(element.shape, heights_.data(), w, cell.coons.level, cell.coons.u(),
                     cell.coons.v(), 0);
  }

  /// `g` holds the heights of the cell's control points, times the weights `w` where rational.
  bool net_below(NetShape shape, const dvec4* g, const double* w, int level, const Interval& u,
                 const Interval& v, std::size_t depth) {
    if (is_excepted(u, v)) return true;
    const auto size = std::size_t(shape.size());
    dvec4 highest(-std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < size; ++k) highest = glm::max(highest, w ? g[k] / w[k] : g[k]);
    if (below(highest)) return true;
    if (level >= finest_ || ++splits_ > split_limit * (1 + finest_ / 4)) return false;
    if (quarters_.size() <= depth) quarters_.resize(depth + 1);
    std::array<dvec4*, 4> heights;
    std::array<double*, 4> weights = {};
    for (std::size_t k = 0; k < 4; ++k) {
      Quarter& part = quarters_[depth][k];
      part.heights.resize(size);
      heights[k] = part.heights.data();
      if (w) {
        part.weights.resize(size);
        weights[k] = part.weights.data();
      }
    }
    quarter(shape, g, heights);
    if (w) quarter(shape, w, weights);
    const double middle_u = 0.5 * (u.lower + u.upper);
    const double middle_v = 0.5 * (v.lower + v.upper);
    for (std::size_t k = 0; k < 4; ++k) {
      if (shape.q == 0 && k % 2 == 1) continue;  // a curve has only two halves
      const Interval half_u = k < 2 ? Interval{u.lower, middle_u} : Interval{middle_u, u.upper};
      const Interval half_v = k % 2 ? Interval{middle_v, v.upper} : Interval{v.lower, middle_v};
      if (!net_below(shape, heights[k], weights[k], level + 1, half_u, half_v, depth + 1)) {
        return false;
      }
    }
    return true;
  }

  struct Exception {
    PatchRectangle region;
    int element;

    std::pair<int, int> place() const { return {region.instance, element}; }
    bool operator<(const Exception& other) const { return place() < other.place(); }
  };

  std::span<const Exception> exceptions_of(int instance, int element) const {
    const Exception sought{{instance, -1, {}, {}}, element};
    const auto [first, last] = std::equal_range(except_.begin(), except_.end(), sought);
    return {first, last};
  }
  /// The rectangle of the element that is looked at lies in one of the regions.
  bool is_excepted(const Interval& u, const Interval& v) const {
    return std::any_of(own_.begin(), own_.end(), [&](const Exception& e) {
      const PatchRectangle& r = e.region;
      return u.lower >= r.u.lower && u.upper <= r.u.upper && v.lower >= r.v.lower &&
             v.upper <= r.v.upper;
    });
  }

  struct Quarter {
    std::vector<dvec4> heights;
    std::vector<double> weights;
  };

  const SceneContent& scene_;
  Stop stop_;
  Directions frame_, local_;
  dvec4 offset_ = dvec4(0.0);  // of the instance that is looked at
  std::vector<dvec4> limits_;  // of x . n by each of the points
  const ScenePart* part_ = nullptr;
  int instance_ = -1;
  std::vector<Exception> except_;   // sorted
  std::span<const Exception> own_;  // of the element that is looked at
  int finest_ = 0;
  int splits_ = 0;
  std::vector<dvec4> heights_;
  std::vector<std::array<Quarter, 4>> quarters_;  // per depth
};

ReachTest::ReachTest(const Scene& scene, Stop stop)
    : search_(std::make_unique<Search>(scene.content(), std::move(stop))) {}
ReachTest::~ReachTest() = default;

bool ReachTest::surely_below(std::span<const dvec3> points, const std::array<dvec3, 4>& corners,
                             std::span<const PatchRectangle> except, int finest) {
  return search_->run(points, corners, except, finest);
}

}  // namespace taut
