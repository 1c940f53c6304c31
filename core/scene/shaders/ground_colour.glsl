// `vec4 groundAt(vec2 post)` returns the ground's sRGB colour and the light on it. `post` counts columns and
// rows from the post under the eye, so that it is exact near the eye. Call it in uniform control flow, because
// it uses derivatives, and only where `groundThere`.
//
// Layers are tori: texel (c, r) of a level is at (c, r) modulo the side, so all levels share one origin.
//
// The level drawn is the coarser of what the footprint asks for and what is loaded. Level l reaches
// 2^l / groundReach texels of level 0 from the eye, and blends into the next level over the last 15 % of that.
// Both use a logarithm read from the bits of a float, with an error below a tenth, because a software
// rasteriser pays for every instruction: with a separate reach per level this cost twice as much.
#include "ground_noise.glsl"
uniform sampler2DArray groundTexels;
uniform bool groundThere;
uniform vec2 groundOrigin;       // texel of the post under the eye
uniform float groundTexelsPerPost, groundShift;
uniform float groundReach, groundFinest, groundWhole, groundLast;
uniform float groundCoarser;  // levels by which the LOD scale shrinks the texture, also where it is magnified

float roughLog2(float x) { return float(floatBitsToInt(x)) * (1.0 / 8388608.0) - 127.0; }

vec4 groundAt(vec2 post) {
  vec2 texel = post * groundTexelsPerPost + groundShift;
  vec2 across = dFdx(texel), up = dFdy(texel);
  // At a grazing angle the footprint is long and narrow. The level lies between what its two sides ask for,
  // so that the ground neither blurs nor shimmers much.
  float area = abs(across.x * up.y - across.y * up.x);
  float wanted = 0.5 * roughLog2(max(area, max(dot(across, across), dot(up, up)) * (1.0 / 16.0)));
  vec2 off = abs(texel);
  float away = roughLog2(max(off.x, off.y) * groundReach);
  float ended = floor(away);
  float there = ended + 1.0 + max((away - ended - 0.7) * (1.0 / 0.3), 0.0);
  float level = min(max(max(wanted, min(there, groundWhole)), groundFinest) + groundCoarser, groundLast);
  float fine = floor(level);
  vec2 place = (texel + groundOrigin) * intBitsToFloat((127 - GROUND_SIDE_BITS - int(fine)) << 23);  // 2^-fine / side
  vec4 ground = mix(texture(groundTexels, vec3(place, fine)), texture(groundTexels, vec3(place * 0.5, fine + 1.0)), level - fine);
  return ground * vec4(1.0, 1.0, 1.0, MOST_LIGHT);
}
