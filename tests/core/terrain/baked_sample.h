#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>

#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::test {

/// Bakes the sample terrain of these options into "terrain" of a folder, and returns it. Where it cannot, the
/// test fails and there is none.
inline std::shared_ptr<const terrain::Database> bakedSample(const std::filesystem::path& folder,
                                                            const terrain::SampleOptions& sample) {
  const auto written = terrain::writeSample(folder / "sample.tif", sample);
  EXPECT_TRUE(written) << toString(written.findings());
  terrain::BakeOptions options;
  options.sources = {folder / "sample.tif"};
  options.output = folder / "terrain";
  const auto baked = terrain::bake(options);
  EXPECT_TRUE(baked) << toString(baked.findings());
  return baked ? *baked : nullptr;
}

}  // namespace trimtab::test
