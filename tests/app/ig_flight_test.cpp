#include <sstream>

#include "ig_support.h"
#include "tests/csv_cells.h"
#include "trimtab/host/flight.h"
#include "trimtab/measure/cost_stages.h"
#include "trimtab/trimtab.h"

namespace trimtab {
namespace {

using test::IgProcess;

/// The named columns of a CSV as text, read without any code of the trace's own.
std::vector<std::string> columns(const std::filesystem::path& file, const std::vector<std::string>& names) {
  std::istringstream in(test::readFile(file));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = test::csvCells(line);
  std::vector<std::string> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = test::csvCells(line);
    std::string row;
    for (const std::string& name : names) {
      const auto at = std::find(header.begin(), header.end(), name);
      if (at == header.end() || cells.size() != header.size()) return {};
      row += cells[static_cast<std::size_t>(at - header.begin())] + ";";
    }
    rows.push_back(row);
  }
  return rows;
}

const std::vector<std::string> kDecisionColumns = {"packet",
                                                   "decision_altitude_ft",
                                                   "decision_pitch_deg",
                                                   "altitude_membership",
                                                   "pitch_membership",
                                                   "total_membership",
                                                   "scheme",
                                                   "band",
                                                   "depth_map_width_px",
                                                   "depth_map_height_px",
                                                   "reason",
                                                   "lod_scale"};

class IgFlight : public ::testing::Test {
 protected:
  IgProcess fly(const std::filesystem::path& flight, const std::filesystem::path& trace,
                std::vector<std::string> more = {}, const char* size = "320x200") const {
    std::vector<std::string> arguments{"--preset",   (dir_ / "preset.json").string(),
                                       "--terrain",  test::smallTerrain().string(),
                                       "--flight",   flight.string(),
                                       "--trace",    trace.string(),
                                       "--headless", "--size",
                                       size,         "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return IgProcess(arguments);
  }
  std::vector<TraceRow> rowsOf(const std::filesystem::path& trace) const {
    const Result<std::vector<TraceRow>> rows = readTrace(trace);
    EXPECT_TRUE(rows) << toString(rows.findings());
    return rows ? *rows : std::vector<TraceRow>{};
  }
  void write(const ValidatedParameters& parameters, const Flight& flight) const {
    test::writeFile(dir_ / "preset.json", test::exported(parameters));
    test::writeFile(dir_ / "flight.csv", flightCsv(flight));
  }

  test::ScratchDir dir_;
};

/// Flies rows of the image generator's trace by libtrimtab, and returns the first whose levers or reasons are
/// others; nothing if all agree to the bit.
std::optional<std::size_t> firstOtherwiseByC(const std::filesystem::path& preset,
                                             const std::vector<TraceRow>& rows) {
  trimtab_preset* loaded = nullptr;
  trimtab_session* session = nullptr;
  EXPECT_EQ(trimtab_preset_load(preset.c_str(), &loaded, nullptr), TRIMTAB_OK);
  EXPECT_EQ(trimtab_session_create(loaded, &session), TRIMTAB_OK);
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < rows.size() && !first; ++i) {
    const AircraftState& state = rows[i].input.state;
    trimtab_state s{};
    s.size = sizeof s;
    trimtab_state_clear(&s);
    s.packet = state.packet, s.time_s = state.time;
    s.latitude_deg = state.position.latitude.value(), s.longitude_deg = state.position.longitude.value();
    s.height_m = state.position.height.value();
    s.heading_deg = state.attitude.heading.value(), s.pitch_deg = state.attitude.pitch.value();
    s.roll_deg = state.attitude.roll.value();
    trimtab_session_fly(session, &s);
    trimtab_session_request(session, s.time_s, 16, 16, nullptr);
    std::vector<double> drawn(kFrameLeverRows.size());
    trimtab_session_levers(session, TRIMTAB_STEP_BUDGET, drawn.data(), drawn.size());
    trimtab_decision decision{};
    decision.size = sizeof decision;
    trimtab_session_decision(session, &decision);
    bool same = decision.scheme == toText(rows[i].decision.scheme) &&
                decision.scheme_reason == toText(rows[i].decision.reason) &&
                decision.total_membership == rows[i].decision.totalMembership;
    for (std::size_t k = 0; k < drawn.size(); ++k)
      same = same && drawn[k] == valueOf(rows[i].levers.drawn, kFrameLeverRows[k]);
    if (!same) first = i;
  }
  trimtab_session_free(session);
  trimtab_preset_free(loaded);
  return first;
}

TEST_F(IgFlight, decidesAsProgramsInCDo) {
  constexpr int kStates = 36000;
  write(*validate(*defaultParameters()), test::weavingFlight(kStates));
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv", {}, "16x16");
  ASSERT_EQ(ig.end(), 0) << ig.err();
  const std::vector<TraceRow> rows = rowsOf(dir_ / "trace.csv");
  ASSERT_EQ(rows.size(), std::size_t{kStates});
  EXPECT_EQ(firstOtherwiseByC(dir_ / "preset.json", rows), std::nullopt);
}

TEST_F(IgFlight, saysWhatHoldingTheBudgetCouldNotDo) {
  TuningParameters p = *defaultParameters();
  p.hold.enabled = true;
  p.measure.budget = Milliseconds{0.1};
  write(*validate(p), test::weavingFlight(60));
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv");
  ASSERT_EQ(ig.end(), 0) << ig.err();
  const nlohmann::json held = ig.summary()["hold"];
  EXPECT_EQ(held["off"], 0);
  // No image takes a tenth of a millisecond; and on a busy machine such short ones are hard to predict.
  EXPECT_GT(held["out_of_reach"].get<int>() + held["not_trusted"].get<int>(), 30);
  std::size_t outOfReach = 0;
  for (const TraceRow& row : rowsOf(dir_ / "trace.csv"))
    outOfReach += row.hold && row.hold->reason == HoldReason::out_of_reach;
  EXPECT_EQ(held["out_of_reach"], outOfReach);
}

TEST_F(IgFlight, drawsOneFrameAndWritesOneRowForEachRowOfTheFlight) {
  const Flight flight = test::weavingFlight(120);
  write(defaultParameters(), flight);
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv");
  ASSERT_EQ(ig.end(), 0) << ig.err();
  const nlohmann::json summary = ig.summary();
  EXPECT_EQ(summary["frames"], 120) << ig.out();
  EXPECT_EQ(summary["packets"], 120);
  EXPECT_GT(summary["decision_changes"], 3);
  EXPECT_GT(summary["horizons_built"], 0);
  EXPECT_EQ(summary["depth_maps_drawn"], 0) << "the horizon needs none";
  EXPECT_EQ(summary["hold"]["off"], 120);

  const std::vector<TraceRow> rows = rowsOf(dir_ / "trace.csv");
  ASSERT_EQ(rows.size(), flight.states.size());
  const std::vector<FrameDecision> decisions = test::decided(rows, defaultParameters());
  std::size_t withTerrain = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].input.state.position, flight.states[i].position) << i;
    EXPECT_EQ(rows[i].decision, decisions[i]) << i;
    ASSERT_TRUE(rows[i].frame) << i;
    withTerrain += rows[i].frame->counts.triangles > 0;
    const FrameCost& cost = rows[i].frame->cost;
    EXPECT_GT(cost.total, 0) << i;
    double sum = 0;
    for (const CostStage& stage : kCostStages)
      if (stage.kind == StageKind::of_frame && std::isfinite(cost.*stage.ms)) sum += cost.*stage.ms;
    EXPECT_NEAR(sum, cost.total, 1e-9 * cost.total) << "the decision is a stage too, row " << i;
  }
  const nlohmann::json& stages = summary["stages_ms"];
  for (const CostStage& stage : kCostStages) EXPECT_TRUE(stages.contains(stage.name)) << stage.name;
  EXPECT_EQ(stages["total"]["frames"], 120);
  EXPECT_GT(stages["draw"]["median"], 0);
  EXPECT_GT(stages["page"]["frames"], 0) << "the first frames make tiles";
  EXPECT_LT(stages["page"]["frames"], 120);
  EXPECT_EQ(stages["blur"]["frames"], 0);
  EXPECT_TRUE(stages["blur"]["median"].is_null()) << "was not run";
  EXPECT_GT(withTerrain, rows.size() / 3)
      << "the flight looks away from its few kilometres of terrain at times";
  EXPECT_FALSE(std::filesystem::exists(dir_ / "trace.csv.part"));
}

