#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/core/scene/scene_test.h"
#include "tests/core/terrain/scenery/scenery_tiles.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/terrain/bake/bake.h"

/// A road through snow, in pictures: line features survive to the distance at which they are narrower than a
/// pixel.
namespace trimtab {
namespace {

constexpr double kWest = 7, kSouth = 50.5, kWide = 0.25, kHigh = 0.125;
constexpr double kMetresADegree = 111230, kRoadM = 24, kRoadLatitude = kSouth + kHigh * 0.51;

double hills(double longitude, double latitude) {
  return 300 + 14 * std::sin(longitude * 260) * std::cos(latitude * 300) + 4 * std::sin(longitude * 1900);
}

/// A tile of cells of snow, and one row of them, as high as the road is wide, of road.
std::string snowWithARoad() {
  constexpr int kColumns = 96, kRows = 48;
  test::BtgWriter writer(7);
  std::vector<double> latitudes{kRoadLatitude - kRoadM / 2 / kMetresADegree,
                                kRoadLatitude + kRoadM / 2 / kMetresADegree};
  for (int r = 0; r <= kRows; ++r) latitudes.push_back(kSouth + kHigh * r / kRows);
  std::sort(latitudes.begin(), latitudes.end());
  std::vector<GeodeticPosition> places;
  for (const double latitude : latitudes)
    for (int c = 0; c <= kColumns; ++c) {
      const double longitude = kWest + kWide * c / kColumns;
      places.push_back({Degrees{latitude}, Degrees{longitude}, Metres{hills(longitude, latitude)}});
    }
  writer.places(places);
  writer.object(3, {}, {std::string(places.size() * 8, '\0')});
  for (const bool road : {false, true}) {
    std::string triangles;
    for (std::size_t r = 0; r + 1 < latitudes.size(); ++r) {
      const bool isRoad = latitudes[r] < kRoadLatitude && latitudes[r + 1] > kRoadLatitude;
      for (std::size_t c = 0; isRoad == road && c < kColumns; ++c) {
        const std::size_t sw = r * (kColumns + 1) + c, nw = sw + kColumns + 1;
        for (const std::size_t v : {sw, sw + 1, nw + 1, sw, nw + 1, nw})
          triangles += writer.count(v) + writer.count(v);
      }
    }
    writer.object(10, {{0, road ? "Road" : "SnowCover"}, {1, std::string(1, '\x9')}}, {triangles});
  }
  return writer.bytes();
}

class LineFeatures : public test::SceneTest {
 protected:
  void bakeRoad(bool keepLines) {
    terrain::BakeOptions options;
    test::writeFile(dir_ / "3072816.btg", snowWithARoad());
    options.sources = {dir_ / "3072816.btg"};
    options.output = dir_ / (keepLines ? "kept" : "published");
    options.keepLines = keepLines;
    options.trianglesPerNode = 500;
    const auto baked = terrain::bake(options);
    ASSERT_TRUE(baked) << toString(baked.findings());
    use(baked.value());
  }

  FrameRequest from(double east, double north, double aboveM, const Attitude& attitude,
                    TerrainForm form) const {
    auto r = request(over(east, north, aboveM), attitude);
    r.terrain.form = form;
    r.waitForPages = true;
    r.cullingCase = CullingCase::view_frustum;
    return r;
  }

  struct Seen {
    int places = 0, road = 0;
    double narrowestPx = 1e9, widestLostPx = 0;
  };
  /// Places of the road that the picture must show: where it is at least `leastPx` wide. There the strongest
  /// pixel nearby has so much of the road's colour; the land's own is the picture's median.
  Seen look(const FrameRequest& r, double leastPx = 1) {
    const auto rgba = picture(r);
    std::vector<int> reds;
    for (std::size_t i = 0; i < rgba.size(); i += 4) reds.push_back(rgba[i]);
    const auto middle = reds.begin() + static_cast<std::ptrdiff_t>(reds.size() / 2);
    std::nth_element(reds.begin(), middle, reds.end());
    const double snow = *middle;
    Seen seen;
    for (int i = 0; i < 4000; ++i) {
      const double longitude = kWest + kWide * (0.02 + 0.96 * (i + 0.5) / 4000);
      const auto middleOf = pixelOf(r, longitude, kRoadLatitude), south = pixelOf(r, longitude, edge(-1)),
                 north = pixelOf(r, longitude, edge(1)), next = pixelOf(r, longitude + 1e-5, kRoadLatitude);
      if (!middleOf || !south || !north || !next) continue;
      // Across the road's direction in the picture.
      const double dx = next->x - middleOf->x, dy = next->y - middleOf->y;
      const double width =
          std::abs((north->x - south->x) * dy - (north->y - south->y) * dx) / std::hypot(dx, dy);
      constexpr double kEdge = 5;
      if (width < leastPx || middleOf->x < kEdge || middleOf->y < kEdge ||
          middleOf->x > r.view.widthPx - kEdge || middleOf->y > r.view.heightPx - kEdge)
        continue;
      double strongest = 0;
      for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x) {
          const auto column = static_cast<std::size_t>(middleOf->x + x),
                     row = static_cast<std::size_t>(middleOf->y + y);
          const double red = rgba[(row * static_cast<std::size_t>(r.view.widthPx) + column) * 4];
          strongest = std::max(strongest, (snow - red) / (snow * (1 - roadToSnow_)));
        }
      ++seen.places;
      seen.road += strongest > 0.4;
      seen.narrowestPx = std::min(seen.narrowestPx, width);
      if (strongest <= 0.4) seen.widestLostPx = std::max(seen.widestLostPx, width);
    }
    return seen;
  }

