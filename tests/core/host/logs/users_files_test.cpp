#include <gtest/gtest.h>

#include <cmath>

#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"

/// Files that users met, which lie beside the checkout: each is read right, or refused with a sentence that
/// says what to do.
namespace trimtab {
namespace {

using test::sharedDir;

TEST(UsersHeadLogs, areReadRightOrRefused) {
  TRIMTAB_NEEDS_SHARED("cases/hosts/headlogs");
  std::size_t read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(sharedDir() / "cases/hosts/headlogs")) {
    const std::string name = entry.path().filename().string();
    const Result<HeadLog> log = readHeadLog(entry.path());
    if (!log) {
      EXPECT_GT(toString(log.findings()).size(), 80U) << name;
      continue;
    }
    // opentrack's own steps of time contradict the motion that its case says.
    if (name == "opentrack.csv") continue;
    ++read;
    const bool other = name == "semicolon_dot.csv" || name == "tabs.csv";
    for (const HeadSample& s : log->samples) {
      const double yaw = (other ? 30 : 40) * std::sin(2 * s.timeS),
                   pitch = other ? 5 * std::sin(s.timeS) : 8 * std::sin(3 * s.timeS);
      ASSERT_NEAR(s.headingDeg, yaw, 0.1) << name;
      ASSERT_NEAR(s.pitchDeg, pitch, 0.1) << name;
    }
    EXPECT_GE(log->durationS(), 3.18) << name;
  }
  EXPECT_GE(read, 17U);
}

TEST(UsersFlights, areReadRightOrRefused) {
  TRIMTAB_NEEDS_SHARED("cases/hosts/flightlogs");
  std::size_t same = 0;
  for (const char* name : {"good", "Time_col", "cr_only", "epoch_ms_time_s", "excel_de", "hms", "jsbsim",
                           "lon360", "metres", "midnight", "nan", "pandas_index", "plotjuggler", "tabs",
                           "time_col", "timestamp_col", "trailing_commas", "utf16"}) {
    const Result<Flight> flight =
        readFlight(sharedDir() / "cases/hosts/flightlogs" / (std::string(name) + ".csv"));
    ASSERT_TRUE(flight) << name << toString(flight.findings());
    ASSERT_EQ(flight->states.size(), 2U) << name;
    const AircraftState &a = flight->states[0], &b = flight->states[1];
    EXPECT_NEAR(a.position.latitude.value(), 47.4, 1e-9) << name;
    EXPECT_NEAR(b.position.latitude.value(), 47.4001, 1e-9) << name;
    EXPECT_NEAR(a.position.height.in<Feet>(), 3000, 2) << name;
    EXPECT_EQ(a.attitude, (Attitude{Degrees{90}, Degrees{1.5}, Degrees{0}})) << name;
    const double step = std::string(name) == "Time_col" ? 0.0166 : std::string(name) == "nan" ? 0.2 : 0.1;
    EXPECT_NEAR(b.time - a.time, step, 1e-6) << name;
    ++same;
  }
  EXPECT_EQ(same, 18U);
}

TEST(UsersFlights, ofOtherProgramsAreReadOrRefusedWithWhatToDo) {
  TRIMTAB_NEEDS_SHARED("cases/hosts/flightlogs");
  for (const auto& [name, says] :
       {std::pair{"xplane_data.txt", "an X-Plane Data.txt"},
        {"g1000.csv", "a Garmin G1000's log"},
        {"fr24.csv", "a Flightradar24 track"},
        {"t.igc", "fixes of an IGC log: 2"},
        {"t.gpx", "points of a GPX track: 1"},
        {"flytrex.csv", "derived from the track"},
        {"noattitude.csv", "derived from the track"},
        {"metres_agl_sim_trace.csv", ""},
        {"iso.csv", "altitude_ft=altitude or altitude_m=altitude"},
        {"fg_generic_headerless.csv", "a map names by number, as latitude_deg=#1"}}) {
    const Result<Flight> flight = readFlight(sharedDir() / "cases/hosts/flightlogs" / name);
    const std::string file = name;
    EXPECT_EQ(flight.ok(), file != "iso.csv" && file != "fg_generic_headerless.csv")
        << toString(flight.findings());
    EXPECT_NE(toString(flight.findings()).find(says), std::string::npos)
        << name << toString(flight.findings());
  }
}

}  // namespace
}  // namespace trimtab
