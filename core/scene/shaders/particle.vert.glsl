#version 430 compatibility
// A corner of a drop's or flake's quad. The processor has placed it: it leaves out what no pixel shows.
layout(location = 0) in vec3 place;  // x, y and w of clip space
layout(location = 1) in vec4 shape;  // across, along, strength
uniform float nearM;
out vec2 corner;
flat out float strength;
void main() {
  corner = shape.xy * 2.0 - 1.0;
  strength = shape.z;
  gl_Position = vec4(place.xy, nearM, place.z);
}
