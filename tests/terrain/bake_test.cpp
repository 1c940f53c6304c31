#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <thread>

#include "rasters.h"
#include "trimtab/terrain/ground.h"
#include "trimtab/terrain/patch_terrain.h"

/// What is left on disk, and what a damaged database says.
namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

class Bake : public ::testing::Test {
 protected:
  Bake() {
    test::RasterRecipe recipe;
    recipe.columns = 90;
    recipe.rows = 70;
    recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
    source_ = test::writeRaster(dir_ / "ground.tif", recipe);
    options_.sources = {source_};
    options_.output = dir_ / "db";
  }
  test::ScratchDir dir_;
  fs::path source_;
  BakeOptions options_;
};

bool sameContents(const Database& a, const Database& b) {
  if (a.index().size() != b.index().size()) return false;
  TileMesh left, right;
  for (std::uint32_t node = 0; node < a.index().size(); ++node) {
    a.buildTile(node, left);
    b.buildTile(node, right);
    if (std::memcmp(left.vertices.data(), right.vertices.data(), left.vertices.size() * sizeof(TileVertex)) !=
        0)
      return false;
    if (!std::equal(left.origin, left.origin + 3, right.origin)) return false;
  }
  return a.index().errorM == b.index().errorM && a.index().slopeMax == b.index().slopeMax;
}

TEST_F(Bake, givesWhatOpenGives) {
  const auto made = bake(options_);
  ASSERT_TRUE(made) << toString(made.findings());
  const auto opened = Database::open(dir_ / "db");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_TRUE(sameContents(**made, **opened));
  const TerrainInfo& info = (*opened)->info();
  EXPECT_EQ(info.name, "ground");
  EXPECT_EQ(info.source, source_.string());
  EXPECT_EQ(info.columns, 90u);
  EXPECT_EQ(info.rows, 70u);
  EXPECT_EQ(info.bytes, (*made)->info().bytes);
  EXPECT_NEAR(info.southWest.longitude.value(), 10.0005, 1e-12);
  EXPECT_NEAR(info.northEast.latitude.value(), 49.9995, 1e-12);
  std::uint64_t bytes = 0;
  for (const auto& file : fs::directory_iterator(dir_ / "db")) bytes += fs::file_size(file);
  EXPECT_EQ(info.bytes, bytes);
  EXPECT_EQ(test::namesIn(dir_.path()), (std::vector<std::string>{"db", "ground.tif"}));
}

TEST_F(Bake, isTheSameToTheByteEachTime) {
  ASSERT_TRUE(bake(options_));
  std::vector<std::string> first;
  for (const std::string& name : test::namesIn(dir_ / "db"))
    first.push_back(test::readFile(dir_ / "db" / name));
  ASSERT_TRUE(bake(options_));
  std::size_t k = 0;
  for (const std::string& name : test::namesIn(dir_ / "db"))
    EXPECT_EQ(test::readFile(dir_ / "db" / name), first[k++]) << name;
}

TEST_F(Bake, isCancelledAnywhereAndGoesOnToTheSameBytes) {
  options_.output = dir_ / "undisturbed";
  ASSERT_TRUE(bake(options_));
  options_.output = dir_ / "db";
  for (const double stop : {0.0, 0.05, 0.2, 0.25, 0.3, 0.5, 0.51, 0.6, 0.75, 0.9, 1.0}) {
    options_.progress = [&](double fraction, const std::string&) {
      EXPECT_GE(fraction, 0);
      EXPECT_LE(fraction, 1);
      return fraction < stop;
    };
    const auto made = bake(options_);
    ASSERT_FALSE(made) << stop;
    EXPECT_NE(toString(made.findings()).find("cancelled"), std::string::npos);
    EXPECT_FALSE(fs::exists(dir_ / "db"));
    if (stop == 0.0) {
      EXPECT_FALSE(fs::exists(dir_ / ".db.work"));
    }
  }
  EXPECT_TRUE(fs::exists(dir_ / ".db.work"));
  options_.progress = nullptr;
  ASSERT_TRUE(bake(options_));
  EXPECT_FALSE(fs::exists(dir_ / ".db.work"));
  EXPECT_EQ(test::namesIn(dir_ / "db"), test::namesIn(dir_ / "undisturbed"));
  for (const std::string& name : test::namesIn(dir_ / "db"))
    EXPECT_EQ(test::readFile(dir_ / "db" / name), test::readFile(dir_ / "undisturbed" / name)) << name;
}

