#version 430 compatibility
in vec2 corner;
in float strength;
uniform vec3 dropColour;   // sRGB
out vec4 fragment;
void main() {
  float square = dot(corner, corner);
  fragment = vec4(dropColour, strength * max(0.0, 1.0 - square * square));
}
