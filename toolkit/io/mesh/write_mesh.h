#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "taut/hull/result/hull_mesh.h"

namespace taut {

/// What the precision of a file did to a mesh.
struct WrittenMesh {
  /// Upper bound of the distance between the mesh and what the file holds, in model units: the
  /// farthest that a vertex was moved by rounding. Zero where the file holds doubles.
  double rounding = 0;
};

/// How far rounding to float, as STL does it, moves a point of the box at most.
double float_rounding_bound(const Box& box);

/// How far rounding to floats may have moved one of these points, at most: half a unit in the last
/// place of each of its coordinates that is a float. What is none was not rounded to one.
double float_rounding(std::span<const dvec3> points);

/// Writes a hull mesh by the file name's extension: `.ply` (binary, doubles, with the origin of
/// every vertex and face and colours), `.obj` (grouped by hull face, with an .mtl beside it),
/// `.off`, `.stl` (binary, float).
///
/// All but STL hold the vertices to the last bit. STL takes the convex hull of the vertices rounded
/// to float, in triangles, so that it is closed and exactly convex too. Polygons of more than 255
/// vertices are split.
///
/// A planar hull is written as its two sides, a segment as two vertices and an edge (in `.off` no
/// more than their number says), a point as one vertex. STL cannot hold the latter two.
///
/// The file appears whole or not at all: it is written under a temporary name beside the target
/// and renamed.
/// @throws IoError if it cannot be written, the extension is not known or STL cannot hold it
WrittenMesh write_mesh(const std::filesystem::path& path, const HullMesh& mesh);

/// Appends to `data` what a file of the format (".ply") holds; the name stands in messages. OBJ
/// then is without materials.
WrittenMesh write_mesh(std::string& data, const std::string& name, const std::string& format,
                       const HullMesh& mesh);

}  // namespace taut
