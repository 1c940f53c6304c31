#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "random_parameters.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

using test::sameBits;

TEST(ShippedPresets, areWhatTheyWouldBeSavedAs) {
  const auto names = shippedPresets();
  EXPECT_EQ(names, (std::vector<std::string_view>{"default", "as-published", "as-printed", "low-level",
                                                  "approach", "helmet-search", "high-cruise"}));
  for (const std::string_view name : names) {
    const auto preset = loadPreset(std::string(name));
    ASSERT_TRUE(preset) << toString(preset.findings());
    EXPECT_TRUE(preset.findings().empty());
    EXPECT_TRUE(validate(preset->parameters));
    EXPECT_EQ(preset->name, name);
    EXPECT_EQ(*presetText(*preset),
              test::readFile(test::sourceDir() / "presets" / (std::string(name) + ".json")));
  }
  EXPECT_TRUE(sameBits(loadPreset("default")->parameters, TuningParameters{}));
}

TEST(ShippedPresets, differWhereTheirNamesSay) {
  const auto keys = [](const char* left, const char* right) {
    std::vector<std::string> result;
    for (const Difference& d : differences(loadPreset(left)->parameters, loadPreset(right)->parameters))
      result.push_back(d.key + " " + d.left + " " + d.right);
    return result;
  };
  EXPECT_EQ(keys("default", "default"), std::vector<std::string>{});
  EXPECT_EQ(keys("default", "as-published"),
            (std::vector<std::string>{
                "fuzzy.pitch.reading linear rounded_step", "fuzzy.hysteresis 0.05 0",
                "culling.occlusion auto depth_map", "terrain.form tiles static_trees",
                "static_lod.error rms as_published", "static_lod.map_from_triangles 30000 0",
                "motion.frames host_states drawn", "motion.lod_step 2 1.2", "motion.lod_maximum 4 1.44",
                "motion.blur_full_degps 0 180", "weather.precipitation_form bounded effect",
                "symbology.enabled false true"}));
  EXPECT_EQ(keys("as-published", "as-printed"),
            std::vector<std::string>{"fuzzy.altitude.reading table equation_a"});
}

}  // namespace
}  // namespace trimtab
