#include "ground_noise.h"
#include "ground_texture.h"

namespace trimtab::scene {

// Layers are tori: texel (c, r) of a level is at (c, r) modulo the side, so all levels have one origin.
//
// The level is what the footprint asks for, or what there is: level l reaches groundReach^-1 2^l texels of
// level 0 about the eye, and hands over to the next in the last 15 % of that. Both are told with the
// logarithm that the bits of a float are, which is wrong by less than a tenth. A software rasteriser pays for
// every instruction: with a reach of its own for every level this cost twice as much.
const char* const kGroundColour = R"(
uniform sampler2DArray groundTexels;
uniform bool groundThere;
uniform vec2 groundOrigin;       // texel of the eye's post
uniform float groundTexelsPerPost, groundShift;
uniform float groundReach, groundFinest, groundWhole, groundLast;

float roughLog2(float x) { return float(floatBitsToInt(x)) * (1.0 / 8388608.0) - 127.0; }

vec4 groundAt(vec2 post) {
  vec2 texel = post * groundTexelsPerPost + groundShift;
  vec2 across = dFdx(texel), up = dFdy(texel);
  // Where ground is seen along, its footprint is long and narrow: between the two, so that it neither blurs
  // nor shimmers much.
  float area = abs(across.x * up.y - across.y * up.x);
  float wanted = 0.5 * roughLog2(max(area, max(dot(across, across), dot(up, up)) * (1.0 / 16.0)));
  vec2 off = abs(texel);
  float away = roughLog2(max(off.x, off.y) * groundReach);
  float ended = floor(away);
  float there = ended + 1.0 + max((away - ended - 0.7) * (1.0 / 0.3), 0.0);
  float level = clamp(max(wanted, min(there, groundWhole)), groundFinest, groundLast);
  float fine = floor(level);
  vec2 place = (texel + groundOrigin) * intBitsToFloat((127 - 10 - int(fine)) << 23);  // by 2^-fine / 1024
  vec4 ground = mix(texture(groundTexels, vec3(place, fine)), texture(groundTexels, vec3(place * 0.5, fine + 1.0)), level - fine);
  return ground * vec4(1.0, 1.0, 1.0, 1.5);
}
)" TRIMTAB_GROUND_NOISE;

}  // namespace trimtab::scene
