#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/gl/frame_buffer.h"
#include "trimtab/culling/select.h"

namespace trimtab::scene {

/// The target of the node pass: one number per pixel with a depth of its own, so that the image and its
/// depths stay as they are. The context must be current for all of its life; it takes memory at the first
/// pass.
class NodeTarget {
 public:
  /// Binds it at that size and sets all pixels to kNone. The camera clears the depth.
  void begin(int width, int height);
  /// Sets all pixels of the bound target to kNone and keeps their depths: what was drawn still hides what is
  /// drawn later, but has no number.
  void forget();
  unsigned id() const { return frame_.id(); }
  /// Returns the numbers, row 0 at the bottom. Leaves the target bound for reading.
  std::vector<std::uint32_t> read() const;

  static constexpr std::uint32_t kNone = 0xffffffffu;

 private:
  FrameBuffer frame_{FrameBuffer::Colour::number};
};

/// Fills `near` with those of `tiles` that reach into a view, by spheres one and a half times as large as
/// their boxes need. What is left out is far from owning a pixel, and the culling that is measured has no
/// part in it.
void nearView(std::span<const TileDraw> tiles, std::span<const Box> bounds, const EyePose& eye,
              const ViewShape& view, std::vector<TileDraw>& near);

}  // namespace trimtab::scene
