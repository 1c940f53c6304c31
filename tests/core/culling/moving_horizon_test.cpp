#include "trimtab/culling/moving_horizon.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "lod_ground.h"

namespace trimtab {
namespace {

using test::LodGround;

struct Flown {
  std::size_t frames = 0, hidden = 0, exact = 0, tiles = 0, asked = 0, wrong = 0, cuts = 0;
  std::uint64_t built = 0, fromScratch = 0, carried = 0;
};

/// Where the eye is in a frame; z is above the highest ground on the way.
using Path = std::function<Vec3(int frame)>;

struct Flight {
  int frames = 60;
  double errorOverDistance = 0.004;
  bool cutStands = false;
  Horizon::Settings settings{.columns = 512};
  bool tellErrors = true;
  int asked = 60;  ///< hidden tiles a frame
};

/// Each frame of a flight: points of tiles that are said to be hidden, asked of the surface as drawn.
Flown fly(LodGround& ground, const Path& path, const Flight& flight, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const SurfaceTree tree = SurfaceTree::of(ground.index());
  MovingHorizon moving;
  Horizon exact;
  LevelCut cut;
  std::vector<TileDraw> last;
  Flown flown;
  double highest = -1e9;
  for (int frame = 0; frame < flight.frames; ++frame)
    highest = std::max(highest, ground.sourceAt(path(frame).x, path(frame).y));
  for (int frame = 0; frame < flight.frames; ++frame) {
    Vec3 eye = path(frame);
    eye.z += highest;
    if (frame == 0 || !flight.cutStands)
      selectLevels(ground.index(), eye, {flight.errorOverDistance, 1, 1}, cut);
    const auto same = [](const TileDraw& a, const TileDraw& b) {
      return a.node == b.node && a.border == b.border;
    };
    if (!std::equal(last.begin(), last.end(), cut.tiles.begin(), cut.tiles.end(), same)) {
      last = cut.tiles;
      ++flown.cuts;
      ground.draw(cut);
    }
    eye.z = std::max(eye.z, ground.heightAt(eye.x, eye.y) + 3);
    const std::vector<HorizonTile> now = ground.tiles(cut);
    const auto hidden = moving.hidden({.eye = eye,
                                       .cut = flown.cuts,
                                       .tiles = cut.tiles,
                                       .errorOverDistance = flight.tellErrors ? flight.errorOverDistance : 0,
                                       .settings = flight.settings},
                                      tree, [&](std::vector<HorizonTile>& tiles) { tiles = now; });
    EXPECT_EQ(hidden.size(), cut.tiles.size());
    std::vector<std::size_t> claimed;
    for (std::size_t t = 0; t < hidden.size(); ++t)
      if (hidden[t] != 0) claimed.push_back(t);
    for (int k = 0; k < flight.asked && !claimed.empty(); ++k) {
      const std::size_t t = claimed[static_cast<std::size_t>(unit(random) * double(claimed.size()))];
      const double u = unit(random), v = unit(random);
      const bool post = k % 2 == 0;
      const Vec3 p = ground.pointOf(cut.tiles[t].node, post ? std::round(16 * u) / 16 : u,
                                    post ? std::round(16 * v) / 16 : v);
      ++flown.asked;
      flown.wrong += !ground.isCovered(eye, p);
    }
    exact.build(eye, now, flight.settings);
    flown.exact += exact.hiddenCount();
    flown.hidden += claimed.size();
    flown.tiles += cut.tiles.size();
    ++flown.frames;
  }
  flown.built = moving.built();
  flown.fromScratch = moving.fromScratch();
  flown.carried = moving.carried();
  return flown;
}

void print(const char* what, const Flown& f) {
  std::printf(
      "%s: %zu frames, %zu cuts, %zu of %zu hidden (from scratch %zu), %zu asked, %llu built, %llu at "
      "once, %llu carried\n",
      what, f.frames, f.cuts, f.hidden, f.tiles, f.exact, f.asked, static_cast<unsigned long long>(f.built),
      static_cast<unsigned long long>(f.fromScratch), static_cast<unsigned long long>(f.carried));
}

Path straight(const LodGround& ground, double aboveM, double stepM, double heading) {
  const double side = ground.sideM();
  return [=](int frame) {
    return Vec3{0.4 * side + stepM * frame * std::cos(heading),
                0.45 * side + stepM * frame * std::sin(heading), aboveM};
  };
}

LodGround& ground() {
  static LodGround ground(32, 30, 3);
  return ground;
}

TEST(MovingHorizon, hidesOnlyWhatTheGroundHidesWhileTheCutStands) {
  for (const double above : {10.0, 60.0, 300.0})
    for (const double heading : {0.1, 0.9, 2.7, 4.4}) {
      const Flown f =
          fly(ground(), straight(ground(), above, 5.1, heading), {.frames = 60, .cutStands = true}, 5);
      EXPECT_EQ(f.wrong, 0u) << above << ' ' << heading;
      EXPECT_EQ(f.fromScratch, 2u) << "the first place, and the first step";
      EXPECT_GT(f.hidden, f.exact * 60 / 100);
      print("cut stands", f);
    }
}

TEST(MovingHorizon, hidesOnlyWhatTheSurfaceAsDrawnHidesWhileLevelsChange) {
  for (const double above : {10.0, 60.0, 300.0})
    for (const double heading : {0.4, 2.0, 3.9, 5.5}) {
      const Flown f = fly(ground(), straight(ground(), above, 5.1, heading), {.frames = 80}, 6);
      EXPECT_EQ(f.wrong, 0u) << above << ' ' << heading;
      EXPECT_GT(f.cuts, 3u);
      EXPECT_GT(f.carried, 10u);
      EXPECT_GT(f.hidden, f.exact * 60 / 100);
      print("levels change", f);
    }
}

TEST(MovingHorizon, holdsThroughTurnsStopsClimbsAndJumps) {
  const double side = ground().sideM();
  const std::vector<std::pair<const char*, Path>> paths{
      {"turn of 9 g",
       [=](int f) {
         const double a = 0.0048 * f, r = 5.1 / 0.0048;
         return Vec3{0.4 * side + r * std::sin(a), 0.4 * side + r * (1 - std::cos(a)), 120};
       }},
      {"stop and go",
       [=](int f) {
         const double s = f < 25 ? 5.1 * f : f < 50 ? 127.5 : 127.5 + 5.1 * (f - 50);
         return Vec3{0.4 * side + s, 0.5 * side, 80};
       }},
      {"climb and dive",
       [=](int f) {
         return Vec3{0.5 * side + 4 * f, 0.5 * side, 200 + 150 * std::sin(0.08 * f)};
       }},
      {"jumps",
       [=](int f) {
         const int leg = f / 13;
         return Vec3{side * (0.25 + 0.07 * (leg % 7)) + 5.1 * (f % 13), side * (0.7 - 0.05 * (leg % 6)),
                     60.0 + 40 * leg};
       }},
      {"there and back",
       [=](int f) {
         return Vec3{0.5 * side + 60 * std::sin(0.2 * f), 0.5 * side, 70};
       }},
      {"hover",
       [=](int f) {
         return Vec3{0.5 * side + 0.02 * std::sin(1.7 * f), 0.5 * side + 0.03 * std::sin(2.3 * f), 50};
       }},
  };
  for (const auto& [what, path] : paths)
    for (const bool stands : {false, true}) {
      const Flown f = fly(ground(), path, {.frames = 90, .cutStands = stands}, 7);
      EXPECT_EQ(f.wrong, 0u) << what;
      EXPECT_GT(f.asked, 1000u) << what;
      print(what, f);
    }
}

// A horizon is for a few frames' way, whatever was not asked for before.
TEST(MovingHorizon, takesTheEyesStepFromAllFramesSinceItWasAsked) {
  const SurfaceTree tree = SurfaceTree::of(ground().index());
  const double side = ground().sideM();
  LevelCut cut;
  const auto roomAfter = [&](double framesSince) {
    MovingHorizon moving;
    for (int call = 0; call < 3; ++call) {
      const Vec3 eye{0.3 * side + 50 * call, 0.4 * side, 900};
      if (call == 0) selectLevels(ground().index(), eye, {0.004, 1, 1}, cut);
      moving.hidden({.eye = eye, .framesSince = framesSince, .cut = 1, .tiles = cut.tiles, .settings = {}},
                    tree, [&](std::vector<HorizonTile>& tiles) { tiles = ground().tiles(cut); });
    }
    const ValidityRegion& region = moving.horizon().region();
    return length(region.to - region.from);
  };
  EXPECT_LT(roomAfter(10), 5 * (MovingHorizon::kFrames + 2));
  EXPECT_GT(roomAfter(1), 50 * MovingHorizon::kFrames) << "in one frame";
  EXPECT_EQ(roomAfter(0), roomAfter(1));
}

// The region shrinks to where the eye is, wherever the one that was being made lies.
TEST(MovingHorizon, givesAnEyeThatComesToRestABetterHorizon) {
  const double side = ground().sideM();
  for (int flown = 40; flown < 52; ++flown) {
    const auto fliesAndRests = [&](int rest) {
      const Path path = [=](int frame) {
        return Vec3{0.4 * side + 5.1 * std::min(frame, flown), 0.45 * side, 60};
      };
      return fly(ground(), path, {.frames = flown + rest, .cutStands = true, .asked = 10}, 5);
    };
    const Flown before = fliesAndRests(4 * MovingHorizon::kFrames),
                after = fliesAndRests(4 * MovingHorizon::kFrames + 1);
    EXPECT_EQ(after.wrong, 0u);
    EXPECT_GT(after.hidden - before.hidden, (after.exact - before.exact) * 95 / 100) << flown;
  }
}

// Without these, the tests above might pass because nothing can go wrong where they look.
TEST(MovingHorizon, isSeenToFailWhereTheRoomIsTakenForItsMiddle) {
  std::size_t wrong = 0;
  for (const double heading : {0.1, 0.9, 2.7, 4.4})
    wrong +=
        fly(ground(), straight(ground(), 60, 30, heading),
            {.frames = 60, .cutStands = true, .settings = {.columns = 512, .still = true}, .asked = 400}, 5)
            .wrong;
  EXPECT_GT(wrong, 0u);
}

}  // namespace
}  // namespace trimtab
