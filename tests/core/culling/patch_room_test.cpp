#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "trimtab/culling/moving_horizon.h"

/// A ridge of one patch, which may be halved, and lower ground behind it. The halves are as near to the
/// source at its posts as the whole is, and further away between them.
namespace trimtab {
namespace {

constexpr std::uint32_t kNone = PatchIndex::kNone, kRidge = 0, kHalf = 1, kBehind = 3;
using Errors = VariantTable<float>;

void fill(std::span<float> errors, float with) {
  std::ranges::fill(errors, with);
}

/// Level ground: its height is all that matters here.
MeshRelief plateau(float west, float east, float south, float north, float z) {
  constexpr std::uint16_t kCells = 4;
  std::vector<ReliefVertex> vertices;
  std::vector<std::uint16_t> indices;
  for (std::uint16_t r = 0; r <= kCells; ++r)
    for (std::uint16_t c = 0; c <= kCells; ++c)
      vertices.push_back({west + (east - west) * c / kCells, south + (north - south) * r / kCells, z, c, r});
  for (std::uint16_t r = 0; r < kCells; ++r)
    for (std::uint16_t c = 0; c < kCells; ++c) {
      const auto sw = static_cast<std::uint16_t>(r * (kCells + 1) + c);
      const auto nw = static_cast<std::uint16_t>(sw + kCells + 1);
      for (const int corner : {sw + 0, sw + 1, nw + 1, sw + 0, nw + 1, nw + 0})
        indices.push_back(static_cast<std::uint16_t>(corner));
    }
  MeshRelief relief;
  makeMeshRelief(vertices, indices, {}, 1, relief);
  return relief;
}

class PatchRoom : public testing::TestWithParam<std::size_t> {
 protected:
  PatchRoom() {
    index_.bounds = {{1000, -2000, 80, 1100, 2000, 100},
                     {1000, -2000, 80, 1100, 0, 100},
                     {1000, 0, 80, 1100, 2000, 100},
                     {3000, -200, 0, 3100, 200, 48}};
    index_.parent = {kNone, kRidge, kRidge, kNone};
    index_.children = {{kHalf, kHalf + 1}, {kNone, kNone}, {kNone, kNone}, {kNone, kNone}};
    index_.errorM = Errors(GetParam(), 4);
    fill(index_.errorM[kRidge], 0.5f);
    fill(index_.errorM[kHalf], 0.1f);
    fill(index_.errorM[kHalf + 1], 0.1f);
    surfaceErrorM_ = index_.errorM;
    for (const std::uint32_t node : {kRidge, kHalf, kHalf + 1}) fill(surfaceErrorM_[node], 10);
  }

  /// Whether the ground behind is said to be hidden: by the ridge as a whole, and then by its halves, 8 m
  /// lower.
  std::array<bool, 2> isHidden(const Errors& surfaceErrorM, bool replacementsStayNear = true) {
    const SurfaceTree tree = SurfaceTree::of(index_, surfaceErrorM);
    MovingHorizon moving;
    std::array<bool, 2> hidden{};
    for (const bool halved : {false, true}) {
      const std::vector<TileDraw> cut = halved ? std::vector<TileDraw>{{kHalf}, {kHalf + 1}, {kBehind}}
                                               : std::vector<TileDraw>{{kRidge}, {kBehind}};
      const auto flags =
          moving.hidden({.eye = {0, 0, 120},
                         .cut = halved ? 2u : 1u,
                         .tiles = cut,
                         .errorOverDistance = 0.000505,
                         .settings = {.columns = 512},
                         .replacementsStayNear = [&](std::uint32_t) { return replacementsStayNear; }},
                        tree, [&](std::vector<HorizonTile>& tiles) {
                          for (const TileDraw& patch : cut)
                            tiles.push_back({.mayOcclude = true, .mesh = &relief_[patch.node]});
                        });
      hidden[halved ? 1 : 0] = flags.back() != 0;
    }
    carried_ = moving.carried();
    return hidden;
  }

  PatchIndex index_;
  Errors surfaceErrorM_;
  std::array<MeshRelief, 4> relief_{plateau(1000, 1100, -2000, 2000, 100), plateau(1000, 1100, -2000, 0, 84),
                                    plateau(1000, 1100, 0, 2000, 84), plateau(3000, 3100, -200, 200, 48)};
  std::uint64_t carried_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Variants, PatchRoom, testing::Values(2u, 3u));

TEST_P(PatchRoom, isForTheSurfaceBetweenThePostsToo) {
  EXPECT_EQ(isHidden(surfaceErrorM_), (std::array{false, false}));
  EXPECT_EQ(carried_, 1u);
  // The posts alone do not say how far the halves may be below the whole.
  EXPECT_EQ(isHidden(index_.errorM), (std::array{true, true})) << "wrong, in what the test above sees";
}

TEST_P(PatchRoom, isNoneWhereErrorsAreNotKnown) {
  // None at all, and those of another count of variants.
  for (const Errors& none : {Errors(), Errors(5 - GetParam(), 4)}) {
    EXPECT_EQ(isHidden(none), (std::array{true, false})) << "each as it is drawn";
    EXPECT_EQ(carried_, 0u);
  }
  for (const float unknown :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    auto errors = index_.errorM;
    fill(errors[kHalf], unknown);
    EXPECT_EQ(isHidden(errors), (std::array{false, false}));
  }
}

TEST_P(PatchRoom, isNoneWhereHeightsSayTooLittle) {
  EXPECT_EQ(isHidden(index_.errorM, false), (std::array{false, false}));
}

}  // namespace
}  // namespace trimtab
