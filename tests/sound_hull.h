#pragma once

#include <set>
#include <string>

#include "models.h"
#include "taut/verify/verify_hull.h"

namespace taut_test {

/// What exact hulls are held to.
inline constexpr double exact = 1e-12;

/// A scene with the document of its hull, which has a report.
struct Sound {
  taut::Scene scene;
  taut::HullDocument hull;
};

Sound sound_hull(const Shape& shape);

/// Makes a report of these: the resolution, the tolerant faces and the largest of their bounds.
void state(taut::HullDocument& hull, double resolution, int tolerant, double bound);

taut::HullVerification verified(const taut::HullDocument& hull, const taut::Scene& scene);

/// Names of all checks that fail.
std::set<std::string> failed(const taut::HullVerification& v);

/// These, all faults and all that was measured.
std::string text_of(const taut::HullVerification& v);

}  // namespace taut_test
