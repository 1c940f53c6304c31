#include "trimtab/terrain/mesher_order.h"

#include <array>

namespace trimtab::terrain {

namespace {

/// As many half-edges as the packing of triangles looks back on.
constexpr std::uint32_t kRecent = 16;
/// Of these the best is sought; older ones are taken as they come.
constexpr std::uint32_t kSought = 3;

}  // namespace

void TriangleOrder::order(const Triangulation& mesh, std::vector<std::uint32_t>& indices) {
  const std::size_t count = mesh.triangles.size();
  done_.assign(count, 0);
  indices.resize(3 * count);
  std::uint32_t* out = indices.data();
  const auto isOpen = [&](std::int32_t h) { return h >= 0 && done_[static_cast<std::size_t>(h >> 2)] == 0; };
  std::array<std::int32_t, kRecent> recent;
  recent.fill(-1);
  std::uint32_t newest = 0;
  std::size_t unseen = 0;
  for (std::size_t left = count; left > 0; --left) {
    // One that leaves few ways on is taken now, or it would stay behind alone.
    std::int32_t best = -1, fewest = 3;
    for (std::uint32_t k = 1; k <= kRecent && (k <= kSought || best < 0) && fewest > 0; ++k) {
      const std::int32_t h = recent[(newest - k) % kRecent];
      if (!isOpen(h)) continue;
      const Triangulation::Triangle& at = mesh.triangles[static_cast<std::size_t>(h >> 2)];
      const std::int32_t ways = (isOpen(at.twin[Triangulation::next(h & 3)]) ? 1 : 0) +
                                (isOpen(at.twin[Triangulation::before(h & 3)]) ? 1 : 0);
      if (ways < fewest) fewest = ways, best = h;
    }
    if (best < 0) {
      while (done_[unseen] != 0) ++unseen;
      best = static_cast<std::int32_t>(4 * unseen);
    }
    const Triangulation::Triangle& at = mesh.triangles[static_cast<std::size_t>(best >> 2)];
    const int second = Triangulation::next(best & 3), third = Triangulation::before(best & 3);
    done_[static_cast<std::size_t>(best >> 2)] = 1;
    *out++ = at.corner[best & 3];
    *out++ = at.corner[second];
    *out++ = at.corner[third];
    recent[newest++ % kRecent] = at.twin[third];
    recent[newest++ % kRecent] = at.twin[second];
  }
}

}  // namespace trimtab::terrain
