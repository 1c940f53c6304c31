#version 430 compatibility
// Mixes an image with the accumulated one, and writes the result in float and in 8 bits per colour.
layout(binding = 0) uniform sampler2D drawn;
layout(binding = 1) uniform sampler2D before;
uniform float keep;
layout(location = 0) out vec4 sum;
layout(location = 1) out vec4 shown;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 now = texelFetch(drawn, at, 0);
  // Before the first image the accumulated one is undefined, perhaps NaN, so it must not be read.
  sum = keep > 0.0 ? vec4(mix(now.rgb, texelFetch(before, at, 0).rgb, keep), now.a) : now;
  shown = sum;
}
