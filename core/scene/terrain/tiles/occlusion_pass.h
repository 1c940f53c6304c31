#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tile_cache.h"

namespace trimtab::scene {

/// The depth map of the published form: GL draws lowered occluders into it, builds its pyramid, and tests the
/// boxes of tiles against it. resources/docs/occlusion.md, The depth map, has the proof and the margins for
/// rounding. Every call needs the current GL context that the pass was made in.
class OcclusionPass {
 public:
  OcclusionPass();
  ~OcclusionPass();
  OcclusionPass(const OcclusionPass&) = delete;
  OcclusionPass& operator=(const OcclusionPass&) = delete;

  static constexpr int kLevels = 5;  ///< levels of the pyramid, each half the size of the one before

  /// Sets the size of the depth map in texels, and the tiles (by slot) to be tested.
  void prepare(int width, int height, std::span<const std::uint32_t> slots);

  /// Binds and clears the depth map. Draw the occluders next.
  void beginDepth();
  /// Builds the pyramid. `program` must be in use.
  void reduce(unsigned program);
  /// Tests the tiles and waits for the result: one flag per tile in the order of `prepare`, 0 if it must be
  /// drawn, 1 if it is hidden, 2 if it is outside the view.
  void test(const TileCache& tiles, std::vector<std::uint8_t>& flags);
  /// Reads the depths of the last map (near / distance), row 0 at the bottom. Leaves its framebuffer bound
  /// for reading.
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
