#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "quad.h"
#include "table.h"
#include "trimtab/measure/geometric_error.h"
#include "trimtab/measure/image_error.h"
#include "trimtab/measure/paired_ratio.h"

namespace trimtab::stress {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kKinds = 9;
/// Black, white, grey, checkers of one pixel, stripes, a ramp, noise, noise of one level, one pixel.
Bytes picture(int kind, std::size_t width, std::size_t height, std::size_t channels, std::mt19937& random) {
  Bytes bytes(width * height * channels);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < channels; ++c) {
        const std::size_t value[kKinds] = {0,
                                           255,
                                           127,
                                           (x + y) % 2 * 255,
                                           x / 3 % 2 * 255,
                                           (x * 255 + y) / (width + 1) % 256,
                                           random() % 256,
                                           127 + random() % 2,
                                           x == width / 2 && y == height / 2 ? 255u : 0u};
        bytes[(y * width + x) * channels + c] = static_cast<std::uint8_t>(value[kind]);
      }
  return bytes;
}

Quad ssimTwin(const Bytes& a, const Bytes& b, std::size_t width, std::size_t height) {
  Quad weight[11], sum = 0;
  for (int k = 0; k < 11; ++k) sum += weight[k] = expq(-Quad((k - 5) * (k - 5)) / (2 * Quad{1.5} * 1.5));
  const Quad c1 = Quad(255 * 255) / 10000, c2 = 9 * c1;
  Quad total = 0;
  for (std::size_t y = 0; y + 11 <= height; ++y)
    for (std::size_t x = 0; x + 11 <= width; ++x) {
      Quad ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
      for (std::size_t j = 0; j < 11; ++j)
        for (std::size_t i = 0; i < 11; ++i) {
          const Quad w = weight[i] * weight[j] / (sum * sum), p = a[(y + j) * width + x + i],
                     q = b[(y + j) * width + x + i];
          ma += w * p, mb += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
        }
      total += (2 * ma * mb + c1) * (2 * (ab - ma * mb) + c2) /
               ((ma * ma + mb * mb + c1) * (aa - ma * ma + bb - mb * mb + c2));
    }
  return total / static_cast<Quad>((width - 10) * (height - 10));
}

TEST(ImageStress, errorsOfExtremePicturesAreThoseOfTheirDefinitions) {
  std::mt19937 random(91);
  Case psnr("images", "PSNR of extreme pictures of any size", 9 * kU + 3 * kU * 130, "dB",
            "the sum is of integers; two roundings of the logarithm's argument, three of at most 130 dB");
  Case similar("images", "SSIM of extreme pictures, down to a single window", 2e-5, "",
               "image_error.h: five roundings of squares of 127 levels (2^-11 each) over 2 C2 = 117");
  Case flips("images",
             "FLIP of extreme pictures: outside 0..1, or not 0 where equal, or a map whose mean is another",
             0, "violations", "a mean of pixels' errors of 0..1; the map rounds to floats");
  const std::pair<int, int> sizes[] = {{1, 1}, {3, 2}, {11, 11}, {12, 17}, {40, 13}, {67, 23}};
  for (const auto& [width, height] : sizes)
    for (int i = 0; i < kKinds; ++i)
      for (int k = 0; k < kKinds; ++k) {
        const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
        const auto where = [&] {
          return std::to_string(width) + " x " + std::to_string(height) + ", " + std::to_string(i) +
                 " against " + std::to_string(k);
        };
        const Bytes a = picture(i, w, h, 4, random), b = i == k ? a : picture(k, w, h, 4, random);
        std::uint64_t squares = 0;
        for (std::size_t n = 0; n < a.size(); ++n)
          if (n % 4 != 3) squares += static_cast<std::uint64_t>((a[n] - b[n]) * (a[n] - b[n]));
        const double db = psnrDb(a, b, width, height);
        psnr.see(squares == 0 ? (std::isinf(db) ? 0 : 1)
                              : distance(db, 10 * log10q(Quad(255 * 255) * static_cast<Quad>(3 * w * h) /
                                                         static_cast<Quad>(squares))),
                 where);

        std::vector<float> map(w * h);
        const double flipped = flip(a, b, width, height, map);
        Quad mean = 0;
        bool inside = flipped >= 0 && flipped <= 1;
        for (const float m : map) mean += m, inside &= m >= 0 && m <= 1;
        flips.require(inside && distance(flipped, mean / static_cast<Quad>(map.size())) < 2 * kFloatU &&
                          (squares > 0 || flipped == 0),
                      where);

        if (width < 11 || height < 11) continue;
        const Bytes c = picture(i, w, h, 1, random), d = i == k ? c : picture(k, w, h, 1, random);
        similar.see(distance(ssim(c, d, width, height), ssimTwin(c, d, w, h)), where);
      }
}

ViewShape small() {
  ViewShape v;
  v.widthPx = 48, v.heightPx = 32;
  return v;
}
/// Metres from the eye to a wall across the view.
std::vector<float> wall(const ViewShape& v, double depth) {
  std::vector<float> distances;
  for (int y = 0; y < v.heightPx; ++y)
    for (int x = 0; x < v.widthPx; ++x) {
      const double a = v.left + (v.right - v.left) * (x + 0.5) / v.widthPx,
                   b = v.bottom + (v.top - v.bottom) * (y + 0.5) / v.heightPx;
      distances.push_back(static_cast<float>(depth * std::sqrt(1 + a * a + b * b)));
    }
  return distances;
}

