#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loops of image_error.h, compiled once for each set of vector instructions.
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

/// Planes of a row of pixels: the reference's three channels, then how far the test picture's lie from them.
inline constexpr int kFlipPlanes = 6;
/// Planes after the vertical pass: reference and difference of luminance, red-green, blue-yellow twice, and
/// of gauss, edge and point.
inline constexpr int kFlipFilteredPlanes = 14;
/// By channel, byte, and then luminance, red-green, blue-yellow (the fourth is 0).
using FlipTable = float[3][256][4];

struct SsimFilter {
  float weights[6] = {};  ///< from the middle outwards
};
/// Planes after SSIM's horizontal pass: sum and difference of the two pictures, and the squares of both.
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
  /// Columns [from, to) of `filtered[p * pitch]` from planes of rows; `rows` points at the middle one.
  void (*flipVertical)(const float* const* rows, std::size_t pitch, int from, int to,
                       const FlipFilters& filters, float* filtered);
  /// Errors of pixels [from, to), whose filtered columns are `shift` further; returns their sum.
  double (*flipError)(const float* filtered, std::size_t pitch, int from, int to, int shift,
                      const FlipFilters& filters, float* error);
};
/// What the kernels may read and write beyond the last column, floats.
inline constexpr int kSimdSlack = 32;

enum class SimdPath { portable, avx2, avx512 };

/// The kernels of a path; nullptr where this processor cannot run it.
const ImageKernels* imageKernels(SimdPath path);
/// The widest that this processor has, or what `useSimdPath` said.
const ImageKernels& imageKernels();
/// For tests: all calls from now on take this path. False, and nothing changes, where it cannot run.
bool useSimdPath(SimdPath path);

namespace portable {
extern const ImageKernels kernels;
}
namespace avx2 {
extern const ImageKernels kernels;
}
namespace avx512 {
extern const ImageKernels kernels;
}

}  // namespace trimtab
