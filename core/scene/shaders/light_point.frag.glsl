#version 430 compatibility
#pragma import_defines(IN_WEATHER, AIR_CUT, AIR_LAYER)
#include "air.glsl"
in vec2 corner;
flat in vec3 shown;
flat in vec3 relative;
out vec4 fragment;
void main() {
  if (dot(corner, corner) > 1.0) discard;
  fragment = vec4(throughAir(shown, hazeLeaves(relative), relative), 1.0);
}
