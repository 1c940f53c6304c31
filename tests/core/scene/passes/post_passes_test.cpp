#include <cmath>
#include <set>

#include "tests/core/scene/scene_test.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/preset/table.h"
#include "trimtab/scene/symbology_geometry.h"

namespace trimtab {
namespace {

using test::SceneTest;

/// The sky alone, of one grey: what the passes over the picture make of it is known.
class PostPasses : public SceneTest {
 protected:
  /// A picture of `grey` all over.
  FrameRequest uniform(double time, double strength) {
    auto r = request({Degrees{0}, Degrees{0}, Metres{100}}, {Degrees{0}, Degrees{80}, Degrees{0}});
    r.time = time;
    r.levers.drawn.blurStrength = strength;
    return r;
  }
  FrameRequest ofMountains(double heading, double time, double strength) {
    auto r = request(over(0.4, 0.4, 400), {Degrees{heading}, Degrees{-8}, Degrees{5}});
    r.time = time;
    r.levers.drawn.blurStrength = strength;
    return r;
  }
  /// Where many pictures are drawn.
  FrameRequest ofSmallMountains(double heading, double time, double strength) {
    auto r = ofMountains(heading, time, strength);
    r.view.widthPx = 160;
    r.view.heightPx = 90;
    return r;
  }
  static SymbologyRequest symbols() {
    TuningParameters p;
    p.symbology.enabled = true;
    const Attitude a{Degrees{30}, Degrees{-2}, Degrees{5}};
    const Velocity v{MetresPerSecond{100}, MetresPerSecond{60}, MetresPerSecond{2}};
    return {{a, a, Metres{1234}, Knots{240}, true, v}, symbologySetup(p), hostSymbols()};
  }
  /// A cross in the lower left quarter of the image, and a translucent triangle in the upper right one.
  static const std::shared_ptr<const HostSymbols>& hostSymbols() {
    static const std::shared_ptr<const HostSymbols> all = [] {
      HostShape cross, triangle;
      cross.primitive = HostPrimitive::lines;
      cross.lineWidth = 0.1F;
      cross.points = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
      triangle.primitive = HostPrimitive::triangles;
      triangle.points = {{-0.5F, -0.5F}, {0.5F, -0.5F}, {0, 0.5F}};
      HostSymbols symbols;
      symbols.surfaces = {{1, 0, 0.5F, 0, 0.5F, -1, 1, -1, 1}, {2, 0.5F, 1, 0.5F, 1, -1, 1, -1, 1}};
      for (const HostShape& shape : {cross, triangle}) {
        HostSymbol s;
        s.id = s.surface = static_cast<std::uint16_t>(symbols.symbols.size() + 1);
        s.visible = true;
        s.rgba = {255, 0, 255, static_cast<std::uint8_t>(s.id == 1 ? 255 : 128)};
        s.shape = std::make_shared<const HostShape>(shape);
        symbols.symbols.push_back(s);
      }
      return std::make_shared<const HostSymbols>(symbols);
    }();
    return all;
  }
  static int difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    return most;
  }
};

TEST_F(PostPasses, runNothingAtRest) {
  use(test::syntheticMountains());
  FrameResult result;
  const auto plain = picture(ofMountains(30, 1, 0), &result);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(differing(plain, picture(ofMountains(30, 1 + i, 0), &result)), 0u);
  EXPECT_EQ(result.counters.blurPasses, 0u);
  EXPECT_EQ(result.counters.symbologyDraws, 0u);
  EXPECT_EQ(result.counters.symbologyRedraws, 0u);
  // After a blur, too, the picture at rest is the plain one.
  picture(ofMountains(60, 4, 0.8), &result);
  picture(ofMountains(45, 4.01, 0.8), &result);
  EXPECT_EQ(result.counters.blurPasses, 2u);
  EXPECT_EQ(differing(plain, picture(ofMountains(30, 4.02, 0), &result)), 0u);
  EXPECT_EQ(result.counters.blurPasses, 2u);
  EXPECT_EQ(differing(plain, picture(ofMountains(30, 4.03, 0.8))), 0u) << "a trail from before the rest";
}

TEST_F(PostPasses, blurKeepsTheFirstPictureAndAStandingOne) {
  use(test::syntheticMountains());
  const auto plain = picture(ofMountains(30, 1, 0));
  for (int i = 0; i < 8; ++i)
    EXPECT_EQ(difference(plain, picture(ofMountains(30, 2 + i * 0.01, 0.9))), 0) << i;
}

// The twin: the same mix in doubles on this processor, from the sharp pictures.
TEST_F(PostPasses, blurMixesAsItsTwinDoes) {
  use(test::syntheticMountains());
  const double times[] = {5, 5.01, 5.03, 5.034, 5.2, 5.21};
  constexpr double kStrength = 0.8;
  std::vector<std::vector<std::uint8_t>> sharp;
  for (int i = 0; i < 6; ++i) sharp.push_back(picture(ofMountains(30 + 4 * i, times[i], 0)));
  std::vector<double> twin(sharp[0].begin(), sharp[0].end());
  for (std::size_t i = 0; i < 6; ++i) {
    if (i > 0) {
      const double keep = std::pow(kStrength, (times[i] - times[i - 1]) * 60);
      for (std::size_t at = 0; at < twin.size(); ++at) twin[at] = keep * twin[at] + (1 - keep) * sharp[i][at];
    }
    const auto blurred = picture(ofMountains(30 + 4.0 * static_cast<double>(i), times[i], kStrength));
    double worst = 0;
    for (std::size_t at = 0; at < twin.size(); ++at)
      worst = std::max(worst, std::abs(twin[at] - blurred[at]));
    EXPECT_LE(worst, 0.51) << i << ": more than rounding to whole greys";
  }
}

// The view jumps once; then the trail fades: after a tenth of a second it is the same, whatever the frame
// rate.
TEST_F(PostPasses, blurFadesAlikeAtEveryFrameRate) {
  use(test::syntheticMountains());
  constexpr double kStrength = 0.9;
  std::vector<std::uint8_t> reference;
  for (const int hz : {30, 60, 100, 450}) {
    picture(ofSmallMountains(90, 0, 0));
    picture(ofSmallMountains(90, 10, kStrength));
    std::vector<std::uint8_t> last;
    for (int i = 1; i <= hz / 10; ++i) last = picture(ofSmallMountains(30, 10 + double(i) / hz, kStrength));
    if (reference.empty())
      reference = last;
    else
      EXPECT_LE(difference(reference, last), 1) << hz << " pictures a second";
  }
  EXPECT_GT(differing(reference, picture(ofSmallMountains(30, 11, 0))), 1000u) << "the trail is over already";
}

// Half floats would stop several greys before the end of a long trail at this rate.
TEST_F(PostPasses, blurLeavesNoGhost) {
  use(test::syntheticMountains());
  picture(ofSmallMountains(90, 10, 0.9));
  std::vector<std::uint8_t> last;
  for (int i = 1; i <= 700; ++i) last = picture(ofSmallMountains(30, 10 + i / 450.0, 0.9));
  EXPECT_LE(difference(last, picture(ofSmallMountains(30, 20, 0))), 1);
}

TEST_F(PostPasses, blurDrawsTheSameTimeAgainAlike) {
  use(test::syntheticMountains());
  picture(ofMountains(60, 10, 0.8));
  const auto once = picture(ofMountains(45, 10.01, 0.8));
  EXPECT_EQ(differing(once, picture(ofMountains(45, 10.01, 0.8))), 0u);
  EXPECT_EQ(differing(once, picture(ofMountains(45, 10.01, 0.8))), 0u);
}

TEST_F(PostPasses, blurStartsAnewWhereTimeIsNoStep) {
  use(test::syntheticMountains());
  const auto plain = picture(ofMountains(30, 1, 0));
  for (const double next : {9.0, 12.5, std::numeric_limits<double>::quiet_NaN()}) {
    picture(ofMountains(90, 10, 0));
    picture(ofMountains(90, 10, 1));
    EXPECT_EQ(differing(plain, picture(ofMountains(30, next, 1))), 0u) << next;
  }
  auto small = ofMountains(30, 10.01, 0.9);
  picture(ofMountains(90, 10, 0.9));
  small.view.widthPx = 320;
  small.view.heightPx = 180;
  auto sharp = small;
  sharp.levers.drawn.blurStrength = 0;
  EXPECT_EQ(differing(picture(small), picture(sharp)), 0u) << "another size";
}

TEST_F(PostPasses, blurKeepsEnergy) {
  const auto plain = picture(uniform(1, 0));
  for (int i = 0; i < 40; ++i) EXPECT_LE(difference(plain, picture(uniform(2 + i * 0.003, 0.95))), 1);
}

TEST_F(PostPasses, blurTakesAnyStrength) {
  use(test::syntheticMountains());
  for (const double strength : {1e-300, 1.0, 7.0, std::numeric_limits<double>::infinity()}) {
    picture(ofMountains(90, 10, strength));
    const auto p = picture(ofMountains(30, 10.5, strength));
    EXPECT_LE(difference(p, picture(ofMountains(30, 12, 0))), 255);
  }
  FrameResult result;
  const auto before = picture(ofMountains(30, 12, 0), &result);
  const auto passes = result.counters.blurPasses;
  EXPECT_EQ(differing(before, picture(ofMountains(30, 13, std::nan("")), &result)), 0u);
  EXPECT_EQ(result.counters.blurPasses, passes) << "no number is no strength";
}

TEST_F(PostPasses, symbolsAreMadeAnewOnlyWhenSomethingInThemChanged) {
  use(test::syntheticMountains());
  auto r = ofMountains(30, 1, 0);
  r.symbology = symbols();
  FrameResult result;
  const auto first = picture(r, &result);
  EXPECT_EQ(result.counters.symbologyRedraws, 1u);
  for (int i = 0; i < 10; ++i) {
    r.symbology->state.altitude = r.symbology->state.altitude + Metres{0.05};
    EXPECT_EQ(differing(first, picture(r, &result)), 0u);
  }
  EXPECT_EQ(result.counters.symbologyRedraws, 1u);
  EXPECT_EQ(result.counters.symbologyDraws, 11u);
  r.symbology->state.speed = Knots{260};
  EXPECT_GT(differing(first, picture(r, &result)), 10u);
  EXPECT_EQ(result.counters.symbologyRedraws, 2u);
}

TEST_F(PostPasses, symbolsTurnedOffChangeOnlyTheirOwnPixels) {
  use(test::syntheticMountains());
  const auto r = ofMountains(30, 1, 0);
  const auto plain = picture(r);
  auto all = r;
  all.symbology = symbols();
  const auto full = picture(all);
  EXPECT_GT(differing(plain, full), 2000u);
  // In the picture of all symbols, each pixel that a symbol alone does not touch is as without that symbol.
  for (std::size_t i = 0; i < kSymbols; ++i) {
    auto without = all;
    without.symbology->setup.element[i].show = false;
    auto alone = all;
    for (std::size_t j = 0; j < kSymbols; ++j) alone.symbology->setup.element[j].show = j == i;
    const auto rest = picture(without), own = picture(alone);
    std::size_t mine = 0, strangers = 0;
    for (std::size_t at = 0; at < full.size(); at += 4) {
      const bool touched = !std::equal(&own[at], &own[at] + 4, &plain[at]);
      const bool changed = !std::equal(&full[at], &full[at] + 4, &rest[at]);
      mine += touched;
      strangers += changed && !touched;
    }
    EXPECT_GT(mine, 50u) << "symbol " << i << " is not seen";
    EXPECT_EQ(strangers, 0u) << "symbol " << i;
  }
  all.symbology->setup.general.enabled = false;
  EXPECT_EQ(differing(plain, picture(all)), 0u);
}

TEST_F(PostPasses, symbolsOfAHostHaveTheirPlaceColourAndAlpha) {
  auto r = uniform(1, 0);
  const auto plain = picture(r);
  r.symbology = symbols();
  for (std::size_t i = 0; i < kSymbols; ++i)
    r.symbology->setup.element[i].show = i == static_cast<std::size_t>(Symbol::host);
  FrameResult result;
  const auto drawn = picture(r, &result);
  const auto pixel = [&](const std::vector<std::uint8_t>& p, int x, int y) {
    const std::size_t at = (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)) * 4;
    return std::array<int, 3>{p[at], p[at + 1], p[at + 2]};
  };
  const std::array<int, 3> magenta{255, 0, 255};
  const int left = kWidth / 4, right = kWidth * 3 / 4, low = kHeight / 4, high = kHeight * 3 / 4;
  EXPECT_EQ(pixel(drawn, left, low), magenta);
  EXPECT_EQ(pixel(drawn, left + 50, low), magenta);
  EXPECT_EQ(pixel(drawn, left + 50, low + 20), pixel(plain, left + 50, low + 20)) << "between the lines";
  const auto under = pixel(plain, right, high), through = pixel(drawn, right, high);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(through[c], under[c] + (magenta[c] - under[c]) * 128 / 255.0, 1.5)
        << "half of it shines through";
  EXPECT_EQ(pixel(drawn, right, low), pixel(plain, right, low));
  EXPECT_EQ(result.counters.hostSymbolsLeftOut, 0u);

