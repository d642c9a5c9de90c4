#include "taut/envelope/curve_chainer.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "taut/core/parallel.h"

namespace taut {
namespace {

/// The north image's curves go so far beyond the equator, in pixels, and the south image's begin
/// there: those that run along the equator, as symmetric models have them, are in one image whole.
constexpr double equator_overlap = 0.25;

/// Ends of chains in the two images, or where a curve is too faint to be followed (its two contacts
/// nearly merge), are one if they are no farther apart, in pixels, and their contacts no farther
/// than this share of the distance of the curve's two contacts.
constexpr double join_reach = 3;
constexpr double join_share = 0.75;

/// Chains of so few points between two triple points are no curves: the triple points are one, in
/// which four or more contacts meet.
constexpr std::size_t shortest_chain = 2;

/// A polyline through the sides of one image, or of both once they are joined.
struct Chain {
  std::vector<EnvelopeCurvePoint> points;
  bool closed = false;
  /// The first and the last point are in no triple point, where others end: the curve leaves the
  /// image's hemisphere there, or the two contacts merge.
  std::array<bool, 2> open = {false, false};

  void reverse() {
    std::reverse(points.begin(), points.end());
    std::swap(open[0], open[1]);
  }
  void exchange_sides() {
    for (EnvelopeCurvePoint& p : points) {
      std::swap(p.contact[0], p.contact[1]);
      std::swap(p.point[0], p.point[1]);
    }
  }
};

/// Chains the points of one image.
class ImageChains {
 public:
  ImageChains(const EnvelopeContent& content, const ImageGrid& grid)
      : content_(content), grid_(grid) {}

  std::vector<Chain> run();

 private:
  /// A place where a curve passes between two pixels, and the next ones along it.
  struct Crossing {
    ImageGrid::SideNumber side;
    EnvelopeCurvePoint point;
    bool outside = false;                         ///< in the other image's hemisphere
    std::array<int, 2> next = {-1, -1};           ///< numbers of crossings
    std::array<bool, 2> turned = {false, false};  ///< contact 0 is there contact 1
    int link_count = 0;
    bool in_triple_point = false;
    bool used = false;
  };

  void find_crossings();
  void link_blocks();
  void link(const ImageGrid::Block& block, std::size_t a, std::size_t b);
  Chain walk(int start);

  const EnvelopeContent& content_;
  const ImageGrid& grid_;
  std::vector<Crossing> crossings_;
  std::unordered_map<ImageGrid::SideNumber, int> number_;
};

void ImageChains::find_crossings() {
  const int pixels = grid_.size() * grid_.size();
  for (int side = 0; side < 2 * pixels; ++side) {
    if (!grid_.bridges(side)) continue;
    number_[side] = int(crossings_.size());
    crossings_.push_back({side, {}, false});
  }
  parallel_for(crossings_.size(), 256, content_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      Crossing& c = crossings_[k];
      const int p = c.side / 2;
      const int q = c.side % 2 == 0 ? p + 1 : p + grid_.size();
      c.point = curve_point(content_, grid_.pixel(p), grid_.pixel(q));
      const bool north = c.point.n.z >= -equator_overlap * 2 / content_.size;
      c.outside = north != (grid_.hemisphere() == Hemisphere::north);
    }
  });
}

/// The sides a and b of a block, which part its pixels in two.
void ImageChains::link(const ImageGrid::Block& block, std::size_t a, std::size_t b) {
  const int i = number_.at(block.side[a]);
  const int j = number_.at(block.side[b]);
  // Contact 0 of a side is that of the upper or left one of its pixels: in the loop the first one
  // above and to the right, the second one below and to the left.
  const auto first_in_loop = [](std::size_t side) { return side < 2; };
  // Along the loop, side a leaves what side b enters.
  const bool turned = first_in_loop(a) == first_in_loop(b);
  const auto add = [&](int from, int to) {
    Crossing& c = crossings_[std::size_t(from)];
    if (c.link_count == 2) return;
    c.next[std::size_t(c.link_count)] = to;
    c.turned[std::size_t(c.link_count)] = turned;
    ++c.link_count;
  };
  add(i, j);
  add(j, i);
}

