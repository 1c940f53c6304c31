#include "tests/core/terrain/ground/build_and_open.h"
#include "trimtab/terrain/format/ground_pyramid.h"

#include <GeographicLib/LocalCartesian.hpp>

#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "ground_support.h"
#include "trimtab/terrain/format/page_file.h"

namespace trimtab::terrain {
namespace {

using test::GroundLand;
using test::Picture;

double linear(int srgb) {
  const double s = srgb / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}
double srgb(double light) {
  return 255 * (light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}
Vec3 normalOf(const GroundTexel& t) {
  const double x = t.normalX / 127.0, y = t.normalY / 127.0;
  return {x, y, std::sqrt(std::max(0.0, 1 - x * x - y * y))};
}

/// Every texel of a level against the four under it, in double.
void expectHalved(const Picture& fine, const Picture& coarse) {
  ASSERT_EQ(coarse.columns, (fine.columns + 1) / 2);
  ASSERT_EQ(coarse.rows, (fine.rows + 1) / 2);
  for (std::uint32_t r = 0; r < coarse.rows; ++r)
    for (std::uint32_t c = 0; c < coarse.columns; ++c) {
      double light[3] = {}, voids = 0;
      Vec3 normal{};
      for (const std::uint32_t y : {2 * r, 2 * r + 1})
        for (const std::uint32_t x : {2 * c, 2 * c + 1}) {
          const GroundTexel& t = fine.at(std::min(x, fine.columns - 1), std::min(y, fine.rows - 1));
          light[0] += linear(t.red) / 4, light[1] += linear(t.green) / 4, light[2] += linear(t.blue) / 4;
          voids += t.voids / 4.0;
          normal = normal + normalOf(t);
        }
      normal = normalized(normal);
      const GroundTexel& found = coarse.at(c, r);
      ASSERT_NEAR(found.red, srgb(light[0]), 0.6) << c << ", " << r;
      ASSERT_NEAR(found.green, srgb(light[1]), 0.6) << c << ", " << r;
      ASSERT_NEAR(found.blue, srgb(light[2]), 0.6) << c << ", " << r;
      ASSERT_NEAR(found.voids, voids, 0.5) << c << ", " << r;
      ASSERT_NEAR(found.normalX, 127 * normal.x, 0.6) << c << ", " << r;
      ASSERT_NEAR(found.normalY, 127 * normal.y, 0.6) << c << ", " << r;
    }
}

std::shared_ptr<const GroundPyramid> built(const GroundSources& sources) {
  auto pyramid = test::buildAndOpenGround(sources);
  EXPECT_TRUE(pyramid) << toString(pyramid.findings());
  return pyramid ? *pyramid : nullptr;
}

TEST(Ground, everyLevelIsTheMeanOfTheOneBelowInLinearLight) {
  struct Size {
    std::uint32_t columns, rows;
  };
  for (const auto [columns, rows] :
       {Size{2, 2}, Size{256, 256}, Size{257, 255}, Size{1201, 700}, Size{513, 3}, Size{1025, 1025}}) {
    GroundLand land(columns, rows);
    const auto pyramid = built(land.sources());
    ASSERT_TRUE(pyramid);
    const GroundShape& shape = pyramid->shape();
    EXPECT_EQ(shape.levels[0], (GroundShape::Level{columns, rows}));
    EXPECT_EQ(shape.levels.back().tileColumns() * shape.levels.back().tileRows(), 1u);
    for (std::uint32_t l = 0; l + 1 < shape.levels.size(); ++l) {
      SCOPED_TRACE(testing::Message() << columns << " x " << rows << ", level " << l + 1);
      expectHalved(test::readLevel(*pyramid, l), test::readLevel(*pyramid, l + 1));
    }
  }
}

TEST(Ground, repeatsTheLastTexelPastItsBorders) {
  GroundLand land(700, 300);
  const auto pyramid = built(land.sources());
  ASSERT_TRUE(pyramid);
  for (std::uint32_t l = 0; l < pyramid->shape().levels.size(); ++l) {
    const GroundShape::Level& level = pyramid->shape().levels[l];
    for (std::uint32_t row = 0; row < level.tileRows(); ++row)
      for (std::uint32_t column = 0; column < level.tileColumns(); ++column) {
        const auto tile = pyramid->readTile(l, column, row);
        ASSERT_TRUE(tile);
        for (std::uint32_t r = 0; r < 256; ++r)
          for (std::uint32_t c = 0; c < 256; ++c) {
            const std::uint32_t inC = std::min(c, level.columns - 1 - column * 256),
                                inR = std::min(r, level.rows - 1 - row * 256);
            ASSERT_TRUE((*tile)[r * 256 + c] == (*tile)[inR * 256 + inC]);
          }
      }
    EXPECT_FALSE(pyramid->readTile(l, level.tileColumns(), 0));
  }
}

TEST(Ground, normalsAreThoseOfTheFinestSurface) {
  GroundLand land(300, 280);
  const auto pyramid = built(land.sources());
  ASSERT_TRUE(pyramid);
  const Picture finest = test::readLevel(*pyramid, 0);
  const PostGrid& posts = land.grid.posts;
  const auto& origin = land.geometry.frame().origin();
  const GeographicLib::LocalCartesian oracle(origin.latitude.value(), origin.longitude.value(), 0);
  const auto place = [&](std::uint32_t c, std::uint32_t r) {
    Vec3 p;
    oracle.Forward(posts.latitude(r), posts.longitude(c),
                   static_cast<double>(land.grid.heights[std::size_t{r} * posts.columns + c]), p.x, p.y, p.z);
    return p;
  };
  for (std::uint32_t r = 1; r + 1 < posts.rows; ++r)
    for (std::uint32_t c = 1; c + 1 < posts.columns; ++c) {
      Vec3 across{}, along{};
      for (const int k : {-1, 0, 1}) {
        const double weight = k == 0 ? 2 : 1;
        across = across + (place(c + 1, r + static_cast<std::uint32_t>(k)) -
                           place(c - 1, r + static_cast<std::uint32_t>(k))) *
                              weight;
        along = along + (place(c + static_cast<std::uint32_t>(k), r + 1) -
                         place(c + static_cast<std::uint32_t>(k), r - 1)) *
                            weight;
      }
      const Vec3 n = normalized(cross(across, along));
      ASSERT_NEAR(finest.at(c, r).normalX, 127 * n.x, 1.2) << c << ", " << r;
      ASSERT_NEAR(finest.at(c, r).normalY, 127 * n.y, 1.2) << c << ", " << r;
    }
}

TEST(Ground, saysWhichVoidsWereFilled) {
  GroundLand land(300, 300);
  land.voids.assign(land.grid.posts.size(), 0);
  for (std::uint32_t r = 100; r < 140; ++r)
    for (std::uint32_t c = 31; c < 64; ++c) land.voids[std::size_t{r} * 300 + c] = 1;
  const auto pyramid = built(land.sources());
  ASSERT_TRUE(pyramid);
  const Picture finest = test::readLevel(*pyramid, 0), next = test::readLevel(*pyramid, 1);
  for (std::uint32_t r = 0; r < 300; ++r)
    for (std::uint32_t c = 0; c < 300; ++c)
      ASSERT_EQ(finest.at(c, r).voids, land.voids[std::size_t{r} * 300 + c] ? 255 : 0);
  EXPECT_EQ(next.at(15, 60).voids, 128);
  EXPECT_EQ(next.at(20, 60).voids, 255);
}

TEST(Ground, coarserThanThePostsIsTheirMean) {
  GroundLand land(701, 600);
  GroundSources sources = land.sources();
  const auto fine = built(sources);
  for (const double texels : {0.5, 0.25, 0.125, 1.0 / 64}) {
    sources.texelsPerPost = texels;
    const auto coarse = built(sources);
    ASSERT_TRUE(fine && coarse);
    const auto skipped = static_cast<std::uint32_t>(-std::log2(texels));
    for (std::uint32_t l = 0; l < coarse->shape().levels.size(); ++l) {
      if (l + skipped >= fine->shape().levels.size()) continue;
      EXPECT_TRUE(test::readLevel(*coarse, l) == test::readLevel(*fine, l + skipped)) << texels << ", " << l;
    }
  }
  GroundLand smallest(2, 2);
  sources = smallest.sources();
  sources.texelsPerPost = 1.0 / 64;
  const auto one = built(sources);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->shape().levels, (std::vector<GroundShape::Level>{{1, 1}}));
  EXPECT_TRUE(one->readTile(0, 0, 0));
}

TEST(Ground, finerThanThePostsKeepsTheirTexels) {
  GroundLand land(300, 200);
  GroundSources sources = land.sources();
  const auto posts = built(sources);
  sources.texelsPerPost = 4;
  const auto fine = built(sources);
  ASSERT_TRUE(posts && fine);
  const Picture a = test::readLevel(*posts, 0), b = test::readLevel(*fine, 0);
  EXPECT_EQ(b.columns, 299u * 4 + 1);
  for (std::uint32_t r = 0; r < 200; ++r)
    for (std::uint32_t c = 0; c < 300; ++c) ASSERT_TRUE(a.at(c, r) == b.at(4 * c, 4 * r));
  // In the middle of four posts, between them.
  for (std::uint32_t r = 0; r < 199; ++r)
    for (std::uint32_t c = 0; c < 299; ++c) {
      const double mean =
          (a.at(c, r).red + a.at(c + 1, r).red + a.at(c, r + 1).red + a.at(c + 1, r + 1).red) / 4.0;
      ASSERT_NEAR(b.at(4 * c + 2, 4 * r + 2).red, mean, 0.6);
    }
}

TEST(Ground, isTheSameFromAFileAndFromParts) {
  GroundLand land(2500, 1500);
  for (const double texels : {1.0, 0.125}) {
    GroundSources sources = land.sources();
    sources.texelsPerPost = texels;
    test::ScratchDir dir;
    ASSERT_TRUE(buildGround(sources, dir / "whole", {}));
    const auto opened = openGround(dir / "whole", land.grid.posts);
    ASSERT_TRUE(opened) << toString(opened.findings());
    const auto inMemory = built(sources);
    ASSERT_EQ((*opened)->shape(), inMemory->shape());
    for (std::uint32_t l = 0; l < inMemory->shape().levels.size(); ++l)
      EXPECT_TRUE(test::readLevel(**opened, l) == test::readLevel(*inMemory, l));
    for (const std::uint32_t parts : {1u, 3u, 7u}) {
      std::vector<std::filesystem::path> files;
      for (std::uint32_t i = 0; i < parts; ++i) {
        files.push_back(dir / ("part" + std::to_string(i)));
        ASSERT_TRUE(buildGroundPart(sources, i, parts, files.back(), {}));
      }
      const auto joined = joinGround(files, dir / "joined", {});
      ASSERT_TRUE(joined) << toString(joined.findings());
      EXPECT_TRUE(test::readFile(dir / "whole") == test::readFile(dir / "joined")) << parts << " parts";
      if (parts == 1 || texels < 1) continue;  // one share has it all
      files.pop_back();
      EXPECT_FALSE(joinGround(files, dir / "less", {}));
      EXPECT_FALSE(std::filesystem::exists(dir / "less"));
    }
  }
}

TEST(Ground, isNotMadeOfHeightsThatCouldNotBeRead) {
  struct Failing final : HeightSource {
    explicit Failing(const HeightSource& heights) : inner(heights) {}
    const PostGrid& posts() const override { return inner.posts(); }
    void read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const override {
      inner.read(window, stride, heights);
    }
    void readVoids(const PostWindow& window, std::uint32_t stride,
                   std::span<std::uint8_t> voids) const override {
      inner.readVoids(window, stride, voids);
    }
    bool failed() const override { return true; }
    const HeightSource& inner;
  };
  GroundLand land(90, 70);
  GroundSources sources = land.sources();
  const Failing failing(*sources.heights);
  sources.heights = &failing;
  test::ScratchDir dir;
  EXPECT_FALSE(buildGroundPart(sources, 0, 1, dir / "ground", {}));
  EXPECT_TRUE(test::namesIn(dir.path()).empty());
}

/// What is done waits for the first that is not: no more of it than memory is given for.
TEST(Ground, doesNotRunAheadOfItsSlowestBlock) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "needs two cores";
  struct Slow final : HeightSource {
    explicit Slow(const HeightSource& heights) : inner(heights) {}
    const PostGrid& posts() const override { return inner.posts(); }
    void read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const override {
      const std::uint32_t column = (window.column + window.columns / 2) / 1024,
                          row = (window.row + window.rows / 2) / 1024;
      if (column == 0 && row == 0) {
        if (!slept.exchange(true)) {
          // As long as it may take others to begin what they should not.
          const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(2);
          for (ahead = 0; ahead < most && std::chrono::steady_clock::now() < until;) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            const std::lock_guard lock(mutex);
            ahead = begun.size();
          }
        }
      } else {
        const std::lock_guard lock(mutex);
        begun.insert({column, row});
      }
      inner.read(window, stride, heights);
    }
    void readVoids(const PostWindow& window, std::uint32_t stride,
                   std::span<std::uint8_t> voids) const override {
      inner.readVoids(window, stride, voids);
    }
    const HeightSource& inner;
    mutable std::atomic<bool> slept{false};
    mutable std::mutex mutex;
    mutable std::set<std::pair<std::uint32_t, std::uint32_t>> begun;
    mutable std::size_t ahead = 99;
    std::size_t most = 0;
  };
  GroundLand land(2500, 2100);
  GroundSources sources = land.sources();
  sources.texelsPerPost = 1;
  const auto whole = built(sources);
  for (const std::size_t blocks : {1u, 2u}) {
    Slow slow(*land.heights);
    slow.most = blocks;
    sources.heights = &slow;
    sources.memory = blocks << 25;
    const auto made = built(sources);
    EXPECT_EQ(slow.begun.size(), 8u);
    EXPECT_LT(slow.ahead, blocks);
    EXPECT_TRUE(test::readLevel(*made, 0) == test::readLevel(*whole, 0));
  }
}

