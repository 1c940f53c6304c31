#pragma once

#include <array>
#include <cstdint>

#include "trimtab/frame/visible_set.h"

namespace trimtab {

/// Return the colours of the overlays, sRGB. Colour-blind people can tell them apart too (Okabe and Ito's
/// set).
std::array<std::uint8_t, 3> reasonColour(CullReason reason);
std::array<std::uint8_t, 3> levelColour(int level);

}  // namespace trimtab
