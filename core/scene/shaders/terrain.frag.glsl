#version 430 compatibility
#pragma import_defines(IN_WEATHER, AIR_CUT, AIR_LAYER)
#include "air.glsl"
#include "ground_noise.glsl"
in vec3 lit;
in float clearness;
in vec3 relative;
in vec2 ground;
uniform bool wire;
#ifdef STATIC_TREE
#include "texture_squares.glsl"
in vec2 inTexture;
uniform bool textureSquares;
#endif
out vec4 fragment;

void main() {
  float detail = wire ? 0.0 : groundDetail(ground);
  vec3 shown = lit * (1.0 + detail);
#ifdef STATIC_TREE
  if (textureSquares && !wire) shown *= textureSquare(inTexture);
#endif
  fragment = vec4(throughAir(shown, clearness, relative), 1.0);
}
