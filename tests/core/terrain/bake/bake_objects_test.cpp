#include <map>
#include <random>
#include <sstream>

#include "bake_support.h"
#include "tests/core/terrain/objects/model_support.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/units/number.h"

/// Bakes with objects; their models come from formulas, by name.
namespace trimtab::terrain {
namespace {

class BakeObjects : public BakeFixture {
 protected:
  BakeObjects() {
    const auto plain = bake(options_);
    EXPECT_TRUE(plain) << toString(plain.findings());
    EXPECT_EQ((*plain)->objects(), nullptr);
    const TerrainInfo info = (*plain)->info();
    south_ = info.southWest;
    north_ = info.northEast;
    fs::remove_all(options_.output);
    options_.objects = dir_ / "list.csv";
    options_.readModel = [this](const fs::path& file) -> Result<SourceModel> {
      if (file.filename() == "gone.obj")
        return Finding{Severity::error, file.string(), "", "a model's file", "none"};
      EXPECT_EQ(file.parent_path(), dir_.path());
      return test::modelOf(file.string(),
                           {test::ball(8, file.filename() == "large.obj" ? 9.0f : size_, 0.1f)});
    };
    write("large.obj,50,50,,0,1\nsmall.obj,20,70,,30,2\nsmall.obj,80,10,500,60,1\n");
  }
  /// Writes placements whose latitudes and longitudes are hundredths of the terrain.
  void write(const std::string& rows) const {
    std::string text = "model,latitude_deg,longitude_deg,height_m,heading_deg,scale\n";
    std::istringstream in(rows);
    for (std::string row; std::getline(in, row); text += '\n') {
      std::istringstream cells(row);
      std::string model, latitude, longitude, rest;
      std::getline(cells, model, ',');
      std::getline(cells, latitude, ',');
      std::getline(cells, longitude, ',');
      std::getline(cells, rest);
      text += model + ',' + numberText(at(south_.latitude, north_.latitude, latitude)) + ',' +
              numberText(at(south_.longitude, north_.longitude, longitude)) + ',' + rest;
    }
    test::writeFile(dir_ / "list.csv", text);
  }
  static double at(Degrees low, Degrees high, const std::string& hundredths) {
    return low.value() + (high - low).value() * std::stod(hundredths) / 100;
  }
  std::string said(const Findings& findings) const { return toString(findings); }

