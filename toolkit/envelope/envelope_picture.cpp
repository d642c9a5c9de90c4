#include "taut/envelope/envelope_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "taut/envelope/envelope_content.h"

namespace taut {
namespace {

constexpr Color curve_color = {16, 16, 16};
constexpr Color point_color = {255, 255, 255};
constexpr Color circle_color = {96, 96, 96};
constexpr Color overlay_curve_color = {255, 255, 255};
constexpr Color overlay_point_color = {224, 0, 0};
constexpr Color empty_color = {0, 0, 0};

/// Images below this size have lines of one pixel.
constexpr int least_size_for_wide_lines = 256;

/// Muted colours; hues a golden section apart, so that neighbouring numbers differ most.
Color muted(int number) {
  const double hue = 6 * std::fmod(0.1 + number * (std::numbers::phi - 1), 1.0);
  const double value = 0.92 - 0.12 * (number / 3 % 3);
  const double saturation = 0.55 - 0.12 * (number % 3);
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    const double share = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    return std::uint8_t(std::lround(255 * value * (1 - saturation * share)));
  };
  return {channel(5), channel(3), channel(1)};
}

/// Draws on a picture.
class Pen {
 public:
  Pen(Picture& picture, const StereographicView& view) : picture_(picture), view_(view) {}

  void polyline(const std::vector<dvec3>& points, bool closed, bool wide, const Color& color) {
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      segment(points[k], points[k + 1], wide, color);
    }
    if (closed && points.size() > 1) segment(points.back(), points.front(), wide, color);
  }

  void disc(const dvec3& n, double radius, const Color& color) {
    if (!is_shown(n)) return;
    const dvec2 p = view_.pixel(n);
    const int reach = int(radius) + 1;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int column = int(std::lround(p.x)) + dx;
        const int row = int(std::lround(p.y)) + dy;
        if (glm::length(dvec2(column, row) - p) <= radius) set(column, row, color);
      }
    }
  }

 private:
  /// Directions in the square have n.z of -1/3 at least, on the side of the hemisphere.
  bool is_shown(const dvec3& n) const { return view_.pole() * n.z > -0.4; }

  void set(int column, int row, const Color& color) {
    if (column < 0 || row < 0 || column >= picture_.width || row >= picture_.height) return;
    picture_.at(column, row) = color;
  }

  void segment(const dvec3& a, const dvec3& b, bool wide, const Color& color) {
    if (!is_shown(a) || !is_shown(b)) return;
    const double length = glm::distance(view_.pixel(a), view_.pixel(b));
    const int steps = std::max(1, int(std::ceil(4 * length)));
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps;
      const dvec2 p = view_.pixel(unit((1 - t) * a + t * b));
      const int column = int(std::lround(p.x));
      const int row = int(std::lround(p.y));
      set(column, row, color);
      if (!wide) continue;
      set(column - 1, row, color);
      set(column + 1, row, color);
      set(column, row - 1, color);
      set(column, row + 1, color);
    }
  }

  Picture& picture_;
  StereographicView view_;
};

void draw_circle(Picture& picture) {
  const double radius = 0.5 * picture.width;
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      const double r = glm::length(dvec2(column + 0.5, row + 0.5) - dvec2(radius));
      // Pixels to which directions of the hemisphere are rounded are left as they are.
      if (r > radius + 0.75 && r <= radius + 2.25) picture.at(column, row) = circle_color;
    }
  }
}

}  // namespace

std::map<int, Color> source_colors(const EnvelopeImages& images) {
  std::set<int> sources;
  for (const auto& image : images.content().images) {
    for (const OffscreenCanvas::Pixel& p : image) {
      if (p.element == OffscreenCanvas::nothing) continue;
      sources.insert(images.content().element_sources[p.element]);
    }
  }
  std::set<Color> taken = {curve_color,         point_color,         circle_color,
                           overlay_curve_color, overlay_point_color, empty_color};
  std::map<int, Color> colors;
  for (const int source : sources) {
    Color color = muted(source);
    // Bytes count up until the colour is a new one.
    for (std::size_t k = 2; !taken.insert(color).second; k = (k + 2) % 3) ++color[k];
    colors[source] = color;
  }
  return colors;
}

Picture envelope_picture(const EnvelopeImages& images, const EnvelopeMap& map,
                         const std::map<int, Color>& colors, Hemisphere hemisphere,
                         const EnvelopeOverlay& overlay) {
  const int size = images.size();
  Picture picture{size, size, std::vector<Color>(std::size_t(size) * std::size_t(size))};
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const auto found = colors.find(images.source({hemisphere, column, row}));
      picture.at(column, row) = found != colors.end() ? found->second : empty_color;
    }
  }
  draw_circle(picture);
  const bool wide = size >= least_size_for_wide_lines;
  Pen pen(picture, images.view(hemisphere));
  for (const EnvelopeCurve& curve : map.curves) {
    std::vector<dvec3> points;
    points.reserve(curve.points.size());
    for (const EnvelopeCurvePoint& p : curve.points) points.push_back(p.n);
    pen.polyline(points, curve.closed, wide, curve_color);
  }
  for (const EnvelopeTriplePoint& p : map.triple_points) {
    pen.disc(p.n, wide ? 2.0 : 1.0, point_color);
  }
  for (const std::vector<dvec3>& curve : overlay.curves) {
    pen.polyline(curve, false, false, overlay_curve_color);
  }
  for (const dvec3& n : overlay.points) pen.disc(n, 1.0, overlay_point_color);
  return picture;
}

}  // namespace taut
