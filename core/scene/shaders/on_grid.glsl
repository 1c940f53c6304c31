// Puts a vertex on the grid to which the rasteriser rounds vertices anyway. A software rasteriser decides by the
// rounded vertices which pixels a triangle covers, but interpolates depth and colour by the unrounded ones: a
// sliver then covers a pixel outside of itself, and what it shows there is far off, in depth too. Only vertices
// near the view are rounded; what lies further out is clipped.
#pragma import_defines(ON_GRID)
#ifdef ON_GRID
uniform vec2 gridSteps;  // from the middle of the image in the guard band to its edge
vec4 onGrid(vec4 p) {
  if (max(abs(p.x), abs(p.y)) < 8.0 * p.w) p.xy = round(p.xy / p.w * gridSteps) / gridSteps * p.w;
  return p;
}
#else
vec4 onGrid(vec4 p) { return p; }
#endif
