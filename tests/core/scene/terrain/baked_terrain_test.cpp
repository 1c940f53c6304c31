#include <cmath>
#include <fstream>
#include <thread>

#include "patched_terrain.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/store.h"

/// What only a terrain that lies on a disk, or anywhere on the earth, can show.
namespace trimtab {
namespace {

namespace fs = std::filesystem;

class BakedScene : public test::SceneTest {
 protected:
  /// 34 km of mountains, eastward from a place.
  void bakeAt(double west) {
    test::RasterRecipe recipe;
    recipe.columns = recipe.rows = 401;
    recipe.west = west, recipe.north = 50, recipe.step = 1.0 / 1200;
    recipe.value = [](int column, int row, int) { return test::mountains(column, row); };
    const auto baked = test::bakeInto(dir, test::writeRaster(dir / "mountains.tif", recipe));
    ASSERT_TRUE(baked) << toString(baked.findings());
    use(baked.value());
  }
  FrameRequest patches(double east, double north, double aboveM, const Attitude& attitude) const {
    auto r = request(over(east, north, aboveM), attitude);
    r.terrain.form = TerrainForm::patches;
    r.waitForPages = true;
    r.levers.drawn.occlusion = OcclusionResolution{320, 240};
    r.occlusion = OcclusionMethod::horizon;
    return r;
  }
  test::ScratchDir dir;
};

TEST_F(BakedScene, cullsAcrossTheDateLineAsAnywhere) {
  bakeAt(179.85);
  ASSERT_LT(database->info().northEast.longitude, database->info().southWest.longitude);
  std::size_t hidden = 0, served = 0;
  for (int i = 0; i < 12; ++i) {
    auto r = patches(0.3 + 0.04 * i, 0.6, 60, {Degrees{30.0 * i}, Degrees{-3}, Degrees{}});
    r.levers.drawn.errorPx = 0.05;
    FrameResult result;
    r.cullingCase = CullingCase::none;
    const auto whole = picture(r, &result);
    for (const CullingCase method : {CullingCase::view_frustum, CullingCase::proposed}) {
      r.cullingCase = method;
      EXPECT_EQ(differing(picture(r, &result), whole), 0u) << "view " << i;
    }
    served += result.horizon;
    EXPECT_EQ(result.note, "") << "view " << i;
    hidden += result.visible.occluded;
  }
  EXPECT_EQ(served, 12u);
  EXPECT_GT(hidden, 20u);
}

TEST_F(BakedScene, theGroundsTextureShrinksWithTheLodScaleOnlyWhereAsked) {
  bakeAt(10);
  auto r = patches(0.5, 0.5, 900, {Degrees{40}, Degrees{-40}, Degrees{}});
  const auto drawn = [&](double scale, bool texture) {
    r.levers.drawn.lodScale = scale;
    r.levers.drawn.errorPx = 2 / scale;  // the same triangles at any scale
    r.scaleTexture = texture;
    return picture(r);
  };
  // How much neighbouring pixels differ: a coarser texture is smoother.
  const auto contrast = [&](const std::vector<std::uint8_t>& rgba) {
    double sum = 0;
    for (std::size_t i = 4; i < rgba.size(); ++i) sum += std::abs(int{rgba[i]} - int{rgba[i - 4]});
    return sum;
  };
  const auto fine = drawn(1, false);
  EXPECT_EQ(differing(drawn(1, true), fine), 0u) << "full detail";
  EXPECT_EQ(differing(drawn(4, false), fine), 0u) << "geometry alone follows the scale";
  const auto half = drawn(2, true);
  EXPECT_GT(differing(half, fine), 1000u);
  EXPECT_LT(contrast(half), 0.98 * contrast(fine));
}

TEST_F(BakedScene, damagedGroundIsShownCoarserAndToldOf) {
  bakeAt(10);
  const auto r = patches(0.5, 0.5, 900, {Degrees{40}, Degrees{-40}, Degrees{}});
  const auto whole = picture(r);
  const fs::path file = dir / "db" / terrain::kGroundName;
  {
    const auto pages = terrain::PageFile::open(file);
    ASSERT_TRUE(pages);
    const auto blob = pages.value()->read(terrain::groundKey(0, 0, 0));
    ASSERT_TRUE(blob);
    const std::vector<char> bytes(reinterpret_cast<const char*>(blob->data()),
                                  reinterpret_cast<const char*>(blob->data()) + blob->size());
    std::ifstream in(file, std::ios::binary);
    std::vector<char> all{std::istreambuf_iterator<char>(in), {}};
    in.close();
    const auto at = std::search(all.begin(), all.end(), bytes.begin(), bytes.end());
    ASSERT_NE(at, all.end());
    at[static_cast<std::ptrdiff_t>(bytes.size() / 2)] ^= 0x10;
    // Whoever has it mapped keeps the file that it was.
    fs::remove(file);
    std::ofstream(file, std::ios::binary).write(all.data(), static_cast<std::streamsize>(all.size()));
  }
  for (const bool waits : {true, false}) {
    const auto opened = terrain::Database::open(dir / "db");
    ASSERT_TRUE(opened) << toString(opened.findings());
    use(opened.value());
    auto request = r;
    request.waitForPages = waits;
    FrameResult result;
    for (int frame = 0; frame < 2000 && (frame == 0 || !result.paging.settled); ++frame) {
      picture(request, &result);
      if (!waits) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(result.paging.settled);
    EXPECT_EQ(result.paging.failed, 1u);
    ASSERT_EQ(renderer.pageFailures().size(), 1u);
    EXPECT_NE(toString(renderer.pageFailures()).find(terrain::kGroundName), std::string::npos);
    const auto damaged = picture(request);
    std::size_t far = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) far += std::abs(int{whole[i]} - int{damaged[i]}) > 40;
    EXPECT_LT(far, whole.size() / 20) << "the same ground, less sharp";
  }
}

}  // namespace
}  // namespace trimtab
