#include "trimtab/culling/select_objects.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "objects_on.h"
#include "tests/core/scene/terrain/synthetic_terrain.h"
#include "trimtab/culling/frustum.h"

namespace trimtab::test {
namespace {

class SelectObjects : public testing::Test {
 protected:
  static const terrain::ObjectTerrain& objects() {
    static const auto made = [] {
      const SyntheticTerrain ground(8, 1.0 / 1200, {Degrees{-33.2}, Degrees{151.0}, Metres{0}}, mountains);
      return scattered(ground, 6000, 3, 12, 2);
    }();
    return *made;
  }
  const ObjectIndex& index = objects().index;

  ObjectQuery query(Vec3 eye, double headingRad) const {
    ObjectQuery q;
    q.eye.position = eye;
    const Vec3 forward{std::sin(headingRad), std::cos(headingRad), -0.1};
    const Vec3 right = normalized(cross(forward, Vec3{0, 0, 1}));
    q.eye.axes = {{right, cross(right, normalized(forward)), -normalized(forward)}};
    q.rule = {.maxErrorPx = 1, .pixelsPerRadian = 1000};
    return q;
  }
  Vec3 footOf(const ObjectIndex::Cell& cell, const ObjectInstance& i) const {
    return {16.0 * cell.origin[0] + i.x, 16.0 * cell.origin[1] + i.y, 16.0 * cell.origin[2] + i.z};
  }
  /// Returns the level at which each instance is drawn, counted from the first level of its model.
  static std::map<std::uint32_t, std::uint32_t> levels(const ObjectIndex& index,
                                                       const VisibleObjects& visible) {
    std::map<std::uint32_t, std::uint32_t> all;
    for (std::uint32_t level = 0; level + 1 < visible.firstOfLevel.size(); ++level)
      for (std::uint32_t i = visible.firstOfLevel[level]; i < visible.firstOfLevel[level + 1]; ++i) {
        const DrawnObject& drawn = visible.drawn[i];
        const ObjectIndex::Model& model = index.models[index.instances[drawn.instance].model];
        EXPECT_GE(level, model.firstLevel);
        EXPECT_LT(level, model.firstLevel + model.levels);
        EXPECT_TRUE(all.emplace(drawn.instance, level - model.firstLevel).second) << "it is drawn twice";
      }
    return all;
  }
};

TEST_F(SelectObjects, whatEachInstanceAsksForByItselfIsDrawn) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  VisibleObjects visible;
  std::size_t drawn = 0, small = 0, far = 0, coarse = 0;
  for (int n = 0; n < 60; ++n) {
    const Box& all = index.cells[0].bounds;
    ObjectQuery q =
        query({all.minX + unit(random) * (double{all.maxX} - all.minX),
               all.minY + unit(random) * (double{all.maxY} - all.minY), all.maxZ * (1.2 - unit(random))},
              6.3 * unit(random));
    q.cull = n % 3 != 0;
    q.leastPx = n % 2 == 0 ? 4 * unit(random) : 0;
    if (n % 4 == 1) q.farM = 8000 * unit(random);
    if (n % 5 == 1) q.airM = 8000 * unit(random);
    q.rule.lodScale = 0.2 + 10 * unit(random);
    if (n % 7 == 0) q.rule.spread = 1.3;
    selectObjects(index, q, visible);
    const auto levelOf = levels(index, visible);
    const Frustum frustum(q.eye, q.view);
    for (std::uint32_t number = 0; number < index.cells.size(); ++number) {
      const ObjectIndex::Cell& cell = index.cells[number];
      if (!cell.isLeaf(number)) continue;
      for (std::uint32_t i = cell.firstInstance; i < cell.firstInstance + cell.instances; ++i) {
        const ObjectInstance& instance = index.instances[i];
        const ObjectIndex::Model& model = index.models[instance.model];
        const Vec3 foot = footOf(cell, instance);
        const double distance = length(foot - q.eye.position),
                     radius = double{model.radiusM} * instance.scale;
        const bool isSmall =
            2 * radius * q.rule.pixelsPerRadian<q.leastPx * distance, isFar = distance> q.farM ||
            (q.cull && distance - radius > q.airM + 0.1);
        const auto found = levelOf.find(i);
        small += isSmall, far += isFar;
        if (isSmall || isFar) {
          // Just before the limit of the air it may go either way.
          EXPECT_EQ(found, levelOf.end()) << n << ": " << i;
          continue;
        }
        const float x = static_cast<float>(foot.x), y = static_cast<float>(foot.y),
                    z = static_cast<float>(foot.z), r = static_cast<float>(0.5 * radius);
        if (found == levelOf.end()) {
          ASSERT_TRUE(q.cull);
          if (distance - radius < q.airM) {
            EXPECT_FALSE(frustum.mayShow({x - r, y - r, z - r, x + r, y + r, z + r})) << n << ": " << i;
          }
          continue;
        }
        ++drawn;
        const double nearest = std::max(distance - radius, 0.0);
        const auto accepts = [&](std::uint32_t level) {
          const double error = double{index.levels[model.firstLevel + level].errorM} * instance.scale;
          return level == 0 || !q.rule.isTooCoarse(error, nearest * nearest, q.rule.limit());
        };
        EXPECT_TRUE(accepts(found->second)) << n << ": " << i;
        coarse += found->second > 0;
        if (found->second + 1 < model.levels) {
          EXPECT_FALSE(accepts(found->second + 1)) << n << ": " << i;
        }
      }
    }
    EXPECT_EQ(visible.drawn.size() + visible.outsideFrustum + visible.tooFar + visible.tooSmall,
              index.instances.size());
  }
  for (const std::size_t kind : {drawn, small, far, coarse}) EXPECT_GT(kind, 1000u);
}

TEST_F(SelectObjects, hiddenCellsAreLeftOutWholeAndNamed) {
  ObjectQuery q = query({0, 0, 20000}, 0);
  q.cull = true;
  q.view.left = q.view.bottom = -30, q.view.right = q.view.top = 30;
  q.eye.axes = {{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}};
  VisibleObjects visible;
  selectObjects(index, q, visible);
  ASSERT_EQ(visible.drawn.size(), index.instances.size());
  std::vector<std::uint8_t> hidden(index.cells.size(), 0);
  hidden[5] = 1;
  q.hidden = hidden;
  selectObjects(index, q, visible);
  EXPECT_EQ(visible.occluded, index.cells[5].instances);
  EXPECT_EQ(visible.reason[5], CullReason::occluded);
  EXPECT_EQ(visible.reason[4], CullReason::drawn);
  for (const DrawnObject& drawn : visible.drawn) EXPECT_NE(drawn.cell, 5u);
  hidden.resize(3);
  q.hidden = hidden;
  selectObjects(index, q, visible);
  EXPECT_EQ(visible.occluded, 0u) << "flags of another terrain are ignored";
}

TEST_F(SelectObjects, anEyeThatIsNoPlaceGetsNothing) {
  VisibleObjects visible;
  for (const double bad : {std::nan(""), double{INFINITY}, -double{INFINITY}}) {
    ObjectQuery q = query({bad, 0, 100}, 0);
    for (const bool cull : {true, false}) {
      q.cull = cull;
      selectObjects(index, q, visible);
      EXPECT_TRUE(visible.drawn.empty()) << bad;
    }
  }
  ObjectQuery q = query({0, 0, 2000}, 0);
  q.farM = std::nan("");
  selectObjects(index, q, visible);
  q.farM = 0;
  selectObjects(index, q, visible);
  EXPECT_TRUE(visible.drawn.empty());
  const ObjectIndex none;
  selectObjects(none, query({0, 0, 0}, 0), visible);
  EXPECT_TRUE(visible.drawn.empty());
  ASSERT_EQ(visible.firstOfLevel.size(), 1u);
}

}  // namespace
}  // namespace trimtab::test