void ImageChains::link_blocks() {
  std::vector<int> blocks;
  for (const Crossing& c : crossings_) {
    const int p = c.side / 2;
    blocks.push_back(p);
    const int before = c.side % 2 == 0 ? p - grid_.size() : p - 1;
    if (before >= 0) blocks.push_back(before);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  for (const int b : blocks) {
    if (!grid_.has_block(b)) continue;
    const ImageGrid::Block block = grid_.block(b);
    std::vector<std::size_t> sides;
    for (std::size_t k = 0; k < 4; ++k) {
      if (grid_.bridges(block.side[k])) sides.push_back(k);
    }
    if (sides.size() == 2) link(block, sides[0], sides[1]);
    if (sides.size() < 3) continue;
    for (const std::size_t side : sides) {
      crossings_[std::size_t(number_.at(block.side[side]))].in_triple_point = true;
    }
    if (sides.size() == 3) continue;
    // Two surfaces in turn, which meet beyond what the image resolves: two curves.
    const auto meet = [&](std::size_t k) {
      return !is_bridging(content_, grid_.pixel(block.pixel[k]), grid_.pixel(block.pixel[k + 2]));
    };
    if (!meet(0) || !meet(1)) continue;
    link(block, 0, 1);
    link(block, 2, 3);
  }
}

/// From a crossing on, to the end of the chain or all around.
Chain ImageChains::walk(int start) {
  Chain chain;
  int at = start;
  int from = -1;
  bool turned = false;
  for (;;) {
    Crossing& c = crossings_[std::size_t(at)];
    c.used = true;
    chain.points.push_back(c.point);
    if (turned) {
      std::swap(chain.points.back().contact[0], chain.points.back().contact[1]);
      std::swap(chain.points.back().point[0], chain.points.back().point[1]);
    }
    const int way = c.next[0] == from && (from >= 0 || c.next[1] >= 0) ? 1 : 0;
    const int next = c.next[std::size_t(way)];
    chain.open[1] = !c.in_triple_point;
    if (next < 0) return chain;
    const Crossing& other = crossings_[std::size_t(next)];
    if (other.outside) {
      chain.open[1] = true;
      return chain;
    }
    if (other.used) {
      chain.closed = next == start;
      return chain;
    }
    turned = turned != c.turned[std::size_t(way)];
    from = at;
    at = next;
  }
}

std::vector<Chain> ImageChains::run() {
  find_crossings();
  link_blocks();
  const auto inner_links = [&](const Crossing& c) {
    return std::count_if(c.next.begin(), c.next.end(), [&](int next) {
      return next >= 0 && !crossings_[std::size_t(next)].outside;
    });
  };
  std::vector<Chain> chains;
  for (const bool closed : {false, true}) {
    for (std::size_t k = 0; k < crossings_.size(); ++k) {
      Crossing& c = crossings_[k];
      if (c.used || c.outside || (!closed && inner_links(c) == 2)) continue;
      // An end of a chain: the crossing that it leads to first is not outside.
      const auto is_outside = [&](int next) {
        return next >= 0 && crossings_[std::size_t(next)].outside;
      };
      bool leaves = false;
      for (std::size_t way = 0; way < 2 && !closed; ++way) {
        leaves = leaves || is_outside(c.next[way]);
      }
      if (is_outside(c.next[0]) || c.next[0] < 0) {
        std::swap(c.next[0], c.next[1]);
        std::swap(c.turned[0], c.turned[1]);
      }
      if (!closed && inner_links(c) > 0) c.next[1] = -1;
      Chain chain = walk(int(k));
      chain.open[0] = !chain.closed && (leaves || !c.in_triple_point);
      if (chain.closed) chain.open[1] = false;
      const bool between = !chain.closed && !chain.open[0] && !chain.open[1];
      if (between && chain.points.size() <= shortest_chain) continue;
      chains.push_back(std::move(chain));
    }
  }
  return chains;
}

/// How far two ends are from showing the same contacts; exchanged if `turned`.
double difference(const EnvelopeCurvePoint& a, const EnvelopeCurvePoint& b, bool turned) {
  return glm::distance(a.point[0], b.point[turned ? 1 : 0]) +
         glm::distance(a.point[1], b.point[turned ? 0 : 1]);
}

/// Two ends may be of one curve.
bool agree(const EnvelopeCurvePoint& a, const EnvelopeCurvePoint& b) {
  const double apart =
      std::max(glm::distance(a.point[0], a.point[1]), glm::distance(b.point[0], b.point[1]));
  return std::min(difference(a, b, false), difference(a, b, true)) <= join_share * apart;
}

/// Joins chains where they pass from one image to the other, and over short gaps.
class Joiner {
 public:
  Joiner(std::vector<Chain> chains, int size) : chains_(std::move(chains)), size_(size) {}

  std::vector<Chain> run() {
    for (std::size_t k = 0; k < chains_.size(); ++k) {
      while (!chains_[k].points.empty() && extend(k)) {
      }
    }
    std::erase_if(chains_, [](const Chain& c) { return c.points.empty(); });
    return std::move(chains_);
  }

 private:
  /// Joins the chain's last point, or else its first, to the nearest end.
  bool extend(std::size_t k) {
    Chain& own = chains_[k];
    if (!own.open[1]) own.reverse();
    if (!own.open[1]) return false;
    const EnvelopeCurvePoint& end = own.points.back();
    double nearest = join_reach * 4.0 / size_;
    std::optional<std::pair<std::size_t, std::size_t>> found;
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
        const Chain& other = chains_[i];
        if (other.points.empty() || !other.open[which] || (i == k && which == 1)) continue;
        const EnvelopeCurvePoint& p = which == 0 ? other.points.front() : other.points.back();
        // A chain of one point is no loop.
        if (i == k && other.points.size() < 3) continue;
        const double distance = glm::distance(p.n, end.n);
        if (distance >= nearest || !agree(end, p)) continue;
        nearest = distance;
        found = {i, which};
      }
    }
    own.open[1] = false;
    if (!found) return true;
    if (found->first == k) {
      own.closed = true;
      own.open[0] = false;
      return false;
    }
    Chain other = std::exchange(chains_[found->first], {});
    if (found->second == 1) other.reverse();
    const bool turned =
        difference(end, other.points.front(), true) < difference(end, other.points.front(), false);
    if (turned) other.exchange_sides();
    own.points.insert(own.points.end(), other.points.begin(), other.points.end());
    own.open[1] = other.open[1];
    return true;
  }

  std::vector<Chain> chains_;
  int size_;
};

