#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <limits>
#include <new>
#include <thread>

#include "core/terrain/bake/heights.h"
#include "core/terrain/bake/source.h"
#include "core/terrain/bake/work.h"
#include "core/terrain/format/manifest_checksum.h"
#include "tests/core/terrain/elevation/rasters.h"
#include "tests/core/terrain/scenery/scenery_tiles.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/file_at.h"
#include "trimtab/terrain/grid/parallel.h"

/// Steps of a bake by themselves.
namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

TEST(Parallel, throwsWhatItsWorkThrew) {
  for (const std::uint32_t bad : {0u, 7u, 99u}) {
    std::atomic<int> ended{0};
    const auto work = [&](std::uint32_t i) {
      if (i >= bad) throw std::bad_alloc();
      ++ended;
    };
    EXPECT_THROW(forEachParallel(100, work, {}), std::bad_alloc);
    EXPECT_LE(ended, static_cast<int>(bad));
  }
  EXPECT_THROW(forEachParallel(
                   9, [](std::uint32_t) {}, [](double) -> bool { throw std::bad_alloc(); }),
               std::bad_alloc);
}

TEST(Parallel, stopsWorkThatAsksOnEveryThread) {
  using Clock = std::chrono::steady_clock;
  std::atomic<int> calls{0}, stopped{0};
  // Asks for at most ten seconds.
  const auto ask = [&](const GoesOn& goesOn) {
    for (const auto start = Clock::now(); Clock::now() - start < std::chrono::seconds(10);) {
      if (!goesOn()) {
        ++stopped;
        return;
      }
      std::this_thread::yield();
    }
  };
  EXPECT_FALSE(forEachParallel(
      9, [&](std::uint32_t, const GoesOn& goesOn) { ask(goesOn); }, [&](double) { return ++calls < 20; }));
  EXPECT_GE(stopped, 1);
  EXPECT_EQ(calls, 20) << "once it said no it is not asked again";

  // The calling thread is done with its own while another works on.
  if (std::thread::hardware_concurrency() < 2) return;
  const auto caller = std::this_thread::get_id();
  std::atomic<bool> begun{false};
  stopped = 0;
  const auto work = [&](std::uint32_t, const GoesOn& goesOn) {
    if (std::this_thread::get_id() != caller) {
      begun = true;
      ask(goesOn);
    } else {
      while (!begun) std::this_thread::yield();
    }
  };
  int after = 0;
  EXPECT_FALSE(forEachParallel(2, work, [&](double share) {
    EXPECT_LT(share, 1);
    return ++after < 3;
  }));
  EXPECT_EQ(stopped, 1);
}

TEST(ReadAt, leavesNoOldErrorAtTheFilesEnd) {
  const test::ScratchDir dir;
  test::writeFile(dir / "short", "four");
  const int file = ::open((dir / "short").c_str(), O_RDONLY);
  char data[8];
  errno = EIO;
  EXPECT_FALSE(readAt(file, 0, data, sizeof data));
  EXPECT_EQ(errno, 0);
  ::close(file);
}

/// Bands that were damaged are read again, in bands of another size.
TEST(HeightsBake, countsItsVoidsWhenBandsOfAnotherSizeWereReadAgain) {
  const test::ScratchDir dir;
  HeightGrid grid;
  grid.posts = {10, 50, 0.001, 0.001, 40, 30};
  for (std::uint32_t i = 0; i < grid.posts.size(); ++i)
    grid.heights.push_back(i % 40 == 3 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(i));
  const std::size_t row = 40 * sizeof(float);
  const auto work = WorkFolder::open(dir / "db", "{}", WorkFolder::Use::alone);
  ASSERT_TRUE(work) << toString(work.findings());
  const auto source = sourceOf(grid);
  int told = 0;
  EXPECT_FALSE(
      bakeHeights(**work, *source, row * 16 * 7, [&](double, const std::string&) { return ++told <= 3; }));
  ASSERT_EQ((*work)->journal().size(), 4u);
  {
    std::fstream file((*work)->database() / "heights.f32", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(2 * row));
    file.write("damaged", 7);
  }
  for (int turn = 0; turn < 2; ++turn) {
    const auto made = bakeHeights(**work, *source, row * 16 * 4, {});
    ASSERT_TRUE(made) << toString(made.findings());
    EXPECT_EQ(made->voids, 30u) << turn;
  }
}

