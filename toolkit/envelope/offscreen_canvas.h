#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace taut {

/// A square image without a window, in which triangles of the upper envelope are drawn by OSMesa:
/// their support values go to a depth attachment of 32 bits, of which the largest wins, and the two
/// numbers that name them to an attachment of unsigned integers, exactly.
///
/// All of the drawing library stays behind this class. The library is loaded when the first canvas
/// is made, so that everything else works without it; no display is needed. A canvas is used by the
/// thread that made it, one canvas at a time. How many threads the library draws with is its own
/// affair (LP_NUM_THREADS) and changes no bit of the image.
class OffscreenCanvas {
 public:
  /// A corner of a triangle, in the plane (StereographicView).
  struct Vertex {
    float x;  ///< to the right
    float y;  ///< up
    /// The contact: its value in the direction n of a pixel is point . n.
    float point[3];
    /// Barycentric coordinates of the corner: (1, 0), (0, 1), (0, 0).
    float b[2];
    /// Per triangle (as its last corner has it): (n_i - n_j) . (x_i - x_j) of the sides 01, 12, 20.
    /// The value gains half of the sum of b_i b_j times these: x . n is so interpolated to third
    /// order.
    float bend[3];
    /// Per triangle: what names it.
    std::uint32_t element;   ///< per triangle: what names it
    std::uint32_t triangle;  ///< per triangle: what names it, within the element
  };
  /// What is drawn at a pixel where nothing is.
  static constexpr std::uint32_t nothing = 0xffffffffU;

  /// What is drawn at a pixel.
  struct Pixel {
    std::uint32_t element = nothing;   ///< as its triangle has it
    std::uint32_t triangle = nothing;  ///< as its triangle has it
  };
  /// Rows from the top. Depths are (reach - value) / (2 reach), 1 where nothing is drawn.
  struct Layer {
    std::vector<Pixel> pixels;  ///< row by row
    std::vector<float> depths;  ///< per pixel
  };

  /// @throws BackendError if the library cannot be loaded or started, another driver than llvmpipe
  /// or softpipe answers, or it lacks OpenGL 3.3, attachments of this size, of integers or of depth
  explicit OffscreenCanvas(int size);
  ~OffscreenCanvas();
  OffscreenCanvas(const OffscreenCanvas&) = delete;
  OffscreenCanvas& operator=(const OffscreenCanvas&) = delete;

  /// The driver and its version.
  const std::string& driver() const;

  /// Takes away all triangles; those that follow are projected for the given pole (+1: the north
  /// image, see StereographicView), of which the image shows -extent <= x, y <= extent, and no
  /// value is farther than `reach` from zero.
  void begin(int pole, double extent, double reach);
  /// Adds triangles, three vertices each.
  void add(std::span<const Vertex> vertices);
  /// Draws all triangles: at each pixel that of the largest value; among equal ones the first.
  Layer draw_first();
  /// Draws the triangles whose element is another than the last draw_first() left at the pixel.
  Layer draw_second();

 private:
  class Context;
  std::unique_ptr<Context> context_;
};

}  // namespace taut
