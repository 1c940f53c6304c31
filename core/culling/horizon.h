#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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
/// ended before.
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
struct HorizonTile {
  const TileRelief* relief = nullptr;  ///< a regular tile; without it and `mesh` never hidden, hides nothing
  bool mayOcclude = false;
  /// Neighbours whose lines go on where this tile's end, or null: drawn at the same level, and may occlude. A
  /// column that a border lies in is not lost then.
  const TileRelief *east = nullptr, *north = nullptr;
  const MeshRelief* mesh = nullptr;  ///< instead of `relief`: any triangles

  const Relief* surface() const { return relief ? static_cast<const Relief*>(relief) : mesh; }
};

class Horizon {
 public:
  static constexpr int kSides = 4;
  static constexpr int kLeastColumns = 16, kMostColumns = 8192;  ///< a quarter

  struct Settings {
    int columns = 1024;   ///< of each quarter of the circle; clamped
    double slack = 1e-5;  ///< radians
    bool raised =
        false;  ///< wrong: lines reach as high as the highest of a column. For tests that see it fail
  };

  /// Tests all tiles against what is nearer. An eye that is not a number hides nothing.
  void build(Vec3 eye, std::span<const HorizonTile> tiles, const Settings& settings);

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
  struct Line {
    std::uint32_t tile, line, next;
  };

  void takeUp(const Relief& relief);
  bool isHidden(const TileRelief& relief) const;
  bool isHidden(const MeshRelief& relief) const;
  bool showsPeak(const TileRelief& relief) const;
  bool isBoxHidden(const Box& box) const;
  bool isPartHidden(const TileRelief& relief, int part) const;
  bool isPartHidden(const MeshRelief& relief, const MeshRelief::Part& part) const;
  bool covers(int side, float t0, float t1, float w) const;
  int cornersOf(const HorizonTile& tile, std::uint32_t line);
  void take(const Relief& relief, const float* x, const float* y, const float* z, int count, int to);
  void enqueueLines(std::uint32_t tile, const HorizonTile& from);
  void addLine(const HorizonTile& tile, std::uint32_t line);
  template <bool Raised>
  void addRun(float* horizon, const float* u, const float* w, int count, int step) const;

  Vec3 eye_;
  int columns_ = 0;
  float perT_ = 0;  ///< columns a unit of t
  float slack_ = 0;
  bool raised_ = false;
  static constexpr int kMostPosts = 65,
                       kGoOn = 2;  ///< of a tile's side; how far a line goes into the next tile
  /// Corners of a line; of a longer one what comes first.
  static constexpr int kMostCorners = 192;
  static_assert(kMostCorners >= kMostPosts + kGoOn);
  /// The line in hand, from the eye.
  std::array<float, kMostCorners> x_, y_, z_;
  // Of the tile in hand: its origin from the eye, and the least distance at which it counts.
  std::array<float, 3> offset_{};
  float nearest_ = 0;
  std::vector<float> profile_;  ///< kSides * columns_
  std::vector<std::uint8_t> hidden_;
  std::size_t hiddenCount_ = 0;
  // Tiles by how near their nearest point is, lines by how far their furthest.
  std::vector<std::uint32_t> ring_, firstOfRing_, order_, firstLine_;
  std::vector<Line> lines_;
};

}  // namespace trimtab
