#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "trimtab/culling/horizon.h"
#include "trimtab/culling/surface_tree.h"

namespace trimtab {

/// The horizon of an eye that moves, at a small part of a build's cost a frame. One horizon stands, for a
/// room around the way that the eye is on; meanwhile the next one is built for the room after it, some of it
/// each frame. Where the eye went elsewhere, one is built at once: hidden tiles are proven in every frame.
///
/// Levels change while a horizon stands. When its build begins, each tile that the rule for the levels may
/// take apart, or join, before the eye has left the room is marked, and its surface is given room downwards
/// (as an occluder) and upwards (when tested) for all that may stand there: both are within their stated
/// errors of the same source. A tile that is drawn in its stead later takes over its verdict; several that
/// were joined are hidden if all were. A change that was not foreseen ends the horizon.
class MovingHorizon {
 public:
  struct Frame {
    Vec3 eye;
    double framesSince = 1;  ///< that the eye took from where it was at the last call; at least 1
    std::uint64_t cut = 0;   ///< another one for another cut
    std::uint64_t rule = 0;  ///< another one where not only the eye differs that the cut was made for
    std::span<const TileDraw> tiles;  ///< the whole cut
    /// As in selectLevels: maxErrorPx * lodScale / pixelsPerRadian. Where it is not known, 0, any other cut
    /// ends the horizon.
    double errorOverDistance = 0;
    Horizon::Settings settings;
    bool sameHorizon = true;  ///< false: from scratch in every frame
    bool incremental = true;  ///< false: from scratch at every new place
    /// Of any node, whether it may occlude where it is drawn; not there: all do.
    std::function<bool(std::uint32_t node)> mayOcclude = {};
    /// Of a node of the cut, whether all that may stand in its place is within the sum of both errors, half
    /// as much again for how far verticals lean, above and below it; not there: all are.
    std::function<bool(std::uint32_t node)> takesRoom = {};
  };
  /// Appends one tile for each of the frame's, in order. What they point to must stay as it is until the next
  /// fill, or clear().
  using Fill = std::function<void(std::vector<HorizonTile>&)>;

  /// One a tile of the frame, in order: 1 is proven hidden. All 0 for an eye that is not a number. Holds
  /// until the next call. An index that moved or changed needs clear() first.
  std::span<const std::uint8_t> hidden(const Frame& frame, const SurfaceTree& tree, const Fill& fill);
  /// Forgets all.
  void clear();
  /// The surfaces tell more than before: the next horizon is built at once. The eye's way is still known.
  void restart();

  /// The one that stands.
  const Horizon& horizon() const { return builds_[standing_].horizon; }
  std::uint64_t built() const { return built_; }              ///< horizons begun, since the start
  std::uint64_t fromScratch() const { return fromScratch_; }  ///< of them in a single frame
  std::uint64_t carried() const { return carried_; }          ///< frames with verdicts of another cut

  /// Frames that a horizon is built in, after the one in which it is begun: with the spare one, all in which
  /// the one before it serves, so that all cost alike.
  static constexpr int kFrames = 10;

 private:
  struct Build {
    Horizon horizon;
    std::vector<HorizonTile> tiles;
    std::vector<TileDraw> cut;
    std::vector<std::uint8_t> mark;  ///< one a node
    std::uint64_t cutNumber = 0, rule = 0;
    Horizon::Settings settings;
    // Of the rule for the levels, when the build began: the eye, and how far it may come from there.
    Vec3 eye;
    double limit = 0, reach = 0;
    bool there = false, marked = false;  ///< marked: what is hidden is in `mark`
  };

  void begin(Build& build, const EyeRoom& room, const Frame& frame, const SurfaceTree& tree,
             const Fill& fill);
  void markChanges(Build& build, const SurfaceTree& tree);
  void giveRoom(Build& build, const Frame& frame, const SurfaceTree& tree);
  struct Errors {
    float atPosts, anywhere;
  };
  static Errors worstErrors(const Build& build, const SurfaceTree& tree, std::uint32_t node);
  /// Whether the build holds in this frame; fills in verdicts_ where its cut is another.
  bool holds(Build& build, const Frame& frame, const SurfaceTree& tree);
  bool carry(Build& build, const Frame& frame, const SurfaceTree& tree);
  EyeRoom roomAhead(Vec3 eye, double firstFrame, double lastFrame) const;
  void prepareNext(const Frame& frame, const SurfaceTree& tree, const Fill& fill);
  std::span<const std::uint8_t> verdicts(const Frame& frame);

  std::array<Build, 2> builds_;
  std::size_t standing_ = 0;
  bool moving_ = false;         ///< last eye and step are known
  Vec3 lastEye_, step_, turn_;  ///< metres a frame, and a frame squared
  std::vector<std::uint8_t> verdicts_;
  bool isCarried_ = false;
  const Build* carriedBy_ = nullptr;  ///< whose verdicts_ are, for the cut carriedTo_
  std::uint64_t carriedTo_ = 0;
  std::vector<std::uint32_t> stack_;
  std::uint64_t built_ = 0, fromScratch_ = 0, carried_ = 0;
};

}  // namespace trimtab
