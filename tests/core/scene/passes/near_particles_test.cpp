#include "core/scene/passes/near_particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/scene/passes/scene_view.h"
#include "core/scene/passes/weather_precipitation.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::scene {
namespace {

constexpr std::array<Precipitation, 2> kKinds{Precipitation::rain, Precipitation::snow};
constexpr double kInfinite = std::numeric_limits<double>::infinity();

PrecipitationView falling(Precipitation kind, double density = 1) {
  PrecipitationView view;
  view.kind = kind;
  view.density = view.amount = density;
  view.time = 12.5;
  return view;
}

/// Looks north, level, from a place in the local frame.
SceneView northward(Vec3 eye = {120, -300, 900}) {
  SceneView view;
  view.eye.position = eye;
  view.eye.axes = {{Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}}};
  return view;
}

std::vector<NearParticle> found(const PrecipitationView& precipitation, const SceneView& view) {
  std::vector<NearParticle> particles;
  findNearParticles(precipitation, view, particles);
  return particles;
}

bool same(const std::vector<NearParticle>& a, const std::vector<NearParticle>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const NearParticle& x, const NearParticle& y) {
    return x.place == y.place && x.radiusM == y.radiusM && x.strength == y.strength;
  });
}

TEST(NearParticles, dependOnTheirArgumentsAlone) {
  for (const Precipitation kind : kKinds) {
    const auto first = found(falling(kind), northward());
    ASSERT_GT(first.size(), 500u);
    EXPECT_TRUE(same(first, found(falling(kind), northward())));
    auto later = falling(kind);
    later.time += 0.02;
    EXPECT_FALSE(same(first, found(later, northward())));
  }
}

TEST(NearParticles, areInTheViewNoFartherThanFogAndPixelsShow) {
  for (const Precipitation kind : kKinds)
    for (const double extinction : {0.0, 0.05, 0.4, 6.0}) {
      SceneView view = northward();
      view.air.extinction = static_cast<float>(extinction);
      const auto precipitation = falling(kind);
      const double pixels = pixelsPerRadian(view.shape);
      const auto particles = found(precipitation, view);
      EXPECT_EQ(particles.empty(), extinction > 5);
      for (const NearParticle& p : particles) {
        const double distance = length(p.place);
        EXPECT_GE(std::exp(-extinction * distance), 0.02) << "lost in fog";
        EXPECT_GE(2 * p.radiusM * pixels / -p.place.z, 0.75) << "narrower than a pixel";
        EXPECT_LT(std::abs(p.place.x), 0.58 * -p.place.z + p.lengthM + 1);
        EXPECT_GT(p.strength, 0);
        EXPECT_LE(p.strength, 1);
      }
    }
}

TEST(NearParticles, getFewerWithDistanceInAVolumeButNotInAPixel) {
  for (const Precipitation kind : kKinds) {
    const auto particles = found(falling(kind), northward());
    const auto between = [&](double from, double to) {
      const auto n = std::count_if(particles.begin(), particles.end(), [=](const NearParticle& p) {
        return length(p.place) >= from && length(p.place) < to;
      });
      return static_cast<double>(n);
    };
    const double near = between(2, 4), middle = between(6, 12), far = between(12, 24);
    EXPECT_GT(near / (64 - 8), middle / (1728 - 216));
    EXPECT_GT(middle / (1728 - 216), far / (13824 - 1728));
    EXPECT_GT(far, near);
  }
}

TEST(NearParticles, areFewerWithLessDensityAndWithASmallerShare) {
  for (const Precipitation kind : kKinds) {
    const std::size_t heavy = found(falling(kind), northward()).size();
    auto light = falling(kind);
    light.amount = 0.25;
    EXPECT_NEAR(static_cast<double>(found(light, northward()).size()) / static_cast<double>(heavy), 0.25,
                0.08);
    auto half = falling(kind);
    half.share = 0.5;
    const auto fewer = found(half, northward());
    EXPECT_NEAR(static_cast<double>(fewer.size()) / static_cast<double>(heavy), 0.5, 0.08);
    // They are some of the same, but for some that are too faint to be drawn unless they are made stronger.
    const auto all = found(falling(kind), northward());
    for (const NearParticle& p : fewer) {
      if (p.strength <= 0.03) continue;
      EXPECT_TRUE(
          std::any_of(all.begin(), all.end(), [&](const NearParticle& q) { return q.place == p.place; }));
    }
    half.share = 0;
    EXPECT_TRUE(found(half, northward()).empty());
  }
}

