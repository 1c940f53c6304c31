#include "trimtab/measure/image_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace trimtab {
namespace {

constexpr int kWidth = 320, kHeight = 200;

/// A pattern without direction, moved by so many pixels where `moves` says so.
template <class Moves>
std::vector<std::uint8_t> image(double dx, double dy, const Moves& moves) {
  std::vector<std::uint8_t> rgba(std::size_t{4} * kWidth * kHeight, 255);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double u = x - (moves(x) ? dx : 0), v = y - (moves(x) ? dy : 0);
      double value = 128;
      for (int wave = 1; wave <= 8;
           ++wave)  // of many directions and lengths, so that no place looks like another
        value += 14 * std::sin((0.1 + 0.07 * wave) * (u * std::cos(2.4 * wave) + v * std::sin(2.4 * wave)));
      for (std::size_t c = 0; c < 3; ++c)
        rgba[4 * static_cast<std::size_t>(y * kWidth + x) + c] =
            static_cast<std::uint8_t>(std::lround(value));
    }
  return rgba;
}
constexpr auto kAll = [](int) { return true; };

TEST(ImageShift, isWhatAnImageWasMovedBy) {
  const auto still = image(0, 0, kAll);
  for (const auto& [dx, dy] : {std::pair{1.0, 0.0}, {0.0, -3.0}, {2.5, 0.0}, {-0.3, 0.4}, {5.0, 5.0}}) {
    const ImageShift shift = imageShift(still, image(dx, dy, kAll), kWidth, kHeight);
    EXPECT_NEAR(shift.p95Px, std::hypot(dx, dy), 0.1) << dx << ' ' << dy;
    EXPECT_EQ(shift.moved, 1);
    EXPECT_GT(shift.blocks, 150);
    EXPECT_EQ(shift.told, 1);
  }
}

TEST(ImageShift, ofEqualImagesIsNothing) {
  const auto still = image(0, 0, kAll);
  const ImageShift shift = imageShift(still, still, kWidth, kHeight);
  EXPECT_EQ(shift.p95Px, 0);
  EXPECT_EQ(shift.moved, 0);
}

TEST(ImageShift, countsTheShareThatMoved) {
  const ImageShift shift =
      imageShift(image(0, 0, kAll), image(3, 0, [](int x) { return x < kWidth / 4; }), kWidth, kHeight);
  EXPECT_NEAR(shift.moved, 0.25, 0.08);
  EXPECT_GT(shift.told, 0.8);
  EXPECT_NEAR(shift.p95Px, 3, 0.2);
}

TEST(ImageShift, alongAnEdgeIsNone) {
  std::vector<std::uint8_t> columns(std::size_t{4} * kWidth * kHeight);
  for (std::size_t i = 0; i < columns.size(); ++i)
    columns[i] = static_cast<std::uint8_t>(128 + 100 * std::sin(0.4 * static_cast<double>(i / 4 % kWidth)));
  EXPECT_EQ(imageShift(columns, columns, kWidth, kHeight).p95Px, 0)
      << "every place above and below fits as well";
}

TEST(ImageShift, ofAFaintPatternTellsNothing) {
  auto faint = image(0, 0, kAll), moved = image(1, 0, kAll);
  for (std::vector<std::uint8_t>* rgba : {&faint, &moved})
    for (std::uint8_t& value : *rgba) value = static_cast<std::uint8_t>(120 + value / 32);
  EXPECT_EQ(imageShift(faint, moved, kWidth, kHeight).blocks, 0) << "what fits is the rounding";
}

TEST(ImageShift, ofFlatOrForeignImagesTellsNothing) {
  const std::vector<std::uint8_t> flat(std::size_t{4} * kWidth * kHeight, 90);
  EXPECT_EQ(imageShift(flat, flat, kWidth, kHeight).blocks, 0);
  EXPECT_TRUE(std::isnan(imageShift(flat, flat, kWidth, kHeight).p95Px));
  EXPECT_EQ(imageShift(image(0, 0, kAll), flat, kWidth, kHeight).blocks, 0)
      << "what it shows is gone, not moved";
  EXPECT_EQ(imageShift(flat, flat, kWidth, kHeight - 1).blocks, 0);
  EXPECT_EQ(imageShift({}, {}, 0, 0).blocks, 0);
  EXPECT_EQ(imageShift(flat, flat, kWidth, kHeight, 0).blocks, 0);
}

}  // namespace
}  // namespace trimtab
