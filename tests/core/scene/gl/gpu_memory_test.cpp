#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "core/scene/terrain/static_trees/static_lod_layer.h"
#include "core/scene/terrain/tiles/tile_cache.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/synthetic_trees.h"

namespace trimtab {
namespace {

/// What is drawn where the GPU has no memory for all of it.
class GpuMemory : public test::SceneTest {
 protected:
  static std::vector<TileDraw> tilesFrom(std::uint32_t first, std::uint32_t count) {
    std::vector<TileDraw> tiles;
    for (std::uint32_t i = 0; i < count; ++i) tiles.push_back({first + i});
    return tiles;
  }
};

TEST_F(GpuMemory, tilesGiveUpOthersAndThenGoWithout) {
  offscreen->makeCurrent();
  const auto terrain = test::syntheticMountains();
  scene::TileCache cache;
  cache.setDatabase(terrain);
  const auto withSlot = [&](const std::vector<TileDraw>& tiles) {
    return std::count_if(tiles.begin(), tiles.end(), [&](const TileDraw& tile) {
      return cache.slotOf(tile.node) != scene::TileCache::kNoSlot;
    });
  };
  // 256 slots are there from the beginning; no more can be had.
  const std::size_t bytes = cache.bytes();
  const auto first = tilesFrom(0, 160), second = tilesFrom(160, 160), many = tilesFrom(0, 320);
  {
    const scene::ScarceMemory scarce(bytes);
    EXPECT_EQ(cache.prepare(first), 160u);
    EXPECT_EQ(cache.prepare(second), 160u) << "in place of those of the frame before";
    EXPECT_EQ(withSlot(second), 160);
    EXPECT_EQ(withSlot(first), 96);
    cache.prepare(many);
    EXPECT_EQ(withSlot(many), 256) << "the rest is not drawn";
    EXPECT_EQ(cache.bytes(), bytes);
    cache.draw(many);
  }
  cache.prepare(many);
  EXPECT_EQ(withSlot(many), 320) << "once there is memory again";
  EXPECT_EQ(glGetError(), GL_NO_ERROR);
}

TEST_F(GpuMemory, noBufferGrowsAfterTheSecondImage) {
  offscreen->makeCurrent();
  const auto terrain = test::syntheticMountains();
  scene::TileCache cache;
  cache.setDatabase(terrain);
  const std::vector<TileDraw> all = tilesFrom(0, static_cast<std::uint32_t>(terrain->index().size()));
  ASSERT_GT(all.size(), 256u) << "more than there is room for at first";
  for (int image = 0; image < 2; ++image) cache.prepare(std::span(all).first(1));
  const scene::ScarceMemory scarce(1);
  EXPECT_EQ(cache.prepare(all), all.size() - 1);

  const test::TreeTerrain trees(terrain);
  const auto source = trees.staticLod();
  std::vector<TileDraw> nodes;
  for (std::uint32_t node = 0; node < source->index.size(); ++node) nodes.push_back({node});
  scene::StaticLodLayer layer;
  layer.setTerrain(source);
  std::size_t uploaded = 0;
  {
    const scene::ScarceMemory plenty(std::size_t{1} << 40);
    for (int image = 0; image < 2; ++image) uploaded += layer.prepare(std::span(nodes).first(1));
  }
  uploaded += layer.prepare(nodes);
  EXPECT_EQ(uploaded, source->tiles.size());
}

TEST_F(GpuMemory, tilesComeOnceThereIsAnyMemory) {
  offscreen->makeCurrent();
  auto none = std::make_unique<scene::ScarceMemory>(1);
  scene::TileCache cache;
  cache.setDatabase(test::syntheticMountains());
  const auto tiles = tilesFrom(0, 4);
  for (int image = 0; image < 3; ++image) EXPECT_EQ(cache.prepare(tiles), 0u);
  none.reset();
  EXPECT_EQ(cache.prepare(tiles), 4u);
}

TEST_F(GpuMemory, picturesOfTilesAreThoseOfBeforeOnceThereIsMemoryAgain) {
  use(test::syntheticMountains());
  auto r = request(over(0.5, 0.5, 300), {Degrees{30}, Degrees{-8}, Degrees{0}});
  const auto whole = picture(r);
  renderer.initialize();
  {
    const scene::ScarceMemory scarce(1);
    picture(r);
  }
  EXPECT_EQ(differing(picture(r), whole), 0u);
}

TEST_F(GpuMemory, treesGiveUpWhatWasLongestUnused) {
  offscreen->makeCurrent();
  const test::TreeTerrain terrain(test::syntheticMountains());
  const auto trees = terrain.staticLod();
  // A root of each tile, 16 by turns.
  std::vector<TileDraw> roots;
  for (std::uint32_t node = 0; node < trees->index.size(); ++node)
    if (roots.empty() || trees->index.nodes[roots.back().node].tile != trees->index.nodes[node].tile)
      roots.push_back({node});
  ASSERT_GE(roots.size(), 64u);
  std::size_t all = 0;
  {
    scene::StaticLodLayer layer(std::size_t{1} << 40);
    layer.setTerrain(trees);
    EXPECT_EQ(layer.prepare(roots), roots.size());
    EXPECT_EQ(layer.prepare(roots), 0u);
    all = layer.bytes();
  }
  const std::size_t room = all / roots.size() * 20;
  scene::StaticLodLayer layer(room);
  layer.setTerrain(trees);
  const auto some = [&](std::size_t first) { return std::span(roots).subspan(first, 8); };
  const auto there = [&](const TileDraw& root) { return layer.has(trees->index.nodes[root.node].tile); };
  for (std::size_t first = 0; first + 8 <= 64; first += 8) {
    EXPECT_EQ(layer.prepare(some(first)), 8u);
    EXPECT_LE(layer.bytes(), room);
    for (const TileDraw& root : some(first)) EXPECT_TRUE(there(root));
  }
  EXPECT_FALSE(there(roots[0])) << "longest unused";
  EXPECT_EQ(layer.prepare(some(48)), 0u) << "used lately";
  const auto kept = static_cast<std::size_t>(std::count_if(roots.begin(), roots.end(), there));
  EXPECT_GE(kept, 16u);
  EXPECT_EQ(layer.prepare(roots), roots.size() - kept) << "a frame that needs more gets it";
  EXPECT_EQ(layer.bytes(), all);
}

TEST_F(GpuMemory, treesGoWithoutWhatThereIsNoMemoryFor) {
  use(std::make_shared<const test::TreeTerrain>(test::syntheticMountains()));
  auto r = request(over(0.5, 0.5, 300), {Degrees{30}, Degrees{-8}, Degrees{0}});
  r.terrain.form = TerrainForm::static_trees;
  const auto whole = picture(r);
  renderer.initialize();
  {
    const scene::ScarceMemory scarce(1 << 20);
    EXPECT_GT(differing(picture(r), whole), 0u);
  }
  EXPECT_EQ(differing(picture(r), whole), 0u);
}

}  // namespace
}  // namespace trimtab
