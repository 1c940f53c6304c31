#include "trimtab/culling/horizon.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace trimtab {
namespace {

constexpr float kNowhere = -std::numeric_limits<float>::max();
constexpr std::uint32_t kNone = 0xffffffffu;
/// Steeper directions are not looked at: what is there is seen.
constexpr float kSteepest = 10;
/// What is nearer than this in plan, metres, or than this share of its own tile's size, hides nothing and is
/// seen: floats would leave its direction too uncertain.
constexpr float kNearest = 64, kNearestShare = 0.05f;
/// How far directions are off by single precision from there on: positions by 2^-22 of their distance and of
/// the tile's size.
constexpr double kRounding = 1.2e-5;

/// Rings of distance in plan, 128 to an octave from 1 m, by the bits of the number: what is in a lower ring
/// is nearer.
constexpr int kRingShift = 16;
constexpr std::uint32_t kRings = 26 * 128;
std::uint32_t ringOf(float distance) {
  const std::uint32_t ring =
      (std::bit_cast<std::uint32_t>(std::max(distance, 1.0f)) - 0x3f800000u) >> kRingShift;
  return std::min(ring, kRings - 1);
}

/// Forwards and sideways of a quarter: +x, +y, -x, -y.
struct Turned {
  float f, l;
};
constexpr std::array<std::array<float, 2>, 4> kForward{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
Turned turned(int side, float x, float y) {
  const auto [a, b] = kForward[static_cast<std::size_t>(side)];
  return {a * x + b * y, a * y - b * x};
}

/// The same of a box in plan.
struct TurnedBox {
  float f0, f1, l0, l1;
};
TurnedBox turned(int side, float x0, float x1, float y0, float y1) {
  switch (side) {
    case 0:
      return {x0, x1, y0, y1};
    case 1:
      return {y0, y1, -x1, -x0};
    case 2:
      return {-x1, -x0, -y1, -y0};
    default:
      return {-y1, -y0, x0, x1};
  }
}

/// Whether the quarter, and a little beside it, meets the box.
bool meets(const TurnedBox& b) {
  return b.f1 > 0 && std::max({b.l0, -b.l1, 0.0f}) <= 1.01f * b.f1;
}

float nearestInPlan(const Box& b, const std::array<float, 3>& o) {
  const float x = std::max({b.minX + o[0], -(b.maxX + o[0]), 0.0f}),
              y = std::max({b.minY + o[1], -(b.maxY + o[1]), 0.0f});
  return std::sqrt(x * x + y * y);
}

std::array<float, 3> fromEye(Vec3 eye, Vec3 origin) {
  return {static_cast<float>(origin.x - eye.x), static_cast<float>(origin.y - eye.y),
          static_cast<float>(origin.z - eye.z)};
}

}  // namespace

void Horizon::build(Vec3 eye, std::span<const HorizonTile> tiles, const Settings& settings) {
  eye_ = eye;
  columns_ = std::clamp(settings.columns, kLeastColumns, kMostColumns);
  perT_ = 0.5f * static_cast<float>(columns_);
  slack_ = static_cast<float>(2 * settings.slack + kRounding);
  raised_ = settings.raised;
  profile_.assign(static_cast<std::size_t>(kSides * columns_), kNowhere);
  hidden_.assign(tiles.size(), 0);
  hiddenCount_ = 0;
  lines_.clear();
  if (!(std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z)) || !(slack_ < 0.1f)) return;

  ring_.assign(tiles.size(), 0);
  firstOfRing_.assign(kRings + 1, 0);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (const Relief* surface = tiles[i].surface())
      ring_[i] = ringOf(nearestInPlan(surface->bounds, fromEye(eye, surface->origin)));
    ++firstOfRing_[ring_[i] + 1];
  }
  for (std::uint32_t ring = 0; ring < kRings; ++ring) firstOfRing_[ring + 1] += firstOfRing_[ring];
  order_.resize(tiles.size());
  for (std::size_t i = 0; i < tiles.size(); ++i)
    order_[firstOfRing_[ring_[i]]++] = static_cast<std::uint32_t>(i);

  firstLine_.assign(kRings, kNone);
  std::uint32_t done = 0;  // rings whose lines are in the horizon
  for (const std::uint32_t i : order_) {
    const HorizonTile& tile = tiles[i];
    if (!tile.surface()) continue;
    for (; done < ring_[i]; ++done)
      for (std::uint32_t n = firstLine_[done]; n != kNone; n = lines_[n].next) {
        const HorizonTile& other = tiles[lines_[n].tile];
        takeUp(*other.surface());
        addLine(other, lines_[n].line);
      }
    takeUp(*tile.surface());
    if (tile.relief ? isHidden(*tile.relief) : isHidden(*tile.mesh)) {
      // Nor can its lines stand out of what hides it.
      hidden_[i] = 1;
      ++hiddenCount_;
    } else if (tile.mayOcclude) {
      enqueueLines(i, tile);
    }
  }
}

