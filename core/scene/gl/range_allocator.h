#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace trimtab::scene {

/// Places in a buffer that grows, in units of the caller's. The lowest place that is large enough is given,
/// and places given back join their neighbours: so what is small and comes and goes stays dense.
class RangeAllocator {
 public:
  /// None where nothing that large is free: grow first.
  std::optional<std::uint32_t> take(std::uint32_t units);
  void give(std::uint32_t first, std::uint32_t units);
  /// To so many units in all; never less than there are.
  void growTo(std::uint32_t units);
  void clear() { *this = {}; }

  std::uint32_t size() const { return size_; }
  std::uint32_t used() const { return used_; }

 private:
  std::map<std::uint32_t, std::uint32_t> free_;  ///< first unit to units; no two touch
  std::uint32_t size_ = 0, used_ = 0;
};

}  // namespace trimtab::scene