/// Cuts a chain where the source on one of its sides changes.
void add_curves(const EnvelopeContent& content, Chain chain, int number,
                std::vector<EnvelopeCurve>& result) {
  const auto sources = [&](const EnvelopeCurvePoint& p) {
    return std::array<int, 2>{content.scene.source(p.contact[0]).source,
                              content.scene.source(p.contact[1]).source};
  };
  if (chain.closed) {
    // Begins at a change, if there is one.
    for (std::size_t k = 1; k < chain.points.size(); ++k) {
      if (sources(chain.points[k]) == sources(chain.points[k - 1])) continue;
      std::rotate(chain.points.begin(), chain.points.begin() + std::ptrdiff_t(k),
                  chain.points.end());
      break;
    }
  }
  const std::size_t first = result.size();
  for (const EnvelopeCurvePoint& p : chain.points) {
    const std::array<int, 2> own = sources(p);
    if (result.size() == first || result.back().sources != own) {
      result.push_back({own, {}, false, number});
    }
    result.back().points.push_back(p);
  }
  if (result.size() == first + 1) result.back().closed = chain.closed;
}

}  // namespace

std::vector<EnvelopeCurve> chain_curves(const EnvelopeContent& content,
                                        const std::array<ImageGrid, 2>& grids) {
  std::vector<Chain> chains;
  for (const ImageGrid& grid : grids) {
    for (Chain& chain : ImageChains(content, grid).run()) chains.push_back(std::move(chain));
  }
  std::vector<EnvelopeCurve> result;
  int number = 0;
  for (Chain& chain : Joiner(std::move(chains), content.size).run()) {
    add_curves(content, std::move(chain), number++, result);
  }
  return result;
}

}  // namespace taut
