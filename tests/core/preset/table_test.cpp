#include "trimtab/preset/table.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/preset/rows.h"
#include "random_parameters.h"
#include "tests/support.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

using test::sameBits;
using ::testing::HasSubstr;

const ParameterRow& rowOf(const std::string& key) {
  return *findRow(key);
}

TEST(ParameterTable, hasTheKeysThatFilesAndScriptsRelyOn) {
  const std::set<std::string_view> expected{"fuzzy.altitude.reading",
                                            "fuzzy.altitude.reference",
                                            "fuzzy.altitude.curve_ft",
                                            "fuzzy.altitude.maximum_ft",
                                            "fuzzy.altitude.height_offset_ft",
                                            "fuzzy.altitude.membership_offset",
                                            "fuzzy.pitch.reading",
                                            "fuzzy.pitch.curve_deg",
                                            "fuzzy.pitch.step",
                                            "fuzzy.pitch.limit_deg",
                                            "fuzzy.combination",
                                            "fuzzy.hysteresis",
                                            "fuzzy.bands_px",
                                            "culling.case",
                                            "lod.screen_space_error_px",
                                            "lod.scale",
                                            "view.source",
                                            "view.horizontal_fov_deg",
                                            "view.vertical_fov_deg",
                                            "view.near_m",
                                            "view.render_size",
                                            "view.width_px",
                                            "view.height_px",
                                            "host.protocol",
                                            "host.extrapolate",
                                            "host.silence_after_ms",
                                            "measure.budget_ms"};
  std::set<std::string_view> keys;
  for (const ParameterRow& row : parameterRows()) EXPECT_TRUE(keys.insert(row.key).second) << row.key;
  // Later versions add keys; none of these may go without a migration.
  for (const std::string_view key : expected) EXPECT_TRUE(keys.contains(key)) << key;
}

TEST(ParameterTable, findsEveryRowByItsKeyAndNothingElse) {
  for (const ParameterRow& row : parameterRows()) {
    EXPECT_EQ(findRow(row.key), &row);
    EXPECT_EQ(findRow(std::string(row.key) + "x"), nullptr);
    EXPECT_EQ(findRow(row.key.substr(0, row.key.size() - 1)), nullptr);
  }
  EXPECT_EQ(findRow(""), nullptr);
  EXPECT_EQ(findRow("~"), nullptr);
}

TEST(ParameterTable, setsOneFieldAndLeavesTheOthers) {
  test::RandomParameters random(1);
  for (const ParameterRow& row : parameterRows()) {
    TuningParameters changed;
    const TuningParameters source = random();
    row.set(changed, row.get(source));
    EXPECT_TRUE(sameBits(row.get(changed), row.get(source))) << row.key;
    for (const ParameterRow& other : parameterRows())
      if (&other != &row) {
        EXPECT_TRUE(sameBits(other.get(changed), other.get(TuningParameters{})))
            << row.key << " " << other.key;
      }
  }
}

// What the compiler is told of a table is tried here on tables that are wrong.
constexpr std::array kComplete{table::row<&TuningParameters::culling, &CullingParameters::cullingCase>(
    {.key = "culling.case", .label = "l", .help = "h"})};
constexpr auto kScale = table::row<&TuningParameters::lod, &LodParameters::scale>(
    {.key = "lod.scale", .label = "l", .help = "h", .hard = {0, 9}, .usual = {0, 9}});
constexpr auto kError = table::row<&TuningParameters::lod, &LodParameters::screenSpaceError>(
    {.key = "lod.error_px", .label = "l", .help = "h", .hard = {0, 9}, .usual = {0, 9}});
static_assert(table::fieldCount<AltitudeParameters>() == 6 && table::fieldCount<SchemeParameters>() == 3);
static_assert(table::fieldCount<ViewParameters>() == 7 && table::fieldCount<TuningParameters>() >= 8);
static_assert(!table::everyFieldHasOneRow(kComplete));
static_assert(table::keysAreOrderly(std::array{kScale, kError, kComplete[0]}));
static_assert(!table::keysAreOrderly(std::array{kScale, kComplete[0], kError}), "a group in two places");
static_assert(!table::keysAreOrderly(std::array{kScale, kScale}), "a key twice");

