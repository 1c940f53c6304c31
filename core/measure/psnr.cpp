#include <cmath>
#include <limits>

#include "image_kernels.h"
#include "picture_span.h"
#include "trimtab/measure/image_error.h"

namespace trimtab {

double psnrDb(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int width, int height) {
  if (!holdsPicture(a, width, height, 4) || !holdsPicture(b, width, height, 4))
    return std::numeric_limits<double>::quiet_NaN();
  const std::uint64_t error = imageKernels().squaredError(a.data(), b.data(), a.size() / 4);
  const double mean = static_cast<double>(error) / (3.0 * static_cast<double>(a.size() / 4));
  return 10 * std::log10(255.0 * 255.0 / mean);
}

}  // namespace trimtab
