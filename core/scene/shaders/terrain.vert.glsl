#version 430 compatibility
#pragma import_defines(TINTED, WIRE)
#include "light.glsl"
#include "on_grid.glsl"
#include "relative_position.glsl"
in vec3 vertexPosition;
in vec3 vertexNormal;
in vec4 vertexColour;
uniform float inGuardBand;
#ifdef STATIC_TREE
layout(location = 2) in vec2 treeTexture;
layout(location = 5) in vec4 treeTint;
#else
uniform samplerBuffer tints;
#endif
out vec3 lit;
out float clearness;       // share of `lit` that haze leaves
out vec3 relative;         // metres from the eye
out vec2 ground;           // groundMetres
#ifdef STATIC_TREE
out vec2 inTexture;        // in units of the material's texture
#endif
#ifdef NODE_IDS
#ifdef STATIC_TREE
layout(location = 4) in uint treeNode;
#endif
flat out uint owner;
#endif
// The node pass must cover the same pixels at the same depths as the image, to the bit.
invariant gl_Position;
void main() {
#ifdef STATIC_TREE
  ivec4 slot = texelFetch(slots, gl_VertexID / TREE_BLOCK);
  inTexture = treeTexture;
#else
  int tile = gl_VertexID / TILE_VERTICES;
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
  float light = lightOn(vertexNormal);
  lit = min(vertexColour.rgb * light * 1.15, vec3(1.0));
#ifdef TINTED
#ifdef STATIC_TREE
  vec4 tint = treeTint;
#else
  vec4 tint = texelFetch(tints, tile);
#endif
  lit = mix(lit, tint.rgb * (0.25 + 0.75 * light), tint.a);
#endif
  relative = p;
  clearness = exp(-length(p) * (1.0 / HAZE_DISTANCE));
  ground = groundMetres(vertexPosition, slot);
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
#ifdef WIRE
  lit = vec3(0.05, 0.05, 0.08);
  gl_Position.z *= 1.002;  // nearer, as depth is reversed
#endif
  gl_Position.xy *= inGuardBand;
  gl_Position = onGrid(gl_Position);
}
