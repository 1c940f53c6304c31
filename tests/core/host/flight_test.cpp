#include "trimtab/host/flight.h"

#include <cmath>
#include <limits>
#include <random>

#include "host_support.h"
#include "tests/support.h"
#include "trimtab/host/motion.h"

namespace trimtab::test {
namespace {

struct BadFlight {
  const char* file;
  const char* line;  ///< ":2" or empty
  const char* says;
};
constexpr BadFlight kBadFlights[] = {
    {"empty", ":0", "header"},
    {"only-comments", ":2", "header"},
    {"no-rows", "", "at least one row"},
    {"no-latitude-column", ":1", "latitude_deg"},
    {"column-twice", ":1", "pitch_deg: expected one column"},
    {"head-heading-alone", ":1", "head_pitch_deg"},
    {"cell-missing", ":3", "7 cells"},
    {"cell-too-many", ":3", "found 8"},
    {"latitude-beyond-pole", ":3", "latitude_deg: expected a number in -90..90, found 90.5"},
    {"longitude-beyond-date-line", ":3", "longitude_deg"},
    {"pitch-beyond-vertical", ":3", "pitch_deg"},
    {"altitude-not-a-number", ":3", "altitude_ft"},
    {"roll-infinite", ":3", "roll_deg"},
    {"heading-text", ":3", "found north"},
    {"heading-empty", ":3", "found nothing"},
    {"decimal-comma", ":3", "time_s"},
    {"time-goes-back", ":4", "time_s: expected not before the row above, at 0.2, found 0.1"},
    {"time-empty", ":3", "time_s"},
    {"visibility-negative", ":2", "visibility_m"},
    {"precipitation-unknown", ":2", "precipitation: expected none, rain or snow, found hail"},
    {"precipitation-without-severity", ":2", "precipitation_severity: expected a severity of 0..5"},
    {"severity-beyond-scale", ":2", "precipitation_severity: expected a number in 0..5, found 6"},
    {"severity-not-whole", ":2", "precipitation_severity: expected a whole number, found 2.5"},
    {"severity-without-precipitation", ":2", "precipitation: expected none, rain or snow beside a severity"},
    {"view-half-angle-too-wide", ":2", "view_left_deg"},
    {"packet-negative", ":2", "packet"},
    {"all-rows-before-ready", "", "at least one row"},
    {"cut-in-the-middle", ":3", "7 cells"},
    {"binary", "", "binary data"},
};

TEST(FlightCsv, withOneMistakeIsRefusedNamingIt) {
  std::size_t files = 0;
  const auto folder = sourceDir() / "tests/data/host/bad-flights";
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
  EXPECT_EQ(files, std::size(kBadFlights)) << "a bad file without a row here, or a row without its file";
  for (const BadFlight& bad : kBadFlights) {
    const auto file = folder / (std::string(bad.file) + ".csv");
    const auto flight = readFlight(file);
    ASSERT_FALSE(flight) << bad.file;
    EXPECT_TRUE(mentions(flight.findings(), file.string() + bad.line)) << toString(flight.findings());
    EXPECT_TRUE(mentions(flight.findings(), bad.says)) << toString(flight.findings());
  }
}

TEST(FlightCsv, listsEveryMistakeNotOnlyTheFirst) {
  const auto flight = parseFlightCsv(
      "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
      "0,91,200,x,1,2,3\n0,0,0,0,0,0\n",
      "f.csv");
  ASSERT_FALSE(flight);
  EXPECT_EQ(flight.findings().size(), 4U) << toString(flight.findings());
}

TEST(FlightCsv, thatIsNotThereOrAFolderIsAMessage) {
  ScratchDir dir;
  EXPECT_TRUE(mentions(readFlight(dir / "none.csv").findings(), "No such file"));
  EXPECT_TRUE(mentions(readFlight(dir.path()).findings(), "a folder"));
}

TEST(FlightCsv, readsBackBitForBit) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  Flight flight;
  for (int i = 0; i < 3000; ++i) {
    AircraftState s;
    s.time = i * 0.1 + uniform(0, 0.05);
    s.packet = static_cast<std::uint64_t>(i) * 3;
    s.position = {Degrees{uniform(-90, 90)}, Degrees{uniform(-180, 180)}, Metres{uniform(-300, 20000)}};
    s.attitude = {Degrees{uniform(0, 360)}, Degrees{uniform(-90, 90)}, Degrees{uniform(-180, 180)}};
    if (i % 2 == 0)
      s.head = Attitude{Degrees{uniform(-180, 180)}, Degrees{uniform(-90, 90)}, Degrees{uniform(-9, 9)}};
    if (i % 3 == 0) s.aboveGround = Metres{uniform(-10, 9000)};
    if (i % 5 == 0) s.visibility = Metres{uniform(0, 1e5)};
    if (i % 11 == 0) s.weather = HostWeather{};
    if (i % 11 == 1)
      s.weather =
          HostWeather{i % 2 ? Precipitation::rain : Precipitation::snow, i % 6, Metres{uniform(0, 1e4)}};
    if (i % 7 == 0)
      s.view = HostView{Metres{uniform(0.1, 9)}, Degrees{-1.0 / 3}, std::nullopt, Degrees{-20},
                        Degrees{uniform(1, 89)}};
    flight.states.push_back(s);
  }
  flight.states[5].attitude.roll = Degrees{-0.0};
  flight.states[6].attitude.roll = Degrees{5e-324};
  const auto again = parseFlightCsv(flightCsv(flight), "again.csv");
  ASSERT_TRUE(again) << toString(again.findings());
  EXPECT_EQ(again->states, flight.states);
}

TEST(FlightCsv, warnsWhereItsLastLineHasNoEnd) {
  const std::string whole =
      "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
      "0,36,128,4000,1,2,90.25\n0.1,36,128,4010,1,2,90.25\n";
  const auto noted = [](const Result<Flight>& flight) {
    for (const Finding& f : flight.findings())
      if (f.severity == Severity::warning && mentions({f}, "cut.csv:3: expected a line end")) return true;
    return false;
  };
  EXPECT_FALSE(noted(parseFlightCsv(whole, "cut.csv")));
  EXPECT_FALSE(noted(parseFlightCsv(whole + "# the end", "cut.csv")));
  for (const std::size_t cut : {1, 2, 4}) {  // 90.25, 90.2 and 90 are numbers, all
    const auto flight = parseFlightCsv(whole.substr(0, whole.size() - cut), "cut.csv");
    ASSERT_TRUE(flight) << toString(flight.findings());
    EXPECT_EQ(flight->states.size(), 2U);
    EXPECT_TRUE(noted(flight)) << toString(flight.findings());
  }
}

TEST(FlightCsv, readsFlightGearsNamesInAnyOrderAndOtherLineEnds) {
  const auto flight = parseFlightCsv(
      "\xef\xbb\xbf# a "
      "comment\r\nengine_rpm,\"heading-deg\",Altitude-ft,roll-deg,pitch-deg,longitude-deg,latitude-deg\r\n"
      "0,90,4000,1,2,128,36\r\n\r\n0,91,4010,1,2,128,36\r\n",
      "fg.csv", 0.5);
  ASSERT_TRUE(flight) << toString(flight.findings());
  ASSERT_EQ(flight->states.size(), 2U);
  EXPECT_EQ(flight->states[1].time, 0.5);
  EXPECT_EQ(flight->states[1].attitude.heading.value(), 91);
  EXPECT_NEAR(flight->states[0].position.height.in<Feet>(), 4000, 1e-9);
}

TEST(FlightCsv, takesExtraColumnsAndRowsOfOneTimeAsATraceHasThem) {
  const auto flight = parseFlightCsv(
      "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg,height_m,packet,reason,"
      "head_heading_deg,"
      "head_pitch_deg\n"
      "1,36,128,1,0,0,90,1500.25,77,\"held, by hysteresis\",5,-6\n1,36,128,1,0,0,90,1500.25,77,x,,\n",
      "trace.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  ASSERT_EQ(flight->states.size(), 2U);
  EXPECT_EQ(flight->states[0].position.height.value(), 1500.25) << "metres count before feet";
  EXPECT_EQ(flight->states[0].packet, 77U);
  EXPECT_EQ(flight->states[0].head->pitch.value(), -6);
  EXPECT_FALSE(flight->states[1].head);
  EXPECT_EQ(stateAt(*flight, 1).packet, 77U);
}

Flight twoStates(const GeodeticPosition& a, const GeodeticPosition& b) {
  Flight flight;
  flight.states.resize(2);
  flight.states[0].position = a;
  flight.states[1].position = b;
  flight.states[1].time = 2;
  return flight;
}

TEST(StateAt, goesTheShortWayRound) {
  Flight flight =
      twoStates({Degrees{10}, Degrees{179.99}, Metres{1000}}, {Degrees{10}, Degrees{-179.99}, Metres{1200}});
  flight.states[0].attitude = {Degrees{350}, Degrees{10}, Degrees{-170}};
  flight.states[1].attitude = {Degrees{20}, Degrees{20}, Degrees{170}};
  const AircraftState s = stateAt(flight, 1);
  EXPECT_NEAR(s.attitude.heading.value(), 5, 1e-9);
  EXPECT_NEAR(s.attitude.pitch.value(), 15, 1e-9);
  EXPECT_NEAR(std::abs(s.attitude.roll.value()), 180, 1e-9);
  EXPECT_NEAR(std::abs(s.position.longitude.value()), 180, 1e-6);
  EXPECT_NEAR(s.position.height.value(), 1100, 1e-9);
  EXPECT_EQ(s.time, 1);
}

TEST(StateAt, crossesThePoleStraight) {
  const Flight flight =
      twoStates({Degrees{89.999}, Degrees{0}, Metres{0}}, {Degrees{89.999}, Degrees{180}, Metres{0}});
  EXPECT_GT(stateAt(flight, 1).position.latitude.value(), 89.99999);
}

TEST(StateAt, isARowAtItsTimeAndTheEndsBeyond) {
  Flight flight = twoStates({Degrees{1.23456789}, Degrees{2}, Metres{3.3}},
                            {Degrees{1.2346}, Degrees{2.0001}, Metres{4}});
  EXPECT_EQ(stateAt(flight, 0), flight.states[0]);
  EXPECT_EQ(stateAt(flight, 2), flight.states[1]);
  EXPECT_EQ(stateAt(flight, -5), flight.states[0]);
  EXPECT_EQ(stateAt(flight, 1e9), flight.states[1]);
  EXPECT_EQ(stateAt(flight, std::numeric_limits<double>::quiet_NaN()).position, flight.states[1].position);
  EXPECT_EQ(stateAt(Flight{}, 1), AircraftState{});
}

TEST(StateAt, holdsTheStateBeforeAJump) {
  const Flight flight =
      twoStates({Degrees{36}, Degrees{128}, Metres{3000}}, {Degrees{37}, Degrees{128}, Metres{3000}});
  EXPECT_EQ(stateAt(flight, 1.9).position, flight.states[0].position);
  EXPECT_TRUE(breaksAfter(flight, 0));
  EXPECT_FALSE(breaksAfter(flight, 1));
}

TEST(StateAt, glidesThroughRowsThatAreFarApartThroughout) {
  Flight flight;
  for (int i = 0; i < 5; ++i) {
    AircraftState s;
    s.time = 10.0 * i;
    s.position = {Degrees{36 + 0.02 * i}, Degrees{128}, Metres{3000}};
    flight.states.push_back(s);
  }
  EXPECT_NEAR(stateAt(flight, 25).position.latitude.value(), 36.05, 1e-6);
}

}  // namespace
}  // namespace trimtab::test
