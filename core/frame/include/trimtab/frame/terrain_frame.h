#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// What a frame drew of the terrain's levels, and what reading them from disk did.
namespace trimtab {

/// By level: of tiles 0 is the finest, of patches (their depth) the coarsest.
struct LevelsFrame {
  static constexpr std::size_t kLevels = 40;
  std::array<std::uint32_t, kLevels> nodes{};
  std::array<std::uint64_t, kLevels> triangles{};
};

/// Counters since the terrain was set.
struct PagingFrame {
  std::size_t waiting = 0;   ///< pages on their way, those for what lies ahead included
  std::size_t heldBack = 0;  ///< diamonds drawn coarser than asked for, for want of them
  std::uint64_t pagesRead = 0, pagesDropped = 0, bytesRead = 0;
  std::uint64_t failed = 0;                  ///< pages that could not be read: drawn coarser for good
  std::uint64_t bytes = 0, budgetBytes = 0;  ///< held now, and allowed
  double longestReadMs = 0;
  bool settled = true;  ///< the same view drawn again would show nothing more
};

}  // namespace trimtab