TEST(ParameterTable, refusesToCompileWhatContradictsItself) {
  const std::string begin =
      "#include \"core/preset/rows.h\"\nusing namespace trimtab;\n"
      "constexpr auto r = table::row<&TuningParameters::view, &ViewParameters::nearDistance>({";
  const std::string good =
      ".key = \"view.near_m\", .label = \"l\", .help = \"h\", .hard = {0.1, 9}, .usual = {0.1, 9}});\n";
  const auto replaced = [&](const std::string& what, const std::string& with) {
    std::string text = good;
    return text.replace(text.find(what), what.size(), with);
  };
  const std::pair<std::string, std::string> rows[] = {
      {good, ""},
      {replaced("near_m", "near_ft"), "suffix is not the unit"},
      {replaced("near_m", "near"), "suffix is not the unit"},
      {replaced("\"h\"", "\"\""), "help are needed"},
      {replaced(".usual = {0.1, 9}", ".usual = {2, 9}"), "default is outside"},
      {replaced(".usual = {0.1, 9}", ".usual = {0.1, 10}"), "beyond hard"},
      {replaced(".hard = {0.1, 9}", ".hard = {9, 0.1}"), "low < high"},
  };
  for (const auto& [row, reason] : rows) {
    const test::ScratchDir dir;
    test::writeFile(dir / "row.cpp", begin + row);
    const test::Ran ran =
        test::run(std::string(TRIMTAB_COMPILE) + " -fsyntax-only " + (dir / "row.cpp").string());
    EXPECT_EQ(ran.exitCode == 0, reason.empty()) << row << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(reason)) << row;
  }
}

TEST(ParameterText, readsBackBitForBit) {
  test::RandomParameters random(2);
  for (int i = 0; i < 300; ++i) {
    const TuningParameters parameters = random();
    for (const ParameterRow& row : parameterRows()) {
      const ParameterValue value = row.get(parameters);
      const auto back = parseValue(row, toText(row, value));
      ASSERT_TRUE(back) << row.key << toText(row, value);
      EXPECT_TRUE(sameBits(*back, value)) << row.key << " " << toText(row, value);
    }
  }
}

TEST(ParameterText, readsBackNumbersOfEverySize) {
  std::mt19937_64 random(3);
  const ParameterRow& row = rowOf("lod.scale");
  for (int i = 0; i < 100000; ++i) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    const std::string text = toText(row, value);
    ASSERT_TRUE(sameBits(std::get<double>(*parseValue(row, text)), value)) << text;
    ASSERT_TRUE(sameBits(std::strtod(text.c_str(), nullptr), value)) << text;
  }
  for (const double value :
       {0.0, -0.0, 5e-324, std::numeric_limits<double>::min(), std::numeric_limits<double>::max()})
    EXPECT_TRUE(sameBits(std::get<double>(*parseValue(row, toText(row, value))), value)) << value;
}

TEST(ParameterText, isPlainAndShort) {
  EXPECT_EQ(numberText(100000), "100000");
  EXPECT_EQ(numberText(0.1), "0.1");
  EXPECT_EQ(numberText(-0.0), "-0");
  EXPECT_EQ(numberText(1e-6), "1e-06");
  EXPECT_EQ(numberText(1e300), "1e+300");
  EXPECT_EQ(numberText(23313556755.0), "23313556755");
  EXPECT_EQ(numberText(23313556755.0, 3), "23300000000");
  EXPECT_EQ(numberText(-7.25 / 3, 4), "-2.417");
  EXPECT_EQ(numberText(90, 6), "90");
  EXPECT_EQ(numberText(std::nan(""), 4), "nan");
  const TuningParameters defaults;
  EXPECT_EQ(toText(rowOf("fuzzy.altitude.curve_ft"), rowOf("fuzzy.altitude.curve_ft").get(defaults)),
            "4000:1 5000:0.6 6000:0.3 7000:0.1 8000:0");
  EXPECT_EQ(toText(rowOf("fuzzy.bands_px"), rowOf("fuzzy.bands_px").get(defaults)),
            "0.1:320x240 0.5:400x300 1:640x480 1.5:800x600");
  EXPECT_EQ(toText(rowOf("host.protocol"), rowOf("host.protocol").get(defaults)), "auto");
}

