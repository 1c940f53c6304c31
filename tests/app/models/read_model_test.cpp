#include "app/models/read_model.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/ProxyNode>
#include <osg/Switch>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgSim/LightPointNode>
#include <osgSim/Sector>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/core/terrain/objects/model_support.h"
#include "tests/support.h"
#include "trimtab/terrain/objects/build_model.h"

namespace trimtab::models {
namespace {

using terrain::SourceModel;
using terrain::SourceVertex;

/// Red, green, blue and white, rows from the top.
constexpr const char* kFourPixels = "P3\n2 2\n255\n255 0 0  0 255 0\n0 0 255  255 255 255\n";

std::array<float, 6> boundsOf(const terrain::SourceMesh& mesh) {
  std::array<float, 6> b{1e9f, 1e9f, 1e9f, -1e9f, -1e9f, -1e9f};
  for (const std::uint32_t i : mesh.indices)
    for (std::size_t k = 0; k < 3; ++k) {
      b[k] = std::min(b[k], mesh.vertices[i].position[k]);
      b[k + 3] = std::max(b[k + 3], mesh.vertices[i].position[k]);
    }
  return b;
}

osg::ref_ptr<osg::Geode> triangles(unsigned count) {
  const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
  const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
  for (unsigned i = 0; i < count; ++i)
    for (const osg::Vec3& v : {osg::Vec3(0, 0, 0), osg::Vec3(1, 0, 0), osg::Vec3(0, 0, 2)})
      vertices->push_back(v + osg::Vec3(static_cast<float>(i), 0, 0));
  geometry->setVertexArray(vertices);
  geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(3 * count)));
  const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
  geode->addDrawable(geometry);
  return geode;
}

class ReadModel : public ::testing::Test {
 protected:
  std::filesystem::path written(const char* name, const osg::Node& node) const {
    EXPECT_TRUE(osgDB::writeNodeFile(node, (dir_ / name).string())) << name;
    return dir_ / name;
  }
  std::filesystem::path written(const char* name, const std::string& text) const {
    test::writeFile(dir_ / name, text);
    return dir_ / name;
  }
  test::ScratchDir dir_;
};

/// A gable 4 m wide, 6 m high and 8 m long, y up, as AC3D writes.
constexpr const char* kAc =
    "AC3Db\n"
    "MATERIAL \"paint\" rgb 0.5 0.25 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0\n"
    "OBJECT world\nkids 1\nOBJECT poly\nname \"hut\"\ntexture \"four.ppm\"\nloc 100 0 0\n"
    "numvert 4\n-2 0 -8\n2 0 -8\n2 6 0\n-2 6 0\n"
    "numsurf 1\nSURF 0x20\nmat 0\nrefs 4\n0 0 0\n1 1 0\n2 1 1\n3 0 1\nkids 0\n";

TEST_F(ReadModel, turnsAc3dUpAndReadsItsTexture) {
  written("four.ppm", kFourPixels);
  const auto model = readModel(written("hut.ac", kAc));
  ASSERT_TRUE(model) << toString(model.findings());
  EXPECT_TRUE(model.findings().empty()) << toString(model.findings());
  ASSERT_EQ(model->levels.size(), 1u);
  EXPECT_EQ(model->levels[0].triangles(), 2u);
  EXPECT_TRUE(model->levels[0].bothSides);
  // x stays, height is what y was, and what was towards -z is to the north.
  EXPECT_EQ(boundsOf(model->levels[0]), (std::array<float, 6>{98, 0, 0, 102, 8, 6}));
  ASSERT_EQ(model->textures.size(), 1u);
  EXPECT_EQ(model->textures[0].width, 2u);
  // Rows from the bottom: blue first.
  EXPECT_EQ(std::vector(model->textures[0].pixels.begin(), model->textures[0].pixels.begin() + 4),
            (std::vector<std::uint8_t>{0, 0, 255, 255}));
  for (const std::uint32_t i : model->levels[0].indices) {
    const SourceVertex& v = model->levels[0].vertices[i];
    EXPECT_EQ(v.texture, 0u);
    EXPECT_NEAR(v.place[1], v.position[2] / 6, 1e-6) << "v rises with the height";
  }
}

