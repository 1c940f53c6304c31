#pragma once

#include <string>

#include "tests/support.h"

namespace trimtab::test {

/// What a command of trimtab-cli is tried out on: 6 km of the sample terrain and two short flights over it,
/// made once for a group of tests.
class SmallRun : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new ScratchDir;
    ASSERT_EQ(run(cli() + " terrain sample --size-km 6 -o " + elevation()).exitCode, 0);
    ASSERT_EQ(run(cli() + " terrain bake " + elevation() + " -o " + database()).exitCode, 0);
    writeFlight("hop", 4000, 0);
    writeFlight("skip", 4500, 40);
  }
  static void TearDownTestSuite() { delete shared_; }

  static std::string cli() { return program("trimtab-cli").string(); }
  static std::string elevation() { return (*shared_ / "sample.tif").string(); }
  static std::string database() { return (*shared_ / "db").string(); }
  static std::string flight(const std::string& name = "hop") { return (*shared_ / (name + ".csv")).string(); }

  static inline ScratchDir* shared_ = nullptr;

 private:
  /// 20 s that climb, nose down and turn.
  static void writeFlight(const std::string& name, int altitudeFt, int headingDeg) {
    std::string csv = "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n";
    for (int i = 0; i < 40; ++i)
      csv += std::to_string(i * 0.5) + ',' + std::to_string(36.615 + i * 5e-4) + ",128.35," +
             std::to_string(altitudeFt + 100 * i) + ',' + std::to_string(-i * 0.3) + ",0," +
             std::to_string(headingDeg + i) + '\n';
    writeFile(flight(name), csv);
  }
};

}  // namespace trimtab::test
