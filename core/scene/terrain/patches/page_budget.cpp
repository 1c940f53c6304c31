#include "page_budget.h"

#include <algorithm>

namespace trimtab::scene {
namespace {

/// Pages stand after those that they stand on: no error of theirs is larger, no number of theirs smaller.
bool isMoreUrgent(const PageWant& a, const PageWant& b) {
  return a.errorPx != b.errorPx ? a.errorPx > b.errorPx : a.page < b.page;
}

}  // namespace

void PageBudget::reset(std::vector<std::uint64_t> bytes, std::uint32_t rootPages) {
  const std::size_t pages = bytes.size();
  *this = {};
  bytesOf_ = std::move(bytes);
  rootPages_ = rootPages;
  held_.assign(pages, 0);
  drawable_.assign(pages, 0);
  aimed_.assign(pages, 0);
}

void PageBudget::aim(std::span<const PageWant> now, std::span<const PageWant> later, std::uint64_t budget) {
  ++aimNumber_;
  budget_ = budget;
  short_ = false;
  aims_.clear();
  std::uint64_t bytes = 0;
  const auto take = [&](std::span<const PageWant> wants) {
    sorted_.assign(wants.begin(), wants.end());
    std::sort(sorted_.begin(), sorted_.end(), isMoreUrgent);
    for (const PageWant& want : sorted_) {
      if (aimed_[want.page] == aimNumber_) continue;
      // The selection stops at the first page that does not fit: what depends on it would be of no use.
      if (want.page >= rootPages_ && bytes + bytesOf_[want.page] > budget_) return false;
      bytes += bytesOf_[want.page];
      aimed_[want.page] = aimNumber_;
      aims_.push_back(want);
    }
    return true;
  };
  short_ = !take(now);
  aimsNow_ = aims_.size();
  if (!short_) take(later);
}

void PageBudget::hold(std::uint32_t page) {
  if (held_[page]) return;
  held_[page] = 1;
  list_.push_back(page);
  bytes_ += bytesOf_[page];
}

void PageBudget::drop(std::uint32_t page) {
  if (!held_[page]) return;
  held_[page] = 0;
  list_.erase(std::find(list_.begin(), list_.end(), page));
  bytes_ -= bytesOf_[page];
}

std::span<const std::uint8_t> PageBudget::drawable() {
  if (!short_) return held_;
  for (const std::uint32_t page : drawableList_) drawable_[page] = 0;
  drawableList_.clear();
  for (std::size_t i = 0; i < aimsNow_; ++i) {
    const std::uint32_t page = aims_[i].page;
    if (!held_[page]) continue;
    drawable_[page] = 1;
    drawableList_.push_back(page);
  }
  return drawable_;
}

std::optional<std::uint32_t> PageBudget::toDrop(std::uint64_t coming) const {
  if (bytes_ + coming <= budget_) return {};
  std::optional<std::uint32_t> oldest;
  for (const std::uint32_t page : list_) {
    if (isAimedAt(page) || page < rootPages_) continue;
    // If several went out of use together, the finest go first.
    if (!oldest || aimed_[page] < aimed_[*oldest] || (aimed_[page] == aimed_[*oldest] && page > *oldest))
      oldest = page;
  }
  return oldest;
}

}  // namespace trimtab::scene
