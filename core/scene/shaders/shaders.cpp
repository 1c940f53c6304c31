#include "shaders.h"

#include "core/scene/passes/weather_air.h"
#include "core/scene/terrain/ground/ground_noise.h"
#include "patch_shaders.h"

namespace trimtab::scene {

namespace {

const char* const kTerrainVertex = R"(#version 430 compatibility
)" TRIMTAB_RELATIVE_POSITION R"(
in vec3 vertexPosition;
in vec3 vertexNormal;
in vec4 vertexColour;
uniform vec3 sun;          // unit, towards it
uniform float hazeDistance;
uniform bool tinted;
uniform bool wire;
uniform float inGuardBand;
#ifdef STATIC_TREE
layout(location = 5) in vec4 treeTint;
#else
uniform samplerBuffer tints;
#endif
out vec3 lit;
out float clearness;       // what the air leaves of it
out vec2 ground;           // metres east and north, modulo 8192 from tile to tile
#ifdef NODE_IDS
#ifdef STATIC_TREE
layout(location = 4) in uint treeNode;
#endif
flat out uint owner;
#endif
// The node pass must cover the picture's pixels at the picture's depths, to the bit.
invariant gl_Position;
void main() {
#ifdef STATIC_TREE
  ivec4 slot = texelFetch(slots, gl_VertexID / 64);
#else
  int tile = gl_VertexID / 1089;
  ivec4 slot = texelFetch(slots, tile * 2);
#endif
#ifdef NODE_IDS
#ifdef STATIC_TREE
  owner = treeNode;
#else
  owner = uint(slot.w);
#endif
#endif
  vec3 p = relativePosition(vertexPosition, slot);
  float light = 0.30 + 0.12 * vertexNormal.z + 1.05 * max(dot(normalize(vertexNormal), sun), 0.0);
  lit = min(vertexColour.rgb * light * 1.15, vec3(1.0));
  if (tinted) {
#ifdef STATIC_TREE
    vec4 tint = treeTint;
#else
    vec4 tint = texelFetch(tints, tile);
#endif
    lit = mix(lit, tint.rgb * (0.25 + 0.75 * light), tint.a);
  }
  clearness = exp(-length(p) / hazeDistance);
  ground = vertexPosition.xy + vec2(slot.xy & 511) * 16.0;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
  if (wire) {
    lit = vec3(0.05, 0.05, 0.08);
    gl_Position.z *= 1.002;  // nearer, as depth is reversed
  }
  gl_Position.xy *= inGuardBand;
}
)";

const char* const kTerrainFragment = R"(#version 430 compatibility
#pragma import_defines(IN_WEATHER)
)" TRIMTAB_AIR TRIMTAB_GROUND_NOISE R"(
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
)";

}  // namespace

// What the weather's far cut takes away is no node's.
const char* const kNodeFragment = R"(#version 430 compatibility
#pragma import_defines(IN_WEATHER)
)" TRIMTAB_AIR R"(
flat in uint owner;
out uint node;
void main() {
  throughAir(vec3(0.0));
  node = owner;
}
)";

// One triangle over the picture at reversed depth 0, infinitely far: it fills what nothing else did.
const char* const kScreenVertex = R"(#version 430 compatibility
uniform vec4 tangents;     // left, right, bottom, top
out vec3 direction;        // eye axes
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2, gl_VertexID & 2);
  direction = vec3(mix(tangents.xz, tangents.yw, corner), -1.0);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
)";

const char* const kSkyFragment = R"(#version 430 compatibility
#pragma import_defines(IN_WEATHER)
#ifdef IN_WEATHER
uniform vec3 fog;          // sRGB
uniform vec3 air;          // extinction a metre first
uniform vec2 fogDepth;     // metres up to where it is clear, metres down to the ground
#endif
in vec3 direction;
uniform vec3 upInEye;
uniform vec3 haze;
uniform float dip;         // of the earth's horizon, its sine
out vec4 fragment;
void main() {
  // A rational ramp and no trigonometry: a software rasteriser pays for every pixel of it.
  float elevation = dot(direction, upInEye) * inversesqrt(dot(direction, direction)) + dip;
  float above = max(elevation, 0.0) * 3.0;
  vec3 sky = mix(haze, vec3(0.20, 0.40, 0.72), above / (above + 0.6));
  vec3 colour = mix(haze * 0.94, sky, clamp(elevation * 200.0 + 0.5, 0.0, 1.0));
#ifdef IN_WEATHER
  // Level, the way through fog has no end: the sky meets the ground in fog alone.
  float metres = (elevation > 0.0 ? fogDepth.x : fogDepth.y) / max(abs(elevation), 1e-5);
  colour = mix(fog, colour, exp(-air.x * metres));
#endif
  fragment = vec4(colour, 1.0);
}
)";

const char* const kLineVertex = R"(#version 430 compatibility
in vec3 vertexPosition;
in vec4 vertexColour;
out vec4 colour;
void main() {
  colour = vertexColour;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(vertexPosition, 1.0);
  gl_Position.z *= 1.002;
}
)";

// Document E's picture: one colour, no light, no air.
const char* const kTreeFlatVertex = R"(#version 430 compatibility
)" TRIMTAB_RELATIVE_POSITION R"(
in vec3 vertexPosition;
uniform vec4 flatColour;
uniform float depthScale;  // more than 1 is nearer, as depth is reversed
out vec4 colour;
void main() {
  colour = flatColour;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(relativePosition(vertexPosition, texelFetch(slots, gl_VertexID / 64)), 1.0);
  gl_Position.z *= depthScale;
}
)";

const char* const kLineFragment = R"(#version 430 compatibility
in vec4 colour;
out vec4 fragment;
void main() { fragment = colour; }
)";

namespace {

std::string withDefine(std::string shader, const char* name) {
  const std::size_t afterVersion = shader.find('\n') + 1;
  return shader.insert(afterVersion, std::string("#define ") + name + " 1\n");
}

}  // namespace

TerrainShaders terrainShaders(TerrainForm form) {
  if (form == TerrainForm::patches) return patchShaders();
  return {form == TerrainForm::static_trees ? withDefine(kTerrainVertex, "STATIC_TREE") : kTerrainVertex,
          kTerrainFragment};
}

std::string forNodes(std::string vertexShader) {
  return withDefine(std::move(vertexShader), "NODE_IDS");
}

}  // namespace trimtab::scene
