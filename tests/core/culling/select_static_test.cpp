#include "trimtab/culling/select_static.h"
#include "trimtab/units/not_finite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "random_trees.h"
#include "view_axes.h"

namespace trimtab {
namespace {

using test::axesOf;

constexpr double kTreePxPerRadian = 1100;

class StaticCutOf : public testing::TestWithParam<unsigned> {
 protected:
  StaticLodIndex index = test::randomTrees(3, GetParam());
  std::mt19937 random{GetParam() * 7919 + 1};
  LevelCut cut;

  Vec3 randomEye() {
    std::uniform_real_distribution<double> place(-8000, 32000), height(0, 9000);
    return {place(random), place(random), height(random)};
  }
  void collect(std::uint32_t node, Vec3 eye, double perError, std::vector<std::uint32_t>& drawn,
               double spread = 1) const {
    const Box& b = index.bounds[node];
    const Vec3 nearest{std::clamp(eye.x, double{b.minX}, double{b.maxX}),
                       std::clamp(eye.y, double{b.minY}, double{b.maxY}),
                       std::clamp(eye.z, double{b.minZ}, double{b.maxZ})};
    const auto& children = index.nodes[node].children;
    if (children[0] == StaticLodIndex::kNone ||
        length(eye - nearest) >= 3000 * std::pow(double{index.rmsErrorM[node]} * perError / 3000, spread))
      return drawn.push_back(node);
    for (const std::uint32_t child : children) collect(child, eye, perError, drawn, spread);
  }
};

TEST_P(StaticCutOf, isWhatARecursionByTheRuleOfDocumentEDraws) {
  std::set<std::size_t> sizes;
  for (int i = 0; i < 60; ++i) {
    const Vec3 eye = randomEye();
    const double perError = 20 * std::pow(1.1, i);
    selectStatic(index, index.rmsErrorM, {perError}, eye, cut);
    std::vector<std::uint32_t> expected;
    for (const std::uint32_t root : index.roots) collect(root, eye, perError, expected);
    ASSERT_EQ((*cut.nodes), expected);
    sizes.insert((*cut.nodes).size());
  }
  EXPECT_GT(sizes.size(), 20u) << "the cuts hardly differed";
}

TEST_P(StaticCutOf, spreadsItsDistancesAsTheRuleSays) {
  for (const double spread : {0.5, 1.4, 2.5})
    for (int i = 0; i < 20; ++i) {
      const Vec3 eye = randomEye();
      selectStatic(index, index.rmsErrorM, {500, spread, 3000}, eye, cut);
      std::vector<std::uint32_t> expected;
      for (const std::uint32_t root : index.roots) collect(root, eye, 500, expected, spread);
      ASSERT_EQ((*cut.nodes), expected) << spread;
    }
}

TEST_P(StaticCutOf, coversEveryLeafExactlyOnce) {
  for (int i = 0; i < 40; ++i) {
    if (i < 30)
      selectStatic(index, i % 2 ? index.rmsErrorM : index.maxErrorM, {100.0 * (1 + i)}, randomEye(), cut);
    else
      selectStaticDepth(index, i - 30, cut);
    for (const std::uint32_t node : i < 30 ? std::vector<std::uint32_t>{} : (*cut.nodes))
      ASSERT_TRUE(
          index.nodes[node].depth == i - 30 ||
          (index.nodes[node].depth < i - 30 && index.nodes[node].children[0] == StaticLodIndex::kNone));
    std::vector<int> covered(index.size());
    for (const std::uint32_t node : (*cut.nodes)) ++covered[node];
    // Children stand after their parents, so one pass hands every cover down.
    std::size_t leaves = 0;
    for (std::size_t node = 0; node < index.size(); ++node) {
      const auto& children = index.nodes[node].children;
      if (children[0] == StaticLodIndex::kNone) {
        ASSERT_EQ(covered[node], 1);
        ++leaves;
        continue;
      }
      for (const std::uint32_t child : children) covered[child] += covered[node];
    }
    ASSERT_GT(leaves, 9u * 8);
  }
}

TEST_P(StaticCutOf, neverGetsFinerAsTheViewerGoesUpAndAway) {
  const auto depthOver = [this](std::uint32_t leaf) {
    for (const std::uint32_t node : (*cut.nodes)) {
      const Box &b = index.bounds[node], &l = index.bounds[leaf];
      if (index.nodes[node].tile == index.nodes[leaf].tile && b.minX <= l.minX && b.maxX >= l.maxX &&
          b.minY <= l.minY && b.maxY >= l.maxY)
        return int{index.nodes[node].depth};
    }
    return -1;
  };
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t i = 0; i < index.size(); ++i)
    if (index.nodes[i].children[0] == StaticLodIndex::kNone) leaves.push_back(i);
  std::vector<int> last(leaves.size(), 1000);
  int steps = 0;
  for (double height = 1500; height < 2e6; height *= 2) {
    selectStatic(index, index.rmsErrorM, {1500}, {12000, 12000, height}, cut);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const int depth = depthOver(leaves[i]);
      ASSERT_GE(depth, 0);
      ASSERT_LE(depth, last[i]);
      steps += depth < last[i];
      last[i] = depth;
    }
  }
  EXPECT_EQ((*cut.nodes), index.roots) << "from so far only roots are left";
  EXPECT_GT(steps, 100);
}

