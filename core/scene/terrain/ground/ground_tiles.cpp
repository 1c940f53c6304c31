#include "ground_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/shaders/light.h"
#include "trimtab/terrain/grid/background_thread.h"

namespace trimtab::scene {

namespace {

constexpr std::size_t kMostFailures = 20;
/// The colour of a tile of which not even the coarsest level can be read.
constexpr std::uint32_t kNothingKnown = 0xaa808080u;
/// Tiles that the thread may be ahead of the image.
constexpr std::size_t kMostUntaken = GroundTiles::kKept / 2;

/// Light as a byte, by both components of a normal.
const std::vector<std::uint8_t>& lightTable() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> light(256 * 256);
    for (int y = -128; y < 128; ++y)
      for (int x = -128; x < 128; ++x) {
        const double nx = x / 127.0, ny = y / 127.0;
        const Vec3 normal{nx, ny, std::sqrt(std::max(0.0, 1 - nx * nx - ny * ny))};
        light[static_cast<std::size_t>((y & 255) * 256 + (x & 255))] =
            static_cast<std::uint8_t>(std::lround(255 * lightOn(normal) / kMostLight));
      }
    return light;
  }();
  return table;
}

}  // namespace

GroundPixels litGround(const terrain::GroundTile& tile, bool showVoids) {
  const std::vector<std::uint8_t>& light = lightTable();
  GroundPixels pixels(tile.size());
  for (std::size_t i = 0; i < tile.size(); ++i) {
    const terrain::GroundTexel& t = tile[i];
    std::array<std::uint32_t, 3> rgb{t.red, t.green, t.blue};
    if (showVoids && t.voids != 0)
      for (std::size_t k = 0; k < 3; ++k)
        // A fifth of the ground shows through, so that its shape can be read.
        rgb[k] = (rgb[k] * (255 * 5 - 4u * t.voids) + kVoidColour[k] * 4u * t.voids) / (255 * 5);
    const std::uint32_t lit = light[static_cast<std::size_t>(static_cast<std::uint8_t>(t.normalY)) * 256 +
                                    static_cast<std::uint8_t>(t.normalX)];
    pixels[i] = rgb[0] | rgb[1] << 8 | rgb[2] << 16 | lit << 24;
  }
  return pixels;
}

GroundTiles::GroundTiles(std::shared_ptr<const terrain::GroundPyramid> ground, bool showVoids)
    : ground_(std::move(ground)), showVoids_(showVoids), thread_([this] { run(); }) {}

GroundTiles::~GroundTiles() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

std::shared_ptr<const GroundPixels> GroundTiles::load(const Tile& tile) {
  {
    std::unique_lock lock(mutex_);
    if (failed_.contains(tile.key())) {
      lock.unlock();
      return fromCoarser(tile);
    }
  }
  const auto texels = ground_->readTile(tile.level, tile.column, tile.row);
  if (texels) return std::make_shared<const GroundPixels>(litGround(*texels, showVoids_));
  {
    const std::lock_guard lock(mutex_);
    // Two may have tried it at once.
    if (failed_.insert(tile.key()).second)
      for (const Finding& finding : texels.findings())
        if (failures_.size() < kMostFailures) failures_.push_back(finding);
  }
  return fromCoarser(tile);
}

