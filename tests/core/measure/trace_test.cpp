#include "trimtab/measure/trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <sstream>

#include "support.h"
#include "trimtab/measure/cost_stages.h"

namespace trimtab {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const TuningParameters kDefaults;

/// Any finite double, by its bits: every exponent, denormals and negative zero too.
double anyDouble(std::mt19937_64& random) {
  for (;;) {
    const auto value = std::bit_cast<double>(random());
    if (std::isfinite(value)) return value;
  }
}

bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void anyMotion(std::mt19937_64& random, DecisionMemory& before, FrameDecision& decision) {
  const auto stack = [&random](MotionStack& s) {
    s = {static_cast<std::uint32_t>(random()), anyDouble(random), anyDouble(random)};
  };
  MotionMemory& memory = before.motion;
  memory.known = random() % 2;
  for (double* value : {&memory.timeS, &memory.headingDeg, &memory.pitchDeg, &memory.blurRemainingMs})
    *value = anyDouble(random);
  stack(memory.blurStack);
  stack(memory.restoreStack);
  memory.level = static_cast<std::uint32_t>(random());
  MotionDecision& motion = decision.motion;
  motion.reason = static_cast<MotionReason>(random() % 13);
  motion.fast = random() % 2;
  motion.limitsInMs = random() % 2;
  for (double* value :
       {&motion.rateDegPerS, &motion.thresholdDegPerS, &motion.blurLimit, &motion.restoreLimit,
        &motion.lodScale, &motion.blur.strength, &motion.blur.remainingMs})
    *value = anyDouble(random);
  stack(motion.blurStack);
  stack(motion.restoreStack);
  motion.level = static_cast<std::uint32_t>(random());
}

void anyWeather(std::mt19937_64& random, WeatherDecision& weather) {
  weather.precipitation = static_cast<Precipitation>(random() % 3);
  weather.fogged = random() % 2;
  for (double* value : {&weather.density, &weather.visibilityM, &weather.extinctionPerM,
                        &weather.nearFarRatio, &weather.farM})
    *value = random() % 4 ? anyDouble(random) : WeatherDecision::kUnlimited;
  weather.reason = static_cast<WeatherReason>(random() % 8);
  weather.farReason = static_cast<FarReason>(random() % 5);
}

TraceRow anyRow(std::mt19937_64& random) {
  const auto number = [&random] { return anyDouble(random); };
  const auto maybe = [&random, &number]<class T>(std::optional<T>& value) {
    if (random() % 2) value = T{number()};
  };
  TraceRow row;
  AircraftState& state = row.input.state;
  state.time = number();
  state.packet = random();
  state.position = {Degrees{number()}, Degrees{number()}, Metres{number()}};
  state.attitude = {Degrees{number()}, Degrees{number()}, Degrees{number()}};
  maybe(row.input.aboveGround);
  state.aboveGround = row.input.aboveGround;
  maybe(state.visibility);
  maybe(state.airspeed);
  if (random() % 2)
    state.velocity =
        Velocity{MetresPerSecond{number()}, MetresPerSecond{number()}, MetresPerSecond{number()}};
  if (random() % 2) {
    state.weather = HostWeather{static_cast<Precipitation>(random() % 3), static_cast<int>(random() % 6), {}};
    maybe(state.weather->visibility);
  }
  if (random() % 2) state.head = Attitude{Degrees{number()}, Degrees{number()}, Degrees{number()}};
  if (random() % 2) {
    state.view = HostView{};
    state.view->left = Degrees{number()};
    maybe(state.view->top);
    maybe(state.view->nearDistance);
  }
  for (const CostStage& stage : kCostStages) row.input.lastCost.*stage.ms = number();
  if (random() % 2) row.before.band = static_cast<int>(random() % 17) - 1;
  FrameDecision& d = row.decision;
  for (double* value :
       {&d.altitudeFt, &d.pitchDeg, &d.altitudeMembership, &d.pitchMembership, &d.totalMembership})
    *value = number();
  d.ruleFiring.count = random() % (RuleList::kCapacity + 1);
  for (std::size_t i = 0; i < d.ruleFiring.count; ++i) d.ruleFiring.mu[i] = number();
  d.scheme = random() % 2 ? Scheme::dynamic : Scheme::frustum;
  d.band = static_cast<int>(random() % 17) - 1;
  if (random() % 2)
    d.depthMap = DepthMapSize{static_cast<int>(random() % 4096), static_cast<int>(random() % 4096)};
  d.reason = static_cast<SchemeReason>(random() % 6);
  d.lodScale = number();
  anyMotion(random, row.before, d);
  anyWeather(random, d.weather);
  if (random() % 2) {
    row.frame = TraceFrame{{random(), random(), random(), random(), random(), random()}, {}};
    for (const CostStage& stage : kCostStages) row.frame->cost.*stage.ms = random() % 8 ? number() : kNan;
  }
  return row;
}

void expectSame(const TraceRow& a, const TraceRow& b) {
  const AircraftState &s = a.input.state, &t = b.input.state;
  EXPECT_EQ(s, t);
  EXPECT_TRUE(sameBits(s.position.height.value(), t.position.height.value()));
  EXPECT_TRUE(sameBits(s.attitude.pitch.value(), t.attitude.pitch.value()));
  EXPECT_EQ(a.input.aboveGround, b.input.aboveGround);
  for (const CostStage& stage : kCostStages)
    EXPECT_TRUE(sameBits(a.input.lastCost.*stage.ms, b.input.lastCost.*stage.ms)) << stage.name;
  EXPECT_EQ(a.before, b.before);
  EXPECT_EQ(a.decision, b.decision);
  ASSERT_EQ(a.frame.has_value(), b.frame.has_value());
  if (!a.frame) return;
  EXPECT_EQ(a.frame->counts, b.frame->counts);
  for (const CostStage& stage : kCostStages)
    EXPECT_TRUE(sameBits(a.frame->cost.*stage.ms, b.frame->cost.*stage.ms)) << stage.name;
}

TEST(Trace, readsBackEveryNumberBitForBit) {
  std::mt19937_64 random(4);
  std::vector<TraceRow> rows;
  std::string text = traceHeader() + '\n';
  for (int i = 0; i < 2000; ++i) {
    rows.push_back(anyRow(random));
    appendTraceRow(text, rows.back());
  }
  const Result<std::vector<TraceRow>> read = parseTrace(text, "trace");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  ASSERT_EQ(read->size(), rows.size());
  for (std::size_t i = 0; i < rows.size() && !HasFailure(); ++i) expectSame(rows[i], (*read)[i]);

  std::string again = traceHeader() + '\n';
  for (const TraceRow& row : *read) appendTraceRow(again, row);
  EXPECT_EQ(again, text) << "and every column is among those compared";
}

TEST(Trace, writesTheStartOfEachLineAsAFlight) {
  EXPECT_EQ(
      traceHeader().rfind("time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg,"
                          "head_heading_deg,head_pitch_deg,packet,",
                          0),
      0u);
  EXPECT_TRUE(isTrace(traceHeader() + "\n1,2,3"));
  EXPECT_FALSE(isTrace("time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"));
  EXPECT_FALSE(isTrace(""));
}

TEST(Trace, givesTheHeightAboveGroundToTheStateSoThatAReplayNeedsNoTerrain) {
  TraceRow row;
  row.input.aboveGround = Metres{123.25};
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  const Result<std::vector<TraceRow>> read = parseTrace(text, "trace");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->at(0).input.state.aboveGround, Metres{123.25});
}

