#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/scene/terrain/patches/page_budget.h"
#include "core/scene/terrain/patches/patch_culling.h"
#include "core/scene/terrain/patches/patch_layer.h"
#include "patched_terrain.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/terrain/bake/slow_patches.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/scene/offscreen.h"

namespace trimtab::scene {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// A renderer's part in paging.
struct Viewer {
  explicit Viewer(std::shared_ptr<const terrain::PatchTerrain> terrain) {
    layer.setTerrain(&terrain->index());
    culling.setTerrain(terrain);
  }
  const PagingFrame& frame(const FrameRequest& request) {
    const EyePose eye{culling.index().frame.fromGeodetic(request.eye), {}};
    const PatchCulling::Paged paged = culling.page(request, eye, layer);
    result.paging = paged.paging;
    result.counters.cutsSelected += paged.cutsSelected;
    return result.paging;
  }
  /// Frames until nothing is on its way any more.
  const PagingFrame& settle(const FrameRequest& request) {
    for (const auto start = Clock::now(); millisecondsSince(start) < 20e3;) {
      frame(request);
      if (result.paging.waiting == 0) break;
      std::this_thread::sleep_for(1ms);
    }
    return frame(request);
  }

  PatchLayer layer;
  PatchCulling culling;
  FrameResult result;
};

std::vector<std::pair<std::uint32_t, int>> tilesOf(const LevelCut& cut) {
  std::vector<std::pair<std::uint32_t, int>> tiles;
  for (const TileDraw& tile : cut.tiles) tiles.emplace_back(tile.node, tile.variant.number);
  return tiles;
}

class Paging : public testing::Test {
 protected:
  static std::shared_ptr<const terrain::PatchTerrain> patches() {
    static const auto terrain = test::smallPatches(1300, 900);
    return terrain;
  }
  void SetUp() override {
    auto created = Offscreen::create(64, 64);
    if (!created) GTEST_SKIP() << toString(created.findings());
    offscreen = std::move(created).value();
    offscreen->makeCurrent();
    slow = std::make_shared<test::SlowPatches>(patches());
  }
  /// Over a place by fractions of the terrain's sides.
  static FrameRequest request(double east, double north, double heightM, double megabytes = 512) {
    const PatchIndex& index = patches()->index();
    FrameRequest r;
    r.eye = {Degrees{50 + north * index.rows / 3600.0}, Degrees{10 + east * index.columns / 2400.0},
             Metres{heightM}};
    r.terrain.cache = Megabytes{megabytes};
    r.levers.drawn.errorPx = 1;
    r.view.widthPx = 1280;
    r.view.heightPx = 720;
    return r;
  }
  static FrameRequest waiting(FrameRequest r) {
    r.waitForPages = true;
    return r;
  }
  /// Megabytes of all pages.
  double all() {
    Viewer viewer(slow);
    FrameRequest r = request(0.5, 0.5, 1000);
    r.levers.drawn.errorPx = 0;
    return static_cast<double>(viewer.frame(waiting(r)).bytes) / 1e6;
  }