/// Returns what the next coarser level has of a tile, between its texels; grey if there is no such level.
std::shared_ptr<const GroundPixels> GroundTiles::fromCoarser(const Tile& tile) {
  constexpr int kSide = static_cast<int>(terrain::GroundShape::kTile);
  GroundPixels pixels(std::size_t{kSide} * kSide, kNothingKnown);
  if (tile.level + 1 >= ground_->shape().levels.size()) return std::make_shared<const GroundPixels>(pixels);
  const auto coarser = readNow({tile.level + 1, tile.column / 2, tile.row / 2});
  const int left = static_cast<int>(tile.column % 2) * kSide, low = static_cast<int>(tile.row % 2) * kSide;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      // Three quarters of the texel that it is in, and a quarter of the one that it is nearer to.
      const int c = left + x, r = low + y;
      const int ownC = c / 2, ownR = r / 2, nextC = std::clamp(ownC + (c % 2) * 2 - 1, 0, kSide - 1),
                nextR = std::clamp(ownR + (r % 2) * 2 - 1, 0, kSide - 1);
      const auto at = [&](int column, int row) {
        return (*coarser)[static_cast<std::size_t>(row * kSide + column)];
      };
      std::uint32_t mixed = 0;
      for (int shift = 0; shift < 32; shift += 8) {
        const auto of = [&](int column, int row) { return at(column, row) >> shift & 255u; };
        mixed |= (9 * of(ownC, ownR) + 3 * of(nextC, ownR) + 3 * of(ownC, nextR) + of(nextC, nextR) + 8) / 16
                 << shift;
      }
      pixels[static_cast<std::size_t>(y * kSide + x)] = mixed;
    }
  return std::make_shared<const GroundPixels>(std::move(pixels));
}

void GroundTiles::keep(std::uint64_t key, std::shared_ptr<const GroundPixels> pixels, bool taken) {
  if (entries_.contains(key)) return;
  uses_.push_front(key);
  entries_[key] = {std::move(pixels), uses_.begin(), taken};
  if (!taken) ++untaken_;
  while (entries_.size() > kKept) {
    const auto oldest = entries_.find(uses_.back());
    if (!oldest->second.taken) --untaken_;
    entries_.erase(oldest);
    uses_.pop_back();
  }
}

std::shared_ptr<const GroundPixels> GroundTiles::find(const Tile& tile) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(tile.key());
  if (found == entries_.end()) return nullptr;
  Entry& entry = found->second;
  uses_.splice(uses_.begin(), uses_, entry.use);
  if (!entry.taken) {
    entry.taken = true;
    --untaken_;
    wake_.notify_one();
  }
  return entry.pixels;
}

std::shared_ptr<const GroundPixels> GroundTiles::readNow(const Tile& tile) {
  if (auto there = find(tile)) return there;
  auto pixels = load(tile);
  const std::lock_guard lock(mutex_);
  keep(tile.key(), pixels, true);
  return pixels;
}

void GroundTiles::want(std::vector<Tile> tiles) {
  std::reverse(tiles.begin(), tiles.end());
  {
    const std::lock_guard lock(mutex_);
    wanted_ = std::move(tiles);
    wantedKeys_.clear();
    for (const Tile& tile : wanted_) wantedKeys_.insert(tile.key());
    // A tile that nobody waits for any more must hold nobody up.
    for (auto& [key, entry] : entries_)
      if (!entry.taken && !wantedKeys_.contains(key)) {
        entry.taken = true;
        --untaken_;
      }
  }
  wake_.notify_one();
}

void GroundTiles::run() {
  terrain::giveWayToPictures();
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return stop_ || (!wanted_.empty() && untaken_ < kMostUntaken); });
    if (stop_) return;
    const Tile tile = wanted_.back();
    wanted_.pop_back();
    if (entries_.contains(tile.key())) continue;
    lock.unlock();
    auto pixels = load(tile);
    lock.lock();
    keep(tile.key(), std::move(pixels), false);
  }
}

std::size_t GroundTiles::bytes() const {
  const std::lock_guard lock(mutex_);
  std::size_t sum = 0;
  for (const auto& [key, entry] : entries_)
    if (entry.pixels) sum += entry.pixels->size() * sizeof(std::uint32_t);
  return sum;
}

std::size_t GroundTiles::failed() const {
  const std::lock_guard lock(mutex_);
  return failed_.size();
}

Findings GroundTiles::failures() const {
  const std::lock_guard lock(mutex_);
  return failures_;
}

}  // namespace trimtab::scene
