#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "map_culling.h"
#include "occlusion.h"
#include "trimtab/culling/depth_map.h"

/// The depth map that the GPU drew (occlusion.h), read back to the CPU and used there.
///
/// At once, as on a software rasteriser: the proof is the one of occlusion.h.
///
/// Later, where waiting would stall: a map of an earlier eye E0 is held against tiles as *that* eye saw them,
/// for the eye E1 of now. The proof. The map was drawn from a surface D that lies below the ground S0 of its
/// frame by sqrt(1 + L^2) (e z + m): by what occlusion.h asks for, and by as much as if e z were larger by m.
/// So around a point P of D at depth z, all points within e z + m are in the ground. Let X be a point of a
/// tile, at a depth of E0 greater than z, in a direction that goes through the texel that shows P, so that
/// the point Q of the segment from E0 to X at depth z is at most e z from P. Q = E0 + t (X - E0), t < 1. The
/// segment from E1 to X has the point Q' = E1 + t (X - E1), and |Q' - Q| = (1 - t) |E1 - E0|. As long as the
/// eye has moved by no more than m, Q' is in the ground, and E1 is above it (OcclusionConditions): from E1,
/// the way to X ends at the ground before it. E1 may look in any direction: only what E0 saw is proven, so a
/// tile that is not wholly in the old view stays.
///
/// "In the ground" must hold for the ground S1 of now, whose levels may be others. D hangs below the tile
/// that it was made of, whichever sides of it are stitched, and slopes bound all levels (OccluderLimits). So
/// it holds where that tile is in the cut of now too. A texel whose P is over a tile that is not is
/// uncovered: vertices are lowered straight down, so P is over the very tile that it belongs to.
namespace trimtab::scene {

/// For tests, which must be able to see a map come late, and the picture break.
struct ForcedReadBack {
  int lag = 0;  ///< maps are used by exactly so many frames late, waiting if need be; 0: as they come
  double motionScale = 1;     ///< of what the proof asks for; less is wrong
  bool keepsChanged = false;  ///< wrong: tiles that are in the cut no more still hide
};

class DepthReadBack {
 public:
  DepthReadBack();
  ~DepthReadBack();
  DepthReadBack(const DepthReadBack&) = delete;
  DepthReadBack& operator=(const DepthReadBack&) = delete;

  /// What the current context lacks for reading later; empty: nothing.
  static const char* lacks();
  /// Maps are used in the frame that draws them, else in a later one.
  void setAtOnce(bool atOnce) { atOnce_ = atOnce; }
  bool atOnce() const { return atOnce_ && forced_.lag == 0; }
  /// Of all from now on.
  static void force(const ForcedReadBack& forced) { forced_ = forced; }
  /// Another terrain: all maps are forgotten.
  void setDatabase(std::shared_ptr<const terrain::Database> database);

  // In this order, every frame in which read-back serves; a frame without forgets nothing.
  /// Later: takes in what has arrived.
  void begin(const EyePose& eye, const LevelCut& cut);
  /// Whether a map may be drawn in this frame, and how far below its eye's motion must be allowed for.
  std::optional<double> motionForMap() const;
  /// One a tile of `visible`, in order, as removeOccluded takes it; empty where there is no map that serves.
  /// At once: after `take`. Later: at any time after `begin`.
  std::span<const std::uint8_t> hidden(std::span<const TileDraw> visible, const EyePose& eye,
                                       const ViewShape& view);
  /// The occluders were drawn into the map of `pass`.
  void take(const OcclusionPass& pass, const EyePose& eye, const ViewShape& view,
            std::span<const TileDraw> occluders);

  /// The map that served last.
  Renderer::Grey picture() const;
  std::uint64_t maps() const { return maps_; }  ///< read back since the start
  /// Frames that the map of the last `hidden` is old; -1: none served.
  int age() const { return age_; }

 private:
  /// A map, from when it is drawn until it is given up.
  struct Map {
    EyePose eye;
    ViewShape view;
    int width = 0, height = 0;
    double motionM = 0;
    std::vector<std::uint32_t> occluders;  ///< nodes that are in the cut yet
    std::uint64_t frame = 0;
  };
  struct Flight {
    Map map;
    unsigned buffer = 0;
    std::size_t capacity = 0;
    void* fence = nullptr;
  };
  double motionM() const;
  bool arrived(const Flight& flight) const;
  void land(Flight& flight);
  void uncoverChanged(const LevelCut& cut);
  bool mayServe(const EyePose& eye, const ViewShape& view) const;

  std::shared_ptr<const terrain::Database> database_;
  TileMeshes meshes_;
  bool atOnce_ = true;
  int age_ = -1;
  inline static ForcedReadBack forced_;
  std::uint64_t frame_ = 0, maps_ = 0;
  std::optional<Vec3> lastEye_;
  double speedM_ = 0;      ///< metres a frame
  int slowestFrames_ = 2;  ///< that a map was old when it was last replaced
  static constexpr std::size_t kFlights = 5;
  std::array<Flight, kFlights> flights_;
  std::optional<Map> map_;  ///< that serves
  std::vector<float> depths_;
  DepthPyramid pyramid_;
  DepthTest test_;
  std::vector<std::uint8_t> inCut_, fates_;
  std::vector<Box> gone_;
};

}  // namespace trimtab::scene
