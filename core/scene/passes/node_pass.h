#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// Where the node pass draws: one number a pixel (R32UI) with a reversed 32-bit float depth of its own, so
/// that the picture and its depths stay as they are. The context is current for all of its life; memory is
/// taken at the first pass.
class NodeTarget {
 public:
  NodeTarget() = default;
  ~NodeTarget();
  NodeTarget(const NodeTarget&) = delete;
  NodeTarget& operator=(const NodeTarget&) = delete;

  /// Binds it at that size, all pixels kNone; the depth is for the camera to clear.
  void begin(int width, int height);
  unsigned id() const { return id_; }
  /// Row 0 at the bottom. Leaves it bound for reading.
  std::vector<std::uint32_t> read() const;

  static constexpr std::uint32_t kNone = 0xffffffffu;

 private:
  void release();
  unsigned id_ = 0, nodes_ = 0, depth_ = 0;
  int width_ = 0, height_ = 0;
};

/// Of `tiles` those that reach into a view, by spheres one and a half times as large as their boxes need:
/// what is left out is far from owning a pixel, and the culling that is measured has no part in it.
void nearView(std::span<const TileDraw> tiles, std::span<const Box> bounds, const EyePose& eye,
              const ViewShape& view, std::vector<TileDraw>& near);

}  // namespace trimtab::scene
