#pragma once

#include <cstdint>
#include <span>

/// How far two pictures are apart: PSNR, SSIM and FLIP from their published definitions. One thread; vector
/// instructions by what the processor has, with the same results to the errors stated.
///
/// Pictures are rows of RGBA8, alpha ignored, without gaps between rows, both of one size. Where the sizes of
/// the spans do not say width x height x 4 (or either is 0), the result is NaN.
namespace trimtab {

/// 10 log10(255^2 / mean squared error) over red, green and blue, dB; infinity for equal pictures. Exact: the
/// sum is of integers.
double psnrDb(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height);

/// Mean structural similarity (Wang et al. 2004: Gaussian window of 11 x 11, sigma 1.5, K 0.01 and 0.03) of
/// one channel of bytes, over the windows that lie inside the picture; NaN where none does. 1 for equal
/// pictures; within 1e-6 of the definition in exact arithmetic, within 2e-5 where windows are flat to a level
/// and a hundred levels apart.
double ssim(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height);
/// Of the luma (ITU-R BT.601, rounded to bytes) of two RGBA pictures.
double ssimOfLuma(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height);

/// Pixels a degree that FLIP takes by default: 0.7 m before a monitor of 3840 pixels and 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 67.0206432765;

/// FLIP (Andersson et al. 2020), the low-dynamic-range form: the error a person sees who flips between
/// `reference` and `test`; mean over all pixels, 0..1. `map`, unless empty, gets each pixel's error and has
/// width x height entries; of any other size, or where no filter can be made for that many pixels a degree
/// (below 1, above 4,000, NaN), the result is NaN. Exactly 0 where the pictures are equal as far as the
/// filters reach (10 pixels by default), at the cost of a comparison. Within 1e-5 of the definition in exact
/// arithmetic, but where two features are equally strong by symmetry: the square root of the rounding of
/// their difference is 1e-4 there.
double flip(std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test, int width,
            int height, std::span<float> map = {}, double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace trimtab