  const std::uint64_t redraws = result.counters.symbologyRedraws;
  picture(r, &result);
  EXPECT_EQ(result.counters.symbologyRedraws, redraws) << "the same store";
  auto changed = std::make_shared<HostSymbols>(*hostSymbols());
  changed->symbols[0].rgba = {0, 0, 255, 255};
  changed->symbols[1].surface = 9;
  r.symbology->host = changed;
  const auto blue = picture(r, &result);
  EXPECT_EQ(result.counters.symbologyRedraws, redraws + 1);
  EXPECT_EQ(result.counters.hostSymbolsLeftOut, 1u) << "there is no surface 9";
  EXPECT_EQ(pixel(blue, left, low), (std::array<int, 3>{0, 0, 255}));
  EXPECT_EQ(pixel(blue, right, high), under);
  r.symbology->setup.general.recolourHost = true;
  r.symbology->setup.element[static_cast<std::size_t>(Symbol::host)].colour = SymbolColour::red;
  const auto red = scene::symbolColour(SymbolColour::red);
  EXPECT_EQ(pixel(picture(r), left, low), (std::array<int, 3>{red[0], red[1], red[2]}));
  r.symbology->setup.element[static_cast<std::size_t>(Symbol::host)].show = false;
  EXPECT_EQ(differing(plain, picture(r)), 0u);
}

