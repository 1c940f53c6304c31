#include "trimtab/culling/horizon.h"

#include "horizon_geometry.h"

namespace trimtab {

using namespace horizon;

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// Error of directions in single precision beyond kNearest, radians: positions are off by 2^-22 of their
/// distance and of the tile's size.
constexpr double kRounding = 1.2e-5;
/// Larger coordinates, metres, are no positions on earth.
constexpr float kMostReach = 1e8f;
/// A quarter has at most so many bins of waiting lines. With 800 columns a dozen columns per bin were
/// fastest.
constexpr int kMostBins = 64;

}  // namespace

bool ValidityRegion::holds(Vec3 eye) const {
  const Vec3 along = to - from, in = eye - from;
  const double squared = dot(along, along);
  const double s = squared > 0 ? std::clamp(dot(in, along) / squared, 0.0, 1.0) : 0;
  return length(in - s * along) <= radius;
}

void Horizon::buildFor(const ValidityRegion& region, std::span<const HorizonTile> tiles,
                       const Settings& settings) {
  begin(region, tiles, settings);
  step(std::numeric_limits<std::size_t>::max() / 2);
}

void Horizon::begin(const ValidityRegion& region, std::span<const HorizonTile> tiles,
                    const Settings& settings) {
  region_ = region;
  eye_ = 0.5 * (region.from + region.to);
  settings_ = settings;
  kernels_ = &kernels(settings.simd);
  columns_ = std::clamp(settings.columns, kLeastColumns, kMostColumns);
  perT_ = 0.5f * static_cast<float>(columns_);
  profile_.assign(static_cast<std::size_t>(kSides * columns_) + 16, kNowhere);
  reached_.resize(static_cast<std::size_t>(3 * columns_ + 16));  // and what a region needs beside a quarter
  hidden_.assign(tiles.size(), 0);
  hiddenCount_ = 0;
  tiles_ = tiles;
  order_.clear();
  binShift_ = std::bit_width(static_cast<unsigned>((columns_ - 1) / kMostBins));
  binsEach_ = ((columns_ - 1) >> binShift_) + 1;
  bins_.resize(static_cast<std::size_t>(kSides * binsEach_));
  for (auto& bin : bins_) bin.clear();
  waiting_.clear();
  awaited_.assign(profile_.size(), kNowhere);
  progress_.next = progress_.work = 0;
  progress_.phase = Phase::done;

  const Vec3 half = 0.5 * (region.to - region.from);
  const double play = std::hypot(half.x, half.y) + std::abs(half.z) + region.radius;
  // Seen from another eye of the region, a direction turns by at most half as much again.
  slack_ = static_cast<float>((play > 0 ? 3 : 2) * settings.slack + kRounding);
  if (!isPlace(region.from) || !isPlace(region.to) || !(region.radius >= 0) || !(slack_ < 0.1f) ||
      !(play <= kMostRegionM))
    return;
  leastM_ = static_cast<float>(2 * play);
  for (int side = 0; side < kSides; ++side) {
    const Turned h = turned(side, static_cast<float>(half.x), static_cast<float>(half.y));
    const float radius = static_cast<float>(region.radius), forwards = std::abs(h.f) + radius;
    play_[static_cast<std::size_t>(side)] = {.along = h.f,
                                             .side = h.l,
                                             .radius = radius,
                                             .forwards = forwards,
                                             .upwards = std::abs(static_cast<float>(half.z)) + radius};
    if (settings.still) play_[static_cast<std::size_t>(side)] = {};
  }
  outlines_.resize(tiles.size());
  firstOfRing_.assign(kRings + 1, 0);
  if (!tiles.empty()) progress_.phase = Phase::outline;
}

Horizon::Outline Horizon::outlineOf(std::uint32_t n) const {
  const HorizonTile& tile = tiles_[n];
  const Relief* relief = tile.surface();
  Outline o{};
  o.tile = kNone;
  if (!relief || !(relief->reach >= 0 && relief->reach < kMostReach)) return o;
  const auto from = fromEye(eye_, relief->origin);
  const Box& b = relief->bounds;
  static_cast<Prism&>(o) = prismOf(b, from);
  for (std::size_t k = 0; k < 3; ++k) o.peak[k] = relief->peak[k] + from[k];
  const float x = std::max({o.x0, -o.x1, 0.0f}), y = std::max({o.y0, -o.y1, 0.0f});
  const float away = std::sqrt(x * x + y * y);
  o.nearest = std::max({kNearest, leastM_, kNearestShare * relief->reach});
  o.off = slack_ + (tile.above > 0 ? tile.above / away : 0);
  o.beside = besideOf(o.off, std::max(std::abs(o.top), std::abs(b.minZ + from[2])), away);
  o.tile = n;
  o.ring = static_cast<std::uint16_t>(ringOf(away - tile.above));
  if (!tile.mayOcclude || (!tile.relief && !tile.mesh)) return o;
  o.lines = -1;
  if (!tile.relief) return o;
  const TileRelief& lines = *tile.relief;
  const bool rows = runsInRows(o);
  const auto cells = static_cast<float>(lines.side - 1);
  o.lines = static_cast<std::int16_t>(lines.lines / 2);
  o.lineTop = lines.lineTop[rows ? 0 : 1] + from[2] - tile.below;
  // Slightly less than the exact share, because a tile may lie slightly askew.
  o.inset = 0.95f * static_cast<float>(lines.lineStep) / cells;
  o.goOn = (rows ? tile.east : tile.north) ? static_cast<float>(TileRelief::kGoOn) / cells : 0;
  return o;
}

