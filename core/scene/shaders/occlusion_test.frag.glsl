#version 430 compatibility
// Tests one part of a tile per fragment: 1 hidden, 0.5 outside the view, 0 perhaps visible.
uniform isamplerBuffer slots;
uniform samplerBuffer parts;
uniform isamplerBuffer tested;  // slots of the tiles to test
uniform sampler2D depthMap;
uniform sampler2D pyramid;      // level 0 is the depth map's 2 x 2
uniform ivec3 eyeHi;
uniform vec3 eyeLo;
uniform vec3 right, up, forward;
uniform vec4 tangents;
uniform float nearM;
uniform ivec2 mapSize;
uniform int levels;
uniform int span;               // texels per side that a test may read
uniform vec2 pad;               // texels
uniform int count;
uniform float shift;            // 0; tests set more to see that the image breaks
out vec4 result;

bool hidden(int slot, int part, out bool outside) {
  outside = false;
  vec3 base = vec3(texelFetch(slots, slot * 2).xyz - eyeHi) * 16.0 - eyeLo;
  vec3 corner[2];
  corner[0] = texelFetch(parts, (slot * PARTS + part) * 2).xyz + base;
  corner[1] = texelFetch(parts, (slot * PARTS + part) * 2 + 1).xyz + base;
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
  int index = at.y * TESTED_PER_ROW + at.x / PARTS;
  result = vec4(0.0);
  if (index >= count) return;
  bool outside;
  if (hidden(texelFetch(tested, index).r, at.x % PARTS, outside)) result = vec4(outside ? 0.5 : 1.0);
}