TEST(ParameterText, convertsTypedUnits) {
  const auto number = [](const std::string& key, const std::string& text) {
    return std::get<double>(*parseValue(rowOf(key), text));
  };
  EXPECT_EQ(number("fuzzy.altitude.maximum_ft", "4000 ft"), 4000);
  EXPECT_EQ(number("fuzzy.altitude.maximum_ft", " 4000ft "), 4000);
  EXPECT_DOUBLE_EQ(number("fuzzy.altitude.maximum_ft", "3048 m"), 10000);
  EXPECT_DOUBLE_EQ(number("view.near_m", "10 ft"), 3.048);
  EXPECT_DOUBLE_EQ(number("view.horizontal_fov_deg", "1.5707963267948966 rad"), 90);
  EXPECT_EQ(number("view.horizontal_fov_deg", "45 deg"), 45);
  EXPECT_EQ(number("view.horizontal_fov_deg", "45°"), 45);
  EXPECT_EQ(number("motion.blur_full_degps", "120 deg/s"), 120);
  EXPECT_EQ(number("motion.blur_full_degps", "120°/s"), 120);
  EXPECT_DOUBLE_EQ(number("host.silence_after_ms", "0.25 s"), 250);
  EXPECT_EQ(number("view.width_px", "800 px"), 800);
}

TEST(ParameterText, refusesWhatItCannotRead) {
  const std::pair<const char*, const char*> bad[] = {{"view.near_m", ""},
                                                     {"view.near_m", "m"},
                                                     {"view.near_m", "nan"},
                                                     {"view.near_m", "inf"},
                                                     {"view.near_m", "1e999"},
                                                     {"view.near_m", "1,5"},
                                                     {"view.near_m", "1 2"},
                                                     {"view.near_m", "1 s"},
                                                     {"view.near_m", "1 furlong"},
                                                     {"view.near_m", "0x10"},
                                                     {"view.near_m", "--1"},
                                                     {"lod.scale", "1 m"},
                                                     {"host.extrapolate", "2"},
                                                     {"host.extrapolate", ""},
                                                     {"fuzzy.combination", "Sum"},
                                                     {"fuzzy.combination", ""},
                                                     {"fuzzy.combination", "0"},
                                                     {"fuzzy.pitch.curve_deg", "0"},
                                                     {"fuzzy.pitch.curve_deg", "0:1:2"},
                                                     {"fuzzy.pitch.curve_deg", "0:"},
                                                     {"fuzzy.pitch.curve_deg", ":1"},
                                                     {"fuzzy.pitch.curve_deg", "nan:1"},
                                                     {"fuzzy.bands_px", "0.1"},
                                                     {"fuzzy.bands_px", "0.1:320"},
                                                     {"fuzzy.bands_px", "320x240:0.1"},
                                                     {"fuzzy.bands_px", "0.1:320.5x240"},
                                                     {"fuzzy.bands_px", "0.1:-320x240"},
                                                     {"fuzzy.bands_px", "0.1:99999999999x240"},
                                                     {"fuzzy.bands_px", "nan:320x240"}};
  for (const auto& [key, text] : bad) {
    const auto value = parseValue(rowOf(key), text);
    ASSERT_FALSE(value) << key << " " << text;
    EXPECT_EQ(value.findings().front().key, key);
    EXPECT_FALSE(value.findings().front().expected.empty());
  }
  std::string points;
  for (std::size_t i = 0; i <= CurvePoints::kCapacity; ++i) points += std::to_string(i) + ":0 ";
  EXPECT_FALSE(parseValue(rowOf("fuzzy.pitch.curve_deg"), points));
}

}  // namespace
}  // namespace trimtab
