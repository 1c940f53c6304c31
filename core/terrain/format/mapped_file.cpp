#include "trimtab/terrain/format/mapped_file.h"
#include "trimtab/terrain/grid/progress.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace trimtab::terrain {

Result<std::shared_ptr<const MappedFile>> MappedFile::open(const std::filesystem::path& file) {
  const auto unreadable = [&](const char* found) {
    return Finding{Severity::error, file.string(), "", "a readable file", found};
  };
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return unreadable(std::strerror(errno));
  struct stat about {};
  std::shared_ptr<MappedFile> mapped(new MappedFile(file));
  if (::fstat(handle, &about) != 0 || !S_ISREG(about.st_mode)) {
    ::close(handle);
    return unreadable("no regular file");
  }
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size > 0) {
    void* at = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, handle, 0);
    if (at == MAP_FAILED) {
      const int error = errno;
      ::close(handle);
      return unreadable(std::strerror(error));
    }
    mapped->bytes_ = {static_cast<const std::byte*>(at), size};
  }
  ::close(handle);
  return std::shared_ptr<const MappedFile>(std::move(mapped));
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

void MappedFile::fetch(std::size_t at, std::size_t size) const {
  constexpr std::size_t kPage = 4096;
  const std::size_t from = at / kPage * kPage;
  if (at + size > bytes_.size() || size < 2 * kPage) return;
  ::madvise(const_cast<std::byte*>(bytes_.data()) + from, at + size - from, MADV_WILLNEED);
}

void MappedFile::forget(std::size_t at, std::size_t size) const {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t first = (at + page - 1) / page * page, end = (at + size) / page * page;
  if (end <= first || end > bytes_.size()) return;
  ::madvise(const_cast<std::byte*>(bytes_.data()) + first, end - first, MADV_DONTNEED);
}

}  // namespace trimtab::terrain
