#include "trimtab/terrain/scenery/objects.h"

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>
#include <numbers>
#include <sstream>

#include "app/models/read_model.h"
#include "tests/core/terrain/scenery/scenery_tiles.h"
#include "tests/support.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/format/object_terrain.h"

/// What stands on FlightGear scenery: made lists and models, and the shared scenery where it is there.
namespace trimtab::models {
namespace {

namespace fs = std::filesystem;

/// An .ac of triangles that stand on x, y (up) and z; each is an object of its own.
std::string acOf(const std::vector<std::pair<std::string, std::array<double, 9>>>& objects) {
  std::string text = "AC3Db\nMATERIAL \"m\" rgb 1 0 0 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n";
  text += "OBJECT world\nkids " + std::to_string(objects.size()) + '\n';
  for (const auto& [name, v] : objects) {
    text += "OBJECT poly\nname \"" + name + "\"\nnumvert 3\n";
    for (std::size_t i = 0; i < 9; i += 3)
      text += std::to_string(v[i]) + ' ' + std::to_string(v[i + 1]) + ' ' + std::to_string(v[i + 2]) + '\n';
    text += "numsurf 1\nSURF 0x20\nmat 0\nrefs 3\n0 0 0\n1 0 0\n2 0 0\nkids 0\n";
  }
  return text;
}

/// A mast of 10 m with an arm of 5 m along the file's x.
std::string mast() {
  return acOf({{"mast", {-0.1, 0, 0, 0.1, 0, 0, 0, 10, 0}}, {"arm", {0, 2, 0, 0, 2.2, 0, 5, 2, 0}}});
}

/// The same with broad ends, so that an image has them.
std::string broadMast() {
  return acOf({{"mast", {-0.2, 0, 0, 0.2, 0, 0, 0.2, 10, 0}},
               {"mast", {-0.2, 0, 0, 0.2, 10, 0, -0.2, 10, 0}},
               {"arm", {0, 9, 0, 5, 9, 0, 5, 9.4, 0}},
               {"arm", {0, 9, 0, 5, 9.4, 0, 0, 9.4, 0}}});
}

class SceneryObjectsTest : public ::testing::Test {
 protected:
  SceneryObjectsTest() {
    fs::create_directories(lists());
    fs::create_directories(dir_ / "base/Models/Power");
    fs::create_directories(dir_ / "base/Scenery/Models/Misc");
    write("3072816.btg", test::gridTile({}));
    test::writeFile(dir_ / "base/Models/Power/mast.ac", mast());
    test::writeFile(dir_ / "base/Scenery/Models/Misc/old.ac", mast());
    write("house.ac", mast());
  }
  fs::path lists() const { return dir_ / "fg/Terrain/e000n50/e007n50"; }
  void write(const std::string& name, const std::string& text) const {
    test::writeFile(lists() / name, text);
  }
  void list(const std::string& lines) const { write("3072816.stg", "OBJECT_BASE 3072816.btg\n" + lines); }
  terrain::SceneryObjects read() {
    const std::vector<fs::path> base{dir_ / "base"};
    findings_.clear();
    return terrain::readSceneryObjects(dir_ / "fg", base, findings_);
  }

