#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/measure/image_kernels.h"
#include "flip_recorded.h"
#include "trimtab/measure/image_error.h"

namespace trimtab {
namespace {

using test::Picture;
using test::PicturePair;

constexpr double kPi = std::numbers::pi;
constexpr double kFeatureNoise = 1e-4;  ///< where features are equally strong by symmetry (image_error.h)

// FLIP as the paper has it: two-dimensional filters, in double, pixel by pixel.

using Channels = std::array<double, 3>;

Channels toXyz(const Channels& rgb) {
  return {(10135552 * rgb[0] + 8788810 * rgb[1] + 4435075 * rgb[2]) / 24577794,
          (2613072 * rgb[0] + 8788810 * rgb[1] + 887015 * rgb[2]) / 12288897,
          (1425312 * rgb[0] + 8788810 * rgb[1] + 70074185 * rgb[2]) / 73733382};
}
constexpr Channels kWhite{0.950428545, 1, 1.088900371};

Channels toYCxCz(const Channels& rgb) {
  const Channels xyz = toXyz(rgb);
  const double x = xyz[0] / kWhite[0], y = xyz[1], z = xyz[2] / kWhite[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Channels toClampedRgb(const Channels& yCxCz) {
  const double y = (yCxCz[0] + 16) / 116;
  const Channels xyz{(y + yCxCz[1] / 500) * kWhite[0], y, (y - yCxCz[2] / 200) * kWhite[2]};
  const double m[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                          {-0.969224334, 1.875930071, 0.041554224},
                          {0.055639423, -0.204011202, 1.057148933}};
  Channels rgb{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) rgb[i] += m[i][j] * xyz[j];
    rgb[i] = std::clamp(rgb[i], 0.0, 1.0);
  }
  return rgb;
}

Channels toHuntLab(const Channels& rgb) {
  const Channels xyz = toXyz(rgb);
  const auto f = [](double t) {
    return t > std::pow(6.0 / 29, 3) ? std::cbrt(t) : t / (3 * std::pow(6.0 / 29, 2)) + 4.0 / 29;
  };
  const double x = f(xyz[0] / kWhite[0]), y = f(xyz[1]), z = f(xyz[2] / kWhite[2]);
  const double l = 116 * y - 16;
  return {l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)};
}

double hyab(const Channels& a, const Channels& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

class Flip {
 public:
  Flip(const PicturePair& pair, double pixelsPerDegree) : width_(pair.test.width), height_(pair.test.height) {
    spatialRadius_ = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * pixelsPerDegree));
    const double deviation = 0.5 * 0.082 * pixelsPerDegree;
    featureRadius_ = static_cast<int>(std::ceil(3 * deviation));
    const auto sensitivity = [&](double a1, double b1, double a2, double b2) {
      return filter(spatialRadius_, [&](int x, int y) {
        const double d2 = (x * x + y * y) / (pixelsPerDegree * pixelsPerDegree);
        const auto part = [&](double a, double b) {
          return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * d2 / b);
        };
        return part(a1, b1) + part(a2, b2);
      });
    };
    csf_ = {sensitivity(1, 0.0047, 0, 1e-5), sensitivity(1, 0.0053, 0, 1e-5),
            sensitivity(34.1, 0.04, 13.5, 0.025)};
    const auto gauss = [&](int x, int y) { return std::exp(-(x * x + y * y) / (2 * deviation * deviation)); };
    edge_ = filter(featureRadius_, [&](int x, int y) { return -x * gauss(x, y); });
    point_ = filter(featureRadius_,
                    [&](int x, int y) { return (x * x / (deviation * deviation) - 1) * gauss(x, y); });
    for (int i = 0; i < 2; ++i) {
      const Picture& p = i == 0 ? pair.reference : pair.test;
      for (std::size_t at = 0; at < p.rgba.size(); at += 4) {
        Channels rgb{};
        for (std::size_t c = 0; c < 3; ++c) {
          const double v = p.rgba[at + c] / 255.0;
          rgb[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        }
        pictures_[i].push_back(toYCxCz(rgb));
      }
    }
    maximum_ = std::pow(hyab(toHuntLab({0, 1, 0}), toHuntLab({0, 0, 1})), 0.7);
  }

