#pragma once

// Land between posts or texels is no even colour: two octaves of noise that stand on the ground, to multiply
// it with. Each fades out before its cells are smaller than two pixels, so that nothing shimmers. The lattice
// repeats every 8,192 m, as `metres` may. To be called in uniform control flow: it takes derivatives. It
// hashes, as a texture of it with its levels costs more than twice as much on a software rasteriser; there is
// no branch round an octave that has faded out, as there both sides of a branch are run.
#define TRIMTAB_GROUND_NOISE                                                               \
  "float groundRandom(ivec2 cell) {\n"                                                     \
  "  uint h = uint(cell.x) * 374761393u + uint(cell.y) * 668265263u;\n"                    \
  "  h = (h ^ (h >> 13)) * 1274126177u;\n"                                                 \
  "  return float((h ^ (h >> 16)) & 65535u) * (2.0 / 65535.0) - 1.0;\n"                    \
  "}\n"                                                                                    \
  "float groundNoise(vec2 p, int period) {\n"                                              \
  "  vec2 whole = floor(p);\n"                                                             \
  "  vec2 t = p - whole;\n"                                                                \
  "  t = t * t * (3.0 - 2.0 * t);\n"                                                       \
  "  ivec2 low = ivec2(whole) & (period - 1), high = (ivec2(whole) + 1) & (period - 1);\n" \
  "  return mix(mix(groundRandom(low), groundRandom(ivec2(high.x, low.y)), t.x),\n"        \
  "             mix(groundRandom(ivec2(low.x, high.y)), groundRandom(high), t.x), t.y);\n" \
  "}\n"                                                                                    \
  "float groundDetail(vec2 metres) {\n"                                                    \
  "  vec2 footprint = fwidth(metres);\n"                                                   \
  "  float widest = max(footprint.x, footprint.y);\n"                                      \
  "  float coarse = clamp(1.5 - widest * (3.0 / 128.0), 0.0, 1.0);\n"                      \
  "  float fine = clamp(1.5 - widest * (3.0 / 32.0), 0.0, 1.0);\n"                         \
  "  return 0.11 * coarse * groundNoise(metres * (1.0 / 128.0), 64) +\n"                   \
  "         0.09 * fine * groundNoise(metres * (1.0 / 32.0), 256);\n"                      \
  "}\n"
