#include <gtest/gtest.h>

#include <cmath>

#include "trimtab/host/flight.h"
#include "trimtab/host/log_look.h"

namespace trimtab {
namespace {

struct FlightCase {
  const char* name;
  const char* text;
  const char* says;  ///< a part of its findings
  const char* columns = "";
};

Result<Flight> parsed(const FlightCase& c) {
  const auto columns = parseColumnMap(c.columns);
  EXPECT_TRUE(columns) << c.columns;
  return parseFlightCsv(c.text, "f.csv", 0.1, *columns);
}

bool tells(const Findings& findings, const char* part) {
  return toString(findings).find(part) != std::string::npos;
}

/// The same two rows, 0.2 s apart, as others write them.
constexpr FlightCase kSameFlight[] = {
    {"our own",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "0,52.3,4.75,1200,-2.5,4,271\n0.2,52.3002,4.75,1202,-2.5,4,271\n",
     ""},
    {"time without a unit",
     "Time,lat,lon,alt_ft,pitch_deg,roll_deg,heading_deg\n"
     "0,52.3,4.75,1200,-2.5,4,271\n0.2,52.3002,4.75,1202,-2.5,4,271\n",
     "times name no unit: read as seconds"},
    {"milliseconds",
     "time (millisecond),latitude,longitude,altitude(feet),pitch,roll,heading\n"
     "0,52.3,4.75,1200,-2.5,4,271\n200,52.3002,4.75,1202,-2.5,4,271\n",
     "read as degrees"},
    {"dates in milliseconds",
     "timestamp,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "1600000000500,52.3,4.75,1200,-2.5,4,271\n1600000000700,52.3002,4.75,1202,-2.5,4,271\n",
     "milliseconds since 1970"},
    {"dates in a column of seconds",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "1600000000500,52.3,4.75,1200,-2.5,4,271\n"
     "1600000000700,52.3002,4.75,1202,-2.5,4,271\n",
     "a date in milliseconds"},
    {"ISO 8601",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "2021-12-31T23:59:59.9+01:00,52.3,4.75,1200,-2.5,4,271\n"
     "2022-01-01 00:00:00.1+0100,52.3002,4.75,1202,-2.5,4,271\n",
     "a clock"},
    {"a clock over midnight",
     "time;latitude_deg;longitude_deg;altitude_ft;pitch_deg;roll_deg;heading_deg\n"
     "23:59:59,9;52,3;4,75;1200;-2,5;4;271\n00:00:00,1;52,3002;4,75;1202;-2,5;4;271\n",
     "after midnight"},
    {"longitudes to 360",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "0,52.3,4.75,1200,-2.5,4,271\n0.2,52.3002,4.75,1202,-2.5,4,271\n",
     ""},
    {"metres",
     "time_s,latitude_deg,longitude_deg,altitude_m,pitch_deg,roll_deg,heading_deg\n"
     "0,52.3,4.75,365.76,-2.5,4,271\n0.2,52.3002,4.75,366.3696,-2.5,4,271\n",
     ""},
    {"radians",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_rad,roll_rad,heading_rad\n"
     "0,52.3,4.75,1200,-0.043633231,0.06981317,4.729842\n"
     "0.2,52.3002,4.75,1202,-0.043633231,0.06981317,4.729842\n",
     ""},
    {"paths",
     "__time,/pose/latitude_deg,/pose/longitude_deg,/pose/altitude_ft,/pose/pitch_deg,/pose/roll_deg,"
     "/pose/heading_deg\n0,52.3,4.75,1200,-2.5,4,271\n0.2,52.3002,4.75,1202,-2.5,4,271\n",
     ""},
    {"rows without a position",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "-0.1,nan,,,0,0,0\n0,52.3,4.75,1200,-2.5,4,271\n0.2,52.3002,4.75,1202,-2.5,4,271\n",
     "1 row without one"},
    {"a map", "clock,N,E,Alt,P,B,H\n0,52.3,4.75,365.76,-2.5,4,271\n200,52.3002,4.75,366.3696,-2.5,4,271\n",
     "",
     "time_ms=clock,latitude_deg=N,longitude_deg=#3,altitude_ft=Alt*3.280839895,pitch_deg=P*1,roll_deg=\"B\","
     "heading_deg=H+0"},
};

void expectTheFlight(const FlightCase& c) {
  const Result<Flight> flight = parsed(c);
  ASSERT_TRUE(flight) << c.name << ": " << toString(flight.findings());
  EXPECT_TRUE(tells(flight.findings(), c.says)) << c.name << ": " << toString(flight.findings());
  ASSERT_EQ(flight->states.size(), 2U) << c.name;
  const AircraftState &a = flight->states[0], &b = flight->states[1];
  EXPECT_NEAR(b.time - a.time, 0.2, 1e-6) << c.name;
  EXPECT_NEAR(a.position.latitude.value(), 52.3, 1e-9) << c.name;
  EXPECT_NEAR(b.position.latitude.value(), 52.3002, 1e-9) << c.name;
  EXPECT_NEAR(a.position.longitude.value(), 4.75, 1e-9) << c.name;
  EXPECT_NEAR(b.position.height.in<Feet>(), 1202, 1e-5) << c.name;
  EXPECT_NEAR(b.attitude.pitch.value(), -2.5, 1e-5) << c.name;
  EXPECT_NEAR(b.attitude.roll.value(), 4, 1e-5) << c.name;
  EXPECT_NEAR(b.attitude.heading.value(), 271, 1e-4) << c.name;
}

TEST(FlightFiles, readOneFlightHoweverItIsWritten) {
  for (const FlightCase& c : kSameFlight) expectTheFlight(c);
}

/// The same flight as programs write it, told by the names of their columns.
constexpr FlightCase kProfiles[] = {
    {"X-Plane",
     "\n   _real,_time |   _totl,_time |   pitch,__deg |   _roll,__deg |   hding,_true |   hding,__mag |   "
     "__lat,__deg |"
     "   __lon,__deg |   __alt,ftmsl |   __alt,ftagl |\n"
     "  7.5 | 20.0 | -2.5 | 4.0 | 271.0 | 269.0 | 52.3 | 4.75 | 1200.0 | 1150.0 |\n"
     "  7.7 | 20.2 | -2.5 | 4.0 | 271.0 | 269.0 | 52.3002 | 4.75 | 1202.0 | 1152.0 |\n",
     "the columns of an X-Plane Data.txt"},
    {"G1000",
     "#airframe_info, log_version=\"1.00\"\n#yyy-mm-dd, hh:mm:ss, hh:mm, degrees, degrees, ft msl, deg, deg, "
     "deg\n"
     "  Lcl Date, Lcl Time, UTCOfst,   Latitude,  Longitude, AltMSL, Pitch, Roll, HDG\n"
     "2023-05-06, 09:59:59,  +02:00,           ,           ,       ,      ,     ,\n"
     "2023-05-06, 10:00:00,  +02:00, 52.3000000,  4.7500000, 1200.0, -2.50, 4.00, 271.0\n"
     "2023-05-06, 10:00:00.2,  +02:00, 52.3002000,  4.7500000, 1202.0, -2.50, 4.00, 271.0\n",
     "HDG is the magnetic heading"},
    {"JSBSim",
     "Time,V_{Total} (ft/s),Altitude ASL (ft),Altitude AGL (ft),Phi (deg),Theta (deg),Psi (deg),Latitude "
     "(deg),"
     "Longitude (deg)\n0.5,170,1200,1150,4,-2.5,271,52.3,4.75\n0.7,170,1202,1152,4,-2.5,271,52.3002,4.75\n",
     "the columns of a JSBSim output"},
    {"PlotJuggler",
     "__time,/a/latitude_deg,/a/longitude_deg,/a/altitude_ft,/a/pitch_deg,/a/roll_deg,/a/heading_deg\n"
     "1600000000.5,52.3,4.75,1200,-2.5,4,271\n1600000000.7,52.3002,4.75,1202,-2.5,4,271\n",
     "PlotJuggler"},
};

TEST(FlightFiles, ofKnownProgramsNeedNoMap) {
  for (const FlightCase& c : kProfiles) expectTheFlight(c);
  const auto xplane = parsed(kProfiles[0]);
  EXPECT_NEAR(xplane->states[0].aboveGround->in<Feet>(), 1150, 1e-6);
  FlightCase other = kProfiles[0];
  other.columns = "time_s=\"_real,_time\",heading_deg=\"hding,__mag\"";
  EXPECT_EQ(parsed(other)->states[0].time, 7.5) << "a map counts before a profile";
  EXPECT_EQ(parsed(other)->states[0].attitude.heading.value(), 269);
}

TEST(FlightFiles, ofFlightradar24HaveThePlaceInOneCell) {
  const auto flight = parseFlightCsv(
      "Timestamp,UTC,Callsign,Position,Altitude,Speed,Direction\n1600000000,2020-09-13T12:26:40Z,X,\"50.5,6."
      "25\",2000,90,45\n"
      "1600000060,2020-09-13T12:27:40Z,X,\"50.51,6.26\",2100,90,46\n",
      "fr.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_EQ(flight->states[1].position.latitude.value(), 50.51);
  EXPECT_EQ(flight->states[1].position.longitude.value(), 6.26);
  EXPECT_EQ(flight->durationS(), 60);
  EXPECT_EQ(flight->states[0].attitude.heading.value(), 45);
  EXPECT_GT(flight->states[0].attitude.pitch.value(), 0);
}

TEST(FlightFiles, ofTracksGetTheirAttitudeFromTheTrack) {
  const auto gpx = parseFlightCsv(
      "<?xml version='1.0'?>\n<gpx creator='t'><trk><trkseg>\n"
      "<trkpt lat=\"46.5\" lon=\"7.25\"><ele>1500</ele><time>2022-02-03T04:05:06Z</time></trkpt>\n"
      "<trkpt lon='7.25' lat='46.501'><time>2022-02-03T04:05:08Z</time><ele>1520.5</ele></trkpt>\n"
      "<trkpt lat=\"46.502\" lon=\"7.25\"><ele>1530</ele></trkpt></trkseg></trk></gpx>\n",
      "t.gpx");
  ASSERT_TRUE(gpx) << toString(gpx.findings());
  ASSERT_EQ(gpx->states.size(), 2U);
  EXPECT_TRUE(tells(gpx.findings(), "1 that lack one of them"));
  EXPECT_EQ(gpx->states[1].time, 2);
  EXPECT_EQ(gpx->states[1].position.height.value(), 1520.5);
  EXPECT_NEAR(gpx->states[0].attitude.heading.value(), 0, 0.1);
  EXPECT_NEAR(gpx->states[0].attitude.pitch.value(), 10.4, 0.1);

  const auto igc = parseFlightCsv(
      "AXYZ123\r\nHFDTE030222\r\nB2359584630000N00715000EA0140001500\r\n"
      "B0000024630060N00715000EV0141000000\r\nGABCDEF\r\n",
      "t.igc");
  ASSERT_TRUE(igc) << toString(igc.findings());
  ASSERT_EQ(igc->states.size(), 2U);
  EXPECT_EQ(igc->states[1].time, 4) << "after midnight";
  EXPECT_NEAR(igc->states[1].position.latitude.value(), 46.501, 1e-9);
  EXPECT_EQ(igc->states[0].position.height.value(), 1500);
  EXPECT_EQ(igc->states[1].position.height.value(), 1410) << "no GNSS height in this fix";
  EXPECT_TRUE(tells(parseFlightCsv("<gpx><trkpt lat=\"1\" lon=\"2\"></trkpt></gpx>", "t.gpx").findings(),
                    "all of which lack"));
}

constexpr FlightCase kRefusedFlights[] = {
    {"altitude of no unit",
     "time_s,latitude_deg,longitude_deg,Altitude,pitch_deg,roll_deg,heading_deg\n"
     "0,52.3,4.75,1200,-2.5,4,271\n",
     "altitude_ft=Altitude or altitude_m=Altitude"},
    {"no header", "0,52.3,4.75,1200,-2.5,4,271\n1,52.3,4.75,1200,-2.5,4,271\n", "no header over 7 columns"},
    {"a head log", "time_s,yaw_deg,pitch_deg\n0,1,2\n", "seems to be a head log"},
    {"a roll alone", "time_s,latitude_deg,longitude_deg,altitude_ft,roll_deg\n0,52.3,4.75,1200,4\n",
     "pitch_deg: expected a column of this name"},
    {"two readings of steps",
     "time,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "0,52.3,4.75,1200,-2.5,4,271\n10,52.3,4.75,1200,-2.5,4,271\n20,52.3,4.75,1200,-2.5,4,271\n"
     "30,52.3,4.75,1200,-2.5,4,271\n40,52.3,4.75,1200,-2.5,4,271\n50,52.3,4.75,1200,-2.5,4,271\n",
     "may be seconds or milliseconds: name the unit"},
    {"angles of no unit",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch,roll,heading\n"
     "0,52.3,4.75,1200,0.1,0.2,1.5\n0.2,52.3,4.75,1202,0.1,0.2,1.5\n",
     "may be degrees or radians: name the unit"},
    {"longitudes of both kinds",
     "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
     "0,52.3,-4.75,1200,-2.5,4,271\n0.2,52.3,184.75,1202,-2.5,4,271\n",
     "f.csv:3: longitude_deg: expected a number in -180..180, found 184.75"},
    {"a clock of two parts",
     "time,latitude_deg,longitude_deg,altitude_ft\n00:01,52.3,4.75,1200\n00:02,52.3,4.76,1200\n",
     "time_s: expected a number, a date with a time or hh:mm:ss, found 00:01"},
    {"a map of what is not there", "time_s,latitude_deg,longitude_deg,altitude_ft\n0,52.3,4.75,1200\n",
     "pitch_deg: expected one column named \"Theta\"", "pitch_deg=Theta"},
    {"a map of a quantity that no flight has",
     "time_s,latitude_deg,longitude_deg,altitude_ft\n0,52.3,4.75,1200\n", "pich_deg: expected one of time_s",
     "pich_deg=time_s"},
};

TEST(FlightFiles, areRefusedWithASentenceThatSaysWhatToDo) {
  for (const FlightCase& c : kRefusedFlights) {
    const Result<Flight> flight = parsed(c);
    EXPECT_FALSE(flight) << c.name;
    EXPECT_TRUE(tells(flight.findings(), c.says)) << c.name << ": " << toString(flight.findings());
  }
}

TEST(FlightFiles, ofWhoseTimesNoUnitFitsAreWarnedOf) {
  std::string text = "time,latitude_deg,longitude_deg,altitude_ft\n";
  for (int minutes = 0; minutes < 8; ++minutes)
    text += std::to_string(minutes / 60.0) + ",52.3," + std::to_string(4.75 + minutes * 0.05) + ",1200\n";
  const auto flight = parseFlightCsv(text, "hours.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_TRUE(tells(flight.findings(), "map the column, as time_s=time*60")) << toString(flight.findings());
}

TEST(FlightFiles, takeLongitudesTo360AsWest) {
  const auto flight = parseFlightCsv(
      "time_s,latitude_deg,longitude_deg,altitude_ft\n0,52.3,355.25,1200\n1,52.3,355.26,1200\n", "f.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_EQ(flight->states[0].position.longitude.value(), -4.75);
  EXPECT_TRUE(tells(flight.findings(), "read as west"));
}

/// A heading of no unit that follows the track shows its unit, even where no angle leaves a turn of radians.
TEST(FlightFiles, findTheUnitOfAHeadingByTheTrack) {
  const std::string header = "time_s,latitude_deg,longitude_deg,altitude_ft,pitch,roll,heading\n";
  const auto east =
      parseFlightCsv(header + "0,10,20,1000,0.1,0,1.57\n1,10,20.001,1000,0.1,0,1.57\n", "f.csv");
  ASSERT_TRUE(east) << toString(east.findings());
  EXPECT_NEAR(east->states[0].attitude.heading.value(), 89.95, 0.01);
  EXPECT_NEAR(east->states[0].attitude.pitch.value(), 5.73, 0.01);
  const auto north = parseFlightCsv(header + "0,10,20,1000,0.1,0,3\n1,10.001,20,1000,0.1,0,3\n", "f.csv");
  ASSERT_TRUE(north) << toString(north.findings());
  EXPECT_EQ(north->states[0].attitude.heading.value(), 3);
}

TEST(FlightFiles, deriveAnAttitudeFromTheTrack) {
  // A level turn to the right of 3 degrees a second at 100 m/s, then nothing.
  std::string text = "time_s,latitude_deg,longitude_deg,altitude_m\n";
  double east = 0, north = 0;
  for (int i = 0; i <= 300; ++i) {
    const double t = i * 0.1, heading = (90 + 3 * t) * M_PI / 180;
    text += std::to_string(t) + ',' + std::to_string(46 + north / 111150) + ',' +
            std::to_string(7 + east / (111320 * std::cos(46 * M_PI / 180))) + ',' +
            std::to_string(1500 + t * 10) + '\n';
    east += 10 * std::sin(heading);
    north += 10 * std::cos(heading);
  }
  const auto flight = parseFlightCsv(text, "f.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_TRUE(tells(flight.findings(), "heading, pitch and roll are derived from the track"));
  const Attitude attitude = flight->states[150].attitude;
  EXPECT_NEAR(attitude.heading.value(), 135, 2);
  EXPECT_NEAR(attitude.pitch.value(), 5.7, 0.3);
  EXPECT_NEAR(attitude.roll.value(), 28, 3);
}

TEST(FlightFiles, areReadByEachMapThatTheirRefusalOffers) {
  const std::string places = "0,52.3,4.75,1200,";
  std::string steps = "t,latitude_deg,longitude_deg,altitude_ft\n";
  for (int row = 0; row < 9; ++row) steps += std::to_string(20 * row) + ",52.3,4.75,1200\n";
  for (const std::string& text :
       {"time_s,latitude_deg,longitude_deg,altitude_ft,Theta,Bank,Psi\n" + places + "0.1,0.2,1.4\n",
        std::string("time_s,latitude_deg,longitude_deg,\"Altitude, MSL\"\n0,52.3,4.75,1200\n"), steps}) {
    const auto refused = parseFlightCsv(text, "f.csv");
    ASSERT_FALSE(refused) << text;
    const auto readings = readingsThatFit(refused.findings());
    ASSERT_EQ(readings.size(), 1U) << toString(refused.findings());
    EXPECT_EQ(readings[0].size(), 2U) << toString(refused.findings());
    for (const ColumnMap& map : readings[0]) {
      const auto flight = parseFlightCsv(text, "f.csv", 0.1, map);
      EXPECT_TRUE(flight) << columnMapText(map) << ": " << toString(flight.findings());
    }
  }
}

TEST(FlightFiles, takeTheAltitudeOfTheMapBeforeOneThatIsFound) {
  const std::string text = "time_s,latitude_deg,longitude_deg,height_m,Alt,alt_3\n0,52.3,4.75,900,1000,7\n";
  const auto height = [&text](const char* map) {
    const auto flight = parseFlightCsv(text, "f.csv", 0.1, *parseColumnMap(map));
    EXPECT_TRUE(flight) << toString(flight.findings());
    return flight ? flight->states[0].position.height.in<Feet>() : 0;
  };
  EXPECT_NEAR(height("altitude_ft=Alt"), 1000, 1e-6);
  EXPECT_NEAR(height("altitude_ft=Alt*3"), 3000, 1e-6) << "alt_3 is another column";
}

TEST(ColumnMap, namesEveryPartThatIsNoAssignment) {
  const auto map =
      parseColumnMap("latitude_deg=Lat, altitude_ft = Alt*3.28084+10 ,\"x\",a=,pitch_deg=P,pitch_deg=Q");
  ASSERT_FALSE(map);
  EXPECT_EQ(map.findings().size(), 3U) << toString(map.findings());
  const auto good =
      parseColumnMap("altitude_ft=Alt*3.28084+10,time_s=\"a, b\"*0.001,roll_deg=bank-angle,yaw_deg=y-5");
  ASSERT_TRUE(good) << toString(good.findings());
  EXPECT_EQ(good->at("altitude_ft").column, "Alt");
  EXPECT_EQ(good->at("altitude_ft").scale, 3.28084);
  EXPECT_EQ(good->at("altitude_ft").offset, 10);
  EXPECT_EQ(good->at("time_s").column, "a, b");
  EXPECT_EQ(good->at("roll_deg").column, "bank-angle");
  EXPECT_EQ(good->at("yaw_deg").offset, -5);
  EXPECT_TRUE(parseColumnMap("")->empty());
}

}  // namespace
}  // namespace trimtab
