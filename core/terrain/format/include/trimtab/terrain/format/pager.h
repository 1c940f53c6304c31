#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/select_patches.h"
#include "trimtab/terrain/format/patch_terrain.h"

namespace trimtab::terrain {

/// Reads pages of patches on threads of its own, those of the largest screen-space error first (PageWant).
/// Pages are numbered as in the terrain's index. All members but the destructor may be called from any
/// thread. Only `waitFor` and the destructor wait for the disk; the destructor waits for the reads that have
/// begun.
class Pager {
 public:
  virtual ~Pager() = default;
  /// Returns a pager for the terrain, which must not be null. It reads nothing until pages are wanted.
  static std::unique_ptr<Pager> start(std::shared_ptr<const PatchTerrain> terrain);

  /// Replaces the list of pages to read. A page that is being read is still read to its end. Pages that are
  /// no longer wanted are dropped, also if they arrive later. A page that failed is not read again.
  virtual void want(std::span<const PageWant> pages) = 0;
  /// Returns pages that have arrived and were not taken yet: as many as fit into `mostBytes` of memory, but
  /// at least one if there is any. It does not wait.
  virtual std::vector<std::shared_ptr<const PatchPage>> takeArrived(std::size_t mostBytes) = 0;
  /// Reads those of these pages that are not read yet, wanted or not, and returns when each has arrived or
  /// failed. Use it for images that must be the same however slow the disk is.
  virtual void waitFor(std::span<const std::uint32_t> pages) = 0;

  /// Counts what happened since the start.
  struct Counters {
    std::uint64_t pagesRead = 0, bytesRead = 0, failed = 0;
    std::size_t waiting = 0;  ///< pages that are wanted, not taken yet, and have not failed
    double longestReadMs = 0;
  };
  virtual Counters counters() const = 0;
  /// Reports whether the page could not be read.
  virtual bool hasFailed(std::uint32_t page) const = 0;
  /// Returns why pages could not be read; only the first failures are kept.
  virtual Findings failures() const = 0;
};

}  // namespace trimtab::terrain
