#include "weather_shaders.h"

// gl_Vertex: the place in a unit cell. gl_MultiTexCoord0: the corner. gl_MultiTexCoord1.x: seconds, from
// which each cell has a pattern of its own; whole multiples, so that its wrap from 1 to 0 moves nothing. The
// cell's z points down. What is narrower than a pixel is drawn a pixel wide and fainter, or it would flicker.
#define TRIMTAB_DROP                                                                                      \
  "uniform float inversePeriod;\n"                                                                        \
  "uniform float phase;\n"          /* of the fall through a cell, 0..1 */                                \
  "uniform float radius;\n"         /* metres */                                                          \
  "uniform vec3 streak;\n"          /* eye axes, metres: from a drop back to where it was */              \
  "uniform float pixelsPerMetre;\n" /* at 1 m */                                                          \
  "uniform float farM;\n"                                                                                 \
  "uniform float extinction;\n"                                                                           \
  "out vec2 corner;\n"                                                                                    \
  "out float strength;\n"                                                                                 \
  "vec3 dropInEye() {\n"                                                                                  \
  "  float own = gl_MultiTexCoord1.x * inversePeriod;\n"                                                  \
  "  vec3 inCell = vec3(fract(gl_Vertex.xy + own * vec2(7.0, 3.0)), fract(phase - own - gl_Vertex.z));\n" \
  "  return (gl_ModelViewMatrix * vec4(inCell, 1.0)).xyz;\n"                                              \
  "}\n"                                                                                                   \
  "float seenAt(float metres) {\n"                                                                        \
  "  return exp(-extinction * metres) * smoothstep(0.3, 1.5, metres) *\n"                                 \
  "         (1.0 - smoothstep(0.75 * farM, farM, metres));\n"                                             \
  "}\n"                                                                                                   \
  "float smeared(float size) { return 0.1 + 0.9 * size / (size + length(streak)); }\n"

namespace trimtab::scene {

const char* const kDropQuadVertex = R"(#version 430 compatibility
)" TRIMTAB_DROP R"(
void main() {
  vec3 p = dropInEye();
  float metres = length(p);
  float half_ = max(radius, 0.8 * metres / pixelsPerMetre);
  float long_ = length(streak);
  vec3 axis = long_ > 1e-4 ? streak / long_ : vec3(0.0, 1.0, 0.0);
  vec3 side = cross(axis, p);
  side = dot(side, side) > 1e-8 ? normalize(side) : vec3(1.0, 0.0, 0.0);
  corner = gl_MultiTexCoord0.xy * 2.0 - 1.0;
  vec3 v = p + streak * gl_MultiTexCoord0.y + axis * half_ * corner.y + side * half_ * corner.x;
  strength = seenAt(metres) * smeared(2.0 * radius) * radius / half_;
  gl_Position = gl_ProjectionMatrix * vec4(v, 1.0);
}
)";

const char* const kDropLineVertex = R"(#version 430 compatibility
)" TRIMTAB_DROP R"(
void main() {
  vec3 p = dropInEye();
  float metres = length(p);
  corner = vec2(0.0, gl_MultiTexCoord0.y * 2.0 - 1.0);
  strength = seenAt(metres) * smeared(2.0 * radius) * min(1.0, 2.0 * radius * pixelsPerMetre / metres);
  gl_Position = gl_ProjectionMatrix * vec4(p + streak * gl_MultiTexCoord0.y, 1.0);
}
)";

const char* const kDropPointVertex = R"(#version 430 compatibility
)" TRIMTAB_DROP R"(
void main() {
  vec3 p = dropInEye();
  float metres = length(p);
  float pixels = 2.0 * radius * pixelsPerMetre / metres;
  gl_PointSize = max(1.0, ceil(pixels));
  corner = vec2(0.0);
  strength = seenAt(metres) * smeared(2.0 * radius) * min(1.0, pixels / gl_PointSize);
  gl_Position = gl_ProjectionMatrix * vec4(p, 1.0);
}
)";

const char* const kDropFragment = R"(#version 430 compatibility
in vec2 corner;
in float strength;
uniform vec3 dropColour;   // sRGB
out vec4 fragment;
void main() {
  float square = dot(corner, corner);
  fragment = vec4(dropColour, strength * max(0.0, 1.0 - square * square));
}
)";

}  // namespace trimtab::scene
