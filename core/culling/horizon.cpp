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
/// Distance at which a room's play is tested with the parts instead of taken off the lines, metres: there it
/// is about a column.
constexpr float kFarM = 8000;

float nearestInPlan(const Box& b, const std::array<float, 3>& o) {
  const float x = std::max({b.minX + o[0], -(b.maxX + o[0]), 0.0f}),
              y = std::max({b.minY + o[1], -(b.maxY + o[1]), 0.0f});
  return std::sqrt(x * x + y * y);
}

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
    play_[static_cast<std::size_t>(side)] = {
        .along = h.f,
        .across = h.l,
        .radius = radius,
        .forwards = forwards,
        .upwards = std::abs(static_cast<float>(half.z)) + radius,
        .beside = (std::abs(h.l) + std::abs(h.f) + 1.5f * radius) / kFarM};
    if (settings.still) play_[static_cast<std::size_t>(side)] = {};
  }
  isSorted_ = tiles.empty();
}

void Horizon::sortTiles() {
  isSorted_ = true;
  ring_.assign(tiles_.size(), 0);
  firstOfRing_.assign(kRings + 1, 0);
  firstPiece_.assign(kRings, kNone);
  constexpr std::size_t kAhead = 8;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    if (i + kAhead < tiles_.size()) __builtin_prefetch(tiles_[i + kAhead].surface());
    if (const Relief* surface = tiles_[i].surface())
      ring_[i] = ringOf(nearestInPlan(surface->bounds, fromEye(eye_, surface->origin)) - tiles_[i].above);
    ++firstOfRing_[ring_[i] + 1];
  }
  for (std::uint32_t ring = 0; ring < kRings; ++ring) firstOfRing_[ring + 1] += firstOfRing_[ring];
  order_.resize(tiles_.size());
  for (std::size_t i = 0; i < tiles_.size(); ++i)
    order_[firstOfRing_[ring_[i]]++] = static_cast<std::uint32_t>(i);
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

void Horizon::testNext() {
  constexpr std::size_t kAhead = 5;
  if (next_ + 2 * kAhead < order_.size()) {
    // What is read of a tile lies in places that are each found by the one before.
    const Relief* further = tiles_[order_[next_ + 2 * kAhead]].surface();
    __builtin_prefetch(further);
    __builtin_prefetch(reinterpret_cast<const char*>(further) + 64);
    if (const TileRelief* relief = tiles_[order_[next_ + kAhead]].relief; relief && lastStood_) {
      const char* lines = reinterpret_cast<const char*>(relief->lineXyz.data());
      for (std::size_t at = 0; at < 3 * sizeof(float) * 64; at += 64) __builtin_prefetch(lines + at);
    }
  }
  const std::uint32_t i = order_[next_++];
  const HorizonTile& tile = tiles_[i];
  ++work_;
  if (!tile.surface()) return;
  for (; done_ < ring_[i]; ++done_) flush(done_);
  takeUp(tile);
  if (!(tile.surface()->reach < kMostReach)) return;
  if (tile.relief ? isHidden(*tile.relief) : isHidden(*tile.mesh)) {
    // Nor can its lines stand out of what hides it.
    hidden_[i] = 1;
    ++hiddenCount_;
    lastStood_ = false;
  } else {
    if (tile.mayOcclude) enqueueLines(tile);
    lastStood_ = true;
  }
}

void Horizon::takeUp(const HorizonTile& tile) {
  const Relief& relief = *tile.surface();
  offset_ = fromEye(eye_, relief.origin);
  nearest_ = std::max({kNearest, leastM_, kNearestShare * relief.reach});
  off_ = slack_;
  if (tile.above > 0) off_ += tile.above / nearestInPlan(relief.bounds, offset_);
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
