#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/culling/select_patches.h"

namespace trimtab::scene {

/// Decides which pages are held within a budget of bytes, and which must go for others. What should be held
/// depends on the view and the budget, never on what was held before.
class PageBudget {
 public:
  /// Starts with no page held. `bytes` has what each page takes when it is held. The first `rootPages` pages
  /// are held whatever they cost.
  void reset(std::vector<std::uint64_t> bytes, std::uint32_t rootPages);

  /// Sets the pages to be held: those that a view needs `now`, and those that it will need `later`. In each,
  /// the pages without which the error is largest come first, as far as the budget reaches. If `now` does not
  /// fit, nothing is left for `later`.
  void aim(std::span<const PageWant> now, std::span<const PageWant> later, std::uint64_t budget);
  /// Returns them in order of their error, `later` after `now`.
  std::span<const PageWant> aims() const { return aims_; }
  bool isAimedAt(std::uint32_t page) const { return aimed_[page] == aimNumber_; }
  /// Reports whether the budget is too small for all that the view needs now.
  bool isShort() const { return short_; }

  void hold(std::uint32_t page);
  void drop(std::uint32_t page);
  bool holds(std::uint32_t page) const { return held_[page] != 0; }
  std::span<const std::uint32_t> held() const { return list_; }
  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t bytesOf(std::uint32_t page) const { return bytesOf_[page]; }
  /// Returns one flag per page, not 0 if the page is held and needed now: what a cut may be made of.
  std::span<const std::uint8_t> drawable();
  /// Returns the page that was unused for longest, if one must go before `coming` more bytes fit; unset if
  /// none must, or if all held pages are needed.
  std::optional<std::uint32_t> toDrop(std::uint64_t coming) const;

 private:
  std::vector<std::uint64_t> bytesOf_;
  std::uint32_t rootPages_ = 0;
  std::uint64_t budget_ = 0, bytes_ = 0;
  std::vector<std::uint8_t> held_, drawable_;
  std::vector<std::uint32_t> list_, drawableList_;
  std::vector<std::uint32_t> aimed_;  ///< number of the last aim that had the page
  std::uint32_t aimNumber_ = 0;
  std::vector<PageWant> aims_, sorted_;
  std::size_t aimsNow_ = 0;
  bool short_ = false;
};

}  // namespace trimtab::scene
