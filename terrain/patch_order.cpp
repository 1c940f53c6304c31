#include "trimtab/terrain/patch_order.h"

#include <algorithm>
#include <array>

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kNone = ~0u;
/// As many half-edges as the packing of triangles looks back on.
constexpr std::uint32_t kRecent = 16;
/// Of these the best is sought; older ones are taken as they come.
constexpr std::uint32_t kSought = 8;
/// Looked at together; lists are filled up by so many.
constexpr std::uint32_t kAtOnce = 8;

std::uint32_t nextOf(std::uint32_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}

}  // namespace

void TriangleOrder::findTwins(std::span<const std::uint32_t> indices, std::size_t vertices) {
  const auto count = static_cast<std::uint32_t>(indices.size());
  start_.assign(vertices + 2, 0);
  for (const std::uint32_t v : indices) ++start_[v + 2];
  for (std::size_t v = 2; v < vertices + 2; ++v) start_[v] += start_[v - 1];
  leaving_.resize(count);
  goal_.resize(count + kAtOnce);
  for (std::uint32_t i = count; i < goal_.size(); ++i) goal_[i] = kNone;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t at = start_[indices[i] + 1]++;
    leaving_[at] = i;
    goal_[at] = indices[nextOf(i)];
  }
  twin_.assign(count, kNone);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t from = indices[i], to = indices[nextOf(i)];
    if (from > to) continue;
    const std::uint32_t end = start_[to + 1];
    for (std::uint32_t first = start_[to]; first < end; first += kAtOnce) {
      // The first, as behind the list's end lie those of another vertex.
      std::uint32_t found = kAtOnce;
      for (std::uint32_t k = 0; k < kAtOnce; ++k)
        found = std::min(found, goal_[first + k] == from ? k : kAtOnce);
      const std::uint32_t at = first + found;
      if (found == kAtOnce) continue;
      if (at >= end) break;
      twin_[i] = leaving_[at];
      twin_[leaving_[at]] = i;
      break;
    }
  }
}

void TriangleOrder::order(std::span<const std::uint32_t> indices, std::size_t vertices,
                          std::uint32_t* ordered) {
  findTwins(indices, vertices);
  done_.assign(indices.size() / 3, 0);
  const auto isOpen = [&](std::uint32_t h) { return h != kNone && done_[h / 3] == 0; };
  std::array<std::uint32_t, kRecent> recent;
  recent.fill(kNone);
  std::uint32_t newest = 0, unseen = 0;
  for (std::size_t left = indices.size() / 3; left > 0; --left) {
    // One that leaves few ways on is taken now, or it would stay behind alone.
    std::uint32_t best = kNone, fewest = kRecent;
    for (std::uint32_t k = 1; k <= kRecent && (k <= kSought || best == kNone) && fewest > 0; ++k) {
      const std::uint32_t h = recent[(newest - k) % kRecent];
      if (!isOpen(h)) continue;
      const std::uint32_t second = nextOf(h), third = nextOf(second);
      const std::uint32_t ways = (isOpen(twin_[second]) ? 1u : 0u) + (isOpen(twin_[third]) ? 1u : 0u);
      if (ways < fewest) fewest = ways, best = h;
    }
    if (best == kNone) {
      while (done_[unseen] != 0) ++unseen;
      best = 3 * unseen;
    }
    const std::uint32_t second = nextOf(best), third = nextOf(second);
    done_[best / 3] = 1;
    *ordered++ = indices[best];
    *ordered++ = indices[second];
    *ordered++ = indices[third];
    recent[newest++ % kRecent] = twin_[third];
    recent[newest++ % kRecent] = twin_[second];
  }
}

}  // namespace trimtab::terrain
