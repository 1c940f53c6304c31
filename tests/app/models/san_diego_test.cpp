#include <gdal_priv.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <set>

#include "app/models/read_model.h"
#include "tests/support.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/ground_pyramid.h"
#include "trimtab/terrain/format/object_terrain.h"

/// Bakes the CDB of San Diego that lies beside the checkout, in three folders, and compares what is in the
/// database with what the files say, read here a second time: tables byte by byte, rasters by GDAL.
namespace trimtab::models {
namespace {

namespace fs = std::filesystem;

/// The rows of a .dbf file, by the names of its columns, blanks cut off.
std::vector<std::map<std::string, std::string>> rowsOfDbf(const fs::path& file) {
  const std::string b = test::readFile(file);
  const auto at = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(b.at(i)));
  };
  const std::size_t count = at(4) | at(5) << 8 | at(6) << 16, header = at(8) | at(9) << 8,
                    width = at(10) | at(11) << 8;
  std::vector<std::map<std::string, std::string>> rows(count);
  std::size_t begin = 1;
  for (std::size_t field = 32; field + 1 < header; field += 32) {
    const std::string name(b.c_str() + field);
    for (std::size_t row = 0; row < count; ++row) {
      std::string value = b.substr(header + row * width + begin, at(field + 16));
      value.erase(0, value.find_first_not_of(' '));
      value.erase(value.find_last_not_of(' ') + 1);
      rows[row][name] = value;
    }
    begin += at(field + 16);
  }
  return rows;
}

/// Longitude and latitude of each point of a .shp file.
std::vector<std::pair<double, double>> pointsOfShp(const fs::path& file) {
  const std::string b = test::readFile(file);
  std::vector<std::pair<double, double>> points;
  for (std::size_t record = 100; record + 28 <= b.size();) {
    std::size_t words = 0;
    for (std::size_t k = 4; k < 8; ++k) words = words << 8 | static_cast<unsigned char>(b[record + k]);
    double x = 0, y = 0;
    std::memcpy(&x, b.data() + record + 12, 8);
    std::memcpy(&y, b.data() + record + 20, 8);
    points.emplace_back(x, y);
    record += 8 + 2 * words;
  }
  return points;
}

/// What stands where, by the tables.
struct Row {
  double longitude, latitude, heading;
  std::string model;
};
std::vector<Row> rowsOf(const fs::path& folder, const std::string& set, const std::string& tail) {
  const std::string name = "N32W118_" + set;
  std::map<std::string, std::string> models;
  for (auto& row : rowsOfDbf(folder / (name + "_T002" + tail + ".dbf"))) models[row["CNAM"]] = row["MODL"];
  const auto points = pointsOfShp(folder / (name + "_T001" + tail + ".shp"));
  auto instances = rowsOfDbf(folder / (name + "_T001" + tail + ".dbf"));
  EXPECT_EQ(points.size(), instances.size());
  std::vector<Row> rows;
  for (std::size_t i = 0; i < points.size(); ++i)
    rows.push_back(
        {points[i].first, points[i].second, std::stod(instances[i]["AO1"]), models[instances[i]["CNAM"]]});
  return rows;
}

class SanDiego : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!fs::exists(test::sharedDir() / "data/cdb-sandiego")) return;
    dir_ = std::make_unique<test::ScratchDir>();
    terrain::BakeOptions options;
    for (const char* name : {"cdb-imagery", "cdb-gtmodels", "cdb-sandiego"})
      options.sources.push_back(test::sharedDir() / "data" / name);
    options.output = *dir_ / "db";
    options.maxError = Metres{0};
    options.readModel = readModel;
    auto baked = terrain::bake(options);
    ASSERT_TRUE(baked) << toString(baked.findings());
    database_ = *baked;
    said_ = toString(baked.findings());
    about_ = toString(terrain::aboutSources(options));
  }
  static void TearDownTestSuite() {
    database_.reset();
    dir_.reset();
  }
  void SetUp() override { TRIMTAB_NEEDS_SHARED("data/cdb-sandiego"); }

  static fs::path cell(const char* folder) { return test::sharedDir() / "data" / folder / "Tiles/N32/W118"; }

  static inline std::unique_ptr<test::ScratchDir> dir_;
  static inline std::shared_ptr<const terrain::Database> database_;
  static inline std::string said_, about_;
};

