#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <random>
#include <set>

#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

/// Whatever looks for hidden ground, in whichever form it is drawn: the same picture, and only the work that
/// is needed.
namespace trimtab {
namespace {

constexpr std::array kMethods{OcclusionMethod::automatic, OcclusionMethod::depth_map,
                              OcclusionMethod::horizon};

std::shared_ptr<const terrain::Database> patchedMountains() {
  static const auto terrain = [] {
    terrain::HeightGrid grid;
    grid.posts = {128.1, 36.4, 1.0 / 1200, 1.0 / 1200, 513, 513};
    for (std::uint32_t row = 0; row < grid.posts.rows; ++row)
      for (std::uint32_t column = 0; column < grid.posts.columns; ++column)
        grid.heights.push_back(
            static_cast<float>(test::mountains(static_cast<int>(column), static_cast<int>(row))));
    return std::make_shared<const test::PatchedTerrain>(std::move(grid));
  }();
  return terrain;
}

class OcclusionStage : public test::SceneTest {
 protected:
  FrameRequest low(double heading, OcclusionMethod method) const {
    auto r = request(over(0.5, 0.5, 120), {Degrees{heading}, Degrees{-3}, Degrees{0}});
    r.levers.drawn.occlusion = OcclusionResolution{400, 300};
    r.occlusion = method;
    r.levers.drawn.errorPx = 1;
    r.waitForPages = true;
    return r;
  }
  /// Number of pixels in which it differs from the same without culling.
  std::size_t lost(FrameRequest r, FrameResult* result = nullptr) {
    const auto drawn = picture(r, result);
    r.cullingCase = CullingCase::none;
    return differing(drawn, picture(r));
  }
};

TEST_F(OcclusionStage, servesEveryFormByEveryMethodWithoutAPixelLost) {
  for (const bool patches : {false, true}) {
    use(patches ? patchedMountains() : test::syntheticMountains());
    for (const OcclusionMethod method : kMethods) {
      std::size_t hidden = 0, served = 0;
      for (int i = 0; i < 8; ++i) {
        FrameResult result;
        auto r = low(45.0 * i, method);
        r.eye = over(0.4 + 0.02 * i, 0.5, 60);
        EXPECT_EQ(lost(r, &result), 0u) << patches << ' ' << static_cast<int>(method) << ' ' << i;
        EXPECT_EQ(result.patches, patches);
        EXPECT_NE(result.occlusion, OcclusionMethod::automatic);
        if (method != OcclusionMethod::automatic) {
          ASSERT_TRUE(result.occlusion.has_value()) << result.note;
          EXPECT_EQ(result.occlusion == method, result.note.empty()) << result.note;
        }
        hidden += result.visible.occluded;
        served += result.occlusion.has_value();
      }
      if (method == OcclusionMethod::automatic) continue;
      EXPECT_GT(hidden, 0u) << patches << ' ' << static_cast<int>(method);
      EXPECT_EQ(served, 8u);
    }
  }
}

TEST_F(OcclusionStage, hidesNothingFromUnderTheGroundAndSaysSo) {
  for (const bool patches : {false, true}) {
    use(patches ? patchedMountains() : test::syntheticMountains());
    for (const OcclusionMethod method : kMethods) {
      auto r = low(40, method);
      r.eye = over(0.5, 0.5, -40);
      FrameResult result;
      EXPECT_EQ(lost(r, &result), 0u);
      EXPECT_EQ(result.note, "The eye is under the ground.");
      EXPECT_FALSE(result.occlusion.has_value());
      EXPECT_EQ(result.visible.occluded, 0u);
    }
  }
}

TEST_F(OcclusionStage, keepsTheVisibleSetWhileNothingInItCanChange) {
  for (const bool patches : {false, true}) {
    use(patches ? patchedMountains() : test::syntheticMountains());
    auto r = low(40, OcclusionMethod::horizon);
    FrameResult first, second, third;
    const auto drawn = picture(r, &first);
    EXPECT_EQ(picture(r, &second), drawn);
    EXPECT_EQ(second.counters.visibleSelected, first.counters.visibleSelected);
    EXPECT_EQ(second.visible.occluded, first.visible.occluded);
    r.skips.sameVisible = false;
    EXPECT_EQ(picture(r, &third), drawn);
    EXPECT_EQ(third.counters.visibleSelected, second.counters.visibleSelected + 1);
    r.skips.sameVisible = true;
    // Whatever it depends on.
    const auto changes = [&](const char* what, auto&& change) {
      auto changed = r;
      FrameResult before, after;
      picture(r, &before);
      change(changed);
      EXPECT_EQ(lost(changed, &after), 0u) << what;
      EXPECT_GT(after.counters.visibleSelected, before.counters.visibleSelected) << what;
    };
    changes("a turn", [](auto& c) { c.attitude.heading = Degrees{41}; });
    changes("a roll", [](auto& c) { c.attitude.roll = Degrees{1}; });
    changes("a step", [](auto& c) { c.eye.height = c.eye.height + Metres{0.5}; });
    changes("a zoom", [](auto& c) { c.view.right *= 0.9; });
    changes("other levels", [](auto& c) { c.levers.drawn.errorPx = 6; });
    changes("another case", [](auto& c) { c.cullingCase = CullingCase::view_frustum; });
    changes("another band", [](auto& c) { c.levers.drawn.occlusion = OcclusionResolution{64, 48}; });
    changes("scheme frustum", [](auto& c) { c.levers.drawn.occlusion.reset(); });
    changes("no back faces", [](auto& c) { c.backFaces = false; });
    if (!patches) changes("another way", [](auto& c) { c.occlusion = OcclusionMethod::depth_map; });
  }
}

TEST_F(OcclusionStage, looksForNothingInSchemeFrustumUnlessAskedTo) {
  for (const bool patches : {false, true}) {
    use(patches ? patchedMountains() : test::syntheticMountains());
    for (const OcclusionMethod method : kMethods) {
      std::size_t hidden = 0;
      for (int i = 0; i < 4; ++i) {
        auto r = low(90.0 * i, method);
        r.eye = over(0.5, 0.5, 40);
        r.reproducible = true;
        r.levers.drawn.occlusion.reset();
        FrameResult skipped, done;
        const auto drawn = picture(r, &skipped);
        EXPECT_FALSE(skipped.occlusion.has_value());
        EXPECT_TRUE(std::isnan(skipped.cost.occlusion));
        r.skips.schemeFrustum = false;
        EXPECT_EQ(picture(r, &done), drawn);
        EXPECT_TRUE(done.occlusion.has_value());
        hidden += done.visible.occluded;
      }
      EXPECT_GT(hidden, 0u) << patches << ' ' << static_cast<int>(method);
    }
  }
}

TEST_F(OcclusionStage, tellsOnlyOfAHorizonOfThisPicture) {
  for (const bool patches : {false, true}) {
    use(patches ? patchedMountains() : test::syntheticMountains());
    const auto tells = [&](const FrameRequest& r, bool ofHorizon, const char* what) {
      FrameResult result;
      picture(r, &result);
      EXPECT_EQ(result.horizon, ofHorizon) << what;
      EXPECT_EQ(renderer.readHorizon(8).size(), ofHorizon ? 8u : 0u) << what;
      EXPECT_FALSE(result.depthMap.has_value()) << what;
      EXPECT_EQ(renderer.readDepthMap().pixels.empty(), !ofHorizon) << what;
    };
    auto r = low(40, OcclusionMethod::horizon);
    r.skips.littleHidden = false;
    tells(r, true, "low");
    tells(r, true, "a view that stands");
    auto sky = r;
    sky.eye = over(0.5, 0.5, 6000);
    sky.attitude.pitch = Degrees{80};
    tells(sky, true, "nothing but sky");
    tells(r, true, "low again");
    auto under = r;
    under.eye = over(0.5, 0.5, -40);
    tells(under, false, "under the ground");
    tells(r, true, "out of it");
    renderer.setTerrain(database);
    EXPECT_TRUE(renderer.readHorizon(8).empty());
    EXPECT_TRUE(renderer.readDepthMap().pixels.empty());
    tells(sky, true, "the terrain anew");
  }
}

/// Triangles that stand nearly upright: the earth's curvature may make them hang over.
TEST_F(OcclusionStage, saysThatACliffHasNoHorizon) {
  terrain::HeightGrid grid;
  grid.posts = {128.1, 36.4, 1e-5, 1e-5, 129, 129};
  for (std::uint32_t post = 0; post < 129 * 129; ++post)
    grid.heights.push_back(post % 129 > 110 ? 3000.0f : 0.0f);
  use(std::make_shared<const test::PatchedTerrain>(std::move(grid)));
  auto r = low(90, OcclusionMethod::horizon);
  r.eye = over(0.5, 0.5, 30);
  FrameResult result;
  EXPECT_EQ(lost(r, &result), 0u);
  picture(r, &result);
  EXPECT_FALSE(result.horizon);
  EXPECT_TRUE(renderer.readHorizon(8).empty());
  EXPECT_FALSE(result.occlusion);
  EXPECT_THAT(result.note, testing::EndsWith("there is no horizon."));
}

/// A head that turns at 200 degrees a second in an aircraft at 600 kt, which is put elsewhere now and then.
TEST_F(OcclusionStage, drawsWhatBecomesVisibleInTheFrameInWhichItDoes) {
  for (const bool patches : {false, true}) {
    use(patches ? patchedMountains() : test::syntheticMountains());
    for (const OcclusionMethod method : kMethods) {
      std::mt19937 random(7);
      std::uniform_real_distribution<double> place(0.3, 0.7);
      double east = 0.4, north = 0.4;
      for (int frame = 0; frame < 26; ++frame) {
        if (frame % 13 == 12) east = place(random), north = place(random);
        north += 308.7 / 60 / 46e3;
        auto r = low(200.0 / 60 * frame, method);
        r.eye = over(east, north, 0);
        r.eye.height =
            database->highestWithin(r.eye.latitude, r.eye.longitude, Metres{300}).value_or(r.eye.height) +
            Metres{patches ? -300.0 : 60.0};
        r.eye.height = std::max(r.eye.height, over(east, north, 40).height);
        FrameResult result;
        picture(r, &result);
        std::set<std::uint32_t> drawn;
        for (const TileDraw& tile : result.visible.tiles) drawn.insert(tile.node);
        const auto nodes = renderer.readNodes(true);
        std::size_t missing = 0;
        for (const std::uint32_t node : nodes)
          missing += node != scene::Renderer::kNoNode && !drawn.count(node);
        EXPECT_EQ(missing, 0u) << patches << ' ' << static_cast<int>(method) << ' ' << frame;
      }
    }
  }
}

/// Two runs of the same frames, on machines of any speed.
TEST_F(OcclusionStage, countsTheSameWhenAskedToBeReproducible) {
  use(test::syntheticMountains());
  const auto counts = [&](int idle) {
    scene::Renderer other;
    other.initialize();
    other.setTerrain(database);
    std::vector<std::size_t> all;
    for (int i = 0; i < 16; ++i) {
      auto r = low(3.0 * i, OcclusionMethod::automatic);
      r.reproducible = true;
      r.eye = over(0.4 + 0.002 * i, 0.5, i < 8 ? 60 : 3000);
      const auto result = other.draw(r, offscreen->framebuffer());
      all.insert(all.end(), {result.visible.tiles.size(), result.visible.occluded,
                             static_cast<std::size_t>(result.counters.horizonsBuilt),
                             static_cast<std::size_t>(result.counters.horizonsLeftOut),
                             static_cast<std::size_t>(result.counters.visibleSelected)});
      EXPECT_EQ(result.occlusion, OcclusionMethod::horizon);
      EXPECT_EQ(result.note, "");
      for (int k = 0; k < idle; ++k) renderer.draw(r, offscreen->framebuffer());
    }
    other.release();
    return all;
  };
  EXPECT_EQ(counts(0), counts(1));
}

TEST_F(OcclusionStage, looksForNothingOverAPlainMostOfTheTime) {
  if (!report.software) GTEST_SKIP() << "depends on the machine";
  use(test::syntheticMountains());
  auto r = low(40, OcclusionMethod::automatic);
  r.eye = over(0.5, 0.5, 6000);
  r.attitude.pitch = Degrees{-60};
  FrameResult result;
  int looked = 0;
  constexpr int kFrames = 120;
  for (int i = 0; i < kFrames; ++i) {
    r.eye.height = r.eye.height + Metres{1};
    picture(r, &result);
    looked += result.occlusion.has_value();
  }
  EXPECT_LT(looked, kFrames / 4);
  EXPECT_GE(result.counters.occlusionsLeftOut, static_cast<std::uint64_t>(kFrames - looked));
  EXPECT_EQ(lost(r), 0u);
}

}  // namespace
}  // namespace trimtab
