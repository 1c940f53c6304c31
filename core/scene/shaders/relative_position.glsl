// A vertex's position relative to the eye, metres. Vertices are multiples of 1/256 m and a tile's offset from
// eyeHi is a multiple of 16 m, so the sum is the same number in every tile that shares the post: borders
// match to the bit and nothing jitters, however far away the origin is. `precise` forbids another order.
uniform isamplerBuffer slots;
uniform ivec3 eyeHi;
uniform vec3 eyeLo;
vec3 relativePosition(vec3 inTile, ivec4 slot) {
  precise vec3 p = inTile + vec3(slot.xyz - eyeHi) * 16.0;
  p -= eyeLo;
  return p;
}

// Returns metres east and north, modulo 8192 from tile to tile: where the ground's noise is.
vec2 groundMetres(vec3 inTile, ivec4 slot) {
  return inTile.xy + vec2(slot.xy & 511) * 16.0;
}
