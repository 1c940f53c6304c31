// `lengthInLayer` returns how many metres of a ray lie in the layer of haze: haze_layer.h has the same. `rise` is
// the sine of the ray's elevation at the eye.
uniform vec2 layer;  // earth's radius + eye's height; (height - top) * (2 * radius + height + top)
float lengthInLayer(float rise, float metres) {
  float b = layer.x * rise;
  float square = b * b - layer.y;
  if (!(square > 0.0)) return 0.0;
  float q = b < 0.0 ? sqrt(square) - b : -sqrt(square) - b;
  float r = layer.y / q;
  return clamp(max(q, r), 0.0, metres) - clamp(min(q, r), 0.0, metres);
}
