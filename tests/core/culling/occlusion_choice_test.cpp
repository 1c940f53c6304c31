#include "trimtab/culling/occlusion_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace trimtab {
namespace {

using Method = OcclusionChoice::Method;

constexpr OcclusionMethod kMethods[] = {OcclusionMethod::horizon, OcclusionMethod::depth_map};

/// What a machine takes for a frame, made up.
struct Machine {
  double fixedMs = 6, msPerTriangle = 6e-5;
  struct Way {
    double costMs = 0, firstMs = 0, share = 0;
  };
  std::vector<Way> ways;  ///< of kMethods

  OcclusionChoice::Outcome frame(Method method, bool first, double triangles) const {
    OcclusionChoice::Outcome o;
    Way way;
    for (std::size_t i = 0; i < std::size(kMethods); ++i)
      if (method == kMethods[i]) way = ways[i];
    o.hidden = static_cast<std::uint64_t>(way.share * triangles);
    o.drawn = static_cast<std::uint64_t>(triangles) - o.hidden;
    o.occlusionMs = first ? way.firstMs : way.costMs;
    o.drawMs = fixedMs + msPerTriangle * static_cast<double>(o.drawn);
    o.totalMs = o.drawMs + o.occlusionMs + 0.3;
    return o;
  }
};

struct PlannedFlight {
  int frames = 4000;
  double triangles = 180e3;
  double stepM = 5, turn = 0.01;  ///< a frame
  double noise = 0;               ///< of each time, share
  double roomMs = kInfinity;
  std::function<Machine(int)> machine;
  std::uint64_t (*rule)(int) = [](int) -> std::uint64_t { return 0; };
};

struct Total {
  double ms = 0, bestFixedMs = 1e300, noneMs = 0;
  std::uint64_t trials = 0;
  std::vector<Method> methods;
};

/// Flies with the choice, and with each fixed choice.
Total fly(const PlannedFlight& flight) {
  Total total;
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0, 1);
  OcclusionChoice choice;
  Method before;
  bool any = false;
  double clock = 0;
  for (int i = 0; i < flight.frames; ++i) {
    const Machine machine = flight.machine(i);
    const Method method = choice.choose({clock,
                                         {flight.stepM * i, 0, 0},
                                         {std::cos(flight.turn * i), std::sin(flight.turn * i), 0},
                                         flight.rule(i),
                                         kMethods,
                                         0,
                                         flight.roomMs});
    const auto truth = machine.frame(method, !any || method != before, flight.triangles);
    any = true;
    before = method;
    auto seen = truth;
    const double late = std::exp(flight.noise * normal(random));
    seen.drawMs *= late;
    seen.occlusionMs *= std::exp(flight.noise * normal(random));
    seen.totalMs = seen.drawMs + seen.occlusionMs + 0.3;
    choice.learn(seen);
    total.ms += truth.totalMs;
    clock += truth.totalMs;
    total.methods.push_back(method);
  }
  total.trials = choice.trials();
  for (std::size_t fixed = 0; fixed <= std::size(kMethods); ++fixed) {
    double ms = 0;
    for (int i = 0; i < flight.frames; ++i)
      ms += flight.machine(i)
                .frame(fixed == 0 ? Method{} : kMethods[fixed - 1], i == 0, flight.triangles)
                .totalMs;
    total.bestFixedMs = std::min(total.bestFixedMs, ms);
    if (fixed == 0) total.noneMs = ms;
  }
  return total;
}

/// How often one serves in the second half.
double shareOf(const Total& total, Method method) {
  const auto middle = total.methods.begin() + static_cast<std::ptrdiff_t>(total.methods.size() / 2);
  return static_cast<double>(std::count(middle, total.methods.end(), method)) /
         static_cast<double>(total.methods.end() - middle);
}

PlannedFlight still(Machine machine) {
  PlannedFlight flight;
  flight.machine = [machine](int) { return machine; };
  return flight;
}

constexpr double kSlack = 0.02;

