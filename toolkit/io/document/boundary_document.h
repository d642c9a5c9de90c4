#pragma once

#include <string>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/hull_document.h"

namespace taut {

/// The document of an exact boundary. `files`: what each of the model's parts was read from, as far
/// as it is known.
HullDocument hull_document(const Scene& scene, const HullBoundary& boundary,
                           const std::vector<std::string>& files = {});

}  // namespace taut