/// What meshes are made of, whatever the sources leave open: nothing there is no height.
TEST(HeightsBake, fillsEveryPostWhateverTheSourcesLeaveOpen) {
  const test::ScratchDir dir;
  test::RasterRecipe voids, beside, turned, nothing;
  voids.noData = -32768;
  voids.value = [](int c, int r, int) {
    constexpr double kNone[] = {std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity(), -32768, 1e30};
    return c / 8 % 2 == 1 && r / 5 % 3 == 1 ? kNone[c % 4] : test::roughGround(c, r);
  };
  beside.west = 10.1;
  turned.crs = "EPSG:32632";
  turned.west = 570000, turned.north = 5541000, turned.step = 50;
  nothing.value = [](int, int, int) { return std::numeric_limits<double>::quiet_NaN(); };
  const auto raster = [&](const char* name, const test::RasterRecipe& recipe) {
    return test::writeRaster(dir / name, recipe);
  };
  const fs::path tile = dir / "3072816.btg";
  test::TileRecipe hole;
  hole.hole = true;
  test::writeFile(tile, test::gridTile(hole));
  test::RasterRecipe hills;
  hills.west = 7.3, hills.north = 50.7, hills.step = 0.002;
  hills.value = [](int c, int r, int) { return c == r ? std::nan("") : test::roughGround(c, r); };

  const std::vector<std::vector<fs::path>> all{{raster("voids.tif", voids)},
                                               {raster("voids.tif", voids), raster("beside.tif", beside)},
                                               {raster("turned.tif", turned)},
                                               {raster("nothing.tif", nothing)},
                                               {tile},
                                               {tile, raster("hills.tif", hills)}};
  for (const std::vector<fs::path>& sources : all) {
    SCOPED_TRACE(sources.back().string());
    BakeOptions options;
    options.sources = sources;
    options.output = dir / "db";
    const auto files = sourceFiles(sources);
    ASSERT_TRUE(files);
    const auto source = readSource(options, std::size_t{1} << 28, {});
    ASSERT_TRUE(source) << toString(source.findings());
    const auto work = WorkFolder::open(options.output, recipeOf(options, *files), WorkFolder::Use::alone);
    ASSERT_TRUE(work) << toString(work.findings());
    const auto made = bakeHeights(**work, *(*source)->elevation, std::size_t{1} << 28, {});
    ASSERT_TRUE(made) << toString(made.findings());
    EXPECT_GT(made->voids + made->outside, 0u);
    const auto heights = FileHeights::open(**work, *made);
    ASSERT_TRUE(heights) << toString(heights.findings());
    std::vector<float> posts(made->posts.size());
    (*heights)->read({0, 0, made->posts.columns, made->posts.rows}, 1, posts);
    EXPECT_TRUE(std::all_of(posts.begin(), posts.end(), [](float z) { return std::isfinite(z); }));
    EXPECT_FALSE((*heights)->failed());
  }
}

class SmallBake : public ::testing::Test {
 protected:
  SmallBake() {
    test::RasterRecipe recipe;
    recipe.columns = 300;
    recipe.rows = 300;
    recipe.value = [](int c, int r, int) { return test::roughGround(c, r); };
    options_.sources = {test::writeRaster(dir_ / "ground.tif", recipe)};
    options_.output = dir_ / "db";
  }
  test::ScratchDir dir_;
  BakeOptions options_;
};

TEST_F(SmallBake, opensWhereItsTilesWereLeftOut) {
  ASSERT_TRUE(bake(options_));
  const fs::path manifest = dir_ / "db/manifest.json";
  std::string text = test::readFile(manifest);
  for (const std::string name : {"nodes.f32", "slopes.u8"}) {
    const std::size_t at = text.find('"' + name + '"'), end = text.find('}', at);
    ASSERT_NE(at, std::string::npos);
    // With the comma before it, if it is the last.
    const std::size_t from = text[end + 1] == ',' ? at : text.rfind(',', at);
    text.erase(from, (text[end + 1] == ',' ? end + 2 : end + 1) - from);
    fs::remove(dir_ / "db" / name);
  }
  const std::size_t place = manifestChecksumPlace(text);
  text.replace(place, 16, manifestChecksum(text, place));
  test::writeFile(manifest, text);
  const auto opened = Database::open(dir_ / "db");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_EQ((*opened)->index().size(), 0u);
  ASSERT_TRUE((*opened)->patches());
  EXPECT_TRUE((*opened)->checkAll().empty());
  const TerrainInfo& info = (*opened)->info();
  EXPECT_TRUE((*opened)->heightAt(info.southWest.latitude, info.southWest.longitude));
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// A process may be refused memory at any moment.
TEST_F(SmallBake, saysSoWhereThereIsNoMemory) {
  int refused = 0;
  for (const std::size_t megabytes : {0, 1, 9, 10, 12, 20}) {
    const pid_t child = ::fork();
    if (child == 0) {
      options_.progress = [&, limited = false](double, const std::string& what) mutable {
        if (limited || what != "building patches") return true;
        limited = true;
        std::size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t most = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + (megabytes << 20);
        const rlimit limit{most, most};
        ::setrlimit(RLIMIT_AS, &limit);
        return true;
      };
      const auto made = bake(options_);
      const std::string said = toString(made.findings());
      ::_exit(made ? 0 : said.find("memory") != said.npos || said.find("thread") != said.npos ? 1 : 2);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status) << " with " << megabytes << " MB";
    EXPECT_LE(WEXITSTATUS(status), 1) << megabytes;
    refused += WEXITSTATUS(status) == 1;
  }
  EXPECT_GT(refused, 0);
  // What was done by then serves.
  ASSERT_TRUE(bake(options_));
}
#endif

}  // namespace
}  // namespace trimtab::terrain
