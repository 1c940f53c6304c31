#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/support.h"
#include "trimtab/decision/decide.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

/// A flight's decisions as people read them: a line wherever the band or the reason changes.
std::string decisionLog(const Flight& flight, const ValidatedParameters& parameters) {
  std::string log;
  DecisionMemory memory;
  FrameDecision last;
  bool first = true;
  for (const AircraftState& state : flight.states) {
    FrameInput input;
    input.state = state;
    input.aboveGround = state.aboveGround;
    const FrameDecision d = decide(input, parameters, memory);
    if (first || d.band != last.band || d.reason != last.reason) {
      char time[32];
      std::snprintf(time, sizeof time, "%8.3f s  ", state.time);
      log += time + explain(d, parameters) + '\n';
    }
    first = false;
    last = d;
  }
  return log;
}

struct Case {
  const char* name;
  const char* preset;
  void (*edit)(TuningParameters&);
};
void none(TuningParameters&) {}
constexpr const char* kFormerRules =
    R"({"format": "trimtab-preset", "version": 3, "parameters": {"fuzzy.combination": "rules"}})";
constexpr Case kCases[] = {
    {"default", "default", none},
    {"as-published", "as-published", none},
    {"as-printed", "as-printed", none},
    // What a preset of before with "fuzzy.combination": "rules" is migrated to.
    {"rules", "default", [](TuningParameters& p) { p = parsePreset(kFormerRules, "former")->parameters; }},
    {"twice-minimum", "default",
     [](TuningParameters& p) { p.scheme.combination = Combination::twice_minimum; }},
};

class GoldenDecisions : public testing::TestWithParam<Case> {};

// To accept a change that is meant: TRIMTAB_UPDATE_GOLDEN=1 test_decision, then read the difference.
TEST_P(GoldenDecisions, ofTheSampleFlightStandAsTheyWere) {
  const Result<Flight> flight = readFlight(test::sourceDir() / "resources/flights/yecheon-circuit.csv");
  ASSERT_TRUE(flight.ok()) << toString(flight.findings());
  const Result<Preset> preset = loadPreset(GetParam().preset);
  ASSERT_TRUE(preset.ok()) << toString(preset.findings());
  TuningParameters parameters = preset->parameters;
  GetParam().edit(parameters);
  const Result<ValidatedParameters> valid = validate(parameters);
  ASSERT_TRUE(valid.ok()) << toString(valid.findings());

  const std::string log = decisionLog(*flight, *valid);
  const auto file =
      test::sourceDir() / "tests/golden" / (std::string("yecheon-circuit.") + GetParam().name + ".txt");
  if (std::getenv("TRIMTAB_UPDATE_GOLDEN")) test::writeFile(file, log);
  EXPECT_EQ(log, test::readFile(file)) << file;

  for (const ExportFormat format : {ExportFormat::json, ExportFormat::xml, ExportFormat::ini}) {
    const Result<Preset> read = parsePreset(exportText(*valid, "golden", {}, format), "export");
    ASSERT_TRUE(read.ok()) << toString(read.findings());
    EXPECT_EQ(log, decisionLog(*flight, *validate(read->parameters))) << "from an export";
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, GoldenDecisions, testing::ValuesIn(kCases),
                         [](const testing::TestParamInfo<Case>& chosen) {
                           std::string name = chosen.param.name;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

/// The memberships every ten seconds of the flight, each as a hexadecimal number, which has every bit.
std::string membershipBits(const Flight& flight, const char* name, const ValidatedParameters& parameters) {
  std::string text;
  DecisionMemory memory;
  double next = 0;
  for (const AircraftState& state : flight.states) {
    FrameInput input;
    input.state = state;
    input.aboveGround = state.aboveGround;
    const FrameDecision d = decide(input, parameters, memory);
    if (state.time < next) continue;
    next = state.time + 10;
    char line[160];
    std::snprintf(line, sizeof line, "%s %8.3f s  %a %a %a\n", name, state.time, d.altitudeMembership,
                  d.pitchMembership, d.totalMembership);
    text += line;
  }
  return text;
}

// The file was written by the program as it was before it had policies, and is never written again.
TEST(PublishedReadings, haveEveryBitThatTheyHadBeforePolicies) {
  const Result<Flight> flight = readFlight(test::sourceDir() / "resources/flights/yecheon-circuit.csv");
  ASSERT_TRUE(flight.ok()) << toString(flight.findings());
  std::string bits;
  for (const char* name : {"as-published", "as-printed"}) {
    const Result<Preset> preset = loadPreset(name);
    ASSERT_TRUE(preset.ok()) << toString(preset.findings());
    bits += membershipBits(*flight, name, *validate(preset->parameters));
  }
  EXPECT_EQ(bits, test::readFile(test::sourceDir() / "tests/golden/yecheon-circuit.bits.txt"));
}

}  // namespace
}  // namespace trimtab
