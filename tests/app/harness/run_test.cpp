#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <thread>

#include "app/harness/heat_colour.h"
#include "mountain_plan.h"
#include "tests/core/scene/foreign/paged_scene.h"
#include "trimtab/host/flight.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/session/session.h"

namespace trimtab::harness {
namespace {

namespace fs = std::filesystem;

/// Everything that must repeat: all but the times.
std::string withoutTimes(const Results& results) {
  std::string text;
  for (const Unit& unit : results.units) {
    text += unit.name.flight + ' ' + unit.name.preset + ' ' + unit.name.method + '\n';
    for (const MeasuredFrame& frame : unit.frames) {
      text += std::to_string(frame.row);
      for (const Quantity& quantity : quantities())
        if (quantity.kind != Quantity::Kind::cost) {
          const double value = quantity.of(frame);
          text += ' ' + std::string(quantity.key) + '=' +
                  (std::isnan(value) ? "nan" : std::to_string(std::bit_cast<std::uint64_t>(value)));
        }
      text += '\n';
    }
  }
  return text;
}

std::map<std::string, fs::file_time_type> partsOf(const fs::path& folder) {
  std::map<std::string, fs::file_time_type> parts;
  for (const auto& entry : fs::directory_iterator(folder / "parts"))
    parts[entry.path().filename().string()] = entry.last_write_time();
  return parts;
}

/// A program that is paused waits in its progress.
TEST(Run, theTimeLeftHasNoPauseInIt) {
  using Seconds = std::chrono::duration<double>;
  const test::ScratchDir dir;
  Plan plan = smallPlan();
  constexpr std::chrono::milliseconds kPause{100};
  Seconds paused{0};
  double longestS = 0;
  plan.progress = [&](double, const std::string& what) {
    if (const std::size_t at = what.find("about "); at != std::string::npos)
      longestS = std::max(longestS, std::stod(what.substr(at + 6)));
    const auto asked = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(kPause);
    paused += std::chrono::steady_clock::now() - asked;
    return true;
  };
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(run(plan, dir / "out"));
  const Seconds all = std::chrono::steady_clock::now() - begin;
  EXPECT_GT(longestS, 0);
  EXPECT_LT(longestS, (all - paused / 2).count()) << "paused for " << paused.count() << " s";
}

TEST(Run, measuresEveryPresetAndCaseOnTheSameRows) {
  const test::ScratchDir dir;
  Plan plan = smallPlan();
  std::vector<double> told;
  plan.progress = [&](double fraction, const std::string&) {
    told.push_back(fraction);
    return true;
  };
  const auto results = run(plan, dir / "out");
  ASSERT_TRUE(results) << toString(results.findings());
  ASSERT_EQ(results->units.size(), 6u);
  for (const Unit& unit : results->units) {
    EXPECT_EQ(unit.framesDecided, 60u);
    ASSERT_EQ(unit.frames.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const MeasuredFrame& frame = unit.frames[i];
      EXPECT_EQ(frame.row, (2 * i + 1) * 60 / 8) << "evenly spread";
      EXPECT_EQ(frame.timeS, static_cast<double>(frame.row) * 0.5);
      EXPECT_EQ(frame.repeatsMs.size(), 2u);
      EXPECT_GT(frame.cost.total, 0);
      EXPECT_GT(frame.cost.decide, 0);
      EXPECT_GT(frame.counts.triangles, 0u);
      EXPECT_EQ(frame.error.wronglyCulledPixels, 0u);
      EXPECT_TRUE(std::isfinite(frame.error.pop)) << "the flight's row before is the frame before";
    }
    EXPECT_FALSE(unit.worst.empty());
    for (const WorstFrame& worst : unit.worst)
      for (const std::string& file : {worst.reference, worst.ours, worst.difference})
        EXPECT_GT(test::readFile(dir / "out" / file).size(), 100u) << file;
  }
  // What is drawn where culling never changes a pixel, and what a coarser preset costs the picture.
  const Unit &none = unitOf(*results, "default", "none"),
             &frustum = unitOf(*results, "default", "view_frustum"),
             &coarse = unitOf(*results, "coarse", "none");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(none.frames[i].error.flip, frustum.frames[i].error.flip);
    EXPECT_LT(frustum.frames[i].counts.triangles, none.frames[i].counts.triangles);
    EXPECT_LT(coarse.frames[i].counts.triangles, none.frames[i].counts.triangles);
  }
  EXPECT_GT(summarise(coarse, *quantityOf("flip")).mean, summarise(none, *quantityOf("flip")).mean);
  EXPECT_EQ(results->comparisons.size(), 3u + 4u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1);

