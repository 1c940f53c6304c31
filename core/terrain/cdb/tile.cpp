#include "trimtab/terrain/cdb/tile.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace trimtab::terrain {

namespace {

/// Reads a name from the left.
class CdbNameReader {
 public:
  explicit CdbNameReader(std::string_view text) : text_(text) {}

  bool letter(char upper) {
    if (text_.empty() || std::toupper(static_cast<unsigned char>(text_[0])) != upper) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool text(std::string_view upper) {
    return std::all_of(upper.begin(), upper.end(), [this](char c) { return letter(c); });
  }
  /// Reads a number of `least` to `most` digits.
  std::optional<int> number(std::size_t least, std::size_t most) {
    std::size_t digits = 0;
    int value = 0;
    for (; digits < std::min(most, text_.size()) && std::isdigit(static_cast<unsigned char>(text_[digits]));
         ++digits)
      value = 10 * value + (text_[digits] - '0');
    if (digits < least) return {};
    text_.remove_prefix(digits);
    return value;
  }
  /// Reads a number of degrees behind one of two letters, of which the second makes it negative.
  std::optional<int> degrees(char positive, char negative, std::size_t digits) {
    const bool below = letter(negative);
    if (!below && !letter(positive)) return {};
    const auto value = number(digits, digits);
    return value && below ? -*value : value;
  }
  std::string_view rest() const { return text_; }

 private:
  std::string_view text_;
};

}  // namespace

int cdbCellWidth(int south) {
  struct Zone {
    int from, width;
  };
  constexpr std::array<Zone, 11> kZones{{{89, 12},
                                         {80, 6},
                                         {75, 4},
                                         {70, 3},
                                         {50, 2},
                                         {-50, 1},
                                         {-70, 2},
                                         {-75, 3},
                                         {-80, 4},
                                         {-89, 6},
                                         {-90, 12}}};
  for (const Zone& zone : kZones)
    if (south >= zone.from) return zone.width;
  return kZones.back().width;
}

std::optional<CdbName> cdbNameOf(std::string_view stem) {
  CdbNameReader in(stem);
  CdbName name;
  CdbTile& tile = name.tile;
  const auto south = in.degrees('N', 'S', 2), west = south ? in.degrees('E', 'W', 3) : std::nullopt;
  if (!west || *south < -90 || *south > 89 || *west < -180 || *west > 179) return {};
  tile.south = *south;
  tile.west = *west;
  for (const auto& [letters, value] :
       {std::pair{"_D", &tile.set}, std::pair{"_S", &tile.first}, std::pair{"_T", &tile.second}}) {
    const auto read = in.text(letters) ? in.number(3, 3) : std::nullopt;
    if (!read) return {};
    *value = *read;
  }
  if (!in.text("_L")) return {};
  const bool coarse = in.letter('C');
  const auto level = in.number(2, 2), up = level && in.text("_U") ? in.number(1, 8) : std::nullopt,
             right = up && in.text("_R") ? in.number(1, 8) : std::nullopt;
  if (!right) return {};
  tile.level = coarse ? -*level : *level;
  tile.up = *up;
  tile.right = *right;
  if (tile.level < CdbTile::kCoarsest || tile.level > CdbTile::kFinest || (coarse && tile.level == 0))
    return {};
  const int across = 1 << std::max(tile.level, 0);
  if (tile.up >= across || tile.right >= across) return {};
  name.rest = in.rest();
  return name;
}

std::string CdbTile::levelName() const {
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), level < 0 ? "LC%02d" : "L%02d", std::abs(level));
  return text.data();
}

std::string CdbTile::name() const {
  std::array<char, 96> text;
  std::snprintf(text.data(), text.size(), "%c%02d%c%03d_D%03d_S%03d_T%03d_%s_U%d_R%d", south < 0 ? 'S' : 'N',
                std::abs(south), west < 0 ? 'W' : 'E', std::abs(west), set, first, second,
                levelName().c_str(), up, right);
  return text.data();
}

CdbExtent CdbTile::extent() const {
  const double share = 1.0 / (1 << std::max(level, 0)), width = cdbCellWidth(south) * share;
  return {west + right * width, south + up * share, width, share};
}

int CdbTile::side() const {
  return level >= 0 ? 1024 : 1024 >> -level;
}

CdbTile CdbTile::parent() const {
  CdbTile coarser = *this;
  --coarser.level;
  if (level > 0) {
    coarser.up /= 2;
    coarser.right /= 2;
  }
  return coarser;
}

CdbTile CdbTile::at(double longitude, double latitude, int otherLevel) const {
  CdbTile other = *this;
  other.level = otherLevel;
  const int across = 1 << std::max(otherLevel, 0);
  const auto part = [across](double share) {
    return std::clamp(static_cast<int>(std::floor(share * across)), 0, across - 1);
  };
  other.up = part(latitude - south);
  other.right = part((longitude - west) / cdbCellWidth(south));
  return other;
}

}  // namespace trimtab::terrain
