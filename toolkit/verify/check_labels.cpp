#include "taut/verify/check_labels.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "taut/core/integers.h"
#include "taut/hull/result/hull_sources.h"
#include "taut/verify/closest_on_surface.h"

namespace taut {
namespace {

using Face = HullDocument::Face;

/// Fractions of the diagonal: what is told to lie on a face may be off it by as much as faces
/// along one edge are off each other; what lies on one for certain is off it by rounding.
constexpr double near_face = 1e-7;

/// Rulings that are no longer, as a fraction of the diagonal, lie near a face that they touch
/// twice.
constexpr double long_ruling = 1e-2;

/// Beside which shares of the way that their ends go a scroll's long rulings are looked at where no
/// face is told: it may lie on two faces, one after the other; and where on a ruling it is looked
/// whether it lies on a face.
constexpr std::array<double, 5> quarters = {0.1, 0.25, 0.5, 0.75, 0.9};
constexpr std::array<double, 5> along_ruling = {0, 0.25, 0.5, 0.75, 1};

/// The ruled faces of a model, as a document without hull.
HullDocument ruled_faces(const Scene& scene) {
  const Model& model = scene.model();
  const std::vector<std::string> no_files;
  HullSources sources(model, no_files);
  for (int i = 0; i < int(model.instances().size()); ++i) {
    const Part& part = model.parts()[to_size(model.instances()[to_size(i)].part)];
    for (const Patch& patch : part.patches()) {
      if (patch.ruled()) sources.add(model.source_id({SourceKind::face, i, patch.face}));
    }
  }
  sources.finish();
  HullDocument faces;
  faces.diagonal = scene.diagonal();
  faces.sources = sources.make();
  return faces;
}

/// Checks one document.
class LabelCheck {
 public:
  LabelCheck(const DocumentGeometry& geometry, const Scene& scene, double resolution,
             HullFaults& faults)
      : hull_(geometry.hull()),
        geometry_(geometry),
        ruled_(ruled_faces(scene)),
        ruled_geometry_(ruled_, geometry.origin(), 0),
        near_(std::max(near_face, geometry.noise()) * hull_.diagonal),
        resolution_(resolution),
        faults_(faults) {}
  void run();

 private:
  void check_told(std::size_t face);
  void check_untold(std::size_t face);
  bool in_plane(const HullDocument::Source& source, const Face& facet, double near) const;
  bool on_face(const DocumentGeometry& geometry, int source, const HullDocument::Ruling& ruling,
               double near) const;
  bool runs_along(int source, const Face& scroll) const;
  void wrong(std::size_t face, const std::string& what) {
    faults_.add("labels", "faces[" + std::to_string(face) + "]: " + what);
  }

  const HullDocument& hull_;
  const DocumentGeometry& geometry_;
  HullDocument ruled_;
  DocumentGeometry ruled_geometry_;
  double near_;
  double resolution_;
  HullFaults& faults_;
};

void LabelCheck::run() {
  for (std::size_t f = 0; f < hull_.faces.size(); ++f) {
    if (hull_.faces[f].kind == FaceKind::patch) continue;
    if (hull_.faces[f].source >= 0) {
      check_told(f);
    } else {
      check_untold(f);
    }
  }
}

void LabelCheck::check_told(std::size_t f) {
  const Face& face = hull_.faces[f];
  const HullDocument::Source& source = geometry_.source(face.source);
  if (source.kind != SourceKind::face) return wrong(f, "its source is no face");
  if (source.patches.empty()) return;
  const double near = near_ + std::max(face.tolerant, resolution_);
  if (face.kind == FaceKind::facet) {
    if (!in_plane(source, face, near)) wrong(f, "its source is not in its plane");
    return;
  }
  for (const HullDocument::Ruling& r : face.rulings) {
    if (!on_face(geometry_, face.source, r, near))
      return wrong(f, "its source has no such rulings");
  }
}

void LabelCheck::check_untold(std::size_t f) {
  const Face& face = hull_.faces[f];
  for (int s = 0; s < int(ruled_.sources.size()); ++s) {
    const HullDocument::Source& source = ruled_.sources[to_size(s)];
    const bool lies_on = face.kind == FaceKind::facet
                             ? in_plane(source, face, geometry_.noise() * hull_.diagonal)
                             : runs_along(s, face);
    if (!lies_on) continue;
    return wrong(f, "it lies on a face of the model, which it does not tell: source " +
                        std::to_string(source.id));
  }
}

/// All of one of its Bezier patches is.
bool LabelCheck::in_plane(const HullDocument::Source& source, const Face& facet,
                          double near) const {
  const double offset = facet.offset - glm::dot(geometry_.origin(), facet.normal);
  return std::any_of(source.patches.begin(), source.patches.end(), [&](const auto& patch) {
    return std::all_of(patch.points.begin(), patch.points.end(), [&](const dvec4& p) {
      return std::abs(glm::dot(geometry_.local(dvec3(p)), facet.normal) - offset) <= near;
    });
  });
}

bool LabelCheck::on_face(const DocumentGeometry& geometry, int source,
                         const HullDocument::Ruling& ruling, double near) const {
  const std::vector<HullDocument::Patch>& patches = geometry.source(source).patches;
  return std::all_of(along_ruling.begin(), along_ruling.end(), [&](double s) {
    const dvec3 p = geometry.local((1 - s) * ruling.a.p + s * ruling.b.p);
    for (std::size_t i = 0; i < patches.size(); ++i) {
      Box box;
      for (const dvec4& q : patches[i].points) box.include(geometry.local(dvec3(q)));
      if (glm::any(glm::lessThan(p, box.lower - near))) continue;
      if (glm::any(glm::lessThan(box.upper + near, p))) continue;
      const auto jet = [&](const dvec2& t) { return geometry.jet(source, {int(i), t}); };
      if (closest_on_surface(p, jet, sampled_parts(patches[i])).distance <= near) return true;
    }
    return false;
  });
}

bool LabelCheck::runs_along(int source, const Face& scroll) const {
  std::vector<HullDocument::Ruling> rulings;
  std::copy_if(scroll.rulings.begin(), scroll.rulings.end(), std::back_inserter(rulings),
               [&](const HullDocument::Ruling& r) {
                 return glm::distance(r.a.p, r.b.p) > long_ruling * hull_.diagonal;
               });
  if (rulings.empty()) return false;
  std::vector<double> way = {0};  // from the first one on
  for (std::size_t k = 1; k < rulings.size(); ++k) {
    way.push_back(way.back() + glm::distance(rulings[k - 1].a.p, rulings[k].a.p) +
                  glm::distance(rulings[k - 1].b.p, rulings[k].b.p));
  }
  const auto lies_on = [&](std::size_t k) {
    return on_face(ruled_geometry_, source, rulings[k], geometry_.noise() * hull_.diagonal);
  };
  return std::all_of(quarters.begin(), quarters.end(), [&](double s) {
    const auto next = std::lower_bound(way.begin(), way.end(), s * way.back());
    const auto k = std::size_t(next - way.begin());
    return lies_on(k) && (k == 0 || lies_on(k - 1));
  });
}

}  // namespace

void check_labels(const DocumentGeometry& geometry, const Scene& scene, double resolution,
                  HullFaults& faults) {
  LabelCheck(geometry, scene, resolution, faults).run();
}

}  // namespace taut