TEST_F(Bake, keepsTheOldDatabaseWhenTheNewOneFails) {
  ASSERT_TRUE(bake(options_));
  const std::string before = test::readFile(dir_ / "db/manifest.json");
  options_.progress = [](double fraction, const std::string&) { return fraction < 0.6; };
  ASSERT_FALSE(bake(options_));
  EXPECT_EQ(test::readFile(dir_ / "db/manifest.json"), before);
  EXPECT_TRUE(Database::open(dir_ / "db"));
  options_.progress = nullptr;
  options_.sources = {dir_ / "absent.tif"};
  ASSERT_FALSE(bake(options_));
  EXPECT_TRUE(Database::open(dir_ / "db"));
}

TEST_F(Bake, replacesADatabaseOfVersionOne) {
  fs::copy(test::sourceDir() / "tests/data/terrain/version-1", dir_ / "db");
  ASSERT_TRUE(bake(options_));
  EXPECT_TRUE(fs::exists(dir_ / "db/patches.pages"));
}

TEST_F(Bake, leavesWhatSomebodyPutThereMeanwhile) {
  ASSERT_TRUE(bake(options_));
  options_.progress = [&](double, const std::string& what) {
    if (what == "writing") test::writeFile(dir_ / "db/letter.txt", "dear");
    return true;
  };
  EXPECT_FALSE(bake(options_));
  EXPECT_EQ(test::readFile(dir_ / "db/letter.txt"), "dear");
  EXPECT_TRUE(Database::open(dir_ / "db"));
  fs::remove(dir_ / "db/letter.txt");
  options_.progress = nullptr;
  EXPECT_TRUE(bake(options_));
}

TEST_F(Bake, replacesADatabaseButNothingElse) {
  ASSERT_TRUE(bake(options_));
  ASSERT_TRUE(bake(options_));
  fs::create_directory(dir_ / "mine");
  test::writeFile(dir_ / "mine/letter.txt", "dear");
  options_.output = dir_ / "mine";
  ASSERT_FALSE(bake(options_));
  EXPECT_EQ(test::readFile(dir_ / "mine/letter.txt"), "dear");
  // A manifest of something else, or a file that no database holds, beside one of ours.
  for (const char* other : {"{\n  \"format\": \"web-app\"\n}", "{}", ""}) {
    test::writeFile(dir_ / "mine/manifest.json", other);
    EXPECT_FALSE(bake(options_)) << other;
    EXPECT_EQ(test::readFile(dir_ / "mine/manifest.json"), other);
  }
  fs::copy(dir_ / "db/manifest.json", dir_ / "mine/manifest.json", fs::copy_options::overwrite_existing);
  EXPECT_FALSE(bake(options_));
  EXPECT_EQ(test::readFile(dir_ / "mine/letter.txt"), "dear");
  fs::remove(dir_ / "mine/letter.txt");
  fs::create_directory(dir_ / "mine/heights.f32");
  EXPECT_FALSE(bake(options_));
  EXPECT_EQ(test::namesIn(dir_ / "mine"), (std::vector<std::string>{"heights.f32", "manifest.json"}));
  options_.output = source_;
  ASSERT_FALSE(bake(options_));
  EXPECT_TRUE(fs::is_regular_file(source_));
  options_.output = "";
  EXPECT_FALSE(bake(options_));
  options_.output = dir_ / "db2";
  options_.sources.clear();
  EXPECT_FALSE(bake(options_));
}

TEST_F(Bake, saysSoWhereItCannotWrite) {
  options_.output = "/proc/db";
  const auto made = bake(options_);
  ASSERT_FALSE(made);
  EXPECT_NE(toString(made.findings()).find("/proc/"), std::string::npos);
}

TEST_F(Bake, saysWhereALargeFileHasNoRoomAndGoesOnWhenThereIs) {
  // A limit on the size of files stands in for it.
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  rlimit little = limit;
  little.rlim_cur = 9000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
  const auto made = bake(options_);
  const auto sample = writeSample(dir_ / "sample.tif", SampleOptions{1, 20, 300, nullptr});
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, before);
  ASSERT_FALSE(made);
  EXPECT_NE(toString(made.findings()).find("heights.f32"), std::string::npos) << toString(made.findings());
  EXPECT_FALSE(sample);
  EXPECT_FALSE(fs::exists(dir_ / "sample.tif"));
  EXPECT_FALSE(fs::exists(dir_ / "db"));
  EXPECT_TRUE(bake(options_));
}

