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

/// An item of long work calls this now and then, on the thread that runs the item. If it returns false, the
/// item should return early, and the caller of the loop discards the results of all items.
using GoesOn = std::function<bool()>;

/// Calls `work(i, goesOn)` once for each 0 <= i < count, in no certain order, on the calling thread and on up
/// to 15 others, at most one per core. It starts these threads in each call, or fewer if the system refuses
/// some, and returns when all have ended. Without items it calls nothing and returns true.
///
/// Only the calling thread calls `carryOn`, with the share of items that are done, 0..1: after each of its
/// own items, whenever such an item calls `goesOn`, and every 50 ms while it waits for the other threads. If
/// `carryOn` returns false, items that have not begun are skipped, `goesOn` returns false from then on, and
/// the result is false, even if every item was done already. `carryOn` may be empty.
///
/// If `work` or `carryOn` throws, the loop stops in the same way, and the first exception is rethrown after
/// all threads have ended.
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
    // Fewer threads can do it too.
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

/// Does the same with `work(i)`, for short items that do not ask whether to go on.
template <class Work>
requires std::is_invocable_v<const Work&, std::uint32_t>
bool forEachParallel(std::uint32_t count, const Work& work, const std::function<bool(double)>& carryOn = {}) {
  return forEachParallel(
      count, [&work](std::uint32_t i, const GoesOn&) { work(i); }, carryOn);
}

}  // namespace trimtab::terrain
