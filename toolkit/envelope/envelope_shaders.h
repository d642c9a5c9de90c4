#pragma once

namespace taut {

/// The programs of OpenGL (GLSL 3.30) that draw triangles of the upper envelope: their vertices are
/// OffscreenCanvas::Vertex, their results a depth and two unsigned integers.
extern const char* const vertex_shader;
extern const char* const fragment_shader;

}  // namespace taut