TEST_F(IgFlight, drawsDepthMapsAndNoHorizonWhereThePresetSaysSo) {
  write(test::edited([](TuningParameters& p) { p.culling.occlusion = OcclusionMethod::depth_map; }),
        test::weavingFlight(120));
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv");
  ASSERT_EQ(ig.end(), 0) << ig.err();
  EXPECT_GT(ig.summary()["depth_maps_drawn"], 0);
  EXPECT_EQ(ig.summary()["horizons_built"], 0);
}

TEST_F(IgFlight, replaysItsOwnTraceToTheBit) {
  write(test::edited([](TuningParameters& p) { p.altitude.reference = AltitudeReference::above_ground; }),
        test::weavingFlight(100));
  IgProcess first = fly(dir_ / "flight.csv", dir_ / "first.csv");
  ASSERT_EQ(first.end(), 0) << first.err();
  IgProcess second = fly(dir_ / "first.csv", dir_ / "second.csv");
  ASSERT_EQ(second.end(), 0) << second.err();

  std::vector<std::string> names = kDecisionColumns;
  for (const char* state : {"time_s", "latitude_deg", "longitude_deg", "height_m", "pitch_deg", "roll_deg",
                            "heading_deg", "above_ground_m", "band_before"})
    names.push_back(state);
  const std::vector<std::string> recorded = columns(dir_ / "first.csv", names);
  ASSERT_EQ(recorded.size(), 100u);
  EXPECT_EQ(recorded, columns(dir_ / "second.csv", names));
  for (const TraceRow& row : rowsOf(dir_ / "first.csv")) {
    ASSERT_TRUE(row.input.aboveGround) << "the terrain was asked";
    EXPECT_LT(row.input.aboveGround->value(), row.input.state.position.height.value());
  }
}

