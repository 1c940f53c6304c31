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

/// A line or a filled triangle of a host's symbol, in pixels of the image. It has no rim.
struct HostMark {
  static constexpr float kFilled = -1;

  float x[3], y[3];     ///< the line's ends and then its end again, or the triangle's corners
  float halfWidth = 0;  ///< of the line; kFilled for a triangle
  std::array<std::uint8_t, 4> rgba{};
};

/// The box of what is visible of a symbol; empty (left > right) if nothing is.
struct SymbolBox {
  float left = 1, bottom = 1, right = 0, top = 0;
  bool empty() const { return left > right; }
};

struct SymbologyDrawing {
  /// A host's symbols become at most so many marks. A symbol that would exceed it is left out.
  static constexpr std::size_t kMostMarks = 60000;

  std::vector<SymbolStroke> strokes;   ///< symbol by symbol in the order of Symbol; none of Symbol::host
  std::vector<HostMark> marks;         ///< of Symbol::host, in the order in which they are drawn
  std::size_t hostSymbolsLeftOut = 0;  ///< see FrameCounters
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
