#include "patch_shaders.h"

#include "core/scene/passes/weather_air.h"
#include "core/scene/terrain/ground/ground_texture.h"

namespace trimtab::scene {
namespace {

const char* const kVertex = R"(#version 430 compatibility
)" TRIMTAB_RELATIVE_POSITION R"(
in vec3 vertexPosition;
in vec3 vertexNormal;
in vec2 vertexPost;
uniform samplerBuffer tints;
uniform bool tinted;
uniform bool wire;
uniform float inGuardBand;
uniform ivec2 eyePost;     // column and row
out vec3 relative;         // metres from the eye
out vec3 upward;
out vec2 post;             // columns and rows from eyePost
out vec2 ground;           // metres east and north, modulo 8192 from patch to patch
flat out vec4 tint;
#ifdef NODE_IDS
flat out uint owner;
#endif
// The node pass must cover the picture's pixels at the picture's depths, to the bit.
invariant gl_Position;
void main() {
  int block = gl_VertexID / 32;
  ivec4 slot = texelFetch(slots, block * 2);
  ivec2 square = texelFetch(slots, block * 2 + 1).xy;
#ifdef NODE_IDS
  owner = uint(slot.w);
#endif
  vec3 p = relativePosition(vertexPosition, slot);
  relative = p;
  upward = vertexNormal;
  // In whole numbers first: as floats, posts of a country are no longer told apart.
  post = vec2(square - eyePost) + vertexPost;
  ground = vertexPosition.xy + vec2(slot.xy & 511) * 16.0;
  tint = tinted ? texelFetch(tints, block) : vec4(0.0);
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
  if (wire) gl_Position.z *= 1.002;  // nearer, as depth is reversed
  gl_Position.xy *= inGuardBand;
}
)";

const char* const kFragmentStart = R"(#version 430 compatibility
#pragma import_defines(IN_WEATHER)
)" TRIMTAB_AIR;

const char* const kFragment = R"(
in vec3 relative;
in vec3 upward;
in vec2 post;
in vec2 ground;
flat in vec4 tint;
uniform vec3 sun;          // unit, towards it
uniform vec3 haze;         // sRGB
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
      light = 0.30 + 0.12 * upward.z + 1.05 * max(dot(normalize(upward), sun), 0.0);
    }
    lit = min(colour * light * 1.15, vec3(1.0));
    lit = mix(lit, tint.rgb * (0.25 + 0.75 * light), tint.a) * (1.0 + detail);
  }
  fragment = vec4(throughAir(mix(haze, lit, exp(-length(relative) / hazeDistance))), 1.0);
}
)";

}  // namespace

TerrainShaders patchShaders() {
  return {kVertex, std::string(kFragmentStart) + kGroundColour + kFragment};
}

}  // namespace trimtab::scene
