#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/select_patches.h"
#include "trimtab/terrain/format/patch_terrain.h"

namespace trimtab::terrain {

/// Reads pages of patches on threads of its own, the most urgent first. Only `waitFor` and the destructor
/// wait for the disk; the destructor waits for the page that is being read.
class Pager {
 public:
  virtual ~Pager() = default;
  static std::unique_ptr<Pager> start(std::shared_ptr<const PatchTerrain> terrain);

  /// Replaces the list of pages to read. Pages that are being read are still finished; pages that have
  /// arrived and are no longer wanted are dropped.
  virtual void want(std::span<const PageWant> pages) = 0;
  /// Returns pages that have arrived since the last call: at most `mostBytes` of them, but at least one if
  /// there is any.
  virtual std::vector<std::shared_ptr<const PatchPage>> takeArrived(std::size_t mostBytes) = 0;
  /// Waits until these pages have arrived or failed. Use it for images that must not depend on time.
  virtual void waitFor(std::span<const std::uint32_t> pages) = 0;

  struct Counters {
    std::uint64_t pagesRead = 0, bytesRead = 0, failed = 0;
    std::size_t waiting = 0;  ///< pages that are wanted, not taken yet, and have not failed
    double longestReadMs = 0;
  };
  virtual Counters counters() const = 0;
  virtual bool hasFailed(std::uint32_t page) const = 0;
  /// Returns the first failures. A page that failed is not tried again.
  virtual Findings failures() const = 0;
};

}  // namespace trimtab::terrain