void Horizon::takeUp(const Relief& relief) {
  offset_ = fromEye(eye_, relief.origin);
  nearest_ = std::max(kNearest, kNearestShare * relief.reach);
}

void Horizon::take(const Relief& relief, const float* x, const float* y, const float* z, int count, int to) {
  const auto offset = fromEye(eye_, relief.origin);
  float *toX = x_.data() + to, *toY = y_.data() + to, *toZ = z_.data() + to;
  for (int k = 0; k < count; ++k) {
    toX[k] = x[k] + offset[0];
    toY[k] = y[k] + offset[1];
    toZ[k] = z[k] + offset[2];
  }
}

/// Fills in the corners of a line, with those of the next tile where it goes on; how many there are.
int Horizon::cornersOf(const HorizonTile& tile, std::uint32_t line) {
  if (!tile.relief) {
    const MeshRelief& mesh = *tile.mesh;
    const std::uint32_t first = mesh.lineFirst[line];
    const int count = std::min(static_cast<int>(mesh.lineFirst[line + 1] - first), kMostCorners);
    take(mesh, mesh.lineX.data() + first, mesh.lineY.data() + first, mesh.lineZ.data() + first, count, 0);
    return count;
  }
  const auto takeFrom = [&](const TileRelief& relief, int from, int count, int to) {
    const std::size_t first =
        std::size_t{line} * static_cast<std::size_t>(relief.side) + static_cast<std::size_t>(from);
    take(relief, relief.lineX.data() + first, relief.lineY.data() + first, relief.lineZ.data() + first, count,
         to);
    return count;
  };
  const int side = tile.relief->side;
  takeFrom(*tile.relief, 0, side, 0);
  // Rows and columns take turns.
  const TileRelief* next = line % 2 == 0 ? tile.east : tile.north;
  if (!next || next->lines != tile.relief->lines || next->side != side) return side;
  return side + takeFrom(*next, 1, std::min(kGoOn, side - 1), side);
}

void Horizon::enqueueLines(std::uint32_t tile, const HorizonTile& from) {
  const std::uint32_t lines = from.relief ? static_cast<std::uint32_t>(from.relief->lines)
                                          : static_cast<std::uint32_t>(from.mesh->lines());
  for (std::uint32_t line = 0; line < lines; ++line) {
    const int count = cornersOf(from, line);
    float furthest = 0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      furthest = std::max(furthest, x_[k] * x_[k] + y_[k] * y_[k]);
    // Nearer by more than the depth buffer's rounding.
    const std::uint32_t ring = ringOf(std::sqrt(furthest) * (1 + 2e-5f) + 0.02f);
    lines_.push_back({tile, line, firstLine_[ring]});
    firstLine_[ring] = static_cast<std::uint32_t>(lines_.size() - 1);
  }
}

/// A run of corners along which u rises, `step` apart in the arrays.
template <bool Raised>
void Horizon::addRun(float* horizon, const float* u, const float* w, int count, int step) const {
  const auto worse = [](float a, float b) { return Raised ? std::max(a, b) : std::min(a, b); };
  const float last = u[(count - 1) * step];
  if (!(last >= 0) || !(u[0] <= static_cast<float>(columns_))) return;
  int column = u[0] <= 0 ? 0 : static_cast<int>(std::ceil(u[0]));  // the next column's side to be crossed
  bool started = Raised;
  float least = Raised ? w[0] : 0;
  for (int i = 0; i + 1 < count; ++i) {
    const float ua = u[i * step], wa = w[i * step], ub = u[(i + 1) * step], wb = w[(i + 1) * step];
    if (static_cast<float>(column) <= ub && column <= columns_) {
      const float rise = ub > ua ? (wb - wa) / (ub - ua) : 0;
      for (; static_cast<float>(column) <= ub && column <= columns_; ++column) {
        float at = wa + (static_cast<float>(column) - ua) * rise;
        at = std::clamp(at, std::min(wa, wb), std::max(wa, wb));
        if (started && column > 0) {
          float& reached = horizon[column - 1];
          reached = std::max(reached, worse(least, at));
        }
        least = at;
        started = true;
      }
    }
    least = worse(least, wb);
  }
  if (Raised && column > 0 && column <= columns_) horizon[column - 1] = std::max(horizon[column - 1], least);
}

