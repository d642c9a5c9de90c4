#include "taut/envelope/envelope_images.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "taut/bounds/support_query.h"
#include "taut/core/error.h"
#include "taut/core/parallel.h"
#include "taut/core/stopwatch.h"
#include "taut/envelope/envelope_content.h"
#include "taut/hull/sample/sampled_start.h"

namespace taut {
namespace {

constexpr int smallest_size = 8;
constexpr int largest_size = 16000;

/// Smaller images are drawn from triangles as fine as those for this size.
constexpr int smallest_fine_size = 64;

/// Values closer than this, in the scene's frame, are decided in double precision: four times what
/// interpolation may be off (GaussTriangleOptions::value_tolerance) and depths round away.
constexpr double decision_margin = 5e-5;

/// How much lower fillers are drawn, in the scene's frame.
constexpr double filler_bias = 1e-3;

/// Fillers are at least so far from vertices and each other, in the scene's frame.
constexpr double filler_distance = 1e-3;

/// Triangles given to the canvas at once.
constexpr std::size_t batch_size = 65536;

/// Pixels' centres at the circle are 2 / size radians apart.
GaussTriangleOptions triangle_options(int image_size) {
  const double size = std::max(image_size, smallest_fine_size);
  return {.direction_tolerance = 1.0 / size, .value_tolerance = 1e-5, .border_width = 3.0 / size};
}

/// Makes the two images.
class Painter {
 public:
  Painter(EnvelopeContent& content, const EnvelopeOptions& options)
      : content_(content),
        options_(options),
        fineness_(triangle_options(options.size)),
        extent_(double(content.side()) / options.size),
        canvas_(int(content.side())) {
    content_.statistics.driver = canvas_.driver();
  }

  void paint();

 private:
  using Vertex = OffscreenCanvas::Vertex;
  using Layer = OffscreenCanvas::Layer;

  void make_triangles();
  void add_cells();
  void find_sources();
  void load(const StereographicView& view);
  bool corners(const StereographicView& view, std::size_t triangle, Vertex* result) const;
  OffscreenCanvas::Pixel better(const OffscreenCanvas::Pixel& first,
                                const OffscreenCanvas::Pixel* second, const dvec3& n) const;
  void decide(Hemisphere hemisphere, const Layer& first, const Layer& second);
  double value(float depth) const { return reach_ * (1 - 2 * double(depth)); }

