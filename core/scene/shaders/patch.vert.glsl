#version 430 compatibility
#pragma import_defines(TINTED, WIRE)
#include "on_grid.glsl"
#include "relative_position.glsl"
in vec3 vertexPosition;
in vec3 vertexNormal;
in vec2 vertexPost;
uniform float inGuardBand;
uniform ivec2 eyePost;     // column and row of the post under the eye
out vec3 relative;         // metres from the eye
out vec3 upward;
out vec2 post;             // columns and rows from eyePost
out vec2 ground;           // groundMetres
#ifdef TINTED
uniform samplerBuffer tints;
flat out vec4 tint;
#endif
#ifdef NODE_IDS
flat out uint owner;
#endif
// The node pass must cover the same pixels at the same depths as the image, to the bit.
invariant gl_Position;
void main() {
  int block = gl_VertexID / PATCH_BLOCK;
  ivec4 slot = texelFetch(slots, block * 2);
  ivec2 square = texelFetch(slots, block * 2 + 1).xy;
#ifdef NODE_IDS
  owner = uint(slot.w);
#endif
  vec3 p = relativePosition(vertexPosition, slot);
  relative = p;
  upward = vertexNormal;
  // Subtract whole numbers first: floats cannot distinguish the posts of a large terrain.
  post = vec2(square - eyePost) + vertexPost;
  ground = groundMetres(vertexPosition, slot);
#ifdef TINTED
  tint = texelFetch(tints, block);
#endif
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
#ifdef WIRE
  gl_Position.z *= 1.002;  // nearer, as depth is reversed
#endif
  gl_Position.xy *= inGuardBand;
  gl_Position = onGrid(gl_Position);
}
