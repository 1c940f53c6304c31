#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace trimtab::terrain {

/// Calls `work(i)` for 0 <= i < count on all cores. `carryOn(share done)` is asked on the calling thread
/// between items; when it says no the rest is left out and the answer is false.
inline bool forEachParallel(std::uint32_t count, const std::function<void(std::uint32_t)>& work,
                            const std::function<bool(double)>& carryOn) {
  std::atomic<std::uint32_t> next{0};
  std::atomic<bool> stop{false};
  const auto run = [&](bool asks) {
    while (!stop) {
      const std::uint32_t i = next++;
      if (i >= count) return;
      work(i);
      if (asks && carryOn && !carryOn(static_cast<double>(std::min(next.load(), count)) / count)) stop = true;
    }
  };
  const unsigned cores = std::min(std::max(1u, std::thread::hardware_concurrency()), 16u);
  std::vector<std::thread> others;
  for (unsigned i = 1; i < cores && i < count; ++i) others.emplace_back(run, false);
  run(true);
  for (std::thread& t : others) t.join();
  return !stop;
}

}  // namespace trimtab::terrain
