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

/// What the ground around an eye hides, in every direction at once: so a head that turns rebuilds nothing.
///
/// The proof. S is the terrain as drawn this frame: continuous over its footprint, one height (by the frame's
/// z) over each place; the eye E is above it. The frame is an isometry of the earth, so the earth's curvature
/// is in S, and rays are straight. Seen from E, a direction is (1, t, w) by one of four quarters: t sideways
/// and w upwards for each metre forwards. Rays of the same t lie in a vertical half-plane, and "nearer" along
/// any of them is nearer in plan.
///
/// Let P be a point of S at (t, wP), and consider a ray of the same t with w < wP, where all of the way to P
/// in plan is over the footprint. Under P, the ray is below S; at E it was above it; so it meets S before it
/// is under P, and shows nothing that is further in plan than P. Straight edges of S have straight images in
/// (t, w). A line of edges that runs through a whole column [t0, t1] therefore reaches, for every t of the
/// column, at least the least w of its corners and of where it crosses the column's sides. That, the greatest
/// over the lines that are wholly nearer than a place, is the horizon there: rays of the column below it have
/// ended before. Nothing of this asks that a line lies on S: it may lie under it; nor that all lines are
/// looked at: so those that no tile's test asks for wait, and most need never be.
///
/// A tile lies inside the box of its posts, and in finer steps inside those of blocks of its posts. It is
/// hidden when each part of it is below the horizon, by the part's largest w, in each column that the part
/// touches. What the ray of a visible pixel meets first is never left out: a hidden tile's rays have met
/// something strictly nearer. A pixel therefore keeps its fragment.
///
/// Drawn vertices are off by rounding and by the rasteriser's sub-pixels, less than `slack` (radians). If all
/// directions within `slack` of one end at S, then it ends at S as it is drawn, since that is as continuous;
/// parts are tested with twice that all around. Lines of a tile beyond the data's border, or so steep that
/// one place may have two heights, must not be used: HorizonTile::mayOcclude.
///
/// For all eyes of a room. Directions stay those from one place E; let the eye be at e = E + d. The way from
/// e to P passes, where it has gone all but the share k of it, X = P + k (e - P). If X is F forwards of E,
/// its direction from E differs from P's by k (dl - t df) / F sideways and k (dz - w df) / F upwards: P
/// itself does not move, and what is nearer by no more than what is between. So the way to P in plan is led
/// to the far side of a line at a place of the line whose t is within |dl - t df| / (F - |df|) of P's, and is
/// under the line there if P's w is less than the line's there by |dz - w df| / (F - |df|). Lines are lowered
/// by the latter; of the former, all count `kFarM` away and their columns' values are the least within what
/// is left of it, while parts are tested wider by the rest, in every quarter that they then reach.
struct HorizonTile {
  const TileRelief* relief = nullptr;  ///< a regular tile; without it and `mesh` never hidden, hides nothing
  bool mayOcclude = false;
  /// Neighbours whose lines go on where this tile's end, or null: drawn at the same level, and may occlude. A
  /// column that a border lies in is not lost then.
  const TileRelief *east = nullptr, *north = nullptr;
  const MeshRelief* mesh = nullptr;  ///< instead of `relief`: any triangles
  /// How much lower and higher than this the surface may be drawn here while the horizon is in use, metres.
  float below = 0, above = 0;

  const Relief* surface() const { return relief ? static_cast<const Relief*>(relief) : mesh; }
};

/// Places of the eye that one horizon holds for: what is within `radius` of a segment.
struct EyeRoom {
  Vec3 from, to;
  double radius = 0;

  bool holds(Vec3 eye) const;
};

class Horizon {
 public:
  static constexpr int kSides = 4;
  static constexpr int kLeastColumns = 16, kMostColumns = 8192;  ///< a quarter

  struct Settings {
    int columns = 1024;   ///< of each quarter of the circle; clamped
    double slack = 1e-5;  ///< radians
    /// Wrong: lines reach as high as the highest of a column, and a room as far as its middle. For tests that
    /// see it fail.
    bool raised = false, still = false;
    bool whole = false;      ///< the profile is as high as all lines prove, not as high as tiles asked
    bool noWaiting = false;  ///< lines are looked at before a tile asks for them: for tests that compare
    SimdLevel simd = SimdLevel::avx512;  ///< at most; the result is the same

    friend bool operator==(const Settings&, const Settings&) = default;
  };

  /// Tests all tiles against what is nearer, for all eyes of the room. What is not a number, or a room larger
  /// than kMostRoomM, hides nothing.
  void buildFor(const EyeRoom& room, std::span<const HorizonTile> tiles, const Settings& settings);
  void build(Vec3 eye, std::span<const HorizonTile> tiles, const Settings& settings) {
    buildFor({eye, eye, 0}, tiles, settings);
  }
  static constexpr double kMostRoomM = 1000;

  /// The same bit by bit: `tiles` and what they point to stay as they are until it is done. Until then
  /// hidden() may say less than in the end, never more.
  void begin(const EyeRoom& room, std::span<const HorizonTile> tiles, const Settings& settings);
  /// `work`: roughly tiles. Whether it is done.
  bool step(std::size_t work);
  bool isDone() const { return phase_ == Phase::done; }
  std::size_t work() const { return work_; }  ///< since begin()

