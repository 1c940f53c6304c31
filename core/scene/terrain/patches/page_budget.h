#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/culling/select_patches.h"

namespace trimtab::scene {

/// Which pages are to be held within a budget of bytes, and which have to go for others. What is to be held
/// depends on the view and the budget, never on what was held before.
class PageBudget {
 public:
  /// `bytes` of each page when it is held; nothing is. `rootPages`: the first so many are held whatever they
  /// cost.
  void reset(std::vector<std::uint64_t> bytes, std::uint32_t rootPages);

  /// `now` is what a view has a use for, `later` what it will: of each, the pages without which the error is
  /// largest, as far as the budget reaches. Where `now` does not fit, nothing is left for `later`.
  void aim(std::span<const PageWant> now, std::span<const PageWant> later, std::uint64_t budget);
  /// In order of their error, `later` after `now`.
  std::span<const PageWant> aims() const { return aims_; }
  bool isAimedAt(std::uint32_t page) const { return aimed_[page] == aimNumber_; }
  /// The budget does not hold all that the view has a use for.
  bool isShort() const { return short_; }

  void hold(std::uint32_t page);
  void drop(std::uint32_t page);
  bool holds(std::uint32_t page) const { return held_[page] != 0; }
  std::span<const std::uint32_t> held() const { return list_; }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t bytesOf(std::uint32_t page) const { return bytesOf_[page]; }
  /// Not 0 where a page is held and is part of what is aimed at for now: what a cut may be made of.
  std::span<const std::uint8_t> drawable();
  /// The page that has been out of use for longest, if one has to go before `coming` bytes more fit; none
  /// also when all that is held is aimed at.
  std::optional<std::uint32_t> toDrop(std::uint64_t coming) const;

 private:
  std::vector<std::uint64_t> bytesOf_;
  std::uint32_t rootPages_ = 0;
  std::uint64_t budget_ = 0, bytes_ = 0;
  std::vector<std::uint8_t> held_, drawable_;
  std::vector<std::uint32_t> list_, drawableList_;
  std::vector<std::uint32_t> aimed_;  ///< number of the last aim that a page was in: when it was last of use
  std::uint32_t aimNumber_ = 0;
  std::vector<PageWant> aims_, sorted_;
  std::size_t aimsNow_ = 0;
  bool short_ = false;
};

}  // namespace trimtab::scene
