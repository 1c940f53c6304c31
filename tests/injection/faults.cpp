#include "faults.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <string>
#include <string_view>

namespace trimtab::test::faults {
namespace {

std::string watched;
std::atomic<long> count{-1}, disturbed{-1};
std::atomic<bool> done{false}, unnamed{true};
std::atomic<Way> wanted{Way::killed};

bool isWatched(std::string_view path) {
  return count >= 0 && path.substr(0, watched.size()) == watched;
}
bool isWatched(int handle) {
  if (count < 0) return false;
  std::array<char, 4096> name{};
  const std::string link = "/proc/self/fd/" + std::to_string(handle);
  const long length = ::syscall(SYS_readlink, link.c_str(), name.data(), name.size());
  return length > 0 && isWatched(std::string_view(name.data(), static_cast<std::size_t>(length)));
}

/// One call that is counted: what is to become of it.
class Call {
 public:
  template <class File>
  explicit Call(const File& file) : mine_(isWatched(file) && count++ == disturbed) {}
  /// Fails as wanted, if the call can; then errno is set.
  bool fails() const {
    if (!mine_) return false;
    const Way way = wanted;
    errno = way == Way::no_space        ? ENOSPC
            : way == Way::io_error      ? EIO
            : way == Way::no_permission ? EACCES
            : way == Way::interrupted   ? EINTR
                                        : 0;
    done = done || errno != 0;
    return errno != 0;
  }
  std::size_t shortened(std::size_t size) const {
    if (!mine_ || wanted != Way::short_count || size < 2) return size;
    done = true;
    return size / 2;
  }
  /// The end of a call that was done.
  template <class T>
  T ended(T result) const {
    if (mine_ && wanted == Way::killed) ::kill(::getpid(), SIGKILL);
    return result;
  }

 private:
  bool mine_;
};

template <class T, class File, class Work>
T call(const File& file, T failure, const Work& work) {
  const Call call(file);
  return call.fails() ? failure : call.ended(static_cast<T>(work(call)));
}

int opened(int folder, const char* path, int flags, mode_t mode) {
  if ((flags & O_TMPFILE) == O_TMPFILE && !unnamed) {
    errno = EOPNOTSUPP;
    return -1;
  }
  return call(std::string_view(path), -1,
              [&](const Call&) { return ::syscall(SYS_openat, folder, path, flags, mode); });
}

/// The C library's own streams are opened without open().
FILE* openedStream(const char* name, const char* path, const char* mode) {
  using Function = FILE* (*)(const char*, const char*);
  const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
  return call(std::string_view(path), static_cast<FILE*>(nullptr),
              [&](const Call&) { return real(path, mode); });
}
constexpr std::string_view kAnySocket = kSockets;

}  // namespace

const char* nameOf(Way way) {
  constexpr const char* kNames[] = {"ENOSPC", "EIO", "EACCES", "EINTR", "short", "killed"};
  return kNames[static_cast<int>(way)];
}
void haveUnnamedFiles(bool have) {
  unnamed = have;
}
void watch(const std::filesystem::path& folder) {
  watched = folder.string();
  disturbed = -1;
  done = false;
  count = 0;
}
void stop() {
  count = -1;
}
void disturb(long number, Way way) {
  wanted = way;
  disturbed = number;
}
long calls() {
  return count;
}
bool happened() {
  return done;
}

}  // namespace trimtab::test::faults

using namespace trimtab::test::faults;

