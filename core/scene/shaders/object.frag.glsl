#version 430 compatibility
#pragma import_defines(IN_WEATHER, AIR_CUT, AIR_LAYER, WIRE)
#include "air.glsl"
in vec4 lit;
in float clearness;
in vec3 relative;
#ifdef TEXTURED
in vec2 place;
flat in float layer;
uniform sampler2DArray objectTextures;
#endif
#ifdef NODE_IDS
flat in uint owner;
out uint node;
#else
out vec4 fragment;
#endif
void main() {
  vec3 shown = lit.rgb;
#if defined(TEXTURED) && !defined(WIRE)
  // A mesh may have parts without a texture, whose number is beyond all textures.
  vec4 texel = layer < 255.0 ? texture(objectTextures, vec3(place, layer)) : vec4(1.0);
  if (texel.a * lit.a < 0.5) discard;
  shown *= texel.rgb;
#endif
#ifdef NODE_IDS
  throughAir(shown, 1.0, relative);  // which discards what is too far to be seen
  node = owner;
#elif defined(IN_WEATHER)
  fragment = vec4(throughAir(shown, hazeLeaves(relative), relative), 1.0);
#else
  fragment = vec4(throughAir(shown, clearness, relative), 1.0);
#endif
}
