#include "trimtab/culling/moving_horizon.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "horizon_geometry.h"
#include "trimtab/culling/box_distance.h"

namespace trimtab {
namespace {

constexpr std::uint8_t kThere = 1, kHidden = 2, kMaySplit = 4, kMayJoin = 8;

/// The eye may be this far beside its predicted path: metres, and shares of the path's length and of its
/// bend.
constexpr double kBesideM = 0.5, kBesideShare = 0.006, kTurnShare = 0.25;
/// The turn is a mean over kTurnFrames frames. A larger one than kMostTurn, metres per frame squared (11 g at
/// 60 frames per second), counts as no turn.
constexpr double kTurnFrames = 8, kMostTurn = 0.03;
/// A longer step in one frame, metres, is a jump and predicts nothing.
constexpr double kJumpM = 60;
/// Frames for which a validity region holds beyond those in which the next horizon is built. More of them
/// would be idle frames, and the others would have to do more.
constexpr double kSpareFrames = 1;
/// Errors are along the earth's verticals, which lean from the frame's z. Where Frame::replacementsStayNear
/// is true they lean so little beside the slopes that a height changes by at most half as much again.
constexpr float kLean = 1.5f;
/// Margin on the LOD rule, because a tile close to its limit may be about to change.
constexpr double kMargin = 0.02;

}  // namespace

void MovingHorizon::clear() {
  for (Build& build : builds_) {
    build.there = false;
    build.mark.clear();
    build.cut.clear();
  }
  moving_ = false;
  hiddenBoxes_ = {};
}

void MovingHorizon::restart() {
  for (Build& build : builds_) build.there = false;
}

/// Returns the region around the eye's predicted path from one frame to another, counted from now.
ValidityRegion MovingHorizon::regionAhead(Vec3 eye, double firstFrame, double lastFrame) const {
  const auto at = [&](double frames) { return eye + frames * step_ + 0.5 * frames * frames * turn_; };
  return {at(firstFrame), at(lastFrame),
          kBesideM + kBesideShare * lastFrame * length(step_) +
              kTurnShare * 0.5 * lastFrame * lastFrame * length(turn_)};
}

/// Returns what the build in use proves of the tiles that it was built for, and keeps what it proves of
/// boxes.
std::span<const std::uint8_t> MovingHorizon::verdictsOfBuild() {
  const Build& build = builds_[active_];
  const std::span<const std::uint8_t> all = build.horizon.hidden();
  hiddenBoxes_ = all.subspan(build.cut.size());
  return all.first(build.cut.size());
}

std::span<const std::uint8_t> MovingHorizon::verdicts(const Frame& frame) {
  const std::span<const std::uint8_t> ofBuild = verdictsOfBuild();
  if (!isCarried_) return ofBuild;
  ++carried_;
  return std::span(verdicts_).first(frame.tiles.size());
}

std::span<const std::uint8_t> MovingHorizon::hidden(const Frame& frame, const SurfaceTree& tree,
                                                    const Fill& fill) {
  if (!horizon::isPlace(frame.eye)) {
    moving_ = false;
    hiddenBoxes_ = {};
    verdicts_.assign(frame.tiles.size(), 0);
    carriedBy_ = nullptr;
    return verdicts_;
  }
  const double share = 1 / std::max(1.0, frame.framesSince);
  const Vec3 step = moving_ ? share * (frame.eye - lastEye_) : Vec3{};
  if (length(step) <= kJumpM) {  // after a jump most eyes go on as before
    const Vec3 turn = turn_ + (1 / kTurnFrames) * (share * (step - step_) - turn_);
    turn_ = length(step - step_) <= kMostTurn && length(turn) <= kMostTurn ? turn : Vec3{};
    step_ = step;
  }
  lastEye_ = frame.eye;
  moving_ = true;

  if (!frame.incremental || !frame.sameHorizon) {
    Build& build = builds_[active_];
    const ValidityRegion region{frame.eye, frame.eye, 0};
    builds_[1 - active_].there = false;
    isCarried_ = false;
    const ValidityRegion& last = build.horizon.region();
    if (frame.sameHorizon && build.there && build.cutNumber == frame.cut && build.rule == frame.rule &&
        build.settings == frame.settings && last.from == region.from && last.to == region.to &&
        last.radius == 0)
      return verdictsOfBuild();
    begin(build, region, frame, tree, fill);
    build.horizon.step(std::numeric_limits<std::size_t>::max() / 2);
    ++fromScratch_;
    return verdictsOfBuild();
  }

  // The newer horizon is used as soon as it is valid.
  Build& coming = builds_[1 - active_];
  if (coming.there && coming.horizon.isDone() && holds(coming, frame, tree)) {
    builds_[active_].there = false;
    active_ = 1 - active_;
  } else if (!holds(builds_[active_], frame, tree)) {
    if (coming.there && !coming.horizon.isDone() && coming.horizon.region().holds(frame.eye))
      coming.horizon.step(std::numeric_limits<std::size_t>::max() / 2);
    else
      coming.there = false;
    if (!coming.there || !holds(coming, frame, tree)) {
      begin(coming, regionAhead(frame.eye, 0, kFrames + kSpareFrames), frame, tree, fill);
      coming.horizon.step(std::numeric_limits<std::size_t>::max() / 2);
      ++fromScratch_;
      isCarried_ = false;
    }
    builds_[active_].there = false;
    active_ = 1 - active_;
  } else {
    prepareNext(frame, tree, fill);
  }
  return verdicts(frame);
}

void MovingHorizon::prepareNext(const Frame& frame, const SurfaceTree& tree, const Fill& fill) {
  const Build& active = builds_[active_];
  Build& coming = builds_[1 - active_];
  if (coming.there && (coming.rule != frame.rule || coming.settings != frame.settings)) coming.there = false;
  if (coming.there) {
    if (coming.horizon.isDone()) {
      // If the eye slowed down, turned or has gone past, it never reaches the region.
      if (!coming.horizon.region().holds(regionAhead(frame.eye, kFrames, kFrames).to)) coming.there = false;
    } else {
      coming.horizon.step(active.horizon.work() * 11 / (10 * kFrames) + 16);
    }
    return;
  }
  const auto extent = [](const ValidityRegion& region) {
    return length(region.to - region.from) + 2 * region.radius;
  };
  const Vec3 then = regionAhead(frame.eye, kFrames + 1, kFrames + 1).to;
  if (!active.horizon.region().holds(then))
    begin(coming, regionAhead(frame.eye, kFrames - 1, 2 * kFrames + kSpareFrames), frame, tree, fill);
  else if (const ValidityRegion here = regionAhead(frame.eye, 0, 2 * kFrames);
           extent(active.horizon.region()) > 8 * extent(here))
    begin(coming, here, frame, tree, fill);  // it has slowed down, and a smaller region proves more
}

void MovingHorizon::begin(Build& build, const ValidityRegion& region, const Frame& frame,
                          const SurfaceTree& tree, const Fill& fill) {
  ++built_;
  if (carriedBy_ == &build) carriedBy_ = nullptr;
  for (const TileDraw& tile : build.cut)
    if (tile.node < build.mark.size()) build.mark[tile.node] = 0;
  build.mark.resize(tree.size(), 0);
  build.tiles.clear();
  fill(build.tiles);
  build.tiles.resize(frame.tiles.size());
  build.tiles.insert(build.tiles.end(), frame.boxes.begin(), frame.boxes.end());
  build.cut.assign(frame.tiles.begin(), frame.tiles.end());
  build.cutNumber = frame.cut;
  build.rule = frame.rule;
  build.settings = frame.settings;
  build.there = true;
  build.marked = false;
  for (const TileDraw& tile : build.cut) build.mark[tile.node] = kThere;
  const bool mayChange =
      frame.incremental && frame.sameHorizon && frame.errorOverDistance > 0 && tree.surfaceErrorM;
  if (mayChange) {
    build.eye = frame.eye;
    build.limit = frame.errorOverDistance;
    build.reach = std::max(length(region.from - frame.eye), length(region.to - frame.eye)) + region.radius;
    markChanges(build, tree);
    widenBounds(build, frame, tree);
  }
  build.horizon.begin(region, build.tiles, frame.settings);
}

/// Returns the largest errors of any variant of a node that the LOD rule may draw while the build is valid:
/// those of the coarsest variant that is good enough, or else of the finest.
MovingHorizon::Errors MovingHorizon::worstErrors(const Build& build, const SurfaceTree& tree,
                                                 std::uint32_t node) {
  Errors worst{tree.finestError(node), tree.surfaceError(node, 0)};
  if (tree.variants == 1) return worst;
  const double away = std::sqrt(distanceSquared(tree.bounds[node], build.eye)) + build.reach;
  for (std::size_t v = 1; v < tree.variants; ++v)
    if (const float error = tree.errorM[node * tree.variants + v];
        error <= worst.atPosts || double{error} <= build.limit * away * (1 + kMargin)) {
      worst.atPosts = std::max(worst.atPosts, error);
      worst.anywhere = std::max(worst.anywhere, tree.surfaceError(node, v));
    }
  return worst;
}

/// Marks the tiles that the LOD rule may split or join before the eye has left the region.
void MovingHorizon::markChanges(Build& build, const SurfaceTree& tree) {
  const double reach = build.reach, limit = build.limit;
  const auto distance = [&](std::uint32_t node) {
    return std::sqrt(distanceSquared(tree.bounds[node], build.eye));
  };
  stack_.clear();
  for (const TileDraw& tile : build.cut) {
    const std::uint32_t node = tile.node, parent = tree.parent[node];
    const double error = double{tree.finestError(node)};
    if (error * (1 + kMargin) > limit * (distance(node) - reach) &&
        std::any_of(tree.childrenOf(node).begin(), tree.childrenOf(node).end(),
                    [](std::uint32_t child) { return child != SurfaceTree::kNone; })) {
      build.mark[node] = static_cast<std::uint8_t>(build.mark[node] | kMaySplit);
      stack_.push_back(node);
    }
    if (parent != SurfaceTree::kNone &&
        double{tree.finestError(parent)} * (1 - kMargin) <= limit * (distance(parent) + reach))
      build.mark[node] = static_cast<std::uint8_t>(build.mark[node] | kMayJoin);
  }
  // A tile that is split needs neighbours of its own level.
  while (!stack_.empty() && !tree.neighbours.empty()) {
    const std::uint32_t node = stack_.back();
    stack_.pop_back();
    for (const std::uint32_t neighbour : tree.neighbours[node]) {
      if (neighbour == SurfaceTree::kNone || build.mark[neighbour] != 0) continue;
      const std::uint32_t coarser = tree.parent[neighbour];
      if (coarser == SurfaceTree::kNone || build.mark[coarser] == 0 || (build.mark[coarser] & kMaySplit) != 0)
        continue;
      build.mark[coarser] = static_cast<std::uint8_t>(build.mark[coarser] | kMaySplit);
      stack_.push_back(coarser);
    }
  }
}

/// Lowers the occluder bound and raises the test bound of every tile that may be replaced, by the error of
/// every LOD that it may switch to.
void MovingHorizon::widenBounds(Build& build, const Frame& frame, const SurfaceTree& tree) {
  const auto changes = [&](std::uint32_t node) {
    return node != SurfaceTree::kNone && (build.mark[node] & (kMaySplit | kMayJoin)) != 0;
  };
  const auto mayOcclude = [&](std::uint32_t node) { return !frame.mayOcclude || frame.mayOcclude(node); };
  const auto worst = [&](std::uint32_t node) { return worstErrors(build, tree, node).anywhere; };
  for (std::size_t i = 0; i < build.cut.size(); ++i) {
    const std::uint32_t node = build.cut[i].node;
    HorizonTile& tile = build.tiles[i];
    if (!tree.neighbours.empty()) {
      if (changes(tree.neighbours[node][1])) tile.east = nullptr;
      if (changes(tree.neighbours[node][3])) tile.north = nullptr;
    }
    // An unmarked patch may still switch to another variant; an unmarked tile may not.
    if (!changes(node) && tree.variants == 1) continue;
    float other = worst(node);
    if ((build.mark[node] & kMaySplit) != 0)
      for (const std::uint32_t child : tree.childrenOf(node))
        if (child != SurfaceTree::kNone) {
          other = std::max(other, worst(child));
          tile.mayOcclude = tile.mayOcclude && mayOcclude(child);
        }
    if ((build.mark[node] & kMayJoin) != 0) {
      const std::uint32_t parent = tree.parent[node], above = tree.parent[parent];
      other = std::max(other, worst(parent));
      if (!tree.neighbours.empty() && above != SurfaceTree::kNone) other = std::max(other, worst(above));
      tile.mayOcclude = tile.mayOcclude && mayOcclude(parent);
    }
    const float margin = kLean * (tree.surfaceError(node, tree.variantOf(build.cut[i])) + other);
    if (!std::isfinite(margin) || (frame.replacementsStayNear && !frame.replacementsStayNear(node))) {
      tile = {};  // hides nothing and is never hidden, so nothing is claimed about its replacement
      continue;
    }
    tile.below = std::max(tile.below, margin);
    tile.above = std::max(tile.above, margin);
  }
}

bool MovingHorizon::holds(Build& build, const Frame& frame, const SurfaceTree& tree) {
  if (!build.there || build.rule != frame.rule || build.settings != frame.settings ||
      !build.horizon.isDone() || !build.horizon.region().holds(frame.eye) || build.mark.size() != tree.size())
    return false;
  if (build.cutNumber == frame.cut && build.cut.size() == frame.tiles.size()) {
    isCarried_ = false;
    return true;
  }
  isCarried_ = true;
  if (carriedBy_ == &build && carriedTo_ == frame.cut) return true;
  carriedBy_ = nullptr;
  if (!carry(build, frame, tree)) return false;
  carriedBy_ = &build;
  carriedTo_ = frame.cut;
  return true;
}

/// Fills verdicts_ for another cut. Returns false if the cut has changed in a way that was not foreseen.
bool MovingHorizon::carry(Build& build, const Frame& frame, const SurfaceTree& tree) {
  if (!(frame.errorOverDistance > 0) || tree.surfaceErrorM == nullptr) return false;
  for (std::size_t i = 0; i < build.cut.size() && !build.marked; ++i)
    if (build.horizon.hidden()[i] != 0) {
      std::uint8_t& mark = build.mark[build.cut[i].node];
      mark = static_cast<std::uint8_t>(mark | kHidden);
    }
  build.marked = true;
  verdicts_.resize(std::max(verdicts_.size(), frame.tiles.size()));
  for (std::size_t i = 0; i < frame.tiles.size(); ++i) {
    const std::uint32_t node = frame.tiles[i].node, parent = tree.parent[node];
    const std::uint8_t mark = build.mark[node];
    if (tree.errorOf(frame.tiles[i]) > worstErrors(build, tree, node).atPosts) return false;
    if (mark != 0) {
      verdicts_[i] = (mark & kHidden) != 0;
      continue;
    }
    if (parent != SurfaceTree::kNone && (build.mark[parent] & kMaySplit) != 0) {
      verdicts_[i] = (build.mark[parent] & kHidden) != 0;
      continue;
    }
    std::uint8_t all = kHidden | kMayJoin;
    bool any = false;
    for (const std::uint32_t child : tree.childrenOf(node))
      if (child != SurfaceTree::kNone) {
        all = static_cast<std::uint8_t>(all & build.mark[child]);
        any = true;
      }
    if (!any || (all & kMayJoin) == 0) return false;
    verdicts_[i] = (all & kHidden) != 0;
  }
  return true;
}

}  // namespace trimtab