  test::ScratchDir dir_;
  Findings findings_;
};

TEST_F(SceneryObjectsTest, areReadFromGoodLinesAndBadOnesAreNamed) {
  list(
      "OBJECT_SHARED Models/Power/mast.ac 7.1 50.55 130 30\n"
      "OBJECT_SHARED Models/Misc/old.ac 7.1 50.55 130 30\n"
      "OBJECT_STATIC house.ac 7.1 50.55 130 -30 # by the road\n"
      "OBJECT_STATIC_AGL house.ac 7.1 50.55 4 0\n"
      "OBJECT_SHARED_AGL Models/Power/mast.ac 7.1 50.55 0 0 10 20\n"
      "OBJECT_STATIC_AGL house.ac 7.1 50.55 -9999.0 0\n"
      "OBJECT_SIGN {@R}01-19 7.1 50.55 130 90 3\n"
      "BUILDING_LIST x.txt y 7.1 50.55 130\n"
      "OBJECT_SHARED Models/Power/gone.xml 7.1 50.55 130 30\n"
      "OBJECT_STATIC house.ac 7.1 95 130 0\n"
      "OBJECT_STATIC house.ac 7.1 50.55 nan 0\n"
      "OBJECT_STATIC house.ac 7.1 50.55 1e9 0\n"
      "OBJECT_STATIC house.ac 7.1 50.55 130\n"
      "OBJECT_STATIC house.ac 7.1 50.55 130 0 x\n"
      "OBJECT_STATIC ../house.ac 7.1 50.55 130 0\n"
      "OBJECT_SHARED /etc/passwd 7.1 50.55 130 0\n" +
      std::string(5000, ' ') + "OBJECT_STATIC house.ac 7.1 50.55 130 0\n");
  const terrain::SceneryObjects objects = read();
  ASSERT_EQ(objects.list.placements.size(), 6u);
  EXPECT_EQ(objects.shared, 3u);
  EXPECT_EQ(objects.own, 3u);
  EXPECT_EQ(objects.signs, 1u);
  EXPECT_EQ(objects.others.at("BUILDING_LIST"), 1u);
  EXPECT_EQ(objects.withoutModel.at("Models/Power/gone.xml"), 1u);
  EXPECT_EQ(objects.list.placements[0].height, Metres{130});
  EXPECT_FALSE(objects.list.placements[3].height);
  EXPECT_EQ(objects.list.placements[3].aboveGround, Metres{4});
  EXPECT_FALSE(objects.list.placements[5].height);
  EXPECT_EQ(objects.list.placements[5].aboveGround, Metres{0});
  // The tilted mast is a model of its own.
  ASSERT_EQ(objects.models.size(), 4u);
  EXPECT_EQ(objects.models[3].pitch, Degrees{10});
  EXPECT_EQ(objects.models[3].roll, Degrees{20});
  ASSERT_EQ(findings_.size(), 8u) << toString(findings_);
  for (std::size_t i = 0; i < findings_.size(); ++i)
    EXPECT_NE(findings_[i].where.find(".stg:" + std::to_string(11 + i)), std::string::npos)
        << toString(findings_);
  const std::string about = toString(terrain::aboutSceneryObjects(dir_ / "fg", objects));
  for (const char* said : {"6 by 4 models", "1 of Models/Power/gone.xml", "1 signs", "1 of BUILDING_LIST"})
    EXPECT_NE(about.find(said), std::string::npos) << said << " in " << about;
}

Vec3 turnedBy(const std::array<std::int16_t, 4>& turn, Vec3 v) {
  Vec3 q{turn[0] / 32767.0, turn[1] / 32767.0, turn[2] / 32767.0};
  const double w = turn[3] / 32767.0;
  const Vec3 t = cross(q, v) * 2;
  return v + t * w + cross(q, t);
}

/// Where a mast stands, and how far its tips are from its foot: metres east, north and up, by GeographicLib.
struct StandingMast {
  GeodeticPosition foot;
  Vec3 arm, top;
  double armDeg() const { return std::atan2(arm.x, arm.y) * 180 / std::numbers::pi; }
};
std::vector<StandingMast> mastsOf(const ObjectIndex& index) {
  std::vector<StandingMast> masts;
  for (std::uint32_t c = 0; c < index.cells.size(); ++c)
    for (std::uint32_t i = 0; index.cells[c].isLeaf(c) && i < index.cells[c].instances; ++i) {
      const ObjectInstance& o = index.instances[index.cells[c].firstInstance + i];
      const auto& from = index.cells[c].origin;
      const Vec3 foot{from[0] * 16.0 + double{o.x}, from[1] * 16.0 + double{o.y},
                      from[2] * 16.0 + double{o.z}};
      const GeodeticPosition place = index.frame.toGeodetic(foot);
      const GeographicLib::LocalCartesian local(place.latitude.value(), place.longitude.value(),
                                                place.height.value());
      const auto fromFoot = [&](Vec3 tip) {
        const GeodeticPosition p = index.frame.toGeodetic(foot + turnedBy(o.turn, tip));
        Vec3 v;
        local.Forward(p.latitude.value(), p.longitude.value(), p.height.value(), v.x, v.y, v.z);
        return v;
      };
      masts.push_back({place, fromFoot({5, 0, 0}), fromFoot({0, 0, 10})});
    }
  return masts;
}

/// Expects masts to be placed as FlightGear says: the arm, along x, points south at heading 0 and turns
/// anticlockwise, so that it points to 180 degrees less the heading.
TEST_F(SceneryObjectsTest, standUprightAtTheirHeightAndHeading) {
  constexpr std::array<double, 5> kHeadings{0, 30, 137.5, 251, -44};
  for (const std::string pose : {"", " 0 90"}) {
    std::string lines;
    for (std::size_t i = 0; i < kHeadings.size(); ++i)
      lines += "OBJECT_SHARED Models/Power/mast.ac 7.0" + std::to_string(i + 1) + " 50.55 " +
               std::to_string(130 + i) + ' ' + std::to_string(kHeadings[i]) + pose + '\n';
    list(lines);
    terrain::BakeOptions options;
    options.sources = {dir_ / "fg"};
    options.sceneryModels = dir_ / "base";
    options.output = dir_ / "db";
    options.post = Metres{500};
    options.readModel = readModel;
    const auto baked = terrain::bake(options);
    ASSERT_TRUE(baked) << toString(baked.findings());
    const auto objects = (*baked)->objects();
    ASSERT_NE(objects, nullptr) << toString(baked.findings());
    const std::vector<StandingMast> masts = mastsOf(objects->index);
    ASSERT_EQ(masts.size(), kHeadings.size());
    for (const StandingMast& mast : masts) {
      const auto i = static_cast<std::size_t>(std::lround(100 * (mast.foot.longitude.value() - 7) - 1));
      ASSERT_LT(i, kHeadings.size());
      EXPECT_NEAR(mast.foot.height.value(), 130.0 + static_cast<double>(i), 0.1);
      EXPECT_NEAR(mast.foot.longitude.value(), 7.01 + 0.01 * static_cast<double>(i), 1e-6);
      EXPECT_NEAR(mast.foot.latitude.value(), 50.55, 1e-6);
      EXPECT_NEAR(std::remainder(mast.armDeg() - (180 - kHeadings[i]), 360.0), 0, 0.1);
      EXPECT_LT(length(mast.top - Vec3{0, 0, 10}), 0.01);
    }
    // The model as it is read, whose axes are those of the file with y up turned to z.
    const auto model = readModel(dir_ / "base/Models/Power/mast.ac");
    ASSERT_TRUE(model);
    Vec3 arm, top;
    for (const auto& v : model->levels[0].vertices) {
      const Vec3 p{double{v.position[0]}, double{v.position[1]}, double{v.position[2]}};
      if (p.x > arm.x) arm = p;
      if (p.z > top.z) top = p;
    }
    EXPECT_NEAR(arm.x, 5, 1e-5);
    EXPECT_NEAR(top.z, 10, 1e-5);
    // A roll of 90 degrees about x lays the mast down to one side; it is a level of its own model.
    float highest = 0;
    for (const auto& vertex : objects->vertices) highest = std::max(highest, vertex.z);
    EXPECT_NEAR(highest, pose.empty() ? 10 : 0.1, 0.11);
    fs::remove_all(options.output);
  }
}

TEST_F(SceneryObjectsTest, areBakedAnewWhereAFileChangedThatAModelListNames) {
  list("OBJECT_SHARED Models/Power/mast.xml 7.1 50.55 130 30\n");
  fs::create_directories(dir_ / "fg/Models/Power");
  fs::create_directories(dir_ / "fg/Models/Misc");
  const fs::path part = dir_ / "fg/Models/Misc/part.ac";
  test::writeFile(part, mast());
  test::writeFile(dir_ / "fg/Models/Power/mast.xml",
                  "<PropertyList><path>Models/Misc/part.ac</path></PropertyList>");
  const auto vertices = [&] {
    const auto opened =
        terrain::openOrBake(dir_ / "fg", dir_ / "cache", {}, 2000, terrain::ObjectsToBake{{}, readModel});
    return opened && (*opened)->objects() ? (*opened)->objects()->vertices.size() : 0;
  };
  const std::size_t before = vertices();
  EXPECT_GT(before, 0u);
  EXPECT_EQ(vertices(), before);
  EXPECT_EQ(test::namesIn(dir_ / "cache").size(), 1u);
  test::writeFile(part, broadMast());
  EXPECT_NE(vertices(), before);
}

/// The shared scenery, whose lists are read here a second time, with a mast for each model that they name.
class SharedScenery : public SceneryObjectsTest, public ::testing::WithParamInterface<const char*> {
 protected:
  struct Line {
    double longitude = 0, latitude = 0, elevation = 0, heading = 0;
  };
  void SetUp() override {
    TRIMTAB_NEEDS_SHARED(fs::path("data") / GetParam());
    const fs::path folder = test::sharedDir() / "data" / GetParam();
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".stg") continue;
      std::istringstream words(test::readFile(entry.path()));
      for (std::string word, path; words >> word;) {
        if (word != "OBJECT_SHARED") continue;
        Line line;
        ASSERT_TRUE(words >> path >> line.longitude >> line.latitude >> line.elevation >> line.heading);
        lines_.push_back(line);
        const fs::path file = dir_ / "shared" / path;
        fs::create_directories(file.parent_path());
        test::writeFile(file.parent_path() / "mast.ac", broadMast());
        test::writeFile(file, "<PropertyList><path>mast.ac</path></PropertyList>");
      }
    }
    ASSERT_FALSE(lines_.empty());
    terrain::BakeOptions options;
    options.sources = {folder};
    options.sceneryModels = dir_ / "shared";
    options.output = dir_ / "db";
    options.post = Metres{500};
    options.maxError = Metres{0};
    options.readModel = readModel;
    auto baked = terrain::bake(options);
    ASSERT_TRUE(baked) << toString(baked.findings());
    database_ = *baked;
    ASSERT_NE(database_->objects(), nullptr) << toString(baked.findings());
  }

