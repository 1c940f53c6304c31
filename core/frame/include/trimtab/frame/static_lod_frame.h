#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace trimtab {

/// What a frame drew of the trees of static levels of detail, by a node's depth in its tree (0 at the root).
struct StaticLodFrame {
  static constexpr std::size_t kDepths = 16;  ///< the last one stands for all below it too

  bool drawn = false;  ///< the trees stood for the terrain; otherwise everything else is zero
  std::array<std::uint64_t, kDepths> triangles{};
  std::array<std::uint32_t, kDepths> nodes{};

  friend bool operator==(const StaticLodFrame&, const StaticLodFrame&) = default;
};

}  // namespace trimtab
