#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/stop_request.h"

namespace trimtab {

namespace {

namespace fs = std::filesystem;

Finding unreadable(const fs::path& file, std::string expected, std::string found) {
  return {Severity::error, file.string(), "", std::move(expected), std::move(found)};
}

Finding unreadable(const fs::path& file, int error) {
  return unreadable(file, "a readable file", std::generic_category().message(error));
}

bool isNull(const struct stat& about) {
  return S_ISCHR(about.st_mode) && about.st_rdev == makedev(1, 3);
}

bool isTerminalAtInput(const struct stat& about) {
  struct stat input {};
  return S_ISCHR(about.st_mode) && ::isatty(STDIN_FILENO) && ::fstat(STDIN_FILENO, &input) == 0 &&
         input.st_rdev == about.st_rdev;
}

/// Reports whether the kernel makes up a file or folder when it is read. Other file systems are mounted below
/// /sys, and /proc may be mounted elsewhere, so that both the path and the file system say it.
bool isMadeByKernel(const fs::path& path) {
  constexpr decltype(statfs::f_type) kProc = 0x9fa0, kSys = 0x62656572;
  struct statfs system {};
  if (::statfs(path.c_str(), &system) == 0 && (system.f_type == kProc || system.f_type == kSys)) return true;
  std::error_code failed;
  const fs::path whole = fs::canonical(path, failed);
  const fs::path top = whole.has_relative_path() ? *whole.relative_path().begin() : fs::path();
  return !failed && (top == "proc" || top == "sys");
}

/// A pipe or a terminal may never end: neither its bytes nor the wait for them may be endless.
class Stream {
 public:
  explicit Stream(int fd) : polled_{fd, POLLIN, 0} {}
  /// Reports whether there is something to read, or the end.
  bool ready() {
    constexpr int kSliceMs = 50;
    constexpr auto kNext = std::chrono::seconds(1), kAll = std::chrono::seconds(5);
    const auto end = std::min(Clock::now() + kNext, begin_ + kAll);
    while (Clock::now() < end && !stopRequested())
      if (::poll(&polled_, 1, kSliceMs) > 0) return true;
    return false;
  }
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

 private:
  using Clock = std::chrono::steady_clock;
  pollfd polled_;
  Clock::time_point begin_ = Clock::now();
};

std::string sizeText(std::size_t bytes) {
  constexpr std::size_t kMiB = std::size_t{1} << 20;
  return std::to_string(bytes / kMiB) + " MiB";
}

Result<std::string> readFrom(int in, const fs::path& file, std::size_t mostBytes) {
  struct stat about {};
  if (::fstat(in, &about) != 0) return unreadable(file, errno);
  std::optional<Stream> stream;
  if (!S_ISREG(about.st_mode)) {
    stream.emplace(in);
    mostBytes = std::min(mostBytes, Stream::kMostBytes);
  }
  const auto tooLarge = [&] { return unreadable(file, "at most " + sizeText(mostBytes), "more"); };
  if (static_cast<std::uint64_t>(about.st_size) > mostBytes) return tooLarge();
  std::string bytes;
  // A file with holes has a size that nothing on the disk bears out.
  constexpr std::uint64_t kBlock = 512;
  bytes.reserve(static_cast<std::size_t>(std::min(static_cast<std::uint64_t>(about.st_size),
                                                  static_cast<std::uint64_t>(about.st_blocks) * kBlock)));
  std::vector<char> block(std::size_t{1} << 16);
  for (;;) {
    if (stream && !stream->ready())
      return unreadable(file, "a file, or a pipe that ends",
                        stopRequested()
                            ? "a request to stop the program"
                            : "one that is open after a second without a byte, or after five seconds");
    const ssize_t count = ::read(in, block.data(), block.size());
    if (count < 0 && (errno == EINTR || (stream && errno == EAGAIN))) continue;
    if (count < 0) return unreadable(file, errno);
    if (count == 0) return bytes;
    bytes.append(block.data(), static_cast<std::size_t>(count));
    if (bytes.size() > mostBytes) return tooLarge();
  }
}

}  // namespace

Result<Done> checkIsData(const fs::path& fileOrFolder) {
  struct stat about {};
  if (::stat(fileOrFolder.c_str(), &about) != 0 || S_ISFIFO(about.st_mode) || S_ISSOCK(about.st_mode))
    return Done{};
  const bool isDevice = S_ISCHR(about.st_mode) || S_ISBLK(about.st_mode);
  if (isDevice && !isNull(about) && !isTerminalAtInput(about))
    return unreadable(fileOrFolder, "a file on a disk, or a pipe that ends", "a device");
  if (!isDevice && isMadeByKernel(fileOrFolder))
    return unreadable(fileOrFolder,
                      S_ISDIR(about.st_mode) ? "a folder on a disk" : "a file on a disk, or a pipe that ends",
                      "a part of /proc or /sys, which the kernel makes up");
  return Done{};
}

Result<std::string> readWhole(const fs::path& file, std::size_t mostBytes) {
  return withinMemory(file, [&]() -> Result<std::string> {
    if (const auto data = checkIsData(file); !data) return data.findings();
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) return unreadable(file, "a readable file", "a folder");
    // Without O_NONBLOCK a FIFO would wait for a writer that may never come.
    const int in = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (in < 0) return unreadable(file, errno);
    const auto closing = [](const int* fd) { ::close(*fd); };
    const std::unique_ptr<const int, decltype(closing)> closed(&in, closing);
    return readFrom(in, file, mostBytes);
  });
}