/// Makes the outlines of some more tiles.
void Horizon::outlineSome() {
  constexpr std::size_t kAhead = 8, kSome = 64;
  for (const std::size_t end = std::min(progress_.next + kSome, tiles_.size()); progress_.next < end;
       ++progress_.next) {
    if (progress_.next + kAhead < tiles_.size()) {
      const void* ahead = tiles_[progress_.next + kAhead].surface();
      __builtin_prefetch(ahead);
      __builtin_prefetch(static_cast<const char*>(ahead) + 64);
    }
    const Outline& outline = outlines_[progress_.next] =
        outlineOf(static_cast<std::uint32_t>(progress_.next));
    ++firstOfRing_[std::size_t{outline.ring} + 1];
  }
  progress_.work += kSome / 8;
  if (progress_.next == tiles_.size()) sortTiles();
}

void Horizon::sortTiles() {
  for (std::uint32_t ring = 0; ring < kRings; ++ring) firstOfRing_[ring + 1] += firstOfRing_[ring];
  order_.resize(tiles_.size());
  for (std::uint32_t i = 0; i < tiles_.size(); ++i) order_[firstOfRing_[outlines_[i].ring]++] = i;
  progress_.phase = Phase::test;
  progress_.next = 0;
}

bool Horizon::step(std::size_t work) {
  for (const std::size_t end = progress_.work + work; !isDone() && progress_.work < end;)
    switch (progress_.phase) {
      case Phase::outline:
        outlineSome();
        break;
      case Phase::test:
        testNext();
        break;
      default:
        lookAtAll(progress_.next);
        ++progress_.work;
        if (++progress_.next == bins_.size()) progress_.phase = Phase::done;
    }
  return isDone();
}

void Horizon::testNext() {
  if (constexpr std::size_t kAhead = 8; progress_.next + kAhead < order_.size())
    __builtin_prefetch(&outlines_[order_[progress_.next + kAhead]]);
  const Outline& outline = outlines_[order_[progress_.next]];
  ++progress_.work;
  if (outline.tile != kNone) test(outline);
  if (++progress_.next < order_.size()) return;
  progress_.phase = settings_.whole ? Phase::finish : Phase::done;
  progress_.next = 0;
  progress_.ring = kRings;
}

void Horizon::test(const Outline& outline) {
  progress_.ring = outline.ring;
  nearest_ = outline.nearest;
  off_ = outline.off;
  beside_ = outline.beside;
  for (std::size_t bin = 0; settings_.noWaiting && bin < bins_.size(); ++bin) lookAtAll(bin);
  // If a post stands out above the horizon its block does too, and nothing else has to be tested.
  bool hidden = isPointBlocked(outline.peak[0], outline.peak[1], outline.peak[2]);
  if (hidden && !isPrismHidden(outline)) {
    const HorizonTile& tile = tiles_[outline.tile];
    offset_ = fromEye(eye_, tile.surface()->origin);
    if (tile.relief)
      hidden = isHidden(*tile.relief);
    else
      hidden = tile.mesh && isHidden(*tile.mesh);
  }
  if (hidden) {
    // Its lines cannot stand out above what hides it either.
    hidden_[outline.tile] = 1;
    ++hiddenCount_;
  } else if (outline.lines != 0) {
    awaitLines(outline);
  }
}

std::optional<double> Horizon::elevation(double x, double y) const {
  for (int side = 0; side < kSides && !profile_.empty(); ++side) {
    const Turned d = turned(side, static_cast<float>(x), static_cast<float>(y));
    if (!(d.f > 0 && std::abs(d.l) <= d.f)) continue;
    const float t = d.l / d.f;
    const int column = std::clamp(static_cast<int>((t + 1) * perT_), 0, columns_ - 1);
    const float w = profile_[at(side, column)];
    if (w == kNowhere) return {};
    return std::atan2(double{w}, std::sqrt(1 + double{t} * t));
  }
  return {};
}

bool Horizon::blocks(Vec3 direction) const {
  if (profile_.empty()) return false;
  const auto place = placeOf(static_cast<float>(direction.x), static_cast<float>(direction.y));
  return place &&
         profile_[at(place->side, place->column)] * place->forwards > static_cast<float>(direction.z);
}

std::optional<Horizon::Place> Horizon::placeOf(float x, float y) const {
  const int side = std::abs(x) >= std::abs(y) ? (x > 0 ? 0 : 2) : (y > 0 ? 1 : 3);
  const Turned d = turned(side, x, y);
  if (!(d.f > 0 && d.f < std::numeric_limits<float>::max())) return {};
  return Place{side, std::min(static_cast<int>((d.l / d.f + 1) * perT_), columns_ - 1), d.f};
}

bool Horizon::isPointBlocked(float x, float y, float z) {
  const auto place = placeOf(x, y);
  return place && lift(place->side, place->column, z / place->forwards);
}

}  // namespace trimtab
