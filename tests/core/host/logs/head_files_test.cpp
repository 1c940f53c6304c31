#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "trimtab/host/head_log.h"

namespace trimtab {
namespace {

struct Pose {
  double t, yaw, pitch, roll;
};

std::vector<Pose> motion(double yaw = 25, double pitch = 6) {
  std::vector<Pose> poses;
  for (int i = 0; i < 150; ++i) {
    const double t = i * 0.02;
    poses.push_back({t, yaw * std::sin(1.5 * t), pitch * std::sin(2.5 * t), 3 * std::cos(t)});
  }
  return poses;
}

/// A log with this header, whose rows are printed by this format from these values.
std::string logOf(const char* header, const char* format,
                  const std::function<std::array<double, 4>(const Pose&)>& values,
                  const std::vector<Pose>& poses = motion()) {
  std::string text = std::string(header) + '\n';
  for (const Pose& pose : poses) {
    const auto v = values(pose);
    char row[200];
    std::snprintf(row, sizeof row, format, v[0], v[1], v[2], v[3]);
    text += std::string(row) + '\n';
  }
  return text;
}

std::array<double, 4> asIs(const Pose& p) {
  return {p.t, p.yaw, p.pitch, p.roll};
}

std::string withCommas(std::string text) {
  for (char& c : text)
    if (c == '.') c = ',';
  return text;
}

struct HeadCase {
  const char* name;
  std::string text;
  const char* says = "";
  const char* columns = "";
};

void expectMotion(const HeadCase& c) {
  const auto columns = parseColumnMap(c.columns);
  ASSERT_TRUE(columns) << c.columns;
  const Result<HeadLog> log = parseHeadLog(c.text, "h.csv", BadRows::refuse, *columns);
  ASSERT_TRUE(log) << c.name << ": " << toString(log.findings());
  EXPECT_NE(toString(log.findings()).find(c.says), std::string::npos)
      << c.name << ": " << toString(log.findings());
  const std::vector<Pose> poses = motion();
  ASSERT_EQ(log->samples.size(), poses.size()) << c.name;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ASSERT_NEAR(log->samples[i].timeS, poses[i].t, 1e-4) << c.name;
    ASSERT_NEAR(log->samples[i].headingDeg, poses[i].yaw, 0.02) << c.name;
    ASSERT_NEAR(log->samples[i].pitchDeg, poses[i].pitch, 0.02) << c.name;
    ASSERT_NEAR(log->samples[i].rollDeg, poses[i].roll, 0.02) << c.name;
  }
}

TEST(HeadFiles, readOneMotionHoweverItIsWritten) {
  const auto scaled = [](double scale, double begin) {
    return [=](const Pose& p) { return std::array<double, 4>{begin + p.t * scale, p.yaw, p.pitch, p.roll}; };
  };
  const auto radians = [](const Pose& p) {
    constexpr double kRad = M_PI / 180;
    return std::array<double, 4>{p.t, p.yaw * kRad, p.pitch * kRad, p.roll * kRad};
  };
  const auto quaternion = [](const Pose& p) {
    constexpr double kHalf = M_PI / 360;
    const double cy = std::cos(p.yaw * kHalf), sy = std::sin(p.yaw * kHalf), cp = std::cos(p.pitch * kHalf),
                 sp = std::sin(p.pitch * kHalf), cr = std::cos(p.roll * kHalf), sr = std::sin(p.roll * kHalf);
    return std::array<double, 4>{cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
                                 cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy};
  };
  std::string index = logOf("time_s,yaw_deg,pitch_deg,roll_deg", "%.3f,%.2f,%.2f,%.2f", asIs), indexed;
  for (std::size_t at = 0, row = 0; at < index.size(); ++row) {
    const std::size_t end = index.find('\n', at);
    indexed += (row == 0 ? "" : std::to_string(row)) + ',' + index.substr(at, end + 1 - at);
    at = end + 1;
  }
  std::string turned = logOf("qw,qx,qy,qz", "%.6f,%.6f,%.6f,%.6f", quaternion);
  for (std::size_t at = 0, row = 0; at < turned.size(); ++row) {
    turned.insert(at, row == 0 ? "time_s," : std::to_string(static_cast<double>(row - 1) * 0.02) + ',');
    at = turned.find('\n', at) + 1;
  }
  for (const HeadCase& c : {
           HeadCase{"our own", index},
           {"an index of pandas", indexed},
           {"decimal commas",
            withCommas(logOf("time_s;yaw_deg;pitch_deg;roll_deg", "%.3f;%.2f;%.2f;%.2f", asIs)),
            "decimal comma"},
           {"another order, degrees",
            logOf("t,pitch,yaw,roll", "%.3f,%.2f,%.2f,%.2f",
                  [](const Pose& p) {
                    return std::array<double, 4>{p.t, p.pitch, p.yaw, p.roll};
                  }),
            "read as degrees"},
           {"named radians", logOf("time,Yaw (rad),Pitch (rad),Roll (rad)", "%.3f,%.5f,%.5f,%.5f", radians)},
           {"milliseconds of no unit", logOf("t,yaw,pitch,roll", "%.0f,%.2f,%.2f,%.2f", scaled(1000, 0)),
            "read as milliseconds"},
           {"dates in seconds",
            logOf("timestamp,yaw,pitch,roll", "%.3f,%.2f,%.2f,%.2f", scaled(1, 1700000123)),
            "seconds since 1970"},
           {"dates in milliseconds",
            logOf("timestamp,yaw,pitch,roll", "%.0f,%.2f,%.2f,%.2f", scaled(1e3, 1700000123e3)),
            "milliseconds since 1970"},
           {"dates in microseconds",
            logOf("timestamp,yaw,pitch,roll", "%.0f,%.2f,%.2f,%.2f", scaled(1e6, 1700000123e6)),
            "microseconds since 1970"},
           {"clocks", logOf("time,yaw,pitch,roll", "12:34:%06.3f,%.2f,%.2f,%.2f", scaled(1, 5)), "a clock"},
           {"a map of shares of a turn",
            logOf("time_s,y,p,r", "%.3f,%.6f,%.6f,%.3f",
                  [](const Pose& p) {
                    return std::array<double, 4>{p.t, p.yaw / 360 + 0.5, p.pitch / 180 + 0.5, p.roll};
                  }),
            "", "yaw_deg=y*360-180,pitch_deg=p*180-90,roll_deg=r"},
           {"quaternions", turned, "", "head_qw=qw,head_qx=qx,head_qy=qy,head_qz=qz"},
           {"time steps",
            logOf("dt,yaw_deg,pitch_deg,roll_deg", "%.3f,%.2f,%.2f,%.2f",
                  [](const Pose& p) {
                    return std::array<double, 4>{0.02, p.yaw, p.pitch, p.roll};
                  }),
            "", "time_step_s=dt"},
           {"opentrack",
            logOf("dt,rawYaw,rawPitch,rawRoll", "%.3f,%.2f,%.2f,%.2f",
                  [](const Pose& p) {
                    return std::array<double, 4>{0.02, p.yaw, p.pitch, p.roll};
                  }),
            "the columns of an opentrack log"},
       })
    expectMotion(c);
}

TEST(HeadFiles, areRefusedIfTwoReadingsFit) {
  const std::string header = "time_s,yaw,pitch,roll";
  const auto shares = [](const Pose& p) {
    return std::array<double, 4>{p.t, p.yaw / 360 + 0.5, p.pitch / 180 + 0.5, 0.25};
  };
  const auto rows = [](const Pose& p) { return std::array<double, 4>{p.t * 50, p.yaw, p.pitch, p.roll}; };
  for (const HeadCase& c : {
           HeadCase{"a still pilot", logOf(header.c_str(), "%.3f,%.2f,%.2f,%.2f", asIs, motion(4, 1)),
                    "may be degrees or radians: name the unit, or map the column, as "
                    "head_heading_deg=yaw,head_pitch_deg=pitch"},
           {"shares of a turn", logOf(header.c_str(), "%.3f,%.4f,%.4f,%.4f", shares),
            "head_heading_deg=yaw*360-180,head_pitch_deg=pitch*180-90"},
           {"counted rows", logOf("t,yaw_deg,pitch_deg,roll_deg", "%.0f,%.2f,%.2f,%.2f", rows),
            "seconds or milliseconds: name the unit"},
           {"quaternions", "time,qw,qx,qy,qz\n0,1,0,0,0\n", "a head log of quaternions"},
           {"a game engine's", "time,EulerX,EulerY,EulerZ\n0,1,2,0\n", "head_heading_deg=EulerY"},
           {"a flight", "time_s,latitude_deg,longitude_deg,altitude_ft\n0,1,2,3\n", "seems to be a flight"},
           {"cells of no column", "time_s,yaw_deg,pitch_deg\n0,1,2,9\n1,2,3,9\n",
            "a name for each of the 4 cells"},
           {"an empty first cell", "yaw_deg,pitch_deg,time_s\n1,2,0\n,2,1\n3,2,2\n",
            "h.csv:3: yaw_deg: expected a finite number"},
       }) {
    const Result<HeadLog> log = parseHeadLog(c.text, "h.csv");
    EXPECT_FALSE(log) << c.name;
    EXPECT_NE(toString(log.findings()).find(c.says), std::string::npos)
        << c.name << ": " << toString(log.findings());
  }
}

}  // namespace
}  // namespace trimtab
