#include <map>
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
  int onGround = 0;
  for (const ObjectInstance& i : index.instances) {
    const auto& origin = index.cells[0].origin;
    const GeodeticPosition p = index.frame.toGeodetic(
        {origin[0] * 16.0 + double{i.x}, origin[1] * 16.0 + double{i.y}, origin[2] * 16.0 + double{i.z}});
    const auto ground = (*baked)->heightAt(p.latitude, p.longitude);
    ASSERT_TRUE(ground);
    onGround += std::abs(p.height.value() - ground->value()) < 0.05;
    if (std::abs(p.height.value() - ground->value()) >= 0.05) {
      EXPECT_NEAR(p.height.value(), 500, 0.05);
    }
  }
  EXPECT_EQ(onGround, 2);
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
