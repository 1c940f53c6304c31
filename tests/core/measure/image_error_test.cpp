#include "trimtab/measure/image_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/measure/image_kernels.h"
#include "image_pairs.h"

namespace trimtab {
namespace {

using test::Picture;
using test::PicturePair;

constexpr SimdLevel kLevels[] = {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512};

/// Runs `check` on every level that this machine has.
template <class Check>
void withEveryPath(const Check& check) {
  const ImageKernels* usual = &imageKernels();
  int ran = 0;
  for (const SimdLevel level : kLevels)
    if (useSimdLevel(level)) {
      SCOPED_TRACE("path " + std::to_string(static_cast<int>(level)));
      check();
      ++ran;
    }
  EXPECT_GE(ran, 1);
  for (const SimdLevel level : kLevels)
    if (level <= simdLevel() && &imageKernels(level) == usual) useSimdLevel(level);
}

double psnr(const PicturePair& p) {
  return psnrDb(p.reference.rgba, p.test.rgba, p.reference.width, p.reference.height);
}

std::vector<std::uint8_t> lumaOf(const Picture& p) {
  std::vector<std::uint8_t> luma;
  for (std::size_t i = 0; i < p.rgba.size(); i += 4)
    luma.push_back(static_cast<std::uint8_t>(
        (299 * p.rgba[i] + 587 * p.rgba[i + 1] + 114 * p.rgba[i + 2] + 500) / 1000));
  return luma;
}

/// Wang et al. 2004, Eqs. 13 to 17, window by window.
double ssimByTheBook(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, int width,
                     int height) {
  double weight[11][11], sum = 0;
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 11; ++x)
      sum += weight[y][x] = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / (2 * 1.5 * 1.5));
  const double c1 = std::pow(0.01 * 255, 2), c2 = std::pow(0.03 * 255, 2);
  double total = 0;
  for (int top = 0; top + 11 <= height; ++top)
    for (int left = 0; left + 11 <= width; ++left) {
      const auto over = [&](const auto& term) {
        double mean = 0;
        for (int y = 0; y < 11; ++y)
          for (int x = 0; x < 11; ++x) {
            const auto at = static_cast<std::size_t>((top + y) * width + left + x);
            mean += weight[y][x] / sum * term(static_cast<double>(a[at]), static_cast<double>(b[at]));
          }
        return mean;
      };
      const double ma = over([](double x, double) { return x; });
      const double mb = over([](double, double y) { return y; });
      const double va = over([&](double x, double) { return (x - ma) * (x - ma); });
      const double vb = over([&](double, double y) { return (y - mb) * (y - mb); });
      const double vab = over([&](double x, double y) { return (x - ma) * (y - mb); });
      total += (2 * ma * mb + c1) * (2 * vab + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2));
    }
  return total / ((width - 10.0) * (height - 10.0));
}

TEST(Psnr, isThatOfTheDefinition) {
  withEveryPath([] {
    for (const PicturePair& p : test::picturePairs()) {
      double squares = 0;
      for (std::size_t i = 0; i < p.test.rgba.size(); ++i)
        if (i % 4 != 3) squares += std::pow(p.reference.rgba[i] - p.test.rgba[i], 2);
      const double mean = squares / (3 * static_cast<double>(p.test.rgba.size() / 4));
      EXPECT_DOUBLE_EQ(psnr(p), 10 * std::log10(255.0 * 255.0 / mean)) << p.name;
    }
  });
}

// `compare -metric PSNR` of ImageMagick 6.9.11 on the same pictures as PPM.
TEST(Psnr, isThatOfImageMagick) {
  const std::pair<const char*, double> recorded[] = {
      {"noise", 7.74711},     {"ramps", 38.5643},     {"lines", 11.6738},  {"landscape", 31.795},
      {"patch", 29.9524},     {"faint", 61.154},      {"black-white", 0},  {"green-blue", 1.76091},
      {"hues", 10.1374},      {"one-pixel", 41.3988}, {"narrow", 7.55275}, {"low", 7.27098},
      {"one-by-one", 20.5975}};
  const auto pairs = test::picturePairs();
  ASSERT_EQ(pairs.size(), std::size(recorded));
  for (const auto& [name, db] : recorded)
    for (const PicturePair& p : pairs)
      if (p.name == name) {
        EXPECT_NEAR(psnr(p), db, 6e-5 * std::max(1.0, db / 10)) << name;
      }
}

TEST(Psnr, sumsDoNotOverflowAndAlphaIsIgnored) {
  withEveryPath([] {
    Picture black(5000, 2300), white(5000, 2300);
    for (std::size_t i = 0; i < white.rgba.size(); ++i) white.rgba[i] = i % 4 == 3 ? 77 : 255;
    EXPECT_EQ(psnrDb(black.rgba, white.rgba, 5000, 2300), 0);
    for (std::size_t i = 0; i < white.rgba.size(); ++i)
      if (i % 4 != 3) white.rgba[i] = 0;
    EXPECT_EQ(psnrDb(black.rgba, white.rgba, 5000, 2300), std::numeric_limits<double>::infinity());
  });
}

