#include <algorithm>
#include <map>

#include "patch_support.h"
#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::terrain {
namespace {

using test::Chosen;
using test::DrawnVertex;
using test::WholeTerrain;

/// The vertices of a border from one post to another, anticlockwise.
std::vector<DrawnVertex> borderBetween(const test::Piece& piece, PatchPoint from, PatchPoint to) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, const std::pair<DrawnVertex, DrawnVertex>*> leaves;
  for (const auto& edge : piece.border) leaves[{edge.first.column, edge.first.row}] = &edge;
  std::vector<DrawnVertex> line;
  auto at = leaves.find({from.column, from.row});
  while (at != leaves.end() && line.size() <= piece.border.size()) {
    line.push_back(at->second->first);
    const DrawnVertex& next = at->second->second;
    if (next.column == to.column && next.row == to.row) {
      line.push_back(next);
      return line;
    }
    at = leaves.find({next.column, next.row});
  }
  return {};
}

/// Every side of every patch, in every variant, against the other patch that may stand at it: that of its own
/// depth across a hypotenuse, of the depth above or below across a leg.
using Pieces = std::vector<test::Pieces>;

void expectNeighboursAgree(const char* what, const PatchIndex& index, const Pieces& pieces) {
  const auto places = test::placesOf(index);
  struct Side {
    std::uint32_t patch;
    bool turned;
    std::vector<DrawnVertex> line;
  };
  std::map<std::array<std::uint32_t, 5>, std::vector<Side>> sides;
  for (std::uint32_t p = 0; p < index.size(); ++p)
    for (const PatchEdge& e : patchEdges(index, places[p])) {
      if (e.side == PatchEdge::kDataEdge) continue;
      std::vector<DrawnVertex> line = borderBetween(pieces[p][0], e.from, e.to);
      ASSERT_FALSE(line.empty()) << what;
      for (std::size_t v = 1; v < index.variants(); ++v)
        ASSERT_EQ(borderBetween(pieces[p][v], e.from, e.to), line) << what << " variant " << v;
      const bool turned = std::pair(e.to.row, e.to.column) < std::pair(e.from.row, e.from.column);
      if (turned) std::reverse(line.begin(), line.end());
      const auto depth = static_cast<std::uint32_t>(e.side);
      const auto key = turned ? std::array{depth, e.to.column, e.to.row, e.from.column, e.from.row}
                              : std::array{depth, e.from.column, e.from.row, e.to.column, e.to.row};
      sides[key].push_back({p, turned, std::move(line)});
    }
  std::size_t pairs = 0;
  for (const auto& [key, at] : sides)
    for (std::size_t i = 1; i < at.size(); ++i) {
      // On one side of it there may be a patch and the one that it was halved from.
      ASSERT_EQ(at[i].line, at[0].line) << what << ": patches " << at[0].patch << " and " << at[i].patch;
      ++pairs;
    }
  EXPECT_GT(pairs, index.size() / 2) << what;
}

void expectNoCracks(const char* what, const PatchIndex& index, const Pieces& pieces, int mixtures) {
  std::mt19937 random(11);
  for (int i = 0; i < mixtures; ++i) {
    const double share = i % 4 == 0 ? 0.55 : i % 4 == 1 ? 0.8 : i % 4 == 2 ? 0.95 : 0.99;
    const auto cut = test::randomCut(index, random, share);
    ASSERT_EQ(test::wrongWith(index, pieces, cut), "") << what << " mixture " << i;
  }
}

constexpr int kMixtures = 200;

void check(const char* what, const HeightGrid& grid, int mixtures = kMixtures) {
  for (const std::uint32_t leafCells : {kFineLeafCells, kCoarseLeafCells}) {
    const WholeTerrain terrain = test::built(grid, defaultLeafToleranceM(grid.posts), leafCells);
    ASSERT_EQ(terrain.index().leafCells, leafCells);
    ASSERT_EQ(terrain.index().variants(), leafCells == kFineLeafCells ? 2u : 3u);
    const Pieces pieces = test::piecesOf(terrain);
    expectNeighboursAgree(what, terrain.index(), pieces);
    expectNoCracks(what, terrain.index(), pieces, mixtures);
  }
}

TEST(PatchCracks, noneInAnyMixtureOfEverest) {
  TRIMTAB_NEEDS_SHARED("data/dem-srtm3-everest/N27E086.hgt");
  check("Everest", test::imported("data/dem-srtm3-everest/N27E086.hgt"));
}
TEST(PatchCracks, noneInAnyMixtureOfBigTujunga) {
  TRIMTAB_NEEDS_SHARED("data/dem-30m-bigtujunga/bigtujunga.tif");
  check("Big Tujunga", test::imported("data/dem-30m-bigtujunga/bigtujunga.tif"));
}
TEST(PatchCracks, noneInAnyMixtureOfTheSample) {
  const test::ScratchDir dir;
  SampleOptions options;
  options.postM = 90;
  ASSERT_TRUE(writeSample(dir / "sample.tif", options));
  check("sample", test::imported(dir / "sample.tif"));
}
TEST(PatchCracks, noneInAnyMixtureOfFractalGround) {
  check("fractal", test::fractal({10, 45, 1.0 / 1200, 1.0 / 1200, 1025, 1025}, 3));
}
TEST(PatchCracks, noneInAnyMixtureOfOddGrids) {
  const PostGrid grids[] = {
      {10, 45, 0.001, 0.001, 2, 2},      {10, 45, 0.001, 0.001, 3, 900},    {10, 45, 0.001, 0.001, 131, 67},
      {10, 45, 0.001, 0.001, 1001, 77},  {10, 45, 0.002, 0.002, 1150, 830},  // strides and several roots
      {-180, -60, 0.05, 0.05, 700, 300},                                     // posts 5 km apart
      {179, -90, 0.1, 0.01, 201, 101},                                       // the pole, the date line
  };
  for (const PostGrid& posts : grids) check("odd grid", test::fractal(posts, 5), 20);
}

}  // namespace
}  // namespace trimtab::terrain
