#include "trimtab/terrain/format/checked_rows.h"

#include <algorithm>

#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/format/unchecked.h"

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

CheckedRows::CheckedRows(std::shared_ptr<const StoredFile> file, std::size_t rowBytes, std::uint32_t rows,
                         std::vector<std::uint64_t> sums, Sound sound, std::size_t mostBytes)
    : file_(std::move(file)),
      rowBytes_(rowBytes),
      rows_(rows),
      perBlock_(rowsPerBlock(rowBytes)),
      sums_(std::move(sums)),
      sound_(std::move(sound)),
      unchecked_(Unchecked::any()),
      mostBlocks_(std::max<std::size_t>(1, mostBytes / (perBlock_ * std::max<std::size_t>(1, rowBytes)))),
      slots_(sums_.size()) {}

std::shared_ptr<const CheckedRows::Block> CheckedRows::readBlock(std::uint32_t number,
                                                                 Findings& findings) const {
  const std::uint32_t first = number * perBlock_, last = std::min(first + perBlock_, rows_);
  const std::uint64_t at = std::uint64_t{first} * rowBytes_;
  auto block = std::make_shared<Block>(std::size_t{last - first} * rowBytes_);
  const auto damaged = [&](const std::string& expected, const std::string& found) {
    findings.push_back({Severity::error, file_->file().string(),
                        "rows " + std::to_string(first) + " to " + std::to_string(last - 1) + " at byte " +
                            std::to_string(at),
                        expected, found});
    return nullptr;
  };
  if (const auto read = file_->read(at, *block); !read)
    return damaged(read.findings()[0].expected, read.findings()[0].found);
  if (unchecked_) return block;
  if (const std::uint64_t sum = sumOf(*block); sum != sums_[number])
    return damaged("checksum " + hexadecimal(sums_[number]), hexadecimal(sum));
  if (sound_ && !sound_(*block)) return damaged("heights within those of the manifest", "others");
  return block;
}

std::shared_ptr<const CheckedRows::Block> CheckedRows::block(std::uint32_t number) const {
  {
    const std::lock_guard lock(mutex_);
    const Slot& slot = slots_[number];
    if (slot.block || slot.damaged) return slot.block;
  }
  Findings findings;
  auto block = readBlock(number, findings);
  const std::lock_guard lock(mutex_);
  Slot& slot = slots_[number];
  // Another thread may have come to an answer meanwhile.
  if (slot.block || slot.damaged) return slot.block;
  slot = {block, !block};
  if (!block) {
    if (damage_.size() < kMostFindings) damage_.insert(damage_.end(), findings.begin(), findings.end());
    return nullptr;
  }
  inMemory_.push_back(number);
  if (inMemory_.size() > mostBlocks_) {
    slots_[inMemory_.front()].block.reset();
    inMemory_.pop_front();
  }
  return block;
}

void CheckedRows::checkAll() const {
  for (std::uint32_t number = 0; number < slots_.size(); ++number) {
    {
      const std::lock_guard lock(mutex_);
      if (slots_[number].damaged) continue;
    }
    Findings findings;
    if (readBlock(number, findings)) continue;
    const std::lock_guard lock(mutex_);
    slots_[number] = {nullptr, true};
    if (damage_.size() < kMostFindings) damage_.insert(damage_.end(), findings.begin(), findings.end());
  }
}

Findings CheckedRows::damage() const {
  const std::lock_guard lock(mutex_);
  return damage_;
}

}  // namespace trimtab::terrain
