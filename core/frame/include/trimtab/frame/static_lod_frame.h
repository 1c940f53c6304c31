#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace trimtab {

/// Counts what a frame drew of the static trees, by a node's depth in its tree (0 at the root).
struct StaticLodFrame {
  static constexpr std::size_t kDepths = 16;  ///< the last one counts all deeper nodes too

  bool drawn = false;  ///< whether the trees were the terrain; if not, everything else is zero
  std::array<std::uint64_t, kDepths> triangles{};
  std::array<std::uint32_t, kDepths> nodes{};

  friend bool operator==(const StaticLodFrame&, const StaticLodFrame&) = default;
};

}  // namespace trimtab