  const auto read = parseResults(test::readFile(dir / "out" / "results.json"), "results.json");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(toJson(*read), toJson(*results));
  EXPECT_EQ(test::readFile(dir / "out" / "frames.csv"), toCsv(*results));
}

TEST(Run, measuresTheRowsThatItIsGiven) {
  const test::ScratchDir dir;
  Plan plan = smallPlan();
  plan.rows = {{3, 20}};
  const auto results = run(plan, dir / "out");
  ASSERT_TRUE(results) << toString(results.findings());
  ASSERT_EQ(results->units.front().frames.size(), 2u);
  EXPECT_EQ(results->units.front().frames[0].row, 3u);
  EXPECT_EQ(results->units.front().frames[1].row, 20u);
  plan.rows = {{3, 21}};
  const auto other = run(plan, dir / "out");
  EXPECT_FALSE(other);
  EXPECT_THAT(toString(other.findings()), testing::HasSubstr("rows 3 20"));
  plan.rows = {{3}, {4}};
  EXPECT_FALSE(run(plan, dir / "two")) << "of a flight that is not there";
}

TEST(Run, givesTheSameErrorsAndCountsInAnotherFolderAndWithOtherRepeats) {
  const test::ScratchDir dir;
  Plan plan = smallPlan();
  plan.frames = 2;
  const auto once = run(plan, dir / "a");
  plan.repeats = 3;
  plan.skips = true;
  const auto again = run(plan, dir / "b");
  ASSERT_TRUE(once && again) << toString(once.findings()) << toString(again.findings());
  EXPECT_EQ(withoutTimes(*once), withoutTimes(*again));
  EXPECT_FALSE(again->units.front().skips.empty());
}

TEST(Run, saysThatCasesAreOneImageOverAnOsgScene) {
  const test::ScratchDir dir;
  const test::PagedScene scene(*hills(), dir.path(), ".osgb", true);
  const auto opened = scene::OsgDatabase::open(scene.file(), {});
  ASSERT_TRUE(opened) << toString(opened.findings());
  Plan plan = smallPlan();
  const auto said = [](const Results& results) {
    for (const std::string& note : results.notes)
      if (note.find("draw the same image") != std::string::npos) return true;
    return false;
  };
  plan.presets.pop_back();
  plan.frames = 1;
  plan.worst = 0;
  const auto ours = run(plan, dir / "ours");
  ASSERT_TRUE(ours) << toString(ours.findings());
  EXPECT_FALSE(said(*ours));
  plan.terrain = *opened;
  const auto theirs = run(plan, dir / "theirs");
  ASSERT_TRUE(theirs) << toString(theirs.findings());
  EXPECT_TRUE(said(*theirs));
  ASSERT_EQ(theirs->units.size(), 3u);
  for (const Unit& unit : theirs->units) {
    EXPECT_EQ(unit.frames[0].counts.triangles, theirs->units[0].frames[0].counts.triangles);
    EXPECT_EQ(unit.frames[0].error.flip, theirs->units[0].frames[0].error.flip);
  }
  plan.terrain = hills();
  const auto refused = run(plan, dir / "theirs");
  EXPECT_NE(toString(refused.findings()).find("a scene of OpenSceneGraph"), std::string::npos);
}

TEST(Run, goesOnWhereItWasCancelled) {
  const test::ScratchDir dir;
  const auto whole = run(smallPlan(), dir / "whole");
  ASSERT_TRUE(whole) << toString(whole.findings());
  Plan plan = smallPlan();
  plan.progress = [](double fraction, const std::string&) { return fraction < 0.5; };
  const auto cancelled = run(plan, dir / "out");
  ASSERT_FALSE(cancelled);
  EXPECT_NE(toString(cancelled.findings()).find("2 of 4 frames"), std::string::npos)
      << toString(cancelled.findings());
  const auto before = partsOf(dir / "out");
  EXPECT_EQ(before.size(), 2u);
  EXPECT_FALSE(fs::exists(dir / "out" / "results.json"));
  plan.progress = {};
  const auto rest = run(plan, dir / "out");
  ASSERT_TRUE(rest) << toString(rest.findings());
  EXPECT_EQ(withoutTimes(*rest), withoutTimes(*whole));
  const auto after = partsOf(dir / "out");
  EXPECT_EQ(after.size(), 4u);
  for (const auto& [name, time] : before) EXPECT_EQ(after.at(name), time) << name << " was measured again";
  // Once whole, nothing is measured again.
  const auto once = run(plan, dir / "out");
  ASSERT_TRUE(once);
  EXPECT_EQ(partsOf(dir / "out"), after);
  EXPECT_EQ(toJson(*once), toJson(*rest));
}

TEST(Run, measuresAgainAPartThatIsNotWhole) {
  const test::ScratchDir dir;
  const auto whole = run(smallPlan(), dir / "out");
  ASSERT_TRUE(whole);
  const std::string part = partsOf(dir / "out").begin()->first,
                    text = test::readFile(dir / "out" / "parts" / part);
  test::writeFile(dir / "out" / "parts" / part, text.substr(0, text.size() / 2));
  const auto again = run(smallPlan(), dir / "out");
  ASSERT_TRUE(again) << toString(again.findings());
  EXPECT_EQ(withoutTimes(*again), withoutTimes(*whole));
}

TEST(Run, refusesTheFolderOfAnotherPlanAndSaysWhatDiffers) {
  const test::ScratchDir dir;
  Plan plan = smallPlan();
  plan.frames = 1;
  ASSERT_TRUE(run(plan, dir / "out"));
  plan.widthPx = 128;
  TuningParameters other = *plan.presets[1].parameters;
  other.lod.screenSpaceError = Pixels{8};
  plan.presets[1].parameters = *validate(other);
  const auto refused = run(plan, dir / "out");
  ASSERT_FALSE(refused);
  std::set<std::string> keys;
  for (const Finding& finding : refused.findings()) {
    EXPECT_EQ(finding.where, (dir / "out" / "plan.json").string());
    keys.insert(finding.key);
  }
  EXPECT_EQ(keys, (std::set<std::string>{"size", "presets"})) << toString(refused.findings());
  EXPECT_NE(toString(refused.findings()).find("96x64"), std::string::npos);
  EXPECT_NE(toString(refused.findings()).find("128x64"), std::string::npos);
}

TEST(Run, refusesWhatItCannotMeasure) {
  const test::ScratchDir dir;
  const auto said = [&dir](const Plan& plan) {
    const auto results = run(plan, dir / "out");
    return results ? std::string() : toString(results.findings());
  };
  Plan plan = smallPlan();
  plan.flights[0].flight.states.resize(3);
  for (AircraftState& state : plan.flights[0].flight.states) state.position.latitude = Degrees{10};
  EXPECT_NE(said(plan).find("one: expected a flight over the terrain mountains, found none of its 3 rows"),
            std::string::npos)
      << said(plan);
  plan = smallPlan();
  plan.cases.clear();
  plan.presets.clear();
  EXPECT_NE(said(plan).find("cases"), std::string::npos);
  EXPECT_NE(said(plan).find("presets"), std::string::npos);
  plan = smallPlan();
  plan.flights.push_back(plan.flights.front());
  EXPECT_NE(said(plan).find("one twice"), std::string::npos) << said(plan);
  // A folder with files of that name that no run of ours has left.
  fs::create_directories(dir / "mine");
  test::writeFile(dir / "mine" / "frames.csv", "precious");
  EXPECT_FALSE(run(smallPlan(), dir / "mine"));
  EXPECT_EQ(test::readFile(dir / "mine" / "frames.csv"), "precious");
  test::writeFile(dir / "file", "");
  EXPECT_FALSE(run(smallPlan(), dir / "file"));
}

TEST(HeatColour, growsLighterAllTheWay) {
  double before = -1;
  for (int i = 0; i <= 400; ++i) {
    const auto c = heatColour(i / 400.0);
    const auto linear = [](int v) { return std::pow(v / 255.0, 2.2); };
    const double luminance = 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
    // Channels are whole numbers.
    EXPECT_GE(luminance, before - 0.002) << i;
    before = luminance;
  }
  EXPECT_EQ(heatColour(std::nan("")), heatColour(0));
  EXPECT_EQ(heatColour(7), heatColour(1));
}

}  // namespace
}  // namespace trimtab::harness
