#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "culling_truth.h"
#include "tests/core/scene/terrain/patched_terrain.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/units/not_finite.h"

/// Views that no aircraft has and terrains that nobody bakes: nothing crashes, what is left out has no pixel,
/// and the next picture is as if they had never been.
namespace trimtab {
namespace {

/// Nothing at all, or static trees alone.
class BareTerrain final : public terrain::Database {
 public:
  explicit BareTerrain(std::shared_ptr<const terrain::StaticLodTerrain> trees = {})
      : trees_(std::move(trees)) {
    index_.frame = trees_ ? trees_->index.frame : LocalFrame({Degrees{36.4}, Degrees{128.1}, Metres{0}});
    info_.name = "bare";
    info_.southWest = {Degrees{36.4}, Degrees{128.1}, Metres{0}};
    info_.northEast = {Degrees{36.41}, Degrees{128.11}, Metres{0}};
    info_.columns = info_.rows = 2;
    info_.postLongitude = info_.postLatitude = Degrees{0.01};
  }
  const terrain::TerrainInfo& info() const override { return info_; }
  const TerrainIndex& index() const override { return index_; }
  void buildTile(std::uint32_t, terrain::TileMesh&) const override {}
  std::optional<Metres> heightAt(Degrees, Degrees) const override { return {}; }
  std::optional<Metres> highestWithin(Degrees, Degrees, Metres) const override { return {}; }
  std::shared_ptr<const terrain::StaticLodTerrain> staticLod() const override { return trees_; }

 private:
  std::shared_ptr<const terrain::StaticLodTerrain> trees_;
  TerrainIndex index_;
  terrain::TerrainInfo info_;
};

std::shared_ptr<const terrain::Database> oneTriangle() {
  terrain::SceneryMesh mesh;
  mesh.name = "one";
  mesh.materials = {"Grass"};
  for (const auto& [latitude, longitude] : {std::pair{36.401, 128.101}, {36.401, 128.109}, {36.409, 128.105}})
    mesh.vertices.push_back(toEcef({Degrees{latitude}, Degrees{longitude}, Metres{100}}));
  mesh.triangles.push_back({{0, 1, 2}, 0});
  terrain::StaticLodOptions options;
  options.trianglesPerNode = 1;
  const LocalFrame frame({Degrees{36.405}, Degrees{128.105}, Metres{0}});
  auto trees = terrain::buildStaticLod({&mesh, 1}, frame, options);
  EXPECT_TRUE(trees) << toString(trees.findings());
  return std::make_shared<const BareTerrain>(trees.value());
}

/// Patches, and tiles where there are cells enough for one, of ground that is a little rough.
std::shared_ptr<const terrain::Database> ofPosts(int posts) {
  const auto height = [](int column, int row) {
    return 100 + 30 * std::sin(column * 0.7) * std::cos(row * 0.5);
  };
  terrain::HeightGrid grid;
  const auto side = static_cast<std::uint32_t>(posts);
  grid.posts = {128.1, 36.4, 1.0 / 1200, 1.0 / 1200, side, side};
  for (int row = 0; row < posts; ++row)
    for (int column = 0; column < posts; ++column)
      grid.heights.push_back(static_cast<float>(height(column, row)));
  std::shared_ptr<const terrain::Database> tiles;
  if (posts == TerrainIndex::kTileCells + 1)
    tiles = std::make_shared<const test::SyntheticTerrain>(
        1, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, height);
  return std::make_shared<const test::PatchedTerrain>(std::move(grid), tiles);
}

class DegenerateViews : public test::CullingTruth {
 protected:
  static constexpr OcclusionResolution kBand{320, 240};

