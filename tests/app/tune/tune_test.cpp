#include "app/tune/tune.h"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "app/tune/verdict.h"
#include "tests/app/harness/mountain_plan.h"
#include "tests/core/scene/foreign/paged_scene.h"
#include "trimtab/preset/preset.h"
#include "trimtab/scene/osg_database.h"

/// Whole runs over a small terrain.
namespace trimtab::tune {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The second half of the flight is held out.
Plan smallTunePlan() {
  Plan plan;
  plan.terrain = harness::hills();
  plan.terrainName = "mountains";
  const Flight flight = harness::mountainFlight();
  const auto half = flight.states.begin() + 30;
  plan.flights = {{"first", {"first", {flight.states.begin(), half}}}};
  plan.heldOut = {{"second", {"second", {half, flight.states.end()}}}};
  plan.free = {"lod.screen_space_error_px", "lod.scale"};
  plan.widthPx = 160;
  plan.heightPx = 96;
  plan.drawnRows = 3;
  plan.evaluations = 400;
  plan.points = 2;
  plan.frames = 3;
  plan.repeats = 1;
  plan.version = "test";
  return plan;
}

std::string searchOf(const fs::path& folder, int search = 0) {
  return test::readFile(folder / ("search-" + std::to_string(search) + ".json"));
}

TEST(Tune, findsPresetsAndSaysWhatTheyAreWorth) {
  const test::ScratchDir dir;
  Plan plan = smallTunePlan();
  plan.maxError = 0.02;
  double told = 0;
  plan.progress = [&](double fraction, const std::string&) {
    EXPECT_GE(fraction, told - 1e-9);
    told = fraction;
    return true;
  };
  const auto outcome = run(plan, dir / "out");
  ASSERT_TRUE(outcome) << toString(outcome.findings());
  EXPECT_THAT(outcome->answer, HasSubstr("not seen: "));
  EXPECT_THAT(outcome->answer, HasSubstr("median ")) << "three frames have no 95th percentile";
  EXPECT_THAT(outcome->answer, testing::Not(HasSubstr("nan")));
  std::size_t found = 0;
  for (const Tuned& preset : outcome->presets) {
    ASSERT_EQ(preset.measured.size(), 2u) << preset.name << ": the flight that was seen, and the other";
    EXPECT_GT(preset.measured[0].medianMs, 0);
    if (preset.role != Role::found) continue;
    ++found;
    const auto file = loadPreset((dir / "out" / "presets" / (preset.name + ".json")).string());
    ASSERT_TRUE(file) << toString(file.findings());
    EXPECT_THAT(differences(file->parameters, *preset.parameters), testing::IsEmpty());
    EXPECT_FALSE(preset.moved.empty());
  }
  EXPECT_GT(found, 0u);
  EXPECT_GE(outcome->presets.size(), found + 3) << "the start, one parameter, and random ones";
  EXPECT_TRUE(std::any_of(outcome->presets.begin(), outcome->presets.end(),
                          [](const Tuned& t) { return t.onFront; }));
  EXPECT_THAT(test::readFile(dir / "out" / "tune.html"), HasSubstr("tuned-1"));
  EXPECT_NEAR(told, 1, 0.01);
}

TEST(Tune, aRunThatWasStoppedComesToTheSamePresets) {
  const test::ScratchDir dir;
  Plan plan = smallTunePlan();
  plan.searches = 2;
  const auto whole = run(plan, dir / "whole");
  ASSERT_TRUE(whole) << toString(whole.findings());
  // Samples are times, which no second run repeats: what follows from them does.
  fs::create_directory(dir / "stopped");
  for (const char* name : {"tune-plan.json", "samples-0.json", "samples-1.json"})
    fs::copy_file(dir / "whole" / name, dir / "stopped" / name);
  int calls = 0;
  plan.progress = [&](double, const std::string& what) {
    return !(what.starts_with("search 2") && ++calls > 3);
  };
  const auto stopped = run(plan, dir / "stopped");
  ASSERT_FALSE(stopped);
  EXPECT_THAT(toString(stopped.findings()), HasSubstr("goes on"));
  EXPECT_TRUE(fs::exists(dir / "stopped" / "search-0.json"));
  EXPECT_FALSE(fs::exists(dir / "stopped" / "search-1.json"));
  plan.progress = nullptr;
  const auto resumed = run(plan, dir / "stopped");
  ASSERT_TRUE(resumed) << toString(resumed.findings());
  for (int s = 0; s < 2; ++s) EXPECT_EQ(searchOf(dir / "stopped", s), searchOf(dir / "whole", s));
  EXPECT_NE(searchOf(dir / "whole", 0), searchOf(dir / "whole", 1)) << "seeds of their own";
}

/// A program that is paused waits in its progress.
TEST(Tune, theTimeOfASearchHasNoPauseInIt) {
  const test::ScratchDir dir;
  Plan plan = smallTunePlan();
  double pausedS = 0;
  plan.progress = [&](double, const std::string& what) {
    const bool search = what.starts_with("search"), counting = what.starts_with("counting");
    if (search || counting) std::this_thread::sleep_for(std::chrono::milliseconds(search ? 500 : 2000));
    if (search) pausedS += 0.5;
    return true;
  };
  const auto outcome = run(plan, dir / "out");
  ASSERT_TRUE(outcome) << toString(outcome.findings());
  EXPECT_GT(pausedS, 0);
  EXPECT_LT(outcome->searchS, pausedS);
  EXPECT_LT(outcome->buildS, 4) << "two flights were counted";
}

TEST(Tune, partsDoTogetherWhatOneProcessDoes) {
  const test::ScratchDir dir;
  Plan plan = smallTunePlan();
  plan.searches = 3;
  plan.maxError = 0.02;
  const auto whole = run(plan, dir / "whole");
  ASSERT_TRUE(whole) << toString(whole.findings());
  fs::create_directory(dir / "parts");
  for (const char* name : {"tune-plan.json", "samples-0.json", "samples-1.json"})
    fs::copy_file(dir / "whole" / name, dir / "parts" / name);
  std::vector<std::string> notes;
  std::string answer;
  // Samples are there; searches, frames to try out and frames to measure come, each in two parts.
  for (int step = 0; step < 3; ++step)
    for (std::size_t i : {std::size_t{1}, std::size_t{0}}) {
      plan.part = harness::Plan::Part{i, 2};
      const auto outcome = run(plan, dir / "parts");
      ASSERT_TRUE(outcome) << toString(outcome.findings());
      if (!outcome->answer.empty()) answer = outcome->answer;
      if (!outcome->notes.empty()) notes.push_back(outcome->notes.back());
    }
  for (int s = 0; s < 3; ++s) EXPECT_EQ(searchOf(dir / "parts", s), searchOf(dir / "whole", s));
  EXPECT_FALSE(answer.empty()) << "the last part joins";
  EXPECT_THAT(notes.front(), HasSubstr("search-0.json is missing")) << "the other part's";
  EXPECT_TRUE(fs::exists(dir / "parts" / "tune.html"));
}

TEST(Tune, refusesBeforeHoursAreSpent) {
  const test::ScratchDir dir;
  bool drawn = false;
  const auto refusal = [&](const std::function<void(Plan&)>& edit) {
    Plan plan = smallTunePlan();
    plan.progress = [&](double, const std::string& what) {
      drawn = drawn || what.starts_with("drawing");
      return true;
    };
    edit(plan);
    const auto outcome = run(plan, dir / "refused");
    return outcome ? std::string() : toString(outcome.findings());
  };
  EXPECT_THAT(refusal([](Plan& p) { p.free.clear(); }), HasSubstr("at least one parameter"));
  EXPECT_THAT(refusal([](Plan& p) { p.flights.clear(); }), HasSubstr("--flight"));
  EXPECT_THAT(refusal([](Plan& p) { p.heldOut = p.flights; }), HasSubstr("was not seen"));
  EXPECT_THAT(refusal([](Plan& p) { p.maxError = 1.5; }), HasSubstr("a mean FLIP above 0 and at most 1"));
  EXPECT_THAT(refusal([](Plan& p) { p.error = ErrorKind::geometric, p.maxError = 40; }),
              HasSubstr("a largest geometric error above 0 and at most 32"));
  EXPECT_THAT(refusal([](Plan& p) { p.error = ErrorKind::pop; }), HasSubstr("at least 20"));
  EXPECT_THAT(refusal([](Plan& p) { p.heldOut[0].name = p.flights[0].name; }), HasSubstr("first twice"));
  EXPECT_THAT(refusal([](Plan& p) { p.heldOut[0].flight.states = p.flights[0].flight.states; }),
              HasSubstr("second, which flies as first does"));
  EXPECT_THAT(refusal([](Plan& p) { p.free = {"lod.scale=2..3"}; }), HasSubstr("where the preset is, 1"));
  EXPECT_THAT(refusal([](Plan& p) { p.budgetMs = 1e-3; }), HasSubstr("--budget-ms: expected 0.1 to 1000 ms"));
  for (const bool heldOut : {false, true})
    EXPECT_THAT(refusal([&](Plan& p) {
                  for (AircraftState& state : (heldOut ? p.heldOut : p.flights)[0].flight.states)
                    state.position.latitude = Degrees{-40};
                }),
                HasSubstr(std::string(heldOut ? "--hold-out: second" : "--flight: first") +
                          ": expected a flight over the terrain mountains"));
  EXPECT_FALSE(drawn);
  EXPECT_FALSE(fs::exists(dir / "refused")) << "it would not take the plan that is mended";

  // What an image without ground takes is known once a flight's samples are drawn.
  std::string doing;
  EXPECT_THAT(refusal([&](Plan& p) {
                p.budgetMs = 0.1;
                p.widthPx = 640, p.heightPx = 360;
                p.progress = [&](double, const std::string& what) {
                  doing = what;
                  return true;
                };
              }),
              HasSubstr("more than an image without ground takes"));
  EXPECT_EQ(doing, "drawing samples of first") << "the other flight is not drawn";
}

TEST(Tune, refusesASceneWhoseLevelsNobodyCanCount) {
  const test::ScratchDir dir;
  const test::PagedScene scene(*harness::hills(), dir.path(), ".osgb", true);
  const auto opened = scene::OsgDatabase::open(scene.file(), {});
  ASSERT_TRUE(opened) << toString(opened.findings());
  Plan plan = smallTunePlan();
  plan.terrain = *opened;
  plan.terrainName = "paged.osgb";
  const auto refused = run(plan, dir / "out");
  ASSERT_FALSE(refused);
  EXPECT_THAT(toString(refused.findings()), HasSubstr("whose levels can be counted"));
  EXPECT_THAT(toString(refused.findings()), HasSubstr("paged.osgb"));
  EXPECT_FALSE(fs::exists(dir / "out"));
}

TEST(Tune, aFolderOfAnotherPlanIsNamedAndKept) {
  const test::ScratchDir dir;
  const Plan plan = smallTunePlan();
  ASSERT_TRUE(run(plan, dir / "out"));
  const std::string before = searchOf(dir / "out");
  Plan other = plan;
  other.seed = 2;
  const auto refused = run(other, dir / "out");
  ASSERT_FALSE(refused);
  EXPECT_THAT(toString(refused.findings()), HasSubstr("seed"));
  other = plan;
  other.version = "newer";
  EXPECT_THAT(
      toString(run(other, dir / "out").findings()),
      HasSubstr("version: expected what this folder was made with, test (or another folder), found newer"));
  EXPECT_EQ(searchOf(dir / "out"), before);
  fs::create_directory(dir / "notes");
  test::writeFile(dir / "notes" / "tune.html", "mine");
  const auto full = run(plan, dir / "notes");
  ASSERT_FALSE(full);
  EXPECT_THAT(toString(full.findings()), HasSubstr("a new folder"));
}

TEST(Tune, aPresetThatASearchFoundIsOneToStartFrom) {
  const test::ScratchDir dir;
  Plan plan = smallTunePlan();
  TuningParameters found = *plan.start;
  found.lod.scale = Ratio{2};
  plan.start = *validate(found);
  for (const char* name : {"tuned-1", "default"}) {
    plan.startName = name;
    const auto outcome = run(plan, dir / name);
    ASSERT_TRUE(outcome) << toString(outcome.findings());
    EXPECT_EQ(outcome->presets.front().name, std::string(name) + " (start)");
    EXPECT_EQ(outcome->presets[1].name, "default");
    EXPECT_THAT(outcome->answer, HasSubstr("on the front of time against error"));
  }
}

TEST(Tune, whatIsNotKeptOnAHeldOutFlightIsNotSaidToBe) {
  Plan plan = smallTunePlan();
  plan.budgetMs = 10;
  std::vector<Tuned> presets(2);
  const auto measure = [](Tuned& preset, double seenMs, double heldOutMs) {
    for (const double ms : {seenMs, heldOutMs}) {
      harness::AnswerRow row;
      row.medianMs = row.p95Ms = ms;
      row.flip = 0.01;
      preset.measured.push_back(row);
    }
  };
  presets[0].name = "start", presets[1].name = "found";
  measure(presets[0], 20, 20);
  measure(presets[1], 9, 9.5);
  EXPECT_THAT(answerOf(plan, presets),
              HasSubstr("Within 10 ms on flights that the search has not seen: preset found"));
  presets[1].measured[1].p95Ms = 12;
  EXPECT_THAT(answerOf(plan, presets),
              HasSubstr("but not on those that it has not seen: there preset found, p95 12"));
  presets[1].measured[0].p95Ms = 11;
  EXPECT_THAT(answerOf(plan, presets), HasSubstr("no preset that was drawn"));
}

TEST(Tune, theErrorThatWasChosenDecidesAndIsSaid) {
  Plan plan = smallTunePlan();
  std::vector<Tuned> presets(3);
  const auto measure = [&](Tuned& preset, const char* name, double ms, double flip, double px, double pop) {
    preset.name = name;
    for (int flight = 0; flight < 2; ++flight) {
      harness::AnswerRow row;
      row.medianMs = row.p95Ms = ms;
      row.flip = flip, row.geometricPx = px, row.pop = pop;
      preset.measured.push_back(row);
    }
  };
  measure(presets[0], "start", 20, 0.01, 1, 1);
  measure(presets[1], "near", 9, 0.03, 2.5, 5);
  measure(presets[2], "calm", 9, 0.02, 7.5, 2);
  const auto answer = [&](ErrorKind kind) {
    plan.error = kind;
    return answerOf(plan, presets);
  };
  plan.budgetMs = 10;
  EXPECT_THAT(answer(ErrorKind::flip), HasSubstr("preset calm, p95 9 ms (0 to 0), FLIP 0.02; start"));
  EXPECT_THAT(answer(ErrorKind::geometric), HasSubstr("preset near, p95 9 ms (0 to 0), 2.5 px; start"));
  EXPECT_THAT(answer(ErrorKind::pop), HasSubstr("preset calm, p95 9 ms (0 to 0), pop 2 of 255; start"));
  plan.budgetMs.reset();
  plan.maxError = 3;
  EXPECT_THAT(
      answer(ErrorKind::geometric),
      HasSubstr(
          "Within a largest geometric error of 3 px on flights that the search has not seen: preset near"));
  EXPECT_THAT(answer(ErrorKind::pop), HasSubstr("Within a 95th percentile of pops of 3 of 255"));
  EXPECT_THAT(answer(ErrorKind::pop), HasSubstr("preset calm"));
  plan.error = ErrorKind::geometric;
  markFront(plan, presets);
  EXPECT_TRUE(presets[1].onFront);
  EXPECT_FALSE(presets[2].onFront) << "another is as quick and has less error";
}

TEST(Tune, aGeometricErrorIsSearchedAndReported) {
  const test::ScratchDir dir;
  Plan plan = smallTunePlan();
  plan.error = ErrorKind::geometric;
  const auto outcome = run(plan, dir / "out");
  ASSERT_TRUE(outcome) << toString(outcome.findings());
  const experiment::Report report = toReport(plan, *outcome);
  EXPECT_EQ(report.plots.front().yLabel, "largest geometric error");
  std::size_t wide = 0;
  for (std::size_t row = 0; row < report.measured.rows.size(); ++row)
    for (const auto& [name, low, high] :
         {std::tuple{"estimated_geometric_px", "estimated_geometric_low_px", "estimated_geometric_high_px"},
          std::tuple{"estimated_p95_ms", "estimated_p95_low_ms", "estimated_p95_high_ms"}}) {
      const double estimate = report.measured.number(row, name);
      EXPECT_LE(report.measured.number(row, low), estimate) << name;
      EXPECT_GE(report.measured.number(row, high), estimate) << name;
      wide += report.measured.number(row, high) > report.measured.number(row, low);
    }
  EXPECT_GT(wide, report.measured.rows.size()) << "of all times, and of some errors";
  // Its samples say nothing of another error.
  plan.error = ErrorKind::flip;
  const auto refused = run(plan, dir / "out");
  ASSERT_FALSE(refused);
  EXPECT_THAT(toString(refused.findings()), HasSubstr("error"));
}

TEST(Tune, withoutAHeldOutFlightItSaysThatNothingIsProven) {
  const test::ScratchDir dir;
  Plan plan = smallTunePlan();
  plan.heldOut.clear();
  const auto outcome = run(plan, dir / "out");
  ASSERT_TRUE(outcome) << toString(outcome.findings());
  EXPECT_THAT(outcome->answer, HasSubstr("nothing is proven"));
}

}  // namespace
}  // namespace trimtab::tune
