#pragma once

#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "taut/bounds/scalar_net.h"
#include "taut/core/geometry.h"
#include "taut/surface/bezier.h"

namespace taut {

/// A net of homogeneous control points or derivatives that a piece holds; v within u.
struct StoredNet {
  NetShape shape;
  const dvec4* points = nullptr;
};

/// Scales a rational net so that the weights at its four corners are as alike as changes of
/// parameters that keep the rectangle can make them.
void even_weights(NetShape shape, std::span<dvec4> net);

/// Part of an element: a rectangle of a patch, an interval of a piece of an edge, or a vertex.
class MapPiece {
 public:
  /// All of an element.
  struct Root {
    struct Net {
      NetShape shape;
      std::vector<dvec4> points;
    };
    int element = -1;
    bool rational = false;
    Interval u = {0, 0}, v = {0, 0};
    Net net;
    std::vector<Net> inward;
  };
  explicit MapPiece(const Root& root);
  MapPiece& operator=(const MapPiece&) = delete;
  ~MapPiece();

  int element = -1;
  Interval u, v;
  /// Its control points; of a rational one in parameters in which weights are most alike.
  StoredNet net;
  StoredNet exact;  ///< in the element's own parameters
  /// Of an edge or vertex: derivatives along the surfaces and edges that end there, away from it.
  std::vector<StoredNet> inward;
  Box box = {};  ///< of its control points

  /// Its two halves across a parameter, which live as long as it does. They are made when someone
  /// first asks; the same bits whoever that is. @pre it has the parameter
  std::array<const MapPiece*, 2> halves(Direction across) const;

 private:
  struct Halves;
  MapPiece(const MapPiece& other);
  dvec4* own(const StoredNet& of) { return points_.data() + (of.points - points_.data()); }
  void finish();

  std::vector<dvec4> points_;  // of all the nets
  mutable std::array<std::atomic<const Halves*>, 2> halves_ = {};
};

}  // namespace taut
