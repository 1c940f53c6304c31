#pragma once

#include "trimtab/units/quantity.h"

namespace trimtab {

/// Says to what symbols without a place in the world (tape, readouts) are fixed.
enum class SymbologyFrame { head, aircraft };
enum class SymbolColour { green, white, amber, cyan, magenta, red, yellow, black };

struct SymbologyParameters {
  bool enabled = false;
  SymbologyFrame frame = SymbologyFrame::head;
  Pixels lineWidth{1.8};
  Pixels outline{1.2};  ///< dark rim around every line; 0 for none
  /// Draws the host's symbols in the preset's colour and not in those that the host sends.
  bool recolourHost = false;

  friend constexpr bool operator==(const SymbologyParameters&, const SymbologyParameters&) = default;
};

/// One symbol of a helmet-mounted display.
struct SymbolElement {
  bool show = true;
  SymbolColour colour = SymbolColour::green;
  Ratio x{0}, y{0};  ///< fractions of half the image
  Ratio size{1};

  friend constexpr bool operator==(const SymbolElement&, const SymbolElement&) = default;
};

}  // namespace trimtab
