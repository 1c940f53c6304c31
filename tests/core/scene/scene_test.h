#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "tests/core/scene/terrain/synthetic_terrain.h"
#include "tests/core/terrain/baked_sample.h"
#include "tests/shared_scene.h"
#include "tests/support.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/synthetic/sample.h"

/// What tests of pictures share: a surfaceless context, a renderer, a terrain.
namespace trimtab::test {

/// TRIMTAB_SOAK in the environment multiplies the views; 1 without.
inline int soak() {
  const char* text = std::getenv("TRIMTAB_SOAK");
  return text ? std::max(1, std::atoi(text)) : 1;
}

class SceneTest : public testing::Test {
 protected:
  static constexpr int kWidth = 640, kHeight = 360;

  void SetUp() override {
    auto created = scene::Offscreen::create(kWidth, kHeight);
    if (!created) GTEST_SKIP() << toString(created.findings());
    offscreen = std::move(created).value();
    report = renderer.initialize();
    ASSERT_TRUE(report.usable) << report.missing;
  }
  void TearDown() override {
    if (offscreen) renderer.release();
  }

  void use(std::shared_ptr<const terrain::Database> terrain) {
    database = std::move(terrain);
    renderer.setTerrain(database);
  }

  /// bakeShared as the terrain; false when there is none.
  bool useShared(const std::string& folder) {
    use(bakeShared(folder));
    return database != nullptr;
  }
  /// Returns the largest difference of two pixels in red, green or blue.
  static int largestStep(const std::vector<std::uint8_t>& rgba, std::size_t a, std::size_t b) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c)
      most = std::max(most, std::abs(int{rgba[4 * a + c]} - int{rgba[4 * b + c]}));
    return most;
  }
  /// The sample, of posts far enough apart to be made within a second.
  bool useSample() {
    sampleDir_ = std::make_unique<ScratchDir>();
    if (auto baked = bakedSample(sampleDir_->path(), {1, 100, 90, {}})) use(std::move(baked));
    return database != nullptr;
  }

  /// bakedOnce; none when it cannot be.
  static std::shared_ptr<const terrain::Database> bakeShared(const std::string& folder) {
    auto opened = bakedOnce(folder);
    if (!opened) {
      ADD_FAILURE() << toString(opened.findings());
      return nullptr;
    }
    return opened.value();
  }

  /// Returns the pixel that shows a point of the terrain.
  static std::pair<int, int> projected(const FrameRequest& r, const LocalFrame& frame, Vec3 p) {
    const Vec3 e = eyeAxes(frame, r.eye, r.attitude) * (p - frame.fromGeodetic(r.eye));
    const ViewShape& v = r.view;
    return {static_cast<int>(std::floor((e.x / -e.z - v.left) / (v.right - v.left) * v.widthPx)),
            static_cast<int>(std::floor((e.y / -e.z - v.bottom) / (v.top - v.bottom) * v.heightPx))};
  }

  FrameRequest request(const GeodeticPosition& eye, const Attitude& attitude) const {
    FrameRequest r;
    r.eye = eye;
    r.attitude = attitude;
    r.view.widthPx = kWidth;
    r.view.heightPx = kHeight;
    r.waitForPages = true;  // what is drawn and counted does not depend on the frames before
    return r;
  }
  /// A place by fractions of the terrain's extent, so far above the ground there.
  GeodeticPosition over(double east, double north, double aboveM) const {
    GeodeticPosition place = scene::placeIn(database->info(), east, north);
    place.height = database->heightAt(place.latitude, place.longitude).value_or(Metres{0}) + Metres{aboveM};
    return place;
  }

  std::vector<std::uint8_t> picture(const FrameRequest& r, FrameResult* result = nullptr) {
    offscreen->makeCurrent();
    const auto drawn = renderer.draw(r, offscreen->framebuffer());
    if (result) *result = drawn;
    return renderer.readPixels(r.view.widthPx, r.view.heightPx);
  }
  static std::size_t differing(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < a.size(); i += 4)
      n += !std::equal(a.begin() + static_cast<std::ptrdiff_t>(i),
                       a.begin() + static_cast<std::ptrdiff_t>(i) + 4,
                       b.begin() + static_cast<std::ptrdiff_t>(i));
    return n;
  }

  /// Each overlay shows in the picture, and none stays behind.
  void paintEachOverlay(const FrameRequest& r) {
    const auto plain = picture(r);
    const auto changes = [&](bool Overlays::*overlay) {
      auto with = r;
      with.overlays.*overlay = true;
      return differing(plain, picture(with));
    };
    constexpr std::size_t kAll = std::size_t{kWidth} * kHeight;
    EXPECT_GT(changes(&Overlays::wireframe), kAll / 50);
    EXPECT_GT(changes(&Overlays::tileBounds), kAll / 500);
    EXPECT_GT(changes(&Overlays::colourByLevel), kAll / 4);
    EXPECT_GT(changes(&Overlays::colourByReason), kAll / 4);
    EXPECT_EQ(differing(plain, picture(r)), 0u) << "an overlay stays behind";
  }

  std::unique_ptr<ScratchDir> sampleDir_;  ///< before what reads files of it
  std::unique_ptr<scene::Offscreen> offscreen;
  scene::Renderer renderer;
  scene::GlReport report;
  std::shared_ptr<const terrain::Database> database;
};

/// 16 x 16 tiles of 90 m posts in mountains: 46 km a side.
inline std::shared_ptr<const SyntheticTerrain> syntheticMountains() {
  static const auto terrain = std::make_shared<const SyntheticTerrain>(
      16, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, mountains);
  return terrain;
}

}  // namespace trimtab::test
