#include "trimtab/terrain/format/post_sources.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

namespace {

constexpr std::string_view kSourcesMagic = "ttruns1\n";

void append(std::string& bytes, std::uint64_t number) {
  std::array<char, sizeof number> raw;
  std::memcpy(raw.data(), &number, sizeof number);
  bytes.append(raw.data(), raw.size());
}

/// Takes values from the front of some bytes.
struct Taker {
  std::string_view bytes;
  bool good = true;

  std::string_view take(std::uint64_t count) {
    if (!good || count > bytes.size()) {
      good = false;
      return {};
    }
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(count);
    return taken;
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    if (const std::string_view raw = take(sizeof value); good) std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  /// A count of items of which each takes `bytesEach` at least.
  std::uint64_t count(std::size_t bytesEach) {
    const std::uint64_t value = number();
    good = good && value <= bytes.size() / bytesEach;
    return good ? value : 0;
  }
};

}  // namespace

void PostSources::addRow(std::span<const std::uint16_t> sources) {
  for (std::size_t c = 0; c < sources.size(); ++c)
    if (c == 0 || sources[c] != sources[c - 1]) runs_.push_back({static_cast<std::uint32_t>(c), sources[c]});
  starts_.push_back(runs_.size());
}

std::uint16_t PostSources::at(std::uint32_t row, std::uint32_t column) const {
  if (row >= rows()) return kNoSource;
  const auto first = runs_.begin() + static_cast<std::ptrdiff_t>(starts_[row]),
             end = runs_.begin() + static_cast<std::ptrdiff_t>(starts_[row + 1]);
  const auto after =
      std::upper_bound(first, end, column, [](std::uint32_t c, const Run& run) { return c < run.column; });
  return after == first ? kNoSource : static_cast<std::uint16_t>((after - 1)->source);
}

std::string PostSources::encoded() const {
  std::string bytes(kSourcesMagic);
  append(bytes, names_.size());
  for (const std::string& name : names_) {
    append(bytes, name.size());
    bytes += name;
  }
  append(bytes, rows());
  for (const std::uint64_t start : starts_) append(bytes, start);
  bytes.append(reinterpret_cast<const char*>(runs_.data()), runs_.size() * sizeof(Run));
  return bytes;
}

std::optional<PostSources> PostSources::decoded(std::string_view bytes) {
  Taker taker{bytes};
  if (taker.take(kSourcesMagic.size()) != kSourcesMagic) return {};
  PostSources all({});
  for (std::uint64_t left = taker.count(sizeof(std::uint64_t)); left > 0; --left)
    all.names_.emplace_back(taker.take(taker.number()));
  all.starts_.clear();
  for (std::uint64_t left = taker.count(sizeof(std::uint64_t)) + 1; left > 0; --left)
    all.starts_.push_back(taker.number());
  const std::uint64_t runs = all.starts_.back();
  if (!taker.good || all.starts_.front() != 0 || !std::is_sorted(all.starts_.begin(), all.starts_.end()) ||
      taker.bytes.size() % sizeof(Run) != 0 || taker.bytes.size() / sizeof(Run) != runs)
    return {};
  all.runs_.resize(runs);
  if (runs > 0) std::memcpy(all.runs_.data(), taker.bytes.data(), taker.bytes.size());
  const bool named = std::all_of(all.runs_.begin(), all.runs_.end(), [&](const Run& run) {
    return run.source < all.names_.size() || run.source == kNoSource;
  });
  if (!named) return {};
  return all;
}

Result<std::optional<PostSources>> readPostSources(const std::filesystem::path& database) {
  using Json = nlohmann::ordered_json;
  const auto text = readWhole(database / kManifestName);
  if (!text) return text.findings();
  const Json manifest = Json::parse(*text, nullptr, false);
  const Json files = manifest.is_object() ? manifest.value("files", Json()) : Json();
  if (!files.is_object() || !files.contains(kSourcesName)) return std::optional<PostSources>();
  const auto bytes = readWhole(database / kSourcesName);
  if (!bytes) return bytes.findings();
  const Json& entry = files[kSourcesName];
  const std::string sum = hexadecimal(checksum(*bytes));
  if (!entry.is_object() || entry.value("fnv64", Json()) != sum)
    return Finding{Severity::error, (database / kSourcesName).string(), "checksum",
                   "the one that the manifest states", sum};
  auto sources = PostSources::decoded(*bytes);
  if (!sources)
    return Finding{Severity::error, (database / kSourcesName).string(), "", "names of sources and their runs",
                   "others"};
  return sources;
}

}  // namespace trimtab::terrain
