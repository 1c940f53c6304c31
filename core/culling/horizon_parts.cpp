#include "horizon_geometry.h"
#include "horizon_kernels.h"
#include "trimtab/culling/horizon.h"

/// Tests whether a tile is wholly below the horizon.
namespace trimtab {

using namespace horizon;

namespace {

/// Directions steeper than this are not tested; whatever is there counts as seen.
constexpr float kSteepest = 10;

/// Returns the most by which t and w change when a direction turns by `off` radians.
float movedBy(float off, float w) {
  return off * 1.5f * (2.1f + w * w);
}

}  // namespace

float Horizon::besideOf(float off, float z, float away) const {
  // The distance in plan is at most sqrt(2) times the distance forwards.
  return 0.01f + movedBy(off, std::min(kSteepest, 1.5f * z / away)) + leastM_ * (1 / kFarM);
}

bool Horizon::covers(int side, float t0, float t1, float w) {
  if (!(std::abs(w) <= kSteepest)) return false;
  const float beside = movedBy(off_, w);
  const Play& play = play_[static_cast<std::size_t>(side)];
  const float limit = w + beside,
              aside = beside + (std::max(play.across(t0), play.across(t1)) + play.radius) * (1 / kFarM);
  t0 -= aside;
  t1 += aside;
  if (t0 > 1 || t1 < -1) return true;  // it lies in another quarter
  const int from = columnOf(t0), to = columnOf(t1);
  const float* horizon = profile_.data() + at(side, 0);
  // If a column is too low it is mostly the first.
  for (int column = from; column <= to;) {
    if (!lift(side, column, limit)) return false;
    ++column;
    column += kernels_->firstNotAbove(horizon + column, to - column + 1, limit);
  }
  return true;
}

bool Horizon::isBoxHidden(const Box& box) {
  return isPrismHidden(prismOf(box, offset_));
}

bool Horizon::isPrismHidden(const Prism& prism) {
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox b = turned(side, prism.x0, prism.x1, prism.y0, prism.y1);
    if (!meets(b, beside_)) continue;
    if (!(b.f0 > nearest_)) return false;
    const BoxImage image(b, prism.top);
    if (!covers(side, image.t0, image.t1, image.w)) return false;
  }
  return true;
}

bool Horizon::isPartHidden(const TileRelief::Part& part) {
  const Box& b = part.box;
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox box =
        turned(side, b.minX + offset_[0], b.maxX + offset_[0], b.minY + offset_[1], b.maxY + offset_[1]);
    if (!meets(box, beside_)) continue;
    if (!(box.f0 > nearest_)) return false;
    BoxImages images;
    kernels_->images(side, part, offset_, images);
    for (std::size_t k = 0; k < static_cast<std::size_t>(part.blocks); ++k)
      if (!covers(side, images.t0[k], images.t1[k], images.w[k])) return false;
  }
  return true;
}

/// Tests the parts, after the whole box was not hidden.
bool Horizon::isHidden(const TileRelief& relief) {
  for (const TileRelief::Part& part : relief.parts)
    if (!isPointBlocked(part.peak[0] + offset_[0], part.peak[1] + offset_[1], part.peak[2] + offset_[2]))
      return false;
  progress_.work += relief.parts.size();
  for (const TileRelief::Part& part : relief.parts)
    if (!isBoxHidden(part.box) && !isPartHidden(part)) return false;
  return true;
}

bool Horizon::isPartHidden(const MeshRelief& relief, const MeshRelief::Part& part) {
  for (int side = 0; side < kSides; ++side) {
    const TurnedBox box = turned(side, part.box.minX + offset_[0], part.box.maxX + offset_[0],
                                 part.box.minY + offset_[1], part.box.maxY + offset_[1]);
    if (!meets(box, beside_)) continue;
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
  progress_.work += relief.parts.size();
  for (const MeshRelief::Part& part : relief.parts)
    if (!isBoxHidden(part.box) && !isPartHidden(relief, part)) return false;
  return true;
}

}  // namespace trimtab