void Horizon::addLine(const HorizonTile& tile, std::uint32_t line) {
  const int count = cornersOf(tile, line);
  const auto [x0, x1] = std::minmax(x_[0], x_[static_cast<std::size_t>(count - 1)]);
  const auto [y0, y1] = std::minmax(y_[0], y_[static_cast<std::size_t>(count - 1)]);
  for (int side = 0; side < kSides; ++side) {
    if (!meets(turned(side, x0, x1, y0, y1))) continue;
    float u[kMostCorners], w[kMostCorners], forward[kMostCorners];
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Turned p = turned(side, x_[i], y_[i]);
      forward[k] = p.f;
      const float inverse = 1 / p.f;
      u[k] = (p.l * inverse + 1) * perT_;
      w[k] = z_[i] * inverse;
    }
    float* horizon = profile_.data() + side * columns_;
    const auto usable = [&](int k) { return forward[k] > nearest_; };
    for (int k = 0; k + 1 < count;) {
      if (!usable(k) || !usable(k + 1)) {
        ++k;
        continue;
      }
      const bool rises = u[k + 1] >= u[k];
      int end = k + 1;
      while (end + 1 < count && usable(end + 1) && (u[end + 1] >= u[end]) == rises) ++end;
      const int from = rises ? k : end;
      if (raised_)
        addRun<true>(horizon, u + from, w + from, end - k + 1, rises ? 1 : -1);
      else
        addRun<false>(horizon, u + from, w + from, end - k + 1, rises ? 1 : -1);
      k = end;
    }
  }
}

bool Horizon::covers(int side, float t0, float t1, float w) const {
  if (!(std::abs(w) <= kSteepest)) return false;
  // A direction that turns by `slack_` moves in t and w by at most this.
  const float beside = slack_ * 1.5f * (2.1f + w * w);
  t0 -= beside;
  t1 += beside;
  if (t0 > 1 || t1 < -1) return true;  // another quarter's
  const float limit = w + beside;
  const int last = columns_ - 1;
  const int from = std::clamp(static_cast<int>(std::floor((std::max(t0, -1.0f) + 1) * perT_)), 0, last),
            to = std::clamp(static_cast<int>(std::floor((std::min(t1, 1.0f) + 1) * perT_)), 0, last);
  const float* horizon = profile_.data() + side * columns_;
  for (int column = from; column <= to; ++column)
    if (!(horizon[column] > limit)) return false;
  return true;
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
  for (int side = 0; side < kSides; ++side) {
    const Turned d = turned(side, static_cast<float>(direction.x), static_cast<float>(direction.y));
    if (!(d.f > 0 && std::abs(d.l) <= d.f)) continue;
    const int column = std::min(static_cast<int>((d.l / d.f + 1) * perT_), columns_ - 1);
    return profile_[static_cast<std::size_t>(side * columns_ + column)] >
           static_cast<float>(direction.z) / d.f;
  }
  return false;
}

bool Horizon::isBoxHidden(const Box& box) const {
  const float x0 = box.minX + offset_[0], x1 = box.maxX + offset_[0], y0 = box.minY + offset_[1],
              y1 = box.maxY + offset_[1], top = box.maxZ + offset_[2];
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox b = turned(side, x0, x1, y0, y1);
    if (!meets(b)) continue;
    if (!(b.f0 > nearest_)) return false;
    const float nearer = 1 / b.f0, further = 1 / b.f1;
    if (!covers(side, b.l0 * (b.l0 < 0 ? nearer : further), b.l1 * (b.l1 > 0 ? nearer : further),
                top * (top > 0 ? nearer : further)))
      return false;
  }
  return true;
}

