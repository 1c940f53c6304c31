#pragma once

#include <cstdint>
#include <limits>

namespace trimtab::terrain {

/// The number of the source of a post to which no source gave a height: a void that was filled.
inline constexpr std::uint16_t kNoSource = std::numeric_limits<std::uint16_t>::max();

}  // namespace trimtab::terrain