  double error(int x, int y) const {
    Channels lab[2];
    double edges[2], points[2];
    for (int i = 0; i < 2; ++i) {
      Channels seen{};
      for (std::size_t c = 0; c < 3; ++c)
        seen[c] = filtered(x, y, spatialRadius_, csf_[c], false,
                           [&](std::size_t at) { return pictures_[i][at][c]; });
      lab[i] = toHuntLab(toClampedRgb(seen));
      const auto strength = [&](const std::vector<double>& f) {
        const auto grey = [&](std::size_t at) { return (pictures_[i][at][0] + 16) / 116; };
        return std::hypot(filtered(x, y, featureRadius_, f, false, grey),
                          filtered(x, y, featureRadius_, f, true, grey));
      };
      edges[i] = strength(edge_);
      points[i] = strength(point_);
    }
    const double raised = std::pow(hyab(lab[0], lab[1]), 0.7), knee = 0.4 * maximum_;
    const double colour =
        raised < knee ? raised * 0.95 / knee : 0.95 + (raised - knee) / (maximum_ - knee) * 0.05;
    const double feature =
        std::sqrt(std::max(std::abs(edges[0] - edges[1]), std::abs(points[0] - points[1])) / std::sqrt(2.0));
    return std::pow(colour, 1 - feature);
  }

 private:
  /// Negative and positive weights each sum up to 1.
  template <class Weight>
  static std::vector<double> filter(int radius, const Weight& weight) {
    std::vector<double> weights;
    double positive = 0, negative = 0;
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x) {
        weights.push_back(weight(x, y));
        (weights.back() > 0 ? positive : negative) += std::abs(weights.back());
      }
    for (double& w : weights)
      if (w != 0) w /= w > 0 ? positive : negative;
    return weights;
  }

  template <class Value>
  double filtered(int x, int y, int radius, const std::vector<double>& filter, bool turned,
                  const Value& value) const {
    double sum = 0;
    const int side = 2 * radius + 1;
    for (int j = -radius; j <= radius; ++j)
      for (int i = -radius; i <= radius; ++i) {
        const int column = std::clamp(x + i, 0, width_ - 1), row = std::clamp(y + j, 0, height_ - 1);
        const int at = turned ? (i + radius) * side + j + radius : (j + radius) * side + i + radius;
        sum += filter[static_cast<std::size_t>(at)] * value(static_cast<std::size_t>(row * width_ + column));
      }
    return sum;
  }

  int width_, height_, spatialRadius_, featureRadius_;
  std::array<std::vector<double>, 3> csf_;
  std::vector<double> edge_, point_;
  std::vector<Channels> pictures_[2];
  double maximum_ = 0;
};

std::vector<SimdLevel> levels() {
  std::vector<SimdLevel> available;
  for (const SimdLevel level : {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512})
    if (level <= simdLevel()) available.push_back(level);
  return available;
}
/// Takes each level that there is, and at the end the one that was taken before.
template <class Check>
void onEveryPath(const Check& check) {
  for (const SimdLevel level : levels()) {
    useSimdLevel(level);
    SCOPED_TRACE("path " + std::to_string(static_cast<int>(level)));
    check();
  }
  useSimdLevel(levels().back());
}

std::vector<float> mapOf(const PicturePair& p, double pixelsPerDegree = kFlipPixelsPerDegree) {
  std::vector<float> map(p.test.rgba.size() / 4, -1.0f);
  const double mean = flip(p.reference.rgba, p.test.rgba, p.test.width, p.test.height, map, pixelsPerDegree);
  double sum = 0;
  for (const float error : map) sum += error;
  EXPECT_NEAR(mean, sum / static_cast<double>(map.size()), 1e-12) << p.name;
  EXPECT_EQ(flip(p.reference.rgba, p.test.rgba, p.test.width, p.test.height, {}, pixelsPerDegree), mean);
  return map;
}

TEST(Flip, isThatOfThePaper) {
  for (const double pixelsPerDegree : {kFlipPixelsPerDegree, 30.0}) {
    for (const PicturePair& p : test::picturePairs()) {
      const Flip byTheBook(p, pixelsPerDegree);
      const bool symmetric = p.name == "lines" || p.name == "hues";
      const int step = p.test.width * p.test.height > 4000 ? 7 : 1;  // every seventh pixel of the larger ones
      std::vector<double> expected;
      for (int at = 0; at < p.test.width * p.test.height; at += step)
        expected.push_back(byTheBook.error(at % p.test.width, at / p.test.width));
      onEveryPath([&] {
        const std::vector<float> map = mapOf(p, pixelsPerDegree);
        double worst = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
          worst = std::max(worst, std::abs(map[i * static_cast<std::size_t>(step)] - expected[i]));
        EXPECT_LT(worst, symmetric ? kFeatureNoise : 3e-6) << p.name << " at " << pixelsPerDegree;
      });
    }
  }
}

