#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/select_patches.h"
#include "trimtab/terrain/format/patch_terrain.h"

namespace trimtab::terrain {

/// Reads pages on threads of its own, the most urgent first. No call but `waitFor` ever waits for a disk;
/// what is being read when a pager goes is waited for.
class Pager {
 public:
  virtual ~Pager() = default;
  static std::unique_ptr<Pager> start(std::shared_ptr<const PatchTerrain> terrain);

  /// What is to be read, in place of what was. Pages that are being read stay so; what has arrived and is no
  /// longer wanted is given up.
  virtual void want(std::span<const PageWant> pages) = 0;
  /// What has arrived since, at most `mostBytes` of it but one page if there is any.
  virtual std::vector<std::shared_ptr<const PatchPage>> takeArrived(std::size_t mostBytes) = 0;
  /// Waits until these are read (now among the arrived) or failed: for pictures that must not depend on time.
  virtual void waitFor(std::span<const std::uint32_t> pages) = 0;

  struct Counters {
    std::uint64_t pagesRead = 0, bytesRead = 0, failed = 0;
    std::size_t waiting = 0;  ///< wanted, not taken yet, and not failed
    double longestReadMs = 0;
  };
  virtual Counters counters() const = 0;
  virtual bool hasFailed(std::uint32_t page) const = 0;
  /// The first failures, as findings; a page that failed is not tried again.
  virtual Findings failures() const = 0;
};

}  // namespace trimtab::terrain
