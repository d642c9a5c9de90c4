#include "taut/verify/check_sources.h"

#include "taut/hull/result/hull_sources.h"

namespace taut {
namespace {

bool same_shape(const HullDocument::Patch& a, const HullDocument::Patch& b) {
  return a.rows == b.rows && a.columns == b.columns && a.points.size() == b.points.size() &&
         std::equal(a.domain.begin(), a.domain.end(), b.domain.begin(), b.domain.end(),
                    [](const Interval& i, const Interval& j) {
                      return i.lower == j.lower && i.upper == j.upper;
                    });
}

double distance(const HullDocument::Patch& a, const HullDocument::Patch& b, double size) {
  double worst = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    raise(worst, glm::distance(dvec3(a.points[i]), dvec3(b.points[i])) / size);
    raise(worst, std::abs(a.points[i].w / b.points[i].w - 1));
  }
  return worst;
}

}  // namespace

bool check_sources(const HullDocument& hull, const Scene& scene, HullFaults& faults,
                   double& off_model) {
  const double size = scene.diagonal() > 0 ? scene.diagonal() : 1;
  raise(off_model, std::abs(hull.diagonal - scene.diagonal()) / size);
  const std::vector<std::string> no_files;
  const HullSources own(scene.model(), no_files);
  bool same = true;
  for (std::size_t i = 0; i < hull.sources.size(); ++i) {
    const HullDocument::Source& source = hull.sources[i];
    const std::string name = "sources[" + std::to_string(i) + "]: ";
    if (source.id < 0 || source.id >= scene.model().source_count()) {
      faults.add("sources", name + "the model has no source " + std::to_string(source.id));
      same = false;
      continue;
    }
    const HullDocument::Source model = own.source(source.id);
    const bool alike = source.kind == model.kind &&
                       std::equal(source.patches.begin(), source.patches.end(),
                                  model.patches.begin(), model.patches.end(), same_shape);
    if (!alike) {
      faults.add("sources",
                 name + "the model's source " + std::to_string(source.id) + " is another one");
      same = false;
      continue;
    }
    for (std::size_t k = 0; k < source.patches.size(); ++k) {
      raise(off_model, distance(source.patches[k], model.patches[k], size));
    }
  }
  return same;
}

}  // namespace taut
