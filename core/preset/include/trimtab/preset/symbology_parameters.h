#pragma once

#include "trimtab/units/quantity.h"

namespace trimtab {

/// What symbols without a place in the world (tape, readouts) are fixed to.
enum class SymbologyFrame { head, aircraft };
enum class SymbolColour { green, white, amber, cyan, magenta, red, yellow, black };

struct SymbologyParameters {
  bool enabled = false;
  SymbologyFrame frame = SymbologyFrame::head;
  Pixels lineWidth{1.8};
  Pixels outline{1.2};  ///< dark rim round every line; 0: none

  friend constexpr bool operator==(const SymbologyParameters&, const SymbologyParameters&) = default;
};

/// One symbol of a helmet-mounted display.
struct SymbolElement {
  bool show = true;
  SymbolColour colour = SymbolColour::green;
  Ratio x{0}, y{0};  ///< fractions of half the picture
  Ratio size{1};

  friend constexpr bool operator==(const SymbolElement&, const SymbolElement&) = default;
};

}  // namespace trimtab
