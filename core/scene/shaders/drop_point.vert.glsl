#version 430 compatibility
#include "drop.glsl"
void main() {
  vec3 p = dropInEye();
  float metres = length(p);
  float pixels = 2.0 * radius * pixelsPerMetre / metres;
  gl_PointSize = max(1.0, ceil(pixels));
  corner = vec2(0.0);
  strength = seenAt(metres) * smeared(2.0 * radius) * min(1.0, pixels / gl_PointSize);
  gl_Position = gl_ProjectionMatrix * vec4(p, 1.0);
}
