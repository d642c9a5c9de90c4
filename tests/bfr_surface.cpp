#include "bfr_surface.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>

#include <array>

#include "refined_cage.h"

namespace taut_test {
namespace {

namespace Bfr = OpenSubdiv::Bfr;
using Factory = Bfr::RefinerSurfaceFactory<>;
using Surface = Bfr::Surface<double>;

/// The finest of which Bfr is capable, and the one before it.
constexpr std::array<int, 2> levels = {10, 9};
constexpr double errors_per_difference = 4;

Factory::Options options_of(int level) {
  return Factory::Options().SetApproxLevelSmooth(level).SetApproxLevelSharp(level);
}

struct Jet {
  dvec3 x, du, dv;
  dvec3 normal() const { return taut::unit(glm::cross(du, dv)); }
};

/// A face by one of the levels.
class Evaluator {
 public:
  Evaluator(const Factory& factory, int face, const std::vector<dvec3>& points) {
    if (!factory.InitVertexSurface(face, &surface_)) return;
    patch_points_.resize(std::size_t(surface_.GetNumPatchPoints()));
    surface_.PreparePatchPoints(&points[0].x, 3, &patch_points_[0].x, 3);
  }

  const Surface& surface() const { return surface_; }

  Jet operator()(const std::array<double, 2>& uv) const {
    Jet jet;
    surface_.Evaluate(uv.data(), &patch_points_[0].x, 3, &jet.x.x, &jet.du.x, &jet.dv.x);
    return jet;
  }

 private:
  Surface surface_;
  std::vector<dvec3> patch_points_;
};

}  // namespace

struct BfrSurface::Content {
  std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> refiner;
  std::array<std::vector<Evaluator>, 2> faces;  // by level, face

  const Surface& surface(int face) const { return faces[0][std::size_t(face)].surface(); }
  Bfr::Parameterization parameters(int face) const { return surface(face).GetParameterization(); }
  BfrPoint point(int face, const std::array<double, 2>& uv) const;
};

BfrPoint BfrSurface::Content::point(int face, const std::array<double, 2>& uv) const {
  const Jet fine = faces[0][std::size_t(face)](uv);
  const Jet coarse = faces[1][std::size_t(face)](uv);
  BfrPoint p;
  p.x = fine.x;
  p.normal = fine.normal();
  p.error = errors_per_difference * glm::distance(fine.x, coarse.x);
  return p;
}

BfrSurface::BfrSurface(const ControlCage& cage) : content_(std::make_unique<Content>()) {
  content_->refiner = refiner_of(cage);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const Factory factory(*content_->refiner, options_of(levels[k]));
    for (int f = 0; f < int(cage.faces.size()); ++f) {
      content_->faces[k].emplace_back(factory, f, cage.points);
    }
  }
}

BfrSurface::~BfrSurface() = default;

bool BfrSurface::has_surface(int face) const { return content_->surface(face).IsValid(); }

BfrPoint BfrSurface::point(int face, Random& random) const {
  const Bfr::Parameterization parameters = content_->parameters(face);
  std::array<double, 2> uv = {uniform(random, 0, 1), uniform(random, 0, 1)};
  if (parameters.HasSubFaces()) {
    const int part = pick(random, 0, parameters.GetFaceSize() - 1);
    const std::array<double, 2> of_part = uv;
    parameters.ConvertNormalizedSubFaceToCoord(part, of_part.data(), uv.data());
  } else if (parameters.GetType() == Bfr::Parameterization::TRI && uv[0] + uv[1] > 1) {
    uv = {1 - uv[0], 1 - uv[1]};
  }
  return content_->point(face, uv);
}

BfrPoint BfrSurface::point_near_corner(int face, double size, Random& random) const {
  const Bfr::Parameterization parameters = content_->parameters(face);
  const int count = parameters.GetFaceSize();
  const int corner = pick(random, 0, count - 1);
  const double a = size * uniform(random, 0, 1);
  const double b = size * uniform(random, 0, 1);
  std::array<double, 2> uv = {a, b};
  if (parameters.HasSubFaces()) {
    // Each part begins at its corner.
    const std::array<double, 2> of_part = uv;
    parameters.ConvertNormalizedSubFaceToCoord(corner, of_part.data(), uv.data());
  } else {
    std::array<double, 2> at = {}, next = {}, last = {};
    parameters.GetVertexCoord(corner, at.data());
    parameters.GetVertexCoord((corner + 1) % count, next.data());
    parameters.GetVertexCoord((corner + count - 1) % count, last.data());
    for (std::size_t k = 0; k < 2; ++k) {
      uv[k] = at[k] + a * (next[k] - at[k]) + b * (last[k] - at[k]);
    }
  }
  return content_->point(face, uv);
}

}  // namespace taut_test