TEST_P(StaticCutOf, drawsInAnOrderThatDependsOnTheTreesAlone) {
  LevelCut again;
  for (int i = 0; i < 20; ++i) {
    selectStatic(index, index.rmsErrorM, {900}, randomEye(), cut);
    selectStatic(index, index.rmsErrorM, {900}, randomEye(), again);
    ASSERT_TRUE(std::is_sorted((*cut.nodes).begin(), (*cut.nodes).end())) << "as these trees were grown";
    ASSERT_TRUE(std::is_sorted((*again.nodes).begin(), (*again.nodes).end()));
  }
}

INSTANTIATE_TEST_SUITE_P(Trees, StaticCutOf, testing::Range(1u, 6u));

TEST(StaticCuts, isTheRootsForAnEyeThatIsNotANumber) {
  const StaticLodIndex index = test::randomTrees(2, 3);
  LevelCut cut;
  for (const Vec3 eye : {Vec3{kNan, 0, 0}, Vec3{0, kNan, 0}, Vec3{0, 0, kNan}, Vec3{kNan, kNan, kNan},
                         Vec3{0, -std::numeric_limits<double>::infinity(), 0}}) {
    selectStatic(index, index.rmsErrorM, {1e9}, eye, cut);
    EXPECT_EQ((*cut.nodes), index.roots);
  }
  selectStatic(index, index.rmsErrorM, {kNan}, {8000, 8000, 500}, cut);
  EXPECT_EQ((*cut.nodes), index.roots);
}

TEST(StaticCuts, isEmptyWithoutTreesAndWholeAtTheGroundWithoutALimit) {
  LevelCut cut;
  selectStatic({}, {}, {1000}, {}, cut);
  EXPECT_TRUE((*cut.nodes).empty());
  const StaticLodIndex index = test::randomTrees(2, 4);
  selectStatic(index, index.rmsErrorM, {1e12}, {8000, 8000, 500}, cut);
  for (const std::uint32_t node : (*cut.nodes))
    EXPECT_EQ(index.nodes[node].children[0], StaticLodIndex::kNone);
}

TEST(StaticCuts, standsStillWhileOnlyTheErrorIsZero) {
  // A lagoon: every level is exact, so the root is drawn even from inside its box.
  StaticLodIndex index = test::randomTrees(1, 5);
  std::fill(index.rmsErrorM.begin(), index.rmsErrorM.end(), 0.0f);
  LevelCut cut;
  selectStatic(index, index.rmsErrorM, {1e9}, {4000, 4000, 100}, cut);
  EXPECT_EQ((*cut.nodes), index.roots);
}

TEST(StaticDistance, followsThePictureOrAFixedFactorAndTheScale) {
  StaticLodParameters p;
  p.errorPx = Pixels{2};
  p.distancePerError = Ratio{300};
  EXPECT_DOUBLE_EQ(staticLodDistancePerError(p, 1, kTreePxPerRadian), 550);
  EXPECT_DOUBLE_EQ(staticLodDistancePerError(p, 4, kTreePxPerRadian), 137.5) << "a larger scale is coarser";
  p.rule = StaticDistanceRule::factor;
  EXPECT_DOUBLE_EQ(staticLodDistancePerError(p, 1, kTreePxPerRadian), 300);
  EXPECT_DOUBLE_EQ(staticLodDistancePerError(p, 1, 9999), 300) << "whatever the picture";
  EXPECT_DOUBLE_EQ(staticLodDistancePerError(p, 3, 9999), 100);
}

TEST(StaticDistance, takesTheErrorThatIsAskedFor) {
  const StaticLodIndex index = test::randomTrees(1, 6);
  EXPECT_EQ(staticLodError(index, ErrorMeasure::as_published), index.rmsErrorM);
  const std::vector<float> rms = staticLodError(index, ErrorMeasure::rms),
                           largest = staticLodError(index, ErrorMeasure::maximum);
  ASSERT_EQ(rms.size(), index.size());
  for (std::size_t i = 0; i < index.size(); ++i) {
    EXPECT_EQ(rms[i], std::max(index.rmsErrorM[i], index.borderErrorM[i]));
    EXPECT_EQ(largest[i], std::max(index.maxErrorM[i], index.borderErrorM[i]));
  }
  EXPECT_NE(rms, index.rmsErrorM) << "borders count";
}

class StaticVisible : public testing::Test {
 protected:
  StaticVisible() { selectStatic(index, index.rmsErrorM, {3000}, eye.position, cut); }
  StaticLodIndex index = test::randomTrees(3, 21);
  EyePose eye{{12000, 4000, 1500}, axesOf(20, -5)};
  LevelCut cut;
  VisibleSet visible;
};