TEST_F(SanDiego, hasTheHeightsThatGdalReads) {
  const fs::path file = cell("cdb-imagery") / "001_Elevation/LC/U0/N32W118_D001_S001_T001_LC01_U0_R0.tif";
  GDALAllRegister();
  const std::unique_ptr<GDALDataset, void (*)(GDALDataset*)> data(GDALDataset::Open(file.c_str()),
                                                                  [](GDALDataset* d) { GDALClose(d); });
  ASSERT_TRUE(data);
  std::vector<float> heights(512 * 512);
  ASSERT_EQ(
      data->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 512, 512, heights.data(), 512, 512, GDT_Float32, 0, 0),
      CE_None);
  std::mt19937 random(7);
  double farthest = 0, highest = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::size_t column = random() % 512, row = random() % 512;
    // Row 0 is the northernmost; its posts stand at the south sides of its cells.
    const auto is = database_->heightAt(Degrees{32 + (511 - static_cast<double>(row)) / 512},
                                        Degrees{-118 + static_cast<double>(column) / 512});
    ASSERT_TRUE(is);
    const double should = double{heights[row * 512 + column]};
    farthest = std::max(farthest, std::abs(is->value() - should));
    highest = std::max(highest, should);
  }
  EXPECT_LT(farthest, 5e-5);
  EXPECT_GT(highest, 200) << "nothing but sea was looked at";
}

/// The finest imagery there lies in the quarter's quarter U3 R3.
TEST_F(SanDiego, hasItsImageryWithinHalfATexel) {
  const fs::path file = cell("cdb-imagery") / "004_Imagery/L02/U3/N32W118_D004_S001_T001_L02_U3_R3.jp2";
  GDALAllRegister();
  const std::unique_ptr<GDALDataset, void (*)(GDALDataset*)> data(GDALDataset::Open(file.c_str()),
                                                                  [](GDALDataset* d) { GDALClose(d); });
  ASSERT_TRUE(data);
  std::vector<float> red(1024 * 1024);
  ASSERT_EQ(
      data->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 1024, 1024, red.data(), 1024, 1024, GDT_Float32, 0, 0),
      CE_None);
  // Pixels fill their area: the first one's centre is half a pixel inside the tile.
  const auto redAt = [&](double longitude, double latitude) {
    const double x = (longitude + 117.25) * 4096 - 0.5, y = (33 - latitude) * 4096 - 0.5;
    const auto c = static_cast<std::size_t>(x), r = static_cast<std::size_t>(y);
    const double u = x - std::floor(x), v = y - std::floor(y);
    const auto pixel = [&](std::size_t i, std::size_t j) { return double{red[j * 1024 + i]}; };
    return (pixel(c, r) * (1 - u) + pixel(c + 1, r) * u) * (1 - v) +
           (pixel(c, r + 1) * (1 - u) + pixel(c + 1, r + 1) * u) * v;
  };
  const auto ground = database_->ground();
  ASSERT_TRUE(ground);
  const double perDegree = 512 * ground->shape().texelsPerPost;
  ASSERT_EQ(perDegree, 4096) << "the finest image is not as fine as the ground";
  constexpr std::uint32_t kColumn = 13, kRow = 13;
  const auto tile = ground->readTile(0, kColumn, kRow);
  ASSERT_TRUE(tile);
  double least = 1e300, spread = 0, bestX = 9, bestY = 9;
  for (double dx = -1; dx <= 1; dx += 0.25)
    for (double dy = -1; dy <= 1; dy += 0.25) {
      double sum = 0;
      for (std::uint32_t r = 0; r < 256; r += 3)
        for (std::uint32_t c = 0; c < 256; c += 3) {
          const double longitude = -118 + (kColumn * 256 + c + dx) / perDegree,
                       latitude = 32 + (kRow * 256 + r + dy) / perDegree;
          const double differ = static_cast<double>((*tile)[r * 256 + c].red) - redAt(longitude, latitude);
          sum += differ * differ;
        }
      spread = std::max(spread, sum);
      if (sum < least) least = sum, bestX = dx, bestY = dy;
    }
  EXPECT_LT(std::abs(bestX), 0.5);
  EXPECT_LT(std::abs(bestY), 0.5);
  EXPECT_LT(least, spread / 4) << "any shift is as good";
  std::printf("best shift of the image %.2f, %.2f texels\n", bestX, bestY);
}

