#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace trimtab::terrain {

/// Calls `work(i)` for 0 <= i < count on all cores. `carryOn(share done)` is asked on the calling thread
/// between items; when it says no the rest is left out and the answer is false. What the work throws first
/// is thrown again here, once all threads have ended.
inline bool forEachParallel(std::uint32_t count, const std::function<void(std::uint32_t)>& work,
                            const std::function<bool(double)>& carryOn = {}) {
  std::atomic<std::uint32_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto run = [&](bool asks) {
    try {
      while (!stop) {
        const std::uint32_t i = next++;
        if (i >= count) return;
        work(i);
        if (asks && carryOn && !carryOn(static_cast<double>(std::min(next.load(), count)) / count))
          stop = true;
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
      stop = true;
    }
  };
  const unsigned cores = std::min(std::max(1u, std::thread::hardware_concurrency()), 16u);
  std::vector<std::thread> others;
  others.reserve(cores);
  try {
    for (unsigned i = 1; i < cores && i < count; ++i) others.emplace_back(run, false);
  } catch (const std::system_error&) {
    // Fewer threads do it too.
  }
  run(true);
  for (std::thread& t : others) t.join();
  if (thrown) std::rethrow_exception(thrown);
  return !stop;
}

}  // namespace trimtab::terrain
