#include "core/scene/occlusion/occluder.h"
#include "shaders.h"

namespace trimtab::scene {

static_assert(kOccluderVertices == 353 && kParts == 16, "the shaders say so in numbers");

// Lowers the occluders: the proof is in occlusion.h.
const char* const kOccluderVertex = R"(#version 430 compatibility
)" TRIMTAB_RELATIVE_POSITION R"(
in vec4 vertexPosition;      // w: slope bound
uniform vec3 forward;        // of the view, local axes
uniform float texelReach;    // from a texel's centre to its corner, at distance 1
uniform float loweringScale; // 1; tests set less to see that the picture breaks
const float kMuch = 1e6;     // metres: hides nothing

void main() {
  int slot = gl_VertexID / 353;
  ivec4 place = texelFetch(slots, slot * 2);
  vec4 limits = intBitsToFloat(texelFetch(slots, slot * 2 + 1));  // reach, farReach, farSlope, edge
  vec3 p = relativePosition(vertexPosition.xyz, place);
  float z = dot(p, forward);
  // The deepest that a triangle of this vertex goes, and so how far sideways its texels may look.
  float slope = vertexPosition.w;
  float sideways = 1.25 * (texelReach * (max(z, 0.0) + 2.0 * limits.w * sqrt(1.0 + slope * slope)));
  if (sideways > limits.x) {
    slope = max(slope, limits.z);
    sideways = 1.25 * (texelReach * (max(z, 0.0) + 2.0 * limits.w * sqrt(1.0 + slope * slope)));
  }
  // Slopes are against the geodetic vertical; what is lowered goes down the frame's z.
  float tilt = 1.65e-7 * (length(vec2(place.xy) * 16.0 + vertexPosition.xy) + limits.y + limits.w);
  float lower = kMuch;
  if (sideways <= limits.y && slope * tilt < 0.5) {
    slope = (slope + tilt) / (1.0 - slope * tilt);
    float k = sqrt(1.0 + slope * slope) * texelReach;
    // Lowering changes the depth that decides how much to lower: solved for the vertex as lowered.
    float denominator = 1.0 + k * forward.z;
    if (denominator > 0.25) lower = k * max(z, 0.0) / denominator;
  }
  p.z -= lower * loweringScale;
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
}
)";

const char* const kOccluderFragment = R"(#version 430 compatibility
void main() {}
)";

// The farthest of 2 x 2 texels: the smallest number, as depth is reversed.
const char* const kReduceFragment = R"(#version 430 compatibility
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
)";

// One fragment a part of a tile: 1 hidden, 0.5 outside the view, 0 perhaps seen.
const char* const kTestFragment = R"(#version 430 compatibility
uniform isamplerBuffer slots;
uniform samplerBuffer parts;
uniform isamplerBuffer tested;  // slots of the tiles in question
uniform sampler2D depthMap;
uniform sampler2D pyramid;      // level 0 is the depth map's 2 x 2
uniform ivec3 eyeHi;
uniform vec3 eyeLo;
uniform vec3 right, up, forward;
uniform vec4 tangents;
uniform float nearM;
uniform ivec2 mapSize;
uniform int levels;
uniform int span;               // texels a side that are looked at
uniform vec2 pad;               // texels
uniform int count;
uniform float shift;            // 0; tests set more to see that the picture breaks
out vec4 result;

bool hidden(int slot, int part, out bool outside) {
  outside = false;
  vec3 base = vec3(texelFetch(slots, slot * 2).xyz - eyeHi) * 16.0 - eyeLo;
  vec3 corner[2];
  corner[0] = texelFetch(parts, (slot * 16 + part) * 2).xyz + base;
  corner[1] = texelFetch(parts, (slot * 16 + part) * 2 + 1).xyz + base;
  float nearest = 1e30;
  vec2 low = vec2(1e30), high = vec2(-1e30);
  for (int i = 0; i < 8; ++i) {
    vec3 c = vec3(corner[i & 1].x, corner[(i >> 1) & 1].y, corner[i >> 2].z);
    float z = dot(forward, c);
    if (z <= nearM * 1.01) return false;
    nearest = min(nearest, z);
    vec2 t = vec2(dot(right, c), dot(up, c)) / z;
    low = min(low, t);
    high = max(high, t);
  }
  vec2 scale = vec2(mapSize) / (tangents.yw - tangents.xz);
  low = (low - tangents.xz) * scale - pad;
  high = (high - tangents.xz) * scale + pad;
  if (any(lessThan(high, vec2(0.0))) || any(greaterThan(low, vec2(mapSize)))) {
    outside = true;
    return true;
  }
  low.x += shift;
  high.x += shift;
  ivec2 from = ivec2(clamp(floor(low), vec2(0.0), vec2(mapSize - 1)));
  ivec2 to = ivec2(clamp(floor(high), vec2(0.0), vec2(mapSize - 1)));
  int level = 0;
  while (level < levels && max((to.x >> level) - (from.x >> level), (to.y >> level) - (from.y >> level)) >= span) ++level;
  from >>= level;
  to >>= level;
  float limit = nearM / nearest * 1.0001;
  for (int y = from.y; y <= to.y; ++y)
    for (int x = from.x; x <= to.x; ++x) {
      float occluder = level == 0 ? texelFetch(depthMap, ivec2(x, y), 0).r : texelFetch(pyramid, ivec2(x, y), level - 1).r;
      if (!(occluder > limit)) return false;
    }
  return true;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int index = at.y * 64 + at.x / 16;
  result = vec4(0.0);
  if (index >= count) return;
  bool outside;
  if (hidden(texelFetch(tested, index).r, at.x % 16, outside)) result = vec4(outside ? 0.5 : 1.0);
}
)";

}  // namespace trimtab::scene
