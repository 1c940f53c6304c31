#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace trimtab::terrain {

/// Reads `size` bytes from offset `at`. Returns false, with errno set, if that fails; errno is 0 at the end
/// of the file. Several threads may use one descriptor, which streams, with their single position, do not
/// allow.
inline bool readAt(int file, std::uint64_t at, void* data, std::size_t size) {
  char* to = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::pread(file, to, size, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got == 0) errno = 0;
    if (got <= 0) return false;
    to += got, at += static_cast<std::uint64_t>(got), size -= static_cast<std::size_t>(got);
  }
  return true;
}
/// Writes `size` bytes at offset `at`. Returns false, with errno set, if that fails.
inline bool writeAt(int file, std::uint64_t at, const void* data, std::size_t size) {
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t put = ::pwrite(file, from, size, static_cast<off_t>(at));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    from += put, at += static_cast<std::uint64_t>(put), size -= static_cast<std::size_t>(put);
  }
  return true;
}

}  // namespace trimtab::terrain
