#version 430 compatibility
in vec4 colour;
out vec4 fragment;
void main() { fragment = colour; }
