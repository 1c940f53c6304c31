#include "trimtab/preset/file_io.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <vector>

#include "trimtab/preset/preset.h"

namespace trimtab {

namespace {

constexpr const char* kWritable = "room and permission to write it";

Finding refused(const std::filesystem::path& file, std::string expected, int error) {
  return {Severity::error, file.string(), "", std::move(expected), std::generic_category().message(error)};
}

/// Closes at the end of its scope; close() is for those who must know whether it worked.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  bool isOpen() const { return fd_ >= 0; }
  bool close() {
    const bool good = fd_ < 0 || ::close(fd_) == 0;
    fd_ = -1;
    return good;
  }

 private:
  int fd_;
};

bool writeAll(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool flushed(int fd) {
  // EINVAL, EROFS: a file system that cannot flush this has nothing to flush.
  return ::fsync(fd) == 0 || errno == EINVAL || errno == EROFS;
}

/// Gives what has reached the disk its name.
Result<Done> named(const std::filesystem::path& unfinished, const std::filesystem::path& file) {
  if (::rename(unfinished.c_str(), file.c_str()) != 0) return refused(file, kWritable, errno);
  // The new name must survive as well. It is there already: who cannot look into its folder may still write.
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  static_cast<void>(reachDisk(folder));
  return Done{};
}

/// The mode of the file that is replaced, else what the process creates files with.
mode_t modeOf(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0) return status.st_mode & 07777;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

/// The beginning of the names that writeAtomically() gives to unfinished files of a target.
std::string unfinishedPrefix(const std::filesystem::path& target) {
  return "." + target.filename().string() + ".trimtab-";
}

/// Makes an unfinished file beside the target and locks it, so that litter is known from work in hand.
/// Whoever clears litter away may have taken the file for it before it was locked; then another one is made.
int createUnfinished(const std::filesystem::path& folder, const std::string& prefix, std::string& name) {
  for (;;) {
    name = (folder / (prefix + "XXXXXX")).string();
    const int fd = ::mkostemp(name.data(), O_CLOEXEC);
    struct stat about {};
    // Where a file system has no locks, nothing is cleared away.
    if (fd < 0 || ::flock(fd, LOCK_EX) != 0 || ::fstat(fd, &about) != 0 || about.st_nlink > 0) return fd;
    ::close(fd);
  }
}

/// Removes what programs that were killed left beside the target.
void clearLitter(const std::filesystem::path& folder, const std::string& prefix) {
  std::error_code failed;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    constexpr std::size_t kRandom = 6;
    if (name.size() != prefix.size() + kRandom || !name.starts_with(prefix)) continue;
    const Descriptor there(::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
    if (there.isOpen() && ::flock(there.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
  }
}

/// For a pipe or device there is nothing to keep, and renaming over it would destroy it.
Result<Done> writeInPlace(const std::filesystem::path& file, std::string_view bytes) {
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (!out.isOpen() || !writeAll(out.get(), bytes) || !out.close()) return refused(file, kWritable, errno);
  return Done{};
}

}  // namespace

Result<Done> writeAtomically(const std::filesystem::path& file, std::string_view bytes) {
  std::error_code failed;
  // A link is kept: the file that it names is replaced.
  std::filesystem::path target = std::filesystem::weakly_canonical(file, failed);
  if (failed || target.empty()) target = file;
  const std::filesystem::file_status status = std::filesystem::status(target, failed);
  if (std::filesystem::is_directory(status))
    return Finding{Severity::error, file.string(), "", "a file's name", "a folder"};
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    return writeInPlace(target, bytes);
  if (std::filesystem::exists(status) && ::access(target.c_str(), W_OK) != 0)
    return refused(file, kWritable, errno);

  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  const std::string prefix = unfinishedPrefix(target);
  clearLitter(folder, prefix);
  std::string beside;
  Descriptor out(createUnfinished(folder, prefix, beside));
  if (!out.isOpen()) return refused(file, "a folder that can be written, " + folder.string(), errno);
  // The lock lasts until the file has its name.
  const Descriptor lock(::fcntl(out.get(), F_DUPFD_CLOEXEC, 0));
  // By the descriptor that is held: the file's mode may forbid to open it for reading.
  if (!writeAll(out.get(), bytes) || ::fchmod(out.get(), modeOf(target)) != 0 || !flushed(out.get()) ||
      !out.close()) {
    const int error = errno;
    ::unlink(beside.c_str());
    return refused(file, kWritable, error);
  }
  auto done = named(beside, target);
  if (!done) ::unlink(beside.c_str());
  return done;
}

Result<Done> reachDisk(const std::filesystem::path& fileOrFolder) {
  Descriptor opened(::open(fileOrFolder.c_str(), O_RDONLY | O_CLOEXEC));
  if (!opened.isOpen() || !flushed(opened.get()))
    return refused(fileOrFolder, "to be written to the disk", errno);
  return Done{};
}

Result<Done> canWriteIn(const std::filesystem::path& folder) {
  constexpr const char* kPrefix = ".trimtab-";
  clearLitter(folder, kPrefix);
  std::string name;
  const Descriptor made(createUnfinished(folder, kPrefix, name));
  if (!made.isOpen()) return refused(folder, "a folder that can be written", errno);
  ::unlink(name.c_str());
  return Done{};
}

Result<Done> makeWritable(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return refused(folder, "a folder that can be written", failed.value());
  return canWriteIn(folder);
}

Result<Done> putInPlace(const std::filesystem::path& unfinished, const std::filesystem::path& file) {
  if (auto done = reachDisk(unfinished); !done) return done;
  return named(unfinished, file);
}

}  // namespace trimtab
