#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/symbology_request.h"
#include "trimtab/preset/parameters.h"

/// Document C's symbols of a helmet-mounted display as strokes on the picture. No GL.
namespace trimtab::scene {

/// Pixels of the picture, the lower left corner of the lower left pixel at 0, 0.
struct SymbolStroke {
  float x0, y0, x1, y1;
  Symbol symbol;
};

/// What of a symbol is in the picture; empty (left > right) when nothing is.
struct SymbolBox {
  float left = 1, bottom = 1, right = 0, top = 0;
  bool empty() const { return left > right; }
};

struct SymbologyDrawing {
  std::vector<SymbolStroke> strokes;  ///< symbol by symbol in the order of Symbol
  std::array<SymbolBox, kSymbols> box;
};

/// The request as far as anybody can see it: angles to a tenth of a pixel, readouts to their last digit. Two
/// requests that come out alike draw alike.
SymbologyRequest quantised(const SymbologyRequest& request, const ViewShape& view);

/// The strokes of a request. Symbols that belong to the world lie where it says: pitch ladder, flight path
/// marker, aircraft reference, line of sight (then `x` and `y` displace them).
void drawSymbology(const SymbologyRequest& request, const ViewShape& view, SymbologyDrawing& drawing);

/// sRGB.
std::array<std::uint8_t, 3> symbolColour(SymbolColour colour);

}  // namespace trimtab::scene
