// Applies the air to a colour, for the fragment shader of everything that has a place in the world: first the
// haze of clear air, then in weather its fog. Beyond the weather's far cut the fragment is discarded: the sky
// shows there, and not the outline of the tiles. Only a frame that is cut has the `discard`. The distance
// comes from a varying, because on a software rasteriser gl_FragCoord costs twice as much as the whole fog.
const vec3 haze = vec3(HAZE_RED, HAZE_GREEN, HAZE_BLUE);  // sRGB
#ifdef IN_WEATHER
uniform vec3 fog;  // sRGB
uniform vec3 air;  // extinction per metre, cut distance, 1 / width of its fade
#ifdef AIR_LAYER
#include "haze_layer.glsl"
uniform vec3 upInFrame;
float metresInFog(vec3 fromEye, float metres) { return lengthInLayer(dot(fromEye, upInFrame) / metres, metres); }
#else
float metresInFog(vec3 fromEye, float metres) { return metres; }
#endif
#endif

// Returns the share of a colour that the haze of clear air leaves.
float hazeLeaves(vec3 fromEye) { return exp(-length(fromEye) * (1.0 / HAZE_DISTANCE)); }

// `clearness` is what hazeLeaves returns; `fromEye` is in metres.
vec3 throughAir(vec3 colour, float clearness, vec3 fromEye) {
  vec3 shown = mix(haze, colour, clearness);
#ifdef IN_WEATHER
  float metres = length(fromEye);
  float left = exp(-air.x * metresInFog(fromEye, metres));
#ifdef AIR_CUT
  if (metres > air.y) discard;
  float near = clamp((air.y - metres) * air.z, 0.0, 1.0);
  left *= near * near * (3.0 - 2.0 * near);
#endif
  shown = min(shown, vec3(1.0)) * left + fog * (1.0 - left);  // less work than mix()
#endif
  return shown;
}
