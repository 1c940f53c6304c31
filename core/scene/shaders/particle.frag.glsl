#version 430 compatibility
in vec2 corner;
flat in float strength;
uniform vec3 colour;  // sRGB
out vec4 fragment;
void main() {
  vec2 left = max(1.0 - corner * corner, 0.0);
  float seen = left.x * left.y;
  fragment = vec4(colour, strength * seen * sqrt(seen));
}
