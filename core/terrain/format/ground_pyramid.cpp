#include "trimtab/terrain/format/ground_pyramid.h"

#include <meshoptimizer.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kTile = GroundShape::kTile;
constexpr std::size_t kTexels = std::size_t{kTile} * kTile;
constexpr std::size_t kRawBytes = kTexels * sizeof(GroundTexel);
constexpr std::byte kRaw{0}, kDeflated{1}, kPacked{2};
/// A texel as the packing takes it: by fours of bytes.
using PaddedTexel = std::array<std::uint8_t, 8>;
static_assert(sizeof(PaddedTexel) == 8 && sizeof(GroundTexel) <= 8);

double linearOf(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}
double srgbOf(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// sRGB to light and back, by tables: bytes to sixteen bits, and the sum of four of those to a byte.
struct LightTables {
  static constexpr int kShift = 4;
  std::array<std::uint32_t, 256> light{};
  std::array<std::uint8_t, (4 * 65535 >> kShift) + 1> byte{};

  LightTables() {
    for (std::size_t i = 0; i < light.size(); ++i)
      light[i] = static_cast<std::uint32_t>(std::lround(65535 * linearOf(static_cast<double>(i) / 255)));
    for (std::size_t i = 0; i < byte.size(); ++i) {
      const double sum = (static_cast<double>(i) + 0.5) * (1 << kShift);
      byte[i] = static_cast<std::uint8_t>(std::lround(255 * srgbOf(std::min(sum / (4 * 65535.0), 1.0))));
    }
  }
};
const LightTables& lightTables() {
  static const LightTables tables;
  return tables;
}

GroundTexel meanOf(const GroundTexel& a, const GroundTexel& b, const GroundTexel& c, const GroundTexel& d) {
  if (a == b && c == d && a == c) return a;
  const LightTables& tables = lightTables();
  const auto colour = [&](std::uint8_t GroundTexel::*at) {
    const std::uint32_t sum =
        tables.light[a.*at] + tables.light[b.*at] + tables.light[c.*at] + tables.light[d.*at];
    return tables.byte[sum >> LightTables::kShift];
  };
  const auto up = [](const GroundTexel& t) {
    const int flat = t.normalX * t.normalX + t.normalY * t.normalY;
    return std::sqrt(static_cast<float>(std::max(0, 127 * 127 - flat)));
  };
  const auto x = static_cast<float>(a.normalX + b.normalX + c.normalX + d.normalX);
  const auto y = static_cast<float>(a.normalY + b.normalY + c.normalY + d.normalY);
  const float z = up(a) + up(b) + up(c) + up(d);
  const float scale = 127 / std::max(std::sqrt(x * x + y * y + z * z), 1.0f);
  const auto byte = [](float v) { return static_cast<std::int8_t>(static_cast<int>(v + 127.5f) - 127); };
  return {colour(&GroundTexel::red),
          colour(&GroundTexel::green),
          colour(&GroundTexel::blue),
          static_cast<std::uint8_t>((a.voids + b.voids + c.voids + d.voids + 2) / 4),
          byte(x * scale),
          byte(y * scale)};
}

Finding broken(std::string expected, std::string found) {
  return {Severity::error, "ground", "tile", std::move(expected), std::move(found)};
}

Finding inFile(const fs::path& file, std::string expected, std::string found) {
  return {Severity::error, file.string(), "", std::move(expected), std::move(found)};
}

class FilePyramid final : public GroundPyramid {
 public:
  FilePyramid(std::shared_ptr<const PageFile> file, fs::path path, GroundShape shape)
      : file_(std::move(file)), path_(std::move(path)), shape_(std::move(shape)) {}
  const GroundShape& shape() const override { return shape_; }
  Result<GroundTile> readTile(std::uint32_t level, std::uint32_t column, std::uint32_t row) const override {
    const auto blob = file_->read(groundKey(level, column, row));
    if (!blob) return blob.findings();
    auto tile = unpackGroundTile(*blob);
    if (tile) return tile;
    Findings findings = tile.findings();
    for (Finding& finding : findings)
      finding.where = path_.string() + ": level " + std::to_string(level) + ", tile " +
                      std::to_string(column) + ", " + std::to_string(row);
    return findings;
  }

 private:
  std::shared_ptr<const PageFile> file_;
  fs::path path_;
  GroundShape shape_;
};

}  // namespace

GroundShape makeGroundShape(const PostGrid& posts, double texelsPerPost) {
  GroundShape shape;
  shape.texelsPerPost = texelsPerPost;
  const auto texels = [&](std::uint32_t count) {
    const double all = (count - 1) * texelsPerPost;
    return static_cast<std::uint32_t>(std::floor(all)) + 1;
  };
  GroundShape::Level level{texels(posts.columns), texels(posts.rows)};
  shape.levels.push_back(level);
  while (level.columns > kTile || level.rows > kTile) {
    level = {(level.columns + 1) / 2, (level.rows + 1) / 2};
    shape.levels.push_back(level);
  }
  return shape;
}

