#include "app/experiment/builders.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "app/experiment/experiment.h"
#include "tests/support.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/static_lod/level.h"

/// Both builders of levels over one tile of real scenery.
namespace trimtab {
namespace {

class Builders : public testing::Test {
 protected:
  void SetUp() override {
    TRIMTAB_NEEDS_SHARED(kTile);
    std::filesystem::copy(test::sharedDir() / kTile, dir_.path() / "5168995.btg.gz");
    terrain::BakeOptions options;
    options.sources = {dir_.path() / "5168995.btg.gz"};
    options.output = dir_.path() / "db";
    const auto baked = terrain::bake(options);
    ASSERT_TRUE(baked) << toString(baked.findings());
    terrain_ = *baked;
  }
  static constexpr const char* kTile = "data/fg-kansai-e135n35/Terrain/e130n30/e135n35/5168995.btg.gz";
  test::ScratchDir dir_;
  std::shared_ptr<const terrain::Database> terrain_;
};

TEST_F(Builders, holdBothAgainstTheSourceTriangles) {
  const auto trees = terrain_->staticLod();
  const auto tree = experiment::treeLevels(*trees, 0);
  const terrain::StaticLodReport report = terrain::reportStaticLod(*trees, 0);
  ASSERT_EQ(tree.size(), report.levels);
  for (std::size_t level = 0; level < tree.size(); ++level) {
    EXPECT_EQ(tree[level].error.triangles, report.facesOfLevel[level]);
    // The report has the worst node, and none better than its children.
    EXPECT_LE(tree[level].error.maxM, report.maxErrorM[level] + 1e-3);
    EXPECT_LE(tree[level].error.rmsM, report.rmsErrorM[level] + 1e-3);
  }
  EXPECT_EQ(tree.back().error.rmsM, 0);
  EXPECT_GT(tree.front().error.rmsM, 5);

  const auto patches = experiment::patchLevels(*terrain_, *trees, 0);
  ASSERT_GT(patches.size(), 12U);
  for (const auto& level : patches) {
    EXPECT_GT(level.error.bytes, 6 * level.error.triangles);
    EXPECT_GE(level.error.maxM, level.error.rmsM);
  }
  // Coarsest first, and each depth from its coarsest variant.
  EXPECT_GT(patches.front().error.rmsM, 10 * patches.back().error.rmsM);
  EXPECT_LT(patches.front().error.triangles, patches.back().error.triangles / 100);
  // The finest are as good as their posts, but for the tolerance they were meshed to.
  const auto posts = experiment::postsError(*terrain_, *trees, 0);
  EXPECT_GT(posts.rmsM, 0);
  EXPECT_NEAR(patches.back().error.rmsM, posts.rmsM, 0.5 * posts.rmsM + 3);

  const auto* fewer = experiment::ofNoMoreTriangles(patches, tree.front().error.triangles);
  ASSERT_NE(fewer, nullptr);
  EXPECT_LE(fewer->error.triangles, tree.front().error.triangles);
  const auto* better = experiment::ofNoGreaterRms(patches, tree.front().error.rmsM);
  ASSERT_NE(better, nullptr);
  EXPECT_LE(better->error.rmsM, tree.front().error.rmsM);
}

TEST_F(Builders, areInTheExperimentsTable) {
  experiment::Setup setup;
  setup.terrain = terrain_;
  setup.terrainName = "one tile";
  const auto report = experiment::runStaticLod(setup);
  ASSERT_TRUE(report) << toString(report.findings());
  const auto rowOf = [&](const std::string& quantity) {
    for (std::size_t row = 0; row < report->measured.rows.size(); ++row)
      if (report->measured.text(row, "quantity") == quantity) return row;
    ADD_FAILURE() << "no row " << quantity;
    return std::size_t{0};
  };
  EXPECT_GT(report->measured.number(rowOf("tree_level_0"), "rms_error_m"), 1);
  EXPECT_GT(report->measured.number(rowOf("patches_no_more_triangles_level_0"), "bytes"), 1000);
  EXPECT_GT(report->measured.number(rowOf("patches_no_greater_rms_level_0"), "value"), 100);
  EXPECT_GT(report->measured.number(rowOf("posts_alone"), "rms_error_m"), 0);
  EXPECT_GT(report->measured.number(rowOf("lines_kept_level_4"), "lines_share"),
            report->measured.number(rowOf("lines_as_published_level_4"), "lines_share"));
  for (const char* column : {"triangles_per_strip", "triangles_per_fan", "acmr_16", "acmr_32"})
    EXPECT_GT(report->measured.number(rowOf("tree_level_0"), column), 1) << column;
  EXPECT_THAT(report->notes,
              ::testing::Contains(::testing::HasSubstr("at least n/2 and at most n triangles in a leaf")));
  const auto errors = std::find_if(report->plots.begin(), report->plots.end(),
                                   [](const auto& plot) { return plot.file == "static-lod-errors"; });
  ASSERT_NE(errors, report->plots.end());
  EXPECT_EQ(errors->series.size(), 2U);
  EXPECT_TRUE(errors->logX && errors->logY);
}

}  // namespace
}  // namespace trimtab
