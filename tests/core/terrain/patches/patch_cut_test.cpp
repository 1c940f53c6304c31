#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "tests/core/culling/patch_fixpoint.h"
#include "tests/core/terrain/bake/slow_patches.h"
#include "trimtab/terrain/format/patch_layout.h"

namespace trimtab {
namespace {

/// Patches that were built, whole and cut off, with the pages that chance leaves.
TEST(BuiltPatches, areCutAsTheSlowWayCutsThem) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> chance(0, 1);
  using terrain::kCoarseLeafCells, terrain::kFineLeafCells;
  for (const auto& [columns, rows, leafCells] :
       {std::tuple(1100u, 800u, kFineLeafCells), std::tuple(700u, 131u, kFineLeafCells),
        std::tuple(258u, 514u, kFineLeafCells), std::tuple(1100u, 800u, kCoarseLeafCells)}) {
    const auto terrain = test::smallPatches(columns, rows, leafCells);
    const PatchIndex& index = terrain->index();
    Box all = index.bounds[0];
    for (const Box& b : index.bounds)
      all = {std::min(all.minX, b.minX), std::min(all.minY, b.minY), 0,
             std::max(all.maxX, b.maxX), std::max(all.maxY, b.maxY), 2000};
    PatchCut cut;
    std::size_t heldBack = 0, most = 0;
    for (int i = 0; i < 40; ++i) {
      const Vec3 eye{all.minX + (all.maxX - all.minX) * (1.4 * chance(random) - 0.2),
                     all.minY + (all.maxY - all.minY) * (1.4 * chance(random) - 0.2), 2500 * chance(random)};
      std::vector<std::uint8_t> resident(index.pages.size(), 1);
      if (i % 2)
        for (std::size_t page = 0; page < resident.size(); ++page)
          resident[page] = index.pages[page].pair == 0 || chance(random) < 0.7;
      const double px = 0.3 * std::pow(1.2, i % 20);
      selectPatches(index, resident, eye, {px, 1, 1100}, cut);
      const test::PatchFixpoint expected(index, resident, eye, px / 1100);
      std::vector<std::uint32_t> drawn;
      for (const TileDraw& tile : cut.cut.tiles) drawn.push_back(tile.node);
      std::sort(drawn.begin(), drawn.end());
      ASSERT_EQ(drawn, expected.drawn);
      ASSERT_EQ(cut.heldBack, expected.heldBack);
      heldBack += cut.heldBack;
      most = std::max(most, drawn.size());
    }
    EXPECT_GT(most, 20u);
    EXPECT_GT(heldBack, 0u);
  }
}

}  // namespace
}  // namespace trimtab
