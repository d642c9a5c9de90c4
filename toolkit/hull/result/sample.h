#pragma once

#include "taut/bounds/scene.h"

namespace taut {

/// A point sampled on the hull: the direction that it supports, and where it lies on the model.
struct Sample {
  dvec3 n;                ///< unit
  Contact contact;        ///< that supports there
  bool answered = false;  ///< by a support query in direction n
};

}  // namespace taut
