#pragma once

#include <cstdint>
#include <span>

namespace trimtab {

/// Says how far what two images of one view show lies apart, pixels. It is what geometricError() says where
/// there are no distances, as of an image generator that gives its images alone.
struct ImageShift {
  double p95Px = 0;  ///< of the blocks that moved or stayed; NaN if no block could be told
  double moved = 0;  ///< share of these blocks that moved by a tenth of a pixel or more
  int blocks = 0;    ///< how many could be told
  double told =
      0;  ///< the share of blocks with contrast that these are; where it is small, p95Px is of a remnant
};

/// Compares two images, rows of RGBA8 without gaps, in blocks of 16 x 16 pixels: a block moved to where its
/// green channel fits the other image best, within `windowPx` pixels, and between pixels by a parabola
/// through the squared differences around it. Where several places fit alike, as along an edge, the nearest
/// counts. A block tells nothing if it is flat, or if no place fits much better than its own while its own
/// does not fit either: its colours changed, not its place. Blocks within `windowPx` of the image's edge are
/// left out. An image of 640 x 360 takes some 50 ms on one core. NaN and 0 blocks for spans of another size.
ImageShift imageShift(std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test, int width,
                      int height, int windowPx = 8);

}  // namespace trimtab
