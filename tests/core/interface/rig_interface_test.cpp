#include <cmath>
#include <cstdlib>
#include <random>

#include "tests/core/rig/profiles.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/trimtab.h"

// Profiles and fits by libtrimtab, for an image generator whose images are known.
namespace trimtab::test {
namespace {

constexpr double kBudgetMs = 14;

class RigInterface : public ::testing::Test {
 protected:
  RigInterface() {
    TuningParameters p;
    p.hold.enabled = true;
    p.measure.budget = Milliseconds{kBudgetMs};
    writeFile(dir_ / "preset.json", exportText(*validate(p), "held", {}, ExportFormat::json));
    writeFile(dir_ / "profile.json", kViewer);
    EXPECT_EQ(trimtab_preset_load((dir_ / "preset.json").c_str(), &preset_, nullptr), TRIMTAB_OK);
    EXPECT_EQ(trimtab_profile_load((dir_ / "profile.json").c_str(), &profile_, nullptr), TRIMTAB_OK);
  }
  ~RigInterface() override {
    trimtab_profile_free(profile_);
    trimtab_preset_free(preset_);
  }

  trimtab_session* session(const trimtab_preset* preset) const {
    trimtab_session* made = nullptr;
    EXPECT_EQ(trimtab_session_create(preset, &made), TRIMTAB_OK);
    return made;
  }

  /// Draws one image as an image generator does that knows neither fit nor budget: its triangles fall with
  /// the power 0.7 of its LOD scale. Returns its time, milliseconds.
  double draw(trimtab_session* session, int i) {
    trimtab_state s{};
    s.size = sizeof s;
    trimtab_state_clear(&s);
    s.time_s = i / 60.0;
    s.packet = static_cast<std::uint64_t>(i);
    s.height_m = 1500;
    s.latitude_deg = 1e-5 * i;
    EXPECT_EQ(trimtab_session_fly(session, &s), TRIMTAB_OK);
    trimtab_image image{};
    image.size = sizeof image;
    EXPECT_EQ(trimtab_session_request(session, s.time_s, 640, 360, &image), TRIMTAB_OK);
    double own[2] = {};
    EXPECT_EQ(trimtab_session_own_levers(session, own, 2), TRIMTAB_OK);
    const double place = image.latitude_deg / 1e-5;
    trimtab_frame frame{};
    frame.size = sizeof frame;
    trimtab_frame_clear(&frame);
    frame.triangles =
        static_cast<std::uint64_t>(1.2e5 * (1 + 0.4 * std::sin(place / 60)) * std::pow(own[0], -0.7));
    frame.draw_ms = frame.total_ms = std::normal_distribution<double>(1, 0.02)(random_) *
                                     (3 + 2e-4 * static_cast<double>(frame.triangles));
    EXPECT_EQ(trimtab_session_finished(session, &frame, s.time_s), TRIMTAB_OK);
    return frame.total_ms;
  }
  int over(trimtab_session* session, int images) {
    int count = 0;
    for (int i = 0; i < images; ++i) count += draw(session, i) > 1.1 * kBudgetMs;
    return count;
  }