  struct Case {
    std::string name;
    FrameRequest request;
  };
  std::vector<Case> cases(const FrameRequest& good) const {
    std::vector<Case> all;
    const auto add = [&](const char* name, const std::function<void(FrameRequest&)>& change) {
      all.push_back({name, good});
      change(all.back().request);
    };
    using R = FrameRequest;
    add("no field of view", [](R& r) { r.view.left = r.view.right = r.view.bottom = r.view.top = 0; });
    add("no width", [](R& r) { r.view.left = r.view.right = 0; });
    add("no height", [](R& r) { r.view.bottom = r.view.top = 0.1; });
    add("field of view turned round", [](R& r) { std::swap(r.view.left, r.view.right); });
    add("field of view beside the axis", [](R& r) { r.view.left = 2, r.view.right = 2.5; });
    add("half the sky", [](R& r) { r.view.left = -1e6, r.view.right = 1e6; });
    add("an endless field of view", [](R& r) { r.view.left = -kInfinity, r.view.right = kInfinity; });
    add("field of view not a number",
        [](R& r) { r.view.left = r.view.right = r.view.bottom = r.view.top = kNan; });
    for (const double near : {0.0, -1.0, 1e-30, 1e7, kNan, kInfinity})
      add("near plane", [near](R& r) { r.view.nearM = near; });
    for (const double angle : {kNan, kInfinity, -kInfinity, 1e300, 7e5}) {
      add("heading", [angle](R& r) { r.attitude.heading = Degrees{angle}; });
      add("pitch", [angle](R& r) { r.attitude.pitch = Degrees{angle}; });
      add("roll", [angle](R& r) { r.attitude.roll = Degrees{angle}; });
      add("all angles", [angle](R& r) { r.attitude = {Degrees{angle}, Degrees{angle}, Degrees{angle}}; });
    }
    for (const double pitch : {90.0, -90.0, 180.0})
      add("straight", [pitch](R& r) { r.attitude = {Degrees{}, Degrees{pitch}, Degrees{}}; });
    for (const double place : {kNan, kInfinity, -kInfinity, 1e300}) {
      add("latitude", [place](R& r) { r.eye.latitude = Degrees{place}; });
      add("longitude", [place](R& r) { r.eye.longitude = Degrees{place}; });
      add("height", [place](R& r) { r.eye.height = Metres{place}; });
      add("place", [place](R& r) { r.eye = {Degrees{place}, Degrees{place}, Metres{place}}; });
    }
    for (const double latitude : {90.0, -90.0})
      for (const double height : {0.0, 1e4, -6.3e6, -6.4e6})
        add("pole", [=](R& r) { r.eye.latitude = Degrees{latitude}, r.eye.height = Metres{height}; });
    for (const double height : {-1e9, -1e5, -9000.0, -100.0, 0.0, 1.0, 3e4, 1e6, 1e9, 1e15})
      for (const double pitch : {0.0, -90.0})
        add("height", [=](R& r) { r.eye.height = Metres{height}, r.attitude.pitch = Degrees{pitch}; });
    add("at the ground", [this](R& r) { r.eye = over(0.5, 0.5, 0); });
    add("inside a tile's box", [this](R& r) { r.eye = over(0.51, 0.49, -3); });
    add("a hand above", [this](R& r) { r.eye = over(0.5, 0.5, 0.05); });
    add("the corner", [this](R& r) { r.eye = over(0, 0, 30); });
    add("the border", [this](R& r) { r.eye = over(1, 0.4, 30), r.attitude.heading = Degrees{270}; });
    for (const double away : {1.2, 4.0, 60.0, 500.0})
      for (const double above : {-200.0, 100.0, 9000.0})
        add("beside the data", [=, this](R& r) {
          r.eye = over(0.5, 0.5, 0);
          r.eye.longitude =
              wrapped180(database->info().southWest.longitude + scene::widthOf(database->info()) * away);
          r.eye.height = Metres{above};
          r.attitude = {Degrees{270}, Degrees{-2}, Degrees{}};
        });
    add("the other side of the earth", [](R& r) {
      r.eye = {Degrees{-36.4}, Degrees{-51.5}, Metres{1000}};
      r.attitude.pitch = Degrees{-90};
    });
    for (const double error : {0.0, 1e-12, 1e12, kInfinity, kNan, -1.0})
      add("error of levels", [error](R& r) { r.levers.drawn.errorPx = r.levers.drawn.treeErrorPx = error; });
    for (const double scale : {1e-9, 1e9, kNan})
      add("scale of levels", [scale](R& r) { r.levers.drawn.lodScale = scale; });
    for (const double far : {0.0, 1e-3, kNan})
      add("visibility", [far](R& r) {
        r.decision.weather = {.fogged = true, .visibilityM = far, .extinctionPerM = 1e-3, .farM = far};
        r.levers.drawn.farM = r.decision.weather.farM;
      });
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 720}, {1280, 1}})
      add("picture", [=](R& r) { r.view.widthPx = width, r.view.heightPx = height; });
    return all;
  }

  /// Draws each by every way there is. What a picture shows must be what the unculled one shows.
  void drawAll(TerrainForm form, const std::vector<Case>& all, const FrameRequest& good) {
    useForm(form);
    std::vector<std::uint8_t> first;
    std::size_t seen = 0;
    for (const auto& [name, request] : all) {
      SCOPED_TRACE(name + ": " + describe(request));
      auto whole = request;
      whole.terrain.form = form;
      whole.cullingCase = CullingCase::none;
      const auto unculled = picture(whole);
      const auto nodes = renderer.readNodes();
      for (const std::uint32_t node : nodes) seen += node != scene::Renderer::kNoNode;
      const auto compare = [&](CullingCase culling, OcclusionMethod method, const char* how) {
        auto r = whole;
        r.cullingCase = culling;
        r.occlusion = method;
        r.levers.drawn.occlusion = kBand;
        ASSERT_EQ(differing(unculled, picture(r)), 0u) << how;
        ASSERT_EQ(renderer.readNodes(), nodes) << how;
      };
      compare(CullingCase::view_frustum, OcclusionMethod::horizon, "view_frustum");
      for (const auto& [method, how] : test::occlusionChoices()) compare(CullingCase::proposed, method, how);
      // Nothing of it stays behind, whatever is kept from frame to frame.
      auto after = good;
      after.terrain.form = form;
      after.levers.drawn.occlusion = kBand;
      for (const OcclusionMethod method : {OcclusionMethod::automatic, OcclusionMethod::horizon}) {
        after.occlusion = method;
        const auto again = picture(after);
        if (first.empty()) {
          after.cullingCase = CullingCase::none;
          first = picture(after);
          after.cullingCase = CullingCase::proposed;
        }
        ASSERT_EQ(differing(first, again), 0u) << "the next view";
      }
    }
    EXPECT_GT(seen, 1000u) << "hardly anything was looked at";
  }
  void drawAll(TerrainForm form) {
    auto good = viewOf(over(0.5, 0.5, 300), {Degrees{270}, Degrees{-5}, Degrees{}});
    good.view.widthPx /= 2, good.view.heightPx /= 2;
    drawAll(form, cases(good), good);
  }
};