TEST(OcclusionChoice, findsTheFastestOfMethodsThatCostTheSame) {
  const Machine mountains{6, 6e-5, {{0.3, 2, 0.8}, {2, 3, 0.9}}};
  const Total total = fly(still(mountains));
  EXPECT_GT(shareOf(total, OcclusionMethod::horizon), 0.9);
  EXPECT_LE(total.ms, total.bestFixedMs * (1 + kSlack));
  EXPECT_LT(total.ms, 0.5 * total.noneMs + 0.5 * total.bestFixedMs);
}

TEST(OcclusionChoice, forgivesAMethodWhatItsVeryFirstFrameMakesForGood) {
  int served = 0;
  PlannedFlight flight;
  flight.machine = [&served](int) {
    const double once = served == 0 ? 400 : 2;
    return Machine{6, 6e-5, {{0.3, once, 0.8}, {9, 9, 0.1}}};
  };
  OcclusionChoice choice;
  Method before;
  for (int i = 0; i < 400; ++i) {
    const Method method = choice.choose({i * 16.0, {i * 5.0, 0, 0}, {1, 0, 0}, 0, kMethods});
    choice.learn(flight.machine(i).frame(method, method != before, 180e3));
    served += method == OcclusionMethod::horizon;
    before = method;
  }
  EXPECT_GT(served, 300);
}

/// One frame in a hundred is late for reasons of its own.
TEST(OcclusionChoice, isNotMisledByLateFrames) {
  const Machine mountains{6, 6e-5, {{0.3, 2, 0.8}, {2, 3, 0.9}}};
  OcclusionChoice choice;
  Method before;
  double clock = 0, best = 0;
  for (int i = 0; i < 4000; ++i) {
    const Method method = choice.choose({clock, {5.0 * i, 0, 0}, {1, 0, 0}, 0, kMethods});
    auto outcome = mountains.frame(method, method != before, 180e3);
    before = method;
    clock += outcome.totalMs;
    best += mountains.frame(OcclusionMethod::horizon, i == 0, 180e3).totalMs;
    if (i % 100 == 50) outcome.occlusionMs += 100, outcome.totalMs += 100;
    choice.learn(outcome);
  }
  EXPECT_LE(clock, 1.03 * best);
}

TEST(OcclusionChoice, takesNoneWhereNonePays) {
  for (const double share : {0.0, 0.005, 0.02}) {
    const Machine plain{10, 4e-5, {{1, 3, share}, {2, 4, share}}};
    const Total total = fly(still(plain));
    EXPECT_GT(shareOf(total, {}), 0.8) << share;
    EXPECT_LE(total.ms, total.noneMs * (1 + kSlack)) << share;
  }
}

TEST(OcclusionChoice, isNotMisledByATimeToDrawThatIsNotOfTriangles) {
  // Nearly all of it is of pixels: what is hidden saves little, however much it is.
  const Machine pixels{15, 1e-6, {{2, 3, 0.9}, {2, 3, 0.9}, {2, 3, 0.9}}};
  const Total total = fly(still(pixels));
  EXPECT_GT(shareOf(total, {}), 0.9);
  EXPECT_LE(total.ms, total.noneMs * (1 + kSlack));
}

TEST(OcclusionChoice, followsAChangeOfWhatPays) {
  PlannedFlight flight;
  flight.machine = [](int i) {
    const double share = i % 2000 < 1000 ? 0 : 0.8;  // plain, mountains, plain, mountains
    return Machine{6, 6e-5, {{1, 2, share}, {2, 3, share}}};
  };
  const Total total = fly(flight);
  EXPECT_LE(total.ms, total.bestFixedMs * (1 + kSlack));
  double ideal = 0;
  for (int i = 0; i < flight.frames; ++i) {
    const Machine m = flight.machine(i);
    ideal += std::min(m.frame({}, false, flight.triangles).totalMs,
                      m.frame(OcclusionMethod::horizon, false, flight.triangles).totalMs);
  }
  EXPECT_LE(total.ms, 1.06 * ideal) << "each change costs some frames";
}

