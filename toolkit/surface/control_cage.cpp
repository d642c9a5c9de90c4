#include "taut/surface/control_cage.h"

#include <cmath>
#include <string>

#include "taut/core/error.h"

namespace taut {
namespace {

/// Checks one cage.
class Validator {
 public:
  explicit Validator(const ControlCage& cage) : cage_(cage) {}

  void points() const {
    for (std::size_t i = 0; i < cage_.points.size(); ++i) {
      const dvec3& p = cage_.points[i];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        fail("point", i, "is not finite");
      }
    }
  }
  void faces() const {
    for (std::size_t i = 0; i < cage_.faces.size(); ++i) {
      const std::vector<int>& face = cage_.faces[i];
      if (face.size() < 3) fail("face", i, "has fewer than three corners");
      if (cage_.scheme == CageScheme::loop && face.size() != 3) {
        fail("face", i, "is no triangle, as the scheme loop needs");
      }
      for (const int v : face) vertex("face", i, v);
    }
  }
  void tags() const {
    for (std::size_t i = 0; i < cage_.creases.size(); ++i) {
      const CageCrease& crease = cage_.creases[i];
      for (const int v : crease.vertices) vertex("crease", i, v);
      if (crease.vertices[0] == crease.vertices[1]) fail("crease", i, "has one vertex twice");
      sharpness("crease", i, crease.sharpness);
    }
    for (std::size_t i = 0; i < cage_.corners.size(); ++i) {
      vertex("corner", i, cage_.corners[i].vertex);
      sharpness("corner", i, cage_.corners[i].sharpness);
    }
    for (std::size_t i = 0; i < cage_.holes.size(); ++i) {
      const int f = cage_.holes[i];
      if (f < 0 || static_cast<std::size_t>(f) >= cage_.faces.size()) {
        fail("hole", i, "is face " + std::to_string(f) + ", which is not there");
      }
    }
  }

 private:
  [[noreturn]] void fail(const char* kind, std::size_t i, const std::string& what) const {
    throw InvalidInput(std::string(kind) + " " + std::to_string(i) + " " + what);
  }
  void vertex(const char* kind, std::size_t i, int v) const {
    if (v >= 0 && static_cast<std::size_t>(v) < cage_.points.size()) return;
    fail(kind, i, "names vertex " + std::to_string(v) + ", which is not there");
  }
  // Asked in a form that NaN fails.
  void sharpness(const char* kind, std::size_t i, double value) const {
    if (!(value >= 0)) fail(kind, i, "has a sharpness that is negative or no number");
  }

  const ControlCage& cage_;
};

}  // namespace

void validate(const ControlCage& cage) {
  const Validator validator(cage);
  validator.points();
  validator.faces();
  validator.tags();
}

const char* name_of(CageScheme scheme) { return scheme == CageScheme::loop ? "loop" : "catmark"; }

const char* name_of(CageBoundary boundary) {
  switch (boundary) {
    case CageBoundary::edge_only:
      return "edge_only";
    case CageBoundary::none:
      return "none";
    default:
      return "edge_and_corner";
  }
}

}  // namespace taut
