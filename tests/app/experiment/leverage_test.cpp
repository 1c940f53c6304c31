#include "app/experiment/leverage.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "app/experiment/stage.h"
#include "tests/app/experiment/piece_of_terrain.h"
#include "tests/app/experiment/straight_flight.h"
#include "tests/core/scene/objects/objects_on.h"
#include "tests/support.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/synthetic/sample.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::experiment {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kFrames = 6;

/// A straight and level flight of ten seconds over a small piece of the sample terrain.
class LeverageTest : public test::PieceOfTerrain {
 protected:
  static experiment::Setup setup() {
    experiment::Setup setup = PieceOfTerrain::setup();
    setup.frames = kFrames;
    setup.flight = test::straightFlight(*terrain_, 0.3, 10);
    return setup;
  }

  static const LeverageRow& rowFor(const Leverage& leverage, Lever lever) {
    for (const LeverageRow& row : leverage.rows)
      if (row.lever == lever) return row;
    throw std::logic_error("a lever has no row");
  }
};

TEST_F(LeverageTest, measuresEachLeverFromOneEndOfItsUsualRangeToTheOther) {
  experiment::Setup s = setup();
  s.terrain = std::make_shared<const test::ObjectsOn>(s.terrain, test::scattered(*s.terrain, 2000, 6, 8, 3));
  const auto leverage = measureLeverage(s);
  ASSERT_TRUE(leverage) << toString(leverage.findings());
  ASSERT_EQ(leverage->rows.size(), kLevers);
  std::set<Lever> seen;
  for (std::size_t i = 0; i < kLevers; ++i) {
    const LeverageRow& row = leverage->rows[i];
    const LeverRow& lever = rowOf(row.lever);
    SCOPED_TRACE(lever.key);
    seen.insert(row.lever);
    EXPECT_EQ(std::min(row.from.value, row.to.value), lever.usual.low);
    EXPECT_EQ(std::max(row.from.value, row.to.value), lever.usual.high);
    if (lever.larger == CostOf::rises) {
      EXPECT_GT(row.from.value, row.to.value) << "from the end that costs more";
    }
    EXPECT_GT(row.from.ms, 0);
    EXPECT_LE(row.wonMs.low, row.wonMs.median);
    EXPECT_GE(row.wonMs.high, row.wonMs.median);
    EXPECT_LE(row.wonPercent.low, row.wonPercent.median);
    EXPECT_GE(row.wonPercent.high, row.wonPercent.median);
    if (i > 0) {
      EXPECT_LE(row.wonMs.median, leverage->rows[i - 1].wonMs.median) << "sorted";
    }
  }
  EXPECT_EQ(seen.size(), kLevers);

  const LeverageRow& occlusion = rowFor(*leverage, Lever::occlusion);
  EXPECT_EQ(occlusion.flipLost.low, 0) << "culling changes no pixel";
  EXPECT_EQ(occlusion.flipLost.high, 0);
  EXPECT_EQ(occlusion.condition, "");
  for (const Lever lever : {Lever::screen_space_error, Lever::render_scale, Lever::particle_density,
                            Lever::far_distance, Lever::blur_strength})
    EXPECT_GT(rowFor(*leverage, lever).to.flipMedian + rowFor(*leverage, lever).from.flipMedian, 0)
        << rowOf(lever).key;
  EXPECT_GT(rowFor(*leverage, Lever::screen_space_error).flipLost.median, 0);
  EXPECT_GT(rowFor(*leverage, Lever::screen_space_error).geometricPxLost.median, 0);
  EXPECT_GT(rowFor(*leverage, Lever::render_scale).flipLost.median, 0);
  EXPECT_GT(rowFor(*leverage, Lever::object_distance).flipLost.median, 0);
  EXPECT_GT(rowFor(*leverage, Lever::small_feature).flipLost.median, 0);
  EXPECT_EQ(rowFor(*leverage, Lever::particle_density).condition, "medium rain");
  EXPECT_EQ(rowFor(*leverage, Lever::far_distance).condition, "fog, visibility 10 km");
  EXPECT_EQ(rowFor(*leverage, Lever::blur_strength).condition, "head sweeping at 180 deg/s");
  EXPECT_LT(rowFor(*leverage, Lever::blur_strength).flipLost.median, 0)
      << "blur is what costs, and the image without it is the sharp one";

  const auto read = parseLeverage(toJson(*leverage), "a test");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(toJson(*read), toJson(*leverage));
  EXPECT_EQ(read->rows[0].lever, leverage->rows[0].lever);
  EXPECT_EQ(read->rows[0].wonMs.high, leverage->rows[0].wonMs.high);

  const test::ScratchDir out;
  ASSERT_TRUE(writeLeverage(out.path(), *leverage));
  EXPECT_EQ(test::readFile(out / "leverage.json"), toJson(*leverage));
  EXPECT_THAT(test::readFile(out / "leverage.csv"),
              HasSubstr("lever,unit,condition,verdict,from,to,ms_from"));
  const std::string page = test::readFile(out / "leverage.html");
  for (const char* words :
       {"time won (ms a frame)", "image lost (FLIP", "Render scale", "16 px", "medium rain", "95 % interval"})
    EXPECT_THAT(page, HasSubstr(words));
  const Report report = toReport(*leverage);
  EXPECT_EQ(report.measured.rows.size(), kLevers);
  EXPECT_TRUE(report.published.rows.empty());
  EXPECT_THAT(toText(report), ::testing::Not(HasSubstr("published")));
}

