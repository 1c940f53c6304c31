#version 430 compatibility
#include "relative_position.glsl"
in vec3 vertexPosition;
in vec3 vertexNormal;
in vec2 vertexPost;
uniform samplerBuffer tints;
uniform bool tinted;
uniform bool wire;
uniform float inGuardBand;
uniform ivec2 eyePost;     // column and row of the post under the eye
out vec3 relative;         // metres from the eye
out vec3 upward;
out vec2 post;             // columns and rows from eyePost
out vec2 ground;           // groundMetres
flat out vec4 tint;
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
  // Subtract whole numbers first: floats cannot tell the posts of a large terrain apart.
  post = vec2(square - eyePost) + vertexPost;
  ground = groundMetres(vertexPosition, slot);
  tint = tinted ? texelFetch(tints, block) : vec4(0.0);
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
  if (wire) gl_Position.z *= 1.002;  // nearer, as depth is reversed
  gl_Position.xy *= inGuardBand;
}
