#include "core/scene/passes/scale_up_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "core/scene/gl/frame_buffer.h"
#include "tests/core/scene/passes/bilinear_twin.h"
#include "tests/core/scene/scene_test.h"

namespace trimtab::scene {
namespace {

using Pixels = std::vector<std::uint8_t>;

struct Case {
  int fromWidth, fromHeight, width, height;
};

class ScaleUp : public test::SceneTest {
 protected:
  static Pixels scaled(ScaleUpPass& pass, const Case& c, const Pixels& pixels) {
    FrameBuffer small, large;
    small.resize(c.fromWidth, c.fromHeight);
    large.resize(c.width, c.height);
    small.writePixels(pixels.data());
    pass.draw(small, large);
    return large.readPixels(c.width, c.height);
  }
  static std::size_t valuesOf(int width, int height) {
    return std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

constexpr Case kCases[] = {{1, 1, 1, 1},   {1, 1, 7, 5},     {1, 9, 4, 20},    {9, 1, 30, 3},   {2, 2, 1, 1},
                           {2, 2, 64, 64}, {31, 17, 33, 19}, {64, 48, 80, 60}, {37, 53, 37, 54}};

TEST_F(ScaleUp, isItsTwinToAGreyLevelAtAnySize) {
  std::mt19937 random(3);
  ScaleUpPass here(true);
  for (const Case& c : kCases) {
    Pixels pixels(valuesOf(c.fromWidth, c.fromHeight));
    for (std::uint8_t& value : pixels) value = static_cast<std::uint8_t>(random());
    const Pixels found = scaled(here, c, pixels);
    double worst = 0;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x)
        for (int channel = 0; channel < 4; ++channel)
          worst = std::max(worst, std::abs(found[static_cast<std::size_t>((y * c.width + x) * 4 + channel)] -
                                           test::scaledUp(pixels, c.fromWidth, c.fromHeight, c.width,
                                                          c.height, x, y, channel)));
    EXPECT_LE(worst, 1) << c.fromWidth << " x " << c.fromHeight << " to " << c.width << " x " << c.height;
  }
}

TEST_F(ScaleUp, keepsOneColourAsItIs) {
  ScaleUpPass here(true);
  for (const Case& c : kCases)
    for (int grey = 0; grey < 256; ++grey) {
      const auto value = static_cast<std::uint8_t>(grey);
      ASSERT_EQ(scaled(here, c, Pixels(valuesOf(c.fromWidth, c.fromHeight), value)),
                Pixels(valuesOf(c.width, c.height), value));
    }
}

TEST_F(ScaleUp, isWhatTheBlitDraws) {
  std::mt19937 random(4);
  ScaleUpPass here(true), blit(false);
  for (const Case& c : {Case{64, 36, 128, 72}, Case{90, 50, 100, 56}}) {
    Pixels pixels(valuesOf(c.fromWidth, c.fromHeight));
    for (std::uint8_t& value : pixels) value = static_cast<std::uint8_t>(random());
    const Pixels expected = scaled(blit, c, pixels), found = scaled(here, c, pixels);
    int worst = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
      worst = std::max(worst, std::abs(int{expected[i]} - int{found[i]}));
    EXPECT_LE(worst, 3) << "grey levels; GL may interpolate in steps of 1/256";
  }
}

}  // namespace
}  // namespace trimtab::scene
