#include "trimtab/culling/select_patches.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "patch_fixpoint.h"
#include "random_patches.h"

namespace trimtab {
namespace {

constexpr std::uint32_t kNoNode = PatchIndex::kNone;
using test::distance;
using Fixpoint = test::PatchFixpoint;
constexpr double kPatchPxPerRadian = 1100;

struct Shape {
  std::uint32_t columns, rows, rootCells, leafCells;
};
// Whole squares; cut off along both sides; a strip of squares; a sliver of one post.
constexpr Shape kShapes[] = {
    {257, 257, 256, 16}, {390, 211, 512, 16}, {900, 120, 128, 8}, {258, 130, 128, 8}};

class PatchCutOf : public testing::TestWithParam<std::tuple<int, std::size_t, unsigned>> {
 protected:
  static PatchIndex make() {
    const auto [shape, variants, seed] = GetParam();
    const Shape& s = kShapes[shape];
    return test::randomPatches(s.columns, s.rows, s.rootCells, s.leafCells, variants, seed);
  }
  Vec3 randomEye() {
    std::uniform_real_distribution<double> chance(0, 1);
    const double over = chance(random) < 0.2 ? 3 : 1;
    return {(over * (chance(random) - 0.5) + 0.5) * index.columns * 10,
            (over * (chance(random) - 0.5) + 0.5) * index.rows * 10, 2500 * chance(random)};
  }
  std::vector<std::uint8_t> randomPages(double share) {
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<std::uint8_t> resident(index.pages.size());
    for (std::size_t i = 0; i < resident.size(); ++i)
      resident[i] = index.pages[i].pair == 0 || chance(random) < share;
    return resident;
  }
  std::vector<std::uint32_t> drawn() const {
    std::vector<std::uint32_t> nodes;
    for (const TileDraw& tile : cut.cut.tiles) nodes.push_back(tile.node);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  PatchIndex index = make();
  std::mt19937 random{std::get<2>(GetParam()) * 7919 + 1};
  PatchCut cut;
};

TEST_P(PatchCutOf, isTheSmallestThatSatisfiesEveryoneWithThePagesThatAreThere) {
  std::set<std::size_t> sizes;
  std::size_t heldBack = 0;
  for (int i = 0; i < 60; ++i) {
    const Vec3 eye = randomEye();
    const double px = 1 * std::pow(1.12, i % 30), scale = i % 7 == 0 ? 4 : 1;
    const auto resident = i % 3 == 0 ? std::vector<std::uint8_t>{} : randomPages(i % 3 == 1 ? 0.9 : 0.5);
    selectPatches(index, resident, eye, {px, scale, kPatchPxPerRadian}, cut);
    const Fixpoint expected(index, resident, eye, px * scale / kPatchPxPerRadian);
    ASSERT_EQ(drawn(), expected.drawn);
    ASSERT_EQ(cut.heldBack, expected.heldBack);
    std::set<std::uint32_t> pages;
    for (const PageWant& want : cut.wants) ASSERT_TRUE(pages.insert(want.page).second) << "a page twice";
    ASSERT_EQ(pages, expected.pages);
    sizes.insert(cut.cut.tiles.size());
    heldBack += cut.heldBack;
  }
  EXPECT_GT(sizes.size(), 12u) << "the cuts hardly differed";
  EXPECT_GT(heldBack, 50u) << "pages were hardly missed";
}

TEST_P(PatchCutOf, coversEverythingOnceAndNeighboursShareWholeSides) {
  for (int i = 0; i < 30; ++i) {
    const auto resident = randomPages(0.7);
    selectPatches(index, resident, randomEye(), {4, 1, kPatchPxPerRadian}, cut);
    std::vector<int> covered(index.size());
    for (const TileDraw& tile : cut.cut.tiles) {
      ++covered[tile.node];
      ASSERT_TRUE(resident[index.page[tile.node]]);
    }
    // Halved diamonds are those with a half whose children are covered from below.
    std::vector<char> below(index.size());
    for (std::size_t p = index.size(); p-- > 0;)
      for (const std::uint32_t child : index.children[p])
        if (child != kNoNode) below[p] |= covered[child] || below[child];
    for (std::size_t p = 0; p < index.size(); ++p) {
      const PatchIndex::Diamond& d = index.diamonds[index.diamond[p]];
      ASSERT_FALSE(below[p] && covered[p]) << "twice";
      for (const std::uint32_t half : d.patches)
        ASSERT_TRUE(half == kNoNode || below[half] == below[p]) << "halved by itself";
      if (below[p] || covered[p]) continue;
      bool above = false;
      for (std::uint32_t a = index.parent[p]; a != kNoNode; a = index.parent[a]) above |= covered[a] != 0;
      ASSERT_TRUE(above) << "a hole";
    }
  }
}

TEST_P(PatchCutOf, keepsThePromisedErrorAndTheCoarsestVariantThatDoes) {
  std::set<int> variants;
  for (int i = 0; i < 40; ++i) {
    const Vec3 eye = randomEye();
    const double tolerance = 3.0 / kPatchPxPerRadian, spread = i % 4 == 1 ? 0.6 : i % 4 == 3 ? 1.7 : 1;
    selectPatches(index, {}, eye, {3, 1, kPatchPxPerRadian, spread, 1500}, cut);
    EXPECT_EQ(cut.heldBack, 0u);
    for (const TileDraw& tile : cut.cut.tiles) {
      const auto error = index.errorM[tile.node];
      const double far = distance(index.bounds[tile.node], eye);
      const double most = tolerance * 1500 * std::pow(far / 1500, 1 / spread) * (1 + 1e-12);
      variants.insert(tile.variant.number);
      ASSERT_LT(tile.variant.number, index.variants());
      if (index.children[tile.node] != std::array{kNoNode, kNoNode} || tile.variant.number > 0) {
        ASSERT_LE(error[tile.variant.number], most);
      }
      if (tile.variant.number + 1u < index.variants()) {
        ASSERT_GT(error[tile.variant.number + 1u], most * (1 - 1e-11)) << "a coarser one would do";
      }
    }
  }
  EXPECT_EQ(variants.size(), std::get<1>(GetParam()));
}

TEST_P(PatchCutOf, saysWhatThePictureLacksInPixelsCoarsePagesFirst) {
  const auto resident = randomPages(0.5);
  for (int i = 0; i < 20; ++i) {
    const Vec3 eye = randomEye();
    selectPatches(index, resident, eye, {2, 1, kPatchPxPerRadian}, cut);
    std::vector<float> error(index.pages.size(), -1);
    for (const PageWant& want : cut.wants) error[want.page] = want.errorPx;
    const Fixpoint expected(index, resident, eye, 2 / kPatchPxPerRadian);
    for (std::size_t d = 0; d < index.diamonds.size(); ++d) {
      if (!expected.wanted[d]) continue;
      for (const std::uint32_t patch : index.diamonds[d].patches) {
        if (patch == kNoNode) continue;
        const double e = double{index.errorM[patch][0]} / distance(index.bounds[patch], eye);
        for (const std::uint32_t child : index.children[patch]) {
          if (child == kNoNode) continue;
          ASSERT_LE(error[index.page[child]], error[index.page[patch]]);
          if (e * kPatchPxPerRadian > 2) {
            ASSERT_GE(error[index.page[child]], e * kPatchPxPerRadian * (1 - 1e-6));
          }
        }
      }
    }
    for (const PageWant& want : cut.wants) ASSERT_GT(want.errorPx, 2 * (1 - 1e-6));
  }
}

TEST_P(PatchCutOf, doesNotDependOnWhatWasChosenBeforeOrOnWhichTerrain) {
  const PatchIndex other = test::randomPatches(130, 130, 128, 8, 5 - std::get<1>(GetParam()), 5);
  std::vector<std::uint32_t> order(index.size());
  for (int i = 0; i < 30; ++i) {
    const Vec3 eye = randomEye();
    const auto resident = randomPages(0.8);
    if (i % 5 == 0) selectPatches(other, {}, eye, {1, 1, kPatchPxPerRadian}, cut);
    selectPatches(index, resident, eye, {3, 1, kPatchPxPerRadian}, cut);
    PatchCut fresh;
    selectPatches(index, resident, eye, {3, 1, kPatchPxPerRadian}, fresh);
    ASSERT_EQ(cut.cut.tiles.size(), fresh.cut.tiles.size());
    ASSERT_EQ(cut.heldBack, fresh.heldBack);
    ASSERT_EQ(cut.wants.size(), fresh.wants.size());
    for (std::size_t k = 0; k < fresh.cut.tiles.size(); ++k) {
      ASSERT_EQ(cut.cut.tiles[k].node, fresh.cut.tiles[k].node);
      ASSERT_EQ(cut.cut.tiles[k].variant.number, fresh.cut.tiles[k].variant.number);
    }
    for (std::size_t k = 0; k < fresh.wants.size(); ++k) {
      ASSERT_EQ(cut.wants[k].page, fresh.wants[k].page);
      ASSERT_EQ(cut.wants[k].errorPx, fresh.wants[k].errorPx);
    }
  }
}

TEST_P(PatchCutOf, isDrawnInAnOrderThatIsTheIndexsOwn) {
  // Any two patches stand in the same order in all cuts: so no order is ever met the other way round.
  std::set<std::pair<std::uint32_t, std::uint32_t>> before;
  for (int i = 0; i < 10; ++i) {
    selectPatches(index, {}, randomEye(), {10, 1, kPatchPxPerRadian}, cut);
    for (std::size_t a = 0; a < cut.cut.tiles.size(); ++a)
      for (std::size_t b = a + 1; b < std::min(a + 20, cut.cut.tiles.size()); ++b) {
        const auto pair = std::pair(cut.cut.tiles[a].node, cut.cut.tiles[b].node);
        ASSERT_FALSE(before.count({pair.second, pair.first}));
        before.insert(pair);
      }
  }
}

TEST_P(PatchCutOf, neverGetsCoarserAnywhereByAPageMore) {
  for (int i = 0; i < 20; ++i) {
    const Vec3 eye = randomEye();
    auto resident = randomPages(0.5);
    selectPatches(index, resident, eye, {2, 1, kPatchPxPerRadian}, cut);
    std::vector<char> covered(index.size());
    for (const TileDraw& tile : cut.cut.tiles) covered[tile.node] = 1;
    for (std::size_t p = 0; p < index.size(); ++p)
      if (index.parent[p] != kNoNode && covered[index.parent[p]]) covered[p] = 1;
    for (int more = 0; more < 5; ++more) resident[random() % resident.size()] = 1;
    selectPatches(index, resident, eye, {2, 1, kPatchPxPerRadian}, cut);
    for (const TileDraw& tile : cut.cut.tiles) ASSERT_TRUE(covered[tile.node]);
  }
}

TEST_P(PatchCutOf, isFinerWhereAPageOfRootsIsLost) {
  std::vector<std::uint32_t> roots;
  for (std::uint32_t page = 0; page < index.pages.size(); ++page)
    if (index.pages[page].pair == 0) roots.push_back(page);
  if (roots.size() == index.pages.size()) GTEST_SKIP() << "nothing is finer";
  for (int i = 0; i < 20; ++i) {
    std::vector<std::uint8_t> resident(index.pages.size(), 1);
    resident[roots[random() % roots.size()]] = 0;
    const Vec3 eye = randomEye();
    selectPatches(index, resident, eye, {4, 1, kPatchPxPerRadian}, cut);
    const auto nodes = drawn();
    std::size_t lost = 0;
    for (const std::uint32_t node : nodes) {
      // Only what has nothing finer is missing.
      if (resident[index.page[node]]) continue;
      EXPECT_FALSE(test::hasChildren(index, index.diamond[node])) << node;
      ++lost;
    }
    EXPECT_LT(lost, nodes.size());
    // It is a cut like any: each diamond whole or halved, and those that it stands on halved.
    std::set<std::uint32_t> above;
    for (std::uint32_t node : nodes)
      for (node = index.parent[node]; node != kNoNode; node = index.parent[node])
        above.insert(index.diamond[node]);
    for (const std::uint32_t node : nodes) EXPECT_FALSE(above.contains(index.diamond[node])) << node;
    // The finer pages of what is lost come before all others.
    for (const PageWant& want : cut.wants)
      if (index.pages[want.page].pair == 0) {
        EXPECT_EQ(want.errorPx, kInfinity);
      }
  }
}

TEST_P(PatchCutOf, isTheRootsForAnEyeThatIsNotANumberOrNotAnywhere) {
  std::size_t roots = 0;
  for (const std::uint32_t parent : index.parent) roots += parent == kNoNode;
  for (const double bad : {kNan, kInfinity, -kInfinity, 1e300})
    for (const Vec3 eye : {Vec3{bad, 0, 0}, Vec3{0, bad, 0}, Vec3{0, 0, bad}, Vec3{bad, bad, bad}})
      for (const double px : {2.0, 0.0}) {
        selectPatches(index, {}, eye, {px, 1, kPatchPxPerRadian}, cut);
        ASSERT_EQ(cut.cut.tiles.size(), roots);
      }
  for (const double px : {kNan, kInfinity}) {
    selectPatches(index, {}, {1000, 1000, 3000}, {px, 1, kPatchPxPerRadian}, cut);
    EXPECT_EQ(cut.cut.tiles.size(), roots);
    EXPECT_EQ(cut.cut.tiles[0].variant.number, std::get<1>(GetParam()) - 1);
  }
}

TEST_P(PatchCutOf, isWholeWithoutATolerance) {
  selectPatches(index, {}, {1000, 1000, 30000}, {0, 1, kPatchPxPerRadian}, cut);
  const Fixpoint expected(index, {}, {1000, 1000, 30000}, 0);
  EXPECT_EQ(drawn(), expected.drawn);
  EXPECT_GT(drawn().size(), index.size() / 3);
}

TEST_P(PatchCutOf, halvesAroundAnEyeThatIsInside) {
  for (std::uint32_t leaf = static_cast<std::uint32_t>(index.size()) - 1; leaf > index.size() - 20; --leaf) {
    if (!(index.errorM[leaf][0] > 0) || index.children[leaf] != std::array{kNoNode, kNoNode}) continue;
    const Box& b = index.bounds[leaf];
    selectPatches(index, {}, {0.5 * (b.minX + b.maxX), 0.5 * (b.minY + b.maxY), 0.5 * (b.minZ + b.maxZ)},
                  {1e9, 1, kPatchPxPerRadian}, cut);
    const auto nodes = drawn();
    EXPECT_TRUE(std::binary_search(nodes.begin(), nodes.end(), leaf));
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, PatchCutOf,
                         testing::Combine(testing::Range(0, 4), testing::Values(2u, 3u),
                                          testing::Values(1u, 2u, 3u)));

TEST(PatchCut, isEmptyWithoutPatches) {
  PatchCut cut;
  selectPatches({}, {}, {}, {1, 1, kPatchPxPerRadian}, cut);
  EXPECT_TRUE(cut.cut.tiles.empty());
  EXPECT_TRUE(cut.wants.empty());
}

TEST(PatchVisible, countsTheTrianglesOfTheVariantsThatAreDrawn) {
  const PatchIndex index = test::randomPatches(900, 700, 512, 16, 3, 3);
  PatchCut cut;
  EyePose eye{{3000, 3000, 1500}, {}};
  selectPatches(index, {}, eye.position, {4, 1, kPatchPxPerRadian}, cut);
  VisibleSet visible;
  std::vector<std::uint8_t> hidden(cut.cut.tiles.size());
  for (std::size_t i = 0; i < hidden.size(); i += 5) hidden[i] = 1;
  selectVisible(cut.cut, {.eye = eye, .farM = 1e9, .hidden = hidden}, visible);
  EXPECT_GT(visible.tiles.size(), 3u);
  EXPECT_GT(visible.occluded, 0u);
  EXPECT_EQ(visible.reason.size(), cut.cut.tiles.size());
  EXPECT_EQ(visible.tiles.size() + visible.occluded + visible.outsideFrustum, cut.cut.tiles.size());
  std::uint64_t triangles = 0;
  for (const TileDraw& tile : visible.tiles) triangles += index.triangles[tile.node][tile.variant.number];
  EXPECT_EQ(visible.triangles, triangles);
  selectVisible(cut.cut, {.eye = eye, .cull = false}, visible);
  EXPECT_EQ(visible.tiles.size(), cut.cut.tiles.size());
}

}  // namespace
}  // namespace trimtab
