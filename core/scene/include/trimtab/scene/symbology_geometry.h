#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/symbology_request.h"
#include "trimtab/preset/parameters.h"

/// Makes document C's symbols of a helmet-mounted display as strokes over the image. Needs no GL.
namespace trimtab::scene {

/// A line in pixels of the image; the lower left corner of the lower left pixel is at 0, 0.
struct SymbolStroke {
  float x0, y0, x1, y1;
  Symbol symbol;
};

/// The box of what is visible of a symbol; empty (left > right) if nothing is.
struct SymbolBox {
  float left = 1, bottom = 1, right = 0, top = 0;
  bool empty() const { return left > right; }
};

struct SymbologyDrawing {
  std::vector<SymbolStroke> strokes;  ///< symbol by symbol in the order of Symbol
  std::array<SymbolBox, kSymbols> box;
};

/// Returns the request rounded to what anybody can see: angles to a tenth of a pixel, readouts to their last
/// digit. Requests that come out alike draw alike.
SymbologyRequest quantised(const SymbologyRequest& request, const ViewShape& view);

/// Fills `drawing` with the strokes of a request. Pitch ladder, flight path marker, aircraft reference and
/// line of sight lie where the world has them, displaced by their `x` and `y`.
void drawSymbology(const SymbologyRequest& request, const ViewShape& view, SymbologyDrawing& drawing);

/// Returns a colour as sRGB.
std::array<std::uint8_t, 3> symbolColour(SymbolColour colour);

}  // namespace trimtab::scene
