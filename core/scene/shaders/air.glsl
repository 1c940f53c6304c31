// What air leaves of a colour, for the fragment shader of everything that has a place in the world. The
// distance comes from gl_FragCoord, so it is that of the pixel and needs no varying. Beyond the weather's far
// cut the fragment is discarded: the sky shows there, and not the outline of the tiles.
#ifdef IN_WEATHER
uniform vec4 tangents;  // left, right, bottom, top
uniform vec2 pictureSize;  // pixels
uniform vec3 fog;  // sRGB
uniform vec3 air;  // extinction per metre, cut distance, 1 / width of its fade
vec3 throughAir(vec3 colour) {
  vec2 across = mix(tangents.xz, tangents.yw, gl_FragCoord.xy / pictureSize);
  float metres = sqrt(1.0 + dot(across, across)) / gl_FragCoord.w;
  if (metres > air.y) discard;
  float near = clamp((air.y - metres) * air.z, 0.0, 1.0);
  return mix(fog, min(colour, vec3(1.0)), exp(-air.x * metres) * near * near * (3.0 - 2.0 * near));
}
#else
vec3 throughAir(vec3 colour) { return colour; }
#endif