/// Random machines whose costs wander.
TEST(OcclusionChoice, isNeverMuchSlowerThanTheBestFixedChoice) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int series = 0; series < 60; ++series) {
    Machine base{2 + 15 * unit(random), 1e-6 + 8e-5 * unit(random), {}};
    for (std::size_t i = 0; i < std::size(kMethods); ++i) {
      const double cost = 0.05 + 3 * unit(random) * unit(random);
      base.ways.push_back({cost, cost * (1 + 3 * unit(random)), unit(random)});
    }
    const double waves = 4 * unit(random), swing = unit(random), phase = 6.28 * unit(random);
    PlannedFlight flight;
    flight.noise = series % 3 == 0 ? 0 : 0.05;
    flight.turn = 0.05 * unit(random);
    flight.machine = [=](int i) {
      Machine m = base;
      for (auto& way : m.ways)
        way.share *= 1 - swing * (0.5 + 0.5 * std::sin(phase + 6.28 * waves * i / 4000));
      return m;
    };
    const Total total = fly(flight);
    EXPECT_LE(total.ms, total.bestFixedMs * (1 + kSlack)) << series;
    EXPECT_LE(total.ms, total.noneMs * (1 + kSlack)) << series;
  }
}

TEST(OcclusionChoice, losesABoundedShareToTryingWhateverChanges) {
  // Everything changes in every frame, and trying is dear.
  PlannedFlight flight = still({6, 6e-5, {{5, 20, 0.1}, {8, 30, 0.1}}});
  flight.stepM = 1000;
  flight.turn = 1;
  flight.rule = [](int i) { return static_cast<std::uint64_t>(i); };
  const Total total = fly(flight);
  EXPECT_LE(total.ms, total.noneMs * (1 + kSlack));
  EXPECT_GT(total.trials, 3u);
}

/// Everything is due in every frame. Trials lose 4 ms of 16.
TEST(OcclusionChoice, seldomTriesInAFrameThatHasNoRoomForIt) {
  PlannedFlight flight = still({5, 6e-5, {{4, 4, 0}, {4, 4, 0}}});
  flight.stepM = 250;
  const std::uint64_t roomy = fly(flight).trials;
  flight.roomMs = 5;
  EXPECT_EQ(fly(flight).trials, roomy) << "there is room";
  flight.roomMs = 3;
  const std::uint64_t tight = fly(flight).trials;
  EXPECT_LT(tight, 40u) << "less than one in a hundred";
  EXPECT_GT(tight, 9u) << "more than the first of each method";
  EXPECT_GT(roomy, 5 * tight);
}

TEST(OcclusionChoice, findsWhatPaysWithoutRoomForTrials) {
  PlannedFlight flight = still({6, 6e-5, {{0.3, 2, 0.8}, {2, 3, 0.9}}});
  flight.roomMs = 0;
  EXPECT_GT(shareOf(fly(flight), OcclusionMethod::horizon), 0.98);
}

/// Another rule ends the patience with a method, but asks for no trial by itself.
TEST(OcclusionChoice, anotherRuleAloneAsksForNoTrial) {
  const Machine plain{10, 4e-5, {{0.5, 1, 0}, {0.5, 1, 0}}};
  OcclusionChoice choice;
  double clock = 0;
  std::uint64_t rule = 0;
  const auto draw = [&](int frames) {
    const std::uint64_t before = choice.trials();
    Method last;
    for (int i = 0; i < frames; ++i) {
      const Method method = choice.choose({clock, {}, {1, 0, 0}, rule, kMethods});
      const auto outcome = plain.frame(method, method != last, 180e3);
      choice.learn(outcome);
      clock += outcome.totalMs;
      last = method;
    }
    return choice.trials() - before;
  };
  draw(3000);
  const std::uint64_t same = draw(100);
  rule = 1;
  EXPECT_LE(draw(20), 1u);
  EXPECT_GT(draw(80), same) << "patience has ended";
}

