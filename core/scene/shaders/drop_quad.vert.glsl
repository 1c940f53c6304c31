#version 430 compatibility
#include "drop.glsl"
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
