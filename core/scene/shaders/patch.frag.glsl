#version 430 compatibility
#pragma import_defines(IN_WEATHER, AIR_CUT, AIR_LAYER)
#include "air.glsl"
#include "ground_colour.glsl"
#include "light.glsl"
in vec3 relative;
in vec3 upward;
in vec2 post;
in vec2 ground;
flat in vec4 tint;
uniform float hazeDistance;
uniform bool wire;
out vec4 fragment;
void main() {
  vec3 lit = vec3(0.05, 0.05, 0.08);
  if (!wire) {
    vec3 colour = vec3(0.45, 0.47, 0.36);
    float light, detail = 0.0;
    if (groundThere) {
      vec4 there = groundAt(post);
      colour = there.rgb;
      light = there.a;
      detail = groundDetail(ground);
    } else {
      light = lightOn(upward);
    }
    lit = min(colour * light * 1.15, vec3(1.0));
    lit = mix(lit, tint.rgb * (0.25 + 0.75 * light), tint.a) * (1.0 + detail);
  }
  fragment = vec4(throughAir(lit, exp(-length(relative) / hazeDistance), relative), 1.0);
}