TEST(OcclusionChoice, triesAgainAfterABoundedTimeWayOrTurn) {
  const Machine plain{10, 4e-5, {{0.5, 1, 0}, {0.5, 1, 0}}};
  const auto trials = [&](double stepM, double turn) {
    PlannedFlight flight = still(plain);
    flight.frames = 400;  // some seven seconds
    flight.stepM = stepM;
    flight.turn = turn;
    return fly(flight).trials;
  };
  const auto resting = trials(0, 0);
  EXPECT_GE(resting, 3u) << "by time alone";
  EXPECT_GT(trials(20, 0), resting);
  EXPECT_GT(trials(0, 0.1), resting);
}

/// What costs next to nothing to try would be tried at every turn.
TEST(OcclusionChoice, triesLessOftenWhatNeverPays) {
  const Machine sea{5, 1e-6, {{0.02, 0.02, 0}, {0.02, 0.02, 0}}};
  PlannedFlight flight = still(sea);
  flight.turn = 0;
  flight.frames = 2000;
  const Total total = fly(flight);
  // Each of two, had they no patience, at every 11th frame.
  EXPECT_LT(total.trials, 2000u * 2 / 11 / 2);
  EXPECT_GT(total.trials, 2000u * 2 / 11 / 8) << "it will be worth it somewhere";
}

/// Maps that cost more than a third of what the horizon leaves to be drawn.
TEST(OcclusionChoice, seldomTriesWhatCouldNotWinItsOwnCost) {
  const Machine mountains{6, 7e-5, {{0.15, 1.5, 0.75}, {2.2, 3.2, 0.81}}};
  for (const bool sameRule : {true, false}) {
    PlannedFlight flight = still(mountains);
    flight.turn = 0.002;
    flight.noise = 0.05;
    if (!sameRule) flight.rule = [](int i) -> std::uint64_t { return static_cast<std::uint64_t>(i / 60); };
    const Total total = fly(flight);
    EXPECT_GT(shareOf(total, OcclusionMethod::horizon), 0.97);
    EXPECT_LE(total.ms, total.bestFixedMs * 1.008);
    EXPECT_LT(total.trials, 70u);
    EXPECT_LT(shareOf(total, OcclusionMethod::horizon), 1) << "it is not believed for ever";
  }
}

TEST(OcclusionChoice, findsWhatHadNoHopeOnceThereIsMuchLeftToHide) {
  PlannedFlight flight;
  flight.triangles = 250e3;
  flight.machine = [&flight](int i) {
    const bool later = 2 * i >= flight.frames;
    return Machine{6, 7e-5, {{0.15, 1.5, later ? 0.2 : 0.75}, {2.2, 3.2, 0.81}}};
  };
  const Total total = fly(flight);
  const auto middle = total.methods.begin() + static_cast<std::ptrdiff_t>(total.methods.size() / 2);
  const auto isMap = [](Method m) { return m == OcclusionMethod::depth_map; };
  EXPECT_LT(std::count_if(total.methods.begin(), middle, isMap), 60);
  // Within half a second.
  EXPECT_GT(std::count_if(middle, total.methods.end(), isMap), total.methods.end() - middle - 100);
}

/// A map that is hopeless, and found so again and again, costs a tenth once the band has fallen, or where the
/// eye is; and another one hides much there.
TEST(OcclusionChoice, triesWhatHadNoHopeAtOnceAfterABandASchemeOrALeap) {
  const Machine before{6, 6e-5, {{12, 12, 0.1}, {12, 12, 0.1}}}, after{6, 6e-5, {{12, 12, 0.1}, {1, 1, 0.7}}};
  struct Change {
    const char* what;
    std::uint64_t band;
    double leapM;
    double whileMs;
    bool isOne;
  };
  for (const Change& change : {Change{"band", 1, 0, 0, true},
                               {"leap", 0, 600, 0, true},
                               {"scheme", 0, 0, 1500, true},
                               {"every second frame without a choice", 0, 0, 0, false}}) {
    OcclusionChoice choice;
    Method last;
    int served = 0;
    double clock = 0;
    for (int i = 0; i < 4000; ++i) {
      const bool later = i >= 3000;
      if (!change.isOne || i == 3000) choice.pause();
      if (i == 3000) {
        EXPECT_LT(choice.trials(), 30u) << change.what;
        clock += change.whileMs;
      }
      const Method method = choice.choose(
          {clock, {later ? change.leapM : 0, 0, 0}, {1, 0, 0}, 0, kMethods, later ? change.band : 0});
      const auto outcome = (later ? after : before).frame(method, method != last, 180e3);
      choice.learn(outcome);
      clock += outcome.totalMs;
      last = method;
      served += later && i < 3060 && method == OcclusionMethod::depth_map;
    }
    EXPECT_EQ(served > 40, change.isOne) << change.what << ": " << served << " of 60 frames";
  }
}

