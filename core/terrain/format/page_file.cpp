#include "trimtab/terrain/format/page_file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <string>

#include "trimtab/preset/unfinished.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/format/stored_file.h"
#include "trimtab/terrain/format/unchecked.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAlignment = 16;
constexpr std::array<char, 8> kMagic{'t', 't', 'p', 'a', 'g', 'e', 's', '\n'};
constexpr std::uint32_t kVersion = 1;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion, headerBytes = 64;
  std::uint64_t fileBytes = 0, tableAt = 0, count = 0, tableSum = 0, unused = 0;
  std::uint64_t sum = 0;  ///< of what stands before it
};
static_assert(sizeof(Header) == 64);

struct Entry {
  std::uint64_t key = 0, at = 0, bytes = 0, sum = 0;
};
static_assert(sizeof(Entry) == 32);

std::string_view textOf(const void* data, std::size_t size) {
  return {static_cast<const char*>(data), size};
}
std::uint64_t sumOf(const Header& header) {
  return checksum(textOf(&header, sizeof header - sizeof header.sum));
}
Finding wrong(const fs::path& file, std::string place, std::string expected, std::string found) {
  return {Severity::error, file.string(), std::move(place), std::move(expected), std::move(found)};
}
std::string bytesText(std::uint64_t bytes) {
  return std::to_string(bytes) + " bytes";
}

class StoredPages final : public PageFile {
 public:
  StoredPages(std::shared_ptr<const StoredFile> stored, const Header& header, std::vector<Entry> entries)
      : stored_(std::move(stored)), header_(header), entries_(std::move(entries)) {}

  std::size_t size() const override { return entries_.size(); }
  std::uint64_t bytes() const override { return header_.fileBytes; }
  std::uint64_t checksum() const override { return header_.sum; }
  bool has(std::uint64_t key) const override { return find(key) != nullptr; }
  std::uint64_t bytesOf(std::uint64_t key) const override {
    const Entry* entry = find(key);
    return entry ? entry->bytes : 0;
  }
  Result<std::vector<std::byte>> read(std::uint64_t key) const override {
    const Entry* entry = find(key);
    if (!entry) return wrong(stored_->file(), "blob " + std::to_string(key), "one of this key", "nothing");
    auto blob = readChecked(*entry);
    if (!blob) keep(blob.findings());
    return blob;
  }
  Findings damage() const override {
    const std::lock_guard lock(mutex_);
    return damage_;
  }
  Result<Done> checkAll() const override {
    Findings findings;
    for (const Entry& entry : entries_) {
      const auto blob = readChecked(entry);
      findings.insert(findings.end(), blob.findings().begin(), blob.findings().end());
    }
    if (!findings.empty()) return findings;
    return Done{};
  }

 private:
  const Entry* find(std::uint64_t key) const {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), key,
                                     [](const Entry& e, std::uint64_t k) { return e.key < k; });
    return at != entries_.end() && at->key == key ? &*at : nullptr;
  }

  Result<std::vector<std::byte>> readChecked(const Entry& entry) const {
    std::vector<std::byte> blob(entry.bytes);
    if (const auto done = stored_->read(entry.at, blob); !done) return done.findings();
    if (unchecked_) return blob;
    const std::uint64_t sum = terrain::checksum(textOf(blob.data(), blob.size()));
    if (sum == entry.sum) return blob;
    return wrong(stored_->file(),
                 "blob " + std::to_string(entry.key) + " at byte " + std::to_string(entry.at),
                 "checksum " + hexadecimal(entry.sum), hexadecimal(sum));
  }
  void keep(const Findings& findings) const {
    constexpr std::size_t kMost = 20;
    const std::lock_guard lock(mutex_);
    for (const Finding& finding : findings)
      if (damage_.size() < kMost && std::find(damage_.begin(), damage_.end(), finding) == damage_.end())
        damage_.push_back(finding);
  }

  std::shared_ptr<const StoredFile> stored_;
  Header header_;
  std::vector<Entry> entries_;
  const bool unchecked_ = Unchecked::any();
  mutable std::mutex mutex_;
  mutable Findings damage_;
};

class FileWriter final : public PageFileWriter {
 public:
  FileWriter(fs::path file, Unfinished unfinished)
      : file_(std::move(file)), unfinished_(std::move(unfinished)) {}

  Result<Done> add(std::uint64_t key, std::span<const std::byte> blob) override {
    Entry entry{key, 0, blob.size(), checksum(textOf(blob.data(), blob.size()))};
    {
      const std::lock_guard lock(mutex_);
      entry.at = end_;
      end_ += (blob.size() + kAlignment - 1) / kAlignment * kAlignment;
      entries_.push_back(entry);
    }
    return write(entry.at, blob.data(), blob.size());
  }

