#include "trimtab/units/large_array.h"

#include <atomic>
#include <cstdint>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace trimtab {
namespace {

constexpr std::size_t kCacheLine = 64, kPage = 4096, kHugePage = std::size_t{2} << 20;
constexpr std::align_val_t kLineAlign{kCacheLine}, kHugeAlign{kHugePage};

// An AMD EPYC looks for a line in its first cache by a hash of address bits 12 to 27. Arrays of one length
// that lie a power of two apart would share all hashes: five streams came at half the speed.
constexpr std::size_t kColourStep = kPage + kCacheLine;

}  // namespace

void* allocateLarge(std::size_t bytes) {
  if (bytes < kHugePage) return ::operator new(bytes, kLineAlign);
  static std::atomic<std::size_t> count = 0;
  const std::size_t all = bytes + kLargeColours * kColourStep;
  auto* memory = static_cast<std::byte*>(::operator new(all, kHugeAlign));
#ifdef MADV_HUGEPAGE
  // Whole pages only, as others' memory may follow. Where the system refuses, ordinary pages serve.
  ::madvise(memory, all / kHugePage * kHugePage, MADV_HUGEPAGE);
#endif
  return memory + count++ % kLargeColours * kColourStep;
}

void freeLarge(void* memory, std::size_t bytes) {
  if (bytes < kHugePage) return ::operator delete(memory, kLineAlign);
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  ::operator delete(reinterpret_cast<void*>(address / kHugePage * kHugePage), kHugeAlign);
}

}  // namespace trimtab
