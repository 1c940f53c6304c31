#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "trimtab/culling/horizon.h"
#include "trimtab/culling/surface_tree.h"

namespace trimtab {

/// The horizon of an eye that moves, at a small part of a full build's cost per frame.
///
/// One horizon is in use; its validity region lies around the predicted path of the eye. Meanwhile the next
/// horizon is built for the region after that, a share of it in each frame. If the eye goes elsewhere, a
/// horizon is built at once, so that every frame has a valid one.
///
/// The LOD cut may change while a horizon is in use. When the build of a horizon begins, every tile that the
/// LOD rule may split or join before the eye has left the validity region is marked, and its occluder bound
/// is lowered and its test bound raised by the error of every LOD that it may switch to. A tile that is drawn
/// in its place later inherits the verdict; a tile that replaces several is hidden if all of them were. A
/// change that was not foreseen ends the horizon. resources/docs/occlusion.md, The moving horizon, has the
/// proof.
///
/// Not thread-safe. hidden() must be called for every frame that uses the horizon, in the order of the
/// frames.
class MovingHorizon {
 public:
  struct Frame {
    Vec3 eye;
    double framesSince = 1;  ///< frames since the last call, at least 1
    std::uint64_t cut = 0;   ///< a new number for each new cut
    std::uint64_t rule = 0;  ///< a new number if the cut differs by more than the eye it was selected for
    std::span<const TileDraw> tiles;  ///< the whole cut
    /// What else may be hidden, and hides nothing: boxes (HorizonTile::box) that do not depend on the cut.
    /// They must be the same in every frame until clear().
    std::span<const HorizonTile> boxes = {};
    /// maxErrorPx * lodScale / pixelsPerRadian, as in selectLevels. If it is 0 (not known), any new cut ends
    /// the horizon.
    double errorOverDistance = 0;
    Horizon::Settings settings;
    bool sameHorizon = true;  ///< if false, a horizon is built in every frame
    bool incremental = true;  ///< if false, a horizon is built at once at every new eye position
    /// Returns whether a node may occlude if it is drawn. If unset, every node may.
    std::function<bool(std::uint32_t node)> mayOcclude = {};
    /// Returns whether every surface that may replace a node of the cut lies within 1.5 times the sum of both
    /// errors of it, above and below. If unset, every node's replacement does.
    std::function<bool(std::uint32_t node)> replacementsStayNear = {};
  };
  /// Appends one HorizonTile for each tile of the frame, in order. What they point to must not change until
  /// the next fill or clear().
  using Fill = std::function<void(std::vector<HorizonTile>&)>;

  /// Returns one flag per tile of the frame, in order: 1 if it is proven hidden. All are 0 if the eye is not
  /// a number. The result is valid until the next call. Call clear() first if the index behind `tree` has
  /// changed.
  std::span<const std::uint8_t> hidden(const Frame& frame, const SurfaceTree& tree, const Fill& fill);
  /// Returns one flag per box of the last frame, in order: 1 if it is proven hidden. Valid until the next
  /// call of hidden().
  std::span<const std::uint8_t> hiddenBoxes() const { return hiddenBoxes_; }
  /// Discards all horizons and the eye's motion.
  void clear();
  /// Discards the horizons because more surfaces are known, so that the next call builds one at once. The
  /// eye's motion is kept.
  void restart();

  /// Returns the horizon in use.
  const Horizon& horizon() const { return builds_[active_].horizon; }
  std::uint64_t built() const { return built_; }              ///< horizons begun since the start
  std::uint64_t fromScratch() const { return fromScratch_; }  ///< of these, built in a single frame
  std::uint64_t carried() const { return carried_; }          ///< frames that used verdicts of another cut

  /// The number of frames in which a horizon is built, after the one that begins it. With a spare frame these
  /// are all frames in which the horizon before it is used, so that all frames cost alike.
  static constexpr int kFrames = 10;

 private:
  struct Build {
    Horizon horizon;
    std::vector<HorizonTile> tiles;
    std::vector<TileDraw> cut;
    std::vector<std::uint8_t> mark;  ///< one per node
    std::uint64_t cutNumber = 0, rule = 0;
    Horizon::Settings settings;
    // For the LOD rule when the build began: the eye, its limit, and how far the eye may go from there.
    Vec3 eye;
    double limit = 0, reach = 0;
    bool there = false, marked = false;  ///< begun and not discarded; `mark` says what is hidden
  };

  void begin(Build& build, const ValidityRegion& region, const Frame& frame, const SurfaceTree& tree,
             const Fill& fill);
  void markChanges(Build& build, const SurfaceTree& tree);
  void widenBounds(Build& build, const Frame& frame, const SurfaceTree& tree);
  struct Errors {
    float atPosts, anywhere;
  };
  static Errors worstErrors(const Build& build, const SurfaceTree& tree, std::uint32_t node);
  /// Returns whether the build is valid for this frame. Fills verdicts_ if its cut is another.
  bool holds(Build& build, const Frame& frame, const SurfaceTree& tree);
  bool carry(Build& build, const Frame& frame, const SurfaceTree& tree);
  ValidityRegion regionAhead(Vec3 eye, double firstFrame, double lastFrame) const;
  void prepareNext(const Frame& frame, const SurfaceTree& tree, const Fill& fill);
  std::span<const std::uint8_t> verdicts(const Frame& frame);
  std::span<const std::uint8_t> verdictsOfBuild();

  std::array<Build, 2> builds_;
  std::size_t active_ = 0;      ///< the build in use
  bool moving_ = false;         ///< lastEye_ is known
  Vec3 lastEye_, step_, turn_;  ///< step_ in metres per frame, turn_ per frame squared
  std::vector<std::uint8_t> verdicts_;
  std::span<const std::uint8_t> hiddenBoxes_;  ///< of the build in use
  bool isCarried_ = false;
  const Build* carriedBy_ = nullptr;  ///< the build that verdicts_ are of, for the cut carriedTo_
  std::uint64_t carriedTo_ = 0;
  std::vector<std::uint32_t> stack_;
  std::uint64_t built_ = 0, fromScratch_ = 0, carried_ = 0;
};

}  // namespace trimtab