  GeodeticPosition south_, north_;
  float size_ = 4;
};

/// Looks through all triangles of all smallest patches for the one over or under a place.
double drawnHeight(const Database& database, const GeodeticPosition& at) {
  const PatchTerrain& patches = *database.patches();
  const PatchIndex& index = patches.index();
  for (std::uint32_t number = 0; number < index.pages.size(); ++number) {
    const auto page = patches.readPage(number);
    for (std::uint32_t i = 0; i < page->patches.size(); ++i) {
      if (index.children[index.pages[number].firstPatch + i][0] != PatchIndex::kNone) continue;
      const PatchMesh& mesh = page->patches[i];
      for (std::uint32_t k = mesh.firstIndex[0]; k < mesh.firstIndex[1]; k += 3) {
        Vec3 corner[3];
        for (std::uint32_t c = 0; c < 3; ++c) {
          const PatchVertex& v = mesh.vertices[mesh.indices[k + c]];
          const GeodeticPosition p = index.frame.toGeodetic({mesh.origin[0] * 16.0 + double{v.x},
                                                             mesh.origin[1] * 16.0 + double{v.y},
                                                             mesh.origin[2] * 16.0 + double{v.z}});
          corner[c] = {(p.longitude - at.longitude).value(), (p.latitude - at.latitude).value(),
                       p.height.value()};
        }
        const auto area = [](Vec3 a, Vec3 b) { return a.x * b.y - a.y * b.x; };
        const double a = area(corner[1], corner[2]), b = area(corner[2], corner[0]),
                     c = area(corner[0], corner[1]);
        if (a >= 0 && b >= 0 && c >= 0 && a + b + c > 0)
          return (a * corner[0].z + b * corner[1].z + c * corner[2].z) / (a + b + c);
      }
    }
  }
  return NAN;
}

TEST_F(BakeObjects, standOnTheGroundAsItIsDrawn) {
  // Coarse patches, metres from the posts.
  options_.maxError = Metres{8};
  std::string rows;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> hundredths(0, 100);
  for (int i = 0; i < 120; ++i)
    rows += "small.obj," + std::to_string(hundredths(random)) + ',' + std::to_string(hundredths(random)) +
            ",,0,1\n";
  rows += "small.obj,0,0,,0,1\nsmall.obj,100,100,,0,1\nsmall.obj,0,100,,0,1\nsmall.obj,50,100,,0,1\n";
  write(rows);
  const auto baked = bake(options_);
  ASSERT_TRUE(baked) << said(baked.findings());
  const ObjectIndex& index = (*baked)->objects()->index;
  ASSERT_EQ(index.instances.size(), 124u);
  double farthestFromPosts = 0;
  for (std::uint32_t c = 0; c < index.cells.size(); ++c)
    for (std::uint32_t i = 0; index.cells[c].isLeaf(c) && i < index.cells[c].instances; ++i) {
      const ObjectInstance& o = index.instances[index.cells[c].firstInstance + i];
      const auto& origin = index.cells[c].origin;
      GeodeticPosition p = index.frame.toGeodetic(
          {origin[0] * 16.0 + double{o.x}, origin[1] * 16.0 + double{o.y}, origin[2] * 16.0 + double{o.z}});
      // Corners on the border are rounded to 1/256 m.
      p.latitude = Degrees{
          std::clamp(p.latitude.value(), south_.latitude.value() + 2e-7, north_.latitude.value() - 2e-7)};
      p.longitude = Degrees{
          std::clamp(p.longitude.value(), south_.longitude.value() + 2e-7, north_.longitude.value() - 2e-7)};
      EXPECT_NEAR(p.height.value(), drawnHeight(**baked, p), 0.05);
      if (const auto posts = (*baked)->heightAt(p.latitude, p.longitude))
        farthestFromPosts = std::max(farthestFromPosts, std::abs(p.height.value() - posts->value()));
    }
  EXPECT_GT(farthestFromPosts, 2) << "the drawn ground is that of the posts, so nothing is tested";
}

TEST_F(BakeObjects, standInTheDatabaseOnItsGround) {
  const auto baked = bake(options_);
  ASSERT_TRUE(baked) << said(baked.findings());
  const auto objects = (*baked)->objects();
  ASSERT_NE(objects, nullptr);
  const ObjectIndex& index = objects->index;
  EXPECT_EQ(index.frame.origin(), (*baked)->index().frame.origin());
  EXPECT_EQ(objects->names, (std::vector<std::string>{"large.obj", "small.obj"}));
  ASSERT_EQ(index.instances.size(), 3u);
  ASSERT_EQ(index.cells.size(), 1u);
  int given = 0;
  for (const ObjectInstance& i : index.instances) {
    const auto& origin = index.cells[0].origin;
    const GeodeticPosition p = index.frame.toGeodetic(
        {origin[0] * 16.0 + double{i.x}, origin[1] * 16.0 + double{i.y}, origin[2] * 16.0 + double{i.z}});
    if (std::abs(p.height.value() - 500) < 0.05)
      ++given;
    else
      EXPECT_NEAR(p.height.value(), drawnHeight(**baked, p), 0.05);
  }
  EXPECT_EQ(given, 1);
  EXPECT_TRUE((*baked)->checkAll().empty());
  // Other files do not depend on them.
  const std::string heights = test::readFile(options_.output / kHeightsName),
                    patches = test::readFile(options_.output / kPatchesName);
  options_.objects.reset();
  ASSERT_TRUE(bake(options_));
  EXPECT_FALSE(fs::exists(options_.output / kObjectsName));
  EXPECT_EQ(test::readFile(options_.output / kHeightsName), heights);
  EXPECT_EQ(test::readFile(options_.output / kPatchesName), patches);
}

TEST_F(BakeObjects, areRefusedWhereTheirFileIsDamagedOrAnothers) {
  ASSERT_TRUE(bake(options_));
  const fs::path file = options_.output / kObjectsName;
  const std::string whole = test::readFile(file);
  const auto open = Database::open(options_.output);
  ASSERT_TRUE(open);
  std::string bytes = whole;
  bytes[bytes.size() / 2] ^= 1;
  test::writeFile(file, bytes);
  EXPECT_FALSE((*open)->checkAll().empty());
  EXPECT_FALSE(Database::open(options_.output));
  // Whole, but of another bake.
  ASSERT_TRUE(writeObjects(file, ObjectTerrain{}));
  const auto other = Database::open(options_.output);
  ASSERT_FALSE(other);
  EXPECT_NE(said(other.findings()).find("as the manifest says"), std::string::npos) << said(other.findings());
  fs::remove(file);
  EXPECT_FALSE(Database::open(options_.output));
  test::writeFile(file, whole);
  EXPECT_TRUE(Database::open(options_.output));
}

std::map<std::string, std::string> contentsOf(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const std::string& name : test::namesIn(folder)) all[name] = test::readFile(folder / name);
  return all;
}

TEST_F(BakeObjects, areTheSameAfterAnInterruptionAndOthersWithAnotherModel) {
  ASSERT_TRUE(bake(options_));
  const auto whole = contentsOf(options_.output);
  fs::remove_all(options_.output);
  for (const char* stop : {"levels of models", "placing objects"}) {
    options_.progress = [stop](double, const std::string& what) { return what != stop; };
    EXPECT_FALSE(bake(options_)) << stop;
    EXPECT_TRUE(fs::exists(dir_ / ".db.work"));
  }
  options_.progress = {};
  const auto again = bake(options_);
  ASSERT_TRUE(again);
  EXPECT_NE(said(again.findings()).find("goes on"), std::string::npos);
  EXPECT_EQ(contentsOf(options_.output), whole);
  const std::string checksum = (*again)->info().checksum;
  // A model that holds something else makes another database, though no file's name or time changed.
  options_.progress = [](double, const std::string& what) { return what != "placing objects"; };
  EXPECT_FALSE(bake(options_));
  options_.progress = {};
  size_ = 4.5f;
  const auto other = bake(options_);
  ASSERT_TRUE(other);
  EXPECT_EQ(said(other.findings()).find("goes on"), std::string::npos);
  EXPECT_NE((*other)->info().checksum, checksum);
  EXPECT_NE(test::readFile(options_.output / kManifestName), whole.at(kManifestName));
}

TEST_F(BakeObjects, ofPartsAreTheSame) {
  ASSERT_TRUE(bake(options_));
  const auto whole = contentsOf(options_.output);
  fs::remove_all(options_.output);
  ASSERT_TRUE(bakePart(options_, 1, 2));
  ASSERT_TRUE(bakePart(options_, 2, 2));
  ASSERT_TRUE(bakeJoin(options_));
  EXPECT_EQ(contentsOf(options_.output), whole);
}

TEST_F(BakeObjects, leaveOutWhatCannotBeUsedByName) {
  write(
      "large.obj,50,50,,0,1\ngone.obj,20,70,,30,2\ngone.obj,20,71,,30,2\nsmall.obj,300,10,,60,1\nsmall.obj,8,"
      "8,,,0\n");
  const auto baked = bake(options_);
  ASSERT_TRUE(baked);
  EXPECT_EQ((*baked)->objects()->index.instances.size(), 1u);
  const std::string all = said(baked.findings());
  for (const char* part :
       {"gone.obj: expected a model's file", "gone.obj: expected a model that can be used, found 2 rows",
        "list.csv:5: expected a place on the terrain", "list.csv:6: scale"})
    EXPECT_NE(all.find(part), std::string::npos) << all;
  EXPECT_FALSE(hasError(baked.findings()));
}

TEST_F(BakeObjects, areRefusedBeforeAnythingIsBaked) {
  write("gone.obj,50,50,,0,1\n");
  const auto none = bake(options_);
  ASSERT_FALSE(none);
  EXPECT_NE(said(none.findings()).find("at least one model"), std::string::npos) << said(none.findings());
  EXPECT_FALSE(fs::exists(dir_ / ".db.work"));
  options_.objects = dir_ / "absent.csv";
  EXPECT_FALSE(bake(options_));
  options_.objects = dir_ / "list.csv";
  std::string rows;
  for (int i = 0; i < 300000; ++i) rows += "large.obj,50,50,,0,1\n";
  write(rows);
  options_.memory = Megabytes{64};
  const auto large = bake(options_);
  ASSERT_FALSE(large);
  EXPECT_NE(said(large.findings()).find("--memory-mb"), std::string::npos) << said(large.findings());
  EXPECT_FALSE(fs::exists(dir_ / ".db.work"));
  EXPECT_FALSE(fs::exists(options_.output));
}

}  // namespace
}  // namespace trimtab::terrain
