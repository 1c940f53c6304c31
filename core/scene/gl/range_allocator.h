#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace trimtab::scene {

/// Gives out places in a buffer that grows, in units of the caller's. It gives the lowest place that is
/// large enough, and places given back join their neighbours, so small things that come and go stay dense.
class RangeAllocator {
 public:
  /// Returns the first unit of a place; unset if none so large is free, so that the caller must grow first.
  std::optional<std::uint32_t> take(std::uint32_t units);
  void give(std::uint32_t first, std::uint32_t units);
  /// Grows to so many units in all. Never shrinks.
  void growTo(std::uint32_t units);
  void clear() { *this = {}; }

  std::uint32_t size() const { return size_; }
  std::uint32_t used() const { return used_; }

 private:
  std::map<std::uint32_t, std::uint32_t> free_;  ///< first unit to units; no two touch
  std::uint32_t size_ = 0, used_ = 0;
};

}  // namespace trimtab::scene
