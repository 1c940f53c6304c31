#version 430 compatibility
// A corner of the square around a light. It is a square and not a point of GL, which GL leaves out as soon as
// its centre is outside the image.
layout(location = 0) in vec3 position;    // of the light, metres from the origin of its cell
layout(location = 1) in vec4 colour;
layout(location = 2) in vec3 cellOrigin;  // metres from the eye
uniform vec2 reach;                       // half a light's size in halves of the image
out vec2 corner;
flat out vec3 shown;
flat out vec3 relative;  // metres from the eye
void main() {
  corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  shown = colour.rgb;
  relative = position + cellOrigin;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(relative, 1.0);
  gl_Position.xy += corner * reach * gl_Position.w;
  // A fiftieth nearer, as depth is reversed: otherwise the ground in front of a light, or ground that is drawn
  // coarser than it is, would cut its disc. What stands so near before a light does not hide it.
  gl_Position.z *= 1.02;
}
