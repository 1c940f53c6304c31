#include "mapped_heights.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace trimtab::terrain {

Result<MappedHeights> MappedHeights::open(const std::filesystem::path& file, std::size_t count) {
  const std::size_t bytes = count * sizeof(float);
  const auto unreadable = [&](const std::string& found) {
    return Finding{Severity::error, file.string(), "", std::to_string(bytes) + " readable bytes", found};
  };
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return unreadable(std::strerror(errno));
  struct stat about {};
  void* at = MAP_FAILED;
  std::string found;
  if (::fstat(handle, &about) != 0)
    found = std::strerror(errno);
  else if (static_cast<std::size_t>(about.st_size) != bytes)
    found = std::to_string(about.st_size);
  else if (at = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, handle, 0); at == MAP_FAILED)
    found = std::strerror(errno);
  ::close(handle);
  if (at == MAP_FAILED) return unreadable(found);
  return MappedHeights({static_cast<const float*>(at), count});
}

MappedHeights::~MappedHeights() {
  if (!heights_.empty()) ::munmap(const_cast<float*>(heights_.data()), heights_.size_bytes());
}

}  // namespace trimtab::terrain
