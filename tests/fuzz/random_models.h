#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "read_one.h"

namespace taut_test {

/// A file's text and what is to read it.
struct RandomModel {
  Reader reader;
  std::string text;
};

/// @name Models at random
/// The same for the same seed on every machine.
/// @{

/// A control cage of 2 to 12 faces as `.obj`, Catmull-Clark or Loop, with tags at random. Half of
/// them grow face by face along edges, the others' corners meet as it happens: no manifold, folded,
/// with faces back to back and vertices that repeat. Points are in general position, on a small
/// grid, in a plane, or one of them is very far.
RandomModel random_cage(std::uint64_t seed);

/// 1 to 6 Bezier patches as `.taut.json`: neighbours on a body of exact arcs or of random bicubic
/// patches, some of them moved, mirrored or repeated, turned, and in most cases rounded to float32
/// or to 1 to 9 decimals.
RandomModel random_surfaces(std::uint64_t seed);
/// @}

/// The cages of faces with these numbers of corners, each topology once: all ways in which corners
/// can be the same vertex, up to the order of the faces of one size and to where a face begins. A
/// cage is one list of vertices a face.
/// @pre 13 corners or less in all: the ways are Bell numbers
void each_gluing(const std::vector<int>& sizes,
                 const std::function<void(const std::vector<std::vector<int>>&)>& visit);

/// Such a cage as `.obj`, its vertices in general position.
RandomModel cage_of_gluing(const std::vector<std::vector<int>>& faces, taut::Scheme scheme);

}  // namespace taut_test
