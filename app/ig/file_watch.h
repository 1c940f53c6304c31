#pragma once

#include <sys/stat.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "trimtab/preset/file_io.h"
#include "trimtab/units/result.h"

namespace trimtab::ig {

/// Notices a changed file by its inode, size and time, so that both replacing and rewriting it are seen. A
/// link is followed, so a link that leads elsewhere is a changed file.
class FileWatch {
 public:
  static constexpr double kPeriodS = 0.2;

  explicit FileWatch(std::filesystem::path file) : file_(std::move(file)), seen_(stampOf(file_)) {}
  /// Reports whether the file is another one than at the last call. It is false while it is missing.
  bool changed();

 private:
  struct Stamp {
    ino_t inode = 0;
    off_t size = 0;
    timespec time{};
  };
  static std::optional<Stamp> stampOf(const std::filesystem::path& file);

  std::filesystem::path file_;
  std::optional<Stamp> seen_;
};

/// Loads a file again whenever it is another one, on a thread of its own: no frame waits for a disk, nor for
/// a file that takes long to read.
template <class T>
class Watch {
 public:
  /// `load` reads the file; `tell` is called when there is something to take. Both are called on the thread.
  Watch(std::filesystem::path file, std::function<Result<T>()> load, std::function<void()> tell)
      : file_(file), watch_(std::move(file)), load_(std::move(load)), tell_(std::move(tell)) {
    thread_ = std::jthread([this](const std::stop_token& stop) { look(stop); });
  }

  /// Returns what a changed file held, or why it is refused; each change once, in their order. Returns
  /// nothing if nothing changed, or while it is read. Does not wait.
  std::optional<Result<T>> take() {
    if (!news_) return std::nullopt;
    const std::lock_guard lock(mutex_);
    Result<T> first = std::move(loaded_.front());
    loaded_.pop_front();
    news_ = !loaded_.empty();
    return first;
  }

 private:
  void look(const std::stop_token& stop) {
    const auto period = std::chrono::duration<double>(FileWatch::kPeriodS);
    for (std::unique_lock lock(mutex_);
         !wake_.wait_for(lock, stop, period, [&stop] { return stop.stop_requested(); });) {
      lock.unlock();
      std::optional<Result<T>> loaded;
      if (watch_.changed()) loaded = withinMemory(file_, load_);
      lock.lock();
      if (!loaded) continue;
      loaded_.push_back(std::move(*loaded));
      news_ = true;
      tell_();
    }
  }

  std::filesystem::path file_;
  FileWatch watch_;
  std::function<Result<T>()> load_;
  std::function<void()> tell_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<Result<T>> loaded_;
  std::atomic<bool> news_{false};
  std::jthread thread_;  ///< the last member, so that it ends before the others do
};

}  // namespace trimtab::ig
