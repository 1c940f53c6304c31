#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/culling/box_arrays.h"
#include "trimtab/culling/mesh_relief.h"
#include "trimtab/culling/relief.h"

namespace trimtab {

namespace horizon {
struct Kernels;
}

/// A tile (or patch) of the drawn surface, as the horizon tests it.
struct HorizonTile {
  /// A regular grid of posts. A tile with neither this nor another surface hides nothing and is never hidden.
  const TileRelief* relief = nullptr;
  bool mayOcclude = false;
  /// Neighbours whose lines continue this tile's lines, or null. They must be drawn at the same level and may
  /// occlude. With them the column of directions that contains the common border is not lost.
  const TileRelief *east = nullptr, *north = nullptr;
  const MeshRelief* mesh = nullptr;  ///< instead of `relief`: any triangles
  /// Instead of both: what lies in a box that hides nothing, such as objects that stand on the ground.
  const Relief* box = nullptr;
  /// Metres by which the surface may be drawn lower and higher than given while the horizon is in use.
  float below = 0, above = 0;

  const Relief* surface() const {
    if (relief) return relief;
    return mesh ? static_cast<const Relief*>(mesh) : box;
  }
};

/// The validity region of a horizon: all eye positions within `radius` of a segment, metres, local frame.
struct ValidityRegion {
  Vec3 from, to;
  double radius = 0;

  bool holds(Vec3 eye) const;
};

/// Finds what the ground around an eye hides, in every direction at once, so that it stays valid while the
/// head turns.
///
/// A tile is hidden if each of its parts is below the horizon: the highest line of ground that is wholly
/// nearer, in every direction of the plan that the part spans. resources/docs/occlusion.md, The horizon, has
/// the proof and the margins. It holds for the surface S as drawn in this frame, if S has one height over
/// each place (along the local frame's z) and no cracks, and if the eye is above it.
///
/// Directions are split into four quarters: +x, +y, -x, -y. In a quarter a direction is (1, t, w): t sideways
/// and w upwards per metre forwards. Each quarter has `columns` equal steps of t in -1..1, and the profile
/// holds the w of the horizon in each.
///
/// A horizon may hold for a whole validity region (ValidityRegion) instead of one eye. Then lines are lowered
/// and tiles are tested wider by as much as any eye of the region sees them shifted.
///
/// The traps: a tile beyond the data's border, or so steep that a place has two heights, must not occlude
/// (HorizonTile::mayOcclude). Vertices are drawn with rounding, so Settings::slack must be at least the angle
/// by which the rasteriser may move them.
class Horizon {
 public:
  static constexpr int kSides = 4;
  static constexpr int kLeastColumns = 16, kMostColumns = 8192;  ///< per quarter

  struct Settings {
    int columns = 1024;   ///< per quarter; clamped to the limits above
    double slack = 1e-5;  ///< angle by which drawing may shift a vertex, radians
    /// Deliberate errors, for tests that see the proof fail: `raised` gives each column its highest point,
    /// `still` treats the validity region as its middle.
    bool raised = false, still = false;
    bool whole = false;      ///< compute the complete profile, not only what the tiles' tests needed
    bool noWaiting = false;  ///< read all lines before a tile needs them; for tests that compare
    SimdLevel simd = SimdLevel::avx512;  ///< the highest level to use; results are equal at all levels

    friend bool operator==(const Settings&, const Settings&) = default;
  };

  /// Tests every tile against the ground nearer than it, for all eyes of the validity region. Nothing is
  /// hidden if the region holds anything that is not a number or is larger than kMostRegionM.
  void buildFor(const ValidityRegion& region, std::span<const HorizonTile> tiles, const Settings& settings);
  void build(Vec3 eye, std::span<const HorizonTile> tiles, const Settings& settings) {
    buildFor({eye, eye, 0}, tiles, settings);
  }
  static constexpr double kMostRegionM = 1000;