TEST_F(Bake, standsAPole) {
  test::RasterRecipe recipe;
  recipe.west = -180, recipe.north = -89.5, recipe.step = 0.5 / 49.5;
  recipe.rows = 50;
  recipe.columns = 300;
  recipe.point = true;
  recipe.value = [](int c, int r, int) { return 2800 + test::roughGround(c, r); };
  options_.sources = {test::writeRaster(dir_ / "pole.tif", recipe)};
  const auto made = bake(options_);
  ASSERT_TRUE(made) << toString(made.findings());
  const TerrainIndex& index = (*made)->index();
  TileMesh mesh;
  for (std::uint32_t node = 0; node < index.size(); ++node) {
    EXPECT_TRUE(std::isfinite(index.errorM[node]) && std::isfinite(index.slopeMax[node]));
    EXPECT_TRUE(std::isfinite(index.bounds[node].minX) && std::isfinite(index.bounds[node].maxZ));
    (*made)->buildTile(node, mesh);
    for (const TileVertex& v : mesh.vertices)
      ASSERT_TRUE(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z));
  }
}

/// Uses all of a database, whatever state it is in.
void useAll(const Database& database) {
  TileMesh mesh;
  for (std::uint32_t node = 0; node < database.index().size(); ++node) database.buildTile(node, mesh);
  const GeodeticPosition a = database.info().southWest, b = database.info().northEast;
  for (int k = 0; k <= 20; ++k)
    database.heightAt(Degrees{a.latitude.value() + (b.latitude - a.latitude).value() * k / 20},
                      Degrees{a.longitude.value() + (b.longitude - a.longitude).value() * (k * 7 % 20) / 20});
  database.highestWithin(a.latitude, a.longitude, Metres{1e5});
  if (const auto patches = database.patches())
    for (std::uint32_t page = 0; page < patches->index().pages.size(); ++page) {
      const auto read = patches->readPage(page);
      EXPECT_EQ(read.ok(), read.findings().empty());
    }
  if (const auto ground = database.ground())
    for (std::uint32_t level = 0; level < ground->shape().levels.size(); ++level) {
      const auto read = ground->readTile(level, 0, 0);
      EXPECT_EQ(read.ok(), read.findings().empty());
    }
}

TEST_F(Bake, findsAFlippedByteInAnyFile) {
  ASSERT_TRUE(bake(options_));
  for (const std::string& name : test::namesIn(dir_ / "db")) {
    const fs::path file = dir_ / "db" / name;
    const std::string whole = test::readFile(file);
    int unseen = 0;
    for (int k = 0; k < 40; ++k) {
      const std::size_t at = whole.size() * static_cast<std::size_t>(k) / 40;
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << k % 8));
      // As another file: those that are mapped must not change under their readers.
      fs::remove(file);
      test::writeFile(file, damaged);
      const auto opened = Database::open(dir_ / "db");
      if (opened) useAll(**opened);
      const Findings findings = opened ? (*opened)->checkAll() : opened.findings();
      if (findings.empty()) {
        // Between the blobs of a page file are up to fifteen bytes that nobody reads.
        EXPECT_EQ(file.extension(), ".pages") << name << " byte " << at;
        EXPECT_EQ(whole[at], 0);
        ++unseen;
        continue;
      }
      EXPECT_EQ(findings.front().where, file.string());
      EXPECT_FALSE(findings.front().expected.empty());
      EXPECT_FALSE(findings.front().found.empty());
    }
    EXPECT_LE(unseen, 3) << name;
    fs::remove(file);
    test::writeFile(file, whole);
  }
  EXPECT_TRUE(Database::open(dir_ / "db"));
}

TEST_F(Bake, tellsNoHeightWhereItsRowsAreDamaged) {
  ASSERT_TRUE(bake(options_));
  const fs::path file = dir_ / "db/heights.f32";
  std::string bytes = test::readFile(file);
  bytes[100] = static_cast<char>(bytes[100] ^ 16);
  fs::remove(file);
  test::writeFile(file, bytes);
  const auto opened = Database::open(dir_ / "db");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_TRUE((*opened)->damage().empty());
  const GeodeticPosition at = (*opened)->info().southWest;
  EXPECT_FALSE((*opened)->heightAt(at.latitude, at.longitude));
  EXPECT_FALSE((*opened)->highestWithin(at.latitude, at.longitude, Metres{1000}));
  const Findings damage = (*opened)->damage();
  ASSERT_EQ(damage.size(), 1u);
  EXPECT_EQ(damage[0].where, file.string());
  EXPECT_NE(damage[0].key.find("rows 0 to"), std::string::npos);
  EXPECT_NE(damage[0].expected.find("checksum"), std::string::npos);
}