extern "C" {

#define TRIMTAB_OPEN(name, ...)                            \
  int name(__VA_ARGS__ const char* path, int flags, ...) { \
    mode_t mode = 0;                                       \
    if ((flags & (O_CREAT | O_TMPFILE)) != 0) {            \
      va_list more;                                        \
      va_start(more, flags);                               \
      mode = va_arg(more, mode_t);                         \
      va_end(more);                                        \
    }                                                      \
    return opened(TRIMTAB_FOLDER, path, flags, mode);      \
  }
#define TRIMTAB_FOLDER AT_FDCWD
TRIMTAB_OPEN(open)
TRIMTAB_OPEN(open64)
#undef TRIMTAB_FOLDER
#define TRIMTAB_FOLDER folder
TRIMTAB_OPEN(openat, int folder, )
TRIMTAB_OPEN(openat64, int folder, )

int mkostemp(char* pattern, int flags) {
  using Function = int (*)(char*, int);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "mkostemp"));
  return call(std::string_view(pattern), -1, [&](const Call&) { return real(pattern, flags); });
}
ssize_t write(int handle, const void* bytes, size_t size) {
  return call(handle, ssize_t{-1},
              [&](const Call& c) { return ::syscall(SYS_write, handle, bytes, c.shortened(size)); });
}
ssize_t writev(int handle, const iovec* parts, int number) {
  return call(handle, ssize_t{-1}, [&](const Call& c) {
    // As a full disk does: the first part only, and half of it.
    const size_t half = c.shortened(parts[0].iov_len);
    return half < parts[0].iov_len ? ::syscall(SYS_write, handle, parts[0].iov_base, half)
                                   : ::syscall(SYS_writev, handle, parts, number);
  });
}
ssize_t pwrite(int handle, const void* bytes, size_t size, off_t at) {
  return call(handle, ssize_t{-1},
              [&](const Call& c) { return ::syscall(SYS_pwrite64, handle, bytes, c.shortened(size), at); });
}
ssize_t pwrite64(int handle, const void* bytes, size_t size, off_t at) {
  return pwrite(handle, bytes, size, at);
}
ssize_t read(int handle, void* bytes, size_t size) {
  return call(handle, ssize_t{-1},
              [&](const Call& c) { return ::syscall(SYS_read, handle, bytes, c.shortened(size)); });
}
ssize_t pread(int handle, void* bytes, size_t size, off_t at) {
  return call(handle, ssize_t{-1},
              [&](const Call& c) { return ::syscall(SYS_pread64, handle, bytes, c.shortened(size), at); });
}
ssize_t pread64(int handle, void* bytes, size_t size, off_t at) {
  return pread(handle, bytes, size, at);
}
int fsync(int handle) {
  return call(handle, -1, [&](const Call&) { return ::syscall(SYS_fsync, handle); });
}
int ftruncate(int handle, off_t size) noexcept {
  return call(handle, -1, [&](const Call&) { return ::syscall(SYS_ftruncate, handle, size); });
}
int ftruncate64(int handle, off_t size) noexcept {
  return ftruncate(handle, size);
}
int rename(const char* from, const char* to) noexcept {
  return call(std::string_view(to), -1, [&](const Call&) { return ::syscall(SYS_rename, from, to); });
}
int renameat2(int fromFolder, const char* from, int toFolder, const char* to, unsigned flags) noexcept {
  return call(std::string_view(to), -1,
              [&](const Call&) { return ::syscall(SYS_renameat2, fromFolder, from, toFolder, to, flags); });
}
int linkat(int fromFolder, const char* from, int toFolder, const char* to, int flags) noexcept {
  return call(std::string_view(to), -1,
              [&](const Call&) { return ::syscall(SYS_linkat, fromFolder, from, toFolder, to, flags); });
}
int mkdir(const char* path, mode_t mode) noexcept {
  return call(std::string_view(path), -1, [&](const Call&) { return ::syscall(SYS_mkdir, path, mode); });
}
int unlink(const char* path) noexcept {
  return call(std::string_view(path), -1, [&](const Call&) { return ::syscall(SYS_unlink, path); });
}
void* mmap(void* at, size_t size, int protection, int flags, int handle, off_t offset) noexcept {
  const auto map = [&] { return ::syscall(SYS_mmap, at, size, protection, flags, handle, offset); };
  if (handle < 0) return reinterpret_cast<void*>(map());
  return reinterpret_cast<void*>(call(handle, long{-1}, [&](const Call&) { return map(); }));
}
void* mmap64(void* at, size_t size, int protection, int flags, int handle, off_t offset) noexcept {
  return mmap(at, size, protection, flags, handle, offset);
}
FILE* fopen(const char* path, const char* mode) {
  return openedStream("fopen", path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  return openedStream("fopen64", path, mode);
}
int socket(int domain, int type, int protocol) noexcept {
  return call(kAnySocket, -1, [&](const Call&) { return ::syscall(SYS_socket, domain, type, protocol); });
}
int bind(int handle, const sockaddr* address, socklen_t size) noexcept {
  return call(handle, -1, [&](const Call&) { return ::syscall(SYS_bind, handle, address, size); });
}
int connect(int handle, const sockaddr* address, socklen_t size) {
  return call(handle, -1, [&](const Call&) { return ::syscall(SYS_connect, handle, address, size); });
}
int getsockname(int handle, sockaddr* address, socklen_t* size) noexcept {
  return call(handle, -1, [&](const Call&) { return ::syscall(SYS_getsockname, handle, address, size); });
}
int setsockopt(int handle, int level, int option, const void* value, socklen_t size) noexcept {
  return call(handle, -1,
              [&](const Call&) { return ::syscall(SYS_setsockopt, handle, level, option, value, size); });
}
ssize_t recvmsg(int handle, msghdr* message, int flags) {
  return call(handle, ssize_t{-1}, [&](const Call& c) {
    iovec& part = message->msg_iov[0];
    part.iov_len = c.shortened(part.iov_len);
    return ::syscall(SYS_recvmsg, handle, message, flags);
  });
}
ssize_t send(int handle, const void* bytes, size_t size, int flags) {
  return call(handle, ssize_t{-1}, [&](const Call& c) {
    return ::syscall(SYS_sendto, handle, bytes, c.shortened(size), flags, nullptr, 0);
  });
}
ssize_t sendto(int handle, const void* bytes, size_t size, int flags, const sockaddr* to, socklen_t toSize) {
  return call(handle, ssize_t{-1}, [&](const Call& c) {
    return ::syscall(SYS_sendto, handle, bytes, c.shortened(size), flags, to, toSize);
  });
}
int ppoll(pollfd* polled, nfds_t number, const timespec* wait, const sigset_t* mask) {
  // The system call changes the time that it is given.
  timespec left = wait ? *wait : timespec{};
  return call(polled[0].fd, -1, [&](const Call&) {
    return ::syscall(SYS_ppoll, polled, number, wait ? &left : nullptr, mask, _NSIG / 8);
  });
}
}