TEST_F(LeverageTest, needsNoConditionWhereTheFlightHasWhatALeverIsFor) {
  experiment::Setup s = setup();
  s.frames = 1;
  s.parameters.weather.step = WeatherStep::snow_light;
  const auto leverage = measureLeverage(s);
  ASSERT_TRUE(leverage) << toString(leverage.findings());
  EXPECT_EQ(rowFor(*leverage, Lever::particle_density).condition, "");
  EXPECT_EQ(rowFor(*leverage, Lever::far_distance).condition, "");
  EXPECT_TRUE(std::isnan(leverage->rows[0].wonMs.low)) << "one frame has no interval";
  EXPECT_TRUE(std::isnan(leverage->rows[0].flipLostPerMs));
}

TEST(LeverageReport, saysWhetherALeverWinsTimeAndWhetherTheMachineWasBusy) {
  const auto rowOf = [](double low, double median, double high) {
    LeverageRow row;
    row.lever = Lever::render_scale;
    row.wonMs = {median, low, high};
    return row;
  };
  Leverage leverage;
  leverage.rows = {rowOf(0.5, 1, 2), rowOf(-0.1, 1, 2), rowOf(-2, -1, -0.5), rowOf(kNan, 1, kNan)};
  leverage.othersShare = 0.4;
  const Report report = toReport(leverage);
  for (const auto& [row, verdict] :
       {std::pair{0u, "wins time"}, {1u, "no difference"}, {2u, "loses time"}, {3u, "too few frames"}})
    EXPECT_EQ(report.measured.text(row, "verdict"), verdict);
  EXPECT_THAT(report.notes.back(), HasSubstr("other programs took 40 % of its processors"));
  const auto read = parseLeverage(toJson(leverage), "a test");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(read->othersShare, 0.4);
  EXPECT_EQ(toJson(*read), toJson(leverage));
  leverage.othersShare = 0.02;
  EXPECT_THAT(toText(toReport(leverage)), ::testing::Not(HasSubstr("busy")));
}

TEST_F(LeverageTest, leavesThePolicyOfThePresetOut) {
  experiment::Setup s = setup();
  s.parameters.policy.enabled = true;
  s.parameters.policy.rules.line = {"if altitude is any then lod_scale = 4, render_scale = 0.5"};
  const auto active = validate(s.parameters);
  ASSERT_TRUE(active) << toString(active.findings());
  EXPECT_EQ(momentsOf(s, *active, false)[0].request.levers.drawn.renderScale, 0.5) << "it would be there";
  s.repeats = 1;
  s.frames = 1;
  const auto with = measureLeverage(s), without = measureLeverage([] {
                                          experiment::Setup plain = setup();
                                          plain.frames = 1;
                                          return plain;
                                        }());
  ASSERT_TRUE(with && without);
  for (const Lever lever : {Lever::screen_space_error, Lever::render_scale}) {
    EXPECT_EQ(rowFor(*with, lever).from.flipMedian, rowFor(*without, lever).from.flipMedian);
    EXPECT_EQ(rowFor(*with, lever).to.flipMedian, rowFor(*without, lever).to.flipMedian);
  }
}

