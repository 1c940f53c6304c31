#include "trimtab/terrain/objects/build_objects.h"

#include <set>

#include "model_support.h"
#include "tests/support.h"
#include "trimtab/terrain/format/object_file.h"

namespace trimtab::terrain {
namespace {

/// Ground that rises to the east, between 46 and 47 degrees north.
class Slope final : public GroundHeights {
 public:
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    if (latitude.value() < 46 || latitude.value() > 47) return {};
    return Metres{1000 * (longitude.value() - 8)};
  }
};

const LocalFrame kFrame{{Degrees{46.5}, Degrees{8.5}, Metres{0}}};

std::vector<std::optional<BuiltModel>> twoModels() {
  SourceMesh hut = test::ball(2, 3, 0), mast;
  test::addTriangle(mast, {0, 0, 0}, {0, 1, 0}, {0, 0.5f, 40});
  test::addTriangle(mast, {0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 40});
  return {*buildModel(test::modelOf("hut", {hut})), *buildModel(test::modelOf("mast", {mast}))};
}

PlacementList scattered(std::size_t count, double extentDeg) {
  PlacementList list{{"hut", "mast"}, {}};
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t i = 0; i < count; ++i) {
    ListedPlacement p;
    p.latitude = Degrees{46.5 + extentDeg * (unit(random) - 0.5)};
    p.longitude = Degrees{8.5 + extentDeg * (unit(random) - 0.5)};
    p.heading = Degrees{720 * unit(random) - 360};
    p.scale = 0.5 + unit(random);
    p.model = static_cast<std::uint32_t>(i % 2);
    p.line = static_cast<std::uint32_t>(i + 2);
    list.placements.push_back(p);
  }
  return list;
}

/// A vertex as a renderer places it, in floats.
std::array<float, 3> drawn(const ObjectInstance& instance, const ObjectIndex::Cell& cell,
                           const ObjectVertex& v) {
  float x = instance.turn[0], y = instance.turn[1], z = instance.turn[2], w = instance.turn[3];
  const float size = std::sqrt(x * x + y * y + z * z + w * w);
  x /= size;
  y /= size;
  z /= size;
  w /= size;
  // v + 2 w (q x v) + 2 q x (q x v)
  const float cx = y * v.z - z * v.y, cy = z * v.x - x * v.z, cz = x * v.y - y * v.x;
  const float s = instance.scale;
  const auto at = [&](float place, float coordinate, float c, float cc, std::int32_t origin) {
    return place + s * (coordinate + 2 * (w * c + cc)) + static_cast<float>(origin) * 16;
  };
  return {at(instance.x, v.x, cx, y * cz - z * cy, cell.origin[0]),
          at(instance.y, v.y, cy, z * cx - x * cz, cell.origin[1]),
          at(instance.z, v.z, cz, x * cy - y * cx, cell.origin[2])};
}

TEST(BuildObjects, makesCellsThatHoldWhatIsDrawn) {
  const auto built = buildObjects(twoModels(), scattered(3000, 0.3), Slope(), kFrame, "list");
  ASSERT_TRUE(built) << toString(built.findings());
  const ObjectIndex& index = built->index;
  ASSERT_EQ(index.instances.size(), 3000u);
  // The reader's checks hold, and so the tree is one.
  const test::ScratchDir dir;
  ASSERT_TRUE(writeObjects(dir / "objects", *built));
  const auto read = readObjects(dir / "objects");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_GT(index.cells.size(), 30u);
  for (std::uint32_t c = 0; c < index.cells.size(); ++c) {
    const ObjectIndex::Cell& leaf = index.cells[c];
    if (!leaf.isLeaf(c)) continue;
    EXPECT_LE(leaf.instances, kLeafInstances);
    for (std::uint32_t i = leaf.firstInstance; i < leaf.firstInstance + leaf.instances; ++i) {
      const ObjectInstance& instance = index.instances[i];
      const ObjectIndex::Model& model = index.models[instance.model];
      EXPECT_LE(model.radiusM * instance.scale, leaf.largestRadiusM);
      EXPECT_LE(index.levels[model.firstLevel + model.levels - 1].errorM * instance.scale,
                leaf.coarsestFromM);
      for (std::uint32_t l = model.firstLevel; l < model.firstLevel + model.levels; ++l)
        for (std::uint32_t v = 0; v < index.levels[l].vertices; ++v) {
          const auto p = drawn(instance, leaf, built->vertices[built->meshes[l].firstVertex + v]);
          // Every cell around it holds it too.
          for (std::uint32_t around = 0; around <= c; ++around) {
            if (index.cells[around].end <= c) continue;
            const Box& b = index.cells[around].bounds;
            ASSERT_TRUE(p[0] >= b.minX && p[0] <= b.maxX && p[1] >= b.minY && p[1] <= b.maxY &&
                        p[2] >= b.minZ && p[2] <= b.maxZ)
                << "cell " << around;
          }
        }
    }
  }
}

