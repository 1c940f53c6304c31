#include <cmath>
#include <optional>
#include <set>

#include "tests/core/scene/scene_test.h"
#include "tests/core/terrain/baked_sample.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/preset/preset.h"
#include "trimtab/session/session.h"

namespace trimtab {
namespace {

constexpr double kImageS = 1.0 / 60;
/// Images after which every lever has crossed its usual range, and on which none may move any more.
constexpr int kSettles = 40, kRests = 30;

/// The loop that the policies that ship close in flight: the allowed error sets how many triangles an image
/// has, and the triangles of the last image are a signal that sets the allowed error.
class PolicyLoop : public test::SceneTest, public testing::WithParamInterface<const char*> {
 protected:
  static constexpr int kImageWidth = 320, kImageHeight = 180;
  /// An image of four times the size has about so many times the triangles, and policies are made for such.
  static constexpr std::uint64_t kLarger = 8;

  void SetUp() override {
    SceneTest::SetUp();
    if (!offscreen) return;
    use(sample());
    ASSERT_NE(database, nullptr);
    session.emplace(*validate(loadPreset(GetParam())->parameters));
    session->setGround(database);
  }

  static std::shared_ptr<const terrain::Database> sample() {
    static const test::ScratchDir dir;
    static const auto baked = test::bakedSample(dir.path(), {1, 60, 90, {}});
    return baked;
  }

  AircraftState viewAt(double aboveM, double headingDeg) const {
    AircraftState state;
    state.time = 10;
    state.position = over(0.45, 0.4, aboveM);
    state.attitude = {Degrees{headingDeg}, Degrees{-4}, Degrees{0}};
    return state;
  }

  /// Decides and draws the next image of a state, and hands the result back as the programs do.
  void fly(AircraftState& state) {
    state.time += kImageS;
    ++state.packet;
    session->fly(state, state.time);
    auto request = session->request(state.time, kImageWidth, kImageHeight);
    ASSERT_TRUE(request);
    request->waitForPages = true;
    offscreen->makeCurrent();
    FrameResult result = renderer.draw(*request, offscreen->framebuffer());
    result.visible.triangles *= kLarger;
    session->finished(result, state.time);
    const PolicyOutcome now = session->decision().policy;
    for (const LeverRow& row : kLeverRows) {
      if (!begun || !now.moves(row.lever)) continue;
      const double before = last[row.lever], value = now[row.lever];
      const double change = row.logarithmic ? std::log2(value / before) : value - before;
      ASSERT_LE(std::abs(change), row.ratePerS * kImageS + 1e-9) << row.key;
      if (change == 0) continue;
      reversals += change * direction[row.lever] < 0;
      direction[row.lever] = change;
    }
    last = now;
    begun = true;
  }

  double errorPx() const { return session->decision().policy[Lever::screen_space_error]; }

  void rest(AircraftState& state) {
    for (int i = 0; i < kSettles; ++i) ASSERT_NO_FATAL_FAILURE(fly(state));
    const PolicyOutcome settled = last;
    for (int i = 0; i < kRests; ++i) {
      ASSERT_NO_FATAL_FAILURE(fly(state));
      ASSERT_EQ(last, settled) << "a lever moves while the view rests: " << errorPx() << " px";
    }
  }

  std::optional<Session> session;
  PolicyOutcome last;
  LeverValues direction = LeverValues::all(0);
  int reversals = 0;
  bool begun = false;
};

TEST_P(PolicyLoop, comesToRestWhereTheViewRests) {
  std::set<double> errors;
  for (const double aboveM : {100.0, 800.0, 5000.0}) {
    AircraftState state = viewAt(aboveM, 30);
    session->restart();
    begun = false;
    ASSERT_NO_FATAL_FAILURE(rest(state)) << aboveM;
    errors.insert(errorPx());
  }
  EXPECT_GT(errors.size(), 1u) << "the loop must be closed: other views, other errors";
  EXPECT_GT(*errors.rbegin(), 1) << "somewhere many triangles are in view";
}

TEST_P(PolicyLoop, doesNotSwingInASlowClimb) {
  AircraftState state = viewAt(600, 30);
  for (int i = 0; i < 300; ++i) {
    state.position.height = state.position.height + Metres{0.15};
    if (i == kSettles) reversals = 0;
    ASSERT_NO_FATAL_FAILURE(fly(state));
  }
  EXPECT_LE(reversals, 4) << "in four seconds";
  ASSERT_NO_FATAL_FAILURE(rest(state)) << "at the top of the climb";
}

INSTANTIATE_TEST_SUITE_P(Presets, PolicyLoop,
                         testing::Values("low-level", "approach", "helmet-search", "high-cruise"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace trimtab
