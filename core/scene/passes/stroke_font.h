#pragma once

#include <span>

namespace trimtab::scene {

/// One pen stroke of a glyph on a grid: x from 0 to 4, y from 0 (base line) to 6.
struct GlyphLine {
  signed char x0, y0, x1, y1;
};

/// Returns the strokes of a character: digits, capitals, + - . and a degree sign (written '*'); nothing for
/// any other.
std::span<const GlyphLine> glyph(char character);

inline constexpr double kGlyphHeight = 6, kGlyphWidth = 4, kGlyphAdvance = 5.6;

}  // namespace trimtab::scene
