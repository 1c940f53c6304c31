#pragma once

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

/// Records what this program flushes and renames, by functions of its own in place of the C library's; for
/// one source file of a program. No test can cut the power, but the order says what would be left.
namespace trimtab::test {

class DiskOrder {
 public:
  static DiskOrder& instance() {
    static DiskOrder order;
    return order;
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    events_.clear();
  }
  void add(const std::string& what, const std::filesystem::path& path) {
    const std::lock_guard lock(mutex_);
    events_.push_back(what + ' ' + path.filename().string());
  }
  /// "flush NAME" or "rename NAME", in their order.
  std::vector<std::string> events() const {
    const std::lock_guard lock(mutex_);
    return events_;
  }
  /// Its place among the events; their number where it is not there.
  std::size_t placeOf(const std::string& event) const {
    const auto all = events();
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), event) - all.begin());
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> events_;
};

}  // namespace trimtab::test

extern "C" {
int fsync(int handle) {
  std::array<char, 4096> name{};
  const std::string link = "/proc/self/fd/" + std::to_string(handle);
  if (::readlink(link.c_str(), name.data(), name.size() - 1) > 0)
    trimtab::test::DiskOrder::instance().add("flush", name.data());
  return static_cast<int>(::syscall(SYS_fsync, handle));
}
int rename(const char* from, const char* to) noexcept {
  trimtab::test::DiskOrder::instance().add("rename", to);
  return static_cast<int>(::syscall(SYS_rename, from, to));
}
}
