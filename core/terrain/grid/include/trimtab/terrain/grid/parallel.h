#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <type_traits>
#include <vector>

namespace trimtab::terrain {

/// Long work calls this now and then, on any thread; if it returns false, the work stops and is discarded.
using GoesOn = std::function<bool()>;

/// Calls `work(i, goesOn)` for 0 <= i < count on up to 16 cores, and returns when all calls have ended. Calls
/// `carryOn(fraction done)` on the calling thread: between items, when its work calls `goesOn`, and while it
/// waits for others. If `carryOn` returns false, the remaining items are skipped and the result is false. The
/// first exception of `work` is rethrown after all threads have ended.
inline bool forEachParallel(std::uint32_t count,
                            const std::function<void(std::uint32_t, const GoesOn&)>& work,
                            const std::function<bool(double)>& carryOn = {}) {
  std::atomic<std::uint32_t> next{0}, done{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::condition_variable ended;
  std::exception_ptr thrown;
  const GoesOn goesOn = [&] { return !stop; };
  const GoesOn asked = [&] {
    if (!stop && carryOn && !carryOn(static_cast<double>(done) / count)) stop = true;
    return !stop;
  };
  const auto caught = [&](const auto& call) {
    try {
      call();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
      stop = true;
    }
  };
  const auto run = [&](const GoesOn& within, bool asks) {
    while (!stop) {
      const std::uint32_t i = next++;
      if (i >= count) return;
      work(i, within);
      ++done;
      if (asks) asked();
    }
  };
  const unsigned cores = std::min(std::max(1u, std::thread::hardware_concurrency()), 16u);
  std::vector<std::thread> others;
  others.reserve(cores);
  unsigned working = 0;  // guarded
  const auto help = [&] {
    caught([&] { run(goesOn, false); });
    const std::lock_guard lock(mutex);
    --working;
    ended.notify_one();
  };
  try {
    for (unsigned i = 1; i < cores && i < count; ++i) {
      {
        const std::lock_guard lock(mutex);
        ++working;
      }
      others.emplace_back(help);
    }
  } catch (const std::system_error&) {
    // Fewer threads do it too.
    const std::lock_guard lock(mutex);
    --working;
  }
  caught([&] { run(asked, true); });
  caught([&] {
    const auto allEnded = [&] {
      std::unique_lock lock(mutex);
      return ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return working == 0; });
    };
    while (!allEnded()) asked();
  });
  for (std::thread& t : others) t.join();
  if (thrown) std::rethrow_exception(thrown);
  return !stop;
}

/// The same for short work that does not check for cancellation.
template <class Work>
requires std::is_invocable_v<const Work&, std::uint32_t>
bool forEachParallel(std::uint32_t count, const Work& work, const std::function<bool(double)>& carryOn = {}) {
  return forEachParallel(
      count, [&work](std::uint32_t i, const GoesOn&) { work(i); }, carryOn);
}

}  // namespace trimtab::terrain
