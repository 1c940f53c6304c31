#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "trimtab/measure/trace.h"

namespace trimtab {
namespace {

using nlohmann::json;
using test::Ran;
using ::testing::HasSubstr;

Ran decideBy(const std::string& arguments) {
  return test::run(test::program("trimtab-cli").string() + " decide " + arguments);
}
const std::string kFlight = (test::sourceDir() / "resources/flights/yecheon-circuit.csv").string();

TEST(DecideCommand, printsOneJsonDocumentWithTheFieldsThatScriptsReadFrom) {
  const Ran ran = decideBy("--preset as-published --altitude-ft 5000 --pitch-deg -1 --json");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const json d = json::parse(ran.out);
  EXPECT_EQ(d.at("altitude_membership"), 0.6);
  EXPECT_NEAR(d.at("pitch_membership").get<double>(), 0.507, 1e-12);
  EXPECT_NEAR(d.at("total_membership").get<double>(), 1.107, 1e-12);
  EXPECT_EQ(d.at("scheme"), "dynamic");
  EXPECT_EQ(d.at("depth_map_px"), (json{640, 480}));
  EXPECT_EQ(d.at("reason"), "in_band");
}

TEST(DecideCommand, saysFrustumWithoutADepthMap) {
  const Ran ran = decideBy("--altitude-ft 9000 --pitch-deg 29 --roll-deg 60 --json");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const json d = json::parse(ran.out);
  EXPECT_EQ(d.at("scheme"), "frustum");
  EXPECT_TRUE(d.at("depth_map_px").is_null());
}

TEST(DecideCommand, takesSingleParametersFromTheCommandLine) {
  EXPECT_THAT(decideBy("--altitude-ft 3000 --pitch-deg 0 --set fuzzy.combination=twice_minimum").out,
              HasSubstr("twice the minimum 1.000"));
  const Ran unknown =
      decideBy("--altitude-ft 3000 --pitch-deg 0 --set fuzzy.nonsense=1 --set fuzzy.hysteresis=much");
  EXPECT_EQ(unknown.exitCode, 1);
  EXPECT_THAT(unknown.err, HasSubstr("found fuzzy.nonsense=1"));
  EXPECT_THAT(unknown.err, HasSubstr("fuzzy.hysteresis"));
}

TEST(DecideCommand, decidesTheHeightAboveGroundWhereThePresetAsksForIt) {
  const std::string above = "--set fuzzy.altitude.reference=above_ground --pitch-deg 0 --altitude-ft 20000";
  EXPECT_THAT(decideBy(above + " --above-ground-ft 5000").out, HasSubstr("5000 ft above ground gives 0.600"));
  EXPECT_THAT(decideBy(above).out, HasSubstr("20000 ft above ground gives 0.000"));
}

const std::string kPolicy =
    " --set 'policy.terms=altitude low = ramp 2000 1000 | load high = ramp 0.5 1'"
    " --set 'policy.rules=if altitude is low then lod_scale = 4 | if altitude is not low then "
    "lod_scale = 2, render_scale = 1 with 0.5 | if load is high then lod_scale = 8'"
    " --set policy.enabled=true ";

TEST(DecideCommand, saysWhatThePolicyMadeOfWhichSignals) {
  const Ran ran = decideBy("--altitude-ft 1500 --pitch-deg -3 --json" + kPolicy);
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const json document = json::parse(ran.out), policy = document.at("policy");
  EXPECT_NEAR(policy.at("signals").at("above_ground").get<double>(), 1500, 1e-9);
  EXPECT_NEAR(policy.at("signals").at("pitch").get<double>(), -3, 1e-9);
  EXPECT_TRUE(policy.at("signals").at("load").is_null());
  EXPECT_EQ(policy.at("unknown_asked"), json::array({"load"}));
  EXPECT_EQ(policy.at("levers").size(), 2u) << "no rule names another";
  EXPECT_NEAR(policy.at("levers").at("lod_scale").get<double>(), (0.5 * 4 + 0.25 * 2) / 0.75, 1e-9);
  EXPECT_EQ(policy.at("levers").at("render_scale"), 1.0);
  const json& rules = policy.at("rules");
  ASSERT_EQ(rules.size(), 2u) << "the third asks for the load, which nobody knows";
  EXPECT_EQ(rules[1].at("rule"), 2);
  EXPECT_NEAR(rules[1].at("firing").get<double>(), 0.25, 1e-9);
  EXPECT_NEAR(rules[1].at("shares").at("lod_scale").get<double>(), 1. / 3, 1e-9);
  EXPECT_EQ(rules[1].at("shares").at("render_scale"), 1.0);
  EXPECT_EQ(document.at("policy_rules")[1],
            "if altitude is not low then lod_scale = 2, render_scale = 1 with 0.5");
  EXPECT_THAT(decideBy("--altitude-ft 1500 --pitch-deg -3" + kPolicy).out,
              HasSubstr("  rule 2 fires 0.25 (LOD scale 33.3 %, Render scale 100 %): if altitude"));
  const json without = json::parse(decideBy("--altitude-ft 1500 --pitch-deg -3 --json").out);
  EXPECT_TRUE(without.at("policy").is_null());
  EXPECT_TRUE(without.at("policy_rules").empty());
}

TEST(DecideCommand, saysTheSameOfARowOfItsOwnTrace) {
  const test::ScratchDir dir;
  const Ran first = decideBy("--flight " + kFlight + " --csv" + kPolicy);
  ASSERT_EQ(first.exitCode, 0) << first.err;
  test::writeFile(dir / "trace.csv", first.out);
  const json flown = json::parse(decideBy("--flight " + kFlight + " --json" + kPolicy).out),
             again =
                 json::parse(decideBy("--flight " + (dir / "trace.csv").string() + " --json" + kPolicy).out);
  ASSERT_EQ(flown.at("decisions").size(), again.at("decisions").size());
  std::set<std::size_t> fired;
  for (std::size_t i = 0; i < flown.at("decisions").size(); ++i) {
    const json& policy = flown.at("decisions")[i].at("policy");
    ASSERT_EQ(policy, again.at("decisions")[i].at("policy")) << i;
    fired.insert(policy.at("rules").size());
  }
  EXPECT_EQ(again.at("as_recorded"), again.at("rows"));
  EXPECT_TRUE(fired.contains(1)) << "somewhere it flies";
}

TEST(DecideCommand, decidesAFlightRowByRow) {
  const Ran ran = decideBy("--flight " + kFlight + " --json");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  const json d = json::parse(ran.out);
  EXPECT_EQ(d.at("rows"), 6001);
  EXPECT_EQ(d.at("decisions").size(), 6001u);
  std::set<std::string> sizes;
  for (const json& row : d.at("decisions")) sizes.insert(row.at("depth_map_px").dump());
  EXPECT_EQ(sizes, (std::set<std::string>{"null", "[320,240]", "[400,300]", "[640,480]", "[800,600]"}));
}

TEST(DecideCommand, writesATraceThatDecidesAgainBitForBitAndFliesAgain) {
  const test::ScratchDir dir;
  const Ran first = decideBy("--flight " + kFlight + " --csv");
  ASSERT_EQ(first.exitCode, 0) << first.err;
  test::writeFile(dir / "trace.csv", first.out);
  const std::string trace = (dir / "trace.csv").string();
  EXPECT_EQ(decideBy("--flight " + trace + " --csv").out, first.out);
  EXPECT_THAT(decideBy("--flight " + trace).out,
              HasSubstr("6001 of 6001 decisions are as the trace recorded them"));
  EXPECT_THAT(decideBy("--flight " + trace + " --preset as-published").out, Not(HasSubstr("6001 of 6001")));

  const Result<Flight> original = readFlight(kFlight), again = readFlight(trace);
  ASSERT_TRUE(original.ok());
  ASSERT_TRUE(again.ok()) << toString(again.findings());
  EXPECT_EQ(again->states, original->states) << "to the bit";
}

TEST(DecideCommand, refusesBadInputWithStatusOne) {
  const test::ScratchDir dir;
  test::writeFile(dir / "bad.csv", "time_s,latitude_deg\n1,2\n");
  test::writeFile(dir / "bad-trace.csv", traceHeader() + "\n1,2,3\n");
  for (const std::string& arguments :
       {std::string("--altitude-ft nan --pitch-deg 0"), std::string("--altitude-ft 0 --pitch-deg inf"),
        std::string("--preset absent.json --altitude-ft 0 --pitch-deg 0"), std::string("--flight absent.csv"),
        "--flight " + (dir / "bad.csv").string(), "--flight " + (dir / "bad-trace.csv").string()}) {
    const Ran ran = decideBy(arguments);
    EXPECT_EQ(ran.exitCode, 1) << arguments;
    EXPECT_EQ(ran.out, "") << arguments;
    EXPECT_THAT(ran.err, HasSubstr("error: ")) << arguments;
  }
}

TEST(DecideCommand, takesAMapOfColumnsAndSaysWhereOneHelps) {
  const test::ScratchDir dir;
  const std::string flight = "--csv --flight " + (dir / "other.csv").string();
  test::writeFile(dir / "own.csv",
                  "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
                  "0,45,9,3280.5,2,0,90\n1,45,9.001,3281.5,2,0,90\n");
  test::writeFile(dir / "other.csv", "ms;N;E;Alt;P;B;H\n0;45;9;3270,5;2;0;90\n1000;45;9,001;3271,5;2;0;90\n");
  const Ran mapped = decideBy(flight +
                              " --columns 'time_ms=ms,latitude_deg=N,longitude_deg=#3,altitude_ft=Alt+10,"
                              "pitch_deg=P,roll_deg=B,heading_deg=H'");
  EXPECT_EQ(mapped.exitCode, 0) << mapped.err;
  EXPECT_EQ(mapped.out, decideBy("--csv --flight " + (dir / "own.csv").string()).out);
  const Ran refused = decideBy(flight);
  EXPECT_EQ(refused.exitCode, 1);
  EXPECT_THAT(refused.err, HasSubstr("--columns: expected a map of columns, as latitude_deg=Lat"));
  EXPECT_THAT(refused.err, HasSubstr("the columns \"ms\", \"N\""));
  EXPECT_THAT(decideBy(flight + " --columns latitude_deg").err,
              HasSubstr("columns: latitude_deg: expected QUANTITY=COLUMN"));
}

TEST(DecideCommand, refusesWhatNoAircraftDoesNamingTheRange) {
  const std::pair<std::string, std::string> refused[] = {
      {"--altitude-ft 0 --pitch-deg 400", "--pitch-deg: expected -90..90 deg, found 400"},
      {"--altitude-ft 0 --pitch-deg -90.001", "--pitch-deg: expected -90..90 deg, found -90.001"},
      {"--altitude-ft 1e9 --pitch-deg 0", "--altitude-ft: expected -66000..3300000 ft"},
      {"--altitude-ft 0 --pitch-deg 0 --roll-deg 361", "--roll-deg: expected -360..360 deg, found 361"},
      {"--altitude-ft 0 --pitch-deg 0 --heading-deg=-361", "--heading-deg: expected -360..360 deg"},
      {"--altitude-ft 0 --pitch-deg nan", "--pitch-deg: expected -90..90 deg, found nan"}};
  for (const auto& [arguments, message] : refused) {
    const Ran ran = decideBy(arguments);
    EXPECT_EQ(ran.exitCode, 1) << arguments;
    EXPECT_THAT(ran.err, HasSubstr("error: " + message));
  }
  EXPECT_EQ(decideBy("--altitude-ft 0 --pitch-deg 90 --roll-deg 360 --heading-deg 360").exitCode, 0);
}

TEST(DecideCommand, tellsWrongUsageWithStatusTwo) {
  for (const char* arguments :
       {"", "--altitude-ft 4000", "--pitch-deg 3", "--altitude-ft high --pitch-deg 3",
        "--altitude-ft 1 --pitch-deg 1 --json --csv", "--flight x.csv --altitude-ft 1 --pitch-deg 1"})
    EXPECT_EQ(decideBy(arguments).exitCode, 2) << arguments;
}

}  // namespace
}  // namespace trimtab
