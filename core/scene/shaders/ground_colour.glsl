// `vec4 groundAt(vec2 post)` returns the ground's sRGB colour and the light on it. `post` counts columns and
// rows from the post under the eye, so that it is exact near the eye. Call it in uniform control flow, because
// it uses derivatives.
//
// Layers are tori: texel (c, r) of a level is at (c, r) modulo the side, so all levels share one origin.
//
// The level drawn is the coarser of what the footprint asks for and what is loaded. Level l reaches
// 2^l / groundReach texels of level 0 from the eye, and blends into the next level over the last 15 % of that.
// The bits of a positive float, read as an integer, are its logarithm times 2^23 plus kBias, with an error below
// a tenth. Levels keep that form, because a software rasteriser pays for every instruction: as floats they took
// a twelfth of the whole shader, and with a separate reach per level it cost twice as much.
#include "ground_noise.glsl"
uniform sampler2DArray groundTexels;
uniform vec2 groundOrigin;       // texel of the post under the eye
uniform float groundTexelsPerPost, groundShift;
uniform float groundReach;
uniform int groundFinest, groundWhole, groundLast;  // levels times 2^23 plus kBias
uniform int groundCoarser;  // levels times 2^23, by which the LOD scale shrinks the texture, also where it is magnified
const int kOneLevel = 1 << 23, kBias = 127 << 23;

vec4 groundAt(vec2 post) {
  vec2 texel = post * groundTexelsPerPost + groundShift;
  vec2 across = dFdx(texel), up = dFdy(texel);
  // At a grazing angle the footprint is long and narrow. The level lies between what its two sides ask for,
  // so that the ground neither blurs nor shimmers much.
  float area = abs(across.x * up.y - across.y * up.x);
  float square = max(area, max(dot(across, across), dot(up, up)) * (1.0 / 16.0));
  int wanted = (floatBitsToInt(square) >> 1) + (kBias >> 1);
  vec2 off = abs(texel);
  int away = floatBitsToInt(max(off.x, off.y) * groundReach);
  int over = away & (kOneLevel - 1);
  int there = away - over + kOneLevel + max(over - kOneLevel / 10 * 7, 0) / 3 * 10;
  int level = min(max(max(wanted, min(there, groundWhole)), groundFinest) + groundCoarser, groundLast);
  int fine = level >> 23;
  vec2 place = (texel + groundOrigin) * intBitsToFloat(2 * kBias - (GROUND_SIDE_BITS << 23) - (fine << 23));  // 2^-fine / side
  float layer = float(fine - 127);
  float part = float(level & (kOneLevel - 1)) * (1.0 / float(kOneLevel));
  vec4 ground = mix(texture(groundTexels, vec3(place, layer)), texture(groundTexels, vec3(place * 0.5, layer + 1.0)), part);
  return ground * vec4(1.0, 1.0, 1.0, MOST_LIGHT);
}
