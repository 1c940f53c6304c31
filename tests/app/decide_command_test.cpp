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
