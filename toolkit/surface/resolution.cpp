#include "taut/surface/resolution.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>

#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/core/tolerances.h"
#include "taut/surface/near_copies.h"

namespace taut {
namespace {

/// What rounding to doubles may do to points in the box, and to planes through them.
double rounding_in(const Box& box) {
  if (box.empty()) return 0;
  const dvec3 reach = glm::max(glm::abs(box.lower), glm::abs(box.upper));
  return coordinate_rounding * (reach.x + reach.y + reach.z);
}

/// The box that holds another one in a pose.
Box placed(const Box& box, const RigidMotion& pose) {
  Box result;
  if (box.empty()) return result;
  for (const double x : {box.lower.x, box.upper.x}) {
    for (const double y : {box.lower.y, box.upper.y}) {
      for (const double z : {box.lower.z, box.upper.z}) result.include(pose({x, y, z}));
    }
  }
  return result;
}

/// What the parts that are placed ask for, each at its coarsest.
struct Coarsest {
  CoordinateGrid grid;
  double join_gap = 0;
  double deviation = 0;
};

Coarsest coarsest(const Model& model) {
  std::vector<bool> is_placed(model.parts().size());
  for (const Instance& instance : model.instances()) is_placed[to_size(instance.part)] = true;
  Coarsest result;
  for (std::size_t k = 0; k < is_placed.size(); ++k) {
    if (!is_placed[k]) continue;
    const Part& part = model.parts()[k];
    const CoordinateGrid grid = part.coordinate_grid();
    if (grid.step > result.grid.step) result.grid = grid;
    result.join_gap = std::max(result.join_gap, part.join_gap());
    result.deviation = std::max(result.deviation, part.deviation_bound());
  }
  return result;
}

/// Three significant digits.
std::string number(double x) {
  std::array<char, 32> text;
  const std::to_chars_result result =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, 3);
  return {text.data(), result.ptr};
}

}  // namespace

const char* name_of(ResolutionSource source) {
  constexpr std::array names = {"rounding", "floor",     "coordinates", "joins",
                                "joins",    "stand-ins", "option"};
  return names[to_size(int(source))];
}

Resolution resolution_of(const Model& model, double diagonal, std::optional<double> share) {
  // Asked in a form that NaN fails.
  if (share && !(*share >= 0 && *share <= 1)) {
    throw InvalidInput("the resolution must be a fraction of the diagonal, from 0 to 1");
  }
  const Coarsest found = coarsest(model);
  Resolution result;
  result.grid = found.grid;
  result.worst_join = found.join_gap;
  const double rounding = rounding_in(model.control_box());
  result.of_model = rounding;
  const auto ask = [&](double length, ResolutionSource source) {
    if (length <= result.of_model) return;
    result.of_model = length;
    result.source = source;
  };
  if (!model.polyhedral()) ask(resolution_floor * diagonal, ResolutionSource::floor);
  ask(grid_resolution * 0.5 * found.grid.step, ResolutionSource::coordinates);
  ask(join_resolution * found.join_gap, ResolutionSource::joins);
  ask(found.deviation, ResolutionSource::stand_ins);
  // Copies that miss each other by little more than what is one anyway are meant to be one.
  if (!share && !model.polyhedral()) {
    result.worst_copy = copies_apart(model, copies_apart_limit * result.of_model);
    ask(result.worst_copy / cover_share, ResolutionSource::copies);
  }
  if (share) result.source = ResolutionSource::option;
  result.rho =
      std::max(rounding, share ? *share * diagonal
                               : std::min(result.of_model, coarsest_resolution * diagonal));
  return result;
}

std::string reason_of(const Resolution& resolution) {
  if (resolution.raised_from > 0) {
    Resolution own = resolution;
    own.rho = std::exchange(own.raised_from, 0.0);
    return "at " + number(own.rho) + " (" + reason_of(own) + ") not all is told apart";
  }
  switch (resolution.source) {
    case ResolutionSource::rounding:
      return "coordinates are doubles";
    case ResolutionSource::floor:
      return number(resolution_floor) + " of the diagonal";
    case ResolutionSource::coordinates:
      return resolution.grid.kind == CoordinateGrid::Kind::float32
                 ? "coordinates are float32"
                 : "coordinates have " + std::to_string(resolution.grid.decimals) + " decimals";
    case ResolutionSource::joins:
      return "joined borders miss each other by up to " + number(resolution.worst_join);
    case ResolutionSource::copies:
      return "copies of surfaces miss each other by up to " + number(resolution.worst_copy);
    case ResolutionSource::stand_ins:
      return "surfaces are known to within " + number(resolution.of_model);
    default:
      return "as asked for";
  }
}

void warn_if_capped(const Resolution& resolution, const Progress& progress) {
  if (!resolution.capped()) return;
  progress.warning("coarse-resolution",
                   reason_of(resolution) + ", which asks for a resolution of " +
                       number(resolution.of_model) + ", more than " + number(coarsest_resolution) +
                       " of the diagonal: it is " + number(resolution.rho) +
                       " unless another one is stated (--resolution)");
}

double tie_of(const Model& model, int instance, const Resolution& resolution) {
  const Instance& placed_part = model.instances()[to_size(instance)];
  const Part& part = model.parts()[to_size(placed_part.part)];
  // Half a step in each coordinate.
  const double off_grid = 0.5 * std::numbers::sqrt3 * part.coordinate_grid().step;
  const double rounding = rounding_in(placed(part.control_box(), placed_part.pose));
  return std::min(std::max({rounding, off_grid, part.deviation_bound()}),
                  tie_share * resolution.rho);
}

}  // namespace taut
