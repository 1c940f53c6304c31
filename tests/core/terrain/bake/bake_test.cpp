#include <sys/resource.h>

#include <fstream>
#include <thread>

#include "bake_support.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/synthetic/sample.h"

/// What is left on disk.
namespace trimtab::terrain {
namespace {

class Bake : public BakeFixture {};

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
  for (const double stop : {0.0, 0.05, 0.2, 0.25, 0.3, 0.5, 0.51, 0.6, 0.71, 0.75, 0.9, 1.0}) {
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

TEST_F(Bake, keepsNothingOfHeightsThatCouldNotBeRead) {
  options_.output = dir_ / "undisturbed";
  ASSERT_TRUE(bake(options_));
  options_.output = dir_ / "db";
  // No other thread maps them then.
  options_.memory = Megabytes{64};
  std::string heights;
  fs::path file;
  options_.progress = [&](double, const std::string& what) {
    if (what != "building patches" || !file.empty()) return true;
    for (const auto& entry : fs::recursive_directory_iterator(dir_ / ".db.work"))
      if (entry.path().filename() == "heights.f32") file = entry.path();
    heights = test::readFile(file);
    fs::resize_file(file, heights.size() / 2);
    return true;
  };
  const auto made = bake(options_);
  ASSERT_FALSE(made);
  EXPECT_NE(toString(made.findings()).find("heights.f32"), std::string::npos) << toString(made.findings());
  ASSERT_FALSE(file.empty());
  std::ofstream(file, std::ios::binary) << heights;
  options_.progress = nullptr;
  ASSERT_TRUE(bake(options_));
  for (const std::string& name : test::namesIn(dir_ / "undisturbed"))
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

/// Whatever part of it there is no room for: tiles, or what GDAL keeps until it closes the file.
TEST_F(Bake, namesNoHeightsThatTheDiskHadNoRoomFor) {
  const SampleOptions sample{1, 20, 300, nullptr};
  const fs::path whole = dir_ / "whole.tif", part = dir_ / "part.tif";
  ASSERT_TRUE(writeSample(whole, sample));
  const rlim_t size = fs::file_size(whole);
  failLargeWrites();
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  for (const rlim_t lacks : {rlim_t{1}, rlim_t{8}, rlim_t{100}, rlim_t{1000}, size / 2, size - 8, size}) {
    rlimit little = limit;
    little.rlim_cur = size - lacks;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
    const auto written = writeSample(part, sample);
    setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_FALSE(written) << lacks << " of " << size;
    EXPECT_FALSE(fs::exists(part));
  }
  EXPECT_TRUE(writeSample(part, sample));
  EXPECT_EQ(test::readFile(part), test::readFile(whole));
}

TEST_F(Bake, saysWhereALargeFileHasNoRoomAndGoesOnWhenThereIs) {
  // A limit on the size of files stands in for it.
  failLargeWrites();
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  rlimit little = limit;
  little.rlim_cur = 9000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &little), 0);
  const auto made = bake(options_);
  const auto sample = writeSample(dir_ / "sample.tif", SampleOptions{1, 20, 300, nullptr});
  setrlimit(RLIMIT_FSIZE, &limit);
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

/// Rounded steps take the last row past the pole.
TEST_F(Bake, endsOnThePoles) {
  test::RasterRecipe recipe;
  recipe.step = 0.01;
  recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
  for (const double beyond : {0.0004, -0.0004}) {
    recipe.north = beyond > 0 ? 90.005 + beyond : -90.005 + beyond + 65 * recipe.step;
    options_.sources = {test::writeRaster(source_, recipe)};
    const auto made = bake(options_);
    ASSERT_TRUE(made) << toString(made.findings());
    const TerrainInfo& info = (*made)->info();
    EXPECT_EQ(info.rows, 65u);
    const double pole = (beyond > 0 ? info.northEast : info.southWest).latitude.value(),
                 other = (beyond > 0 ? info.southWest : info.northEast).latitude.value();
    EXPECT_NEAR(pole, beyond > 0 ? 90 : -90, 1e-9);
    EXPECT_NEAR(other, beyond > 0 ? 89.3604 : -89.3604, 1e-9);
    const std::string bytes = test::readFile(dir_ / "db/heights.f32");
    const auto* heights = reinterpret_cast<const float*>(bytes.data());
    for (int r = 0; r < 65; ++r)
      for (int c = 0; c < 65; ++c)
        ASSERT_EQ(heights[(64 - r) * 65 + c], static_cast<float>(test::roughGround(c, r)));
  }
}

/// What no database can hold is told of before the old one goes.
TEST_F(Bake, refusesGridsThatCouldNotBeOpened) {
  ASSERT_TRUE(bake(options_));
  const std::string before = test::readFile(dir_ / "db/manifest.json");
  struct Bad {
    double west, north, step;
    const char* said;
  };
  for (const Bad& bad : {Bad{5000, 50, 0.001, "-540 to 540, found 5000"}, Bad{10, 50, 1e-12, "1e-09 to 180"},
                         Bad{10, 90.01, 0.001, "-90 to 90"}, Bad{10, -89.9, 0.01, "-90 to 90"}}) {
    test::RasterRecipe recipe;
    recipe.west = bad.west, recipe.north = bad.north, recipe.step = bad.step;
    const fs::path file = test::writeRaster(dir_ / "bad.tif", recipe);
    options_.sources = {file};
    options_.progress = [](double, const std::string& what) { return what != "reading heights"; };
    const auto made = bake(options_);
    ASSERT_FALSE(made);
    const std::string said = toString(made.findings());
    EXPECT_NE(said.find(bad.said), std::string::npos) << said;
    EXPECT_NE(said.find(file.string()), std::string::npos) << said;
    EXPECT_EQ(test::readFile(dir_ / "db/manifest.json"), before);
  }
}

TEST_F(Bake, isOpenedBeforeItTakesThePlaceOfTheOld) {
  ASSERT_TRUE(bake(options_));
  const std::string before = test::readFile(dir_ / "db/manifest.json");
  options_.maxError = Metres{60};
  options_.progress = [&](double, const std::string& what) {
    if (what == "writing") fs::resize_file(dir_ / ".db.work/database/heights.f32", 10);
    return true;
  };
  const auto made = bake(options_);
  ASSERT_FALSE(made);
  EXPECT_NE(toString(made.findings()).find("what was there is as it was"), std::string::npos)
      << toString(made.findings());
  EXPECT_EQ(test::readFile(dir_ / "db/manifest.json"), before);
  options_.progress = nullptr;
  const auto again = bake(options_);
  ASSERT_TRUE(again) << toString(again.findings());
  EXPECT_NE(test::readFile(dir_ / "db/manifest.json"), before);
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