namespace {

/// Sorts what is in a folder: files are visited, folders and links to folders wait for their turn. Returns
/// false where `visit` wants no more.
bool visitFolder(const fs::path& folder, const std::function<bool(const fs::path&)>& visit,
                 std::vector<fs::path>& folders, std::set<fs::path>& links, Findings& left) {
  std::error_code failed, ignored;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    if (stopRequested()) return false;
    const fs::file_type type = at->status(ignored).type();
    if (type == fs::file_type::not_found && at->is_symlink(ignored))
      left.push_back({Severity::warning, at->path().string(), "", "a file or folder", "a link to nothing"});
    const bool isFile = type == fs::file_type::regular, isFolder = type == fs::file_type::directory;
    if ((!isFile && !isFolder) || !checkIsData(at->path())) continue;
    if (isFile && !visit(at->path())) return false;
    if (isFolder && at->is_symlink(ignored)) links.insert(at->path());
    if (isFolder && !at->is_symlink(ignored)) folders.push_back(at->path());
  }
  if (failed)
    left.push_back({Severity::warning, folder.string(), "", "a folder that may be read", failed.message()});
  return true;
}

}  // namespace

Result<Done> visitFiles(const fs::path& folder, const std::function<bool(const fs::path&)>& visit) {
  if (const auto data = checkIsData(folder); !data) return data;
  Findings left;
  std::set<std::pair<dev_t, ino_t>> entered;
  std::vector<fs::path> folders{folder};
  // Links wait until no other folder is left, so that a folder is known by its own path where it has one.
  std::set<fs::path> links;
  while (!folders.empty() || !links.empty()) {
    if (folders.empty()) folders.push_back(links.extract(links.begin()).value());
    const fs::path at = std::move(folders.back());
    folders.pop_back();
    struct stat about {};
    if (::stat(at.c_str(), &about) != 0 || !entered.emplace(about.st_dev, about.st_ino).second) continue;
    const bool goesOn = visitFolder(at, visit, folders, links, left);
    if (stopRequested())
      return unreadable(folder, "to be looked through to the end", "a request to stop the program");
    if (!goesOn) break;
  }
  return {Done{}, std::move(left)};
}

Finding tooLargeForMemory(const fs::path& file) {
  return unreadable(file, "a file that this program's memory can hold", "a larger one");
}

}  // namespace trimtab