TEST_F(SanDiego, hasEachFeatureAtItsPlaceAndHeading) {
  std::vector<Row> rows;
  const auto add = [&](const std::vector<Row>& more) { rows.insert(rows.end(), more.begin(), more.end()); };
  add(rowsOf(cell("cdb-gtmodels") / "101_GTFeature/L00/U0", "D101_S001", "_L00_U0_R0"));
  add(rowsOf(cell("cdb-gtmodels") / "101_GTFeature/L00/U0", "D101_S002", "_L00_U0_R0"));
  ASSERT_EQ(rows.size(), 48u);
  add(rowsOf(cell("cdb-sandiego") / "100_GSFeature/L01/U1", "D100_S001", "_L01_U1_R1"));
  ASSERT_EQ(rows.size(), 48u + 127);

  ASSERT_TRUE(database_->objects());
  const ObjectIndex& index = database_->objects()->index;
  ASSERT_EQ(index.instances.size(), 66u);
  constexpr double kDegree = std::numbers::pi / 180, kA = 6378137, kF = 1 / 298.257223563,
                   kE2 = kF * (2 - kF);
  // Metres east and north of a degree.
  const auto degreeAt = [&](double latitude) {
    const double s = std::sin(latitude * kDegree), w = 1 - kE2 * s * s;
    return std::pair{kA / std::sqrt(w) * std::cos(latitude * kDegree) * kDegree,
                     kA * (1 - kE2) / (w * std::sqrt(w)) * kDegree};
  };
  double farthest = 0, mostTurned = 0, highest = 0;
  std::map<std::string, int> placed;
  std::set<double> headings;
  for (std::uint32_t c = 0; c < index.cells.size(); ++c)
    for (std::uint32_t i = 0; index.cells[c].isLeaf(c) && i < index.cells[c].instances; ++i) {
      const ObjectInstance& o = index.instances[index.cells[c].firstInstance + i];
      const auto& from = index.cells[c].origin;
      const Vec3 place{from[0] * 16.0 + double{o.x}, from[1] * 16.0 + double{o.y},
                       from[2] * 16.0 + double{o.z}};
      const double x = o.turn[0], y = o.turn[1], z = o.turn[2], w = o.turn[3],
                   n = x * x + y * y + z * z + w * w;
      // The model's y axis, 50 m long, in the local frame.
      const Vec3 nose =
          place + Vec3{2 * (x * y - z * w), n - 2 * (x * x + z * z), 2 * (y * z + x * w)} * (50 / n);
      const GeodeticPosition p = index.frame.toGeodetic(place), q = index.frame.toGeodetic(nose);
      const auto [east, north] = degreeAt(p.latitude.value());
      const Row* nearest = nullptr;
      double distance = 1e9;
      for (const Row& row : rows)
        if (const double d = std::hypot((row.longitude - p.longitude.value()) * east,
                                        (row.latitude - p.latitude.value()) * north);
            d < distance)
          distance = d, nearest = &row;
      ASSERT_NE(nearest, nullptr);
      farthest = std::max(farthest, distance);
      const double heading =
          std::atan2((q.longitude - p.longitude).value() * east, (q.latitude - p.latitude).value() * north) /
          kDegree;
      mostTurned = std::max(mostTurned, std::abs(std::remainder(heading - nearest->heading, 360.0)));
      headings.insert(nearest->heading);
      highest = std::max(highest,
                         std::abs(p.height.value() - database_->heightAt(p.latitude, p.longitude)->value()));
      ++placed[nearest->model];
      EXPECT_NE(database_->objects()->names[o.model].find('_' + nearest->model + ".flt"), std::string::npos)
          << nearest->model << " is drawn by " << database_->objects()->names[o.model];
    }
  EXPECT_LT(farthest, 0.1);
  EXPECT_LT(mostTurned, 0.1);
  EXPECT_EQ(placed["coniferous_tree01"], 47);
  EXPECT_EQ(placed["coronado_bridge"], 1);
  EXPECT_EQ(placed.size(), 20u) << "18 buildings, each once";
  RecordProperty("farthest_mm", static_cast<int>(farthest * 1000));
  std::printf("farthest %.6f m, most turned %.6f degrees, %zu headings, off the posts' ground %.3f m\n",
              farthest, mostTurned, headings.size(), highest);
}