  double groundAt(double latitude, double longitude) const {
    const auto ground = database_->heightAt(Degrees{latitude}, Degrees{longitude});
    EXPECT_TRUE(ground);
    return ground.value_or(Metres{0}).value();
  }
  /// How far the four posts about a place are from one plane: two triangles there leave the bilinear surface
  /// by at most a quarter of it.
  double twistAt(double latitude, double longitude) const {
    const terrain::TerrainInfo& info = database_->info();
    const double y = info.postLatitude.value(), x = info.postLongitude.value(),
                 south = info.southWest.latitude.value(), west = info.southWest.longitude.value();
    const double s = south + std::floor((latitude - south) / y) * y,
                 w = west + std::floor((longitude - west) / x) * x;
    return std::abs(groundAt(s, w) - groundAt(s, w + x) - groundAt(s + y, w) + groundAt(s + y, w + x));
  }

  static constexpr int kSide = 400, kHalf = kSide / 2;

  /// Looks west at a mast from 40 m away and half its height, over the scenery's own triangles. Its tip is
  /// where it must be in the image; its arm, which points south, is on the left.
  void expectDrawn(scene::Renderer& renderer, scene::Offscreen& offscreen, const Line& line) {
    constexpr double kEdge = 0.25, kPxAMetre = kHalf / kEdge / 40;
    const GeographicLib::LocalCartesian local(line.latitude, line.longitude, line.elevation);
    double latitude = 0, longitude = 0, height = 0;
    local.Reverse(40, 0, 5, latitude, longitude, height);
    FrameRequest r;
    r.eye = {Degrees{latitude}, Degrees{longitude}, Metres{height}};
    r.attitude = {Degrees{-90}, Degrees{0}, Degrees{0}};
    r.view = {kSide, kSide, -kEdge, kEdge, -kEdge, kEdge, 1};
    r.terrain.form = TerrainForm::static_trees;
    r.waitForPages = true;
    offscreen.makeCurrent();
    renderer.draw(r, offscreen.framebuffer());
    const auto rgba = renderer.readPixels(kSide, kSide);
    // Other masts are farther, so that nothing of them is in the rows of the upper quarter.
    int top = -1, west = kSide, east = -1;
    for (int y = kHalf + static_cast<int>(2.5 * kPxAMetre); y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const auto* const p = &rgba[static_cast<std::size_t>(4 * (y * kSide + x))];
        if (p[0] < 2 * p[1] || p[0] < 2 * p[2]) continue;
        top = std::max(top, y), west = std::min(west, x), east = std::max(east, x);
      }
    EXPECT_NEAR(top, kHalf + 5 * kPxAMetre, 2) << latitude << ' ' << longitude;
    EXPECT_NEAR(west, kHalf - 5 * kPxAMetre, 2) << latitude << ' ' << longitude;
    EXPECT_NEAR(east, kHalf + 0.2 * kPxAMetre, 2) << latitude << ' ' << longitude;
  }