TEST(BuildObjects, standsThemUprightTurnedByTheirHeading) {
  PlacementList list{{"hut", "mast"}, {}};
  const double headings[] = {0, 90, -135, 200};
  // Far from the frame's origin, where up is not its z.
  for (const double heading : headings) {
    ListedPlacement p;
    p.latitude = Degrees{46.9};
    p.longitude = Degrees{28.5};
    p.heading = Degrees{heading};
    p.model = 1;
    p.scale = 1 + 0.25 * static_cast<double>(list.placements.size());  // tells them apart afterwards
    if (heading == 90) p.height = Metres{123};
    list.placements.push_back(p);
  }
  const auto built = buildObjects(twoModels(), list, Slope(), kFrame, "list");
  ASSERT_TRUE(built) << toString(built.findings());
  const ObjectIndex::Cell& cell = built->index.cells[0];
  ASSERT_EQ(built->index.instances.size(), 4u);
  for (const ObjectInstance& instance : built->index.instances) {
    const auto i = static_cast<std::size_t>(std::lround((instance.scale - 1) * 4));
    const auto place = [&](float x, float y, float z) {
      ObjectVertex v;
      v.x = x / instance.scale;
      v.y = y / instance.scale;
      v.z = z / instance.scale;
      const auto at = drawn(instance, cell, v);
      return kFrame.toGeodetic({double{at[0]}, double{at[1]}, double{at[2]}});
    };
    const GeodeticPosition foot = place(0, 0, 0), top = place(0, 0, 1000), front = place(0, 1000, 0);
    constexpr double kMetresADegree = 111195;
    const double groundM = headings[i] == 90 ? 123 : 20500;
    EXPECT_NEAR(foot.height.value(), groundM, 1.5);
    EXPECT_NEAR(foot.latitude.value(), 46.9, 1e-5);
    // 1,000 m up: the same place, within the turn's steps of 1/32767.
    EXPECT_NEAR(top.height.value() - foot.height.value(), 1000, 1);
    EXPECT_NEAR((top.latitude - foot.latitude).value() * kMetresADegree, 0, 1);
    const double north = (front.latitude - foot.latitude).value() * kMetresADegree,
                 east =
                     (front.longitude - foot.longitude).value() * kMetresADegree * std::cos(46.9 * 0.0174533);
    EXPECT_NEAR(north, 1000 * std::cos(headings[i] * 0.0174533), 6) << headings[i];
    EXPECT_NEAR(east, 1000 * std::sin(headings[i] * 0.0174533), 6) << headings[i];
  }
}

