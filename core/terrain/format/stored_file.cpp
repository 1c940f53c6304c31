#include "trimtab/terrain/format/stored_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "trimtab/preset/file_io.h"

namespace trimtab::terrain {

Result<std::shared_ptr<const StoredFile>> StoredFile::open(const std::filesystem::path& file) {
  const auto unreadable = [&](const char* found) {
    return Finding{Severity::error, file.string(), "", "a readable file", found};
  };
  if (const auto data = checkIsData(file); !data) return data.findings();
  // Without O_NONBLOCK a FIFO would wait for a writer.
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (handle < 0) return unreadable(std::strerror(errno));
  struct stat about {};
  if (::fstat(handle, &about) != 0 || !S_ISREG(about.st_mode)) {
    ::close(handle);
    return unreadable("no regular file");
  }
  return std::shared_ptr<const StoredFile>(
      new StoredFile(file, handle, static_cast<std::uint64_t>(about.st_size)));
}

StoredFile::~StoredFile() {
  ::close(handle_);
}

Result<Done> StoredFile::read(std::uint64_t at, std::span<std::byte> bytes) const {
  std::size_t have = 0;
  while (have < bytes.size()) {
    const ssize_t got =
        ::pread(handle_, bytes.data() + have, bytes.size() - have, static_cast<off_t>(at + have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      return Finding{Severity::error, file_.string(), "byte " + std::to_string(at + have), "a readable file",
                     std::strerror(errno)};
    if (got == 0)
      return Finding{Severity::error, file_.string(), "byte " + std::to_string(at + have),
                     std::to_string(bytes.size()) + " bytes from byte " + std::to_string(at),
                     "the end of the file, which was cut short after it was opened"};
    have += static_cast<std::size_t>(got);
  }
  return Done{};
}

}  // namespace trimtab::terrain
