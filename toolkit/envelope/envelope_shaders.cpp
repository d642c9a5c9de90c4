#include "taut/envelope/envelope_shaders.h"

namespace taut {

const char* const vertex_shader = R"(#version 330 core
layout(location = 0) in vec2 place;
layout(location = 1) in vec3 point_in;
layout(location = 2) in vec2 b_in;
layout(location = 3) in vec3 bend_in;
layout(location = 4) in uvec2 name_in;
uniform float extent;
out vec3 point;
out vec2 b;
flat out vec3 bend;
flat out uvec2 name;
void main() {
  gl_Position = vec4(place / extent, 0.0, 1.0);
  point = point_in;
  b = b_in;
  bend = bend_in;
  name = name_in;
}
)";

// The direction is the pixel's own, not interpolated. Errors of interpolated points are tangential
// to first order, so that they change values to second order only.
const char* const fragment_shader = R"(#version 330 core
in vec3 point;
in vec2 b;
flat in vec3 bend;
flat in uvec2 name;
layout(location = 0) out uvec2 name_out;
uniform float size;
uniform float pole;
uniform float reach;
uniform float extent;
uniform int second;
uniform usampler2D first_names;
void main() {
  if (second != 0 && texelFetch(first_names, ivec2(gl_FragCoord.xy), 0).x == name.x) discard;
  vec2 p = extent * (2.0 * gl_FragCoord.xy / size - 1.0);
  float r2 = dot(p, p);
  vec3 n = vec3(2.0 * p, pole * (1.0 - r2)) / (1.0 + r2);
  float b2 = 1.0 - b.x - b.y;
  float value = dot(point, n) +
                0.5 * (b.x * b.y * bend.x + b.y * b2 * bend.y + b2 * b.x * bend.z);
  gl_FragDepth = (reach - value) / (2.0 * reach);
  name_out = name;
}
)";

}  // namespace taut
