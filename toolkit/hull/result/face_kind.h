#pragma once

namespace taut {

/// What part of a convex hull's boundary a face belongs to.
enum class FaceKind : unsigned char {
  patch = 0,   ///< on the model's surface
  scroll = 1,  ///< spans between two contacts
  facet = 2,   ///< lies flat on three or more contacts
};

}  // namespace taut