  std::vector<Line> lines_;
  std::shared_ptr<const terrain::Database> database_;
};

TEST_P(SharedScenery, everyPlacementStandsUprightAtItsHeight) {
  const std::vector<StandingMast> masts = mastsOf(database_->objects()->index);
  ASSERT_EQ(masts.size(), lines_.size());
  for (const Line& line : lines_) {
    SCOPED_TRACE(std::to_string(line.latitude) + ' ' + std::to_string(line.longitude));
    const GeographicLib::LocalCartesian local(line.latitude, line.longitude, 0);
    const StandingMast* nearest = nullptr;
    double distance = 1e9, height = 0;
    for (const StandingMast& mast : masts) {
      Vec3 v;
      local.Forward(mast.foot.latitude.value(), mast.foot.longitude.value(), mast.foot.height.value(), v.x,
                    v.y, v.z);
      if (const double d = std::hypot(v.x, v.y); d < distance) distance = d, height = v.z, nearest = &mast;
    }
    ASSERT_NE(nearest, nullptr);
    EXPECT_LT(distance, 0.1);
    if (line.elevation == -9999)
      EXPECT_NEAR(height, groundAt(line.latitude, line.longitude),
                  0.1 + twistAt(line.latitude, line.longitude) / 4);
    else
      EXPECT_NEAR(height, line.elevation, 0.1);
    EXPECT_NEAR(std::remainder(nearest->armDeg() - (180 - line.heading), 360.0), 0, 0.1);
    EXPECT_LT(length(nearest->top - Vec3{0, 0, 10}), 0.01);
  }
  auto created = scene::Offscreen::create(kSide, kSide);
  if (!created) GTEST_SKIP() << toString(created.findings());
  const auto offscreen = std::move(created).value();
  scene::Renderer renderer;
  ASSERT_TRUE(renderer.initialize().usable);
  renderer.setTerrain(database_);
  for (const Line& line : lines_)
    if (line.elevation != -9999) expectDrawn(renderer, *offscreen, line);
  renderer.release();
}

