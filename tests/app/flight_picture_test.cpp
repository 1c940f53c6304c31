#include "ig_support.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"

/// Flights over real terrain, as trimtab-ig draws them row by row: no hole anywhere, whatever height and
/// speed.
namespace trimtab {
namespace {

constexpr int kWidth = 320, kHeight = 180;

/// In a picture without sky: pixels without terrain below one with terrain, column by column, and those of
/// the lowest row. Level flight makes a column a vertical plane, where a ray below one that meets the ground
/// meets it nearer.
int holes(const std::vector<std::uint8_t>& rgba) {
  const auto isTerrain = [&rgba](int x, int y) {
    const std::uint8_t* p = &rgba[static_cast<std::size_t>(y * kWidth + x) * 4];
    return p[0] != 255 || p[1] != 0 || p[2] != 255;
  };
  int found = 0;
  for (int x = 0; x < kWidth; ++x) {
    bool seen = false;
    for (int y = kHeight - 1; y >= 0; --y) {
      seen |= isTerrain(x, y) || y == 0;
      found += seen && !isTerrain(x, y);
    }
  }
  return found;
}

/// North along a meridian at a height above the highest ground within 2 km, looked up row by row.
std::vector<AircraftState> flightOver(const terrain::Database& database, double aboveFt, double speedMps,
                                      int rows) {
  const terrain::TerrainInfo& info = database.info();
  const double south = info.southWest.latitude.value(), north = info.northEast.latitude.value();
  std::vector<AircraftState> states;
  for (int i = 0; i < rows; ++i) {
    AircraftState state;
    state.time = i * 3.0;
    const double metresNorth = state.time * speedMps;
    state.position.latitude = Degrees{south + 0.15 * (north - south) + metresNorth / 111000};
    state.position.longitude = (info.southWest.longitude + info.northEast.longitude) / 2;
    const auto highest =
        database.highestWithin(state.position.latitude, state.position.longitude, Metres{2000});
    EXPECT_TRUE(highest);
    state.position.height = *highest + Feet{aboveFt}.as<Metres>();
    states.push_back(state);
  }
  return states;
}

void expectNoHole(const char* file) {
  const test::ScratchDir dir;
  terrain::BakeOptions options;
  options.sources = {test::sharedDir() / file};
  options.output = dir / "terrain";
  const auto baked = terrain::bake(options);
  ASSERT_TRUE(baked) << toString(baked.findings());
  const auto offscreen = scene::Offscreen::create(kWidth, kHeight);
  ASSERT_TRUE(offscreen) << toString(offscreen.findings());
  (*offscreen)->makeCurrent();
  scene::Renderer renderer;
  ASSERT_TRUE(renderer.initialize().usable);
  renderer.setTerrain(*baked);
  Session session(defaultParameters());
  session.setGround(*baked);

  const double speeds[] = {200 / 3.6, Knots{600}.as<MetresPerSecond>().value()};
  std::uint64_t drawn = 0;
  for (const double aboveFt : {300.0, 1000.0, 4000.0, 10000.0, 30000.0})
    for (const double speed : speeds) {
      for (const AircraftState& state : flightOver(**baked, aboveFt, speed, 10)) {
        session.fly(state);
        std::optional<FrameRequest> request = session.request(0, kWidth, kHeight);
        request->overlays.showHoles = true;
        const FrameResult result = renderer.draw(*request, (*offscreen)->framebuffer());
        drawn += result.visible.tiles.size();
        EXPECT_EQ(holes(renderer.readPixels(kWidth, kHeight)), 0)
            << aboveFt << " ft, " << speed << " m/s, at " << state.position.latitude.value();
      }
    }
  EXPECT_GT(drawn, 50u);

  // The check itself: what was culled for a look to the south leaves holes when one looks to the north.
  std::optional<FrameRequest> request = session.request(0, kWidth, kHeight);
  request->overlays.showHoles = true;
  const LocalFrame& frame = (*baked)->index().frame;
  request->frozenEye = EyePose{frame.fromGeodetic(request->eye),
                               eyeAxes(frame, request->eye, {Degrees{150}, Degrees{0}, Degrees{0}})};
  renderer.draw(*request, (*offscreen)->framebuffer());
  EXPECT_GT(holes(renderer.readPixels(kWidth, kHeight)), 100);
  renderer.release();
}

TEST(FlightPicture, hasNoHoleOverEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest/N27E086.hgt");
  expectNoHole("data/dem-srtm3-everest/N27E086.hgt");
}

TEST(FlightPicture, hasNoHoleOverFuji) {
  TRIMTAB_NEEDS_SHARED("data/dem-osgearth-fuji/mt_fuji_90m.tif");
  expectNoHole("data/dem-osgearth-fuji/mt_fuji_90m.tif");
}

}  // namespace
}  // namespace trimtab
