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
/// ended before. Nothing of this asks that a line lies on S: it may lie under it.
///
/// A tile lies inside the boxes of its posts, and in finer steps inside the hulls of blocks of its posts,
/// whose images are the hulls of the posts' images. It is hidden when each part of it is below the horizon,
/// by the part's largest w, in each column that the part touches. What the ray of a visible pixel meets first
/// is never left out: a hidden tile's rays have met something strictly nearer. A pixel therefore keeps its
/// fragment.
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
/// is left of it, while parts are tested wider by the rest.
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
  bool isDone() const { return isSorted_ && next_ == order_.size(); }
  std::size_t work() const { return work_; }  ///< since begin()

  const EyeRoom& room() const { return room_; }
  /// One a tile of the last build: 1 is proven hidden.
  const std::vector<std::uint8_t>& hidden() const { return hidden_; }
  std::size_t hiddenCount() const { return hiddenCount_; }
  /// All of the horizon, from +x by +y, -x and -y: the w of each column; very low where there is none.
  std::span<const float> profile() const { return profile_; }
  int columns() const { return columns_; }
  /// Elevation in radians in a direction of the plan, as far as the whole of the horizon proves; none where
  /// nothing bounds the sky.
  std::optional<double> elevation(double x, double y) const;
  /// Whether a ray of this direction ends at the ground, as far as the whole of the horizon proves.
  bool blocks(Vec3 direction) const;

 private:
  /// A piece of a line in columns of the profile, waiting until all of the line is nearer.
  struct Piece {
    std::uint32_t column, first, next;
    std::int32_t count;
  };
  /// What most tiles are judged by, so that they are not looked at themselves.
  struct Outline {
    float x0, x1, y0, y1, top;  ///< from the eye
    std::array<float, 3> peak;
    float nearest, off;  ///< least distance at which it counts; how far directions to it may be off
    std::uint32_t tile, ring;
  };
  /// Of a regular tile, those of its lines that run across the line of sight, and how they go on.
  struct Lines {
    const float *xyz, *goOn;
    std::array<float, 3> from, goOnFrom;  ///< their origins, from the eye
    float besideM, below;
    int side, count;
  };
  /// How far the eye may be from the middle of its room, by a quarter.
  struct Play {
    float along, side, radius;  ///< of the segment, forwards and sideways; around it
    float forwards, upwards;    ///< at most

    /// How far the eye may be beside a way of this t, times its length's share forwards.
    float across(float t) const { return std::abs(side - t * along); }
  };

  void sortTiles();
  Outline outlineOf(std::uint32_t tile) const;
  Lines linesOf(const HorizonTile& tile, const Outline& outline) const;
  void testNext();
  void prefetchLines() const;

  bool isHidden(const TileRelief& relief);
  bool isHidden(const MeshRelief& relief);
  bool isPointBlocked(float x, float y, float z) const;
  bool isBoxHidden(const Outline& box) const;
  bool isBoxHidden(const Box& box) const;
  bool isPartHidden(const TileRelief& relief, int part) const;
  bool isPartHidden(const MeshRelief& relief, const MeshRelief::Part& part) const;
  bool covers(int side, float t0, float t1, float w) const;

  void enqueueLines(const Lines& lines);
  void enqueueLines(const MeshRelief& mesh, float below);
  void enqueueLine(int last, int count, float besideM);
  void enqueueRun(std::uint32_t ring, int side, int from, int count, bool rises, float nearestM);
  int take(const float* x, const float* y, const float* z, int count, float below);
  std::uint32_t ringOfLine(int last, int count, float besideM) const;
  template <bool Raised>
  int reach(const float* u, const float* w, int count, int step, int beside, int& first);
  void flush(std::uint32_t ring);

  EyeRoom room_;
  Vec3 eye_;  ///< its middle
  std::array<Play, kSides> play_{};
  Settings settings_;
  int columns_ = 0;
  float perT_ = 0;  ///< columns a unit of t
  float slack_ = 0, leastM_ = 0;
  std::span<const HorizonTile> tiles_;
  std::size_t next_ = 0, work_ = 0;
  std::uint32_t done_ = 0;  ///< rings whose lines are in the horizon
  bool isSorted_ = true;    ///< tiles are in their order
  bool lastStood_ = false;  ///< the last tile stood out: so will most likely those after it

  /// Corners of a line; of a longer one what comes first.
  static constexpr int kMostCorners = 192;
  static_assert(kMostCorners >= TileRelief::kMostPosts + TileRelief::kGoOn);
  /// The line in hand, from the eye, and its image in a quarter.
  alignas(64) std::array<float, kMostCorners + 16> x_, y_, z_, forward_, u_, w_;
  std::vector<float> reached_;
  // Of the tile in hand: its origin from the eye, the least distance at which it counts, and how far
  // directions to it may be off.
  std::array<float, 3> offset_{};
  float nearest_ = 0, off_ = 0;
  std::vector<float> profile_;  ///< kSides * columns_
  std::vector<std::uint8_t> hidden_;
  std::size_t hiddenCount_ = 0;
  // Tiles by how near their nearest point is, lines by how far their furthest.
  std::vector<std::uint32_t> firstOfRing_, order_, firstPiece_;
  std::vector<Outline> outlines_;
  std::vector<Lines> lines_;
  std::vector<Piece> pieces_;
  std::vector<float> pool_;  ///< of the pieces' columns
};

}  // namespace trimtab
