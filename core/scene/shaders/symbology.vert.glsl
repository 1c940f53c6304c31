#version 430 compatibility
layout(location = 0) in vec2 pixel;
layout(location = 1) in vec4 stroke;   // along, across, length, half width
layout(location = 2) in vec4 vertexColour;
uniform vec2 size;
out vec4 place;
out vec4 colour;
void main() {
  place = stroke;
  colour = vertexColour;
  gl_Position = vec4(pixel / size * 2.0 - 1.0, 0.0, 1.0);
}
