#pragma once

#include <cstddef>
#include <vector>

namespace trimtab {

/// Allocates memory that begins at a cache line. From 2 MiB on it asks the system for huge pages, and any
/// kLargeColours arrays allocated in turn begin at different places of a page, so that arrays of one length
/// can be read together at the memory's speed.
void* allocateLarge(std::size_t bytes);
void freeLarge(void* memory, std::size_t bytes);
inline constexpr std::size_t kLargeColours = 8;

template <class T>
struct LargePages {
  using value_type = T;
  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) {}
  static_assert(alignof(T) <= 64);
  T* allocate(std::size_t count) { return static_cast<T*>(allocateLarge(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t count) { freeLarge(memory, count * sizeof(T)); }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }
};

template <class T>
using LargeArray = std::vector<T, LargePages<T>>;

}  // namespace trimtab