  Result<Done> finish() override {
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
    for (std::size_t i = 1; i < entries_.size(); ++i)
      if (entries_[i].key == entries_[i - 1].key)
        return wrong(file_, "blob " + std::to_string(entries_[i].key), "each key once", "the key twice");
    Header header;
    header.tableAt = end_;
    header.count = entries_.size();
    header.fileBytes = end_ + entries_.size() * sizeof(Entry);
    header.tableSum = checksum(textOf(entries_.data(), entries_.size() * sizeof(Entry)));
    header.sum = sumOf(header);
    if (auto done = write(header.tableAt, entries_.data(), entries_.size() * sizeof(Entry)); !done)
      return done;
    if (auto done = write(0, &header, sizeof header); !done) return done;
    // An empty table does not reach the end of the last blob's filling.
    if (::ftruncate(unfinished_.handle(), static_cast<off_t>(header.fileBytes)) != 0)
      return wrong(file_, "", "a file that can be written", std::strerror(errno));
    // A bake flushes its files at its end.
    return unfinished_.putInPlace(false);
  }

 private:
  Result<Done> write(std::uint64_t at, const void* data, std::size_t size) {
    const char* from = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t wrote = ::pwrite(unfinished_.handle(), from, size, static_cast<off_t>(at));
      if (wrote < 0 && errno == EINTR) continue;
      if (wrote <= 0)
        return wrong(file_, "", "room to write " + bytesText(size),
                     wrote < 0 ? std::strerror(errno) : "none");
      from += wrote;
      at += static_cast<std::uint64_t>(wrote);
      size -= static_cast<std::size_t>(wrote);
    }
    return Done{};
  }

  fs::path file_;
  Unfinished unfinished_;
  std::mutex mutex_;
  std::uint64_t end_ = sizeof(Header);
  std::vector<Entry> entries_;
};

}  // namespace

Result<std::shared_ptr<const PageFile>> PageFile::open(const fs::path& file) {
  auto opened = StoredFile::open(file);
  if (!opened) return opened.findings();
  const std::shared_ptr<const StoredFile> stored = *opened;
  const std::uint64_t size = stored->size();
  Header header;
  if (size < sizeof header)
    return wrong(file, "size", "a header of " + bytesText(sizeof header), bytesText(size));
  if (const auto read = stored->read(0, std::as_writable_bytes(std::span(&header, 1))); !read)
    return read.findings();
  if (header.magic != kMagic) return wrong(file, "header", "a file of pages", "something else");
  if (header.version != kVersion)
    return wrong(file, "version", std::to_string(kVersion) + " (bake the sources again)",
                 std::to_string(header.version));
  if (const std::uint64_t sum = sumOf(header); sum != header.sum)
    return wrong(file, "header's checksum", hexadecimal(header.sum), hexadecimal(sum));
  if (header.fileBytes != size) return wrong(file, "size", bytesText(header.fileBytes), bytesText(size));
  if (header.tableAt < sizeof header || header.tableAt > size ||
      header.count != (size - header.tableAt) / sizeof(Entry) || (size - header.tableAt) % sizeof(Entry) != 0)
    return wrong(
        file, "table",
        std::to_string(header.count) + " entries from byte " + std::to_string(header.tableAt) + " to the end",
        bytesText(size));
  std::vector<Entry> entries(header.count);
  if (const auto read = stored->read(header.tableAt, std::as_writable_bytes(std::span(entries))); !read)
    return read.findings();
  if (const std::uint64_t sum = terrain::checksum(textOf(entries.data(), entries.size() * sizeof(Entry)));
      sum != header.tableSum)
    return wrong(file, "table's checksum", hexadecimal(header.tableSum), hexadecimal(sum));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Entry& e = entries[i];
    if (i > 0 && e.key <= entries[i - 1].key)
      return wrong(file, "table entry " + std::to_string(i), "keys that rise", std::to_string(e.key));
    if (e.at < sizeof header || e.at % kAlignment != 0 || e.at > header.tableAt ||
        e.bytes > header.tableAt - e.at)
      return wrong(file, "table entry " + std::to_string(i),
                   "a blob before byte " + std::to_string(header.tableAt),
                   bytesText(e.bytes) + " from byte " + std::to_string(e.at));
  }
  return std::shared_ptr<const PageFile>(std::make_shared<StoredPages>(stored, header, std::move(entries)));
}

Result<std::unique_ptr<PageFileWriter>> PageFileWriter::create(const fs::path& file) {
  auto unfinished = Unfinished::file(file);
  if (!unfinished) return unfinished.findings();
  return {std::make_unique<FileWriter>(file, std::move(unfinished).value()), unfinished.findings()};
}

}  // namespace trimtab::terrain