  EnvelopeContent& content_;
  const EnvelopeOptions& options_;
  GaussTriangleOptions fineness_;
  double extent_;  ///< of the images in the plane
  OffscreenCanvas canvas_;
  double reach_ = 1;
};

void Painter::make_triangles() {
  // Cells of patches that are proven to touch no supporting plane are not drawn.
  const Scene& scene = content_.scene;
  const int levels = culling_levels(scene.patch_count());
  const GaussMap gauss_map(
      scene, {.levels = levels, .threads = options_.threads, .progress = options_.progress});
  Culling culling =
      cull(scene, gauss_map,
           {.levels = levels, .threads = options_.threads, .progress = options_.progress});
  std::erase_if(culling.cells, [](const CulledCell& c) {
    return c.state == CellState::off || c.state == CellState::ruled;
  });
  const InnerPoints inner(culling.frame_points);

  const auto count = std::size_t(content_.elements.count());
  std::vector<std::vector<CulledCell>> cells(count);
  for (const CulledCell& c : culling.cells) {
    cells[std::size_t(content_.elements.number({c.instance, SourceKind::face, c.patch, 0, 0}))]
        .push_back(c);
  }
  std::vector<GaussTriangles> own(count);
  parallel_for(count, 16, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    for (std::size_t k = begin; k < end; ++k) {
      const Contact c = content_.elements.contact(int(k));
      if (content_.geometry.is_repeated(c)) continue;
      if (c.kind == SourceKind::face) {
        add_face_triangles(content_.geometry, c, int(k), cells[k], inner, fineness_, own[k]);
        add_join_bands(content_.geometry, c, int(k), fineness_, own[k]);
      } else if (c.kind == SourceKind::edge) {
        add_edge_bands(content_.geometry, c, int(k), inner, fineness_, own[k]);
      }
      inner.remove_hidden(own[k]);
    }
  });
  for (GaussTriangles& triangles : own) content_.triangles.append(std::exchange(triangles, {}));
  add_cells();
}

/// Cells of the model's vertices and, behind them, fillers: cells of support points.
void Painter::add_cells() {
  std::vector<CellPoint> points;
  for (int k = 0; k < content_.elements.count(); ++k) {
    const Contact c = content_.elements.contact(k);
    if (c.kind != SourceKind::vertex || content_.geometry.is_repeated(c)) continue;
    points.push_back({c, k, content_.geometry.point(c), 0});
  }
  const std::size_t vertices = points.size();
  SupportQuery query(content_.scene);
  for (const Sample& sample : sampled_start(content_.scene, query).samples) {
    const Contact c = content_.geometry.canonical(sample.contact);
    const dvec3 x = content_.geometry.point(c);
    // What is a vertex but for rounding would make facets without directions.
    const bool known = std::any_of(points.begin(), points.end(), [&](const CellPoint& p) {
      return glm::distance(p.x, x) < filler_distance;
    });
    if (!known) points.push_back({c, content_.elements.number(c), x, filler_bias});
  }
  const std::vector<int> first = add_point_cells(points, fineness_, content_.triangles);
  content_.first_filler =
      vertices < first.size() ? first[vertices] : int(content_.triangles.triangles.size());
}

void Painter::find_sources() {
  const Scene& scene = content_.scene;
  for (const Part& part : scene.model().parts()) {
    std::vector<char>& corners = content_.is_corner.emplace_back(part.vertices().size(), 0);
    const auto mark = [&](int vertex) {
      if (vertex >= 0) corners[std::size_t(vertex)] = 1;
    };
    for (const Patch& patch : part.patches()) {
      for (const int vertex : patch.corner_vertex) mark(vertex);
      for (const Border& border : patch.borders) mark(border.vertex);
    }
  }
  for (int k = 0; k < content_.elements.count(); ++k) {
    Contact c = content_.elements.contact(k);
    // Inside of the element, whose borders may be others' sources.
    if (c.kind != SourceKind::vertex) c.u = 0.5;
    if (c.kind == SourceKind::face) c.v = 0.5;
    content_.element_sources.push_back(scene.source(content_.told(c)).source);
  }
}

/// A triangle as it is drawn; false if it is not in the image.
bool Painter::corners(const StereographicView& view, std::size_t triangle, Vertex* result) const {
  const GaussTriangles::Triangle& t = content_.triangles.triangles[triangle];
  std::array<const GaussTriangles::Node*, 3> node{};
  std::array<dvec2, 3> p{};
  for (std::size_t k = 0; k < 3; ++k) {
    node[k] = &content_.triangles.nodes[std::size_t(t.node[k])];
    // Directions with less are outside of the square, also by a triangle: its corners have -1/3,
    // and -0.6 with the margins of the smallest image.
    if (view.pole() * node[k]->n.z < -0.75) return false;
    p[k] = view.plane(node[k]->n);
  }
  const dvec2 lower = glm::min(p[0], glm::min(p[1], p[2]));
  const dvec2 upper = glm::max(p[0], glm::max(p[1], p[2]));
  if (lower.x > extent_ || lower.y > extent_ || upper.x < -extent_ || upper.y < -extent_) {
    return false;
  }
  const auto bend = [&](std::size_t a, std::size_t b) {
    // Where triangles could not be made fine, their interpolation says too little.
    const double turn = glm::dot(node[a]->n, node[b]->n);
    if (!t.smooth || turn < std::cos(2 * largest_turn)) return 0.0F;
    return float(glm::dot(node[a]->n - node[b]->n, node[a]->x - node[b]->x));
  };
  const std::array<float, 3> bends = {bend(0, 1), bend(1, 2), bend(2, 0)};
  for (std::size_t k = 0; k < 3; ++k) {
    const dvec3& x = node[k]->x;
    result[k] = {float(p[k].x),
                 float(p[k].y),
                 {float(x.x), float(x.y), float(x.z)},
                 {k == 0 ? 1.0F : 0.0F, k == 1 ? 1.0F : 0.0F},
                 {bends[0], bends[1], bends[2]},
                 std::uint32_t(t.element),
                 std::uint32_t(triangle)};
  }
  return true;
}

void Painter::load(const StereographicView& view) {
  canvas_.begin(int(view.pole()), extent_, reach_);
  const std::size_t count = content_.triangles.triangles.size();
  std::vector<Vertex> vertices(3 * std::min(batch_size, count));
  std::vector<char> seen(std::min(batch_size, count));
  for (std::size_t first = 0; first < count; first += batch_size) {
    options_.progress.check();
    const std::size_t here = std::min(batch_size, count - first);
    parallel_for(here, 1024, options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        seen[k] = corners(view, first + k, &vertices[3 * k]) ? 1 : 0;
      }
    });
    std::size_t kept = 0;
    for (std::size_t k = 0; k < here; ++k) {
      if (seen[k] == 0) continue;
      if (kept != k)
        std::copy_n(vertices.begin() + std::ptrdiff_t(3 * k), 3,
                    vertices.begin() + std::ptrdiff_t(3 * kept));
      ++kept;
    }
    canvas_.add({vertices.data(), 3 * kept});
  }
}

/// Where climbing from what is drawn, or from what lies below it, leads to the higher contact.
OffscreenCanvas::Pixel Painter::better(const OffscreenCanvas::Pixel& first,
                                       const OffscreenCanvas::Pixel* second, const dvec3& n) const {
  const auto climbed = [&](std::uint32_t triangle) {
    return climb(content_.geometry, content_.start(triangle, n), n);
  };
  const auto number = [&](const ClimbedContact& c) { return content_.elements.number(c.contact); };
  const ClimbedContact a = climbed(first.triangle);
  if (second == nullptr) return {std::uint32_t(number(a)), first.triangle};
  const ClimbedContact b = climbed(second->triangle);
  // Of contacts that are one, the lower kind, which has the higher number.
  const double tie = content_.geometry.tie();
  const bool second_wins = b.h > a.h + tie || (b.h >= a.h - tie && number(b) > number(a));
  return {std::uint32_t(number(second_wins ? b : a)),
          second_wins ? second->triangle : first.triangle};
}