bool Horizon::isPartHidden(const TileRelief& relief, int part) const {
  constexpr int kPosts = TileRelief::kPartCells + 1;
  const int row0 = part / relief.partsPerSide() * TileRelief::kPartCells,
            column0 = part % relief.partsPerSide() * TileRelief::kPartCells;
  const int rows = std::min(kPosts, relief.side - row0), columns = std::min(kPosts, relief.side - column0);
  const Box& b = relief.parts[static_cast<std::size_t>(part)];
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox box =
        turned(side, b.minX + offset_[0], b.maxX + offset_[0], b.minY + offset_[1], b.maxY + offset_[1]);
    if (!meets(box)) continue;
    if (!(box.f0 > nearest_)) return false;
    float t[kPosts][kPosts], w[kPosts][kPosts];
    for (int j = 0; j < rows; ++j) {
      const std::size_t first = static_cast<std::size_t>((row0 + j) * relief.side + column0);
      for (int i = 0; i < columns; ++i) {
        const std::size_t k = first + static_cast<std::size_t>(i);
        const Turned p = turned(side, relief.x[k] + offset_[0], relief.y[k] + offset_[1]);
        const float inverse = 1 / p.f;
        t[j][i] = p.l * inverse;
        w[j][i] = (relief.z[k] + offset_[2]) * inverse;
      }
    }
    constexpr int kStep = TileRelief::kBlockCells;
    for (int j = 0; j + 1 < rows; j += kStep)
      for (int i = 0; i + 1 < columns; i += kStep) {
        float t0 = t[j][i], t1 = t0, top = w[j][i];
        for (int r = j; r <= std::min(j + kStep, rows - 1); ++r)
          for (int c = i; c <= std::min(i + kStep, columns - 1); ++c) {
            t0 = std::min(t0, t[r][c]);
            t1 = std::max(t1, t[r][c]);
            top = std::max(top, w[r][c]);
          }
        if (!covers(side, t0, t1, top)) return false;
      }
  }
  return true;
}

/// Whether a post stands out of the horizon: then its block would, and nothing else has to be looked at.
bool Horizon::showsPeak(const TileRelief& relief) const {
  for (const std::uint32_t post : relief.peaks)
    if (!blocks({double{relief.x[post] + offset_[0]}, double{relief.y[post] + offset_[1]},
                 double{relief.z[post] + offset_[2]}}))
      return true;
  return false;
}

bool Horizon::isHidden(const TileRelief& relief) const {
  if (relief.parts.empty() || relief.side > kMostPosts) return false;
  if (isBoxHidden(relief.bounds)) return true;
  if (showsPeak(relief)) return false;
  for (int part = 0; part < static_cast<int>(relief.parts.size()); ++part)
    if (!isBoxHidden(relief.parts[static_cast<std::size_t>(part)]) && !isPartHidden(relief, part))
      return false;
  return true;
}

bool Horizon::isPartHidden(const MeshRelief& relief, const MeshRelief::Part& part) const {
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox box = turned(side, part.box.minX + offset_[0], part.box.maxX + offset_[0],
                                 part.box.minY + offset_[1], part.box.maxY + offset_[1]);
    if (!meets(box)) continue;
    if (!(box.f0 > nearest_)) return false;
    float t[3 * MeshRelief::kPartTriangles], w[3 * MeshRelief::kPartTriangles];
    for (std::size_t i = 0; i < part.vertices; ++i) {
      const std::size_t k = part.firstVertex + i;
      const Turned p = turned(side, relief.x[k] + offset_[0], relief.y[k] + offset_[1]);
      const float inverse = 1 / p.f;
      t[i] = p.l * inverse;
      w[i] = (relief.z[k] + offset_[2]) * inverse;
    }
    const std::uint8_t* corner = relief.corners.data() + part.firstCorner;
    for (std::size_t i = 0; i < part.triangles; ++i, corner += 3) {
      const auto [a, b, c] = std::array{corner[0], corner[1], corner[2]};
      if (!covers(side, std::min({t[a], t[b], t[c]}), std::max({t[a], t[b], t[c]}),
                  std::max({w[a], w[b], w[c]})))
        return false;
    }
  }
  return true;
}

bool Horizon::isHidden(const MeshRelief& relief) const {
  if (relief.parts.empty()) return false;
  if (isBoxHidden(relief.bounds)) return true;
  for (const MeshRelief::Part& part : relief.parts) {
    const std::size_t peak = part.firstVertex + part.peak;
    if (!blocks({double{relief.x[peak] + offset_[0]}, double{relief.y[peak] + offset_[1]},
                 double{relief.z[peak] + offset_[2]}}))
      return false;
  }
  for (const MeshRelief::Part& part : relief.parts)
    if (!isBoxHidden(part.box) && !isPartHidden(relief, part)) return false;
  return true;
}

}  // namespace trimtab
