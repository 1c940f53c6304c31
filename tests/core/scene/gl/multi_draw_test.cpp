#include "core/scene/gl/multi_draw.h"

#include <random>

#include "core/scene/gl/gl_api.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/gl_report.h"

namespace trimtab {
namespace {

using scene::DrawWay;
constexpr std::array kWays{DrawWay::indirect, DrawWay::base_vertex, DrawWay::loop};

class MultiDraw : public test::SceneTest {
 protected:
  /// Views of all kinds in every form that the terrain has, with each overlay that draws in another way.
  std::vector<FrameRequest> views(TerrainForm form) const {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(0.2, 0.8), unit(0, 1);
    std::vector<FrameRequest> all;
    for (int i = 0; i < 6; ++i) {
      auto r =
          request(over(place(random), place(random), 60 * std::pow(60, unit(random))),
                  {Degrees{360 * unit(random)}, Degrees{10 - 50 * unit(random)}, Degrees{20 * unit(random)}});
      r.terrain.form = form;
      r.waitForPages = true;
      r.levers.drawn.occlusion = OcclusionResolution{320, 240};
      r.overlays.colourByLevel = i == 3;
      r.overlays.wireframe = i == 4;
      r.overlays.colourByReason = i == 5;
      all.push_back(r);
    }
    return all;
  }
  struct Shown {
    std::vector<std::uint8_t> picture;
    std::vector<std::uint32_t> nodes;
    friend bool operator==(const Shown&, const Shown&) = default;
  };
  std::vector<Shown> drawnBy(DrawWay way, TerrainForm form) {
    const scene::ForcedDrawWay forced(way);
    const scene::GlReport gl = renderer.initialize();
    EXPECT_TRUE(gl.usable);
    EXPECT_NE(gl.drawing.find("as asked for"), std::string::npos) << gl.drawing;
    std::vector<Shown> all;
    for (const FrameRequest& r : views(form)) {
      Shown shown{picture(r), {}};
      shown.nodes = renderer.readNodes();
      all.push_back(std::move(shown));
    }
    return all;
  }
  void compareWays(TerrainForm form) {
    const std::vector<Shown> reference = drawnBy(DrawWay::loop, form);
    for (std::size_t i = 1; i < reference.size(); ++i)
      EXPECT_GT(differing(reference[i].picture, reference[0].picture), 1000u)
          << "view " << i << " shows nothing";
    for (const DrawWay way : kWays) {
      const std::vector<Shown> shown = drawnBy(way, form);
      for (std::size_t i = 0; i < shown.size(); ++i)
        EXPECT_TRUE(shown[i] == reference[i]) << "way " << static_cast<int>(way) << ", view " << i;
    }
  }
};

TEST_F(MultiDraw, namesTheWayThatThisContextGets) {
  EXPECT_FALSE(report.drawing.empty());
  EXPECT_EQ(report.drawing, scene::drawChoiceOfContext().reason);
  if (report.software) {
    EXPECT_EQ(scene::drawChoiceOfContext().way, DrawWay::base_vertex);
  }
}

TEST_F(MultiDraw, drawsTheSamePictureOfTilesEachWay) {
  use(test::syntheticMountains());
  compareWays(TerrainForm::tiles);
}

TEST_F(MultiDraw, drawsTheSamePictureOfPatchesEachWay) {
  use(test::patchedMountains(false));
  compareWays(TerrainForm::patches);
}

TEST_F(MultiDraw, drawsTheSamePictureOfTreesEachWay) {
  use(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  compareWays(TerrainForm::static_trees);
}

TEST_F(MultiDraw, makesCommandsAnewOnlyForOtherNodesOrOtherPlaces) {
  offscreen->makeCurrent();
  std::vector<TileDraw> nodes{{1}, {2, BorderMask(3)}, {7, BorderMask(15)}};
  for (const DrawWay way : kWays) {
    scene::MultiDraw draw(way);
    EXPECT_FALSE(draw.begin({}, 0)) << "nothing is what it begins with";
    EXPECT_TRUE(draw.begin(nodes, 1));
    draw.add(0, 6, 0);
    EXPECT_FALSE(draw.begin(nodes, 1));
    EXPECT_EQ(draw.size(), 1u);
    EXPECT_TRUE(draw.begin(nodes, 2));
    EXPECT_EQ(draw.size(), 0u);
    auto other = nodes;
    other[1].border = BorderMask(2);
    EXPECT_TRUE(draw.begin(other, 2));
    EXPECT_TRUE(draw.begin(std::span(other).first(2), 2));
    std::swap(other[0], other[1]);
    EXPECT_TRUE(draw.begin(std::span(other).first(2), 2)) << "order counts";
    EXPECT_EQ(draw.made(), 5u);
  }
}

/// Pixels of a triangle that shows its back, drawn once as it is and once from both sides.
TEST_F(MultiDraw, drawsFromBothSidesWhatIsToBeAndLeavesFaceCullingAsItWas) {
  offscreen->makeCurrent();
  glBindFramebuffer(GL_FRAMEBUFFER, offscreen->framebuffer());
  glViewport(0, 0, kWidth, kHeight);
  glDisable(GL_DEPTH_TEST);
  const std::array<float, 6> corners{-1, -1, -1, 1, 1, -1};
  const std::array<std::uint16_t, 3> indices{0, 1, 2};
  unsigned array = 0, query = 0;
  std::array<unsigned, 2> buffers{};
  glGenVertexArrays(1, &array);
  glGenBuffers(2, buffers.data());
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glEnableVertexAttribArray(0);
  glGenQueries(1, &query);
  const auto pixels = [&](DrawWay way, bool oneSided) {
    scene::MultiDraw draw(way);
    EXPECT_TRUE(draw.begin(std::array<TileDraw, 2>{{{1}, {2}}}, 1));
    draw.add(0, 3, 0, true);
    draw.add(0, 3, 0);
    (oneSided ? glEnable : glDisable)(GL_CULL_FACE);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    draw.draw(array, GL_UNSIGNED_SHORT);
    glEndQuery(GL_SAMPLES_PASSED);
    EXPECT_EQ(glIsEnabled(GL_CULL_FACE) == GL_TRUE, oneSided);
    unsigned passed = 0;
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &passed);
    return passed;
  };
  for (const DrawWay way : kWays) {
    const unsigned one = pixels(way, true);
    EXPECT_NEAR(one, kWidth * kHeight / 2, kWidth + kHeight);
    EXPECT_EQ(pixels(way, false), 2 * one);
  }
  glDeleteQueries(1, &query);
  glDeleteBuffers(2, buffers.data());
  glDeleteVertexArrays(1, &array);
}

}  // namespace
}  // namespace trimtab