GroundTileSize sizeOfGroundTile(const GroundShape::Level& level, std::uint32_t column, std::uint32_t row) {
  return {std::min(kTile, level.columns - column * kTile), std::min(kTile, level.rows - row * kTile)};
}

void padGroundTile(GroundTile& tile, GroundTileSize size) {
  for (std::uint32_t r = 0; r < size.rows; ++r) {
    GroundTexel* row = &tile[std::size_t{r} * kTile];
    std::fill(row + size.columns, row + kTile, row[size.columns - 1]);
  }
  for (std::uint32_t r = size.rows; r < kTile; ++r)
    std::copy_n(&tile[std::size_t{size.rows - 1} * kTile], kTile, &tile[std::size_t{r} * kTile]);
}

GroundTile halvedGround(const std::array<const GroundTile*, 4>& below, GroundTileSize size) {
  GroundTile tile(kTexels);
  constexpr std::uint32_t kHalf = kTile / 2;
  for (std::uint32_t r = 0; r < size.rows; ++r)
    for (std::uint32_t c = 0; c < size.columns; ++c) {
      const GroundTile& from = *below[(r / kHalf) * 2 + c / kHalf];
      const GroundTexel* at = &from[std::size_t{2 * (r % kHalf)} * kTile + 2 * (c % kHalf)];
      tile[std::size_t{r} * kTile + c] = meanOf(at[0], at[1], at[kTile], at[kTile + 1]);
    }
  padGroundTile(tile, size);
  return tile;
}

// Bytes' differences from texel to texel are packed with as few bits as sixteen of them need, which is undone
// as fast as a disk reads. Where that leaves little (seas, plains) deflating leaves less: to inflate a
// photograph takes many times longer than to read it, to inflate a plain takes less.
std::vector<std::byte> packGroundTile(const GroundTile& tile) {
  // Bytes must not depend on what the library's next version likes best.
  static const bool versioned = (meshopt_encodeVertexVersion(0), true);
  static_cast<void>(versioned);
  constexpr uLong kWorthIt = kRawBytes / 4;
  std::vector<PaddedTexel> padded(kTexels);
  for (std::size_t i = 0; i < kTexels; ++i) std::memcpy(padded[i].data(), &tile[i], sizeof(GroundTexel));
  std::vector<std::byte> blob(1 + meshopt_encodeVertexBufferBound(kTexels, sizeof(PaddedTexel)));
  const std::size_t packed =
      meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(blob.data() + 1), blob.size() - 1,
                                 padded.data(), kTexels, sizeof(PaddedTexel));
  if (packed < 2 * kWorthIt) {
    std::vector<std::byte> planes(kRawBytes), deflated(1 + kWorthIt);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(tile.data());
    for (std::size_t k = 0; k < sizeof(GroundTexel); ++k) {
      std::uint8_t before = 0;
      for (std::size_t i = 0; i < kTexels; ++i) {
        const std::uint8_t now = bytes[i * sizeof(GroundTexel) + k];
        planes[k * kTexels + i] = static_cast<std::byte>(static_cast<std::uint8_t>(now - before));
        before = now;
      }
    }
    uLongf size = kWorthIt;
    if (compress2(reinterpret_cast<Bytef*>(deflated.data() + 1), &size,
                  reinterpret_cast<const Bytef*>(planes.data()), planes.size(), 1) == Z_OK &&
        size < packed) {
      deflated[0] = kDeflated;
      deflated.resize(1 + size);
      return deflated;
    }
  }
  if (packed > 0 && packed < kRawBytes) {
    blob[0] = kPacked;
    blob.resize(1 + packed);
    return blob;
  }
  blob.resize(1 + kRawBytes);
  blob[0] = kRaw;
  std::memcpy(blob.data() + 1, tile.data(), kRawBytes);
  return blob;
}

