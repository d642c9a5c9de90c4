#include "taut/envelope/trace_envelope.h"

#include <algorithm>
#include <optional>

#include "taut/envelope/curve_chainer.h"
#include "taut/envelope/image_grid.h"
#include "taut/envelope/image_regions.h"

namespace taut {
namespace {

/// Two planes that touch in directions so close are one.
constexpr double same_plane = 1e-6;

/// How far from its pixels' middle a plane may touch, and within which planes over one hole are
/// one, in pixels.
constexpr double plane_reach = 2.5;

/// Finds the triple points of one image.
class TriplePoints {
 public:
  TriplePoints(const EnvelopeContent& content, std::vector<EnvelopeTriplePoint>& result)
      : content_(content), reach_(plane_reach * 4.0 / content.size), result_(result) {}

  void find(const ImageGrid& grid) {
    for (int p = 0; p < grid.size() * grid.size(); ++p) {
      if (grid.has_block(p)) find(grid, grid.block(p));
    }
  }

 private:
  void find(const ImageGrid& grid, const ImageGrid::Block& block) {
    std::vector<EnvelopePixel> branches;
    for (std::size_t k = 0; k < 4; ++k) {
      if (grid.bridges(block.side[k])) branches.push_back(grid.pixel(block.pixel[(k + 1) % 4]));
    }
    if (branches.size() >= 3) {
      if (auto plane = common_plane(content_, branches, reach_)) {
        add(*plane, same_plane);
      } else if (branches.size() == 4) {
        add_each_three(branches);
      }
    } else if (branches.size() <= 1 && may_hold_hole(grid, block)) {
      std::array<EnvelopePixel, 4> loop;
      for (std::size_t k = 0; k < 4; ++k) loop[k] = grid.pixel(block.pixel[k]);
      if (auto plane = plane_over_hole(content_, loop, reach_)) add(*plane, 0.5 * reach_);
    }
  }

  /// Two planes close together, each of three of the four branches.
  void add_each_three(const std::vector<EnvelopePixel>& branches) {
    for (std::size_t left_out = 0; left_out < 4; ++left_out) {
      std::vector<EnvelopePixel> order;
      for (std::size_t k = 1; k <= 4; ++k) order.push_back(branches[(left_out + k) % 4]);
      if (auto plane = common_plane(content_, order, reach_)) add(*plane, same_plane);
    }
  }

  /// The block's triangles differ all around: only then can contacts be far apart.
  bool may_hold_hole(const ImageGrid& grid, const ImageGrid::Block& block) const {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto triangle = [&](std::size_t i) {
        return content_.at(grid.pixel(block.pixel[i % 4])).triangle;
      };
      if (triangle(k) == triangle(k + 1)) return false;
    }
    return true;
  }

  void add(const EnvelopeTriplePoint& plane, double same) {
    for (EnvelopeTriplePoint& known : result_) {
      if (glm::distance(known.n, plane.n) > same) continue;
      for (std::size_t k = 0; k < plane.contacts.size(); ++k) {
        const auto& c = plane.contacts[k];
        const bool there =
            std::any_of(known.contacts.begin(), known.contacts.end(),
                        [&](const Contact& other) { return same_element(c, other); });
        if (there) continue;
        known.contacts.push_back(c);
        known.points.push_back(plane.points[k]);
      }
      return;
    }
    result_.push_back(plane);
  }

  const EnvelopeContent& content_;
  double reach_;
  std::vector<EnvelopeTriplePoint>& result_;
};

}  // namespace

EnvelopeMap trace_envelope(const EnvelopeImages& images, const Progress& progress) {
  const EnvelopeContent& content = images.content();
  const std::array<ImageGrid, 2> grids = {ImageGrid(content, Hemisphere::north, progress),
                                          ImageGrid(content, Hemisphere::south, progress)};
  progress.update("trace", 0.5);
  EnvelopeMap map;
  map.size = content.size;
  find_regions(content, grids, map);
  map.curves = chain_curves(content, grids);
  TriplePoints triple_points(content, map.triple_points);
  for (const ImageGrid& grid : grids) triple_points.find(grid);
  return map;
}

}  // namespace taut