TEST_F(SanDiego, saysWhatItHasAndWhatIsNotDrawn) {
  for (const char* text : {"LC01: 1, L00: 1, L01: 2, L02: 5", "48 by 2 models", "18 by 18 models",
                           "none for 109 features", "100 rows of coarser levels", "2308 lights"})
    EXPECT_NE(about_.find(text), std::string::npos) << text << "\n" << about_;
  EXPECT_NE(said_.find("D:/textures/tree.rgb"), std::string::npos) << said_;
}

/// All 22 models are visible, and have their textures at some level.
TEST_F(SanDiego, itsModelsAreDrawn) {
  std::set<fs::path> models;
  for (const char* folder : {"cdb-gtmodels", "cdb-gsmodel"})
    for (const auto& entry : fs::recursive_directory_iterator(test::sharedDir() / "data" / folder))
      if (entry.path().extension() == ".flt") models.insert(entry.path());
  models.insert("/vsizip/" +
                (cell("cdb-gsmodel") / "300_GSModelGeometry/L00/U0/N32W118_D300_S001_T001_L00_U0_R0.zip" /
                 "N32W118_D300_S001_T001_L00_U0_R0_AL015_000_Building_-6926_6132.flt")
                    .string());
  ASSERT_EQ(models.size(), 4u);
  for (const fs::path& file : models) {
    const auto model = readModel(file);
    ASSERT_TRUE(model) << file << toString(model.findings());
    EXPECT_GT(model->levels[0].triangles(), 40u) << file;
    // The palm's texture is not beside it at any level.
    EXPECT_EQ(model->textures.empty(), file.string().find("palm") != std::string::npos)
        << file << toString(model.findings());
    const bool bridge = file.string().find("coronado") != std::string::npos;
    ASSERT_EQ(model->levels.size(), bridge ? 2u : 1u) << file;
    if (!bridge) continue;
    // The level of the least significant size alone, then the other alone.
    EXPECT_EQ(model->levels[0].triangles(), 1640u);
    EXPECT_EQ(model->levels[1].triangles(), 36u);
  }
}

/// TRIMTAB_SHOTS names a folder for the pictures.
TEST_F(SanDiego, showsItsBuildingsAndItsBridge) {
  constexpr int kWidth = 1280, kHeight = 720;
  auto created = scene::Offscreen::create(kWidth, kHeight);
  if (!created) GTEST_SKIP() << toString(created.findings());
  const auto offscreen = std::move(created).value();
  scene::Renderer renderer;
  ASSERT_TRUE(renderer.initialize().usable);
  struct View {
    const char* name;
    double latitude, longitude, heightM, heading, pitch;
    std::uint64_t atLeast;
  };
  for (const View& v : {View{"downtown", 32.7000, -117.1850, 250, 60, -4, 12},
                        View{"bridge", 32.6860, -117.1750, 300, 60, -5, 2},
                        View{"trees", 32.5500, -117.1320, 60, 15, -8, 30}}) {
    renderer.setTerrain(database_);
    FrameRequest r;
    r.eye = {Degrees{v.latitude}, Degrees{v.longitude}, Metres{v.heightM}};
    r.attitude = {Degrees{v.heading}, Degrees{v.pitch}, Degrees{0}};
    r.view.widthPx = kWidth;
    r.view.heightPx = kHeight;
    r.waitForPages = true;
    offscreen->makeCurrent();
    const FrameResult result = renderer.draw(r, offscreen->framebuffer());
    EXPECT_GE(result.objects.drawn, v.atLeast) << v.name;
    const auto rgba = renderer.readPixels(kWidth, kHeight);
    const char* const folder = std::getenv("TRIMTAB_SHOTS");
    if (!folder) continue;
    std::string ppm = "P6\n" + std::to_string(kWidth) + ' ' + std::to_string(kHeight) + "\n255\n";
    for (int y = kHeight - 1; y >= 0; --y)
      for (int x = 0; x < kWidth; ++x)
        for (int k = 0; k < 3; ++k)
          ppm += static_cast<char>(rgba[static_cast<std::size_t>(4 * (y * kWidth + x) + k)]);
    test::writeFile(fs::path(folder) / ("san-diego-" + std::string(v.name) + ".ppm"), ppm);
  }
  renderer.release();
}

}  // namespace
}  // namespace trimtab::models
