#include "trimtab/terrain/scenery/objects.h"

#include <cmath>
#include <numbers>

#include "app/models/read_model.h"
#include "tests/core/terrain/scenery/scenery_tiles.h"
#include "tests/support.h"
#include "trimtab/terrain/bake/bake.h"
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

/// Expects a mast at heading 30 to be drawn as FlightGear says: its arm, along x, points south at 0 and turns
/// anticlockwise, so that it points to 180 - 30 degrees; and it stands at 130 m.
TEST_F(SceneryObjectsTest, standUprightAtTheirHeightAndHeading) {
  for (const std::string pose : {"", " 0 90"}) {
    list("OBJECT_SHARED Models/Power/mast.ac 7.1 50.55 130 30" + pose + "\n");
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
    ASSERT_EQ(objects->index.instances.size(), 1u);
    const ObjectInstance& o = objects->index.instances[0];
    const auto& from = objects->index.cells[0].origin;
    const Vec3 foot{from[0] * 16.0 + double{o.x}, from[1] * 16.0 + double{o.y}, from[2] * 16.0 + double{o.z}};
    const GeodeticPosition place = objects->index.frame.toGeodetic(foot);
    EXPECT_NEAR(place.height.value(), 130, 0.1);
    EXPECT_NEAR(place.longitude.value(), 7.1, 1e-6);
    EXPECT_NEAR(place.latitude.value(), 50.55, 1e-6);
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
    const GeodeticPosition armTip = objects->index.frame.toGeodetic(foot + turnedBy(o.turn, {5, 0, 0}));
    const double kMetresADegree = 111195;
    const double north = (armTip.latitude - place.latitude).value() * kMetresADegree,
                 east = (armTip.longitude - place.longitude).value() * kMetresADegree *
                        std::cos(50.55 * std::numbers::pi / 180);
    EXPECT_NEAR(std::atan2(east, north) * 180 / std::numbers::pi, 150, 0.3);
    const GeodeticPosition tip = objects->index.frame.toGeodetic(foot + turnedBy(o.turn, {0, 0, 10}));
    EXPECT_NEAR(tip.height.value(), 140, 0.1);
    // A roll of 90 degrees about x lays the mast down to one side; it is a level of its own model.
    float highest = 0;
    for (const auto& vertex : objects->vertices) highest = std::max(highest, vertex.z);
    EXPECT_NEAR(highest, pose.empty() ? 10 : 0.1, 0.11);
    fs::remove_all(options.output);
  }
}

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