TEST(BuildObjects, namesWhatIsOffTheGroundAndModelsThatAreNone) {
  auto models = twoModels();
  models[1].reset();
  PlacementList list = scattered(10, 0.1);
  list.placements[4].latitude = Degrees{50};
  list.placements.push_back(list.placements[0]);
  list.placements.back().scale = 1000;
  list.placements.back().line = 99;
  std::optional<BuiltModel> large = models[0];
  large->levels[0].mesh.vertices[0].position = {0, 0, 19000};
  models.push_back(large);
  list.models.push_back("large");
  list.placements.back().model = 2;
  const auto built = buildObjects(models, list, Slope(), kFrame, "list.csv");
  ASSERT_TRUE(built) << toString(built.findings());
  EXPECT_EQ(built->index.instances.size(), 4u);
  EXPECT_EQ(built->index.models.size(), 2u);
  const std::string all = toString(built.findings());
  EXPECT_NE(all.find("list.csv:6: expected a place on the terrain"), std::string::npos) << all;
  EXPECT_NE(all.find("list.csv:99: scale: expected an object that reaches at most 20000 m"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("list.csv: mast: expected a model that can be used, found 5 rows"), std::string::npos)
      << all;
  models[0].reset();
  models[2].reset();
  EXPECT_FALSE(buildObjects(models, list, Slope(), kFrame, "list.csv"));
}

TEST(BuildObjects, givesTexturesThatFindNoRoomTheirMeanColour) {
  std::vector<std::optional<BuiltModel>> models;
  PlacementList list;
  for (unsigned i = 0; i < 257; ++i) {
    SourceModel source = test::modelOf(std::to_string(i), {test::ball(2, 3, 0)});
    // The last one has the texture of the first.
    const auto shade = static_cast<std::uint8_t>(i % 256);
    source.textures = {{1, 1, {shade, 10, 20, 255}}};
    for (SourceVertex& v : source.levels[0].vertices) v.texture = 0;
    models.push_back(*buildModel(source));
    ListedPlacement p;
    p.latitude = Degrees{46.5};
    p.longitude = Degrees{8.5};
    p.model = i;
    list.models.push_back(source.name);
    list.placements.push_back(p);
  }
  const auto built = buildObjects(models, list, Slope(), kFrame, "list");
  ASSERT_TRUE(built);
  EXPECT_EQ(built->textures.size(), 255u);
  ASSERT_EQ(built.findings().size(), 1u) << toString(built.findings());
  const auto firstVertex = [&](std::size_t model) {
    return built->vertices[built->meshes[built->index.models[model].firstLevel].firstVertex];
  };
  EXPECT_EQ(firstVertex(255).texture, ObjectVertex::kNoTexture);
  EXPECT_EQ(firstVertex(255).colour, (std::array<std::uint8_t, 4>{255, 10, 20, 255}));
  EXPECT_EQ(firstVertex(256).texture, 0);
}

TEST(BuildObjects, keepsPlacesInTexturesBetweenWholeTurns) {
  SourceModel source = test::modelOf("wall", {SourceMesh{}});
  test::addTriangle(source.levels[0], {0, 0, 0}, {4, 0, 0}, {0, 0, 4});
  source.textures = {{1, 1, {1, 2, 3, 255}}};
  const std::array<float, 2> places[3] = {{1000.25f, -7.5f}, {1001.5f, -7.5f}, {1000.25f, -5.75f}};
  for (std::size_t i = 0; i < 3; ++i) {
    source.levels[0].vertices[i].texture = 0;
    source.levels[0].vertices[i].place = places[i];
  }
  PlacementList list{{"wall"}, {ListedPlacement{Degrees{46.5}, Degrees{8.5}, {}, {}, 1, 0, 2}}};
  const std::vector<std::optional<BuiltModel>> models{*buildModel(source)};
  const auto built = buildObjects(models, list, Slope(), kFrame, "list");
  ASSERT_TRUE(built);
  std::set<std::pair<int, int>> halves;
  for (const ObjectVertex& v : built->vertices) halves.insert({v.place[0], v.place[1]});
  // 0.25 and 1.5; 0.5 and 2.25: as half floats.
  EXPECT_EQ(halves, (std::set<std::pair<int, int>>{{0x3400, 0x3800}, {0x3e00, 0x3800}, {0x3400, 0x4080}}));
}

TEST(BuildObjects, putsAMillionInOnePlace) {
  PlacementList list{{"hut", "mast"}, {}};
  ListedPlacement p;
  p.latitude = Degrees{46.5};
  p.longitude = Degrees{8.5};
  list.placements.assign(1000000, p);
  const auto built = buildObjects(twoModels(), list, Slope(), kFrame, "list");
  ASSERT_TRUE(built);
  EXPECT_EQ(built->index.instances.size(), 1000000u);
  EXPECT_EQ(built->index.cells.size(), 1u);
}

/// A lamp without a mesh, and a mast with a red light on its top.
std::vector<std::optional<BuiltModel>> litModels() {
  SourceModel lamp = test::modelOf("lamp", {SourceMesh{}}),
              mast = test::modelOf("mast", {test::ball(2, 3, 0)});
  lamp.lights = {{{0, 0, 6}, {255, 200, 120, 255}}};
  mast.lights = {{{0, 10, 40}, {255, 0, 0, 255}}, {{NAN, 0, 0}}, {{0, 0, 30000}}};
  const auto built = buildModel(mast);
  EXPECT_EQ(built.findings().size(), 1u) << toString(built.findings());
  EXPECT_NE(toString(built.findings()).find("lights within 20000 m of the model's origin, found 2 others"),
            std::string::npos)
      << toString(built.findings());
  return {*buildModel(lamp), *built};
}

TEST(BuildObjects, placesLightsWithTheirModels) {
  PlacementList list = scattered(2000, 0.3);
  const auto built = buildObjects(litModels(), list, Slope(), kFrame, "list");
  ASSERT_TRUE(built) << toString(built.findings());
  EXPECT_EQ(built->index.instances.size(), 1000u) << "lamps have no mesh";
  ASSERT_EQ(built->lights.points.size(), 2000u);
  EXPECT_EQ(built->lights.cells.size(), 8u);
  const test::ScratchDir dir;
  ASSERT_TRUE(writeObjects(dir / "objects", *built));
  const auto read = readObjects(dir / "objects");
  ASSERT_TRUE(read) << toString(read.findings());
  std::vector<Vec3> red, warm;
  for (const LightIndex::Cell& cell : built->lights.cells)
    for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
      const LightPoint& p = built->lights.points[i];
      (p.colour[1] == 0 ? red : warm)
          .push_back({16.0 * cell.origin[0] + double{p.x}, 16.0 * cell.origin[1] + double{p.y},
                      16.0 * cell.origin[2] + double{p.z}});
    }
  ASSERT_EQ(red.size(), 1000u);
  for (const ListedPlacement& p : list.placements) {
    // A lamp is above its foot; a mast's light also ahead of it, as its heading says.
    const double up = (p.model == 0 ? 6 : 40) * p.scale, ahead = p.model == 0 ? 0 : 10 * p.scale;
    const double turn = p.heading.value() * 0.017453292519943295;
    const GeodeticPosition foot{p.latitude, p.longitude, *Slope().heightAt(p.latitude, p.longitude)};
    const Mat3 axes = eastNorthUp(p.latitude, p.longitude);
    const Vec3 place = kFrame.fromGeodetic(foot) +
                       kFrame.ecefToLocal() * (axes.row[0] * (ahead * std::sin(turn)) +
                                               axes.row[1] * (ahead * std::cos(turn)) + axes.row[2] * up);
    double nearest = 1e9;
    for (const Vec3& at : p.model == 0 ? warm : red) nearest = std::min(nearest, length(at - place));
    ASSERT_LT(nearest, 0.01) << "line " << p.line;
  }
}

