#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace trimtab {

/// Holds one value per variant of each patch, patch by patch.
template <class T>
class VariantTable {
 public:
  VariantTable() = default;  ///< one variant, no patches
  /// `variants` must not be 0.
  explicit VariantTable(std::size_t variants, std::size_t patches = 0)
      : variants_(variants), values_(variants * patches) {}

  std::size_t variants() const { return variants_; }
  std::size_t size() const { return values_.size() / variants_; }  ///< patches
  void resize(std::size_t patches) { values_.resize(patches * variants_); }
  /// Adds a patch with one value per variant.
  void push_back(std::span<const T> patch) { values_.insert(values_.end(), patch.begin(), patch.end()); }

  std::span<const T> operator[](std::size_t patch) const {
    return {values_.data() + patch * variants_, variants_};
  }
  std::span<T> operator[](std::size_t patch) { return {values_.data() + patch * variants_, variants_}; }
  std::span<const T> values() const { return values_; }
  /// Returns the values of some patches.
  std::span<T> values(std::size_t first, std::size_t patches) {
    return {values_.data() + first * variants_, patches * variants_};
  }

  friend bool operator==(const VariantTable&, const VariantTable&) = default;

 private:
  std::size_t variants_ = 1;
  std::vector<T> values_;
};

}  // namespace trimtab
