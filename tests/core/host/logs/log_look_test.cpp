#include "trimtab/host/log_look.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"

namespace trimtab {
namespace {

class LogLook : public ::testing::Test {
 protected:
  Result<LogBeginning> look(const std::string& text, LogKind kind, std::size_t most = kLogBeginning) {
    test::writeFile(dir_ / "log.csv", text);
    return beginningOfLog(dir_ / "log.csv", kind, most);
  }
  const test::ScratchDir dir_;
};

TEST_F(LogLook, saysWhatTheNamesOfColumnsTell) {
  const auto flight = look(
      "# a comment\nclock_ms;Lat;Lon;Alt (m);Theta;Bank_rad;\"Psi\"\n"
      "5;51,25;3,5;100;1;0,2;30\n10;51,26;3,5;101;1;0,2;31\n",
      LogKind::flight);
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_EQ(columnMapText(flight->found),
            "altitude_m=\"Alt (m)\",heading=Psi,latitude_deg=Lat,longitude_deg=Lon,pitch=Theta,"
            "roll_rad=Bank_rad");
  EXPECT_EQ(flight->header.size(), 7U);
  ASSERT_EQ(flight->rows.size(), 2U);
  EXPECT_EQ(flight->rows[1][1], "51,26");
  EXPECT_TRUE(flight->hasHeader && flight->whole);

  const auto head = look("dt,rawYaw,rawPitch,rawRoll\n0.01,5,6,7\n0.01,5,6,8\n", LogKind::head);
  ASSERT_TRUE(head) << toString(head.findings());
  EXPECT_EQ(columnMapText(head->found),
            "head_heading_deg=rawYaw,head_pitch_deg=rawPitch,head_roll_deg=rawRoll,time_step_s=dt");
  const auto cell = look("Timestamp,UTC,Callsign,Position,Altitude,Direction\n1600000000,x,Y,\"5,6\",7,8\n",
                         LogKind::flight);
  ASSERT_TRUE(cell) << toString(cell.findings());
  EXPECT_EQ(cell->found.at("longitude_deg").column, "Position[2]");
}

/// The columns that the reader finds by itself, written as a map, give the same reading.
TEST_F(LogLook, findsWhatTheReaderFinds) {
  const std::string text =
      "Time,Latitude,Longitude,altitude_msl_ft,roll,heading_true,pitch\n"
      "1,10,20,3000,2,271,1\n1.5,10.0001,20,3010,3,272,-1\n";
  const auto begin = look(text, LogKind::flight);
  ASSERT_TRUE(begin);
  const auto plain = parseFlightCsv(text, "f.csv"),
             mapped = parseFlightCsv(text, "f.csv", 0.1, *parseColumnMap(columnMapText(begin->found)));
  ASSERT_TRUE(plain && mapped) << toString(mapped.findings());
  EXPECT_EQ(flightCsv(*plain), flightCsv(*mapped));
}

TEST_F(LogLook, takesWholeRowsOfALongLog) {
  std::string text = "time_s,yaw_deg,pitch_deg\n";
  for (int i = 0; i < 400; ++i) text += std::to_string(i * 0.25) + ",12.5,-3.5\n";
  const auto begin = look(text, LogKind::head, 1000);
  ASSERT_TRUE(begin) << toString(begin.findings());
  EXPECT_FALSE(begin->whole);
  EXPECT_TRUE(begin->text.ends_with(",12.5,-3.5\n"));
  EXPECT_LE(begin->text.size(), 1000U);
  EXPECT_GT(begin->text.size(), 970U);
  EXPECT_EQ(begin->rows.size(), 8U) << "a few rows show what they are";

  // Each row holds two characters, U+0A15 and U+0100, between which the bytes of a line end stand.
  std::string wide = "\xff\xfe";
  for (const char c : text) {
    if (c == '\n') wide += std::string(",\0\x15\x0a\0\x01", 6);
    wide += std::string{c, '\0'};
  }
  for (std::size_t most = 1000; most < 1060; ++most) {
    const auto utf16 = look(wide, LogKind::head, most);
    ASSERT_TRUE(utf16) << toString(utf16.findings());
    EXPECT_EQ(utf16->text.size() % 2, 0U) << most;
    EXPECT_TRUE(utf16->text.ends_with(std::string_view("\x01\n\0", 3))) << most;
  }
}

TEST_F(LogLook, namesColumnsByNumberWhereNamesDoNot) {
  const auto begin = look("1,2,3\n4,5,6\n7,8,9\n", LogKind::head);
  ASSERT_TRUE(begin) << toString(begin.findings());
  EXPECT_FALSE(begin->hasHeader);
  const std::vector<std::string> header{"Alt", "Alt", "", "say \"up\"", "a, b", " Lat "};
  std::string names;
  for (std::size_t i = 0; i < header.size(); ++i) names += sourceOf(header, i).written + ' ';
  EXPECT_EQ(names, "#1 #2 #3 #4 \"a, b\" Lat ");
  EXPECT_EQ(sourceOf(header, 5, 2, -1.5).written, "Lat*2-1.5");
}

TEST_F(LogLook, refusesWhatHasNoColumns) {
  const auto track = look(
      "<gpx><trk><trkseg><trkpt lat='1' lon='2'><ele>3</ele><time>2022-02-03T04:05:06Z</time></trkpt>"
      "</trkseg></trk></gpx>",
      LogKind::flight);
  EXPECT_NE(toString(track.findings()).find("a track"), std::string::npos) << toString(track.findings());
  EXPECT_FALSE(look("", LogKind::flight));
  EXPECT_FALSE(beginningOfLog(dir_ / "none.csv", LogKind::flight));
  EXPECT_FALSE(beginningOfLog(dir_.path(), LogKind::flight));
}

TEST(ColumnMap, isReadBackAsItIsWritten) {
  const std::string text =
      "altitude_ft=\"Alt, MSL\"*3.28084-12.5,head_qw=#4,latitude_deg=lat*0.0000001,pitch_deg=P,"
      "roll_deg=\"bank or roll\"*-1+0.5";
  const auto map = parseColumnMap(text);
  ASSERT_TRUE(map) << toString(map.findings());
  const auto again = parseColumnMap(columnMapText(*map));
  ASSERT_TRUE(again) << columnMapText(*map);
  for (const auto& [key, source] : *map) {
    const ColumnSource& other = again->at(key);
    EXPECT_EQ(other.column, source.column) << key;
    EXPECT_EQ(other.scale, source.scale) << key;
    EXPECT_EQ(other.offset, source.offset) << key;
  }
}

/// Returns the texts of the maps, one list for each ambiguity.
std::vector<std::vector<std::string>> offered(const Findings& findings) {
  std::vector<std::vector<std::string>> texts;
  for (const auto& maps : readingsThatFit(findings)) {
    texts.emplace_back();
    for (const ColumnMap& map : maps) texts.back().push_back(columnMapText(map));
  }
  return texts;
}

TEST(ReadingsThatFit, areTheMapsThatARefusalNames) {
  const auto angles = parseFlightCsv(
      "time_s,latitude_deg,longitude_deg,altitude_ft,\"Theta or Pitch\",Bank,Psi\n0,51,3,900,0.2,0.1,1.2\n"
      "1,51,3,900,0.2,0.1,1.2\n",
      "f.csv", 0.1, *parseColumnMap("pitch=\"Theta or Pitch\""));
  using Texts = std::vector<std::vector<std::string>>;
  EXPECT_EQ(offered(angles.findings()),
            (Texts{{"heading_deg=Psi,pitch_deg=\"Theta or Pitch\",roll_deg=Bank",
                    "heading_rad=Psi,pitch_rad=\"Theta or Pitch\",roll_rad=Bank"}}));
  const auto altitude =
      parseFlightCsv("time_s,latitude_deg,longitude_deg,Alt\n0,51,3,900\n1,51,3,900\n", "f.csv");
  EXPECT_EQ(offered(altitude.findings()), (Texts{{"altitude_ft=Alt", "altitude_m=Alt"}}));
  std::string shares = "time_s,yaw,pitch\n";
  for (int i = 0; i < 9; ++i) shares += std::to_string(i) + ",0.25,0.5\n";
  const auto head = parseHeadLog(shares, "h.csv");
  EXPECT_EQ(offered(head.findings()),
            (Texts{{"head_heading_deg=yaw,head_pitch_deg=pitch", "head_heading_rad=yaw,head_pitch_rad=pitch",
                    "head_heading_deg=yaw*360-180,head_pitch_deg=pitch*180-90"}}));
  EXPECT_TRUE(readingsThatFit(parseFlightCsv("a,b\n1,2\n", "f.csv").findings()).empty());
}

/// A dialog can only show what its lines hold.
TEST(ReadingsThatFit, nameQuantitiesThatAPersonIsShown) {
  const auto keysOf = [](LogKind kind) {
    std::set<std::string> keys;
    for (const LogQuantity& quantity : logQuantities(kind))
      for (const LogKey& key : quantity.keys) EXPECT_TRUE(keys.insert(key.key).second) << key.key;
    return keys;
  };
  const auto flightKeys = keysOf(LogKind::flight), headKeys = keysOf(LogKind::head);
  for (const char* key : {"time_s", "time_ns", "altitude_m", "roll_rad", "head_roll_deg"})
    EXPECT_TRUE(flightKeys.contains(key)) << key;
  for (const char* key : {"time_ms", "head_heading_rad", "head_pitch_deg", "head_qz", "time_step_s"})
    EXPECT_TRUE(headKeys.contains(key)) << key;
  // Each is a quantity that its reader knows: it is not refused as one that no log has.
  const auto unknown = [](const auto& read) {
    return toString(read.findings()).find("a quantity that no") != std::string::npos;
  };
  const ColumnSource source{"a", 1, 0, "a"};
  for (const std::string& key : flightKeys) {
    if (key.empty()) continue;
    EXPECT_FALSE(unknown(parseFlightCsv("a,b\n1,2\n", "f.csv", 0.1, {{key, source}}))) << key;
  }
  for (const std::string& key : headKeys)
    EXPECT_FALSE(unknown(parseHeadLog("a,b\n1,2\n", "h.csv", BadRows::refuse, {{key, source}}))) << key;
}

TEST(LogQuantities, beginWithTheUnitOfTheColumnsName) {
  const auto unitFor = [](LogKind kind, std::size_t quantity, const char* column) {
    const LogQuantity& row = logQuantities(kind)[quantity];
    return row.keys[likelyKey(row, column)].key;
  };
  EXPECT_EQ(unitFor(LogKind::flight, 3, "Alt MSL (ft)"), "altitude_ft");
  EXPECT_EQ(unitFor(LogKind::flight, 3, "height_m"), "altitude_m");
  EXPECT_EQ(unitFor(LogKind::flight, 3, "Alt"), "") << "nothing says whether it is feet or metres";
  EXPECT_EQ(unitFor(LogKind::flight, 1, "N_rad"), "latitude_rad");
  EXPECT_EQ(unitFor(LogKind::flight, 1, "N"), "latitude_deg");
  EXPECT_EQ(unitFor(LogKind::head, 0, "clock_us"), "time_us");
  EXPECT_EQ(unitFor(LogKind::head, 1, "Yaw"), "head_heading");
}

}  // namespace
}  // namespace trimtab
