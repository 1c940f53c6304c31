#pragma once

#include <array>
#include <cstdint>

#include "trimtab/frame/visible_set.h"

namespace trimtab {

/// Return the colours of the overlays, sRGB. Colour-blind people can tell them apart too (Okabe and Ito's
/// set).
std::array<std::uint8_t, 3> reasonColour(CullReason reason);
std::array<std::uint8_t, 3> levelColour(int level);

/// Returns a colour (RGBA8, red in the lowest byte) that is as strong as an overlay's colours are over the
/// land's.
constexpr std::uint32_t overlayTint(std::array<std::uint8_t, 3> c) {
  return c[0] | static_cast<std::uint32_t>(c[1]) << 8 | static_cast<std::uint32_t>(c[2]) << 16 | 150u << 24;
}

}  // namespace trimtab
