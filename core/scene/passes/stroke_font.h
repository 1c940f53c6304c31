#pragma once

#include <span>

namespace trimtab::scene {

/// One pen stroke of a glyph on a grid: x 0..4, y 0 (base line)..6.
struct GlyphLine {
  signed char x0, y0, x1, y1;
};

/// Digits, capitals, + - . and a degree sign (written '*'); nothing for any other character.
std::span<const GlyphLine> glyph(char character);

inline constexpr double kGlyphHeight = 6, kGlyphWidth = 4, kGlyphAdvance = 5.6;

}  // namespace trimtab::scene
