#version 430 compatibility
// Document E's image of static trees: one colour, no light, no air.
#include "relative_position.glsl"
in vec3 vertexPosition;
uniform vec4 flatColour;
uniform float depthScale;  // more than 1 is nearer, as depth is reversed
out vec4 colour;
void main() {
  colour = flatColour;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(relativePosition(vertexPosition, texelFetch(slots, gl_VertexID / TREE_BLOCK)), 1.0);
  gl_Position.z *= depthScale;
}
