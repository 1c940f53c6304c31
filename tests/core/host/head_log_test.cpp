#include "trimtab/host/head_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "tests/support.h"

namespace trimtab {
namespace {

using test::sharedDir;

HeadLog parsed(const std::string& text) {
  const Result<HeadLog> log = parseHeadLog(text, "head.csv");
  EXPECT_TRUE(log.ok()) << toString(log.findings());
  return log ? *log : HeadLog{};
}

bool tells(const Findings& findings, const std::string& part) {
  return toString(findings).find(part) != std::string::npos;
}

TEST(HeadLog, readsItsOwnColumnsFromTheFirstRowsTimeOn) {
  const HeadLog log = parsed(
      "time_s,head_heading_deg,head_pitch_deg,head_roll_deg\n"
      "10,1,2,3\n# a remark\n\n10.25, -4 ,+5,6\r\n");
  EXPECT_EQ(log.name, "head.csv");
  EXPECT_EQ(log.samples, (std::vector<HeadSample>{{0, 1, 2, 3}, {0.25, -4, 5, 6}}));
  EXPECT_EQ(headAt(log, 0.125), (Attitude{Degrees{-1.5}, Degrees{3.5}, Degrees{4.5}}));
  EXPECT_EQ(headAt(log, -3), headAt(log, 0));
  EXPECT_EQ(headAt(log, 99), headAt(log, 0.25)) << "its last sample is held";
  EXPECT_EQ(headAt(log, std::nan("")), headAt(log, 0));
}

TEST(HeadLog, takesUnitsFromNamesElseFromTheAngles) {
  EXPECT_NEAR(parsed("t heading pitch\n0 3.1 0.1\n1 -3.1 0.1\n").samples[0].headingDeg, 177.6, 0.1)
      << "it wraps";
  EXPECT_EQ(parsed("t heading pitch\n0 10 0.1\n").samples[0].pitchDeg, 0.1);
  EXPECT_EQ(parsed("t heading_deg pitch_deg\n0 1 0.1\n").samples[0].headingDeg, 1);
  EXPECT_NEAR(parsed("t;heading_rad;pitch_deg\n0;1;2\n").samples[0].headingDeg, 57.2958, 1e-4);
  EXPECT_EQ(parsed("time_ms,yaw_deg,pitch_deg\n0,1,2\n1500,1,2\n").durationS(), 1.5);
  EXPECT_TRUE(
      tells(parseHeadLog("t heading pitch\n0 3.1 0.1\n1 -3.1 0.1\n", "h").findings(), "read as radians"));
  EXPECT_TRUE(tells(parseHeadLog("t heading pitch\n0 3.1 0.1\n", "h").findings(), "degrees or radians"));
}

TEST(HeadLog, unwindsWhatWrapsAndTurnsTheShortWay) {
  const HeadLog log = parsed("t,heading_deg,pitch_deg\n0,350,359\n0.1,10,1\n0.2,30,2\n");
  EXPECT_EQ(log.samples[0].headingDeg, -10);
  EXPECT_EQ(log.samples[1].headingDeg, 10);
  EXPECT_EQ(log.samples[0].pitchDeg, -1);
  EXPECT_EQ(headAt(log, 0.05).heading, Degrees{0});
}

TEST(HeadLog, exchangesTheColumnsOfMv360sMisleadingHeaders) {
  const std::string text =
      "timestamp viewpoint yaw pitch roll\n0.0 0 0.1 6.2 0\n0.1 0 6.2 1.0 0\n0.2 0 0.1 2.5 0\n";
  const Result<HeadLog> log = parseHeadLog(text, "user");
  ASSERT_TRUE(log.ok());
  EXPECT_TRUE(tells(log.findings(), "the two are exchanged"));
  EXPECT_NEAR(log->samples[0].pitchDeg, 5.73, 0.01);
  EXPECT_NEAR(log->samples[2].headingDeg, 143.2, 0.1);
  // A name that says its unit is meant.
  EXPECT_FALSE(parseHeadLog("t,heading_deg,pitch_deg\n0,0,0\n1,0,80\n2,0,120\n", "h").ok());
  EXPECT_FALSE(parseHeadLog("t,yaw,pitch\n0,0,0\n1,80,80\n2,120,120\n", "h").ok()) << "both wind";
}

TEST(HeadLog, sortsRowsOutOfOrderAndSaysSo) {
  const Result<HeadLog> log =
      parseHeadLog("t,heading_deg,pitch_deg\n0,0,0\n0.2,20,0\n0.1,10,0\n0.1,11,0\n0.3,30,0\n", "h.csv");
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(log->samples,
            (std::vector<HeadSample>{{0, 0, 0, 0}, {0.1, 11, 0, 0}, {0.2, 20, 0, 0}, {0.3, 30, 0, 0}}));
  EXPECT_TRUE(tells(log.findings(), "1 rows before the row above them; sorted by time"));
  EXPECT_TRUE(tells(log.findings(), "1 rows with the time of another"));
}

TEST(HeadLog, holdsTheHeadInAGap) {
  const Result<HeadLog> log = parseHeadLog("t,heading_deg,pitch_deg\n0,0,0\n0.1,10,0\n0.6,60,0\n", "h.csv");
  ASSERT_TRUE(log.ok());
  EXPECT_TRUE(tells(log.findings(), "1 gaps of more than 250 ms, the longest of 500 ms"));
  EXPECT_NEAR(headAt(*log, 0.05).heading.value(), 5, 1e-9);
  EXPECT_EQ(headAt(*log, 0.35).heading, Degrees{10});
  EXPECT_EQ(headAt(*log, 0.6).heading, Degrees{60});
}

TEST(HeadLog, namesWhatIsWrongWithItsPlace) {
  const auto findings = [](const std::string& text) {
    return toString(parseHeadLog(text, "h.csv").findings());
  };
  EXPECT_NE(findings("").find("expected a header"), std::string::npos);
  EXPECT_NE(findings("# nothing\n").find("expected a header"), std::string::npos);
  EXPECT_NE(findings("time_s,head_heading_deg,head_pitch_deg\n").find("at least one row"), std::string::npos);
  EXPECT_NE(findings("a,b,c\n1,2,3\n").find("h.csv:1: heading"), std::string::npos);
  const std::string bad = findings("t,heading,pitch\n0,0,0\n1,nan,0\n2,0\n3,x,inf\n");
  EXPECT_NE(bad.find("h.csv:3: heading: expected a finite number, found \"nan\""), std::string::npos) << bad;
  EXPECT_NE(bad.find("h.csv:4: expected 3 cells, as the header, found 2"), std::string::npos) << bad;
  EXPECT_NE(bad.find("h.csv:5: pitch"), std::string::npos) << bad;
  EXPECT_FALSE(readHeadLog("absent.txt").ok());
}

// A log by MV360's headers (yaw is the nod) with some seconds in which the tracker lost the helmet: the nod
// leaves the quarter turn there.
std::string logWithBadSeconds(int rows, int bad) {
  std::string text = "timestamp viewpoint yaw pitch roll\n";
  for (int i = 0; i < rows; ++i) {
    const bool lost = i >= 100 && i < 100 + bad;
    text += std::to_string(i * 0.0625) + " 0 " + (lost ? "1.7" : "0.1") + " " +
            std::to_string(std::remainder(i * 0.05, 6.28)) + (lost ? " 1.3\n" : " 0\n");
  }
  return text;
}

TEST(HeadLog, namesRowColumnAndValueOfABadSecond) {
  const Result<HeadLog> log = parseHeadLog(logWithBadSeconds(1000, 55), "user");
  ASSERT_FALSE(log.ok());
  const std::string told = toString(log.findings());
  EXPECT_NE(told.find("user:102: yaw: expected a pitch of -90 to 90 deg, found \"1.7\""), std::string::npos)
      << told;
  EXPECT_NE(told.find("and 45 more rows"), std::string::npos) << told;
  EXPECT_EQ(told.find("--"), std::string::npos) << "an option of some program: " << told;
  EXPECT_NE(told.find("55 bad rows of 1000"), std::string::npos) << told;
}

// Unwinding from 0.05 degrees to 450 gives 90.000000000000014.
TEST(HeadLog, givesNoPitchBeyondAQuarterTurn) {
  const Result<HeadLog> log =
      parseHeadLog("timestamp;yaw;pitch\n0;0;0\n16;0.1;-0.05\n32;0.2;450\n64;0.4;-0.2\n", "user");
  ASSERT_TRUE(log) << toString(log.findings());
  ASSERT_EQ(log->samples.size(), 4U);
  EXPECT_EQ(log->samples[2].pitchDeg, 90);
}

TEST(HeadLog, leavesBadRowsOutWhenAsked) {
  const Result<HeadLog> log = parseHeadLog(logWithBadSeconds(1000, 55), "user", BadRows::leave_out);
  ASSERT_TRUE(log.ok()) << toString(log.findings());
  EXPECT_EQ(log->samples.size(), 945u);
  EXPECT_EQ(log->rowsLeftOut, 55u);
  EXPECT_TRUE(tells(log.findings(), "55 bad rows of 1000: they are left out"));
  for (const HeadSample& sample : log->samples) EXPECT_NEAR(sample.pitchDeg, 5.73, 0.01);
  // The heading goes on unwinding across them: 0.05 rad a row.
  EXPECT_NEAR(log->samples.back().headingDeg - log->samples.front().headingDeg, 999 * 0.05 * 180 / 3.14159265,
              2);
  const Result<HeadLog> unread =
      parseHeadLog("t,heading,pitch\n0,0,0\n1,x,0\n2,0,0\n", "h", BadRows::leave_out);
  ASSERT_TRUE(unread.ok());
  EXPECT_EQ(unread->samples.size(), 2u);
  EXPECT_TRUE(parseHeadLog(logWithBadSeconds(200, 99), "user", BadRows::leave_out).ok());
  EXPECT_FALSE(parseHeadLog("t,heading,pitch\n0,x,0\n1,x,0\n2,0,0\n", "h", BadRows::leave_out).ok())
      << "a log that is mostly bad is no log";
}

TEST(HeadLog, survivesAnyBytes) {
  std::mt19937_64 random(3);
  std::string good = "timestamp viewpoint yaw_rad pitch_rad roll_rad\n";
  for (int i = 0; i < 20; ++i) good += std::to_string(i * 0.017) + " 0 0.1 0.2 0.3\n";
  for (int i = 0; i < 3000; ++i) {
    std::string text = good;
    for (std::uint64_t n = random() % 6; n > 0; --n)
      text[random() % text.size()] = static_cast<char>(random());
    text.resize(random() % (text.size() + 1));
    const Result<HeadLog> log = parseHeadLog(text, "noise");
    if (!log) continue;
    for (const HeadSample& s : log->samples) {
      ASSERT_TRUE(std::isfinite(s.timeS) && s.timeS >= 0 && std::abs(s.pitchDeg) <= 90 + 1e-3);
      const Attitude a = headAt(*log, s.timeS);
      ASSERT_LE(std::abs(a.heading.value()), 180);
    }
  }
}

/// Straight from the file: heading is the column called pitch, the nod the one called yaw.
TEST(HeadLog, readsMv360AsItsReadmeSays) {
  TRIMTAB_NEEDS_SHARED("data/headmotion-mv360/user1_euler.txt");
  const auto file = sharedDir() / "data/headmotion-mv360/user1_euler.txt";
  const Result<HeadLog> log = readHeadLog(file);
  ASSERT_TRUE(log.ok()) << toString(log.findings());
  std::istringstream in(test::readFile(file));
  std::string line;
  std::getline(in, line);
  double time, viewpoint, yaw, pitch, roll;
  double leastNod = 90, mostNod = -90, left = 0, right = 0;
  for (const HeadSample& s : log->samples) {
    in >> time >> viewpoint >> yaw >> pitch >> roll;
    ASSERT_NEAR(s.timeS, time, 1e-9);
    ASSERT_NEAR(std::remainder(s.headingDeg - pitch * 180 / std::acos(-1.0), 360), 0, 1e-6);
    ASSERT_NEAR(std::remainder(s.pitchDeg - yaw * 180 / std::acos(-1.0), 360), 0, 1e-6);
    leastNod = std::min(leastNod, s.pitchDeg), mostNod = std::max(mostNod, s.pitchDeg);
    left = std::min(left, s.headingDeg), right = std::max(right, s.headingDeg);
  }
  EXPECT_EQ(log->samples.size(), 16053u);
  EXPECT_GE(leastNod, -32);
  EXPECT_LE(mostNod, 49);
  EXPECT_GT(right - left, 360) << "it winds";
}

TEST(Sweep, turnsThereAndBackAtAnyStep) {
  const Result<HeadLog> log = parseSweep("sweep:180deg/1s/2s");
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(log->durationS(), 6);
  EXPECT_EQ(headAt(*log, 0).heading, Degrees{-90});
  EXPECT_EQ(headAt(*log, 2).heading, Degrees{-90});
  EXPECT_EQ(headAt(*log, 2.5).heading, Degrees{0});
  EXPECT_EQ(headAt(*log, 3).heading, Degrees{90});
  EXPECT_EQ(headAt(*log, 5.25).heading, Degrees{45});
  EXPECT_EQ(headAt(*log, 8.5).heading, Degrees{0}) << "and again";
  for (const double hz : {60.0, 200.0, 450.0})
    for (double t = 2; t + 1 / hz <= 3; t += 1 / hz)
      ASSERT_NEAR((headAt(*log, t + 1 / hz).heading - headAt(*log, t).heading).value() * hz, 180, 1e-6);
  EXPECT_EQ(headAt(parseSweep("nod:90/0.5").value(), 2.5).pitch, Degrees{45});
  EXPECT_EQ(parseSweep("sweep:-180/1/0").value().durationS(), 2);
}

TEST(Sweep, ofTenThousandDegreesASecondWinds) {
  const HeadLog log = parseSweep("sweep:10000/1s/0s").value();
  EXPECT_NEAR(headAt(log, 0.5).heading.value(), 0, 1e-9);
  EXPECT_NEAR(headAt(log, 0.51).heading.value(), 100, 1e-6);
  EXPECT_NEAR(headAt(log, 0.52).heading.value(), -160, 1e-6) << "200 degrees on";
}

TEST(Sweep, refusesWhatItCannotTurn) {
  for (const char* text : {"sweep:", "sweep:180", "sweep:180/0", "sweep:180/-1", "sweep:nan/1", "sweep:1e9/1",
                           "sweep:180/1s/2s/3s", "sweep:180/1h", "nod:200/1", "sweep:180/1/-1", "turn:1/1"})
    EXPECT_FALSE(parseSweep(text).ok()) << text;
  EXPECT_TRUE(openHead("sweep:90/1").ok());
  EXPECT_FALSE(openHead("absent.csv").ok());
}

}  // namespace
}  // namespace trimtab