TEST(ImageStress, geometricErrorsHoldAtAnyDistance) {
  std::mt19937_64 random(92);
  std::uniform_real_distribution<double> unit(0, 1);
  const ViewShape v = small();
  const double pixel = std::min((v.right - v.left) / v.widthPx, (v.top - v.bottom) / v.heightPx);
  const int window = 12;
  Case displaced("geometric error", "a wall moved along the view, 1e-3 to 1e7 m", 16 * kFloatU / pixel, "px",
                 "a ratio of two float depths, eight roundings each, over a pixel's tangent");
  Case scaled("geometric error", "the same pictures 2^-20 to 2^16 times as far", 0, "px",
              "only ratios of distances count: powers of two scale floats exactly");
  Case sky("geometric error", "the same with sky in them, up to 1e7 m", window * 1e-5, "px",
           "sky is taken to be at 1e12 m: a line to it is off by 1e-5 of the window");
  Case bounded("geometric error", "distances of anything: results beyond the window, below 0 or no number", 0,
               "violations", "what is no number is sky; the window or the picture's edge is the most");
  for (std::size_t i = 0; i < samples(300); ++i) {
    const double depth = std::pow(10, -3 + 10 * unit(random)), shift = pixel * 6 * unit(random);
    const GeometricError e = geometricError(wall(v, depth), wall(v, depth * (1 + shift)), v, window);
    // The foot of the perpendicular lies within half a pixel of the other wall's lines, either way.
    const double least = shift / pixel, most = std::hypot(least, 0.5 * (1 + shift));
    displaced.see(std::max({0.0, least - e.maxPx, e.maxPx - most}),
                  [&] { return digits(depth) + " m by " + digits(least) + " px"; });

    std::vector<float> a(wall(v, 100)), b;
    for (float& d : a) d *= static_cast<float>(0.5 + unit(random));
    if (i % 3 == 0) a[5] = a[700] = std::numeric_limits<float>::infinity();
    b = a;
    for (std::size_t n = 0; n < b.size(); n += 1 + static_cast<std::size_t>(40 * unit(random)))
      b[n] *= static_cast<float>(1 + 0.1 * unit(random));
    const GeometricError whole = geometricError(a, b, v, window);
    const auto far = [](std::vector<float> distances, float scale) {
      for (float& d : distances) d *= scale;
      return distances;
    };
    for (const int power : {-20, -10, 1, 16}) {
      const float scale = std::ldexp(1.0f, power);
      const GeometricError other = geometricError(far(a, scale), far(b, scale), v, window);
      (i % 3 == 0 ? sky : scaled)
          .see(std::max(std::abs(other.maxPx - whole.maxPx), std::abs(other.meanPx - whole.meanPx)));
    }
    constexpr float kOdd[] = {0, -1, 1e-45f, 1e-38f, 1e-3f, 1e7f, 1e12f, 3e38f, HUGE_VALF, -HUGE_VALF, NAN};
    for (float& d : a)
      if (unit(random) < 0.3) d = kOdd[static_cast<std::size_t>(unit(random) * 10.99)];
    for (const GeometricError& odd :
         {geometricError(a, b, v, window), geometricError(b, a, v, window), geometricError(a, a, v, window)})
      bounded.require(odd.maxPx >= 0 && odd.maxPx <= window && odd.meanPx >= 0 && odd.meanPx <= odd.maxPx,
                      [&] { return digits(odd.maxPx) + ", mean " + digits(odd.meanPx); });
  }
}

TEST(ImageStress, pairedRatiosAreOrderStatistics) {
  std::mt19937_64 random(93);
  std::uniform_real_distribution<double> unit(0, 1);
  Case median("paired ratio", "median of ratios, relative", 6 * kU, "",
              "two quotients, two square roots of half an ulp, a product");
  Case interval("paired ratio", "ends of the interval for 1 to 3,000 pairs", 0, "differences",
                "the binomial distribution, summed exactly");
  const std::size_t most = isLong() ? 30000 : 3000;
  for (std::size_t n = 1; n <= most; n += 1 + n / 20) {
    std::vector<double> a, b;
    std::vector<Quad> ratios;
    while (ratios.size() < n) {
      a.push_back(unit(random) < 0.05 ? std::nan("") : std::pow(10, -3 + 6 * unit(random)));
      b.push_back(unit(random) < 0.05 ? HUGE_VAL : std::pow(10, -3 + 6 * unit(random)));
      if (std::isfinite(a.back()) && std::isfinite(b.back())) ratios.push_back(Quad{b.back()} / a.back());
    }
    std::sort(ratios.begin(), ratios.end());
    const PairedRatio r = pairedRatio(a, b);
    const Quad middle = n % 2 == 1 ? ratios[n / 2] : sqrtq(ratios[n / 2 - 1] * ratios[n / 2]);
    median.see(relative(r.median, middle), [&] { return std::to_string(n); });
    // P(Bin(n, 1/2) <= k - 1) <= 0.025 for the largest k there is.
    std::size_t cut = 0;
    Quad term = powq(Quad{0.5}, static_cast<Quad>(n)), tail = term;
    while (tail <= Quad{1} / 40) {
      ++cut;
      term = term * static_cast<Quad>(n - cut + 1) / static_cast<Quad>(cut);
      tail += term;
    }
    const bool same = cut == 0
                          ? r.low == 0 && std::isinf(r.high)
                          : relative(r.low, ratios[cut - 1]) <= kU && relative(r.high, ratios[n - cut]) <= kU;
    interval.require(same && r.pairs == n,
                     [&] { return std::to_string(n) + " pairs, cut " + std::to_string(cut); });
  }
}

}  // namespace
}  // namespace trimtab::stress