  std::unique_ptr<Offscreen> offscreen;
  std::shared_ptr<test::SlowPatches> slow;
};

TEST_F(Paging, makesNoFrameWaitForASlowDisk) {
  Viewer viewer(slow);
  viewer.settle(request(0.1, 0.5, 900));
  slow->held = true;
  const std::size_t read = slow->read().size();
  std::size_t heldBack = 0;
  for (int i = 0; i < 100; ++i) {
    FrameRequest r = request(0.1 + 0.008 * i, 0.5, 900);
    r.velocity = Velocity{MetresPerSecond{0}, MetresPerSecond{300}, MetresPerSecond{0}};
    heldBack += viewer.frame(r).heldBack;
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(slow->read().size(), read) << "a frame waited until a read had ended";
  EXPECT_GT(heldBack, 100u);
  slow->held = false;
}

TEST_F(Paging, endsWhereAFrameThatWaitsBegins) {
  const double megabytes = all();
  ASSERT_GT(megabytes, 1);
  for (const double share : {2.0, 0.5, 0.15}) {
    Viewer background(slow);
    for (int i = 0; i < 6; ++i) {
      const FrameRequest r = request(0.1 + 0.15 * i, 0.2 + 0.1 * i, 700 + 200 * i, share * megabytes);
      background.settle(r);
      Viewer fresh(slow);
      fresh.frame(waiting(r));
      ASSERT_EQ(tilesOf(background.culling.cut()), tilesOf(fresh.culling.cut())) << share << " " << i;
      ASSERT_EQ(background.result.paging.heldBack, fresh.result.paging.heldBack);
      if (share > 1) {
        EXPECT_EQ(fresh.result.paging.heldBack, 0u);
      }
      EXPECT_EQ(background.result.paging.waiting, 0u);
      for (const auto& [node, variant] : tilesOf(fresh.culling.cut()))
        ASSERT_TRUE(fresh.layer.has(fresh.culling.index().page[node]));
    }
  }
}

TEST_F(Paging, staysWithinTheBudgetWhateverIsFlownOver) {
  const double megabytes = 0.25 * all();
  Viewer viewer(slow);
  std::set<std::size_t> sizes;
  for (int i = 0; i < 300; ++i) {
    FrameRequest r =
        request(0.5 + 0.45 * std::sin(0.05 * i), 0.5 + 0.4 * std::cos(0.071 * i), 600, megabytes);
    r.velocity = Velocity{MetresPerSecond{200}, MetresPerSecond{100}, MetresPerSecond{0}};
    const PagingFrame& paging = viewer.frame(r);
    ASSERT_LE(static_cast<double>(paging.bytes), megabytes * 1e6);
    ASSERT_LE(viewer.layer.bytes(), paging.bytes);
    EXPECT_EQ(paging.budgetBytes, static_cast<std::uint64_t>(megabytes * 1e6));
    sizes.insert(viewer.culling.cut().tiles.size());
    if (i % 10 == 0) std::this_thread::sleep_for(5ms);
  }
  EXPECT_GT(viewer.result.paging.pagesDropped, 10u);
  EXPECT_GT(viewer.result.paging.bytes, megabytes * 1e6 / 2);
  EXPECT_GT(sizes.size(), 10u);
}

TEST_F(Paging, givesUpWhatItHasWhenTheBudgetShrinksAndGetsItBack) {
  Viewer viewer(slow);
  const FrameRequest large = request(0.5, 0.5, 600), small = request(0.5, 0.5, 600, 0.1 * all());
  viewer.settle(large);
  const auto before = tilesOf(viewer.culling.cut());
  viewer.frame(small);
  EXPECT_LE(viewer.layer.bytes(), small.terrain.cache.value() * 1e6);
  EXPECT_LT(viewer.culling.cut().tiles.size(), before.size());
  EXPECT_GT(viewer.result.paging.heldBack, 0u);
  viewer.settle(large);
  EXPECT_EQ(tilesOf(viewer.culling.cut()), before);
}

TEST_F(Paging, givesTheGpuItsMemoryBackWhenTheBudgetShrinksALot) {
  Viewer viewer(slow);
  const FrameRequest large = request(0.5, 0.5, 600), small = request(0.5, 0.5, 600, 0.02 * all());
  viewer.settle(large);
  const std::size_t before = viewer.layer.reservedBytes();
  viewer.settle(small);
  EXPECT_LT(viewer.layer.reservedBytes(), before / 2);
  for (const TileDraw& tile : viewer.culling.cut().tiles)
    ASSERT_TRUE(viewer.layer.has(viewer.culling.index().page[tile.node]));
  EXPECT_FALSE(viewer.culling.cut().tiles.empty());
}

TEST_F(Paging, hasWhatTheEyeIsFlyingTo) {
  FrameRequest from = request(0.2, 0.5, 700), to = request(0.2, 0.5, 700);
  const double metres = 4500;
  const LocalFrame& frame = patches()->index().frame;
  const Vec3 east = frame.ecefToLocal() * eastNorthUp(from.eye.latitude, from.eye.longitude).row[0];
  to.eye = frame.toGeodetic(frame.fromGeodetic(from.eye) + east * metres);
  std::map<bool, std::size_t> heldBack;
  for (const bool says : {true, false}) {
    Viewer viewer(slow);
    if (says)
      from.velocity = Velocity{MetresPerSecond{0}, MetresPerSecond{metres / 5}, MetresPerSecond{0}};
    else
      from.velocity.reset();
    viewer.settle(from);
    EXPECT_EQ(viewer.result.paging.heldBack, 0u);
    heldBack[says] = viewer.frame(to).heldBack;
  }
  EXPECT_EQ(heldBack[true], 0u);
  EXPECT_GT(heldBack[false], 0u);
}

TEST_F(Paging, drawsCoarserForGoodWhereAPageCannotBeRead) {
  const FrameRequest r = request(0.3, 0.4, 500);
  Viewer whole(slow);
  whole.frame(waiting(r));
  const auto bad = std::make_shared<test::SlowPatches>(patches());
  const PatchIndex& index = patches()->index();
  std::size_t finest = 0;
  for (const TileDraw& tile : whole.culling.cut().tiles)
    if (index.page[tile.node] > finest) finest = index.page[tile.node];
  bad->broken.insert(static_cast<std::uint32_t>(finest));
  for (const bool waits : {true, false}) {
    Viewer viewer(bad);
    const PagingFrame& paging = waits ? viewer.frame(waiting(r)) : viewer.settle(r);
    EXPECT_EQ(paging.failed, 1u);
    EXPECT_EQ(paging.waiting, 0u);
    EXPECT_GT(paging.heldBack, 0u);
    EXPECT_LT(viewer.culling.cut().tiles.size(), whole.culling.cut().tiles.size());
    EXPECT_EQ(viewer.culling.failures().size(), 1u);
    for (const TileDraw& tile : viewer.culling.cut().tiles) EXPECT_NE(index.page[tile.node], finest);
  }
}

TEST_F(Paging, drawsNothingButGoesOnWithoutRoots) {
  slow->broken.insert(0);
  Viewer viewer(slow);
  viewer.frame(request(0.3, 0.4, 500));
  EXPECT_EQ(viewer.layer.bytes(), 0u);
  // Pages that do not need the roots arrive when they do.
  for (int i = 0; i < 3; ++i) viewer.frame(request(0.3, 0.4, 500));
  EXPECT_EQ(viewer.culling.failures().size(), 1u);
}

TEST_F(Paging, choosesAgainOnlyWhatMayHaveChanged) {
  Viewer viewer(slow);
  FrameRequest r = waiting(request(0.3, 0.4, 500));
  viewer.frame(r);
  const auto tiles = tilesOf(viewer.culling.cut());
  const std::uint64_t chosen = viewer.result.counters.cutsSelected;
  const auto number = viewer.culling.cutNumber();
  for (int i = 0; i < 3; ++i) viewer.frame(r);
  EXPECT_EQ(viewer.result.counters.cutsSelected, chosen);
  r.skips.sameCut = false;
  viewer.frame(r);
  EXPECT_EQ(viewer.result.counters.cutsSelected, chosen + 1);
  EXPECT_EQ(tilesOf(viewer.culling.cut()), tiles);
  EXPECT_EQ(viewer.culling.cutNumber(), number);
  r.eye.height = Metres{505};
  viewer.frame(r);
  EXPECT_GT(viewer.culling.cutNumber().cut, number.cut);
}

TEST_F(Paging, readsAllAgainWhenTheContextWasLost) {
  Viewer viewer(slow);
  const FrameRequest r = request(0.3, 0.4, 500);
  viewer.settle(r);
  const auto tiles = tilesOf(viewer.culling.cut());
  const std::size_t bytes = viewer.layer.bytes();
  viewer.layer.setTerrain(&patches()->index());
  viewer.frame(r);
  for (const TileDraw& tile : viewer.culling.cut().tiles)
    ASSERT_TRUE(viewer.layer.has(viewer.culling.index().page[tile.node]));
  viewer.settle(r);
  EXPECT_EQ(tilesOf(viewer.culling.cut()), tiles);
  EXPECT_EQ(viewer.layer.bytes(), bytes);
}

TEST_F(Paging, showsTheMeshesOfWhatIsThere) {
  Viewer viewer(slow);
  viewer.frame(waiting(request(0.3, 0.4, 900, 512)));
  const PatchIndex& index = patches()->index();
  std::size_t absent = 0;
  for (std::uint32_t patch = 0; patch < index.size(); ++patch) {
    const terrain::PatchMesh* mesh = viewer.culling.meshOf(patch);
    ASSERT_EQ(mesh != nullptr, viewer.layer.has(index.page[patch]));
    absent += !mesh;
    if (mesh) {
      ASSERT_EQ(mesh->firstIndex[1], 3u * index.triangles[patch][0]);
    }
  }
  EXPECT_GT(absent, 0u);
}

/// The same through the renderer, to the pixel.
class PagedPicture : public test::SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (!offscreen) return;
    slow = std::make_shared<test::SlowPatches>(test::patchedMountains(false)->patches());
    auto terrain = std::make_shared<test::PatchedTerrain>(*test::patchedMountains(false));
    terrain->replace(slow);
    use(terrain);
  }
  std::shared_ptr<test::SlowPatches> slow;
};

