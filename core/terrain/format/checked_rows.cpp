#include "trimtab/terrain/format/checked_rows.h"

#include <algorithm>

#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
constexpr std::size_t kMostFindings = 20;

std::uint64_t sumOf(std::span<const std::byte> bytes) {
  return checksum({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::uint32_t CheckedRows::rowsPerBlock(std::size_t rowBytes) {
  return static_cast<std::uint32_t>(
      std::max<std::size_t>(1, kBlockBytes / std::max<std::size_t>(1, rowBytes)));
}

void CheckedRows::Sums::add(std::span<const std::byte> rows) {
  const std::size_t block = rowBytes_ * perBlock_;
  while (!rows.empty()) {
    if (open_.empty() && rows.size() >= block) {
      sums_.push_back(sumOf(rows.first(block)));
      rows = rows.subspan(block);
      continue;
    }
    const std::size_t take = std::min(rows.size(), block - open_.size());
    open_.insert(open_.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(take));
    rows = rows.subspan(take);
    if (open_.size() < block) continue;
    sums_.push_back(sumOf(open_));
    open_.clear();
  }
}

std::vector<std::uint64_t> CheckedRows::Sums::finish() {
  if (!open_.empty()) sums_.push_back(sumOf(open_));
  open_.clear();
  return std::move(sums_);
}

CheckedRows::CheckedRows(std::shared_ptr<const MappedFile> mapped, std::size_t rowBytes, std::uint32_t rows,
                         std::vector<std::uint64_t> sums, Sound sound)
    : mapped_(std::move(mapped)),
      rowBytes_(rowBytes),
      rows_(rows),
      perBlock_(rowsPerBlock(rowBytes)),
      sums_(std::move(sums)),
      sound_(std::move(sound)),
      states_(new std::atomic<std::uint8_t>[rows / perBlock_ + 1]) {
  for (std::uint32_t b = 0; b <= rows / perBlock_; ++b) states_[b] = sums_.empty() ? kGood : kUnknown;
}

bool CheckedRows::check(std::uint32_t block) const {
  const std::uint32_t first = block * perBlock_, last = std::min(first + perBlock_, rows_);
  const std::size_t at = std::size_t{first} * rowBytes_, size = std::size_t{last - first} * rowBytes_;
  mapped_->fetch(at, size);
  const auto bytes = mapped_->bytes().subspan(at, size);
  const std::uint64_t sum = sumOf(bytes);
  const bool right = sum == sums_[block], good = right && (!sound_ || sound_(bytes));
  // Another thread may have come to the same answer.
  if (states_[block].exchange(good ? kGood : kBad, std::memory_order_acq_rel) == kUnknown && !good) {
    const std::lock_guard lock(mutex_);
    if (damage_.size() < kMostFindings)
      damage_.push_back(
          {Severity::error, mapped_->file().string(),
           "rows " + std::to_string(first) + " to " + std::to_string(last - 1) + " at byte " +
               std::to_string(at),
           right ? "heights within those of the manifest" : "checksum " + hexadecimal(sums_[block]),
           right ? "others" : hexadecimal(sum)});
  }
  return good;
}

void CheckedRows::checkAll() const {
  for (std::uint32_t row = 0; row < rows_; row += perBlock_) isGood(row / perBlock_);
}

Findings CheckedRows::damage() const {
  const std::lock_guard lock(mutex_);
  return damage_;
}

}  // namespace trimtab::terrain
