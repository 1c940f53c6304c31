#pragma once

#include <cstddef>
#include <cstdint>

#include "trimtab/units/simd.h"

/// The inner loops of image_error.h, compiled once per SimdLevel.
namespace trimtab {

/// One side of a filter that is symmetric or antisymmetric about its middle: `weights[1..radius]`.
struct HalfFilter {
  int radius = 0;
  const float* weights = nullptr;
  float sum = 0;  ///< of all weights of both sides and the middle
};

/// FLIP's filters. Colour is opponent: luminance, X - Y and Y - Z of the white point's share.
struct FlipFilters {
  HalfFilter luminance, redGreen, blueYellow1, blueYellow2;  ///< contrast sensitivity; the last two add up
  HalfFilter gauss, edge, point;  ///< features; one radius, that of `luminance` or more
  float colourScale = 0;          ///< log2 of p_t / (p_c c_max)
  float colourKnee = 0;           ///< HyAB^q_c where the second slope starts: p_c c_max
  float colourMaximum = 0;        ///< c_max
};

/// Columns that FLIP's filtered planes keep together.
inline constexpr int kFlipBlock = 16;
/// Planes of a row of pixels: the reference's three channels, then how far the test image's lie from them.
inline constexpr int kFlipPlanes = 6;
/// Planes after the horizontal pass, of the reference and then of the difference: luminance, red-green,
/// blue-yellow twice, and gauss, edge and point of luminance.
inline constexpr int kFlipFilteredPlanes = 14;
/// One row of one block.
inline constexpr std::size_t kFlipBlockRow = kFlipFilteredPlanes * kFlipBlock;
/// The indices are the channel, the byte, and one of luminance, red-green, blue-yellow (the fourth is 0).
using FlipTable = float[3][256][4];

struct SsimFilter {
  float weights[6] = {};  ///< from the middle outwards
};
/// Planes after SSIM's horizontal pass: sum and difference of the two images, and the squares of both.
inline constexpr int kSsimPlanes = 4;

struct ImageKernels {
  /// Sum of squared differences over red, green and blue.
  std::uint64_t (*squaredError)(const std::uint8_t* a, const std::uint8_t* b, std::size_t pixels);

  void (*luma)(const std::uint8_t* rgba, std::size_t pixels, std::uint8_t* luma);
  /// Columns 0..columns of `planes[p * pitch]` from columns + 10 bytes.
  void (*ssimRow)(const std::uint8_t* a, const std::uint8_t* b, int columns, const SsimFilter& filter,
                  float* planes, std::size_t pitch);
  /// Sum of the windows' similarity over `columns`, from eleven rows of planes.
  double (*ssimSum)(const float* const* rows, std::size_t pitch, int columns, const SsimFilter& filter);

  void (*flipConvert)(const std::uint8_t* reference, const std::uint8_t* test, int pixels,
                      const FlipTable& table, float* planes, std::size_t pitch);
  /// Filters blocks [0, blocks) of a row whose first pixel is `planes[p * pitch]` into `filtered[block *
  /// blockPitch]`.
  void (*flipHorizontal)(const float* planes, std::size_t pitch, int blocks, const FlipFilters& filters,
                         float* filtered, std::size_t blockPitch);
  /// Errors of `columns` pixels of `rows` rows; returns their sum. Row y of the first block is
  /// `filtered[rowOffset[y]]`, and y may be as far below 0 and beyond `rows` as the filters reach. `error`
  /// may be null.
  double (*flipError)(const float* filtered, std::size_t blockPitch, const std::size_t* rowOffset, int rows,
                      int columns, const FlipFilters& filters, float* error, std::size_t errorPitch);
};
/// The kernels may read and write so many floats beyond the last column.
inline constexpr int kSimdSlack = 32;

/// Returns the kernels of a level; the level must not be above simdLevel().
const ImageKernels& imageKernels(SimdLevel level);
/// Returns the kernels in use: the widest, or those of the level that `useSimdLevel` named.
const ImageKernels& imageKernels();
/// Makes all calls from now on use this level, for tests. Returns false, and changes nothing, if it is above
/// simdLevel().
bool useSimdLevel(SimdLevel level);

}  // namespace trimtab
