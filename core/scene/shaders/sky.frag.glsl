#version 430 compatibility
#pragma import_defines(IN_WEATHER, AIR_LAYER)
#ifdef IN_WEATHER
uniform vec3 fog;          // sRGB
uniform vec3 air;          // x: extinction per metre
#ifdef AIR_LAYER
#include "haze_layer.glsl"
uniform float lowest;      // (height - ground) * (2 * radius + height + ground) for ground below all that is drawn
const float kEndless = 1e9;
// A ray that meets the earth ends there. No ground before that is seen through more haze than this.
float metresInFog(float elevation, float rise) {
  float b = layer.x * rise;
  float square = b * b - lowest;
  bool ends = rise < 0.0 && square > 0.0;
  return lengthInLayer(rise, ends ? lowest / (sqrt(max(square, 0.0)) - b) : kEndless);
}
#else
uniform vec2 fogDepth;     // metres up to clear air, metres down to the ground
// A level ray has no end in fog, so at the horizon sky and ground both show fog alone.
float metresInFog(float elevation, float rise) {
  return (elevation > 0.0 ? fogDepth.x : fogDepth.y) / max(abs(elevation), 1e-5);
}
#endif
#endif
in vec3 direction;
uniform vec3 upInEye;
const vec3 haze = vec3(HAZE_RED, HAZE_GREEN, HAZE_BLUE);  // sRGB
uniform float dip;         // sine of the dip of the earth's horizon
out vec4 fragment;
void main() {
  // This is a rational ramp without trigonometry, because a software rasteriser pays for every pixel.
  float rise = dot(direction, upInEye) * inversesqrt(dot(direction, direction));
  float elevation = rise + dip;
  float above = max(elevation, 0.0) * 3.0;
  vec3 sky = mix(haze, vec3(0.20, 0.40, 0.72), above / (above + 0.6));
  vec3 colour = mix(haze * 0.94, sky, clamp(elevation * 200.0 + 0.5, 0.0, 1.0));
#ifdef IN_WEATHER
  float left = exp(-air.x * metresInFog(elevation, rise));
  colour = colour * left + fog * (1.0 - left);
#endif
  fragment = vec4(colour, 1.0);
}
