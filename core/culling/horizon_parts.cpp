#include "trimtab/culling/horizon.h"
#include "trimtab/culling/horizon_geometry.h"
#include "trimtab/culling/horizon_kernels.h"

/// Whether a tile is wholly below the horizon.
namespace trimtab {

using namespace horizon;

namespace {

/// Steeper directions are not looked at: what is there is seen.
constexpr float kSteepest = 10;

}  // namespace

bool Horizon::covers(int side, float t0, float t1, float w) const {
  if (!(std::abs(w) <= kSteepest)) return false;
  // A direction that turns by `off_` moves in t and w by at most this.
  const float beside = off_ * 1.5f * (2.1f + w * w);
  const Play& play = play_[static_cast<std::size_t>(side)];
  const float limit = w + beside,
              aside = beside + (std::max(play.across(t0), play.across(t1)) + play.radius) * (1 / kFarM);
  t0 -= aside;
  t1 += aside;
  if (t0 > 1 || t1 < -1) return true;  // another quarter's
  const int last = columns_ - 1;
  const int from = std::clamp(static_cast<int>((std::max(t0, -1.0f) + 1) * perT_), 0, last),
            to = std::clamp(static_cast<int>((std::min(t1, 1.0f) + 1) * perT_), 0, last);
  const float* horizon = profile_.data() + side * columns_;
  // Mostly it is the first that stands out.
  if (!(horizon[from] > limit)) return false;
  return kernels(settings_.simd).allAbove(horizon + from, to - from + 1, limit);
}

bool Horizon::isBoxHidden(const Box& box) const {
  Outline outline{};
  outline.x0 = box.minX + offset_[0];
  outline.x1 = box.maxX + offset_[0];
  outline.y0 = box.minY + offset_[1];
  outline.y1 = box.maxY + offset_[1];
  outline.top = box.maxZ + offset_[2];
  return isBoxHidden(outline);
}

bool Horizon::isBoxHidden(const Outline& box) const {
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox b = turned(side, box.x0, box.x1, box.y0, box.y1);
    if (!meets(b)) continue;
    if (!(b.f0 > nearest_)) return false;
    const float nearer = 1 / b.f0, further = 1 / b.f1;
    if (!covers(side, b.l0 * (b.l0 < 0 ? nearer : further), b.l1 * (b.l1 > 0 ? nearer : further),
                box.top * (box.top > 0 ? nearer : further)))
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

/// After the whole box was not.
bool Horizon::isHidden(const TileRelief& relief) {
  for (const auto& peak : relief.peaks)
    if (!isPointBlocked(peak[0] + offset_[0], peak[1] + offset_[1], peak[2] + offset_[2])) return false;
  work_ += relief.parts.size();
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

bool Horizon::isHidden(const MeshRelief& relief) {
  for (const MeshRelief::Part& part : relief.parts) {
    const std::size_t peak = part.firstVertex + part.peak;
    if (!isPointBlocked(relief.x[peak] + offset_[0], relief.y[peak] + offset_[1],
                        relief.z[peak] + offset_[2]))
      return false;
  }
  work_ += relief.parts.size();
  for (const MeshRelief::Part& part : relief.parts)
    if (!isBoxHidden(part.box) && !isPartHidden(relief, part)) return false;
  return true;
}

}  // namespace trimtab
