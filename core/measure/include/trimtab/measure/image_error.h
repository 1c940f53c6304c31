#pragma once

#include <cstdint>
#include <span>

/// Compares two images by PSNR, SSIM and FLIP, from their published definitions. Each runs on the calling
/// thread with the vector instructions of the processor; the results agree within the errors stated.
///
/// Images are rows of RGBA8 without gaps, alpha ignored, both of one size. If the spans do not have width x
/// height x 4 bytes, or either size is 0, the result is NaN.
namespace trimtab {

/// Returns 10 log10(255^2 / mean squared error) over red, green and blue, dB; infinity for equal images. The
/// sum is one of integers, so it is exact.
double psnrDb(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height);

/// Returns the mean structural similarity (Wang et al. 2004: Gaussian window of 11 x 11, sigma 1.5, K 0.01
/// and 0.03) of one channel of bytes, over the windows that lie inside the image; NaN if there is none. It is
/// 1 for equal images, within 1e-6 of the definition in exact arithmetic, and within 2e-5 for windows that
/// are flat to a level and a hundred levels apart.
double ssim(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height);
/// Returns the same for the luma (ITU-R BT.601, rounded to bytes) of two RGBA images.
double ssimOfLuma(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height);

/// FLIP's default pixels per degree: 0.7 m in front of a monitor that is 3840 pixels and 0.7 m wide.
inline constexpr double kFlipPixelsPerDegree = 67.0206432765;

/// Returns FLIP (Andersson et al. 2020) in its low-dynamic-range form: the error that a person sees who flips
/// between `reference` and `test`, as the mean over all pixels, 0..1. `map`, unless empty, receives each
/// pixel's error and must have width x height entries. The result is NaN for a map of another size, and if no
/// filter can be made for so many pixels per degree (below 1, above 4,000, NaN). A pixel's error is exactly 0
/// if the images are equal as far as the filters reach (10 pixels by default), and then costs only the
/// comparison. It is within 1e-5 of the definition in exact arithmetic, except where two features are equally
/// strong by symmetry: there the square root of the rounding of their difference is 1e-4.
double flip(std::span<const std::uint8_t> reference, std::span<const std::uint8_t> test, int width,
            int height, std::span<float> map = {}, double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace trimtab