TEST_F(ReadModel, namesATextureThatIsNotThere) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const auto model = readModel(written("hut.ac", kAc));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->textures.empty());
  EXPECT_NE(toString(model.findings()).find("four.ppm"), std::string::npos) << toString(model.findings());
  const SourceVertex& v = model->levels[0].vertices[model->levels[0].indices[0]];
  EXPECT_EQ(v.texture, SourceVertex::kNoTexture);
  EXPECT_EQ(v.colour, (std::array<std::uint8_t, 4>{128, 64, 255, 255}));
}

TEST_F(ReadModel, readsWavefrontWithItsMaterial) {
  written("m.mtl", "newmtl red\nKd 1 0 0\nd 1\n");
  const auto model = readModel(
      written("tower.obj", "mtllib m.mtl\nv 0 0 0\nv 3 0 0\nv 3 9 0\nv 0 9 -1\nusemtl red\nf 1 2 3 4\n"));
  ASSERT_TRUE(model) << toString(model.findings());
  EXPECT_EQ(model->levels[0].triangles(), 2u);
  EXPECT_EQ(boundsOf(model->levels[0]), (std::array<float, 6>{0, 0, 0, 3, 1, 9}));
  EXPECT_EQ(model->levels[0].vertices[0].colour, (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
}

TEST_F(ReadModel, readsPointsAsLightsWithTheirMaterial) {
  written("m.mtl", "newmtl red\nKd 1 0 0\n");
  const auto model =
      readModel(written("lamp.obj", "mtllib m.mtl\nv 0 6 0\nv 1 2 -3\nusemtl red\np 1\np 2\n"));
  ASSERT_TRUE(model) << toString(model.findings());
  EXPECT_TRUE(model.findings().empty()) << toString(model.findings());
  ASSERT_EQ(model->lights.size(), 2u);
  EXPECT_EQ(model->lights[0].position, (std::array<float, 3>{0, 0, 6}));
  EXPECT_EQ(model->lights[1].position, (std::array<float, 3>{1, 3, 2}));
  EXPECT_EQ(model->lights[0].colour, (std::array<std::uint8_t, 4>{255, 0, 0, 255}));
  const auto built = terrain::buildModel(*model);
  ASSERT_TRUE(built) << toString(built.findings());
  EXPECT_TRUE(built->levels.empty());
  EXPECT_EQ(built->lights.size(), 2u);
  const auto other =
      readModel(written("lamp2.obj", "mtllib m.mtl\nv 0 7 0\nv 1 2 -3\nusemtl red\np 1\np 2\n"));
  ASSERT_TRUE(other);
  EXPECT_NE(terrain::checksumOf(*model), terrain::checksumOf(*other)) << "a bake would keep the old lights";
}

TEST_F(ReadModel, readsLightPointsAndSaysOnceWhatItLeavesOut) {
  const osg::ref_ptr<osgSim::LightPointNode> lights = new osgSim::LightPointNode;
  for (int i = 0; i < 5; ++i) {
    osgSim::LightPoint light(osg::Vec3(static_cast<float>(i), 0, 1), osg::Vec4(0, 1, 0, 1));
    light._intensity = 0.5f;
    light._on = i != 4;
    if (i < 2) light._sector = new osgSim::ElevationSector(0, 1);
    lights->addLightPoint(light);
  }
  const osg::ref_ptr<osg::MatrixTransform> moved =
      new osg::MatrixTransform(osg::Matrix::translate(10, 20, 30));
  moved->addChild(lights);
  const auto model = readModel(written("edge.osgb", *moved));
  ASSERT_TRUE(model) << toString(model.findings());
  ASSERT_EQ(model->lights.size(), 4u) << "one is off";
  EXPECT_EQ(model->lights[3].position, (std::array<float, 3>{13, 20, 31}));
  EXPECT_EQ(model->lights[3].colour, (std::array<std::uint8_t, 4>{0, 128, 0, 255}));
  ASSERT_EQ(model.findings().size(), 1u) << toString(model.findings());
  EXPECT_NE(toString(model.findings()).find("some with a sector"), std::string::npos);
}

TEST_F(ReadModel, makesALevelOfEachRange) {
  const osg::ref_ptr<osg::Group> root = new osg::Group;
  const osg::ref_ptr<osg::LOD> lod = new osg::LOD, second = new osg::LOD, always = new osg::LOD;
  lod->addChild(triangles(5), 0, 100);
  lod->addChild(triangles(3), 100, 1000);
  lod->addChild(triangles(1), 1000, 5000);
  second->addChild(triangles(4), 0, 300);
  always->addChild(triangles(2), 0, 0);
  root->addChild(lod);
  root->addChild(second);
  root->addChild(always);
  for (const char* name : {"a.osgb", "a.ive", "a.osgt"}) {
    const auto model = readModel(written(name, *root));
    ASSERT_TRUE(model) << toString(model.findings());
    std::vector<std::size_t> counts;
    for (const terrain::SourceMesh& level : model->levels) counts.push_back(level.triangles());
    EXPECT_EQ(counts, (std::vector<std::size_t>{11, 9, 5, 3, 2})) << name;
  }
}

TEST_F(ReadModel, flattensTransformsAndSwitches) {
  const osg::ref_ptr<osg::MatrixTransform> moved = new osg::MatrixTransform(
      osg::Matrix::scale(-2, 1, 1) * osg::Matrix::rotate(osg::PI_2, osg::Vec3(0, 0, 1)) *
      osg::Matrix::translate(10, 0, 0));
  const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
  choice->addChild(triangles(1), false);
  choice->addChild(triangles(1), true);
  choice->getChild(1)->getOrCreateStateSet()->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
  moved->addChild(choice);
  const auto model = readModel(written("a.osgb", *moved));
  ASSERT_TRUE(model);
  const terrain::SourceMesh& mesh = model->levels[0];
  ASSERT_EQ(mesh.triangles(), 1u);
  EXPECT_FALSE(mesh.bothSides);
  // x becomes -2 x, and that is turned to y; the mirrored triangle is turned round.
  const auto at = [&](std::size_t k) { return mesh.vertices[mesh.indices[k]].position; };
  EXPECT_NEAR(at(0)[0], 10, 1e-5);
  EXPECT_NEAR(at(1)[2], 2, 1e-5);
  EXPECT_NEAR(at(2)[1], -2, 1e-5);
}

TEST_F(ReadModel, readsWhatOpenSceneGraphWrites) {
  for (const char* name : {"a.3ds", "a.flt", "a.stl", "a.osg", "a.osgt", "a.osgb", "a.ive"}) {
    const auto model = readModel(written(name, *triangles(3)));
    ASSERT_TRUE(model) << name << toString(model.findings());
    EXPECT_EQ(model->levels.size(), 1u) << name;
    EXPECT_EQ(model->levels[0].triangles(), 3u) << name;
    EXPECT_EQ(boundsOf(model->levels[0]), (std::array<float, 6>{0, 0, 0, 3, 0, 2})) << name;
  }
}

TEST_F(ReadModel, turnsColladaByItsUpAxis) {
  // A triangle 2 m high, in the plane that is upright by the file's own words.
  for (const auto& [axis, places] : {std::pair{"Z_UP", "0 0 0 3 0 0 0 0 2"}, {"Y_UP", "0 0 0 3 0 0 0 2 0"}}) {
    const auto model = readModel(written(
        "a.dae",
        std::string(
            "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
            "version=\"1.4.1\"><asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00"
            "</modified><up_axis>") +
            axis +
            "</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array "
            "id=\"f\" "
            "count=\"9\">" +
            places +
            "</float_array><technique_common><accessor source=\"#f\" count=\"3\" stride=\"3\"><param "
            "name=\"X\" "
            "type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
            "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
            "source=\"#p\"/></vertices>"
            "<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 "
            "2</p></triangles>"
            "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node "
            "id=\"n\">"
            "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
            "<instance_visual_scene url=\"#s\"/></scene></COLLADA>\n"));
    ASSERT_TRUE(model) << toString(model.findings());
    const std::array<float, 6> bounds = boundsOf(model->levels[0]), expected{0, 0, 0, 3, 0, 2};
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(bounds[k], expected[k], 1e-5) << axis << ' ' << k;
  }
}

TEST_F(ReadModel, doesNotDependOnTheOrderOfParts) {
  std::vector<osg::ref_ptr<osg::Node>> parts;
  for (const char* image : {"a.ppm", "b.ppm", ""}) {
    const osg::ref_ptr<osg::Geode> part = triangles(static_cast<unsigned>(3 + parts.size()));
    if (*image != 0) {
      test::writeFile(dir_ / image, *image == 'a' ? kFourPixels : "P3\n1 1\n255\n9 8 7\n");
      part->getOrCreateStateSet()->setTextureAttributeAndModes(
          0, new osg::Texture2D(osgDB::readRefImageFile((dir_ / image).string())), osg::StateAttribute::ON);
    }
    parts.push_back(part);
  }
  std::set<std::uint64_t> sums;
  std::sort(parts.begin(), parts.end());
  do {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (const auto& part : parts) root->addChild(part);
    const auto model = readModel(written("a.osgb", *root));
    ASSERT_TRUE(model) << toString(model.findings());
    EXPECT_EQ(model->textures.size(), 2u);
    EXPECT_EQ(model->levels[0].triangles(), 12u);
    sums.insert(terrain::checksumOf(*model));
  } while (std::next_permutation(parts.begin(), parts.end()));
  EXPECT_EQ(sums.size(), 1u);
}

TEST_F(ReadModel, endsAtReferencesThatGoRound) {
  const auto refersTo = [&](const char* name) {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangles(1));
    const osg::ref_ptr<osg::ProxyNode> proxy = new osg::ProxyNode;
    proxy->setFileName(0, name);
    root->addChild(proxy);
    return root;
  };
  written("b.osgt", *refersTo("c.osgt"));
  written("c.osgt", *refersTo("a.osgt"));
  const auto model = readModel(written("a.osgt", *refersTo("b.osgt")));
  ASSERT_TRUE(model) << toString(model.findings());
  EXPECT_EQ(model->levels[0].triangles(), 3u);
  EXPECT_NE(toString(model.findings()).find("inside itself"), std::string::npos)
      << toString(model.findings());
  for (int i = 0; i < 30; ++i)
    written(("d" + std::to_string(i) + ".osgt").c_str(),
            *refersTo(("d" + std::to_string(i + 1) + ".osgt").c_str()));
  const auto deep = readModel(dir_ / "d0.osgt");
  ASSERT_TRUE(deep);
  EXPECT_EQ(deep->levels[0].triangles(), 16u);
  for (const char* other : {"http://127.0.0.1:9/x.osgt", "x.lua", "gone.osgt"}) {
    const auto left = readModel(written("e.osgt", *refersTo(other)));
    ASSERT_TRUE(left) << other;
    EXPECT_NE(toString(left.findings()).find(other), std::string::npos) << toString(left.findings());
  }
}

TEST_F(ReadModel, refusesWhatIsNoModel) {
  for (const auto& file : {dir_ / "absent.obj", dir_.path(), written("a.xml", "<PropertyList/>"),
                           written("a.lua", "x"), written("bad.osgb", "no model"), written("empty.ac", "")}) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const auto model = readModel(file);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "") << file;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << file;
    EXPECT_FALSE(model && model->levels[0].triangles() > 0) << file;
    EXPECT_NE(toString(model.findings()).find(file.filename().string()), std::string::npos)
        << toString(model.findings());
  }
}

TEST_F(ReadModel, seesOpenFlightModelsThatKnowASignificantSizeAlone) {
  TRIMTAB_NEEDS_SHARED("data/cdb-gtmodels");
  int read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           test::sharedDir() / "data/cdb-gtmodels",
           std::filesystem::directory_options::skip_permission_denied)) {
    if (entry.path().extension() != ".flt") continue;
    ++read;
    const auto model = readModel(entry.path());
    ASSERT_TRUE(model) << toString(model.findings());
    EXPECT_GT(model->levels[0].triangles(), 0u) << entry.path();
    const auto built = terrain::buildModel(*model);
    ASSERT_TRUE(built) << entry.path() << toString(built.findings());
    for (const terrain::BuiltLevel& level : built->levels) {
      const terrain::SourceMesh& first = built->levels[0].mesh;
      EXPECT_LE(test::farthestSampled(level.mesh, first, 1), double{level.errorM} + 1e-6);
      EXPECT_LE(test::farthestSampled(first, level.mesh, 1), double{level.errorM} + 1e-6);
    }
  }
  if (read == 0) GTEST_SKIP() << "no OpenFlight files in " << test::sharedDir() / "data";
}

}  // namespace
}  // namespace trimtab::models
