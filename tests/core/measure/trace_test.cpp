#include "trimtab/measure/trace.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <sstream>

#include "tests/support.h"
#include "trimtab/measure/cost_stages.h"
#include "trimtab/measure/trace_file.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

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
  for (double* value :
       {&memory.timeS, &memory.headingDeg, &memory.pitchDeg, &memory.blurRemainingMs, &memory.blurShare})
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
  for (double* value : {&weather.density, &weather.visibilityM, &weather.extinctionPerM, &weather.layerTopM,
                        &weather.safeFarM, &weather.nearFarRatio, &weather.farM})
    *value = random() % 4 ? anyDouble(random) : WeatherDecision::kUnlimited;
  weather.reason = static_cast<WeatherReason>(random() % 8);
  weather.farReason = static_cast<FarReason>(random() % 7);
}

void anyPolicy(std::mt19937_64& random, TraceRow& row) {
  for (double& value : row.input.signalValues.value)
    if (random() % 2) value = anyDouble(random);
  if (random() % 2) {
    LeverDrive::State before{
        .moving = static_cast<std::uint32_t>(random()), .timeS = anyDouble(random), .begun = true};
    for (double& value : before.values.value) value = anyDouble(random);
    row.before.levers = LeverDrive(before);
  }
  if (random() % 2) {
    PolicyOutcome& set = row.decision.policy;
    for (double& value : set.value) value = anyDouble(random);
    set.moved = static_cast<std::uint32_t>(random());
    set.unknownAsked = static_cast<std::uint32_t>(random());
  }
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
  maybe(row.input.highestGround);
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
  if (random() % 2) row.input.drawn = {number(), random(), {}};
  const auto attitude = [&] { return Attitude{Degrees{number()}, Degrees{number()}, Degrees{number()}}; };
  if (random() % 2)
    row.input.drawn.eye =
        DrawnEye{number(), {Degrees{number()}, Degrees{number()}, Metres{number()}}, attitude(), attitude()};
  if (random() % 2) row.before.band = static_cast<int>(random() % 17) - 1;
  FrameDecision& d = row.decision;
  for (double* value :
       {&d.altitudeFt, &d.pitchDeg, &d.altitudeMembership, &d.pitchMembership, &d.totalMembership})
    *value = number();
  d.scheme = random() % 2 ? Scheme::dynamic : Scheme::frustum;
  d.band = static_cast<int>(random() % 17) - 1;
  if (random() % 2)
    d.occlusionResolution =
        OcclusionResolution{static_cast<int>(random() % 4096), static_cast<int>(random() % 4096)};
  d.reason = static_cast<SchemeReason>(random() % 5);
  LeverChain& chain = row.levers;
  for (FrameLevers* levers : {&chain.preset, &chain.motion, &chain.weather, &chain.policy, &chain.drawn}) {
    *levers = {number(), number(), number(), number(), number(), number(),
               number(), number(), number(), number(), number(), {}};
    if (random() % 2)
      levers->occlusion =
          OcclusionResolution{1 + static_cast<int>(random() % 4096), static_cast<int>(random() % 4096)};
  }
  anyMotion(random, row.before, d);
  anyWeather(random, d.weather);
  anyPolicy(random, row);
  if (random() % 2) {
    row.frame = TraceFrame{
        {random(), random(), random(), random(), random(), random(), random(), random(), random()}, {}};
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
  EXPECT_EQ(a.input.drawn, b.input.drawn);
  for (std::size_t i = 0; i < kSignals; ++i) {
    const double x = a.input.signalValues.value[i], y = b.input.signalValues.value[i];
    EXPECT_TRUE((std::isnan(x) && std::isnan(y)) || sameBits(x, y)) << kSignalRows[i].key;
  }
  EXPECT_EQ(a.before, b.before);
  EXPECT_EQ(a.decision, b.decision);
  EXPECT_EQ(a.levers, b.levers);
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
  TuningParameters weather = kDefaults;
  weather.weather.source = WeatherSource::host;
  weather.rainMedium.farStretch = Ratio{1.7};
  for (const TuningParameters& p : {kDefaults, aboveGround, weather}) {
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

TEST(Trace, findsTheRowsThatOtherParametersDecideOtherwise) {
  std::vector<TraceRow> rows = recorded(defaultParameters());
  rows[10].decision.totalMembership = std::nextafter(rows[10].decision.totalMembership, 3);
  const std::vector<TraceDifference> differences = decideAgain(rows, defaultParameters());
  ASSERT_EQ(differences.size(), 1u);
  EXPECT_EQ(differences[0].row, 10u);
}

TEST(TraceFile, writesWhatReadTraceReads) {
  test::ScratchDir dir;
  std::mt19937_64 random(12);
  const TraceRow row = anyRow(random);
  Result<TraceFile> file = TraceFile::open(dir / "trace.csv");
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->write(std::vector<TraceRow>(2, row)) && file->finish());
  const Result<std::vector<TraceRow>> read = readTrace(dir / "trace.csv");
  ASSERT_TRUE(read.ok()) << toString(read.findings());
  ASSERT_EQ(read->size(), 2u);
  expectSame(row, read->at(1));
}

TEST(TraceFile, keepsTheOldFileUntilTheNewOneIsWhole) {
  test::ScratchDir dir;
  const std::filesystem::path file = dir / "trace.csv", part = dir / "trace.csv.part";
  test::writeFile(file, "the old one");
  Result<TraceFile> trace = TraceFile::open(file);
  ASSERT_TRUE(trace) << toString(trace.findings());
  std::mt19937_64 random(12);
  const std::vector<TraceRow> rows(2, anyRow(random));
  ASSERT_TRUE(trace->write(rows));
  EXPECT_EQ(test::readFile(file), "the old one");
  EXPECT_EQ(readTrace(part)->size(), 2u) << "a crash leaves it";
  ASSERT_TRUE(trace->finish());
  EXPECT_EQ(readTrace(file)->size(), 2u);
  EXPECT_FALSE(std::filesystem::exists(part));
}

TEST(TraceFile, refusesToWriteOverATraceThatWasCutOff) {
  test::ScratchDir dir;
  const std::filesystem::path file = dir / "trace.csv", part = dir / "trace.csv.part";
  const std::string rows = traceHeader() + "\n1,2";
  test::writeFile(part, rows);
  const Result<TraceFile> trace = TraceFile::open(file);
  EXPECT_FALSE(trace);
  EXPECT_NE(toString(trace.findings()).find("trace.csv.part"), std::string::npos);
  EXPECT_EQ(test::readFile(part), rows);
  test::writeFile(part, traceHeader() + "\n");
  EXPECT_TRUE(TraceFile::open(file)) << "nothing is lost with a header";
  std::filesystem::create_directory(dir / "folder");
  for (const std::filesystem::path& no : {dir / "folder", std::filesystem::path("/dev/null")})
    EXPECT_FALSE(TraceFile::open(no)) << no;
}

TEST(TraceFile, keepsTheWholeRowsWhenTheDiskIsFull) {
  test::ScratchDir dir;
  // As on a full disk, no more than that can be written.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  failLargeWrites();
  rlimit most = before;
  most.rlim_cur = 30000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &most), 0);
  Result<TraceFile> trace = TraceFile::open(dir / "trace.csv");
  std::mt19937_64 random(3);
  const std::vector<TraceRow> rows(100, anyRow(random));
  const Result<Done> written = trace->write(rows), again = trace->write(rows);
  const Result<Done> done = trace->finish();
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_NE(toString(written.findings()).find("room for more rows"), std::string::npos);
  EXPECT_TRUE(again) << "it is said once";
  EXPECT_FALSE(done);
  EXPECT_NE(toString(done.findings()).find("trace.csv.part"), std::string::npos) << toString(done.findings());
  EXPECT_FALSE(std::filesystem::exists(dir / "trace.csv"));
  const Result<std::vector<TraceRow>> kept = readTrace(dir / "trace.csv.part");
  ASSERT_TRUE(kept) << toString(kept.findings());
  ASSERT_FALSE(kept->empty());
  expectSame(rows[0], kept->back());
}

TEST(TraceFile, isRefusedWhereThereIsNoFolder) {
  test::ScratchDir dir;
  EXPECT_FALSE(TraceFile::open(dir / "absent" / "trace.csv").ok());
  EXPECT_FALSE(readTrace(dir / "absent.csv").ok());
}

}  // namespace
}  // namespace trimtab
