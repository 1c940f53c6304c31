// Ground between posts or texels has no even colour: multiply it by 1 plus two octaves of noise that is fixed
// to the ground. Each octave fades out before its cells are smaller than two pixels, so that nothing shimmers.
// The lattice repeats every 8,192 m. Call `groundDetail` in uniform control flow, because it uses derivatives.
// The noise is hashed: a texture of it with its levels costs more than twice as much on a software rasteriser.
// No branch skips an octave that has faded out, because a software rasteriser runs both sides of a branch.
float groundRandom(ivec2 cell) {
  uint h = uint(cell.x) * 374761393u + uint(cell.y) * 668265263u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return float((h ^ (h >> 16)) & 65535u) * (2.0 / 65535.0) - 1.0;
}
float groundNoise(vec2 p, int period) {
  vec2 whole = floor(p);
  vec2 t = p - whole;
  t = t * t * (3.0 - 2.0 * t);
  ivec2 low = ivec2(whole) & (period - 1), high = (ivec2(whole) + 1) & (period - 1);
  return mix(mix(groundRandom(low), groundRandom(ivec2(high.x, low.y)), t.x),
             mix(groundRandom(ivec2(low.x, high.y)), groundRandom(high), t.x), t.y);
}
float groundDetail(vec2 metres) {
  vec2 footprint = fwidth(metres);
  float widest = max(footprint.x, footprint.y);
  float coarse = clamp(1.5 - widest * (3.0 / 128.0), 0.0, 1.0);
  float fine = clamp(1.5 - widest * (3.0 / 32.0), 0.0, 1.0);
  return 0.11 * coarse * groundNoise(metres * (1.0 / 128.0), 64) +
         0.09 * fine * groundNoise(metres * (1.0 / 32.0), 256);
}
