#include "trimtab/culling/select_patches.h"

#include <algorithm>
#include <cmath>

#include "gather_cut.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/tree_walk.h"

namespace trimtab {
namespace {

constexpr std::uint32_t kNone = PatchIndex::kNone;

/// Says what is known of a diamond that should be split.
enum Lack : std::uint8_t {
  kOwn = 1,    ///< a page of its children is not resident
  kAny = 2,    ///< the same is true of it or of a diamond that it depends on
  kKnown = 4,  ///< kAny has been computed
  kCounted = 8
};

class Selection {
 public:
  Selection(const PatchIndex& index, std::span<const std::uint8_t> resident, Vec3 eye, const CutRule& rule,
            PatchCut& cut)
      : index_(index), resident_(resident), eye_(eye), rule_(rule), limit_(rule.limit()), cut_(cut) {}

  void run() {
    begin();
    forEachRoot(index_, [&](std::uint32_t patch) { cut_.stack.push_back(patch); });
    while (!cut_.stack.empty()) {
      const std::uint32_t patch = cut_.stack.back();
      cut_.stack.pop_back();
      ask(patch);
    }
    forEachRoot(index_, [&](std::uint32_t patch) {
      wantPage(index_.page[patch], std::numeric_limits<float>::infinity());
      gather(patch);
    });
    for (const std::uint32_t diamond : cut_.splitList)
      forEachChildOf(diamond, [&](std::uint32_t child) { wantPage(index_.page[child], cut_.need[diamond]); });
    for (PageWant& want : cut_.wants)
      want.errorPx = static_cast<float>(std::sqrt(want.errorPx) * rule_.pixelsPerRadian);
  }

 private:
  void begin() {
    cut_.cut.tiles.clear();
    cut_.heldBack = 0;
    // The terrain is another one, so the lists of the last call say nothing.
    if (cut_.need.size() != index_.diamonds.size() || cut_.wantOf.size() != index_.pages.size()) {
      cut_.need.assign(index_.diamonds.size(), 0);
      cut_.missing.assign(index_.diamonds.size(), 0);
      cut_.wantOf.assign(index_.pages.size(), 0);
    } else {
      for (const std::uint32_t diamond : cut_.splitList) cut_.need[diamond] = 0, cut_.missing[diamond] = 0;
      for (const PageWant& want : cut_.wants) cut_.wantOf[want.page] = 0;
    }
    cut_.splitList.clear();
    cut_.wants.clear();
    cut_.stack.clear();
  }

  bool tooCoarse(float error, double distance2) const {
    return rule_.isTooCoarse(double{error}, distance2, limit_);
  }

  void ask(std::uint32_t patch) {
    const double distance2 = distanceSquared(index_.bounds[patch], eye_);
    const float error = index_.errorM[patch][0];
    if (isLost(index_.page[patch]))
      return halve(index_.diamond[patch], std::numeric_limits<float>::infinity());
    if (!tooCoarse(error, distance2)) return;
    halve(index_.diamond[patch], std::max(static_cast<float>(double{error} * double{error} / distance2),
                                          std::numeric_limits<float>::min()));
  }

  /// Gives the diamonds that a diamond depends on at least its own need, so that pages are wanted in an order
  /// in which they can be used.
  void halve(std::uint32_t diamond, float need) {
    if (diamond == kNone || cut_.need[diamond] >= need) return;
    if (cut_.need[diamond] == 0) {
      const std::size_t before = cut_.stack.size();
      forEachChildOf(diamond, [&](std::uint32_t child) {
        cut_.stack.push_back(child);
        if (!isResident(index_.page[child]) && !isLost(index_.page[child])) cut_.missing[diamond] = kOwn;
      });
      if (cut_.stack.size() == before) return;
      cut_.splitList.push_back(diamond);
    }
    cut_.need[diamond] = need;
    for (const std::uint32_t parent : index_.diamonds[diamond].parents) halve(parent, need);
  }

  template <class Visit>
  void forEachChildOf(std::uint32_t diamond, const Visit& visit) const {
    for (const std::uint32_t patch : index_.diamonds[diamond].patches)
      if (patch != kNone) forEachChild(index_, patch, visit);
  }

  bool isResident(std::uint32_t page) const { return resident_.empty() || resident_[page] != 0; }
  /// Returns true for a root page that is not resident. Nothing coarser can replace it, so finer pages do.
  bool isLost(std::uint32_t page) const { return index_.pages[page].pair == 0 && !isResident(page); }

  bool isHeldBack(std::uint32_t diamond) {
    std::uint8_t& missing = cut_.missing[diamond];
    if (missing & kKnown) return missing & kAny;
    bool any = missing & kOwn;
    for (const std::uint32_t parent : index_.diamonds[diamond].parents)
      any = any || (parent != kNone && isHeldBack(parent));
    missing = static_cast<std::uint8_t>(missing | kKnown | (any ? kAny : 0));
    return any;
  }

  void wantPage(std::uint32_t page, float need) {
    std::uint32_t& place = cut_.wantOf[page];
    if (place == 0) {
      cut_.wants.push_back({page, need});
      place = static_cast<std::uint32_t>(cut_.wants.size());
    } else {
      float& error = cut_.wants[place - 1].errorPx;
      error = std::max(error, need);
    }
  }

  /// Appends the part of the cut below a root, depth first, so that the order of any two patches is the
  /// index's.
  void gather(std::uint32_t root) {
    cut_.stack.push_back(root);
    takeCut(
        index_, cut_.stack,
        [&](std::uint32_t patch) {
          const std::uint32_t diamond = index_.diamond[patch];
          if (!(cut_.need[diamond] > 0)) return false;
          if (!isHeldBack(diamond)) return true;
          if (!(cut_.missing[diamond] & kCounted)) ++cut_.heldBack;
          cut_.missing[diamond] |= kCounted;
          return false;
        },
        [&](std::uint32_t patch) { cut_.cut.tiles.push_back({.node = patch, .variant = variantOf(patch)}); });
  }

  PatchVariant variantOf(std::uint32_t patch) const {
    const double distance2 = distanceSquared(index_.bounds[patch], eye_);
    const std::span<const float> errors = index_.errorM[patch];
    std::size_t variant = errors.size() - 1;
    while (variant > 0 && tooCoarse(errors[variant], distance2)) --variant;
    return PatchVariant(variant);
  }

  const PatchIndex& index_;
  std::span<const std::uint8_t> resident_;
  Vec3 eye_;
  const CutRule& rule_;
  double limit_;
  PatchCut& cut_;
};

}  // namespace

void selectPatches(const PatchIndex& index, std::span<const std::uint8_t> resident, Vec3 eye,
                   const CutRule& rule, PatchCut& cut) {
  Selection(index, resident, eye, rule, cut).run();
  cut.cut.triangles.clear();
  for (const TileDraw& tile : cut.cut.tiles)
    cut.cut.triangles.push_back(index.triangles[tile.node][tile.variant.number]);
  gatherCut(index.bounds, index.cones, cut.cut);
}

}  // namespace trimtab