TEST(Ssim, isThatOfTheDefinition) {
  withEveryPath([] {
    for (const PicturePair& p : test::picturePairs()) {
      const int width = p.reference.width, height = p.reference.height;
      if (width < 11 || height < 11) continue;
      const auto a = lumaOf(p.reference), b = lumaOf(p.test);
      const double expected = ssimByTheBook(a, b, width, height);
      EXPECT_NEAR(ssim(a, b, width, height), expected, 1e-6) << p.name;
      EXPECT_NEAR(ssim(b, a, width, height), expected, 1e-6) << p.name;
      EXPECT_NEAR(ssimOfLuma(p.reference.rgba, p.test.rgba, width, height), expected, 1e-6) << p.name;
    }
  });
}

// rmgr's SSIM library (romigrou/ssim on GitHub), the mean of its map over the pixels whose windows lie inside
// the picture; its float arithmetic is up to 3e-5 from the definition on flat pictures.
TEST(Ssim, isThatOfAnotherLibrary) {
  const std::pair<const char*, double> recorded[] = {
      {"noise", 0.015008815},       {"ramps", 0.979309185}, {"lines", 0.680482326},
      {"landscape", 0.933773555},   {"patch", 0.983610685}, {"faint", 0.999687218},
      {"black-white", 0.000099997}, {"hues", 0.920423523},  {"one-pixel", 0.998578799}};
  for (const PicturePair& p : test::picturePairs())
    for (const auto& [name, mean] : recorded)
      if (p.name == name) {
        EXPECT_NEAR(ssimOfLuma(p.reference.rgba, p.test.rgba, p.reference.width, p.reference.height), mean,
                    5e-6)
            << name;
      }
}

TEST(Ssim, widthsAroundTheVectors) {
  withEveryPath([] {
    for (int width = 11; width < 60; width += 3) {
      const Picture p = test::landscape(width, 17, 5), q = test::landscape(width, 17, 2);
      const auto a = lumaOf(p), b = lumaOf(q);
      EXPECT_NEAR(ssim(a, b, width, 17), ssimByTheBook(a, b, width, 17), 1e-6) << width;
    }
  });
}

TEST(Ssim, equalPicturesAreExactlyOne) {
  withEveryPath([] {
    for (const PicturePair& p : test::picturePairs())
      if (p.reference.width >= 11 && p.reference.height >= 11) {
        EXPECT_EQ(ssimOfLuma(p.test.rgba, p.test.rgba, p.test.width, p.test.height), 1) << p.name;
      }
    Picture a = test::landscape(300, 40, 6), b = a;
    b.at(299, 39)[0] ^= 0x80;  // all windows but a few are equal
    const double s = ssimOfLuma(a.rgba, b.rgba, 300, 40);
    EXPECT_LT(s, 1);
    EXPECT_NEAR(s, ssimByTheBook(lumaOf(a), lumaOf(b), 300, 40), 1e-7);
  });
}

TEST(ImageError, whatIsNoPictureIsNaN) {
  const Picture p = test::landscape(20, 20, 4);
  const std::span<const std::uint8_t> whole = p.rgba, less = whole.first(p.rgba.size() - 4);
  std::vector<float> map(399);
  for (const auto& measure : {+[](std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int w,
                                  int h) { return psnrDb(a, b, w, h); },
                              +[](std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int w,
                                  int h) { return ssimOfLuma(a, b, w, h); },
                              +[](std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, int w,
                                  int h) { return flip(a, b, w, h); }}) {
    EXPECT_FALSE(std::isnan(measure(whole, whole, 20, 20)));
    EXPECT_TRUE(std::isnan(measure(whole, less, 20, 20)));
    EXPECT_TRUE(std::isnan(measure(less, whole, 20, 20)));
    EXPECT_TRUE(std::isnan(measure(whole, whole, 0, 20)));
    EXPECT_TRUE(std::isnan(measure(whole, whole, 20, 0)));
    EXPECT_TRUE(std::isnan(measure(whole, whole, -20, -20)));
    EXPECT_TRUE(std::isnan(measure({}, {}, 0, 0)));
  }
  EXPECT_TRUE(std::isnan(ssim(whole, whole, 20, 20)));  // four bytes a pixel where one is asked for
  EXPECT_TRUE(std::isnan(flip(whole, whole, 20, 20, map)));
  const Picture narrow = test::landscape(10, 40, 4);
  EXPECT_TRUE(std::isnan(ssimOfLuma(narrow.rgba, narrow.rgba, 10, 40)));  // no window lies inside
}

}  // namespace
}  // namespace trimtab
