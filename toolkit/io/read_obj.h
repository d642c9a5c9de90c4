#pragma once

#include <filesystem>

#include "taut/core/progress.h"
#include "taut/surface/model.h"

namespace taut {

/// Reads the free-form surfaces and curves of a Wavefront OBJ file: Bezier (one or several pieces)
/// and B-spline, rational or not, each over the range of parameters that its statement names.
///
/// A surface is a face, a curve an edge, both named after the group or object that they stand in.
/// Polygons, curves in parameter space and statements that are not known are left out with a
/// warning; trimmed surfaces and other bases are refused.
///
/// Source: Alias|Wavefront, "Advanced Visualizer", appendix B1 "Object files" (3.0).
/// @throws as read_model()
Part read_obj(const std::filesystem::path& path, const Progress& progress);

}  // namespace taut
