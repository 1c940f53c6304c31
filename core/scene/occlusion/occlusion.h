#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/terrain/tiles/tile_cache.h"

/// What the depth map hides, and why a tile that is left out cannot have owned a pixel.
///
/// S is the terrain as drawn this frame: continuous over the terrain's footprint (no cracks), one height over
/// each place, slope at most L near a place. The eye E is above S, further than the near plane's corners. A
/// texel of the depth map is sampled at its centre only, so what is drawn into it is not S but a surface that
/// lies below S by at least sqrt(1 + L^2) e z, where z is its own view depth and e the largest distance in a
/// texel from the centre, at depth 1.
///
/// Let the centre's ray meet that lowered surface at P, at depth z, and let r be any ray of the texel. The
/// point Q of r at depth z is at most e z from P: a v upwards and d sideways with v^2 + d^2 <= (e z)^2. S
/// under Q is at most L d lower than under P, so Q is above S by at most v + L d - sqrt(1 + L^2) e z <= 0. E
/// is above S and Q is not: r meets S between them, at depth z or less, and beyond the near plane. So behind
/// the depth that a texel shows, no ray of the texel sees anything.
///
/// A tile is left out when each texel that its boxes touch shows a depth nearer than the box. What r meets
/// first lies in a tile too, and that one is never left out: one of its boxes is at r's texel and not behind
/// its depth. So a pixel loses only fragments that it did not show. Margins for float and sub-pixel rounding
/// are added to e, boxes and depths.
namespace trimtab::scene {

class OcclusionPass {
 public:
  OcclusionPass();
  ~OcclusionPass();
  OcclusionPass(const OcclusionPass&) = delete;
  OcclusionPass& operator=(const OcclusionPass&) = delete;

  static constexpr int kTilesPerRow = 64;
  static constexpr int kLevels = 5;  ///< halvings that the pyramid has

  /// Sizes the depth map and lists the tiles (by slot) to be tested.
  void prepare(int width, int height, std::span<const std::uint32_t> slots);

  /// Binds and clears the depth map; the occluders are drawn next.
  void beginDepth();
  /// Builds the pyramid; `program` is in use.
  void reduce(unsigned program);
  /// Tests and reads back, waiting for it: one flag a tile in the order of `prepare`. 0 drawn, 1 hidden, 2
  /// outside the view.
  void test(const TileCache& tiles, std::vector<std::uint8_t>& flags);
  /// Depths of the last map (near / distance), row 0 at the bottom. Leaves its framebuffer bound for reading.
  void read(std::vector<float>& depths) const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  void resizeMap(int width, int height);
  void resizeResult(int rows);

  int width_ = 0, height_ = 0, storedWidth_ = 0, storedHeight_ = 0, resultRows_ = 0, count_ = 0;
  unsigned depth_ = 0, pyramid_ = 0, frame_ = 0, reduceFrame_ = 0;
  unsigned result_ = 0, resultFrame_ = 0;
  unsigned testedBuffer_ = 0, testedTexture_ = 0, emptyArray_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace trimtab::scene