/// Whatever the view, what they cost has a bound.
TEST(NearParticles, areNeverMoreThanTheBound) {
  for (const Precipitation kind : kKinds)
    for (const double tangent : {0.01, 0.1, 0.577, 2.0, 20.0, 1e6})
      for (const double size : {0.05, 1.0, 20.0}) {
        SceneView view = northward();
        view.shape.left = view.shape.bottom = -tangent;
        view.shape.right = view.shape.top = tangent;
        view.shape.widthPx = view.shape.heightPx = 4000;
        auto precipitation = falling(kind);
        precipitation.look.size = Ratio{size};
        EXPECT_LE(found(precipitation, view).size(), kMostParticles) << tangent;
      }
}

/// All of them belong to the air: an eye that moves sees the same ones from elsewhere.
TEST(NearParticles, standInTheAirThatCarriesThem) {
  for (const Precipitation kind : kKinds) {
    const auto before = found(falling(kind), northward());
    const Vec3 moved{0.25, 0.5, -0.125};
    const auto after = found(falling(kind), northward(Vec3{120, -300, 900} + moved));
    const SceneView view = northward();
    std::size_t again = 0;
    for (const NearParticle& p : before)
      again += std::any_of(after.begin(), after.end(), [&](const NearParticle& q) {
        return length(q.place - (p.place - view.eye.axes * moved)) < 1e-6;
      });
    EXPECT_GT(again * 10, before.size() * 8);
    auto carried = falling(kind);
    carried.airDrift = moved;
    SceneView along = northward(Vec3{120, -300, 900} + moved);
    const auto drifting = found(carried, along);
    ASSERT_EQ(drifting.size(), before.size());
    for (std::size_t i = 0; i < drifting.size(); ++i)
      EXPECT_LT(length(drifting[i].place - before[i].place), 1e-6);
  }
}

TEST(NearParticles, fallAndSeamlesslySoWhereTheLatticeRepeats) {
  const auto lowered = [](double time) {
    auto precipitation = falling(Precipitation::rain);
    precipitation.time = time;
    return found(precipitation, northward());
  };
  for (const double time : {0.0, 12.5, 1.79e9, -5.0, 65536.0}) {
    const auto before = lowered(time), after = lowered(time + 1.0 / 64);
    std::size_t fell = 0;
    for (const NearParticle& p : before)
      fell += std::any_of(after.begin(), after.end(), [&](const NearParticle& q) {
        const Vec3 d = q.place - p.place;
        return std::abs(d.x) < 1e-4 && std::abs(d.z) < 1e-4 && d.y < -0.09 && d.y > -0.12;
      });
    EXPECT_GT(fell * 10, before.size() * 8) << time;
  }
}

TEST(NearParticles, areDefinedForNumbersThatAreNone) {
  for (const Precipitation kind : kKinds)
    for (const double bad : {kNan, kInfinite, -kInfinite, 1e300}) {
      auto precipitation = falling(kind);
      precipitation.time = bad;
      precipitation.velocity = {bad, 0, bad};
      precipitation.airDrift = {0, bad, 0};
      const auto particles = found(precipitation, northward());
      EXPECT_GT(particles.size(), 100u) << bad;
      for (const NearParticle& p : particles) EXPECT_TRUE(std::isfinite(length(p.place))) << bad;
      const Vec3 streak = particleMotion(precipitation, northward()).streak;
      EXPECT_LE(length(streak), 1.01) << bad;
      SceneView view = northward({bad, 0, 0});
      EXPECT_LE(found(falling(kind), view).size(), kMostParticles);
      view = northward();
      view.shape.right = bad;
      EXPECT_LE(found(falling(kind), view).size(), kMostParticles);
      precipitation = falling(kind);
      precipitation.share = bad;
      EXPECT_LE(found(precipitation, northward()).size(), kMostParticles);
    }
}

}  // namespace
}  // namespace trimtab::scene
