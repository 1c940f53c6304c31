#include <algorithm>
#include <set>

#include "patch_support.h"
#include "trimtab/terrain/format/patch_layout.h"

namespace trimtab::terrain {
namespace {

struct Case {
  std::string what;
  PostGrid posts;
  PatchIndex index;
};

/// With squares of the side that the grid has, and of the other one; of a country of its own alone.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    const std::pair<const char*, PostGrid> grids[] = {
        {"two by two", {10, 45, 0.001, 0.001, 2, 2}},
        {"two columns", {10, 45, 0.001, 0.001, 2, 700}},
        {"odd", {10, 45, 0.001, 0.001, 67, 131}},
        {"one square", {10, 45, 0.001, 0.001, 65, 65}},
        {"one post more", {10, 45, 0.001, 0.001, 66, 66}},
        {"a degree at 3 seconds", {86, 27, 1.0 / 1200, 1.0 / 1200, 1201, 1201}},
        {"a ribbon", {-3, -45, 0.0003, 0.0003, 3, 5000}},
        {"several roots", {-3, 45, 0.0009, 0.0009, 2500, 1800}},
        {"a country", {-3, 45, 0.0003, 0.0003, 13000, 11000}},
        {"posts 1.8 km apart", {-180, -60, 1.0 / 60, 1.0 / 60, 2000, 500}},
        {"posts 20 km apart", {-180, -60, 0.2, 0.2, 300, 200}},
        {"round the pole", {-10, -90, 0.1, 0.01, 201, 101}},
    };
    std::vector<Case> made;
    for (const auto& [what, posts] : grids)
      for (const std::uint32_t leafCells : {kFineLeafCells, kCoarseLeafCells})
        if (leafCells >= leafCellsOf(posts))
          made.push_back({what + (" in squares of " + std::to_string(leafCells)), posts,
                          makePatchIndex(posts, PostGeometry(posts), leafCells)});
    return made;
  }();
  return all;
}

TEST(PatchIndex, squaresAreFineWhereThereAreFewOfThem) {
  const auto square = [](std::uint32_t cells) {
    return PostGrid{10, 45, 1.0 / 3600, 1.0 / 3600, cells + 1, cells + 1};
  };
  EXPECT_EQ(leafCellsOf(square(160), 100), kFineLeafCells);
  EXPECT_EQ(leafCellsOf(square(161), 100), kCoarseLeafCells);
  EXPECT_EQ(leafCellsOf(square(3600)), kFineLeafCells) << "a degree at a second";
  EXPECT_EQ(leafCellsOf({-3, 45, 0.0003, 0.0003, 13000, 11000}), kCoarseLeafCells) << "a country";
  // As many patches as are told of, and no more.
  const PostGrid largest = square(kFineLeafCells * 387);
  ASSERT_EQ(leafCellsOf(largest), kFineLeafCells);
  ASSERT_EQ(leafCellsOf(square(kFineLeafCells * 388)), kCoarseLeafCells);
  const PatchIndex index = makePatchIndex(largest, PostGeometry(largest), leafCellsOf(largest));
  EXPECT_EQ(index.leafCells, kFineLeafCells);
  EXPECT_EQ(index.squareCells(pairs(index) - 1), kFineLeafCells);
  EXPECT_NEAR(static_cast<double>(index.size()), 1.2e6, 0.02e6);
}

