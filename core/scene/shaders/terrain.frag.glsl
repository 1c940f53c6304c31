#version 430 compatibility
#pragma import_defines(IN_WEATHER, AIR_CUT, AIR_LAYER, WIRE)
#include "air.glsl"
#include "ground_noise.glsl"
in vec3 lit;
in float clearness;
in vec3 relative;
in vec2 ground;
#ifdef STATIC_TREE
#include "texture_squares.glsl"
in vec2 inTexture;
uniform bool textureSquares;
#endif
out vec4 fragment;

void main() {
#ifdef WIRE
  vec3 shown = lit;
#else
  vec3 shown = lit * (1.0 + groundDetail(ground));
#ifdef STATIC_TREE
  if (textureSquares) shown *= textureSquare(inTexture);
#endif
#endif
#ifdef IN_WEATHER
  // Weather needs `relative`, from which the haze follows too. With `clearness` instead there would be nine varying
  // floats, and a software rasteriser prepares them by fours for each triangle.
  fragment = vec4(throughAir(shown, hazeLeaves(relative), relative), 1.0);
#else
  fragment = vec4(throughAir(shown, clearness, relative), 1.0);
#endif
}
