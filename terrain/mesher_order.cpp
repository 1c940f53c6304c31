#include "trimtab/terrain/mesher_order.h"

#include <array>

namespace trimtab::terrain {

namespace {

/// As many half-edges as the packing of triangles looks back on.
constexpr std::uint32_t kRecent = 16;
/// Of these the best is sought; older ones are taken as they come.
constexpr std::uint32_t kSought = 3;
/// In place of a number of neighbours.
constexpr std::uint8_t kDone = 4;

}  // namespace

void TriangleOrder::order(const Triangulation& mesh, std::vector<std::uint32_t>& indices) {
  const std::size_t count = mesh.triangles.size();
  open_.resize(count + 1);
  open_[0] = kDone;
  for (std::size_t t = 0; t < count; ++t) {
    const std::int32_t* const twin = mesh.triangles[t].twin;
    open_[t + 1] = static_cast<std::uint8_t>((twin[0] >= 0) + (twin[1] >= 0) + (twin[2] >= 0));
  }
  indices.resize(3 * count);
  std::uint32_t* out = indices.data();
  const auto openOf = [&](std::int32_t h) -> std::uint8_t& {
    return open_[static_cast<std::size_t>(std::max(h, -1) + 4) >> 2];
  };
  std::array<std::int32_t, kRecent> recent;
  recent.fill(-1);
  std::uint32_t newest = 0;
  std::size_t unseen = 1;
  for (std::size_t left = count; left > 0; --left) {
    // One that leaves few ways on is taken now, or it would stay behind alone.
    std::int32_t best = -1;
    std::uint8_t fewest = kDone;
    for (std::uint32_t k = 1; k <= kSought; ++k) {
      const std::int32_t h = recent[(newest - k) % kRecent];
      const std::uint8_t ways = openOf(h);
      best = ways < fewest ? h : best;
      fewest = std::min(fewest, ways);
    }
    for (std::uint32_t k = kSought + 1; k <= kRecent && best < 0; ++k) {
      const std::int32_t h = recent[(newest - k) % kRecent];
      if (openOf(h) != kDone) best = h;
    }
    if (best < 0) {
      while (open_[unseen] == kDone) ++unseen;
      best = static_cast<std::int32_t>(4 * (unseen - 1));
    }
    const Triangulation::Triangle& at = mesh.triangles[static_cast<std::size_t>(best >> 2)];
    const int second = Triangulation::next(best & 3), third = Triangulation::before(best & 3);
    openOf(best) = kDone;
    for (const std::int32_t h : at.twin) {
      std::uint8_t& open = openOf(h);
      open = static_cast<std::uint8_t>(open - (open != kDone));
    }
    *out++ = at.corner[best & 3];
    *out++ = at.corner[second];
    *out++ = at.corner[third];
    recent[newest++ % kRecent] = at.twin[third];
    recent[newest++ % kRecent] = at.twin[second];
  }
}

}  // namespace trimtab::terrain
