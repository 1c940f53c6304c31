#version 430 compatibility
#include "drop.glsl"
void main() {
  vec3 p = dropInEye();
  float metres = length(p);
  corner = vec2(0.0, gl_MultiTexCoord0.y * 2.0 - 1.0);
  strength = seenAt(metres) * smeared(2.0 * radius) * min(1.0, 2.0 * radius * pixelsPerMetre / metres);
  gl_Position = gl_ProjectionMatrix * vec4(p + streak * gl_MultiTexCoord0.y, 1.0);
}