TEST_F(PostPasses, symbolsStaySharpInABlur) {
  use(test::syntheticMountains());
  auto r = ofMountains(30, 1, 0);
  r.symbology = symbols();
  const auto sharp = picture(r);
  r.symbology.reset();
  const auto plain = picture(r);
  picture(ofMountains(30, 9, 0));
  // A trail of symbols would be seen beside the moved ones.
  for (int i = 0; i < 5; ++i) {
    auto blurred = ofMountains(30, 10 + i * 0.01, 0.95);
    blurred.symbology = symbols();
    blurred.symbology->setup.element[0].x = Ratio{0.02 * (4 - i)};
    const auto p = picture(blurred);
    if (i < 4) continue;
    EXPECT_LE(difference(p, sharp), 1);
  }
  EXPECT_GT(differing(plain, sharp), 1000u);
}

TEST_F(PostPasses, symbolsHaveTheirColourAndARim) {
  auto r = uniform(1, 0);
  r.symbology = symbols();
  r.symbology->state.view = r.symbology->state.aircraft = {};
  r.symbology->setup.general.lineWidth = Pixels{4};
  r.symbology->setup.general.outline = Pixels{2};
  for (std::size_t i = 0; i < kSymbols; ++i)
    r.symbology->setup.element[i].show = i == static_cast<std::size_t>(Symbol::pitch_ladder);
  const auto pixel = [&](const std::vector<std::uint8_t>& p, int x, int y) {
    const std::size_t at = (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)) * 4;
    return std::array<int, 3>{p[at], p[at + 1], p[at + 2]};
  };
  for (int c = 0; c < 8; ++c) {
    const auto colour = static_cast<SymbolColour>(c);
    r.symbology->setup.element[0].colour = colour;
    const auto p = picture(r);
    const auto expected = scene::symbolColour(colour);
    // The horizon's bar runs along the picture's middle, between two rows.
    EXPECT_EQ(pixel(p, 450, 180), (std::array<int, 3>{expected[0], expected[1], expected[2]})) << c;
    const auto rim = pixel(p, 450, 183);
    if (colour == SymbolColour::black)
      EXPECT_GT(rim[1], 200);
    else
      EXPECT_LT(rim[1], 40);
    EXPECT_EQ(pixel(p, 450, 188), pixel(p, 450, 189)) << "sky again";
  }
  // Without a rim a line that covers half of a row of pixels leaves half of what was there.
  r.symbology->setup.general.lineWidth = Pixels{3};
  r.symbology->setup.general.outline = Pixels{0};
  r.symbology->setup.element[0].colour = SymbolColour::red;
  const auto over = picture(r);
  r.symbology.reset();
  const auto below = picture(r);
  const auto red = scene::symbolColour(SymbolColour::red);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(pixel(over, 450, 180)[c], red[c]);
    EXPECT_NEAR(pixel(over, 450, 181)[c], 0.5 * (red[c] + pixel(below, 450, 181)[c]), 2);
    EXPECT_EQ(pixel(over, 450, 182)[c], pixel(below, 450, 182)[c]);
  }
}

}  // namespace
}  // namespace trimtab