TEST(PatchIndex, childrenHalveTheirParents) {
  for (const Case& at : cases()) {
    const PatchIndex& index = at.index;
    const auto places = test::placesOf(index);
    ASSERT_EQ(places.size(), index.size()) << at.what;
    for (std::uint32_t p = 0; p < index.size(); ++p) {
      ASSERT_EQ(index.depth[p], places[p].depth());
      const std::int64_t area = test::twiceArea(patchEdges(index, places[p]));
      ASSERT_GT(area, 0);
      std::int64_t below = 0;
      for (const std::uint32_t child : index.children[p]) {
        if (child == PatchIndex::kNone) continue;
        ASSERT_GT(child, p);
        ASSERT_EQ(index.parent[child], p);
        ASSERT_EQ(index.depth[child], index.depth[p] + 1);
        ASSERT_LE(index.page[p], index.page[child]);
        below += test::twiceArea(patchEdges(index, places[child]));
      }
      if (index.depth[p] + 1 < 2 * pairs(index)) {
        ASSERT_EQ(below, area) << at.what << " patch " << p;
      } else {
        ASSERT_EQ(below, 0);
      }
    }
  }
}

TEST(PatchIndex, everyDepthCoversThePosts) {
  for (const Case& at : cases()) {
    const PatchIndex& index = at.index;
    const auto places = test::placesOf(index);
    std::vector<std::int64_t> area(static_cast<std::size_t>(2 * pairs(index)));
    for (const PatchPlace& place : places)
      area[static_cast<std::size_t>(place.depth())] += test::twiceArea(patchEdges(index, place));
    for (const std::int64_t a : area)
      EXPECT_EQ(a, 2 * std::int64_t{at.posts.columns - 1} * (at.posts.rows - 1)) << at.what;
  }
}

/// Of two patches: the edge that they share, ends the other way round.
bool meet(const PatchEdge& a, const PatchEdge& b) {
  return a.from == b.to && a.to == b.from && a.side == b.side;
}

TEST(PatchIndex, halvesOfADiamondShareTheirHypotenuse) {
  for (const Case& at : cases()) {
    const PatchIndex& index = at.index;
    const auto places = test::placesOf(index);
    std::vector<int> seen(index.size());
    for (std::uint32_t d = 0; d < index.diamonds.size(); ++d) {
      const PatchIndex::Diamond& diamond = index.diamonds[d];
      ASSERT_NE(diamond.patches[0], PatchIndex::kNone);
      for (std::size_t k = 0; k < 2; ++k) {
        const std::uint32_t patch = diamond.patches[k];
        if (patch == PatchIndex::kNone) {
          ASSERT_EQ(diamond.parents[k], PatchIndex::kNone);
          continue;
        }
        ++seen[patch];
        ASSERT_EQ(index.diamond[patch], d);
        const std::uint32_t parent = index.parent[patch];
        ASSERT_EQ(diamond.parents[k], parent == PatchIndex::kNone ? parent : index.diamond[parent]);
        if (parent != PatchIndex::kNone) {
          ASSERT_LT(diamond.parents[k], d);
        }
      }
      const auto edges = patchEdges(index, places[diamond.patches[0]]);
      const auto hypotenuse = std::find_if(edges.begin(), edges.end(), [&](const PatchEdge& e) {
        return e.side == index.depth[diamond.patches[0]];
      });
      if (diamond.patches[1] == PatchIndex::kNone || hypotenuse == edges.end()) continue;
      const auto others = patchEdges(index, places[diamond.patches[1]]);
      EXPECT_TRUE(
          std::any_of(others.begin(), others.end(), [&](const PatchEdge& e) { return meet(*hypotenuse, e); }))
          << at.what << " diamond " << d;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(index.size()));
  }
}

TEST(PatchIndex, pagesHoldTheirPatchesInOrder) {
  for (const Case& at : cases()) {
    const PatchIndex& index = at.index;
    std::uint32_t next = 0;
    for (std::uint32_t page = 0; page < index.pages.size(); ++page) {
      ASSERT_EQ(index.pages[page].firstPatch, next);
      ASSERT_GT(index.pages[page].patches, 0u);
      for (std::uint32_t p = next; p < next + index.pages[page].patches; ++p) ASSERT_EQ(index.page[p], page);
      next += index.pages[page].patches;
    }
    EXPECT_EQ(next, index.size()) << at.what;
  }
}

}  // namespace
}  // namespace trimtab::terrain