TEST_F(DegenerateViews, ofTilesShowWhatIsThere) {
  use(test::syntheticMountains());
  drawAll(TerrainForm::tiles);
}

TEST_F(DegenerateViews, ofPatchesShowWhatIsThere) {
  use(test::patchedMountains(false));
  drawAll(TerrainForm::patches);
}

TEST_F(DegenerateViews, ofStaticTreesShowWhatIsThere) {
  use(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  drawAll(TerrainForm::static_trees);
}

TEST_F(DegenerateViews, ofTinyTerrainsShowWhatIsThere) {
  struct Tiny {
    const char* name;
    std::shared_ptr<const terrain::Database> terrain;
    std::vector<TerrainForm> forms;
  };
  const Tiny kTiny[] = {
      {"one tile", ofPosts(TerrainIndex::kTileCells + 1), {TerrainForm::tiles, TerrainForm::patches}},
      {"four posts", ofPosts(2), {TerrainForm::patches}},
      {"one triangle", oneTriangle(), {TerrainForm::static_trees}},
  };
  for (const auto& [name, terrain, forms] : kTiny) {
    SCOPED_TRACE(name);
    use(terrain);
    for (const TerrainForm form : forms) {
      useForm(form);
      std::vector<Case> all;
      FrameRequest good = viewOf(over(0.5, 0.5, 400), {Degrees{}, Degrees{-90}, Degrees{}});
      good.eye.height = Metres{500};
      good.view.widthPx /= 2, good.view.heightPx /= 2;
      for (const double height : {-500.0, 100.0, 101.0, 130.0, 500.0, 3e4, 1e9})
        for (const double pitch : {-90.0, -30.0, 0.0, 80.0})
          for (const double east : {0.5, 0.0, -3.0}) {
            auto r = good;
            r.eye = over(east, 0.5, 0);
            r.eye.height = Metres{height};
            r.attitude = {Degrees{90}, Degrees{pitch}, Degrees{}};
            all.push_back({"tiny", r});
          }
      drawAll(form, all, good);
    }
  }
}

TEST_F(DegenerateViews, ofNoTerrainAreSky) {
  use(std::make_shared<const BareTerrain>());
  const auto good = viewOf(over(0.5, 0.5, 300), {Degrees{270}, Degrees{-5}, Degrees{}});
  for (const auto& [name, request] : cases(good))
    for (const auto& choice : test::occlusionChoices()) {
      auto r = request;
      r.occlusion = choice.method;
      r.levers.drawn.occlusion = kBand;
      FrameResult result;
      picture(r, &result);
      ASSERT_TRUE(result.visible.tiles.empty()) << name;
      ASSERT_FALSE(result.occlusion) << name;
    }
}

TEST_F(DegenerateViews, withoutAPictureDrawNothing) {
  use(test::syntheticMountains());
  auto r = viewOf(over(0.5, 0.5, 300), {});
  for (const auto& [width, height] : {std::pair{0, 0}, {0, 720}, {1280, 0}, {-4, 100}}) {
    r.view.widthPx = width, r.view.heightPx = height;
    const auto result = renderer.draw(r, offscreen->framebuffer());
    EXPECT_TRUE(result.visible.tiles.empty());
    EXPECT_TRUE(renderer.readNodes().empty()) << "there never was a picture";
  }
}

}  // namespace
}  // namespace trimtab
