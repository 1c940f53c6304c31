// `float textureSquare(vec2 place)` returns what a ground's colour is multiplied by to show its texture
// coordinates: a chequerboard of eighths of a texture. Squares smaller than a pixel fade to their mean. Where
// coordinates do not change, as in a tile that has none, nothing is darkened. Call it in uniform control flow.
float textureSquare(vec2 place) {
  vec2 square = 8.0 * place;
  vec2 width = fwidth(square);
  float seen = clamp(2.0 - 2.0 * max(width.x, width.y), 0.0, 1.0);
  float odd = mod(floor(square.x) + floor(square.y), 2.0);
  return 1.0 - 0.5 * mix(0.5, odd, seen);
}
