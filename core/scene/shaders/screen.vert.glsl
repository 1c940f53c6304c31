#version 430 compatibility
// One triangle that covers the image, at reversed depth 0, which is infinitely far: the sky fills what
// nothing else covered.
uniform vec4 tangents;     // left, right, bottom, top
out vec3 direction;        // eye axes
void main() {
  vec2 corner = vec2((gl_VertexID & 1) * 2, gl_VertexID & 2);
  direction = vec3(mix(tangents.xz, tangents.yw, corner), -1.0);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
