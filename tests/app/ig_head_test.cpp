#include "ig_support.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "trimtab/motion/head_motion.h"

namespace trimtab {
namespace {

using test::IgProcess;

class IgHead : public ::testing::Test {
 protected:
  IgProcess fly(const std::string& flight, const std::string& trace,
                const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"--preset",   "default",
                                       "--terrain",  test::smallTerrain().string(),
                                       "--flight",   (dir_ / flight).string(),
                                       "--trace",    (dir_ / trace).string(),
                                       "--headless", "--size",
                                       "320x200",    "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return IgProcess(arguments);
  }
  std::vector<TraceRow> rowsOf(const std::string& trace) const {
    const Result<std::vector<TraceRow>> rows = readTrace(dir_ / trace);
    EXPECT_TRUE(rows) << toString(rows.findings());
    return rows ? *rows : std::vector<TraceRow>{};
  }

  /// Straight on at 60 rows a second, while the head sweeps.
  void writeFlight(int rows) const {
    Flight flight = test::weavingFlight(rows);
    for (std::size_t i = 0; i < flight.states.size(); ++i) {
      flight.states[i].time = static_cast<double>(i) / 60;
      flight.states[i].attitude = {Degrees{40}, Degrees{-5}, Degrees{0}};
    }
    test::writeFile(dir_ / "flight.csv", flightCsv(flight));
  }

  test::ScratchDir dir_;
};

TEST_F(IgHead, sweepsOverAFlightAndReplaysToTheBit) {
  writeFlight(119);
  IgProcess ig = fly("flight.csv", "trace.csv", {"--head", "sweep:180/1s/0.5s"});
  ASSERT_EQ(ig.end(), 0) << ig.err();
  const std::vector<TraceRow> rows = rowsOf("trace.csv");
  ASSERT_EQ(rows.size(), 119u);
  const HeadLog sweep = parseSweep("sweep:180/1s/0.5s").value();
  int lowered = 0, raised = 0;
  std::uint64_t finest = 0, coarsest = ~0ull;
  for (const TraceRow& row : rows) {
    ASSERT_EQ(row.input.state.head, headAt(sweep, row.input.state.time));
    lowered += row.decision.motion.reason == MotionReason::lowered;
    raised += row.decision.motion.reason == MotionReason::raised;
    const double heading = row.input.state.head->heading.value();
    // The same direction, on the way there and at rest after it.
    if (heading < 89.5) continue;
    if (row.decision.motion.lodScale == 1) finest = std::max(finest, row.frame->counts.triangles);
    if (row.decision.motion.lodScale == 4) coarsest = std::min(coarsest, row.frame->counts.triangles);
  }
  EXPECT_EQ(lowered, 2);
  EXPECT_EQ(raised, 2);
  EXPECT_LT(coarsest, finest) << "a larger scale draws fewer triangles";

  IgProcess again = fly("trace.csv", "again.csv");
  ASSERT_EQ(again.end(), 0) << again.err();
  const std::vector<TraceRow> replayed = rowsOf("again.csv");
  ASSERT_EQ(replayed.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(replayed[i].decision, rows[i].decision) << i;
    ASSERT_EQ(replayed[i].frame->counts, rows[i].frame->counts) << i;
  }
}

TEST_F(IgHead, flysARecordedHead) {
  TRIMTAB_NEEDS_SHARED("data/headmotion-mv360/user1_euler.txt");
  writeFlight(60);
  IgProcess ig = fly("flight.csv", "trace.csv",
                     {"--head", (test::sharedDir() / "data/headmotion-mv360/user1_euler.txt").string()});
  ASSERT_EQ(ig.end(), 0) << ig.err();
  EXPECT_NE(ig.err().find("the two are exchanged"), std::string::npos) << ig.err();
  EXPECT_TRUE(rowsOf("trace.csv").at(30).input.state.head);
}

TEST_F(IgHead, saysWhichOptionLeavesBadRowsOut) {
  writeFlight(4);
  test::writeFile(dir_ / "head.csv", "time_s,heading_deg,pitch_deg\n0,0,0\n1,0,95\n2,0,0\n");
  const std::string log = (dir_ / "head.csv").string();
  IgProcess refused = fly("flight.csv", "trace.csv", {"--head", log});
  EXPECT_EQ(refused.end(), 1);
  EXPECT_NE(refused.err().find("--skip-bad-rows"), std::string::npos) << refused.err();
  EXPECT_NE(refused.err().find("to leave 1 row out"), std::string::npos) << refused.err();
  IgProcess flown = fly("flight.csv", "trace.csv", {"--head", log, "--skip-bad-rows"});
  EXPECT_EQ(flown.end(), 0) << flown.err();
}

TEST_F(IgHead, refusesABadHeadAndOneBesideATrace) {
  writeFlight(4);
  for (const std::string head : {"sweep:180", "absent.txt"}) {
    IgProcess ig = fly("flight.csv", "trace.csv", {"--head", head});
    EXPECT_EQ(ig.end(), 1) << head;
  }
  ASSERT_EQ(fly("flight.csv", "trace.csv").end(), 0);
  IgProcess ig = fly("trace.csv", "again.csv", {"--head", "sweep:180/1s"});
  EXPECT_EQ(ig.end(), 1);
  EXPECT_NE(ig.err().find("a trace that brings its heads"), std::string::npos) << ig.err();
}

}  // namespace
}  // namespace trimtab