/// Decisions over a wild walk, as a program records them.
std::vector<TraceRow> recorded(const ValidatedParameters& parameters) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> climb(-30, 30), nod(-2, 2);
  std::vector<TraceRow> rows;
  DecisionMemory memory{1};
  double height = 1500, pitch = 0, heading = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    height = std::clamp(height + climb(random), 0.0, 3500.0);
    pitch = std::clamp(pitch + nod(random), -40.0, 40.0);
    TraceRow row;
    row.input.state.packet = i;
    row.input.state.position.height = Metres{i % 97 == 0 ? kNan : height};
    row.input.state.attitude.pitch = Degrees{pitch};
    row.input.state.time = 0.02 * static_cast<double>(i) - (i == 3000 ? 1 : 0);
    heading += i / 40 % 3 ? 0.1 : 2.5;
    row.input.state.head = Attitude{Degrees{heading}, Degrees{nod(random)}, Degrees{0}};
    if (i % 3) row.input.aboveGround = Metres{height / 2};
    if (i / 100 % 4 > 0)
      row.input.state.weather =
          HostWeather{static_cast<Precipitation>(i / 100 % 3), static_cast<int>(i / 7 % 6), {}};
    if (i / 50 % 3 > 0) row.input.state.visibility = Metres{std::exp(0.0021 * static_cast<double>(i))};
    row.before = memory;
    row.decision = decide(row.input, parameters, memory);
    rows.push_back(row);
  }
  return rows;
}

