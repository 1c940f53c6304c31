#include "trimtab/preset/file_io.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <optional>
#include <system_error>
#include <vector>

#include "descriptor.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/unfinished.h"

namespace trimtab {

namespace {

/// Writes to a pipe or device, where there is nothing to keep, and which renaming would destroy. Nobody may
/// be at the other end of a pipe, or nobody who reads from it.
Result<Done> writeInPlace(const std::filesystem::path& file, std::string_view bytes) {
  constexpr int kStandsStillMs = 2000;
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK));
  std::error_code ignored;
  if (!out.isOpen() && errno == ENXIO && std::filesystem::is_fifo(file, ignored))
    return Finding{Severity::error, file.string(), "", "a pipe that somebody reads", "one that nobody reads"};
  pollfd polled{out.get(), POLLOUT, 0};
  while (out.isOpen() && !bytes.empty()) {
    const ssize_t count = ::write(out.get(), bytes.data(), bytes.size());
    if (count >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      if (::poll(&polled, 1, kStandsStillMs) == 0)
        return Finding{Severity::error, file.string(), "", "a pipe that somebody reads to the end",
                       "one that was full for two seconds"};
    } else if (errno != EINTR) {
      return refused(file, kWritable, errno);
    }
  }
  if (!out.isOpen() || !out.close()) return refused(file, kWritable, errno);
  return Done{};
}

}  // namespace

Result<Done> writeAtomically(const std::filesystem::path& file, std::string_view bytes) {
  std::error_code failed;
  const std::filesystem::file_status there = std::filesystem::status(file, failed);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there) &&
      !std::filesystem::is_directory(there))
    return writeInPlace(file, bytes);
  auto made = Unfinished::file(file);
  if (!made) return made.findings();
  if (auto written = made->append(bytes); !written) return written;
  if (auto done = made->putInPlace(); !done) return done;
  return {Done{}, made.findings()};
}

Result<Done> writeOwn(const std::filesystem::path& file, std::string_view bytes) {
  Descriptor out(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  if (out.isOpen() && writeAll(out.get(), bytes) && out.close()) return Done{};
  return refused(file, "room to write " + std::to_string(bytes.size()) + " bytes", errno);
}

Result<Done> canReplace(const std::filesystem::path& file) {
  std::error_code failed;
  const std::filesystem::file_status there = std::filesystem::status(file, failed);
  if (!std::filesystem::exists(there)) return Done{};
  if (!std::filesystem::is_regular_file(there))
    return Finding{Severity::error, file.string(), "", "a file's name",
                   std::filesystem::is_directory(there) ? "a folder" : "a pipe or a device"};
  if (::access(file.c_str(), W_OK) != 0) return refused(file, kWritable, errno);
  return Done{};
}

Result<Done> reachDisk(const std::filesystem::path& fileOrFolder) {
  const Descriptor opened(::open(fileOrFolder.c_str(), O_RDONLY | O_CLOEXEC));
  if (!opened.isOpen() || !flushed(opened.get()))
    return refused(fileOrFolder, "to be written to the disk", errno);
  return Done{};
}

Result<Done> canWriteIn(const std::filesystem::path& folder) {
  if (const Descriptor made(openUnnamed(folder)); made.isOpen()) return Done{};
  return refused(folder, "a folder that can be written", errno);
}

Result<Done> canMake(const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  const Result<Done> writable = canWriteIn(folder);
  if (writable) return writable;
  Finding why = writable.findings().front();
  why.where = file.string();
  why.found = folder.string() + ", " + why.found;
  return why;
}

Result<Done> makeWritable(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return refused(folder, "a folder that can be written", failed.value());
  return canWriteIn(folder);
}

Result<Done> putInPlace(const std::filesystem::path& unfinished, const std::filesystem::path& file) {
  if (auto done = reachDisk(unfinished); !done) return done;
  if (::rename(unfinished.c_str(), file.c_str()) != 0) return refused(file, kWritable, errno);
  // The new name must survive as well. It is there already: who cannot look into its folder may still write.
  static_cast<void>(reachDisk(file.has_parent_path() ? file.parent_path() : "."));
  return Done{};
}

void failLargeWrites() {
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace trimtab