TEST_F(LeverageTest, setsALeverAsAPolicyWithThatTargetDoes) {
  experiment::Setup s = setup();
  s.frames = 3;
  s.parameters.weather.step = WeatherStep::rain_medium;
  const auto plain = validate(s.parameters);
  ASSERT_TRUE(plain);
  for (const LeverRow& lever : kLeverRows)
    for (const double value : {lever.usual.low, std::midpoint(lever.usual.low, lever.usual.high)}) {
      SCOPED_TRACE(std::string(lever.key) + " " + std::to_string(value));
      experiment::Setup other = s;
      other.parameters.policy.enabled = true;
      other.parameters.policy.rules.line = {"if altitude is any then " + std::string(lever.key) + " = " +
                                            std::to_string(value)};
      const auto valid = validate(other.parameters);
      ASSERT_TRUE(valid) << toString(valid.findings());
      const auto ours = momentsOf(s, *plain, true), theirs = momentsOf(other, *valid, true);
      ASSERT_EQ(ours.size(), 3u);
      for (std::size_t i = 0; i < ours.size(); ++i) {
        const FrameRequest set = withLever(ours[i].request, lever.lever, value, s.parameters);
        const FrameRequest& decided = theirs[i].request;
        EXPECT_EQ(set.levers, decided.levers);
        EXPECT_EQ(set.decision.weather, decided.decision.weather);
        EXPECT_EQ(set.decision.motion, decided.decision.motion);
        EXPECT_EQ(set.decision.scheme, decided.decision.scheme);
        EXPECT_EQ(set.decision.band, decided.decision.band);
        EXPECT_EQ(set.decision.occlusionResolution, decided.decision.occlusionResolution);
      }
    }
}

TEST_F(LeverageTest, noPixelDiffersWhereOnlyTheOcclusionMoves) {
  experiment::Setup s = setup();
  s.widthPx = 320;
  s.heightPx = 180;
  s.frames = 4;
  // Low in the valleys, where hills hide ground.
  for (AircraftState& state : s.flight->states) {
    const auto ground = terrain_->heightAt(state.position.latitude, state.position.longitude);
    state.position.height = *ground + Metres{5};
    state.attitude.pitch = Degrees{0};
  }
  auto stage = Stage::open(s);
  ASSERT_TRUE(stage) << toString(stage.findings());
  std::size_t compared = 0, hidden = 0;
  for (const OcclusionMethod method :
       {OcclusionMethod::depth_map, OcclusionMethod::horizon, OcclusionMethod::automatic}) {
    s.parameters.culling.occlusion = method;
    std::vector<std::vector<std::uint8_t>> first;
    // The policy moves the lever over its range, and nothing else.
    for (const double total : {0.0, 0.3, 0.7, 1.2, 1.7, 2.0}) {
      experiment::Setup moved = s;
      moved.parameters.policy.enabled = true;
      moved.parameters.policy.rules.line = {"if altitude is any then occlusion = " + std::to_string(total)};
      const auto valid = validate(moved.parameters);
      ASSERT_TRUE(valid) << toString(valid.findings());
      const std::vector<Moment> moments = momentsOf(moved, *valid, false);
      ASSERT_EQ(moments.size(), 4u);
      first.resize(moments.size());
      for (std::size_t i = 0; i < moments.size(); ++i) {
        ASSERT_EQ(moments[i].request.decision.scheme, total == 0 ? Scheme::frustum : Scheme::dynamic);
        FrameRequest request = moments[i].request;
        request.exactSlivers = true;
        hidden += (*stage)->draw(request).visible.occluded;
        const std::vector<std::uint8_t> pixels = (*stage)->shown();
        if (total == 0) first[i] = pixels;
        EXPECT_EQ(differingPixels(first[i], pixels), 0u) << total << ", moment " << i;
        ++compared;
      }
    }
  }
  EXPECT_GT(hidden, 0u) << "or nothing is shown";
  std::printf("%zu images, %zu nodes hidden, 0 pixels differ\n", compared, hidden);
}

TEST_F(LeverageTest, canBeCancelledAndSaysWhatItLacks) {
  experiment::Setup s = setup();
  s.progress = [](double, const std::string&) { return false; };
  const auto stopped = measureLeverage(s);
  ASSERT_FALSE(stopped);
  EXPECT_THAT(toString(stopped.findings()), HasSubstr("cancelled"));
  s = setup();
  s.flight->states.clear();
  EXPECT_FALSE(measureLeverage(s));
  s = setup();
  for (AircraftState& state : s.flight->states)
    state.position.latitude = state.position.latitude + Degrees{20};
  const auto elsewhere = measureLeverage(s);
  ASSERT_FALSE(elsewhere);
  EXPECT_THAT(toString(elsewhere.findings()), HasSubstr("over the terrain"));
  for (const char* bad : {"", "{}", R"({"leverage": [{"lever": "volume"}]})"}) {
    const auto read = parseLeverage(bad, "a file");
    ASSERT_FALSE(read);
    EXPECT_THAT(toString(read.findings()), HasSubstr("a file"));
  }
}

}  // namespace
}  // namespace trimtab::experiment
