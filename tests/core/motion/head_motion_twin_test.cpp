#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "pilot.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {
namespace {

using test::Pilot;

/// Document C's semantics read off the history as a whole, frame by frame from the start.
class Twin {
 public:
  explicit Twin(const MotionParameters& parameters) : p_(parameters) {}

  struct Frame {
    double time, heading, pitch;
  };
  struct Outcome {
    double scale;
    std::uint32_t blurCount, restoreCount;
    bool blurred;
  };
  Outcome next(const Frame& frame) {
    history_ += kindOf(frame);
    last_ = frame;
    if (history_.back() == '<') level_ = 0, blurFrom_ = -kInfinity, history_ = "|";
    // Runs end at anything else, at firings ("!") included.
    const auto run = [this](char kind) {
      const std::size_t other = history_.find_last_not_of(kind);
      return history_.size() - (other == std::string::npos ? 0 : other + 1);
    };
    if (run('F') == static_cast<std::size_t>(p_.blurFrames.value())) {
      level_ = std::min(level_ + 1, steps());
      blurFrom_ = frame.time;
      history_ += '!';
    }
    if (run('S') == static_cast<std::size_t>(p_.restoreFrames.value()) + 1) {
      level_ = std::max(level_ - 1, 0);
      blurFrom_ = -kInfinity;
      history_ += '!';
    }
    return {std::min(std::pow(p_.lodStep.value(), level_), p_.lodMaximum.value()),
            static_cast<std::uint32_t>(run('F')), static_cast<std::uint32_t>(run('S')),
            frame.time - blurFrom_ < p_.blurDuration.in<Seconds>() - 1e-8};
  }

 private:
  int steps() const {
    int count = 0;
    while (std::pow(p_.lodStep.value(), count) < p_.lodMaximum.value() - 1e-9) ++count;
    return count;
  }
  char kindOf(const Frame& f) const {
    if (!last_) return '|';
    if (f.time < last_->time) return '<';
    if (f.time - last_->time > p_.gap.in<Seconds>() + 1e-8) return '|';
    double heading = std::fmod(std::abs(f.heading - last_->heading), 360);
    heading = std::min(heading, 360 - heading);
    const double change = std::max(heading, std::abs(f.pitch - last_->pitch));
    const double perFrame = (p_.leftFov + p_.rightFov).value() / (1 / (f.time - last_->time));
    return change > perFrame + 1e-9 ? 'F' : 'S';
  }

  MotionParameters p_;
  std::optional<Frame> last_;
  std::string history_;
  int level_ = 0;
  double blurFrom_ = -kInfinity;
};

TEST(HeadMotion, agreesWithATwinThatReadsTheWholeHistory) {
  std::mt19937 random(11);
  const auto pick = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int lowered = 0, raised = 0, gaps = 0;
  for (int round = 0; round < 60; ++round) {
    MotionParameters p;
    p.leftFov = Degrees{pick(5, 90)};
    p.blurFrames = Ratio{std::floor(pick(1, 14))};
    p.restoreFrames = Ratio{std::floor(pick(0, 9))};
    p.lodStep = Ratio{pick(1.1, 3)};
    p.lodMaximum = Ratio{pick(1, 12)};
    p.blurDuration = Milliseconds{pick(0, 900)};
    p.reference = MotionReference::head;
    Pilot pilot(p);
    Twin twin(p);
    twin.next({0, 0, 0});
    double rate = 0, nod = 0;
    for (int i = 0; i < 1500; ++i) {
      if (random() % 12 == 0) rate = random() % 2 ? pick(-400, 400) : 0;
      if (random() % 15 == 0) nod = random() % 2 ? pick(-150, 150) : 0;
      const double dt = random() % 150 == 0 ? pick(0.26, 2) : random() % 300 == 0 ? -1 : pick(0.002, 0.05);
      pilot.time += dt;
      pilot.heading += rate * std::abs(dt);
      pilot.pitch = std::clamp(pilot.pitch + nod * std::abs(dt), -90.0, 90.0);
      const MotionDecision d = pilot.look();
      const Twin::Outcome expected = twin.next({pilot.time, pilot.heading, pilot.pitch});
      ASSERT_NEAR(d.lodScale, expected.scale, 1e-9) << round << ' ' << i;
      ASSERT_EQ(d.blurStack.frames, expected.blurCount) << round << ' ' << i;
      ASSERT_EQ(d.restoreStack.frames, expected.restoreCount) << round << ' ' << i;
      ASSERT_EQ(d.blur.strength > 0, expected.blurred) << round << ' ' << i;
      lowered += d.reason == MotionReason::lowered;
      raised += d.reason == MotionReason::raised;
      gaps += d.reason == MotionReason::gap;
    }
  }
  EXPECT_GT(lowered, 500);
  EXPECT_GT(raised, 500);
  EXPECT_GT(gaps, 200);
}

}  // namespace
}  // namespace trimtab
