#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "tests/csv_cells.h"
#include "trimtab/measure/cost_stages.h"
#include "trimtab/measure/trace.h"

/// Traces that older versions, other programs or accidents made.
namespace trimtab {
namespace {

/// `text` without the columns whose names `drop` says yes to.
std::string without(const std::string& text, bool (*drop)(std::string_view)) {
  std::istringstream lines(text);
  std::vector<bool> keep;
  std::string line, left;
  while (std::getline(lines, line)) {
    const bool header = keep.empty();
    std::istringstream cells(line);
    std::string cell;
    bool first = true;
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (header) keep.push_back(!drop(cell));
      if (!keep[i]) continue;
      left += (first ? "" : ",") + cell;
      first = false;
    }
    left += '\n';
  }
  return left;
}

TEST(Trace, readsTheRuleBaseOfOlderTraces) {
  TraceRow row;
  row.frame = TraceFrame{};  // so that no line ends in an empty cell
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  text.replace(text.find("below_first_band"), 16, "no_rule_fires");
  const std::size_t line = text.find('\n');
  const Result<std::vector<TraceRow>> read =
      parseTrace("rule_firing," + text.substr(0, line + 1) + "0;0," + text.substr(line + 1), "t.csv");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  EXPECT_EQ(read->front().decision.reason, SchemeReason::below_first_band) << "its total was 0";
}

TEST(Trace, readsTracesOfBeforeHeadMotionWithItsDefaults) {
  TraceRow row;
  row.before.motion.level = 3;
  row.decision.motion.reason = MotionReason::lowered;
  row.decision.totalMembership = 1.25;
  row.frame = TraceFrame{};  // so that no line ends in an empty cell
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  const Result<std::vector<TraceRow>> read = parseTrace(without(text,
                                                                [](std::string_view name) {
                                                                  return name.starts_with("motion_") ||
                                                                         name.starts_with("blur_") ||
                                                                         name.starts_with("restore_");
                                                                }),
                                                        "trace");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  EXPECT_EQ(read->at(0).decision.totalMembership, 1.25);
  EXPECT_EQ(read->at(0).decision.motion, MotionDecision{});
  EXPECT_EQ(read->at(0).before.motion, MotionMemory{});
}

TEST(Trace, readsTracesOfBeforeTheStagesOfAFrame) {
  TraceRow row;
  row.frame = TraceFrame{};
  for (const CostStage& stage : kCostStages) row.input.lastCost.*stage.ms = row.frame->cost.*stage.ms = 7;
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  const std::string older = without(text, [](std::string_view name) {
    for (const std::string stage : {"page_ms", "blur_ms", "weather_ms", "symbology_ms"})
      if (name == stage || name == "last_" + stage) return true;
    return false;
  });
  ASSERT_LT(older.size(), text.size());
  const Result<std::vector<TraceRow>> read = parseTrace(older, "trace");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  ASSERT_TRUE(read->at(0).frame);
  for (const FrameCost* cost : {&read->at(0).input.lastCost, &read->at(0).frame->cost}) {
    for (const double known :
         {cost->decide, cost->select, cost->occlusion, cost->cull, cost->draw, cost->gpu, cost->total})
      EXPECT_EQ(known, 7);
    for (const double unknown : {cost->page, cost->blur, cost->weather, cost->symbology})
      EXPECT_TRUE(std::isnan(unknown)) << "not 0, which would say that it cost nothing";
  }
}

TEST(Trace, readsTracesOfBeforeBackFacesWereLeftOut) {
  TraceRow row;
  row.frame = TraceFrame{{1, 2, 3, 4, 5, 6, 7}, {}};
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  const Result<std::vector<TraceRow>> now = parseTrace(text, "trace");
  ASSERT_TRUE(now.ok()) << toString(now.findings());
  EXPECT_EQ(now->at(0).frame->counts, row.frame->counts);
  const Result<std::vector<TraceRow>> read =
      parseTrace(without(text, [](std::string_view name) { return name == "culled_back_facing"; }), "trace");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  EXPECT_EQ(read->at(0).frame->counts, (TraceCounts{1, 2, 3, 4, 5, 6, 0}));
}

TEST(Trace, readsColumnsInAnyOrderAndPassesOverOthers) {
  TraceRow row;
  row.input.state.packet = 77;
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  // Columns turned round, one more at the front, Windows line ends.
  std::istringstream lines(text);
  std::string line, turned;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = test::csvCells(line);
    turned += turned.empty() ? "remark" : "none";
    for (auto cell = cells.rbegin(); cell != cells.rend(); ++cell) turned += ',' + *cell;
    turned += "\r\n";
  }
  const Result<std::vector<TraceRow>> read = parseTrace(turned, "trace");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  EXPECT_EQ(read->at(0).input.state.packet, 77u);
}

TEST(Trace, namesEveryBadCellWithLineAndColumn) {
  TraceRow row;
  std::string good;
  appendTraceRow(good, row);
  std::string bad = good;
  bad.replace(0, 1, "soon");
  std::string reason = good;
  reason.replace(reason.find("below_first_band"), 16, "because");
  std::string packet = good;
  const Result<std::vector<TraceRow>> read =
      parseTrace(traceHeader() + '\n' + good + bad + "\n" + reason + "1,2,3\n", "t.csv");
  ASSERT_FALSE(read.ok());
  ASSERT_EQ(read.findings().size(), 3u);
  EXPECT_EQ(toString(read.findings()[0]), "t.csv:3: time_s: expected a number, found \"soon\"");
  EXPECT_EQ(toString(read.findings()[1]),
            "t.csv:5: reason: expected below_first_band, in_band, held_by_hysteresis, "
            "invalid_input, altitude_unknown, found \"because\"");
  EXPECT_EQ(toString(read.findings()[2]).rfind("t.csv:6: expected ", 0), 0u);
}

TEST(Trace, refusesAFileWithoutItsColumnsAndNamesThem) {
  const Result<std::vector<TraceRow>> read = parseTrace("time_s,latitude_deg\n1,2\n", "t.csv");
  ASSERT_FALSE(read.ok());
  EXPECT_GT(read.findings().size(), 10u);
  EXPECT_EQ(toString(read.findings()[0]),
            "t.csv:1: longitude_deg: expected this column, found no such column");
  EXPECT_FALSE(parseTrace("", "t.csv").ok());
}

TEST(Trace, warnsWhereItsLastLineHasNoEnd) {
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, TraceRow{});
  const Result<std::vector<TraceRow>> whole = parseTrace(text, "t.csv");
  ASSERT_TRUE(whole.ok()) << toString(whole.findings());
  EXPECT_TRUE(whole.findings().empty());
  text.pop_back();
  const Result<std::vector<TraceRow>> cut = parseTrace(text, "t.csv");
  ASSERT_TRUE(cut.ok()) << toString(cut.findings());
  EXPECT_EQ(cut->size(), 1u);
  EXPECT_EQ(toString(cut.findings()),
            "t.csv:2: expected a line end after the last row, found none: the file may be cut short in its "
            "last number");
}

TEST(Trace, survivesAnyBytes) {
  std::mt19937_64 random(6);
  TraceRow row;
  std::string good = traceHeader() + '\n';
  appendTraceRow(good, row);
  for (int i = 0; i < 3000; ++i) {
    std::string text = good;
    for (std::uint64_t n = random() % 6; n > 0; --n)
      text[random() % text.size()] = static_cast<char>(random());
    text.resize(random() % (text.size() + 1));
    (void)parseTrace(text, "noise");
  }
}

}  // namespace
}  // namespace trimtab