Result<GroundTile> unpackGroundTile(std::span<const std::byte> blob) {
  if (blob.empty()) return broken("texels", "nothing");
  GroundTile tile(kTexels);
  if (blob[0] == kRaw) {
    if (blob.size() != 1 + kRawBytes)
      return broken(std::to_string(kRawBytes) + " bytes of texels", std::to_string(blob.size() - 1));
    std::memcpy(tile.data(), blob.data() + 1, kRawBytes);
    return tile;
  }
  if (blob[0] == kPacked) {
    std::vector<PaddedTexel> padded(kTexels);
    if (meshopt_decodeVertexBuffer(padded.data(), kTexels, sizeof(PaddedTexel),
                                   reinterpret_cast<const unsigned char*>(blob.data() + 1),
                                   blob.size() - 1) != 0)
      return broken(std::to_string(kTexels) + " texels, packed", "something else");
    for (std::size_t i = 0; i < kTexels; ++i) std::memcpy(&tile[i], padded[i].data(), sizeof(GroundTexel));
    return tile;
  }
  if (blob[0] != kDeflated)
    return broken("raw, packed or deflated texels", "kind " + std::to_string(std::to_integer<int>(blob[0])));
  std::vector<std::uint8_t> planes(kRawBytes);
  uLongf size = kRawBytes;
  const int code = uncompress(planes.data(), &size, reinterpret_cast<const Bytef*>(blob.data() + 1),
                              static_cast<uLong>(blob.size() - 1));
  if (code != Z_OK || size != kRawBytes)
    return broken(std::to_string(kRawBytes) + " bytes, deflated", "something else");
  auto* bytes = reinterpret_cast<std::uint8_t*>(tile.data());
  for (std::size_t k = 0; k < sizeof(GroundTexel); ++k) {
    std::uint8_t value = 0;
    for (std::size_t i = 0; i < kTexels; ++i) {
      value = static_cast<std::uint8_t>(value + planes[k * kTexels + i]);
      bytes[i * sizeof(GroundTexel) + k] = value;
    }
  }
  return tile;
}

std::vector<std::byte> packGroundShape(const GroundShape& shape) {
  std::vector<std::byte> blob;
  const auto add = [&](std::uint64_t value) {
    for (int i = 0; i < 8; ++i) blob.push_back(static_cast<std::byte>(value >> (8 * i)));
  };
  add(std::bit_cast<std::uint64_t>(shape.texelsPerPost));
  for (const GroundShape::Level& level : shape.levels) add(std::uint64_t{level.columns} << 32 | level.rows);
  return blob;
}

Result<GroundShape> unpackGroundShape(std::span<const std::byte> blob) {
  const auto at = [&](std::size_t i) {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < 8; ++k)
      value |= std::uint64_t{std::to_integer<std::uint8_t>(blob[8 * i + k])} << (8 * k);
    return value;
  };
  if (blob.size() < 16 || blob.size() % 8 != 0 || blob.size() > 8 * 40)
    return broken("the sizes of the ground's levels", std::to_string(blob.size()) + " bytes");
  GroundShape shape;
  shape.texelsPerPost = std::bit_cast<double>(at(0));
  int exponent = 0;
  if (!(shape.texelsPerPost >= 1.0 / 64 && shape.texelsPerPost <= 64) ||
      std::frexp(shape.texelsPerPost, &exponent) != 0.5)
    return broken("a power of two of texels a post, 1/64 to 64", std::to_string(shape.texelsPerPost));
  for (std::size_t i = 1; i < blob.size() / 8; ++i)
    shape.levels.push_back(
        {static_cast<std::uint32_t>(at(i) >> 32), static_cast<std::uint32_t>(at(i) & 0xffffffffu)});
  return shape;
}

Result<std::shared_ptr<const GroundPyramid>> openGround(const fs::path& path, const PostGrid& posts) {
  auto opened = PageFile::open(path);
  if (!opened) return opened.findings();
  return openGround(std::move(opened).value(), path, posts);
}

Result<std::shared_ptr<const GroundPyramid>> openGround(std::shared_ptr<const PageFile> pages,
                                                        const fs::path& path, const PostGrid& posts) {
  const PageFile& file = *pages;
  const auto blob = file.read(kGroundShapeKey);
  if (!blob) return blob.findings();
  auto shape = unpackGroundShape(*blob);
  if (!shape) return inFile(path, shape.findings()[0].expected, shape.findings()[0].found);
  if (*shape != makeGroundShape(posts, shape->texelsPerPost))
    return inFile(
        path,
        "the ground of " + std::to_string(posts.columns) + " x " + std::to_string(posts.rows) + " posts",
        "another size");
  for (std::uint32_t l = 0; l < shape->levels.size(); ++l)
    for (std::uint32_t r = 0; r < shape->levels[l].tileRows(); ++r)
      for (std::uint32_t c = 0; c < shape->levels[l].tileColumns(); ++c)
        if (!file.has(groundKey(l, c, r)))
          return inFile(path, "all tiles of the ground",
                        "none at level " + std::to_string(l) + ", tile " + std::to_string(c) + ", " +
                            std::to_string(r));
  return Result<std::shared_ptr<const GroundPyramid>>(
      std::make_shared<FilePyramid>(std::move(pages), path, std::move(shape).value()));
}

}  // namespace trimtab::terrain
