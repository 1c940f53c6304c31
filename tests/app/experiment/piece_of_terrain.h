#pragma once

#include <memory>

#include "app/experiment/experiment.h"
#include "tests/core/terrain/baked_sample.h"
#include "tests/support.h"

namespace trimtab::test {

/// A small piece of the sample terrain, baked once, and an experiment over it with small images.
class PieceOfTerrain : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<ScratchDir>();
    terrain_ = bakedSample(folder_->path(), {1, 12, 60, {}});
    ASSERT_NE(terrain_, nullptr);
  }
  static void TearDownTestSuite() {
    terrain_.reset();
    folder_.reset();
  }

  static experiment::Setup setup() {
    experiment::Setup setup;
    setup.terrain = terrain_;
    setup.terrainName = "piece";
    setup.presetName = "default";
    setup.widthPx = 160;
    setup.heightPx = 90;
    setup.repeats = 1;
    return setup;
  }

  static inline std::unique_ptr<ScratchDir> folder_;
  static inline std::shared_ptr<const terrain::Database> terrain_;
};

}  // namespace trimtab::test
