#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// The heights of a bake as one array in memory that the system may take back, which a copy would not allow.
/// Only for the work folder, whose files nobody else changes: readers of a mapped file that is cut short end
/// by SIGBUS.
class MappedHeights {
 public:
  /// Fails unless the file has `count` heights.
  static Result<MappedHeights> open(const std::filesystem::path& file, std::size_t count);
  ~MappedHeights();
  MappedHeights(MappedHeights&& other) noexcept : heights_(other.heights_) { other.heights_ = {}; }
  MappedHeights& operator=(MappedHeights&&) = delete;

  std::span<const float> span() const { return heights_; }

 private:
  explicit MappedHeights(std::span<const float> heights) : heights_(heights) {}
  std::span<const float> heights_;
};

}  // namespace trimtab::terrain
