#include "dted.h"

#include <cpl_vsi.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

/// Bytes of the headers UHL, DSI and ACC, and of VOL and HDR each, which tapes have before them.
constexpr std::size_t kHeaderBytes = 3428, kTapeBytes = 80;
/// Bytes of a profile beside its posts: eight before them, and the checksum after them.
constexpr std::size_t kBeforePosts = 8, kSumBytes = 4;

struct Profiles {
  std::vector<bool> there;  ///< by column
  std::size_t compared = 0, wrong = 0, zero = 0;
  std::optional<std::size_t> firstWrong;
};

std::uint32_t bigEndian(const std::uint8_t* bytes, std::size_t count) {
  return std::accumulate(bytes, bytes + count, std::uint32_t{0},
                         [](std::uint32_t sum, std::uint8_t byte) { return sum << 8 | byte; });
}

std::optional<Profiles> profilesOf(const fs::path& path, std::size_t columns, std::size_t rows) {
  const std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file(VSIFOpenL(path.c_str(), "rb"), &VSIFCloseL);
  if (!file) return {};
  std::size_t headers = kHeaderBytes;
  for (std::string name(3, 0); VSIFReadL(name.data(), 1, name.size(), file.get()) == name.size();) {
    if (name == "UHL") break;
    if (name != "VOL" && name != "HDR") return {};
    headers += kTapeBytes;
    if (VSIFSeekL(file.get(), headers - kHeaderBytes, SEEK_SET) != 0) return {};
  }
  if (VSIFSeekL(file.get(), headers, SEEK_SET) != 0) return {};
  Profiles profiles;
  profiles.there.resize(columns);
  std::vector<std::uint8_t> record(kBeforePosts + 2 * rows + kSumBytes);
  while (VSIFReadL(record.data(), 1, record.size(), file.get()) == record.size() && record[0] == 0xaa) {
    const std::size_t column = bigEndian(&record[4], 2);
    if (column < columns) profiles.there[column] = true;
    const std::size_t summed = record.size() - kSumBytes;
    const std::uint32_t sum = std::accumulate(record.begin(), record.begin() + static_cast<long>(summed), 0u),
                        stored = bigEndian(&record[summed], kSumBytes);
    ++profiles.compared;
    if (stored == 0) ++profiles.zero;
    if (sum == stored) continue;
    ++profiles.wrong;
    if (!profiles.firstWrong) profiles.firstWrong = column;
  }
  return profiles;
}

}  // namespace

Findings dtedFaults(const PlacedRaster& raster, const fs::path& file, bool ignoreChecksums) {
  if (std::string_view(raster.data->GetDriverName()) != "DTED") return {};
  const auto columns = static_cast<std::size_t>(raster.data->GetRasterXSize());
  const auto profiles = profilesOf(file, columns, static_cast<std::size_t>(raster.data->GetRasterYSize()));
  if (!profiles) return {};
  const auto named = [&](std::size_t column) {
    return "column " + std::to_string(column) + " (longitude " +
           numberText(raster.transform[0] + (static_cast<double>(column) + 0.5) * raster.transform[1], 9) +
           ")";
  };
  Findings faults;
  const auto& there = profiles->there;
  const auto missing = static_cast<std::size_t>(std::count(there.begin(), there.end(), false));
  const auto first = static_cast<std::size_t>(std::find(there.begin(), there.end(), false) - there.begin());
  // Columns may be left out of a file, but its end does not fail to come.
  const bool cut = missing > 0 && !there.back();
  if (missing > 0)
    faults.push_back({cut ? Severity::error : Severity::warning, file.string(), "profiles",
                      std::to_string(columns) + " columns of posts, as the header says",
                      std::to_string(columns - missing) + ": " + named(first) +
                          " is the first that is missing" +
                          (cut ? "; the file is cut, copy or download it again" : "; voids there")});
  if (profiles->wrong == 0) return faults;
  std::string found = std::to_string(profiles->wrong) + " of " + std::to_string(profiles->compared) +
                      " disagree, from " + named(*profiles->firstWrong) + " on";
  if (profiles->zero == profiles->compared) found += "; all are 0, as of a program that does not sum";
  if (ignoreChecksums)
    faults.push_back({Severity::warning, file.string(), "checksums",
                      "profiles that agree with their checksums",
                      found + ": read nevertheless, as --ignore-checksums says"});
  else
    faults.push_back(
        {Severity::error, file.string(), "checksums",
         "profiles that agree with their checksums, or --ignore-checksums to read them as they are", found});
  return faults;
}

}  // namespace trimtab::terrain
