#pragma once

#include <optional>
#include <string>

#include "taut/core/progress.h"
#include "taut/surface/model.h"

namespace taut {

/// What a resolution comes from.
enum class ResolutionSource {
  rounding,     ///< coordinates are doubles
  floor,        ///< resolution_floor of the diagonal
  coordinates,  ///< the grid that they were rounded to
  joins,        ///< joined borders miss each other
  copies,       ///< surfaces that are one but for little do
  stand_ins,    ///< patches stand for surfaces that they meet within a tolerance only
  option,       ///< the caller
};
/// As in reports: "rounding", "floor", "coordinates", "joins" (also of copies), "stand-ins",
/// "option".
const char* name_of(ResolutionSource source);

/// The resolution of a model: what is nearer than that may be taken for one. Lengths in model
/// units.
struct Resolution {
  double rho = 0;                                        ///< the resolution
  ResolutionSource source = ResolutionSource::rounding;  ///< what it comes from
  /// What the model asks for by itself: more than rho where that is capped.
  double of_model = 0;
  /// The coarsest grid of a part that is placed.
  CoordinateGrid grid;
  /// The largest gap in a part that is placed (Part::join_gap).
  double worst_join = 0;
  /// How far copies of patches are apart that may be told to be one (copies_apart); 0 where the
  /// resolution is stated.
  double worst_copy = 0;
  /// The model's resolution, where places of its hull are told apart at the coarser rho only; or 0.
  double raised_from = 0;

  /// The model asks for a coarser one by itself.
  bool capped() const { return source != ResolutionSource::option && of_model > rho; }
};

/// The resolution of a model with this diagonal: that of its box, or of its surfaces' own.
///
/// It is the largest of what rounding to doubles does to coordinates (coordinate_rounding);
/// resolution_floor of the diagonal, if there is more than points and polygons; what the grid of a
/// part's coordinates tells (grid_resolution), and the gaps of its joins (join_resolution); the
/// deviation of its stand-ins; and, where copies of patches miss each other by no more than four
/// times all that, what makes them one (cover_share). All but the first, the smallest that has a
/// meaning, are capped at coarsest_resolution of the diagonal. Only parts that are placed count,
/// with their own numbers whatever the pose, and all of these, be they on the hull or not. The
/// order of parts does not matter.
///
/// `share`: this fraction of the diagonal instead; 0: nothing but the rounding to doubles.
/// @pre 0 <= diagonal, finite @throws InvalidInput if the share is not in [0, 1]
Resolution resolution_of(const Model& model, double diagonal, std::optional<double> share = {});

/// Why the resolution is what it is, for a person: "coordinates have 6 decimals".
std::string reason_of(const Resolution& resolution);

/// Warns (coarse-resolution) if the model asks for a coarser one than it has.
void warn_if_capped(const Resolution& resolution, const Progress& progress);

/// How near elements of an instance must be to others to touch them: what rounding, to doubles and
/// to its part's grid, and the deviation of stand-ins may move a point of theirs by; at most
/// tie_share of the resolution.
/// @pre the resolution is the model's, 0 <= instance < number of instances
double tie_of(const Model& model, int instance, const Resolution& resolution);

}  // namespace taut
