#pragma once

#include <filesystem>
#include <vector>

#include "taut/bounds/scene.h"
#include "taut/hull/result/hull_boundary.h"
#include "taut/hull/result/hull_mesh.h"

namespace taut {

/// Points along a curve, in model coordinates.
using Polyline = std::vector<dvec3>;

/// The curves of an exact hull.
std::vector<Polyline> hull_curves(const SceneFrame& frame, const HullBoundary& boundary);
/// Of these, those about its tolerant faces (HullFace::tolerant).
std::vector<Polyline> tolerant_curves(const SceneFrame& frame, const HullBoundary& boundary);
/// The edges of a mesh that separate hull faces, one polyline each.
std::vector<Polyline> hull_curves(const HullMesh& mesh);

/// The files that write_project() makes of NAME.mlp: NAME-hull.ply, NAME-curves.ply,
/// NAME-model.ply, NAME-tolerant.ply and NAME.mlp.
std::vector<std::filesystem::path> project_files(const std::filesystem::path& path);

/// Writes a MeshLab project of layers in files beside it that it names relative to itself: the hull
/// as write_mesh() has it, its curves as edges, the model as triangles on a modest grid (free
/// curves as edges, points alone as they are; trimmed faces untrimmed), and the curves about
/// tolerant faces. A hull without curves has no layer of them, one without tolerant faces none of
/// those about them.
///
/// The files appear all, or none does; returns them, the project last.
/// @throws IoError if one of them cannot be written
std::vector<std::filesystem::path> write_project(const std::filesystem::path& path,
                                                 const HullMesh& mesh,
                                                 const std::vector<Polyline>& curves,
                                                 const Model& model,
                                                 const std::vector<Polyline>& tolerant = {});

}  // namespace taut