TEST_F(IgFlight, endsAfterSoManyFramesAndWritesThePictureOfTheLast) {
  write(defaultParameters(), test::weavingFlight(50));
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv",
                     {"--frames", "7", "--screenshot", (dir_ / "a.png").string()});
  ASSERT_EQ(ig.end(), 0) << ig.err();
  EXPECT_EQ(ig.summary()["frames"], 7);
  EXPECT_EQ(rowsOf(dir_ / "trace.csv").size(), 7u);
  const std::string png = test::readFile(dir_ / "a.png");
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\1\x40\0\0\0\xc8", 8)) << "320 x 200";

  test::writeFile(dir_ / "seventh.csv", flightCsv({"", {test::weavingFlight(50).states[6]}}));
  IgProcess alone =
      fly(dir_ / "seventh.csv", dir_ / "alone.csv", {"--screenshot", (dir_ / "b.png").string()});
  ASSERT_EQ(alone.end(), 0) << alone.err();
  EXPECT_EQ(png, test::readFile(dir_ / "b.png")) << "a picture depends on its row alone";
}

TEST_F(IgFlight, playsOnTheFlightsOwnClockWhenAsked) {
  write(defaultParameters(), test::weavingFlight(60, 60));
  const auto start = std::chrono::steady_clock::now();
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv", {"--realtime"});
  ASSERT_EQ(ig.end(), 0) << ig.err();
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(59 * 1000 / 60));
  EXPECT_EQ(rowsOf(dir_ / "trace.csv").size(), 60u);
  EXPECT_LE(ig.summary()["frames"], 60);
  EXPECT_TRUE(ig.summary()["picture_p99_ms"].is_null()) << "sixty images have no 99th percentile";
  EXPECT_TRUE(ig.summary()["frame_median_ms"].is_number());
}

TEST_F(IgFlight, aKilledRunLeavesItsRowsInAPartAndTheOldTraceUntouched) {
  write(defaultParameters(), test::weavingFlight(100000));
  test::writeFile(dir_ / "trace.csv", "old");
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv");
  const auto lines = [&] {
    const std::string part = test::readFile(dir_ / "trace.csv.part");
    return std::count(part.begin(), part.end(), '\n');
  };
  ASSERT_TRUE(ig.until([&] { return lines() > 20; })) << ig.err();
  ig.signal(SIGKILL);
  EXPECT_EQ(ig.end(), 128 + SIGKILL);
  EXPECT_EQ(test::readFile(dir_ / "trace.csv"), "old");
  EXPECT_GE(rowsOf(dir_ / "trace.csv.part").size(), 20u);
}

TEST_F(IgFlight, aSignalEndsTheRunWithACompleteTrace) {
  write(defaultParameters(), test::weavingFlight(100000));
  IgProcess ig = fly(dir_ / "flight.csv", dir_ / "trace.csv");
  ASSERT_TRUE(ig.until([&] { return test::readFile(dir_ / "trace.csv.part").size() > 10000; })) << ig.err();
  ig.signal(SIGTERM);
  ASSERT_EQ(ig.end(), 0) << ig.err();
  const std::vector<TraceRow> rows = rowsOf(dir_ / "trace.csv");
  EXPECT_EQ(rows.size(), ig.summary()["packets"]);
  EXPECT_TRUE(rows.back().frame);
}

TEST_F(IgFlight, playsRecordingsOfRealHostsWithTheirFlaws) {
  struct Case {
    const char* file;
    std::size_t packets;
    const char* says;
  };
  const Case cases[] = {{"captures/fgfs-2020.3.16-native-fdm-v24-ufo-60hz.pcap", 1320, "silence of 18"},
                        {"captures/ccl-3.3.3-minihost-dummyig-cigi33.pcap", 234, "Start of Frame"},
                        {"data/flight-fg-keflavik/reg_flight.csv", 2138, "36 rows"}};
  for (const Case& c : cases) {
    TRIMTAB_NEEDS_SHARED(c.file);
    write(defaultParameters(), test::weavingFlight(1));
    IgProcess ig = fly(test::sharedDir() / c.file, dir_ / "trace.csv");
    ASSERT_EQ(ig.end(), 0) << c.file << "\n" << ig.err();
    EXPECT_EQ(ig.summary()["frames"], c.packets) << c.file;
    EXPECT_NE(ig.err().find(c.says), std::string::npos) << ig.err();
    const std::vector<TraceRow> rows = rowsOf(dir_ / "trace.csv");
    ASSERT_EQ(rows.size(), c.packets) << c.file;
    const std::vector<FrameDecision> decisions = test::decided(rows, defaultParameters());
    for (std::size_t i = 0; i < rows.size(); ++i)
      ASSERT_EQ(rows[i].decision, decisions[i]) << c.file << " " << i;
  }
}

}  // namespace
}  // namespace trimtab
