#include "flip_filters.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace trimtab {
namespace {

constexpr double kPi = std::numbers::pi;
// The reference's constants: linear sRGB to XYZ, and one over the white point.
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double kInverseWhite[3] = {1.052156925, 1.0, 0.918357670};

/// a sqrt(pi / b) exp(-pi^2 x^2 / b), without the factor.
double falloff(double degrees, double b) {
  return std::exp(-kPi * kPi * degrees * degrees / b);
}

double sumOfBothSides(const std::vector<double>& half) {
  double sum = half[0];
  for (std::size_t k = 1; k < half.size(); ++k) sum += 2 * half[k];
  return sum;
}

/// Returns the half filter that sums up to 1, without the outer weights that together are below 1e-10: where
/// an error comes from them alone it is below 3e-6.
std::vector<double> normalised(std::vector<double> half) {
  const double sum = sumOfBothSides(half);
  for (double& weight : half) weight /= sum;
  double dropped = 0;
  while (half.size() > 2 && dropped + 2 * half.back() < 1e-10) {
    dropped += 2 * half.back();
    half.pop_back();
  }
  return half;
}

double linear(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

struct Lab {
  double l, a, b;
};
/// Hunt-adjusted CIE Lab of one of the primaries.
Lab primary(int channel) {
  double f[3];
  for (int i = 0; i < 3; ++i) {
    const double share = kToXyz[i][channel] * kInverseWhite[i];
    f[i] = share > std::pow(6.0 / 29, 3) ? std::cbrt(share) : share * (29.0 * 29 / 108) + 4.0 / 29;
  }
  const double l = 116 * f[1] - 16;
  return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

}  // namespace

HalfFilter FlipFilterBank::keep(const std::vector<double>& half, double sum) {
  weights_.emplace_back(half.begin(), half.end());
  return {static_cast<int>(half.size()) - 1, weights_.back().data(), static_cast<float>(sum)};
}

FlipFilterBank::FlipFilterBank(double pixelsPerDegree) {
  weights_.reserve(8);
  // Contrast sensitivity (Andersson et al. 2020, Table 1): luminance and red-green are one Gaussian each,
  // blue-yellow is a sum of two. A sum's parts are separable, each with the square root of its height.
  constexpr double kLuminanceB = 0.0047, kRedGreenB = 0.0053;
  constexpr double kBlueYellowA[2] = {34.1, 13.5}, kBlueYellowB[2] = {0.04, 0.025};
  const int spatial =
      static_cast<int>(std::ceil(3 * std::sqrt(kBlueYellowB[0] / (2 * kPi * kPi)) * pixelsPerDegree));
  const auto taps = static_cast<std::size_t>(spatial) + 1;
  std::vector<double> luminance(taps), redGreen(taps), parts[2] = {luminance, luminance};
  for (std::size_t k = 0; k < taps; ++k) {
    const double degrees = static_cast<double>(k) / pixelsPerDegree;
    luminance[k] = falloff(degrees, kLuminanceB);
    redGreen[k] = falloff(degrees, kRedGreenB);
    for (int i = 0; i < 2; ++i)
      parts[i][k] =
          std::sqrt(kBlueYellowA[i] * std::sqrt(kPi / kBlueYellowB[i])) * falloff(degrees, kBlueYellowB[i]);
  }
  luminance = normalised(luminance);
  redGreen = normalised(redGreen);
  const double scale = 1 / std::hypot(sumOfBothSides(parts[0]), sumOfBothSides(parts[1]));
  for (auto& part : parts)
    for (double& weight : part) weight *= scale;

  // Features: a Gaussian of half the feature's width and its first two derivatives, the positive and the
  // negative weights of which sum up to 1 each.
  constexpr double kFeatureDegrees = 0.082;
  const double deviation = 0.5 * kFeatureDegrees * pixelsPerDegree;
  const auto feature = static_cast<std::size_t>(std::ceil(3 * deviation)) + 1;
  std::vector<double> gauss(std::max(feature, luminance.size())), edge = gauss, point = gauss;
  double gaussSum = 0, edgeSum = 0, positive = 0, negative = 0;
  for (std::size_t k = 0; k < feature; ++k) {
    const double x = static_cast<double>(k), sides = k == 0 ? 1 : 2;
    gauss[k] = std::exp(-x * x / (2 * deviation * deviation));
    edge[k] = x * gauss[k];
    point[k] = (x * x / (deviation * deviation) - 1) * gauss[k];
    gaussSum += sides * gauss[k];
    edgeSum += edge[k];
    (point[k] > 0 ? positive : negative) += sides * std::abs(point[k]);
  }
  for (std::size_t k = 0; k < feature; ++k) {
    gauss[k] /= gaussSum;
    edge[k] /= edgeSum;
    point[k] /= point[k] > 0 ? positive : negative;
  }
  radius_ = std::max(spatial, static_cast<int>(gauss.size()) - 1);

  const Lab green = primary(1), blue = primary(2);
  const double maximum =
      std::pow(std::abs(green.l - blue.l) + std::hypot(green.a - blue.a, green.b - blue.b), 0.7);
  const double knee = 0.4 * maximum;
  filters_ = {.luminance = keep(luminance, 1),
              .redGreen = keep(redGreen, 1),
              .blueYellow1 = keep(parts[0], sumOfBothSides(parts[0])),
              .blueYellow2 = keep(parts[1], sumOfBothSides(parts[1])),
              .gauss = keep(gauss, 1),
              .edge = keep(edge, 0),
              .point = keep(point, 0),
              .colourScale = static_cast<float>(std::log2(0.95 / knee)),
              .colourKnee = static_cast<float>(knee),
              .colourMaximum = static_cast<float>(maximum)};
}

const FlipTable& flipTable() {
  struct Table {
    alignas(16) FlipTable values{};
  };
  static const auto table = [] {
    auto made = std::make_unique<Table>();
    for (std::size_t channel = 0; channel < 3; ++channel) {
      double share[3];
      for (int i = 0; i < 3; ++i) share[i] = kToXyz[i][channel] * kInverseWhite[i];
      for (std::size_t byte = 0; byte < 256; ++byte) {
        const double amount = linear(static_cast<double>(byte) / 255);
        float* to = made->values[channel][byte];
        to[0] = static_cast<float>(amount * share[1]);
        to[1] = static_cast<float>(amount * (share[0] - share[1]));
        to[2] = static_cast<float>(amount * (share[1] - share[2]));
      }
    }
    return made;
  }();
  return table->values;
}

}  // namespace trimtab
