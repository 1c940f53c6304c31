#include "synthetic_trees.h"
#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"

namespace trimtab {
namespace {

/// The static trees of a terrain, with texture coordinates by place: one texture is `unitM` metres wide.
class TexturedTrees final : public terrain::Database {
 public:
  TexturedTrees(std::shared_ptr<const terrain::Database> plain, double unitM, Vec3 zero) : plain_(plain) {
    auto trees = std::make_shared<terrain::StaticLodTerrain>(*plain->staticLod());
    for (terrain::StaticLodTile& tile : trees->tiles)
      for (const terrain::StaticLodVertex& v : tile.vertices)
        tile.texture.push_back({static_cast<float>((v.x + 16.0 * tile.origin[0] - zero.x) / unitM),
                                static_cast<float>((v.y + 16.0 * tile.origin[1] - zero.y) / unitM)});
    trees_ = std::move(trees);
  }
  const terrain::TerrainInfo& info() const override { return plain_->info(); }
  const TerrainIndex& index() const override { return plain_->index(); }
  void buildTile(std::uint32_t node, terrain::TileMesh& mesh) const override {
    plain_->buildTile(node, mesh);
  }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    return plain_->heightAt(latitude, longitude);
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const override {
    return plain_->highestWithin(latitude, longitude, radius);
  }
  std::shared_ptr<const terrain::StaticLodTerrain> staticLod() const override { return trees_; }

 private:
  std::shared_ptr<const terrain::Database> plain_;
  std::shared_ptr<const terrain::StaticLodTerrain> trees_;
};

using TextureSquares = test::SceneTest;

TEST_F(TextureSquares, showTextureCoordinatesWhereTheyAre) {
  constexpr double kUnitM = 4000, kSquareM = kUnitM / 8;
  const auto mountains = std::make_shared<const test::TreeTerrain>(test::syntheticMountains());
  use(mountains);
  auto r = request(over(0.5, 0.5, 9000), {Degrees{0}, Degrees{-90}, Degrees{0}});
  r.overlays.treeDepth = 4;  // leaves, which are exact
  const LocalFrame frame = database->index().frame;
  const Vec3 eye = frame.fromGeodetic(r.eye);
  const auto plain = picture(r);
  r.overlays.textureSquares = true;
  EXPECT_EQ(differing(plain, picture(r)), 0u) << "without coordinates nothing changes";

  use(std::make_shared<const TexturedTrees>(mountains, kUnitM, eye));
  const auto squares = picture(r);
  r.overlays.textureSquares = false;
  EXPECT_EQ(differing(plain, picture(r)), 0u) << "coordinates alone change nothing";

  int bright = 0, dark = 0;
  for (int row = -6; row < 6; ++row)
    for (int column = -6; column < 6; ++column) {
      const double east = (column + 0.5) * kSquareM, north = (row + 0.5) * kSquareM;
      const Vec3 up =
          database->index().frame.ecefToLocal() * eastNorthUp(r.eye.latitude, r.eye.longitude).row[2];
      const GeodeticPosition place = frame.toGeodetic(eye + Vec3{east, north, -9000 * up.z});
      const auto height = database->heightAt(place.latitude, place.longitude);
      ASSERT_TRUE(height);
      const auto [x, y] = projected(r, frame, frame.fromGeodetic({place.latitude, place.longitude, *height}));
      ASSERT_TRUE(x > 0 && y > 0 && x < kWidth && y < kHeight);
      const std::size_t at = 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
      const bool odd = (row + column) % 2 != 0;
      for (std::size_t k = 0; k < 3;
           ++k)  // haze, which is not darkened, is at most a fifth of the colour from here
        EXPECT_NEAR(squares[at + k], plain[at + k] * (odd ? 0.55 : 1.0), odd ? 0.12 * plain[at + k] : 0)
            << row << " " << column;
      ++(odd ? dark : bright);
    }
  EXPECT_EQ(dark, bright);
}

}  // namespace
}  // namespace trimtab
