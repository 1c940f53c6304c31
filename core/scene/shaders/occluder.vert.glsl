#version 430 compatibility
// Lowers the occluders: core/scene/terrain/tiles/occlusion_pass.h has the proof.
#include "relative_position.glsl"
in vec4 vertexPosition;      // w: slope bound
uniform vec3 forward;        // of the view, local axes
uniform float texelReach;    // from a texel's centre to its corner, at distance 1
uniform float loweringScale; // 1; tests set less to see that the image breaks
const float kMuch = 1e6;     // metres; a vertex so low hides nothing

void main() {
  int slot = gl_VertexID / OCCLUDER_VERTICES;
  ivec4 place = texelFetch(slots, slot * 2);
  vec4 limits = intBitsToFloat(texelFetch(slots, slot * 2 + 1));  // reach, farReach, farSlope, edge
  vec3 p = relativePosition(vertexPosition.xyz, place);
  float z = dot(p, forward);
  // The texels of a triangle of this vertex may look so far sideways, at its greatest depth.
  float slope = vertexPosition.w;
  float sideways = 1.25 * (texelReach * (max(z, 0.0) + 2.0 * limits.w * sqrt(1.0 + slope * slope)));
  if (sideways > limits.x) {
    slope = max(slope, limits.z);
    sideways = 1.25 * (texelReach * (max(z, 0.0) + 2.0 * limits.w * sqrt(1.0 + slope * slope)));
  }
  // Slopes are measured against the geodetic vertical, but vertices are lowered along the frame's z.
  float tilt = 1.65e-7 * (length(vec2(place.xy) * 16.0 + vertexPosition.xy) + limits.y + limits.w);
  float lower = kMuch;
  if (sideways <= limits.y && slope * tilt < 0.5) {
    slope = (slope + tilt) / (1.0 - slope * tilt);
    float k = sqrt(1.0 + slope * slope) * texelReach;
    // Lowering changes the depth that decides how much to lower: this is the solution for the lowered vertex.
    float denominator = 1.0 + k * forward.z;
    if (denominator > 0.25) lower = k * max(z, 0.0) / denominator;
  }
  p.z -= lower * loweringScale;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
}
