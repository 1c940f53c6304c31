// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <string>

#include "trimtab/decision/decide.h"
#include "trimtab/preset/policy_lines.h"
#include "views/model/draft.h"
#include "views/model/live.h"

namespace trimtab::test {

/// Puts a policy, as lines, into a draft and switches it on.
inline void setPolicy(views::Draft& draft, const std::vector<std::string>& terms,
                      const std::vector<std::string>& rules) {
  draft.setValue("policy.terms", TextLines{terms});
  draft.setValue("policy.rules", TextLines{rules});
  draft.setValue("policy.enabled", true);
}

/// Two terms over the height, one over the speed, two rules.
inline void setSmallPolicy(views::Draft& draft) {
  setPolicy(draft,
            {"above_ground low = ramp 2000 1000", "above_ground high = ramp 1000 2000",
             "speed fast = ramp 200 400"},
            {"if above_ground is low and speed is fast then screen_space_error = 4 # blurred by speed",
             "if above_ground is high then screen_space_error = 1.5, far_distance = 0.8"});
}

/// Eight signals, three terms over each, forty rules over six levers.
inline void setLargePolicy(views::Draft& draft) {
  struct Row {
    const char *signal, *low, *middle, *high;
  };
  static constexpr Row kRows[] = {
      {"altitude", "trapezoid -inf 0 4000 9000", "triangle 4000 9000 20000", "ramp 9000 20000"},
      {"above_ground", "ramp 1500 300", "gaussian 2500 1000", "sigmoid 6000 0.002"},
      {"pitch", "ramp -2 -12", "bell 0 6 2", "ramp 4 14"},
      {"roll", "ramp 20 5", "triangle 10 30 50", "ramp 35 60"},
      {"speed", "ramp 180 120", "points 120 0 200 1 320 1 420 0", "sigmoid 420 0.03"},
      {"sight_rate", "ramp 20 5", "triangle 10 40 80", "ramp 60 120"},
      {"visibility", "ramp 4000 1500", "triangle 2000 8000 20000", "ramp 12000 30000"},
      {"load", "ramp 0.8 0.6", "triangle 0.6 0.9 1.1", "ramp 0.95 1.25"}};
  static constexpr const char* kNames[] = {"low", "medium", "high"};
  std::vector<std::string> terms, rules;
  for (const Row& row : kRows) {
    const char* const shapes[] = {row.low, row.middle, row.high};
    for (int i = 0; i < 3; ++i)
      terms.push_back(std::string(row.signal) + " " + kNames[i] + " = " + shapes[i]);
  }
  static constexpr const char* kLevers[] = {"screen_space_error", "lod_scale",     "far_distance",
                                            "particle_density",   "blur_strength", "render_scale"};
  static constexpr double kValues[][3] = {{2, 4, 8},     {1, 1.5, 2},   {1, 0.9, 0.7},
                                          {1, 0.7, 0.4}, {1, 0.8, 0.6}, {1, 0.9, 0.75}};
  for (int i = 0; i < 40; ++i) {
    const int a = i % 8, b = (i * 3 + 1) % 8 == a ? (a + 1) % 8 : (i * 3 + 1) % 8, lever = i % 6;
    std::string rule = i == 17 ? "off if " : "if ";
    rule += std::string(kRows[a].signal) + " is " + kNames[i % 3] + (i % 5 == 0 ? " or " : " and ") +
            (i % 7 == 0 ? "not " : "") + kRows[b].signal + " is " + (i % 4 == 1 ? "very " : "") +
            kNames[(i / 3) % 3] + " then " + kLevers[lever] + " = " +
            std::to_string(kValues[lever][(i / 6) % 3]);
    if (i % 4 == 0)
      rule +=
          std::string(", ") + kLevers[(lever + 1) % 6] + " = " + std::to_string(kValues[(lever + 1) % 6][1]);
    if (i % 6 == 2) rule += " with 0.5";
    rules.push_back(rule + " # what rule " + std::to_string(i + 1) + " is for");
  }
  setPolicy(draft, terms, rules);
}

/// A made-up flight whose signals all move; one frame a call.
class PolicyFlight {
 public:
  explicit PolicyFlight(double hz = 20) : hz_(hz) {}

  views::LiveFrame next(const ValidatedParameters& parameters) {
    const double t = static_cast<double>(frame_++) / hz_;
    views::LiveFrame f;
    f.time = f.input.state.time = t;
    f.input.state.packet = frame_;
    f.input.state.position.height = Feet{6000 - 4000 * std::cos(t * 0.1)}.as<Metres>();
    f.input.state.attitude.pitch = Degrees{8 * std::sin(t * 0.3)};
    if (parameters.policy() != nullptr) f.input.signalValues = signalsAt(t);
    f.decision = decide(f.input, parameters, memory_);
    return f;
  }
  /// Returns the same frame with other signals and its decision.
  views::LiveFrame at(const SignalValues& flight, const ValidatedParameters& parameters) {
    DecisionMemory fresh;
    views::LiveFrame f;
    f.time = f.input.state.time = static_cast<double>(frame_++) / hz_;
    f.input.signalValues = flight;
    f.decision = decide(f.input, parameters, fresh);
    return f;
  }

 private:
  static SignalValues signalsAt(double t) {
    SignalValues values;
    values[Signal::altitude] = 6000 - 4000 * std::cos(t * 0.1);
    values[Signal::above_ground] = 1800 - 1500 * std::cos(t * 0.13);
    values[Signal::pitch] = 8 * std::sin(t * 0.3);
    values[Signal::roll] = std::abs(40 * std::sin(t * 0.21));
    values[Signal::speed] = 280 + 140 * std::sin(t * 0.09);
    values[Signal::climb] = 1800 * std::sin(t * 0.1);
    values[Signal::sight_rate] = std::abs(70 * std::sin(t * 0.4));
    values[Signal::visibility] = 9000 + 5000 * std::sin(t * 0.05);
    values[Signal::precipitation] = 0;
    values[Signal::load] = 0.85 + 0.25 * std::sin(t * 0.17);
    values[Signal::triangles] = 640000 + 90000 * std::sin(t * 0.2);
    return values;  // nobody knows the head's own rate
  }

  double hz_;
  std::uint64_t frame_ = 0;
  DecisionMemory memory_;
};

}  // namespace trimtab::test
