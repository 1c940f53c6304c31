#include <set>

#include "core/scene/occlusion/occlusion_stage.h"
#include "core/scene/terrain/tiles/tile_ground.h"
#include "patched_terrain.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/units/geodesy.h"

/// Where hidden ground is first looked for, surfaces are made some a frame: nothing is hidden that would not
/// be with all of them, and in the end all is that would.
namespace trimtab {
namespace {

/// The tiles of one eye in a valley, and what looks for those that are hidden from it.
class Looking {
 public:
  explicit Looking(bool atOnce)
      : database_(test::syntheticMountains()), stage_(ground_), index_(database_->index()) {
    ground_.setDatabase(database_);
    ground_.setCut(cut_, number_);
    request_.occlusion = OcclusionMethod::horizon;
    request_.waitForPages = atOnce;
    request_.skips.littleHidden = false;
    request_.levers.drawn.occlusion = OcclusionResolution{400, 300};
    request_.view.widthPx = 640, request_.view.heightPx = 360;
    request_.eye = scene::placeIn(database_->info(), 0.5, 0.5);
    request_.eye.height =
        database_->heightAt(request_.eye.latitude, request_.eye.longitude).value() + Metres{80};
    eye_ = {index_.frame.fromGeodetic(request_.eye),
            eyeAxes(index_.frame, request_.eye, {Degrees{45}, Degrees{-3}, Degrees{0}})};
    selectLevels(index_, eye_.position, {0.2, 1, 640}, cut_);
    number_ = {1, 1, 0.2 / 640};
  }

  /// One flag a tile of the cut: 1 is hidden.
  const std::vector<std::uint8_t>& frame() {
    const std::uint64_t made = ground_.share().made();
    stage_.begin(request_, eye_, false);
    EXPECT_EQ(stage_.result().note, "");
    if (stage_.visibleStays(request_)) {
      counters_ += stage_.counters();
      made_ = ground_.share().made() - made;
      return flags_;
    }
    flags_.assign(cut_.tiles.size(), 0);
    std::copy(stage_.hidden().begin(), stage_.hidden().end(), flags_.begin());
    counters_ += stage_.counters();
    made_ = ground_.share().made() - made;
    return flags_;
  }
  std::uint64_t made() const { return made_; }  ///< surfaces, in the last frame
  std::size_t tiles() const { return cut_.tiles.size(); }
  std::uint64_t horizons() const { return counters_.horizonsBuilt; }
  std::uint64_t selections() const { return counters_.visibleSelected; }

 private:
  std::shared_ptr<const test::SyntheticTerrain> database_;
  scene::TileGround ground_;
  scene::OcclusionStage stage_;
  const TerrainIndex& index_;
  LevelCut cut_;
  scene::CutNumber number_;
  FrameRequest request_;
  FrameCounters counters_;
  EyePose eye_;
  std::vector<std::uint8_t> flags_;
  std::uint64_t made_ = 0;
};

TEST(SurfaceShare, aFrameMakesFewAndInTheEndAsMuchIsHidden) {
  Looking atOnce(true), shared(false);
  const std::vector<std::uint8_t> all = atOnce.frame();
  const auto most = std::count(all.begin(), all.end(), 1);
  ASSERT_GT(most, 0);
  EXPECT_GT(atOnce.made(), 4 * scene::SurfaceShare::kAFrame);
  const auto frames = static_cast<int>(2 * shared.tiles() / scene::SurfaceShare::kAFrame) + 4;
  std::ptrdiff_t hidden = 0;
  for (int i = 0; i < frames; ++i) {
    const std::vector<std::uint8_t>& some = shared.frame();
    EXPECT_LE(shared.made(), scene::SurfaceShare::kAFrame);
    for (std::size_t k = 0; k < some.size(); ++k) EXPECT_LE(some[k], all[k]) << "frame " << i;
    hidden = std::count(some.begin(), some.end(), 1);
  }
  EXPECT_EQ(hidden, most);
  EXPECT_LT(shared.horizons(), 10u);
  // At rest with all that it needs: nothing is done any more.
  const std::uint64_t selections = shared.selections();
  shared.frame();
  EXPECT_EQ(shared.made(), 0u);
  EXPECT_EQ(shared.selections(), selections);
}

class SharedScene : public test::SceneTest {};

TEST_F(SharedScene, drawsWhateverIsVisibleWhileSurfacesAreMade) {
  for (const bool patches : {false, true}) {
    const std::shared_ptr<const terrain::Database> tiles = test::syntheticMountains();
    use(patches ? test::patchedMountains(false) : tiles);
    std::size_t hidden = 0;
    for (int frame = 0; frame < 40; ++frame) {
      if (frame == 0) renderer.setTerrain(database);  // forgets its surfaces
      auto r = request(over(0.45 + 1e-4 * frame, 0.5, 90), {Degrees{9.0 * frame}, Degrees{-3}, Degrees{0}});
      r.terrain.form = patches ? TerrainForm::patches : TerrainForm::tiles;
      r.levers.drawn.occlusion = OcclusionResolution{400, 300};
      r.occlusion = OcclusionMethod::horizon;
      r.levers.drawn.errorPx = 0.5;
      FrameResult result;
      picture(r, &result);
      std::set<std::uint32_t> drawn;
      for (const TileDraw& tile : result.visible.tiles) drawn.insert(tile.node);
      std::size_t missing = 0;
      for (const std::uint32_t node : renderer.readNodes(true))
        missing += node != scene::Renderer::kNoNode && !drawn.count(node);
      EXPECT_EQ(missing, 0u) << patches << ' ' << frame;
      hidden += result.visible.occluded;
    }
    EXPECT_GT(hidden, 0u) << patches;
  }
}

/// Of patches as of tiles: what is known of the nearest hides the boxes of others.
TEST_F(SharedScene, hidesWhileMostSurfacesAreNotMade) {
  for (const bool patches : {false, true}) {
    const std::shared_ptr<const terrain::Database> tiles = test::syntheticMountains();
    use(patches ? test::patchedMountains(false) : tiles);
    std::size_t hidden = 0;
    for (const double east : {0.4, 0.45, 0.5, 0.55}) {
      renderer.setTerrain(database);  // forgets its surfaces
      auto r = request(over(east, 0.5, 60), {Degrees{40}, Degrees{-3}, Degrees{0}});
      r.terrain.form = patches ? TerrainForm::patches : TerrainForm::tiles;
      r.levers.drawn.occlusion = OcclusionResolution{400, 300};
      r.occlusion = OcclusionMethod::horizon;
      r.levers.drawn.errorPx = 0.1;
      r.waitForPages = true;
      r.cullingCase = CullingCase::view_frustum;
      FrameResult result;
      picture(r, &result);
      r.cullingCase = CullingCase::proposed;
      r.waitForPages = false;
      const std::size_t frames = result.tilesInCut / scene::SurfaceShare::kAFrame / 3;
      ASSERT_GT(frames, 3u) << "no place for this test";
      for (std::size_t i = 0; i < frames; ++i) {
        picture(r, &result);
        EXPECT_EQ(result.note, "") << i;
        hidden += result.visible.occluded;
      }
    }
    EXPECT_GT(hidden, 0u) << patches;
  }
}

}  // namespace
}  // namespace trimtab