TEST_F(Bake, refusesATruncatedLongerOrAbsentFile) {
  ASSERT_TRUE(bake(options_));
  for (const std::string& name : test::namesIn(dir_ / "db")) {
    const fs::path file = dir_ / "db" / name;
    const std::string whole = test::readFile(file);
    for (const std::string& damaged : {std::string(), whole.substr(0, 1), whole.substr(0, whole.size() / 2),
                                       whole.substr(0, whole.size() - 1), whole + "x"}) {
      if (name == "manifest.json" && damaged == whole + "x") continue;
      fs::remove(file);
      test::writeFile(file, damaged);
      const auto opened = Database::open(dir_ / "db");
      ASSERT_FALSE(opened) << name << " of " << damaged.size() << " bytes";
      EXPECT_EQ(opened.findings().front().where, file.string());
    }
    fs::remove(file);
    const auto opened = Database::open(dir_ / "db");
    ASSERT_FALSE(opened) << name;
    EXPECT_EQ(opened.findings().front().where, file.string());
    test::writeFile(file, whole);
  }
}

TEST_F(Bake, refusesAnotherVersionSayingWhich) {
  ASSERT_TRUE(bake(options_));
  std::string text = test::readFile(dir_ / "db/manifest.json");
  const std::string old = "\"version\": 2";
  text.replace(text.find(old), old.size(), "\"version\": 7");
  test::writeFile(dir_ / "db/manifest.json", text);
  const auto opened = Database::open(dir_ / "db");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.findings().front().key, "version");
  EXPECT_EQ(opened.findings().front().found, "7");
}

TEST_F(Bake, ofVersionOneStillOpens) {
  const auto opened = Database::open(test::sourceDir() / "tests/data/terrain/version-1");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_EQ((*opened)->info().columns, 40u);
  EXPECT_EQ((*opened)->index().size(), 5u);
  EXPECT_EQ((*opened)->patches(), nullptr);
  EXPECT_EQ((*opened)->ground(), nullptr);
  // As the source was made: 300 + 80 sin(column / 5) + 60 cos(row from north / 4), to a centimetre.
  const auto height = (*opened)->heightAt(Degrees{50 + 0.001 * (34 - 8)}, Degrees{10 + 0.001 * 15});
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->value(), 300 + 80 * std::sin(3.0) + 60 * std::cos(2.0), 0.01);
  EXPECT_TRUE((*opened)->checkAll().empty());
  useAll(**opened);
}

TEST_F(Bake, opensNothingThatIsNoDatabase) {
  EXPECT_FALSE(Database::open(dir_ / "nowhere"));
  EXPECT_FALSE(Database::open(source_));
  fs::create_directory(dir_ / "other");
  test::writeFile(dir_ / "other/manifest.json", "[1, 2]");
  EXPECT_FALSE(Database::open(dir_ / "other"));
  test::writeFile(dir_ / "other/manifest.json", "{\"format\": \"something\"}");
  const auto opened = Database::open(dir_ / "other");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.findings().front().key, "format");
}

TEST_F(Bake, onceIsEnoughForOpenOrBake) {
  const fs::path cache = dir_ / "cache";
  int asked = 0;
  const Progress count = [&](double, const std::string&) { return ++asked, true; };
  ASSERT_TRUE(openOrBake(source_, cache, count));
  EXPECT_GT(asked, 0);
  asked = 0;
  const auto again = openOrBake(source_, cache, count);
  ASSERT_TRUE(again);
  EXPECT_EQ(asked, 0);
  ASSERT_EQ(test::namesIn(cache).size(), 1u);
  const fs::path made = cache / test::namesIn(cache).front();
  // A database is opened as it is.
  ASSERT_TRUE(openOrBake(made, dir_ / "unused", count));
  EXPECT_EQ(asked, 0);
  EXPECT_FALSE(fs::exists(dir_ / "unused"));
  // A damaged copy is made again; a changed source is another one.
  fs::resize_file(made / "heights.f32", 10);
  ASSERT_TRUE(openOrBake(source_, cache, count));
  EXPECT_GT(asked, 0);
  fs::last_write_time(source_, fs::last_write_time(source_) + std::chrono::seconds(5));
  ASSERT_TRUE(openOrBake(source_, cache, count));
  EXPECT_EQ(test::namesIn(cache).size(), 2u);
  EXPECT_FALSE(openOrBake(dir_ / "absent", cache, count));
}

TEST_F(Bake, isReadByManyThreadsAtOnce) {
  const auto made = bake(options_);
  ASSERT_TRUE(made);
  const Database& database = **made;
  TileMesh alone;
  database.buildTile(1, alone);
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      TileMesh mesh;
      for (int k = 0; k < 200; ++k) {
        database.buildTile(
            static_cast<std::uint32_t>(k) % static_cast<std::uint32_t>(database.index().size()), mesh);
        database.buildTile(1, mesh);
        if (std::memcmp(mesh.vertices.data(), alone.vertices.data(),
                        alone.vertices.size() * sizeof(TileVertex)) != 0)
          ++wrong;
      }
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace trimtab::terrain