TEST(BuildObjects, refusesTooManyLightsByNameAndPlacesTheRest) {
  auto models = litModels();
  models[1]->lights.assign(1000000, {{0, 0, 40}});
  PlacementList list = scattered(100, 0.1);
  const auto built = buildObjects(models, list, Slope(), kFrame, "list.csv");
  ASSERT_TRUE(built) << toString(built.findings());
  EXPECT_EQ(built->lights.points.size(), 50u);
  EXPECT_EQ(built->index.instances.size(), 50u);
  EXPECT_NE(
      toString(built.findings())
          .find("list.csv: mast: expected at most 4000000 lights on a terrain, found 1000000 in each of "
                "50 rows, after 50 of other models"),
      std::string::npos)
      << toString(built.findings());
}

TEST(BuildObjects, ofLightsAloneIsATerrainToo) {
  auto models = litModels();
  PlacementList list = scattered(10, 0.1);
  for (ListedPlacement& p : list.placements) p.model = 0;
  list.placements[3].scale = 5000;  // its lamp would be 30 km high
  const auto built = buildObjects(models, list, Slope(), kFrame, "list.csv");
  ASSERT_TRUE(built) << toString(built.findings());
  EXPECT_EQ(built->lights.points.size(), 9u);
  EXPECT_TRUE(built->index.cells.empty());
  EXPECT_NE(toString(built.findings()).find("list.csv:5: scale"), std::string::npos)
      << toString(built.findings());
  const test::ScratchDir dir;
  ASSERT_TRUE(writeObjects(dir / "objects", *built));
  EXPECT_TRUE(readObjects(dir / "objects"));
}

TEST(BuildObjects, stopsWhenAsked) {
  const auto built = buildObjects(twoModels(), scattered(100, 0.1), Slope(), kFrame, "list",
                                  [](double, const std::string&) { return false; });
  EXPECT_FALSE(built);
}

}  // namespace
}  // namespace trimtab::terrain