/// Bands that come and go, and an eye that leaps, ask for trials in every frame.
TEST(OcclusionChoice, losesABoundedShareWhereBandsAndPlacesChange) {
  const Machine plain{6, 6e-5, {{5, 200, 0.1}, {0.1, 200, 0}}};
  for (const int frames : {1, 7, 100}) {
    OcclusionChoice choice;
    Method last;
    double clock = 0, none = 0;
    for (int i = 0; i < 6000; ++i) {
      const auto turn = static_cast<std::uint64_t>(i / frames);
      const Method method = choice.choose(
          {clock, {1000.0 * static_cast<double>(turn % 3), 0, 0}, {1, 0, 0}, 0, kMethods, turn % 2});
      const auto outcome = plain.frame(method, method != last, 180e3);
      choice.learn(outcome);
      clock += outcome.totalMs;
      none += plain.frame({}, false, 180e3).totalMs;
      last = method;
    }
    EXPECT_LE(clock, none * (1 + kSlack)) << frames;
    EXPECT_GT(choice.trials(), 3u) << frames;
  }
}

TEST(OcclusionChoice, choosesAmongWhatCanServe) {
  OcclusionChoice choice;
  const OcclusionMethod one[] = {OcclusionMethod::depth_map};
  for (int i = 0; i < 500; ++i) {
    const Method method = choice.choose({i * 16.0, {i * 100.0, 0, 0}, {1, 0, 0}, 0, one});
    EXPECT_TRUE(!method || method == OcclusionMethod::depth_map) << i;
    const Machine good{6, 6e-5, {{}, {0.2, 0.2, 0.9}}};
    choice.learn(good.frame(method, false, 1e5));
  }
  EXPECT_EQ(choice.choose({9000, {}, {1, 0, 0}, 0, one}), OcclusionMethod::depth_map);
  EXPECT_EQ(choice.choose({9001, {}, {1, 0, 0}, 0, {}}), Method{}) << "it cannot serve here";
}

TEST(OcclusionChoice, learnsNothingFromWhatIsNotANumber) {
  OcclusionChoice choice;
  for (int i = 0; i < 50; ++i) {
    choice.choose({i * 16.0, {i * 100.0, 0, 0}, {0, 0, 0}, 0, kMethods});
    OcclusionChoice::Outcome o;
    o.occlusionMs = i % 3 == 0 ? std::numeric_limits<double>::quiet_NaN() : 1;
    o.drawMs = i % 3 == 1 ? std::numeric_limits<double>::infinity() : 10;
    o.totalMs = i % 3 == 2 ? std::numeric_limits<double>::quiet_NaN() : 11;
    o.drawn = 1000;
    choice.learn(o);
  }
  EXPECT_EQ(choice.msPerTriangle(), 0);
  choice.learn({0, 0, 0, 0, 0});
  EXPECT_TRUE(std::isfinite(choice.msPerTriangle()));
}

TEST(OcclusionChoice, isAFunctionOfWhatItWasTold) {
  const auto once = [] {
    PlannedFlight flight = still({6, 6e-5, {{0.3, 2, 0.5}, {0.8, 3, 0.6}}});
    flight.noise = 0.1;
    return fly(flight).methods;
  };
  EXPECT_EQ(once(), once());
}

}  // namespace
}  // namespace trimtab
