#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "random_parameters.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using ::testing::HasSubstr;

Findings findingsOf(const TuningParameters& parameters) {
  return validate(parameters).findings();
}

/// Findings after a change of the defaults.
Findings findingsAfter(const std::function<void(TuningParameters&)>& change) {
  TuningParameters parameters;
  change(parameters);
  return findingsOf(parameters);
}

TEST(Validation, acceptsTheDefaultsWithoutAWord) {
  const auto validated = validate(TuningParameters{});
  ASSERT_TRUE(validated);
  EXPECT_TRUE(validated.findings().empty()) << toString(validated.findings());
  EXPECT_TRUE(test::sameBits(*defaultParameters(), TuningParameters{}));
}

TEST(Validation, refusesEveryNumberOutsideItsHardRange) {
  for (const ParameterRow& row : parameterRows()) {
    if (row.kind != Kind::scalar) continue;
    for (const double bad : {kNan, kInfinity, -kInfinity, std::nextafter(row.hard.low, -kInfinity),
                             std::nextafter(row.hard.high, kInfinity)}) {
      TuningParameters parameters;
      row.set(parameters, bad);
      const auto validated = validate(parameters);
      EXPECT_FALSE(validated) << row.key << " " << bad;
      ASSERT_EQ(validated.findings().size(), 1u) << row.key << " " << toString(validated.findings());
      EXPECT_EQ(validated.findings()[0].key, row.key);
      EXPECT_EQ(validated.findings()[0].severity, Severity::error);
    }
  }
}

TEST(Validation, warnsOutsideTheUsualRangeAndAccepts) {
  for (const ParameterRow& row : parameterRows()) {
    if (row.kind != Kind::scalar) continue;
    for (const double edge : {row.hard.low, row.hard.high}) {
      TuningParameters parameters;
      parameters.scheme.bands = {{1.5, 320, 240}};
      parameters.altitude.reading = AltitudeReading::table;
      row.set(parameters, edge);
      if (row.key == "fuzzy.hysteresis") continue;  // rules bind it before its range does
      const auto validated = validate(parameters);
      ASSERT_TRUE(validated) << row.key << " " << toString(validated.findings());
      const bool usual = edge >= row.usual.low && edge <= row.usual.high;
      EXPECT_EQ(validated.findings().empty(), usual) << row.key << " " << edge;
      for (const Finding& f : validated.findings()) EXPECT_EQ(f.severity, Severity::warning);
    }
  }
}

TEST(Validation, listsEveryOffence) {
  TuningParameters parameters;
  parameters.lod.scale = Ratio{kNan};
  parameters.view.nearDistance = Metres{-1};
  parameters.altitude.curve = {{5000, 0}, {4000, 1}};
  parameters.scheme.bands.size = 0;
  parameters.measure.budget = Milliseconds{500};
  const Findings findings = findingsOf(parameters);
  EXPECT_EQ(findings.size(), 5u) << toString(findings);
}

TEST(Validation, refusesChoicesThatDoNotExist) {
  EXPECT_EQ(findingsAfter([](auto& p) { p.scheme.combination = static_cast<Combination>(3); }).size(), 1u);
  EXPECT_EQ(findingsAfter([](auto& p) { p.host.protocol = static_cast<HostProtocol>(-1); }).size(), 1u);
}

TEST(Validation, holdsCurvesToTheirShape) {
  const std::pair<Curve<Feet>, const char*> bad[] = {{{}, "2 to 32 points"},
                                                     {{{0, 1}}, "2 to 32 points"},
                                                     {{{0, kNan}, {1, 0}}, "finite"},
                                                     {{{kNan, 0}, {1, 0}}, "finite"},
                                                     {{{0, 0}, {kInfinity, 0}}, "finite"},
                                                     {{{0, 1}, {300000, 0}}, "-2000 to 200000 ft"},
                                                     {{{0, -0.001}, {1, 0}}, "membership 0 to 1"},
                                                     {{{0, 0}, {1, 1.001}}, "membership 0 to 1"},
                                                     {{{2, 0}, {1, 0}}, "rising"},
                                                     {{{1, 0}, {1, 0.5}, {1, 1}}, "at most two"}};
  for (const auto& [curve, expected] : bad) {
    const Findings findings = findingsAfter([&shape = curve](auto& p) { p.altitude.curve = shape; });
    ASSERT_EQ(findings.size(), 1u) << expected << toString(findings);
    EXPECT_EQ(findings[0].key, "fuzzy.altitude.curve_ft");
    EXPECT_THAT(findings[0].expected, HasSubstr(expected));
  }
  const Curve<Feet> good[] = {{{0, 1}, {1, 0}}, {{0, 1}, {0, 0}}, {{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 0}}};
  for (const Curve<Feet>& curve : good)
    EXPECT_TRUE(findingsAfter([&](auto& p) { p.altitude.curve = curve; }).empty());
  EXPECT_EQ(findingsAfter([](auto& p) {
              p.altitude.curve = {{0, 1}, {90000, 0}};
            }).size(),
            1u)
      << "a warning";
}

