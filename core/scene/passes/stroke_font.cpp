#include "stroke_font.h"

#include <array>
#include <string_view>
#include <vector>

namespace trimtab::scene {
namespace {

struct Drawing {
  char character;
  std::string_view pen;  ///< points as pairs of digits, x then y; a blank lifts the pen
};

constexpr Drawing kDrawings[] = {
    {'0', "103041453616050110"},
    {'1', "042620"},
    {'2', "0516364544430040"},
    {'3', "051636454433 133342413010 1001"},
    {'4', "36024230 3630"},
    {'5', "460603334241301001"},
    {'6', "36160501103041423302"},
    {'7', "064620"},
    {'8', "13040516364544331302011030414233"},
    {'9', "1030414536160504133344"},
    {'A', "002640 0242"},
    {'B', "000636454433 0333424130 0030"},
    {'C', "4536160501103041"},
    {'D', "00062644422000"},
    {'E', "46060040 0333"},
    {'F', "460600 0333"},
    {'G', "4536160501103041 4323 4143"},
    {'H', "0006 4640 0343"},
    {'I', "1030 1636 2026"},
    {'J', "4641301001"},
    {'K', "0006 460340"},
    {'L', "060040"},
    {'M', "0006234640"},
    {'N', "00064046"},
    {'O', "103041453616050110"},
    {'P', "000636454433 0333"},
    {'Q', "103041453616050110 2240"},
    {'R', "000636454433 0333 2340"},
    {'S', "453616050413334241301001"},
    {'T', "0646 2620"},
    {'U', "060110304146"},
    {'V', "062046"},
    {'W', "0610233046"},
    {'X', "0046 0640"},
    {'Y', "062346 2320"},
    {'Z', "06460040"},
    {'+', "0343 2125"},
    {'-', "0343"},
    {'.', "2021"},
    {'*', "1434361614"},
};

/// Holds all glyphs' lines in one array, and where each character's begin.
struct Font {
  std::vector<GlyphLine> lines;
  std::array<std::size_t, 129> first{};

  Font() {
    for (std::size_t c = 0; c < 128; ++c) {
      first[c] = lines.size();
      for (const Drawing& drawing : kDrawings)
        if (static_cast<std::size_t>(drawing.character) == c) add(drawing.pen);
    }
    first[128] = lines.size();
  }

  void add(std::string_view pen) {
    const auto at = [&pen](std::size_t i) { return static_cast<signed char>(pen[i] - '0'); };
    for (std::size_t i = 0; i + 3 < pen.size();) {
      if (pen[i + 2] == ' ') {
        i += 3;
        continue;
      }
      lines.push_back({at(i), at(i + 1), at(i + 2), at(i + 3)});
      i += 2;
    }
  }
};

}  // namespace

std::span<const GlyphLine> glyph(char character) {
  static const Font font;
  const auto c = static_cast<unsigned char>(character);
  if (c >= 128) return {};
  return {font.lines.data() + font.first[c], font.first[c + 1u] - font.first[c]};
}

}  // namespace trimtab::scene
