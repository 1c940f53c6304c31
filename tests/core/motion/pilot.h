#pragma once

#include "trimtab/motion/head_motion.h"

namespace trimtab::test {

/// A head that is turned step by step, and what is decided of it.
class Pilot {
 public:
  explicit Pilot(MotionParameters parameters = {}) : p(parameters) { look(); }

  MotionDecision look() {
    AircraftState state;
    state.time = time;
    state.head = Attitude{Degrees{heading}, Degrees{pitch}, Degrees{0}};
    return decideMotion(state, p, memory);
  }
  /// One frame of `seconds` that turns the heading at this rate.
  MotionDecision turn(double degPerS, double seconds = 0.01) {
    time += seconds;
    heading += degPerS * seconds;
    return look();
  }
  MotionDecision turns(int frames, double degPerS, double seconds = 0.01) {
    MotionDecision last;
    for (int i = 0; i < frames; ++i) last = turn(degPerS, seconds);
    return last;
  }

  MotionParameters p;
  MotionMemory memory;
  double time = 0, heading = 0, pitch = 0;
};

}  // namespace trimtab::test
