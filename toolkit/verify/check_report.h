#pragma once

#include <optional>

#include "taut/verify/document_measures.h"
#include "taut/verify/hull_faults.h"

namespace taut {

/// Relative accuracy to which measures are compared: what integrals between a document's rulings
/// reach where these end in free ends.
inline constexpr double measure_accuracy = 1e-10;

/// The resolution that a document's report states.
struct StatedResolution {
  double length = 0;  ///< in model units; 0 if none is stated
  /// It is what the model's numbers miss, not just the smallest or what was asked for.
  bool is_of_model = false;
};
StatedResolution stated_resolution(const HullDocument& hull);

/// How far, in model units, the model may be from the whole document at most, as its report states;
/// 0 if it does not.
double stated_gap(const HullDocument& hull);

/// The exact hull's mean width that a document's report states, in model units.
std::optional<double> stated_mean_width(const HullDocument& hull);

/// Compares what a document's report says of the exact hull with the document: its dimension, the
/// numbers of faces and curves, nothing unresolved, how many faces are tolerant and their largest
/// bound, and the measures where there are any. A document without a report has nothing to compare.
/// `rounding`: what that of coordinates may do to
/// the measures.
void check_report(const HullDocument& hull, const std::optional<DocumentMeasures>& measures,
                  double rounding, HullFaults& faults);

}  // namespace taut
