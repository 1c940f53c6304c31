#version 430 compatibility
#pragma import_defines(TINTED, WIRE)
#include "light.glsl"
// Of a vertex, in the axes of its model.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texturePlace;
layout(location = 3) in vec4 colour;
layout(location = 4) in float textureNumber;
// Of an instance.
layout(location = 5) in vec4 footAndScale;  // metres from the eye
layout(location = 6) in vec4 turn;          // a unit quaternion, from the model's axes to the terrain's
layout(location = 7) in vec4 instanceTint;
#ifdef NODE_IDS
flat out uint owner;  // the instance that is drawn, which has come as a colour
#endif
out vec4 lit;
out float clearness;  // share of `lit` that haze leaves
out vec3 relative;    // metres from the eye
#ifdef TEXTURED
out vec2 place;
flat out float layer;
#endif
vec3 turned(vec3 v) { return v + 2.0 * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v); }
void main() {
  vec3 p = footAndScale.xyz + turned(position * footAndScale.w);
  float light = lightOn(turned(normal));
  lit = vec4(min(colour.rgb * light * 1.15, vec3(1.0)), colour.a);
#ifdef TINTED
  lit.rgb = mix(lit.rgb, instanceTint.rgb * (0.25 + 0.75 * light), instanceTint.a);
#endif
#ifdef NODE_IDS
  owner = packUnorm4x8(instanceTint);
#endif
  relative = p;
  clearness = exp(-length(p) * (1.0 / HAZE_DISTANCE));
#ifdef TEXTURED
  place = texturePlace;
  layer = textureNumber;
#endif
  gl_Position = gl_ModelViewProjectionMatrix * vec4(p, 1.0);
#ifdef WIRE
  lit = vec4(0.05, 0.05, 0.08, 1.0);
  gl_Position.z *= 1.002;  // nearer, as depth is reversed
#endif
}