TEST_F(PagedPicture, endsAtWhatAFrameThatWaitsShows) {
  FrameRequest r = request(over(0.3, 0.4, 700), {Degrees{50}, Degrees{-12}, Degrees{0}});
  r.levers.drawn.errorPx = 1;
  slow->setDelay(10ms);
  std::size_t differed = 0;
  for (int i = 0; i < 3; ++i) {
    r.eye = over(0.3 + 0.2 * i, 0.4 + 0.1 * i, 700);
    use(database);
    r.waitForPages = false;
    FrameResult result;
    const auto first = picture(r, &result);
    // Until nothing is on its way and nothing changes any more, however long a frame takes.
    auto background = first;
    int same = 0;
    for (const auto start = Clock::now();
         (result.paging.waiting > 0 || same < 10 || millisecondsSince(start) < 400) &&
         millisecondsSince(start) < 60e3;) {
      auto next = picture(r, &result);
      same = next == background ? same + 1 : 0;
      background = std::move(next);
    }
    use(database);
    r.waitForPages = true;
    const auto whole = picture(r, &result);
    EXPECT_EQ(result.paging.heldBack, 0u);
    EXPECT_EQ(differing(background, whole), 0u);
    differed += differing(first, whole);
  }
  EXPECT_GT(differed, 1000u) << "there was nothing to wait for";
}