/// Takes what was drawn; where two contacts are as good as equal, and where what is drawn changes
/// from pixel to pixel, double precision decides.
void Painter::decide(Hemisphere hemisphere, const Layer& first, const Layer& second) {
  const std::size_t size = content_.side();
  struct Counts {
    long decided = 0, filled = 0, empty = 0;
  };
  std::vector<Counts> counts(size);
  std::vector<OffscreenCanvas::Pixel>& image = content_.images[std::size_t(hemisphere)];
  image = first.pixels;
  const auto at_change = [&](std::size_t row, std::size_t column) {
    const auto element = [&](std::size_t r, std::size_t c) {
      return first.pixels[std::min(r, size - 1) * size + std::min(c, size - 1)].element;
    };
    const std::uint32_t own = element(row, column);
    return own != element(row, column + 1) || own != element(row + 1, column) ||
           (column > 0 && own != element(row, column - 1)) ||
           (row > 0 && own != element(row - 1, column));
  };
  parallel_for(size, 4, options_.threads, [&](std::size_t begin, std::size_t end) {
    options_.progress.check();
    for (std::size_t row = begin; row < end; ++row) {
      for (std::size_t column = 0; column < size; ++column) {
        const std::size_t k = row * size + column;
        OffscreenCanvas::Pixel& pixel = image[k];
        if (pixel.element == OffscreenCanvas::nothing) {
          ++counts[row].empty;
          continue;
        }
        const bool close = second.pixels[k].element != OffscreenCanvas::nothing &&
                           value(first.depths[k]) - value(second.depths[k]) <= decision_margin;
        if (close || at_change(row, column)) {
          ++counts[row].decided;
          const dvec3 n =
              content_.direction({hemisphere, int(column) - image_margin, int(row) - image_margin});
          pixel = better(pixel, close ? &second.pixels[k] : nullptr, n);
        }
        if (int(pixel.triangle) >= content_.first_filler) ++counts[row].filled;
      }
    }
  });
  for (const Counts& c : counts) {
    content_.statistics.decided_pixels += c.decided;
    content_.statistics.filled_pixels += c.filled;
    content_.statistics.empty_pixels += c.empty;
  }
}

void Painter::paint() {
  EnvelopeStatistics& statistics = content_.statistics;
  options_.progress.update("triangles", 0);
  Stopwatch watch;
  make_triangles();
  find_sources();
  for (const GaussTriangles::Node& node : content_.triangles.nodes) {
    reach_ = std::max(reach_, 1.01 * glm::length(node.x));
  }
  statistics.triangles = long(content_.triangles.triangles.size());
  statistics.seconds_triangles = watch.seconds();
  for (const Hemisphere hemisphere : hemispheres) {
    options_.progress.update("draw", hemisphere == Hemisphere::north ? 0 : 0.5);
    watch = Stopwatch();
    load(StereographicView{hemisphere, options_.size});
    const Layer first = canvas_.draw_first();
    const Layer second = canvas_.draw_second();
    statistics.seconds_draw += watch.seconds();
    watch = Stopwatch();
    decide(hemisphere, first, second);
    statistics.seconds_decide += watch.seconds();
  }
}

}  // namespace

EnvelopeImages::EnvelopeImages(const Scene& scene, const EnvelopeOptions& options) {
  if (options.size < smallest_size || options.size > largest_size) {
    throw InvalidInput("the size of envelope images must be " + std::to_string(smallest_size) +
                       " .. " + std::to_string(largest_size) + " pixels");
  }
  auto content = std::make_unique<EnvelopeContent>(scene);
  content->size = options.size;
  content->threads = options.threads;
  Painter(*content, options).paint();
  content_ = std::move(content);
}

EnvelopeImages::~EnvelopeImages() = default;
EnvelopeImages::EnvelopeImages(EnvelopeImages&&) noexcept = default;

const Scene& EnvelopeImages::scene() const { return content_->scene; }
int EnvelopeImages::size() const { return content_->size; }
const EnvelopeStatistics& EnvelopeImages::statistics() const { return content_->statistics; }

EnvelopePixel EnvelopeImages::pixel(const dvec3& n) const {
  const Hemisphere hemisphere = hemisphere_of(n);
  const dvec2 p = view(hemisphere).pixel(n);
  const auto nearest = [&](double x) { return std::clamp(int(std::lround(x)), 0, size() - 1); };
  return {hemisphere, nearest(p.x), nearest(p.y)};
}

int EnvelopeImages::source(const EnvelopePixel& p) const {
  const std::uint32_t element = content_->at(p).element;
  return element == OffscreenCanvas::nothing ? -1 : content_->element_sources[element];
}

Contact EnvelopeImages::contact(const EnvelopePixel& p) const {
  return content_->told(content_->climbed(p).contact);
}

}  // namespace taut
