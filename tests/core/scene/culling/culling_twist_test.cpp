#include <algorithm>
#include <cmath>
#include <set>

#include "culling_truth.h"
#include "tests/core/scene/terrain/patched_terrain.h"

/// Patches over posts whose heights turn about from cell to cell: between posts, the surfaces of two levels
/// are further apart than at any.
namespace trimtab {
namespace {

class CullingTwist : public test::CullingTruth {
 protected:
  static std::shared_ptr<const test::PatchedTerrain> twisted() {
    constexpr int kPosts = 12 * TerrainIndex::kTileCells + 1;
    terrain::HeightGrid grid;
    grid.posts = {8.1, 46.4, 1.0 / 1200, 1.0 / 1200, kPosts, kPosts};
    for (int row = 0; row < kPosts; ++row)
      for (int column = 0; column < kPosts; ++column) {
        const double saddles = 5 * std::sin(1.9 * column) * std::sin(2.1 * row);
        grid.heights.push_back(static_cast<float>(0.6 * test::mountains(column, row) + saddles));
      }
    return std::make_shared<const test::PatchedTerrain>(std::move(grid), nullptr, false);
  }
};

TEST_F(CullingTwist, losesNothingWhileLevelsChangeInFlight) {
  use(twisted());
  useForm(TerrainForm::patches);
  constexpr int kFrames = 72;
  constexpr double kStepM = 600 * 1852.0 / 3600 / 60;
  int changes = 0;
  std::uint64_t moved = 0;
  std::size_t cut = 0, wrong = 0, occluded = 0, hidden = 0;
  for (int i = 0; i < kFrames * test::soak(); ++i) {
    const int leg = i / kFrames, step = i % kFrames;
    const auto place = [&](int at) {
      return over(0.25 + 0.05 * (leg % 9) + kStepM * at / 29000, 0.3 + 0.04 * (leg % 10), 0);
    };
    Metres highest{0};
    for (int at = 0; at < kFrames; ++at) highest = std::max(highest, place(at).height);
    auto r = viewOf(place(step), {Degrees{90 + 40 * std::sin(0.1 * i)}, Degrees{-3}, Degrees{0}});
    r.eye.height = highest + Metres{30.0 + 60 * (leg % 5)};
    r.levers.drawn.errorPx = 0.5;
    const View view = truthOf(r, false);
    changes += view.cut != cut;
    cut = view.cut;
    r.cullingCase = CullingCase::proposed;
    r.occlusion = OcclusionMethod::horizon;
    r.levers.drawn.occlusion = OcclusionResolution{400, 300};
    const auto result = renderer.draw(r, offscreen->framebuffer());
    std::set<std::uint32_t> drawn;
    for (const TileDraw& patch : result.visible.tiles) drawn.insert(patch.node);
    for (const auto& [node, pixels] : view.owners) wrong += !drawn.contains(node);
    moved = result.counters.horizonsMoved;
    occluded += result.visible.occluded;
    hidden += view.hidden;
  }
  std::printf("%d frames, %d other cuts, %zu of %zu hidden left out, %llu frames by earlier horizons\n",
              kFrames * test::soak(), changes, occluded, hidden, static_cast<unsigned long long>(moved));
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(moved, 40u);
  EXPECT_GT(changes, 2);
  EXPECT_GT(occluded, hidden / 8);
}

}  // namespace
}  // namespace trimtab
