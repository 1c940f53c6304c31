#version 430 compatibility
// Keeps the farthest of 2 x 2 texels: the smallest number, because depth is reversed.
uniform sampler2D source;
uniform ivec2 sourceSize;
out vec4 farthest;
void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * 2;
  float f = 1.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 at = corner + ivec2(i & 1, i >> 1);
    if (at.x < sourceSize.x && at.y < sourceSize.y) f = min(f, texelFetch(source, at, 0).r);
  }
  farthest = vec4(f);
}