  /// Starts the same work to be done in steps. `tiles` and what they point to must not change until isDone().
  /// Until then hidden() may report fewer hidden tiles than in the end, never more.
  void begin(const ValidityRegion& region, std::span<const HorizonTile> tiles, const Settings& settings);
  /// Does some more work, in units of roughly one tile, and returns true once all is done.
  bool step(std::size_t work);
  bool isDone() const { return progress_.phase == Phase::done; }
  std::size_t work() const { return progress_.work; }  ///< units of work done since begin()

  const ValidityRegion& region() const { return region_; }
  /// Returns one flag per tile of the last build: 1 if it is proven hidden.
  const std::vector<std::uint8_t>& hidden() const { return hidden_; }
  std::size_t hiddenCount() const { return hiddenCount_; }
  /// Returns the w of each column, the quarters +x, +y, -x, -y in turn; a column without ground has the
  /// lowest float. It is as high as the tiles' tests needed, and complete only with Settings::whole.
  std::span<const float> profile() const {
    return std::span(profile_).first(static_cast<std::size_t>(kSides * columns_));
  }
  int columns() const { return columns_; }
  /// Returns the elevation of the profile in a direction of the plan, radians; unset if the profile has no
  /// ground there.
  std::optional<double> elevation(double x, double y) const;
  /// Returns true if the profile proves that a ray in this direction ends at the ground.
  bool blocks(Vec3 direction) const;

 private:
  /// Lines of one tile in one quarter that are not in the profile yet, because no test needed them.
  struct Waiting {
    std::uint32_t tile, ring;  ///< ring: all of the next line is nearer than the rings beyond this one
    int line, count, step;     ///< the next line, how many are left, and the step to the one after
  };
  /// An entry of a bin (a few adjacent columns of the profile): waiting lines that may raise its columns.
  struct Raiser {
    float top, topSoFar;       ///< the highest w they may reach; the highest of this and all entries before
    std::int16_t first, last;  ///< columns that they may raise, also beyond this bin
    std::uint32_t waiting;
  };
  /// A rectangle in plan with a top, metres relative to the eye.
  struct Prism {
    float x0, x1, y0, y1, top;
  };
  static Prism prismOf(const Box& box, const std::array<float, 3>& from) {
    return {box.minX + from[0], box.maxX + from[0], box.minY + from[1], box.maxY + from[1],
            box.maxZ + from[2]};
  }
  /// The summary of a tile by which most tiles are judged without a look at their relief; one cache line.
  struct alignas(64) Outline : Prism {
    std::array<float, 3> peak;
    float nearest, off;  ///< least distance at which it counts; angle by which directions to it may be off
    float beside;        ///< by how much of t it may reach into another quarter, for any eye of the region
    std::uint32_t tile;
    // For a regular tile's lines that run across the line of sight: their highest corner; how far the
    // outermost are from the borders, and how far they continue beyond, both as shares of the tile's size.
    float lineTop, inset, goOn;
    std::uint16_t ring;
    std::int16_t lines;  ///< their number; -1 for a mesh that may occlude
  };
  static_assert(sizeof(Outline) == 64);
  /// A tile's lines; of a regular tile, those that run across the line of sight and their continuation.
  struct Lines {
    const MeshRelief* mesh;  ///< if null, xyz and goOn are used
    const float *xyz, *goOn;
    std::array<float, 3> from, goOnFrom;  ///< their origins relative to the eye
    float besideM, below, nearest;
    int side;
  };
  /// Says how far the eye may be from the middle of the validity region, as one quarter sees it, metres.
  struct Play {
    float along, side, radius;  ///< half the segment forwards and sideways; the radius around it
    float forwards, upwards;    ///< largest offsets

    /// Returns the largest offset beside a line of sight with this t, per unit of its forward component.
    float across(float t) const { return std::abs(side - t * along); }
  };

  void outlineSome();
  void sortTiles();
  Outline outlineOf(std::uint32_t tile) const;
  /// Returns whether rows rather than columns run across the line of sight. The others hide next to nothing
  /// more.
  static bool runsInRows(const Prism& p) { return std::abs(p.y0 + p.y1) >= std::abs(p.x0 + p.x1); }
  Lines linesOf(const HorizonTile& tile, const Outline& outline) const;
  void testNext();
  void test(const Outline& outline);

