#pragma once

#include <array>
#include <map>
#include <vector>

#include "taut/bounds/contact_geometry.h"
#include "taut/bounds/scalar_net.h"

namespace taut {

/// What of a model all but touches a plane: parts of patches that are not ruled, and of edges and
/// curves that are not straight, which may hold contacts of their own. In the scene's frame.
class TopParts {
 public:
  explicit TopParts(const ContactGeometry& geometry);

  /// Two contacts are in one piece of what lies within `depth` of the supporting plane across d on
  /// which both are: of one surface, over its edges, or of one curve. It may also be told so for
  /// depths up to a fourth larger. False where that is too much to look at.
  bool hang_together(const dvec3& d, const Contact& a, const Contact& b, double depth) const;

 private:
  struct Part {
    NetShape shape;
    std::vector<dvec4> net;
  };
  using Place = std::array<int, 3>;  ///< instance, kind, and element
  static Place place(const Contact& c) { return {c.instance, int(c.kind), c.element}; }
  void add_edges(int instance);
  void find_bodies();
  int part_of(const Contact& c) const;
  bool hang_together_in_one_element(const dvec3& d, const Contact& a, const Contact& b,
                                    double lowest) const;
  bool find(int body, const dvec3& d, double height, double depth, std::vector<Box>& found) const;

  const ContactGeometry& geometry_;
  std::vector<Part> parts_;
  std::map<Place, int> index_;
  std::vector<int> bodies_;  ///< by part: the same for what hangs together
};

}  // namespace taut