INSTANTIATE_TEST_SUITE_P(All, SharedScenery,
                         ::testing::Values("fg-cologne", "fg-debian-hawaii-bigisland",
                                           "fg-debian-iceland-reykjanes", "fg-kansai-e135n35"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

class PropertyModel : public ::testing::Test {
 protected:
  Result<terrain::SourceModel> read(const std::string& content) const {
    test::writeFile(dir_ / "part.ac", mast());
    test::writeFile(dir_ / "model.xml",
                    "<?xml version=\"1.0\"?>\n<PropertyList>" + content + "</PropertyList>");
    return readModel(dir_ / "model.xml");
  }
  static std::array<float, 3> highest(const terrain::SourceMesh& mesh) {
    std::array<float, 3> high{-1e9f, -1e9f, -1e9f};
    for (const auto i : mesh.indices)
      for (std::size_t k = 0; k < 3; ++k) high[k] = std::max(high[k], mesh.vertices[i].position[k]);
    return high;
  }
  test::ScratchDir dir_;
};

TEST_F(PropertyModel, isUprightAndMovedByItsOffsets) {
  const auto model = read(
      "<path>part.ac</path><offsets><x-m>3</x-m><z-m>2</z-m><heading-deg>90</heading-deg></offsets>"
      "<model><path>part.ac</path><offsets><y-m>-100</y-m><z-m>20</z-m></offsets></model>");
  ASSERT_TRUE(model) << toString(model.findings());
  const auto high = highest(model->levels[0]);
  // Heading is anticlockwise about z: the arm along x points along y; the second mast moves with the first.
  EXPECT_NEAR(high[1], 5, 1e-4);
  EXPECT_NEAR(high[2], 32, 1e-4);
  EXPECT_NEAR(high[0], 103, 1e-3);
}

TEST_F(PropertyModel, hasALevelForEachRange) {
  const auto model = read(
      "<path>part.ac</path>"
      "<animation><type>range</type><object-name>arm</object-name><max-m>500</max-m></animation>"
      "<animation><type>range</type><min-m>0</min-m><max-m>4000</max-m></animation>");
  ASSERT_TRUE(model) << toString(model.findings());
  ASSERT_EQ(model->levels.size(), 2u);
  EXPECT_EQ(model->levels[0].triangles(), 2u);
  EXPECT_EQ(model->levels[1].triangles(), 1u);
}

TEST_F(PropertyModel, showsWhatIsSelectedWhileNoPropertyIsSet) {
  const auto shown = [&](const std::string& condition) {
    const auto model =
        read("<path>part.ac</path><animation><type>select</type><object-name>arm</object-name>" + condition +
             "</animation>");
    return model ? model->levels[0].triangles() : 0;
  };
  const std::string sun = "<property>/sim/time/sun-angle-rad</property><value>1.57</value>";
  EXPECT_EQ(shown(""), 2u);
  EXPECT_EQ(shown("<condition><greater-than>" + sun + "</greater-than></condition>"), 1u);
  EXPECT_EQ(shown("<condition><less-than>" + sun + "</less-than></condition>"), 2u);
  EXPECT_EQ(shown("<condition><property>/a</property></condition>"), 1u);
  EXPECT_EQ(shown("<condition><not><property>/a</property></not></condition>"), 2u);
  EXPECT_EQ(
      shown("<condition><or><property>/a</property><less-than>" + sun + "</less-than></or></condition>"), 2u);
  EXPECT_EQ(
      shown("<condition><equals><property>/season</property><value>winter</value></equals></condition>"), 1u);
}

TEST_F(PropertyModel, namesWhatIsNotUsedAndDrawsTheRest) {
  const auto model = read(
      "<path>part.ac</path><model><path>gone.ac</path></model><model><path>model.xml</path></model>"
      "<offsets><x-m>1e30</x-m></offsets>"
      "<animation><type>spin</type></animation><animation><type>spin</type></animation><model><path>");
  ASSERT_TRUE(model) << toString(model.findings());
  EXPECT_EQ(model->levels[0].triangles(), 2u);
  const std::string said = toString(model.findings());
  for (const char* what : {"gone.ac", "inside itself", "x-m in", "2 spin", "XML to its end"})
    EXPECT_NE(said.find(what), std::string::npos) << what << " in " << said;
  EXPECT_FALSE(read("<model><path>model.xml</path></model>"));
}

}  // namespace
}  // namespace trimtab::models
