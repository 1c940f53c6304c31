#include "trimtab/scene/ground_texture.h"

namespace trimtab::scene {

// Layers are tori: texel (c, r) of a level is at (c, r) modulo the side, so a layer's address of the eye's
// post is a fraction of a whole number by a power of two, which floats hold exactly, and the rest is small.
//
// `groundReach`: how far about the eye each level is there, as slope and offset of a ramp that is 0 up to
// most of that distance and 1 from it on. Their sum is the finest level to be had, and rises smoothly where
// one ends.
const char* const kGroundColour = R"(
uniform sampler2DArray groundTexels;
uniform sampler2D groundNoise;
uniform bool groundThere;
uniform vec2 groundOrigin;       // texel of the eye's post
uniform float groundTexelsPerPost, groundShift, groundLast;
uniform vec4 groundSlope[4], groundOffset[4];

vec4 groundLayer(vec2 texel, float level) {
  float scale = uintBitsToFloat(uint(127 - 10 - int(level)) << 23);  // 2^-level / 1024
  return texture(groundTexels, vec3(texel * scale + fract(groundOrigin * scale), level));
}

vec4 groundAt(vec2 post) {
  vec2 texel = post * groundTexelsPerPost + groundShift;
  vec2 x = dFdx(texel), y = dFdy(texel);
  float xx = dot(x, x), yy = dot(y, y), longest = max(xx, yy);
  // Where ground is seen along, its footprint is long and narrow: between the two, so that neither blurs or
  // shimmers much.
  float area = x.x * y.y - x.y * y.x;
  float wanted = 0.5 * log2(max(max(abs(area), longest * (1.0 / 16.0)), 1.0));
  vec2 off = abs(texel);
  float away = max(off.x, off.y);
  vec4 there = clamp(groundSlope[0] * away + groundOffset[0], 0.0, 1.0);
  there += clamp(groundSlope[1] * away + groundOffset[1], 0.0, 1.0);
  there += clamp(groundSlope[2] * away + groundOffset[2], 0.0, 1.0);
  there += clamp(groundSlope[3] * away + groundOffset[3], 0.0, 1.0);
  float level = min(max(wanted, dot(there, vec4(1.0))), groundLast);
  float fine = floor(level);
  vec4 ground = mix(groundLayer(texel, fine), groundLayer(texel, min(fine + 1.0, groundLast)), level - fine);
  return ground * vec4(1.0, 1.0, 1.0, 1.5);
}

float groundDetail(vec2 metres) {
  return texture(groundNoise, metres * (1.0 / 8192.0)).r * 0.5 - 0.25;
}
)";

}  // namespace trimtab::scene