  ScratchDir dir_;
  trimtab_preset* preset_ = nullptr;
  trimtab_profile* profile_ = nullptr;
  std::mt19937 random_{3};
};

TEST_F(RigInterface, namesTheLeversOfAProfile) {
  ASSERT_EQ(trimtab_profile_lever_count(profile_), 2u);
  trimtab_own_lever lever{};
  lever.size = sizeof lever;
  ASSERT_EQ(trimtab_profile_lever(profile_, 1, &lever), TRIMTAB_OK);
  EXPECT_STREQ(lever.key, "far_distance");
  EXPECT_STREQ(lever.own_key, "zFar");
  EXPECT_STREQ(lever.own_unit, "km");
  EXPECT_EQ(lever.from, 5);
  EXPECT_EQ(lever.neutral, 80);
  EXPECT_EQ(trimtab_profile_lever(profile_, 2, &lever), TRIMTAB_MISUSE);
  trimtab_session* s = session(preset_);
  double own[2] = {};
  EXPECT_EQ(trimtab_session_own_levers(s, own, 2), TRIMTAB_MISUSE) << "it has no profile";
  ASSERT_EQ(trimtab_session_set_profile(s, profile_, nullptr), TRIMTAB_OK);
  EXPECT_EQ(trimtab_session_own_levers(s, own, 2), TRIMTAB_NOTHING) << "it has no state";
  EXPECT_EQ(trimtab_session_own_levers(s, own, 3), TRIMTAB_MISUSE);
  draw(s, 0);
  ASSERT_EQ(trimtab_session_own_levers(s, own, 2), TRIMTAB_OK);
  EXPECT_EQ(own[0], 1);
  EXPECT_EQ(own[1], 80);
  trimtab_session_free(s);
}

TEST_F(RigInterface, holdsABudgetFromTheFirstImageOnAfterAFit) {
  const std::string file = (dir_ / "fit.json").string();
  ::setenv("TRIMTAB_PROFILE", (dir_ / "profile.json").c_str(), 1);
  ::setenv("TRIMTAB_FIT", file.c_str(), 1);
  trimtab_session* fitting = session(preset_);
  ::unsetenv("TRIMTAB_PROFILE");
  ::unsetenv("TRIMTAB_FIT");
  for (int i = 0; i < 40 * 16; ++i) draw(fitting, i);
  EXPECT_EQ(trimtab_session_fit_views(fitting), 40u);
  EXPECT_TRUE(std::filesystem::exists(file)) << "a program that is killed leaves what it has";
  trimtab_session_free(fitting);

  trimtab_fit* fit = nullptr;
  trimtab_findings* findings = nullptr;
  ASSERT_EQ(trimtab_fit_load(file.c_str(), &fit, &findings), TRIMTAB_OK);
  trimtab_findings_free(findings);
  trimtab_preset* adapted = nullptr;
  ASSERT_EQ(trimtab_preset_adapt(preset_, profile_, fit, &adapted, &findings), TRIMTAB_OK);
  EXPECT_GT(trimtab_findings_count(findings), 0u) << "the image generator lacks levers";
  trimtab_findings_free(findings);

  constexpr int kImages = 60;
  trimtab_session* unfitted = session(preset_);
  ASSERT_EQ(trimtab_session_set_profile(unfitted, profile_, nullptr), TRIMTAB_OK);
  const int before = over(unfitted, kImages);
  trimtab_session* fitted = session(adapted);
  ASSERT_EQ(trimtab_session_set_profile(fitted, profile_, fit), TRIMTAB_OK);
  const int after = over(fitted, kImages);
  EXPECT_GT(before, 5) << "what images cost has to be learned first";
  EXPECT_LE(after, 1) << "only the first one, before which no load is known";
  for (trimtab_session* s : {unfitted, fitted}) trimtab_session_free(s);
  trimtab_preset_free(adapted);
  trimtab_fit_free(fit);
}

TEST_F(RigInterface, staysInAViewUntilAllSettingsAreDrawn) {
  trimtab_session* s = session(preset_);
  ASSERT_EQ(trimtab_session_set_profile(s, profile_, nullptr), TRIMTAB_OK);
  EXPECT_EQ(trimtab_session_fit_views(s), 0u);
  ASSERT_EQ(trimtab_session_fit_start(s, (dir_ / "fit.json").c_str(), nullptr), TRIMTAB_OK);
  EXPECT_EQ(trimtab_session_fit_start(s, (dir_ / "fit.json").c_str(), nullptr), TRIMTAB_MISUSE);
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(trimtab_session_needs_image(s, i / 60.0), 1);
    draw(s, i);
  }
  EXPECT_EQ(trimtab_session_fit_views(s), 1u);
  trimtab_findings* findings = nullptr;
  EXPECT_EQ(trimtab_session_fit_finish(s, &findings), TRIMTAB_REFUSED);
  trimtab_finding finding{};
  finding.size = sizeof finding;
  ASSERT_EQ(trimtab_findings_get(findings, 0, &finding), TRIMTAB_OK);
  EXPECT_STREQ(finding.key, "views");
  trimtab_findings_free(findings);
  EXPECT_TRUE(std::filesystem::exists(dir_ / "fit.json")) << "what it has is kept";
  draw(s, 16);
  trimtab_session_free(s);
}

TEST_F(RigInterface, refusesWhatTheEnvironmentCannotMean) {
  ::setenv("TRIMTAB_PROFILE", (dir_ / "none.json").c_str(), 1);
  trimtab_session* s = nullptr;
  EXPECT_EQ(trimtab_session_create(preset_, &s), TRIMTAB_REFUSED);
  EXPECT_EQ(s, nullptr);
  ::unsetenv("TRIMTAB_PROFILE");
}

}  // namespace
}  // namespace trimtab::test