TEST_F(StaticVisible, neverDropsANodeWithAPointInThePicture) {
  const ViewShape view;
  std::size_t dropped = 0;
  for (int i = 0; i < 200; ++i) {
    eye.axes = axesOf(i * 1.9, i % 40 - 30);
    selectVisible(cut, {.eye = eye, .view = view}, visible);
    for (std::size_t place = 0; place < (*cut.nodes).size(); ++place) {
      const std::uint32_t node = (*cut.nodes)[place];
      ASSERT_EQ(visible.reasonOf(node), visible.reason[place]);
      if (visible.reason[place] != CullReason::outside_frustum) continue;
      ++dropped;
      const Box& b = index.bounds[node];
      for (int corner = 0; corner < 27; ++corner) {
        const auto at = [](int third, float low, float high) { return low + (high - low) * 0.5 * third; };
        const Vec3 e = eye.axes * (Vec3{at(corner % 3, b.minX, b.maxX), at(corner / 3 % 3, b.minY, b.maxY),
                                        at(corner / 9, b.minZ, b.maxZ)} -
                                   eye.position);
        const double depth = -e.z;
        ASSERT_FALSE(depth > view.nearM && e.x >= view.left * depth && e.x <= view.right * depth &&
                     e.y >= view.bottom * depth && e.y <= view.top * depth);
      }
    }
  }
  EXPECT_GT(dropped, 5000u);
}

TEST_F(StaticVisible, drawsTheWholeCutWithoutATestAndForAnEyeThatIsNotANumber) {
  selectVisible(cut, {.eye = eye, .cull = false}, visible);
  EXPECT_EQ(visible.tiles.size(), (*cut.nodes).size());
  eye.position.x = kNan;
  selectVisible(cut, {.eye = eye}, visible);
  EXPECT_EQ(visible.tiles.size(), (*cut.nodes).size());
}

TEST_F(StaticVisible, leavesOutWhatIsBeyondTheWeathersFarDistance) {
  selectVisible(cut, {.eye = eye}, visible);
  const std::size_t inView = visible.tiles.size();
  constexpr double kFar = 6000;
  selectVisible(cut, {.eye = eye, .farM = kFar}, visible);
  EXPECT_GT(visible.beyondVisibility, 5u);
  EXPECT_EQ(visible.tiles.size() + visible.beyondVisibility, inView);
  for (const std::uint32_t node : (*cut.nodes)) {
    const Box& b = index.bounds[node];
    const Vec3 nearest{std::clamp(eye.position.x, double{b.minX}, double{b.maxX}),
                       std::clamp(eye.position.y, double{b.minY}, double{b.maxY}),
                       std::clamp(eye.position.z, double{b.minZ}, double{b.maxZ})};
    const double distance = length(nearest - eye.position);
    ASSERT_FALSE(visible.reasonOf(node) == CullReason::beyond_visibility && distance <= kFar);
    ASSERT_FALSE(visible.reasonOf(node) == CullReason::drawn && distance > kFar + 1);
  }
}

TEST_F(StaticVisible, countsWhatIsDrawnAndWhyTheRestIsNot) {
  selectVisible(cut, {.eye = eye}, visible);
  const VisibleSet all = visible;
  ASSERT_GT(all.tiles.size(), 10u);
  ASSERT_GT(all.outsideFrustum, 10u);
  std::vector<std::uint8_t> flags(all.tiles.size());
  for (std::size_t i = 0; i < flags.size(); i += 3) flags[i] = 1;
  removeOccluded(cut, flags, visible);
  std::uint64_t triangles = 0;
  std::vector<std::uint32_t> expected;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    const std::uint32_t node = all.tiles[i].node;
    EXPECT_EQ(visible.reasonOf(node), flags[i] ? CullReason::occluded : CullReason::drawn);
    if (flags[i]) continue;
    expected.push_back(node);
    triangles += index.nodes[node].triangles;
  }
  ASSERT_EQ(visible.tiles.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(visible.tiles[i].node, expected[i]);
  EXPECT_EQ(visible.triangles, triangles);
  EXPECT_EQ(visible.tiles.size() + visible.occluded + visible.outsideFrustum, (*cut.nodes).size());

  const StaticLodFrame frame = staticLodFrame(index, visible);
  std::uint64_t byDepth = 0, nodes = 0;
  for (std::size_t d = 0; d < StaticLodFrame::kDepths; ++d)
    byDepth += frame.triangles[d], nodes += frame.nodes[d];
  EXPECT_TRUE(frame.drawn);
  EXPECT_EQ(byDepth, triangles);
  EXPECT_EQ(nodes, expected.size());
}

TEST(StaticFrame, gathersWhatIsDeeperThanItsLastPlace) {
  StaticLodIndex index = test::randomTrees(1, 8);
  VisibleSet visible;
  for (std::uint32_t i = 0; i < 3; ++i) {
    index.nodes[i].depth = static_cast<std::uint8_t>(20 + i);
    index.nodes[i].triangles = 10;
    visible.tiles.push_back({i});
  }
  const StaticLodFrame frame = staticLodFrame(index, visible);
  EXPECT_EQ(frame.triangles.back(), 30u);
  EXPECT_EQ(frame.nodes.back(), 3u);
}

}  // namespace
}  // namespace trimtab
