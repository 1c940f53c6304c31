#include "app/models/open_flight.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

namespace trimtab::models {

namespace {

constexpr std::uint16_t kPush = 10, kPop = 11, kLevelOfDetail = 73;
constexpr std::size_t kHeader = 4, kSwitchIn = 16, kSwitchOut = 24, kSignificantSize = 72, kWithSize = 80;
/// Metres of distance for a metre of significant size.
constexpr double kDistance = 1000;

std::uint16_t shortAt(const std::string& bytes, std::size_t at) {
  return static_cast<std::uint16_t>(static_cast<unsigned char>(bytes[at]) << 8 |
                                    static_cast<unsigned char>(bytes[at + 1]));
}
double doubleAt(const std::string& bytes, std::size_t at) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < 8; ++k) bits = bits << 8 | static_cast<unsigned char>(bytes[at + k]);
  return std::bit_cast<double>(bits);
}
void put(std::string& bytes, std::size_t at, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (std::size_t k = 0; k < 8; ++k)
    bytes[at + k] = static_cast<char>(static_cast<unsigned char>(bits >> (56 - 8 * k)));
}

/// A level that has a significant size and no ranges.
struct SizedLevel {
  std::size_t at = 0;
  double size = 0;
};

/// The levels that are children of one node, and what is known of the node.
struct Siblings {
  std::vector<SizedLevel> levels;
  double within = std::numeric_limits<double>::infinity();  ///< the size of the nearest level around them
};

void setRanges(std::string& bytes, const Siblings& siblings) {
  std::set<double> sizes;
  for (const SizedLevel& level : siblings.levels) sizes.insert(level.size);
  for (const SizedLevel& level : siblings.levels) {
    const auto coarser = sizes.upper_bound(level.size);
    const double end = coarser == sizes.end() ? std::max(siblings.within, level.size) : *coarser;
    put(bytes, level.at + kSwitchIn, kDistance * end);
    put(bytes, level.at + kSwitchOut, *sizes.begin() == level.size ? 0 : kDistance * level.size);
  }
}

}  // namespace

std::string withRangesBySize(std::string bytes) {
  std::vector<Siblings> open(1);
  double last = std::numeric_limits<double>::infinity();  // the size of the last node, if it is a level
  for (std::size_t at = 0; at + kHeader <= bytes.size();) {
    const std::uint16_t code = shortAt(bytes, at), length = shortAt(bytes, at + 2);
    if (length < kHeader || at + length > bytes.size()) break;
    if (code == kPush) {
      open.push_back({{}, std::min(last, open.back().within)});
    } else if (code == kPop) {
      setRanges(bytes, open.back());
      if (open.size() == 1) break;
      open.pop_back();
      last = std::numeric_limits<double>::infinity();
    } else if (code == kLevelOfDetail) {
      last = std::numeric_limits<double>::infinity();
      if (length >= kWithSize && doubleAt(bytes, at + kSwitchIn) == 0 &&
          doubleAt(bytes, at + kSwitchOut) == 0) {
        const double size = doubleAt(bytes, at + kSignificantSize);
        if (std::isfinite(size) && size > 0) {
          open.back().levels.push_back({at, size});
          last = size;
        }
      }
    }
    at += length;
  }
  for (const Siblings& siblings : open) setRanges(bytes, siblings);
  return bytes;
}

}  // namespace trimtab::models
