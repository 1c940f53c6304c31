#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "random_parameters.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

using nlohmann::json;
using Adapter = valijson::adapters::NlohmannJsonAdapter;

class PresetSchema : public ::testing::Test {
 protected:
  PresetSchema() {
    const json document = json::parse(presetSchema());
    valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(Adapter(document), schema_);
  }
  bool accepts(const std::string& text) {
    const json document = json::parse(text);
    return valijson::Validator().validate(schema_, Adapter(document), nullptr);
  }

  valijson::Schema schema_;
};

TEST_F(PresetSchema, isThePublishedFile) {
  EXPECT_EQ(presetSchema(), test::readFile(test::sourceDir() / "presets/preset.schema.json"))
      << "run: trimtab-cli preset schema -o presets/preset.schema.json";
}

TEST_F(PresetSchema, acceptsShippedPresetsAndExports) {
  for (const std::string_view name : shippedPresets()) {
    EXPECT_TRUE(accepts(test::readFile(test::sourceDir() / "presets" / (std::string(name) + ".json"))))
        << name;
    const auto parameters = validate(loadPreset(std::string(name))->parameters);
    EXPECT_TRUE(accepts(exportText(*parameters, "n", {}, ExportFormat::json))) << name;
  }
}

TEST_F(PresetSchema, acceptsWhateverIsSaved) {
  test::RandomParameters random(6);
  for (int i = 0; i < 100; ++i) {
    Preset preset;
    preset.parameters = random();
    EXPECT_TRUE(accepts(*presetText(preset)));
  }
}

TEST_F(PresetSchema, wantsExportsComplete) {
  json exported = json::parse(exportText(defaultParameters(), "n", {}, ExportFormat::json));
  for (const ParameterRow& row : parameterRows()) {
    json less = exported;
    less["parameters"].erase(std::string(row.key));
    EXPECT_FALSE(accepts(less.dump())) << row.key;
  }
  for (const char* const member : {"checksum", "provenance", "name", "version"}) {
    json less = exported;
    less.erase(member);
    EXPECT_FALSE(accepts(less.dump())) << member;
  }
}

TEST_F(PresetSchema, refusesEveryBadFileButThoseWhoseMistakeNoSchemaCanSay) {
  const std::set<std::string> beyondSchemas{"bands-falling",
                                            "base-bad",
                                            "base-folder",
                                            "base-itself",
                                            "base-missing",
                                            "curve-falling",
                                            "curve-three-at-one-place",
                                            "hysteresis-reaches-zero",
                                            "hysteresis-wider-than-band",
                                            "maximum-below-curve",
                                            "member-twice",
                                            "no-rule-counts",
                                            "parameter-twice"};
  std::size_t refused = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::sourceDir() / "tests/data/presets/bad")) {
    const std::string text = test::readFile(entry.path());
    if (!json::accept(text)) continue;
    const std::string name = entry.path().stem().string();
    const bool ofPolicy = name.starts_with("policy-") && name != "policy-terms-not-list";  // lines are text
    EXPECT_EQ(accepts(text), ofPolicy || beyondSchemas.contains(name)) << name;
    ++refused;
  }
  EXPECT_GT(refused, 30u);
}

TEST(ParameterReference, isThePublishedFile) {
  EXPECT_EQ(parameterReference(), test::readFile(test::sourceDir() / "resources/reference.md"))
      << "run: trimtab-cli preset reference -o resources/reference.md";
}

TEST(ParameterReference, namesEveryKeyAndOption) {
  const std::string page = parameterReference();
  for (const ParameterRow& row : parameterRows()) {
    EXPECT_NE(page.find("### `" + std::string(row.key) + "`"), std::string::npos);
    for (const ChoiceOption& option : row.choices)
      EXPECT_NE(page.find("`" + std::string(option.name) + "` (" + std::string(option.label) + ")"),
                std::string::npos);
  }
}

}  // namespace
}  // namespace trimtab
