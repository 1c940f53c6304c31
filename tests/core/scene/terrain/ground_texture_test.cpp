#include <random>

#include "core/scene/shaders/light.h"
#include "core/scene/shaders/shared_constants.h"
#include "ground_on_gpu.h"

namespace trimtab::scene {
namespace {

/// Bilinear of a level at a post, in double; channel 3 is the light as a share of kMostLight.
double sampled(const Formula& ground, std::uint32_t level, double column, double row, int channel) {
  const double scale = std::ldexp(1.0, -static_cast<int>(level));
  const double x = ground.shape().texelOf(column) * scale - 0.5,
               y = ground.shape().texelOf(row) * scale - 0.5;
  const auto c = static_cast<std::int64_t>(std::floor(x)), r = static_cast<std::int64_t>(std::floor(y));
  double sum = 0;
  for (const int j : {0, 1})
    for (const int i : {0, 1}) {
      const GroundTexel t = ground.texel(level, c + i, r + j);
      const double nx = t.normalX / 127.0, ny = t.normalY / 127.0;
      const double light = 255 * lightOn({nx, ny, std::sqrt(1 - nx * nx - ny * ny)}) / kMostLight;
      const double value = channel == 0 ? t.red : channel == 1 ? t.green : channel == 2 ? t.blue : light;
      const double u = x - static_cast<double>(c), v = y - static_cast<double>(r);
      sum += value * (i ? u : 1 - u) * (j ? v : 1 - v);
    }
  return sum;
}

/// The picture against the levels themselves: the level is told by the formula's blue, which is another at
/// each. Returns the finest and coarsest level seen.
std::pair<double, double> expectSampled(const Formula& ground, const View& view,
                                        const std::vector<std::uint8_t>& colour,
                                        const std::vector<std::uint8_t>& light, int width, int height,
                                        std::uint32_t least, double tolerance = 2) {
  double finest = 99, coarsest = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double column = view.columnAt(x + 0.5, y + 0.5), row = view.rowAt(x + 0.5, y + 0.5);
      const std::uint8_t* pixel = &colour[static_cast<std::size_t>(y * width + x) * 4];
      double level = (pixel[2] - 40) / 20.0;
      while (level < least) level += 8;
      const double last = static_cast<double>(ground.shape().levels.size() - 1);
      for (const int k : {0, 1, 3}) {
        // Blue tells the level to half a step: what it can be there is a little range.
        double low = 1e9, high = -1e9;
        for (const double l : {level - 0.03, level, level + 0.03}) {
          const double at = std::clamp(l, 0.0, last);
          const auto fine = static_cast<std::uint32_t>(at);
          const double a = sampled(ground, fine, column, row, k),
                       b = fine < last ? sampled(ground, fine + 1, column, row, k) : a;
          low = std::min(low, a + (b - a) * (at - fine));
          high = std::max(high, a + (b - a) * (at - fine));
        }
        const double found = k == 3 ? light[static_cast<std::size_t>(y * width + x) * 4] : pixel[k];
        if (found < low - tolerance || found > high + tolerance) {
          ADD_FAILURE() << "pixel " << x << ", " << y << " channel " << k << " level " << level << ": "
                        << found << " for " << low << " to " << high;
          return {finest, coarsest};
        }
      }
      finest = std::min(finest, level);
      coarsest = std::max(coarsest, level);
    }
  return {finest, coarsest};
}

TEST_F(GroundOnGpu, isWhatTheLevelsHoldAtEveryPlaceAndScale) {
  struct Case {
    double texels, eyeColumn, eyeRow;
  };
  for (const Case at : {Case{1, 5000.3, 7000.8}, Case{2, 9990.1, 3.2}, Case{0.5, 20, 11990}})
    for (const double scale : {0.11, 0.5, 1.0, 3.0, 17.0}) {
      const auto ground = std::make_shared<Formula>(10000, 12000, at.texels);
      texture_->setGround(ground);
      texture_->update(at.eyeColumn, at.eyeRow, true, 0);
      EXPECT_TRUE(texture_->complete());
      SCOPED_TRACE(testing::Message() << at.texels << " texels a post, " << scale << " posts a pixel");
      // Turned a little, about the eye, inside the data.
      View view;
      view.acrossColumn = scale, view.acrossRow = 0.07 * scale;
      view.upColumn = -0.05 * scale, view.upRow = scale;
      view.column = std::clamp(at.eyeColumn - 80 * scale, 10 * scale, 9999 - 165 * scale);
      view.row = std::clamp(at.eyeRow - 60 * scale, 0.0, 11999 - 135 * scale);
      const auto [finest, coarsest] =
          expectSampled(*ground, view, draw(view), draw(view, true), kWidth, kHeight, 0);
      const double expected = std::max(0.0, std::log2(scale * at.texels));
      EXPECT_NEAR(finest, expected, 0.15);
      EXPECT_NEAR(coarsest, expected, 0.15);
    }
}

TEST_F(GroundOnGpu, getsCoarserWithDistanceWithoutASeam) {
  const auto ground = std::make_shared<Formula>(40000, 40000);
  texture_->setGround(ground);
  texture_->update(20000.5, 19999.5, true, 0);
  // Lines of fine footprint through the eye and far away from it: levels follow distance alone.
  for (const double away : {300.0, 440.0, 470.0, 700.0, 950.0, 3000.0, 9000.0, 15000.0}) {
    View view;
    view.acrossColumn = 0.2, view.upRow = 0.2;
    view.column = 20000 + away, view.row = 20000;
    const auto [finest, coarsest] =
        expectSampled(*ground, view, draw(view), draw(view, true), kWidth, kHeight, 0);
    const double reach = std::log2(away / 480);
    EXPECT_LE(finest, std::max(0.0, reach + 1.2)) << away;
    EXPECT_GE(coarsest, std::max(0.0, std::floor(reach) - 0.01)) << away;
    EXPECT_LT(coarsest - finest, 1) << away;
  }
}

TEST_F(GroundOnGpu, movedInStepsIsTheSameToTheBitAsFresh) {
  const auto ground = std::make_shared<Formula>(9000, 7000);
  const std::size_t levels = ground->shape().levels.size();
  texture_->setGround(ground);
  std::mt19937 random(7);
  double column = 300, row = 300;
  for (int step = 0; step < 60; ++step) {
    column += static_cast<double>(random() % 400) - 90;
    row += static_cast<double>(random() % 300) - 60;
    texture_->update(column, row, step % 3 == 0, 1 << 20);
  }
  texture_->update(column, row, true, 0);
  const auto moved = layers(levels);
  View view;
  view.column = column - 400, view.row = row - 300;
  view.acrossColumn = view.upRow = 5;
  const auto picture = draw(view);
  texture_ = std::make_unique<GroundTexture>();
  texture_->setGround(ground);
  texture_->update(column, row, true, 0);
  EXPECT_EQ(draw(view), picture);
  // All of a large level is of the window; of small ones only what has ground is.
  const auto fresh = layers(levels);
  constexpr std::size_t kLayer = std::size_t{kGroundSide} * kGroundSide;
  for (std::size_t l = 0; l < levels && ground->shape().levels[l].columns > 2000; ++l)
    EXPECT_TRUE(std::equal(moved.begin() + static_cast<std::ptrdiff_t>(l * kLayer),
                           moved.begin() + static_cast<std::ptrdiff_t>((l + 1) * kLayer),
                           fresh.begin() + static_cast<std::ptrdiff_t>(l * kLayer)))
        << "level " << l;
}

TEST_F(GroundOnGpu, showsTheNextCoarserLevelUntilTilesAreThere) {
  const auto ground = std::make_shared<Formula>(20000, 20000);
  texture_->setGround(ground);
  View view;
  view.acrossColumn = view.upRow = 0.5;
  view.column = 10000, view.row = 10000;
  texture_->update(10000, 10000, false, 0);
  const auto last = static_cast<std::uint32_t>(ground->shape().levels.size()) - 1;
  double before = 99;
  for (int frame = 0; frame < 5000 && !texture_->complete(); ++frame) {
    const auto [finest, coarsest] =
        expectSampled(*ground, view, draw(view), draw(view, true), kWidth, kHeight, 0);
    ASSERT_FALSE(testing::Test::HasFailure()) << "frame " << frame;
    EXPECT_LE(coarsest, before + 1e-9);
    before = coarsest;
    texture_->update(10000, 10000, false, 512 << 10);
  }
  ASSERT_TRUE(texture_->complete());
  EXPECT_EQ(expectSampled(*ground, view, draw(view), draw(view, true), kWidth, kHeight, 0).second, 0);
  EXPECT_GE(last, 6u);
}

TEST_F(GroundOnGpu, whatCannotBeReadStaysCoarser) {
  const auto ground = std::make_shared<Formula>(5000, 5000);
  ground->brokenLevel = 0;
  texture_->setGround(ground);
  texture_->update(2500, 2500, true, 0);
  View view;
  view.acrossColumn = view.upRow = 0.5;
  view.column = 2450, view.row = 2450;
  const auto [finest, coarsest] =
      expectSampled(*ground, view, draw(view), draw(view, true), kWidth, kHeight, 1, 10);
  EXPECT_EQ(finest, 1);
  EXPECT_EQ(coarsest, 1);
  EXPECT_FALSE(texture_->failures().empty());
}

TEST_F(GroundOnGpu, whatCannotBeReadIsTriedOnceAndHoldsNothingUp) {
  for (const bool waits : {true, false}) {
    const auto ground = std::make_shared<Formula>(5000, 5000);
    ground->brokenLevel = 1;
    texture_->setGround(ground);
    for (int frame = 0; frame < 5000 && !(frame > 0 && texture_->complete()); ++frame) {
      texture_->update(2500, 2500, waits, 4 << 20);
      if (!waits) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(texture_->complete());
    const int tried = ground->failed;
    EXPECT_EQ(static_cast<std::size_t>(tried), texture_->failed());
    EXPECT_GT(tried, 3);
    // Far away and back: what was kept of it is not any more.
    for (const double column : {0.0, 4900.0, 2500.0})
      for (const double row : {0.0, 4900.0, 2500.0}) texture_->update(column, row, true, 0);
    EXPECT_TRUE(texture_->complete());
    EXPECT_EQ(static_cast<std::size_t>(ground->failed), texture_->failed());
    View view;
    view.acrossColumn = view.upRow = 0.5;
    view.column = 2450, view.row = 2450;
    EXPECT_EQ(expectSampled(*ground, view, draw(view), draw(view, true), kWidth, kHeight, 0).second, 0)
        << "the finer level is there";
  }
}

TEST_F(GroundOnGpu, isGreyWhereNothingCanBeRead) {
  const auto ground = std::make_shared<Formula>(200, 200);
  ground->brokenLevel = 0;
  texture_->setGround(ground);
  texture_->update(100, 100, true, 0);
  EXPECT_TRUE(texture_->complete());
  View view;
  view.column = view.row = 20;
  const auto pixels = draw(view);
  for (std::size_t i = 0; i < pixels.size(); i += 4) ASSERT_EQ(pixels[i], 128);
}

TEST_F(GroundOnGpu, neverWaitsNorUploadsMoreThanAllowed) {
  const auto ground = std::make_shared<Formula>(20000, 20000);
  texture_->setGround(ground);
  texture_->update(1000, 1000, true, 0);
  ground->held = true;
  const auto read = ground->read.load();
  for (int frame = 0; frame < 50; ++frame) texture_->update(1000 + 20 * frame, 1000, false, 100 << 10);
  EXPECT_EQ(ground->read, read) << "a frame waited until a read had ended";
  EXPECT_FALSE(texture_->complete());
  ground->held = false;
  for (int frame = 0; frame < 200; ++frame) {
    const std::uint64_t before = texture_->bytesUploaded();
    texture_->update(2000 + 3 * frame, 1000 + 5 * frame, false, 100 << 10);
    EXPECT_LE(texture_->bytesUploaded() - before, 100u << 10);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST_F(GroundOnGpu, itsThreadGivesWayToWhoDraws) {
  const int own = ::getpriority(PRIO_PROCESS, 0);
  const auto ground = std::make_shared<Formula>(2000, 2000);
  texture_->setGround(ground);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  for (; !texture_->complete() && std::chrono::steady_clock::now() < end;
       std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    texture_->update(1000, 1000, false, 16 << 20);
  EXPECT_TRUE(texture_->complete());
  EXPECT_GE(ground->niceness, std::min(own + 10, 19));
  EXPECT_EQ(::getpriority(PRIO_PROCESS, 0), own);
}

TEST_F(GroundOnGpu, keepsItsMemoryHoweverFarItFlies) {
  const auto ground = std::make_shared<Formula>(60000, 60000);
  texture_->setGround(ground);
  std::size_t most = 0;
  for (int frame = 0; frame < 200; ++frame) {
    texture_->update(1000 + 280 * frame, 30000 + 50 * (frame % 100), frame % 20 == 0, 2 << 20);
    most = std::max(most, texture_->bytes());
  }
  const std::size_t levels = ground->shape().levels.size();
  EXPECT_LE(most, levels * kGroundSide * kGroundSide * 4 + (97u << 18));
}

TEST_F(GroundOnGpu, onlyBordersAreUploadedAsTheEyeMoves) {
  const auto ground = std::make_shared<Formula>(60000, 60000);
  texture_->setGround(ground);
  texture_->update(30000, 30000, true, 0);
  const std::uint64_t first = texture_->bytesUploaded();
  texture_->update(30020, 30000, true, 0);
  texture_->update(30000, 30000, true, 0);
  const std::uint64_t still = texture_->bytesUploaded();
  texture_->update(30064, 30000, true, 0);
  texture_->update(30128, 30000, true, 0);
  const std::uint64_t moved = texture_->bytesUploaded() - still;
  // Two columns of sixteen blocks of the finest level, and one of the next.
  EXPECT_LE(moved, 4u * 16 * 64 * 64 * 4);
  EXPECT_GE(moved, 2u * 16 * 64 * 64 * 4);
  EXPECT_LT(still - first, 3u * 16 * 64 * 64 * 4);
}

TEST_F(GroundOnGpu, voidsStandOutWhereTheyAreShown) {
  const auto ground = std::make_shared<Formula>(3000, 3000);
  texture_->setGround(ground);
  texture_->update(50, 500, true, 0);
  View view;
  view.acrossColumn = view.upRow = 0.5;
  view.column = 0, view.row = 450;
  const auto plain = draw(view);
  texture_->showVoids(true);
  texture_->update(50, 500, true, 0);
  const auto shown = draw(view);
  texture_->showVoids(false);
  texture_->update(50, 500, true, 0);
  EXPECT_EQ(draw(view), plain);
  const auto at = [&](const auto& pixels, int column, int channel) {
    return int{
        pixels[static_cast<std::size_t>(60 * kWidth + 2 * column) * 4 + static_cast<std::size_t>(channel)]};
  };
  EXPECT_NEAR(at(shown, 20, 0), at(plain, 20, 0) * 0.2 + 204 * 0.8, 2);
  EXPECT_NEAR(at(shown, 20, 2), at(plain, 20, 2) * 0.2 + 167 * 0.8, 2);
  EXPECT_EQ(at(shown, 60, 0), at(plain, 60, 0));
}

}  // namespace
}  // namespace trimtab::scene