TEST(Ground, leavesNothingBehindWhereItIsCancelled) {
  GroundLand land(2500, 1500);
  test::ScratchDir dir;
  const auto done = buildGround(land.sources(), dir / "ground",
                                [](double share, const std::string&) { return share < 0.3; });
  ASSERT_FALSE(done);
  EXPECT_NE(toString(done.findings()).find("cancelled"), std::string::npos) << toString(done.findings());
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

TEST(Ground, refusesFilesThatAreNotItsOwn) {
  GroundLand land(600, 300);
  test::ScratchDir dir;
  ASSERT_TRUE(buildGround(land.sources(), dir / "ground", {}));
  PostGrid other = land.grid.posts;
  other.columns = 601;
  const auto refused = openGround(dir / "ground", other);
  ASSERT_FALSE(refused);
  EXPECT_NE(toString(refused.findings()).find("601"), std::string::npos);
  {
    auto writer = PageFileWriter::create(dir / "empty");
    ASSERT_TRUE(writer && (*writer)->finish());
  }
  EXPECT_FALSE(openGround(dir / "empty", land.grid.posts));
  {
    auto writer = PageFileWriter::create(dir / "holes");
    const GroundShape shape = makeGroundShape(land.grid.posts, 1);
    ASSERT_TRUE(writer && (*writer)->add(kGroundShapeKey, packGroundShape(shape)) && (*writer)->finish());
  }
  const auto holes = openGround(dir / "holes", land.grid.posts);
  ASSERT_FALSE(holes);
  EXPECT_NE(toString(holes.findings()).find("tile 0, 0"), std::string::npos);
}

TEST(GroundTile, comesBackAsItWasPacked) {
  GroundTile tile(256 * 256);
  std::uint32_t state = 1;
  for (GroundTexel& t : tile) {
    state = state * 1664525u + 1013904223u;
    t = {static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
         static_cast<std::uint8_t>(state >> 8),  static_cast<std::uint8_t>(state >> 4),
         static_cast<std::int8_t>(state >> 12),  static_cast<std::int8_t>(state >> 20)};
  }
  const auto noisy = packGroundTile(tile);
  EXPECT_EQ(noisy.size(), 1 + tile.size() * 6);
  EXPECT_EQ(*unpackGroundTile(noisy), tile);
  const GroundTile plain(256 * 256, {38, 78, 112, 0, 0, 3});
  const auto small = packGroundTile(plain);
  EXPECT_LT(small.size(), 4096u);
  EXPECT_EQ(*unpackGroundTile(small), plain);
  // Hills: neighbours differ by little.
  GroundTile hills = tile;
  for (std::size_t i = 1; i < hills.size(); ++i) {
    const auto near = [&](auto before, int by) { return static_cast<decltype(before)>(before + by % 8 - 4); };
    hills[i] = {near(hills[i - 1].red, tile[i].red),       near(hills[i - 1].green, tile[i].green),
                near(hills[i - 1].blue, tile[i].blue),     0,
                near(hills[i - 1].normalX, tile[i].voids), near(hills[i - 1].normalY, tile[i].voids)};
  }
  const auto packed = packGroundTile(hills);
  EXPECT_LT(packed.size(), hills.size() * 3);
  EXPECT_EQ(*unpackGroundTile(packed), hills);
  // Cut off or changed, it is refused or something else, and never more.
  for (std::size_t i = 0; i < packed.size(); i += 97) {
    auto changed = packed;
    changed[i] ^= std::byte{0x55};
    if (const auto read = unpackGroundTile(changed)) {
      EXPECT_EQ(read->size(), hills.size());
    }
  }
  for (const auto& blob : {noisy, packed, small})
    for (std::size_t length = 0; length < blob.size(); length = length * 2 + 1)
      EXPECT_FALSE(unpackGroundTile(std::span(blob).first(length)));
  for (std::size_t i = 0; i < small.size(); ++i) {
    auto changed = small;
    changed[i] ^= std::byte{0x55};
    if (const auto read = unpackGroundTile(changed)) {
      EXPECT_EQ(read->size(), tile.size());
    }
  }
}

}  // namespace
}  // namespace trimtab::terrain
