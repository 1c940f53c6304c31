#pragma once

// The kernels for the instructions that the including source is compiled for, as TRIMTAB_KERNELS::kernels.

#include "flip_kernel.h"
#include "psnr_kernel.h"
#include "simd_kernels.h"
#include "ssim_kernel.h"

namespace trimtab::TRIMTAB_KERNELS {

constexpr ImageKernels kernels{
    .squaredError = squaredError,
    .luma = lumaOf,
    .ssimRow = ssimRow,
    .ssimSum = ssimSum,
    .flipConvert = flipConvert,
    .flipHorizontal = flipHorizontal,
    .flipError = flipError,
};

}  // namespace trimtab::TRIMTAB_KERNELS
