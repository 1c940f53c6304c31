#version 430 compatibility
#pragma import_defines(IN_WEATHER, AIR_CUT, AIR_LAYER, GROUND_TEXTURE, TINTED, WIRE)
#include "air.glsl"
#ifdef GROUND_TEXTURE
#include "ground_colour.glsl"
#else
#include "light.glsl"
#endif
in vec3 relative;
in vec3 upward;
in vec2 post;
in vec2 ground;
#ifdef TINTED
flat in vec4 tint;
#endif
out vec4 fragment;
// A software rasteriser runs both sides of a branch and masks what each writes: what an image has not is not compiled.
void main() {
#ifdef GROUND_TEXTURE
  vec4 there = groundAt(post);
  vec3 colour = there.rgb;
  float light = there.a, detail = groundDetail(ground);
#else
  vec3 colour = vec3(0.45, 0.47, 0.36);
  float light = lightOn(upward), detail = 0.0;
#endif
  vec3 lit = min(colour * (light * 1.15), vec3(1.0));
#ifdef TINTED
  lit = mix(lit, tint.rgb * (0.25 + 0.75 * light), tint.a);
#endif
  lit *= 1.0 + detail;
#ifdef WIRE
  lit = vec3(0.05, 0.05, 0.08);
#endif
  fragment = vec4(throughAir(lit, hazeLeaves(relative), relative), 1.0);
}