TEST(Flip, isThatOfTheReferenceImplementation) {
  const auto pairs = test::picturePairs();
  onEveryPath([&] {
    for (const test::RecordedFlip& recorded : test::kRecordedFlip)
      for (const PicturePair& p : pairs) {
        if (p.name != recorded.pair) continue;
        const std::vector<float> map = mapOf(p, recorded.pixelsPerDegree);
        // At 20 pixels a degree the reference's floats lose differences of lines that double still has.
        const double bound = p.name == "lines" && recorded.pixelsPerDegree == 20 ? 1.6e-4 : 1e-4;
        double sum = 0;
        for (const float error : map) sum += error;
        EXPECT_NEAR(sum / static_cast<double>(map.size()), recorded.mean, 1e-4) << p.name;
        for (int i = 0; i < test::kProbes; ++i) {
          const auto [x, y] = test::probeOf(i, p.test);
          EXPECT_NEAR(map[static_cast<std::size_t>(y * p.test.width + x)],
                      recorded.atProbes[static_cast<std::size_t>(i)], bound)
              << p.name << " " << x << "," << y << " at " << recorded.pixelsPerDegree;
        }
      }
  });
}

TEST(Flip, pathsAgree) {
  const auto pairs = test::picturePairs();
  for (const PicturePair& p : pairs) {
    const bool symmetric = p.name == "lines" || p.name == "hues";
    useSimdLevel(SimdLevel::portable);
    const std::vector<float> portable = mapOf(p);
    onEveryPath([&] {
      const std::vector<float> map = mapOf(p);
      for (std::size_t i = 0; i < map.size(); ++i)
        ASSERT_NEAR(map[i], portable[i], symmetric ? kFeatureNoise : 2e-6) << p.name << " " << i;
    });
  }
}

TEST(Flip, isExactlyZeroOutOfReachOfADifference) {
  const Picture a = test::landscape(400, 150, 6);
  for (const auto& [x, y] : {std::pair{0, 0}, {399, 149}, {127, 70}, {128, 71}, {200, 8}}) {
    PicturePair p{"one pixel", a, a};
    p.test.at(x, y)[1] ^= 0x40;
    const Flip byTheBook(p, kFlipPixelsPerDegree);
    onEveryPath([&] {
      const std::vector<float> map = mapOf(p);
      for (int row = 0; row < a.height; ++row)
        for (int column = 0; column < a.width; ++column) {
          const float error = map[static_cast<std::size_t>(row * a.width + column)];
          const int distance = std::max(std::abs(row - y), std::abs(column - x));
          if (distance > 10) {
            ASSERT_EQ(error, 0) << column << "," << row;
          }
          if (distance <= 10 && (row + column) % 5 == 0) {
            ASSERT_NEAR(error, byTheBook.error(column, row), 3e-6) << column << "," << row;
          }
        }
    });
  }
}

TEST(Flip, equalPicturesAreZeroAndTheWorstIsOne) {
  onEveryPath([] {
    for (PicturePair p : test::picturePairs()) {
      p.test = p.reference;
      for (std::size_t i = 3; i < p.test.rgba.size(); i += 4) p.test.rgba[i] = static_cast<std::uint8_t>(i);
      for (const float error : mapOf(p)) ASSERT_EQ(error, 0) << p.name;  // alpha does not count
    }
    for (const PicturePair& p : test::picturePairs())
      for (const float error : mapOf(p)) {
        ASSERT_GE(error, 0);
        ASSERT_LE(error, 1.000001f);
      }
  });
}

TEST(Flip, sizesAroundBlocksAndStrips) {
  for (const auto& [width, height] :
       {std::pair{2, 2}, {15, 7}, {16, 8}, {17, 9}, {127, 3}, {128, 17}, {129, 16}, {257, 5}, {1, 40}}) {
    const PicturePair p{"size", test::landscape(width, height, 6), test::landscape(width, height, 2)};
    const Flip byTheBook(p, kFlipPixelsPerDegree);
    onEveryPath([&] {
      const std::vector<float> map = mapOf(p);
      for (int at = 0; at < width * height; at += 3)
        ASSERT_NEAR(map[static_cast<std::size_t>(at)], byTheBook.error(at % width, at / width), 3e-6)
            << width << "x" << height << " " << at;
    });
  }
}

TEST(Flip, pixelsPerDegreeFromOneToThousands) {
  const PicturePair p{"ppd", test::landscape(60, 40, 6), test::landscape(60, 40, 2)};
  for (const double bad : {0.0, -67.0, 0.999, 4001.0, 1e30, std::nan(""), HUGE_VAL})
    EXPECT_TRUE(std::isnan(flip(p.reference.rgba, p.test.rgba, 60, 40, {}, bad))) << bad;
  for (const double good : {1.0, 2.0, 7.3, 15.0, 400.0, 4000.0}) {
    const Flip byTheBook(p, good);
    onEveryPath([&] {
      const std::vector<float> map = mapOf(p, good);
      for (int i = 0; i < (good > 1000 ? 1 : 5); ++i) {
        const int x = (i * 23) % 60, y = (i * 17) % 40;
        EXPECT_NEAR(map[static_cast<std::size_t>(y * 60 + x)], byTheBook.error(x, y), 1e-5) << good;
      }
    });
  }
}

}  // namespace
}  // namespace trimtab
