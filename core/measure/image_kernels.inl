// The inner loops of image_error.h for one SimdLevel.

#include "flip_lanes.inl"
#include "flip_kernels.inl"
#include "psnr_kernels.inl"
#include "ssim_kernels.inl"

constexpr ImageKernels kernels{
    .squaredError = squaredError,
    .luma = lumaOf,
    .ssimRow = ssimRow,
    .ssimSum = ssimSum,
    .flipConvert = flipConvert,
    .flipHorizontal = flipHorizontal,
    .flipError = flipError,
};
