#include <random>

#include "core/scene/surface/tile_indices.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/planted_defects.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab {
namespace {

/// Each second tile of a level has the ground of the tile to its west, in other colours: where both are
/// drawn, their depths are equal to the bit, and the first one shows.
class TwinTerrain final : public terrain::Database {
 public:
  explicit TwinTerrain(std::shared_ptr<const test::SyntheticTerrain> ground)
      : ground_(std::move(ground)), index_(ground_->index()) {
    for (std::uint32_t node = 0; node < index_.size(); ++node)
      index_.bounds[node] = ground_->index().bounds[twinOf(node)];
  }
  const terrain::TerrainInfo& info() const override { return ground_->info(); }
  const TerrainIndex& index() const override { return index_; }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    return ground_->heightAt(latitude, longitude);
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const override {
    return ground_->highestWithin(latitude, longitude, radius);
  }
  void buildTile(std::uint32_t node, terrain::TileMesh& mesh) const override {
    ground_->buildTile(twinOf(node), mesh);
    for (terrain::TileVertex& v : mesh.vertices)
      if (node != twinOf(node)) std::swap(v.colour[0], v.colour[1]);
  }

 private:
  std::uint32_t twinOf(std::uint32_t node) const {
    const auto& level = ground_->index().levels[ground_->index().level[node]];
    return (node - level.firstNode) % level.columns % 2 == 1 ? node - 1 : node;
  }
  std::shared_ptr<const test::SyntheticTerrain> ground_;
  TerrainIndex index_;
};

class DrawOrder : public test::SceneTest {};

TEST_F(DrawOrder, ofTilesAtTheSameDepthDoesNotDependOnWhatIsLeftOut) {
  use(std::make_shared<const TwinTerrain>(test::syntheticMountains()));
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(0.2, 0.8), unit(0, 1);
  std::size_t outside = 0, twins = 0;
  for (int i = 0; i < 24; ++i) {
    auto r =
        request(over(place(random), place(random), 40 * std::pow(100, unit(random))),
                {Degrees{360 * unit(random)}, Degrees{10 - 60 * unit(random)}, Degrees{30 * unit(random)}});
    r.levers.drawn.errorPx = i % 2 ? 0.5 : 8.0;
    FrameResult result;
    r.cullingCase = CullingCase::none;
    const auto whole = picture(r, &result);
    const auto unculled = renderer.readNodes();
    r.cullingCase = CullingCase::view_frustum;
    EXPECT_EQ(differing(picture(r, &result), whole), 0u) << "view " << i;
    outside += result.visible.outsideFrustum;
    EXPECT_EQ(renderer.readNodes(), unculled) << "view " << i;
    EXPECT_EQ(renderer.readNodes(true), unculled) << "view " << i;
    const auto drawn = result.visible.tiles;
    for (const TileDraw& tile : drawn)
      twins += std::any_of(drawn.begin(), drawn.end(),
                           [&](const TileDraw& other) { return other.node == tile.node + 1; });
    // Others of the list missing, one by one.
    for (std::size_t gone = 0; gone < drawn.size(); gone += 1 + drawn.size() / 6) {
      plant(renderer, {.culledNode = drawn[gone].node});
      picture(r);
      const auto nodes = renderer.readNodes();
      std::size_t wrong = 0;
      for (std::size_t p = 0; p < nodes.size(); ++p)
        wrong += nodes[p] != unculled[p] && unculled[p] != drawn[gone].node;
      EXPECT_EQ(wrong, 0u) << "view " << i << " without " << drawn[gone].node;
    }
    plant(renderer, {});
  }
  EXPECT_GT(outside, 500u);
  EXPECT_GT(twins, 200u) << "hardly any two tiles were at the same depth";
}

TEST(TileIndices, reuseVerticesThatACacheOf32Holds) {
  const auto indices = scene::makeTileIndices();
  for (const auto& range : indices.variant) {
    std::vector<std::uint16_t> cache;
    int shaded = 0;
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      if (std::find(cache.begin(), cache.end(), indices.indices[i]) != cache.end()) continue;
      ++shaded;
      cache.push_back(indices.indices[i]);
      if (cache.size() > 32) cache.erase(cache.begin());
    }
    EXPECT_LE(shaded, 1230) << "of 1,089 vertices";
  }
}

}  // namespace
}  // namespace trimtab