  const EyeRoom& room() const { return room_; }
  /// One a tile of the last build: 1 is proven hidden.
  const std::vector<std::uint8_t>& hidden() const { return hidden_; }
  std::size_t hiddenCount() const { return hiddenCount_; }
  /// From +x by +y, -x and -y: the w of each column; very low where there is none. All of the horizon where
  /// Settings::whole.
  std::span<const float> profile() const {
    return std::span(profile_).first(static_cast<std::size_t>(kSides * columns_));
  }
  int columns() const { return columns_; }
  /// Elevation in radians in a direction of the plan, as far as the profile proves; none where nothing bounds
  /// the sky.
  std::optional<double> elevation(double x, double y) const;
  /// Whether a ray of this direction ends at the ground, as far as the profile proves.
  bool blocks(Vec3 direction) const;

 private:
  /// Lines that no tile has asked for yet: some of a tile's, in a quarter.
  struct Waiting {
    std::uint32_t tile, ring;  ///< the next is nearer than what is further out, as far as is known
    int line, count, step;     ///< the next, how many are left, and from one to the next
  };
  /// Of a bin, which is a few columns of the profile that follow each other: who waits to raise them.
  struct Raiser {
    float top, topSoFar;       ///< to this at most; the most of all in the bin up to this one
    std::int16_t first, last;  ///< columns, of other bins too
    std::uint32_t waiting;
  };
  /// In plan, and up to the top, metres from the eye.
  struct Prism {
    float x0, x1, y0, y1, top;
  };
  static Prism prismOf(const Box& box, const std::array<float, 3>& from) {
    return {box.minX + from[0], box.maxX + from[0], box.minY + from[1], box.maxY + from[1],
            box.maxZ + from[2]};
  }
  /// What most tiles are judged by, so that they are not looked at themselves: one line of the cache.
  struct alignas(64) Outline : Prism {
    std::array<float, 3> peak;
    float nearest, off;  ///< least distance at which it counts; how far directions to it may be off
    float beside;        ///< by how much of t, for all eyes, it may reach into another quarter
    std::uint32_t tile;
    // Of a regular tile's lines that run across the line of sight: their highest corner; how far the
    // outermost are from the borders, and how far they go on beyond, in shares of its size.
    float lineTop, inset, goOn;
    std::uint16_t ring;
    std::int16_t lines;  ///< how many; of a mesh -1, where it may occlude
  };
  static_assert(sizeof(Outline) == 64);
  /// A tile's lines; of a regular one, those that run across the line of sight, and how they go on.
  struct Lines {
    const MeshRelief* mesh;  ///< or else:
    const float *xyz, *goOn;
    std::array<float, 3> from, goOnFrom;  ///< their origins, from the eye
    float besideM, below, nearest;
    int side;
  };
  /// How far the eye may be from the middle of its room, by a quarter.
  struct Play {
    float along, side, radius;  ///< of the segment, forwards and sideways; around it
    float forwards, upwards;    ///< at most

    /// How far the eye may be beside a way of this t, times its length's share forwards.
    float across(float t) const { return std::abs(side - t * along); }
  };

  void outlineSome();
  void sortTiles();
  Outline outlineOf(std::uint32_t tile) const;
  /// Lines along the line of sight hide next to nothing that the others do not.
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
  /// What covers() widens by at most, of a tile so far away whose surface lies within so much of the eye's
  /// height; nothing that it leaves to another quarter may be left out there.
  float besideOf(float off, float z, float away) const;
  /// The nearest in the quarter.
  int columnOf(float t) const {
    return std::min(static_cast<int>((std::clamp(t, -1.0f, 1.0f) + 1) * perT_), columns_ - 1);
  }
  /// A direction of the plan: its column of the profile, and how far forwards the place is.
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

  EyeRoom room_;
  Vec3 eye_;  ///< its middle
  std::array<Play, kSides> play_{};
  Settings settings_;
  const horizon::Kernels* kernels_ = nullptr;
  int columns_ = 0;
  float perT_ = 0;  ///< columns a unit of t
  float slack_ = 0, leastM_ = 0;
  std::span<const HorizonTile> tiles_;
  /// Outlines of all tiles, the test of each, nearest first, and then what still waits, bin by bin, where
  /// Settings::whole.
  enum class Phase : std::uint8_t { outline, test, finish, done } phase_ = Phase::done;
  std::size_t next_ = 0;  ///< of the phase
  std::size_t work_ = 0;
  std::uint32_t ring_ = 0;  ///< of the tile in hand

  /// Corners of a line.
  static constexpr int kMostCorners = MeshRelief::kMostCorners;
  static_assert(kMostCorners >= TileRelief::kMostPosts + TileRelief::kGoOn);
  /// The line in hand, from the eye, and its image in a quarter; after the corner `last_` its neighbour's.
  alignas(64) std::array<float, kMostCorners + 16> x_, y_, z_, forward_, u_, w_;
  int last_ = 0, corners_ = 0;
  std::vector<float> reached_;
  // Of the tile in hand: its origin from the eye, and what its outline says.
  std::array<float, 3> offset_{};
  float nearest_ = 0, off_ = 0, beside_ = 0;
  std::vector<float> profile_;  ///< kSides * columns_, and 16 that are read but never matter
  std::vector<std::uint8_t> hidden_;
  std::size_t hiddenCount_ = 0;
  std::vector<std::uint32_t> firstOfRing_, order_;  ///< tiles by how near their nearest point is
  std::vector<Outline> outlines_;
  std::vector<Waiting> waiting_;
  std::vector<std::vector<Raiser>> bins_;  ///< kSides * binsEach_
  int binsEach_ = 0, binShift_ = 0;        ///< 1 << binShift_ columns each
  std::vector<float> awaited_;             ///< kSides * columns_: nothing that waits there is higher
};

}  // namespace trimtab
