#version 430 compatibility
void main() {}
