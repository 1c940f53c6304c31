#include "trimtab/decision/decide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <random>
#include <string>

#include "tests/core/fuzzy/published_tables.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/not_finite.h"

namespace {
/// Allocations by this program so far.
std::size_t allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// Not inlined: the compiler would see free() meet what it takes for the standard operator new.
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace trimtab {
namespace {

const TuningParameters kDefaults;

ValidatedParameters valid(const TuningParameters& p) {
  Result<ValidatedParameters> result = validate(p);
  EXPECT_TRUE(result.ok()) << toString(result.findings());
  return result ? *result : defaultParameters();
}

FrameInput flying(double altitudeFt, double pitchDeg) {
  FrameInput input;
  input.state.position.height = Feet{altitudeFt}.as<Metres>();
  input.state.attitude.pitch = Degrees{pitchDeg};
  return input;
}

FrameDecision first(const FrameInput& input, const ValidatedParameters& parameters) {
  DecisionMemory memory;
  return decide(input, parameters, memory);
}

std::string decimals(double value, const char* printed) {
  const char* point = std::strchr(printed, '.');
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", point ? static_cast<int>(std::strlen(point + 1)) : 0, value);
  return text;
}

/// As the file presets/as-published sets it.
ValidatedParameters asPublished() {
  const Result<Preset> preset = loadPreset("as-published");
  EXPECT_TRUE(preset.ok()) << toString(preset.findings());
  return valid(preset ? preset->parameters : kDefaults);
}

TEST(Decide, reproducesEveryPublishedRowAsPublished) {
  const ValidatedParameters p = asPublished();
  for (const test::Printed& row : test::kPrintedAltitude)
    EXPECT_EQ(decimals(first(flying(row.x, 0), p).altitudeMembership, row.membership), row.membership)
        << row.x;
  for (const test::Printed& row : test::kPrintedPitch)
    EXPECT_EQ(decimals(first(flying(0, row.x), p).pitchMembership, row.membership), row.membership) << row.x;
  // A total by way of pitch: below 4,000 ft from 1 up, above 8,000 ft down to 0.
  for (double altitude = 0; altitude < 9000; altitude += 90) {
    for (double pitch = -40; pitch < 40; pitch += 0.7) {
      const FrameDecision d = first(flying(altitude, pitch), p);
      const test::PrintedBand* band = nullptr;
      for (const test::PrintedBand& b : test::kPrintedBands)
        if (d.totalMembership >= b.low && (d.totalMembership < b.high || b.high == 2.0)) band = &b;
      ASSERT_EQ(d.scheme, band ? Scheme::dynamic : Scheme::frustum);
      ASSERT_EQ(d.occlusionResolution,
                band ? std::optional(OcclusionResolution{band->width, band->height}) : std::nullopt);
    }
  }
}

TEST(Decide, reproducesEveryPublishedAltitudeByDefault) {
  const ValidatedParameters p = defaultParameters();
  for (const test::Printed& row : test::kPrintedAltitude)
    EXPECT_EQ(decimals(first(flying(row.x, 0), p).altitudeMembership, row.membership), row.membership)
        << row.x;
}

TEST(Decide, asPrintedMissesThePublishedAltitudesInOneRow) {
  const Result<Preset> preset = loadPreset("as-printed");
  ASSERT_TRUE(preset.ok()) << toString(preset.findings());
  const ValidatedParameters p = valid(preset->parameters);
  for (const test::Printed& row : test::kPrintedAltitude) {
    const double value = first(flying(row.x, 0), p).altitudeMembership;
    if (row.x == 7990)
      EXPECT_EQ(decimals(value, "0.001"), "0.099");
    else
      EXPECT_EQ(decimals(value, row.membership), row.membership) << row.x;
  }
}

TEST(Decide, restsOnABandEdgeInPublishedLevelFlight) {
  EXPECT_EQ(first(flying(3000, 0), asPublished()).totalMembership, 1.5);
  EXPECT_EQ(first(flying(3000, 0), asPublished()).occlusionResolution, (OcclusionResolution{800, 600}));
  EXPECT_EQ(first(flying(9000, 0), asPublished()).totalMembership, 0.5);
  EXPECT_EQ(first(flying(9000, 0), asPublished()).occlusionResolution, (OcclusionResolution{400, 300}));
}

TEST(Decide, takesWholeFeetAsWholeFeet) {
  for (int feet = -2000; feet <= 70000; ++feet) {
    const FrameDecision d = first(flying(feet, 0), defaultParameters());
    ASSERT_EQ(d.altitudeFt, feet);
  }
}

TEST(Decide, usesTheHeightAboveGroundWhereAskedAndSaysWhenNobodyKnowsIt) {
  TuningParameters p = kDefaults;
  p.altitude.reference = AltitudeReference::above_ground;
  FrameInput input = flying(20000, 0);
  FrameDecision d = first(input, valid(p));
  EXPECT_EQ(d.scheme, Scheme::frustum);
  EXPECT_EQ(d.reason, SchemeReason::altitude_unknown);
  EXPECT_FALSE(d.occlusionResolution);
  input.aboveGround = Feet{5000}.as<Metres>();
  d = first(input, valid(p));
  EXPECT_EQ(d.altitudeFt, 5000);
  EXPECT_EQ(d.altitudeMembership, 0.6);
  EXPECT_EQ(first(input, defaultParameters()).altitudeFt, 20000);
  FrameInput fromHost = flying(20000, 0);
  fromHost.state.aboveGround = Feet{5000}.as<Metres>();
  EXPECT_EQ(first(fromHost, valid(p)).altitudeFt, 5000) << "what the host says of the state holds as well";
}

TEST(Decide, refusesWhatIsNotANumberAndLeavesTheMemoryAlone) {
  const ValidatedParameters p = defaultParameters();
  for (const auto& [altitude, pitch] : {std::pair{kNan, 0.0},
                                        {0.0, kNan},
                                        {kInfinity, 0.0},
                                        {-kInfinity, 0.0},
                                        {0.0, kInfinity},
                                        {0.0, -kInfinity},
                                        {kNan, kNan}}) {
    DecisionMemory memory{2};
    const FrameDecision d = decide(flying(altitude, pitch), p, memory);
    EXPECT_EQ(d.reason, SchemeReason::invalid_input);
    EXPECT_EQ(d.scheme, Scheme::frustum);
    EXPECT_FALSE(d.occlusionResolution);
    EXPECT_EQ(memory.band, 2);
    EXPECT_TRUE(std::isfinite(d.altitudeFt) && std::isfinite(d.pitchDeg) && std::isfinite(d.totalMembership));
  }
}

TEST(Decide, holdsABandByHysteresisAndSaysSo) {
  const ValidatedParameters p = defaultParameters();
  DecisionMemory memory;
  EXPECT_EQ(decide(flying(3000, 0), p, memory).reason, SchemeReason::in_band);
  EXPECT_EQ(memory.band, 3);
  const FrameDecision held = decide(flying(3000, 2.9), p, memory);  // 1.4517: 0.0483 below the edge
  EXPECT_EQ(held.band, 3);
  EXPECT_EQ(held.reason, SchemeReason::held_by_hysteresis);
  EXPECT_EQ(decide(flying(3000, 3.1), p, memory).band, 2);
  EXPECT_EQ(decide(flying(3000, -2.9), p, memory).band, 2);
  EXPECT_EQ(decide(flying(3000, -3.1), p, memory).band, 3);
}

TEST(Decide, carriesTheLevelOfDetailScale) {
  TuningParameters p = kDefaults;
  p.lod.scale = Ratio{1.5};
  EXPECT_EQ(leversOf(first(flying(0, 0), valid(p)), *valid(p)).drawn.lodScale, 1.5);
  EXPECT_EQ(leversOf(first(flying(kNan, 0), valid(p)), *valid(p)).drawn.lodScale, 1.5);
}

TEST(Decide, neverFlipsOnARandomWalkOfOneFoot) {
  const ValidatedParameters p = defaultParameters();
  // Altitudes whose total in level flight rests on a band's edge: 1.0 at 5333 ft; 0.5 from 8000 ft up.
  for (const double edge : {5333.0, 8000.0}) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      std::mt19937_64 random(seed);
      DecisionMemory memory;
      double altitude = edge;
      const int band = decide(flying(altitude, 0), p, memory).band;
      for (int i = 0; i < 2000; ++i) {
        altitude = std::clamp(altitude + (random() % 2 ? 1.0 : -1.0), edge - 120, edge + 120);
        ASSERT_EQ(decide(flying(altitude, 0), p, memory).band, band) << altitude << " ft, seed " << seed;
      }
    }
  }
}

TEST(Decide, flipsOnThatWalkWithoutHysteresis) {
  TuningParameters p = kDefaults;
  p.scheme.hysteresis = Membership{0};
  const ValidatedParameters plain = valid(p);
  DecisionMemory memory;
  std::mt19937_64 random(1);
  int flips = 0, band = decide(flying(5333, 0), plain, memory).band;
  for (int i = 0; i < 2000; ++i) {
    const int next = decide(flying(5333 + static_cast<double>(random() % 3) - 1, 0), plain, memory).band;
    flips += next != band;
    band = next;
  }
  EXPECT_GT(flips, 100);
}

TEST(Decide, isPureButForItsMemory) {
  const ValidatedParameters p = defaultParameters();
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> altitudes(-500, 12000), pitches(-90, 90);
  DecisionMemory a, b;
  for (int i = 0; i < 20000; ++i) {
    const FrameInput input = flying(altitudes(random), pitches(random));
    const DecisionMemory before = a;
    const FrameDecision once = decide(input, p, a), twice = decide(input, p, b);
    ASSERT_EQ(once, twice);
    ASSERT_EQ(a, b);
    DecisionMemory again = before;
    ASSERT_EQ(decide(input, p, again), once);
  }
}

TEST(Decide, doesNotAllocate) {
  TuningParameters policy = kDefaults;
  policy.policy.enabled = true;
  policy.policy.terms.line = {"altitude low = ramp 8000 2000", "pitch down = ramp 0 -20"};
  policy.policy.rules.line = {"if altitude is low and not pitch is down then screen_space_error = 4",
                              "if pitch is down then lod_scale = 2, particle_density = 0.5"};
  for (const ValidatedParameters& p : {defaultParameters(), valid(policy)}) {
    DecisionMemory memory;
    FrameInput inputs[] = {flying(3000, 1), flying(9000, 29), flying(kNan, 0), flying(6500, -12)};
    for (FrameInput& input : inputs) {
      input.signalValues[Signal::altitude] = input.state.position.height.as<Feet>().value();
      input.signalValues[Signal::pitch] = input.state.attitude.pitch.value();
    }
    decide(inputs[0], p, memory);  // a thread's first decision makes its working storage
    const std::size_t before = allocations;
    for (const FrameInput& input : inputs) decide(input, p, memory);
    EXPECT_EQ(allocations, before);
  }
  EXPECT_GT(allocations, 0u) << "the counter must count";
}

TEST(Explain, namesNumbersOutcomeAndReasonInOneLine) {
  const ValidatedParameters p = defaultParameters();
  EXPECT_EQ(
      explain(first(flying(5500, -3), p), p),
      "dynamic, depth map 640 x 480: 5500 ft gives 0.450, pitch -3.00 deg gives 0.550, sum 1.000, in band "
      "[1, 1.5)");
  EXPECT_EQ(explain(first(flying(9000, 28), p), p),
            "frustum, no depth map: 9000 ft gives 0.000, pitch 28.00 deg gives 0.033, sum 0.033, below 0.1");
  EXPECT_EQ(
      explain(first(flying(1000, -30), p), p),
      "dynamic, depth map 800 x 600: 1000 ft gives 1.000, pitch -30.00 deg gives 1.000, sum 2.000, in band "
      "[1.5, 2]");
  DecisionMemory memory{3};
  EXPECT_EQ(explain(decide(flying(3000, 2.4), p, memory), p),
            "dynamic, depth map 800 x 600: 3000 ft gives 1.000, pitch 2.40 deg gives 0.460, sum 1.460, held "
            "in band "
            "[1.5, 2] by hysteresis 0.05");
  EXPECT_EQ(explain(first(flying(kNan, 0), p), p),
            "frustum, no depth map: the altitude or the pitch is not a number");
}

TEST(Decide, theChainKeepsWhatThePresetWouldHaveDrawn) {
  TuningParameters p = *asPublished();
  p.policy.enabled = true;
  p.policy.rules.line = {"if altitude is any then occlusion = 0", "if altitude is any then lod_scale = 3"};
  const ValidatedParameters parameters = valid(p);
  const FrameDecision plain = first(flying(3000, 0), asPublished());
  FrameInput input = flying(3000, 0);
  input.signalValues[Signal::altitude] = 3000;
  const FrameDecision ruled = first(input, parameters);
  const LeverChain chain = leversOf(ruled, *parameters);
  EXPECT_EQ(ruled.scheme, Scheme::frustum) << "the rule says so";
  EXPECT_FALSE(chain.drawn.occlusion);
  EXPECT_EQ(chain.preset.occlusion, plain.occlusionResolution) << "the memberships do not";
  EXPECT_TRUE(chain.preset.occlusion);
  EXPECT_EQ(chain.weather.lodScale, 1);
  EXPECT_EQ(chain.drawn.lodScale, 3);
  EXPECT_EQ(chain.drawn, chain.policy);
  EXPECT_EQ(askedLevers(ruled, *parameters), chain.policy) << "the last step alone";
  EXPECT_EQ(askedLevers(plain, *parameters), leversOf(plain, *parameters).policy);
}

}  // namespace
}  // namespace trimtab
