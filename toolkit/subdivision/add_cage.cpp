#include "taut/subdivision/add_cage.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <string>
#include <utility>

#include "taut/subdivision/limit_patches.h"

namespace taut {
namespace {

long faces_with_repeated_vertices(const ControlCage& cage) {
  return std::count_if(cage.faces.begin(), cage.faces.end(), [](std::vector<int> face) {
    std::sort(face.begin(), face.end());
    return std::adjacent_find(face.begin(), face.end()) != face.end();
  });
}

std::string two_digits(double x) {
  std::array<char, 32> text;
  const std::to_chars_result result =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, 2);
  return {text.data(), result.ptr};
}

void warn(const ControlCage& cage, const LimitSurface& surface, const std::string& place,
          const Progress& progress) {
  if (surface.non_manifold_edges + surface.non_manifold_vertices > 0) {
    progress.warning("non-manifold-cage", place + ": the cage is no manifold at " +
                                              std::to_string(surface.non_manifold_edges) +
                                              " edges and " +
                                              std::to_string(surface.non_manifold_vertices) +
                                              " vertices, which are taken as infinitely sharp");
  }
  if (const long count = faces_with_repeated_vertices(cage); count > 0) {
    progress.warning("degenerate-cage", place + ": " + std::to_string(count) +
                                            " faces of the cage have a vertex more than once");
  }
  if (surface.deviation_bound > surface.accuracy) {
    progress.warning("cage-accuracy", place + ": the cage's limit surface is known to within " +
                                          two_digits(surface.deviation_bound) +
                                          " only, not to the accuracy asked for, " +
                                          two_digits(surface.accuracy));
  }
}

}  // namespace

void add_cage(Part& part, const ControlCage& cage, const std::string& place,
              const CageOptions& options) {
  validate(cage);
  LimitOptions limit;
  limit.accuracy = options.accuracy;
  limit.progress = options.progress;
  LimitSurface surface = limit_patches(cage, limit);
  warn(cage, surface, place, options.progress);

  const int first_face = static_cast<int>(part.faces().size());
  std::vector<FacePatch> face;
  for (std::size_t i = 0; i < surface.patches.size(); ++i) {
    SurfacePatch& patch = surface.patches[i];
    face.push_back({std::move(patch.bezier), patch.smooth, !patch.exact});
    const bool last =
        i + 1 == surface.patches.size() || surface.patches[i + 1].cage_face != patch.cage_face;
    if (!last) continue;
    part.add_patches(std::exchange(face, {}), "face " + std::to_string(patch.cage_face));
  }
  part.add_cage(
      {std::make_shared<const ControlCage>(cage), surface.irregular_faces, surface.refined_faces},
      first_face);
  part.include_deviation(surface.deviation_bound);
}

}  // namespace taut