TEST(Trace, decidesAgainBitForBit) {
  TuningParameters aboveGround = kDefaults;
  aboveGround.altitude.reference = AltitudeReference::above_ground;
  TuningParameters rules = kDefaults;
  rules.scheme.combination = Combination::rules;
  TuningParameters weather = kDefaults;
  weather.weather.source = WeatherSource::host;
  weather.rainMedium.farStretch = Ratio{1.7};
  for (const TuningParameters& p : {kDefaults, aboveGround, rules, weather}) {
    const Result<ValidatedParameters> parameters = validate(p);
    ASSERT_TRUE(parameters.ok());
    const std::vector<TraceRow> rows = recorded(*parameters);
    std::string text = traceHeader() + '\n';
    for (const TraceRow& row : rows) appendTraceRow(text, row);
    const Result<std::vector<TraceRow>> read = parseTrace(text, "trace");
    ASSERT_TRUE(read.ok()) << toString(read.findings());
    EXPECT_TRUE(decideAgain(*read, *parameters).empty());

    // The chain of memories is whole as well.
    DecisionMemory memory = read->front().before;
    for (const TraceRow& row : *read) {
      ASSERT_EQ(memory, row.before);
      ASSERT_EQ(decide(row.input, *parameters, memory), row.decision);
    }
  }
}

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

TEST(Trace, readsTheFourRulesOfOlderTraces) {
  TraceRow row;
  row.frame = TraceFrame{};  // so that no line ends in an empty cell
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  const std::string older = without(text, [](std::string_view name) { return name == "rule_firing"; });
  const std::size_t line = older.find('\n');
  const Result<std::vector<TraceRow>> read =
      parseTrace("rule_low_down,rule_low_up,rule_high_down,rule_high_up," + older.substr(0, line + 1) +
                     "0.5,0.25,1,0," + older.substr(line + 1),
                 "t.csv");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  const RuleFiring& firing = read->front().decision.ruleFiring;
  EXPECT_EQ(std::vector<double>(firing.span().begin(), firing.span().end()),
            (std::vector<double>{0.5, 0.25, 1, 0}));
}

TEST(Trace, refusesMoreFiringsThanARuleBaseHolds) {
  TraceRow row;
  row.decision.ruleFiring.mu.fill(0);
  row.decision.ruleFiring.count = RuleList::kCapacity;
  std::string text = traceHeader() + '\n';
  appendTraceRow(text, row);
  std::string all = "0";
  for (std::size_t i = 1; i < RuleList::kCapacity; ++i) all += ";0";
  ASSERT_TRUE(parseTrace(text, "t.csv").ok());
  text.replace(text.find(all), all.size(), all + ";0");
  EXPECT_EQ(toString(parseTrace(text, "t.csv").findings()),
            "t.csv:2: rule_firing: expected up to 16 numbers with ; between, found \"" + all + ";0\"");
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

TEST(Trace, findsTheRowsThatOtherParametersDecideOtherwise) {
  std::vector<TraceRow> rows = recorded(defaultParameters());
  rows[10].decision.totalMembership = std::nextafter(rows[10].decision.totalMembership, 3);
  const std::vector<TraceDifference> differences = decideAgain(rows, defaultParameters());
  ASSERT_EQ(differences.size(), 1u);
  EXPECT_EQ(differences[0].row, 10u);
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
    std::vector<std::string> cells(1);
    for (const char c : line)
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
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
            "t.csv:5: reason: expected below_first_band, in_band, held_by_hysteresis, no_rule_fires, "
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

TEST(TraceWriter, writesWhatReadTraceReads) {
  test::ScratchDir dir;
  std::mt19937_64 random(12);
  const TraceRow row = anyRow(random);
  Result<TraceWriter> writer = TraceWriter::open(dir / "trace.csv");
  ASSERT_TRUE(writer.ok());
  (*writer).write(row);
  (*writer).write(row);
  EXPECT_TRUE((*writer).close().ok());
  const Result<std::vector<TraceRow>> read = readTrace(dir / "trace.csv");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  ASSERT_EQ(read->size(), 2u);
  expectSame(row, read->at(1));
}

TEST(TraceWriter, saysWhenAFileCannotBeOpenedOrTheDiskIsFull) {
  test::ScratchDir dir;
  EXPECT_FALSE(TraceWriter::open(dir / "absent" / "trace.csv").ok());
  EXPECT_FALSE(readTrace(dir / "absent.csv").ok());
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  Result<TraceWriter> writer = TraceWriter::open("/dev/full");
  ASSERT_TRUE(writer.ok());
  for (int i = 0; i < 100; ++i) (*writer).write(TraceRow{});
  EXPECT_FALSE((*writer).close().ok());
}

}  // namespace
}  // namespace trimtab
