#version 430 compatibility
// Coverage of a stroke with round ends, from the distance of the pixel's centre to its line.
in vec4 place;
in vec4 colour;
out vec4 fragment;
void main() {
  vec2 off = vec2(place.x - clamp(place.x, 0.0, place.z), place.y);
  fragment = vec4(colour.rgb, colour.a * clamp(place.w + 0.5 - length(off), 0.0, 1.0));
}
