#include "trimtab/terrain/mesh/order.h"

#include <algorithm>
#include <array>

#include "trimtab/terrain/mesh/triangulation.h"

namespace trimtab::terrain {

namespace {

/// The packing of triangles looks back on so many half-edges.
constexpr std::uint32_t kRecent = 16;
/// The best of so many is sought; older ones are used as they come.
constexpr std::uint32_t kSought = 3;
/// Marks a vertex that is done, in place of a number of neighbours.
constexpr std::uint8_t kDone = 4;

}  // namespace

void TriangleOrder::order(std::span<const std::int32_t> twins, std::vector<std::int32_t>& order) {
  const std::size_t count = twins.size() / 3;
  open_.resize(count + 1);
  open_[0] = kDone;
  for (std::size_t t = 0; t < count; ++t) {
    const std::int32_t* const twin = &twins[3 * t];
    open_[t + 1] = static_cast<std::uint8_t>((twin[0] >= 0) + (twin[1] >= 0) + (twin[2] >= 0));
  }
  order.resize(count);
  std::int32_t* out = order.data();
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
    const std::int32_t* const twin = &twins[3 * static_cast<std::size_t>(best >> 2)];
    openOf(best) = kDone;
    for (int k = 0; k < 3; ++k) {
      std::uint8_t& open = openOf(twin[k]);
      open = static_cast<std::uint8_t>(open - (open != kDone));
    }
    *out++ = best;
    recent[newest++ % kRecent] = twin[Triangulation::before(best & 3)];
    recent[newest++ % kRecent] = twin[Triangulation::next(best & 3)];
  }
}

}  // namespace trimtab::terrain
