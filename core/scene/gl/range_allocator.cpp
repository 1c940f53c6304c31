#include "range_allocator.h"

#include <algorithm>
#include <cassert>
#include <iterator>

namespace trimtab::scene {

std::optional<std::uint32_t> RangeAllocator::take(std::uint32_t units) {
  const auto place =
      std::find_if(free_.begin(), free_.end(), [units](const auto& range) { return range.second >= units; });
  if (place == free_.end()) return {};
  const auto [first, length] = *place;
  free_.erase(place);
  if (length > units) free_.emplace(first + units, length - units);
  used_ += units;
  return first;
}

void RangeAllocator::give(std::uint32_t first, std::uint32_t units) {
  assert(units <= used_ && first + units <= size_);
  used_ -= units;
  auto after = free_.lower_bound(first);
  if (after != free_.end() && after->first == first + units) {
    units += after->second;
    after = free_.erase(after);
  }
  if (after != free_.begin()) {
    const auto before = std::prev(after);
    if (before->first + before->second == first) {
      before->second += units;
      return;
    }
  }
  free_.emplace(first, units);
}

void RangeAllocator::growTo(std::uint32_t units) {
  if (units <= size_) return;
  const std::uint32_t more = units - size_, first = size_;
  size_ = units;
  used_ += more;
  give(first, more);
}

}  // namespace trimtab::scene
