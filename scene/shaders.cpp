#include "trimtab/scene/shaders.h"

namespace trimtab::scene {

const char* const kTerrainVertex = R"(#version 430 compatibility
)" TRIMTAB_RELATIVE_POSITION R"(
in vec3 vertexPosition;
in vec3 vertexNormal;
in vec4 vertexColour;
uniform vec3 sun;          // unit, towards it
uniform float hazeDistance;
uniform bool tinted;
uniform bool wire;
uniform samplerBuffer tints;
out vec3 lit;
out float clearness;       // what the air leaves of it
out vec2 ground;           // metres east and north, modulo 8192 from tile to tile
void main() {
  int tile = gl_VertexID / 1089;
  ivec4 slot = texelFetch(slots, tile * 2);
  vec3 p = relativePosition(vertexPosition, slot);
  float light = 0.30 + 0.12 * vertexNormal.z + 1.05 * max(dot(normalize(vertexNormal), sun), 0.0);
  lit = min(vertexColour.rgb * light * 1.15, vec3(1.0));
  if (tinted) {
    vec4 tint = texelFetch(tints, tile);
    lit = mix(lit, tint.rgb * (0.25 + 0.75 * light), tint.a);
  }
  clearness = exp(-length(p) / hazeDistance);
  ground = vertexPosition.xy + vec2(slot.xy & 511) * 16.0;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
  if (wire) {
    lit = vec3(0.05, 0.05, 0.08);
    gl_Position.z *= 1.002;  // nearer, as depth is reversed
  }
}
)";

// Land between posts is no even colour: two octaves of noise that stand on the ground. Each fades out before
// its cells are smaller than two pixels, so that nothing shimmers. The lattice repeats every 8,192 m, as
// `ground` does.
const char* const kTerrainFragment = R"(#version 430 compatibility
in vec3 lit;
in float clearness;
in vec2 ground;
uniform vec3 haze;         // sRGB
uniform bool wire;
out vec4 fragment;

float random(ivec2 cell) {
  uint h = uint(cell.x) * 374761393u + uint(cell.y) * 668265263u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return float((h ^ (h >> 16)) & 65535u) * (2.0 / 65535.0) - 1.0;
}

float noise(vec2 p, int period) {
  vec2 whole = floor(p);
  vec2 t = p - whole;
  t = t * t * (3.0 - 2.0 * t);
  ivec2 low = ivec2(whole) & (period - 1), high = (ivec2(whole) + 1) & (period - 1);
  return mix(mix(random(low), random(ivec2(high.x, low.y)), t.x), mix(random(ivec2(low.x, high.y)), random(high), t.x), t.y);
}

void main() {
  vec2 footprint = fwidth(ground);
  float widest = max(footprint.x, footprint.y);
  float detail = 0.0;
  float coarse = clamp(1.5 - widest * (3.0 / 128.0), 0.0, 1.0), fine = clamp(1.5 - widest * (3.0 / 32.0), 0.0, 1.0);
  if (coarse > 0.0) detail += 0.11 * coarse * noise(ground * (1.0 / 128.0), 64);
  if (fine > 0.0) detail += 0.09 * fine * noise(ground * (1.0 / 32.0), 256);
  if (wire) detail = 0.0;
  fragment = vec4(mix(haze, lit * (1.0 + detail), clearness), 1.0);
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
  fragment = vec4(mix(haze * 0.94, sky, clamp(elevation * 200.0 + 0.5, 0.0, 1.0)), 1.0);
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

const char* const kLineFragment = R"(#version 430 compatibility
in vec4 colour;
out vec4 fragment;
void main() { fragment = colour; }
)";

}  // namespace trimtab::scene
