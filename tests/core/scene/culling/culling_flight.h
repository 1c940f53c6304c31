#pragma once

#include <array>
#include <cmath>
#include <random>
#include <span>
#include <string>

#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"

namespace trimtab::test {

/// Flies the three culling cases over a terrain: their pictures must be equal, whatever proves tiles hidden.
class CullingFlight : public SceneTest {
 protected:
  static constexpr std::array<OcclusionResolution, 6> kSizes{
      {{64, 48}, {320, 240}, {400, 300}, {640, 480}, {800, 600}, {33, 77}}};

  struct Tally {
    int views = 0, viewsOverFifth = 0;
    int served = 0;  ///< views in which the method tested for hidden tiles
    std::size_t differing = 0, frustum = 0, proposed = 0;
  };

  CullingFlight(OcclusionMethod method, double lowestM) : method_(method), lowestM_(lowestM) {}

  void compare(FrameRequest r, OcclusionResolution size, Tally& tally) {
    FrameResult frustum, proposed;
    r.levers.drawn.occlusion = size;
    r.occlusion = method_;
    r.cullingCase = CullingCase::none;
    const auto whole = picture(r);
    r.cullingCase = CullingCase::view_frustum;
    const std::size_t frustumDiffers = differing(whole, picture(r, &frustum));
    r.cullingCase = CullingCase::proposed;
    tally.differing += differing(whole, picture(r, &proposed));
    EXPECT_EQ(frustumDiffers, 0u) << "view " << tally.views;
    EXPECT_LE(proposed.visible.tiles.size(), frustum.visible.tiles.size());
    const bool horizon = method_ == OcclusionMethod::horizon;
    if (horizon) {
      EXPECT_EQ(proposed.visible.tiles.size() + proposed.visible.occluded, frustum.visible.tiles.size());
      EXPECT_FALSE(proposed.depthMap.has_value());
    }
    ++tally.views;
    tally.served += horizon ? proposed.horizon : proposed.depthMap.has_value();
    tally.frustum += frustum.visible.tiles.size();
    tally.proposed += proposed.visible.tiles.size();
    tally.viewsOverFifth += proposed.visible.occluded * 5 > frustum.visible.tiles.size();
  }

  /// Flights along valleys and above, any attitude, every size; lopsided and narrow views too.
  Tally fly(int views, unsigned seed, std::span<const OcclusionResolution> sizes = kSizes) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0.15, 0.85), unit(0, 1);
    Tally tally;
    for (int i = 0; i < views * soak(); ++i) {
      // Up to 9,000 m above the ground, most of them low, where much is hidden.
      const double above = lowestM_ * std::pow(9000 / lowestM_, std::pow(unit(random), 2.5));
      const double pitch = i % 7 == 3 ? -75 + 30 * unit(random) : -20 + 25 * unit(random);
      const double roll = i % 3 == 0 ? 360 * unit(random) : 0;
      const auto east = place(random), north = place(random);
      auto r =
          request(over(east, north, above), {Degrees{360 * unit(random)}, Degrees{pitch}, Degrees{roll}});
      if (i % 5 == 4) r.view.left = -0.2, r.view.right = 0.9, r.view.bottom = -0.6, r.view.top = 0.1;
      if (i % 11 == 7) r.view.left = -0.02, r.view.right = 0.02, r.view.bottom = -0.01, r.view.top = 0.01;
      r.levers.drawn.errorPx = i % 4 == 0 ? 6.0 : i % 4 == 1 ? 0.5 : 2.0;
      compare(r, sizes[static_cast<std::size_t>(i) % sizes.size()], tally);
    }
    std::printf("%d views: %zu tiles by frustum, %zu proposed, %d tested, %d leave out over a fifth\n",
                tally.views, tally.frustum, tally.proposed, tally.served, tally.viewsOverFifth);
    return tally;
  }

  /// What stands in the way of the method where the eye sees too much, in the result's words.
  void expectReasons() {
    const auto note = [this](const GeodeticPosition& eye) {
      auto r = request(eye, {Degrees{270}, Degrees{-5}, Degrees{0}});
      r.levers.drawn.occlusion = OcclusionResolution{320, 240};
      r.occlusion = method_;
      const auto result = renderer.draw(r, offscreen->framebuffer());
      EXPECT_EQ(method_ == OcclusionMethod::horizon ? result.horizon : result.depthMap.has_value(),
                result.note.empty());
      EXPECT_TRUE(result.note.empty() || result.visible.occluded == 0);
      return result.note;
    };
    EXPECT_EQ(note(over(0.5, 0.5, 300)), "");
    EXPECT_EQ(note(over(0.5, 0.5, -30)), "The eye is under the ground.");
    EXPECT_EQ(note(over(0.5, 0.5, 0.2)), "The eye is too near the ground.");
    auto beside = over(0.5, 0.5, 3000);
    beside.longitude = beside.longitude + Degrees{0.6};
    EXPECT_EQ(note(beside), "The eye is not over the terrain.");
  }

 private:
  OcclusionMethod method_;
  double lowestM_;
};

}  // namespace trimtab::test
