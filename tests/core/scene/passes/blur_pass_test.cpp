#include "core/scene/passes/blur_pass.h"

#include <cstdlib>
#include <random>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"
#include "tests/core/scene/scene_test.h"

namespace trimtab::scene {
namespace {

class BlurPassTest : public test::SceneTest {};

// The other tests of blur run on the rasteriser that there is; here both ways get the same images.
TEST_F(BlurPassTest, mixesAlikeByShaderAndOnThisProcessor) {
  constexpr int kSide = 64;
  std::mt19937 random(2);
  BlurPass byShader(false), here(true);
  FrameBuffer image;
  image.resize(kSide, kSide);
  int changed = 0;
  for (const double time : {1.0, 1.01, 1.03, 1.03, 1.034, 1.2, 3.0, 3.002}) {
    std::vector<std::uint8_t> pixels(std::size_t{4} * kSide * kSide);
    for (std::uint8_t& value : pixels) value = static_cast<std::uint8_t>(random());
    const auto blurred = [&](BlurPass& pass) {
      image.writePixels(pixels.data());
      pass.apply(image, 0.9, time);
      return image.readPixels(kSide, kSide);
    };
    const auto expected = blurred(byShader), found = blurred(here);
    changed += found != pixels;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const bool alpha = i % 4 == 3;  // nobody looks at it
      ASSERT_TRUE(alpha || std::abs(int{expected[i]} - int{found[i]}) <= 1) << time << " s, value " << i;
    }
  }
  EXPECT_EQ(changed, 6) << "all but the first one, and the one after a rest";
}

}  // namespace
}  // namespace trimtab::scene
