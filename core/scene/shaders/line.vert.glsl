#version 430 compatibility
in vec3 vertexPosition;
in vec4 vertexColour;
out vec4 colour;
void main() {
  colour = vertexColour;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(vertexPosition, 1.0);
  gl_Position.z *= 1.002;
}