  /// How dark the road is by the snow, from so near that both are broad.
  void measureColours(TerrainForm form) {
    const auto rgba = picture(from(0.5, 0.51, 150, {Degrees{0}, Degrees{-90}, Degrees{}}, form));
    std::vector<int> reds;
    for (std::size_t i = 0; i < rgba.size(); i += 4) reds.push_back(rgba[i]);
    const auto [road, snow] = std::minmax_element(reds.begin(), reds.end());
    roadToSnow_ = double(*road) / *snow;
    ASSERT_LT(roadToSnow_, 0.7);
    ASSERT_GT(roadToSnow_, 0.2);
  }

 private:
  struct Pixel {
    double x, y;
  };
  static double edge(int side) { return kRoadLatitude + side * kRoadM / 2 / kMetresADegree; }
  std::optional<Pixel> pixelOf(const FrameRequest& r, double longitude, double latitude) const {
    const LocalFrame frame({r.eye.latitude, r.eye.longitude, Metres{0}});
    const EyePose eye{frame.fromGeodetic(r.eye), eyeAxes(frame, r.eye, r.attitude)};
    const Vec3 away =
        frame.fromGeodetic({Degrees{latitude}, Degrees{longitude}, Metres{hills(longitude, latitude)}}) -
        eye.position;
    const double x = dot(eye.axes.row[0], away), y = dot(eye.axes.row[1], away),
                 z = -dot(eye.axes.row[2], away);
    if (!(z > r.view.nearM)) return {};
    return Pixel{(x / z - r.view.left) / (r.view.right - r.view.left) * r.view.widthPx,
                 (y / z - r.view.bottom) / (r.view.top - r.view.bottom) * r.view.heightPx};
  }

  double roadToSnow_ = 0.5;
  test::ScratchDir dir_;
};

/// Along the road from 150 m above it, where a pixel sees 40 times as far along as across.
constexpr double kLostAtAGrazePx = 1.5;

struct From {
  double east, north, aboveM, heading, pitch;
};
/// Straight down until the road is a pixel wide, along it, and across it at a slant.
constexpr From kFrom[] = {
    {0.5, 0.51, 1000, 0, -90},  {0.5, 0.51, 2500, 0, -90},   {0.5, 0.51, 5000, 0, -90},
    {0.5, 0.51, 8000, 37, -90}, {0.5, 0.5, 11000, 0, -90},   {0.5, 0.5, 12800, 0, -90},
    {0.03, 0.51, 150, 90, -6},  {0.03, 0.51, 600, 90, -12},  {0.97, 0.5, 1500, 270, -20},
    {0.5, 0.4, 1200, 0, -35},   {0.5, 0.95, 4000, 180, -35}, {0.1, 0.1, 3000, 60, -30}};

TEST_F(LineFeatures, arePaintedOnPatchesWhileAPixelWide) {
  ASSERT_NO_FATAL_FAILURE(bakeRoad(false));
  ASSERT_NO_FATAL_FAILURE(measureColours(TerrainForm::patches));
  double narrowest = 1e9;
  for (const From& at : kFrom)
    for (const double errorPx : {1.0, 4.0, 16.0}) {
      auto r = from(at.east, at.north, at.aboveM, {Degrees{at.heading}, Degrees{at.pitch}, Degrees{}},
                    TerrainForm::patches);
      r.levers.drawn.errorPx = errorPx;
      const Seen seen = look(r);
      std::printf(
          "%5.0f m, pitch %3.0f, %2.0f px: %4d places, %4d with the road, to %.2f px wide, lost to %.2f px\n",
          at.aboveM, at.pitch, errorPx, seen.places, seen.road, seen.narrowestPx, seen.widestLostPx);
      EXPECT_GT(seen.places, 20);
      // Coarse surfaces move the road in the picture by as much as they may err. Where ground is seen at less
      // than a degree a texel is as long as it is wide, and the road fades a little sooner.
      if (errorPx < 4) {
        EXPECT_LE(seen.widestLostPx, at.pitch > -10 ? kLostAtAGrazePx : 0)
            << at.aboveM << " m, pitch " << at.pitch;
      }
      narrowest = std::min(narrowest, seen.narrowestPx);
    }
  EXPECT_LT(narrowest, 1.1);
}

TEST_F(LineFeatures, stayInTreesThatKeepThemWhileAPixelWide) {
  double kept = 1, published = 1;
  for (const bool keep : {true, false}) {
    ASSERT_NO_FATAL_FAILURE(bakeRoad(keep));
    ASSERT_NO_FATAL_FAILURE(measureColours(TerrainForm::static_trees));
    for (const From& at : kFrom) {
      auto r = from(at.east, at.north, at.aboveM, {Degrees{at.heading}, Degrees{at.pitch}, Degrees{}},
                    TerrainForm::static_trees);
      const Seen seen = look(r);
      std::printf("%s: %5.0f m, pitch %3.0f: %4d places, %4d with the road, to %.2f px wide\n",
                  keep ? "kept" : "published", at.aboveM, at.pitch, seen.places, seen.road, seen.narrowestPx);
      EXPECT_GT(seen.places, 20);
      double& share = keep ? kept : published;
      share = std::min(share, double(seen.road) / seen.places);
    }
  }
  EXPECT_GT(kept, 0.995);
  EXPECT_LT(published, 0.7) << "as published, the road goes long before";
}

}  // namespace
}  // namespace trimtab
