// Drops and flakes. gl_Vertex is the place in a unit cell, whose z points down; gl_MultiTexCoord0 is the corner.
// gl_MultiTexCoord1.x is seconds, which give each cell a pattern of its own; whole multiples of it, so that its
// wrap from 1 to 0 moves nothing. A drop narrower than a pixel is drawn a pixel wide and fainter, or it would
// flicker.
uniform float inversePeriod;
uniform float phase;  // of the fall through a cell, 0..1
uniform float radius;  // metres
uniform vec3 streak;  // eye axes, metres: from a drop back to where it was
uniform float pixelsPerMetre;  // at 1 m
uniform float farM;
uniform float extinction;
out vec2 corner;
out float strength;
vec3 dropInEye() {
  float own = gl_MultiTexCoord1.x * inversePeriod;
  vec3 inCell = vec3(fract(gl_Vertex.xy + own * vec2(7.0, 3.0)), fract(phase - own - gl_Vertex.z));
  return (gl_ModelViewMatrix * vec4(inCell, 1.0)).xyz;
}
float seenAt(float metres) {
  return exp(-extinction * metres) * smoothstep(0.3, 1.5, metres) *
         (1.0 - smoothstep(0.75 * farM, farM, metres));
}
float smeared(float size) { return 0.1 + 0.9 * size / (size + length(streak)); }
