#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/store.h"

/// A file of pages, its checksums made right so that its lies are believed: refused with reasons, or every
/// blob is read within the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size >= 64 && data[0] % 2 == 0) {
    std::uint64_t tableAt = 0;
    std::memcpy(&tableAt, &bytes[24], 8);
    if (tableAt <= size) {
      const std::uint64_t sum = terrain::checksum(std::string_view(bytes).substr(tableAt));
      std::memcpy(&bytes[40], &sum, 8);
    }
    const std::uint64_t sum = terrain::checksum(std::string_view(bytes).substr(0, 56));
    std::memcpy(&bytes[56], &sum, 8);
  }
  const int file = ::memfd_create("pages", 0);
  if (::write(file, bytes.data(), size) != static_cast<ssize_t>(size)) std::abort();
  {
    const auto pages = terrain::PageFile::open("/proc/self/fd/" + std::to_string(file));
    if (!pages && pages.findings().empty()) std::abort();
    if (pages) {
      const auto checked = (*pages)->checkAll();
      if (!checked && checked.findings().empty()) std::abort();
    }
  }
  ::close(file);
  return 0;
}