  bool isHidden(const TileRelief& relief);
  bool isHidden(const MeshRelief& relief);
  bool isPointBlocked(float x, float y, float z);
  bool isPrismHidden(const Prism& prism);
  bool isBoxHidden(const Box& box);
  bool isPartHidden(const TileRelief::Part& part);
  bool isPartHidden(const MeshRelief& relief, const MeshRelief::Part& part);
  bool covers(int side, float t0, float t1, float w);
  /// Returns by how much of t covers() widens a tile at most, from its distance and its height relative to
  /// the eye. The test in the neighbouring quarter must reach as far.
  float besideOf(float off, float z, float away) const;
  /// Returns the column of the quarter that is nearest to t.
  int columnOf(float t) const {
    return std::min(static_cast<int>((std::clamp(t, -1.0f, 1.0f) + 1) * perT_), columns_ - 1);
  }
  /// A position in plan: the column of the profile in its direction, and how far forwards it is.
  struct Place {
    int side, column;
    float forwards;
  };
  std::optional<Place> placeOf(float x, float y) const;
  std::size_t at(int side, int column) const { return static_cast<std::size_t>(side * columns_ + column); }

  void awaitLines(const Outline& outline);
  void await(const Waiting& lines, const Prism& prism, float nearest);
  bool lift(int side, int column, float w);
  void tidy(std::size_t bin);
  void lookAtAll(std::size_t bin);
  bool look(Waiting& lines, int side);
  void raiseLine(int side, float besideM, float nearest);
  void raiseRun(int side, int from, int count, bool rises, float nearestM);
  void take(const Lines& lines, int line);
  std::uint32_t ringOfLine(float besideM) const;
  template <bool Raised>
  int reach(const float* u, const float* w, int count, int step, int beside, int& first);

  ValidityRegion region_;
  Vec3 eye_;  ///< middle of the region
  std::array<Play, kSides> play_{};
  Settings settings_;
  const horizon::Kernels* kernels_ = nullptr;
  int columns_ = 0;
  float perT_ = 0;  ///< columns per unit of t
  float slack_ = 0, leastM_ = 0;
  std::span<const HorizonTile> tiles_;
  /// First the outlines of all tiles, then the test of each, nearest first, and last, with Settings::whole,
  /// the lines that still wait, bin by bin.
  enum class Phase : std::uint8_t { outline, test, finish, done };
  struct Progress {
    Phase phase = Phase::done;
    std::size_t next = 0;  ///< item of the phase
    std::size_t work = 0;
    std::uint32_t ring = 0;  ///< of the tile being tested
  } progress_;

  static constexpr int kMostCorners = MeshRelief::kMostCorners;
  static_assert(kMostCorners >= TileRelief::kMostPosts + TileRelief::kGoOn);
  /// The corners of the current line relative to the eye, and their image in a quarter. Corners after `last_`
  /// are the neighbouring tile's.
  alignas(64) std::array<float, kMostCorners + 16> x_, y_, z_, forward_, u_, w_;
  int last_ = 0, corners_ = 0;
  std::vector<float> reached_;
  // The tile being tested has this origin relative to the eye, and these values from its outline.
  std::array<float, 3> offset_{};
  float nearest_ = 0, off_ = 0, beside_ = 0;
  std::vector<float> profile_;  ///< kSides * columns_, and 16 more that kernels read without effect
  std::vector<std::uint8_t> hidden_;
  std::size_t hiddenCount_ = 0;
  std::vector<std::uint32_t> firstOfRing_, order_;  ///< tiles by the distance of their nearest point
  std::vector<Outline> outlines_;
  std::vector<Waiting> waiting_;
  std::vector<std::vector<Raiser>> bins_;  ///< kSides * binsEach_
  int binsEach_ = 0, binShift_ = 0;        ///< each has 1 << binShift_ columns
  std::vector<float> awaited_;             ///< kSides * columns_: the highest w that waiting lines may reach
};

}  // namespace trimtab
