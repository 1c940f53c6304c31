#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// Declares what a frame drew of each level, and the state of paging.
namespace trimtab {

/// Counts by level: 0 is the finest level of tiles, but the coarsest depth of patches.
struct LevelsFrame {
  static constexpr std::size_t kLevels = 40;
  std::array<std::uint32_t, kLevels> nodes{};
  std::array<std::uint64_t, kLevels> triangles{};
};

/// The state of paging; counters run since the terrain was set.
struct PagingFrame {
  std::size_t waiting = 0;   ///< wanted pages that are neither taken nor failed, those ahead included
  std::size_t heldBack = 0;  ///< diamonds drawn coarser than wanted, because a page is missing
  std::uint64_t pagesRead = 0, pagesDropped = 0, bytesRead = 0;
  std::uint64_t failed = 0;                  ///< pages that could not be read; ground is coarser
  std::uint64_t bytes = 0, budgetBytes = 0;  ///< memory in use, and allowed
  double longestReadMs = 0;                  ///< of one page
  bool settled = true;  ///< whether drawing the same view again would show the same
};

}  // namespace trimtab
