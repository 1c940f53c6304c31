#include "trimtab/culling/horizon.h"

#include "trimtab/culling/horizon_geometry.h"

namespace trimtab {

using namespace horizon;

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// How far directions are off by single precision from kNearest on: positions by 2^-22 of their distance and
/// of the tile's size.
constexpr double kRounding = 1.2e-5;
/// Beyond this a surface's numbers are no places on earth, metres.
constexpr float kMostReach = 1e8f;

bool isPlace(Vec3 p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

bool EyeRoom::holds(Vec3 eye) const {
  const Vec3 along = to - from, in = eye - from;
  const double squared = dot(along, along);
  const double s = squared > 0 ? std::clamp(dot(in, along) / squared, 0.0, 1.0) : 0;
  return length(in - s * along) <= radius;
}

void Horizon::buildFor(const EyeRoom& room, std::span<const HorizonTile> tiles, const Settings& settings) {
  begin(room, tiles, settings);
  step(std::numeric_limits<std::size_t>::max() / 2);
}

void Horizon::begin(const EyeRoom& room, std::span<const HorizonTile> tiles, const Settings& settings) {
  room_ = room;
  eye_ = 0.5 * (room.from + room.to);
  settings_ = settings;
  columns_ = std::clamp(settings.columns, kLeastColumns, kMostColumns);
  perT_ = 0.5f * static_cast<float>(columns_);
  profile_.assign(static_cast<std::size_t>(kSides * columns_), kNowhere);
  reached_.resize(static_cast<std::size_t>(3 * columns_ + 16));  // and what a room asks for beside a quarter
  hidden_.assign(tiles.size(), 0);
  hiddenCount_ = 0;
  tiles_ = tiles;
  order_.clear();
  pieces_.clear();
  pool_.clear();
  next_ = work_ = 0;
  done_ = 0;
  isSorted_ = true;

  const Vec3 half = 0.5 * (room.to - room.from);
  const double play = std::hypot(half.x, half.y) + room.radius;
  // A direction from another place of the room turns by at most half as much again.
  slack_ = static_cast<float>((play > 0 ? 3 : 2) * settings.slack + kRounding);
  if (!isPlace(room.from) || !isPlace(room.to) || !(room.radius >= 0) || !(slack_ < 0.1f) ||
      !(play + std::abs(half.z) <= kMostRoomM))
    return;
  leastM_ = static_cast<float>(2 * play);
  for (int side = 0; side < kSides; ++side) {
    const Turned h = turned(side, static_cast<float>(half.x), static_cast<float>(half.y));
    const float radius = static_cast<float>(room.radius), forwards = std::abs(h.f) + radius;
    play_[static_cast<std::size_t>(side)] = {.along = h.f,
                                             .side = h.l,
                                             .radius = radius,
                                             .forwards = forwards,
                                             .upwards = std::abs(static_cast<float>(half.z)) + radius};
    if (settings.still) play_[static_cast<std::size_t>(side)] = {};
  }
  isSorted_ = tiles.empty();
}

Horizon::Outline Horizon::outlineOf(std::uint32_t n) const {
  const HorizonTile& tile = tiles_[n];
  const Relief* relief = tile.surface();
  Outline o{};
  o.tile = kNone;
  if (!relief || !(relief->reach >= 0 && relief->reach < kMostReach)) return o;
  const auto from = fromEye(eye_, relief->origin);
  const Box& b = relief->bounds;
  o.x0 = b.minX + from[0];
  o.x1 = b.maxX + from[0];
  o.y0 = b.minY + from[1];
  o.y1 = b.maxY + from[1];
  o.top = b.maxZ + from[2];
  for (std::size_t k = 0; k < 3; ++k) o.peak[k] = relief->peak[k] + from[k];
  const float x = std::max({o.x0, -o.x1, 0.0f}), y = std::max({o.y0, -o.y1, 0.0f});
  const float away = std::sqrt(x * x + y * y);
  o.nearest = std::max({kNearest, leastM_, kNearestShare * relief->reach});
  o.off = slack_ + (tile.above > 0 ? tile.above / away : 0);
  o.tile = n;
  o.ring = ringOf(away - tile.above);
  return o;
}

Horizon::Lines Horizon::linesOf(const HorizonTile& tile, const Outline& o) const {
  Lines l{};
  if (!tile.relief || !tile.mayOcclude || o.tile == kNone) return l;
  const TileRelief& relief = *tile.relief;
  // Those along the line of sight hide next to nothing that the others do not.
  const bool rows = std::abs(o.y0 + o.y1) >= std::abs(o.x0 + o.x1);
  l.side = relief.side;
  l.count = relief.lines / 2;
  const auto first = static_cast<std::size_t>(rows ? 0 : l.count);
  l.xyz = relief.lineXyz.data() + first * 3 * static_cast<std::size_t>(relief.side);
  l.from = fromEye(eye_, relief.origin);
  l.besideM = relief.besideM;
  l.below = tile.below;
  const TileRelief* next = rows ? tile.east : tile.north;
  if (next && next->lines == relief.lines && next->side == relief.side) {
    l.goOn = next->goOn.data() + first * 3 * TileRelief::kGoOn;
    l.goOnFrom = fromEye(eye_, next->origin);
  }
  return l;
}

void Horizon::sortTiles() {
  isSorted_ = true;
  firstOfRing_.assign(kRings + 1, 0);
  firstPiece_.assign(kRings, kNone);
  outlines_.resize(tiles_.size());
  lines_.resize(tiles_.size());
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    if (i + kAhead < tiles_.size()) {
      const HorizonTile& ahead = tiles_[i + kAhead];
      for (const void* p :
           {static_cast<const void*>(ahead.surface()), static_cast<const void*>(ahead.north)}) {
        __builtin_prefetch(p);
        __builtin_prefetch(static_cast<const char*>(p) + 64);
      }
    }
    outlines_[i] = outlineOf(static_cast<std::uint32_t>(i));
    lines_[i] = linesOf(tiles_[i], outlines_[i]);
    ++firstOfRing_[outlines_[i].ring + 1];
  }
  for (std::uint32_t ring = 0; ring < kRings; ++ring) firstOfRing_[ring + 1] += firstOfRing_[ring];
  order_.resize(tiles_.size());
  for (std::uint32_t i = 0; i < tiles_.size(); ++i) order_[firstOfRing_[outlines_[i].ring]++] = i;
}

bool Horizon::step(std::size_t work) {
  const std::size_t end = work_ + work;
  if (!isSorted_) {
    sortTiles();
    work_ += tiles_.size() / 8;
  }
  while (!isDone() && work_ < end) testNext();
  return isDone();
}

/// Tiles that stand out follow each other.
void Horizon::prefetchLines() const {
  constexpr std::size_t kAhead = 8;
  if (next_ + kAhead >= order_.size()) return;
  const Lines& lines = lines_[order_[next_ + kAhead]];
  const auto bytes = sizeof(float) * 3 * static_cast<std::size_t>(lines.side * std::min(lines.count, 2));
  for (std::size_t at = 0; at < bytes; at += 64)
    __builtin_prefetch(reinterpret_cast<const char*>(lines.xyz) + at);
  __builtin_prefetch(lines.goOn);
}

void Horizon::testNext() {
  if (lastStood_) prefetchLines();
  const Outline& outline = outlines_[order_[next_++]];
  ++work_;
  if (outline.tile == kNone) return;
  for (; done_ < outline.ring; ++done_) flush(done_);
  const HorizonTile& tile = tiles_[outline.tile];
  nearest_ = outline.nearest;
  off_ = outline.off;
  // If a post stands out of the horizon then its block would, and nothing else has to be looked at.
  bool hidden = isPointBlocked(outline.peak[0], outline.peak[1], outline.peak[2]);
  if (hidden && !isBoxHidden(outline)) {
    offset_ = fromEye(eye_, tile.surface()->origin);
    hidden = tile.relief ? isHidden(*tile.relief) : isHidden(*tile.mesh);
  }
  lastStood_ = !hidden;
  if (hidden) {
    // Nor can its lines stand out of what hides it.
    hidden_[outline.tile] = 1;
    ++hiddenCount_;
  } else if (tile.mayOcclude) {
    if (tile.relief) {
      enqueueLines(lines_[outline.tile]);
    } else {
      offset_ = fromEye(eye_, tile.mesh->origin);
      enqueueLines(*tile.mesh, tile.below);
    }
  }
}

std::optional<double> Horizon::elevation(double x, double y) const {
  for (int side = 0; side < kSides && !profile_.empty(); ++side) {
    const Turned d = turned(side, static_cast<float>(x), static_cast<float>(y));
    if (!(d.f > 0 && std::abs(d.l) <= d.f)) continue;
    const float t = d.l / d.f;
    const int column = std::clamp(static_cast<int>((t + 1) * perT_), 0, columns_ - 1);
    const float w = profile_[static_cast<std::size_t>(side * columns_ + column)];
    if (w == kNowhere) return {};
    return std::atan2(double{w}, std::sqrt(1 + double{t} * t));
  }
  return {};
}

bool Horizon::blocks(Vec3 direction) const {
  return !profile_.empty() && isPointBlocked(static_cast<float>(direction.x), static_cast<float>(direction.y),
                                             static_cast<float>(direction.z));
}

bool Horizon::isPointBlocked(float x, float y, float z) const {
  const int side = std::abs(x) >= std::abs(y) ? (x > 0 ? 0 : 2) : (y > 0 ? 1 : 3);
  const Turned d = turned(side, x, y);
  if (!(d.f > 0 && d.f < std::numeric_limits<float>::max())) return false;
  const int column = std::min(static_cast<int>((d.l / d.f + 1) * perT_), columns_ - 1);
  return profile_[static_cast<std::size_t>(side * columns_ + column)] * d.f > z;
}

}  // namespace trimtab