TEST_F(PagedPicture, isWholeFromTheFirstFrameOn) {
  slow->setDelay(40ms);
  FrameRequest r = request(over(0.5, 0.5, 900), {Degrees{50}, Degrees{-70}, Degrees{0}});
  r.overlays.showHoles = true;
  r.waitForPages = false;
  for (int i = 0; i < 12; ++i) {
    r.eye = over(0.3 + 0.03 * i, 0.5, 900);
    FrameResult result;
    const auto pixels = picture(r, &result);
    std::size_t holes = 0;
    for (std::size_t p = 0; p < pixels.size(); p += 4)
      holes += pixels[p] == 255 && pixels[p + 1] == 0 && pixels[p + 2] == 255;
    EXPECT_EQ(holes, 0u) << i << ", " << result.paging.waiting << " pages on their way";
  }
}

TEST(PageBudget, holdsWhatLeavesTheLeastErrorAndTheRootsWhateverTheyCost) {
  PageBudget pages;
  pages.reset({50, 10, 10, 10, 10, 10}, 1);
  const std::vector<PageWant> now{{3, 2}, {1, 9}, {0, 100}, {2, 9}}, later{{4, 5}, {1, 5}, {5, 1}};
  const auto aims = [&](std::uint64_t budget) {
    pages.aim(now, later, budget);
    std::vector<std::uint32_t> numbers;
    for (const PageWant& want : pages.aims()) numbers.push_back(want.page);
    return numbers;
  };
  using Pages = std::vector<std::uint32_t>;
  EXPECT_EQ(aims(1000), (Pages{0, 1, 2, 3, 4, 5}));
  EXPECT_FALSE(pages.isShort());
  EXPECT_EQ(aims(90), (Pages{0, 1, 2, 3, 4}));
  EXPECT_FALSE(pages.isShort());
  EXPECT_EQ(aims(75), (Pages{0, 1, 2}));
  EXPECT_TRUE(pages.isShort());
  EXPECT_EQ(aims(0), (Pages{0}));
}

TEST(PageBudget, givesUpWhatWasLongestOfNoUse) {
  PageBudget pages;
  pages.reset({5, 10, 10, 10, 10}, 1);
  for (const std::uint32_t page : {0u, 1u, 2u, 3u}) pages.hold(page);
  pages.aim(std::vector<PageWant>{{0, 9}, {1, 9}}, {}, 40);
  pages.aim(std::vector<PageWant>{{0, 9}, {2, 9}}, {}, 40);
  EXPECT_EQ(pages.toDrop(5), std::nullopt);
  EXPECT_EQ(pages.toDrop(10), 3u) << "never of use";
  pages.drop(3);
  EXPECT_EQ(pages.toDrop(20), 1u);
  pages.drop(1);
  EXPECT_EQ(pages.toDrop(1000), std::nullopt) << "what is of use, and the roots, stay";
  EXPECT_EQ(pages.bytes(), 15u);
}

}  // namespace
}  // namespace trimtab::scene