TEST(Validation, holdsBandsToTheirShape) {
  const std::pair<BandList, const char*> bad[] = {{{}, "1 to 16 bands"},
                                                  {{{0, 64, 64}}, "above 0 and below 2"},
                                                  {{{2, 64, 64}}, "above 0 and below 2"},
                                                  {{{-1, 64, 64}}, "above 0 and below 2"},
                                                  {{{kNan, 64, 64}}, "finite"},
                                                  {{{0.5, 64, 64}, {0.5, 64, 64}}, "rising"},
                                                  {{{1, 64, 64}, {0.5, 64, 64}}, "rising"},
                                                  {{{1, 15, 64}}, "16 to 8192 px"},
                                                  {{{1, 64, 8193}}, "16 to 8192 px"},
                                                  {{{1, -64, 64}}, "16 to 8192 px"}};
  for (const auto& [bands, expected] : bad) {
    const Findings findings = findingsAfter([&shape = bands](auto& p) { p.scheme.bands = shape; });
    ASSERT_EQ(findings.size(), 1u) << expected << toString(findings);
    EXPECT_EQ(findings[0].key, "fuzzy.bands_px");
    EXPECT_THAT(findings[0].expected, HasSubstr(expected));
  }
  EXPECT_EQ(findingsAfter([](auto& p) { p.scheme.bands = {{1, 16, 8192}}; }).size(), 1u) << "a warning";
}

TEST(Validation, keepsHysteresisInsideEveryBand) {
  const auto with = [](double hysteresis, BandList bands) {
    return validate([&] {
             TuningParameters p;
             p.scheme.hysteresis = Membership{hysteresis};
             p.scheme.bands = bands;
             return p;
           }())
        .ok();
  };
  EXPECT_TRUE(with(0.24, {{0.5, 64, 64}, {1, 64, 64}}));
  EXPECT_FALSE(with(0.25, {{0.5, 64, 64}, {1, 64, 64}}));
  EXPECT_FALSE(with(0.1, {{0.5, 64, 64}, {1.8, 64, 64}})) << "the last band reaches up to 2";
  EXPECT_TRUE(with(0.09, {{0.5, 64, 64}, {1.8, 64, 64}}));
  EXPECT_FALSE(with(0.1, {{0.1, 64, 64}})) << "frustum could never return";
  EXPECT_TRUE(with(0, {{0.1, 64, 64}, {0.10000001, 64, 64}}));
}

TEST(Validation, writesHalfABandAsPeopleWould) {
  const auto findings = findingsAfter([](auto& p) { p.scheme.bands = {{0.99, 64, 64}, {1, 64, 64}}; });
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].expected, "less than 0.005, half the narrowest band");
}

TEST(Validation, asksTheMaximumOnlyOfEquations) {
  const auto with = [](AltitudeReading reading, double maximum) {
    return findingsAfter([&](auto& p) {
      p.altitude.reading = reading;
      p.altitude.maximum = Feet{maximum};
    });
  };
  EXPECT_TRUE(with(AltitudeReading::table, 7999).empty());
  EXPECT_TRUE(with(AltitudeReading::equation_a, 8000).empty());
  ASSERT_EQ(with(AltitudeReading::equation_b, 7999).size(), 1u);
  EXPECT_EQ(
      toString(with(AltitudeReading::equation_b, 7999)),
      "fuzzy.altitude.maximum_ft: expected at least 8000 ft, the altitude curve's last point, found 7999 ft");
}

}  // namespace
}  // namespace trimtab
