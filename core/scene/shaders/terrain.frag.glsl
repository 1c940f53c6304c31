#version 430 compatibility
#pragma import_defines(IN_WEATHER)
#include "air.glsl"
#include "ground_noise.glsl"
in vec3 lit;
in float clearness;
in vec2 ground;
uniform vec3 haze;         // sRGB
uniform bool wire;
out vec4 fragment;

void main() {
  float detail = wire ? 0.0 : groundDetail(ground);
  fragment = vec4(throughAir(mix(haze, lit * (1.0 + detail), clearness)), 1.0);
}
