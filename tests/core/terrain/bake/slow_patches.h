#pragma once

#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/patches/build.h"

/// Patches of a small terrain, and of one whose disk is slow or broken.
namespace trimtab::test {

/// Hills and a plain; a post every 30 m or so.
inline std::shared_ptr<const terrain::PatchTerrain> smallPatches(
    std::uint32_t columns, std::uint32_t rows, std::uint32_t leafCells = terrain::kFineLeafCells) {
  terrain::HeightGrid grid;
  grid.posts = {10, 50, 1.0 / 2400, 1.0 / 3600, columns, rows};
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const double x = 0.02 * c, y = 0.017 * r;
      grid.heights.push_back(static_cast<float>(400 + 260 * std::sin(x) * std::cos(1.3 * y) +
                                                40 * std::sin(5.1 * x + y) +
                                                9 * std::sin(23 * x) * std::sin(19 * y)));
    }
  const terrain::GridHeights heights(grid);
  return terrain::buildPatches(heights, terrain::defaultLeafToleranceM(grid.posts), leafCells);
}

/// As another one, with what disks do: take their time, fail, say what was not asked for.
class SlowPatches final : public terrain::PatchTerrain {
 public:
  explicit SlowPatches(std::shared_ptr<const terrain::PatchTerrain> inner,
                       std::chrono::milliseconds delay = std::chrono::milliseconds{0})
      : inner_(std::move(inner)), delay_(delay) {}

  const PatchIndex& index() const override { return inner_->index(); }
  const std::vector<terrain::PatchFacts>& facts() const override { return inner_->facts(); }
  std::uint64_t pageBytes(std::uint32_t page) const override { return inner_->pageBytes(page); }
  Result<terrain::PatchPage> readPage(std::uint32_t page) const override {
    ++begun;
    // No longer than a test may take.
    for (int ms = 0; held && ms < 20'000; ++ms) std::this_thread::sleep_for(std::chrono::milliseconds{1});
    std::this_thread::sleep_for(delay_.load());
    niceness = ::getpriority(PRIO_PROCESS, 0);
    {
      const std::lock_guard lock(mutex_);
      read_.push_back(page);
      if (broken.count(page))
        return Finding{Severity::error, "page " + std::to_string(page), "", "its checksum", "another"};
    }
    if (throws) throw std::bad_alloc();
    if (lies) page = (page + 1) % static_cast<std::uint32_t>(index().pages.size());
    return inner_->readPage(page);
  }

  void setDelay(std::chrono::milliseconds delay) { delay_ = delay; }
  /// In order.
  std::vector<std::uint32_t> read() const {
    const std::lock_guard lock(mutex_);
    return read_;
  }
  std::set<std::uint32_t> broken;  ///< set before it is used
  bool throws = false, lies = false;
  std::atomic<bool> held{false};         ///< until it is let go, no read ends
  mutable std::atomic<int> begun{0};     ///< reads
  mutable std::atomic<int> niceness{0};  ///< of the last thread that read

 private:
  std::shared_ptr<const terrain::PatchTerrain> inner_;
  std::atomic<std::chrono::milliseconds> delay_;
  mutable std::mutex mutex_;
  mutable std::vector<std::uint32_t> read_;
};

}  // namespace trimtab::test
