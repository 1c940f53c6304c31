#pragma once

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "trimtab/units/result.h"

namespace trimtab {

/// A file handle, closed at the end of its scope; close() is for those who must know whether it worked.
class Descriptor {
 public:
  explicit Descriptor(int handle = -1) : handle_(handle) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  int get() const { return handle_; }
  bool isOpen() const { return handle_ >= 0; }
  bool close() { return handle_ < 0 || ::close(std::exchange(handle_, -1)) == 0; }

 private:
  int handle_;
};

inline constexpr const char* kWritable = "room and permission to write it";

inline Finding refused(const std::filesystem::path& file, std::string expected, int error) {
  return {Severity::error, file.string(), "", std::move(expected), std::generic_category().message(error)};
}

/// If it fails, errno has the reason.
inline bool writeAll(int handle, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(handle, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

inline bool flushed(int handle) {
  // EINVAL, EROFS: a file system that cannot flush this has nothing to flush.
  return ::fsync(handle) == 0 || errno == EINVAL || errno == EROFS;
}

}  // namespace trimtab
