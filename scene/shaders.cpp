#include "trimtab/scene/shaders.h"

namespace trimtab::scene {

const char* const kTerrainVertex = R"(#version 430 compatibility
)" TRIMTAB_RELATIVE_POSITION R"(
in vec3 vertexPosition;
in vec3 vertexNormal;
in vec4 vertexColour;
uniform vec3 sun;          // unit, towards it
uniform vec3 haze;         // sRGB
uniform vec3 up;           // unit, at the eye
uniform float hazeDistance;
uniform bool tinted;
uniform bool wire;
uniform samplerBuffer tints;
out vec3 colour;
void main() {
  int tile = gl_VertexID / 1089;
  vec3 p = relativePosition(vertexPosition, texelFetch(slots, tile * 2));
  float light = 0.42 + 0.14 * vertexNormal.z + 0.78 * max(dot(normalize(vertexNormal), sun), 0.0);
  vec3 lit = min(vertexColour.rgb * light * 1.15, vec3(1.0));
  if (tinted) {
    vec4 tint = texelFetch(tints, tile);
    lit = mix(lit, tint.rgb * (0.25 + 0.75 * light), tint.a);
  }
  colour = mix(haze, lit, exp(-length(p) / hazeDistance));
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
  if (wire) {
    colour = vec3(0.05, 0.05, 0.08);
    gl_Position.z *= 1.002;  // nearer, as depth is reversed
  }
}
)";

const char* const kTerrainFragment = R"(#version 430 compatibility
in vec3 colour;
out vec4 fragment;
void main() { fragment = vec4(colour, 1.0); }
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
